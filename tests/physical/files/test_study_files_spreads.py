"""Study files whose inputs have spreads, and random samples with units: the results are those of `study.solve`."""

import shutil
import tomllib

import numpy as np
import pytest

import study
from study.inputs.reading import from_tables
from study.store import writer

pytest.importorskip("pint")
BALL = {"R": "5.0 ± 0.1 mm", "punch": "steel 52100", "E2": "210 +- 10 GPa", "nu1": 0.3, "micro": "smooth"}
AXES = {"E1": ["1 ± 0.1 GPa", "4 GPa"], "h": ["100 ± 5 um", "200 um"], "P": ["1 N", "10 N"]}
TEXT = "".join(
    [f"[{section}]\n" + "".join(f"{name} = {given!r}\n" for name, given in table.items())
     for section, table in (("model", BALL), ("axes", AXES), ("output", {"x": 3}))]
)  # fmt: skip


def of(text: str, folder) -> study.Study:
    return study.Study(from_tables(tomllib.loads(text), "film", text, "film.toml"), folder)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("spreads")
    assert of(TEXT, folder).run(workers=1).computed == 8
    return folder


def same_as(found, alone):
    for name, array in alone.data_vars.items():
        if array.dtype.kind == "f" and name not in ("error", "model_error", "residual"):
            small = 1e-9 * float(abs(alone[name.removesuffix("_spread")]).max())  # a difference of numbers of this size
            np.testing.assert_allclose(found[name], array, rtol=1e-7, atol=small, err_msg=name)


def test_the_file_has_what_solve_gives(results):
    found, alone = of(TEXT, results).open(), study.solve(**BALL, **AXES, x=3)
    assert found.sizes == {"E1": 2, "h": 2, "P": 2, "x": 3} and found.a_spread.attrs["units"] == "m"
    assert set(alone.variables) <= set(found.variables) >= {"a_spread", "p_spread", "E1_spread"}
    same_as(found, alone)
    case = found.sel(E1="1 GPa", h="100 um", P="10 N")
    given, text = f"{1e6 * float(case.a_spread):.1f} µm", str(study.summary(case))
    assert "E1 = 1.00 ± 0.10 GPa" in text and f"± {given}" in text
    assert study.readable(found).h_spread.attrs["units"] == "µm"


def test_what_is_known_of_an_edited_study(results, tmp_path):
    """The blocks have the derivatives: another spread of the same inputs is computed from them."""
    shutil.copytree(results, tmp_path, dirs_exist_ok=True)
    assert of(TEXT, tmp_path).status()["state"] == "done" and of(TEXT, tmp_path).verify().good
    assert of(f"title = 'films'\n{TEXT}", tmp_path).run(workers=1).computed == 0
    edited = TEXT.replace("'10 N']", "'10 N', '20 N']")
    assert of(edited, tmp_path).status()["counts"] == {0: 8, 127: 4}
    assert of(edited, tmp_path).run(workers=1).computed == 4
    same_as(of(edited, tmp_path).open().sel(P=["1 N", "10 N"]), of(TEXT, results).open())
    with pytest.raises(study.StudyError, match="12 of its 12 cases are not in this one"):
        of(edited.replace("'200 um'", "'300 um'").replace("100 ± 5", "101 ± 5"), tmp_path).run(workers=1)
    wider = edited.replace("± 0.1 mm", "± 0.2 mm").replace("+- 10", "+- 20").replace("± 5", "± 10")
    assert of(wider, tmp_path).status()["state"] == "outdated"
    assert of(wider, tmp_path).run(workers=1).computed == 0
    # without derivatives by n: a part of those that the blocks have
    fewer = wider.replace(" +- 20", "").replace("1 ± 0.1 GPa", "1 GPa")
    assert of(fewer, tmp_path).run(workers=1).computed == 0
    given = BALL | {"R": "5.0 ± 0.2 mm", "E2": "210 GPa", "E1": ["1 GPa", "4 GPa"], "h": "100 ± 10 um", "P": "10 N"}
    same_as(of(fewer, tmp_path).open().sel(h="100 um", P="10 N"), study.solve(**given, x=3))
    plain = edited + "spreads = false\n"
    assert of(plain, tmp_path).run(workers=1).computed == 0 and "a_spread" not in of(plain, tmp_path).open()


