"""A case of a batch has the numbers that it has alone, whatever is wrong with its neighbours: every base and law."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from solver_cases import ALL_KINDS, JUDGED, LOAD, MAIN, RANGES, random_cases
from test_extremes import sample

from solver import Problem, Status, solve
from solver.laws import heights
from solver.numerics.caches import Cache

pytestmark = pytest.mark.usefixtures("each_path")

NUMBERS = (*JUDGED, "A0", "dP_dD", "p", "lam")


def mixed(size, seed):
    """Cases of every base, law, bonding and tolerance in one batch, some of them invalid or outside the model."""
    rng = np.random.default_rng(seed)
    case = (
        random_cases(size, seed)
        | {"asperities_on": np.full(size, "half_space")}
        | {"nu1": np.where(rng.random(size) < 0.1, 0.5, 0.3)}
    )
    case["nu2"] = rng.uniform(0.1, 0.5, size)
    case["h"] = np.maximum(case["h"], 5e-3)  # a thinner exact layer is a difference of large terms
    for name, choices in {
        "base": ("half_space", "thin_layer", "layered"),
        "micro": ("disc_cell", "power_law", "smooth"),
        "rtol": (1e-3, 1e-6, 1e-9),
        "nodes": (0, 0, 20),
        "max_iterations": (0, 0, 50),
    }.items():
        case[name] = rng.choice(choices, size)
    case["P"][rng.random(size) < 0.05] = np.nan
    case["h"][rng.random(size) < 0.05] = -1.0
    return case


def beyond(size, seed):
    """The same with elastic punches, rigid bases, a lattice, random heights and the base "auto"."""
    rng = np.random.default_rng(seed)
    case = mixed(size, seed) | {"sigma": 10 ** rng.uniform(-5, -3, size), "cut": rng.uniform(3, 5, size)}
    case["n"] = np.where(rng.random(size) < 0.2, 0.0, case["n"])
    for name, choices in {
        "base": ("half_space", "thin_layer", "layered", "auto"),
        "micro": ("disc_cell", "hex_lattice", "normal_heights", "uniform_heights"),
        "m": (0.0, 0.1, 3.0),
    }.items():
        case[name] = rng.choice(choices, size)
    return case


@pytest.mark.parametrize(("kinds", "size", "seed"), [(mixed, 100, 5), (beyond, 24, 0)])
def test_mixed_batches_are_single_cases(monkeypatch, kinds, size, seed):
    """Each case of a batch has the numbers it has alone, and in any other order and company.

    To rounding: BLAS rounds a product of more rows otherwise, and where that decides whether a residual is below 1e-13
    the iteration takes a step more or less, of that size, which a pressure may feel a hundred times. A case alone makes
    its own table of heights.
    """
    x = np.array([0.0, 0.5, 1.0])
    case = kinds(size, seed)
    together = solve(Problem.of(**case), x)
    assert set(together.status) >= {Status.CONVERGED, Status.INVALID_INPUT, Status.THIN_LAYER_NOT_APPLICABLE}
    order = np.random.default_rng(0).permutation(size)
    shuffled = solve(Problem.of(**{name: v[order] for name, v in case.items()}), x)
    for i in range(size):
        monkeypatch.setattr(heights, "_cache", Cache(6e7))
        alone = solve(Problem.of(**{name: v[i] for name, v in case.items()}), x)
        for other, j in ((together, i), (shuffled, int(np.flatnonzero(order == i)[0]))):
            assert other.status[j] == alone.status[0]
            assert other.nodes[j] == alone.nodes[0]
            for name in NUMBERS:
                value, expected = getattr(other, name)[j], getattr(alone, name)[0]
                assert_allclose(value, expected, rtol=1e-11, atol=0, err_msg=f"{name} of case {i}")


def test_a_table_of_heights_is_the_same_in_any_company(monkeypatch):
    """Tables that are made together take the steps that one of them needs. λ was 2e-10 off, A and p_max 6e-15; now λ is
    within 7e-14."""
    rng, p = np.random.default_rng(0), np.geomspace(1e-6, 1e-1, 200)
    sigma, cut = 10 ** rng.uniform(-6, -1.5, 20), rng.uniform(3, 5, 20)
    case = {"E": 1.0, "Nbar": 250_000.0, "Ra": 0.004}
    monkeypatch.setattr(heights, "_cache", Cache(6e7))
    together = heights.LAW.at(p[:, None], **case, sigma=sigma, cut=cut)
    for i in range(0, 20, 2):
        monkeypatch.setattr(heights, "_cache", Cache(6e7))
        alone = heights.LAW.at(p, **case, sigma=sigma[i], cut=cut[i])
        for values, expected in zip(together, alone, strict=True):
            assert_allclose(values[:, i], expected, rtol=1e-12, atol=0)


def test_arguments_are_not_edited():
    case = mixed(30, 9)
    before = {name: v.copy() for name, v in case.items()}
    solve(Problem.of(**case))
    for name, v in case.items():
        assert_array_equal(v, before[name])


GOOD = MAIN | {
    "P": LOAD,
    "R": 1.0,
    "E2": 1.0,
    "rtol": 1e-6,
    "nu1": 0.3,
    "nu2": 0.3,
    "m": 0.1,
    "sigma": 1e-4,
    "cut": 4.0,
}
OF_A_LAYER, OF_ASPERITIES, OF_POWER_LAWS = ("h", "n", "nu1", "nu2"), ("Nbar", "Ra"), ("B", "beta")
KINDS = [*ALL_KINDS, ("auto", "disc_cell"), ("layered", "normal_heights")]
#: A number that no case can have, of every parameter: (name, value).
POISON = [(name, bad) for name in GOOD for bad in (np.nan, np.inf, -np.inf, -1.0, 0.0)
          if (name, bad) not in ((free, 0.0) for free in ("n", "nu1", "nu2", "m", "sigma"))]  # fmt: skip


def used(name, base, law):
    """Whether a case of a base and a law has this parameter."""
    return not (
        (name in OF_A_LAYER and base == "half_space")
        or (name in OF_ASPERITIES and law == "smooth")
        or (name in OF_POWER_LAWS and law != "power_law")
        or (name in ("sigma", "cut") and law != "normal_heights")
    )


@pytest.mark.parametrize(("base", "law"), KINDS, ids=["-".join(kind) for kind in KINDS])
def test_poison_is_flagged_and_harmless(base, law):
    """Every bad number of every parameter between good cases: INVALID_INPUT and NaN where the parameter is used; the
    others have the numbers they have without them."""
    case = {name: np.full(len(POISON) + 1, value) for name, value in GOOD.items()}
    ordinary = random_cases(len(POISON) + 1, 21, RANGES | {"h": (5e-3, 0.1)})
    case = {name: np.ravel(np.column_stack([ordinary.get(name, value), value])) for name, value in case.items()}
    clean = solve(Problem.of(**case, base=base, micro=law))
    assert_array_equal(clean.status, Status.CONVERGED)
    bad = {name: values.copy() for name, values in case.items()}
    for i, (name, value) in enumerate(POISON):
        bad[name][2 * i + 1] = value
    s = solve(Problem.of(**bad, base=base, micro=law))
    hurt = 1 + 2 * np.array([i for i, (name, _) in enumerate(POISON) if used(name, base, law)])
    expected = np.full(len(s.status), Status.CONVERGED)
    expected[hurt] = Status.INVALID_INPUT
    assert_array_equal(s.status, expected)
    for name in (*NUMBERS, "residual", "error"):
        found = getattr(s, name)
        healthy = np.setdiff1d(np.arange(len(found)), hurt)
        atol = {"residual": 1e-14, "error": 6e-14}.get(name, 0.0)  # differences of numbers that are nearly the same
        assert_allclose(found[healthy], getattr(clean, name)[healthy], rtol=1e-11, atol=atol, err_msg=name)
        if name != "P":
            assert np.all(np.isnan(found[hurt])), name


@pytest.mark.parametrize(("base", "law"), ALL_KINDS, ids=["-".join(kind) for kind in ALL_KINDS])
def test_poison_among_extreme_cases(base, law):
    """Parameters that the cases need are NaN, infinite or negative between neighbours far beyond any scene."""
    case = {name: values[:7] for name, values in sample(base).items()} | {"base": base, "micro": law, "rtol": 1e-3}
    names = [name for name in ("P", "h", "n", "nu1", "Nbar", "Ra") if used(name, base, law)]
    bad = {name: np.repeat(values[:, None], 2, 1).ravel() if np.ndim(values) else values
           for name, values in case.items()}  # fmt: skip
    for i, (name, value) in enumerate(zip(names, [np.nan, np.inf, -2.0] * 2, strict=False)):
        bad[name][2 * i + 1] = value
    clean, s = solve(Problem.of(**case)), solve(Problem.of(**bad))
    assert_array_equal(s.status[1 : 2 * len(names) : 2], Status.INVALID_INPUT)
    assert_array_equal(s.status[::2], clean.status)
    for name in JUDGED:
        assert_allclose(getattr(s, name)[::2], getattr(clean, name), rtol=1e-9, atol=0, err_msg=name)


@pytest.mark.parametrize("name", ["max_iterations", "nodes", "rtol"])
def test_each_case_has_its_own_limits(name):
    """Three values in one batch, of which the first is too little for one of the others."""
    values = {"max_iterations": [1, 40, 2], "nodes": [6, 40, 20], "rtol": [1e-3, 1e-9, 1e-6]}[name]
    together = solve(Problem.of(**MAIN | {"P": LOAD, name: values}))
    for i, value in enumerate(values):
        alone = solve(Problem.of(**MAIN | {"P": LOAD, name: value}))
        for quantity in ("status", "a", "D", "error"):  # the numbers of a case alone to rounding, see above
            assert_allclose(getattr(together, quantity)[i], getattr(alone, quantity)[0], rtol=1e-9, atol=1e-12)
