"""What becomes of curves that cannot be fitted: a status for each, and nothing is raised in a batch."""

import pickle
import warnings

import numpy as np
import pytest
from measured_curves import DEPTHS, GEL, fit, gel, status

import study
from study.inverse.fits import tasks as room
from study.work import engine

NOISE = np.random.default_rng(7).standard_normal(len(DEPTHS))


def bad_curves():
    """Name -> loads at DEPTHS, and the status they end with."""
    P, sigma = gel()
    some = np.where(np.arange(len(P)) < 3, P, np.nan)
    return {
        "good": (P, "converged"),
        "no point": (np.full(len(P), np.nan), "invalid_input"),
        "as many points as unknowns": (some, "invalid_input"),
        "constant": (np.full(len(P), 1e-9), "invalid_input"),
        "noise": (sigma * NOISE, "no_contact"),
        "a straight line": (1e-9 * (DEPTHS / 1e-6 + 1e-3 * NOISE), "no_contact"),
        "an exact straight line": (1e-9 * DEPTHS / 1e-6, "no_contact"),
        "upside down": (-P, "no_contact"),
        "newtons for nanonewtons": (1e9 * P, "no_contact"),
        "infinite loads": (np.full(len(P), np.inf), "invalid_input"),
    }


def test_each_bad_curve_has_its_status_and_nothing_is_raised_or_warned_of():
    curves = bad_curves()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fitted = fit(DEPTHS, np.array([P for P, _ in curves.values()]))
    assert dict(zip(curves, status(fitted), strict=True)) == {name: wanted for name, (_, wanted) in curves.items()}
    usable = fitted.fit_status.values == 0
    for name in ("E1", "E1_low", "E1_high", "E1_spread", "D0", "P0"):
        assert np.array_equal(np.isfinite(fitted[name].values), usable), name
    assert fitted.fit_status.dtype == np.int8
    wanted = "converged at_bound iteration_limit several_minima not_identifiable no_contact invalid_input"
    assert fitted.fit_status.attrs["flag_meanings"] == wanted
    text = str(study.summary(fitted))
    assert text.count("no contact") >= 5 and text.count("invalid input") >= 4 and "nan" not in text


def test_a_contact_that_keeps_to_the_assumptions_is_said_to():
    depths = np.linspace(-0.2, 1.0, 60) * 1e-7
    text = str(study.summary(fit(depths, gel(depths=depths)[0])))
    assert "At the deepest point none of the checked assumptions is violated" in text
    assert text.count("\n\n") == 2, "below what was given, and below the heading"


def test_gaps_equal_depths_and_disorder_change_nothing_and_are_said():
    depths = np.linspace(-0.2, 1.0, 60) * 1e-7
    loads = gel(depths=depths)[0]
    usual = fit(depths, loads)
    text = str(study.summary(usual))
    assert not any(word in text for word in ("have no numbers", "of another", "not in the order"))
    order = np.random.default_rng(3).permutation(64)
    D, P = np.append(depths, [1e-8, np.nan, *depths[[5, 9]]]), np.append(loads, [np.nan, 1e-9, *loads[[5, 9]]])
    D, P = (np.append(column[order], np.nan) for column in (D, P))  # the last one fills up
    odd = fit(D, P)
    text = str(study.summary(odd))
    assert "2 of 64 points have no numbers and are left out. 2 points have the same D as another; each counts." in text
    assert "The points are not in the order of D, which does not matter." in text
    np.testing.assert_allclose(odd.E1, usual.E1, rtol=0.02, err_msg="two points of 60 count twice")


def test_no_points_at_all():
    assert status(fit(DEPTHS[:0], DEPTHS[:0])) == ["invalid_input"]


def test_one_depth_alone():
    assert status(fit(np.full(50, 1e-7), np.linspace(0, 1e-9, 50))) == ["invalid_input"]
    above = fit(np.linspace(-2e-7, 0, 50), np.linspace(0, 1e-9, 50), contact_point=False)
    assert status(above) == ["invalid_input"]  # without a contact point only depths above 0 are in contact


def test_depths_in_the_wrong_unit():
    """Metres for nanometres: 10⁵ radii deep. A status, no exception."""
    P, _ = gel()
    assert status(fit(1e9 * DEPTHS, P))[0] in ("invalid_input", "no_contact")


def test_at_a_bound():
    P, _ = gel(noise=1e-3)
    bounds = {"E1": ("1 kPa", "4.9 kPa")}
    fitted = study.fit({"D": (DEPTHS, "m"), "P": (P, "N")}, free=bounds, progress=False, **GEL)
    assert status(fitted) == ["at_bound"]
    np.testing.assert_allclose(fitted.E1, 4.9e3, rtol=1e-12)
    assert fitted.E1_high <= 4.9e3 * (1 + 1e-12)


