"""Adhesion in calls and study files: units, results, statuses, masks, words, what is refused, files, fits."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from study.rules.slope_and_adhesion import rises_from_tension
from study.studies.literature.pull_off import THIN

GEL = {"R": "5 um", "E2": "10 kPa", "nu2": 0.49, "base": "half_space", "micro": "smooth"}
STICKY = GEL | {"w_adhesion": "1 mJ/m^2"}
HELD = -1.5 * np.pi * 1e-3 * 5e-6  # N, of Johnson, Kendall and Roberts
ALONE = {"base": "half_space", "micro": "smooth"}


@pytest.fixture(autouse=True)
def quiet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def test_a_pull_under_a_dead_load():
    found = study.solve(**STICKY, P=["-5 nN", "0 nN", "-30 nN"])
    assert_allclose(found.P_off, [HELD] * 3, rtol=1e-9)
    assert study.decode(found.status).values.tolist() == ["converged", "converged", "pulled_off"]
    assert found.stable.dtype == bool and found.stable.values.tolist()[:2] == [True, True]
    assert np.isnan(found.a[2]) and np.isfinite(found.a[:2]).all()
    assert_allclose((found.P_in[1], found.a_in[1]), (0, found.a[1]), rtol=1e-9)  # it jumps to P = 0
    units = {name: found[name].attrs["units"] for name in ("w_adhesion", "P_off", "D_off", "a_in")}
    assert units == {"w_adhesion": "J/m^2", "P_off": "N", "D_off": "m", "a_in": "m"}


def test_words_say_whether_it_is_stable_and_when_it_comes_off():
    text = study.summary(study.solve(**STICKY, D="-50 nm"))
    assert "w_adhesion = 1 mJ/m², adhesion JKR" in text and "This contact is stable." in text
    assert (
        "under depth control the punch comes off at P = " in text and "Not checked" in text and "adhesion." not in text
    )
    soft = study.summary(study.solve(**STICKY, P="0 nN", k_machine="0.02 N/m"))
    assert "on a machine of stiffness 20 mN/m the punch comes off" in soft
    off = study.summary(study.solve(**STICKY, P="-50 nN"))
    assert "NOT SOLVED (pulled_off)" in off and "comes off at P = -23.562 nN" in off
    open_ = study.summary(study.solve(**STICKY, a="0.5 um"))
    assert "This contact is unstable" in open_
    assert "so the surfaces do not adhere" in study.summary(study.solve(**GEL, P="1 nN", w_adhesion="0 J/m^2"))


def test_branches_and_machines():
    both = study.solve(**STICKY, D="-100 nm", branch=["stable", "unstable"])
    assert both.a[0] > both.a_off[0] > both.a[1] and both.stable.values.tolist() == [True, False]
    rigid = study.solve(**STICKY, P="0 nN", k_machine="rigid")
    assert_allclose(rigid.D_off, study.solve(**STICKY, D="0 nm").D_off, rtol=1e-6)


def test_the_reach_of_the_attraction():
    """pi E w/(4 sigma0²) with sigma0 = w/(0.97 z0): 0.1 a at one z0."""
    contact = study.solve(P=1e-5, w_adhesion=1e-7, **ALONE)
    edge = np.sqrt(0.1 * float(contact.a) * 4 * 1e-7 / np.pi) / 0.97
    found = study.solve(P=1e-5, w_adhesion=1e-7, z0=[0.99 * edge, 1.01 * edge], **ALONE)
    assert study.decode(found.validity).values.tolist() == ["", "not_jkr"]
    assert "not known" in contact.validity.attrs["comment"] and "comment" not in found.validity.attrs


def test_tension_inside():
    p = np.array([[3.0, 2.0, 1.0, -5.0], [1.0, -1.0, -2.0, -9.0], [1.0, -1.0, 0.5, -9.0], [-1.0, 2.0, 1.0, -9.0]])
    assert rises_from_tension(p).tolist() == [False, False, True, True]
    assert "interior_tension" not in study.decode(study.solve(P=1e-5, w_adhesion=1e-7, **ALONE).validity).item()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"w_adhesion": 1e-6, "micro": "disc_cell", "Nbar": 250000, "Ra": 0.004},
            r"needs micro = .smooth. among the inputs",
        ),
        ({"adhesion": "dmt"}, "adhesion is given without w_adhesion"),
        ({"k_machine": 1}, "k_machine is given without w_adhesion"),
        ({"w_adhesion": 1e-6, "adhesion": "maugis"}, "needs exactly one of sigma0 and z0"),
        ({"w_adhesion": 1e-6, "adhesion": "dmt", "z0": 1e-4}, "z0 is given with adhesion"),
        ({"w_adhesion": 1e-6, "adhesion": "dmt", "shape": "sphere"}, "is for shape = .paraboloid."),
        (
            {"w_adhesion": 1e-6, "adhesion": "maugis", "z0": 1e-4, "shape": "flat", "flat_radius": 0.1},
            'is not for shape = "flat", whose edge is fixed: take "jkr"',
        ),
        ({"w_adhesion": 0.0, "P": -1e-5}, "P must be > 0 where w_adhesion is 0"),
        ({"w_adhesion": 1e-6, "scheme": "picard"}, "picard"),
        ({"w_adhesion": 1e-6, "adhesion": "dlvo"}, 'must be one of "jkr", "dmt", "maugis"'),
        ({"w_adhesion": 1e-6, "k_machine": "soft"}, 'k_machine = "soft": must be a finite number, >= 0, or "rigid"'),
        ({"w_adhesion": 1e-6, "micro": "disc_cell"}, 'micro = "smooth", which w_adhesion wants'),
        ({"D": -1e-3, "P": None}, "a pull needs w_adhesion"),
        ({"w_adhesion": -1e-6}, r"w_adhesion = -1e-06: must be in \[0, 1e3\]"),
        ({"P": -1e-5}, r"must be in \[1e-24, 1e3\]"),
    ],
)
def test_what_is_refused(given, message):
    with pytest.raises(study.StudyError, match=message):
        call = {"P": 1e-5} | ALONE | given
        study.solve(**{name: value for name, value in call.items() if value is not None})


def test_words_are_read_as_people_write_them():
    call = ALONE | {"P": 0.0, "w_adhesion": 1e-6}
    plain = study.solve(**call, adhesion="jkr", branch="stable", k_machine=np.inf)
    for words in ({"adhesion": "JKR"}, {"branch": " Stable", "k_machine": "rigid"}):
        assert study.solve(**call, **{"k_machine": np.inf} | words).equals(plain)


def test_a_refusal_says_what_the_asperities_may_pull():
    rough = GEL | {"micro": "disc_cell", "Nbar": "1 1/um^2", "Ra": "0.1 um"}
    with pytest.raises(study.StudyError, match=r"1.5 pi w Ra Nbar = 471.24 Pa: .* above 47.124 kPa"):
        study.solve(**rough, P="1 nN", w_adhesion="1 mJ/m^2")


def test_stresses_of_what_sticks():
    """Under the centre of the surface sz is -p(0); at the edge it pulls without limit, and dmt attracts outside."""
    contact = study.solve(P=[1e-5, -1e-7], w_adhesion=1e-7, **ALONE)
    sz = study.stresses(contact, r=[0.0, 1.0], z=[0.0]).sz.squeeze("z")
    assert_allclose(sz.sel(r=0.0), -contact.p0, rtol=1e-9)
    assert np.all(sz.sel(r=1.0) == np.inf)
    with pytest.raises(study.StudyError, match="extremes: there are no largest stresses .* where the surfaces adhere"):
        study.extremes(contact)
    with pytest.raises(study.StudyError, match='no stresses of contacts that adhere yet, except with adhesion = "jkr"'):
        study.stresses(study.solve(P=1e-5, w_adhesion=1e-7, adhesion="dmt", **ALONE))


def test_a_results_file_has_what_is_true_and_false(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = '[model]\nbase = "half_space"\nmicro = "smooth"\nw_adhesion = 1e-7\n[axes]\na = [1e-3, 2e-2]\n'
    (tmp_path / "sticky.toml").write_text(text, encoding="utf-8")
    read = study.open_results(study.load(tmp_path / "sticky.toml").run().path)
    assert read.stable.dtype == bool and read.stable.values.tolist() == [False, True]
    assert_allclose(read.P_off, -1.5 * np.pi * 1e-7, rtol=1e-9)


def test_a_thin_layer_holds_harder():
    """Towards -2 pi w R and -3 pi w R of docs/literature.md, at a/h near 5."""
    thin = {"h": 1e-3, "n": 0, "w_adhesion": 1e-7, "P": 0.0, "micro": "smooth"}
    cases = [{"bonding": "frictionless"}, {"bonding": "bonded", "nu1": 0.3}, {"bonding": "bonded", "nu1": 0.5}]
    over = study.solve(**thin, cases=cases).P_off.values / (-np.pi * 1e-7)
    assert (over > 1.9).all() and (over[:2] < THIN["frictionless"]).all() and 2.2 < over[2] < THIN["bonded, ν = 0.5"]


def test_a_fit_finds_the_work_of_adhesion():
    """From its curve of retraction. Between radii P is right to 1e-5 of the largest load."""
    depths = np.concatenate([np.linspace(400, -200, 12), [-600.0, -800.0]])
    curve = study.solve(**STICKY, D=[f"{d} nm" for d in depths[:12]], x=2, profiles=False)
    measured = {"D": (depths, "nm"), "P": (np.append(curve.P.values, [0.0, 0.0]), "N")}
    options = {"contact_point": False, "baseline": False, "intervals": None}
    fitted = study.fit(
        measured, **GEL, w_adhesion="1.5 mJ/m^2", free={"w_adhesion": ("0.5 mJ/m^2", "2 mJ/m^2")}, **options
    )
    assert_allclose(fitted.w_adhesion, 1e-3, rtol=1e-4)
