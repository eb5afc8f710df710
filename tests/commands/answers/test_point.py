"""One contact from the command line: the words are those of `study.summary`, the numbers those of `study.solve`."""

import json
import math

import pytest

import study
from study import solving
from study.__main__ import main
from study.rules.rule import RULES

BALL = {"R": "5 mm", "E_punch": "210 GPa", "E2": "70 GPa", "nu2": 0.33, "base": "half_space", "micro": "smooth"}


def words(**parameters) -> list[str]:
    return [f"{name}={value}" for name, value in parameters.items()]


def test_a_contact_in_words(capsys):
    assert main(["point", *words(**BALL, P="10 N")]) == 0
    assert capsys.readouterr().out == study.summary(study.solve(**BALL, P="10 N", x=2)) + "\n"


def test_numbers_without_units_are_dimensionless(capsys):
    assert main(["point", "P=1e-5", "base = half_space", "micro=smooth"]) == 0
    assert "P      = 1e-05 E2* R^2" in capsys.readouterr().out


def test_a_contact_as_numbers(capsys):
    assert main(["point", "--json", *words(**BALL | {"E2": "70 ± 7 GPa"}, P="10 N")]) == 0
    printed = json.loads(capsys.readouterr().out)
    found = study.solve(**BALL | {"E2": "70 ± 7 GPa"}, P="10 N", x=2)
    assert printed["a"] == {"value": found.a.item(), "unit": "m", "spread": found.a_spread.item()}
    assert printed["R"] == {"value": 0.005, "unit": "m"} and printed["bonding"] == "frictionless"
    assert [printed[name] for name in ("status", "model_used", "validity")] == ["converged", "smooth_half_space", []]
    assert printed["error"] == found.error.item()


