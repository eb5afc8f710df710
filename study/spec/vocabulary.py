"""The only table of names: what every parameter and result is called, measured in, allowed to be and printed as."""

import difflib
import math
import numbers
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solver.parameters import CONTROL, Parameter, among
from solver.parameters import PARAMETERS as SOLVER_PARAMETERS
from solver.parameters import allowed as are_within

INTEGERS = {"status": "int8", "model_used": "int8", "iterations": "int32", "nodes_used": "int16"}
"""Results that are whole numbers -> the type in which they are stored."""
NOT_RUN = 127
"""Value of `status` for a case that was never computed (the solver's own statuses are 0, 1, 2, ...)."""

SI = {(0, 0): "1", (0, 1): "m", (0, 2): "m^2", (0, -2): "1/m^2", (1, 0): "Pa", (1, 1): "N/m", (1, 2): "N"}
"""SI units by their powers of E2* and R; all others are written as powers of Pa and m."""


def si_unit(powers: tuple[int, int]) -> str:
    """The SI unit of E2*^i R^j, (i, j) = `powers`."""
    return SI.get(powers, "Pa^{} m^{}".format(*powers))


@dataclass(frozen=True)
class Entry:
    """A row of the vocabulary: one parameter, result or coordinate.

    powers : (i, j): the dimensionless number times E2*^i R^j is the physical quantity
    interval : of a parameter that has narrower bounds in a study than in the solver
    """

    name: str
    symbol: str
    long_name: str
    role: str
    powers: tuple[int, int] = (0, 0)
    equation: str = ""
    interval: str = ""

    @property
    def own(self) -> Parameter:
        """The row of a parameter in the solver's table: bounds, choices, default, which cases need it."""
        known = CONTROL.get(self.name) or SOLVER_PARAMETERS.get(self.name) or Parameter()
        return known._replace(interval=self.interval) if self.interval else known

    @cached_property
    def unit(self) -> str:
        """The SI unit of the physical quantity."""
        return si_unit(self.powers)

    @cached_property
    def ratio(self) -> str:
        """The symbol over its scale, as on the axis of a plot: "h/R", "P/(E2* R^2)"; empty without a symbol."""
        return over_scale(self.symbol, self.powers) if self.symbol else ""

    @cached_property
    def scale(self) -> str:
        """The scale in words, such as "E2* R^2"; empty for a pure number."""
        parts = [(s, e) for s, e in zip(("E2*", "R"), self.powers, strict=True) if e]
        return " ".join(s if e == 1 else f"{s}^{e}" for s, e in parts)


def over_scale(symbol: str, powers: tuple[int, int], scales: tuple[str, str] = ("E2*", "R"), gap: str = " ") -> str:
    """A symbol over its scale E2*^i R^j: "(dP/dD)/(E2* R)", "N̄ R^2".

    powers : (i, j); scales : how E2* and R are written; gap : what is written between two factors
    """
    over, times = [], []
    for word, power in zip(scales, powers, strict=True):
        if power:
            (over if power > 0 else times).append(word + f"^{abs(power)}" * (abs(power) > 1))
    text = gap.join([f"({symbol})" if "/" in symbol and over else symbol, *times])
    below = gap.join(over)
    return text + (f"/({below})" if len(over) > 1 else f"/{below}" if over else "")


LISTED = 40  # most names that a message lists

