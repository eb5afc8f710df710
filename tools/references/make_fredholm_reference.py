"""Write fredholm_reference.csv: smooth spheres on layers that bend like plates, or on a rigid base, without the solver.

The equation is the one derived in tools/resolved/layered_independent.py, for f(t) on 0 ≤ t ≤ 1 in units of the contact
radius a: f(t) + (2/π) ∫₀^∞ (L(kη) - 1) cos(kt) f̂(k) dk = d - t², with f̂(k) = ∫₀¹ f(t) cos(kt) dt, η = h/a and
f(1) = 0. Here it is solved by Galerkin in long double: f is made of Legendre polynomials in panels that narrow towards
the edge, f̂ of spherical Bessel functions. The columns are P R/(E1* a³), D R/a² and p(0) R/(E1* a).

Two meshes are compared. The last column is the largest relative difference of the three numbers between them. All are
written with 18 digits; the difference tells how many of them are right. It is due to rounding: the smallest eigenvalue
of the equation is 5e-9 at h/a = 2^-10.
Two minutes on one processor: ``python tools/references/make_fredholm_reference.py``. It needs a long double of 64 bits.
"""

from pathlib import Path

import numpy as np
from mpmath import mp

real = np.longdouble
PI = real("3.14159265358979323846264338327950288")
COLUMNS = ("set", "bonding", "nu1", "n", "h_a", "P", "D", "p0", "difference")
#: set, bonding, nu1, n and h/a. nu1 counts only in a bond, which is on a rigid base here.
CASES = (
    ("plates", "frictionless", 0.3, 2e5, 0.15),
    ("plates", "frictionless", 0.3, 2e5, 0.1),
    ("plates", "frictionless", 0.3, 2e4, 0.15),
    ("films", "frictionless", 0.3, 3e2, 3e-3),
    ("films", "frictionless", 0.3, 3e3, 3e-3),
    ("films", "frictionless", 0.3, 3e4, 3e-3),
    *(("rigid", "bonded", 0.5, 0.0, 2.0**power) for power in (-6, -8.5, -10)),
    *(("force", "bonded", 0.5, 0.0, 1 / ratio) for ratio in (0.1, 0.5, 1.0, 2.0, 4.0)),
)


def gauss(count):
    """Nodes and weights on [-1, 1]: those of numpy, improved by Newton's method in long double."""
    x = np.polynomial.legendre.leggauss(count)[0].astype(real)
    for _ in range(3):
        last, value = np.ones_like(x), x
        for j in range(2, count + 1):
            last, value = value, ((2 * j - 1) * x * value - (j - 1) * last) / j
        slope = count * (x * value - last) / (x * x - 1)
        x = x - value / slope
    return x, 2 / ((1 - x * x) * slope * slope)


def kernel(u, bonding, n):
    """L(u) - 1 of a layer without friction on a half-space, or of an incompressible one bonded to a rigid base."""
    if bonding == "bonded":
        assert n == 0
        return -(np.exp(-2 * u) + 1 + 2 * u + 2 * u * u) / (np.cosh(2 * u) + 2 * u * u + 1)
    small, term, excess = np.minimum(u, 2), np.minimum(u, 2), np.zeros_like(u)
    for j in range(1, 16):  # sinh u - u, which cancels below u = 2
        term = term * small * small / (2 * j * (2 * j + 1))
        excess = excess + term
    s = np.sinh(u)
    gap = np.where(u < 2, excess, s - u) * (s + u)  # sinh² u - u²
    return ((n - 1) * (s * np.exp(-u) + u) + n * u * u) / (s * np.cosh(u) + u + n * gap)


def waves(eta, n, nodes):
    """k and weights of ∫₀^∞ (L(kη) - 1) (…) dk: panels that double from below kη = 1/n, then have one width."""
    widest = min(16.0, 0.5 / eta)
    ends = [0.0, min(widest, 2.0**-8 / eta / max(1.0, n))]
    while ends[-1] < 26 / eta:
        ends.append(ends[-1] + min(ends[-1], widest))
    ends = np.array(ends, dtype=real)
    x, w = gauss(nodes)
    half = (ends[1:] - ends[:-1])[:, None] / 2
    return (ends[:-1, None] + half * (x + 1)).ravel(), (half * w).ravel()


def bessel(z, count):
    """Spherical Bessel functions j_l(z), l < count: recurrence upwards for z > count, otherwise downwards; for z < 1 a
    series."""
    values = np.empty((count, len(z)), dtype=real)
    up, series = z > count, z < 1
    down = ~up & ~series
    x = z[up]
    values[0, up], values[1, up] = np.sin(x) / x, np.sin(x) / x**2 - np.cos(x) / x
    for j in range(1, count - 1):
        values[j + 1, up] = (2 * j + 1) / x * values[j, up] - values[j - 1, up]
    x, lead = z[series], np.ones(series.sum(), dtype=real)
    for j in range(count):
        lead = lead * x / (2 * j + 1) if j else lead
        term, total = lead, lead
        for i in range(1, 16):
            term = -term * x * x / (2 * i * (2 * (j + i) + 1))
            total = total + term
        values[j, series] = total
    x = z[down]
    above, current, squares = np.zeros_like(x), np.full_like(x, 1e-300), np.zeros_like(x)
    for j in range(3 * count + 40, -1, -1):
        if j < count:
            values[j, down] = current
        squares = squares + (2 * j + 1) * current * current
        above, current = current, (2 * j + 1) / x * current - above
    values[:, down] /= np.sqrt(squares)  # Σ (2 l + 1) j_l² = 1
    return values


