"""The vocabulary: name, unit, bounds, symbol and words of every parameter and result, from vocabulary.toml."""

import difflib
import math
import numbers
import re
import tomllib
from collections import ChainMap
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files

from solver.parameters import FIRST, LAYER, MOST, NamedRows, Parameter, full_name
from solver.parameters import allowed as are_within

from ..terminal import shown

__all__ = ["SCENE", "VOCABULARY", "names"]
INTEGERS = {"status": "int8", "model_used": "int8", "iterations": "int32", "nodes_used": "int16"}
"""Results that are whole numbers -> the type in which they are stored."""
TRUTHS = {"stable": "int8"}
"""Results that are true or false, of some studies alone -> the type in which blocks store them."""
WITH_SPREADS = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD", "A0", "lam0")
"""Results that have spreads, like profiles; the others tell how well the case is solved."""
BY_INPUT = "_by_input"
"""NAME_by_input: derivatives of the result NAME by logarithms of the solver's inputs, by Poisson ratios themselves."""
NOT_RUN = 127
"""Value of `status` for a case that was never computed (the solver's own statuses are 0, 1, 2, ...)."""

SI = {(0, 0): "1", (0, 1): "m", (0, 2): "m^2", (0, -2): "1/m^2", (1, 0): "Pa", (1, 1): "N/m", (1, 2): "N"}
SI[-1, 1] = "m/Pa"
"""SI units by their powers of E2* and R; all other powers are written with Pa and m."""


def si_unit(powers: tuple[int, int]) -> str:
    """The SI unit of E2*^i R^j, (i, j) = `powers`."""
    return SI.get(powers, "Pa^{} m^{}".format(*powers))


@dataclass(frozen=True)
class Entry:
    """A row of the vocabulary: one parameter, result or coordinate; vocabulary.toml says what the fields are."""

    name: str
    role: str
    long_name: str
    symbol: str = ""
    powers: tuple[int, int] = (0, 0)
    equation: str = ""
    interval: str = ""
    written: str = ""

    @property
    def unit(self) -> str:
        """The SI unit of the physical quantity."""
        return self.written or si_unit(self.powers)

    @property
    def ratio(self) -> str:
        """The symbol over its scale, as on the axis of a plot: "h/R", "P/(E2* R^2)"; empty without a symbol."""
        return over_scale(self.symbol, self.powers) if self.symbol else ""

    @property
    def scale(self) -> str:
        """The scale in words, such as "E2* R^2"; empty for a pure number."""
        parts = [(s, e) for s, e in zip(("E2*", "R"), self.powers, strict=True) if e]
        return " ".join(s if e == 1 else f"{s}^{e}" for s, e in parts)


@cache
def over_scale(symbol: str, powers: tuple[int, int], scales: tuple[str, str] = ("E2*", "R"), gap: str = " ") -> str:
    """A symbol over its scale E2*^i R^j: "(dP/dD)/(E2* R)", "N̄ R^2".

    powers : (i, j); scales : texts for E2* and R; gap : text between two factors
    """
    numerator: list[str] = []
    times: list[str] = []
    for word, power in zip(scales, powers, strict=True):
        if power:
            (numerator if power > 0 else times).append(word + f"^{abs(power)}" * (abs(power) > 1))
    text = gap.join([f"({symbol})" if "/" in symbol and numerator else symbol, *times])
    denominator = gap.join(numerator)
    return text + (f"/({denominator})" if len(numerator) > 1 else f"/{denominator}" if numerator else "")


LISTED = 40  # most names that a message lists
LONGEST = 100  # most letters of a wrong name that are compared with others


def entries(tables: dict) -> dict[str, Entry]:
    """Name -> row, from tables like vocabulary.toml: role -> name -> the other fields."""
    rows = [(name, role, row) for role, table in tables.items() for name, row in table.items()]
    return {name: Entry(name, role, **row | {"powers": tuple(row.get("powers", (0, 0)))}) for name, role, row in rows}


