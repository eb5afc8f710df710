"""Places of a contact where the pressure falls while the load rises: there a law of yielding does not hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from solver import Status, solve
from solver.parameters import one_of
from solver.scaling import dimensionless, law_of

from ...again import Again
from ...arrays import xarray_later as xr
from ...inputs.definition import StudyError
from ...inputs.lexicon import lexicon_in
from ...rules.rule import of_cases

#: The load is lowered to this part; pressures that are larger there by less than _SAME of the largest are the same.
_LESS, _SAME = 0.9, 1e-6
#: Radii in a that are looked at.
_RADII = np.sin(np.linspace(0, np.pi / 2, 25))


def falling(contacts: xr.Dataset) -> list[str]:
    """A sentence on contacts whose asperities yield, and whose pressure somewhere was larger at 0.9 of the load."""
    laws = [name for name, law in lexicon_in(contacts).known.laws.items() if law.yielded]
    yielding = one_of(contacts["micro"].values.astype(str), laws)
    if not yielding.any():
        return []
    try:
        again = Again.of(contacts, "summary")
    except StudyError:  # of a mean, say
        return []
    solved = (contacts["status"].values.ravel() == Status.CONVERGED) & one_of(again.problem.micro, laws)
    where, index = np.zeros(len(solved), dtype=bool), np.flatnonzero(solved)
    if len(index):
        problem = again.problem.take(index)
        now = solve(problem, _RADII)
        before = solve(replace(problem, control="P", value=_LESS * now.P), _RADII)
        r = _RADII * (now.a / before.a)[:, None]
        p, lam = (
            np.array([np.interp(at, _RADII, own, right=0.0) for at, own in zip(r, profile, strict=True)])
            for profile in (before.p, before.lam)
        )
        yielded = np.empty(len(index))
        for name in np.unique(problem.micro):
            some = np.flatnonzero(problem.micro == name)
            law = law_of(dimensionless(problem.take(some)))
            yielded[some] = np.ravel(law.law.yielded(*law.own))
        falls = p > now.p + _SAME * now.p.max(axis=1, keepdims=True)
        where[index] = (falls & (lam > yielded[:, None])).any(axis=1)
    text = "The pressure falls somewhere while the load rises: spots that have yielded there unload, and stay flatter \
than this law has them."
    return [of_cases(where) + text] * bool(where.any())
