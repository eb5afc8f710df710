"""Smooth paraboloids: Hertz's closed form, and one linear system on a thin layer.

On a thin layer (X K + Y) q = s² with X = 8/(pi a), Y = 2 C/a² (p in E2*). K is diagonalised once for each mesh,
K = V diag(κ) V⁻¹; κ is real and positive, and V well conditioned (tests/smooth/test_paraboloids.py). With
c = V⁻¹ s² and t = Y/X = pi C/(4 a), X q = V (c/(κ + t)): load, depth and central pressure are sums of n fractions
1/(κ + t). Arrays are (n, B) here, with a column for each case: sums over the nodes then run along whole rows.

Newton's method solves these cases too. It takes 7 times as long for a batch of 16,000, and twice as long for
lone cases (`python tools/bench/benchmark_smooth.py`).
"""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..closed_forms import hertz, hertz_pressure
from ..numerics.ladder import MARGIN, climb, next_rung
from ..numerics.mesh import mesh_of
from ..numerics.quadrature import lagrange
from ..rough.error import ENCLOSING, RING, added_in_ring
from ..solution import Solution
from ..status import Status

#: Quantity -> its value from the radius a and the sums S (3, B); each quantity has one row of S.
_OF_SUMS = {
    "P": lambda a, S: np.pi**2 / 4 * a * a * a * S[0],
    "D": lambda a, S: a * a / 2 * S[1],
    "p0": lambda a, S: np.pi / 8 * a * S[2],
}
_ROWS = {name: row for row, name in enumerate(_OF_SUMS)}
#: The power of a in each quantity; and the part of each sum that does not come from the pressure: 1 in D = a²/2 (1 +
#: ...).
_POWERS, _BARE = np.array([[3.0], [2.0], [1.0]]), np.array([[0.0], [1.0], [0.0]])
#: The power m in the first guess of the radius under a load: (a_H^m + a_L^m)^(1/m), with Hertz's radius a_H and the
#: radius a_L on springs alone. It is right to 0.3 % (tests/smooth/test_paraboloids.py).
_BLEND = 3.21
#: Most Newton steps for ln a; a step below _LAST is the last one. The error after a step is below 0.04 times the square
#: of the step (tests/smooth/test_paraboloids.py): after a step below _LAST it is below rounding.
_STEPS, _LAST = 30, 2e-7


class Modes(NamedTuple):
    """Spectral form of a mesh: `kappa` (n, 1); `nodal` (n, n), which makes X q from the fractions; and `sums` (3, n),
    which makes S from them."""

    kappa: np.ndarray
    nodal: np.ndarray
    sums: np.ndarray


@lru_cache(maxsize=32)
def modes(n):
    """:class:`Modes` of ``mesh_of(n)``."""
    mesh = mesh_of(n)
    kappa, V = np.linalg.eig(mesh.K)
    nodal = (V * np.linalg.solve(V, mesh.s**2)).real
    return Modes(kappa.real[:, None], nodal, np.stack([mesh.w @ nodal, mesh.edge @ nodal, nodal[-1]]))


def on_half_space(control, value, x):
    """:class:`~solver.solution.Solution` of Hertz's contacts in units R = E2* = 1; value (B,), x (m,)."""
    H = hertz(**{control: value})
    rest = {"p": hertz_pressure(x, H.p0[:, None]), "dP_dD": 2 * H.a, "residual": 0.0}
    errors = dict.fromkeys(("error", "profile_error"), 4 * np.finfo(float).eps)
    return _solution(H._asdict() | rest | errors | {control: value})


def on_thin_layer(control, value, C, rtol, nodes, x):
    """:class:`~solver.solution.Solution` of smooth punches on thin layers in units R = E2* = 1; all arrays (B,), x
    (m,)."""

    def on_mesh(index, n, start):
        piece = _solution(_on_mesh(control, value[index], C[index], n, x))
        return piece.error, None, piece

    rungs = climb(rtol, nodes, on_mesh)
    steps = np.zeros(len(value), dtype=np.int32)
    for index, piece in rungs:
        steps[index] += piece.iterations
    solution = Solution.join(len(value), len(x), rungs)
    status = np.where(np.isfinite(solution.error), Status.CONVERGED, Status.DIVERGED).astype(np.int8)
    return replace(solution, status=status, iterations=steps, **{control: value})


