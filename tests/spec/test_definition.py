"""Study files: what is read, what is refused, and what the digest depends on."""

import numpy as np
import pytest

import study
from study.spec import definition, identity
from study.spec.definition import MOST_VALUES
from study.spec.vocabulary import PARAMETERS, VOCABULARY

GOOD = """
title = "Prüfung"
[model]
h = 0.02
n = 0.5
Nbar = 250000
Ra = 0.004
[axes]
P = [1e-5, 2e-5]
bonding = ["frictionless", "bonded"]
nodes = {start = 8, stop = 24, num = 3}
[numerics]
rtol = 1e-4
[output]
x = [0, 0.5, 1]
"""


def read(tmp_path, text, name="fig99.toml"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return definition.read(path)


def messages(tmp_path, text) -> list[str]:
    with pytest.raises(study.StudyError) as caught:
        read(tmp_path, text)
    assert isinstance(caught.value, ValueError)
    prefix = f"{(tmp_path / 'fig99.toml').as_posix()}: "
    assert all(message.startswith(prefix) for message in caught.value.messages)
    return [message.removeprefix(prefix) for message in caught.value.messages]


def test_good_file(tmp_path):
    found = read(tmp_path, GOOD)
    assert (found.name, found.title, found.text) == ("fig99", "Prüfung", GOOD)
    assert found.grid.sizes == {"P": 2, "bonding": 2, "nodes": 3}
    values = {name: array.tolist() for name, (_, array) in found.grid.values.items()}
    assert values["P"] == [1e-5, 2e-5]
    assert values["nodes"] == [8, 16, 24]
    assert type(values["nodes"][0]) is int
    assert values["rtol"] == 1e-4
    assert values["micro"] == "disc_cell"
    assert values["nu1"] == values["nu2"] == 0.3
    assert "beta" not in values
    assert found.x.tolist() == [0, 0.5, 1]


def test_a_byte_order_mark_and_crlf_are_read(tmp_path):
    assert read(tmp_path, "\ufeff" + GOOD.replace("\n", "\r\n")).grid.size == 12


def test_log_axis(tmp_path):
    text = GOOD.replace("P = [1e-5, 2e-5]", 'P = {start = 1e-6, stop = 1e-4, num = 3, spacing = "log"}')
    # a few roundings
    np.testing.assert_allclose(read(tmp_path, text).grid.values["P"][1], [1e-6, 1e-5, 1e-4], rtol=1e-14, atol=0)


# what is replaced in GOOD, by what, and the message that must appear
BAD = [
    ("h = 0.02", "h = 0.02\nNabr = 1", '[model] "Nabr" is not a parameter; did you mean "Nbar"?'),
    ("[output]", "[outptu]\n[output]", '"outptu" is not a section; did you mean "output"?'),
    ("P = [", "Nabr = [1]\nP = [", '[axes] "Nabr" is not a parameter; did you mean "Nbar"?'),
    ("rtol = ", "blok = 3\nrtol = ", '[numerics] "blok" is not known; did you mean "block"?'),
    ("x = [0", "profile = true\nx = [0", '[output] "profile" is not known; did you mean "profiles"?'),
    ("h = 0.02", "h = 0.02\nP = 1e-5", "P is given twice: in [model] and in [axes]"),
    ("h = 0.02", "h = 0.02\nbonding = 'bonded'", "bonding is given twice: in [model] and in [axes]"),
    ("rtol = ", "nodes = 8\nrtol = ", "nodes is given twice: in [numerics] and in [axes]"),
    ("h = 0.02", "h = 0.02\nrtol = 1e-3", "[model] rtol belongs in [numerics]"),
    ("h = 0.02", "h = 0.02\na = 0.04", "exactly one of P, a, D must be given, not P and a"),
    ("P = [1e-5, 2e-5]", "", "exactly one of P, a, D must be given, not none"),
    ("h = 0.02", "h = [0.02]", "[model] h has several values: these belong in [axes]"),
    (
        "P = [1e-5, 2e-5]",
        "P = 1e-5",
        "P = 1e-05: must be a list or {start, stop, num, spacing}; a single value belongs in",
    ),
    ("2e-5]", "-1]", "P[1] = -1: must be in [1e-24, 1e3]"),
    ("2e-5]", "0]", "P[1] = 0: must be in [1e-24, 1e3]"),
    ("2e-5]", "nan]", "P[1] = nan: must be a finite number, in [1e-24, 1e3]"),
    ("2e-5]", "inf]", "P[1] = inf: must be a finite number, in [1e-24, 1e3]"),
    ("2e-5]", "'2e-5']", 'P[1] = "2e-5": must be a finite number, in [1e-24, 1e3]'),
    ("2e-5]", "true]", "P[1] = True: must be a finite number, in [1e-24, 1e3]"),
    ("2e-5]", "[1]]", "P[1] = [1]: must be a finite number, in [1e-24, 1e3]"),
    ("2e-5]", "2024-01-01]", "P[1] = 2024-01-01: must be a finite number, in [1e-24, 1e3]"),
    ("2e-5]", "1" + "0" * 400 + "]", "...: must be a finite number, in [1e-24, 1e3]"),
    ("2e-5]", "1e-5]", "P[0] and P[1] are both 1e-05: values of an axis must differ"),
    (
        '"bonded"]',
        '"frictionless"]',
        'bonding[0] and bonding[1] are both "frictionless": values of an axis must differ',
    ),
    ('"bonded"]', '"glued"]', 'bonding[1] = "glued": must be one of "frictionless", "bonded"'),
    ("P = [1e-5, 2e-5]", "P = []", "P is empty: must have at least one value"),
    ("n = 0.5", "n = 0", "n = 0: must be in [1e-9, 1e9]"),
    ("n = 0.5", "n = -0.5", "n = -0.5: must be in [1e-9, 1e9]"),
    ("n = 0.5", "n = 0.5\nnu1 = 0.51", "nu1 = 0.51: must be in (-1, 0.5]"),
    ("n = 0.5", "n = 0.5\nnu2 = -1", "nu2 = -1: must be in (-1, 0.5]"),
    ("n = 0.5", "", 'n is missing: base = "layered" needs it'),
    ("Ra = 0.004", "", 'Ra is missing: micro = "disc_cell" needs it'),
    ("Ra = 0.004", "Ra = 0.004\nmicro = 'power_law'\nB = 0.1", 'beta is missing: micro = "power_law" needs it'),
    ("Ra = 0.004", "Ra = 0.004\nbeta = 1.5", "beta = 1.5: must be in [0.01, 1]"),
    ("rtol = 1e-4", "rtol = 1e-13", "rtol = 1e-13: must be in [1e-12, 0.1]"),
    ("rtol = 1e-4", "k = -1", "k = -1: must be in [0, 1e6]"),
    ("start = 8", "start = 2", "nodes[0] = 2.0: must be 0 or in [4, 256]"),
    ("stop = 24", "stop = 9", "nodes[1] = 8.5: must be a whole number"),
    ("num = 3", "num = 1", "nodes: num = 1: must be a whole number in [2, 1000000]"),
    ("num = 3", "num = 3, spacing = 'cubic'", 'nodes: spacing = "cubic": must be one of "linear", "log"'),
    ("start = 8", "start = 0, spacing = 'log'", "nodes: start = 0: must be a finite number, > 0 for spacing log"),
    ("start = 8", "start = 8, begin = 8", 'nodes: "begin" is not allowed; a range is {start, stop, num, spacing}'),
    ("rtol = 1e-4", "block = 0", "[numerics] block = 0: must be a whole number in [1, 1000000]"),
    ("x = [0, 0.5, 1]", "x = 1", "x = 1: must be a whole number in [2, 10000] or a list of numbers from 0 to 1"),
    (
        "x = [0, 0.5, 1]",
        "x = [0, 0.7, 0.5, 1]",
        "x = [0, 0.7, 0.5, 1]: a list must increase from 0 to 1, both included",
    ),
    ("x = [0, 0.5, 1]", "x = [0, 0.5]", "x = [0, 0.5]: a list must increase from 0 to 1, both included"),
    ("x = [0, 0.5, 1]", "profiles = 1", 'profiles = 1: must be true or false, or a list of "p", "lam"'),
    ('title = "Prüfung"', "title = 3", "title = 3: must be text"),
    ('title = "Prüfung"', 'kind = "contract"', 'kind = "contract": must be "contact", or left out'),
    (
        'title = "Prüfung"',
        'kind = "micro_law"',
        'kind = "micro_law": must be "contact", or left out; a micro law needs no study: call solver.fit_power_law',
    ),
    ('title = "Prüfung"', "kind = ['contact']", "kind = ['contact']: must be"),
    (
        'title = "Prüfung"',
        "fit = {}",
        '"fit" is not a section; known: title, kind, model, axes, cases, sample, numerics',
    ),
    ('title = "Prüfung"', "cases = 3", "cases must be [[cases]] tables (a list of dictionaries)"),
    ('title = "Prüfung"', "cases = []", "cases is empty: must have at least one case"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BAD, ids=lambda text: text[:40])
def test_bad_file(tmp_path, old, new, expected):
    assert old in GOOD
    found = messages(tmp_path, GOOD.replace(old, new, 1))
    assert any(expected in message for message in found), found
    assert len(found) == 1, found


def test_all_errors_of_a_file_at_once(tmp_path):
    text = GOOD.replace("h = 0.02", "h = -1\nNabr = 3").replace("2e-5]", "nan]").replace("x = [0", "x = [0.1")
    assert len(messages(tmp_path, text)) == 4


def test_many_wrong_values_of_an_axis_are_counted(tmp_path):
    found = messages(tmp_path, GOOD.replace("P = [1e-5, 2e-5]", "P = {start = -9, stop = 0, num = 10}"))
    assert found[:3] == [f"P[{i}] = {-9.0 + i}: must be in [1e-24, 1e3]" for i in range(3)]
    assert found[3:] == ["P: and 7 more such values"]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"[model\nh = 1\n", "line 1"),
        (b"[model]\nh = 1\nh = 2\n", "line 3"),
        (b"h = 1" + b"0" * 5000, "a whole number has more than 4300 digits"),
        (b"title = '\xff'", "utf-8"),
        (b"a = " + b"[" * 5000, "nested too deep"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_malformed_toml_names_file_and_place(tmp_path, content, reason):
    path = tmp_path / "fig99.toml"
    path.write_bytes(content)
    with pytest.raises(study.StudyError, match=f"fig99.toml: is not valid TOML: .*{reason}"):
        definition.read(path)


def test_missing_file(tmp_path):
    with pytest.raises(study.StudyError, match="none.toml: cannot be read: No such file"):
        definition.read(tmp_path / "none.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(study.StudyError, match="folder.toml: cannot be read: Is a directory"):
        definition.read(tmp_path / "folder.toml")


@pytest.mark.parametrize("name", [".hidden.toml", "a b.toml", "..toml", "fig04.txt", "é.toml"])
def test_names_that_are_refused(tmp_path, name):
    with pytest.raises(study.StudyError, match="a study file is called NAME.toml"):
        read(tmp_path, GOOD, name)


def test_cases_and_their_gaps(tmp_path):
    text = """
    [model]
    Nbar = 250000
    Ra = 0.004
    [[cases]]
    label = "layer"
    P = 1e-5
    h = 0.02
    n = 0.5
    [[cases]]
    P = 2e-5
    base = "half_space"
    nu1 = 0.4
    [axes]
    nodes = [8, 16]
    """
    grid = read(tmp_path, text).grid
    assert grid.sizes == {"case": 2, "nodes": 2}
    assert grid.values["base"][1].tolist() == ["layered", "half_space"]
    assert grid.values["nu1"][1].tolist() == [0.3, 0.4]
    np.testing.assert_array_equal(grid.values["h"][1], [0.02, np.nan])
    assert grid.labels["label"][1].tolist() == ["layer", ""]
    assert messages(tmp_path, text.replace("h = 0.02", "")) == ['h is missing: base = "layered" needs it']
    swapped = text.replace("h = 0.02", "").replace("nu1", "h = 0.02\n    nu1")
    assert messages(tmp_path, swapped) == ['h is missing in case 0: base = "layered" needs it']
    assert messages(tmp_path, text.replace("P = 2e-5", "")) == ["P is missing in case 1"]
    assert messages(tmp_path, text.replace('"layer"', "3")) == ["[[cases]] label: must be text"]
    twins = (
        "[[cases]]\nP = 1\nlabel = 'u'\n[[cases]]\nlabel = 'v'\nP = 1\n[model]\nmicro = 'smooth'\nbase = 'half_space'"
    )
    assert messages(tmp_path, twins) == ["cases 0 and 1 are the same"]
    assert messages(tmp_path, twins.replace("'v'\nP = 1", "'u'\nP = 2")) == [
        'label[0] and label[1] are both "u": values of an axis must differ'
    ]


def test_a_parameter_that_a_base_needs_somewhere_on_an_axis(tmp_path):
    for base in ("thin_layer", "layered"):
        text = f"[axes]\nP = [1]\nbase = ['half_space', '{base}']\n[model]\nmicro = 'smooth'\nh = 1"
        assert messages(tmp_path, text) == [f'n is missing: base = "{base}" needs it']


def test_size_is_checked_before_anything_is_allocated(tmp_path):
    many = "{start = 1, stop = 2, num = 100000}"
    text = f"[axes]\nP = {many}\nNbar = {many}\nRa = {many}\n[model]\nh = 1\nn = 0.5\n"
    found = messages(tmp_path, text)
    assert found[0].startswith("1000000000000000 cases make")
    assert f"{MOST_VALUES:.0e}" in found[0]


@pytest.mark.parametrize("value", ["0.6", "-1.0", "nan", "inf"])
def test_a_wrong_number_among_right_ones_is_named(tmp_path, value):
    text = f"[axes]\nP = [1.0]\nnu1 = [0.3, {value}, 0.2]\n[model]\nmicro = 'smooth'\nh = 1\nn = 0.5"
    (message,) = messages(tmp_path, text)
    assert message.startswith(f"nu1[1] = {value}: must be ") and "(-1, 0.5]" in message


def test_digest_is_of_the_numbers(tmp_path):
    digest = read(tmp_path, GOOD).digest
    same = [
        GOOD.replace("Prüfung", "x"),
        GOOD + "# comment",
        GOOD.replace("rtol", "block = 7\nrtol"),
        GOOD.replace("[1e-5, 2e-5]", "{start = 1e-5, stop = 2e-5, num = 2}"),
        GOOD.replace("h = 0.02\nn = 0.5", "n = 0.5\nh = 2e-2\nnu1 = 0.3"),
    ]
    assert {read(tmp_path, text).digest for text in same} == {digest}
    other = [
        GOOD.replace("2e-5", "2.00000000000001e-5"),
        GOOD.replace("1e-4", "1e-5"),
        GOOD.replace("0.5, 1]", "0.6, 1]"),
        GOOD.replace("x = ", "profiles = false\nx = "),
        GOOD.replace("h = 0.02", "h = 0.02\nnu1 = 0.31"),
        GOOD.replace('["frictionless", "bonded"]', '["bonded", "frictionless"]'),
    ]
    found = {read(tmp_path, text).digest for text in other}
    assert len(found) == len(other)
    assert digest not in found


def test_digest_changes_with_the_numerics(tmp_path, monkeypatch):
    digest = read(tmp_path, GOOD).digest
    monkeypatch.setattr(identity, "NUMERICS_VERSION", "other")
    assert read(tmp_path, GOOD).digest != digest


def test_defaults_of_the_vocabulary_are_allowed_values():
    from study.spec.vocabulary import check

    for name in PARAMETERS:
        entry = VOCABULARY[name]
        assert entry.own.default is None or not check(entry.own, entry.own.default)
        assert entry.own.interval or entry.own.choices
