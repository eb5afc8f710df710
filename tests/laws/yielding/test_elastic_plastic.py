"""Asperities that yield: reference rows, the elastic and the plastic limit, contacts, error bars, keys, refusals."""

import warnings
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import study
from solver import Problem, sensitivities, solve
from solver.closed_forms import yield_pressure
from solver.laws import disc_cell
from solver.laws.elastic_plastic import LAW, TABOR
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables

REFERENCES = Path(__file__).parents[2] / "references"
#: Columns X, x_y, t, y and the law there, in 25 digits; and contacts, to 9 digits: these are of another implementation
#: of the law, in this solver.
ROWS = np.genfromtxt(REFERENCES / "elastic_plastic_law.csv", delimiter=",", names=True)
CONTACTS = np.genfromtxt(REFERENCES / "elastic_plastic_contact.csv", delimiter=",", names=True, dtype=None)
SPOTS = {"Nbar": 250_000.0, "Ra": 0.004}
LAYER = {"h": 0.02, "n": 0.5, "bonding": "bonded"}
RESULTS = ("a", "D", "p0", "p_max", "Ar_An")


def random_contacts(size, seed=11, **fixed):
    """Layers from thin to thick; spots from elastic to far beyond their yield."""
    random = np.random.default_rng(seed)
    n = 10 ** random.uniform(-1, 1, size)
    case = {"P": 10 ** random.uniform(-7, -4, size), "n": n, "h": 10 ** random.uniform(-3, 0, size)}
    case |= {"Nbar": 10 ** random.uniform(3, 6, size), "Ra": 10 ** random.uniform(-3, -1.5, size)}
    case |= {"hardness": n * 10 ** random.uniform(-3, 0, size), "nu1": random.uniform(0.1, 0.5, size)}
    case |= {"bonding": random.choice(["bonded", "frictionless"], size)}
    case |= {"base": random.choice(["layered", "half_space"], size)}
    return Problem.of(**case | fixed, micro="elastic_plastic")


def test_reference_rows():
    y, own = ROWS["y"][:, None], (ROWS["X"][:, None], ROWS["xy"][:, None])
    curve = LAW.curve(y, *own)
    numbers = {"q": curve.q, "g": curve.g, "dq_dy": curve.dq, "dg_dy": curve.dg, "lam": LAW.area(y, curve.q, *own)}
    numbers |= {"pmax_over_pstar": LAW.peak(y, curve.q, *own)}
    for name, values in numbers.items():
        assert_allclose(values[:, 0], ROWS[name], rtol=1e-13, atol=0, err_msg=name)
    assert_allclose(LAW.from_pressure(curve.q, *own), y, rtol=1e-12, atol=0)


def test_reference_contacts():
    nu1 = CONTACTS["nu1"]
    names = ("P", "h", "n", "nu1", "nu2", "bonding", "Nbar", "Ra")
    strengths = {
        "hardness": CONTACTS["H"],
        "yield_strength": 1.5 * CONTACTS["xy"] * CONTACTS["H"] / yield_pressure(nu1),
    }
    found = solve(
        Problem.of(**{name: CONTACTS[name] for name in names}, **strengths, micro="elastic_plastic", rtol=1e-8)
    )
    assert_array_equal(found.status, 0)
    for name in (*RESULTS, "A0"):
        assert_allclose(getattr(found, name), CONTACTS[name], rtol=1e-8, atol=0, err_msg=name)


def elastic_contacts():
    return random_contacts(24, base=np.tile(["layered", "half_space", "thin_layer", "auto"], 6), bonding="frictionless")


def test_a_contact_that_stays_elastic_is_that_of_the_disc_cell_of_the_core():
    """To rounding: elastic_plastic is solved by numpy, and the disc cell by the compiled core where there is one."""
    cases, x = elastic_contacts(), (0.0, 0.5, 0.9)
    elastic, alone = solve(cases.but(micro="disc_cell"), x), solve(cases.but(hardness=1e3), x)
    for name in (*RESULTS, "P", "A0", "dP_dD", "p", "lam"):
        assert_allclose(getattr(alone, name), getattr(elastic, name), rtol=1e-12, atol=1e-16, err_msg=name)


def test_a_contact_that_stays_elastic_is_that_of_the_disc_cell(numpy_path):
    """To the last bit, on every base; beside contacts that yield to rounding, as products of matrices have it. So it is
    where asperities feel the layer, of which the flow of the spots is computed too."""
    cases, x = elastic_contacts(), (0.0, 0.5, 0.9)
    alike = ~cases.feels_layer()
    hard = np.arange(24) % 3 > 0
    elastic, alone = solve(cases.but(micro="disc_cell"), x), solve(cases.but(hardness=1e3), x)
    mixed = solve(cases.but(hardness=np.where(hard, 1e3, cases.hardness)), x)
    for name in (*RESULTS, "P", "A0", "dP_dD", "error", "p", "lam"):
        values = getattr(elastic, name)
        if name in ("p", "lam"):  # at more radii, in another product of matrices
            assert_allclose(getattr(alone, name), values, rtol=1e-12, atol=1e-16)
        else:
            assert_array_equal(getattr(alone, name)[alike], values[alike], name)
            assert_allclose(getattr(alone, name)[~alike], values[~alike], rtol=1e-13, err_msg=name)
        assert_allclose(getattr(mixed, name)[hard], values[hard], rtol=1e-11, atol=1e-14, err_msg=name)
    assert (alone.plastic_share == 0).all() and np.isnan(elastic.plastic_share).all()
    assert (mixed.plastic_share[~hard] > 0).any()


