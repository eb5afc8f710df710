"""Tables of indents (h, P, S): the radius by the area function, and the modulus of the film that made them."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from study.__main__ import main

FILM = {"R": "1 mm", "h": "500 nm", "nu1": 0.2, "bonding": "bonded", "body": "silicon", "punch": "rigid"}
FILM |= {"micro": "smooth"}
TIP = [24.5, 800.0, 50.0]  # nm


def indents(S=None) -> dict:
    """A table whose contact depths are 20, 50 and 100 nm."""
    hc, P = np.array([20.0, 50.0, 100.0]), np.array([0.1, 0.5, 2.0])  # nm, mN
    S = np.array([0.01, 0.04, 0.1]) if S is None else S  # mN/nm
    return {"h": (hc + 0.75 * P / S, "nm"), "P": (P, "mN"), "S": (S, "mN/nm")}


def test_the_radius_of_an_area_function():
    hc = np.array([20.0, 50.0, 100.0])
    area = 24.5 * hc**2 + 800 * hc + 50 * np.sqrt(hc)
    curves = study.curves(indents(), area=TIP)
    assert_allclose(curves.a.values[0], 1e-9 * np.sqrt(area / np.pi), rtol=1e-12)
    assert_allclose(curves.dP_dD.values[0], [1e4, 4e4, 1e5], rtol=1e-12)
    assert set(curves.data_vars) == {"a", "dP_dD"}
    cone = study.curves(indents(), area=lambda depth: 24.5 * depth**2)
    assert_allclose(cone.a.values[0], 1e-9 * hc * np.sqrt(24.5 / np.pi), rtol=1e-12)
    with_area = {"S": indents()["S"], "A": (area * 1e-6, "um^2")}
    assert_allclose(study.curves(with_area).a, curves.a, rtol=1e-12)


def test_from_a_table_to_the_modulus(tmp_path, capsys):
    """A file whose stiffness is that of contacts with the radii of its area function, in Python and in a terminal."""
    depths = np.linspace(10, 200, 25)
    radii = np.sqrt((24.5 * depths**2 + 800 * depths) / np.pi)
    contacts = study.solve(**FILM, E1="200 GPa", a=[f"{a} nm" for a in radii], x=2, profiles=False)
    S = contacts.dP_dD.values * 1e-6  # mN/nm
    P = 1e-2 * radii**2 * 1e-3
    rows = np.column_stack([depths + 0.75 * P / S, P, S])
    np.savetxt(tmp_path / "table.csv", rows, delimiter=",", header="h [nm],P [mN],S [mN/nm]", comments="")
    curves = study.curves(tmp_path / "table.csv", area=[24.5, 800])
    fitted = study.fit(curves, **FILM, free=["E1"], x="a", y="dP_dD", intervals="fisher")
    assert fitted.E1.item() == pytest.approx(200e9, rel=1e-5)
    words = [*(f"{name}={value}" for name, value in FILM.items()), "free=E1", "x=a", "y=dP_dD", "intervals=fisher"]
    assert main(["fit", str(tmp_path / "table.csv"), *words, "area=24.5, 800", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["E1"]["value"] == fitted.E1.item()
    for area, message in {
        "area=tip": "area=tip: must be numbers C0, C1 ... in nm, such as area=24.5,800",
        "area=": "area=: must be numbers C0, C1 ... in nm",
    }.items():
        assert main(["fit", str(tmp_path / "table.csv"), *words, area]) == 2
        assert message in capsys.readouterr().err


def test_points_without_contact_are_none():
    table = indents() | {"S": ([0.01, 0.0, -0.1], "mN/nm"), "h": ([30.0, 50.0, 60.0], "nm")}
    assert np.isfinite(study.curves(table, area=24.5).a.values).tolist() == [[True, False, False]]


@pytest.mark.parametrize(
    ("left_out", "more", "area", "message"),
    [
        ("h", {}, TIP, "there is no h"),
        ("", {}, None, "need the area function of the tip"),
        ("", {}, "tip", 'area = "tip": must be numbers'),
        ("", {"A": ([1.0, 2.0, 3.0], "nm^2")}, TIP, "there is a column A: leave out area"),
        ("", {"D": ([1.0, 2.0, 3.0], "nm")}, TIP, '"D" does not go with S'),
        ("S", {"D": ([1.0, 2.0, 3.0], "nm")}, TIP, "area goes with the columns h, P and S"),
        ("", {"P": ([1.0, 2.0, 3.0], "nm")}, TIP, "P"),
    ],
)
def test_what_is_refused(left_out, more, area, message):
    table = {name: column for name, column in (indents() | more).items() if name != left_out}
    with pytest.raises(study.StudyError) as error:
        study.curves(table, area=area)
    assert message in str(error.value)
