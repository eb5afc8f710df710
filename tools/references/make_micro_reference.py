"""Write micro_reference.csv: the exact micro law from Eqs (6), (7), (11), (13), 50 digits, independent of the solver.

Each row belongs to one y = cot θ, an exact float64; λ runs from 1e-12 to 1 - 1e-12. The columns are λ, q = p/p*,
g = A/A*, dq/dy, dg/dy and pmax/p*, printed with 25 digits. q and g are the law itself, solved for p and A with
b = B̄ cos θ; the derivatives are numerical (mpmath.diff at 50 digits).
Run it from anywhere: ``python tools/references/make_micro_reference.py``.
"""

from pathlib import Path

import mpmath as mp
import numpy as np

mp.mp.dps = 50
COLUMNS = ("y", "lam", "q", "g", "dq", "dg", "p_max")


def spot(y):
    """λ, q, g, pmax/p* of one spot, in units B̄ = Ra = 1, p* = 2 E/3 = 1, from the equations as printed."""
    E = mp.mpf(3) / 2
    b = y / mp.sqrt(1 + y * y)
    p = 2 * E * b**3 / 3 / (mp.acos(b) + b * mp.sqrt(1 - b * b))  # (7)
    A = b**2 - 2 * p / E * mp.sqrt(1 - b * b)  # (6)
    p_max = 2 * E * b / mp.pi + 2 * p / mp.pi * mp.asin(b)  # (13)
    return b**2, p, A, p_max


def row(y):
    """One row of the table."""
    exact = mp.mpf(y)
    lam, q, g, p_max = spot(exact)
    dq, dg = (mp.diff(lambda v, i=i: spot(v)[i], exact) for i in (1, 2))
    return ",".join([repr(y), *(mp.nstr(v, 25) for v in (lam, q, g, dq, dg, p_max))])


def main():
    """Write the table into tests/references."""
    lam = np.concatenate([np.geomspace(1e-12, 0.5, 30), 1 - np.geomspace(0.4, 1e-12, 30)])
    ys = [float(y) for y in np.sqrt(lam / (1 - lam))]
    text = "\n".join([",".join(COLUMNS), *map(row, ys), ""])
    (Path(__file__).parents[2] / "tests/references/micro_reference.csv").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
