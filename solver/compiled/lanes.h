/* Vectors of W doubles, a case in each lane, and the functions that C has for one number. To about 1e-16, relative. */
typedef double V __attribute__((vector_size(8 * W)));
typedef int64_t I __attribute__((vector_size(8 * W)));
typedef uint64_t U __attribute__((vector_size(8 * W)));
#define ALONE __attribute__((noinline))        /* compiled once: the same bits wherever it is called */
#define EACH(l) for (int l = 0; l < W; l++)
static inline V all(double x) { return x - (V){0}; }
static inline V pick(I mask, V yes, V no) { return (V)((mask & (I)yes) | (~mask & (I)no)); }
static inline V most(V a, V b) { return pick(a > b, a, b); }
static inline V least(V a, V b) { return pick(a < b, a, b); }
static inline V size_of(V x) { return (V)((I)x & INT64_MAX); }
static inline V clip(V x, V low, V high) { return pick(x < low, low, pick(x > high, high, x)); }  /* NaN stays */
static inline int any(I mask) { int64_t r = 0; EACH(l) r |= mask[l]; return r != 0; }
static inline I is_finite(V x) { return x - x == 0; }
static inline V root(V x) { V r; EACH(l) r[l] = __builtin_sqrt(x[l]); return r; }        /* GCC makes it one vector's */
/* exp(x) and exp(x) - 1 */
static inline V exponential(V x, V *less_one) {
    const double magic = 6755399441055744.0;                                   /* 1.5 2^52 */
    V inside = clip(x, all(-708.0), all(709.0)), t = inside * 1.4426950408889634 + magic, n = t - magic;
    V r = (inside - n * 0x1.62e42fee00000p-1) - n * 0x1.a39ef35793c76p-33;     /* ln 2 in two parts */
    V scale = (V)(((I)t << 52) + ((int64_t)1023 << 52));
    V sum = all(1 / 6227020800.0);
    sum = sum * r + 1 / 479001600.0, sum = sum * r + 1 / 39916800.0, sum = sum * r + 1 / 3628800.0;
    sum = sum * r + 1 / 362880.0, sum = sum * r + 1 / 40320.0, sum = sum * r + 1 / 5040.0, sum = sum * r + 1 / 720.0;
    sum = sum * r + 1 / 120.0, sum = sum * r + 1 / 24.0, sum = sum * r + 1 / 6.0, sum = sum * r + 0.5;
    sum = sum * (r * r) + r;
    if (less_one) *less_one = pick(x < -700.0, all(-1.0), scale * sum + (scale - 1));
    V result = pick(x < -708.0, all(0.0), pick(x > 709.0, all(__builtin_inf()), scale * sum + scale));
    return pick(x == x, result, x);
}
static inline V vexp(V x) { return exponential(x, 0); }
/* The logarithm of x > 0, not subnormal: fdlibm's. */
static inline V vlog(V x) {
    U bits = (U)x + 0x00095f6200000000ull;                                     /* mantissas from sqrt(1/2) to sqrt(2) */
    V k = (V)((bits >> 52) | 0x4330000000000000ull) - (0x1p52 + 1023);
    V f = (V)((bits & 0x000fffffffffffffull) + 0x3fe6a09e00000000ull) - 1;
    V s = f / (2 + f), z = s * s, half = 0.5 * f * f;
    V R = all(1.479819860511658591e-1);
    R = R * z + 1.531383769920937332e-1; R = R * z + 1.818357216161805012e-1; R = R * z + 2.222219843214978396e-1;
    R = R * z + 2.857142874366239149e-1; R = R * z + 3.999999999940941908e-1; R = R * z + 6.666666666666735130e-1;
    V result = k * 6.93147180369123816490e-01 - ((half - (s * (half + R * z) + k * 1.90821492927058770002e-10)) - f);
    result = pick(x == __builtin_inf(), x, result);
    return pick(x >= 2.2250738585072014e-308, result, pick(x == 0, all(-__builtin_inf()), all(__builtin_nan(""))));
}
static inline V power(V x, V e) { return vexp(e * vlog(x)); }
static inline V cube_root(V x) { return vexp(vlog(most(x, all(1e-300))) / 3); }
/* atan(1/y) for y > 0: Cephes's. */
static inline V angle(V y) {
    I steep = y < 0.4142135623730950488, flat = y > 1.5151515151515151;
    V above = pick(steep, -y, pick(flat, all(1.0), 1 - y)), below = pick(steep, all(1.0), pick(flat, y, 1 + y));
    V t = above / below, z = t * t;
    V begin = pick(steep, all(1.5707963267948966), pick(flat, all(0.0), all(0.7853981633974483)));
    V rest = pick(steep, all(6.123233995736766e-17), pick(flat, all(0.0), all(3.061616997868383e-17)));
    V p = ((((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z
            - 1.228866684490136173410e2) * z - 6.485021904942025371773e1);
    V q = (((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) * z
            + 4.853903996359136964868e2) * z + 1.945506571482613964425e2);
    return begin + (t + (t * z * (p / q) + rest));
}
