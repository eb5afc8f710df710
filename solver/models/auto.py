"""The base "auto": each case is solved by the cheapest model that is accurate enough, and says which one that was.

The models are rungs, from closed form to the exact layer. A batch goes down them by index sets: a case tries a rung
that closed forms call promising, is judged by its estimated model error (:mod:`.model_error`), and stays there or goes
on; what is left at the end is solved on the exact layer. A model that fails costs a case time, never its result.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..body.kernel import layered_kernel
from ..body.springs import local_compliance
from ..contact.start import guess_radius
from ..laws import LAWS, smooth
from ..numerics.mesh import mesh
from ..numerics.quadrature import gauss_legendre
from ..scaling import as_cases, law_of
from ..solution import Model, Solution
from ..status import Status
from .model_error import MARGIN, TRUSTED, closed_form, first_order, nodes_for

#: A rung that is bound to fail is cheaper left out: the error of leaving out the asperities is about this times
#: (A[p(0)]/a²)^0.75, that of dropping the layer this times the change of the kernel, at given load, radius, depth.
_ASPERITIES = {"P": 0.8, "a": 2.3, "D": 0.9}
_LAYER = {"P": 0.8, "a": 2.5, "D": 1.0}

_BY_NAME = {"half_space": Model.HALF_SPACE, "thin_layer": Model.THIN_LAYER, "layered": Model.LAYERED}


class Rung(NamedTuple):
    """A model, whether it is smooth, the problem it solves, and the closed form of its error without asperities."""

    model: Model
    smooth: bool
    problem: Callable
    expected: Callable


def model_of(problem):
    """:class:`Model` (B,) int8 of cases whose base is named; NONE of "auto"."""
    used, rough = np.zeros(len(problem), dtype=np.int8), problem.rough()
    for base, model in _BY_NAME.items():
        of_base = problem.base == base
        used[of_base] = np.where(rough[of_base], model, model + 1)
    return used


def cheapest(problem, x, solve):
    """:class:`Solution` of cases in units R = E2* = 1, each on the cheapest model that meets its accuracy.

    problem : all of base "auto"; x : (m,) radii; solve : ``solve(problem, x)`` for the bases with a name.
    """
    nodes, pieces = nodes_for(problem.accuracy), []
    for micro, n in sorted(set(zip(problem.micro.tolist(), nodes.tolist(), strict=True))):
        index = np.flatnonzero((problem.micro == micro) & (nodes == n))
        pieces += [(index[rows], found) for rows, found in _descend(problem.take(index), n, x, solve)]
    return Solution.join(len(problem), len(x), pieces)


def judged(problem, x, solve):
    """:class:`Solution` of thin layers in units R = E2* = 1, with the model error of first order, no margin."""
    pieces, n = [], int(nodes_for(np.zeros(1))[0])
    for micro in np.unique(problem.micro):
        index = np.flatnonzero(problem.micro == micro)
        part = replace(problem.take(index), model_check=np.full(len(index), "closed_form"))
        found = solve(part, np.concatenate([x, mesh(n).x]))
        error = _model_error(part, found, n, found.p[:, len(x) :])
        pieces.append((index, replace(_shown(found, len(x)), model_error=error)))
    return Solution.join(len(problem), len(x), pieces)


def _descend(part, n, x, solve):
    """Solve the cases `part` of one micro law, judged on n nodes: list of (index, Solution)."""
    expected, law = _expected_errors(part), LAWS[str(part.micro[0])]
    left, pieces = np.arange(len(part)), []
    for rung in RUNGS:
        if rung.model == Model.LAYERED or not (law.rough or rung.smooth):
            continue
        tried = left[MARGIN * expected[rung.model][left] < part.accuracy[left]]
        if len(tried):
            found = _on_rung(rung, part.take(tried), n, x, solve)
            allowed = np.minimum(part.accuracy[tried], MARGIN * TRUSTED)
            good = np.flatnonzero((found.status == Status.CONVERGED) & (found.model_error <= allowed))
            pieces.append((tried[good], found.take(good)))
            left = np.setdiff1d(left, tried[good], assume_unique=True)
    if len(left):
        pieces.append((left, solve(_with(part.take(left), base="layered"), x)))
    return pieces


def _on_rung(rung, part, n, x, solve):
    """:class:`Solution` of the cases `part` on one rung, with its asperities and model error."""
    asperities = rung.smooth and LAWS[str(part.micro[0])].rough
    s, weight = _area_rule()
    points = [x, mesh(n).x, np.sqrt((1 - s) * (1 + s))]
    problem = rung.problem(part)
    if asperities:
        problem = _with(problem, micro=smooth.LAW.name, scheme="newton")
    found = solve(problem, np.concatenate(points))
    _, at_nodes, at_area = np.split(found.p, np.cumsum([len(v) for v in points[:-1]]), axis=1)
    if asperities:
        found = replace(found, **_asperities(part, found, at_area, weight))
    error = MARGIN * _model_error(part, found, n, at_nodes, 1 + asperities)
    model = np.full(len(part), rung.model, dtype=np.int8)
    return replace(_shown(found, len(x)), model_error=error, model_used=model)


def _area_rule():
    """Nodes s and weights of ∫₀¹ λ s ds; s = t³ because λ of a smooth punch rises like s^(2/3) from the edge."""
    t, w = gauss_legendre(24)
    return t**3, 3 * w * t**5


def _asperities(part, found, p, weight):
    """What Eqs (6), (11)-(13) make of the pressure of a smooth solution; p (B, m) at the points of the area rule."""
    law = law_of(part)
    centre = law.at(found.p0[:, None])
    return {
        "A0": centre.A[:, 0],
        "p_max": centre.p_max[:, 0],
        "Ar_An": 2 * law.at(p).lam @ weight,
        "lam": law.at(found.p).lam,
    }


def _model_error(part, found, n, p, steps=1):
    """Estimated model error (B,) without margin of the solution `found` of the cases `part`; p at the nodes."""
    cases = as_cases(_with(part, base="layered"))
    return first_order(cases, found, p, n, steps)


def _shown(found, m):
    """The solution with the profiles at the first m radii only."""
    return replace(found, p=found.p[:, :m], lam=found.lam[:, :m])


# ---- what the rungs solve, and what closed forms expect of them


def _with(part, **texts):
    return replace(part, **{name: np.full(len(part), text) for name, text in texts.items()})


def _half_space(part):
    """The half-space of E2* under asperities of E1*, which are those of E2* with B̄ E2*/E1* and Ra (E2*/E1*)²."""
    n = part.n
    B = part.B * n ** (2 - part.beta)
    return replace(_with(part, base="half_space"), Nbar=part.Nbar * n**2, Ra=part.Ra / n**2, B=B)


def _layer_alone(part):
    """A half-space of E1*."""
    return replace(_with(part, base="half_space"), E2=part.n)


def _dropped(part, x):
    material = part.n, part.nu1, part.nu2, part.bonding == "bonded"
    return _LAYER[part.control] * np.abs(layered_kernel(1.5 * x, *material).L / part.n - 1)


def _alone(part, x):
    return np.abs(part.n - 1) / (2 * x)


def _thin(part, x):
    return np.nan_to_num(closed_form(part, part.h / x), nan=np.inf)


#: From the cheapest to the dearest; the last one is the truth.
RUNGS = (
    Rung(Model.SMOOTH_HALF_SPACE, True, _half_space, _dropped),
    Rung(Model.SMOOTH_LAYER_ALONE, True, _layer_alone, _alone),
    Rung(Model.SMOOTH_THIN_LAYER, True, lambda part: _with(part, base="thin_layer"), _thin),
    Rung(Model.HALF_SPACE, False, _half_space, _dropped),
    Rung(Model.LAYER_ALONE, False, _layer_alone, _alone),
    Rung(Model.THIN_LAYER, False, lambda part: _with(part, base="thin_layer"), _thin),
    Rung(Model.SMOOTH_LAYERED, True, lambda part: _with(part, base="layered"), lambda part, x: 0.0),
)


def _expected_errors(part):
    """Error (B,) expected of each model (dict), from closed forms at the first guess of the radius: a screening."""
    cases = as_cases(_with(part, base="layered"))
    a = guess_radius(cases)
    x = part.h / a
    material = part.n, part.nu1, part.nu2, part.bonding == "bonded"
    p0 = 2 / np.pi * a * part.n / layered_kernel(1.5 * x, *material).L
    A0 = cases.law.at(p0[:, None]).A[:, 0]
    asperities = _ASPERITIES[part.control] * (A0 / a**2) ** 0.75
    errors = {rung.model: rung.expected(part, x) + rung.smooth * asperities for rung in RUNGS}
    # on the exact layer a smooth case costs little less than a rough one: it must be nearly sure
    errors[Model.SMOOTH_LAYERED] = 2 * asperities
    # asperities soften the edge, where the thin layer errs
    errors[Model.THIN_LAYER] = errors[Model.THIN_LAYER] / (1 + 0.15 / x)
    if not cases.law.rough:
        errors[Model.SMOOTH_LAYERED] = np.full(len(part), np.inf)  # it is the exact model
    # it costs what the thin layer costs, which is better wherever there is one
    springs = local_compliance(part.h, part.n, part.nu1, part.nu2, part.bonding == "bonded")
    errors[Model.HALF_SPACE] = np.where(springs > 0, np.inf, errors[Model.HALF_SPACE])
    return errors