def test_at_yield_q_and_g_are_smooth():
    """They and their derivatives go on as they were, and the spots of no λ lose pressure."""
    y = np.geomspace(1e-4, 1e3, 4000)[None]
    for X, x_y in ((0.8, 0.2), (3.0, 0.378), (1e5, 0.5)):
        curve = LAW.curve(y, np.array([[X]]), np.array([[x_y]]))
        assert (np.diff(curve.q) > 0).all() and (np.diff(curve.g) > 0).all()
        for values, slope in ((curve.q, curve.dq), (curve.g, curve.dg)):
            steps = np.diff(values) / np.diff(y)
            # 1.2e-4 at the bend, by the distance of the points
            assert_allclose(steps, (slope[:, 1:] + slope[:, :-1]) / 2, rtol=2e-4, atol=0)


def test_plastic_limit():
    """Separate spots bear the hardness; where they merge, their pressure is H + p c with c from 0 to 1."""
    hardness, p = 1e-6, np.array([1e-10, 1e-8, 1e-7, 5e-7])
    spots = LAW.at(p, 1.0, **SPOTS, hardness=hardness, yield_strength=np.nan, nu=0.3)
    assert_allclose(spots.lam[:2] * hardness / p[:2], 1.0, rtol=5e-3)
    assert (spots.lam > p / (hardness + p)).all() and (spots.p_max <= hardness + p).all()


def test_hardness_follows_from_yield_strength_and_back():
    one = study.solve(P=1e-6, **LAYER, **SPOTS, micro="elastic_plastic", hardness=0.0284)
    other = study.solve(P=1e-6, **LAYER, **SPOTS, micro="elastic_plastic", yield_strength=0.0284 / TABOR)
    assert_allclose(one.a, other.a, rtol=1e-14)
    assert one.plastic_share > 0.5 and "plastic_share" not in study.solve(P=1e-6, **LAYER, **SPOTS, hardness=0.0284)


def test_error_bars():
    """λ bends where yielding begins, which two meshes may see alike by chance: with the quadrature of the nodes alone
    errors of Ar/An were nine times the estimate."""
    cases = random_contacts(20, seed=7)
    found, exact = solve(cases), solve(cases.but(rtol=1e-9))
    right = (found.status == 0) & (exact.status == 0)
    assert right.sum() > 18
    errors = [np.abs(getattr(found, name) / getattr(exact, name) - 1)[right] for name in RESULTS]
    assert (np.max(errors, axis=0) < found.error[right] + 1e-9).all()


def test_plastic_share_is_the_share_of_the_profile():
    """λ crosses its bound where the share says it, to 1e-5."""
    cases = random_contacts(8, seed=5, rtol=1e-8)
    found = solve(cases)
    radii = np.sqrt(np.maximum(found.plastic_share[:, None] + 1e-5 * np.array([-1, 1]), 0))
    inside = (found.status == 0) & (radii[:, 0] > 0.01) & (radii[:, 1] < 1)
    assert inside.sum() > 4
    E = np.where(cases.base == "half_space", 1.0, cases.n)
    own = LAW.scales(E, cases.Nbar, cases.Ra, cases.hardness, cases.hardness / TABOR, cases.nu)[2:]
    lam = solve(cases, np.clip(np.nan_to_num(radii), 0, 1).ravel()).lam
    for i in np.flatnonzero(inside):
        before, after = lam[i, 2 * i : 2 * i + 2]
        assert before > LAW.yielded(*own)[i] > after, i


def test_sensitivities_by_strengths():
    """By both, against differences. x_y and hardness act where spots have yielded alone."""
    Y = 0.35 * 0.02
    cases = Problem.of(
        P=[1e-6, 1e-5],
        **LAYER,
        **SPOTS,
        hardness=0.02,
        yield_strength=[Y, 1.05 * Y],
        micro="elastic_plastic",
        rtol=1e-8,
    )
    found = sensitivities(cases, solve(cases))
    for name in ("hardness", "yield_strength", "nu1"):
        step = 1e-3
        moved = [cases.but(rtol=1e-9, **{name: getattr(cases, name) * (1 + sign * step)}) for sign in (1, -1)]
        up, down = map(solve, moved)
        over = 2 * step * (cases.nu1 if name == "nu1" else 1.0)
        for quantity in (*RESULTS, "dP_dD"):
            slope = (np.log(getattr(up, quantity)) - np.log(getattr(down, quantity))) / over
            mine = found.logs[quantity][:, found.inputs.index(name)]
            assert_allclose(
                mine, slope, rtol=1e-3, atol=2e-4 if quantity == "dP_dD" else 2e-5, err_msg=f"{name} {quantity}"
            )


