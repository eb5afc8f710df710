"""The fields of solved contacts, whose pressures at the nodes are solved for again at the radius of each."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..bases import is_bare, is_stack
from ..body.graded import is_graded
from ..kernels.two_layers import TwoLayers, layer_modulus
from ..layers import numbers_of
from ..numerics.ladder import STACK
from ..numerics.threads import one_blas_thread
from ..rough.answer import answer
from ..scaling import as_cases, dimensionless_pair
from ..sensitivity.same_mesh import meshes, solve_again, stacks
from ..sensitivity.solved_cases import solved_cases
from ..shapes import is_flat, shaped
from ..solve import solve
from ..status import Status
from ..ways import by_equation
from . import normal, sliding
from .field import integrals
from .pressure import Pressure
from .shaped import corners, shaped_pressures
from .stacks.section import INTERFACE, SUBLAYERS, Section
from .waves import MISSED, THINNEST

#: Largest rtol with which the pressure is solved for again, whatever that of the contact was.
_RTOL = 1e-8
#: Smallest error of the stresses; and below _DOUBTED the error of the pressure counts twice: in one of 300 contacts it
#: was 1.8 times too small there (tools/errors/stress_errors.py).
_LEAST, _DOUBTED = 1e-10, 2e-9
#: With the number of sublayers of a graded layer, the relative change of the stresses is at most this times that of the
#: load (tests/stacks/test_stresses_of_stacks.py).
_OF_GRADED = 3.0
#: Largest number of entries of an array of integrals of several cases.
_AT_ONCE = 4_000_000


class Fields(NamedTuple):
    """The fields of B contacts, in the units of their problem; NaN where the contact is not solved.

    inside : name -> (B, Z, R), at the given depths and radii: sr, st, sz, trz, ur, uz; with mu > 0 also the amplitudes
        of :func:`~.polynomial.of_pressure`
    above, below : name -> (B, J, R), at the interfaces, on their upper and on their lower side; J is the largest number
        of layers of a case; NaN without a layer
    error : (B,), error of any stress over the largest stress
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
    of the thin layer. An elastic punch only changes the pressure.

    problem, solution : B cases, and their :class:`~solver.solution.Solution`
    r, z : (R,), (Z,), radii and depths in units of a, >= 0
    mu : >= 0, the coefficient of friction
    """
    r, z = np.asarray(r, dtype=float), np.asarray(z, dtype=float)
    names = [*normal.NAMES, *(sliding.NAMES if mu > 0 else ())]
    J = max(1, numbers_of(problem.parameters))
    fields = {name: np.full((len(problem), len(z) + 2 * J, len(r)), np.nan) for name in names}
    error, index = np.full(len(problem), np.nan), np.flatnonzero(have_fields(problem, solution))
    if len(index):
        scaled, ended = dimensionless_pair(problem.take(index), solution.take(index))
        a = ended.a
        film = ~is_bare(scaled.base) & (scaled.h / a < THINNEST)
        for rows, pressure, missed in pressures_of(scaled, ended, a):
            here = index[rows]
            in_film = np.where(are_infinite(scaled.take(rows)), 1.0, MISSED)  # near an infinite edge it is unknown
            error[here] = np.maximum(missed, np.where(film[rows], in_film, 0.0))
            for some, field in _of_pressures(scaled.take(rows), a[rows], pressure, r, z, mu):
                units = problem.E2[here[some], None, None], solution.a[here[some], None, None]
                depths = np.append(np.arange(len(z)), len(z) + _ends(field["sr"].shape[1] - len(z), J))
                for name, values in field.items():
                    fields[name][here[some, None], depths] = values * units[name.startswith("u")]
        on_surface = np.isin(np.arange(len(z) + 2 * J), np.flatnonzero(z == 0))[:, None]
        at_tip = on_surface & (r == corners(scaled, a)[:, None])[:, None]
        fields["sz"][index] = np.where(at_tip, -np.inf, fields["sz"][index])
        infinite = np.isinf(fields["sz"])
        for name in ("sr", "st"):
            fields[name] = np.where(infinite, fields["sz"], fields[name])
    parts = (slice(len(z)), slice(len(z), len(z) + J), slice(len(z) + J, None))
    return Fields(*({name: values[:, part] for name, values in fields.items()} for part in parts), error)


def _ends(rows, J):
    """The places, among J upper and J lower sides of interfaces, of `rows` that are half upper and half lower sides."""
    return np.concatenate([np.arange(rows // 2), J + np.arange(rows // 2)])


def have_fields(problem, solution):
    """(B,) bool: solved contacts for which stresses can be computed. They cannot be yet if attraction acts outside the
    contact, or for rough punches that are not paraboloids."""
    without = (problem.w_adhesion > 0) & (problem.adhesion != "jkr")
    return (solution.status == Status.CONVERGED) & ~without & ~(shaped(problem) & problem.rough())


def are_infinite(problem):
    """(B,) bool: contacts whose stresses are infinite at the edge: those of flat punches, and those with adhesion."""
    return is_flat(problem) | (problem.w_adhesion > 0)


def pressures_of(scaled, solution, a, with_errors=True):
    """Yield indices of cases, their :class:`~.pressure.Pressure` in units of E2*, and its error (b,). On a graded layer
    the pressure is that with a number of sublayers. The load then differs from that of the solution, and the stresses
    by about as much.

    scaled, solution, a : in units R = E2* = 1, as :func:`~solver.scaling.dimensionless_pair` gives them
    with_errors : whether the error includes that of profiles, which takes as long as the pressure
    """
    graded = is_graded(scaled)
    if graded.any():
        cut = scaled.but(sublayers=np.where(graded, SUBLAYERS, scaled.sublayers))
        for rows, pressure, missed in pressures_of(cut, solution, a, with_errors):
            load = 2 * np.pi * a[rows] ** 2 * pressure.mean(np.ones(1))[:, 0]
            change = _OF_GRADED * np.abs(load / solution.P[rows] - 1)
            yield rows, pressure, missed + np.where(graded[rows], change, 0.0)
        return
    of_basis = by_equation(scaled, "basis")
    with_shape = np.flatnonzero(of_basis)
    for rows, pressure, missed in shaped_pressures(scaled.take(with_shape), a[with_shape], solution.D[with_shape]):
        yield with_shape[rows], pressure, missed + _LEAST
    others = np.flatnonzero(~of_basis)
    for rows, pressure, missed in _of_paraboloids(scaled.take(others), solution.take(others), a[others], with_errors):
        yield others[rows], pressure, missed


def _of_paraboloids(scaled, solution, a, with_errors):
    if not len(scaled):
        return
    named = solved_cases(scaled, solution.model_used).named
    fine = np.minimum(named.rtol, _RTOL)
    at_a = replace(named, control="a", value=a).but(rtol=fine, nodes=0, max_iterations=0)
    at_radii = solve(at_a)
    now = solved_cases(at_a, at_radii.model_used)
    for rows, nodes in stacks(now.written, meshes(at_radii, at_a), a, STACK):
        some = now.take(rows)
        iterated = solve_again(as_cases(some.written), nodes, a[rows], some.written.rtol)
        q, p_star = iterated.at.curve.q, iterated.at.cases.law.p_star * some.E2
        # panels may differ from those of the solution: their own error counts
        off = answer(iterated, np.zeros(0)).solution.profile_error if with_errors else 0.0
        error = np.where(iterated.closed, off, np.nan)
        pressure = Pressure(iterated.at.mesh, np.where(np.isfinite(error)[:, None], p_star[:, None] * q, np.nan))
        edge = np.abs(pressure.at_edge()) / np.abs(pressure.values).max(axis=1)  # should be 0, as it is in profiles
        error = error + edge
        yield rows, pressure, error + np.minimum(error, _DOUBTED) + _LEAST


def bodies_of(scaled, bare):
    """Layer and body of cases, :class:`~solver.kernels.two_layers.TwoLayers`. A bare half-space becomes a bonded layer
    on a body of the same material, whatever interface the problem has."""
    if not bare:
        return TwoLayers.of(scaled)
    return TwoLayers(np.ones(len(scaled)), scaled.nu2, scaled.nu2, np.ones(len(scaled), dtype=bool))


def _of_pressures(scaled, a, pressure, r, z, mu):
    """Yield indices of cases of one kind, and their fields, name -> (b, Z + 2J, R): at z, on the upper sides of all
    interfaces, and on their lower sides."""
    stacked = is_stack(scaled.base)
    for i in np.flatnonzero(stacked):
        yield np.array([i]), _of_stack(scaled.take([i]), a[[i]], pressure.take([i]), r, z, mu)
    others = np.flatnonzero(~stacked)
    if len(others):
        for some, field in _of_layers(scaled.take(others), a[others], pressure.take(others), r, z, mu):
            yield others[some], field


def _of_stack(scaled, a, pressure, r, z, mu):
    """As :func:`_of_pressures`, (1, Z + 2N, R), for one case on a stack of N layers."""
    section = Section.of(scaled, a, pressure, mu, np.zeros(max(1, numbers_of(scaled.parameters))))
    ends = section.ends
    N = len(ends)
    numbers = np.concatenate([section.numbers(z), np.arange(N), np.arange(1, N + 1)])
    field = section.field(r, np.concatenate([z, ends, ends]), numbers)
    return {name: values[None] for name, values in field.items()}


def _of_layers(scaled, a, pressure, r, z, mu):
    """As :func:`_of_pressures`, (b, Z + 2, R), for cases with one layer or none."""
    bare = is_bare(scaled.base)
    h = np.where(bare, 1.0, scaled.h / a)
    depths = np.concatenate([np.tile(z, (len(h), 1)), h[:, None], h[:, None]], axis=1)
    body = (depths > h[:, None] * INTERFACE) & ~bare[:, None]
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
                friction = sliding.components(integrals(sliding.SLIDING, layers, *here), G2[..., None])
                free = (~layers.bonded)[:, None, None]
                friction["ux_0"] = np.where(free, np.nan, friction["ux_0"])
                field |= {name: mu * values for name, values in friction.items()}
            if bare[some[0]]:
                for values in field.values():
                    values[:, -2:] = np.nan
            yield some, field
