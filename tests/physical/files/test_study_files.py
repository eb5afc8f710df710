"""Study files with units: results in SI, found by text, computed once, and one message for each slip."""

import shutil
import tomllib

import numpy as np
import pytest
import xarray as xr

import study
from study.__main__ import main
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables
from study.store import writer

pytest.importorskip("pint")
TEXT = """
title = "DLC"
[model]
R = "5 mm"
E1 = "200 GPa"
nu1 = 0.25
E_punch = "210 GPa"
nu_punch = 0.3
micro = "smooth"
[axes]
E2 = ["210 GPa", "rigid"]
h = ["2 um", "20 um"]
P = { start = "1 N", stop = "100 N", num = 3, spacing = "log" }
[output]
x = 3
"""


DRAWN = "[sample]\nsize = 1\nseed = 7\n"  # draws the first value of each list


def of(text: str, folder, name: str = "dlc") -> study.Study:
    return study.Study(from_tables(tomllib.loads(text), name, text, f"{name}.toml"), folder)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("units")
    assert of(TEXT, folder).run(workers=1).computed == 12
    return folder


def test_results_are_those_of_solve_in_si(folder):
    found = of(TEXT, folder).open()
    assert found.sizes == {"E2": 2, "h": 2, "P": 3, "x": 3} and found.a.attrs["units"] == "m"
    assert found.P.values.tolist() == [1.0, 10.0, 100.0] and found.R.attrs["units"] == "m"
    model = tomllib.loads(TEXT)["model"]
    for h in ("2 um", "20 um"):
        for E2 in ("210 GPa", "rigid"):
            case = found.sel(h=h, E2=E2, P="10 N")
            alone = study.solve(**model, h=h, E2=E2, P="10 N", x=3)
            for name in ("a", "D", "p0", "dP_dD", "p"):  # BLAS sums a batch in another order
                np.testing.assert_allclose(case[name], alone[name], rtol=1e-12, err_msg=name)
    with xr.open_dataset(folder / "dlc.nc") as plain:
        assert plain.h.attrs["units"] == "m" and plain.p.dims == ("E2", "h", "P", "x")
    assert "a rigid base" in study.summary(found.sel(h="2 um", E2="rigid", P="10 N"))


def test_whoever_edits_a_study_computes_what_is_new(folder, tmp_path):
    """The dimensionless numbers of a case, and its key, are the same in any grid: alone, on an axis, from a file."""
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    before = of(TEXT, tmp_path).open()
    edited = TEXT.replace('["2 um", "20 um"]', '["20 um", "3 um", "2 um"]').replace('["210 GPa", "rigid"]', '["rigid"]')
    with pytest.raises(study.StudyError, match="6 of its 12 cases are not in this one"):
        of(edited, tmp_path).run(workers=1)
    edited = TEXT.replace('["2 um", "20 um"]', '["20 um", "3 um", "2 um"]').replace('"5 mm"', '"0.005 m"')
    assert of(edited, tmp_path).status()["counts"] == {0: 12, 127: 6}
    assert of(edited, tmp_path).run(workers=1).computed == 6
    after = of(edited, tmp_path).open().sel(h=before.h)
    for name in before.data_vars:  # to the rounding of two changes of units
        np.testing.assert_allclose(after[name], before[name], rtol=1e-15, err_msg=name)
    dimensionless = TEXT.replace('R = "5 mm"', 'R = "6 mm"')
    with pytest.raises(study.StudyError, match="18 of its 18 cases are not in this one"):
        of(dimensionless, tmp_path).run(workers=1)


