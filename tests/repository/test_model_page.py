"""The pages of the model: their equations against the solver, their tables against the code."""

import re

import numpy as np
import pages
import pytest

import study
from solver import Model, Problem, Status, solve
from solver.kernels.closed_form import layered_kernel
from study.data import derived
from study.data.dataset import status_words
from study.inputs.lexicon import PACKAGE
from study.inputs.vocabulary import VOCABULARY

CONTENTS = "docs/model.md"
#: Each page of the model, and how many blocks of Python it has.
MODEL = {
    "docs/symbols.md": 0,
    "docs/macroscale.md": 4,
    "docs/microscale.md": 2,
    "docs/coated_body.md": 1,
    "docs/solving.md": 2,
    "docs/four_answers.md": 0,
    "docs/paper_numbers.md": 1,
}
PAGE = "\n".join(map(pages.read, MODEL))
ROLES = ("control", "material", "roughness", "numerics", "result", "profile", "flag", "count", "derived")
PRINTED = {"m^2": "m²", "1/m^2": "m⁻²", "J/m^2": "J/m²", "1": ""}
#: Parameters that are no inputs of a user, or of a shape of a test.
OF_TESTS = ("table_unit", "steepness")


def rows(head: str, page: str = PAGE) -> list[list[str]]:
    """Cells of the tables whose first line begins with `head`, as "value | name"."""
    tables = re.findall(rf"^\| {re.escape(head)}.*\n\|[-|]+\|\n((?:\|.*\n)+)", page, flags=re.MULTILINE)
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in "".join(tables).splitlines()]


@pytest.mark.parametrize("page", [page for page, blocks in MODEL.items() if blocks])
def test_python_of_the_pages_prints_what_stands_there(page, tmp_path):
    assert len(pages.examples(page)) == MODEL[page] and all(text for _, text in pages.examples(page))
    pages.check_examples(page, tmp_path)


def headings(text: str) -> dict[str, str]:
    """The headings of a page below its title, and the text below each."""
    _, *parts = re.split(r"^##+ (.*)$", text, flags=re.MULTILINE)
    return dict(zip(parts[::2], parts[1::2], strict=True))


def test_each_heading_of_the_contents_leads_to_the_page_that_has_it():
    """A message that names docs/model.md with a heading is two steps from the text. Limits stand there themselves."""
    contents = headings(pages.read(CONTENTS))
    assert len(contents) == 14 and contents.pop("Limits").count("\n- ") > 8
    assert {page_of(heading, text) for heading, text in contents.items()} == set(MODEL)


def page_of(heading: str, text: str) -> str:
    """The page to which the text below a heading leads, and which has this heading itself."""
    (target,) = re.findall(r"\]\((\w+\.md#[\w-]+)\)$", text.rstrip())
    page, _, anchor = target.partition("#")
    assert anchor == heading.lower().replace(" ", "-")
    assert re.search(rf"^#+ {heading}$", pages.read(f"docs/{page}"), flags=re.MULTILINE), heading
    return f"docs/{page}"


def test_the_headings_of_the_equations_of_stresses_lead_to_them():
    contents = headings(pages.read("docs/stresses.md"))
    for heading in ("Transfer", "Waves", "Near the surface", "Sliding"):
        assert page_of(heading, contents[heading]) == "docs/stress_fields.md"


@pytest.mark.parametrize("page", [CONTENTS, *MODEL])
def test_no_page_of_the_model_is_long(page):
    assert len(pages.read(page).split()) <= 3500


@pytest.mark.parametrize(
    ("page", "roles"),
    [
        ("docs/symbols.md", ROLES),
        ("docs/shapes.md", ("shape",)),
        ("docs/adhesion.md", ("adhesion", "pull_off")),
    ],
)
def test_every_name_is_in_a_table_of_symbols_with_its_unit(page, roles):
    listed = {name: row for row in rows("symbol", pages.read(page)) for name in re.findall(r"`(\w+)`", row[1])}
    entries = {name: entry for name, entry in VOCABULARY.items() if entry.role in roles and name not in OF_TESTS}
    assert set(listed) == set(entries) | ({"x"} if page == "docs/symbols.md" else set())
    for name, entry in entries.items():
        *_, scale, physical = listed[name]
        plain = scale.strip("$").replace("^\\ast", "*").replace("E_2", "E2").replace("{-2}", "-2")
        assert plain == entry.scale, name
        assert physical == PRINTED.get(entry.unit, entry.unit), name


