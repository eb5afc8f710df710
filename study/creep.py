"""The load on a creeping body, replaced by the load on an elastic body with the same contact."""

from typing import Any

import numpy as np

from .inputs.definition import StudyError
from .terminal import shown

#: If a time step over the retardation time is shorter, a series replaces the difference of two nearly equal numbers.
_SHORT = 1e-3


def effective_load(t: Any, P: Any, prony: dict[str, Any]) -> np.ndarray:
    """The load P̃ under which an elastic body has the contact of a body that creeps.

    At the time t it is

        P̃(t) = E0 ∫ J(t - s) dP(s),   E0 J(t) = J0 + Σ J_i (1 - exp(-t/tau_i)).

    J is the creep compliance of all that deforms: a layer on a rigid base, or a half-space, under a rigid punch, with a
    Poisson's ratio that does not change. E0 is the modulus for the computation of the elastic contact. The load is 0
    before t[0], where it jumps to P[0]. Between the times it is linear; two equal times are a step.

    Parameters
    ----------
    t : array (times,), in any unit; never falls
    P : array (times,), the load in any unit, at least 0; never falls, since an effective load does not exist for a
        contact that shrinks
    prony : "J0", a number >= 0, and "J" and "tau", numbers or arrays (terms,), >= 0 and > 0, tau in the unit of t;
        J0 alone is an elastic body

    Returns
    -------
    numpy.ndarray : P̃ (times,), in the unit of P. `study.solve(P=P̃, ...)` gives the radii and depths

    Raises
    ------
    StudyError : a ValueError. The load or time falls, or an input cannot be used

    Examples
    --------
    >>> import study
    >>> gel = {"J0": 1.0, "J": [3.0], "tau": [1.0]}
    >>> study.effective_load([0.0, 0.2, 3.0], [0.0, 2e-4, 2e-4], gel).round(6).tolist()
    [0.0, 0.000256, 0.000767]
    """
    times, loads = _numbers("t", t), _numbers("P", P)
    if times.ndim != 1 or times.shape != loads.shape or not times.size:
        raise _wrong(f"t {times.shape} and P {loads.shape} must be two rows of one length")
    if (np.diff(times) < 0).any():
        raise _wrong("t falls: sort the times")
    steps = np.diff(loads, prepend=0.0)
    if (steps < 0).any():
        place = int(np.argmax(steps < 0))
        wanted = "only a load that never falls, from 0 on, has an effective load; cut the curve there"
        raise _wrong(f"P falls at t = {times[place]:g}: {wanted}")
    J0, J, tau = _terms(prony)
    delayed = np.zeros((len(times), len(tau)))  # for each term ∫ (1 - exp(-(t - s)/tau)) dP
    for i in range(1, len(times)):
        x = (times[i] - times[i - 1]) / tau
        delayed[i] = delayed[i - 1] - (loads[i - 1] - delayed[i - 1]) * np.expm1(-x) + steps[i] * _share(x)
    return J0 * loads + delayed @ J


def _share(x: np.ndarray) -> np.ndarray:
    """1 - (1 - exp(-x))/x: the share of a delayed rise that has come at the end of a load ramp over x retardation
    times."""
    with np.errstate(invalid="ignore"):
        return np.where(x < _SHORT, x / 2 - x**2 / 6 + x**3 / 24, 1 + np.expm1(-x) / np.where(x > 0, x, 1.0))


def _terms(prony: Any) -> tuple[float, np.ndarray, np.ndarray]:
    """J0, J (terms,) and tau (terms,)."""
    if not isinstance(prony, dict) or "J0" not in prony or not set(prony) <= {"J0", "J", "tau"}:
        raise _wrong(f'prony = {shown(prony)}: must be {{"J0": ..., "J": [...], "tau": [...]}}')
    J0, J, tau = (np.atleast_1d(_numbers(name, prony.get(name, []))) for name in ("J0", "J", "tau"))
    if J0.shape != (1,) or J.ndim != 1 or J.shape != tau.shape:
        raise _wrong("prony: J0 must be one number, J and tau two rows of one length")
    if (J0 < 0).any() or (J < 0).any() or (tau <= 0).any():
        raise _wrong("prony: J0 and J must not be below 0, and tau must be above 0")
    return float(J0[0]), J, tau


def _numbers(name: str, values: Any) -> np.ndarray:
    try:
        numbers = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise _wrong(f"{name} = {shown(values)}: must be numbers") from None
    if not np.isfinite(numbers).all():
        raise _wrong(f"{name} must be finite numbers")
    return numbers


def _wrong(text: str) -> StudyError:
    return StudyError([f"effective_load: {text}"])
