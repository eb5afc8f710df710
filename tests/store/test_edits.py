"""What an edit of a study file computes anew, of a finished study and of one that stopped half-way."""

import json
import re

import pytest
import xarray as xr
from line_study import store_block
from same import assert_same

import study
from study.store.edits import differences


@pytest.fixture
def load(tmp_path):
    """A study of two contacts, always the same file and folder."""

    def written(numerics: str = "", model: str = "", label: str = "light", title: str = "") -> study.Study:
        text = f"title = {json.dumps(title)}\n"
        text += f'[model]\nh = 0.5\nn = 0.5\nmicro = "smooth"\n{model}\n[numerics]\n{numerics}\n[output]\nx = 3\n'
        text += f'[[cases]]\nP = 1e-7\nlabel = "{label}"\n[[cases]]\nP = 1e-3\nlabel = "heavy"\n'
        (tmp_path / "two.toml").write_text(text, encoding="utf-8")
        return study.load(tmp_path / "two.toml", tmp_path / "results")

    return written


def fresh(opened: study.Study, folder) -> xr.Dataset:
    there = study.Study(opened.definition, folder)
    there.run()
    return there.open()


AUTO = 'base = "auto"'
EDITS = {
    "rtol": ({"numerics": "rtol = 1e-2"}, {"numerics": "rtol = 1e-10"}, "nodes_used"),
    "accuracy": (
        {"model": AUTO, "numerics": "accuracy = 1e-6"},
        {"model": AUTO, "numerics": "accuracy = 0.5"},
        "model_used",
    ),
}


@pytest.mark.parametrize(("before", "after", "seen"), EDITS.values(), ids=EDITS)
@pytest.mark.parametrize("finished", [True, False])
def test_an_edit_of_the_numerics_computes_again(load, tmp_path, before, after, seen, finished):
    """Of a finished study, and of one that stopped half-way and goes on after the edit."""
    if finished:
        load(**before).run()
        old = load(**before).open()
    else:
        old = load(**before)
        store_block(old, 0, 1)
        old = old.open(partial=True)
    edited = load(**after)
    assert edited.dry_run().present == 0
    if finished:
        with pytest.raises(study.StudyError, match="2 of its 2 cases are not in this one: --force"):
            edited.run()
    assert edited.run(force=finished).computed == 2
    found = edited.open()
    assert_same(found, fresh(edited, tmp_path / "fresh"))
    assert found[seen].values[0] != old[seen].values[0]


def test_an_edit_of_a_label_is_in_the_results_and_computes_nothing(load):
    load().run()
    edited = load(label="small")
    assert edited.run().computed == 0
    assert edited.open().label.values.tolist() == ["small", "heavy"]


def test_an_edit_of_what_no_case_uses_is_of_no_account(load):
    """Of a finished study, and of one that stopped half-way."""
    load(model="nu1 = 0.2").run()
    assert load(model="nu1 = 0.4").status()["state"] == "done"
    half_way = load(model="nu1 = 0.2\nB = 0.1", numerics="rtol = 1e-7")
    store_block(half_way, 0, 1)
    assert load(model="B = 0.3", numerics="rtol = 1e-7").run(force=True).computed == 1


def test_an_edit_of_the_title_is_in_the_results_and_computes_nothing(load):
    load().run()
    for title in ("two", 'of one\n "line"', ""):
        edited = load(title=title)
        assert edited.run().computed == 0
        assert edited.open().title == (title or "two")
    assert not load().run().counts  # nothing to do


def test_results_of_another_definition_name_the_input_that_differs(load):
    load(numerics="rtol = 1e-4").run()
    edited = load(numerics="rtol = 1e-6", title="another")
    said = "; numerics.rtol: 0.0001 there, 1e-06 here)"
    for act in (edited.run, edited.open, lambda: edited.verify().raise_if_bad()):
        with pytest.raises(study.StudyError, match=re.escape(said)):
            act()


MODEL = "title = 'a'\n[model]\nRa = 0.004\nh = '5 um'\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (MODEL.replace("'a'", "'b'") + "# comment", []),
        (MODEL.replace("0.004", "0.002"), ["Ra: 0.004 there, 0.002 here"]),
        (MODEL.replace("Ra = 0.004\n", ""), ["Ra: 0.004 there, none here"]),
        ("[model]\nh = '5 um'\n[axes]\nRa = [0.004, 0.1]\n", ["Ra: 0.004 there, [0.004, 0.1] here"]),
        (MODEL + "[axes]\nn = {start = 1, stop = 2}\n", ["n.start: none there, 1 here", "n.stop: none there, 2 here"]),
        (
            MODEL + "[[cases]]\nP = 1\n[[cases]]\nP = 2\n",
            ["cases[0].P: none there, 1 here", "cases[1].P: none there, 2 here"],
        ),
        (MODEL + "[numerics]\nblock = 3\n", []),
        (MODEL + "[output]\nx = 5\n", ["output.x: none there, 5 here"]),
        (
            "[model]\nRa = 1\nh = 2\nn = 3\nm = 4\n",
            ["Ra: 0.004 there, 1 here", 'h: "5 um" there, 2 here', "n: none there, 3 here", "and 1 more"],
        ),
        ("no TOML", []),
    ],
    ids=["same", "changed", "gone", "an axis", "a range", "cases", "block", "output", "many", "no study"],
)
def test_differences_of_study_files(text, said):
    assert differences(MODEL, text) == said
