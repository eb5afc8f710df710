"""Stacks of layers in calls, study files and on the command line."""

import json
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import study
from study.__main__ import main
from study.inputs.definition import from_call
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables

DLC = [
    {"material": "DLC a-C:H", "h": "2 um", "bonding": "bonded"},
    {"material": "CrN", "h": "0.2 um", "bonding": "bonded"},
]
BALL = {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "micro": "smooth"}
PURE = [{"h": 0.01, "n": 2.0, "nu": 0.2, "bonding": "bonded"}, {"h": 0.02, "n": 0.5, "nu": 0.4, "bonding": "bonded"}]


def test_a_stack_in_a_call():
    contact = study.solve(layers=PURE, a=[0.03, 0.06], micro="smooth")
    assert study.decode(contact.model_used).values.tolist() == ["smooth_stack"] * 2
    assert contact["layers.2.h"] == 0.02 and contact["layers.2.bonding"] == "bonded" and contact.h == 0.01
    one = study.solve(layers=PURE[:1], a=0.05, micro="smooth")
    layered = study.solve(h=0.01, n=2.0, nu1=0.2, bonding="bonded", a=0.05, micro="smooth")
    assert_allclose(one.P, layered.P, rtol=1e-10)


@pytest.mark.parametrize(
    "inputs", [{"layers": [{"h": 0.01, "n": 1.0}] * 17}, {"layers.17.h": 0.01, "layers.17.n": 1.0}]
)
def test_too_many_layers_are_named(inputs):
    with pytest.raises(study.StudyError) as caught:
        study.solve(P=1e-5, micro="smooth", **inputs)
    assert "solve: layers: 17 layers: at most 16 are allowed" in caught.value.messages


def test_an_axis():
    contact = study.solve(layers=PURE, a=0.05, micro="smooth", **{"layers.2.h": [0.01, 0.02, 0.04]})
    assert contact.P.dims == ("layers.2.h",)
    alone = study.solve(layers=PURE, a=0.05, micro="smooth")
    assert_allclose(contact.P.sel({"layers.2.h": 0.02}), alone.P, rtol=1e-12)
    top = study.solve(layers=PURE, a=0.05, micro="smooth", **{"layers.1.h": [0.01, 0.02]})
    assert_allclose(top.P.sel(h=0.01), alone.P, rtol=1e-12)


def test_materials_units_and_spreads():
    stack = [DLC[0] | {"h": "2.0 ± 0.1 um"}, DLC[1]]
    contact = study.solve(**BALL, layers=stack, P="1 N", sensitivities=True)
    nitride = study.materials.get("CrN")
    assert contact["layers.2.material"] == "CrN" and contact["layers.2.E1"] == nitride.E
    E2 = 207e9 / (1 - 0.29**2)
    assert_allclose(contact["layers.2.n"], nitride.E / (1 - nitride.nu**2) / E2, rtol=1e-12)
    assert contact.a_spread > 0 and {"layers.2.E1", "layers.2.h", "layers.2.nu"} <= {*contact.input.values.tolist()}
    by = contact.D_sensitivity.sel(input="layers.2.E1").item()
    moduli = [
        study.solve(
            **BALL,
            layers=[stack[0], {"E1": E, "nu": nitride.nu, "h": "0.2 um", "bonding": "bonded"}],
            P="1 N",
            rtol=1e-10,
        )
        for E in (f"{nitride.E * 1.01} Pa", f"{nitride.E * 0.99} Pa")
    ]
    assert_allclose(by, float(np.log(moduli[0].D / moduli[1].D)) / np.log(1.01 / 0.99), rtol=1e-3)


def test_springs_with_units():
    bond = {"cn": "1e-17 m/Pa", "ct": "2e-17 m/Pa"}
    contact = study.solve(**BALL, layers=[DLC[0] | {"bonding": bond}, DLC[1]], P="1 N")
    assert contact["layers.1.cn"] == 1e-17 and contact["layers.1.cn"].attrs["units"] == "m/Pa"
    rigid = study.solve(**BALL, layers=DLC, P="1 N")
    assert contact.D > rigid.D


