"""`sensitivities=True` of `study.solve`: derivatives by the inputs as they were given."""

import warnings

import numpy as np
import pytest

import study

BALL = {"R": "5 mm", "E_punch": "200 GPa", "E2": "210 GPa", "micro": "smooth", "x": 2, "workers": 1}
LAYER = {"E1": "1.0 ± 0.1 GPa", "nu1": 0.3, "h": ["100 um", "200 um"], "P": ["1 N", "10 N"], "bonding": "bonded"}
RESULTS = ("a", "D", "p0", "p_max", "dP_dD")


def quiet(**given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**given)


def test_hertz():
    """p(0) ~ (P E*²/R²)^(1/3), a ~ (P R/E*)^(1/3), D ~ a²/R; E* has two parts, of the body and of the punch."""
    found = quiet(**BALL, P="1 N", base="half_space", nu2=0.3, nu_punch=0.2, sensitivities=True)
    stiff = {"E2": 210 / (1 - 0.3**2), "E_punch": 200 / (1 - 0.2**2)}
    of_body = stiff["E_punch"] / (stiff["E2"] + stiff["E_punch"])  # its share of the compliance
    wanted = {
        "a": {"P": 1 / 3, "R": 1 / 3, "E2": -of_body / 3, "E_punch": -(1 - of_body) / 3},
        "D": {"P": 2 / 3, "R": -1 / 3, "E2": -2 * of_body / 3, "E_punch": -2 * (1 - of_body) / 3},
        "p0": {"P": 1 / 3, "R": -2 / 3, "E2": 2 * of_body / 3, "E_punch": 2 * (1 - of_body) / 3},
    }
    for name, by in wanted.items():
        for given, value in by.items():
            mine = found[f"{name}_sensitivity"].sel(input=given)
            np.testing.assert_allclose(mine, value, rtol=0, atol=1e-7, err_msg=f"{name} by {given}")  # STEP²
    by_nu = 2 * 0.3 / (1 - 0.3**2) * of_body  # d ln E*/d nu2
    np.testing.assert_allclose(found.a_sensitivity.sel(input="nu2"), -by_nu / 3, rtol=0, atol=1e-7)
    assert found.P_sensitivity.sel(input="P") == 1


@pytest.mark.parametrize(
    ("name", "up", "down", "step"),
    [("E1", "1.001 GPa", "0.999 GPa", 2e-3), ("R", "5.005 mm", "4.995 mm", 2e-3), ("nu1", 0.301, 0.299, 2e-3)],
)
def test_layers_on_a_grid(name, up, down, step):
    found = quiet(**BALL | LAYER, sensitivities=True)
    assert found.a_sensitivity.dims == ("h", "P", "input")
    ends = [quiet(**BALL | LAYER | {name: end, "rtol": 1e-9}) for end in (up, down)]
    for result in RESULTS:
        wanted = np.log(ends[0][result] / ends[1][result]) / step
        mine = found[f"{result}_sensitivity"].sel(input=name)
        np.testing.assert_allclose(mine, wanted, rtol=0, atol=2e-5, err_msg=result)  # the moved cases: 1e-3²


def test_without_units():
    found = study.solve(P=[1e-5, 2e-5], h=0.02, n=0.5, micro="smooth", sensitivities=True)
    assert found.input.values.tolist() == ["P", "h", "n", "m"]
    assert (found.P_sensitivity.sel(input="P") == 1).all() and (found.a_sensitivity.sel(input="m") == 0).all()
    assert "a_sensitivity" not in study.solve(P=1e-5, h=0.02, n=0.5, micro="smooth")


@pytest.mark.parametrize("more", [{"sensitivities": "yes"}, {"sensitivities": True, "chunks": {"P": 1}}])
def test_what_is_refused(more):
    with pytest.raises(study.StudyError, match="must be true or false, and false beside chunks"):
        study.solve(P=[1e-5, 2e-5], base="half_space", micro="smooth", **more)
