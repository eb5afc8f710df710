"""From a :class:`.problem.Problem` to the dimensionless :class:`.contact.equation.Cases`, and back to its units."""

from dataclasses import replace

import numpy as np

from .body.layered import Layer
from .body.springs import layer_modulus, local_compliance, thin_layer_coefficients
from .contact.equation import Cases
from .laws import LAWS
from .parameters import PARAMETERS, allowed
from .status import Status

#: n of a base that stands for a rigid one; its square and cube are still far from the least float.
_STIFF = 1e-50

#: Power of R and of E2* in the unit of each quantity.
_UNITS = {
    "a": (1, 0),
    "D": (1, 0),
    "A0": (1, 0),
    "p0": (0, 1),
    "p_max": (0, 1),
    "p": (0, 1),
    "P": (2, 1),
    "dP_dD": (1, 1),
}


def dimensionless(problem):
    """The problem in units R = E2* = 1, and C (B,) of Eq. (3) in them: 0 without a layer."""
    R, E2 = problem.R, problem.E2
    value = _without_unit(problem.value, (1, 2) if problem.control == "P" else (0, 1), R, E2)
    layered = problem.base != "half_space"
    h, n = problem.h / R, np.where(layered, problem.n, 1.0)
    springs = local_compliance(h, n, problem.nu1, problem.nu2, problem.bonding == "bonded")
    C = np.where(problem.base == "thin_layer", springs, 0.0)
    more = {name: _without_unit(v, PARAMETERS[name].powers, R, E2) for name, v in problem.more.items()}
    own = {name: _without_unit(getattr(problem, name), PARAMETERS[name].powers, R, E2) for name in ("Nbar", "Ra")}
    one = np.ones(len(problem))
    return replace(problem, value=value, h=h, n=n, R=one, E2=one, **own, more=more), C


def _without_unit(value, powers, R, E2):
    """`value` over E2^i R^j, (i, j) = `powers`; divided one by one, for R² may overflow where the quotient does not."""
    for unit, power in zip((R, E2), powers[::-1], strict=True):
        for _ in range(abs(power)):
            value = value / unit if power > 0 else value * unit
    return value


def with_rigid_punch(problem):
    """The problem with an elastic punch on a half-space or a thin layer as that of a rigid one: the same contact.

    Displacements add. On a half-space E2* becomes E2*/(1 + m). On a thin layer A1 becomes A1 + m: the body has the
    modulus E1*/(n + m), asperities feel Ec = E1*/(1 + m), and springs of the same C are those of a frictionless layer
    of thickness 2 A2 h/(1 + m). The exact layer stays as it is; so do thin layers without springs, or that it judges.
    """
    m, base = problem.m, problem.base
    if not (m > 0).any():
        return problem
    n = np.where(base == "half_space", 1.0, problem.n)
    _, A2 = thin_layer_coefficients(n, problem.nu1, problem.nu2, problem.bonding == "bonded")
    thin = (base == "thin_layer") & (A2 > 0) & (problem.model_check != "first_order")
    moved = (m > 0) & ((base == "half_space") | thin)
    return replace(
        problem,
        E2=np.where(moved, problem.E2 * layer_modulus(n) / (n + m), problem.E2),
        n=np.where(moved, (n + m) / (1 + m), problem.n),
        h=np.where(moved, 2 * A2 * problem.h / (1 + m), problem.h),
        bonding=np.where(moved, "frictionless", problem.bonding),
        m=np.where(moved, 0.0, m),
    )


def with_a_stiff_base(problem):
    """The problem with a thin layer on a rigid base, n = 0, as that on a half-space whose part is below rounding.

    The equation divides by the half-space's part, X, which must not be 0. At n = _STIFF it is below 1e-20 of that of
    the springs for every h and a within the bounds. Layers that are judged by the exact one stay as they are.
    """
    stiff = (problem.base == "thin_layer") & (problem.n == 0) & (problem.model_check != "first_order")
    if not stiff.any():
        return problem
    return replace(problem, n=np.where(stiff, _STIFF, problem.n), E2=np.where(stiff, problem.E2 / _STIFF, problem.E2))


def refused(problem, scaled):
    """(B,) bool: cases that cannot be solved as they are given; `scaled` is the problem in units R = E2* = 1."""
    units = [~allowed(PARAMETERS[name], getattr(problem, name)) for name in ("R", "E2")]
    return scaled.invalid() | units[0] | units[1]


def as_cases(part, C):
    """:class:`~solver.contact.equation.Cases` of one law on one base."""
    law = LAWS[str(part.micro[0])]
    E = layer_modulus(part.n) / (1 + part.m)
    law = law.bind(E, **{name: getattr(part, name) for name in law.parameters})
    none = np.zeros(len(part))
    layered = part.base[0] == "layered"
    layer = Layer(part.h, part.n, part.nu1, part.nu2, part.bonding == "bonded", part.m) if layered else None
    return Cases(part.control, law, layer, part.value, E if layered else none + 1, C, reach=none, coarse=none > 0)


def restore(solution, problem, without=()):
    """The end of every way to solve: back to the units of the problem, the controlled quantity exactly as given.

    A case with a number that cannot be is not converged, nor is one with a number that its unit makes infinite.
    `without`: names of the numbers that this way to solve does not give.
    """
    solution.refuse(solution.out_of_range(without), Status.DIVERGED)
    for name, (of_R, of_E2) in _UNITS.items():
        array = getattr(solution, name)
        factor = problem.R**of_R * problem.E2**of_E2
        array *= factor.reshape(-1, *[1] * (array.ndim - 1))
    solution.refuse(solution.not_finite(without), Status.DIVERGED)
    getattr(solution, problem.control)[:] = problem.value