_TABLES = tomllib.loads((files(__package__) / "vocabulary.toml").read_text(encoding="utf-8"))
#: Field of the first layer of a stack -> its name, which is that of a case with one layer.
FIRST_LAYER = FIRST | {"E1": "E1", "material": "layer"}
#: Field that the material of the first layer is called beside `layer`, the number of a layer.
FIRST_MATERIAL = "layers.1.material"
#: What a layer may have in a list -> its words.
OF_A_LAYER = {
    "h": "thickness of layer {}",
    "n": "ratio of the reduced moduli of layer {} and half-space",
    "nu": "Poisson ratio of layer {}",
    "bonding": "interface below layer {}",
    "cn": "normal compliance of the interface below layer {}",
    "ct": "tangential compliance of the interface below layer {}",
    "profile": "profile of the modulus of layer {} from its top to its bottom",
    "n_bottom": "ratio of the reduced moduli of the bottom of layer {} and half-space",
    "nu_bottom": "Poisson ratio of the bottom of layer {}",
    "E1": "Young's modulus of layer {}",
    "E1_bottom": "Young's modulus of the bottom of layer {}",
    "material": "material of layer {}",
    "Y": "yield strength of layer {}",
}
_SYMBOLS = {"h": "h", "n": "n", "nu": "ν", "cn": "cn", "ct": "ct", "n_bottom": "n", "nu_bottom": "ν", "Y": "Y"}


def name_in_stack(number: int, field: str) -> str:
    """The name of an input of a layer, `number` from 1 at the surface."""
    return full_name(number, field, FIRST_LAYER)


@cache
def _of_layers() -> tuple[dict[str, Entry], dict[str, Entry], dict[str, tuple]]:
    """The rows of VOCABULARY, SCENE and BODIES for the inputs of layers, which have names such as "layers.2.h"."""
    rows, scene, bodies = {}, {}, {}
    for number in range(1, MOST + 1):
        for field, words in OF_A_LAYER.items():
            name = name_in_stack(number, field)
            if name.startswith("layers.") and field in LAYER:
                symbol = f"{_SYMBOLS[field]}l{number}" if field in _SYMBOLS else ""  # ν2 belongs to the body
                powers = LAYER[field].powers
                rows[name] = Entry(name, "material", words.format(number), symbol, powers)
            elif name.startswith("layers.") and field != "material":
                scene[name] = Entry(name, "scene", words.format(number), f"El{number}", (1, 0))
        if number > 1:
            body = name_in_stack(number, "material")
            bodies[body] = tuple(name_in_stack(number, field) for field in ("E1", "nu", "n"))
    rows["sublayers"] = Entry("sublayers", "material", "number of sublayers of a graded layer, 0: chosen")
    return rows, scene, bodies


def _follows(place: int):
    """The function of a name that gives its row in a table, for `NamedRows.further`."""
    return lambda name: _of_layers()[place].get(name) if is_of_layers(name) else None


def is_of_layers(name: object) -> bool:
    """Whether a name can be that of an input of a layer of a stack."""
    return isinstance(name, str) and name.startswith(("layers.", "sublayers"))


SCENE = NamedRows(entries({"scene": _TABLES.pop("scene")}), _follows(1))
"""Inputs of a study with units that are no parameters of the solver. These parameters follow from them."""
VOCABULARY = NamedRows(entries(_TABLES), _follows(0))
"""Parameters, results and coordinates. A `Lexicon` also has the parameters of users' laws and shapes."""
ROWS = ChainMap(VOCABULARY, SCENE)
"""Rows of SCENE and VOCABULARY."""
#: Body -> names of its modulus and Poisson ratio, and of the ratio of moduli that follows from them.
#: `bodies_of` adds those of a stack below the first.
BODIES = NamedRows(
    {"punch": ("E_punch", "nu_punch", "m"), "layer": ("E1", "nu1", "n"), "body": ("E2", "nu2", "")}, _follows(2)
)


