"""An input with a unit that is beyond the bounds of the solver: what was given, and the bounds in the same unit."""

import re

import numpy as np
import pytest
import xarray as xr

import study
from study.__main__ import main

pytest.importorskip("pint")
GIVEN = {"R": "5 mm", "E1": "210 GPa", "nu1": 0.3, "E2": "210 GPa", "nu2": 0.3, "h": "2 um", "micro": "smooth"}
#: 1e-24 and 1e3 E2* R², E2* = 210 GPa/0.91.
LOADS = r"must be in \[5.769e-18, 5.769e\+09\] N, which is \[1e-24, 1e3\] E2\* R\^2, E2\* = 230.77 GPa and R = 5 mm"
LOADS += "; a pull needs w_adhesion, the work of adhesion"
LENGTHS = r"which is \[1e-12, 1e6\] R"


def refusal(**change) -> str:
    with pytest.raises(study.StudyError) as caught:
        study.solve(**GIVEN | {"P": "1 N"} | change)
    assert all(message.startswith("solve: ") for message in caught.value.messages)
    return str(caught.value).replace("solve: ", "")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"P": "-10 N"}, f"^P = -10 N: {LOADS}$"),
        ({"P": "0 N"}, f"^P = 0 N: {LOADS}$"),
        ({"P": ["1 N", "-0.01 kN"]}, r"^P\[1\] = -0.01 kN: must be in \[5.769e-21, 5.769e\+06\] kN, which is"),
        ({"h": "-0.002 mm"}, rf"^h = -0.002 mm: must be in \[5e-12, 5e\+06\] mm, {LENGTHS}"),
        ({"h": "2e-9 um"}, rf"^h = 2e-9 um: must be in \[5e-09, 5e\+09\] um, {LENGTHS}"),
        ({"h": ["2 um", "-3e-6 m"], "R": ["5 mm", "6 mm"]}, r"^h\[1\] = -3e-6 m: must be in \[5e-15, 5000\] m"),
        ({"h": ["2 um", "5e-9 um"], "R": ["5 mm", "6 mm"]}, r"^h\[1\] = 5e-9 um: must be in \[6e-09, 6e\+09\] um"),
        ({"P": "-10 ± 1 N"}, f"^P = -10 ± 1 N: {LOADS}$"),
        ({"P": "-10 N ± 5 %"}, f"^P = -10 N ± 5 %: {LOADS}$"),
        ({"Nbar": "-1 µm⁻²", "Ra": "1 um"}, r"^Nbar = -1 µm⁻²: must be in \[4e-12, 4e\+10\] 1/µm², which is"),
        ({"P": xr.DataArray([2.0, -1.0], dims="q", attrs={"units": "N"})}, rf"^P\[1\] = -1 N: {LOADS}$"),
        ({"P": "-1 N", "h": "-1 um"}, "(?s)^h = -1 um.*\nP = -1 N"),
        ({"P": "-1 N", "E2": "rigid"}, r"which is \[1e-24, 1e3\] E1\* R\^2, E1\* = 230.77 GPa and R = 5 mm; a pull"),
        ({"E1": "200 mPa"}, "^E1 = 0.2 Pa: ratio of .* layer and half-space: n = 9.524e-13: must be 0 or in"),
        ({"E_punch": "1e-9 Pa"}, r"^E_punch = 1e-09 Pa: ratio of .* layer and punch, 0: rigid: m = .*: must be in"),
    ],
)  # fmt: skip
def test_the_message_has_the_unit_that_was_given(change, message):
    assert re.search(message, refusal(**change)), refusal(**change)


def test_quantities_of_pint():
    import pint

    unit = pint.UnitRegistry()
    assert "P = -10 newton: must be in [5.769e-18, 5.769e+09] newton" in refusal(P=unit.Quantity(-10, "N"))
    assert "P[1] = -2.0 newton: must be in [5.769e-18" in refusal(P=unit.Quantity(np.array([1.0, -2.0]), "N"))


def test_rows_ranges_and_the_command_line(tmp_path, capsys):
    with pytest.raises(study.StudyError, match=r"^solve: P\[1\] = -2 N: must be in"):
        study.solve(**GIVEN, cases=[{"P": "1 N"}, {"P": "-2 N"}])
    path = tmp_path / "slip.toml"
    path.write_text(
        '[model]\nR = "5 mm"\nE1 = "210 GPa"\nE2 = "210 GPa"\nh = "2 um"\nmicro = "smooth"\n'
        '[axes]\nP = { start = "-2 mN", stop = "1 N", num = 4 }\n'
    )
    with pytest.raises(study.StudyError, match=r"slip.toml: P\[0\] = -2 mN: must be in \[5.769e-15, 5.769e\+12\] mN"):
        study.load(path)
    words = [f"{name}={value}" for name, value in GIVEN.items()]
    assert main(["point", *words, "P=-10 N"]) == 2
    assert "P = -10 N: must be in [5.769e-18, 5.769e+09] N" in capsys.readouterr().err


@pytest.mark.parametrize("radius", [{"R": "5.0 ± 0.1 mm"}, {"R": None, "R1": "5 mm", "R2": "20 ± 1 mm"}])
def test_a_table_whose_lengths_would_follow_the_spread_of_a_radius(radius, tmp_path):
    """Its lengths are in R, but no heights in µm grow with the error of R: the spreads would be wrong."""
    file = tmp_path / "mine.csv"
    file.write_text("z,share\n0,1\n1e-5,1\n2e-5,1\n")
    given = GIVEN | {"P": "50 mN", "Nbar": "5 1/um^2", "Ra": "20 um", "h": "99 um", "micro": f"table:{file}"}
    change = {name: value for name, value in (given | radius).items() if value}
    word = next(name for name, value in radius.items() if value and "±" in value)
    message = (
        rf"^solve: {word} has a spread: the lengths in .*mine.csv are in R and would change with it; give {word} none$"
    )
    with pytest.raises(study.StudyError, match=message):
        study.solve(**change)
    assert study.solve(**given).status == 0
