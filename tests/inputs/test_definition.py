"""Study files: what is read, what is refused, and what the digest depends on."""

import numpy as np
import pytest

import study
from study.inputs import identity
from study.inputs import reading as study_file
from study.inputs.definition import MOST_VALUES
from study.inputs.lexicon import PACKAGE
from study.inputs.vocabulary import PARAMETERS

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
    return study_file.read(path)


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
    for no_text in ("3", '["a", "b"]', "0x" + 5000 * "f"):
        assert messages(tmp_path, text.replace('"layer"', no_text)) == ["[[cases]] label: must be text"]
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


def test_the_order_of_axes_is_in_the_digest(tmp_path):
    """Of a study whose other values are the same for all cases too: its results have their dimensions in this order."""
    model, P, n = "[model]\nmicro = 'smooth'\nh = 0.1\n[axes]\n", "P = [1e-5, 2e-5]\n", "n = [0.5, 0.6]\n"
    assert read(tmp_path, model + P + n).digest != read(tmp_path, model + n + P).digest


def test_digest_changes_with_the_numerics(tmp_path, monkeypatch):
    digest = read(tmp_path, GOOD).digest
    monkeypatch.setattr(identity, "NUMERICS_VERSION", "other")
    assert read(tmp_path, GOOD).digest != digest


def test_defaults_of_the_vocabulary_are_allowed_values():
    from study.inputs.vocabulary import check

    for name in PARAMETERS:
        row = PACKAGE.parameter(name)
        assert row.default is None or not check(row, row.default)
        assert row.interval or row.choices
