"""The parameters of a case: the table of their bounds, defaults and choices, and of the cases that need and use
them."""

import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .bases import BASES, STACKS, WITH_LAYERS
from .numerics import profiles

BONDINGS = ("frictionless", "bonded")
#: How the model error of a thin layer is estimated: at no cost, or by solving the exact layer.
MODEL_CHECKS = ("closed_form", "first_order")
#: How attraction acts; and which of two states with the same load or depth the answer is.
ADHESIONS, BRANCHES = ("jkr", "dmt", "maugis"), ("stable", "unstable")
#: The body on which asperities press: "layer", the coated body itself; "half_space", one of the layer's material;
#: "auto", the coated body if their pitch is above the thickness of the layer.
ASPERITIES_ON = ("auto", "layer", "half_space")
#: The condition, for `needed_by` and `used_by` below, that every case meets.
EVERY = ("", ())


class Parameter(NamedTuple):
    """One parameter of a case.

    Attributes
    ----------
    default : the value if it is not given; None: it has no default, and must be given if a case needs it.
    choices : the words that a text may be; () for a number.
    whole : whether the number is an integer.
    interval : the allowed numbers, in units R = E2* = 1 and mathematical notation. Within it the solver is tested
        (tools/fuzz/fuzz_solver.py): each case is solved, or has a status.
    also : single values that are allowed outside the interval.
    needed_by : a condition, (name of another parameter, some of its choices): the cases that meet it need this
        parameter. Several such pairs may follow one another: then a case must meet one of them. In these cases the
        parameter is checked, and must be given if it has no default. EVERY: all cases need it.
    used_by : a second condition: the answer depends on the parameter only in cases that meet both.
    powers : (i, j); the unit is E2*^i R^j.
    instead : for a parameter without a default, the name of another one that can replace it; "": a case can do without
        it. None: it must be given.
    symbol, long_name : the symbol and the name, in tables and figures, of a parameter that a registered law declares.

    Examples
    --------
    >>> angle = Parameter(0.5, interval="(0, 1.57)")
    >>> allowed(angle, [1.0, 2.0]).tolist()
    [True, False]
    """

    default: float | int | str | None = None
    choices: tuple[str, ...] = ()
    whole: bool = False
    interval: str = ""
    also: tuple = ()
    needed_by: tuple = EVERY
    used_by: tuple = EVERY
    powers: tuple[int, int] = (0, 0)
    instead: str | None = None
    symbol: str = ""
    long_name: str = ""


class NamedRows(dict):
    """Rows by name, which cannot be changed.

    further : function from a name to a row that follows from the name itself, as for "layers.2.h", or None. Such a row
        can be looked up, but is not among the rows that are listed
    """

    def __init__(self, rows, further=lambda name: None):
        super().__init__(rows)
        self.further = further

    def __missing__(self, name):
        row = self.further(name)
        if row is None:
            raise KeyError(name)
        return row

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or self.further(name) is not None

    def get(self, name, default=None):
        row = super().get(name)
        row = self.further(name) if row is None else row
        return default if row is None else row

    def _refuse(self, *_, **__):
        raise TypeError("this table is the same for all calls: its rows cannot be changed")

    __setitem__ = __delitem__ = __ior__ = update = setdefault = pop = popitem = clear = _refuse


#: The conditions that a case has a layer, and that it is bonded.
LAYERED = ("base", WITH_LAYERS)
BONDED = ("bonding", ("bonded",))
#: The conditions that a case has a stack of layers, and that Poisson ratios change something.
STACKED = ("base", STACKS)
COUPLED = (*BONDED, *STACKED)

#: A condition that no case meets.
NEVER = ("base", ())
#: A yield strength. It is optional: it is compared with the answers, and does not change them.
STRENGTH = Parameter(interval="[1e-15, 1e15]", powers=(1, 0), used_by=NEVER, instead="")

#: The controls, one of which is given.
CONTROL = {
    "P": Parameter(interval="[1e-24, 1e3]", powers=(1, 2)),
    "a": Parameter(interval="[1e-9, 1e3]", powers=(0, 1)),
    "D": Parameter(interval="[1e-18, 1e3]", powers=(0, 1)),
}

