"""The equation of a smooth contact at given radii, of any shape on any kernel.

The Hankel transform of the pressure is p̂(k) = ∫₀ᵃ φ(t) cos kt dt. With τ = t/a, κ = ka and φ = (E/π) y,

    y(τ) + (2/π) ∫₀¹ y(σ) ∫ (L(κh/a) - 1) (cos κτ - cos κ) cos κσ dκ dσ = F(a) - F(aτ) + A,       y(1) = A,

    P = 2 E a ∫₀¹ y dτ,       D = F(a) + A + (2/π) ∫ (L - 1) cos κ ŷ(κ) dκ.

A is 0 without adhesion; :mod:`.adhesion.jkr` has it with adhesion. The equation does not contain the depth, so that
nothing cancels on stiff layers. It is linear, y = y_F + A y_1, where y_1 has the right-hand side 1, that of a flat
punch.

Galerkin's method solves it in the basis of :mod:`.products`. F has kinks, and only its projection on the basis counts:
the rest of the kernel and the rest of F are both small, and the error is their product.
"""

from typing import NamedTuple

import numpy as np

from ..body.wave_rule import FILM, MILD, place_of
from ..numerics import batch
from .products import LAST, Products, coarser, has_few, size_of, wave_nodes
from .shape_terms import lifted_drop
from .tabulated_body import Tabulated, excess

_EPS, _TINY = np.finfo(float).eps, np.finfo(float).tiny
#: Number of classes of stiffness.
_CLASSES = MILD + 1
#: Relative rounding error of closed forms; and that of the equation, over eps times its size and the norm of its
#: matrix.
_ROUNDING, _FLOOR = 64 * _EPS, 16
#: Relative error of the kernel's part because the kernel is evaluated at a finite number of waves. _OF_WAVES: for
#: octave 1 of h/a and each octave below; _OF_FEW: with the few nodes in octave -3 and below. They are the largest in
#: random contacts (`python tools/errors/shape_errors.py`), times 2 to 5. The error of the depth is _OF_DEPTH times as
#: large.
_OF_WAVES, _OF_FEW = (1e-13, 1e-13, 1e-13, 1e-13, 3e-13, 1e-12, 3e-12, 3e-12, 3e-12, 3e-12, 2e-11), 1e-11
_OF_DEPTH = 0.3
#: In the octaves up to _THIN the few waves are not enough if L(0) is below _SOFT: the depth is then a small remainder.
_THIN, _SOFT = -3, 0.1
#: The error of a basis is the rest of a geometric series, from its last functions, times _BASIS. A series whose terms
#: fall like 1/N² or 1/N, as in films, has a rest 2 and 2.7 times as large; and the series of films are irregular (with
#: 3, 8 of 9,600 random numbers had errors up to 1.16 times the estimate). _RATIOS are bounds of the ratio of successive
#: terms.
_BASIS, _RATIOS = 4.0, (1e-3, 0.9)


@batch.of_cases
class Response(NamedTuple):
    """The solution of the equation for shapes at B radii, in units R = E2* = 1. Arrays are (B,) unless stated.

    a, E : radius, and modulus of the half-space
    P, D : load and depth without adhesion
    flat_P, flat_D : load and depth of a flat punch of radius a with A = 1
    slope : dD/da without adhesion
    flat_slope : d flat_D/da
    P_error, D_error, flat_P_error, flat_D_error : absolute errors of these numbers at the radius a
    bent, flat_bent : (B, N), the second terms of the equation, y_F - F(a) + F and y_1 - 1, in the basis
    changes, flat_changes : (B, N), estimated errors of these because the basis is finite
    size : int, number of functions of the basis; 0 for closed forms
    """

    a: np.ndarray
    E: np.ndarray
    P: np.ndarray
    D: np.ndarray
    flat_P: np.ndarray
    flat_D: np.ndarray
    slope: np.ndarray
    flat_slope: np.ndarray
    P_error: np.ndarray
    D_error: np.ndarray
    flat_P_error: np.ndarray
    flat_D_error: np.ndarray
    size: np.ndarray
    bent: np.ndarray
    flat_bent: np.ndarray
    changes: np.ndarray
    flat_changes: np.ndarray

    @property
    def S(self):
        """Stiffness (B,) of a flat punch of radius a."""
        return self.flat_P / self.flat_D

    def only(self, mask):
        """The response with NaN in place of all numbers of cases outside the `mask` (B,)."""
        return Response(*(np.where(mask.reshape(-1, *[1] * (v.ndim - 1)), v, np.nan) for v in self))

    @classmethod
    def join(cls, size, pieces):
        """The responses of a batch of `size` cases from pairs of places in it and the :class:`Response` there."""
        width = max((piece.bent.shape[1] for _, piece in pieces), default=1)
        arrays = [np.full(size, np.nan) for _ in cls._fields[:-4]] + [np.zeros((size, width)) for _ in range(4)]
        for index, piece in pieces:
            for array, values in zip(arrays, piece, strict=True):
                if array.ndim == 1:
                    array[index] = values
                else:
                    array[index, : values.shape[1]], array[index, values.shape[1] :] = values, 0.0
        return cls(*arrays)


