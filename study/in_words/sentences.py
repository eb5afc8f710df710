"""Sentences about contacts: before they are solved, whether they are far outside what the model describes; and then how
they were solved, by which model, what they rest on, and what is beyond the model."""

from __future__ import annotations

import numpy as np

from solver import Status
from solver.bases import is_bare, may_be_layered
from solver.known import Known
from solver.models.estimate import estimate

from ..arrays import xarray_later as xr
from ..data.dataset import flag_words, validity_of_rows
from ..data.si import ASSUMED
from ..inputs.definition import Definition
from ..inputs.grid import along, columns
from ..inputs.lexicon import lexicon_of
from ..inputs.vocabulary import VOCABULARY, bodies_of
from ..rules import rule
from ..rules.rule import RULES, broken, have
from ..terminal import rounded
from .influence import influence
from .margins import RUBBER, holds, which_yields
from .notes import ended, falling, of_adhesion, of_scan, of_shape, presses_on, sticks, unit_of_length
from .pressures import largest_of_all

#: A contact is far outside if it exceeds the limit of an assumption this many times. The estimate is right to about
#: that factor: of 300 random contacts beyond no limit it takes none for far outside, and of 300 that exceed one 50
#: times it finds all but a few (tests/physical/words/test_far_outside.py).
FAR = 10.0
#: Only contacts on layers softer than this against the body (n = E1*/E2*) are looked at: they may take seconds, the
#: more the softer the layer is. A choice, for the time falls evenly as n rises.
SOFT = 0.1
MOST = 100  # contacts of a grid that are looked at, evenly spread: so few that it is not noticed
SAID = f"far outside what the model describes: an estimate exceeds limits {FAR:g} times and more. It may take long."
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
NOT_VIOLATED = "None of the assumptions that are checked is violated (docs/model.md, Four answers)."
#: Behind a model with asperities.
WHOSE = " The asperities are the punch's; a rough surface under a polished punch is the same contact, and of two rough \
surfaces the sum counts (docs/model.md, Elastic punch)."
SLIDES = 'The layer slides on the body without friction, since bonding is not given. One that is deposited or glued on \
does not slide, and if it is soft it is then much stiffer: bonding = "bonded".'


class FarOutside(UserWarning):
    """Said before anything is solved."""


def far_outside(definition: Definition) -> list[str]:
    """A sentence for each assumption that at least half of the contacts of a study violate FAR times over, by an
    estimate; below a first one that says so. [] of most studies.

    Only rough contacts on soft exact layers are looked at, of studies with units: others are solved at once, or not
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
    found = [RULES[word].sentence for word, where in far.items() if 2 * where.sum() >= len(index)]
    who = "this contact is" if grid.size == 1 else "at least half of these contacts are"
    return [f"{who} {SAID}", *found] if found else []


def _exceeded(parameters: dict[str, np.ndarray], known: Known) -> dict[str, np.ndarray]:
    """Name of each assumption -> (n,) bool: the contact exceeds its limit FAR times, by an estimate."""
    size = len(parameters["micro"])
    unknown = {"status": np.zeros(size), "model_used": np.full(size, np.nan), "model_error": np.full(size, np.nan)}
    estimated = estimate(lexicon_of(known).problem(parameters))
    return broken(validity_of_rows(parameters | unknown | estimated, known, FAR))


def doubts(contact: xr.Dataset) -> list[str]:
    """A sentence for each assumption of the model that some cases violate, and for inputs that nothing real has."""
    v = dict(contact.variables)  # arithmetic of DataArrays takes longer than solving a contact
    found = rule.sentences(v | (largest_of_all(contact) if v["p_max"].attrs.get("units") == "Pa" else {}))
    yields = rule.RULES["body_yields"].sentence
    found = [f"{text} {which_yields(contact)}".rstrip() if text.endswith(yields) else text for text in found]
    return found + beside_rules(contact)


def beside_rules(contact: xr.Dataset) -> list[str]:
    """Sentences on contacts beside those of the rules, which see no problem that could be solved again."""
    return falling(contact) + ended(contact)


def _near_0(case: xr.Dataset) -> str:
    """The second size to which an error is relative: with adhesion a load or a depth may be 0."""
    names = [name for name in "PD" if abs(case[name]) < abs(case.get(f"{name}_off", 0.0))]
    return f" ({' and '.join(names)}: of the size at pull-off)" * bool(names)


def sentences(case: xr.Dataset, judged: list[str]) -> list[str]:
    """Sentences on a case: how well it is solved, by which model, which assumptions it violates, whether it holds.

    judged : the quantities shown of which `error` is the largest error; p_max is among them where there are asperities
    """
    word, used = (flag_words(case[name]).item() for name in ("status", "model_used"))
    if word == "converged":
        *first, last = (VOCABULARY[name].symbol for name in judged if np.isfinite(case[name]))
        within = f"{', '.join(first)} and {last} are within a relative {float(case['error']):.1g}"
        found = [f"Solved: {within} of the model's solution{_near_0(case)}."]
        found += [f"Spreads: {text}" for text in influence(case, "p_max" if "p_max" in judged else "p0")]
    else:
        known = {one.name.lower(): one.meaning for one in Status}
        meaning = known.get(word, "the case has not been computed")
        found = [f"NOT SOLVED ({word}): {meaning}."]
    model = MODELS.get(used)
    if model:
        error = float(case["model_error"])
        exact = used in ("half_space", "layered", "stack")  # then `model_error` is that of the micro law
        against = "the micro law itself errs" if exact else "against the exact layered contact it errs"
        errs = f"; {against} by about {rounded(100 * error)} %" if error > 0 else ""
        found.append(f"Model: {model}{presses_on(case)}{errs}.{WHOSE * (not used.startswith('smooth'))}")
    found += of_scan(case) + of_shape(case) + of_adhesion(case)
    beyond = doubts(case)
    found += [f"Beware: {sentence}" for sentence in beyond]
    strength, exceeded = holds(case) if word == "converged" else ([], False)
    found += [EXCEEDED if exceeded else NOT_VIOLATED] * (not beyond and word == "converged")
    if word == "converged":
        found += [f"Strength: {' '.join(strength)}"] * bool(strength)
        unchecked = ["adhesion"] * (not sticks(case)) + ["whether the bodies stay elastic"] * (not strength)
        found += [f"Not checked (docs/model.md, Limits): {', and '.join(unchecked)}."] * bool(unchecked)
    return found + [f"Assumed: {sentence}" for sentence in assumed(case)]


def assumed(case: xr.Dataset) -> list[str]:
    """A sentence for each default that stands for an input which was not given, and may be far from it."""
    v = case.variables
    taken = {name for name in v if v[name].attrs.get("comment") == ASSUMED}
    found = unit_of_length(case) + [SLIDES] * bool("bonding" in taken and not is_bare(v["base"].item()))
    for modulus, ratio, _ in bodies_of(v).values():
        if ratio in taken and modulus in v and v[modulus].attrs.get("units") == "Pa" and v[modulus] < RUBBER:
            found.append(f"{ratio} = {v[ratio].item():g}. Of rubbers and gels, as soft as this, it is nearly 0.5.")
    return found
