"""Smooth cases: Hertz's closed form, and one linear solve on a thin layer.

On a thin layer (X K + Y) q = s² with X = 8/(pi a), Y = 2 C/a² (p in E2*). K is diagonalised once per mesh,
K = V diag(κ) V⁻¹, so that q = V (c/(X κ + Y)) for every case, and the load is a sum of n fractions in a.
(κ is real and positive, the condition of V below 20 up to 200 nodes.)
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .closed_forms import hertz, hertz_pressure
from .ladder import MARGIN, climb, next_rung
from .mesh import mesh
from .status import Status

#: Newton steps for ln a under a given load or depth: from above, where the logarithm is concave; 8 do.
_STEPS = 30


class Modes(NamedTuple):
    """Spectral form of a mesh: κ (n,), coefficients c (n,) of s², V (n, n); load, edge and centre by modes."""

    kappa: np.ndarray
    c: np.ndarray
    V: np.ndarray
    load: np.ndarray
    edge: np.ndarray
    centre: np.ndarray


@lru_cache(maxsize=32)
def modes(n):
    """:class:`Modes` of ``mesh(n)``."""
    grid = mesh(n)
    kappa, V = np.linalg.eig(grid.K)
    c = np.linalg.solve(V, grid.s**2)
    return Modes(
        kappa.real, c.real, V.real, (grid.w @ V).real * c.real, (grid.edge @ V).real * c.real, V[-1].real * c.real
    )


def half_space(control, value, x):
    """Hertz: dict of output arrays in units R = E2* = 1; value (B,), x (m,)."""
    H = hertz(**{control: value})
    zero = np.zeros_like(H.a)
    out = H._asdict() | {"p_max": H.p0, "dP_dD": 2 * H.a, "residual": zero, "error": zero + 4 * np.finfo(float).eps}
    return out | _smooth_extras(hertz_pressure(x, H.p0[:, None]), zero) | {control: value}


def thin_layer(control, value, C, rtol, nodes, x):
    """Smooth punch on a thin layer: dict of output arrays in units R = E2* = 1; value, C, rtol, nodes (B,), x (m,)."""
    out = {}

    def solve_on(index, n):
        part = _on_mesh(control, value[index], C[index], n, x)
        for name, v in part.items():
            out.setdefault(name, np.full((len(value), *v.shape[1:]), np.nan))[index] = v
        return part["error"]

    unmet = climb(rtol, nodes, solve_on)
    status = np.where(unmet, Status.TOLERANCE_NOT_MET, Status.CONVERGED)
    status[~np.isfinite(out["error"])] = Status.DIVERGED
    return out | _smooth_extras(out["p"], out["p0"] * 0) | {"status": status.astype(np.int8), control: value}


def _on_mesh(control, value, C, n, x):
    """Solve on n nodes; the error is the difference to the next finer mesh."""
    with np.errstate(all="ignore"):
        modal, finer = modes(n), modes(next_rung(n))
        a, steps = _radius(control, value, C, modal)
        values, better = _values(a, C, modal), _values(_radius(control, value, C, finer, a)[0], C, finer)
        error = np.max([np.abs(values[name] / better[name] - 1) for name in ("a", "P", "D", "p0")], axis=0)
        q = (modal.c / _denominator(a, C, modal)) @ modal.V.T
        grid = mesh(n)
        F = (8 / np.pi / a)[:, None] * (q @ grid.K.T) + (2 * C / a**2)[:, None] * q - grid.s**2
    p = np.maximum(q @ grid.basis(np.sqrt((1 - x) * (1 + x))).T, 0.0)
    p[:, x == 1.0] = 0.0
    error = np.maximum(MARGIN * error, 4 * n * np.finfo(float).eps)
    residual = np.abs(F).max(axis=1)
    return values | {
        "error": error,
        "residual": residual,
        "p": p,
        "nodes": np.full(len(a), n),
        "iterations": np.full(len(a), steps),
    }


def _denominator(a, C, modal):
    """X κ + Y, (B, n)."""
    return (8 / np.pi / a)[:, None] * modal.kappa + (2 * C / a**2)[:, None]


def _sums(a, C, modal):
    """P/(2 pi a²), 2 D/a² - 1, p(0), and the logarithmic derivatives of P and D by η = ln a."""
    X, Y = 8 / np.pi / a, 2 * C / a**2
    share = 1 / _denominator(a, C, modal)
    rate = share**2 * (X[:, None] * modal.kappa + 2 * Y[:, None])  # d share/dη
    load, edge = share @ modal.load, X * (share @ modal.edge)
    d_load, d_edge = rate @ modal.load, X * (rate @ modal.edge) - edge
    return load, edge, share @ modal.centre, 2 + d_load / load, 2 + d_edge / (1 + edge)


def _values(a, C, modal):
    load, edge, p0, by_P, by_D = _sums(a, C, modal)
    P, D = 2 * np.pi * a**2 * load, a**2 / 2 * (1 + edge)
    return {"a": a, "P": P, "D": D, "p0": p0, "p_max": p0, "dP_dD": P * by_P / (D * by_D)}


def _radius(control, value, C, modal, start=None):
    """a (B,) for the given load or depth by Newton on logarithms, and the number of steps of the batch."""
    if control == "a":
        return value, 0
    if start is not None:
        eta = np.log(start)
    elif control == "P":
        eta = 0.25 * np.log(np.cbrt(0.75 * value) ** 4 + 4 * C * value / np.pi)
    else:
        eta = 0.5 * np.log(1.5 * value)
    steps = 0
    while steps < _STEPS:
        steps += 1
        a = np.exp(eta)
        load, edge, _, by_P, by_D = _sums(a, C, modal)
        if control == "P":
            change = np.log(2 * np.pi * a**2 * load / value) / by_P
        else:
            change = np.log(a**2 / 2 * (1 + edge) / value) / by_D
        eta = eta - change
        if not np.nanmax(np.abs(change), initial=0) > 1e-14:
            break
    return np.exp(eta), steps


def _smooth_extras(p, zero):
    """What a smooth punch adds: real contact everywhere, λ = 1 inside."""
    return {"p": p, "lam": np.ones_like(p), "A0": zero, "Ar_An": zero + 1}
