"""Materials by name in place of E and ν."""

import tomllib

import numpy as np
import pytest
import xarray as xr

import study
from study import materials
from study.inputs.reading import from_tables

pytest.importorskip("pint")
pytestmark = pytest.mark.filterwarnings("ignore:this contact is beyond")
COATED = {"R": "5 mm", "punch": "100Cr6", "layer": "PTFE", "body": "steel 52100", "h": "100 um", "micro": "smooth"}


def numbers(E: str, nu: str, name: str, spreads: bool) -> dict:
    found = materials.get(name)
    ends = (f" ± {found.E_spread!r}", f" ± {found.nu_spread!r}") if spreads else ("", "")
    return {E: f"{found.E!r}{ends[0]} Pa", nu: f"{found.nu!r}{ends[1]}"}


def test_a_name_stands_for_both_numbers_and_their_spreads():
    found = study.solve(**COATED, P="10 N", x=2)
    given = {"R": "5 mm", "h": "100 um", "micro": "smooth", "P": "10 N"}
    given |= numbers("E_punch", "nu_punch", "100Cr6", True) | numbers("E1", "nu1", "PTFE", True)
    expected = study.solve(**given, **numbers("E2", "nu2", "100Cr6", True), x=2)
    for name in ("a", "a_spread", "D_spread", "p0_spread"):
        np.testing.assert_allclose(found[name], expected[name], rtol=1e-12, err_msg=name)
    text = study.summary(found)
    assert "punch of steel 52100, E_punch = 207.0 ± 3.0 GPa" in text and "layer of PTFE, E1 = 490 ± 50 MPa" in text


def test_a_material_of_the_user(tmp_path):
    text = '["my coating"]\nE = 490e6\nnu = 0.46\nE_spread = 50e6\nnu_spread = 0.02'
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    mine = materials.read(tmp_path / "mine.toml")["my coating"]
    found = study.solve(**COATED | {"layer": [mine, "PTFE"]}, P="10 N", x=2)
    assert found.layer.values.tolist() == ["my coating", "PTFE"]
    assert found.a[0] == found.a[1] and found.a_spread[0] == found.a_spread[1], "PTFE has these numbers"


def test_several_materials_are_one_axis():
    names = ["PTFE", "PEEK", "PMMA"]
    found = study.solve(**COATED | {"layer": names, "body": ["rigid", "glass"]}, P="10 N", x=2)
    assert found.sizes == {"layer": 3, "body": 2, "x": 2} and found.layer.values.tolist() == names
    series = pytest.importorskip("pandas").Series(names)
    assert study.solve(**COATED | {"layer": series}, P="10 N", x=2).layer.values.tolist() == names
    alone = study.solve(**COATED | {"layer": "peek", "body": "rigid"}, P="10 N", x=2)
    chosen = found.sel(layer="PEEK", body="rigid")
    np.testing.assert_allclose([chosen.a, chosen.a_spread], [alone.a, alone.a_spread], rtol=1e-12)
    assert "a rigid base" in study.summary(chosen) and chosen.E1.item() == materials.get("PEEK").E
    rows = [{"label": "soft", "layer": "PTFE"}, {"label": "hard", "layer": "PEEK"}]
    cases = study.solve(cases=rows, **{k: v for k, v in COATED.items() if k != "layer"}, P="10 N", x=2)
    assert cases.layer.values.tolist() == ["PTFE", "PEEK"] and cases.label.values.tolist() == ["soft", "hard"]


def test_the_materials_of_earlier_results():
    """As `P=earlier.P`: the names were no names of materials."""
    earlier = study.solve(**COATED | {"layer": ["PTFE", "PEEK"]}, P="10 N", x=2)
    again = study.solve(**COATED | {"layer": earlier.layer, "punch": earlier.punch}, P="10 N", x=2)
    xr.testing.assert_identical(again.a_spread, earlier.a_spread)
    with pytest.raises(study.StudyError, match="layer: a DataArray of names is over the dimension of its own name"):
        study.solve(**COATED | {"layer": earlier.layer.rename(layer="film")}, P="10 N")


def test_study_files_take_the_values_and_if_wanted_the_spreads(tmp_path):
    text = "".join(f"{name} = {value!r}\n" for name, value in COATED.items() if name != "layer")
    text = f'[model]\n{text}[axes]\nlayer = ["PTFE", "PEEK"]\nP = ["1 N", "10 N"]\n[output]\nspreads = false\n'
    made = study.Study(from_tables(tomllib.loads(text), "lining", text, "lining.toml"), tmp_path)
    assert made.run(workers=1).computed == 4
    found = made.open().sel(layer="PTFE", P="10 N")
    assert "a_spread" not in found and found.punch.item() == "steel 52100"
    np.testing.assert_allclose(found.a, study.solve(**COATED, P="10 N", x=2).a, rtol=1e-12)
    edited = text.replace('"PEEK"]', '"PEEK", "PMMA"]')
    assert study.Study(from_tables(tomllib.loads(edited), "lining", edited, "x"), tmp_path).run(workers=1).computed == 2
    edited = text.replace("spreads = false", "spreads = true")
    made = study.Study(from_tables(tomllib.loads(edited), "spread", edited, "x"), tmp_path)
    assert made.run(workers=1).computed == 4, "the blocks without derivatives do not do"
    found = made.open().sel(layer="PTFE", P="10 N")
    alone = study.solve(**COATED, P="10 N", x=2)
    np.testing.assert_allclose([found.a, found.a_spread], [alone.a, alone.a_spread], rtol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"layer": "unobtainium"}, '^solve: layer: "unobtainium" is not a material; did you mean[^\n]*$'),
        (
            {"punch": "cone"},
            '^solve: punch: "cone" is not a material, such as "steel 52100"; the punch is a ball[^?]*$',
        ),
        (
            {"punch": "Sphere"},
            '^solve: punch: "Sphere" is not a material, such as "steel 52100"; the punch is a ball[^?]*$',
        ),
        ({"layer": "rigid"}, 'layer: "rigid" is not a material'),
        ({"body": 5.0}, "body: 5.0 is not the name of a material"),
        (
            {"punch": ["steel", 1 << 20_000]},
            "^solve: punch: a number of more than 4300 digits is not the name of a material",
        ),
        ({"E1": "1 GPa"}, "layer and E1 are both given: E1 follows from layer"),
        ({"nu2": 0.3}, "body and nu2 are both given"),
        ({"m": 0.5}, "punch and m are both given"),
        ({"coating": "PTFE"}, '"coating" is not a parameter'),
        ({"layer": materials.Material("mine", "1 GPa", 0.3, 0, 0)}, 'layer: "mine": E, nu and their spreads must be'),
        ({"layer": materials.Material("mine", 1e9, float("nan"), 0, 0)}, 'layer: "mine": E, nu and their spreads must'),
        ({"layer": materials.Material("mine", 1e9, 0.6, 0, 0)}, r"^solve: nu1 = 0.6: must be in \(-1, 0.5\]$"),
        ({"layer": [materials.Material("mine", 1e9, 0.6, 0, 0)]}, r"^solve: nu1\[0\] = 0.6: must be in \(-1, 0.5\]$"),
    ],
)
def test_slips_are_named(change, message):
    with pytest.raises(study.StudyError, match=message):
        study.solve(**COATED | change, P="10 N")
