"""The base "auto": each case is solved once, on the cheapest model whose error is small enough by a closed form.

The models are in docs/accuracy.md. Before anything is solved, :func:`bounds` gives an upper bound of the error of each
model against the rough contact on the exact layer, from h/a and A[p(0)]/a² at the first guess of the radius. The bound
of the chosen model becomes `model_error`.
"""

from dataclasses import replace

import numpy as np

from ..kernels.closed_form import decaying_part, whole
from ..kernels.two_layers import layer_modulus
from ..laws.disc_cell import SMOOTH
from ..numerics.quadrature import gauss_legendre
from ..rough.start import guess_radius
from ..scaling import as_cases, dimensionless, law_of, restore
from ..solution import Model, Solution
from ..status import Status
from .named import closed_form, solve_named, with_model_error

#: In random cases the true error is at most 0.86 times each of these bounds (`python tools/errors/margins.py 3000 2`).
#: The error of the thin layer is at most _THIN times its closed form, which is that of a smooth punch.
_THIN = 4.0
#: If h/a is above _THICKEST, the error by leaving out the body under a thick layer is at most _ALONE times
#: (a/h) ∫|L - 1| du. Otherwise that bound would be too large to be of use, unless n is almost 1.
_ALONE, _THICKEST = 0.8, 1.0
#: The error by leaving out the asperities is at most this times (A[p(0)]/a²)^0.75 at given P, a or D. For asperities
#: with A ~ p^β and β < 1/3 the exponent is 2/(3 - β), which is smaller: in a ring at the edge, (A/a²)^(2/(3 - β)) wide,
#: they are more compliant than the body.
_ASPERITIES = {"P": 5.0, "a": 7.0, "D": 4.0}
#: A bound is of first order. Above this it is not trusted, and its model is not chosen, whatever `accuracy` is.
_TRUSTED = 0.3
#: Nodes u and weights of ∫ · du by the trapezoidal rule in ln u. They are few: 10 % are enough for a bound.
_U = np.exp(np.linspace(np.log(1e-3), np.log(25.0), 14))
_WEIGHTS = _U * np.log(_U[1] / _U[0])

_SMOOTH = (Model.SMOOTH_LAYER_ALONE, Model.SMOOTH_THIN_LAYER)


def cheapest(problem, x):
    """:class:`Solution` of cases of the base "auto", in the units of the problem, each on the cheapest model whose
    bound is within its accuracy. If that model fails, the case is solved on the exact layer. x : (m,) radii."""
    scaled = dimensionless(problem).but(model_check="closed_form")
    pieces, left = [], np.ones(len(problem), dtype=bool)
    for micro in np.unique(problem.micro):
        index = np.flatnonzero(problem.micro == micro)
        part = scaled.take(index)
        for model, bound in bounds(part).items():
            chosen = np.flatnonzero(left[index] & (bound <= np.minimum(part.accuracy, _TRUSTED)))
            if len(chosen):
                cheap = _on_model(model, part.take(chosen), x)
                good = np.flatnonzero(cheap.status == Status.CONVERGED)
                used = np.full(len(good), model, dtype=np.int8)
                cheap = replace(cheap.take(good), model_error=bound[chosen[good]], model_used=used)
                pieces.append((index[chosen[good]], cheap))
                left[index[chosen[good]]] = False
    rest = np.flatnonzero(left)
    if len(rest):
        pieces.append((rest, solve_named(scaled.take(rest).but(base="layered"), x)))
    return with_model_error(problem, restore(Solution.join(len(problem), len(x), pieces), problem))


def bounds(part):
    """Model -> bound (B,) of its largest relative error over a, P, D, p0, p_max, Ar_An, for cases of one micro law; the
    cheapest model is the first. The bounds are closed forms at the first guess of the radius. tests/models/test_auto.py
    compares them with the exact layer."""
    cases = as_cases(part.but(base="layered"))
    a = guess_radius(cases)
    h_a, material = part.h / a, (part.n, part.nu1, part.nu2, part.bonding == "bonded")
    alone, thin = np.full(len(part), np.inf), np.nan_to_num(_THIN * closed_form(part, a), nan=np.inf)
    of_law = cases.law.law.error
    i = np.flatnonzero(h_a > _THICKEST)
    L1, _ = decaying_part(_U * np.ones((len(i), 1)), *(v[i, None] for v in material))
    alone[i] = _ALONE * (np.abs(L1) @ _WEIGHTS) / h_a[i]
    with_spots = {Model.LAYER_ALONE: alone + of_law, Model.THIN_LAYER: thin + of_law}
    if not cases.law.rough:
        return {Model(model + 1): bound for model, bound in with_spots.items()}
    p0 = 2 / np.pi * a * layer_modulus(part.n) / whole(1.5 * h_a, *material)
    _, beta = cases.law.edge()
    share = cases.law.at(p0[:, None]).A[:, 0] / a**2
    asperities = _ASPERITIES[part.control] * share ** np.minimum(0.75, 2 / (3 - beta))
    return {Model(model + 1): bound + asperities for model, bound in with_spots.items()} | with_spots


def _on_model(model, part, x):
    """:class:`Solution` of the cases `part` on a cheap model, with their asperities."""
    thin = model in (Model.THIN_LAYER, Model.SMOOTH_THIN_LAYER)
    base = part.but(base="thin_layer") if thin else part.but(base="half_space", E2=layer_modulus(part.n), nu2=part.nu1)
    if model not in _SMOOTH or not part.known.laws[str(part.micro[0])].rough:
        return solve_named(base, x)
    s, _ = area_rule()
    radii = np.concatenate([x, np.sqrt((1 - s) * (1 + s))])
    solution = solve_named(base.but(micro=SMOOTH.name, scheme="newton"), radii)
    p, p_area = np.split(solution.p, [len(x)], axis=1)
    law = law_of(part)
    return replace(solution, **spots_under(law, solution.p0, p_area), p=p, lam=law.at(p).lam)


def area_rule():
    """Points in s and weights of 2 ∫₀¹ λ s ds, Ar/An: λ of a smooth punch rises like s^(2/3) from the edge."""
    t, weight = gauss_legendre(24)
    return t**3, 6 * weight * t**5


def spots_under(law, p0, p_area):
    """The quantities (B,), by name, that asperities of a :class:`~solver.laws.Bound` add to a smooth solution with the
    pressures `p0` (B,) in the centre and `p_area` (B, m) at the points of :func:`area_rule`."""
    centre, (_, weights) = law.at(p0[:, None]), area_rule()
    return {"A0": centre.A[:, 0], "p_max": centre.p_max[:, 0], "Ar_An": law.at(p_area).lam @ weights}
