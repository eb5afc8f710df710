"""A large study that is edited takes from its parts the cases that it still has. Large is 40 cases here."""

import tomllib

import pytest
from same import assert_same_numbers

import study
from study.inputs.reading import from_tables
from study.store import former_parts, windows

PLAIN = """
[model]
n = 0.5
Ra = 0.004
base = "thin_layer"
Nbar = 250000
[axes]
P = [1e-5, 3e-5, 2e-5]
h = [0.01, 0.02, 0.03, 0.05, 0.07]
bonding = ["frictionless", "bonded"]
m = [0.0, 0.5]
[output]
x = 4
"""
UNITS = """
[model]
R = "5 mm"
E1 = "2 GPa"
E2 = "200 GPa"
micro = "smooth"
bonding = "bonded"
[axes]
h = ["30 um", "10 um", "20 um"]
P = {start = "1 mN", stop = "1 N", num = 20, spacing = "log"}
[output]
dtype = "float32"
x = 3
"""


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Parts of twenty cases and fewer."""
    monkeypatch.setattr(windows, "CASES", 40)
    monkeypatch.setattr(windows, "usual_block", lambda grid: 20)
    monkeypatch.setattr(windows, "BLOCKS", 1)


def written(folder, text: str, *edits: tuple[str, str]) -> study.Study:
    for before, after in edits:
        assert before in text
        text = text.replace(before, after)
    return study.Study(from_tables(tomllib.loads(text), "big", text, "big.toml"), folder)


LONGER = ("P = [1e-5, 3e-5, 2e-5]", "P = [4e-5, 1e-5, 3e-5]")
TURNED = ("h = [0.01, 0.02, 0.03, 0.05, 0.07]", "h = [0.07, 0.04, 0.05, 0.03, 0.02]")


@pytest.mark.parametrize(
    ("text", "edits", "computed"),
    [
        (PLAIN, [LONGER], 20),
        (PLAIN, [LONGER, TURNED], 60 - 2 * 4 * 4),
        (PLAIN, [("m = [0.0, 0.5]", ""), ("n = 0.5", "n = 0.5\nm = 0.5"), ("0.07]", "0.07, 0.09, 0.1]")], 12),
        (PLAIN, [("n = 0.5", "n = 0.6")], 60),
        (PLAIN, [("x = 4", "x = 5")], 60),
        (UNITS, [("30 um", "40 um")], 20),
        (UNITS, [("2 GPa", "3 GPa")], 60),
    ],
    ids=["an axis", "two axes", "an axis less", "another body", "other radii", "units", "another modulus"],
)
def test_an_edited_study_takes_what_still_fits(tmp_path, text, edits, computed):
    assert written(tmp_path / "big", text).run().computed == 60
    edited = written(tmp_path / "big", text, *edits)
    with pytest.raises(study.StudyError, match="--force removes them"):
        edited.run()
    report = edited.run(force=True)
    assert report.complete and report.computed == computed
    assert edited.verify().kind == "sound" and edited.run().computed == 0
    assert not [*tmp_path.rglob("*.block")]
    anew = written(tmp_path / "anew", text, *edits)
    assert anew.run().computed == edited.status()["cases"]
    of_float32 = "float32" in text
    if of_float32:  # to the last bit of what the units are multiplied with
        found, expected = (opened.open().drop_vars(["error", "profile_error", "residual"]) for opened in (edited, anew))
        for name in expected.data_vars:
            assert abs(found[name] - expected[name]).max() <= 3e-7 * abs(expected[name]).max(), name
    else:
        assert_same_numbers(edited.open(), anew.open())


def test_a_study_that_is_larger_needs_no_force(tmp_path):
    """No case of the former parts is lost. Of the study as it was before, some are."""
    written(tmp_path, PLAIN).run()
    larger = written(tmp_path, PLAIN, ("2e-5]", "2e-5, 4e-5]"), TURNED, ("0.07,", "0.07, 0.01,"))
    assert larger.dry_run().refused is None
    report = larger.run()
    assert report.complete and report.computed == 4 * 6 * 4 - 60 and larger.verify().kind == "sound"
    assert written(tmp_path, PLAIN).dry_run().refused


def test_a_study_with_spreads_is_computed(tmp_path):
    """Its results do not contain the derivatives that its blocks have."""
    text = UNITS.replace("2 GPa", "2 ± 0.1 GPa")
    written(tmp_path, text).run()
    edited = written(tmp_path, text, ("30 um", '30 um", "40 um'))
    with pytest.raises(study.StudyError, match="--force removes them"):
        edited.run()
    assert edited.run(force=True).computed == 80


def test_a_damaged_part_is_not_taken(tmp_path):
    written(tmp_path, PLAIN).run()
    path = sorted((tmp_path / "big").glob("*.nc"))[0]
    data = path.read_bytes()
    path.write_bytes(data[:5000] + bytes([data[5000] ^ 1]) + data[5001:])
    edited = written(tmp_path, PLAIN, LONGER)
    assert edited.run(force=True).computed > 20 and edited.verify().kind == "sound"


def test_nothing_is_removed_before_what_is_taken_is_on_the_disk(tmp_path, monkeypatch):
    written(tmp_path, PLAIN).run()
    there = sorted(path.name for path in (tmp_path / "big").iterdir())
    monkeypatch.setattr(former_parts, "put", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        written(tmp_path, PLAIN, LONGER).run(force=True)
    assert sorted(path.name for path in (tmp_path / "big").iterdir()) == there
