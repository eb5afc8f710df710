"""The start of the iteration: closed forms of radius and pressure, and the mesh that a case is likely to need."""

import numpy as np

from ..numerics.linalg import solve_stack
from .equation import Unknowns, evaluate, groups
from .punch import largest

#: The first guess of the pressure is nowhere below this part of the largest.
_LEAST = 1e-12


def guess_radius(cases):
    """Contact radius (B,): the given radius, or a guess from the load or depth. The guess combines the radii of a
    half-space, springs and asperities, each alone."""
    if cases.control == "a":
        return cases.value
    if cases.is_flat:
        return cases.shape.least()
    punch, body, law, value = cases.punch, cases.body, cases.law, cases.value
    if cases.control == "D":
        return punch.radius_at_depth(value)
    springs = punch.on_springs(value, body.C)
    gamma, beta = law.edge()  # asperities of A ~ p^β
    spots = punch.on_asperities(value, law.p_star, law.A_star * gamma, 1 / beta)
    a, softness = np.inf, np.ones(len(value))
    for _ in range(7):  # the modulus that the contact feels depends on its radius
        before, a = a, _together(cases.shape, punch.on_half_space(value, body.E, softness), springs, spots)
        if np.array_equal(a, before):
            break
        softness = body.softness(a)
    return a


def _together(shape, *radii):
    """Contact radius (B,) of body, springs and asperities together, from the `radii` (B,) of each alone."""
    least = shape.least()
    a = least + sum(np.maximum(radius - least, 0.0) ** 4 for radius in radii) ** 0.25
    return np.minimum(a, (np.max(radii, axis=0) + shape.most()) / 2)


def guess_pressure(cases, a, s):
    """q (B, m) at s (m,) > 0 in contacts of radius a (B,). 1/q is the sum of the 1/q of half-space, springs and
    asperities alone. So it is exact where one of them is far more compliant than the others."""
    X, Y, Z = groups(cases, np.log(a))
    base = cases.punch.stiffness(a, s, X * cases.body.softness(a)[:, None], Y)
    return 1 / (base + 1 / cases.law.sparse(cases.punch.drop(a, s) / Z))


def first_guess(cases, mesh, a=None):
    """:class:`Unknowns` on a mesh from :func:`guess_pressure` at the radii a (B,), or at :func:`guess_radius` if a is
    None."""
    a = guess_radius(cases) if a is None else a
    return Unknowns(cases.law.guess(guess_pressure(cases, a, mesh.s)), np.log(a))


def smooth_start(cases, mesh):
    """The equation for given radii (control "a") at a first guess: 1/q is the sum of the 1/q of the smooth contact and
    of the asperities alone."""
    eta, drop = np.log(cases.value), cases.punch.drop(cases.value, mesh.s)
    X, Y, Z = groups(cases, eta)
    operator = cases.body.at(np.exp(eta), mesh)
    smooth = solve_stack(operator.K, Y / X * np.ones(mesh.n), (drop / X)[..., None])[..., 0]
    smooth = np.maximum(smooth, _LEAST * smooth.max(axis=1, keepdims=True))
    y = cases.law.guess(1 / (1 / smooth + 1 / cases.law.sparse(drop / Z)))
    return evaluate(cases, Unknowns(y, eta), mesh, operator)


def nodes_wanted(cases, rtol, a):
    """Number of nodes (B,) that just about meets rtol (B,) at the radii a (B,), by a fit to random cases. With
    asperities it falls with the width of the ring at the edge in which they are more compliant than the body; under a
    smooth punch it falls with the thickness of the layer."""
    if not cases.law.rough:
        return cases.body.first_nodes(rtol, a, None)
    q = guess_pressure(cases, a, np.ones(1))
    displacement = groups(cases, np.log(a))[2] * cases.law.evaluate(cases.law.guess(q)).g
    share = displacement[:, 0] / largest(cases.punch, a)
    return cases.body.first_nodes(rtol, a, cases.law.law.rise * np.clip(np.nan_to_num(share), 0.0, 1.0))