def _solution(arrays):
    """The solution with the numbers of a smooth punch: real contact everywhere, λ = 1 inside, p_max = p(0)."""
    smooth = {"p_max": arrays["p0"], "lam": 1.0, "A0": 0.0, "Ar_An": 1.0}
    return Solution.of(*arrays["p"].shape, **arrays, **smooth)


def _on_mesh(control, value, C, n, x):
    """Arrays of a :class:`~solver.solution.Solution` (dict) on n nodes. `error` is the larger of two: the distance, to
    first order, to the solution on the next finer mesh, and the effect of a ring at the edge that both meshes miss."""
    mesh, modal = mesh_of(n), modes(n)
    a, steps = _radius(control, value, C, modal)
    t, S, slopes, fractions = _sums(a, C, modal)
    P, D, p0 = (of_sums(a, S) for of_sums in _OF_SUMS.values())
    Xq = modal.nodal @ fractions
    residual = np.abs(mesh.K @ Xq + t * Xq - mesh.s[:, None] ** 2).max(axis=0)
    p = np.pi / 8 * a * np.maximum(_to_edge(mesh, np.sqrt((1 - x) * (1 + x))) @ Xq, 0.0)
    error = np.maximum(MARGIN * _distance(control, t, S, slopes, modes(next_rung(n))), 4 * n * np.finfo(float).eps)
    ring = np.where(t < RING * mesh.s[0] ** 2, ENCLOSING[control] * added_in_ring(t, mesh.s[0]), 0.0)
    error = np.maximum(error, ring)
    between = np.maximum(error, MARGIN * _between(mesh, Xq, t, next_rung(n)))
    names = ("a", "P", "D", "p0", "dP_dD", "p", "error", "profile_error", "residual", "nodes", "iterations")
    slope = P * slopes[0] / (D * slopes[1])
    return dict(zip(names, (a, P, D, p0, slope, p.T, error, between, residual, n, steps), strict=True))


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


def _between(mesh, Xq, t, finer):
    """Largest difference (B,), over the largest pressure, between the pressure and that for the same radius on `finer`
    nodes, most of which lie between those of the mesh."""
    modal = modes(finer)
    fine = modal.nodal @ (1 / (modal.kappa + t))
    return np.abs(_to_edge(mesh, mesh_of(finer).s) @ Xq - fine).max(axis=0) / fine.max(axis=0)


def _to_edge(mesh, points):
    """The polynomials that are 1 at one node and 0 at the others and at the edge, where there is no pressure: their
    values (m, n) at `points` (m,) in s."""
    return lagrange(np.append(0.0, mesh.s), points)[:, 1:]


def _radius(control, value, C, modal):
    """a (B,) for the given load or depth, by Newton's method on logarithms, and the number of steps (B,)."""
    if control == "a":
        return value, np.zeros(len(value), dtype=int)
    if control == "P":
        a = (np.cbrt(0.75 * value) ** _BLEND + (4 / np.pi * C * value) ** (_BLEND / 4)) ** (1 / _BLEND)
    else:
        a = np.sqrt(1.5 * value)  # a² is between D, by Hertz, and 2 D, for springs alone
    row, steps, change = _ROWS[control], np.zeros(len(a), dtype=int), np.full(len(a), np.inf)
    for _ in range(_STEPS):
        going = np.abs(change) > _LAST  # for each case by itself, so that it has the same steps in any batch
        if not going.any():
            break
        steps += going
        _, S, slopes, _ = _sums(a, C, modal)
        change = np.where(going, np.log(_OF_SUMS[control](a, S) / value) / slopes[row], 0.0)
        a = a * np.exp(-change)
    return a, steps