def _layers_in(names) -> int:
    """The number of layers, from the names of inputs; 0 without a stack."""
    words = [name for name in names if is_of_layers(name)]
    numbers = [name.split(".")[1] for name in words if name.startswith("layers.")]
    return min(max((int(number) for number in numbers if number.isdigit()), default=int(bool(words))), MOST)


def parameters_of_layers(names) -> tuple[str, ...]:
    """Names of the parameters of the layers of a stack that the `names` of inputs mention; () without a stack."""
    return _of_count(_layers_in(names))


@cache
def _of_count(count: int) -> tuple[str, ...]:
    words = [name for name in _of_layers()[0] if name != "sublayers" and int(name.split(".")[1]) <= count]
    return (*words, "sublayers") if count else ()


def scene_of(names) -> list[str]:
    """Names of SCENE, also for the layers that the `names` of inputs mention."""
    count = _layers_in(names)
    return [*SCENE, *(name for name in _of_layers()[1] if int(name.split(".")[1]) <= count)] if count else [*SCENE]


def bodies_of(names) -> dict[str, tuple[str, str, str]]:
    """BODIES, also for the layers that the `names` of inputs mention."""
    count = _layers_in(names)
    return BODIES | {f"layers.{i}.material": BODIES[f"layers.{i}.material"] for i in range(2, count + 1)}


_NOT_THERE = tomllib.loads((files(__package__) / "not_there.toml").read_text(encoding="utf-8"))
_RESULT, _LINE = (_NOT_THERE[section]["says"] for section in ("results", "line"))


def names(*roles: str) -> tuple[str, ...]:
    """Names that have one of the roles, in the order of the table; without the parameters of laws of users.

    Parameters
    ----------
    roles : "control", "material", "shape", "adhesion", "roughness", "numerics", "result", "pull_off", "derived",
        "coordinate"

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> names("control")
    ('P', 'a', 'D')
    """
    return tuple(name for role, table in _TABLES.items() if role in roles for name in table)


CONTROLS = names("control")
NUMERICS = names("numerics")
OF_PARAMETERS = ("control", "material", "shape", "adhesion", "roughness", "numerics")
"""Roles of parameters."""


class Names(tuple):
    """Names of parameters. It contains the names of layers, such as "layers.2.h", but does not list them: see
    `Lexicon.parameters_of`."""

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or is_of_layers(name) and name in VOCABULARY


PARAMETERS = Names(names(*OF_PARAMETERS))
"""Names of the parameters of this package."""


def attributes(name: str, rigid: bool = False, rows: Mapping[str, Entry] = VOCABULARY) -> dict:
    """CF attributes of a dimensionless variable: long_name, and where they apply symbol, scale, equation.

    The long_name ends with the label for the axis of a plot, "thickness of the layer, h/R". There are no units: CF
    wants none for a pure number, and xarray would write "[1]" after every label.

    rigid : of layers on a rigid base, where E1* is the unit of moduli
    rows : of a vocabulary that has the name
    """
    entry = rows[name]
    words = ", ".join(filter(None, (entry.long_name, entry.ratio)))
    texts = {"long_name": words, "symbol": entry.symbol, "scale": entry.scale, "equation": entry.equation}
    return {key: text.replace("E2*", "E1*") if rigid else text for key, text in texts.items() if text}


def allowed(parameter: Parameter) -> str:
    """The condition on the values of a parameter, as the end of a message: "must be > 0"."""
    if parameter.choices:
        words = [f'"{choice}"' for choice in parameter.choices if not choice.startswith(("table:", "scan:"))]
        words += ['or "table:FILE.csv"'] * bool({"paraboloid", "uniform", "disc_cell"} & {*parameter.choices})
        return "must be one of " + ", ".join(words)
    low, high = parameter.interval[1:-1].split(", ")
    if high == "inf":
        return f"must be {'>' if parameter.interval[0] == '(' else '>='} {low}"
    return f"must be {''.join(f'{value} or ' for value in parameter.also)}in {parameter.interval}"


