"""Study files that are refused: every message names the file, the key, the value and what is allowed."""

import pytest
from test_definition import GOOD, messages, read

import study
from study.inputs import reading as study_file
from study.inputs.definition import MOST_MESSAGES, refusal

# what is replaced in GOOD, by what, and the message that must appear
BAD = [
    ("h = 0.02", "h = 0.02\nNabr = 1", '[model] "Nabr" is not a parameter; did you mean "Nbar"?'),
    ("[output]", "[outptu]\n[output]", '"outptu" is not a section; did you mean "output"?'),
    ("h = 0.02", "h = 0.02\np = 1e-5", '[model] "p" is not a parameter; did you mean "P"?'),
    ("h = 0.02", "h = 0.02\nx = 5", '[model] "x" is not a parameter; known: P, a, D'),
    ("h = 0.02", "h = 0.02\nA0 = 1", '[model] "A0" is not a parameter; of the results P, a or D may be given'),
    ("h = 0.02", "h = 0.02\nh = 0.03", "a name is given twice in one section"),
    (
        "[model]",
        "sigma = 1\n[model]",
        '"sigma" is not a section; known: title, kind, model, axes, cases, layers, sample, '
        "correlations, numerics, output; parameters stand below [model] or [axes]",
    ),
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
    ("n = 0.5", "n = 1e-10", "n = 1e-10: must be 0 or in [1e-9, 1e9]"),
    ("n = 0.5", "n = -0.5", "n = -0.5: must be 0 or in [1e-9, 1e9]"),
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
        '"fit" is not a section; known: title, kind, model, axes, cases, layers, sample, correlations, numerics',
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
        (b"a = " + b"[" * 5000, "nested too deep"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_malformed_toml_names_file_and_place(tmp_path, content, reason):
    path = tmp_path / "fig99.toml"
    path.write_bytes(content)
    with pytest.raises(study.StudyError, match=f"fig99.toml: is not valid TOML: .*{reason}"):
        study_file.read(path)


@pytest.mark.parametrize("content", ["title = 'größer'".encode("cp1252"), "title = 'größer'".encode("utf-16")])
def test_another_encoding_is_answered_with_the_right_one(tmp_path, content):
    """ "'utf-8' codec can't decode byte 0xb5" was called TOML that is not valid."""
    path = tmp_path / "fig99.toml"
    path.write_bytes(content)
    with pytest.raises(study.StudyError, match=r"fig99.toml: is not UTF-8 \(byte \d+\): save it with"):
        study_file.read(path)


@pytest.mark.parametrize(
    ("line", "hinted"),
    [
        ("E1 = 200 GPa", True),
        ("h = [2 um, 4 um]", True),
        ("E1 = 200 ± 10", True),
        ("base = half_space", True),
        ("P = {start = 1 N, stop = 2}", True),
        ("P = 1e-6,", False),
        ("P = 1e-6 2e-6", False),
        ('E1 = "200 GPa', False),
        ("P = {start = 1, stop = 2", False),
    ],
)
def test_texts_without_quotes_are_told_of_them(tmp_path, line, hinted):
    path = tmp_path / "fig99.toml"
    path.write_text(f"[model]\n{line}\n", encoding="utf-8")
    with pytest.raises(study.StudyError, match="is not valid TOML") as caught:
        study_file.read(path)
    assert str(caught.value).endswith('; texts stand in quotes, a number with its unit too: "5 mm"') == hinted


@pytest.mark.parametrize("line", ["P = {start = 1, stop = 2", "P = [1, 2", 'layer = ["DLC", "TiN"'])
def test_what_is_not_closed_is_told_so(tmp_path, line):
    path = tmp_path / "fig99.toml"
    path.write_text(f"[axes]\n{line}\n", encoding="utf-8")
    with pytest.raises(study.StudyError, match=r"a list ends with \], a range with }$"):
        study_file.read(path)


@pytest.mark.parametrize(
    ("line", "end"),
    [
        ("R = “3 mm”", 'column 5); quotes are straight: "5 mm"'),
        ("R = „3 mm“", 'column 5); quotes are straight: "5 mm"'),
        ("P = 1,5", "column 6); a number has a decimal point"),
        ("h = {start = 0,1, stop = 3, num = 3}", "; a number has a decimal point"),
        ("h = [0.01; 0.02]", "column 10)"),
    ],
)
def test_marks_of_other_programs_are_named(tmp_path, line, end):
    path = tmp_path / "fig99.toml"
    path.write_text(f"[model]\n{line}\n", encoding="utf-8")
    with pytest.raises(study.StudyError, match="is not valid TOML") as caught:
        study_file.read(path)
    assert str(caught.value).endswith(end)


def test_missing_file(tmp_path):
    with pytest.raises(study.StudyError, match="none.toml: cannot be read: No such file"):
        study_file.read(tmp_path / "none.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(study.StudyError, match="folder.toml: cannot be read: Is a directory"):
        study_file.read(tmp_path / "folder.toml")


@pytest.mark.parametrize("name", [".hidden.toml", "a b.toml", "..toml", "fig04.txt", "é.toml"])
def test_names_that_are_refused(tmp_path, name):
    with pytest.raises(study.StudyError, match="a study file is called NAME.toml"):
        read(tmp_path, GOOD, name)


def test_the_longest_name(tmp_path):
    """With all characters that there may be."""
    longest = ("aZ_09.-" * 29)[:200]
    assert read(tmp_path, GOOD, f"{longest}.toml").name == longest
    with pytest.raises(study.StudyError, match="200 at most"):
        read(tmp_path, GOOD, f"{longest}b.toml")


@pytest.mark.parametrize("count", [1, 2, MOST_MESSAGES - 1, MOST_MESSAGES, MOST_MESSAGES + 1, 1000])
def test_no_mistake_is_lost_in_the_count(count):
    """Each is said, or counted in the last line; where all are said there is no such line."""
    messages = refusal("s.toml", [f"mistake {i}" for i in range(count)]).messages
    said = [message for message in messages if message.startswith("s.toml: mistake")]
    assert said == [f"s.toml: mistake {i}" for i in range(min(count, MOST_MESSAGES))]
    rest = [f"s.toml: and {count - MOST_MESSAGES} more mistakes"] if count > MOST_MESSAGES else []
    assert list(messages[len(said) :]) == rest
