"""Two bodies of one material: pieces of their own, whose spreads are independent, or one piece (`same_piece`)."""

import json
import tomllib
import warnings

import numpy as np
import pytest

import study
from study.__main__ import main
from study.inputs.reading import from_tables

pytest.importorskip("pint")
BALL = {"R": "5 mm", "punch": "PMMA", "body": "PMMA", "base": "half_space", "micro": "smooth", "P": "10 N", "x": 3}
PMMA = study.materials.get("PMMA")
OF_E = PMMA.reduced_modulus_spread / PMMA.reduced_modulus


def quiet(**given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**given)


@pytest.mark.parametrize("layer", [{}, {"base": "layered", "layer": "PMMA", "h": "0.2 mm", "bonding": "bonded"}])
def test_one_piece_is_off_as_a_whole(layer):
    """Hertz's D goes as E*^(-2/3) and a as E*^(-1/3), of two bodies of one modulus as of one; so does a layer of the
    same material, as far as it is solved to 1e-6."""
    found = quiet(**BALL | layer, same_piece=True)
    np.testing.assert_allclose(found.D_spread / found.D, 2 / 3 * OF_E, rtol=1e-5)
    np.testing.assert_allclose(found.a_spread / found.a, 1 / 3 * OF_E, rtol=1e-5)
    apart = quiet(**BALL | layer)
    np.testing.assert_array_equal(found.D, apart.D)
    assert found.E2_spread == found.E_punch_spread == PMMA.E_spread
    if not layer:  # two independent halves of the compliance
        np.testing.assert_allclose(apart.D_spread / apart.D, 2 / 3 * OF_E / np.sqrt(2), rtol=2e-3)


def of(text: str):
    return from_tables(tomllib.loads(text), "pmma", text, "pmma.toml")


def test_of_a_grid_where_some_bodies_are_alike():
    """Each case is what it is alone, inputs keep the dimensions in which they were given."""
    names = {"punch": ["PMMA", "steel 52100", "PEEK"], "body": ["PEEK", "PMMA"]}
    found, apart = quiet(**BALL | names, same_piece=True), quiet(**BALL | names)
    assert found.E2.dims == ("body",) and found.nu_punch.dims == ("punch",) and found.D.dims == apart.D.dims
    for punch in names["punch"]:
        for body in names["body"]:
            alike = {"same_piece": True} if punch == body else {}
            alone = quiet(**BALL | {"punch": punch, "body": body} | alike)
            case = found.sel(punch=punch, body=body)
            np.testing.assert_allclose(case.D_spread, alone.D_spread, rtol=1e-9, err_msg=f"{punch}, {body}")
            np.testing.assert_array_equal(case.D, alone.D)
    rows = [{"punch": punch, "body": "PMMA"} for punch in names["punch"]]
    common = {name: value for name, value in BALL.items() if name not in names}
    cases = quiet(cases=rows, **common, same_piece=True)
    np.testing.assert_allclose(cases.D_spread, found.D_spread.sel(body="PMMA"), rtol=1e-9)


def test_study_files_say_it_in_the_model(tmp_path):
    given = {name: value for name, value in BALL.items() if name not in ("x", "punch", "P")}
    text = "[model]\nsame_piece = true\n" + "".join(f"{name} = {value!r}\n" for name, value in given.items())
    text += "[axes]\npunch = ['PMMA', 'PEEK']\nP = ['1 N', '10 N']\n[output]\nx = 3\n"
    (tmp_path / "pmma.toml").write_text(text)
    loaded = study.load(tmp_path / "pmma.toml", tmp_path)
    assert loaded.run(workers=1).complete
    found, alone = loaded.open(), quiet(**given, punch=["PMMA", "PEEK"], P=["1 N", "10 N"], same_piece=True, x=3)
    np.testing.assert_allclose(found.D_spread, alone.D_spread.transpose(*found.D_spread.dims), rtol=1e-9)
    assert found.E2.dims == () and found.body.attrs["comment"] == alone.body.attrs["comment"]
    apart = of(text.replace("true", "false"))
    assert apart.digest != loaded.definition.digest, "other spreads are other results"


