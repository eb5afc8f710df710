/* Sums over waves at single points: as wave_points.py and edge_waves.py of solver/fields/points, their reference, which
   say what is computed. W waves of one point are in the lanes. */
#include "bessel.h"
enum { DIFFERENCE, LAYER, BODY, STATES };   /* where the points are; STATES: the states are those of the caller */
enum { OF_STATE = 6, JET = 6, MOST_FIELDS = 6, OF_HANKEL = 8 };
typedef struct {                            /* the point of a sum, and what all points of a call share */
    int64_t point, at_case;
    double r, z, h, nu, normal, returned, passed;           /* nu of its material, and 1/(1 - nu) */
    Series series;
    double hankel[2][OF_HANKEL];            /* of H_0 and H_1, the real and the imaginary parts by turns */
} Point;
static inline V part_of(const double *from, int64_t count, double fill) {      /* what lies beyond the end is `fill` */
    V x = all(fill);
    if (count >= W) memcpy(&x, from, sizeof x);
    else for (int64_t l = 0; l < count; l++) x[l] = from[l];
    return x;
}
static inline void decays(V x, double nu, V S, V T, V *v) {
    V decay = vexp(-x), shift = x * (S - T);
    v[0] = decay * ((1 - 2 * nu) * S - 2 * (1 - nu) * T - shift);
    v[1] = decay * ((1 - 2 * nu) * T - 2 * (1 - nu) * S - shift);
    v[2] = decay * (S + shift), v[3] = decay * (T + shift);
}
static inline void derive(const Point *at, const V *v, V *to) {                /* A v */
    to[0] = v[1] + 2 * v[3], to[1] = ((1 - 2 * at->nu) * v[2] - at->nu * v[0]) * at->normal;
    to[2] = -v[3], to[3] = (v[0] + at->nu * v[2]) * at->normal;
}
static inline void below(const Point *at, V x, const V *v, V *to) {            /* e^(Ax) v, x < 2 or so */
    V first[4], second[4], third[4], less, e = exponential(x, &less), inverse = 1 / e, square = x * x;
    V sinh = 0.5 * (less + less * inverse), cosh = 0.5 * (e + inverse), half = 0.5 * x * sinh;
    V odd = all(0), rest = x * cosh - sinh;                                    /* the sum of 2j x^(2j + 1)/(2j + 1)! */
    odd = odd * square + 1 / 6758061133824000.0, odd = odd * square + 1 / 22230464256000.0;
    odd = odd * square + 1 / 93405312000.0, odd = odd * square + 1 / 518918400.0, odd = odd * square + 1 / 3991680.0;
    odd = odd * square + 1 / 45360.0, odd = odd * square + 1 / 840.0, odd = odd * square + 1 / 30.0;
    odd = odd * square + 1 / 3.0;
    rest = 0.5 * pick(x < 0.8, x * square * odd, rest);
    derive(at, v, first), derive(at, first, second);
    for (int i = 0; i < 4; i++) second[i] -= v[i];
    derive(at, second, third);
    for (int i = 0; i < 4; i++) to[i] = cosh * v[i] + sinh * first[i] + half * second[i] + rest * third[i];
}
/* The state, times p, at the waves from i on, of which the layer is thin for all or for none. */
static inline void state_at(const Sums *s, const Point *at, int64_t i, int64_t count, int thin, V k, V *v) {
    int64_t thick = s->waves - s->thin, row = at->at_case * (thin ? s->thin : thick) + (thin ? i : i - s->thin);
    V X = k * at->h, x = k * at->z;
    if (s->kind == STATES) {
        for (int j = 0; j < 4; j++)
            v[j] = part_of(s->states + (j * s->points + at->point) * s->columns + i, count, 0);
    } else if (s->kind == BODY) {
        const double *base = s->base + at->at_case * s->waves + i;
        decays(x - X, at->nu, part_of(base, count, 0), part_of(base + s->size * s->waves, count, 0), v);
    } else if (thin) {
        V top[4], other[4];
        for (int j = 0; j < 4; j++) top[j] = part_of(s->surface + j * s->size * s->thin + row, count, 0);
        below(at, x, top, v);
        if (s->kind == LAYER) return;
        V p = part_of(s->p + at->at_case * s->waves + i, count, 0);
        decays(x, at->nu, s->S * p, s->T * p, other);
        for (int j = 0; j < 4; j++) v[j] -= other[j];
    } else {
        const double *down = s->down + row, *up = s->up + row;
        V rises[4];
        decays(x, at->nu, part_of(down, count, 0), part_of(down + s->size * thick, count, 0), v);
        decays(X - x, at->nu, part_of(up, count, 0), -part_of(up + s->size * thick, count, 0), rises);
        v[0] += rises[0], v[1] -= rises[1], v[2] += rises[2], v[3] -= rises[3];
    }
}
/* The pair (Q, v'), times p */
static inline void across_at(const Sums *s, const Point *at, int64_t i, int64_t count, V k, V *v) {
    if (s->kind == STATES) {
        for (int j = 4; j < OF_STATE; j++)
            v[j] = part_of(s->states + (j * s->points + at->point) * s->columns + i, count, 0);
        return;
    }
    V X = k * at->h, x = k * at->z, less, far = exponential(-2 * X, &less), around = at->passed * far - less;
    V p = part_of(s->p + at->at_case * s->waves + i, count, 0) / around, decay = vexp(-x);
    if (s->kind == BODY) {
        v[4] = p * (at->returned > -1 ? at->passed : 0.0) * decay, v[5] = -2 * v[4];
        return;
    }
    V up = p * at->returned * vexp(x - 2 * X), down = p * (s->kind == LAYER ? decay : at->returned * far * decay);
    v[4] = down - up, v[5] = -2 * (down + up);
}
/* The slowly varying parts of p^ J_m next to the edge, of waves that are far beyond x = 1 */
static inline void edges(const Sums *s, const Point *at, int64_t i, int64_t count, V k, int top, V *J) {
    const double *f = s->f + 2 * (at->at_case * s->waves + i);
    V x = k * at->r, y = 1 / x, square = y * y, real = all(0), imaginary = all(0), sine, cosine;
    for (int64_t l = 0; l < W && l < count; l++) real[l] = f[2 * l], imaginary[l] = f[2 * l + 1];
    angles(k * (1 - at->r), &sine, &cosine);
    V even = cosine - sine, odd = cosine + sine;                               /* times e^(i pi/4) */
    V scale = root(y * 0.07957747154594767) * part_of(s->windows + s->window[at->point] * s->columns + i, count, 0);
    V slow = scale * (real * even - imaginary * odd), turned = scale * (real * odd + imaginary * even);
    for (int m = 0; m < 2; m++) {
        const double *c = at->hankel[m];
        V H = ((c[6] * square + c[4]) * square + c[2]) * square + c[0];
        V G = (((c[7] * square + c[5]) * square + c[3]) * square + c[1]) * y;
        J[m] = m ? -(slow * G + turned * H) : slow * H - turned * G;
    }
    for (int m = 1; m < top; m++) J[m + 1] = 2 * m * y * J[m] - J[m - 1];
}
static inline void integrands(const Sums *s, const Point *at, const V *v, V *to) {
    V sum = (2 * at->nu * v[2] + (1 + at->nu) * v[0]) * at->normal;
    if (s->fields == 4) to[0] = sum, to[1] = -v[0], to[2] = v[2], to[3] = v[3];
    else to[0] = sum, to[1] = v[0] + v[5], to[2] = v[5] - v[0], to[3] = v[2], to[4] = v[3] + v[4], to[5] = v[3] - v[4];
}
static ALONE void add_waves(const Sums *s, const Point *at, int64_t from, int64_t to, int thin, V sums[][JET]) {
    int top = (int)s->most + 2;
    for (int64_t i = from; i < to; i += W) {
        int64_t count = to - i;
        V k = part_of(s->k + i, count, s->k[to - 1]), half = 0.5 * k, quarter = half * half;
        V v[3][OF_STATE], values[3][MOST_FIELDS], J[MOST_ORDER + 1], first[MOST_ORDER], second[MOST_ORDER];
        state_at(s, at, i, count, thin, k, v[0]);
        if (s->fields > 4) across_at(s, at, i, count, k, v[0]);
        for (int d = 0; d < 2; d++) {
            derive(at, v[d], v[d + 1]);
            for (int j = 0; j < 4; j++) v[d + 1][j] *= k;
            if (s->fields > 4) v[d + 1][4] = half * v[d][5], v[d + 1][5] = 2 * k * v[d][4];
        }
        for (int d = 0; d < 3; d++) integrands(s, at, v[d], values[d]);
        if (s->f) edges(s, at, i, count, k, top, J);
        else bessel(&at->series, k * at->r, top, J);
        for (int m = 0; m < top - 1; m++) {
            V other = m > 1 ? J[m - 2] : m ? -J[1] : J[2];
            first[m] = m ? (J[m - 1] - J[m + 1]) * half : -J[1] * k;
            second[m] = (other + J[m + 2] - 2 * J[m]) * quarter;
        }
        for (int j = 0; j < s->fields; j++) {
            int64_t m = s->orders[j];
            sums[j][0] += values[0][j] * J[m], sums[j][1] += values[0][j] * first[m];
            sums[j][2] += values[1][j] * J[m], sums[j][3] += values[0][j] * second[m];
            sums[j][4] += values[1][j] * first[m], sums[j][5] += values[2][j] * J[m];
        }
    }
}
static void sum_waves(const Sums *s) {
    Point at = {0};
    at.series = series_of((int)s->most + 2);
    for (int m = 0; m < 2; m++)
        for (int j = 0; j < OF_HANKEL; j++)                                    /* the signs are those of (-i)^j */
            at.hankel[m][j] = j ? at.hankel[m][j - 1] * (4 * m * m - (2 * j - 1) * (2 * j - 1)) / (8 * j) : 1.0;
    for (int m = 0; m < 2; m++) for (int j = 0; j < OF_HANKEL; j++) if (j % 4 == 1 || j % 4 == 2) at.hankel[m][j] *= -1;
    for (int64_t i = 0; i < s->points; i++) {
        V sums[MOST_FIELDS][JET] = {0};
        int layered = s->kind == DIFFERENCE || s->kind == LAYER;
        int64_t end = s->ends[i], thin = !layered ? 0 : s->thin < end ? s->thin : end;
        at.point = i, at.at_case = s->cases[i], at.r = s->r[i], at.z = s->z[i], at.nu = s->nu[i];
        at.normal = 1 / (1 - at.nu), at.h = s->h ? s->h[i] : 0;
        if (s->returned) at.returned = s->returned[i], at.passed = s->passed[i];
        add_waves(s, &at, 0, thin, 1, sums);
        add_waves(s, &at, thin, end, 0, sums);
        for (int d = 0; d < JET; d++)
            for (int j = 0; j < s->fields; j++) {
                double sum = 0;
                EACH(l) sum += sums[j][d][l];
                s->sums[(d * s->fields + j) * s->points + i] = sum;
            }
    }
}