def test_a_rigid_body_is_the_word_that_says_so(capsys):
    """null is a result of a contact without a solution. What is printed can be given again."""
    given = {"R": "5 mm", "E_punch": "rigid", "E1": "5 GPa", "h": "2 um", "E2": "rigid", "P": "1 N", "micro": "smooth"}
    assert main(["point", "--json", *words(**given)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["E2"] == printed["E_punch"] == "rigid" and printed["E1"]["value"] == 5e9


def test_what_validity_has_no_mask_for_is_in_the_numbers_too(capsys):
    """A modulus in mPa, say: a program that reads them saw nothing of what the words say."""
    assert main(["point", "--json", *words(**BALL | {"E2": "70 mPa"}, P="1 pN")]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["validity"] == [] and printed["beware"][0].startswith("E2 = 0.07 Pa: materials have 1 Pa to 2 TPa")


def test_what_the_model_does_not_describe_is_said_and_is_no_traceback(capsys):
    assert main(["point", "--json", *words(P=1e-5, h=0.02, n=0.5, Nbar=25000, Ra=0.004)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["validity"] == ["few_spots"] and printed["beware"] == [RULES["few_spots"].sentence]
    steep = words(**BALL, P="1 MN")
    assert main(["point", *steep]) == 0
    assert "Beware: The strain is not small" in capsys.readouterr().out


def test_a_contact_without_a_solution(capsys):
    stiff = words(P=1e-5, h=0.02, n=0.5, nu1=0.5, bonding="bonded", base="thin_layer", micro="smooth")
    assert main(["point", *stiff]) == 1
    assert "NOT SOLVED (thin_layer_not_applicable)" in capsys.readouterr().out
    assert main(["point", "--json", *stiff]) == 1
    printed = json.loads(capsys.readouterr().out)
    assert printed["a"]["value"] is None and printed["status"] == "thin_layer_not_applicable"


def test_materials_by_name_bring_their_spreads(capsys):
    given = words(R="5 mm", punch="100Cr6", layer="DLC a-C:H", body="PDMS", h="2 um", P="1 N", micro="smooth")
    assert main(["point", "--json", *given]) == 0
    printed = json.loads(capsys.readouterr().out)
    for who, name in (("punch", "steel 52100"), ("1", "DLC a-C:H"), ("2", "PDMS")):
        known, under = study.materials.get(name), "_" * (who == "punch")
        assert printed[f"E{under}{who}"] == {"value": known.E, "unit": "Pa", "spread": known.E_spread}
        assert printed[f"nu{under}{who}"]["value"] == known.nu
    assert printed["a"]["spread"] > 0 and math.isfinite(printed["a"]["spread"])


@pytest.mark.parametrize(
    ("given", "messages"),
    [
        (["P"], ['"P": must be NAME=VALUE, such as R="5 mm"']),
        (["P=", "=3"], ['"P=": must be NAME=VALUE, such as R="5 mm"', '"=3": must be NAME=VALUE, such as R="5 mm"']),
        (["P=1e-5", "P=2e-5"], ["P is given twice"]),
        (["P=1e-5", "x=5"], ["x does not apply to one contact: leave it out"]),
        *(
            (["P=1e-5", f"{name}=3"], [f"{name} does not apply to one contact: leave it out"])
            for name in ("profiles", "cases", "title", "workers")
        ),
        (["body=steel 52100", "E2=210 GPa"], ["body and E2 are both given: E2 follows from body"]),
        (
            ["layer=DLC"],
            ['layer: "DLC" is not a material; did you mean "DLC ta-C" or "DLC a-C:H"? (or give E1 and nu1)'],
        ),
        (
            ["P=1e-5", "h=0.02", "n=0.5", "accuracy=5%", "micro=smooth", "R=2 mm", "E2=5 GPa"],
            ['P = 1e-05 has no unit: must be a force, such as "2 N" (accuracy = "5%" makes this a study with units)'],
        ),
        (["P=1e-5", "p0=1"], ['"p0" is not a parameter; of the results P, a or D may be given']),
        (["R=1 mm", "p0=1 GPa"], ['"p0" is not a parameter; of the results P, a or D may be given']),
        (["P=1e-5", "mirco=smooth"], ['"mirco" is not a parameter; did you mean "micro"?']),
    ],
)
def test_bad_input_is_said_before_anything_is_computed(given, messages, capsys):
    assert main(["point", *given]) == 2
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err.splitlines()[: len(messages)] == messages


def test_a_unit_of_something_else(capsys):
    assert main(["point", *words(**BALL, P="10 GPa")]) == 2
    assert capsys.readouterr().err == 'P = "10 GPa" is a pressure: must be a force, such as "2 N"\n'


def test_what_is_far_outside_is_said_before_it_is_solved(capsys, monkeypatch):
    """On stderr, once; what is within the model is solved without a word."""
    film = {"R": "5 mm", "layer": "PTFE", "h": "10 nm", "body": "steel 52100", "P": "5 N", "bonding": "bonded"}
    film |= {"Nbar": "0.1 1/um^2", "Ra": "2 um", "asperities_on": "half_space"}
    assert main(["point", "--json", *words(**film | {"h": "0.2 mm"})]) == 0
    assert capsys.readouterr().err == ""

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(solving, "solved", interrupted)
    assert main(["point", "--json", *words(**film)]) == 130
    answer = capsys.readouterr()
    assert answer.out == "" and answer.err.startswith("beware: this contact is far outside what the model describes")
    assert RULES["pitch_not_small_against_h"].sentence in answer.err


def test_run_and_check_say_what_is_far_outside(tmp_path, capsys):
    """Before anything is computed."""
    text = '[model]\nR = "5 mm"\nlayer = "PTFE"\nh = "10 nm"\nbody = "steel 52100"\nbonding = "bonded"\n'
    text += 'Nbar = "0.1 1/um^2"\nRa = "2 um"\nasperities_on = "half_space"\n'
    text += '[axes]\nP = ["1 N", "5 N"]\n[output]\nspreads = false\n'
    (tmp_path / "film.toml").write_text(text, encoding="utf-8")
    file, said = str(tmp_path / "film.toml"), "film: beware: at least half of these contacts are far outside"
    assert main(["check", file]) == 0 and said in capsys.readouterr().out
    assert main(["run", "--dry-run", file, "--results", str(tmp_path)]) == 0
    assert said in capsys.readouterr().err


def test_a_picture_of_the_stresses(capsys, tmp_path):
    picture = tmp_path / "new" / "ball.PNG"
    assert main(["point", "--json", "--stresses", str(picture), *words(**BALL, P="10 N")]) == 0
    printed = capsys.readouterr()
    assert json.loads(printed.out)["status"] == "converged" and printed.err == f"stresses: {picture}\n"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert main(["point", "--stresses", str(tmp_path / "ball.svg"), *words(**BALL, P="10 N")]) == 0
    assert b"<svg" in (tmp_path / "ball.svg").read_bytes()


def test_a_picture_that_cannot_be_drawn_is_told_before_anything_is_solved(capsys, monkeypatch):
    def never(*, x=65, **_):
        raise AssertionError("it is solved")

    monkeypatch.setattr("study.commands.point.solve", never)
    assert main(["point", "--stresses", "ball.doc", *words(**BALL, P="10 N")]) == 2
    assert "--stresses ball.doc: must end with one of .png, .pdf, .svg" in capsys.readouterr().err
    assert main(["point", "--stresses", "ball.png", *words(**BALL, P="10 N, 20 N")]) == 2
    assert "--stresses ball.png: the picture shows one contact, and the call has a list" in capsys.readouterr().err
    stamp = ["shape=flat", "flat_radius=0.1", "P=1e-5", "base=half_space", "micro=smooth"]
    assert main(["point", "--stresses", "stamp.png", *stamp]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("--stresses stamp.png: there are no largest stresses under a flat") and not said.out