def test_windows_hold_all_that_a_spread_is_made_of(results, tmp_path, monkeypatch):
    monkeypatch.setattr(writer, "CHUNK", 2)
    monkeypatch.setattr(writer, "AT_ONCE", 1)
    assert np.isnan(of(TEXT, tmp_path).open(partial=True).a_spread).all()
    of(TEXT.replace("[output]", "[numerics]\nblock = 10\n[output]"), tmp_path).run(workers=1)
    same_as(of(TEXT, tmp_path).open(), of(TEXT, results).open())


def test_half_the_digits_are_enough_for_derivatives(results, tmp_path):
    of(TEXT + "dtype = 'float32'\n", tmp_path).run(workers=1)
    found, whole = of(TEXT + "dtype = 'float32'\n", tmp_path).open(), of(TEXT, results).open()
    assert found.a_spread.dtype == found.p.dtype == "float32"
    for name in ("a_spread", "p0_spread", "dP_dD_spread"):
        np.testing.assert_allclose(found[name], whole[name], rtol=1e-5)  # some 1e-7 of each derivative


SAMPLE = """
[model]
R = "5 mm"
E2 = "210 ± 10 GPa"
[axes]
bonding = ["frictionless", "bonded"]
[sample]
size = 12
seed = 3
layer = ["PTFE", "PEEK"]
h = { start = "10 um", stop = "1 mm", spacing = "log" }
Ra = { start = "1 um", stop = "10 um", spacing = "log" }
Nbar = { start = 0.1, stop = 1, over = "Ra^2" }
P = ["1.0 ± 0.1 N", "10 N"]
[output]
profiles = false
"""


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_a_sample_with_units_and_spreads(tmp_path):
    made = of(SAMPLE, tmp_path)
    assert made.run(workers=1).complete
    found = made.open()
    assert found.a.sizes == {"case": 12, "bonding": 2} and set(found.layer.values.tolist()) == {"PTFE", "PEEK"}
    assert found.h.attrs["units"] == "m" and found.h.min() >= 1e-5 and found.h.max() <= 1e-3
    fraction = found.Nbar * found.Ra**2
    assert fraction.min() >= 0.1 - 1e-5 and fraction.max() <= 1 + 1e-5
    assert len(np.unique(found.h)) == 12 and set(found.P.values.tolist()) == {1.0, 10.0}
    case = found.isel(case=int(np.argmin(found.P.values)), bonding=1)
    one = {name: f"{float(case[name])!r} {unit}" for name, unit in (("h", "m"), ("Ra", "m"), ("Nbar", "1/m^2"))}
    given = {"R": "5 mm", "E2": "210 ± 10 GPa", "layer": str(case.layer.values), "P": "1.0 ± 0.1 N", **one}
    alone = study.solve(**given, bonding="bonded", x=2, profiles=False)
    same_as(case, alone)
    plain = of(SAMPLE.replace('"10 um"', '"0.01 mm"'), tmp_path).definition
    assert plain.digest == made.definition.digest


def test_all_that_the_results_say_is_in_the_digest(tmp_path):
    """Also where the solver's numbers are the same: SI values, names of materials, labels, spreads."""
    rows = '[[cases]]\nlabel = "one"\nP = "1 N"\n[[cases]]\nlabel = "two"\nP = "2 N"\n'
    text = '[model]\nR = "5 mm"\nE1 = "100 GPa"\nh = "2 um"\nE2 = "200 GPa"\nE_punch = "rigid"\nmicro = "smooth"\n'
    text += rows

    def digest(*changes: tuple[str, str]) -> str:
        changed = text
        for old, new in changes:
            assert changed.count(old) == 1
            changed = changed.replace(old, new)
        return of(changed, tmp_path).definition.digest

    same = [(), [('"2 um"', '"0.002 mm"')], [("[model]", 'title = "t"\n[model]')]]
    assert {digest(*changes) for changes in same} == {digest()}
    other = [
        [('E_punch = "rigid"', 'punch = "rigid"')],
        [('"5 mm"', '"10 mm"'), ('"2 um"', '"4 um"'), ('P = "1 N"', 'P = "4 N"'), ('P = "2 N"', 'P = "8 N"')],
        [('"100 GPa"', '"50 GPa"'), ('"200 GPa"', '"100 GPa"'), ('"1 N"', '"0.5 N"'), ('P = "2 N"', 'P = "1 N"')],
        [('"two"', '"both"')],
        [('"2 um"', '"2.0 ± 0.1 um"')],
        [('"2 um"', '"2.0 ± 0.2 um"')],
    ]
    assert len({digest(), *(digest(*changes) for changes in other)}) == 1 + len(other)