def test_a_rigid_base():
    gel = [
        {"E1": "10 kPa", "nu": 0.5, "h": "20 um", "bonding": "bonded"},
        {"E1": "50 kPa", "nu": 0.4, "h": "30 um", "bonding": "bonded"},
    ]
    with_units = study.solve(R="50 um", E2="rigid", layers=gel, D="1 um", micro="smooth")
    n = 50e3 / (1 - 0.16) / (10e3 / 0.75)
    pure = [{"h": 0.4, "n": 1.0, "nu": 0.5, "bonding": "bonded"}, {"h": 0.6, "n": n, "nu": 0.4, "bonding": "bonded"}]
    without = study.solve(layers=pure, rigid_base=True, D=0.02, micro="smooth")
    assert_allclose(with_units.P / (10e3 / 0.75) / 50e-6**2, without.P, rtol=1e-9)


def test_graded_with_units():
    lens = [{"E1": ["30 kPa", "1.5 MPa"], "nu": 0.49, "h": "20 um", "profile": "exponential", "bonding": "bonded"}]
    contact = study.solve(R="2 mm", E2="1.5 MPa", nu2=0.49, layers=lens, P="100 uN", micro="smooth", rtol=1e-4)
    assert contact.status == 0 and contact.error < 1e-4 and contact["layers.1.E1_bottom"] == 1.5e6
    soft, hard = (
        study.solve(R="2 mm", E2=E, nu2=0.49, base="half_space", P="100 uN", micro="smooth").D
        for E in ("30 kPa", "1.5 MPa")
    )
    assert hard < contact.D < soft


def test_a_table_in_a_call(tmp_path):
    """Its numbers are in the key, not its name alone."""
    path, tables = tmp_path / "table.csv", {"title": "", "output": {}}
    layer, keys = {"profile": f"table:{path}", "h": 0.05, "bonding": "bonded"}, []
    for last in (2, 3):
        path.write_text(f"0,1\n1,{last}\n")
        definition = from_call({"a": 0.05, "micro": "smooth", "layers": [layer]}, [], False, tables)
        keys.append((case_keys(definition.grid).tolist(), definition.digest))
    assert keys[0][0] != keys[1][0] and keys[0][1] != keys[1][1]
    contact = study.solve(a=0.05, micro="smooth", rtol=1e-4, layers=[layer])
    assert contact.status == 0 and contact.n == 1
    with pytest.raises(study.StudyError, match="is given beside a table"):
        study.solve(a=0.05, micro="smooth", layers=[layer | {"n": 2.0}])


TOML = {
    "model": {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "micro": "smooth", "P": "1 N"},
    "layers": DLC,
    "axes": {"layers": {"2": {"h": ["0.1 um", "0.2 um"]}}},
}


def test_a_study_file(tmp_path):
    text = """
    [model]
    R = "5 mm"
    punch = "steel 52100"
    body = "steel 52100"
    micro = "smooth"
    P = "1 N"
    [[layers]]
    material = "DLC a-C:H"
    h = "2 um"
    bonding = "bonded"
    [[layers]]
    material = "CrN"
    bonding = { cn = "1e-17 m/Pa", ct = "0 m/Pa" }
    [axes]
    layers.2.h = { start = "0.1 um", stop = "0.4 um", num = 3 }
    """
    path = tmp_path / "stack.toml"
    path.write_text(text)
    assert main(["check", str(path)]) == 0
    study.load(path, tmp_path).run()
    script = "import study, sys; print(study.summary(study.open_results(sys.argv[1])))"
    fresh = subprocess.run([sys.executable, "-c", script, str(tmp_path / "stack.nc")], capture_output=True, text=True)
    assert "layer 2: of CrN" in fresh.stdout, fresh.stderr
    opened = study.open_results(tmp_path / "stack.nc")
    stack = [DLC[0], DLC[1] | {"bonding": {"cn": "1e-17 m/Pa", "ct": "0 m/Pa"}}]
    alone = study.solve(**BALL, layers=stack, P="1 N", **{"layers.2.h": ["0.1 um", "0.25 um", "0.4 um"]})
    assert_allclose(opened.D.values, alone.D.values, rtol=1e-12)
    again = study.sensitivities(opened)
    assert again.D_sensitivity.dims == ("layers.2.h", "input")


