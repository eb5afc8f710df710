"""The largest stress under the asperities of solved contacts: the sum, as tensors on the axis of each spot, of the
stress of the spot and that of the contact as a whole (docs/stresses.md, Asperities)."""

from dataclasses import replace

import numpy as np

from ..bases import is_bare
from ..fields.contact import have_fields, pressures_of
from ..fields.invariants import mises
from ..kernels.two_layers import layer_modulus
from ..numerics.quadrature import gauss_legendre
from ..numerics.threads import one_blas_thread
from ..scaling import dimensionless_pair
from ..solve import solve
from ..status import Status
from .asperities import POINTS, hertz_part
from .below import felt_spots
from .below.felt_cells import felt_cells
from .contact import alike
from .peaks import between, chebyshev_nodes, in_patch

#: The grid of spots: number of radii r, nodes of the angle arcsin(r/a); number of depths; and the smallest and largest
#: depth, in b. The stresses are polynomials through these nodes (tests/yields/test_spots.py has twice as many).
_SPOTS, _DEPTHS, _ENDS = 17, 20, (0.1, 1.5)
_RADII = np.sin(np.pi / 4 * (1 + chebyshev_nodes(_SPOTS)))
_Z = _ENDS[0] + (_ENDS[1] - _ENDS[0]) * (1 + chebyshev_nodes(_DEPTHS)) / 2
#: The stress of the contact as a whole, between the surface and the deepest place, is a polynomial through _MANY
#: depths, or through _FEW if b is below _SMALL a.
_MANY, _FEW, _SMALL = 8, 4, 0.02
#: A spot at the edge has no size. This b/B̄ stands for it.
_LEAST = 1e-6
#: Laws whose λ is that of one spot in its cell at any radius. For other laws only the spot in the centre is known.
_CELLS = ("disc_cell", "elastic_plastic")


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def of_contacts(problem, solution, mu=0.0, residual=0.0):
    """(3, B): the largest von Mises stress in the unit of E2, and the radius (signed if mu > 0) and depth in a of its
    place. NaN for smooth contacts and for contacts that are not solved.

    The asperities are elastic: if the law has spots that yield, the spots are those of an elastic disc cell. For
    lattices and random heights it is the stress of the largest spot in the centre.

    problem, solution : B cases, and their :class:`~solver.solution.Solution`
    mu : >= 0, friction; residual : (B,) or a number, biaxial stress of the layer, in the unit of E2
    """
    largest = np.full((3, len(problem)), np.nan)
    rough = np.isfinite(problem.Nbar) & np.isfinite(problem.Ra) & problem.rough()
    there, felt = (solution.status == Status.CONVERGED) & rough, problem.feels_layer()
    residual = np.broadcast_to(residual, len(problem)) / problem.E2
    for some, stress in (there & ~felt, _on_half_space), (there & felt & have_fields(problem, solution), _on_body):
        index = np.flatnonzero(some)
        if len(index):
            part = problem.take(index)
            scaled, ended = dimensionless_pair(part, solution.take(index))
            a = ended.a
            at_radii = with_elastic_spots(scaled, a, _RADII)
            for rows, pressure, _ in pressures_of(scaled, ended, a):
                for few, loaded in alike(scaled.take(rows), a[rows], pressure, mu, residual[index[rows]]):
                    here = rows[few]
                    largest[:, index[here]] = stress(loaded, scaled.take(here), a[here], at_radii.take(here))
            largest[0, index] *= part.E2
    return largest


def with_elastic_spots(scaled, a, x):
    """The :class:`~solver.solution.Solution` of contacts of radius a with elastic spots, with profiles at x."""
    at_a = scaled.but(micro=np.where(scaled.micro == "elastic_plastic", "disc_cell", scaled.micro))
    return solve(replace(at_a, control="a", value=a), x)


def _on_body(loaded, scaled, a, at_radii):
    """(3, B), as :func:`_largest`, for asperities that feel the coated body."""
    return felt_spots.largest_stress(loaded, felt_cells(scaled, a, at_radii.lam, at_radii.p0), _RADII)


