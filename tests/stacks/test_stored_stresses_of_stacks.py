"""`[output] stresses = true` of stacks: the largest stresses over layers and interfaces are stored with the cases."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver.yields.stacked.largest import DIMENSION, EXTREMES
from solver.yields.stacked.mixture import OF_ONE_LAYER
from study.data.frames import frames
from study.inputs.punch import stresses
from study.store import windows
from study.work import run as running

STUDY = """
[model]
R = "1 mm"
body = "steel 52100"
micro = "smooth"
[[layers]]
h = "2 um"
bonding = "bonded"
[[layers]]
E1 = "280 GPa"
nu = 0.21
h = "1 um"
bonding = "bonded"
Y = "{strength}"
[axes]
layers.1.material = ["DLC a-C:H", "TiN"]
P = {loads}
[output]
profiles = false
stresses = true
"""
CALL = {"R": "1 mm", "body": "steel 52100", "micro": "smooth", "P": ["0.5 N", "2 N"]}
LAYERS = [
    {"h": "2 um", "bonding": "bonded", "material": "TiN"},
    {"E1": "280 GPa", "nu": 0.21, "h": "1 um", "bonding": "bonded"},
]


def load(folder, loads='["0.5 N", "2 N"]', strength="1.5 GPa"):
    (folder / "stack.toml").write_text(STUDY.format(loads=loads, strength=strength), encoding="utf-8")
    return study.load(folder / "stack.toml", folder / "results")


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stored")
    file = load(folder)
    file.run(workers=1)
    return folder, file.open()


def test_the_names_are_those_of_the_solver():
    assert {name: dim or None for name, (dim, _) in stresses.OF_STACKS.items()} == {
        name: DIMENSION[place] for name, (_, place) in EXTREMES.items()
    }
    assert stresses.OF_ONE_LAYER == OF_ONE_LAYER


def test_results_have_the_extremes_of_a_call(stored):
    """Also from the results: they can be solved again, though `layer` is the number of a layer."""
    _, results = stored
    here = {"layers.1.material": "TiN"}
    expected = study.extremes(study.solve(**CALL, layers=LAYERS))
    again = study.extremes(results.sel(here))
    assert results.mises_layer.dims == ("P", "layers.1.material", "layer")
    assert results.tau_interface.dims == ("P", "layers.1.material", "interface")
    assert results.layer.values.tolist() == results.interface.values.tolist() == [1, 2]
    for name, array in expected.data_vars.items():
        values = results[name].sel(here).transpose(*array.dims)
        # a batch of other cases changes pressures by rounding, and a flat maximum is found to about its root
        tolerance = {"rtol": 1e-10, "atol": 1e-6 if name.endswith(("_r", "_z")) else 0.0}
        assert_allclose(values.values, array.values, **tolerance, err_msg=name)
        assert_allclose(again[name].values, array.values, **tolerance, err_msg=name)
        assert values.attrs["long_name"] == array.attrs["long_name"]
        assert values.attrs.get("units") == array.attrs.get("units")
    assert study.readable(results).mises_layer.attrs["units"] == "GPa"


def test_a_strength_that_changes_needs_no_case_again(stored):
    """The mask compares with what is stored; the material of the first layer is known by its name."""
    folder, results = stored
    assert (results.validity.values & 512 > 0).tolist() == (results.mises_layer.sel(layer=2) > 1.5e9).values.tolist()
    weak = load(folder, strength="1 MPa")
    assert weak.run(workers=1).computed == 0
    assert (weak.open().validity.values & 512).all()
    said = str(study.summary(results.isel(P=1, **{"layers.1.material": 1})))
    assert "layer of TiN" in said and "layer 1" in said


def test_more_loads_in_several_windows(stored, monkeypatch):
    """The cases that are stored are found, and files of several windows are one dataset."""
    folder, results = stored
    more = load(folder, '["0.5 N", "2 N", "3 N"]')
    assert more.run(workers=1).computed == 2
    whole = more.open().load()
    assert whole.mises_layer.sel(P=results.P).equals(results.mises_layer)
    monkeypatch.setattr(running, "BRIEF", float("inf"))
    monkeypatch.setattr(windows, "CASES", 2)
    monkeypatch.setattr(windows, "usual_block", lambda grid: 2)
    monkeypatch.setattr(windows, "BLOCKS", 1)
    cut = study.load(folder / "stack.toml", folder / "windows")
    cut.run(workers=1)
    assert cut.open().mises_layer.load().equals(whole.mises_layer)


def test_tables_and_figures(stored):
    _, results = stored
    rows = frames(results)["contacts"]
    assert len(rows) == 4 and rows["mises_layer 2 (Pa)"].tolist() == results.mises_layer.values[..., 1].ravel().tolist()
    figure = study.plot(results, "P", "mises_layer", **{"layers.1.material": "TiN"})
    assert [axes.get_title() for axes in figure.axes] == ["layer = 1", "layer = 2"]
    lines = [line.get_ydata() for axes in figure.axes for line in axes.lines if np.isfinite(line.get_ydata()).all()]
    largest = results.mises_layer.sel({"layers.1.material": "TiN"}).max() / 1e9
    assert np.isclose(max(y.max() for y in lines), float(largest), rtol=1e-12)
