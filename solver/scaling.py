"""The way from a :class:`.problem.Problem` to the dimensionless :class:`.rough.equation.Cases`, and back to its
units."""

from dataclasses import replace

import numpy as np

from . import shapes
from .bases import is_bare, is_stack, is_thin_layer, on_springs
from .body import BODIES
from .body.graded import graded_first
from .body.half_space import STIFF, local_compliance
from .body.stacked import layers_of, stack, thin_stack
from .kernels.two_layers import TwoLayers, layer_modulus, thin_layer_coefficients
from .laws import try_out
from .numerics.batch import alike
from .parameters import COMMON, CONTROL, allowed
from .rough.equation import Cases
from .solution import PULLS
from .status import Status

#: Codes of :func:`kinds_of_laws`: the bodies on which asperities press.
_HALF_SPACE, _BODY, _GRADED = 0, 1, 2
#: A graded layer that asperities feel is cut into _SUBLAYERS in each octave of the depth, in at most _MOST_OCTAVES. The
#: pitch is then at most _WIDEST times the thinnest sublayer: spots feel the gradient over their own size, and thinner
#: sublayers take seconds (tests/stacks/test_felt.py has finer ones).
_SUBLAYERS, _MOST_OCTAVES, _WIDEST = 4, 4, 100.0
#: (i, j) of the unit E2*^i R^j of each quantity that has a unit.
_UNITS = {"A0": (0, 1), "p0": (1, 0), "p_max": (1, 0), "p": (1, 0), "dP_dD": (1, 1)}
_UNITS = _UNITS | {name: row.powers for name, row in CONTROL.items()}
_UNITS = _UNITS | {name: CONTROL[name.partition("_")[0]].powers for name in PULLS}


def dimensionless(problem):
    """The problem in units R = E2* = 1; without a layer n is 1."""

    def number(values, powers):
        """The values over E2^i R^j, in single divisions: R² may overflow where the quotient does not."""
        for unit, power in zip((problem.R, problem.E2), powers[::-1], strict=True):
            for _ in range(abs(power)):
                values = values / unit if power > 0 else values * unit
        return values

    n = np.where(is_bare(problem.base), 1.0, problem.n)
    if without_units(problem):
        return replace(problem, parameters=problem.parameters | {"n": n})
    powers = {name: problem.known.parameters[name].powers for name in problem.parameters}
    numbers = {name: number(problem.parameters[name], pair) for name, pair in powers.items() if any(pair)}
    ones = np.ones(len(problem))
    numbers |= {"n": n, "R": ones, "E2": ones}
    value = number(problem.value, CONTROL[problem.control].powers)
    return replace(problem, value=value, parameters=problem.parameters | numbers)


def dimensionless_pair(problem, solution):
    """The problem in units R = E2* = 1, and its solution with radius, load and depth in these units."""
    controls = {
        name: getattr(solution, name) / (problem.E2**of_E2 * problem.R**of_R)
        for name, (of_E2, of_R) in _UNITS.items()
        if name in CONTROL
    }
    return dimensionless(problem), replace(solution, **controls)


def without_units(problem):
    """Whether R and E2* are 1 in all cases, so that nothing need be divided or multiplied by them."""
    return bool((problem.R == 1).all() and (problem.E2 == 1).all())


def with_rigid_punch(problem):
    """An equivalent problem, in which elastic punches on half-spaces and thin layers are replaced by rigid ones.

    The displacements of both bodies add. On a half-space E2* becomes E2*/(1 + m). On a thin layer A1 becomes A1 + m:
    its half-space has the modulus E1*/(n + m), asperities feel Ec = E1*/(1 + m), and springs of the same C are those of
    a frictionless layer of thickness 2 A2 h/(1 + m). Exact layers do not change, nor do thin layers to which Eq. (3)
    does not apply, or whose model error comes from the exact layer (`model_check` "first_order").
    """
    m, base = problem.m, problem.base
    if not (m > 0).any():
        return problem
    n = np.where(is_bare(base), 1.0, problem.n)
    _, A2 = thin_layer_coefficients(n, problem.nu1, problem.nu2, problem.bonding == "bonded")
    thin = is_thin_layer(base) & (A2 > 0) & (problem.model_check != "first_order")
    moved = (m > 0) & (is_bare(base) | thin)
    return problem.but(
        E2=np.where(moved, problem.E2 * layer_modulus(n) / (n + m), problem.E2),
        n=np.where(moved, (n + m) / (1 + m), problem.n),
        h=np.where(moved, 2 * A2 * problem.h / (1 + m), problem.h),
        bonding=np.where(moved, "frictionless", problem.bonding),
        m=np.where(moved, 0.0, m),
    )


def with_a_stiff_base(problem):
    """The problem, in which rigid bases, n = 0, under thin layers are replaced by half-spaces whose displacement is
    below rounding. Cases whose model error comes from the exact layer do not change."""
    stiff = is_thin_layer(problem.base) & (problem.n == 0) & (problem.model_check != "first_order")
    if not stiff.any():
        return problem
    return problem.but(n=np.where(stiff, STIFF, problem.n), E2=np.where(stiff, problem.E2 / STIFF, problem.E2))


