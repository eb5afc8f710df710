"""The micro laws of identical asperities on a square and on a hexagonal lattice.

Let l = 1/sqrt(Nbar), p^ = p Ra/(E l), A^ = A Ra/l² and p_max^ = p_max Ra/(E l). One curve each of A^, λ and p_max^ over
p^ serves every Nbar, Ra and E. The curves come from lattices.csv, which tools/references/make_lattices.py computes from
the periodic contact problem. p* and A* are those of the disc cell. Both ends of the curves are known
(docs/microscale.md, Lattices).

Full contact is only a limit. Between neighbouring summits the surface has a kink, here called a ridge, where its slope
changes by J. Full contact would need a pressure of minus infinity there: it is (z J/4π) ln r at the distance r from a
point where z ridges meet, and from a ridge itself, with z = 2. So gaps remain, of the size exp(-4π p^/(z J)); their
area falls as exp(-2π p^/J). A^ falls short of its limit by the mean gap, which falls as exp(-3π p^) on the square
lattice (J = 1, z = 4), and as exp(-4π p^/J) on the hexagonal one.
"""

import csv
from importlib.resources import files

import numpy as np

from . import disc_cell
from .cell.cell_law import of_spots
from .tabulated import LawTable, fitted, law_of, t_of

FILE = files(__package__) / "lattices.csv"  # which may be in a zip file
#: p* and A* in units E = Ra = l = 1; and the limit of the radius of a spot over y for y -> 0.
P_STAR, A_STAR = 2 / (3 * np.sqrt(np.pi)), 1 / np.pi
_SPOT = np.cbrt(0.75 * P_STAR)
#: Distance of neighbours on the hexagonal lattice, over l.
_PITCH = (4 / 3) ** 0.25
#: Full contact. J: the change of slope at a ridge, equal to the distance of neighbours. relief: the limit of A^. above:
#: the limit of p_max^ - p^, from ``full_contact`` in tools/references/make_lattices.py. rate: A^ and p_max^ - p^ tend
#: to their limits as exp(-rate p^).
ENDS = {
    "square": {"J": 1.0, "relief": 1 / 12, "above": 0.2206356, "rate": 3 * np.pi},
    "hex": {"J": _PITCH, "relief": 5 / (36 * np.sqrt(3)), "above": 0.2177788, "rate": 4 * np.pi / _PITCH},
}
#: Largest relative error of A, λ and p_max (tests/laws/lattice/test_lattice.py). λ reaches it; that of A and p_max is
#: 1e-5.
ERROR = 2e-4
#: Degree of the polynomials. FITTED in tests/laws/lattice/test_lattice.py says how near they are to the rows.
_DEGREE = 12
#: Beyond the last row guiding points of this weight lead the fit; a row has at most the weight 1.
_WEIGHT = 1e-4
#: At the guiding points V + m ln t continues from the last row and tends to a limit: its slope decays over this
#: distance in t.
_SETTLES = 0.15


def read(name):
    """p^, A^, λ and p_max^ (n,) of the lattice of this name, from the file; p^ ascends."""
    with FILE.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["lattice"] == name]
    return (np.array([float(row[column]) for row in rows]) for column in ("p", "A", "lam", "p_max"))


def _table(name):
    """:class:`~solver.laws.tabulated.LawTable` of a lattice."""
    J, relief, above, rate = ENDS[name].values()
    p, A, lam, p_max = read(name)
    q = p / P_STAR
    columns = (
        (A / A_STAR, 2, rate, relief / A_STAR, _SPOT**2 / A_STAR),
        (lam, 2, 2 * np.pi / J, 1.0, np.pi * _SPOT**2),
        ((p_max - p) / P_STAR, 1, rate, above / P_STAR, 2 * _SPOT / np.pi / P_STAR),
    )
    return LawTable(*(_quantity(t_of(q), q, *column) for column in columns))


def _quantity(t, q, X, power, rate, limit, first):
    """:class:`~solver.laws.tabulated.TableCurve` near the rows X (n,) at t and q (n,), with the right ends: X/t^power
    tends to `first` for t -> 0, and X tends to `limit` as exp(-rate p^)."""
    rate = rate * P_STAR
    last = -rate * q[-2:] - np.log(1 / X[-2:] - 1 / limit)  # V + m ln t
    t_guides = np.linspace(t[-1], 1, 13)[1:]
    settling = (last[1] - last[0]) / (t[-1] - t[-2]) * _SETTLES * -np.expm1((t[-1] - t_guides) / _SETTLES)
    guides = t_guides, last[1] + settling - power * np.log(t_guides), _WEIGHT
    return fitted(t, q, X, _DEGREE, guides, first, power=power, rate=rate, limit=limit)[0]


def _law(name):
    words = {"name": f"{name}_lattice", "scales": disc_cell.scales}
    rest = {"parameters": disc_cell.PARAMETERS, "smears": False, "rise": 1.1}
    on_body = of_spots(lattice=name, **words, **rest)
    return law_of(_table(name), **words, **rest, error=ERROR, cell=name, on_body=on_body)


SQUARE, HEX = _law("square"), _law("hex")
