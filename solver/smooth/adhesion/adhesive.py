"""Smooth contacts with adhesion: the solutions of a batch."""

from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ...numerics import batch
from ...shapes.shape import has_radius
from ...status import Status
from ..radius import guess
from ..state import Scales, State, answer, beyond_profile, pinned
from . import dmt
from .jkr import Jkr
from .machine import Holder, machine
from .maugis import Maugis, ring_pressure, ring_stress
from .pull import States, Turn, above_turn, below, highest, last_minimum

#: A load or depth whose relative difference to that of pull-off is at most _SAME counts as that of pull-off: users
#: return the pull-off that they got, with the rounding of a change of units.
_SAME = 64 * np.finfo(float).eps
#: Where the relative error of load and depth at pull-off is at least this, PULLED_OFF cannot be decided.
_UNKNOWN = 0.1
#: Errors of numbers that may be 0 are relative to at least this part of what adhesion takes from them.
_LEAST = 0.1


def solve(part, shape, body, x, ends=True):
    """:class:`~...solution.Solution` of cases with w > 0 of one base, one shape and one law of adhesion, in units R =
    E2* = 1, with profiles at the radii x (m,).

    ends : whether pull-off and pull-in are searched; else the contacts are given by their radii, and the numbers of
        both are 0
    """
    if str(part.adhesion[0]) == "dmt":
        return dmt.solve(part, shape, body, machine(part), x)
    law, every, ring = Jkr(shape, body, part.w_adhesion), np.arange(len(part)), None
    if str(part.adhesion[0]) == "maugis":
        law = Maugis(shape, body, part.w_adhesion, ring_stress(part))
    if has_radius(shape).all():
        return _flat(part, law, x)
    if not ends:
        return _at_radii(part, law, x)
    curve, at_turn = States(law), np.zeros(len(part), dtype=bool)
    search, counts = pulled(part, law)
    turn, jumped = search.turn, search.jumped
    if part.control == "a":
        state = law.at(part.value)
    else:
        place, at_turn = _place_of_control(part, curve, search)
        state = curve.at(place, every)[0]
    pulls = {"P_off": turn.state.P, "D_off": turn.state.D, "a_off": np.where(turn.at_axis, 0.0, turn.state.a)}
    pulls |= {"P_in": np.where(search.holder.load, 0.0, jumped.P), "a_in": jumped.a}
    off, scales = _off(turn.state), _scales(law, turn.state, state)
    if isinstance(law, Maugis):
        ring = partial(ring_pressure, part, state.zone)
    exact = _at_minimum(part, state, at_turn)
    solution = _answered(part, shape, exact, (pulls, off, scales), curve.counts + counts, x, ring)
    steep = at_turn & (part.control == "D") & ~turn.corner
    solution = replace(solution, dP_dD=np.where(steep, np.inf, np.where(at_turn, state.stiffness, solution.dP_dD)))
    return solution.refused(_outside(part, law), Status.OUTSIDE_LAW)


def _outside(part, law):
    """(B,) bool: the contact is larger than the profile."""
    return beyond_profile(part, law.shape, lambda index, a: law.take(index).at(a))


def _at_radii(part, law, x):
    """The solution of contacts given by their radii, without pull-off and pull-in. Errors of load and depth are
    relative to what adhesion takes of them at least."""
    state = law.at(part.value)
    ring = partial(ring_pressure, part, state.zone) if isinstance(law, Maugis) else None
    scales = Scales(*law.taken(state))
    solution, _ = answer(part, law.shape, state, np.ones(len(part), dtype=np.int32), x, ring, scales)
    solution = solution.refused(~np.isfinite(state.P), Status.DIVERGED)
    return solution.refused(_outside(part, law), Status.OUTSIDE_LAW)


@batch.of_cases
class Pulled(NamedTuple):
    """The parts of B cases that do not depend on their load or depth.

    holder, turn : what holds the punch, and the :class:`~.pull.Turn` of its Q
    jumped : the state to which the contact jumps when the punch just touches
    control, of_control : a holder that prescribes the control itself, and the Turn of its Q
    """

    holder: Holder
    turn: Turn
    jumped: State
    control: Holder
    of_control: Turn


def pulled(part, law):
    """:class:`Pulled` of the cases, and how often the equation was solved for each (B,). Cases that differ only in the
    value of their control share one search."""
    first, same = _alike(part)
    few, law = part.take(first), law.take(first)
    curve, holder = States(law), Holder.by(machine(few))
    start = highest(law, curve.radii)
    turn = of_control = last_minimum(curve, holder, start)
    control = Holder.by(np.full(len(few), np.inf if part.control == "D" else 0.0))
    differ = any((of_machine != alone).any() for of_machine, alone in zip(holder, control, strict=True))
    if differ and part.control != "a":
        of_control = last_minimum(curve, control, start)
    jumped, _ = curve.at(_jump(curve, holder, turn), np.arange(len(few)))
    return Pulled(holder, turn, jumped, control, of_control).take(same), curve.counts[same]


