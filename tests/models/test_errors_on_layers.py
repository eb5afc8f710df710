"""Asperities on the coated body itself: which contacts have them, what they change, what is said of their errors."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from solver_cases import JUDGED, difference

from solver import Model, Problem, Status, sensitivities, solve
from solver.laws.cell.family import REACH
from solver.models.asperity_error import last_fraction

#: The whole spheres of the specification: R = E2* = 1, bonded.
SPHERE = {"Nbar": 0.0054**-2, "Ra": 0.004, "h": 0.001, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded"}
HARD, SOFT = SPHERE | {"n": 5.0, "P": 6e-5}, SPHERE | {"n": 0.2, "P": 4e-5}
NUMBERS = (*JUDGED, "A0", "dP_dD", "lam")


def beside_half_space(**given):
    """The contact on the coated body, over that with asperities on a half-space: D, p_max and the real area."""
    felt, alone = (solve(Problem.of(**given, asperities_on=word)) for word in ("layer", "half_space"))
    area = felt.Ar_An * felt.a**2 / (alone.Ar_An * alone.a**2)
    return [float(ratio[0]) for ratio in (felt.D / alone.D, felt.p_max / alone.p_max, area)]


def test_whole_spheres():
    """What the layer changes of spheres with every asperity resolved, in three digits. On the hard film the resolved
    sphere has 1.017, 0.850, 1.116 of the half-space's."""
    assert_allclose(beside_half_space(**HARD, micro="square_lattice"), [1.017, 0.849, 1.117], rtol=0, atol=5e-4)
    assert_allclose(beside_half_space(**SOFT, micro="disc_cell"), [0.966, 1.303, 0.846], rtol=0, atol=6e-4)


def test_auto_is_the_layer_where_the_pitch_is_above_h():
    """Up to a pitch of h the numbers are those of the half-space, to the bit."""
    h = 0.0054 * np.array([0.2, 1 - 1e-6, 1.0, 1 + 1e-6, 5.0])
    given = HARD | {"h": h}
    auto, layer, alone = (solve(Problem.of(**given, asperities_on=word)) for word in ("auto", "layer", "half_space"))
    assert Problem.of(**given).feels_layer().tolist() == [True, True, False, False, False]
    same = solve(Problem.of(**given, asperities_on="half_space").take(slice(2, None)))
    for name in NUMBERS:
        assert_allclose(getattr(auto, name)[:2], getattr(layer, name)[:2], rtol=1e-12, err_msg=name)
        assert_array_equal(getattr(auto, name)[2:], getattr(same, name), name)
    assert_allclose(layer.D[2:], alone.D[2:], rtol=1e-4, err_msg="where they meet they are one")
    assert_allclose(layer.p_max[2:], alone.p_max[2:], rtol=2e-3)
    units = {"R": 0.005, "E2": 2e11}
    scaled = given | {"P": given["P"] * 2e11 * 0.005**2, "h": h * 0.005, "Ra": 2e-5, "Nbar": given["Nbar"] / 0.005**2}
    assert_array_equal(Problem.of(**scaled, **units).feels_layer(), Problem.of(**given).feels_layer(), "any units")


def test_bases_that_have_the_half_space_alone_and_auto():
    base = ["half_space", "thin_layer", "layered", "auto"]
    found = solve(Problem.of(**HARD | {"n": 0.5}, base=base))
    alone = solve(Problem.of(**HARD | {"n": 0.5}, base=base, asperities_on="half_space"))
    for name in NUMBERS:
        assert_allclose(getattr(found, name)[:2], getattr(alone, name)[:2], rtol=1e-13, err_msg=name)
        assert_array_equal(getattr(found, name)[3], getattr(found, name)[2], "auto takes the exact layer")
    assert found.model_used[3] == Model.LAYERED and found.model_error[3] == found.model_error[2]


@pytest.mark.parametrize(
    "wrong",
    [
        {"base": "thin_layer"},
        {"base": "half_space"},
        {"micro": "smooth"},
        {"micro": "power_law", "B": 0.1, "beta": 0.5},
    ],
    ids=str,
)
def test_what_cannot_feel_the_layer_refuses_it(wrong):
    found = solve(Problem.of(**HARD | {"n": 0.5} | wrong, asperities_on=["layer", "auto", "half_space"]))
    assert found.status.tolist() == [Status.INVALID_INPUT, Status.CONVERGED, Status.CONVERGED]
    assert found.D[1] == found.D[2]


def test_where_the_law_ends_there_are_no_numbers():
    """Spots that merge, a pitch of more than 300 h, a disc cell on a soft film; a curve may be drawn through them."""
    given = SPHERE | {"n": [1.2, 5.0, 0.02], "h": [0.001, 1.7e-5, 0.001], "P": [0.05, 6e-5, 9e-6]}
    problem = Problem.of(**given, micro="disc_cell")
    found, beyond = solve(problem), solve(problem, extrapolate=True)
    assert (found.status == Status.OUTSIDE_LAW).all() and np.isnan(found.D).all()
    last = last_fraction(problem)
    assert_allclose(last[:2], [REACH, 0.0], rtol=1e-9)
    assert 0.05 < last[2] < 0.5 and (beyond.lam[[0, 2], 0] > last[[0, 2]]).all()
    hexagonal = solve(problem.but(micro="hex_lattice"))
    assert hexagonal.status.tolist()[2] == Status.CONVERGED, "the lattice goes on"
    assert solve(problem.but(asperities_on="half_space")).status.tolist() == [0, 0, 0]


