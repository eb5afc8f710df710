"""`[output] stresses = true`: the largest stresses are stored with the cases."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from study.inputs.identity import case_keys
from study.inputs.reading import read
from study.work import cases

MODEL = {"h": "0.02", "n": "5.0", "bonding": '"frictionless"', "micro": '"smooth"', "nu2": "0.3"}
SCENE = {"R": '"5 mm"', "body": '"steel 316L"', "layer": '"DLC a-C:H"', "h": '"20 um"', "bonding": '"bonded"'}
SCENE |= {"micro": '"smooth"'}


def written(folder, model: dict, loads: str = "[1e-6, 1e-5]", stresses: str = "true"):
    path = folder / "hard.toml"
    lines = ["[model]", *(f"{name} = {value}" for name, value in model.items()), "[axes]", f"P = {loads}"]
    path.write_text("\n".join([*lines, "[output]", "profiles = false", f"stresses = {stresses}"]), encoding="utf-8")
    return path


def load(folder, *given, results="results", **options):
    return study.load(written(folder, *given, **options), folder / results)


def test_results_have_the_extremes(tmp_path):
    file = load(tmp_path, MODEL)
    file.run(workers=1)
    found, expected = file.open(), study.extremes(study.solve(P=[1e-6, 1e-5], h=0.02, n=5.0, nu2=0.3, micro="smooth"))
    assert len(expected.data_vars) == 30
    for name, array in expected.data_vars.items():
        assert np.array_equal(found[name].values, array.values, equal_nan=True), name
        assert found[name].attrs["long_name"] == array.attrs["long_name"]
    assert "mises1" not in load(tmp_path, MODEL, stresses="false").definition.stresses


def test_blocks_stream_through_a_study(tmp_path, monkeypatch):
    """No more cases than a block has are in memory with their stresses, which are those of one batch."""
    sizes, real = [], cases.stresses_of

    def stresses_of(problem, *others):
        sizes.append(len(problem))
        return real(problem, *others)

    monkeypatch.setattr(cases, "stresses_of", stresses_of)
    bare, loads = {"base": '"half_space"', "nu2": "0.3", "micro": '"smooth"'}, np.geomspace(1e-6, 1e-4, 10).tolist()
    path = written(tmp_path, bare, str(loads))
    path.write_text(path.read_text(encoding="utf-8") + "\n[numerics]\nblock = 4\n", encoding="utf-8")
    file = study.load(path, tmp_path / "results")
    file.run(workers=1)
    assert sizes == [4, 4, 2]
    batch = study.extremes(base="half_space", nu2=0.3, micro="smooth", P=loads)
    assert_allclose(file.open().mises2, batch.mises2, rtol=1e-9)


def test_more_loads_compute_no_case_again_and_have_stresses(tmp_path, monkeypatch):
    load(tmp_path, MODEL).run(workers=1)
    more = load(tmp_path, MODEL, "[1e-6, 1e-5, 1e-4]")
    assert more.run(workers=1).computed == 1
    assert np.isfinite(more.open().mises2.values).all()


def test_keys_are_those_of_before_unless_stresses_are_wanted(tmp_path):
    plain = read(written(tmp_path, MODEL, stresses="false"))
    other = read(written(tmp_path, MODEL | {"nu2": "0.4"}, stresses="false"))
    assert np.array_equal(case_keys(plain.grid), case_keys(other.grid)) and plain.digest == other.digest
    wanted = read(written(tmp_path, MODEL))
    other = read(written(tmp_path, MODEL | {"nu2": "0.4"}))
    assert not (case_keys(wanted.grid, True) == case_keys(plain.grid)).any() and wanted.digest != plain.digest
    assert not (case_keys(wanted.grid, True) == case_keys(other.grid, True)).any() and wanted.digest != other.digest


def test_units_and_strengths_of_materials(tmp_path):
    """A body that is named is known by its yield strength: the mask is set though the file gives none."""
    file = load(tmp_path, SCENE, '["1 mN", "100 N"]')
    file.run(workers=1)
    found = file.open()
    assert found.mises2.attrs["units"] == "Pa"
    limit = study.materials.get("steel 316L").yield_strength
    assert (found.mises2.values > limit).tolist() == [False, True] == (found.validity.values & 512 > 0).tolist()
    without = load(tmp_path, SCENE, '["1 mN", "100 N"]', stresses="false", results="without")
    without.run(workers=1)
    assert (without.open().validity.values & 512 > 0).tolist() == [False, True], "stored or not"


@pytest.mark.parametrize("value", ["1", '"yes"'])
def test_what_is_refused(tmp_path, value):
    with pytest.raises(study.StudyError, match=r"\[output\] stresses = .*: must be true or false"):
        load(tmp_path, MODEL, stresses=value)