def check(parameter: Parameter, value) -> str:
    """The mistake in one value of a parameter: "" or a text such as "must be > 0"."""
    if parameter.choices:
        table = str(value).removeprefix("Table:")
        hint = f'; a table of your own is "table:{table}"' * table.endswith(".csv")
        hint += f"; {_LINE}" * ("paraboloid" in parameter.choices and absent(str(value)) == _LINE)
        return "" if isinstance(value, str) and value in parameter.choices else allowed(parameter) + hint
    endless = parameter.interval.endswith("inf]")
    if not finite(value) and not (endless and value == math.inf):
        return f"must be a finite number, {allowed(parameter).removeprefix('must be ')}" + ', or "rigid"' * endless
    if parameter.whole and value != int(value):
        return "must be a whole number"
    return "" if are_within(parameter, float(value)).all() else allowed(parameter)  # float: a Decimal may trap it


def finite(value) -> bool:
    """Whether a value is a finite real number that a float can hold; True and False are not numbers here."""
    try:
        number = isinstance(value, (numbers.Real, Decimal)) and not isinstance(value, bool)
        return number and math.isfinite(float(value))
    except (OverflowError, ValueError):  # ValueError: of a signalling NaN
        return False


def no_parameter(name: str, words, place: str = "") -> str:
    """The message about a name that is no parameter. It tells what the model has instead, or a similar name.

    words : names that may be proposed; place : what stands before the name, such as "[model] "
    """
    words, hint = list(words), absent(name)
    if hint == _RESULT:
        search = "solve for P, or another input, by study.design or roughcoat design (docs/design.md)"
        hint += f"\n    to reach a wanted {name}: {search}"
    like = [other for other in words if other[0].lower() == str(name)[:1].lower()]  # Er, say, is no R
    near = suggest(name, like, words)
    return f"{place}{shown(str(name))} is not a parameter{f'; {hint}' if hint else near}"


def absent(name: str) -> str:
    """The sentence of not_there.toml about a name that is no parameter, perhaps a result; "" if it has none.

    The whole name is looked up first, then its parts, as in "friction_coeff" and "E_film". If the file has several of
    the parts, the first one in the file counts.
    """
    name = str(name)[:LONGEST]
    if name in PARAMETERS or name in SCENE:
        return ""
    says = _ABSENT | {word: _RESULT for word in names("result", "derived") if word not in _ABSENT}
    whole = (name, _as_word(name), _as_word(re.sub(r"[\d*']", "", name)))
    first, *others = re.split(r"[\s_.*-]+", name)
    parts = [re.sub(r"\d+$", "", first)] * bool(others) + [_as_word(word) for word in (first, *others) if len(word) > 2]
    texts = [says[word] for word in whole if word in says] or [text for word, text in says.items() if word in parts]
    return next(iter(texts), "")


def _as_word(name: str) -> str:
    """A name in small letters, without blanks, "_" and "-"; a name of one or two letters as it is."""
    return re.sub(r"[\s_-]", "", name).lower() if len(name) > 2 else name


_ABSENT = {_as_word(word): entry["says"] for entry in _NOT_THERE.values() for word in entry["words"]}


def suggest(word: str, words, listed=None) -> str:
    """The end of a message: '; did you mean "Nbar"?' if a word is similar, otherwise the words, or `listed`."""
    lower = {name.lower(): name for name in words}
    near = difflib.get_close_matches(str(word).lower()[:LONGEST], lower, n=1, cutoff=0.6)
    if near:
        return f'; did you mean "{lower[near[0]]}"?'
    listed = list(listed or words)
    return "; known: " + ", ".join(listed[:LISTED]) + f" and {len(listed) - LISTED} more" * (len(listed) > LISTED)
