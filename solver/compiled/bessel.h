/* Sine and cosine, and the Bessel functions J_0 to J_7 of x >= 0, to about 1e-15. The tables are those of
   tools/make_bessel.py; the highest powers are first. */
static const double NEAR[17][2] = {
    {4.0030437640628113e-13, 1.2093613396338289e-14}, {-1.2433011305498057e-11, -4.004572738786147e-13},
    {3.363450456866669e-10, 1.1610597914042965e-11}, {-7.915323084479192e-09, -2.943013798390916e-10},
    {1.5956109057781304e-07, 6.431268785753088e-09}, {-2.7177492236298073e-06, -1.1967081867872172e-07},
    {3.8473197856340086e-05, 1.8684525372057272e-06}, {-0.000443545922431152, -2.4045748659686983e-05},
    {0.004058078989140805, 0.00024949458139090494}, {-0.028472718610882044, -0.0020290394945705996},
    {0.14598884856759267, 0.012456814392255438}, {-0.5074680458471, -0.05474581821284722},
    {1.0383794611437211, 0.15858376432721938}, {-0.8080888076696872, -0.2595948652859303},
    {-0.6484692830871837, 0.15151665143806634}, {0.9303012472958572, 0.08105866038589796},
    {0.04582966485981377, -0.05814382795599107},
};
static const double FAR[12][4] = {
    {-2.0391504603291065e-10, 1.9611107072011976e-10, 2.1732281186744534e-10, -2.0847373494450512e-10},
    {1.4750393967466458e-09, -1.3980983130749886e-09, -1.5735706702738963e-09, 1.487484957986028e-09},
    {-5.095567444423025e-09, 4.716861679104599e-09, 5.444932988370198e-09, -5.0254196725244136e-09},
    {1.1738404575384732e-08, -1.0435629789967938e-08, -1.2580302532198723e-08, 1.1145494643485827e-08},
    {-2.220099170349574e-08, 1.8400068951657234e-08, 2.3923017346240325e-08, -1.9739382005297028e-08},
    {4.2546291790572966e-08, -3.142366876079038e-08, -4.6292540376970764e-08, 3.39793578734192e-08},
    {-1.020564570797483e-07, 6.375387204287001e-08, 1.1281774072269541e-07, -6.984201010520019e-08},
    {3.619758767812361e-07, -1.8158032712012744e-07, -4.102441117732622e-07, 2.0294684457276046e-07},
    {-2.1839132224663715e-06, 8.238379757156372e-07, 2.5809891297171923e-06, -9.50582922063157e-07},
    {2.738088336416646e-05, -6.9307858402402855e-06, -3.5203992971025806e-05, 8.47096052798641e-06},
    {-0.0010986328124932216, 0.0001430511474538575, 0.0018310546874928113, -0.0002002716064378206},
    {1.0, -0.015624999999999976, 1.0, 0.04687499999999997},
};
enum { OF_NEAR = sizeof NEAR / sizeof *NEAR, OF_FAR = sizeof FAR / sizeof *FAR, MOST_ORDER = 7, OF_SERIES = 11 };
/* x - n pi/2 with |x| below 1e6; pi/2 in three parts, fdlibm's, like the polynomials */
static inline void angles(V x, V *sine, V *cosine) {
    const double magic = 6755399441055744.0;                                   /* 1.5 2^52 */
    V t = x * 0.6366197723675814 + magic, n = t - magic;
    V r = ((x - n * 1.57079632673412561417) - n * 6.07710050630396597660e-11) - n * 2.02226624879595063154e-21;
    V z = r * r, s = all(1.58969099521155010221e-10), c = all(-1.13596475577881948265e-11);
    s = s * z - 2.50507602534068634195e-08, c = c * z + 2.08757232129817482790e-09;
    s = s * z + 2.75573137070700676789e-06, c = c * z - 2.75573143513906633035e-07;
    s = s * z - 1.98412698298579493134e-04, c = c * z + 2.48015872894767294178e-05;
    s = s * z + 8.33333333332248946124e-03, c = c * z - 1.38888888888741095749e-03;
    s = s * z - 1.66666666666666324348e-01, c = c * z + 4.16666666666666019037e-02;
    s = r + r * z * s, c = 1 - (0.5 * z - z * z * c);
    I quarter = (I)t, odd = -(quarter & 1);
    *sine = (V)((I)pick(odd, c, s) ^ ((quarter & 2) << 62));
    *cosine = (V)((I)pick(odd, s, c) ^ (((quarter + 1) & 2) << 62));
}
/* Coefficients of J_m(x) (2/x)^m in (x/2)^2, for the orders `top` and top - 1. */
typedef struct { double c[OF_SERIES][2]; } Series;
static Series series_of(int top) {
    Series series;
    for (int i = 0; i < 2; i++) {
        double term = 1;
        for (int j = 2; j <= top - i; j++) term /= j;
        for (int j = 0; j < OF_SERIES; term /= -(j + 1) * (j + 1 + top - i), j++)
            series.c[OF_SERIES - 1 - j][i] = term;
    }
    return series;
}
static inline void near_orders(const Series *series, V x, int top, V *J) { /* x <= 2; from the highest order down */
    V half = 0.5 * x, q = half * half, more = all(0), last = all(0);
    for (int j = 0; j < OF_SERIES; j++) more = more * q + series->c[j][0], last = last * q + series->c[j][1];
    J[0] = all(1);
    for (int m = 1; m <= top; m++) J[m] = half * J[m - 1];
    J[top] *= more;
    for (int m = top - 1; m >= 0; m--) {
        J[m] *= last;
        V next = m * last - q * more;
        more = last, last = next;
    }
}
/* J_0 to J_top, `top` from 1 to MOST_ORDER */
static inline void bessel(const Series *series, V x, int top, V *J) {
    I far = x >= 8, near = x < 2;
    if (!any(~near)) {
        near_orders(series, x, top, J);
        return;
    }
    V inverse = 1 / most(x, all(2.0));
    if (any(~far)) {
        V t = x * x * 0.03125 - 1, zero = all(0), first = all(0);
        for (int j = 0; j < OF_NEAR; j++) zero = zero * t + NEAR[j][0], first = first * t + NEAR[j][1];
        J[0] = zero, J[1] = x * first;
    }
    if (any(far)) {
        V z = 8 * inverse, u = z * z, P = all(0), Q = all(0), P1 = all(0), Q1 = all(0), sine, cosine;
        for (int j = 0; j < OF_FAR; j++)
            P = P * u + FAR[j][0], Q = Q * u + FAR[j][1], P1 = P1 * u + FAR[j][2], Q1 = Q1 * u + FAR[j][3];
        angles(x, &sine, &cosine);
        V even = cosine + sine, odd = sine - cosine, scale = root(inverse * 0.31830988618379067);
        V zero = scale * (P * even - z * Q * odd), first = scale * (P1 * odd + z * Q1 * even);
        J[0] = any(~far) ? pick(far, zero, J[0]) : zero, J[1] = any(~far) ? pick(far, first, J[1]) : first;
    }
    for (int m = 1; m < top; m++) J[m + 1] = 2 * m * inverse * J[m] - J[m - 1];
    if (any(near)) {
        V lower[MOST_ORDER + 1];
        near_orders(series, x, top, lower);
        for (int m = 0; m <= top; m++) J[m] = pick(near, lower[m], J[m]);
    }
}
