"""README and docs: what stands in a block runs, commands and links exist, numbers are those of the code."""

import re
import shlex
import tomllib

import pages
import pytest
import xarray as xr
from benchmark_page import PAGE
from conftest import ROOT
from test_repository import TARGETS
from validate_page import texts as resolved

import roughcoat
import solver
import study
from study import open_results
from study.__main__ import main, parser
from study.inputs.reading import from_tables, read

TEXT = {page: pages.read(page) for page in pages.PAGES}


def anchors(text: str) -> set[str]:
    """Of the headings of a page, as GitHub makes them."""
    heads = re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.DOTALL), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


def test_the_readme_is_short():
    """It is a door: what explains and derives is in docs/."""
    assert len(TEXT["README.md"].splitlines()) <= 130


def test_the_readme_shows_the_first_command_of_two_minutes():
    """That page is compared with what its commands print."""
    shown = re.compile(r"^```sh\nroughcoat ([^\n]*)\n```\n\n```text\n(.*?)^```", re.MULTILINE | re.DOTALL)
    assert shown.findall(TEXT["README.md"]) == shown.findall(TEXT["docs/two_minutes.md"])[:1] != []


def test_the_page_of_speeds_is_that_of_its_command():
    """Its text stands in the benchmark, so that `make speed` loses nothing."""
    pattern = ".+?".join(re.escape(piece) for piece in re.split(r"\{\w+\}", PAGE))
    assert pattern.count(".+?") > 10 and re.fullmatch(pattern, TEXT["docs/speed.md"], re.DOTALL)


def test_the_pages_of_resolved_spheres_are_those_of_their_numbers():
    """What `make validate` has solved, which takes minutes, is in docs/validate.nc; both pages are written of it."""
    with xr.open_datatree(ROOT / "docs/validate.nc") as tree:
        written = resolved({name: tree[name].to_dataset().load() for name in tree.children})
    assert [*written] == ["validate", "validate_limits"]
    for name, text in written.items():
        assert pages.same(text.split(), TEXT[f"docs/{name}.md"].split()), name


@pytest.mark.parametrize(
    ("printed", "expected", "alike"),
    [
        ("12", "12", True),
        ("12", "13", False),  # a count
        ("12345", "12346", False),
        ("-12", "12", False),
        ("6e-11", "3e-10", False),
        ("3e-10", "4e-10", False),
        ("5.1", "5.2", False),  # two percent
        ("0.999", "1.00", False),
        ("1.37", "1.38", False),
        ("0.19714", "0.19715", True),
        ("0.19714", "0.19716", False),
        ("3.4504e-05", "3.4505e-05", True),
        ("3.4504e-05", "3.4504e-04", False),
        ("9.999e-05", "1.000e-04", True),
        ("0.1971", "0.19714", False),  # of other digits
        ("nan", "nan", True),
        ("nan", "0.19714", False),
        ("inf", "0.19714", False),
        ("word", "0.19714", False),
        ("-0.0001", "0.0000", False),
    ],
)
def test_when_words_of_a_page_are_the_same(printed, expected, alike):
    assert pages.same([printed], [expected]) == pages.same([expected], [printed]) == alike
    assert not pages.same([printed], [expected, expected])


@pytest.mark.parametrize("page", pages.PAGES)
def test_links_lead_somewhere(page):
    words = re.sub(r"```.*?```|\$[^$]*\$|`[^`]*`", "", TEXT[page], flags=re.DOTALL)
    for path, anchor in re.findall(r"\]\((?!https?:)([^)#]*)#?([^)]*)\)", words):
        target = (ROOT / page).parent / path if path else ROOT / page
        assert target.exists(), path
        if anchor:
            assert anchor in anchors(target.read_text(encoding="utf-8")), f"{path}#{anchor}"


@pytest.mark.parametrize("page", pages.PAGES)
def test_what_a_page_names_exists(page):
    text = re.sub(r"```(?!sh).*?```", "", TEXT[page], flags=re.DOTALL)
    code = "\n".join(re.findall(r"```.*?```|`[^`]+`", text, re.DOTALL))
    assert set(re.findall(r"\bmake ([a-z0-9_-]+)\b", code)) <= set(TARGETS)
    files = re.findall(r"`((?:studies|study|solver|tests)/[\w/]+\.(?:py|toml|csv))`", text)
    for path in set(files) - {"studies/mine.toml", "studies/figures.py"}:
        assert (ROOT / path).exists(), path
    for package, names in re.findall(r"`(rc|study|solver|derived)((?:\.[a-z_]\w*)+)", code):
        found = {"rc": roughcoat, "study": study, "solver": solver, "derived": study.derived}[package]
        for name in names.strip(".").split("."):
            found = getattr(found, name)


#: Pages that nobody reads from top to bottom.
REFERENCES = {"docs/changelog.md", "CHANGELOG.md", "docs/literature.md", "docs/materials_table.md", "docs/symbols.md"}


@pytest.mark.parametrize("page", sorted(set(pages.PAGES) - REFERENCES))
def test_a_page_has_at_most_3500_words(page):
    assert len(TEXT[page].split()) <= 3500


@pytest.mark.parametrize("package", [roughcoat, solver])
def test_the_page_of_python_has_every_public_name(package):
    shown = re.findall(
        r"`(?:rc|solver)\.(\w+)`", TEXT["docs/python.md"].partition("## The solver")[2 * (package is solver)]
    )
    assert {*shown} == {*package.__all__} | ({"__version__"} if package is roughcoat else set())


