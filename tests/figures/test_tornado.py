"""`study.plot(contact, "p_max", "input")`: what each input changes of one result."""

import warnings

import numpy as np
import pytest

import study
from study.figures.plots import drawn
from study.figures.style import StyledFigure

BALL = {"R": "5 mm", "E2": "210 GPa ± 10 GPa", "nu2": "0.3 ± 0.02", "micro": "smooth", "base": "half_space", "x": 2}


def of(contact, name: str, **where):
    return drawn(contact, name, "input", "", where, StyledFigure)


def test_bars_are_the_changes_with_one_standard_deviation():
    """p(0) ~ (P E*²/R²)^(1/3) of a sphere on a half-space."""
    contact = study.solve(**BALL, P=["1.0 ± 0.1 N", "10 N"], workers=1)
    figure, columns = of(contact, "p0", P="1 N")
    by_nu = 2 * 0.3 / (1 - 0.3**2) * 0.02
    wanted = {"E2": 2 / 3 * 10 / 210, "nu2": 2 / 3 * by_nu, "P": 0.1 / 3}
    assert columns["input"].tolist() == sorted(wanted, key=wanted.get), "the longest is the last, above"
    np.testing.assert_allclose(
        columns["change of p0 [%]"], [100 * wanted[name] for name in columns["input"]], rtol=1e-6
    )
    total = float(contact.p0_spread.sel(P="1 N") / contact.p0.sel(P="1 N"))
    np.testing.assert_allclose(np.sqrt(np.sum(columns["change of p0 [%]"] ** 2)), 100 * total, rtol=1e-6)
    (axes,) = figure.axes
    widths = [bar.get_width() for bar in axes.patches]
    np.testing.assert_allclose(widths[:3], columns["change of p0 [%]"])
    np.testing.assert_allclose(widths[3:], -columns["change of p0 [%]"])


def test_without_spreads_each_input_is_larger_by_1_percent():
    contact = study.solve(P=2e-5, h=0.02, n=0.5, nu1=0.3, Nbar=2.5e5, Ra=0.004, bonding="bonded", x=2, workers=1)
    _, columns = of(contact, "p_max")
    by_input = study.sensitivities(contact).p_max_sensitivity
    wanted = by_input.sel(input=columns["input"])
    np.testing.assert_allclose(columns["change of p_max [%]"], wanted, rtol=1e-12)
    assert {"P", "n", "Ra", "nu1"} <= {*columns["input"]} and "m" not in columns["input"]


@pytest.mark.parametrize(
    ("x", "message"),
    [("p0", r"y = input is of one contact: choose one of P \(2\)"), ("p", "x must be one of a, P, D, p0, p_max")],
)
def test_what_is_refused(x, message):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        contact = study.solve(**BALL, P=["1 N", "2 N"], workers=1)
    with pytest.raises(study.StudyError, match=message):
        study.plot(contact, x, "input")


def test_what_has_failed_has_no_bars():
    contact = study.solve(P=1e-5, h=0.02, n=0.5, Nbar=1e5, Ra=1e-3, max_iterations=1, x=2, workers=1)
    with pytest.raises(study.StudyError, match="nothing to draw"):
        study.plot(contact, "p_max", "input")
