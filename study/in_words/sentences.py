"""Sentences about contacts: before they are solved, whether they are far outside the model; afterwards, how well they
were solved, by which model, under which assumptions, and what the model leaves out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from solver import Status, solve
from solver.bases import is_bare, may_be_layered
from solver.known import Known
from solver.laws.cell.family import MOST as MOST_PITCH
from solver.laws.cell.family import REACH
from solver.models.estimate import estimate
from solver.models.law_error import last_fraction, without_family
from solver.parameters import one_of
from solver.scaling import dimensionless, law_of

from ..arrays import xarray_later as xr
from ..data.contacts import Contacts
from ..data.dataset import flag_words, validity_of_rows
from ..data.si import ASSUMED
from ..inputs.definition import Definition
from ..inputs.grid import along, columns
from ..inputs.lexicon import lexicon_in, lexicon_of
from ..inputs.punch.micro_laws import USED
from ..inputs.vocabulary import VOCABULARY, bodies_of
from ..rules import rule
from ..rules.rule import RULES, broken, have, of_cases
from ..terminal import rounded
from .influence import influence
from .margins import RUBBER, holds
from .notes import of_adhesion, of_scan, of_shape, presses_on, sticks, unit_of_length
from .pressures import largest_of_all
from .stress_lines import which_yields

#: A contact is far outside the model if it exceeds the limit of an assumption by this factor. The estimate is right to
#: about the same factor: among 300 random contacts within all limits it puts none far outside, and among 300 that
#: exceed a limit 50 times it finds all except a few (tests/physical/words/test_far_outside.py).
FAR = 10.0
#: Largest n = E1*/E2* of the contacts that are judged: on such soft layers a contact may take seconds, more on softer
#: layers. This is a choice, since the time falls steadily as n rises.
SOFT = 0.1
MOST = 100  # number of contacts of a grid that are judged, evenly spread: few enough to take no noticeable time
FAR_OUT = f"far outside what the model describes: estimates exceed limits {FAR:g} times or more. Solving may take long."
_BASES = {
    "half_space": "a half-space",
    "layer_alone": "a half-space of the layer's material",
    "thin_layer": "the thin-layer equation",
    "layered": "the exact layered half-space",
    "stack": "the exact stack of layers",
    "thin_stack": "the thin-layer equation of the stack of layers",
}
MODELS = {base: f"{words} under the asperities" for base, words in _BASES.items()}
MODELS |= {f"smooth_{base}": f"{words}, without asperities" for base, words in _BASES.items()}
EXCEEDED = "None of the assumptions that `validity` checks is violated, except that a strength is exceeded, as follows."
NOT_VIOLATED = "None of the checked assumptions is violated (docs/model.md, Four answers)."
#: Follows a model with asperities.
WHOSE = " The asperities belong to the punch. A rough surface under a polished punch is the same contact; if both \
surfaces are rough, their heights add up (docs/model.md, Elastic punch)."
SLIDES = 'The layer slides on the body without friction because bonding is not given. A deposited or glued layer does \
not slide, and a soft one is then much stiffer: give bonding = "bonded".'

#: A law that ends below this share of the largest contact fraction ends because the disc cell goes wrong.
_WHOLE_RANGE = 0.999
_WIDE_PITCH = (
    f"The pitch of the asperities is above {MOST_PITCH:g} h, where the effect of the layer on them is not known"
)
_MERGED = (
    f"The spots cover more than {REACH:g} of the area in the centre, or in a ring, and are no longer circles: the \
law of asperities on the coated body ends there"
)
_HALF_SPACE = 'asperities_on = "half_space" gives numbers, for a half-space of the layer\'s material.'
#: The load is reduced to this share. Pressures that grow by less than _SAME of the largest count as unchanged.
_LESS, _SAME = 0.9, 1e-6
#: Radii in a at which the pressure is examined.
_RADII = np.sin(np.linspace(0, np.pi / 2, 25))


class FarOutside(UserWarning):
    """A warning before contacts far outside the model are solved."""


def far_outside(definition: Definition) -> list[str]:
    """A sentence for each assumption that at least half of the contacts of a study exceed by FAR, by an estimate, after
    a first sentence that says so. [] for most studies.

    Only rough contacts on soft exact layers, in studies with units, are judged: others are solved quickly, or cannot be
    judged.
    """
    grid = definition.grid
    if definition.scans:  # nothing can be estimated without their laws
        return []
    slow = may_be_layered(along(grid, "base")) & have("rough", along(grid, "micro"), grid.lexicon.known)
    slow = slow & (along(grid, "n") < SOFT)
    if not (definition.scene and slow.any()):
        return []
    index = np.arange(grid.size)[:: -(-grid.size // MOST)]
    looked_at = index[np.broadcast_to(slow, grid.shape).ravel()[index]]
    far = _exceeded(columns(grid, looked_at), grid.lexicon.known) if len(looked_at) else {}
    assumptions = [RULES[word].sentence for word, where in far.items() if 2 * where.sum() >= len(index)]
    who = "this contact is" if grid.size == 1 else "at least half of these contacts are"
    return [f"{who} {FAR_OUT}", *assumptions] if assumptions else []


def _exceeded(parameters: dict[str, np.ndarray], known: Known) -> dict[str, np.ndarray]:
    """Name of each assumption -> (n,) bool: the contact exceeds its limit by FAR, by an estimate."""
    size = len(parameters["micro"])
    unknown = {"status": np.zeros(size), "model_used": np.full(size, np.nan), "model_error": np.full(size, np.nan)}
    estimated = estimate(lexicon_of(known).problem(parameters))
    return broken(validity_of_rows(parameters | unknown | estimated, known, FAR))


def doubts(contact: xr.Dataset) -> list[str]:
    """A sentence for each assumption of the model that some cases violate, and for inputs that no real body has."""
    v = dict(contact.variables)  # arithmetic of DataArrays takes longer than solving a contact
    texts = rule.sentences(v | (largest_of_all(contact) if v["p_max"].attrs.get("units") == "Pa" else {}))
    yields = rule.RULES["body_yields"].sentence
    texts = [f"{text} {which_yields(contact)}".rstrip() if text.endswith(yields) else text for text in texts]
    return texts + beside_rules(contact)


def beside_rules(contact: xr.Dataset) -> list[str]:
    """Sentences on contacts in addition to those of the rules, which cannot solve a contact again."""
    return falling(contact) + ended(contact)


def ended(contacts: xr.Dataset) -> list[str]:
    """Sentences on contacts at pressures that the law of asperities on their bodies does not know, and the way out."""
    if "asperities_used" not in contacts:
        return []
    outside = (contacts["status"].values == Status.OUTSIDE_LAW) & (
        contacts["asperities_used"].values == USED.index("layer")
    )
    if not outside.any():
        return []
    if (solvable := Contacts.in_words(contacts)) is None:
        return []
    problem = solvable.problem
    index, last = np.flatnonzero(outside), np.full(outside.shape, np.nan)
    part, far = problem.take(index), np.zeros_like(outside)
    last.flat[index], far.flat[index] = last_fraction(part), without_family(part)
    fails = outside & ~far & (last < _WHOLE_RANGE * REACH)
    texts = []
    if fails.any():
        text = f"On a layer this soft the disc cell fails where spots cover more than {rounded(last[fails].min())}"
        texts.append(f'{of_cases(fails)}{text} of the area; micro = "hex_lattice" holds up to {REACH:g}.')
    for where, text in ((far, _WIDE_PITCH), (outside & ~far & ~fails, _MERGED)):
        texts += [f"{of_cases(where)}{text}; {_HALF_SPACE}"] * bool(where.any())
    return texts


def falling(contacts: xr.Dataset) -> list[str]:
    """A sentence on contacts whose asperities yield, and whose pressure somewhere was larger at 0.9 of the load."""
    laws = [name for name, law in lexicon_in(contacts).known.laws.items() if law.yielded]
    yielding = one_of(contacts["micro"].values.astype(str), laws)
    if not yielding.any():
        return []
    if (solvable := Contacts.in_words(contacts)) is None:
        return []
    problems = solvable.problem
    solved = (contacts["status"].values.ravel() == Status.CONVERGED) & one_of(problems.micro, laws)
    where, index = np.zeros(len(solved), dtype=bool), np.flatnonzero(solved)
    if len(index):
        problem = problems.take(index)
        now = solve(problem, _RADII)
        before = solve(replace(problem, control="P", value=_LESS * now.P), _RADII)
        r = _RADII * (now.a / before.a)[:, None]
        p, lam = (
            np.array([np.interp(at, _RADII, values, right=0.0) for at, values in zip(r, profile, strict=True)])
            for profile in (before.p, before.lam)
        )
        yielded = np.empty(len(index))
        for name in np.unique(problem.micro):
            some = np.flatnonzero(problem.micro == name)
            law = law_of(dimensionless(problem.take(some)))
            yielded[some] = np.ravel(law.law.yielded(*law.own))
        falls = p > now.p + _SAME * now.p.max(axis=1, keepdims=True)
        where[index] = (falls & (lam > yielded[:, None])).any(axis=1)
    text = "The pressure falls somewhere while the load rises: spots that have yielded unload there and stay flatter \
than this law assumes."
    return [of_cases(where) + text] * bool(where.any())


def _near_0(case: xr.Dataset) -> str:
    """Words for the size to which an error is relative with adhesion, where a load or a depth may be 0."""
    names = [name for name in "PD" if abs(case[name]) < abs(case.get(f"{name}_off", 0.0))]
    return f" ({' and '.join(names)} relative to the size at pull-off)" * bool(names)


def sentences(case: xr.Dataset, judged: list[str]) -> list[str]:
    """Sentences on a case: how well it is solved, by which model, which assumptions it violates, whether it holds.

    judged : the displayed quantities whose largest error is `error`; p_max is among them if there are asperities
    """
    word, used = (flag_words(case[name]).item() for name in ("status", "model_used"))
    contact = Contacts.in_words(case) if word == "converged" else None
    if word == "converged":
        *first, last = (VOCABULARY[name].symbol for name in judged if np.isfinite(case[name]))
        of = f"{', '.join(first)} and {last}{_near_0(case)}"
        lines = [f"Solved: the estimated relative error of {of} is {float(case['error']):.1g}."]
        lines += [f"Spreads: {text}" for text in influence(case, contact, "p_max" if "p_max" in judged else "p0")]
    else:
        meanings = {status.name.lower(): status.meaning for status in Status}
        meaning = meanings.get(word, "the case has not been computed")
        lines = [f"NOT SOLVED ({word}): {meaning}."]
    model = MODELS.get(used)
    if model:
        error = float(case["model_error"])
        exact = used in ("half_space", "layered", "stack")  # then `model_error` is that of the micro law
        against = "the micro law itself errs" if exact else "against the exact layered contact it errs"
        errs = f"; {against} by about {rounded(100 * error)} %" if error > 0 else ""
        lines.append(f"Model: {model}{presses_on(case)}{errs}.{WHOSE * (not used.startswith('smooth'))}")
    lines += of_scan(case) + of_shape(case) + of_adhesion(case)
    warnings = doubts(case)
    lines += [f"Beware: {sentence}" for sentence in warnings]
    strength, exceeded = holds(case, contact) if word == "converged" else ([], False)
    lines += [EXCEEDED if exceeded else NOT_VIOLATED] * (not warnings and word == "converged")
    if word == "converged":
        lines += [f"Strength: {' '.join(strength)}"] * bool(strength)
        unchecked = ["adhesion"] * (not sticks(case)) + ["whether the bodies stay elastic"] * (not strength)
        lines += [f"Not checked (docs/model.md, Limits): {', and '.join(unchecked)}."] * bool(unchecked)
    return lines + [f"Assumed: {sentence}" for sentence in assumed(case)]


def assumed(case: xr.Dataset) -> list[str]:
    """A sentence for each input that was not given, if its default may be far from the true value."""
    v = case.variables
    defaults = {name for name in v if v[name].attrs.get("comment") == ASSUMED}
    lines = unit_of_length(case) + [SLIDES] * bool("bonding" in defaults and not is_bare(v["base"].item()))
    for modulus, ratio, _ in bodies_of(v).values():
        if ratio in defaults and modulus in v and v[modulus].attrs.get("units") == "Pa" and v[modulus] < RUBBER:
            lines.append(f"{ratio} = {v[ratio].item():g}. Rubbers and gels, as soft as this, have nearly 0.5.")
    return lines