def respond(shape, body, a, by_recurrence=False):
    """:class:`Response` of B shapes on a body at radii a (B,); NaN where a is NaN.

    by_recurrence : the functions of a table that no process has made yet are, which takes a thirtieth of the time; the
        last bits are others (tests/smooth/test_wave_functions.py)
    """
    if body.kernel is None:
        return _on_half_space(shape, body, a)
    octave, place = place_of(body, a)
    sampler = None if isinstance(body, Tabulated) else body.kernel.sampler  # a table is quick at all nodes
    soft = 0 if sampler is None else (octave <= _THIN) & (body.L0 < _SOFT)
    usable = (a > 0) & np.isfinite(a)
    fine = np.where(usable & (octave == FILM), np.floor(np.log2(body.h / a)), octave)  # films have more functions
    fine = np.maximum(fine, LAST).astype(int)
    kinds, pieces = 2 * (2 * ((fine - LAST) * _CLASSES + place) + soft) + shape.even, []
    for kind in np.unique(kinds[usable]).tolist():
        index = np.flatnonzero(usable & (kinds == kind))
        which = int(octave[index[0]]), int(place[index[0]])
        part, size = body.take(index), size_of(int(fine[index[0]]), bool(kind % 2))
        chosen = None if kind // 2 % 2 else sampler
        L1 = excess(part, wave_nodes(chosen, *which, size) * (part.h / a[index])[:, None])
        products = Products.of(L1, chosen, *which, size, by_recurrence)
        of_waves = error_of_waves(chosen, which[0])
        pieces.append((index, _on_kernel(shape.take(index), part, a[index], products, of_waves)))
    return Response.join(len(a), pieces)


def _on_half_space(shape, body, a):
    none, depth = np.zeros((len(a), 1)), shape.lifted(a[:, None])[:, 0]
    P, slope = 2 * body.E * shape.lifted_load(a), shape.lifted_slope(a[:, None])[:, 0]
    moved = _of_radius(a, slope)
    errors = (_ROUNDING * P + moved * 2 * body.E * a, _ROUNDING * depth + moved, _ROUNDING * 2 * body.E * a, 0 * a)
    flat = 2 * body.E * a, 1 + 0 * a
    return Response(a, body.E, P, depth, *flat, slope, 0 * a, *errors, 0 * a, none, none, none, none)


def _on_kernel(shape, body, a, products, of_waves):
    """:class:`Response` from the `products` of the kernel, and their error, `of_waves`."""
    N, E = products.edge.shape[1], body.E
    depth, slope = (f(a[:, None])[:, 0] for f in (shape.lifted, shape.lifted_slope))
    sides = np.zeros((len(a), N, 3))
    sides[:, :, 0], sides[:, 0, 1], sides[:, :, 2] = lifted_drop(shape, a, N), 1.0, products.edge
    y, matrix = solved(products, sides, N), matrix_of(products, N)
    at_edge = at_the_edge(products, y)
    flat_D = 1 + at_edge[:, 1]
    P, flat_P = 2 * E * a * y[:, 0, 0], 2 * E * a * y[:, 0, 1]
    D = depth + at_edge[:, 0]
    turned = np.einsum("bn,bnj->bj", products.slope, y)
    resolvent = (products.corner - at_edge[:, 2]) / flat_D
    bent = y[:, :, :2] - sides[:, :, :2]
    changes, of_basis = left_out(products, matrix, sides, y, ~shape.even)
    rounded = _FLOOR * _EPS * N * np.abs(matrix).sum(axis=2).max(axis=1)
    of_radius = _of_radius(a, slope)
    bends = sizes(bent)
    share = of_waves * np.minimum(bends / np.maximum(sizes(y[:, :, :2]), _TINY), 1.0)  # y is 0 under the flat part
    errors = []
    for j, (load, low, high) in enumerate(((P, depth, D), (flat_P, 1.0, flat_D))):
        of_load = (rounded + share[:, j]) * np.abs(load) + 2 * E * a * of_basis[:, 0, j]
        of_depth = (
            rounded * np.abs(high) + _OF_DEPTH * of_waves * (bends[:, j] + np.abs(high - low)) + of_basis[:, 1, j]
        )
        errors += [of_load, of_depth]
    errors[0], errors[1] = errors[0] + of_radius * flat_P, errors[1] + of_radius * flat_D
    return Response(
        a, E, P, D, flat_P, flat_D,
        (slope - turned[:, 0] / a) * flat_D,
        -flat_D / a * (turned[:, 1] - resolvent),
        *errors, N + 0 * a, *np.moveaxis(bent, 2, 0), *np.moveaxis(changes, 2, 0),
    )  # fmt: skip