# fmt: off
_ENTRIES = (
    Entry("P", "P", "load", "control", (1, 2), equation="(5)"),
    Entry("a", "a", "radius of the nominal contact area", "control", (0, 1), equation="(4)"),
    Entry("D", "D", "indentation depth", "control", (0, 1), equation="(14)"),
    Entry("h", "h", "thickness of the layer", "material", (0, 1)),
    Entry("n", "n", "ratio of the reduced moduli of layer and half-space", "material"),
    Entry("m", "m", "ratio of the reduced moduli of layer and punch, 0: rigid", "material"),
    Entry("nu1", "ν1", "Poisson ratio of the layer", "material"),
    Entry("nu2", "ν2", "Poisson ratio of the half-space", "material"),
    Entry("bonding", "", "interface of layer and half-space", "material"),
    Entry("base", "", "elastic base", "material"),
    Entry("Nbar", "N̄", "number of asperities per unit area", "roughness", (0, -2)),
    Entry("Ra", "Ra", "radius of an asperity", "roughness", (0, 1)),
    Entry("micro", "", "micro law A[p]", "roughness", equation="(6), (7)"),
    Entry("B", "B", "coefficient of the power law A = B p^β, in Ra/E1*^β", "roughness"),
    Entry("beta", "β", "exponent of the power law A = B p^β", "roughness"),
    Entry("sigma", "σ", "standard deviation of the heights of the asperities", "roughness", (0, 1)),
    Entry("cut", "c", "largest height of an asperity above the mean, over σ", "roughness"),
    Entry("scheme", "", "scheme of solution", "numerics"),
    Entry("k", "k", "iteration parameter of the successive approximations", "numerics", equation="(8)"),
    Entry("rtol", "", "wanted relative error", "numerics", interval="[1e-12, 0.1]"),
    Entry("accuracy", "", "allowed relative model error of the base auto", "numerics"),
    Entry("model_check", "", "how the model error of a named thin layer is estimated", "numerics"),
    Entry("nodes", "", "number of nodes, 0: chosen by rtol", "numerics"),
    Entry("max_iterations", "", "largest number of iterations, 0: the scheme's own", "numerics"),
    Entry("p0", "p(0)", "nominal pressure in the centre", "result", (1, 0), equation="(3)"),
    Entry("p_max", "pmax", "real pressure in the middle of the central spot", "result", (1, 0), equation="(13)"),
    Entry("Ar_An", "Ar/An", "real over nominal contact area", "result", equation="(12)"),
    Entry("A0", "A[p(0)]", "additional displacement of the rough layer in the centre", "result", (0, 1),
          equation="(6)"),
    Entry("dP_dD", "dP/dD", "contact stiffness", "result", (1, 1)),
    Entry("lam0", "λ(0)", "relative contact area in the centre", "result", equation="(11)"),
    Entry("p", "p(r)", "nominal contact pressure", "profile", (1, 0), equation="(3)"),
    Entry("lam", "λ(r)", "relative contact area", "profile", equation="(11)"),
    Entry("status", "", "how the solution of the case ended", "flag"),
    Entry("error", "", "estimated relative error of a, P, D, p(0), pmax and Ar/An", "result"),
    Entry("profile_error", "", "estimated error of the profiles of p and λ, over their largest values", "result"),
    Entry("model_error", "", "estimated relative error of the model used, against the exact layered one", "result"),
    Entry("model_used", "", "model that the case was solved with", "flag"),
    Entry("residual", "", "relative residual of the discrete equation", "result"),
    Entry("iterations", "", "number of iterations", "count"),
    Entry("nodes_used", "", "number of nodes used", "count"),
    Entry("validity", "", "assumptions of the model that the case violates; 0: none", "flag"),
    Entry("An", "An", "nominal contact area", "derived", (0, 2)),
    Entry("An_ratio", "An/(π a0²)", "nominal contact area over a reference area", "derived"),
    Entry("p_mean", "P/An", "mean nominal pressure", "derived", (1, 0)),
    Entry("spots", "N̄ An", "number of contact spots", "derived"),
    Entry("b0", "b(0)", "radius of the central contact spot", "derived", (0, 1), equation="(7)"),
    Entry("p_peak", "ppeak", "largest real pressure in the contact, wherever it is", "derived", (1, 0),
          equation="(13)"),
    Entry("E_eff", "Eeff", "effective reduced modulus (dP/dD)/(2a)", "derived", (1, 0)),
    Entry("x", "r/a", "radius over the radius of the nominal contact area", "coordinate"),
    Entry("case", "", "number of the case", "coordinate"),
    Entry("label", "", "label of the case", "coordinate"),
)
# fmt: on


