"""Graded layers: exponential and linear profiles and tables, against many uniform layers and against each other."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, Status, solve
from solver.body.graded import contrast, cuts, graded_first
from solver.body.stacked import kernel_of

SMOOTH, ROUGH = {"micro": "smooth"}, {"Nbar": 250000, "Ra": 0.004}


@pytest.mark.parametrize(
    ("profile", "top", "bottom"), [("exponential", 1.0, 10.0), ("linear", 8.0, 0.2), ("linear", 0.1, 1.0)]
)
@pytest.mark.parametrize("above", [False, True], ids=["at the surface", "below a layer"])
def test_graded_layers(profile, top, bottom, above):
    """To 1e-4, with an honest error, beside 400 layers of equal thickness, which err by about 1e-4 themselves."""
    graded = {"h": 0.05, "n": [top, bottom], "nu": [0.2, 0.4], "profile": profile, "bonding": "bonded"}
    cover = [{"h": 0.01, "n": 2.0, "bonding": "bonded"}] * above
    case = {"a": np.array([0.03, 0.1]), **SMOOTH}
    contact = solve(Problem.of(layers=[*cover, graded], rtol=1e-4, **case))
    fine = solve(Problem.of(layers=[*cover, graded], rtol=1e-5, **case))
    assert np.all(contact.status == Status.CONVERGED) and np.all(contact.error < 1e-4)
    for name in ("P", "D", "p0", "dP_dD"):
        off = np.abs(getattr(contact, name) / getattr(fine, name) - 1)
        assert np.all(off < contact.error + fine.error), name


def test_a_graded_layer_is_many_uniform_ones():
    """N layers of equal thickness come to the profile by N^-2 ln cN: 16 are between 2 and 4 times as near as 8."""
    graded = {"h": 0.06, "n": [1.0, 4.0], "nu": 0.3, "profile": "exponential", "bonding": "bonded"}
    exact, off = solve(Problem.of(a=0.05, layers=[graded], rtol=2e-6, **ROUGH)), {}
    for count in (8, 16):
        depths = (np.arange(count) + 0.5) / count
        steps = [{"h": 0.06 / count, "n": 4.0**z, "nu": 0.3, "bonding": "bonded"} for z in depths]
        contact = solve(Problem.of(a=0.05, layers=steps, **ROUGH))
        off[count] = np.array([getattr(contact, name) / getattr(exact, name) - 1 for name in ("P", "D")])
    assert np.all(np.abs(off[8]) > 3e-4)
    assert np.all((off[8] / off[16] > 2) & (off[8] / off[16] < 4))


def test_how_much_the_modulus_of_the_first_layer_changes():
    """ln of the largest over the smallest; nothing in a uniform layer, however the second one changes, nor in none."""
    first, second = (
        {"h": 0.06, "n": n, "profile": "exponential", "bonding": "bonded"} for n in ([1.0, 4.0], [2.0, 9.0])
    )
    layers = [[first, second], [second | {"n": 3.0, "profile": "uniform"}, first], [first | {"n": [4.0, 1.0]}]]
    problems = [Problem.of(a=0.05, layers=stack, **ROUGH) for stack in layers]
    problems.append(Problem.of(a=0.05, base="half_space", **ROUGH))
    assert_allclose([contrast(problem)[0] for problem in problems], [np.log(4), 0, np.log(4), 0], rtol=1e-12, atol=0)
    assert [graded_first(problem)[0] for problem in problems] == [True, False, True, False]


def test_graded_layers_stick():
    """JKR's D and pull-off are those of more and more uniform layers, whose first one is what the edge feels: 16 are 2
    to 4.5 times as near as 8."""
    graded = {"h": 0.06, "n": [1.0, 4.0], "nu": 0.3, "profile": "exponential", "bonding": "bonded"}
    case, names, off = SMOOTH | {"a": 0.1, "w_adhesion": 1e-4}, ("D", "P_off", "D_off"), {}
    exact = solve(Problem.of(layers=[graded], rtol=1e-2, **case))
    assert exact.status == Status.CONVERGED and exact.stable
    for count in (8, 16):
        depths = (np.arange(count) + 0.5) / count
        steps = [{"h": 0.06 / count, "n": 4.0**z, "nu": 0.3, "bonding": "bonded"} for z in depths]
        contact = solve(Problem.of(layers=steps, **case))
        off[count] = np.array([getattr(contact, name) / getattr(exact, name) - 1 for name in names])
    assert np.all(np.abs(off[16]) < 3e-3)
    assert np.all((off[8] / off[16] > 2) & (off[8] / off[16] < 4.5))


def test_a_profile_that_does_not_change_is_uniform():
    """To the error that films have, 5e-8: the first of the sublayers is one."""
    layer = {"h": 0.05, "n": 3.0, "nu": 0.3, "bonding": "bonded"}
    same = layer | {"n": [3.0, 3.0], "profile": "exponential"}
    one, other = (solve(Problem.of(a=0.05, layers=[own], **SMOOTH)) for own in (layer, same))
    assert_allclose([other.P, other.D, other.p0], [one.P, one.D, one.p0], rtol=5e-8)


@pytest.mark.parametrize("below", [{"cn": 0.02, "ct": 0.01}, {"cn": 0.0, "ct": 0.05}, "frictionless"])
@pytest.mark.parametrize("covered", [False, True])
def test_what_is_below_a_graded_layer_is_below_its_last_sublayer(below, covered):
    """Springs and sliding are where the layer ends, not within it: a profile that does not change gives way like the
    uniform layer on the same springs, and one that does like uniform layers of which the last is on springs."""
    cover = [{"h": 0.01, "n": 2.0, "bonding": "bonded"}] * covered
    layer = {"h": 0.05, "nu": 0.3, "bonding": below}
    ends = cuts(1, 4 if covered else 8)
    parts = [
        {"h": 0.05 * (b - a), "n": 4.0 ** ((a + b) / 2), "nu": 0.3, "bonding": "bonded"} for a, b in pairwise(ends)
    ]
    parts[-1]["bonding"] = below
    k = np.geomspace(0.1, 300, 30)
    for n, uniform in (([3.0, 3.0], [layer | {"n": 3.0}]), ([1.0, 4.0], parts)):
        graded = [*cover, layer | {"n": n, "profile": "exponential"}]
        softness = []
        for layers in (graded, [*cover, *uniform]):
            kernel, h = kernel_of(Problem.of(a=0.05, layers=layers, sublayers=1, **SMOOTH))
            softness.append(kernel.whole(k[None] * h[:, None]) / kernel.E1[:, None])
        assert_allclose(*softness, rtol=1e-10)


def test_a_table_is_a_profile(tmp_path):
    """Of a straight line it is the linear one; on a rigid base its first number is 1."""
    path = tmp_path / "line.csv"
    path.write_text("# measured\nz/h,E*/E2*\n0,1\n0.25,1.5\n1,3\n")
    layer = {"h": 0.05, "nu": 0.3, "bonding": "bonded"}
    table, line = layer | {"profile": f"table:{path}"}, layer | {"profile": "linear", "n": [1.0, 3.0]}
    for rigid in (False, True):
        one, other = (
            solve(Problem.of(a=0.05, layers=[own], rigid_base=rigid, rtol=1e-4, **SMOOTH)) for own in (table, line)
        )
        assert_allclose([one.P, one.D, one.p0], [other.P, other.D, other.p0], rtol=1e-5)


TABLES = {
    "no file": (None, "cannot be read"),
    "words": ("0,1\n1,soft\n", "cannot be read"),
    "one row": ("0,1\n", "2 to 10000 rows"),
    "three columns": ("0,1,2\n1,1,2\n", "two columns"),
    "not to 1": ("0,1\n0.9,2\n", "from 0 to 1"),
    "back": ("0,1\n0.5,2\n0.4,2\n1,3\n", "must grow"),
    "negative": ("0,1\n1,-2\n", "must be in"),
}


@pytest.mark.parametrize("kind", TABLES)
def test_bad_tables(kind, tmp_path):
    text, message = TABLES[kind]
    path = tmp_path / "table.csv"
    if text is not None:
        path.write_text(text)
    with pytest.raises(ValueError, match=message):
        Problem.of(a=0.05, layers=[{"h": 0.05, "profile": f"table:{path}"}], **SMOOTH)