@pytest.mark.parametrize(
    ("name", "given", "written"),
    [
        ("R", '"5 mm"', '"0.005 m"'),
        ("E1", '"200 GPa"', '"2e5 MPa"'),
        ("nu1", "0.25", '"0.25"'),
        ("E_punch", '"210 GPa"', '"2.1e11 Pa"'),
        ("nu_punch", "0.3", "0.30"),
    ],
)
def test_where_an_input_stands_and_how_it_is_written_changes_no_key(tmp_path, name, given, written):
    keys = {tuple(key) for key in case_keys(of(TEXT, tmp_path).definition.grid).tolist()}
    line = f"{name} = {given}"
    for edited in (
        TEXT.replace(line, f"{name} = {written}"),
        TEXT.replace(f"{line}\n", "").replace("[axes]", f"[axes]\n{name} = [{written}]"),
        TEXT.replace(f"{line}\n", "").replace("[output]", f"[[cases]]\n{name} = {written}\n[output]"),
    ):
        assert (
            edited != TEXT and {tuple(key) for key in case_keys(of(edited, tmp_path).definition.grid).tolist()} == keys
        )


def test_the_same_contact_twice_as_large_is_another_study(tmp_path):
    """All its numbers are known, none of its results: the dimensionless contact is the same, the file is not."""
    small = TEXT.replace('{ start = "1 N", stop = "100 N", num = 3, spacing = "log" }', '["1 N", "10 N"]')
    large = small.replace('"5 mm"', '"10 mm"').replace('"2 um", "20 um"', '"4 um", "40 um"')
    large = large.replace('"1 N", "10 N"', '"4 N", "40 N"')
    assert of(small, tmp_path).run(workers=1).computed == 8
    before, status = of(small, tmp_path).open(), of(large, tmp_path).status()
    assert (status["state"], status["counts"]) == ("outdated", {0: 8})
    assert of(large, tmp_path).run(workers=1).computed == 0
    np.testing.assert_allclose(of(large, tmp_path).open().a, 2 * before.a.values, rtol=1e-15)


def test_what_is_damaged_is_written_again(folder, tmp_path):
    content = bytearray((folder / "dlc.nc").read_bytes())
    before = of(TEXT, folder).open()
    place = content.find(before.h.values.astype("<f8").tobytes())
    assert place > 0
    content[place] ^= 1  # of a coordinate
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    (tmp_path / "dlc.nc").write_bytes(content)
    assert of(TEXT, tmp_path).status()["state"] == "damaged"
    assert of(TEXT, tmp_path).run(workers=1).computed == 0
    np.testing.assert_allclose(of(TEXT, tmp_path).open().a, before.a, rtol=1e-15)


def test_cases_and_other_radii(tmp_path):
    rows = '[[cases]]\nlabel = "ball"\nR2 = "10 mm"\n[[cases]]\nlabel = "cup"\nR2 = "-20 mm"\n'
    text = TEXT.replace('R = "5 mm"', 'R1 = "10 mm"') + rows
    made = of(text, tmp_path, "cups")
    assert made.run(workers=1).computed == 24
    found = made.open()
    assert list(found.sizes) == ["case", "E2", "h", "P", "x"] and found.label.values.tolist() == ["ball", "cup"]
    np.testing.assert_allclose(found.R, [5e-3, 20e-3], rtol=1e-14)
    alone = study.solve(**tomllib.loads(TEXT)["model"], E2="210 GPa", h="2 um", P="10 N", x=3)
    np.testing.assert_allclose(found.sel(E2="210 GPa", h="2 um", P="10 N").a[0], alone.a, rtol=1e-13)
    grown = text.replace('"20 um"]', '"20 um", "30 um"]')
    assert of(grown, tmp_path, "cups").run(workers=1).computed == 12