VOCABULARY = {entry.name: entry for entry in _ENTRIES}


def names(*roles: str) -> tuple[str, ...]:
    """Names that have one of the roles, in the order of the table."""
    return tuple(entry.name for entry in _ENTRIES if entry.role in roles)


CONTROLS = names("control")
NUMERICS = names("numerics")
PARAMETERS = list(names("control", "material", "roughness", "numerics"))
"""Names of parameters; `study.spec.laws.update_vocabulary` adds those of registered laws here and to VOCABULARY."""


def cases_with(name: str, values) -> np.ndarray:
    """bool: the cases that have a parameter; `values(other)` gives the texts of another one, on which that depends."""
    return among(VOCABULARY[name].own.needed_by, values)


def matters(name: str, values) -> bool:
    """Whether the answer of some case may depend on a parameter; `values` as in `cases_with`."""
    own = VOCABULARY[name].own
    return all(np.any(among(condition, values)) for condition in (own.needed_by, own.used_by))


def attributes(name: str, rigid: bool = False) -> dict:
    """CF attributes of a dimensionless variable: long_name, and where they apply symbol, scale, equation.

    The long_name ends with what stands on the axis of a plot, "thickness of the layer, h/R". There are no units: CF
    wants none of a pure number, and xarray would write "[1]" behind every label.

    rigid : of layers on a rigid base, where E1* is the unit of moduli
    """
    entry = VOCABULARY[name]
    words = ", ".join(filter(None, (entry.long_name, entry.ratio)))
    found = {"long_name": words, "symbol": entry.symbol, "scale": entry.scale, "equation": entry.equation}
    if rigid:
        found = {key: text.replace("E2*", "E1*") for key, text in found.items()}
    return {key: text for key, text in found.items() if text}


def allowed(own: Parameter) -> str:
    """What the values of a parameter must be, as the end of a message: "must be > 0"."""
    if own.choices:
        return "must be one of " + ", ".join(f'"{choice}"' for choice in own.choices)
    low, high = own.interval[1:-1].split(", ")
    if high == "inf":
        return f"must be {'>' if own.interval[0] == '(' else '>='} {low}"
    either = "".join(f"{value} or " for value in own.also)
    return f"must be {either}in {own.interval}"


def check(own: Parameter, value) -> str:
    """What is wrong with one value of a parameter: "" or a text such as "must be > 0"."""
    if own.choices:
        table = value.removeprefix("Table:") if isinstance(value, str) and value.endswith(".csv") else ""
        hint = f'; a table of your own is "table:{table}"' * bool(table)
        return "" if isinstance(value, str) and value in own.choices else allowed(own) + hint
    if not finite(value):
        return f"must be a finite number, {allowed(own).removeprefix('must be ')}"
    if own.whole and value != int(value):
        return "must be a whole number"
    return "" if are_within(own, value).all() else allowed(own)


def finite(value) -> bool:
    """Whether a value is a finite real number that a float can hold; True and False are not numbers here."""
    try:
        return isinstance(value, numbers.Real) and not isinstance(value, bool) and math.isfinite(float(value))
    except OverflowError:
        return False


def instead(name: str, known) -> str:
    """The end of a message about a name that is no parameter."""
    return "; of the results P, a or D may be given" if name in names("result") else suggest(name, known)


def suggest(word: str, known) -> str:
    """The end of a message: '; did you mean "Nbar"?' when a known word is near, otherwise what is known."""
    lower = {name.lower(): name for name in known}
    near = difflib.get_close_matches(str(word).lower()[:100], lower, n=1, cutoff=0.6)
    if near:
        return f'; did you mean "{lower[near[0]]}"?'
    listed = list(known)
    return "; known: " + ", ".join(listed[:LISTED]) + (f" and {len(listed) - LISTED} more" * (len(listed) > LISTED))
