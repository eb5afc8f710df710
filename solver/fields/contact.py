"""The fields of solved contacts: pressures at the nodes are found again, at the radius of each."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..bases import is_bare, is_stack
from ..kernels.two_layers import TwoLayers, layer_modulus
from ..numerics.ladder import STACK
from ..numerics.threads import one_blas_thread
from ..rough.answer import answer
from ..scaling import as_cases, dimensionless
from ..sensitivity.same_mesh import found_again, meshes, stacks
from ..sensitivity.solved_cases import solved_cases
from ..shapes import is_flat, shaped
from ..solve import solve
from ..status import Status
from ..ways import by_equation
from . import normal, sliding
from .field import integrals
from .pressure import Pressure
from .shaped import corners, shaped_pressures
from .waves import MISSED, THINNEST

#: The pressure is solved again with at most this rtol, whatever that of the contact was.
_RTOL = 1e-8
#: Least error of the stresses: `profile_error` says less than that where it may be twice too small
#: (tools/errors/stress_errors.py).
_LEAST = 1e-10
#: Numbers in an array of the integrals of several cases.
_AT_ONCE = 4_000_000


class Fields(NamedTuple):
    """The fields of B contacts, in the units of their problem; NaN where the contact is not solved.

    inside : name -> (B, Z, R), at the depths and radii that were asked for: sr, st, sz, trz, ur, uz; with mu > 0 also
        the amplitudes of :func:`~.polynomial.of_pressure`
    above, below : the same at the interface, (B, R), in the layer and in the body; NaN without a layer
    error : (B,), of any stress, over the largest
    """

    inside: dict
    above: dict
    below: dict
    error: np.ndarray


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def of_contacts(problem, solution, r, z, mu=0.0):
    """:class:`Fields` of solved contacts, a batch of any mixture.

    Each contact is solved again with its radius given. A thin layer has the field of the exact layer under the pressure
    of the thin one; an elastic punch changes the pressure alone.

    problem, solution : B cases and their :class:`~solver.solution.Solution`, of which a, status and model_used count
    r, z : (R,), (Z,), radii and depths in units of a, >= 0
    mu : >= 0, the coefficient of friction
    """
    r, z = np.asarray(r, dtype=float), np.asarray(z, dtype=float)
    names = [*normal.NAMES, *(sliding.NAMES if mu > 0 else ())]
    made = {name: np.full((len(problem), len(z) + 2, len(r)), np.nan) for name in names}
    error, index = np.full(len(problem), np.nan), np.flatnonzero(have_fields(problem, solution))
    if len(index):
        part, ended = problem.take(index), solution.take(index)
        scaled, a = dimensionless(part), ended.a / part.R
        film = ~is_bare(scaled.base) & (scaled.h / a < THINNEST)
        for rows, pressure, missed in pressures_of(scaled, ended, a):
            here = index[rows]
            in_film = np.where(are_infinite(scaled.take(rows)), 1.0, MISSED)  # next to an infinite edge, unknown
            error[here] = np.maximum(missed, np.where(film[rows], in_film, 0.0))
            for some, field in _of_pressures(scaled.take(rows), a[rows], pressure, r, z, mu):
                units = problem.E2[here[some], None, None], solution.a[here[some], None, None]
                for name, values in field.items():
                    made[name][here[some]] = values * units[name.startswith("u")]
        on_surface = np.isin(np.arange(len(z) + 2), np.flatnonzero(z == 0))[:, None]
        at_tip = on_surface & (r == corners(scaled, a)[:, None])[:, None]
        made["sz"][index] = np.where(at_tip, -np.inf, made["sz"][index])
        infinite = np.isinf(made["sz"])
        for name in ("sr", "st"):
            made[name] = np.where(infinite, made["sz"], made[name])
    parts = (slice(None, len(z)), len(z), len(z) + 1)
    return Fields(*({name: values[:, part] for name, values in made.items()} for part in parts), error)


def have_fields(problem, solution):
    """(B,) bool: solved contacts of which there are stresses. There are none yet of stacks, of what attracts outside
    of the contact, and of rough punches of other shapes than the paraboloid."""
    without = is_stack(problem.base) | ((problem.w_adhesion > 0) & (problem.adhesion != "jkr"))
    return (solution.status == Status.CONVERGED) & ~without & ~(shaped(problem) & problem.rough())


def are_infinite(problem):
    """(B,) bool: contacts whose stresses are infinite at the edge, as those of flat punches and of what sticks."""
    return is_flat(problem) | (problem.w_adhesion > 0)


def pressures_of(scaled, solution, a):
    """Yield indices of cases, their :class:`~.pressure.Pressure` in units of E2*, and its error (b,)."""
    of_basis = by_equation(scaled, "basis")
    with_shape = np.flatnonzero(of_basis)
    depths = solution.D[with_shape] / scaled.R[with_shape]
    for rows, pressure, missed in shaped_pressures(scaled.take(with_shape), a[with_shape], depths):
        yield with_shape[rows], pressure, missed + _LEAST
    others = np.flatnonzero(~of_basis)
    for rows, pressure, missed in _of_paraboloids(scaled.take(others), solution.take(others), a[others]):
        yield others[rows], pressure, missed


def _of_paraboloids(scaled, solution, a):
    if not len(scaled):
        return
    named = solved_cases(scaled, solution.model_used).named
    fine = np.minimum(named.rtol, _RTOL)
    at_a = replace(named, control="a", value=a).but(rtol=fine, nodes=0, max_iterations=0)
    again = solve(at_a)
    now = solved_cases(at_a, again.model_used)
    for rows, nodes in stacks(now.written, meshes(again, at_a), a, STACK):
        some = now.take(rows)
        iterated = found_again(as_cases(some.written), nodes, a[rows], some.written.rtol)
        q, p_star = iterated.at.curve.q, iterated.at.cases.law.p_star * some.E2
        # panels may be others than those of the solution: their own error counts
        error = np.where(iterated.closed, answer(iterated, np.zeros(0)).solution.profile_error, np.nan)
        pressure = Pressure(iterated.at.mesh, np.where(np.isfinite(error)[:, None], p_star[:, None] * q, np.nan))
        edge = np.abs(pressure.at_edge()) / np.abs(pressure.values).max(axis=1)  # ought to be 0, and profiles say so
        yield rows, pressure, error + edge + _LEAST


def bodies_of(scaled, bare):
    """Layer and body of cases, :class:`~solver.kernels.two_layers.TwoLayers`; of bare half-spaces two of one material,
    bonded, whatever the problem says of an interface."""
    if not bare:
        return TwoLayers.of(scaled)
    return TwoLayers(np.ones(len(scaled)), scaled.nu2, scaled.nu2, np.ones(len(scaled), dtype=bool))


def _of_pressures(scaled, a, pressure, r, z, mu):
    """Yield indices of cases of one kind, and their fields, name -> (b, Z + 2, R): at z, and on both sides of the
    interface."""
    bare = is_bare(scaled.base)
    h = np.where(bare, 1.0, scaled.h / a)
    depths = np.concatenate([np.tile(z, (len(h), 1)), h[:, None], h[:, None]], axis=1)
    body = (depths > h[:, None]) & ~bare[:, None]
    body[:, -1] = ~bare
    kinds = np.stack([bare, np.floor(np.log2(h)), *body.T], axis=1)
    _, kind = np.unique(kinds, axis=0, return_inverse=True)
    most = max(_AT_ONCE // (len(r) * depths.shape[1]), 1)
    for number in range(kind.max() + 1):
        index = np.flatnonzero(kind.ravel() == number)
        for some in np.array_split(index, -(-len(index) // most)):
            rows, layers = (depths[some], body[some[0]]), bodies_of(scaled.take(some), bare[some[0]])
            here = h[some], pressure.take(some), r, *rows
            G2 = np.where(rows[1], 1 - layers.nu2[:, None], (layer_modulus(layers.n) * (1 - layers.nu1))[:, None])
            field = normal.components(integrals(normal.NORMAL, layers, *here), G2[..., None])
            if mu > 0:
                rubbed = sliding.components(integrals(sliding.SLIDING, layers, *here), G2[..., None])
                free = (~layers.bonded)[:, None, None]
                rubbed["ux_0"] = np.where(free, np.nan, rubbed["ux_0"])
                field |= {name: mu * values for name, values in rubbed.items()}
            if bare[some[0]]:
                for values in field.values():
                    values[:, -2:] = np.nan
            yield some, field
