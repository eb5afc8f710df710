"""The site of the documentation, where Sphinx is installed (`make docs`): no warning, no dead link, no request."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

import pytest
from conftest import ROOT

import roughcoat
import solver

sphinx = pytest.importorskip("sphinx", reason="make docs installs Sphinx")
pytest.importorskip("sphinx_gallery", reason="make docs installs it")
SCHEME = re.compile(r"[a-z]+:|//")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FORMULAS = (
    "async () => { if (window.MathJax?.startup) await MathJax.startup.promise; return ["
    + ", ".join(
        f"document.querySelectorAll('{what}').length"
        for what in ("mjx-container", "[data-mml-node=merror], mjx-merror")
    )
    + "]; }"
)


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The built site. Pictures of the gallery are those of its scripts, which have tests of their own: it runs none."""
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "-n", "-c", "docs/site", "-D", "plot_gallery=0"]
    command += ["-d", str(folder / "doctrees"), "docs", str(folder / "html")]
    done = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(ROOT)}, timeout=300
    )
    assert done.returncode == 0, done.stderr
    return folder / "html"


def test_every_public_name_has_a_page(site):
    names = [f"{package.__name__}.{name}" for package in (roughcoat, solver) for name in package.__all__]
    text = (site / "reference/names.html").read_text(encoding="utf-8")
    for name in names:
        assert (site / f"reference/{name}.html").exists() and f'href="{name}.html"' in text, name
    assert 'id="roughcoat.solve"' in (site / "reference/roughcoat.solve.html").read_text(encoding="utf-8")


def test_every_page_lists_its_neighbours(site):
    """The left sidebar has the pages of the group that the bar names; only the start and the search have none."""
    without = set()
    for path in site.rglob("*.html"):
        text = path.read_text(encoding="utf-8")
        sidebar = re.search(r'<nav class="[^"]*\bbd-links\b.*?</nav>', text, flags=re.DOTALL)
        if '<article class="bd-article"' in text and not (sidebar and "<a " in sidebar[0]):
            without.add(path.relative_to(site).as_posix())
    assert without <= {"index.html", "search.html", "genindex.html", "py-modindex.html"}


def test_no_link_is_dead(site):
    pages = {path: path.read_text(encoding="utf-8") for path in site.rglob("*.html") if path.name != "contact.html"}
    anchors = {path: set(re.findall(r'\b(?:id|name)="([^"]+)"', text)) for path, text in pages.items()}
    dead = []
    for path, text in pages.items():
        for link in re.findall(r'<a\b[^>]*\bhref="([^"]+)"', text):
            if SCHEME.match(link):
                continue
            file, _, anchor = unquote(link).partition("#")
            target = (path.parent / file).resolve() if file else path
            if not target.exists() or (anchor and target in anchors and anchor not in anchors[target]):
                dead.append(f"{path.relative_to(site)}: {link}")
    assert len(pages) > 60 and dead == []


def test_nothing_is_loaded_from_elsewhere(site):
    for path in site.rglob("*.html"):
        text = path.read_text(encoding="utf-8")
        loaded = re.findall(r'<(?:script|img|iframe|source)\b[^>]*\bsrc="([^"]+)"', text)
        loaded += re.findall(r'<link\b[^>]*\brel="(?:stylesheet|preload|icon)"[^>]*\bhref="([^"]+)"', text)
        assert [link for link in loaded if SCHEME.match(link) and not link.startswith("data:")] == [], path.name
    assert (site / "_static/contact.html").stat().st_size > 100_000 and (site / "_static/tex-svg.js").exists()


def test_pages_of_the_code_say_what_it_has(site):
    statuses = (site / "reference/statuses.html").read_text(encoding="utf-8")
    assert all(status.name.lower() in statuses for status in solver.Status)
    validity = (site / "reference/validity.html").read_text(encoding="utf-8")
    assert all(name in validity for name in ("layer_not_thin", "body_yields", "asperities_yield"))
    commands = (site / "reference/command_line.html").read_text(encoding="utf-8")
    assert all(f'id="{name}"' in commands for name in ("point", "explore", "scan", "materials", "docs", "table"))
    assert "study_digest" in (site / "reference/file_format.html").read_text(encoding="utf-8")


@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed (make explorer-test)")
def test_a_browser_without_a_network_shows_every_page_and_formula(site):
    """It asks for files of the site alone, raises nothing, and sets each formula without an error."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed (make explorer-test)")
    asked, trouble, formulas = [], [], 0
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        tab = browser.new_page()
        tab.context.set_offline(True)
        tab.on("request", lambda request: asked.append(request.url))
        tab.on("requestfailed", lambda request: trouble.append(f"{request.url}: {request.failure}"))
        tab.on("pageerror", lambda error: trouble.append(f"{tab.url}: {error}"))
        template = site / "_static/webpack-macros.html"  # of the theme, no page
        for path in sorted(set(site.rglob("*.html")) - {template}):
            tab.goto(path.as_uri())
            shown, wrong = tab.evaluate(FORMULAS)
            formulas += shown
            trouble += [f"{path.name}: {wrong} formulas"] if wrong else []
        browser.close()
    elsewhere = [url for url in asked if not url.startswith((site.as_uri(), "data:", "blob:"))]
    assert elsewhere == [] and trouble == [] and formulas > 300


@pytest.fixture
def tab(site):
    """A tab of a browser that has no network."""
    if CHROMIUM is None:
        pytest.skip("chromium is not installed (make explorer-test)")
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed (make explorer-test)")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page()
        page.context.set_offline(True)
        yield page
        browser.close()


def test_a_search_from_disk_quotes_the_pages(site, tab):
    tab.goto((site / "search.html").as_uri() + "?q=hardness")
    tab.wait_for_selector("#search-results p.context")
    quoted = tab.evaluate("[...document.querySelectorAll('#search-results p.context')].map(e => e.innerText)")
    assert len(quoted) > 5 and all("hard" in text.lower() for text in quoted)  # Sphinx looks for the stem


@pytest.mark.parametrize("width", [360, 800, 1400])
def test_pages_fit_a_phone_a_tablet_and_a_desk(site, tab, width):
    """A page does not scroll sideways, and neither do its commands and answers; Python, formulas and tables may."""
    tab.set_viewport_size({"width": width, "height": 900})
    wide = """[document.documentElement.scrollWidth, ...[...document.querySelectorAll(
      '.highlight-sh pre, .highlight-text pre, .highlight-toml pre, .highlight-default pre')].map(
      e => e.scrollWidth - e.clientWidth)]"""
    pages = [*site.glob("*.html"), site / "examples/index.html", *(site / "reference").glob("[!rs]*.html")]
    too_wide = []
    for page in sorted(pages):
        tab.goto(page.as_uri())
        whole, *beyond = tab.evaluate(wide)
        too_wide += [page.name] if whole > width or max(beyond, default=0) > 0 else []
    assert len(pages) > 50 and too_wide == []