def _alike(part):
    """Places of one case for each different set of parameters, and for each case (B,) the number of its set."""
    codes = [np.unique(values, return_inverse=True)[1] for values in part.parameters.values()]
    _, first, same = np.unique(np.stack(codes), axis=1, return_index=True, return_inverse=True)
    return first, same.ravel()


def _at_minimum(part, state, at_turn):
    """The states, where at pull-off itself, `at_turn` (B,), the slope of the control is infinite instead of 0: then an
    error of the control adds nothing to the error of the radius."""
    if part.control == "a":
        return state
    name = f"d{part.control}"
    return state._replace(**{name: np.where(at_turn, np.inf, getattr(state, name))})


def _answered(part, shape, state, ends, counts, x, ring=None):
    """The solution with these states; its status is PULLED_OFF where they are NaN.

    ends : the numbers of pull-off and pull-in by name, their relative error, and the :class:`~..state.Scales`
    """
    pulls, off, scales = ends
    solution, _ = answer(part, shape, state, counts, x, ring, scales)
    solution = replace(solution, error=np.maximum(solution.error, off))
    solution = solution.refused(~np.isfinite(state.P), Status.PULLED_OFF)
    failed = np.isnan(pulls["P_off"]) | (solution.status == Status.PULLED_OFF) & ~(off < _UNKNOWN)
    numbers = {"stable": solution.a >= pulls["a_off"], part.control: part.value}
    return replace(solution, **pulls, **numbers).refused(failed, Status.DIVERGED)


def _scales(law, off, state):
    """:class:`~..state.Scales` of the states. Load and depth pass through 0, so their errors are relative to at least
    their values at pull-off, the state `off`. Those may be 0 too; so at least to a tenth of what adhesion takes there.
    Errors of p(0) are relative to at least a tenth of what adhesion takes from it."""
    P, D, _ = _LEAST * law.taken(off)
    return Scales(np.fmax(np.abs(off.P), P), np.fmax(np.abs(off.D), D), _LEAST * law.taken(state)[2])


def _off(state):
    """Relative error (B,) of load and depth at pull-off, each relative to at least what adhesion takes from it, because
    either may be 0: the depth is for the shape r^(3/2) under a load."""
    P, D = (np.abs(state.A) * v for v in (state.response.flat_P, state.response.flat_D))
    return state.P_error / np.maximum(np.abs(state.P), P) + state.D_error / np.maximum(np.abs(state.D), D)


def _place_of_control(part, curve, pulls):
    """x (B,) of the given branch for a given P or D, NaN if that branch has no such state; and whether the control is
    at its minimum (B,). The largest radius with the value of the control belongs to the stable branch if it is above
    the :class:`~.pull.Turn` of the holder of the punch."""
    control, of_control, turn = pulls.control, pulls.of_control, pulls.turn
    least, unstable = control.of(of_control.state.P, of_control.state.D), part.branch == "unstable"
    at_turn = (np.abs(part.value - least) <= _SAME * np.abs(least)) & ~of_control.at_axis
    above = np.where((part.value >= least) & ~at_turn, part.value, np.nan)
    largest = np.where(at_turn, of_control.x, above_turn(curve, control, above, of_control, _start(part, curve)))
    stays = largest >= turn.x
    x = np.where(stays ^ unstable, largest, np.nan)
    rest = unstable & np.isnan(x) & ~of_control.corner & ~at_turn
    if rest.any():
        smaller = below(curve, control, part.value, np.where(rest, of_control.x, np.nan), False)
        x = np.where(rest & (smaller < turn.x), smaller, x)
    return x, at_turn & np.isfinite(of_control.state.P) & ~(np.isnan(x))


def _start(part, curve):
    """First guess of x (B,): that of the contact without adhesion."""
    value = np.maximum(part.value, 0.0)
    return guess(part.control, np.where(value > 0, value, np.nan), curve.law.shape, curve.law.body, curve.radii)


def _jump(curve, holder, turn):
    """x (B,) to which the contact jumps when the punch just touches, Q = 0: above the :class:`~.pull.Turn`, or below it
    if Q is positive at the Turn."""
    least = holder.of(turn.state.P, turn.state.D)
    x = above_turn(curve, holder, np.where(least <= 0, 0.0, np.nan), turn, turn.x + 1)
    if (rest := least > 0).any():
        x = np.where(rest, below(curve, holder, 0 * least, np.where(rest, turn.x, np.nan), True), x)
    return x


def _flat(part, law, x):
    """The solution for flat punches: the contact keeps the radius of the punch down to the load or depth at which its
    edge gives way."""
    off, state = law.at(law.shape.least()), pinned(part, law.shape, law.body)
    holds = (state.A >= off.A * (1 + _SAME)) & (part.branch == "stable")
    pulls = {"P_off": off.P, "D_off": off.D, "a_off": off.a, "P_in": 0 * off.a, "a_in": off.a}
    ends = pulls, _off(off), _scales(law, off, state)
    return _answered(part, law.shape, state.only(holds), ends, np.ones(len(part), dtype=np.int32), x)