def test_every_number_of_an_equation_of_the_vocabulary_is_on_the_page():
    named = {number for entry in VOCABULARY.values() for number in re.findall(r"\((\d+)\)", entry.equation)}
    assert named and {f"({number})" for number in named} <= set(re.findall(r"\\qquad (\(\d+\))", PAGE))


def test_the_statuses_are_those_of_the_solver():
    table = {int(value): (name.strip("`"), meaning) for value, name, meaning in rows("value | name | meaning")}
    assert {value: name for value, (name, _) in table.items()} == status_words()
    for status in Status:
        assert table[status][1] == status.meaning


def test_the_models_are_those_of_the_solver():
    table = {int(value): name.strip("`") for value, name, _ in rows("value | name | model")}
    assert table == {int(model): model.name.lower() for model in Model}


def test_the_masks_and_thresholds_are_those_of_the_code():
    table = {(int(mask), name.strip("`")) for mask, name, *_ in rows("mask")}
    assert table == set(derived.ASSUMPTIONS.items())
    text = "\n".join(row[2] for row in rows("mask"))
    thresholds = re.findall(r"[<>] ([\d.]+)", text)
    constants = (
        "NOT_THIN",
        "FEW_SPOTS",
        "SPOT_OVER_LAYER",
        "MERGING",
        "STEEP",
        "COMPRESSED",
        "COMPRESSED",
        "STRETCHED",
        "STEEP_SPOT",
        "PITCH_OVER_LAYER",
        "STEEP",
        "SLOPE",
        "ZONE",
    )
    assert [float(value) for value in thresholds] == [getattr(derived, name) for name in constants]


def test_defaults_of_the_table_are_those_of_the_solver():
    default = {name: PACKAGE.parameter(name).default for name in VOCABULARY}
    assert [default[name] for name in ("nu1", "nu2", "rtol", "accuracy")] == [0.3, 0.3, 1e-6, 0.01]
    for name in ("bonding", "base", "micro", "scheme", "model_check"):
        described = next(row[2] for row in rows("symbol") if f"`{name}`" in row[1])
        assert f"`{default[name]}` (default)" in described
        assert set(PACKAGE.parameter(name).choices) <= set(re.findall(r"`(\w+)`", described))


@pytest.mark.parametrize("n", [0.1, 0.5, 3.0])
def test_series_of_the_kernels(n):
    u = 2e-3
    free = layered_kernel(u, n, 0.3, 0.3, False).L - (n + u / 2)
    np.testing.assert_allclose(free / u**3, -(n**2) / 6, rtol=0.02, atol=0)
    rubber = layered_kernel(u, n, 0.5, 0.5, True).L - n
    np.testing.assert_allclose(rubber / u**3, 2 / 3 * (1 - n**2), rtol=0.02, atol=0)


def test_alike_materials_are_no_layer():
    assert np.all(np.abs(layered_kernel([0.1, 1.0, 10.0], 1.0, 0.3, 0.3, True).L1) < 1e-14)


def test_no_numbers_is_nan_everywhere_but_in_what_was_given():
    found = solve(Problem.of(P=1e-5, h=0.02, n=2.0, bonding="bonded", base="thin_layer", micro="smooth"))
    assert found.status == Status.THIN_LAYER_NOT_APPLICABLE and found.P == 1e-5
    assert np.isnan([found.a, found.D, found.p0, found.error, found.model_error]).all()


def test_a_smooth_punch_on_a_layer_feels_a_modulus_whatever_its_shape():
    contact = study.solve(a=[0.01, 0.0101], h=0.02, n=0.5, micro="smooth", rtol=1e-9)
    secant = float(contact.P.diff("a").item() / contact.D.diff("a").item())
    assert secant / (2 * 0.01005) == pytest.approx(derived.effective_modulus(contact).mean().item(), rel=1e-4)
