/* Loads of contacts that stick, and of those that do not, at depths: as study/inverse/fits/tables/branch.py, its
   reference, which says what is computed. The points of one curve are in the lanes. */
#define RAMP 0.25
#define LEAST_RAMP 0.01
#define STEEP 0.02
enum { TO_A_DEPTH = 5, TO_A_TURN = 12 };    /* steps of the searches */
typedef struct { V a, b, c, d; } Cubic;     /* a + b t + c t² + d t³ in a cell, 0 <= t <= 1 */
typedef struct { V value, slope, more, less; } Pair;         /* exp of one cubic less exp of another, and both */
static inline Cubic cubic(const Sticking *s, const double *row, int part, I cell) {
    const double *values = row + part * s->length, *slopes = row + (4 + part) * s->length;
    V a, b, p, q;
    EACH(l) a[l] = values[cell[l]], b[l] = values[cell[l] + 1];
    EACH(l) p[l] = s->step * slopes[cell[l]], q[l] = s->step * slopes[cell[l] + 1];
    return (Cubic){a, p, 3 * (b - a) - 2 * p - q, 2 * (a - b) + p + q};
}
static inline V of_cubic(const Cubic *c, V t) { return c->a + t * (c->b + t * (c->c + t * c->d)); }
static inline V growth(const Sticking *s, const Cubic *c, V t) {
    return (c->b + t * (2 * c->c + 3 * t * c->d)) / s->step;
}
static inline Pair difference(const Sticking *s, const Cubic *c, V t) {
    V more = vexp(of_cubic(c, t)), less = vexp(of_cubic(c + 1, t));
    return (Pair){more - less, more * growth(s, c, t) - less * growth(s, c + 1, t), more, less};
}
static inline I counted(const double *rising, int64_t length, V x, int64_t low) { /* the cell in which x lies */
    I count = (I){0} - 1, last = (I){0} + (length - 2), first = (I){0} + low;
    for (int64_t j = 0; j < length; j++) count -= all(rising[j]) <= x;
    I above = count > last;
    count = (above & last) | (~above & count);
    I below = count < first;
    return (below & first) | (~below & count);
}
/* t at which the depth has its minimum, by false position in which half the value of the end that stays counts. */
static V turn_of(const Sticking *s, const Cubic *c) {
    V low = all(0), high = all(1), t = high, s_low = difference(s, c, low).slope, s_high = difference(s, c, high).slope;
    for (int i = 0; i < TO_A_TURN; i++) {
        t = clip(low + (high - low) * s_low / (s_low - s_high), low, high);
        V slope = difference(s, c, t).slope;
        I falls = slope < 0;
        s_low = pick(falls, slope, s_low / 2), s_high = pick(falls, s_high / 2, slope);
        low = pick(falls, t, low), high = pick(falls, high, t);
    }
    return t;
}
static inline int64_t last_turn(const double *slope, int64_t length, int64_t none) {
    for (int64_t j = length - 2; j >= 0; j--) if (slope[j] < 0 && slope[j + 1] >= 0) return j;
    return none;
}
static inline void put(double *out, int64_t place, V x, int count) {
    for (int l = 0; l < count; l++) out[place + l] = x[l];
}
static void put_loads(const Sticking *s, const Loads *out, int64_t curve, int64_t point, int count, I cell, V t, V P,
                      V slope, const V *of_parts, int parts) {
    int64_t place = curve * s->points + point, all_points = s->curves * s->points;
    put(out->P, place, P, count), put(out->slope, place, slope, count);
    for (int i = 0; i < 4; i++) put(out->by_parts, i * all_points + place, i < parts ? of_parts[i] : 0 * P, count);
    for (int64_t k = 0; k < s->others; k++) {
        const double *row = s->rows + ((k + 1) * s->curves + curve) * 8 * s->length;
        V sum = all(0);
        for (int i = 0; i < parts; i++) {
            Cubic c = cubic(s, row, i, cell);
            sum += of_cubic(&c, t) * of_parts[i];
        }
        put(out->by_rows, k * all_points + place, sum, count);
    }
}
static void free_loads(const Sticking *s, const double *row, int64_t curve, int64_t point, int count, V depth) {
    I presses = depth > 0;
    V wanted = vlog(most(depth, all(0))), t = all(0.5);
    I cell = any(presses) ? counted(row + s->length, s->length, wanted, 0) : (I){0};
    Cubic of_load = cubic(s, row, 0, cell), of_depth = cubic(s, row, 1, cell);
    for (int i = 0; any(presses) && i < TO_A_DEPTH; i++) {
        V step = (of_cubic(&of_depth, t) - wanted) / (growth(s, &of_depth, t) * s->step);
        t = clip(t - pick(is_finite(step), step, all(0)), all(0), all(1));
    }
    V P = pick(presses, vexp(of_cubic(&of_load, t)), all(0)), by = growth(s, &of_load, t) / growth(s, &of_depth, t);
    V slope = pick(presses, P * by / pick(presses, depth, all(1)), all(0)), of_parts[2] = {P, -by * P};
    put_loads(s, &s->free, curve, point, count, cell, t, P, slope, of_parts, 2);
}
typedef struct { int64_t turn; double t, D, P, ramp; } End;        /* of the branch of a curve */
static void sticking_loads(const Sticking *s, const double *row, const double *rising, const End *end, int64_t curve,
                           int64_t point, int count, V depth) {
    I cell = counted(rising, s->length, depth, end->turn), beyond = depth < end->D, at_turn = cell == end->turn;
    Cubic of_load[2] = {cubic(s, row, 0, cell), cubic(s, row, 2, cell)};
    Cubic of_depth[2] = {cubic(s, row, 1, cell), cubic(s, row, 3, cell)};
    V first = pick(at_turn, all(end->t), all(0)), one = all(1);
    V low = difference(s, of_depth, first).value, high = difference(s, of_depth, one).value;
    V share = clip((depth - low) / (high - low), all(0), one);
    V t = first + (1 - first) * pick(first > 0, root(share), share);
    for (int i = 0; i < TO_A_DEPTH; i++) {
        Pair now = difference(s, of_depth, t);
        V step = (now.value - depth) / (most(now.slope, all(1e-300)) * s->step);
        t = clip(t - pick(is_finite(step), step, all(0)), first, one);
    }
    t = pick(beyond, first, t);
    Pair D = difference(s, of_depth, t), P = difference(s, of_load, t);
    V part = clip(1 - (end->D - depth) / end->ramp, all(0), one);
    V slope = P.slope / most(D.slope, STEEP * D.less + 1e-300);
    slope = pick(beyond, pick(part > 0, all(end->P / end->ramp), all(0)), slope), part = pick(beyond, part, one);
    V of_parts[4] = {part * P.more, -slope * D.more, -part * P.less, slope * D.less};
    V load = pick(is_finite(D.value), part * P.value, all(__builtin_nan("")));
    put_loads(s, &s->sticks, curve, point, count, cell, t, load, slope, of_parts, 4);
}
static void of_curve(const Sticking *s, int64_t curve) {
    double f[4][MOST_LENGTH], rising[MOST_LENGTH], of_depth[MOST_LENGTH], of_load[MOST_LENGTH];
    double deepest = -__builtin_inf();
    const double *row = s->rows + curve * 8 * s->length, *depth = s->depth + curve * s->points;
    int64_t L = s->length;
    for (int i = 0; i < 4; i++)
        for (int64_t j = 0; j < L; j += W) {
            int count = (int)(L - j < W ? L - j : W);
            V x = all(0);
            for (int l = 0; l < count; l++) x[l] = row[i * L + j + l];
            put(f[i], j, vexp(x), count);
        }
    for (int64_t j = 0; j < L; j++) {
        of_depth[j] = f[1][j] * row[5 * L + j] - f[3][j] * row[7 * L + j];
        of_load[j] = f[0][j] * row[4 * L + j] - f[2][j] * row[6 * L + j];
    }
    int64_t turn = last_turn(of_depth, L, -1), least = last_turn(of_load, L, -1);
    End end = {.turn = turn < 0 ? 0 : turn};
    I cell = (I){0} + end.turn;
    Cubic loads[2] = {cubic(s, row, 0, cell), cubic(s, row, 2, cell)};
    Cubic depths[2] = {cubic(s, row, 1, cell), cubic(s, row, 3, cell)};
    V t = turn < 0 ? all(0) : turn_of(s, depths);
    Pair D = difference(s, depths, t), P = difference(s, loads, t);
    end.t = t[0], end.D = D.value[0], end.P = P.value[0];
    for (int64_t j = 0; j < s->points; j++) deepest = depth[j] > deepest ? depth[j] : deepest;
    end.ramp = __builtin_fmax(RAMP * D.less[0], LEAST_RAMP * __builtin_fmax(__builtin_fabs(end.D), deepest));
    s->D_off[curve] = s->D_least[curve] = end.D;
    if (least >= 0) {
        I there = (I){0} + least;
        Cubic c[2] = {cubic(s, row, 1, there), cubic(s, row, 3, there)};
        double D_least = difference(s, c, all(of_load[least] / (of_load[least] - of_load[least + 1]))).value[0];
        if (!(D_least <= end.D)) s->D_least[curve] = D_least;
    }
    for (int64_t j = 0; j < L; j++) {
        double D_j = f[1][j] - f[3][j];
        rising[j] = j <= end.turn ? -__builtin_inf() : D_j == D_j ? D_j : __builtin_inf();
    }
    for (int64_t j = 0; j < s->points; j += W) {
        int count = (int)(s->points - j < W ? s->points - j : W);
        V x = all(depth[j]);
        for (int l = 0; l < count; l++) x[l] = depth[j + l];
        sticking_loads(s, row, rising, &end, curve, j, count, x);
        free_loads(s, row, curve, j, count, x);
    }
}
