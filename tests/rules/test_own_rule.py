"""What docs/extending.md says of rules, done as it stands there: one function in one file."""

import pages
import pytest
from matplotlib.figure import Figure

import study
from study.figures.annotate import note_violations
from study.rules.rule import ASSUMPTIONS, RULES, rule

(RULE,) = (block for block in pages.blocks("docs/extending.md", "python") if "import rule" in block)
STEEL = {"R": "5 mm", "E2": "210 GPa", "base": "half_space", "Nbar": "1 1/um^2", "Ra": "5 um", "x": 2}
SENTENCE = "The asperities flow (pmax > 0.03 E2*): the real area is larger than this one."


@pytest.fixture(autouse=True)
def rules_as_they_were():
    before = dict(RULES), dict(ASSUMPTIONS)
    yield
    for register, rows in zip((RULES, ASSUMPTIONS), before, strict=True):
        register.clear()
        register.update(rows)


def flowing():
    """Contacts of which the second alone has asperities that flow."""
    return study.solve(**STEEL, P=["0.02 N", "10 N"])


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_a_rule_is_one_function():
    assert not (flowing().validity.values >> 20).any()
    exec(RULE, {"__name__": "mine"})
    contact = flowing()
    assert (contact.validity.values >> 20).tolist() == [0, 1]
    assert [text.split().count("asperities_flow") for text in study.decode(contact.validity).values] == [0, 1]
    assert f"1 of 2 cases: {SENTENCE}" in study.in_words.doubts(contact)
    assert [f"Beware: {SENTENCE}" in study.summary(contact.isel(P=i)) for i in (0, 1)] == [False, True]
    axes = Figure().subplots()
    note_violations(axes, {"1": contact.validity[1]})
    assert r"1: asperities flow, $p_{\max} > 0.03\,E_2^*$" in axes.get_title("left")


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_what_another_program_has_found_is_told_by_its_name():
    """Results do not keep to an assumption because this program does not know it."""
    exec(RULE, {"__name__": "mine"})
    contact = flowing().isel(P=1)
    del RULES["asperities_flow"], ASSUMPTIONS[1 << 20]
    assert "asperities_flow: a rule that is not known here." in study.in_words.doubts(contact)


def test_a_rule_without_a_mask_is_asked_before_and_after(tmp_path, capsys):
    """By `check`, of the inputs of the file, and by the words about a contact."""

    @rule()
    def thick(v):
        if "h" in v and (v["h"] > 0.1).any():
            yield "The layer is thick."

    layer = {"R": "5 mm", "E1": "1 GPa", "E2": "210 GPa", "h": "0.2 m", "micro": "smooth"}
    text = "".join(f'{name} = "{value}"\n' for name, value in layer.items())
    (tmp_path / "mine.toml").write_text(f'title = "t"\n[model]\n{text}P = "1 N"\n[axes]\nnu1 = [0.3]\n')
    from study.__main__ import main

    assert main(["check", str(tmp_path / "mine.toml")]) == 0
    assert "mine: beware: The layer is thick." in capsys.readouterr().out
    with pytest.warns(UserWarning, match="The layer is thick"):
        study.solve(**layer, P="1 N", x=2)


@pytest.mark.parametrize("mask", [2, 3, -4, 0])
def test_masks_and_names_are_of_one_rule(mask):
    """2 is taken, 3 is two masks; of the last the name is taken."""

    def few_spots(v, times):
        return v["a"] > 1

    few_spots.__name__ = "few_spots" if mask == 0 else "fewest"
    with pytest.raises(ValueError, match=f"{few_spots.__name__}, {mask}: a rule needs a name, and a power of 2 or 0"):
        rule(mask)(few_spots)
    assert "fewest" not in RULES and max(ASSUMPTIONS) < 1 << 20