#: The parameters that no law and no shape declares; their meanings and units are in :class:`~solver.problem.Problem`.
#: :class:`~solver.known.Known` has the whole table. It includes the parameters of laws and shapes, the choices of
#: `micro`, `shape` and `scheme`, and the rows of layers of a stack, such as "layers.2.h", which follow from their names
#: (`row`). Keys of cases leave defaults out (study/inputs/identity.py): a change of a default needs a new
#: `NUMERICS_VERSION`.
COMMON = NamedRows(
    {
        "h": Parameter(interval="[1e-12, 1e6]", needed_by=LAYERED, powers=(0, 1)),
        "n": Parameter(interval="[1e-9, 1e9]", also=(0,), needed_by=LAYERED),  # 0: a rigid base
        "m": Parameter(0.0, interval="[0, 1e9]"),
        "nu1": Parameter(0.3, interval="(-1, 0.5]", needed_by=LAYERED, used_by=COUPLED),
        "nu2": Parameter(0.3, interval="(-1, 0.5]", needed_by=LAYERED, used_by=COUPLED),
        "Y1": STRENGTH._replace(needed_by=LAYERED),
        "Y2": STRENGTH,
        "Y_punch": STRENGTH,
        "bonding": Parameter("frictionless", BONDINGS, needed_by=LAYERED),
        "base": Parameter("layered", BASES),
        "accuracy": Parameter(1e-2, interval="(0, 1)", needed_by=("base", ("auto",))),
        "model_check": Parameter("closed_form", MODEL_CHECKS, needed_by=("base", ("thin_layer",))),
        "micro": Parameter("disc_cell"),
        "asperities_on": Parameter("auto", ASPERITIES_ON, needed_by=LAYERED),
        "shape": Parameter("paraboloid", ("paraboloid",)),
        "w_adhesion": Parameter(0.0, interval="[0, 1e3]", powers=(1, 1)),
        "adhesion": Parameter("jkr", ADHESIONS),
        "sigma0": Parameter(interval="[1e-15, 1e15]", powers=(1, 0), instead=""),
        "z0": Parameter(interval="[1e-15, 1e3]", powers=(0, 1), instead=""),
        "branch": Parameter("stable", BRANCHES),
        "k_machine": Parameter(interval="[0, inf]", powers=(1, 1), instead=""),
        "scheme": Parameter("newton", ("newton", "picard")),
        "k": Parameter(1.0, interval="[0, 1e6]", used_by=("scheme", ("picard",))),
        "rtol": Parameter(1e-6, interval="[1e-15, 1)"),
        "nodes": Parameter(0, whole=True, interval="[4, 256]", also=(0,)),
        "max_iterations": Parameter(0, whole=True, interval="[1, 100000]", also=(0,)),
        "R": Parameter(1.0, interval="(0, inf)"),
        "E2": Parameter(1.0, interval="(0, inf)"),
    }
)

#: Most layers of a stack.
MOST = 16
#: Number of uniform sublayers of a graded layer in each octave of the depth; 0: more and more, until the answers no
#: longer change.
_SUBLAYERS = Parameter(0, whole=True, interval="[1, 512]", also=(0,), needed_by=STACKED)
#: Key of a layer -> its row in the table of parameters. cn, ct : compliance of the interface below the layer, across
#: and along it, length over pressure; 0 is a perfect bond, and without friction ct has no effect. Y : yield strength.
LAYER = {
    "h": Parameter(interval="[1e-12, 1e6]", powers=(0, 1)),
    "n": Parameter(interval="[1e-9, 1e9]"),
    "nu": Parameter(0.3, interval="(-1, 0.5]"),
    "bonding": Parameter("frictionless", BONDINGS),
    "cn": Parameter(0.0, interval="[0, 1e15]", powers=(-1, 1)),
    "ct": Parameter(0.0, interval="[0, 1e15]", powers=(-1, 1)),
    "profile": Parameter("uniform", profiles.WORDS),
    "n_bottom": Parameter(interval="[1e-9, 1e9]", instead=""),
    "nu_bottom": Parameter(interval="(-1, 0.5]", instead=""),
    "Y": STRENGTH,
}
#: Key of the first layer -> its name in a case with one layer.
FIRST = {"h": "h", "n": "n", "nu": "nu1", "bonding": "bonding", "Y": "Y1"}
NAME_OF_LAYER = re.compile(rf"layers\.([1-9]\d?)\.({'|'.join(LAYER)})")