def test_tables_and_calls_have_the_same_keys():
    one = from_tables(TOML, "one", "", "one")
    parameters = TOML["model"] | {"layers": DLC, "layers.2.h": ["0.1 um", "0.2 um"]}
    other = from_call(parameters, [], False, {"title": "", "output": {}})
    assert (case_keys(one.grid) == case_keys(other.grid)).all()
    changed = from_tables(TOML | {"layers": [DLC[0] | {"bonding": "frictionless"}, DLC[1]]}, "one", "", "one")
    assert (case_keys(one.grid) != case_keys(changed.grid)).all()


def test_old_keys_stay():
    """A call without layers has the key that it had before one with layers was made."""
    case = {"P": 1e-5, "h": 0.01, "n": 0.5, "Nbar": 250000, "Ra": 0.004}
    tables = {"title": "", "output": {}}
    before = from_call(dict(case), [], False, tables)
    from_call({"P": 1e-5, "layers": PURE * 2, "micro": "smooth"}, [], False, tables)
    after = from_call(dict(case), [], False, tables)
    assert (case_keys(before.grid) == case_keys(after.grid)).all() and before.digest == after.digest
    assert case_keys(before.grid).tolist() == OLD


#: The key of this case at commit 49208f30, before there were stacks.
OLD = [[8410003975613323893, 15640725963468336789]]


def test_point(capsys):
    words = ["point", "R=5 mm", "E2=210 GPa", "layers.1.E1=200 GPa", "layers.1.h=2 um", "layers.1.bonding=bonded"]
    words += ["layers.2.E1=280 GPa", "layers.2.h=0.2 um", "layers.2.bonding=bonded", "P=1 N", "micro=smooth"]
    assert main(words) == 0
    assert "layer 2: h = 200 nm" in capsys.readouterr().out
    assert main([*words, "--json"]) == 0
    numbers = json.loads(capsys.readouterr().out)
    assert_allclose(numbers["layers.2.h"]["value"], 2e-7)
    assert main([*words, "layers.2.cn=-1 m/Pa"]) == 2


def test_the_summary_has_the_geometry():
    text = str(study.summary(study.solve(**BALL, layers=DLC, P="1 N")))
    assert "Stack, from the surface down: layer 2: of CrN, h = 200 nm" in text and "then the body" in text
    assert "layer 2 at 0.0" in text and "The largest shear stress of an interface is" in text


def test_cases():
    """Stacks that differ, and one beside a bare body."""
    cases = [{"layers": PURE, "P": 1e-5}, {"layers": PURE[::-1], "P": 2e-5}, {"base": "half_space", "P": 2e-5}]
    contacts = study.solve(cases=cases, micro="smooth")
    for i, case in enumerate(cases):
        assert_allclose(contacts.a[i], study.solve(**case, micro="smooth").a, rtol=1e-12)


@pytest.mark.filterwarnings("ignore:this contact is beyond")  # its asperities yield
def test_rough_stacks_with_units():
    """The rules about the pressures of metals and the pitch of the asperities know their first layer."""
    rough = BALL | {"micro": "disc_cell", "Nbar": "1 1/um^2", "Ra": "2 um"}
    contact = study.solve(**rough, layers=DLC, P="0.1 N")
    assert contact.status == 0 and "layer 2: of CrN" in str(study.summary(contact))


def test_bases_of_one_call():
    contacts = study.solve(layers=PURE, P=1e-5, base=["stack", "half_space", "thin_layer"], micro="smooth")
    used = study.decode(contacts.model_used).values.tolist()
    assert used == ["smooth_stack", "smooth_half_space", "smooth_thin_stack"]


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_strengths_beside_a_stack():
    """Each layer and the body set the mask by their own strength; strong ones do not."""
    inputs = BALL | {"layers": DLC, "P": "1000 N"}
    for weak in ("Y1", "layers.2.Y", "Y2"):
        strong = {name: "100 GPa" for name in ("Y1", "layers.2.Y", "Y2") if name != weak}
        assert study.solve(**inputs, **strong, **{weak: "1 MPa"}).validity.item() & 512
        assert not study.solve(**inputs, **strong, **{weak: "100 GPa"}).validity.item() & 512


