/* The largest values in boxes of functions of stresses that are quadratic there: as _highest of
   solver/yields/search/climb.py, its reference. The points of one box are in the lanes. */
enum { MISES, TRESCA, S1, SR, TAU, TENSION, COMPRESSION };
enum { ACROSS = 9, ROUNDS = 20, PADDED = ACROSS * ACROSS + 7 };                /* so that W divides it */
#define NARROWEST 3e-6
typedef struct { int64_t function; double centre[2], stresses[6][4]; } Model;
static inline V function_of(int64_t function, V sr, V st, V sz, V trz) {
    if (function == SR) return sr;
    if (function == TAU) return size_of(trz);
    if (function == TENSION || function == COMPRESSION) return function == TENSION ? sz : -sz;
    if (function == MISES) {
        V a = sr - st, b = st - sz, c = sz - sr;
        return root(0.5 * (a * a + b * b + c * c) + 3 * trz * trz);
    }
    V middle = 0.5 * (sr + sz), half = 0.5 * pick(sr == sz, all(0), sr - sz), radius = root(half * half + trz * trz);
    V low = middle - radius, high = middle + radius, first = pick(st > high, st, high);
    return function == S1 ? first : first - pick(st < low, st, low);
}
static void at_points(const Model *model, const double *u, const double *v, int count, double *values) {
    for (int i = 0; i < count; i += W) {
        V du, dv, s[4];
        memcpy(&du, u + i, sizeof du), memcpy(&dv, v + i, sizeof dv);
        du -= model->centre[0], dv -= model->centre[1];
        for (int j = 0; j < 4; j++) {
            double f = model->stresses[0][j], by_u = model->stresses[1][j], by_v = model->stresses[2][j];
            double uu = model->stresses[3][j] / 2, uv = model->stresses[4][j], vv = model->stresses[5][j] / 2;
            s[j] = f + du * (by_u + uu * du) + dv * (by_v + uv * du + vv * dv);
        }
        V value = function_of(model->function, s[0], s[1], s[2], s[3]);
        memcpy(values + i, &value, sizeof value);
    }
}
/* A grid about `middle` of `points` in each direction, or along u alone: its values, and the place of the largest. */
static int on_grid(const Model *model, const double *middle, const double *width, int points, int flat, double *u,
                   double *v, double *values) {
    int count = 0, best = 0;
    for (int j = 0; j < (flat ? 1 : points); j++)
        for (int i = 0; i < points; i++, count++) {
            u[count] = middle[0] + width[0] * (2.0 * i / (points - 1) - 1);
            v[count] = middle[1] + (flat ? 0 : width[1] * (2.0 * j / (points - 1) - 1));
        }
    for (int i = count; i < PADDED && i % W; i++) u[i] = u[0], v[i] = v[0];
    at_points(model, u, v, count, values);
    for (int i = 1; i < count; i++)                                            /* the first NaN is the largest */
        if (values[i] > values[best] || (values[i] != values[i] && values[best] == values[best])) best = i;
    return best;
}
static inline double within(double x, double low, double high) { return x < low ? low : x > high ? high : x; }
static inline double cut(double step) { return step != step ? 0 : within(step, -1, 1); }
static void top_of(const double *f, int flat, double *step) { /* of the parabola through 3 or 3 x 3 values */
    const double *row = flat ? f : f + 3;
    double a = (row[2] - row[0]) / 2, aa = row[2] - 2 * row[1] + row[0], b = 0, bb = 0, ab = 0;
    if (!flat) b = (f[7] - f[1]) / 2, bb = f[7] - 2 * f[4] + f[1], ab = (f[8] - f[2] - f[6] + f[0]) / 4;
    double determinant = aa * bb - ab * ab;
    int curved = determinant > 0 && aa < 0, line = b == 0 && bb == 0 && aa < 0;
    step[0] = curved ? cut((ab * b - bb * a) / determinant) : line ? cut(-a / aa) : 0;
    step[1] = curved ? cut((ab * a - aa * b) / determinant) : 0;
}
static void highest(const Model *model, const double *low, const double *high, double *place, double *value) {
    double u[PADDED], v[PADDED], values[PADDED], width[2], middle[2], share = 2.0 / (ACROSS - 1);
    int flat = low[1] == high[1];
    for (int i = 0; i < 2; i++) width[i] = (high[i] - low[i]) / 2, middle[i] = (low[i] + high[i]) / 2;
    int best = on_grid(model, middle, width, ACROSS, flat, u, v, values);
    place[0] = u[best], place[1] = v[best], *value = values[best];
    for (int round = 0; round < ROUNDS && share > NARROWEST; round++) {
        double steps[2], step[2], top[2][W], of_top[W];
        for (int i = 0; i < 2; i++) {
            steps[i] = width[i] * share;
            middle[i] = within(place[i], low[i] + steps[i], high[i] - steps[i]);
        }
        best = on_grid(model, middle, steps, 3, flat, u, v, values);
        top_of(values, flat, step);
        for (int i = 0; i < 2; i++) EACH(l) top[i][l] = within(middle[i] + steps[i] * step[i], low[i], high[i]);
        at_points(model, top[0], top[1], 1, of_top);
        share *= of_top[0] >= values[best] && of_top[0] >= *value ? 1 / 16.0 : 0.5;
        if (values[best] > *value) *value = values[best], place[0] = u[best], place[1] = v[best];
        if (of_top[0] > *value) *value = of_top[0], place[0] = top[0][0], place[1] = top[1][0];
    }
}
static void highest_in_boxes(const Boxes *s) {
    for (int64_t i = 0; i < s->tasks; i++) {
        Model model = {.function = s->functions[i], .centre = {s->centre[2 * i], s->centre[2 * i + 1]}};
        for (int d = 0; d < 6; d++)
            for (int j = 0; j < 4; j++) model.stresses[d][j] = s->models[(4 * d + j) * s->tasks + i];
        highest(&model, s->low + 2 * i, s->high + 2 * i, s->places + 2 * i, s->values + i);
    }
}