def full_name(number: int, field: str, first: Mapping[str, str] = FIRST) -> str:
    """The name of a parameter of a layer.

    Parameters
    ----------
    number : number of the layer, 1 at the surface
    field : a key of `LAYER`
    first : key of the first layer -> its name in a case with one layer

    Returns
    -------
    str

    Examples
    --------
    >>> full_name(1, "nu"), full_name(2, "nu")
    ('nu1', 'layers.2.nu')
    """
    return first[field] if number == 1 and field in first else f"layers.{number}.{field}"


def numbers_of(names) -> int:
    """The number of layers of a stack, by the `names` of its parameters; 0 if none of them is that of a layer."""
    names = [name for name in names if isinstance(name, str) and name.startswith(("layers.", "sublayers"))]
    matches = (NAME_OF_LAYER.fullmatch(name) for name in names)
    return max((int(match[1]) for match in matches if match), default=int(bool(names)))


def row(name: object, tables: Iterable[str] = ()) -> Parameter | None:
    """The row of a parameter of a layer, or of `sublayers`, in the table of parameters.

    Parameters
    ----------
    name : name of the parameter
    tables : words "table:FILE" of the profiles that have been read

    Returns
    -------
    solver.parameters.Parameter, or None if the name is not that of a layer, or is a name of a case with one layer
    """
    if not isinstance(name, str) or not name.startswith(("layers.", "sublayers")):
        return None
    if name.endswith(".profile") and name in _ROWS:
        return _ROWS[name]._replace(choices=(*profiles.WORDS, *tables))
    return _ROWS.get(name)


def _row(number: int, field: str) -> Parameter:
    of_bottom = field in ("n_bottom", "nu_bottom")
    used = (full_name(number, "profile"), profiles.GRADED) if of_bottom else LAYER[field].used_by
    return LAYER[field]._replace(needed_by=STACKED, used_by=used)


#: Name -> row, for each parameter of a layer that is not a parameter of a case with one layer.
_ROWS = {
    name: _row(number, field)
    for number in range(1, MOST + 1)
    for field in LAYER
    if (name := full_name(number, field)).startswith("layers.")
} | {"sublayers": _SUBLAYERS}


def is_ratio(name):
    """Whether a parameter is a Poisson ratio, which may be 0: derivatives are by the ratio, not by its logarithm."""
    return name in ("nu1", "nu2") or name.startswith("layers.") and name.endswith((".nu", ".nu_bottom"))


def one_of(values, words):
    """(...) bool: whether each value is one of a few words or numbers. `numpy.isin` sorts, which takes longer."""
    values = np.asarray(values)
    met = np.zeros(values.shape, dtype=bool)
    for word in words:
        met |= values == word
    return met


def among(condition, values):
    """(...) bool: the cases that meet a condition such as `needed_by`. `values(name)` returns the texts of a parameter
    in an array of any shape."""
    if condition == EVERY:
        return np.True_
    met = np.False_
    for name, words in zip(condition[::2], condition[1::2], strict=True):
        met = met | one_of(values(name), words)
    return met


def uses(parameter, values):
    """(...) bool: the cases whose answer depends on a :class:`Parameter`; `values` as in :func:`among`."""
    return among(parameter.needed_by, values) & among(parameter.used_by, values)


@lru_cache(maxsize=64)
def ends(interval):
    """Lower and upper end of an interval in mathematical notation, and whether each belongs to it."""
    low, high = (float(end) for end in interval[1:-1].split(", "))
    return low, high, interval[0] == "[", interval[-1] == "]"


def allowed(parameter, values):
    """(...) bool: whether the `interval` and `also` of a parameter allow each of the `values`; NaN is never allowed."""
    low, high, with_low, with_high = ends(parameter.interval)
    values = np.asarray(values)
    above = values >= low if with_low else values > low
    below = values <= high if with_high else values < high
    inside = above & below
    for value in parameter.also:
        inside = inside | (values == value)
    return inside