@pytest.mark.parametrize("page", ["README.md", "docs/studies.md", "docs/large_runs.md"])
def test_commands_parse(page):
    found = [line for block in pages.blocks(page, "sh") for line in block.splitlines()]
    found += re.findall(r"`((?:python -m )?roughcoat [^`]+)`", TEXT[page])
    calls = [re.match(r"(?:.*-m )?roughcoat (.*)", line) for line in found]
    commands = [shlex.split(call[1]) for call in calls if call]
    commands += [line.split() for line in re.findall(r"`((?:run|status|retry|clean) mine[^`|]*)`", TEXT[page])]
    assert len(commands) >= 3
    for command in commands:
        parser().parse_args(["tcp://127.0.0.1:8786" if word == "ADDRESS" else word for word in command])


@pytest.mark.parametrize(
    ("page", "sizes"),
    [
        ("README.md", {"bonding": 2, "h": 2, "n": 9, "P": 21}),
        ("docs/studies.md", {"bonding": 2, "h": 2, "n": 9, "P": 21}),
        ("docs/stacks.md", {"layers.2.h in SI": 3}),
    ],
)
def test_study_files_are_valid(page, sizes):
    definitions = [from_tables(tomllib.loads(text), "mine", text, page) for text in pages.blocks(page, "toml")]
    assert dict(definitions[0].grid.sizes) == sizes


def test_the_table_of_real_systems_has_their_numbers_of_cases():
    rows = re.findall(r"^\| `(\w+)` \| [^|]* \| (\d+) \|$", TEXT["docs/studies.md"], flags=re.MULTILINE)
    assert len(rows) == 9
    for name, cases in rows:
        assert read(ROOT / f"studies/systems/{name}.toml").grid.size == int(cases)


RUN = (
    "README.md",
    *(f"docs/{name}.md" for name in ("accuracy", "python", "shapes", "adhesion", "stacks", "fit", "afm")),
    "docs/other_programs.md",
    "docs/time.md",
    "docs/sobol.md",
)


@pytest.mark.parametrize("page", RUN)
def test_python_prints_what_stands_there(page, tmp_path):
    pages.check_examples(page, tmp_path)


def test_python_of_the_studies_runs(results):
    pages.check_examples("docs/studies.md", results.parent)
    assert (results.parent / "coating.png").stat().st_size > 5000


def test_table1_of_the_page_is_what_make_prints(tmp_path):
    folders = "--results", str(tmp_path / "results"), "--tables", str(tmp_path)
    assert main(["table", "table1", *folders]) == 0
    made = (tmp_path / "table1.txt").read_text(encoding="utf-8")
    (shown,) = re.findall(
        r"^`make table1`[^\n]*\n\n```text\n(.*?)^```", TEXT["docs/accuracy.md"], re.DOTALL | re.MULTILINE
    )
    assert shown in made


def test_of_softness_and_thickness(results):
    contacts = open_results(results / "parameter_map.nc")
    chosen = contacts.where(contacts.validity == 0).sel(Nbar=250000, Ra=0.002).sel(P=1e-5, method="nearest").p_max
    assert (chosen.min("h") / chosen.max("h") > 0.8).all()
    assert (chosen.min("n") / chosen.max("n") < 0.3).all()
    fall = 1 - chosen.isel(h=-1) / chosen.isel(h=0)
    assert (fall.sel(bonding="frictionless") < fall.sel(bonding="bonded")).all()


def test_of_the_thin_layer_in_the_main_case(results):
    cases = open_results(results / "main_case.nc").set_index(case="label")
    exact, thin = (cases.sel(case=f"rough, {base}") for base in ("exact layer", "layered"))
    a, p0, D = (100 * (float(thin[name] / exact[name]) - 1) for name in ("a", "p0", "D"))
    assert f"{a:.1f} % too wide, p(0) {-p0:.1f} % too low and D {D:.1f} % too" in TEXT["docs/accuracy.md"]


def microseconds(text: str, head: str, row: str, between: str) -> dict[float, float]:
    """The last columns of one row of a table, by the error in its head."""
    found = [re.search(rf"^{start}.*$", text, flags=re.MULTILINE)[0] for start in (head, row)]
    errors, times = (re.split(between, line.strip(" |")) for line in found)
    units = {"": 1.0, "µs": 1.0, "ms": 1e3}
    pairs = [(error, *time.partition(" ")) for error, time in zip(errors, times, strict=True)]
    return {float(error): float(number) * units[unit] for error, number, _, unit in pairs if re.match(r"[\d.]", error)}


@pytest.mark.parametrize(("ours", "measured"), [("the paper's layer", "paper, layer"), ("coatings", "coatings")])
def test_times_are_those_of_tradeoff(ours, measured):
    """To the two digits that are shown."""
    page = (ROOT / "docs/tradeoff_measured.txt").read_text(encoding="utf-8")
    found = microseconds(TEXT["docs/accuracy.md"], r"\| processor time", rf"\| {ours}", r" \| ")
    known = microseconds(page, "set  ", rf"{measured} +newton, rtol", " {2,}")
    assert found == {error: float(f"{known[error]:.2g}") for error in (1e-3, 1e-6, 1e-9)}
