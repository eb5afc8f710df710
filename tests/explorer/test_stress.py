"""The stresses of the page, stress.js, run by node, against those of the program."""

import json
import shutil
import subprocess
import warnings

import numpy as np
import pytest
from conftest import ROOT

import study
from study.explorer.page import contents

ROOM = ROOT / "study/explorer"
NODE = shutil.which("node")
FIELDS = """
const [Core, Stress] = ["core", "stress"].map((name) => require(`${process.argv[1]}/${name}.js`));
const [meshes, cases] = JSON.parse(require("fs").readFileSync(0));
Core.load(meshes);
console.log(JSON.stringify(cases.map((p) => {
  const { ev } = Core.solve(p), field = Stress.field(ev), h = p.layered ? p.h / p.value : 0;
  const at = (f, zs) => (f ? zs.map((z) => { const { sr, sz } = f(z); return [sr, sz]; }) : []);
  return { layer: at(field.layer, [0, 0.1, 0.5, 1].map((part) => part * h)), edge: field.edge,
    body: at(field.body, [0, 0.05, 0.3, 1].map((z) => h + z)), peaks: Stress.peaks(ev, field, 0.3) };
})));
"""
LOADS = """
globalThis.DATA = JSON.parse(require("fs").readFileSync(0));
const Contact = require(`${process.argv[1]}/contact.js`);
const texts = JSON.parse(process.argv[2]), contact = Contact.solve(texts);
const rows = Contact.stresses(contact).bodies.map((row) => [row.body, Contact.yieldLoad(contact, row)]);
console.log(JSON.stringify(rows));
"""

pytestmark = pytest.mark.skipif(NODE is None, reason="node is not installed (make explorer-test)")


def by_node(script: str, given, *words: str):
    command = [NODE, "-e", script, "--", str(ROOM), *words]
    done = subprocess.run(command, input=json.dumps(given), capture_output=True, text=True, check=True, timeout=300)
    return json.loads(done.stdout)


def contacts(many: int) -> list[dict]:
    """Random contacts as core.js takes them, with layers from a/20 to 10 a, soft and hard."""
    random, cases = np.random.default_rng(4), []
    for _ in range(many):
        a, layered = 10 ** random.uniform(-2.5, -1), bool(random.random() < 0.9)
        case = {"control": "a", "value": a, "layered": layered, "rough": bool(random.random() < 0.5)}
        case |= {"bonded": bool(random.random() < 0.6), "h": a * 10 ** random.uniform(-1.3, 1)}
        case |= {"n": 10 ** random.uniform(-2, 2) if layered else 1.0, "m": float(random.choice([0.0, 0.5]))}
        case |= {"nu1": random.uniform(0, 0.5), "nu2": random.uniform(0, 0.5), "Nbar": 250_000.0, "Ra": 0.004}
        cases.append(case)
    return cases


def of_program(case: dict):
    """The contact by `study.solve`."""
    given = {"a": case["value"], "m": case["m"], "nu2": case["nu2"], "x": 2}
    given |= {"micro": "disc_cell", "Nbar": 250_000, "Ra": 0.004} if case["rough"] else {"micro": "smooth"}
    if case["layered"]:
        given |= {name: case[name] for name in ("h", "n", "nu1")} | {"base": "layered"}
        given |= {"bonding": "bonded" if case["bonded"] else "frictionless"}
    else:
        given |= {"base": "half_space"}
    return study.solve(**given)


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
def test_fields_on_the_axis_and_at_the_edge():
    """Within 3e-6 of the largest stress: waves end at kh = 16, and the pressure is that of 22 nodes."""
    cases = contacts(60)
    looked_at = 0
    for case, shown in zip(cases, by_node(FIELDS, [contents()["meshes"], cases]), strict=True):
        contact, h = of_program(case), case["h"] / case["value"] if case["layered"] else 0.0
        if int(contact.status) != 0:
            continue
        looked_at += 1
        wanted, largest = [], np.abs(shown["layer"] + shown["body"]).max()
        if case["layered"]:
            field = study.stresses(contact, r=[0.0], z=h * np.array([0, 0.1, 0.5]))
            under = [float(field[f"{name}_above"].item()) for name in ("sr", "sz")]
            wanted = [*np.stack([field.sr.values.ravel(), field.sz.values.ravel()], axis=1), under]
        np.testing.assert_allclose(shown["layer"], wanted, rtol=0, atol=3e-6 * largest, err_msg=str(case))
        field = study.stresses(contact, r=[0.0, 1.0], z=[0.0, *(h + np.array([0.05, 0.3, 1]))])
        wanted = np.stack([field[name].sel(r=0.0).values.ravel() for name in ("sr", "sz")], axis=1)
        if case["layered"]:
            wanted[0] = [field[f"{name}_below"].sel(r=0.0).item() for name in ("sr", "sz")]
        np.testing.assert_allclose(shown["body"], wanted, rtol=0, atol=3e-6 * largest, err_msg=str(case))
        assert shown["edge"] == pytest.approx(field.sr.sel(r=1.0, z=0.0).item(), abs=3e-6 * largest), case
        extremes = study.extremes(contact)
        for body, name in (("layer", "mises1"), ("body", "mises2")):
            if shown["peaks"][body]:
                value, on_axis = extremes[name].item(), extremes[f"{name}_r"].item() == 0
                assert shown["peaks"][body]["value"] <= value * (1 + 1e-5), case
                assert not on_axis or shown["peaks"][body]["value"] == pytest.approx(value, rel=1e-4), case
    assert looked_at > 50


@pytest.mark.parametrize("layer", ["DLC a-C:H", "TiN"])
def test_loads_of_first_yield(layer):
    """A ball on a coating of a tenth of a: body and punch yield on the axis, at the loads that `first_yield` finds."""
    texts = {"R": "5 mm", "punch": "steel 52100", "layer": layer, "h": "30 um", "bonding": "bonded"}
    texts |= {"body": "steel 52100", "micro": "smooth"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        first = study.first_yield(**texts)
    rows = dict(by_node(LOADS, contents(), json.dumps(texts | {"P": "10 N"})))
    assert rows["body"] == pytest.approx(first.P_Y2.item(), rel=3e-3)
    assert rows["punch"] == pytest.approx(first.P_Y_punch.item(), rel=3e-3)
