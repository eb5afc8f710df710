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
    assert text.startswith("The asperities are closest to yielding: the largest von Mises stress, ")
    assert "of the yield strength estimated from hardness, 2.82 ± 0.23 GPa." in text, "52100 has a hardness"
    load, spread = sizes(
        re.search(r"The asperities would yield at about P = ([\d.]+) ± (\d+ m?N)\.", text).expand(r"\1 N, \2")
    )
    assert load == pytest.approx(yields.P_Ya.item(), rel=0.06), "two digits"
    assert spread == pytest.approx(yields.P_Ya_spread.item(), rel=0.06)
    assert re.search(r"Less close: .*the body at 0\.\d+ of its yield strength", text)


def test_the_stress_its_place_and_the_share_are_those_of_the_extremes():
    found = quiet(**DLC, P="100 N", micro="smooth", Y2="800 MPa")
    text, extremes = strength(found), largest(found, "mises2")
    assert text.startswith("The body would yield: ") and " on the axis " in text
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
    assert f"the layer at {part} its fracture strength" in text or "largest tension" in text


def test_strengths_that_are_not_known_are_asked_for():
    """And how large they must be is said: here at the bottom of the layer it is far from p(0)/1.6."""
    ball = {"R": "3 mm", "E2": "4 GPa", "nu2": 0.4, "E1": "500 GPa", "nu1": 0.2, "h": "20 um", "bonding": "bonded"}
    found = quiet(**ball, P="20 N", micro="smooth")
    text, extremes = strength(found), largest(found, "mises1", "mises2")
    layer, body = sizes(text)
    assert (
        text.startswith("Not known: the strength of the layer, which must be above ")
        and "(Y1)" in text
        and "(Y2)" in text
    )
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
    assert strength(quiet(**given, Y2=0.01 if "R" not in given else "1 MPa")).startswith("The body is closest to ")


def test_of_many_contacts_it_is_said_of_each():
    found = quiet(**DLC, P=["1 N", "10 N"], micro="smooth")
    lines = [line for line in study.summary(found).splitlines() if line.startswith("Strength: ")]
    assert lines == [f"Strength: {strength(found.isel(P=i))}" for i in (0, 1)]


def test_films_say_who_computes_their_stresses():
    assert strength(quiet(**DLC | {"h": "20 nm"}, P="10 N", micro="smooth")).startswith("The layer is so thin")


def test_a_body_that_yields_is_named_in_the_warning():
    given = {"h": 0.02, "n": 5.0, "bonding": "bonded", "micro": "smooth", "P": 1e-5}
    stress = largest(study.solve(**given), "mises1", "mises2")
    for name, who in (("1", "layer"), ("2", "body")):
        limit = stress[f"mises{name}"].item()
        weak, strong = (study.solve(**given, **{f"Y{name}": share * limit}) for share in (0.999999, 1.000001))
        assert weak.validity.item() & 512 and not strong.validity.item() & 512
        assert f"its yield strength. The results are those of bodies that stay elastic. The {who} yields." in str(
            study.summary(weak)
        )
    many = study.solve(**given | {"P": [1e-6, 1e-5]}, Y1=0.9 * stress.mises1.item(), Y2=0.99 * stress.mises2.item())
    assert (many.validity.values & 512 > 0).tolist() == [False, True]


def test_of_few_asperities_it_is_the_load_at_which_one_yields():
    """The model may have less than one asperity, which bears more than the load. Hertz: P = (pi q Y)^3 Ra^2/(6 E^2)."""
    ball = {"R": "1 mm", "punch": "rigid", "E2": "3 GPa", "nu2": 0.3, "base": "half_space", "Nbar": "0.01 1/um^2"}
    ball |= {"Ra": "5 um", "yield_strength": "63 MPa"}
    P = (np.pi * 1.612797 * 63e6) ** 3 * 25e-12 / 6 / (3e9 / 0.91) ** 2
    weak, strong = (quiet(**ball, P=f"{part * P} N") for part in (0.98, 1.02))
    assert not weak.validity.item() & 1024 and strong.validity.item() & 1024
    assert weak.a.item() ** 2 * np.pi * 1e10 < 1.5, "asperities"
    for contact, words in ((weak, "would yield"), (strong, "begins to yield")):
        load = re.search(rf"One asperity alone {words} at about P = ([\d.]+) µN\.", strength(contact))[1]
        assert float(load) == pytest.approx(1e6 * P, rel=0.06)
    assert "0.99 of the yield strength, 63 MPa" in strength(weak)


def test_of_a_law_of_ones_own_pmax_is_compared(tmp_path):
    """A table has no radius of asperities: their stress is that of a sphere under the same pressure."""
    c = np.geomspace(0.01, 0.9, 60)  # the disc cell
    B, Ra = 1 / np.sqrt(np.pi * 2e7), 5e-4
    q = c**3 / (np.arccos(c) + c * np.sqrt(1 - c * c))
    p, A = 2 * B / (3 * Ra) * q, B * B / Ra * (c * c - 4 / 3 * q * np.sqrt(1 - c * c))
    rows = np.c_[p, A, c * c, 2 * B * c / np.pi / Ra + 2 / np.pi * p * np.arcsin(c)]
    np.savetxt(tmp_path / "law.csv", rows, delimiter=",", header="p,A,lam,p_max", comments="")
    found = quiet(**DLC | {"R": "10 mm"}, P=["1 uN", "30 N"], micro=f"table:{tmp_path / 'law.csv'}")
    text = strength(found.isel(P=1))
    assert text.startswith("The asperities would yield: the stress as of a sphere under pmax, ")
    assert "The law of the asperities does not give the stress below them" in text
    share = (found.p_max - found.p0).values / 1.5547 / (8e9 / 2.84)
    assert float(re.search(r"([\d.]+) times the", text)[1]) == pytest.approx(share[1], rel=0.06)
    assert (found.validity.values & 1024 > 0).tolist() == (share > 1).tolist() == [False, True]


def test_no_sentence_contradicts_the_next():
    """The mask 512 does not know the punch, and asperities that flow are not those of an elastic law."""
    text = study.summary(quiet(R="5 mm", punch="PMMA", body=STEEL, base="half_space", P="100 N", micro="smooth"))
    assert "except that a strength is exceeded" in text and "The punch would yield: " in text
    assert "None of the checked assumptions is violated" not in text
    rough = {"Nbar": "0.2 1/um^2", "Ra": "5 um", "micro": "elastic_plastic", "hardness": "8 GPa"}
    text = strength(quiet(R="5 mm", punch=STEEL, body=STEEL, base="half_space", P="1 N", **rough))
    assert re.match(r"The asperities have yielded on \d+ % of the nominal contact area\. The ", text)


def test_without_strengths_no_stress_is_computed(monkeypatch):
    from study.rules import strength as rules

    monkeypatch.setattr(rules, "solve", None)
    study.solve(P=1e-5, h=0.02, n=5.0, Nbar=250000.0, Ra=0.004)
    with pytest.raises(TypeError):
        study.solve(P=1e-5, h=0.02, n=5.0, Nbar=250000.0, Ra=0.004, Y1=0.01)