def test_float32_and_partial_results(tmp_path, monkeypatch):
    """Written window by window, each in the units of its own cases."""
    monkeypatch.setattr(writer, "CHUNK", 4)
    monkeypatch.setattr(writer, "AT_ONCE", 1)
    text = TEXT + 'dtype = "float32"\nprofiles = false\n'
    text = text.replace('R = "5 mm"', "").replace("[axes]", '[axes]\nR = ["5 mm", "6 mm"]')
    partial = of(text, tmp_path).open(partial=True)
    assert np.isnan(partial.a).all() and partial.h.values.tolist() == [2e-6, 2e-5]
    of(text, tmp_path).run(workers=1)
    found = of(text, tmp_path).open()
    assert found.a.dtype == np.float32
    given = {name: value for name, value in tomllib.loads(TEXT)["model"].items() if name != "R"} | {"h": "2 um"}
    for R in ("5 mm", "6 mm"):
        alone = study.solve(**given, R=R, E2="210 GPa", P="10 N", x=2)
        np.testing.assert_allclose(found.a.sel(R=R, h="2 um", E2="210 GPa", P="10 N"), alone.a, rtol=1e-6)


def test_check_says_what_is_assumed(tmp_path, capsys):
    path = tmp_path / "mine.toml"
    bare = TEXT.replace('E_punch = "210 GPa"\nnu_punch = 0.3\n', "")
    for text, words, more in (
        (TEXT, "", ""),
        (TEXT.replace("nu1 = 0.25\n", ""), "nu1 = 0.3, ", ""),
        (bare, "", ", a rigid punch"),
    ):
        path.write_text(text, encoding="utf-8")
        assert main(["check", str(path)]) == 0
        said = f"    assumed, as not given: {words}nu2 = 0.3, bonding = frictionless{more}"
        assert capsys.readouterr().out.splitlines()[1:] == [said]


def test_slips_of_a_prefix_and_wide_spreads_are_doubted(tmp_path, capsys):
    """By `check` and by `run`, as by `study.solve`."""
    path = tmp_path / "mine.toml"
    text = TEXT.replace('"200 GPa"', '"200 TPa"').replace('"2 um", ', '"2 ± 3 um", ')
    text = text.replace("nu1 = 0.25", 'nu1 = "0.45 ± 0.06"')
    path.write_text(text, encoding="utf-8")
    assert main(["check", str(path)]) == 0
    doubts = [
        "mine: beware: E1 = 2e+05 GPa: materials have 1 Pa to 2 TPa; is its unit right?",
        "mine: beware: h = 2.0 ± 3.0 µm: this spread is too wide for the ± of the results, which is of first order.",
        "mine: beware: nu1 = 0.450 ± 0.060: this spread is too wide for the ± of the results, which is of first order.",
    ]
    assert capsys.readouterr().out.splitlines()[2:] == doubts
    assert main(["run", str(path), "--dry-run"]) == 0
    assert capsys.readouterr().err.splitlines() == doubts


