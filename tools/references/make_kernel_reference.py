"""Write kernel_reference.csv: L, L - 1, u dL/du of the exact layered base with 25 digits, independent of the solver.

The closed forms of the two interfaces as printed (hyperbolic without friction, exponential when bonded), evaluated
naively with 300 digits, so that no care about cancellation is needed; the derivative is numerical (mpmath.diff). Every
input is an exact float64. test_kernel.py solves the boundary-value problem behind the formulas for some of the rows.
Run it from anywhere: ``python tools/references/make_kernel_reference.py``.
"""

from itertools import product
from pathlib import Path

import mpmath as mp

COLUMNS = ("bonded", "n", "nu1", "nu2", "u", "L", "L1", "uL")

RATIOS = (1e-8, 1e-3, 0.5, 1.0, 2.0, 1e3, 1e8)
POISSON = (-0.9, 0.0, 0.3, 0.45, 0.499999, 0.5)
UNEQUAL = ((-0.9, 0.5), (0.5, -0.9), (0.0, 0.5), (0.5, 0.0), (0.3, 0.45), (0.45, 0.3), (0.499999, 0.3), (0.3, 0.499999))
WAVES = (1e-8, 1e-6, 1e-4, 1e-2, 0.05, 0.2, 0.5, 0.79, 0.81, 2.0, 5.0, 12.0, 30.0, 100.0)


def frictionless(u, n, nu1, nu2):
    """L = [s² + n(sc + u)]/[(sc + u) + n(s² - u²)]; no Poisson ratio enters."""
    s, c = mp.sinh(u), mp.cosh(u)
    return (s**2 + n * (s * c + u)) / (s * c + u + n * (s**2 - u**2))


def bonded(u, n, nu1, nu2):
    """L = [1 + 4bue - ab e²]/[1 - (a + b + 4bu²)e + ab e²], e = exp(-2u)."""
    alpha, g1, g2, e = n * (1 - nu1) / (1 - nu2), 3 - 4 * nu1, 3 - 4 * nu2, mp.exp(-2 * u)
    a, b = (alpha * g2 - g1) / (1 + alpha * g2), (alpha - 1) / (alpha + g1)
    return (1 + 4 * b * u * e - a * b * e**2) / (1 - (a + b + 4 * b * u**2) * e + a * b * e**2)


def row(is_bonded, n, nu1, nu2, u):
    """One row of the table."""
    numbers = [mp.mpf(v) for v in (n, nu1, nu2)]
    function, wave = bonded if is_bonded else frictionless, mp.mpf(u)
    L = function(wave, *numbers)
    slope = wave * mp.diff(lambda v: function(v, *numbers), wave)
    values = [mp.mpf(0) if abs(v) < mp.mpf(10) ** -200 else v for v in (L, L - 1, slope)]  # L ≡ 1 with its rounding
    return ",".join([str(int(is_bonded)), *map(repr, (n, nu1, nu2, u)), *(mp.nstr(v, 25) for v in values)])


def main():
    """Write the table into tests/references."""
    pairs = [(nu, nu) for nu in POISSON] + list(UNEQUAL)
    with mp.workdps(300):
        rows = [row(False, n, 0.3, 0.3, u) for n, u in product(RATIOS, WAVES)]
        rows += [row(True, n, *pair, u) for pair, n, u in product(pairs, RATIOS, WAVES)]
    text = "\n".join([",".join(COLUMNS), *rows, ""])
    (Path(__file__).parents[2] / "tests/references/kernel_reference.csv").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
