"""The page of the explorer in chromium, opened from disk; for tests of it."""

import shutil

import pytest

from study.explorer.page import page as text_of_page

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
#: A script: of the address of a contact what the page then shows.
SHOWN = """async (hash) => {
  const before = location.hash;
  location.hash = hash;
  if (location.hash !== before) await new Promise((done) => addEventListener("hashchange", done, { once: true }));
  for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame);
  const all = (query, of) => [...document.querySelectorAll(query)].map(of);
  return { trouble: document.querySelector("#trouble").textContent, time: document.querySelector("#time").textContent,
    results: all("[data-result]", (cell) => [cell.dataset.result, cell.textContent]),
    beyond: all("#lights [data-state=beyond]", (row) => row.dataset.name),
    command: document.querySelector("#copied").textContent };
}"""


@pytest.fixture(scope="module")
def explorer(tmp_path_factory):
    """The page, opened from disk. That it asks for nothing and raises nothing is looked at in the end."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed (make explorer-test)")
    if CHROMIUM is None:
        pytest.skip("chromium is not installed (make explorer-test)")
    path = tmp_path_factory.mktemp("explorer") / "contact.html"
    path.write_text(text_of_page(), encoding="utf-8")
    requests, errors = [], []
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        tab = browser.new_page(viewport={"width": 1400, "height": 900})
        tab.on("request", lambda request: requests.append(request.url))
        tab.on("pageerror", lambda error: errors.append(str(error)))
        tab.set_default_timeout(20_000)
        tab.goto(path.as_uri())
        yield tab
        browser.close()
    assert [url for url in requests if url != path.as_uri()] == []
    assert errors == []