@pytest.mark.parametrize("given", [HARD, SOFT, HARD | {"n": 30.0}, SOFT | {"n": 0.02, "P": 1e-5}], ids=str)
def test_the_error_of_a_half_space_is_what_the_layer_changes(given):
    """Of the contacts, at one pressure: `model_error` is that at p(0), to a factor of 1.5."""
    both = [solve(Problem.of(**given, micro="hex_lattice", asperities_on=word)) for word in ("half_space", "layer")]
    names = ("D", "p_max", "Ar_An")
    error = difference(*both, names=names)
    assert error / 1.5 < both[0].model_error < 1.5 * error and both[1].model_error < 0.02


def test_it_is_never_0_where_the_pitch_is_above_h():
    """Of "auto" too, whose bound is not of that; of the power law, by the disc cell to which it is fitted."""
    far = {"P": 6e-5, "n": 0.5, "asperities_on": "half_space", "B": 0.1, "beta": 0.5}
    given = SPHERE | far | {"h": 0.0054 / np.array([1.001, 1.5, 4, 16, 400]), "micro": "disc_cell"}
    errors = [solve(Problem.of(**given | more)).model_error for more in ({}, {"base": "auto"}, {"micro": "power_law"})]
    for error in errors:
        assert (np.diff(error) > 0).all() and (error > 0).all() and error[0] < 2e-3 + 0.01 * (error is errors[1])
    assert (solve(Problem.of(**given | {"h": 0.0054})).model_error == 0).all()
    assert (solve(Problem.of(**given | {"base": "half_space"})).model_error == 0).all()


@pytest.mark.parametrize("given", [HARD | {"P": 6e-4}, SOFT, SOFT | {"n": 0.05, "P": 5e-6}], ids=str)
def test_the_error_of_the_disc_cell_is_its_distance_from_the_lattice(given):
    """By a cell without a layer: what the neighbours lift hardly depends on that."""
    disc, lattice = (solve(Problem.of(**given, micro=word)) for word in ("disc_cell", "hex_lattice"))
    error = difference(disc, lattice)
    assert disc.status == lattice.status == 0 and 0.7 * error < disc.model_error < 3 * error


def test_elastic_punches_and_stacks():
    """An elastic punch over a rigid one of the material that both make; a stack of one layer, and of two halves."""
    m, case = 0.6, HARD | {"micro": "square_lattice", "rtol": 1e-9}
    layer = {"n": 5.0, "nu1": 0.25, "bonding": "bonded", "layers.1.cn": 0.0}
    halves = {
        f"layers.2.{name}": value for name, value in (("h", 5e-4), ("n", 5.0), ("nu", 0.25), ("bonding", "bonded"))
    }
    one = solve(Problem.of(**case, m=m, asperities_on="layer"))
    rest = {name: value for name, value in case.items() if name not in layer} | {"base": "stack", "m": m}
    stack = solve(Problem.of(**rest, **layer, asperities_on="layer"))
    two = solve(Problem.of(**rest | {"h": 5e-4}, **layer, **halves, asperities_on="layer"))
    for name in NUMBERS:
        assert_allclose(getattr(stack, name), getattr(one, name), rtol=1e-9, err_msg=name)
        assert_allclose(getattr(two, name), getattr(one, name), rtol=1e-7, err_msg=name)
    rigid = solve(Problem.of(**case, asperities_on="layer"))
    assert one.p_max < 0.8 * rigid.p_max


def test_derivatives_by_the_layer():
    """By moved contacts, and where the pitch is h none jumps: moved inputs press on what the contact presses on."""
    for word, h in (("auto", 1e-3), ("auto", 0.0054 * (1 - 1e-4)), ("auto", 0.0054 * (1 + 1e-4))):
        problem = Problem.of(**HARD | {"h": h, "rtol": 1e-10}, micro="square_lattice", asperities_on=word)
        solution = solve(problem)
        found = sensitivities(problem, solution, inputs=("h", "Nbar", "n", "Ra"))
        held = problem.but(asperities_on="layer" if problem.feels_layer()[0] else "half_space")
        for i, name in enumerate(found.inputs):
            value = getattr(problem, name)
            up, down = (solve(held.but(**{name: value * np.exp(step)})) for step in (1e-3, -1e-3))
            for key in ("D", "p_max", "Ar_An"):
                slope = np.log(getattr(up, key) / getattr(down, key)) / 2e-3
                assert_allclose(found.logs[key][:, i], slope, rtol=1e-4, atol=2e-6, err_msg=f"{key} by {name}")


def test_neighbours_do_not_matter():
    """A batch of bodies, laws and pitches: each case has the numbers that it has alone."""
    given = SPHERE | {"P": 3e-5, "n": [5.0, 5.0, 0.2, 5.0, 0.2], "h": [1e-3, 0.02, 1e-3, 3e-3, 5e-4]}
    given |= {"micro": ["disc_cell", "disc_cell", "square_lattice", "smooth", "disc_cell"]}
    problem = Problem.of(**given, base=["layered", "layered", "layered", "layered", "auto"])
    together = solve(problem)
    for i in range(len(problem)):
        alone = solve(problem.take([i]))
        for name in ("D", "p_max", "Ar_An", "model_error"):
            assert_allclose(getattr(together, name)[i], getattr(alone, name)[0], rtol=1e-9, err_msg=f"{name} of {i}")