def keys(**model):
    tables = {"model": {"P": 1e-6, "h": 0.02, "n": 0.5, **SPOTS, "hardness": 0.02, "micro": "elastic_plastic"} | model}
    return case_keys(from_tables(tables, "one", "", "one").grid)


def test_poisson_ratios_count_without_friction_too():
    for base, names in (("layered", ("nu1", "nu2")), ("half_space", ("nu2",)), ("thin_layer", ("nu1",))):
        for name in names:
            assert (keys(base=base) != keys(base=base, **{name: 0.2})).all(), (base, name)
            assert (keys(base=base, micro="disc_cell") == keys(base=base, micro="disc_cell", **{name: 0.2})).all()
    for base in ("layered", "thin_layer", "auto", "half_space"):
        name = "nu2" if base == "half_space" else "nu1"
        a = study.solve(P=1e-6, **LAYER | {"bonding": "frictionless", "base": base, name: [0.1, 0.45]}, **SPOTS,
                        hardness=0.02, micro="elastic_plastic", m=0.2, accuracy=0.3).Ar_An  # fmt: skip
        assert abs(a[1] / a[0] - 1) > 1e-4, base


def test_strengths_that_do_not_go_together_are_invalid():
    """x_y outside [0.2, 0.5]; one of both is enough, none is a message."""
    x_y, H = np.array([0.19, 0.21, 0.49, 0.51]), 0.02
    found = solve(Problem.of(P=1e-6, **LAYER, **SPOTS, hardness=H, yield_strength=1.5 * x_y * H / yield_pressure(0.3),
                             micro="elastic_plastic"))  # fmt: skip
    assert_array_equal(found.status != 0, [True, False, False, True])
    assert np.isnan(found.a[[0, 3]]).all()
    with pytest.raises(ValueError, match="hardness or yield_strength is missing"):
        Problem.of(P=1e-6, **LAYER, **SPOTS, micro="elastic_plastic")
    with pytest.raises(study.StudyError, match="hardness or yield_strength is missing: micro = "):
        study.solve(P=1e-6, **LAYER, **SPOTS, micro="elastic_plastic")
    with pytest.raises(study.StudyError, match="hardness or yield_strength is missing in case 1"):
        study.solve(P=1e-6, **LAYER, **SPOTS, micro="elastic_plastic", cases=[{"yield_strength": 0.01}, {"m": 0.1}])
    with pytest.raises(study.StudyError, match="sigma is given with micro"):
        study.solve(P=1e-6, **LAYER, **SPOTS, micro="elastic_plastic", hardness=0.02, sigma=1e-5)


def test_falling_loads_are_warned_of():
    case = LAYER | SPOTS | {"micro": "elastic_plastic", "hardness": 0.02, "x": 2, "profiles": False}
    with pytest.warns(UserWarning, match="P falls along its axis"):
        study.solve(P=[1e-5, 1e-6], **case)
    with pytest.warns(UserWarning, match="P falls along its axis"):
        study.solve(P=["2 N", "1 N"], R="10 mm", E2="210 GPa", Nbar="2 1/um^2", Ra="10 um", hardness="8 GPa",
                    base="half_space", micro="elastic_plastic")  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study.solve(P=[1e-6, 1e-5], **case)
        study.solve(P=[1e-5, 1e-6], **case | {"micro": "disc_cell"})


def test_yield_pressure():
    """Against the table of the closed form, 30 digits rounded to 7; and its place is that of the largest stress."""
    nu = [0.0, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5]
    table = [1.299305, 1.498586, 1.554347, 1.612797, 1.674110, 1.738481, 1.806116, 1.877239]
    assert_allclose(yield_pressure(nu), table, rtol=0, atol=6e-7)
    y = np.linspace(0, 1.2, 100_001)[:, None]
    stress = np.abs((1 + np.array(nu)) * (1 - y * np.arctan2(1.0, y)) - 1.5 / (1 + y * y))
    assert_allclose(1 / yield_pressure(nu), stress.max(axis=0), rtol=1e-9)
    assert_allclose(yield_pressure(-1 + 1e-9), 1 / 1.5, rtol=1e-8)


def test_peak_pressure_of_results():
    found = study.solve(P=[1e-6, 1e-5], **LAYER, **SPOTS, micro="elastic_plastic", hardness=0.02)
    assert_allclose(study.derived.peak_pressure(found), found.p_max, rtol=1e-12)
    assert disc_cell.LAW.yielded is None