def test_a_run_says_what_the_model_does_not_describe(tmp_path, monkeypatch, capsys):
    """As `study.solve` does; it was seen in figures alone. What was said of the inputs is not said again."""
    monkeypatch.chdir(tmp_path)
    text = TEXT.replace('stop = "100 N"', 'stop = "1 MN"').replace('"200 GPa"', '"200 TPa"')
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    assert main(["run", "mine.toml"]) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if "beware" in line]
    starts = ["E1 = 2e+05 GPa: materials", "4 of 12 cases: The strain is", "6 of 12 cases: The pressure"]
    assert [
        line.removeprefix("mine: beware: ")[: len(start)] for line, start in zip(lines, starts, strict=True)
    ] == starts
    assert main(["run", "mine.toml"]) == 0
    assert len([line for line in capsys.readouterr().err.splitlines() if "beware" in line]) == 1


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"20 um"]', "0.004]", r'h\[1\] = 0.004 has no unit: must be a length, such as "2 mm" \(R = "5 mm" makes this'),
        ('start = "1 N"', "start = 1", "P: start = 1 has no unit: must be a force"),
        ('stop = "100 N"', 'stop = "100 MPa"', 'P: stop = "100 MPa" is a pressure'),
        ('start = "1 N", ', "", "P: start is missing: must be a finite number"),
        ('start = "1 N"', 'start = "-1 mN"', 'P: start = "-1 mN": must be > 0 for spacing log'),
        ('start = "1 N"', 'start = "1 ± 0.1 N"', 'P: start = "1 ± 0.1 N": a range has no spread, a list of values may'),
        ("x = 3", "x = 3\nspreads = 1", r"\[output\] spreads = 1: must be true or false"),
        ('"5 mm"', '["5 mm"]', r"\[model\] R has several values: these belong in \[axes\]"),
        ("[axes]", '[axes]\nR = ["5 mm"]', r"R is given twice: in \[model\] and in \[axes\]"),
        ("[axes]", "rtol = 1e-6\n[axes]", r"\[model\] rtol belongs in \[numerics\]"),
        ("[axes]", 'hh = "1 um"\n[axes]', '"hh" is not a parameter; did you mean "h"'),
        ("[output]", "[sample]\nnu2 = [0.1, 0.2]\n[output]", r"\[sample\] size is missing: must be a whole number"),
        ("[output]", f"{DRAWN}nu1 = [0.1]\n[output]", r"nu1 is given twice: in \[model\] and in \[sample\]"),
        ("[output]", f"{DRAWN}Ra = {{start = 1, stop = 2}}\n[output]", r"\[sample\] Ra: start = 1 has no unit"),
        ("[output]", f'{DRAWN}Nbar = {{start = "1 m", stop = 2, over = "h"}}\n[output]', "Nbar: start .* is a length"),
        ("[output]", f"{DRAWN}nu2 = {{start = 0, stop = 2}}\n[output]", r"nu2: stop = 2.*: must be in \(-1, 0.5\]"),
        ("[output]", f"{DRAWN}body = {{start = 0, stop = 2}}\n[output]", r"body = .*: must be a list to choose from"),
        ("[output]", f"{DRAWN}Ra = ['2 um', 2]\n[output]", r"Ra\[1\] = 2 has no unit: must be a length"),
        ("[output]", f"{DRAWN}Ra = ['2 um', '2 GPa']\n[output]", r'Ra\[1\] = "2 GPa" is a pressure'),
        (
            "[output]",
            f"{DRAWN}layer = ['PTFE', 'PTFF']\n[output]",
            'layer: "PTFF" is not a material; did you mean "PTFE"',
        ),
        ("[output]", f"{DRAWN}base = ['layered', 'none']\n[output]", r'base\[1\] = "none": must be one of'),
        ("[output]", f"{DRAWN}nu2 = [0.3, '0.3 m']\n[output]", r'nu2\[1\] = "0.3 m" is a length: must be a number'),
        ("[output]", f"{DRAWN}nu9 = [0.1]\n[output]", r'\[sample\] "nu9" is not a parameter'),
        ("[output]", f"{DRAWN}nu2 = [0.1]\n[[cases]]\n[output]", "both make the dimension case"),
        ('"2 um"', '"2e-9 um"', r"h\[0\] = 2e-9 um: must be in \[5e-09, 5e\+09\] um, which is"),
        ('"20 um"]', '"2000 nm"]', r"h\[0\] and h\[1\] are both 2e-06 m: values of an axis must differ"),
        ('"5 mm"', f"0x{'f' * 4000}", "R = a number of more than 4300 digits has no unit"),
        ('"5 mm"', '"5 m\\u001b[31mm"', r'R = "5 m\\x1b\[31mm": write one number'),
        ("[output]", "[cases]\nh = 1\n[output]", r"cases must be \[\[cases\]\] tables"),
        ("nu1 = 0.25", f"nu1 = 0x{'f' * 4000}", "nu1 = .* must be finite"),
        ("[axes]", "[axes]\nk = 1", "k = 1: must be a list or {start, stop, num, spacing}"),
    ],
)
def test_slips_are_named_with_file_key_and_value(tmp_path, capsys, old, new, message):
    assert old in TEXT
    path = tmp_path / "slip.toml"
    path.write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(study.StudyError, match=message) as caught:
        study.load(path)
    assert caught.value.messages[0].startswith(f"{path.as_posix()}: ")
    assert main(["check", str(path)]) == 2
