"""No silent failure, far beyond any scene: fixed samples of the cases of `make extremes`, every base and law.

The ranges are those of studies/evidence/extremes.toml and extremes_layered.toml. Warnings are errors here, as in all
tests.
"""

import tomllib
from functools import cache

import numpy as np
import pytest
from conftest import ROOT
from layered_independent import answers, rough
from solver_cases import ALL_KINDS, KINDS, ROUGH_KINDS, difference

from solver import Problem, Status, solve
from solver.rough import equation
from solver.rough.start import guess_radius
from solver.scaling import as_cases
from study.inputs.lexicon import PACKAGE
from study.inputs.sample import draw
from study.inputs.vocabulary import VOCABULARY

RTOL = 1e-6
#: Cases of the sample, and the share of those with a solution that must converge.
SIZE = {"half_space": 150, "thin_layer": 40, "layered": 8}
CONVERGED = dict.fromkeys(ALL_KINDS, 0.999)
NUMBERS = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", "residual", "error", "p", "lam")
WITH_NUMBERS = {Status.CONVERGED, Status.TOLERANCE_NOT_MET}
NO_SOLUTION = {Status.THIN_LAYER_NOT_APPLICABLE, Status.LIFT_OFF, Status.OUTSIDE_LAW}

#: By law, a case of a sample with n above 1e3 that one rule for all panels of the convolution gets wrong.
STIFF_FILMS = {"smooth": [286], "disc_cell": [36], "power_law": [3]}

kinds = pytest.mark.parametrize(("base", "law"), ALL_KINDS, ids=["-".join(kind) for kind in ALL_KINDS])


@cache
def sample(base, size=None, seed=11, **start):
    """Arguments of ``Problem.of`` without base and law; `start`: of a range, where it is not the study's."""
    study = ROOT / "studies/evidence" / ("extremes_layered.toml" if base == "layered" else "extremes.toml")
    table = tomllib.loads(study.read_text(encoding="utf-8"))["sample"]
    ranges = {name: table[name] | {"start": value} for name, value in start.items()}
    errors, known = [], {name: PACKAGE.parameter(name) for name in table if name in VOCABULARY}
    columns = draw(table | {"size": size or SIZE[base], "seed": seed} | ranges, known, errors)
    assert not errors
    return {name: np.array(values) for name, values in columns.items()}


def solved_twice(case, **kind):
    """:class:`Solution` of cases at RTOL, and at a tenth of it: in one batch, where both have their operators."""
    size = len(case["h"])
    twice = {name: np.tile(values, 2) for name, values in case.items()}
    found = solve(Problem.of(**twice, **kind, rtol=np.repeat([RTOL, RTOL / 10], size)))
    return found.take(np.arange(size)), found.take(np.arange(size, 2 * size))


@cache
def solved(base, law):
    return solved_twice(sample(base), base=base, micro=law)


@kinds
def test_every_answer_is_numbers_or_a_flag(base, law):
    s, _ = solved(base, law)
    for status in np.unique(s.status):
        of_status = s.status == status
        for name in NUMBERS:
            finite = np.isfinite(getattr(s, name)[of_status])
            assert np.all(finite) if status in WITH_NUMBERS else name == "P" or not np.any(finite), (name, status)
    assert np.all(s.error[s.status == Status.CONVERGED] <= RTOL)
    assert np.all(s.error[s.status == Status.TOLERANCE_NOT_MET] > RTOL)
    solvable = ~np.isin(s.status, list(NO_SOLUTION))
    assert (s.status[solvable] == Status.CONVERGED).mean() >= CONVERGED[base, law]
    assert solvable.mean() > 0.8


@kinds
def test_no_case_converges_to_another_answer(base, law):
    """The truth: the same case at a tenth of rtol."""
    s, fine = solved(base, law)
    np.testing.assert_array_equal(np.isin(s.status, list(NO_SOLUTION)), np.isin(fine.status, list(NO_SOLUTION)))
    both = (s.status == Status.CONVERGED) & (fine.status == Status.CONVERGED)
    truth = difference(s, fine)[both]
    assert both.sum() > 0.8 * (s.status == Status.CONVERGED).sum()
    assert truth.max() <= 10 * RTOL
    assert (truth <= RTOL).mean() >= 0.99