def sine_integral(k):
    """Si(k): by mpmath, beyond 60 by its asymptotic series, whose smallest term is below exp(-60)."""
    with mp.workdps(25):
        near = [real(mp.nstr(mp.si(mp.mpf(str(v))), 24)) for v in k[k <= 60]]
    x = k[k > 60]
    f, g, term = np.zeros_like(x), np.zeros_like(x), 1 / x
    for j in range(0, 56, 2):  # term = (-1)^(j/2) j!/x^(j + 1)
        f, g = f + term, g + term * (j + 1) / x
        term = -term * (j + 1) * (j + 2) / (x * x)
    return np.concatenate([np.array(near, dtype=real), PI / 2 - f * np.cos(x) - g * np.sin(x)])


def transforms(k, edges, count):
    """∫₀¹ φ(t) cos(kt) dt of the normed Legendre polynomials φ of every panel: (k, panels · count)."""
    parts = []
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        half, middle = (high - low) / 2, (high + low) / 2
        turns = np.cos(k * middle), -np.sin(k * middle)
        waves = np.stack([(-1) ** (j // 2) * turns[j % 2] for j in range(count)])  # cos(k middle + j π/2)
        norm = np.sqrt(half * (2 * np.arange(count, dtype=real) + 1) * 2)
        parts.append(norm[:, None] * waves * bessel(k * half, count))
    return np.concatenate(parts).T


def solved(system, sides):
    """Gauss elimination without exchange of rows: the system is symmetric and positive."""
    system, sides = system.copy(), sides.copy()
    for i in range(len(system)):
        factors = system[i + 1 :, i] / system[i, i]
        system[i + 1 :, i:] -= factors[:, None] * system[i, i:]
        sides[i + 1 :] -= factors[:, None] * sides[i]
    for i in range(len(system) - 1, -1, -1):
        sides[i] = (sides[i] - system[i, i + 1 :] @ sides[i + 1 :]) / system[i, i]
    return sides


def right_sides(edges, count):
    """∫₀¹ φ dt and ∫₀¹ φ t² dt of the same polynomials φ: (panels · count, 2)."""
    x, w = gauss(count + 2)
    P = np.stack([np.ones_like(x), x, *np.zeros((count - 2, len(x)), dtype=real)])
    for j in range(2, count):
        P[j] = ((2 * j - 1) * x * P[j - 1] - (j - 1) * P[j - 2]) / j
    sides = []
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        half, t = (high - low) / 2, (high + low) / 2 + x * (high - low) / 2
        norm = np.sqrt(half * (2 * np.arange(count, dtype=real) + 1) / 2)[:, None]
        sides.append(norm * (P @ (w[:, None] * np.stack([np.ones_like(t), t * t], axis=1))))
    return np.concatenate(sides)


def answer(bonding, n, eta, count, nodes):
    """P R/(E1* a³), D R/a² and p(0) R/(E1* a), by polynomials of `count` coefficients in panels down to h/2."""
    halvings = max(1, int(np.ceil(np.log2(2 / eta))))
    edges = np.array([0.0, *(1 - 0.5 ** np.arange(1, halvings + 1)), 1.0], dtype=real)
    k, weights = waves(eta, n, nodes)
    weights = weights * kernel(k * eta, bonding, n) * 2 / PI
    size = count * (len(edges) - 1)
    system, ends, middles = np.eye(size, dtype=real), np.zeros(size, dtype=real), np.zeros(size, dtype=real)
    si = sine_integral(k)
    for i in range(0, len(k), 4000):
        part = slice(i, i + 4000)
        wave = transforms(k[part], edges, count)
        system += (wave.T * weights[part]) @ wave
        ends += (weights[part] * np.cos(k[part])) @ wave
        middles += (weights[part] * k[part] * si[part]) @ wave / PI
    sides = right_sides(edges, count)
    f = solved(system, sides)
    edge = 1 - ends @ f
    d = edge[1] / edge[0]
    f = d * f[:, 0] - f[:, 1]
    return np.array([2 * (sides[:, 0] @ f), d, 2 / PI - middles @ f])


def main():
    """Write the table into tests/references."""
    assert np.finfo(real).eps < 2e-19, "this machine's long double is no longer than a double"
    lines = [",".join(COLUMNS)]
    for name, bonding, nu1, n, eta in CASES:
        coarse, fine = (answer(bonding, n, eta, count, nodes) for count, nodes in ((18, 40), (24, 48)))
        numbers = [np.format_float_scientific(value, precision=17) for value in fine]
        difference = f"{float(np.abs(coarse / fine - 1).max()):.0e}"
        lines.append(",".join([name, bonding, str(nu1), repr(n), repr(eta), *numbers, difference]))
    path = Path(__file__).parents[2] / "tests/references/fredholm_reference.csv"
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")


if __name__ == "__main__":
    main()
