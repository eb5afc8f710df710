"""The page in chromium: the digits that it shows are those of `roughcoat point --json`, and it needs nothing else."""

import contextlib
import io
import json
import re
import shlex
import shutil
import tomllib
from urllib.parse import quote

import numpy as np
import pytest

import roughcoat
from study.__main__ import main
from study.explorer.page import page as text_of_page
from study.specimen import materials

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SIZES = {
    "km": 1e3, "m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9, "kN": 1e3, "N": 1.0, "mN": 1e-3, "µN": 1e-6, "nN": 1e-9,
    "GPa": 1e9, "MPa": 1e6, "kPa": 1e3, "Pa": 1.0, "MN/m": 1e6, "kN/m": 1e3, "N/m": 1.0, "mN/m": 1e-3, "": 1.0,
}  # fmt: skip
#: Masks that the page looks at; the others are of thin layers, cups and strengths, which it does not have.
LOOKED_AT = {"few_spots", "spot_not_small_against_h", "spots_merging", "strain_not_small"}
LOOKED_AT |= {"asperity_strain_not_small", "pitch_not_small_against_h"}
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

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed (make explorer-test)")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed (make explorer-test)")


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page, opened from disk. That it asks for nothing and raises nothing is looked at in the end."""
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


def contacts(many: int) -> list[dict[str, str]]:
    """Random contacts as texts, with materials and without, of all controls, smooth and rough."""
    random, found = np.random.default_rng(46), []
    hard = [name for name in materials.names() if materials.get(name).E > 1e9]

    def text(low, high, unit):
        return f"{np.exp(random.uniform(np.log(low), np.log(high))):.3g} {unit}"

    for _ in range(many):
        case = {"R": text(0.5, 50, "mm"), "punch": str(random.choice([*hard, "rigid"]))}
        if random.random() < 0.8:
            case |= {"h": text(1, 500, "um"), "bonding": str(random.choice(["bonded", "frictionless"]))}
            own = {"E1": f"{text(1, 400, '')}± 5 % GPa", "nu1": f"{random.uniform(0.1, 0.49):.2f} ± 0.02"}
            case |= own if random.random() < 0.5 else {"layer": str(random.choice(materials.names()))}
        else:
            case["base"] = "half_space"
        case["body"] = str(random.choice(hard))
        control = str(random.choice(["P", "a", "D"]))
        case[control] = {"P": text(0.5, 100, "N"), "a": text(20, 300, "um"), "D": text(0.3, 10, "um")}[control]
        case["micro"] = str(random.choice(["smooth", "disc_cell"]))
        if case["micro"] == "disc_cell":
            case |= {"Nbar": text(0.01, 5, "1/um^2"), "Ra": text(1, 100, "um")}
        found.append(case)
    return found


def of_python(command: str) -> dict:
    """What the copied command answers with --json, in this process."""
    words = shlex.split(command)
    assert words[:2] == ["roughcoat", "point"]
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        main(["point", "--json", *words[2:]])
    return json.loads(printed.getvalue())


def misses(shown: str, value: float, spread: float) -> list[float]:
    """By how many units of the last digit the number and its ± are away from those of the program."""
    number, more, unit = re.fullmatch(r"([\d.e+-]+)(?: ± ([\d.e+-]+))? ?(\S*)", shown).groups()
    last = 10.0 ** -len(number.partition(".")[2]) * SIZES[unit]
    if "." not in number and number.endswith("0"):  # 4230 may have three digits
        last = 10.0 ** (len(number) - len(number.rstrip("0"))) * SIZES[unit]
    pairs = [(number, value), (more, spread)] if more else [(number, value)]
    return [abs(float(text) * SIZES[unit] - wanted) / last for text, wanted in pairs]


def test_each_digit_is_that_of_the_command(page, monkeypatch):
    """Within 0.5 of the last digit by rounding, and what the page's own error adds near the middle of two digits. The ± of
    what the page does not show takes five sixths of the time of the command, and is left out."""
    monkeypatch.setattr("study.commands.point._spreads_of_derived", lambda contact: {})
    solved, away, times, other = 0, [], [], 0
    for case in contacts(230):
        hash_ = "&".join(f"{name}={quote(text)}" for name, text in case.items())
        shown = page.evaluate(SHOWN, hash_)
        answer = of_python(shown["command"])
        if shown["trouble"]:
            assert "1/256" in shown["trouble"] or answer["status"] != "converged", (case, shown["trouble"])
            continue
        solved += 1
        assert answer["status"] == "converged", case
        for name, text in shown["results"]:
            own = answer[name]
            away += misses(text, own["value"], own.get("spread") or 0.0)
            assert away[-1] < 0.8 and away[-2 if "±" in text else -1] < 0.8, (case, name, text, own)
        other += {*shown["beyond"]} & LOOKED_AT != {*answer["validity"]} & LOOKED_AT
        assert ("metals_yield" in shown["beyond"]) == any("metals yield" in one for one in answer["beware"]), case
        times.append(float(re.search(r"(\d+) ms", shown["time"])[1]))
    same = np.mean(np.array(away) <= 0.5001)
    print(f"\n{solved} contacts, {len(away)} numbers, {same:.2%} with the digits of the program", end="; ")
    print(f"redraw {np.median(times):.0f} ms (median; wanted below 16 on an idle machine)")
    assert solved >= 200
    assert same > 0.98
    assert other <= 2, "an assumption is judged alike but within 1e-4 of its limit"


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
@pytest.mark.parametrize("form", ["python", "toml"])
def test_copies_are_the_same_contact(page, form, tmp_path):
    """README's contact, one that has only what must be given, and one with strengths: the digits are those of the page."""
    for hash_ in (
        "R=10 mm&E_punch=210 GPa&nu_punch=0.3&E1=200 ± 20 GPa&nu1=0.2&h=2.0 ± 0.1 um&bonding=bonded&E2=210 GPa&nu2=0.3"
        "&P=10 N&micro=disc_cell&Nbar=2 1/um^2&Ra=10 um",
        "R=1 mm&punch=rigid&base=half_space&body=PTFE&D=3 um&micro=smooth",
        "R=5 mm&E_punch=207 GPa&nu_punch=0.29&Y_punch=2.8 GPa&layer=TiN&h=3 um&E2=70 ± 2 GPa&nu2=0.33&Y2=300 MPa&a=80 um",
    ):
        page.check("input[value=command]", force=True)
        answer = of_python(page.evaluate(SHOWN, quote(hash_, safe="=&"))["command"])
        page.check(f"input[value={form}]", force=True)
        shown = page.evaluate(SHOWN, quote(hash_, safe="=&"))
        text = shown["command"]
        if form == "python":
            names = {}
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                exec(text, names)
            contact = names["contact"]
            assert "Given:" in printed.getvalue()
        else:
            contact = roughcoat.solve(**tomllib.loads(text)["model"])
            (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
            assert main(["check", str(tmp_path / "mine.toml")]) == 0
        assert float(contact["a"]) == answer["a"]["value"]
        for name, digits in shown["results"]:
            spread = float(contact[f"{name}_spread"]) if f"{name}_spread" in contact else 0.0
            assert max(misses(digits, float(contact[name]), spread)) < 0.8, (hash_, name, digits)
    page.check("input[value=command]", force=True)


def test_a_new_user_is_answered_told_and_led(page):
    """The first screen is the answer; a wrong unit is told at its field; no layer, materials and the map serve."""
    page.evaluate(SHOWN, "")
    page.click("#restart")
    page.wait_for_function("document.querySelector('#words').textContent.includes('69.36 ± 0.32 µm')")
    page.fill("#in-P", "10 mm")
    page.wait_for_selector("#wrong-P:not([hidden])")
    assert "a force with its unit" in page.inner_text("#wrong-P")
    page.fill("#in-P", "20 N")
    page.select_option("#in-layer", "no layer")
    page.wait_for_function("location.hash.includes('base=half_space') && location.hash.includes('P=20%20N')")
    assert page.is_hidden("#in-h")
    assert page.inner_text("#numbers thead").split("\t")[-1].strip() == "smooth (Hertz)"
    page.select_option("#in-layer", "PTFE")
    page.wait_for_function("location.hash.includes('layer=PTFE')")
    page.wait_for_selector("#map[aria-busy=false]", timeout=120_000)
    before = page.evaluate("location.hash")
    page.focus("#map canvas")
    for key in ("ArrowRight", "ArrowUp", "Enter"):
        page.keyboard.press(key)
    page.wait_for_function("(before) => location.hash !== before", arg=before)
    bare = (
        "[...document.querySelectorAll('input, select')].filter((one) => !one.labels?.length && !one.ariaLabel).length"
    )
    assert page.evaluate(bare) == 0, "each input has a label for screen readers"


def test_a_map_of_the_contact_before_changes_nothing(page):
    """A click on it, while the next is not drawn, does not take its contact."""
    page.evaluate(SHOWN, "")
    page.click("#restart")
    page.wait_for_selector("#map[aria-busy=false]", timeout=120_000)
    hash_ = page.evaluate("""async () => {
      const input = document.querySelector("#in-P"), frame = () => new Promise(requestAnimationFrame);
      input.value = "20 N";
      input.dispatchEvent(new Event("input"));
      await frame(); await frame();
      const canvas = document.querySelector("#map canvas"), { left, top, width, height } = canvas.getBoundingClientRect();
      canvas.dispatchEvent(new MouseEvent("click", { clientX: left + width / 2, clientY: top + height / 3 }));
      await new Promise((done) => setTimeout(done, 400)); // the address follows
      return location.hash;
    }""")
    assert "P=20%20N" in hash_ and "h=2%20um" in hash_


def test_redraws_while_a_slider_moves(page):
    """The time is printed: wanted below 16 ms on an idle machine."""
    page.click("#restart")
    times = page.evaluate("""async () => {
      const slider = document.querySelector("[data-field=P] input[type=range]"), times = [];
      for (let i = 0; i < 60; i++) {
        slider.value = 600 + i;
        slider.dispatchEvent(new Event("input"));
        await new Promise(requestAnimationFrame);
        await new Promise(requestAnimationFrame);
        times.push(Number(/(\\d+) ms/.exec(document.querySelector("#time").textContent)[1]));
      }
      return times.sort((a, b) => a - b);
    }""")
    print(f"\nredraw of 60 places of a slider: {times[6]} ms in the fastest tenth, {times[30]} ms in the middle", end="; ")
    print(f"{times[-1]} ms at most (wanted below 16 on an idle machine)")
    assert page.input_value("#in-P") != "10 N"


def test_stresses_and_loads_of_first_yield_are_shown(page):
    page.evaluate(
        SHOWN, "R=5 mm&punch=steel 52100&layer=DLC a-C:H&h=20 um&body=steel carbon&P=100 N".replace(" ", "%20")
    )
    page.wait_for_selector("#stresses[aria-busy=false]")
    page.wait_for_function("document.querySelector('[data-load=body]').textContent.includes('mN')")
    table = page.inner_text("#strengths").splitlines()
    rows = {row.split("\t")[0]: dict(zip(table[0].split("\t")[1:], row.split("\t")[1:], strict=True)) for row in table[1:]}
    assert rows["share of it"]["body"] == "5.3 times" and rows["yield strength"]["body"] == "250 MPa"
    assert rows["yields from P ="]["layer"].startswith("above ")
    assert "looked for up to a = 0.2 R" in page.inner_text("#stress-note")
    assert "the body is nearest to its limit: it bears 5.3 times its yield strength" in page.inner_text("#verdict")
    page.select_option("#in-body", "own E and ν")
    page.fill("#in-Y2", "2.5 GPa")
    page.wait_for_function("document.querySelector('#verdict').textContent.includes('53 %')")
    assert "Y2=2.5%20GPa" in page.evaluate("location.hash")
    film = "R=5 mm&punch=steel 52100&layer=DLC a-C:H&body=steel carbon&P=5 N".replace(" ", "%20")
    page.evaluate(SHOWN, f"{film}&h=400%20nm")
    page.wait_for_selector("#stresses[aria-busy=false]", state="attached")
    assert "At the edge" not in page.inner_text("#stress-note"), "the edge of layers thinner than a/64 takes too long"
    assert (
        "thinner than 1/256 of the contact radius (about 54.9 µm)"
        in page.evaluate(SHOWN, f"{film}&h=100%20nm")["trouble"]
    )


def test_a_phone_has_no_sideways_scrolling(page):
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.set_viewport_size({"width": 1400, "height": 900})
