"""Adhesion in a ring around the contact, after Maugis and Dugdale, of any shape on any kernel.

The stress -σ₀ acts where a < r < c; at c the gap is w/σ₀. The pressure inside of c is -σ₀ plus that of a contact with
φ(a) = 0, whose equation (:mod:`..galerkin`) has F - Q in place of F,

    Q(t) = (2 σ₀/E) [sqrt(c² - t²) + c ∫ (L - 1) J1(kc) cos kt dk/k],      P = 2 E a ∫₀¹ y dτ - π c² σ₀,

and the gap at c is f(c) - D + u(c),

    u(c) = (2/E) [∫₀ᵃ φ dt/sqrt(c² - t²) + ∫ (L - 1) J0(kc) φ̂ dk] - (2 σ₀ c/E) [2/π + ∫ (L - 1) J1(kc) J0(kc) dk/k].

So a and γ = c/a determine w; for a given w, γ is searched at each radius. With t = c sin z the integrands stay regular
as c -> a.
"""

from typing import NamedTuple

import numpy as np

from ...body.wave_rule import OCTAVES, place_of, quadrature
from ...numerics import batch, special
from ...numerics.bracket import false_position, secant
from ...numerics.quadrature import gauss_legendre
from ...shapes.shape import column
from ..galerkin import Response, at_the_edge, error_of_waves, left_out, matrix_of, sizes, solved
from ..products import Products, differences_at, size_of
from ..shape_terms import functions, lifted_drop, longest
from ..state import State
from ..tabulated_body import excess

#: Relative step, in a and in γ - 1, of the fourth-order differences that give the slopes of P and D.
_STEP = 2e-3
#: _ROUNDING: relative rounding of P and D for each function of the basis. _NEAR: error of ln w, or of ln(γ - 1), at the
#: end of its search.
_ROUNDING, _NEAR = 1e-15, 1e-13
#: Rings that are computed together.
_TOGETHER = 64
#: Points of the rule in z beyond those for the basis, whose last function turns by 4N quarters over the rule.
_MORE = 24


class Ring(NamedTuple):
    """Contacts at given a and γ, (B,) each: the work of adhesion, load, depth, and errors of all three. `bent` (B, N):
    the part of y that the layer adds to the right-hand side of a half-space, a polynomial."""

    w: np.ndarray
    P: np.ndarray
    D: np.ndarray
    w_error: np.ndarray
    P_error: np.ndarray
    D_error: np.ndarray
    bent: np.ndarray


class RingResponse(NamedTuple):
    """How B bodies respond to a ring.

    y : (B, N), coefficients
    at_edge, moved : (B,), the parts of D and of u(c) that come from the kernel
    errors : (3, B), of y_0, at_edge and moved
    changes : (B, N), estimated errors of y
    """

    y: np.ndarray
    at_edge: np.ndarray
    moved: np.ndarray
    errors: np.ndarray
    changes: np.ndarray