def test_not_identifiable():
    """A shallow contact says nothing of h: its interval ends at a bound, and so it is said."""
    shallow = np.linspace(-0.2, 1.0, 120) * 5e-9
    P, _ = gel(depths=shallow, noise=0.02)
    fitted = fit(shallow, P, free=("E1", "h"), intervals="profile")
    assert status(fitted)[0] in ("not_identifiable", "at_bound")
    np.testing.assert_allclose(fitted.h_high, 1.5e-5, rtol=1e-9)
    assert fitted.E1_low < 5e3 < fitted.E1_high


def test_the_stiffness_of_a_half_space_is_a_straight_line_and_a_contact():
    a = np.linspace(0.1, 1, 30) * 1e-6
    P = 2 * a * 2e5 / (1 - 0.3**2)
    bare = {"R": "5 um", "nu2": 0.3, "micro": "smooth", "base": "half_space"}
    fitted = study.fit({"a": (a, "m"), "dP_dD": (P, "N/m")}, x="a", y="dP_dD", free=["E2"], progress=False, **bare)
    assert status(fitted) == ["converged"]
    np.testing.assert_allclose(fitted.E2, 2e5, rtol=1e-9)


def test_outliers():
    """5 % of points off by 20 sigma: Huber's loss is off by less than half of what least squares is."""
    P, sigma = gel()
    random = np.random.default_rng(3)
    curves = P + 20 * sigma * random.choice([-1, 1], (40, len(P))) * (random.random((40, len(P))) < 0.05)
    off = {}
    for loss in ("linear", "huber"):
        fitted = fit(DEPTHS, curves, loss=loss)
        off[loss] = np.sqrt(np.mean(np.log(fitted.E1.values / 5e3) ** 2))
    assert off["huber"] < 0.5 * off["linear"]
    covered = (fitted.E1_low < 5e3) & (fitted.E1 > 0) & (fitted.E1_high > 5e3)
    assert covered.mean() > 0.8


def test_an_interrupt_keeps_what_is_done(monkeypatch):
    P, _ = gel()
    blocks = room.fit_block
    calls = []

    def interrupted(*arguments):
        calls.append(1)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return blocks(*arguments)

    monkeypatch.setattr(room, "fit_block", interrupted)
    monkeypatch.setattr(engine, "START", np.inf)  # the interrupt is of this process
    curves = P * np.linspace(1, 2, 70)[:, None]
    with pytest.warns(UserWarning, match="interrupted after 64 of 70 curves, which are kept"):
        fitted = fit(DEPTHS, curves)
    assert status(fitted).count("converged") == 64 and status(fitted).count("not_run") == 6
    assert np.isfinite(fitted.E1.values).sum() == 64
    assert "interrupted" in str(study.summary(fitted.isel(curve=np.flatnonzero(fitted.fit_status.values)[:1])))
    calls[:] = [1]
    with pytest.raises(KeyboardInterrupt):
        fit(DEPTHS, P)


class Apart:
    """In place of a worker process: what goes there and comes back is packed, and the table is another one."""

    def __init__(self):
        self.parts = 0

    def reuse(self, most):
        return 0

    def feed(self, feeder, count):
        feeder(self.call)
        return [None]

    def call(self, function, part):
        self.parts += 1
        function, part = pickle.loads(pickle.dumps((function, part._replace(call="apart"))))
        return pickle.loads(pickle.dumps(function(part)))

    def end(self):
        pass


def test_curves_that_processes_fit_have_the_same_bits(monkeypatch):
    curves = gel()[0] * np.linspace(1, 2, 130)[:, None]
    monkeypatch.setattr(engine, "START", np.inf)
    here = fit(DEPTHS, curves)
    apart = Apart()
    for name, value in {"START": 1e-9, "_pool": apart, "available_workers": lambda: 2}.items():
        monkeypatch.setattr(engine, name, value)
    both = fit(DEPTHS, curves)
    assert apart.parts == 2, "of three blocks all but the first"
    room.forget("apart")
    assert not room._tables, "a call leaves no table behind"
    assert both.identical(here)


def test_the_figure_draws_over_gaps_and_has_units():
    depths = np.linspace(-0.2, 1.0, 40) * 1e-7
    loads = gel(depths=depths)[0]
    loads[20] = np.nan
    above, below = study.plot(fit(depths, loads)).axes
    assert below.get_ylabel() == "residual, nN" and above.get_ylabel().endswith(", nN")
    drawn = next(line for line in above.lines if line.get_linestyle() == "-")
    assert len(drawn.get_xdata()) == 39 and np.isfinite(drawn.get_ydata()).all()


def test_each_curve_of_a_figure_has_room():
    """In inches; alone it has the width of a column."""
    depths = np.linspace(-0.2, 1.0, 40) * 1e-7
    fitted = fit(depths, gel(depths=depths)[0] * np.array([[1.0], [2.0], [3.0]]))
    assert study.plot(fitted, curve=1).get_figwidth() == 3.4
    assert study.plot(fitted).get_figwidth() >= 3 * 2.9
