/* Newton's method on the meshes of the ladder: solver/rough of numpy, a case in each lane. */
#define EPS 2.220446049250313e-16
#define MOST_NODES 96
#define ROOM 128                                /* for the nodes, or the few k, and what `combine` writes behind them */
#define KINDS 512                               /* more than there are octaves, two classes, two interfaces */
#define WAVES 4096                              /* numbers k of a quadrature: MOST_WAVES of tables.py */
/* The equation on one mesh at a state: arrays over the nodes; Kq and its slope by ln a have the edge last. */
typedef struct {
    int64_t n;
    const double *s, *w, *half_space;
    const Rows *rows;
    V eta, a, X, Y, Z, load, y[ROOM], q[ROOM], g[ROOM], dq[ROOM], dg[ROOM], Kq[ROOM], slope[ROOM], F[ROOM];
} Equation;
/* Cases in the lanes, and room to compute them: `most` points, of which `room` has five times as many. */
typedef struct {
    const Batch *b;
    const Mesh *mesh;
    const Table *table, *tables[KINDS / 2];                                    /* of the group; of the mesh */
    int64_t index[W];
    int count, last;                                                           /* no step follows the last */
    Law law;
    Layer layer;
    V value, E, C, rtol, *points, *pressures, *room;
    V L1[ROOM], uL[ROOM], d_eta[ROOM], step[ROOM], missed[ROOM], y_start[ROOM], q_start[ROOM], g_start[ROOM];
    V K[ROOM * ROOM], A[ROOM * ROOM], weights[WAVES], slopes[WAVES], waves[WAVES];
    Equation on, fine;
} Group;
/* What each case has come to. Of `rung` -1 it has ended or is handed back; `stage` says what comes next on its mesh. */
typedef struct { double *y, eta, a, soft, residual, before, edge_q; int64_t rung; int32_t count, stage; } State;
enum { AT_STEPS, AT_GUESS, AT_FINISH };
#define OF_STATES(s, name) ({ V v_; EACH(l) v_[l] = (s)[c->index[l]].name; v_; })
static inline V of_cases(const double *values, const int64_t *index) {
    V v;
    EACH(l) v[l] = values[index[l]];
    return v;
}
static inline void load_cases(Group *c, const int64_t *index, int count) {
    const Batch *b = c->b;
    Layer *of = &c->layer;
    const double *from[] = {b->value, b->rtol, b->E, b->C, b->p_star, b->A_star, b->beta, b->ratio, b->n, b->m, b->h,
                            b->c1, b->c2, b->one_c1, b->one_c2, b->plus_c1, b->one_c1c2};
    V *to[] = {&c->value, &c->rtol, &c->E, &c->C, &c->law.p_star, &c->law.A_star, &c->law.beta, &c->law.ratio,
               &of->n, &of->m, &of->h, &of->c1, &of->c2, &of->one_c1, &of->one_c2, &of->plus_c1, &of->one_c1c2};
    c->count = count;
    EACH(l) c->index[l] = index[l < count ? l : count - 1];
    if (b->law == CELL) {
        EACH(l) c->law.cell[l] = b->cells[c->index[l]];
        for (int i = 0; i < NUMBERS; i++) c->law.of_cell[i] = of_lanes(c->law.cell, i);
    }
    of->bonded = b->layered && b->bonded[index[0]] != 0;
    of->stiff = b->layered && b->n[index[0]] > 2;
    for (int i = 0; i < (of->bonded ? 17 : b->layered ? 11 : 8); i++) *to[i] = of_cases(from[i], c->index);
}
static inline V softness(const Group *c, V a) {
    return c->b->layered ? whole(&c->layer, 1.5 * c->layer.h / a) : all(1.0);
}
/* For few cases the lanes hold neighbours of a table in place of cases: F has four. The order of each sum is that of
   many cases, and so are its bits. */
