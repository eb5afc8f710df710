"""Whether a contact holds, in words: the part closest to its limit, by what factor, and the load at which it fails."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from solver import Problem, solve
from solver.bases import is_bare
from solver.closed_forms import yield_pressure
from solver.shapes import ROUND
from solver.yields.below import central_spot
from solver.yields.below.central_spot import SPOT_EXTREMES
from solver.yields.contact import of_contacts
from solver.yields.extremes import EXTREMES
from solver.yields.similar.under_load import extremes_at, radius_under
from solver.yields.similar.unit_contacts import are_similar

from ..arrays import xarray_later as xr
from ..data.body_strengths import known_strengths, layer_strengths
from ..data.contacts import Contacts
from ..data.dataset import flag_words
from ..inputs.vocabulary import bodies_of
from ..rules.assumptions import FEW_SPOTS
from ..specimen import materials
from ..specimen.quantities import readable
from ..terminal import rounded
from .stated_inputs import is_rigid
from .stress_lines import at_asperities, below_spots, in_stacks, of_interfaces, strengths_of_layer

#: Modulus in Pa below which a material is a rubber or a gel (nearly always nu = 0.5), which tears and does not yield.
RUBBER = 1e8
#: Least thickness of a film over a: with thinner films the stresses take many seconds.
_THINNEST = 2e-3
#: Relative precision of the load at a limit, and number of contacts after which the search for it gives up.
_SAME, _MOST = 1e-3, 8
#: If a body is rubber or gel, nothing is said below this share of a strength.
_FAR = 0.01
#: Largest a/R of contacts on which something is said.
_WIDEST = 0.2
_THROUGH = "The layer is thin compared with the pitch: single spots press on the body through it, which is left out."
_SHAPE = "Not computed here for this shape: study.extremes gives the stresses, study.first_yield the loads."
_FILM = "The layer is so thin (h < 0.002 a) that its stresses take long to compute: study.extremes gives them"
_OWN_LAW = (
    "The law of the asperities does not give the stress below them: it is taken to be that below a sphere, "
    "(pmax - p(0))/{q:.3g}."
)
_SPOTS, _PUNCH = "of spots", "of the punch"


class _Limit(NamedTuple):
    """A part of the contact that may fail.

    who : words for the part, as a subject; what, of : words for its stress, and for its strength
    verb, ing : words for its failure, "yield" and "yielding"
    stress : name of the stress among the extremes; or _PUNCH, or _SPOTS
    strength, spread : in the unit of E2; NaN: not known
    needs : the input for its strength; "": nothing is said where the strength is not known
    hard : whether the strength is the hardness over 2.84
    """

    who: str
    verb: str
    ing: str
    what: str
    of: str
    stress: str
    strength: float
    spread: float
    needs: str
    hard: bool = False

    @property
    def plural(self) -> bool:
        return self.who == "the asperities"


class Margin(NamedTuple):
    """Sentences on the strengths of a contact, and whether one of them is exceeded."""

    sentences: list[str]
    exceeded: bool = False


class _Compared(NamedTuple):
    """A limit and the stress that it limits, with its place in a."""

    limit: _Limit
    stress: float
    r: float
    z: float

    @property
    def share(self) -> float:
        return self.stress / self.limit.strength


class _Looked(NamedTuple):
    """A contact with known stresses.

    problem, solution : at the radius of the contact
    compared : stresses with their limits, the closest first; lacking : stresses whose strength is not known
    hard : whether no body is rubber or gel
    """

    contact: Contacts
    problem: Problem
    solution: Any
    compared: list[_Compared]
    lacking: list[_Compared]
    hard: bool


def holds(case: xr.Dataset, contact: Contacts | None) -> Margin:
    """Sentences about one solved contact; none where its strengths are not known and it has no units, or where it
    cannot be solved again, without a `contact`."""
    looked = _looked_at(case, contact)
    if isinstance(looked, str):
        return Margin([looked] * bool(looked))
    compared, hard = looked.compared, looked.hard
    far = not compared or not hard and compared[0].share < _FAR
    sentences = [] if far else _closest(looked, case)
    if "pitch_not_small_against_h" in flag_words(case["validity"]).item().split() and not is_rigid(case, "base"):
        sentences = [*sentences, _THROUGH] if sentences else []
    sentences += _needed(looked.contact, looked.lacking) if looked.lacking and hard else []
    sentences += of_interfaces(looked.contact, looked.problem, looked.solution) if hard else []
    sentences = [*(_flowing(case) if sentences else []), *sentences, *_of_own_law(looked.contact, sentences)]
    return Margin(sentences, bool(compared) and compared[0].share > 1)


def closest(case: xr.Dataset) -> str:
    """The body or spots closest to their limit, and their share of it, as in "asperities 1.1"; "-": not known."""
    looked = _looked_at(case, Contacts.in_words(case)) if case["status"] == 0 else ""
    if isinstance(looked, str) or not looked.compared:
        return "-"
    limit = looked.compared[0].limit
    return f"{limit.who.removeprefix('the ')} {rounded(looked.compared[0].share)}"


def _looked_at(case: xr.Dataset, contact: Contacts | None) -> _Looked | str:
    """The stresses and limits of a contact, or the reason why they are not known; "" where nothing is to be said."""
    if contact is None:
        return ""
    strengths = {body: [column[0] for column in columns] for body, columns in known_strengths(contact, {}).items()}
    moduli = [case[name] for name, _, _ in bodies_of(case.variables).values() if name in case]
    moduli = [modulus for modulus in moduli if modulus.attrs.get("units") == "Pa"]
    hard = bool(moduli) and min(moduli) >= RUBBER
    values = [value for value, *_ in strengths.values()] + [value[0] for value, *_ in layer_strengths(contact, {})]
    if not (hard or np.isfinite(values).any()):
        return ""
    problem = contact.problem
    if reason := contact.without_stresses():
        return f"Not known: {reason}."
    if problem.shape[0] not in ROUND:
        return _SHAPE
    if not is_bare(problem.base[0]) and problem.h[0] < _THINNEST * _radius(contact):
        return _FILM + "."
    at_a = replace(problem, control="a", value=np.array([_radius(contact)]))
    solution, limits = solve(at_a), _limits(contact, strengths)
    stresses = [_Compared(*row) for row in _stresses(limits, at_a, solution, case) if np.isfinite(row[1])]
    compared = sorted((row for row in stresses if np.isfinite(row.limit.strength)), key=lambda row: -row.share)
    lacking = [row for row in stresses if np.isnan(row.limit.strength) and row.limit.needs]
    return _Looked(contact, at_a, solution, compared, lacking, hard)


def _stresses(limits: list[_Limit], problem: Problem, solution: Any, case: xr.Dataset) -> list[tuple]:
    """(limit, stress, r, z) of each limit, r and z in a. The stresses of all bodies are searched for together."""
    names = tuple(limit.stress for limit in limits if limit.stress in EXTREMES)
    if are_similar(problem, solution.a / problem.R)[0] and solution.status[0] == 0:
        return _of_similar(limits, problem, solution.a, case)
    stresses = of_contacts(problem, solution, names=names) if names else {}
    stresses |= in_stacks(problem, solution, [limit.stress for limit in limits])
    if any(limit.stress in SPOT_EXTREMES for limit in limits):
        below = central_spot.of_contacts(problem, solution)
        stresses |= {name: np.stack([value, 0 * value, z]) for name, (value, z) in below.items()}
    if any(limit.stress == _PUNCH for limit in limits):
        nu = np.array([_nu_punch(case)])
        stresses[_PUNCH] = of_contacts(problem, solution, names=("mises2",), punch=nu)["mises2"]
    if any(limit.stress == _SPOTS for limit in limits):
        stresses[_SPOTS] = below_spots(problem, solution)
    return [(limit, *stresses[limit.stress][:, 0].tolist()) for limit in limits]


def _of_similar(limits: list[_Limit], problem: Problem, a: np.ndarray, case: xr.Dataset) -> list[tuple]:
    """The same of a smooth contact on one layer at the radius a, which needs no tables of a mesh."""
    names = tuple(limit.stress for limit in limits if limit.stress in EXTREMES)
    stresses = extremes_at(problem, a, names) if names else {}
    if any(limit.stress == _PUNCH for limit in limits):
        stresses[_PUNCH] = extremes_at(problem, a, ("mises2",), np.array([_nu_punch(case)]))["mises2"]
    return [(limit, *stresses[limit.stress][:, 0].tolist()) for limit in limits]


def _nu_punch(case: xr.Dataset) -> float:
    return float(case["nu_punch"]) if "nu_punch" in case else 0.3


def _of_own_law(contact: Contacts, sentences: list[str]) -> list[str]:
    """A sentence on asperities for which only pmax is known, if other sentences are about them."""
    if np.isfinite(contact.problem.Ra[0]) or not any("asperities" in text for text in sentences):
        return []
    return [_OWN_LAW.format(q=float(yield_pressure(at_asperities(contact.problem)[1])[0]))]


def _flowing(case: xr.Dataset) -> list[str]:
    """A sentence on asperities whose law lets them yield."""
    if "plastic_share" not in case or not np.isfinite(case["plastic_share"]):
        return []
    share = 100 * float(case["plastic_share"])
    yielded = f"The asperities have yielded on {rounded(share)} % of the nominal contact area."
    return [yielded if share else "No asperity yields."]


def _radius(contact: Contacts) -> float:
    return float(contact.dataset["a"]) / contact.units[1].item()


def _limits(contact: Contacts, strengths: dict[str, list]) -> list[_Limit]:
    """The limits of a contact at which a part fails."""
    case, problem, limits = contact.dataset, contact.problem, []
    coated, mises, Y = not is_bare(problem.base[0]), "largest von Mises stress", "yield strength"

    def yields(who: str, stress: str, body: str, needs: str, what: str = mises) -> _Limit:
        value, spread, hard = strengths[body]
        return _Limit(who, "yield", "yielding", what, Y, stress, float(value), float(spread), needs, bool(hard))

    felt, below, unit = bool(problem.feels_layer()[0]), "below the asperities", contact.units[0].item()
    if layers := layer_strengths(contact, {}):
        for j, ([value], [spread], [hard]) in enumerate(layers, 1):
            rows = [(f"layer {j}", f"mises_layer {j}", mises, "yield", Y, value, spread, bool(hard))]
            for who, stress, what, verb, of, *numbers in rows + strengths_of_layer(case, j, unit):
                limits.append(_Limit(who, verb, f"{verb}ing", what, of, stress, *numbers[:2], "", numbers[2]))
    elif coated:
        limits.append(yields("the layer", "mises1", "layer", "Y1"))
        coating = _material(case, "layer")
        places = [
            ("the layer", "s1_layer", "largest tension", "fracture"),
            ("the interface", "tau_interface", "largest shear stress", "interface"),
        ]
        if felt:
            limits.append(yields(f"the layer {below}", "mises1_spot", "layer", ""))
            places.append((f"the layer {below}", "sr_interface1_spot", "radial tension", "fracture"))
            places.append((f"the interface {below}", "tau_interface_spot", "largest shear stress", "interface"))
        for who, stress, what, of in places:
            if strength := getattr(coating, f"{of}_strength", None):
                verb, name = ("crack", "fracture strength") if of == "fracture" else ("fail", "strength")
                spread = getattr(coating, f"{of}_strength_spread") / unit
                limits.append(_Limit(who, verb, f"{verb}ing", what, name, stress, strength / unit, spread, ""))
    if not is_rigid(case, "base"):
        limits.append(yields("the body", "mises2 0" if layers else "mises2", "body", "Y2"))
        limits += [yields(f"the body {below}", "mises2_spot", "body", "")] * (felt and not layers)
    if problem.m[0] > 0:
        limits.append(yields("the punch", _PUNCH, "punch", "Y_punch"))
    law = problem.known.laws[str(problem.micro[0])]
    if law.rough and not law.yielded:
        of_law = mises if np.isfinite(problem.Ra[0]) else "stress as of a sphere under pmax"
        limits.append(yields("the asperities", _SPOTS, "asperities", "hardness or yield_strength", of_law))
    return limits


def _material(case: xr.Dataset, body: str) -> Any:
    try:
        return materials.get(str(case[body].values)) if body in case else None
    except LookupError:  # a material of the user's file
        return None


def _part(share: float) -> str:
    return f"{rounded(share)} {'times' if share > 1 else 'of'}"


def _closest(looked: _Looked, case: xr.Dataset) -> list[str]:
    """Sentences on the closest limit, on the other limits, and on the load that reaches the closest."""
    contact, first, *others = looked.contact, *looked.compared
    limit, share = first.limit, first.share
    place = _place(contact, first.r, first.z, float(looked.problem.value[0])) if np.isfinite(first.z) else ""
    place = "" if limit.what.endswith("pmax") else f" {place}"
    value, strength = _with_unit(contact, first.stress), _with_unit(contact, limit.strength, spread=limit.spread)
    closest = f"{'are' if limit.plural else 'is'} closest to {limit.ing}"
    of = f"{_part(share)} the {limit.of}{' estimated from hardness' * limit.hard}, {strength}"
    verb = closest if share <= 1 else f"would {limit.verb}"
    sentences = [f"{limit.who} {verb}: the {limit.what}, {value}{place}, is {of}."]
    if others:
        parts = [(compared.limit, _part(compared.share)) for compared in others]
        texts = [f"{weak.who} at {part} {'their' if weak.plural else 'its'} {weak.of}" for weak, part in parts]
        sentences.append(f"Less close: {', '.join(texts)}.")
    return [_capital(text) for text in [*sentences, *_at_which_load(looked, first, case)]]


def _at_which_load(looked: _Looked, first: _Compared, case: xr.Dataset) -> list[str]:
    """Sentences on the load that reaches the limit, and on the number of asperities that touch then, if few."""
    limit, share, contact = first.limit, first.share, looked.contact
    failure = _load(looked, first, case)
    if failure is None:
        farther = f"No load up to a = 0.2 R was found that makes {limit.who} {limit.verb}."
        return [farther] * (share < 1)
    P, slope, solution = failure
    spread = P * slope * limit.spread / limit.strength
    text = f"P = {_with_unit(contact, P, 2, spread)}"
    who, verb, begin = limit.who, limit.verb, "begin" if limit.plural else "begins"
    if limit.stress != _SPOTS or not (touching := _spots_of(looked.problem, solution)) < FEW_SPOTS:
        return [f"At about {text} {who} {begin} to {verb}." if share > 1 else f"{who} would {verb} at about {text}."]
    E, nu = at_asperities(looked.problem)
    alone = (np.pi * limit.strength * yield_pressure(nu)[0]) ** 3 * looked.problem.Ra[0] ** 2 / (6 * E[0] ** 2)
    if abs(P / alone - 1) < 3 * _SAME:
        return [f"One asperity alone {'begins to yield' if share > 1 else 'would yield'} at about {text}."]
    P_alone = _with_unit(contact, alone, 2, 3 * alone * limit.spread / limit.strength)
    where = f"{text}, where {rounded(touching)} of them touch; one asperity alone yields at about P = {P_alone}"
    return [f"They begin to yield at about {where}." if share > 1 else f"They would yield at about {where}."]


def _spots_of(problem: Problem, solution: Any) -> float:
    """The number of asperities that touch; NaN under a law without a density."""
    return float(problem.Nbar[0] * np.pi * solution.a[0] ** 2)


def _load(looked: _Looked, first: _Compared, case: xr.Dataset) -> tuple[float, float, Any] | None:
    """The load at which the stress reaches the strength, d ln P/d ln strength there, and the solution; by a secant
    method in logarithms that starts at the load of the contact. None if it fails."""
    problem, limit = looked.problem, first.limit
    P, value, slope = np.log(looked.solution.P[0]), np.log(first.share), 1 / 3
    similar = bool(are_similar(problem, np.array([_WIDEST]))[0])
    a, solution = looked.solution.a, looked.solution
    for _ in range(_MOST):
        step = float(np.clip(-value / slope, -3, 3))
        load = np.exp([P + step])
        if similar:
            a = radius_under(problem, load, a)
        else:
            at = replace(problem, control="P", value=load)
            solution = solve(at)
            a = solution.a
        if a[0] / problem.R[0] > _WIDEST and value < 0:
            return None
        stresses = _of_similar([limit], problem, a, case) if similar else _stresses([limit], at, solution, case)
        after = np.log(stresses[0][1] / limit.strength)
        if not np.isfinite(after):
            return None
        slope = max((after - value) / step, 0.05) if step else slope
        P, value = P + step, after
        if abs(value) < _SAME:
            return float(np.exp(P)), 1 / slope, solution
    return None


def _needed(contact: Contacts, lacking: list[_Compared]) -> list[str]:
    """A sentence on the strengths that are not known, and how large they must be for the contact to hold."""
    parts = [
        f"the strength of {limit.who}, which must be above {_with_unit(contact, stress)} ({limit.needs})"
        for limit, stress, *_ in lacking
    ]
    return [f"Not known: {'; '.join(parts)}."]


def _place(contact: Contacts, r: float, z: float, a: float) -> str:
    where = "on the axis" if abs(r) < 1e-3 else f"at r = {abs(r):.2g} a"
    if z == 0:
        return f"on the surface {where}" if abs(r) >= 1e-3 else "in the middle of the surface"
    deep = readable(float(f"{z * a * contact.units[1].item():.2g}"), "m") if contact.scene else f"{z * a:.2g} R"
    return f"{where} at a depth of {deep}"


def _with_unit(contact: Contacts, value: float, length: int = 0, spread: float = 0.0) -> str:
    """A stress as text, or a load with length = 2, with ± if it has a spread."""
    if not contact.scene:
        return f"{value:.2g} E2*{' R^2' * (length == 2)}"
    stress, size = (unit.item() for unit in contact.units)
    scale = stress * size**length
    unit = "N" if length else "Pa"
    if spread > 0:
        return readable(value * scale, unit, spread * scale)
    return readable(float(f"{value * scale:.2g}"), unit)


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]
