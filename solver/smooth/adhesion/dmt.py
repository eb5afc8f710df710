"""Adhesion of a paraboloid that acts only outside of the contact, after Derjaguin, Muller and Toporov.

The attraction of the undeformed profiles, 2π w R on any body, adds to the load, and the surfaces keep the shape that
they have without adhesion: P = P₀(a) - 2π w and D = D₀(a) with R = 1. Pull-off is at a = 0.
"""

from dataclasses import replace

import numpy as np

from ...status import Status
from ..galerkin import Response, respond
from ..radius import NEAR, Radii, guess, rising_root, touching
from ..state import Scales, State, answer


def solve(part, shape, body, k, x):
    """:class:`~...solution.Solution` of cases of one base with w > 0 and this law, in units R = E2* = 1; k (B,) is the
    stiffness of the machine that holds the punch."""
    pull = 2 * np.pi * part.w_adhesion
    without_pull = part.value + pull if part.control == "P" else part.value
    legal = (without_pull > 0) & ((part.branch == "stable") | (part.control == "a"))
    response, counts = touching(part.control, np.where(legal, without_pull, np.nan), shape, body)
    state = State.free(response)
    state = state._replace(P=state.P - pull, P_error=state.P_error + NEAR * pull)
    jumped = _jump(shape, body, pull, k)
    solution, tensile = answer(part, shape, state, counts, x, scales=Scales(P=pull))
    solution = solution.refused(legal & (tensile | np.isnan(state.P)), Status.LIFT_OFF)
    solution = solution.refused(~legal, Status.PULLED_OFF)
    pulls = {
        "P_off": -pull,
        "D_off": 0.0,
        "a_off": 0.0,
        "P_in": np.where(k == 0, 0.0, jumped.P - pull),
        "a_in": jumped.a,
    }
    pulls = {name: values + 0 * pull for name, values in pulls.items()}
    return replace(solution, **pulls, stable=np.isfinite(state.P), **{part.control: part.value})


def _jump(shape, body, pull, k):
    """The :class:`~..galerkin.Response` without adhesion for which D + (P - pull)/k = 0; its P and a are 0 where k is
    infinite."""
    radii, pieces = Radii(shape), []

    def evaluate(x, index):
        a, da = radii.at(x, index)
        response = respond(shape.take(index), body.take(index), a)
        pieces.append((index, response))
        moved = response.D * k[index] + response.P
        return np.log(moved / pull[index]), response.slope * (k[index] + response.S) * da / moved

    on_spring = np.isfinite(k)
    start = guess("P", np.where(on_spring, pull, np.nan), shape, body, radii)
    reached = np.isfinite(rising_root(evaluate, start)[0])
    response = Response.join(len(pull), pieces)
    P, a = (np.where(on_spring, np.where(reached, v, np.nan), 0.0) for v in (response.P, response.a))
    return response._replace(P=P, a=a)
