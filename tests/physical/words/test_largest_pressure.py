"""Where p peaks in a ring the words say so."""

import json
import re
import warnings

import numpy as np
import pytest

import study
from study.__main__ import main
from study.commands.point import _ring as ring
from study.data.derived import depth_of_the_body, peak_pressure

PLATE = {"R": "3 mm", "punch": "rigid", "layer": "ta-C", "h": "20 um", "bonding": "bonded", "body": "PEEK", "P": "20 N"}
ROUGH = {"Nbar": "2 1/um^2", "Ra": "10 um"}
SIZES = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "nm": 1e-9, "µm": 1e-6, "mm": 1e-3}


def quiet(**given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**given)


def moved_spread(given: dict, formula) -> float:
    """The spread of what a formula makes of a contact, by differences of solutions over a tenth of each spread."""
    contact = quiet(**given, rtol=1e-8)
    names = ("R", "E1", "nu1", "E2", "nu2", "E_punch", "nu_punch", "h", "P", "Nbar", "Ra")
    exact = {name: (contact[name].item(), contact[name].attrs.get("units")) for name in names if name in contact}
    exact = {name: own for name, own in exact.items() if name != "nu_punch" or np.isfinite(contact.E_punch)}
    words = {name: given[name] for name in ("bonding", "micro") if name in given} | {"rtol": 1e-8}

    def moved(name: str, by: float) -> dict:
        values = {key: value + by * (key == name) for key, (value, _) in exact.items() if np.isfinite(value)}
        return {key: f"{value!r} {exact[key][1]}" if exact[key][1] else value for key, value in values.items()}

    steps = {name: 0.05 * contact[f"{name}_spread"].item() for name in exact if f"{name}_spread" in contact}
    cases = [moved(name, sign * step) for name, step in steps.items() for sign in (1, -1)]
    solved = quiet(cases=cases, **words)
    up, down = np.reshape([float(formula(solved.isel(case=i))) for i in range(len(cases))], (-1, 2)).T
    return float(np.sum(((up - down) / 0.1) ** 2) ** 0.5)


def test_a_ring_is_printed():
    """487 MPa in a ring were 207 MPa, those of the centre."""
    found = quiet(**PLATE, micro="smooth")
    text, top = study.summary(found), float(found.p.max())
    assert top > 2.3 * found.p0
    number, spread, unit, radius, length = re.search(
        r"\n  largest nominal pressure, in a ring +pring  = ([\d.]+) ± ([\d.]+) (\w+) at r = ([\d.]+) (\w+)\n", text
    ).groups()
    place = int(np.argmax(found.p.values))
    assert float(number) * SIZES[unit] == pytest.approx(top, rel=2e-3)
    assert float(spread) * SIZES[unit] == pytest.approx(float(found.p_spread[place]), rel=0.06), "two digits"
    assert float(radius) * SIZES[length] == pytest.approx(float(found.a * found.x[place]), rel=1e-3)


def test_under_asperities_both_pressures_are_those_of_the_ring():
    found = quiet(**PLATE | ROUGH)
    text, peak = study.summary(found), study.derived.peak_pressure(found).item()
    assert peak > 1.1 * found.p_max
    number, spread, unit = re.search(
        r"\n  largest real pressure, in the ring +ppeak  = ([\d.]+) ± ([\d.]+) (\w+)\n", text
    ).groups()
    assert float(number) * SIZES[unit] == pytest.approx(peak, rel=5e-3), "two digits of the spread"
    assert float(spread) * SIZES[unit] == pytest.approx(moved_spread(PLATE | ROUGH, peak_pressure), rel=0.06)
    plain = study.solve(P=1e-5, h=0.002, n=100, bonding="bonded", Nbar=1e5, Ra=0.004)
    assert re.search(r"ppeak  = \S+ E2\*\n", study.summary(plain)), "no input has a spread"
    # the pitch is above h: model_error makes a ±
    assert re.search(r"pring  = \S+ ± \S+ E2\* at r = 0\.0118\d+ R\n", study.summary(plain))


