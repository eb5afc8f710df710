"""Smooth cases: Hertz's closed form, and one linear solve on a thin layer.

On a thin layer (X K + Y) q = s² with X = 8/(pi a), Y = 2 C/a² (p in E2*). K is diagonalised once per mesh,
K = V diag(κ) V⁻¹, so that X q = V (c/(κ + t)), t = Y/X = pi C/(4 a), for every case: load, depth and central pressure
are sums of n fractions of t. (κ is real and positive, the condition of V below 20 up to 200 nodes.) Cases are columns
here: sums over the nodes then run along whole rows.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..closed_forms import hertz, hertz_pressure
from ..numerics.ladder import MARGIN, climb, next_rung
from ..numerics.mesh import mesh
from ..status import Status

#: What the sums S (3, B) stand for; powers of a; what is left of S without pressure.
_OF_SUMS = {
    "P": lambda a, S: np.pi**2 / 4 * a * a * a * S[0],
    "D": lambda a, S: a * a / 2 * S[1],
    "p0": lambda a, S: np.pi / 8 * a * S[2],
}
_ROWS = {name: row for row, name in enumerate(_OF_SUMS)}
_POWERS, _BARE = np.array([[3.0], [2.0], [1.0]]), np.array([[0.0], [1.0], [0.0]])
#: With Hertz's radius and that on the layer alone, (a_H^m + a_L^m)^(1/m) is within 0.0022 of the radius under a load.
_BLEND = 3.21
#: Newton steps for ln a leave an error below 0.04 times their square, so that one below _LAST is the last: the second
#: under a load, the third at a depth.
_STEPS, _LAST = 30, 2e-7
#: Factor of what no mesh sees, by the control.
_ENCLOSING = {"a": 0.5, "P": 0.2, "D": 0.25}


class Modes(NamedTuple):
    """Spectral form of a mesh: κ (n, 1), `nodal` (n, n) from the fractions to X q, `sums` (3, n) from them to S."""

    kappa: np.ndarray
    nodal: np.ndarray
    sums: np.ndarray


@lru_cache(maxsize=32)
def modes(n):
    """:class:`Modes` of ``mesh(n)``."""
    grid = mesh(n)
    kappa, V = np.linalg.eig(grid.K)
    nodal = (V * np.linalg.solve(V, grid.s**2)).real
    return Modes(kappa.real[:, None], nodal, np.stack([grid.w @ nodal, grid.edge @ nodal, nodal[-1]]))


def half_space(control, value, x):
    """Hertz: dict of output arrays in units R = E2* = 1; value (B,), x (m,)."""
    H = hertz(**{control: value})
    zero = np.zeros_like(H.a)
    out = H._asdict() | {"p_max": H.p0, "dP_dD": 2 * H.a, "residual": zero, "error": zero + 4 * np.finfo(float).eps}
    return out | _smooth_extras(hertz_pressure(x, H.p0[:, None]), zero) | {control: value}


def thin_layer(control, value, C, rtol, nodes, x):
    """Smooth punch on a thin layer: dict of output arrays in units R = E2* = 1; value, C, rtol, nodes (B,), x (m,)."""
    out, steps = {}, np.zeros(len(value), dtype=int)

    def solve_on(index, n):
        part = _on_mesh(control, value[index], C[index], n, x)
        steps[index] += part["iterations"]
        for name, v in part.items():
            out.setdefault(name, np.full((len(value), *v.shape[1:]), np.nan))[index] = v
        return part["error"]

    unmet = climb(rtol, nodes, solve_on)
    status = np.where(unmet, Status.TOLERANCE_NOT_MET, Status.CONVERGED)
    status[~np.isfinite(out["error"])] = Status.DIVERGED
    ended = {"status": status.astype(np.int8), "iterations": steps, control: value}
    return out | _smooth_extras(out["p"], out["p0"] * 0) | ended


@np.errstate(all="ignore")
def _on_mesh(control, value, C, n, x):
    """Solve on n nodes; the error is the distance, to first order, to the next finer mesh."""
    grid, modal = mesh(n), modes(n)
    a, steps = _radius(control, value, C, modal)
    t, S, slopes, fractions = _sums(a, C, modal)
    P, D, p0 = (of_sums(a, S) for of_sums in _OF_SUMS.values())
    Xq = modal.nodal @ fractions
    residual = np.abs(grid.K @ Xq + t * Xq - grid.s[:, None] ** 2).max(axis=0)
    p = np.pi / 8 * a * np.maximum(grid.basis(np.sqrt((1 - x) * (1 + x))) @ Xq, 0.0)
    p[x == 1.0] = 0.0
    error = np.maximum(MARGIN * _distance(control, t, S, slopes, modes(next_rung(n))), 4 * n * np.finfo(float).eps)
    error = np.maximum(error, _unseen(control, t, grid.s[0]))
    return {
        "a": a,
        "P": P,
        "D": D,
        "p0": p0,
        "p_max": p0,
        "dP_dD": P * slopes[0] / (D * slopes[1]),
        "error": error,
        "residual": residual,
        "p": p.T,
        "nodes": np.full(len(a), n),
        "iterations": steps,
    }


def _sums(a, C, modal):
    """t (B,), the sums S (3, B), the logarithmic derivatives of P, D, p(0) by η = ln a (3, B), fractions (n, B)."""
    t = np.pi / 4 * C / a
    fractions = 1 / (modal.kappa + t)
    S = modal.sums @ fractions + _BARE
    return t, S, _POWERS + t * (modal.sums @ (fractions * fractions)) / S, fractions


def _distance(control, t, S, slopes, finer):
    """Largest relative change (B,) of a, P, D, p(0), to first order, on the finer mesh under the same control."""
    change = (finer.sums @ (1 / (finer.kappa + t)) + _BARE) / S - 1
    if control == "a":
        return np.abs(change).max(axis=0)
    shift = -change[_ROWS[control]] / slopes[_ROWS[control]]
    return np.maximum(np.abs(shift), np.abs(change + slopes * shift).max(axis=0))


def _unseen(control, t, s1):
    """Error (B,) where the springs yield more than the half-space in a layer at the edge that neither mesh sees, s ~ t.

    On every mesh it is t times one function of t/s1², s1 the first node, which this encloses (test_accuracy.py).
    """
    blind = _ENCLOSING[control] * t * np.log1p(s1**2 / (2 * t))
    return np.where((t > 0) & (t < 16 * s1**2), blind, 0.0)


def _radius(control, value, C, modal):
    """a (B,) for the given load or depth by Newton on logarithms, and the number of steps (B,)."""
    if control == "a":
        return value, np.zeros(len(value), dtype=int)
    if control == "P":
        a = (np.cbrt(0.75 * value) ** _BLEND + (4 / np.pi * C * value) ** (_BLEND / 4)) ** (1 / _BLEND)
    else:
        a = np.sqrt(1.5 * value)  # a² is between D, Hertz, and 2 D, layer alone
    row, steps, change = _ROWS[control], np.zeros(len(a), dtype=int), np.full(len(a), np.inf)
    for _ in range(_STEPS):
        going = np.abs(change) > _LAST  # each case by itself: it has the same steps in any batch
        if not going.any():
            break
        steps += going
        _, S, slopes, _ = _sums(a, C, modal)
        change = np.where(going, np.log(_OF_SUMS[control](a, S) / value) / slopes[row], 0.0)
        a = a * np.exp(-change)
    return a, steps


def _smooth_extras(p, zero):
    """What a smooth punch adds: real contact everywhere, λ = 1 inside."""
    return {"p": p, "lam": np.ones_like(p), "A0": zero, "Ar_An": zero + 1}
