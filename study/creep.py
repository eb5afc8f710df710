"""The load on a body that creeps, as the load on an elastic body with the same contact."""

from typing import Any

import numpy as np

from .inputs.definition import StudyError
from .terminal import shown

#: Below this step over retardation time the difference of two near numbers is replaced by its series.
_SHORT = 1e-3


def effective_load(t: Any, P: Any, prony: dict[str, Any]) -> np.ndarray:
    """The load P̃ under which an elastic body has the contact that a body that creeps has at the time t:

        P̃(t) = E0 ∫ J(t - s) dP(s),   E0 J(t) = J0 + Σ J_i (1 - exp(-t/tau_i)).

    J is the creep compliance of all that deforms, E0 the modulus that the elastic contact is then computed with: of a
    layer on a rigid base, or of a half-space, under a rigid punch, with a Poisson's ratio that does not change. Before
    t[0] there is no load: P[0] comes at t[0] at once. Between the times the load is linear; two equal times are a step.

    Parameters
    ----------
    t : array (times,), in any unit; it never falls
    P : array (times,), the load in any unit, from 0 on; it never falls, since radius and load no longer belong
        together when the contact shrinks
    prony : "J0", a number >= 0, and "J" and "tau", numbers or arrays (terms,), >= 0 and > 0, tau in the unit of t;
        J0 alone is an elastic body

    Returns
    -------
    numpy.ndarray : P̃ (times,), in the unit of P. `study.solve(P=P̃, ...)` has the radii and depths

    Raises
    ------
    StudyError : a ValueError. A load or time that falls, or input that cannot be used

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
    delayed = np.zeros((len(times), len(tau)))  # of each term, ∫ (1 - exp(-(t - s)/tau)) dP
    for i in range(1, len(times)):
        x = (times[i] - times[i - 1]) / tau
        delayed[i] = delayed[i - 1] - (loads[i - 1] - delayed[i - 1]) * np.expm1(-x) + steps[i] * _share(x)
    return J0 * loads + delayed @ J


def _share(x: np.ndarray) -> np.ndarray:
    """1 - (1 - exp(-x))/x: the part of a rise that has come when the rise ends; it takes x retardation times."""
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