def test_without_a_ring_nothing_is_said_of_one():
    for more in ({"P": "1 mN"}, {"layer": "PTFE"}, {"base": "half_space"}):
        found = quiet(**PLATE | more, micro="smooth")
        text = study.summary(found)
        assert "ring" not in text and "largest nominal" not in text and "largest real" not in text


def test_point_solves_for_the_profile(capsys):
    words = [f"{name}={value}" for name, value in PLATE.items()]
    assert main(["point", *words, "micro=smooth"]) == 0
    found = quiet(**PLATE, micro="smooth")
    assert capsys.readouterr().out == study.summary(found) + "\n"
    assert main(["point", "--json", *words, "micro=smooth"]) == 0
    printed = json.loads(capsys.readouterr().out)
    spread = found.p_spread[int(np.argmax(found.p.values))].item()
    assert printed["p_ring"] == {"value": found.p.max().item(), "unit": "Pa", "spread": spread} and spread > 0
    assert printed["r_ring"]["value"] == pytest.approx(0.9375 * found.a.item(), rel=1e-12)
    assert printed["D_body"] == {"value": found.D.item(), "unit": "m", "spread": found.D_spread.item()}, "rigid punch"
    assert printed["p_peak"]["spread"] == pytest.approx(spread, rel=1e-6), "without asperities"
    assert printed["r_ring"]["spread"] == pytest.approx(moved_spread(PLATE | {"micro": "smooth"}, ring), rel=1e-3)
    assert main(["point", "--json", *words, "P=20 N", "micro=smooth"]) == 2


def test_spreads_of_what_follows_without_a_ring(capsys):
    """In the centre the largest pressures are those of the results. An elastic punch yields a part of the depth."""
    given = PLATE | {"layer": "PTFE", "punch": "steel 52100"} | ROUGH
    assert main(["point", "--json", *(f"{name}={value}" for name, value in given.items())]) == 0
    found, printed = quiet(**given), json.loads(capsys.readouterr().out)
    assert printed["p_ring"]["spread"] == pytest.approx(found.p0_spread.item(), rel=1e-9)
    assert printed["p_peak"]["spread"] == found.p_max_spread.item()
    wanted = moved_spread(given, depth_of_the_body)
    assert printed["D_body"]["spread"] == pytest.approx(wanted, rel=1e-3) and printed["r_ring"]["spread"] is None
    exact = {"R": "3 mm", "E2": "210 GPa", "base": "half_space", "P": "20 N", "micro": "smooth"}
    assert main(["point", "--json", *(f"{name}={value}" for name, value in exact.items())]) == 0
    assert "spread" not in capsys.readouterr().out


def test_of_a_contact_without_a_solution_no_spread_is_known(capsys):
    given = {"R": "3 mm", "E1": "1000 ± 50 GPa", "E2": "1 MPa", "h": "30 um", "bonding": "bonded", "a": "160 um"}
    assert main(["point", "--json", *(f"{name}={value}" for name, value in given.items()), "micro=smooth"]) == 1
    printed = json.loads(capsys.readouterr().out)
    assert printed["status"] == "lift_off"
    assert all(printed[name]["value"] is printed[name]["spread"] is None for name in ("p_ring", "p_peak", "D_body"))


def test_doubts_about_yielding_see_the_ring():
    """A film of steel on PEEK, whose ring is pressed by 0.03 of its modulus, and its centre by half of that."""
    given = PLATE | {"layer": "steel 52100", "R": "0.1 mm", "micro": "smooth"}
    loads = ["1 N", "2 N", "5 N", "10 N", "20 N", "50 N"]
    found = quiet(**given | {"P": loads})
    ring, centre = ((one > 0.03 * found.E1).values for one in (found.p.max("x"), found.p0))
    assert (ring & ~centre).any()
    for i, P in enumerate(loads):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            study.solve(**given | {"P": P})
        assert any("metals yield" in str(one.message) for one in caught) == ring[i], P
