"""Whether a contact holds, in words: what is nearest to its limit, by what factor, and at which load it is there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from solver import Problem, solve
from solver.yields import spots
from solver.yields.contact import of_contacts

from ..again import Again, no_stresses, of_all_cases, strengths
from ..arrays import xarray_later as xr
from ..data.dataset import flag_words
from ..inputs.definition import StudyError
from ..inputs.punch.shapes import ROUND
from ..inputs.vocabulary import bodies_of
from ..specimen import materials
from ..specimen.quantities import readable
from .inputs import is_rigid

#: Below this modulus in Pa a material is a rubber or a gel, which tears and does not yield. Nearly all have a Poisson
#: ratio close to 0.5.
RUBBER = 1e8
#: Stresses of thinner films, in a, take many seconds.
_THINNEST = 2e-3
#: The load at a limit is found to this part, or not said after so many contacts.
_SAME, _MOST = 1e-3, 8
#: Beside rubber or gel nothing is said of what has less than this part of its strength.
_FAR = 0.01
#: Nothing is said of contacts wider than this, in R.
_WIDEST = 0.2
_THROUGH = "The layer is thin against the pitch: single spots press on the body through it, which is left out."
_SHAPE = "Not looked at under this shape: study.extremes computes the stresses, study.first_yield the loads."
_FILM = "The layer is so thin (h < 0.002 a) that its stresses take long: study.extremes computes them"


class _Limit(NamedTuple):
    """Something that may fail.

    who : words for it, as a subject; verb : what it does there
    what : words for its stress; of : words for its strength
    stress : of contacts, (Problem, Solution) -> (3, B), the stress, its r and z in a
    strength : in the unit of E2; NaN: not known
    needs : the input that is its strength; "": nothing is said where it is not known
    """

    who: str
    verb: str
    what: str
    of: str
    stress: Callable
    strength: float
    needs: str


def holds(case: xr.Dataset) -> list[str]:
    """Sentences about one contact that is solved; none where nothing is known of its strengths, and it has no units."""
    try:
        again = Again.of(case, "summary")
    except StudyError:  # of a mean, say
        return []
    known = {body: float(values[0]) for body, values in strengths(case, again, {}).items()}
    moduli = [case[name] for name, _, _ in bodies_of(case.variables).values() if name in case]
    moduli = [modulus for modulus in moduli if modulus.attrs.get("units") == "Pa"]
    hard = bool(moduli) and min(moduli) >= RUBBER
    if not (hard or np.isfinite(list(known.values())).any()):
        return []
    problem = again.problem
    if reason := no_stresses(again):
        return [f"Not known: {reason}."]
    if problem.shape[0] not in ROUND:
        return [_SHAPE]
    if problem.base[0] != "half_space" and problem.h[0] < _THINNEST * _radius(case, again):
        return [_FILM + "."]
    at_a = replace(problem, control="a", value=np.array([_radius(case, again)]))
    solution = solve(at_a)
    found = [(limit, *limit.stress(at_a, solution)[:, 0]) for limit in _limits(case, again, known)]
    found = [(limit, *numbers) for limit, *numbers in found if np.isfinite(numbers[0])]
    compared = [one for one in found if np.isfinite(one[0].strength)]
    compared.sort(key=lambda one: -one[1] / one[0].strength)
    far = not compared or not hard and compared[0][1] < _FAR * compared[0][0].strength
    said = [] if far else _nearest(again, at_a, solution, compared)
    if "pitch_not_small_against_h" in flag_words(case["validity"]).item().split() and not is_rigid(case, "base"):
        said = [*said, _THROUGH] if said else []
    lacking = [(limit, stress) for limit, stress, *_ in found if np.isnan(limit.strength) and limit.needs]
    return [*said, *_needed(again, lacking)] if lacking and hard else said


def which_yields(contacts: xr.Dataset) -> str:
    """Whether it is the layer or the body, of the contacts in which one of them yields."""
    flags = contacts["validity"].values.ravel() & 512
    try:
        again = Again.of(contacts, "summary")
    except StudyError:  # of a mean, say
        return ""
    some = np.flatnonzero(flags)
    problem = again.problem.take(some)
    stress, parts = of_contacts(problem, solve(problem), names=("mises1", "mises2")), []
    for who, name, limit in (("the layer", "mises1", "Y1"), ("the body", "mises2", "Y2")):
        count = int((stress[name][0] > problem.parameters[limit]).sum())
        parts += [f"in {count} it is {who}" if len(flags) > 1 else f"it is {who}"] * bool(count)
    return f"{_capital(', '.join(parts))}." if parts else ""


def _radius(case: xr.Dataset, again: Again) -> float:
    return float(case["a"]) / (float(again.scene.R) if again.scene else 1.0)


def _limits(case: xr.Dataset, again: Again, known: dict[str, float]) -> list[_Limit]:
    """What may fail in a contact, with the functions that give its stresses."""
    problem, limits = again.problem, []
    coated, mises, Y = problem.base[0] != "half_space", "largest von Mises stress", "yield strength"

    def extreme(name: str, punch: np.ndarray | None = None) -> Callable:
        return lambda problem, solution: of_contacts(problem, solution, names=(name,), punch=punch)[name]

    if coated:
        limits.append(_Limit("the layer", "yield", mises, Y, extreme("mises1"), known["layer"], "Y1"))
        coating = _material(case, "layer")
        unit = float(again.scene.unit) if again.scene else 1.0
        cracks, off = ((getattr(coating, f"{of}_strength", None) or np.nan) / unit for of in ("fracture", "interface"))
        limits += [
            _Limit("the layer", "crack", "largest tension", "fracture strength", extreme("s1_layer"), cracks, "")
        ]
        shear = "largest shear stress", "strength"
        limits += [_Limit("the interface", "fail", *shear, extreme("tau_interface"), off, "")]
    if not is_rigid(case, "base"):
        limits.append(_Limit("the body", "yield", mises, Y, extreme("mises2"), known["body"], "Y2"))
    if problem.m[0] > 0:
        nu = float(case["nu_punch"]) if "nu_punch" in case else 0.3
        own = extreme("mises2", np.array([nu]))
        limits.append(_Limit("the punch", "yield", mises, Y, own, known["punch"], "Y_punch"))
    if np.isfinite(problem.Nbar[0]) and problem.micro[0] not in ("smooth", "elastic_plastic"):
        what = known["asperities"], "hardness or yield_strength"
        limits.append(_Limit("what meets at the asperities", "yield", mises, Y, spots.of_contacts, *what))
    return limits


def _material(case: xr.Dataset, body: str) -> Any:
    try:
        return materials.get(str(case[body].values)) if body in case else None
    except LookupError:  # of a file of the user
        return None


def _part(share: float) -> str:
    return f"{share:.2g} {'times' if share > 1 else 'of'}"


def _nearest(again: Again, problem: Problem, solution: Any, compared: list) -> list[str]:
    """What is nearest to its limit, the others, and the load at which it would be there."""
    limit, stress, r, z = compared[0]
    share = stress / limit.strength
    place = _place(again, r, z, float(problem.value[0]))
    value, strength = _with_unit(again, stress), _with_unit(again, limit.strength)
    words = f"nearest to its limit is {limit.who}: the {limit.what}, {value} {place}, is {_part(share)} the {limit.of}"
    said = [f"{words}, {strength}."]
    if len(compared) > 1:
        rest = ", ".join(f"{one.who} {_part(value / one.strength)} its {one.of}" for one, value, *_ in compared[1:])
        said.append(f"Less near: {rest}.")
    load = _load(problem, solution, limit, share)
    if load is not None:
        text = f"P = {_with_unit(again, load, 2)}"
        who, verb = limit.who, limit.verb
        said.append(f"At about {text} {who} begins to {verb}." if share > 1 else f"{who} would {verb} at about {text}.")
    elif share < 1:
        said.append(f"No load up to a = 0.2 R makes {limit.who} {limit.verb}, as far as that was looked for.")
    return [_capital(text) for text in said]


def _load(problem: Problem, solution: Any, limit: _Limit, share: float) -> float | None:
    """The load at which the stress is the strength, near the one of the contact: by the secant in logarithms."""
    P, value, slope = np.log(solution.P[0]), np.log(share), 1 / 3
    for _ in range(_MOST):
        step = float(np.clip(-value / slope, -3, 3))
        at = replace(problem, control="P", value=np.exp([P + step]))
        there = solve(at)
        if there.a[0] > _WIDEST and value < 0:
            return None
        after = np.log(limit.stress(at, there)[0, 0] / limit.strength)
        if not np.isfinite(after):
            return None
        slope = max((after - value) / step, 0.05) if step else slope
        P, value = P + step, after
        if abs(value) < _SAME:
            return float(np.exp(P))
    return None


def _needed(again: Again, lacking: list) -> list[str]:
    """Which strengths would say more, and how large they must be for the contact to hold."""
    parts = [
        f"of {limit.who}, which needs above {_with_unit(again, stress)} ({limit.needs})" for limit, stress in lacking
    ]
    return [f"Not known {'; '.join(parts)}."]


def _place(again: Again, r: float, z: float, a: float) -> str:
    where = "on the axis" if abs(r) < 1e-3 else f"at r = {abs(r):.2g} a"
    if z == 0:
        return f"on the surface {where}" if abs(r) >= 1e-3 else "in the middle of the surface"
    deep = readable(float(f"{z * a * float(again.scene.R):.2g}"), "m") if again.scene else f"{z * a:.2g} R"
    return f"{where} {deep} deep"


def _with_unit(again: Again, value: float, length: int = 0) -> str:
    """A stress, or with length = 2 a load."""
    if not again.scene:
        return f"{value:.2g} E2*{' R^2' * (length == 2)}"
    scale = float(of_all_cases(again.scene.unit, (), ())[0]) * float(of_all_cases(again.scene.R, (), ())[0]) ** length
    return readable(float(f"{value * scale:.2g}"), "N" if length else "Pa")


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]