def _on_half_space(loaded, scaled, a, at_radii):
    """(3, B), as :func:`_largest`, for asperities on a half-space."""
    c, p0s = _of_spots(scaled, at_radii)
    b = c / np.sqrt(np.pi * scaled.Nbar[:, None]) / a[:, None]
    return _largest(loaded, np.where(loaded.bare, scaled.nu2, scaled.nu1), c, p0s, b)


def _of_spots(scaled, at_radii):
    """b/B̄ and Hertz's part of the largest pressure of the spots at :data:`_RADII`, (B, R) each; NaN where no spot is
    known."""
    E = np.where(is_bare(scaled.base), 1.0, layer_modulus(scaled.n)) / (1 + scaled.m)
    c = np.where(np.isin(scaled.micro, _CELLS)[:, None], np.maximum(np.sqrt(at_radii.lam), _LEAST), np.nan)
    p0s = 2 * E[:, None] * c / (np.pi * np.sqrt(np.pi * scaled.Nbar) * scaled.Ra)[:, None]
    central = hertz_part(at_radii.p_max, at_radii.p0, E, scaled.Nbar, scaled.Ra)
    p0s[:, :1], c[:, :1] = (values[:, None] for values in central)
    return c, p0s


def _largest(loaded, nu, c, p0s, b):
    """(3, B): the largest stress, its radius and depth in a. b : (B, R), in a."""
    cell = _cell(nu[:, None], c, p0s, loaded.pressure.at(_RADII))
    count = _FEW if np.nanmax(b) < _SMALL else _MANY
    # the stress of the layer ends at the interface; larger spots have the stress there
    deepest = np.minimum(_ENDS[1] * np.nanmax(b, axis=1), np.inf if loaded.bare else loaded.h)
    whole = loaded.stresses(_RADII, deepest[:, None] * (1 + chebyshev_nodes(count)) / 2, loaded.bare)
    places = np.full((3, len(c)), np.nan)
    for i in range(len(c)):
        spots = slice(None) if np.isfinite(c[i]).all() else slice(1)  # at all radii, or in the centre
        share = np.minimum(b[i, spots, None] * _Z / deepest[i], 1.0)  # (R, Z)
        matrix = between((2 * share - 1).ravel(), count).reshape(*share.shape, count)
        for side, sign in enumerate(loaded.signs):
            stresses = np.einsum("rdz,fzr->fdr", matrix, whole[:, i, side, :, spots])
            stresses[:2] += cell[0, i, spots].T
            stresses[2] += cell[1, i, spots].T
            largest, (u, v) = in_patch(stresses, mises)
            if not largest <= places[0, i]:
                alone = stresses.shape[2] == 1
                r, size = (0.0, b[i, 0]) if alone else (np.sin(np.pi / 4 * (1 + u)), between([u], _SPOTS)[0] @ b[i])
                depth = _ENDS[0] + (_ENDS[1] - _ENDS[0]) * (1 + v) / 2
                places[:, i] = largest, sign * r + 0.0, depth * size
    return places


def _cell(nu, c, p0s, p):
    """sr = st and sz (2, B, R, Z) on the axes of spots, at the depths _Z in b, by a spot less p on its cell."""
    x, weight = gauss_legendre(POINTS)
    angle = np.arcsin(c)[..., None] * x
    t = np.sin(angle) / c[..., None]
    density = p0s[..., None] * t * np.cos(angle) / c[..., None] + 2 / np.pi * p[..., None] * t
    density = density * np.arcsin(c)[..., None] * weight
    z = _Z[:, None]
    kernel = (density * t)[..., None, :] / (z * z + (t * t)[..., None, :])
    E, F = kernel.sum(axis=-1), (kernel * 2 * z * z / (z * z + (t * t)[..., None, :])).sum(axis=-1)
    z, nu, p = _Z, nu[..., None], p[..., None]
    cos = z / np.hypot(1 / c[..., None], z)
    sr = (F - (1 + 2 * nu) * E) / 2 + p / 2 * (1 + 2 * nu - 2 * (1 + nu) * cos + cos**3)
    return np.stack([sr, -(E + F) + p * (1 - cos**3)])
