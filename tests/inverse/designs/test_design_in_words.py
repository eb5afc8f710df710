"""The command `design` and `study.summary` of what a design found."""

import json

import numpy as np
import pytest

import study
from study.__main__ import main
from study.commands.designing import question_of
from study.commands.point import parameters_of

# Of steel and DLC, whose asperities would yield in some of these contacts.
pytestmark = [
    pytest.mark.filterwarnings("ignore:a contact of the answer is beyond"),
    pytest.mark.filterwarnings("ignore:this contact is beyond"),
]

LINING = {"R": "5 mm", "punch": "steel 52100", "layer": "PTFE", "body": "steel 52100", "bonding": "bonded",
          "Nbar": "1e5 1/mm^2", "Ra": "2 um"}  # fmt: skip
WORDS = [f"{name}={value}" for name, value in LINING.items()]
BY = {"h": ("1 um", "1 mm")}


@pytest.fixture(scope="module")
def designed():
    return study.design({"p_max": "180 MPa"}, by=BY, P="5 N", **LINING)


def test_one_design_is_the_answer_and_its_contact(designed):
    text = study.summary(designed)
    first, _, given, *_ = text.splitlines()
    assert first == f"{designed.message.item()}." and "h = 378 ± 305 µm" in given
    contact = study.solve(**LINING, P="5 N", h=f"{designed.h.item()!r} m")
    same = [line for line in study.summary(contact).splitlines() if line.startswith(("  ", "Spreads", "Strength"))]
    assert same and all(line in text for line in same)
    assert "<svg" in text._repr_html_()


def test_several_designs_are_a_line_each():
    loads = study.design({"p_max": "180 MPa"}, by=BY, P=["1 N", "5 N"], **LINING)
    lines = study.summary(loads).splitlines()
    assert lines == ["--- P = 1 N", f"{loads.message[0].item()}.", "--- P = 5 N", f"{loads.message[1].item()}."]


def test_two_solutions_are_two_contacts():
    plate = {"n": 10.0, "bonding": "frictionless", "micro": "smooth", "P": 1e-5}
    text = study.summary(study.design({"p0": 0.0122}, by={"h": (1e-4, 0.1)}, **plate))
    assert text.startswith("p0 = 0.0122 E2* at h = 0.003106") and "; or h = 0.005663" in text
    assert text.count("Given:") == 2


def test_the_command(capsys, designed):
    assert main(["design", "p_max=180 MPa", "h=1 um .. 1 mm", *WORDS, "P=5 N"]) == 0
    assert capsys.readouterr().out == f"{study.summary(designed)}\n"


def test_as_json(capsys, designed):
    assert main(["design", "--json", "p_max=180 MPa", "h=1 um .. 1 mm", *WORDS, "P=5 N"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["design_status"] == "found" and found["message"] == designed.message.item()
    (solution,) = found["solutions"]
    assert solution["h"] == {
        "value": designed.h.item(),
        "unit": "m",
        "spread": designed.h_spread.item(),
        "low": designed.h_low.item(),
        "high": None,
    }
    assert solution["p_max"]["value"] == designed.p_max.item() and solution["status"] == "converged"


def test_json_of_several_contacts(capsys):
    given = ["n=10", "bonding=frictionless", "micro=smooth", "P=1e-5, 2e-5"]
    assert main(["design", "--json", "p0=0.0122", "h=1e-4 .. 0.1", *given]) == 1
    found = json.loads(capsys.readouterr().out)
    assert [(one["design_status"], len(one["solutions"])) for one in found] == [("several", 2), ("none_below", 0)]
    assert np.isclose(found[0]["solutions"][0]["h"]["value"], 0.0031062, rtol=1e-4)


@pytest.mark.parametrize(
    ("words", "target", "by", "rest"),
    [
        ("p0=1 h=1..2 P=3", {"p0": 1.0}, {"h": (1.0, 2.0)}, {"P": 3.0}),
        ("D=1 h=1..2 P=3", {"D": 1.0}, {"h": (1.0, 2.0)}, {"P": 3.0}),
        ("P=3 h=1..2 D=1", {"P": 3.0}, {"h": (1.0, 2.0)}, {"D": 1.0}),
        ("a=3 P=1..2", {"a": 3.0}, {"P": (1.0, 2.0)}, {}),
        ("P=3 h=1..2", {}, {"h": (1.0, 2.0)}, {"P": 3.0}),
        ("p0=1 p_max=2 h=1..2 P=3", {"p0": 1.0, "p_max": 2.0}, {"h": (1.0, 2.0)}, {"P": 3.0}),
    ],
)
def test_which_word_is_the_target(words, target, by, rest):
    assert question_of(parameters_of(words.split())) == (target, by, rest)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["p_max=180 MPa", "h=1 um"],
            'exactly one input must have two bounds, such as h="1 um .. 1 mm"; here: none',
        ),
        (["p_max=180 MPa", "h=1 um .. 1 mm", "P=1 N .. 2 N"], "here: h, P"),
        (["p_max=180 MPa", "h=1 mm .. 1 um", "P=1 N"], "the first bound must be below the second"),
        (["h=1 um .. 1 mm", "P=1 N"], "0 targets: give exactly one wanted result with its value"),
        (["p_max=180 MPa", "D=2 um", "P=1 N", "h=1 um .. 1 mm"], "exactly one of P, a, D must be given, not P and D"),
        (["p_max"], '"p_max": must be NAME=VALUE'),
    ],
)
def test_wrong_words_are_told(capsys, words, message):
    assert main(["design", *words, *WORDS]) == 2
    out = capsys.readouterr()
    assert out.out == "" and message in out.err and "Traceback" not in out.err