def test_the_words_say_which_it_is(capsys):
    for more, words in (
        ({}, "punch and body independent pieces of PMMA"),
        ({"same_piece": True}, "punch and body one piece of PMMA"),
    ):
        given = study.summary(quiet(**BALL, **more)).splitlines()[0]
        assert given.startswith("Given:") and words in given and given.count("piece") == 1
    three = {"base": "layered", "layer": "PMMA", "h": "0.2 mm"}
    assert "punch, layer and body independent pieces of PMMA" in study.summary(quiet(**BALL | three))
    unused = quiet(**BALL | {"layer": "PMMA", "h": "0.2 mm"})
    assert "punch and body independent pieces of PMMA" in study.summary(unused)
    for other in ({"punch": "PEEK"}, {"punch": "rigid"}):
        assert "piece" not in study.summary(quiet(**BALL | other))
    several = study.summary(quiet(**BALL | {"punch": ["PMMA", "PEEK"]}, same_piece=True))
    assert [part.count("one piece of PMMA") for part in several.split("---")[1:]] == [1, 0]
    words = [f"{name}={value}" for name, value in BALL.items() if name != "x"]
    assert main(["point", *words, "same_piece=true"]) == 0
    assert "punch and body one piece of PMMA" in capsys.readouterr().out
    assert main(["point", "--json", *words, "same_piece=True"]) == 0
    spread = json.loads(capsys.readouterr().out)["D"]["spread"]
    assert spread == quiet(**BALL, same_piece=True).D_spread.item()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"punch": "PEEK"}, "same_piece: no two of punch, layer and body are of one material by name"),
        ({"punch": "rigid", "body": ["PMMA", "PEEK"]}, "same_piece: no two of punch, layer and body are of one"),
        ({"punch": None, "E_punch": "3 GPa"}, "same_piece: no two of punch, layer and body are of one material"),
        ({"same_piece": "yes"}, 'same_piece = "yes": must be true or false'),
        ({"same_piece": 1}, "same_piece = 1: must be true or false"),
        ({"cases": [{"punch": "PMMA", "same_piece": True}], "punch": None}, "same_piece is for all cases alike"),
    ],
)
def test_what_cannot_be_one_piece_is_refused(change, message):
    given = {name: value for name, value in (BALL | {"same_piece": True} | change).items() if value is not None}
    with pytest.raises(study.StudyError, match=message):
        study.solve(**given)


def test_without_names_or_units_there_is_no_piece(tmp_path, capsys):
    with pytest.raises(study.StudyError, match="same_piece: no two of punch, layer and body are of one material by"):
        study.solve(P=1e-5, base="half_space", micro="smooth", same_piece=True)
    plain = "[model]\nP = 1e-5\nbase = 'half_space'\nmicro = 'smooth'\nsame_piece = true\n"
    with pytest.raises(study.StudyError, match="^pmma.toml: same_piece: no two of punch, layer and body"):
        of(plain)
    named = "[model]\nR = '5 mm'\npunch = 'PMMA'\nbody = 'PMMA'\nbase = 'half_space'\nmicro = 'smooth'\nP = '1 N'\n"
    with pytest.raises(study.StudyError, match=r'\[model\] same_piece = "yes": must be true or false'):
        of(named + "same_piece = 'yes'\n")
    with pytest.raises(study.StudyError, match="same_piece is for all cases alike"):
        of(named + "[axes]\nsame_piece = [true, false]\n")
    assert main(["point", "R=5 mm", "punch=PMMA", "body=PMMA", "P=1 N", "same_piece=1"]) == 2
    assert "must be same_piece=true or same_piece=false" in capsys.readouterr().err