typedef double F __attribute__((vector_size(32), aligned(8)));
/* Sums (rows) of the columns (count) of a table, each times one x. The table has blocks of 8 rows, four together. */
ALONE static void combine(const Group *c, const double *t, int64_t count, int64_t rows, const V *x, V *out) {
    int64_t i = 0;
    for (; 4 * c->count <= W && i < rows; i += 32, t += 32 * count)
        for (int lane = 0; lane < c->count; lane++) {
            F s[8] = {{0}}, s0 = s[0], s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
            for (int64_t j = 0; j < count; j++) {
                const F *k = (const F *)(t + 8 * j), *l = k + 2 * count, *m = l + 2 * count, *n = m + 2 * count;
                double v = x[j][lane];
                s0 += k[0] * v; s1 += k[1] * v; s2 += l[0] * v; s3 += l[1] * v;
                s4 += m[0] * v; s5 += m[1] * v; s6 += n[0] * v; s7 += n[1] * v;
            }
            s[0] = s0; s[1] = s1; s[2] = s2; s[3] = s3; s[4] = s4; s[5] = s5; s[6] = s6; s[7] = s7;
            for (int64_t k = 0; k < 32; k++)
                EACH(l) if (l == lane || (l > lane && lane == c->count - 1)) out[i + k][l] = s[k / 4][k % 4];
        }
    for (; i < rows; i += 8) {
        V s0 = all(0), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
        for (int64_t j = 0; j < count; j++, t += 8) {
            V v = x[j];
            s0 += t[0] * v; s1 += t[1] * v; s2 += t[2] * v; s3 += t[3] * v;
            s4 += t[4] * v; s5 += t[5] * v; s6 += t[6] * v; s7 += t[7] * v;
        }
        out[i] = s0; out[i + 1] = s1; out[i + 2] = s2; out[i + 3] = s3;
        out[i + 4] = s4; out[i + 5] = s5; out[i + 6] = s6; out[i + 7] = s7;
    }
}
static inline V dot(const V *x, const V *y, int64_t n) {
    V sum = all(0);
    for (int64_t i = 0; i < n; i++) sum += x[i] * y[i];
    return sum;
}
static inline V against(const double *w, const V *x, int64_t n) {
    V sum = all(0);
    for (int64_t i = 0; i < n; i++) sum += w[i] * x[i];
    return sum;
}
/* L - 1 and its slope at the few nodes k. */
ALONE static void kernel_at(Group *c, V a) {
    V h_a = c->layer.h / a;
    for (int64_t i = 0; i < c->table->few; i++) c->L1[i] = decaying(&c->layer, c->table->k[i] * h_a, c->uL + i);
}
/* K, the row of the edge under it, and K q. */
static void form(Group *c, Equation *e) {
    int64_t n = e->n, size = n * (n + 1);
    V *K = c->K;
    if (c->b->layered && e->rows->product) combine(c, e->rows->product, c->table->few, size, c->L1, K);
    else if (c->b->layered) {
        int64_t G = c->table->all;
        combine(c, c->table->spread, c->table->few, G, c->L1, c->weights);
        for (int64_t i = 0; i <= n; i++) {                                    /* what is written behind a row is lost */
            for (int64_t g = 0; g < G; g++) c->room[g] = e->rows->J_rows[i * G + g] * c->weights[g];
            combine(c, e->rows->phi, G, n, c->room, K + i * n);
        }
    }
    for (int64_t i = 0; i < size; i++) K[i] = c->b->layered ? K[i] + e->half_space[i] : all(e->half_space[i]);
    for (int64_t i = 0; i <= n; i++) e->Kq[i] = dot(K + i * n, e->q, n);
}
/* The slope of K q by ln a; 0 on a half-space. */
static void slopes(Group *c, Equation *e) {
    int64_t n = e->n, G;
    for (int64_t i = 0; i <= n; i++) e->slope[i] = all(0);
    if (!c->b->layered) return;
    if (e->rows->product) {
        combine(c, e->rows->product, c->table->few, n * (n + 1), c->uL, c->A);
        for (int64_t i = 0; i <= n; i++) e->slope[i] = dot(c->A + i * n, e->q, n);
        return;
    }
    G = c->table->all;
    combine(c, c->table->spread, c->table->few, G, c->uL, c->slopes);
    combine(c, e->rows->phi_columns, n, G, e->q, c->room);
    for (int64_t g = 0; g < G; g++) c->room[g] *= c->slopes[g];
    combine(c, e->rows->J, G, n + 1, c->room, e->slope);
}
static ALONE void curves(const Group *c, Equation *e) {
    V a = e->a, a2 = a * a;
    e->X = 8 / PI * c->law.p_star / (a * c->E), e->Y = 2 * c->C * c->law.p_star / a2, e->Z = 2 * c->law.A_star / a2;
    for (int64_t i = 0; i < e->n; i++) {
        Curve v = curve_of(&c->law, e->y[i]);
        e->q[i] = v.q; e->g[i] = v.g; e->dq[i] = v.dq; e->dg[i] = v.dg;
    }
    e->load = against(e->w, e->q, e->n);
}
static ALONE void evaluate(Group *c, Equation *e) {
    int64_t n = e->n;
    curves(c, e);
    form(c, e);
    for (int64_t i = 0; i < n; i++) e->F[i] = e->X * e->Kq[i] + e->Y * e->q[i] + e->Z * e->g[i] - e->s[i] * e->s[i];
}
/* The residual of a control, ln of its quantity over its value; X and the displacement of the edge may be others. */
static inline V control_residual(const Group *c, const Equation *e) {
    if (c->b->control == RADIUS) return e->eta - vlog(c->value);
    if (c->b->control == LOAD) return vlog(2 * PI * c->law.p_star * e->load / c->value) + 2 * e->eta;
    return vlog((1 + e->X * e->Kq[e->n]) / (2 * c->value)) + 2 * e->eta;
}
/* The derivative of ln of a control along t, dq at the nodes, and by ln a. */
static inline V along(const Group *c, const Equation *e, int control, const V *t, V *by_eta) {
    int64_t n = e->n;
    *by_eta = all(control == RADIUS ? 1.0 : 2.0);
    if (control != DEPTH) return control == RADIUS ? all(0) : against(e->w, t, n) / e->load;
    V edge = e->X * e->Kq[n], depth = 1 + edge;
    *by_eta += (e->X * e->slope[n] - edge) / depth;
    return e->X * dot(c->K + n * n, t, n) / depth;
}
/* Elimination of A (n, n) for two right-hand sides, without exchange of rows; the lanes whose pivots are positive. */
static I eliminate(V *A, V *r, V *t, int64_t n) {
    I sound = all(1.0) == 1.0;
    for (int64_t k = 0; k < n; k++) {
        V *top = A + k * n, inverse = 1 / top[k];
        sound &= top[k] > 0;
        top[k] = inverse;
        for (int64_t i = k + 1; i < n; i++) {
            V *row = A + i * n, f = row[k] * inverse;
            for (int64_t j = k + 1; j < n; j++) row[j] -= f * top[j];
            r[i] -= f * r[k], t[i] -= f * t[k];
        }
    }
    for (int64_t k = n - 1; k >= 0; k--) {
        V x = r[k], z = t[k];
        for (int64_t j = k + 1; j < n; j++) x -= A[k * n + j] * r[j], z -= A[k * n + j] * t[j];
        r[k] = x * A[k * n + k], t[k] = z * A[k * n + k];
    }
    return sound;
}
/* One step: c->step has the new y less the old, c->d_eta dq/d eta; returns the change of eta, NaN where it failed. */
static ALONE V advance(Group *c, Equation *e) {
    int64_t n = e->n;
    V *t = c->step, *r = c->d_eta, inverse = 1 / e->X;
    slopes(c, e);
    for (int64_t i = 0; i < n; i++) {
        for (int64_t j = 0; j < n; j++) c->A[i * n + j] = c->K[i * n + j];
        c->A[i * n + i] += (e->Y + e->Z * (e->dg[i] / e->dq[i])) * inverse;
        r[i] = e->Kq[i] - e->slope[i] + 2 * (e->Y * e->q[i] + e->Z * e->g[i]) * inverse;
        t[i] = -e->F[i] * inverse;
    }
    I sound = eliminate(c->A, r, t, n);
    V by_eta, unused, of_t = along(c, e, c->b->control, t, &unused), of_r = along(c, e, c->b->control, r, &by_eta);
    V d_eta = clip(-(control_residual(c, e) + of_t) / (by_eta + of_r), all(-1.0), all(1.0));
    d_eta = pick(sound, d_eta, all(__builtin_nan("")));
    for (int64_t i = 0; i < n; i++) {
        V old = e->y[i], new = old + (t[i] + r[i] * d_eta) / e->dq[i];
        if (c->b->law != SMOOTH) new = clip(new, 0.2 * old, 5.0 * old);
        t[i] = new - old;
    }
    return d_eta;
}
/* The part that rounding and the operator itself have in an error. */
static inline V of_operator(const Group *c, V a, int64_t n) {
    V floor = all(4 * n * EPS);
    if (!c->b->layered) return floor;
    return most(floor, 1e-14 * n / least(whole(&c->layer, 4.0 * c->layer.h / a), all(1.0)));
}
/* Residual of the cases; the lanes that have closed; the lanes with a gap that is real. */
static ALONE I closed(const Group *c, const Equation *e, V *residual, I *apart) {
    V top = all(0), high = all(0), largest = all(0), sum = all(0);
    for (int64_t i = 0; i < e->n; i++) largest = most(e->q[i], largest);
    for (int64_t i = 0; i < e->n; i++) {
        I bare = (e->q[i] >= 0) & (e->q[i] < 1e-16 * largest);
        V gap = pick(bare, most(e->F[i] - e->Z * e->g[i], all(0)), all(0)), F = pick(gap > 0, all(0), size_of(e->F[i]));
        high = most(gap, high), top = most(F, top), sum += F;
    }
    V G = size_of(control_residual(c, e));
    *residual = pick(is_finite(sum + G), most(top, G), all(__builtin_nan("")));
    *apart = high > 1e-9;
    I done = *residual < 1e-13, near = ~done & (*residual < 1e-5);
    if (any(near)) done |= near & (*residual < most(1e-2 * of_operator(c, e->a, e->n), 20 * EPS / softness(c, e->a)));
    return done;
}
/* The unknown y at points between the nodes: interpolate of solver/rough/results.py. */
static ALONE void interpolate(Group *c, const Points *p, const double *J, double tolerance, V *y) {
    const Equation *e = &c->on;
    const Law *law = &c->law;
    int64_t n = e->n, m = p->m, next = (m + 31) / 32 * 32;
    V *kq = c->room, *at_layer = kq + next, *right = at_layer + next, *linear = right + next, *factor = linear + next;
    combine(c, p->half_space, n, m, e->q, kq);
    if (c->b->layered) {
        combine(c, J, c->table->all, m, c->waves, at_layer);
        for (int64_t i = 0; i < m; i++) kq[i] += at_layer[i];
    }
    combine(c, p->basis, n, m, e->q, c->pressures);
    combine(c, p->basis, n, m, c->missed, factor);
    for (int64_t i = 0; i < m; i++) {
        V drop = all(p->s[i] * p->s[i]), stiff = e->X * p->kappa[i], floor = 1e-3 * stiff * size_of(c->pressures[i]);
        linear[i] = stiff + e->Y;
        right[i] = most(drop - e->X * kq[i] + stiff * c->pressures[i], clip(floor, 1e-16 * drop, 1e-9 * drop));
        if (law->name == SMOOTH) y[i] = right[i] / linear[i];
        else y[i] = guess_of(law, 1 / (linear[i] / right[i] + 1 / sparse_of(law, right[i] / e->Z)))
                    * clip(factor[i], all(0.7), all(1.4));
    }
    I going = all(1.0) == 1.0;
    for (int k = 0; k < 40 && law->name != SMOOTH && any(going); k++) {
        I far = going ^ going;
        for (int64_t i = 0; i < m; i++) {
            V old = y[i];
            Curve v = curve_of(law, old);
            V f = linear[i] * v.q + e->Z * v.g - right[i];
            V new = clip(old - f / (linear[i] * v.dq + e->Z * v.dg), 0.2 * old, 5.0 * old), change = new - old;
            y[i] = pick(going, new, old);
            far |= change * change > tolerance * new * new;
        }
        going &= far;
    }
}
/* What `interpolate` needs beside the curves: c->missed, and of layers c->waves; the kernel is that at the radius. */
static ALONE void before_points(Group *c) {
    const Equation *e = &c->on;
    const Table *t = c->table;
    if (c->b->layered) {
        combine(c, t->spread, t->few, t->all, c->L1, c->weights);
        combine(c, t->own.phi_columns, e->n, t->all, e->q, c->waves);
        for (int64_t g = 0; g < t->all; g++) c->waves[g] *= c->weights[g];
    }
    for (int64_t i = 0; i < e->n; i++) {
        V linear = e->X * c->mesh->kappa[i] + e->Y, right = linear * e->q[i] + e->Z * e->g[i];
        c->missed[i] = all(1.0);
        if (c->b->law == SMOOTH) continue;
        V ratio = e->y[i] / guess_of(&c->law, 1 / (linear / right + 1 / sparse_of(&c->law, right / e->Z)));
        c->missed[i] = pick(ratio == ratio, clip(ratio, all(0.5), all(2.0)), all(1.0));
    }
}
