"""Estimates of contacts before they are solved: whether they are far outside the model's validity."""

from __future__ import annotations

import numpy as np

from solver.bases import may_be_layered
from solver.known import Known
from solver.models.estimate import estimate

from ..data.dataset import validity_of_rows
from ..inputs.definition import Definition
from ..inputs.grid import along, columns
from ..inputs.lexicon import lexicon_of
from ..rules.rule import RULES, broken, have

#: A contact is far outside if it exceeds the limit of an assumption this many times. The estimate is right to about
#: that factor: of 300 random contacts beyond no limit it takes none for far outside, and of 300 that exceed one 50
#: times it finds all but a few (tests/physical/words/test_far_outside.py).
FAR = 10.0
#: Only contacts on layers softer than this against the body (n = E1*/E2*) are looked at: they may take seconds, the
#: more the softer the layer is. A choice, for the time falls evenly as n rises.
SOFT = 0.1
MOST = 100  # contacts of a grid that are looked at, evenly spread: so few that it is not noticed
SAID = f"far outside what the model describes: an estimate exceeds limits {FAR:g} times and more. It may take long."


class FarOutside(UserWarning):
    """Said before anything is solved."""


def far_outside(definition: Definition) -> list[str]:
    """A sentence for each assumption that at least half of the contacts of a study violate FAR times over, by an
    estimate; below a first one that says so. [] of most studies.

    Only rough contacts on soft exact layers are looked at, of studies with units: others are solved at once, or not
    judged.
    """
    grid = definition.grid
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