BAD = {
    "too many": ({"layers": PURE * 9}, "18 layers: at most 16"),
    "beside": ({"layers": PURE, "h": 0.1}, "h is given beside layers"),
    "a wrong key": ({"layers": [PURE[0] | {"thickness": 1}]}, "layers.1.thickness: is not a key of a layer"),
    "a negative spring": ({"layers": [PURE[0] | {"bonding": {"cn": -1, "ct": 0}}]}, "layers.1.cn = -1: must be in"),
    "a wrong spring": ({"layers": [PURE[0] | {"bonding": {"kn": 1}}]}, "springs have cn and ct"),
    "no thickness": ({"layers": [PURE[0], {"n": 1.0}]}, "layers.2.h is missing"),
    "several values": ({"layers": [PURE[0] | {"h": [0.1, 0.2]}]}, "an axis stands beside layers"),
    "no list": ({"layers": "two"}, "at the surface first; in a terminal write layers.1.h=..., layers.2.h=... instead"),
    "a rigid base": ({"layers": PURE, "rigid_base": True}, "of the first layer 1"),
    "a rigid word": ({"layers": PURE, "rigid_base": "yes"}, "must be true or false"),
    "layered": ({"layers": PURE, "base": "layered"}, 'base = "layered" has one layer'),
    "three moduli": ({"layers": [PURE[0] | {"n": [1, 2, 3], "profile": "linear"}]}, "must be [top, bottom]"),
    "one modulus": ({"layers": [PURE[0] | {"profile": "linear"}]}, "layers.1.n = 2.0: of a graded layer must be [top"),
    "no file": ({"layers": [{"h": 0.1, "profile": "table:no.csv"}]}, "layers.1: profile table:no.csv: cannot be read"),
    "no file on an axis": (
        {"layers": [PURE[0] | {"profile": "linear", "n": [1.0, 2.0]}], "layers.1.profile": ["linear", "table:no.csv"]},
        "solve: layers: profile table:no.csv: cannot be read",
    ),
    "a table": ({"layers": [PURE[0] | {"profile": "cubic"}]}, 'or "table:FILE.csv"'),
    "no layers": ({"layers": {}}, "layers = {}: must be a list of layers"),
    "from 0": ({"layers": PURE, "layers.0.h": 0.1}, "layers count from 1 at the surface"),
    "a ratio on a rigid base": ({"rigid_base": True, "h": 0.1, "n": 0.5}, "layers.1.n = 0.5: on a rigid base n is"),
    "a hard bottom": (
        {"layers": [{"h": "1 um", "E1": ["1 GPa", "1e15 GPa"], "profile": "exponential"}], **BALL},
        "layers.1.E1_bottom = 1e+15 GPa: ratio of the reduced moduli of the bottom of layer 1",
    ),
    "nothing": ({"base": "stack"}, 'layers are missing: base = "stack" needs them'),
    "a tuple": ({"layer": ("DLC a-C:H", "CrN"), "h": "1 um", **BALL}, "is a tuple: a list is an axis"),
}


def test_layers_that_are_no_list_in_a_file():
    with pytest.raises(study.StudyError, match="layers = 3: must be a list of layers"):
        from_tables({"model": {"a": 0.05, "micro": "smooth", "layers": 3}}, "x", "", "x")


@pytest.mark.parametrize("words", [["table:no.csv", "linear"], xr.DataArray(["linear", "table:no.csv"], dims="kind")])
def test_profiles_without_their_file_have_one_message(words):
    layers = [{"h": 0.1, "n": [1.0, 2.0], "profile": "linear"}]
    with pytest.raises(study.StudyError) as caught:
        study.solve(a=0.05, micro="smooth", layers=layers, **{"layers.1.profile": words})
    assert len(caught.value.messages) == 1 and "table:no.csv: cannot be read" in str(caught.value)


@pytest.mark.parametrize("kind", BAD)
def test_bad_input(kind):
    parameters, message = BAD[kind]
    with pytest.raises(study.StudyError) as caught:
        study.solve(**{"a": "1 um" if "R" in parameters else 0.05, "micro": "smooth"} | parameters)
    assert message in str(caught.value)
