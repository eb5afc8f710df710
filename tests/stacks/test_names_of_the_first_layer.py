"""The first layer of a stack, whose numbers have two names, h and layers.1.h: messages name it as the other layers."""

import pytest

import study
from study.__main__ import main

BALL = {"R": "5 mm", "E2": "210 GPa", "micro": "smooth", "P": "10 N"}
TIN = {"h": "2 um", "material": "TiN"}
WRONG = {
    "a number": (TIN | {"h": "-2 um"}, "layers.1.h = -2 um: must be in"),
    "a Poisson ratio": ({"h": "2 um", "E1": "1 GPa", "nu": 0.7}, "layers.1.nu = 0.7: must be in (-1, 0.5]"),
    "a word": (TIN | {"bonding": "glued"}, 'layers.1.bonding = "glued": must be one of'),
    "a material": (TIN | {"material": "tinn"}, 'layers.1.material: "tinn" is not a material; did you mean "TiN"?'),
    "another way": (TIN | {"material": "tinn"}, "(or give layers.1.E1 and layers.1.nu)"),
    "its place": (
        {"h": "2 um", "E1": "TiN"},
        "a material is given as layers.1.material, in place of layers.1.E1",
    ),
    "two moduli": (TIN | {"nu": 0.2}, "layers.1.nu are both given: layers.1.nu follows from layers.1.material"),
    "no modulus": ({"h": "2 um"}, "layers.1.E1 is missing: Young's modulus of this layer, or its material"),
    "no thickness": ({"material": "TiN"}, "layers.1.h is missing"),
}


@pytest.mark.parametrize("kind", WRONG)
def test_what_is_wrong(kind):
    layer, message = WRONG[kind]
    with pytest.raises(study.StudyError) as caught:
        study.solve(**BALL, layers=[layer, TIN])
    assert message in str(caught.value) and "layer, in" not in str(caught.value)


def test_equal_values_of_an_axis():
    with pytest.raises(study.StudyError, match=r"layers\.1\.h\[0\] and layers\.1\.h\[1\] are both"):
        study.solve(**BALL, layers=[TIN, TIN], **{"layers.1.h": ["1 um", "1 um"]})


def test_both_names():
    """In a call, in one of its cases and in a study file: none of the two values may win in silence."""
    both = {"layers.1.h": "2 um", "layers.1.material": "TiN", "h": "3 um"}
    with pytest.raises(study.StudyError, match="^solve: layers.1.h is h, which is given too: leave out one$"):
        study.solve(**BALL, **both)
    with pytest.raises(study.StudyError, match="layers.1.h is h, which is given too: leave out one"):
        study.solve(**BALL, cases=[both, both | {"R1": "1 m"}])


@pytest.mark.parametrize("section", ["[model]", "[axes]", "[[cases]]"])
def test_both_names_in_a_file(tmp_path, capsys, section):
    """Exit code 2, before anything is computed."""
    several = section == "[axes]"
    values = ('["3 um"]', '["2 um"]') if several else ('"3 um"', '"2 um"')
    given = "".join(f'{name} = "{value}"\n' for name, value in BALL.items())
    file = tmp_path / "both.toml"
    file.write_text(f'[model]\n{given}layers.1.material = "TiN"\n{section * (section != "[model]")}\nh = {values[0]}\n')
    with open(file, "a", encoding="utf-8") as text:
        text.write(f"layers.1.h = {values[1]}\n")
    assert main(["run", str(file), "--results", str(tmp_path)]) == 2
    assert "layers.1.h is h, which is given too: leave out one" in capsys.readouterr().err
    assert [*tmp_path.iterdir()] == [file]
