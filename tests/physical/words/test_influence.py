"""The sentence about what ± is made of."""

import re
import warnings

import numpy as np
import pytest

import study

FILM = {"R": "5 mm", "E2": "210 GPa", "E1": "1.0 ± 0.1 GPa", "nu1": 0.4, "h": "100 ± 5 um", "bonding": "bonded"}
FILM |= {"P": "5.0 ± 0.05 N", "x": 2, "workers": 1}
ROUGH = {"Nbar": "2e9 1/m^2", "Ra": "10 um"}


def quiet(**given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**given)


def sentence(contact) -> str:
    lines = [line for line in study.summary(contact).splitlines() if line.startswith("Spreads: ")]
    return lines[0] if lines else ""


@pytest.mark.parametrize(("more", "name", "symbol"), [({"micro": "smooth"}, "p0", r"p\(0\)"), (ROUGH, "p_max", "pmax")])
def test_the_share_is_that_of_the_variance_and_h_does_what_is_said(more, name, symbol):
    found = quiet(**FILM | more)
    alone = quiet(**FILM | more | {"h": "100 um", "P": "5 N"})  # the spread of E1 by itself
    share = float((alone[f"{name}_spread"] / found[f"{name}_spread"]) ** 2)
    form = rf"Spreads: E1 contributes (\d+) % of the variance of {symbol}; "
    form += rf"a ([\d.]+) % (\w+) h makes {symbol} 1 % larger\."
    percent, change, way = re.fullmatch(form, sentence(found)).groups()
    assert int(percent) == round(100 * share)
    factor = 1 + (1 if way == "larger" else -1) * float(change) / 100
    ends = [quiet(**FILM | more | {"h": f"{100 * h} um"})[name].item() for h in (factor, 1.0)]
    assert ends[0] / ends[1] == pytest.approx(1.01, abs=1e-3), "two digits, and the curvature"


def test_where_nothing_is_said():
    exact = {"E1": "1 GPa", "h": "100 um", "P": "5 N"}
    assert sentence(quiet(**FILM | exact, micro="smooth")) == ""
    assert sentence(quiet(**FILM, micro="smooth").drop_vars("micro").assign_coords(micro="of_another")) == ""
    correlated = quiet(**FILM, micro="smooth", correlations={("E1", "h"): 0.5})
    assert "variance" not in sentence(correlated) and "h makes" in sentence(correlated)
    assert correlated.attrs["correlations"] == "E1 and h: 0.5"


def test_an_input_that_makes_nearly_all_and_a_layer_that_hardly_acts():
    """The change is ten times that of a contact solved again on a layer that is 1 % thicker."""
    thick = quiet(**FILM | {"h": "10.0 ± 0.1 mm", "P": "5 N"}, micro="smooth")
    most = "Spreads: E1 contributes nearly all of the variance of p(0); 10 % of h changes p(0) by "
    assert sentence(thick) == f"{most}less than 0.01 %."
    thinner, more = (quiet(**FILM | {"h": h, "P": "5 N"}, micro="smooth") for h in ("1.00 ± 0.01 mm", "1.01 mm"))
    change = float(sentence(thinner).removeprefix(most).removesuffix(" %."))
    assert change == pytest.approx(1000 * abs(more.p0.item() / thinner.p0.item() - 1), rel=0.05)
    assert np.isfinite(thick.p0_spread)


def test_a_spread_that_no_digit_shows_has_no_parts():
    """The glass of a bead on a soft gel: the parts of such a spread are below the error of the solution."""
    gel = {"R": "2.5 um", "E1": "5 kPa", "nu1": 0.5, "h": "2 um", "bonding": "bonded", "D": "50 nm", "micro": "smooth"}
    glass = {"E_punch": "64.0 ± 0.6 GPa", "nu_punch": "0.2 ± 0.005", "E2": "71 ± 1 GPa", "nu2": "0.22 ± 0.01"}
    contact = quiet(**gel, **glass, x=2, workers=1)
    assert 0 < contact.p0_spread < 1e-8 * contact.p0
    assert sentence(contact) == (
        "Spreads: the ± of the inputs changes p(0) by less than a part in ten million; "
        "a 10 % smaller h makes p(0) 1 % larger."
    )
