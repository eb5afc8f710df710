/* Micro laws and the two kernels of a layer, a case in each lane: solver/laws, solver/kernels/closed_form.py. */
typedef struct { V q, g, dq, dg; } Curve;
typedef struct { int name; const double *cell[W]; V p_star, A_star, beta, ratio, of_cell[NUMBERS]; } Law;
#define PI 3.14159265358979323846
static inline V spot_curve(V y, V *dq, V *g, V *dg) {                          /* (6), (7); returns q */
    V sin2 = 1 / (1 + y * y), sine = root(sin2), cosine = y * sine, theta = angle(y);
    V cos2 = cosine * cosine, sc = sine * cosine, inverse = 1 / (theta + sc), slope = cos2 * inverse;
    V q = slope * cosine;
    *dq = sin2 * slope * (3 * sine + 2 * q);
    if (!g) return q;
    V z = 4 * theta * theta;
    V series = theta * z / 6 * (1 - z / 20 * (1 - z / 42 * (1 - z / 72 * (1 - z / 110 * (1 - z / 156)))));
    V rest = pick(theta < 0.3, series, theta - sc);                            /* theta - sin cos */
    V d_q_sin = slope * inverse * ((cos2 - 3 * sin2) * rest - 6 * sin2 * sc);
    *g = cos2 - (4.0 / 3) * q * sine;
    *dg = sin2 * (2 * sc + (4.0 / 3) * d_q_sin);
    return q;
}
static inline V spot_guess(V q) {
    V m = least(2.0 / 3 * q, all(1e100)), kappa = least(PI / 4 * q, all(1e200)), m2 = m * m, m3 = m2 * m;
    V t = cube_root(m3 + kappa + root(kappa) * root(2 * m3 + kappa));
    return most(m + t + m2 / most(t, all(1e-300)), 2 * q);
}
static inline V spot_from_pressure(V q) {
    V y = spot_guess(q), slope;
    for (int i = 0; i < 3; i++) {
        V now = spot_curve(y, &slope, 0, 0);
        y = y * vexp(vlog(q / now) * now / (slope * y));
    }
    return y;
}
/* The piece of a family at x >= 0, and t from -1 to 1 on it; returns dt/dx. */
static inline V piece(V x, V kappa, V top, I *index, V *t) {
    V z = most(least(1 + kappa * x, top), all(1.0));                           /* 1 to top, of no number too */
    U bits = (U)z;
    *index = (I)(bits >> 47) - 1023 * PIECES;
    *t = 2 * ((V)(((bits << 5) & 0x000fffffffffffffull) | 0x3ff0000000000000ull) - 1) - 1;
    return 2 * PIECES * kappa * (V)((2046 - (bits >> 52)) << 52);
}
static inline V of_lanes(const double *const *at, int i) {
    V v;
    EACH(l) v[l] = at[l][i];
    return v;
}
/* The polynomial of `rows` coefficients at t, and its slope by t; each lane has its own coefficients. */
static inline V polynomial(const double *const *at, int rows, V t, V *slope) {
    V value = all(0), d = all(0);
    for (int i = rows - 1; i >= 0; i--) d = d * t + value, value = value * t + of_lanes(at, i);
    *slope = d;
    return value;
}
/* exp of P, G or Q at y: of the series `which`, and its derivative by ln y; beyond the end a power of y. */
static inline V of_cell(const Law *law, const double *const *at, int which, V y, V t, V dt, V *by_log) {
    V slope, value = polynomial(at, ROW, t, &slope), end = law->of_cell[end_];
    I far = y > end;
    *by_log = slope * dt * y;
    if (any(far)) {
        V s = law->of_cell[slope_P_ + which], c = law->of_cell[settles_], bend = law->of_cell[bend_P_ + which] / c;
        V beyond = vlog(most(y / end, all(1.0))), less, turned;
        exponential(-c * beyond, &less);
        turned = -less * bend;
        value = pick(far, value * vexp((s + bend) * beyond - turned / c), value);
        *by_log = pick(far, (s + turned) * value, *by_log);
    }
    return value;
}
static ALONE Curve cell_curve(const Law *law, V y) {                           /* solver/laws/cell/cell_law.py */
    const double *at[W];
    I index;
    V t, by_P, by_G, dt = piece(y, law->of_cell[kappa_], law->of_cell[top_], &index, &t);
    EACH(l) at[l] = law->cell[l] + NUMBERS + 2 * ROW * index[l];
    V P = of_cell(law, at, 0, y, t, dt, &by_P);
    EACH(l) at[l] += ROW;
    V G = of_cell(law, at, 1, y, t, dt, &by_G), slope = 2 / PI * y * y;
    return (Curve){slope * y * P, y * y * G, slope * (3 * P + by_P), y * (2 * G + by_G)};
}
static ALONE V cell_guess(const Law *law, V q) {
    const double *at[W];
    I index;
    V r = cube_root(PI / 2 * q), t, unused, end = law->of_cell[end_r_];
    piece(r, law->of_cell[kappa_r_], law->of_cell[top_r_], &index, &t);
    EACH(l) at[l] = law->cell[l] + (int64_t)law->of_cell[at_r_][l] + ROW / 2 * index[l];
    V y = r * polynomial(at, ROW / 2, t, &unused);
    I far = r > end;
    return any(far) ? pick(far, y * power(most(r / end, all(1.0)), law->of_cell[slope_r_]), y) : y;
}
static ALONE V cell_peak(const Law *law, V y) {
    const double *at[W];
    I index;
    V t, unused, dt = piece(y, law->of_cell[kappa_], law->of_cell[top_], &index, &t);
    EACH(l) at[l] = law->cell[l] + (int64_t)law->of_cell[at_Q_][l] + ROW * index[l];
    return 3 / PI * y * of_cell(law, at, 2, y, t, dt, &unused);
}
static inline Curve curve_of(const Law *law, V y) {
    Curve c;
    if (law->name == CELL) return cell_curve(law, y);
    if (law->name == SMOOTH) return (Curve){y, all(0.0), all(1.0), all(0.0)};
    if (law->name == POWER_LAW) {
        V inverse = 2 / law->beta, q = power(y, inverse);
        return (Curve){q + 1e-295 * y, y * y, inverse * q / y + 1e-295, 2 * y};
    }
    c.q = spot_curve(y, &c.dq, &c.g, &c.dg);
    return c;
}
static inline V guess_of(const Law *law, V q) {
    if (law->name == DISC_CELL) return spot_guess(q);
    if (law->name == CELL) return cell_guess(law, q);
    return law->name == POWER_LAW ? power(most(q, all(1e-295)), law->beta / 2) : q;
}
static inline V sparse_of(const Law *law, V g) {                               /* q of small pressures */
    if (law->name == POWER_LAW) return power(g, 1 / law->beta);
    V t = g / 1.351283845031745;                                              /* (pi/2)^(2/3) */
    return law->name == SMOOTH ? g : t * root(t);
}
static inline V area_of(const Law *law, V y, V q) {                            /* (11) */
    if (law->name == SMOOTH) return all(1.0);
    if (law->name == CELL) return least(y * y, all(1.0));
    if (law->name == POWER_LAW) y = spot_from_pressure(law->ratio * q);
    return 1 / (1 + 1 / (y * y));
}
static inline V peak_of(const Law *law, V y, V q) {                            /* (13) over p* */
    if (law->name == SMOOTH) return q;
    if (law->name == CELL) return cell_peak(law, y);
    V spot = law->ratio * pick(q < 1e-270, all(__builtin_nan("")), q);         /* the ratio is 1 but of power laws */
    if (law->name == POWER_LAW) y = spot_from_pressure(spot);
    return (3 / PI / root(1 + 1 / (y * y)) + 2 / PI * spot * (PI / 2 - angle(y))) / law->ratio;
}
/* c1 to one_c1c2: the constants of a bond, bond_constants of closed_form.py; not used without one. */
typedef struct { int bonded, stiff; V n, m, h, c1, c2, one_c1, one_c2, plus_c1, one_c1c2; } Layer;
static inline V nested(V z, const double *inverse) {
    V total = all(1.0);
    for (int i = 7; i >= 0; i--) total = 1 + z * inverse[i] * total;
    return total;
}
/* The gap (1 - e)^2 - 4 u^2 e and the excess e (sinh 2u - 2u), by their series where u is small. */
static inline V gap_and_excess(V u, V e, V rest, V *excess) {
    static const double of_gap[] = {1 / 30., 1 / 56., 1 / 90., 1 / 132., 1 / 182., 1 / 240., 1 / 306., 1 / 380.};
    static const double of_excess[] = {1 / 20., 1 / 42., 1 / 72., 1 / 110., 1 / 156., 1 / 210., 1 / 272., 1 / 342.};
    V ue = u * e, gap = rest * rest - 4 * u * ue;
    I small = u < 0.8;
    *excess = rest * (1 + e) / 2 - 2 * ue;
    if (any(small)) {
        V z = 4 * u * u;
        gap = pick(small, e * (z * z / 12 * nested(z, of_gap)), gap);
        *excess = pick(small, e * u * z / 3 * nested(z, of_excess), *excess);
    }
    return gap;
}
static inline V bonded_below(const Layer *b, V u, V e, V rest, V *excess, V *slope) {
    V c1 = b->c1, c2 = b->c2, gap = gap_and_excess(u, e, rest, excess);
    I hard = c2 > 0;
    V one_c1e = pick(c1 > 0, b->one_c1 + c1 * rest, 1 - c1 * e);
    V soft = one_c1e * (1 - c2 * e) - 4 * c2 * u * u * e;
    V d_soft = e * (2 * (c1 + c2 + 4 * c2 * u * u) - 8 * c2 * u - 4 * c1 * c2 * e);
    V stiff = b->one_c1 * b->one_c2 + b->one_c1 * c2 * (rest - 4 * u * u * e) + c1 * b->one_c2 * rest + c1 * c2 * gap;
    V d_stiff = 2 * e * (b->one_c1 * c2 * (1 - 4 * u + 4 * u * u) + c1 * b->one_c2) + c1 * c2 * (4 * *excess - 2 * gap);
    *slope = pick(hard, d_stiff, d_soft);
    return pick(hard, stiff, soft);
}
/* L - 1 and -u dL/du of layer and punch together, at u > 0. */
ALONE static V decaying(const Layer *b, V u, V *falling) {
    V less, e = exponential(-2 * u, &less), rest = -less, L1, uL;
    if (b->bonded) {
        V excess, d_below, c1 = b->c1, c2 = b->c2, below = bonded_below(b, u, e, rest, &excess, &d_below);
        V above = e * (4 * c2 * u * (1 + u) + (b->n - 1) * b->one_c1 * b->one_c2 + 2 * c1 * c2 * rest);
        V d_above = e * (4 * c2 * (1 + 2 * u) + 4 * c1 * c2 * e) - 2 * above;
        L1 = above / below;
        uL = u * (d_above - L1 * d_below) / below;
    } else {
        V e4 = 4 * e, ue4 = u * e4, wedge = rest * (1 + e) + ue4, gap = rest * rest - u * ue4, excess = wedge - 2 * ue4;
        if (b->stiff) {
            gap = gap_and_excess(u, e, rest, &excess);
            excess = 2 * excess;
        }
        V inverse = 1 / (wedge + b->n * gap), nu = b->n * u, more = b->n - 1, share = e4 * inverse;
        V d_below = e4 * (1 + e) - 2 * ue4 + 2 * b->n * (excess - gap);
        L1 = share * (more * (rest / 2 + u) + nu * u);
        uL = u * (share * (more * (1 + e) + 2 * nu) - L1 * (2 + d_below * inverse));
    }
    *falling = -uL / (1 + b->m);
    return L1 / (1 + b->m);
}
/* The kernel itself, of layer and punch together. */
static inline V whole(const Layer *b, V u) {
    V less, e = exponential(-2 * u, &less), rest = -less, L;
    if (b->bonded) {
        V excess, slope, below = bonded_below(b, u, e, rest, &excess, &slope);
        L = (b->one_c1c2 + 2 * b->c1 * b->c2 * excess + 4 * u * b->c2 * b->plus_c1 * e) / below;
    } else {
        V excess, wedge = rest * (1 + e) + 4 * u * e, gap = gap_and_excess(u, e, rest, &excess);
        if (!b->stiff) gap = rest * rest - 4 * u * u * e;
        L = (rest * rest + b->n * wedge) / (wedge + b->n * gap);
    }
    return (L + b->m) / (1 + b->m);
}
