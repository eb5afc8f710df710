"""Mistakes in study files with units: all are named at once, each by one message."""

import pytest
from test_study_files import DRAWN, TEXT, of

import study
from study.inputs.reading import from_tables

pytest.importorskip("pint")


@pytest.mark.parametrize("section", ["model", "axes", "sample", "cases"])
def test_one_unit_anywhere_makes_it_a_study_with_units(section):
    """What else it needs is then asked for in the words of units."""
    given = {"model": {"micro": "smooth", "base": "half_space"}, "axes": {}, "sample": {}, "cases": []}
    load = {"model": {"P": "1 N"}, "axes": {"P": ["1 N", "2 N"]}, "cases": [{"P": "1 N"}, {"P": "2 N"}]}
    load["sample"] = {"size": 3, "seed": 1, "P": {"start": "1 N", "stop": "2 N"}}
    given[section] = given[section] + load[section] if section == "cases" else given[section] | load[section]
    with pytest.raises(study.StudyError, match="R is missing: the radius of the punch"):
        from_tables({name: table for name, table in given.items() if table}, "s", "", "s.toml")


def test_all_mistakes_are_named_at_once(tmp_path):
    """Of each part of the file, though its parts are read one after the other."""
    wrong = {'"5 mm"': '"5 s"', "0.25": "0.6", '"210 GPa", "rigid"': '"210 GPa", 7', '"1 N"': '"1 m"', "x = 3": "x = 1"}
    text = "titel = 1\n" + TEXT.replace("[axes]", 'bonding = "glued"\na = "1 um"\n[axes]') + "[numerics]\nrtol = 5\n"
    for old, new in wrong.items():
        text = text.replace(old, new, 1)
    with pytest.raises(study.StudyError) as caught:
        of(text, tmp_path)
    said = [
        message.removeprefix("dlc.toml: ").split(":")[0].split(" has no unit")[0] for message in caught.value.messages
    ]
    keys = ['"titel" is not a section; did you mean "title"?', "P", "rtol = 5", "E2[1] = 7", 'R = "5 s" is in second']
    keys += ["nu1 = 0.6", 'bonding = "glued"', "exactly one of P, a, D must be given, not P and a", "x = 1"]
    assert said == keys


def test_what_is_missing_is_said_in_the_same_round():
    with pytest.raises(study.StudyError) as caught:
        study.solve(R="5 mm", E1=5, bonding="bonded")
    words = [message.removeprefix("solve: ").split(":")[0] for message in caught.value.messages]
    assert words == [
        *("E1 = 5 has no unit", "E2 is missing", "exactly one of P, a, D must be given, not none"),
        *("h is missing", "Nbar is missing", "Ra is missing"),
    ]
    cases = [{"P": "1 N", "h": "1 um"}, {"P": "2 N"}]
    with pytest.raises(study.StudyError) as caught:
        study.solve(R="5 mm", E1="1 GPa", E2="9 GPa", micro="smooth", cases=cases)
    assert caught.value.messages == ("solve: h must be given in every case, or once for all",)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('["2 um", "20 um"]', '"2 um"', 'h = "2 um": must be a list or {start'),
        ('["2 um", "20 um"]', "[]", "h is empty: must have at least one value"),
        ("[output]", "nu2 = { start = 0.1, stop = 0.2, nu = 3, num = 3 }\n[output]", 'nu2: "nu" is not allowed'),
        ("[output]", f'{DRAWN}label = ["x"]\n[output]', '[sample] "label" is not a parameter'),
        (
            "[output]",
            '[[cases]]\nnu2 = 0.3\nlable = "x"\n[output]',
            '"lable" is not a parameter; did you mean "label"?',
        ),
        ("[output]", "[cases]\nnu2 = 0.3\n[output]", "cases must be [[cases]] tables (a list of dictionaries)"),
        ("[axes]", "[axis]\n[axes]", '"axis" is not a section; did you mean "axes"?'),
    ],
)
def test_one_mistake_is_one_message(tmp_path, old, new, message):
    with pytest.raises(study.StudyError) as caught:
        of(TEXT.replace(old, new, 1), tmp_path)
    assert len(caught.value.messages) == 1 and message in caught.value.messages[0]


def test_an_empty_range_is_a_mistake(tmp_path):
    with pytest.raises(study.StudyError, match="h: start is missing"):
        of(TEXT.replace('["2 um", "20 um"]', "{}"), tmp_path)


def test_a_range_with_a_mistake_makes_no_second_message(tmp_path):
    """Whatever its numbers would be in units of this radius."""
    with pytest.raises(study.StudyError) as caught:
        of(TEXT.replace('"5 mm"', '"1 nm"').replace("num = 3", "nu = 3"), tmp_path)
    assert caught.value.messages == (
        'dlc.toml: P: "nu" is not allowed; a range is {start, stop, num, spacing}',
        "dlc.toml: P: num is missing: must be a whole number in [2, 1000000]",
    )