def refused(problem, scaled):
    """(B,) bool: cases with a number that makes them unsolvable; `scaled` is the problem in units R = E2* = 1."""
    units = [~allowed(COMMON[name], getattr(problem, name)) for name in ("R", "E2")]
    return scaled.invalid() | units[0] | units[1]


def without_springs(scaled):
    """(B,) bool: thin layers to which Eq. (3) does not apply, because C <= 0."""
    without = is_thin_layer(scaled.base)
    if without.any():
        without = without & ~(local_compliance(scaled.h, TwoLayers.of(scaled)) > 0)
    stacks = np.flatnonzero(is_stack(scaled.base) & on_springs(scaled.base))
    if len(stacks):
        without[stacks] = ~(thin_stack(scaled.take(stacks)).C > 0)
    return without


def as_cases(part):
    """:class:`~solver.rough.equation.Cases` of a problem whose cases share the law, the base and the shape."""
    body = BODIES[str(part.base[0])](part)
    return Cases(part.control, law_of(part, body), body, part.value, shapes.shape_of(part))


def kinds_of_laws(problem):
    """(B,) int8: the body on which the asperities of each case press. _HALF_SPACE; _BODY, the coated body; or, if its
    first layer is graded, _GRADED plus the number of octaves into which that layer is cut."""
    kinds = np.where(problem.feels_layer(), _BODY, _HALF_SPACE).astype(np.int8)
    if not kinds.any():
        return kinds
    if np.any(cut := graded_first(problem) & (kinds == _BODY)):
        part = problem.take(cut)
        finest = _WIDEST * np.sqrt(part.Nbar) * part.h / _SUBLAYERS
        kinds[cut] = _GRADED + np.clip(np.floor(np.log2(finest)), 0, _MOST_OCTAVES)
    return kinds


def felt_body(part, body=None):
    """The body that the asperities of cases feel, for :func:`law_of`; None if they press on a half-space."""
    kind = kinds_of_laws(part)[0] if len(part) else _HALF_SPACE
    if kind == _HALF_SPACE:
        return None
    if kind >= _GRADED:
        _, sublayers, octaves = felt_sublayers(part)
        return stack(part.but(sublayers=sublayers), octaves=octaves)
    return BODIES[str(part.base[0])](part) if body is None else body


def felt_sublayers(part):
    """The layers of cases whose first one is graded, :func:`.body.stacked.layers_of`; the number (B,) of sublayers in
    an octave of the depth below asperities; and the number of octaves of the first layer."""
    return layers_of(part), np.full(len(part), _SUBLAYERS), int(kinds_of_laws(part)[0]) - _GRADED


def law_of(part, body=None):
    """The law of the cases with their numbers, :class:`~solver.laws.Bound`; it is that on their bodies if the
    asperities feel these. Raises ValueError if :func:`~solver.laws.try_out` detects a mistake in a user's law.

    part : cases that share the law, the base, and the answer of :func:`kinds_of_laws`
    body : their body, if the caller has it
    """
    law, felt = part.known.laws[str(part.micro[0])], felt_body(part, body)
    values = {name: getattr(part, name) for name in law.arguments}
    if felt:
        return law.on_body(felt.kernel, felt.m, felt.h, felt.E, **values)
    E = layer_modulus(part.n) / (1 + part.m)
    try_out(law, E, values)
    return law.bind(E, **values)


def of_one_law(problem):
    """Groups of cases that :func:`law_of` can bind together: a list of indices (b,)."""
    kinds = kinds_of_laws(problem)
    bases = np.where(kinds == _HALF_SPACE, "", problem.base)
    return alike(problem.micro, bases, kinds)


def restore(solution, problem):
    """The solution in the units of the problem: every way to solve ends here. A case with an impossible number, or one
    that its unit makes infinite, gets ``Status.DIVERGED``."""
    pulls, unknown = problem.w_adhesion > 0, without_centre(problem)
    solution = solution.refused(solution.out_of_range(pulls, unknown), Status.DIVERGED)
    arrays, have_units = {}, not without_units(problem)
    for name, (of_E2, of_R) in _UNITS.items():
        array = arrays[name] = getattr(solution, name).copy()
        if have_units:
            factor = problem.R**of_R * problem.E2**of_E2
            array *= factor.reshape(-1, *[1] * (array.ndim - 1))
    solution = replace(solution, **arrays)
    return solution.refused(solution.not_finite(shapes.shaped(problem) | pulls, unknown), Status.DIVERGED)


def without_centre(problem):
    """(B,) bool: cases whose pressure on the axis is unknown: rough ones under a point
    (:func:`~solver.rough.results.pointed`)."""
    without, shaped = np.zeros(len(problem), dtype=bool), shapes.shaped(problem) & problem.rough()
    for word in np.unique(problem.shape[shaped]).tolist():
        index = np.flatnonzero(shaped & (problem.shape == word))
        without[index] = shapes.shape_of(problem.take(index)).pointed
    return without
