"""Whether a contact holds, in words: against `study.extremes` and `study.first_yield`, which search by other ways."""

import re

import numpy as np
import pytest
from test_largest_pressure import SIZES, quiet
from yielding import first_yield, largest

import study

SIZES = SIZES | {"N": 1.0, "mN": 1e-3, "kN": 1e3}
STEEL = "steel 52100"
DLC = {"R": "5 mm", "punch": STEEL, "layer": "DLC a-C:H", "h": "20 um", "bonding": "bonded", "body": STEEL}


def strength(contact) -> str:
    """The line about strengths; "" without one."""
    lines = [line for line in study.summary(contact).splitlines() if line.startswith("Strength: ")]
    return lines[0].removeprefix("Strength: ") if lines else ""


def sizes(text: str) -> list[float]:
    return [float(number) * SIZES[unit] for number, unit in re.findall(r"([\d.]+) ([µmkMG]?[NPm]a?)\b", text)]


def test_what_is_nearest_to_its_limit_and_at_which_load_it_is_there():
    found = quiet(**DLC, P="10 N", Nbar="0.1 1/um^2", Ra="20 um")
    text, yields = strength(found), first_yield("asperities", **DLC, Nbar="0.1 1/um^2", Ra="20 um")
    assert text.startswith("Nearest to its limit is what meets at the asperities: the largest von Mises stress, ")
    load = re.search(r"What meets at the asperities would yield at about P = ([\d.]+ m?N)\.", text)[1]
    assert sizes(load) == pytest.approx([yields.P_Ya.item()], rel=0.06), "two digits"
    assert re.search(r"Less near: .*the body 0\.\d+ of its yield strength", text)


def test_the_stress_its_place_and_the_share_are_those_of_the_extremes():
    found = quiet(**DLC, P="100 N", micro="smooth", Y2="800 MPa")
    text, extremes = strength(found), largest(found, "mises2")
    assert text.startswith("Nearest to its limit is the body: ") and " on the axis " in text
    stress, depth, limit = sizes(text.split(". Less")[0])
    assert stress == pytest.approx(extremes.mises2.item(), rel=0.06) and limit == 8e8
    assert depth == pytest.approx(extremes.mises2_z.item() * found.a.item(), rel=0.06)
    share = float(re.search(r"is ([\d.]+) times the yield strength", text)[1])
    assert share == pytest.approx(extremes.mises2.item() / 8e8, rel=0.06) and share > 1
    load = sizes(re.search(r"At about P = ([\d.]+ m?N) the body begins to yield\.", text)[1])
    assert load == pytest.approx([first_yield("body", **DLC, micro="smooth", Y2="800 MPa").P_Y2.item()], rel=0.06)


def test_a_coating_that_cracks():
    """ta-C has a fracture strength; where it bends over a soft body its tension is far larger than the pressure."""
    plate = {"R": "3 mm", "punch": "rigid", "layer": "ta-C", "h": "20 um", "bonding": "bonded", "body": "PEEK"}
    found = quiet(**plate, P="20 N", micro="smooth")
    text, limit = strength(found), study.materials.get("ta-C").fracture_strength
    tension = largest(found, "s1_layer").s1_layer.item()
    part = f"{tension / limit:.2g} {'times' if tension > limit else 'of'}"
    assert f"the layer {part} its fracture strength" in text or "largest tension" in text


def test_strengths_that_are_not_known_are_asked_for():
    """And how large they must be is said: here at the bottom of the layer it is far from p(0)/1.6."""
    ball = {"R": "3 mm", "E2": "4 GPa", "nu2": 0.4, "E1": "500 GPa", "nu1": 0.2, "h": "20 um", "bonding": "bonded"}
    found = quiet(**ball, P="20 N", micro="smooth")
    text, extremes = strength(found), largest(found, "mises1", "mises2")
    layer, body = sizes(text)
    assert text.startswith("Not known of the layer, which needs above ") and "(Y1)" in text and "(Y2)" in text
    assert layer == pytest.approx(extremes.mises1.item(), rel=0.06) and layer > 5 * found.p0.item() / 1.6
    assert body == pytest.approx(extremes.mises2.item(), rel=0.06)


@pytest.mark.parametrize(
    "given",
    [
        {"P": 1e-5, "base": "half_space", "micro": "smooth"},
        {"R": "5 mm", "E2": "20 MPa", "nu2": 0.499, "base": "half_space", "P": "1 mN", "micro": "smooth"},
    ],
    ids=["no units", "rubber"],
)
def test_where_no_strength_is_wanted(given):
    found = quiet(**given)
    assert strength(found) == "" and study.summary(found).endswith("adhesion, and whether the bodies stay elastic.")
    assert strength(quiet(**given, Y2=0.01 if "R" not in given else "1 MPa")).startswith("Nearest to its limit is the ")


def test_of_many_contacts_it_is_not_said():
    found = quiet(**DLC, P=["1 N", "10 N"], micro="smooth")
    assert "Strength: " not in study.summary(found) and strength(found.isel(P=0))


def test_films_say_who_computes_their_stresses():
    assert strength(quiet(**DLC | {"h": "20 nm"}, P="10 N", micro="smooth")).startswith("The layer is so thin")


def test_a_body_that_yields_is_named_in_the_warning():
    given = {"h": 0.02, "n": 5.0, "bonding": "bonded", "micro": "smooth", "P": 1e-5}
    stress = largest(study.solve(**given), "mises1", "mises2")
    for name, who in (("1", "layer"), ("2", "body")):
        limit = stress[f"mises{name}"].item()
        weak, strong = (study.solve(**given, **{f"Y{name}": share * limit}) for share in (0.999999, 1.000001))
        assert weak.validity.item() & 512 and not strong.validity.item() & 512
        assert f"its yield strength. The results are those of bodies that stay elastic. It is the {who}." in str(
            study.summary(weak)
        )
    many = study.solve(**given | {"P": [1e-6, 1e-5]}, Y1=0.9 * stress.mises1.item(), Y2=0.99 * stress.mises2.item())
    assert (many.validity.values & 512 > 0).tolist() == [False, True]


def test_without_strengths_no_stress_is_computed(monkeypatch):
    from study.rules import strength as rules

    monkeypatch.setattr(rules, "solve", None)
    study.solve(P=1e-5, h=0.02, n=5.0, Nbar=250000.0, Ra=0.004)
    with pytest.raises(TypeError):
        study.solve(P=1e-5, h=0.02, n=5.0, Nbar=250000.0, Ra=0.004, Y1=np.float64(0.1))