@batch.of_cases
class Maugis(NamedTuple):
    """The law of adhesion of B cases: shapes, the body, w and σ₀ (B,)."""

    shape: object
    body: object
    w: np.ndarray
    sigma: np.ndarray
    reaches_axis = True  # the curve may reach a = 0: with a wide ring P and D rise from there on

    def taken(self, state):
        """The approximate amounts (3, B) that adhesion takes from load, depth and p(0) of states."""
        c = state.a * state.zone
        return np.array([np.pi * c**2 * self.sigma, 2 * c * self.sigma / self.body.E, self.sigma])

    def at(self, a):
        """The :class:`~..state.State` at the radii a (B,); A is 0, and `zone` is γ."""
        usable, over = np.flatnonzero((a > 0) & np.isfinite(a)), np.full(len(a), np.nan)
        if len(usable):
            over[usable] = self.take(usable)._over(a[usable])
        center = self.ring(a, over, with_errors=True)
        by_a, by_over = self._slopes(a, over)
        dP, dD = (by_a[i] - by_over[i] * by_a[0] / by_over[0] for i in (1, 2))
        off = (center.w_error + _NEAR * self.w) / np.abs(by_over[0])  # estimated error of ln(γ - 1)
        errors = center.P_error + off * np.abs(by_over[1]), center.D_error + off * np.abs(by_over[2])
        N, none = center.bent.shape[1], np.zeros_like(center.bent)
        pressed = np.pi * (a * (1 + np.exp(over))) ** 2 * self.sigma  # the load inside of c is larger by this
        nan, ones = np.full_like(a, np.nan), np.ones_like(a)
        response = Response(
            a, self.body.E * ones, center.P + pressed, center.D, ones, ones, dD, nan, *errors, nan, nan, N * ones,
            center.bent, none, none, none,
        )  # fmt: skip
        return State(a, 0 * a, center.P, center.D, dP, dD, *errors, 1 + np.exp(over), response)

    def _over(self, a):
        """ln(γ - 1) (B,) of the ring whose work of adhesion is w."""

        def off(x, index):
            part = self.take(index)
            return np.log(part.ring(a[index], x).w / part.w)

        near = np.pi * self.body.E * self.w / (4 * self.sigma**2) / a
        wide = np.sqrt(2 * self.w / self.sigma) / a
        start = np.log(np.minimum(near, wide))
        x = secant(off, start)
        rest = np.flatnonzero(np.isnan(x))
        if len(rest):
            x[rest], _ = false_position(lambda v, i: off(v, rest[i]), start[rest], np.full(len(rest), _NEAR))
        return x

    def _slopes(self, a, over):
        """Derivatives (3, B) of w, P and D by a and by ln(γ - 1)."""
        steps, weights = _STEP * np.array([-2, -1, 1, 2]), np.array([1, -8, 8, -1]) / (12 * _STEP)
        around = np.append(1 + steps, np.ones(4))[:, None] * a, np.append(np.zeros(4), steps)[:, None] + over
        rings = self.take(np.tile(np.arange(len(a)), 8)).ring(*(v.ravel() for v in around))
        numbers = np.array(rings[:3]).reshape(3, 8, -1)
        by_a, by_over = (np.einsum("s,isb->ib", weights, numbers[:, part]) for part in (slice(4), slice(4, 8)))
        return by_a / a, by_over

    def ring(self, a, over, with_errors=False):
        """The :class:`Ring` at a and ln(γ - 1) (B,); its errors include those of the basis only if `with_errors`."""
        c = a * (1 + np.exp(over))
        octave, place = (np.zeros(len(a), dtype=int),) * 2
        if self.body.kernel is not None:
            octave, place = place_of(self.body, c)
            octave = np.maximum(octave, OCTAVES[0])
        usable = np.isfinite(c)
        edge = np.sqrt(np.exp(over) * (2 + np.exp(over)))
        parts = np.nan_to_num(16 * longest(self._ends(a, c / a, edge))).astype(int)  # each has its rule
        kinds, pieces = 32 * (2 * (octave * 16 + place) + self.shape.even) + parts, []
        for kind in np.unique(kinds[usable]).tolist():
            index = np.flatnonzero(usable & (kinds == kind))
            which = int(octave[index[0]]), int(place[index[0]]), with_errors
            for rows in np.split(index, range(_TOGETHER, len(index), _TOGETHER)):
                pieces.append((rows, self.take(rows)._ring(a[rows], over[rows], *which)))
        width = max((piece.bent.shape[1] for _, piece in pieces), default=1)
        out = Ring(*np.full((6, len(a)), np.nan), np.zeros((len(a), width)))
        for index, piece in pieces:
            for array, values in zip(out[:-1], piece[:-1], strict=True):
                array[index] = values
            out.bent[index, : piece.bent.shape[1]] = piece.bent
        return out

    def _ring(self, a, over, octave, place, with_errors):
        """The :class:`Ring` of contacts whose h/c lies in one octave and one class of stiffness."""
        N, E, gamma = size_of(octave, bool(self.shape.even[0])) + 4, self.body.E, 1 + np.exp(over)
        edge = np.sqrt(np.exp(over) * (gamma + 1))  # sqrt(γ² - 1)
        z, dz = self._rule(a, gamma, edge, N)
        tau, root = gamma[:, None] * np.sin(z), gamma[:, None] * np.cos(z)  # γ sin z, sqrt(γ² - τ²)
        basis = np.stack(list(functions(tau, N)), axis=1)
        c, unit = a * gamma, 2 * self.sigma / E
        depth, height = self.shape.lifted(column(a)), self.shape.height(column(c))[:, 0]
        pulled = (unit * a)[:, None] * (root - edge[:, None])
        exact = depth - self.shape.lifted(column(a) * tau) + pulled
        side = lifted_drop(self.shape, a, N) + np.einsum("bq,bnq->bn", pulled * dz * root, basis)
        layer = self._layer(a, gamma, (octave, place), side, with_errors)
        whole = exact + np.einsum("bn,bnq->bq", layer.y - side, basis)
        D = depth[:, 0] - unit * a * edge + layer.at_edge
        moved = 2 / np.pi * ((whole * dz).sum(axis=1) - unit * c) + layer.moved  # u(c)
        load, tension = 2 * E * a * layer.y[:, 0], np.pi * c**2 * self.sigma
        rounding, (of_y, of_edge, of_moved) = _ROUNDING * N, layer.errors
        D_error = of_edge + rounding * (np.abs(depth[:, 0]) + unit * a * edge + np.abs(D))
        of_moved = of_moved + 2 / np.pi * sizes(np.einsum("bnq,bq->bn", basis, dz) * layer.changes)
        gap_error = D_error + of_moved + rounding * (height + np.abs(moved) + unit * c)
        return Ring(
            self.sigma * (height - D + moved), load - tension, D, self.sigma * gap_error,
            2 * E * a * of_y + rounding * (np.abs(load) + tension), D_error, layer.y - side,
        )  # fmt: skip

    def _layer(self, a, gamma, which, side, with_errors):
        """The :class:`RingResponse` of contacts; on a half-space their right-hand side is `side` (B, N)."""
        if self.body.kernel is None:
            return RingResponse(side, 0 * a, 0 * a, np.zeros((3, len(a))), 0 * side)
        N, (d, cosine, by, q) = side.shape[1], self._waves(a, gamma, *which, side.shape[1])
        kappa, J0 = by / gamma[:, None], special.j0(by)
        J1 = column(2 * self.sigma / self.body.E * a * gamma) * special.j1(by) / kappa
        products, sides = Products.summed(d, cosine, 2 / np.pi * q), np.zeros((len(a), N, 3))
        sides[:, :, 0], sides[:, 0, 1] = side + np.einsum("bg,bng->bn", q * J1, d), 1.0
        sides[:, :, 2] = products.edge
        solution = solved(products, sides if with_errors else sides[:, :, :1], N)
        y = solution[:, :, 0]
        at_edge = at_the_edge(products, solution)[:, 0] - (q * J1 * cosine).sum(axis=1)
        transform = 2 / np.pi * (np.einsum("bn,bng->bg", y, d) + y[:, :1] * cosine)
        moved = (q * J0 * (transform - J1)).sum(axis=1)
        (of_y, of_edge, of_moved), changes = np.zeros((3, len(a))), 0 * y
        if with_errors:
            changes, left = left_out(products, matrix_of(products, N), sides, solution, ~self.shape.even)
            (of_y, of_edge), changes = left[:, :, 0].T, changes[:, :, 0]
            felt = np.einsum("bg,bng->bn", q * J0, d)
            felt[:, 0] += (q * J0 * cosine).sum(axis=1)
            of_moved = 2 / np.pi * sizes(felt * changes)
        bends = sizes(y - side)
        film = self.body.h < 2.0 ** OCTAVES[0] * a * gamma  # the quadrature ends where L - 1 has not decayed
        of_waves = np.where(film, 1.0, error_of_waves(None, which[0]))
        of_waves = of_waves * np.array([bends, bends + np.abs(at_edge), bends + np.abs(moved)])
        return RingResponse(y, at_edge, moved, np.array([of_y, of_edge, of_moved]) + of_waves, changes)

    def _rule(self, a, gamma, edge, N):
        """Points z and weights (B, Q), for τ = γ sin z <= 1. For a shape that is not smooth in r², the panels begin at
        0 and at each kink, and the points are Gauss points y in z = start + width y²."""
        ends = self._ends(a, gamma, edge)
        if self.shape.even[0]:
            y, w = gauss_legendre(_MORE + 2 * N)
            return ends[:, 1:] * y, ends[:, 1:] * w
        y, w = gauss_legendre(_MORE + int(4 * N * longest(ends)[0]))
        low, width = ends[:, :-1, None], np.diff(ends, axis=1)[:, :, None]
        return (low + width * y**2).reshape(len(a), -1), (width * (2 * y * w)).reshape(len(a), -1)

    def _ends(self, a, gamma, edge):
        """Ends of panels (B, K) in z: 0, the kinks of the shape and the edge, which stands in for kinks outside of the
        contact."""
        end = np.arctan2(1.0, edge)[:, None]  # arcsin(1/γ)
        if self.shape.even[0]:
            return np.hstack([0 * end, end])
        kinks = np.sort(np.minimum(np.nan_to_num(self.shape.kinks() / column(a), nan=1.0), 1.0), axis=1)
        return np.hstack([0 * end, np.minimum(np.arcsin(kinks / gamma[:, None]), end), end])

    def _waves(self, a, gamma, octave, place, N):
        """d_m (B, N, G); cos κ, κγ, and the weights of the integral of L - 1 over κ, (B, G) each."""
        k, weight = quadrature(octave, place)  # in 1/c
        by = np.broadcast_to(k, (len(a), len(k)))
        L1 = excess(self.body, by * (self.body.h / (a * gamma))[:, None])
        kappa = k / gamma[:, None]
        return differences_at(N, kappa), np.cos(kappa), by, weight * L1 / gamma[:, None]


def ring_stress(part):
    """σ₀ (B,) of cases that give it or the range z₀ = w/(0.97 σ₀)."""
    return np.where(np.isnan(part.sigma0), part.w_adhesion / (0.97 * part.z0), part.sigma0)


def ring_pressure(part, zone, x):
    """The pressure (B, m) at x (m,) inside of the contact that the tension in the ring adds."""
    sigma = ring_stress(part)[:, None]
    edge = np.sqrt((zone - 1) * (zone + 1))[:, None]
    return sigma * (2 / np.pi * np.arctan2(np.sqrt((1 - x) * (1 + x)), edge) - 1)