@pytest.mark.parametrize(("base", "law"), KINDS, ids=["-".join(kind) for kind in KINDS])
@pytest.mark.parametrize("control", ["a", "D"])
def test_extremes_by_radius_and_depth(base, law, control):
    """Finite numbers for each case; those called converged are within their tolerance."""
    case = sample(base, 60, 3) | {"bonding": "frictionless", "base": base, "micro": law}
    case |= {control: np.cbrt(case.pop("P")) ** {"a": 1, "D": 2}[control]}
    s, fine = (solve(Problem.of(**case, rtol=rtol)) for rtol in (1e-4, 1e-6))
    assert set(s.status) <= {Status.CONVERGED, Status.TOLERANCE_NOT_MET}
    assert (s.status == Status.CONVERGED).mean() > (0.95 if law == "disc_cell" else 0.99)
    for name in NUMBERS:
        assert np.all(np.isfinite(getattr(s, name))), name
    assert np.all(s.error[s.status == Status.CONVERGED] <= 1e-4)
    ok = (s.status == Status.CONVERGED) & (fine.status == Status.CONVERGED)
    assert ok.mean() > 0.8
    assert np.quantile(difference(s, fine)[ok], 0.99) <= 1e-4


@pytest.mark.parametrize(("law", "which"), STIFF_FILMS.items())
def test_stiff_films_neither_fail_nor_lift_off(law, which):
    """Of 300 films more than 1e3 times stiffer than the body, those that an inaccurate convolution makes fail, or
    appear to be tensile at the edge. The truth: the same case at a tenth of rtol."""
    case = {name: values[which] for name, values in sample("layered", 300, 5, n=1e3).items()}
    s, fine = solved_twice(case, base="layered", micro=law)
    assert np.all(s.status == Status.CONVERGED) and np.all(fine.status == Status.CONVERGED)
    assert np.all(difference(s, fine) <= RTOL)


def test_no_operator_is_so_wrong_that_an_open_iteration_could_have_closed():
    """The residual from which on the operator is not asked, `_OPEN`, is far above all that its error can close."""
    cases = as_cases(Problem.of(**sample("layered", 3000), base="layered", micro="disc_cell"))
    a = guess_radius(cases)
    for nodes in (8, 144):
        rounding = equation._ROUNDING / cases.body.softness(a)
        most = np.maximum(equation._OF_OPERATOR * equation._floor(cases.body, a, nodes), rounding)
        assert 0 < most.max() < equation._OPEN / 100


@pytest.mark.parametrize(("base", "law"), ROUGH_KINDS)
def test_against_another_formulation(base, law):
    """Collocation through the Abel transform at given a, where it is fine enough."""
    size = 60
    case, judged = sample(base, size, 3), 0
    found = solve(Problem.of(**case, base=base, micro=law, rtol=RTOL))
    for i in np.flatnonzero(found.status == Status.CONVERGED):
        one = {name: case[name][i] for name in ("h", "n", "nu1", "nu2", "Nbar", "Ra", "B", "beta")}
        with np.errstate(all="ignore"):  # it may fail: then it does not judge
            coarse, fine = (
                rough(count, law, found.a[i], bonded=case["bonding"][i] == "bonded", base=base, **one)
                for count in (36, 54)
            )
            own = 3 * np.abs(coarse / fine - 1).max()
        if own < RTOL:
            judged += 1
            assert np.abs(answers(found, i) / fine - 1).max() <= 10 * RTOL, i
    assert judged >= 20


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered"])
def test_subnormal_scales(base):
    """Lengths and pressures with a few bits left: powers of 2, which they hold exactly."""
    R = 2.0**-1060
    one, tiny = (
        solve(Problem.of(a=unit / 32, h=unit / 64, n=0.5, R=unit, base=base, micro="smooth")) for unit in (1.0, R)
    )
    soft = solve(Problem.of(a=1 / 32, h=1 / 64, n=0.5, E2=R, base=base, micro="smooth"))
    assert tiny.status[0] == soft.status[0] == Status.CONVERGED
    assert tiny.p0[0] == pytest.approx(one.p0[0], rel=1e-12)
    assert tiny.error[0] <= RTOL and soft.error[0] <= RTOL
    assert soft.D[0] == pytest.approx(one.D[0], rel=1e-12)