def error_of_waves(sampler, octave):
    """Relative error of the kernel's part in an octave of h/a."""
    if octave <= _THIN and has_few(sampler, octave):
        return _OF_FEW
    return _OF_WAVES[min(max(1 - octave, 0), len(_OF_WAVES) - 1)]


def _of_radius(a, slope):
    """Error (B,) of the depth by the rounding of a. Just beyond a corner the depth rises steeply with a; at the corner
    the slope is infinite, and does not count."""
    return np.where(np.isfinite(slope), _EPS * a * slope, 0.0)


def left_out(products, matrix, sides, y, kinked):
    """Estimated errors because the basis is finite: of the second terms (B, N, 2) of the equation, without adhesion and
    for a flat punch, and of y_0 and D, (B, 2, 2). kinked : (B,) bool, whether the shape is not smooth in r².

    A basis of n functions leaves a residual r, and the error of a number that is z @ sides is z @ r. In the last
    functions of the basis, r is the residual of the solution without them; r and z both fall with n, and the last
    functions add their product. The second terms are not such numbers. If F has a part outside the basis, it changes
    their last functions by about their own size: the ratio is then that of half as many functions, its root.
    """
    N = matrix.shape[1]
    n = coarser(N)
    blocks = [slice(n - i * (N - n), N - i * (N - n)) for i in range(3)]
    less = solved(products, sides[:, :n, :2], n)
    bent, of_less = y[:, :, :2] - sides[:, :, :2], np.pad(less - sides[:, :n, :2], ((0, 0), (0, N - n), (0, 0)))
    residual = sides[:, n:, :2] - matrix[:, n:, :n] @ less
    z = _weights(products, y)
    added = sizes(z[:, n:])[:, :, None] * sizes(residual)[:, None]
    falls = _ratio(*(sizes(z[:, part])[:, :, None] * sizes(y[:, part, :2])[:, None] for part in blocks))
    of_bent = _ratio(*(sizes(bent[:, part]) for part in blocks))
    of_bent[kinked, 0] = np.sqrt(of_bent[kinked, 0])
    return _rest(of_bent)[:, None] * (bent - of_less), _rest(falls) * added


def _ratio(last, before, first):
    """The ratio of successive terms of a series, from three of them, one of which may be small by chance."""
    return np.maximum(last / np.maximum(before, _TINY), np.sqrt(last / np.maximum(first, _TINY)))


def _rest(ratio):
    """The rest of a geometric series with this `ratio`, over its last term, times _BASIS."""
    ratio = np.clip(ratio, *_RATIOS)
    return _BASIS * ratio / (1 - ratio)


def _weights(products, y):
    """z (B, N, 2) with which y_0 and D are z @ sides: solutions of the transposed equation. The matrix is symmetric
    except for the edge, so that they follow from the solutions y_1 and y_2 for the sides 1 and edge."""
    edge = products.edge[:, : y.shape[1]]
    v = y[:, :, 2] / (1 - y[:, :1, 2])
    u = y[:, :, 1] + v * y[:, :1, 1]
    of_u, of_v = ((edge * part).sum(axis=1) for part in (u, v))
    of_depth = (products.corner - of_v) / (1 + of_u)
    return np.stack([u / (1 + of_u)[:, None], v + u * of_depth[:, None]], axis=2)


def sizes(y):
    """Norms (B,) or (B, j) of functions (B, N) or (B, N, j) in the basis."""
    return np.sqrt((y**2).sum(axis=1))


def solved(products, sides, N):
    """The solution (B, N, j) of the equation for right-hand `sides` (B, N, j) in the first N functions of the basis."""
    return np.linalg.solve(matrix_of(products, N), sides)


def matrix_of(products, N):
    """The matrix (B, N, N) of the equation."""
    matrix = np.eye(N) + products.differences[:, :N, :N]
    matrix[:, :, 0] += products.edge[:, :N]
    return matrix


def at_the_edge(products, y):
    """(2/π) ∫ (L - 1) cos κ ŷ dκ (B, j) of y (B, N, j): ê_0 is d_0 + cos κ."""
    return np.einsum("bn,bnj->bj", products.edge[:, : y.shape[1]], y) + products.corner[:, None] * y[:, 0]
