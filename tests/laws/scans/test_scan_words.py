"""micro = "scan:FILE": the law of a scan is computed before the contacts, on their own bodies and over their range."""

import json
import warnings

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import study
from solver.laws import own_table
from study import StudyError, roughness
from study.__main__ import main
from study.scan_laws import law as scan_law
from study.scan_laws import words

pytestmark = pytest.mark.filterwarnings("ignore:this contact is beyond what the model")
SURFACE = roughness.self_affine((48, 48), "0.25 um", hurst=0.8, rms="20 nm", shortest="1.5 um", seed=1)
WORD = "scan:wafer.sdf"
BALL = {"R": "5 mm", "E2": "5 GPa", "P": "0.1 N"}
COATED = {"h": "2 um", "n": 5, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded"}
STACK = [{"h": "1 um", "E1": "50 GPa", "nu": 0.2, "bonding": "bonded"}, {"h": "3 um", "E1": "2 GPa", "nu": 0.4}]
STUDY = """
title = "a scan under a ball"
[model]
R = "5 mm"
E2 = "5 GPa"
base = "half_space"
micro = "scan:wafer.sdf"
[axes]
P = ["50 mN", "100 mN"]
"""


def write_sdf(z, path="wafer.sdf", dx=0.25e-6):
    """The heights (n, n) in m as an SDF file, whose heading has all lengths."""
    pairs = {"ManufacID": "test", "NumPoints": z.shape[1], "NumProfiles": z.shape[0], "Xscale": dx, "Yscale": dx}
    pairs |= {"Zscale": 1e-12, "Zresolution": -1, "Compression": 0, "DataType": 7, "CheckType": 0}
    heading = "\n".join(f"{key} = {value}" for key, value in pairs.items())
    rows = "\n".join(" ".join(f"{number:.3f}" for number in row) for row in z * 1e12)
    with open(path, "w") as file:
        file.write(f"aISO-1.0\n{heading}\n*\n{rows}\n*\n")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_sdf(SURFACE.z)


def rows_in(contact, word=WORD):
    """p, A, λ and p_max of the table that results carry."""
    text = json.loads(contact.attrs["scan_laws"])[word]
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return np.array([line.split(",") for line in lines[1:]], dtype=float).T


def test_it_is_the_law_of_the_scan_up_to_the_pressure_of_the_contacts():
    contact = study.solve(**BALL, base="half_space", micro=WORD)
    p, A, lam, p_max, _ = rows_in(contact)
    alone = roughness.law(roughness.read("wafer.sdf"), pressures=p, progress=False)
    assert_allclose([A, lam, p_max], [alone.A, alone.lam, alone.p_max], rtol=1e-6)
    unit = 5e9 / (1 - 0.3**2)
    assert contact.status == 0 and p[0] < contact.p0 / unit < p[-1] < 4 * contact.p0 / unit
    assert_allclose(contact.lam.sel(x=0), np.interp(contact.p0 / unit, p, lam), rtol=0.15)
    assert WORD in study.summary(contact) and contact.model_error >= 0.01


def test_hard_pressed_contacts_have_a_law_to_nearly_full_contact():
    contact = study.solve(**BALL | {"P": "300 N"}, base="half_space", micro=WORD)
    lam = rows_in(contact)[2]
    assert 0.95 <= lam[-1] <= 1 and contact.status.item() in (0, 10)


def test_each_body_has_a_law_of_its_own_whatever_its_company():
    """Two thicknesses and two loads; alone each has the same numbers."""
    several = study.solve(**BALL | COATED | {"P": ["50 mN", "100 mN"], "h": ["1 um", "2 um"]}, micro=WORD)
    assert several.micro.dims == ("h",) and (several.status == 0).all()
    assert several.micro.values.tolist() == [f"{WORD} (h = 1 um)", f"{WORD} (h = 2 um)"]
    alone = study.solve(**BALL | COATED | {"P": ["50 mN", "100 mN"]}, micro=WORD)
    assert alone.micro.item() == WORD
    for name in ("a", "D", "p_max", "Ar_An"):
        assert_allclose(several[name].sel(h=2e-6), alone[name], rtol=1e-12)
    assert abs(several.D[0, 0] / several.D[0, 1] - 1) > 0.01


@pytest.mark.parametrize(
    ("body", "on"),
    [
        (COATED, COATED | {"E2": "5 GPa"}),
        (COATED | {"base": "auto"}, COATED | {"E2": "5 GPa"}),
        (COATED | {"E_punch": "20 GPa"}, COATED | {"E2": "5 GPa", "E_punch": "20 GPa"}),
        ({"base": "stack", "layers": STACK, "nu2": 0.3}, {"layers": STACK, "nu2": 0.3, "E2": "5 GPa"}),
        ({"h": "5 um", "E1": "20 GPa", "nu1": 0.4, "E2": "rigid", "bonding": "bonded"},) * 2,
    ],
    ids=["layer", "auto", "elastic punch", "stack", "rigid base"],
)
def test_the_law_is_that_of_the_contacts_own_body(body, on):
    """As by rc.roughness.law(on=...), whose law the same contact takes; its table stands over the modulus felt."""
    contact = study.solve(**BALL | body, micro=WORD)
    of_scan = roughness.law(roughness.read("wafer.sdf"), on=on, progress=False)
    p, A, *_ = rows_in(contact)
    assert_allclose(np.interp(np.log(of_scan.p[3:8] * (1 + of_scan.m)), np.log(p), A), of_scan.A[3:8], rtol=0.02)
    by_hand = study.solve(**BALL | body, micro=of_scan)
    assert contact.status == by_hand.status == 0
    assert_allclose(contact.D, by_hand.D, rtol=0.02)
    bare = rows_in(study.solve(**BALL, base="half_space", micro=WORD))
    assert abs(np.interp(np.log(bare[0][9]), np.log(p), A) / bare[1][9] - 1) > 0.01


def test_results_carry_the_table_and_are_solved_again_without_the_scan(tmp_path):
    contact = study.solve(**BALL | COATED | {"h": ["1 um", "2 um"]}, micro=WORD)
    contact.to_netcdf("found.nc")
    (tmp_path / "wafer.sdf").unlink()
    with xr.open_dataset("found.nc") as read:
        for results in (contact, read):
            assert_allclose(study.extremes(results).sz_interface_min, study.extremes(contact).sz_interface_min)
        slopes = [study.sensitivities(results).D_sensitivity for results in (contact, read)]
        assert_allclose(*slopes)


def test_a_study_is_checked_without_the_law_and_run_with_it(tmp_path, monkeypatch, capsys):
    (tmp_path / "ball.toml").write_text(STUDY)
    computed = []
    monkeypatch.setattr(scan_law, "law_up_to", lambda *a, real=scan_law.law_up_to: computed.append(a) or real(*a))
    monkeypatch.setattr(words, "_TABLES", type(words._TABLES)(1_000_000))
    for command in ("check", "status", "list"):
        assert main([command, *["ball.toml"] * (command != "list")]) == 0
    assert not computed
    assert main(["run", "ball.toml"]) == 0 and len(computed) == 1
    assert main(["run", "ball.toml"]) == 0 and len(computed) == 1
    results = study.load("ball.toml").open()
    assert (results.status == 0).all() and rows_in(results).shape[1] >= 8
    assert_allclose(study.solve(**BALL, base="half_space", micro=WORD).D, results.D.sel(P=0.1), rtol=1e-9)
    assert study.extremes(results).mises2.notnull().all()
    before = study.load("ball.toml").definition.digest
    write_sdf(1.01 * SURFACE.z)
    assert study.load("ball.toml").definition.digest != before
    assert study.load("ball.toml").status()["state"] == "outdated"
    capsys.readouterr()


def test_an_unfinished_study_is_solved_again(tmp_path, monkeypatch):
    """Its law had no rows, and the scan may be gone; another run takes the law from the blocks."""
    (tmp_path / "ball.toml").write_text(STUDY + "[numerics]\nblock = 1\n")
    ball = study.load("ball.toml")
    ball.run(part=(1, 2), workers=1)
    (tmp_path / "wafer.sdf").rename("moved.sdf")
    monkeypatch.setattr(words, "_TABLES", type(words._TABLES)(1_000_000))
    unfinished = ball.open(partial=True)
    assert unfinished.status.values.tolist() == [0, 127] and rows_in(unfinished).shape[1] >= 8
    alone = study.extremes(unfinished.sel(P=0.05))
    monkeypatch.setattr(scan_law, "law_up_to", None)  # it is not computed again
    assert ball.run(workers=1).computed == 1
    assert_allclose(study.extremes(ball.open()).mises2.sel(P=0.05), alone.mises2, rtol=1e-12)


def test_files_are_looked_for_beside_the_study(tmp_path, monkeypatch):
    """They were looked for in the working folder alone. What is not there is looked for in the working folder."""
    folder, here = tmp_path / "mine", tmp_path / "here"
    folder.mkdir()
    here.mkdir()
    (tmp_path / "wafer.sdf").rename(folder / "wafer.sdf")
    law = roughness.law(roughness.read(folder / "wafer.sdf"), pressures=np.geomspace(1e-4, 1e-2, 6), progress=False)
    law.to_csv(folder / "law.csv")
    r = np.linspace(0, 1e-4, 30)
    np.savetxt(
        folder / "tip.csv", np.c_[r * 1e6, r**2 / 1e-2 * 1e6], delimiter=",", header="r [um], f [um]", comments=""
    )
    (folder / "profile.csv").write_text("0,4\n1,2\n")
    (folder / "ball.toml").write_text(STUDY)
    (folder / "table.toml").write_text(STUDY.replace("scan:wafer.sdf", "table:law.csv"))
    (folder / "tip.toml").write_text(
        STUDY.replace('R = "5 mm"', 'shape = "table:tip.csv"').replace("scan:wafer.sdf", "smooth")
    )
    layers = '[[layers]]\nh = "1 um"\nprofile = "table:profile.csv"\nbonding = "bonded"\nnu = 0.3\n'
    (folder / "graded.toml").write_text(
        STUDY.replace('base = "half_space"\n', "").replace("scan:wafer.sdf", "smooth") + layers
    )
    monkeypatch.chdir(here)
    for name in ("ball", "table", "tip", "graded"):
        assert study.load(f"../mine/{name}.toml").definition.grid.size == 2
    loaded = study.load("../mine/ball.toml")
    monkeypatch.chdir(tmp_path)
    loaded.run()
    assert loaded.open().micro.item() == WORD
    with pytest.raises(StudyError, match="micro: wafer.sdf: cannot be read"):  # no study: the working folder alone
        study.solve(**BALL, base="half_space", micro=WORD)
    (folder / "wafer.sdf").rename("wafer.sdf")
    assert study.load("mine/ball.toml").definition.digest == loaded.definition.digest


def test_the_sample(tmp_path):
    contact = study.solve(**BALL, base="half_space", micro="scan:sample")
    law = roughness.law(
        roughness.read(study.samples.scan()), pressures=rows_in(contact, "scan:sample")[0][:5], progress=False
    )
    assert_allclose(rows_in(contact, "scan:sample")[1][:5], law.A, rtol=1e-6)
    assert contact.status == 0 and contact.micro == "scan:sample"
    (tmp_path / "wafer.sdf").rename("sample")
    assert refused(micro="scan:./no") == "solve: micro: ./no: cannot be read: No such file or directory"
    other = study.solve(**BALL, base="half_space", micro="scan:./sample")
    assert abs(other.D / contact.D - 1) > 0.01


def test_a_point(capsys):
    assert main(["point", "R=5 mm", "E2=5 GPa", "P=0.1 N", "base=half_space", f"micro={WORD}"]) == 0
    assert WORD in capsys.readouterr().out


def test_a_law_without_rows_gives_no_numbers():
    law = own_table.awaiting_rows(WORD, "1")
    with pytest.raises(RuntimeError, match="have not been computed"):
        law.bind(np.ones(1), law_unit=np.ones(1))


def refused(**changed):
    """The message of a contact that is refused."""
    with pytest.raises(StudyError) as error:
        study.solve(**BALL | {"base": "half_space"} | changed)
    return str(error.value)


def test_what_is_refused_says_why():
    """Before anything is computed, and all of it in one line each."""
    assert refused(micro="scan:none.sdf") == "solve: micro: none.sdf: cannot be read: No such file or directory"
    assert refused(micro="scan:") == 'solve: micro: names no file: "scan:wafer.sdf"'
    np.save("map.npy", SURFACE.z)
    lacking = refused(micro="scan:map.npy")
    assert "map.npy: give unit" in lacking and "Also give dx" in lacking and "--law law.csv" in lacking
    np.savetxt("line.csv", np.c_[np.arange(48), SURFACE.z[0] * 1e9])
    assert "give unit" in refused(micro="scan:line.csv")
    write_sdf(SURFACE.z[:1].repeat(2, 1), "profile.sdf")
    assert refused(micro="scan:profile.sdf").endswith("is a profile: the law of a scan needs a map of heights")
    assert "a layer of springs has no kernel" in refused(**COATED, base="thin_layer", micro=WORD)
    assert "several bodies need a law each, and micro is an axis" in refused(
        **COATED | {"h": ["1 um", "2 um"], "base": "layered"}, micro=[WORD, "smooth"]
    )
    thicknesses = [f"{h} um" for h in range(1, 33)]
    assert "32 bodies, of which each needs a law, at most 30" in refused(
        **COATED | {"h": thicknesses}, base="layered", micro=WORD
    )
    with pytest.raises(StudyError, match="A is a length: give the other inputs with units too"):
        study.solve(P=1e-5, base="half_space", micro=WORD)
    with warnings.catch_warnings(), pytest.raises(StudyError, match="design: micro = .* compute the law first"):
        warnings.simplefilter("ignore")
        study.design(
            {"p_max": "50 MPa"}, by={"P": ("1 mN", "1 N")}, R="5 mm", E2="5 GPa", base="half_space", micro=WORD
        )


def test_a_scan_that_changes_meanwhile_is_refused(monkeypatch):
    from study.inputs.definition import from_call

    definition = from_call(BALL | {"base": "half_space", "micro": WORD}, [], False, {})
    write_sdf(1.5 * SURFACE.z)
    monkeypatch.setattr(words, "_TABLES", type(words._TABLES)(1_000_000))
    with pytest.raises(StudyError, match="has changed since the study was read"):
        words.with_rows(definition)
