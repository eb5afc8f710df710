"""The micro laws of identical asperities on a square and on a hexagonal lattice.

In p^ = p Ra/(E l), l = 1/sqrt(Nbar), one curve each of A^ = A Ra/l², λ and p_max^ serves every Nbar, Ra and E. They
come from lattices.csv, which tests/references/make_lattices.py computes from the periodic contact problem. p* and A*
are those of the disc cell. Both ends are known.

- Isolated spots are Hertz's, A^ = (9/16 p^²)^(1/3) - c p^ + ..., c = 1.2415 and 1.2481 (sums over the lattice).
- At full contact A^ is the mean relief, 1/12 and 0.0802. The pressure of full contact is minus infinity on the ridges
  between the summits: (z J/4π) ln r at a distance r of a place where z of them meet, z = 2 on a ridge itself, J the
  change of slope there. So gaps stay, of size exp(-4π p^/(z J)), and their area falls by exp(-2π p^/J). A^ falls short
  by the mean gap, which falls by exp(-3π p^) on the square lattice (J = 1, z = 4) and by exp(-4π p^/J) on the other.
"""

import csv
from pathlib import Path

import numpy as np

from . import disc_cell
from .tabulated import Table, fitted, law_of, t_of

FILE = Path(__file__).with_name("lattices.csv")
#: p* and A* in units E = Ra = l = 1, and the radius of an isolated spot over y.
P_STAR, A_STAR = 2 / (3 * np.sqrt(np.pi)), 1 / np.pi
_SPOT = np.cbrt(0.75 * P_STAR)
#: J, the distance of neighbours, is the change of slope on a ridge between them; relief: its mean; above: p_max^ - p^
#: at full contact, by ``full_contact`` of the maker of the table; rate: how fast A^ and p_max^ - p^ tend to their ends.
ENDS = {
    "square": {"J": 1.0, "relief": 1 / 12, "above": 0.2206356, "rate": 3 * np.pi},
    "hex": {
        "J": (4 / 3) ** 0.25,
        "relief": 5 / (36 * np.sqrt(3)),
        "above": 0.2177788,
        "rate": 4 * np.pi / (4 / 3) ** 0.25,
    },
}
#: Largest relative error of A, λ and p_max (tests/laws/test_lattice.py). It is that of λ; A and p_max have 1e-5.
ERROR = 2e-4
#: Degree of the polynomials: 5e-6 from the rows of A. Degree 16 is 3e-6 from them, and costs a twentieth more time.
_DEGREE = 12
#: Weight of points beyond the last row.
_WEIGHT = 1e-4
#: There V + m ln t goes on over this distance in t: it tends to a number.
_SETTLES = 0.15


def read(name):
    """p^, A^, λ and p_max^ (n,) of a lattice, by name, from the file; p^ ascends."""
    with FILE.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["lattice"] == name]
    return (np.array([float(row[column]) for row in rows]) for column in ("p", "A", "lam", "p_max"))


def _table(name):
    """:class:`~solver.laws.tabulated.Table` of a lattice."""
    J, relief, above, rate = ENDS[name].values()
    p, A, lam, p_max = read(name)
    q = p / P_STAR
    given = (
        (A / A_STAR, 2, rate, relief / A_STAR, _SPOT**2 / A_STAR),
        (lam, 2, 2 * np.pi / J, 1.0, np.pi * _SPOT**2),
        ((p_max - p) / P_STAR, 1, rate, above / P_STAR, 2 * _SPOT / np.pi / P_STAR),
    )
    return Table(*(_quantity(t_of(q), q, *one) for one in given))


def _quantity(t, q, X, power, rate, limit, first):
    """:class:`~solver.laws.tabulated.Quantity` through the rows X (n,) at t and q (n,), with both its ends."""
    rate = rate * P_STAR
    last = -rate * q[-2:] - np.log(1 / X[-2:] - 1 / limit)  # V + m ln t
    beyond = np.linspace(t[-1], 1, 13)[1:]
    settling = (last[1] - last[0]) / (t[-1] - t[-2]) * _SETTLES * -np.expm1((t[-1] - beyond) / _SETTLES)
    guides = beyond, last[1] + settling - power * np.log(beyond), _WEIGHT
    return fitted(t, q, X, _DEGREE, guides, first, power=power, rate=rate, limit=limit)[0]


def _law(name):
    known = {
        "parameters": disc_cell.PARAMETERS,
        "scales": disc_cell.scales,
        "error": ERROR,
        "smears": False,
        "rise": 1.1,
    }
    return law_of(_table(name), name=f"{name}_lattice", **known)


SQUARE, HEX = _law("square"), _law("hex")
