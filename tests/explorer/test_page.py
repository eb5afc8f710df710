"""The page in chromium: digits that it shows are those of `roughcoat point --json`, and its copies are that contact."""

import contextlib
import io
import json
import re
import shlex
import tomllib
from urllib.parse import quote

import numpy as np
import pytest
from explorer_page import SHOWN

import roughcoat
from study.__main__ import main
from study.specimen import materials

SIZES = {
    "km": 1e3, "m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9, "kN": 1e3, "N": 1.0, "mN": 1e-3, "µN": 1e-6, "nN": 1e-9,
    "GPa": 1e9, "MPa": 1e6, "kPa": 1e3, "Pa": 1.0, "MN/m": 1e6, "kN/m": 1e3, "N/m": 1.0, "mN/m": 1e-3, "": 1.0,
}  # fmt: skip
#: Masks that the page looks at; the others are of thin layers, cups and strengths, which it does not have.
LOOKED_AT = {"few_spots", "spots_merging", "strain_not_small", "asperity_strain_not_small"}


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


def test_each_digit_is_that_of_the_command(explorer, monkeypatch):
    """Within 0.5 of the last digit by rounding, and what the page's own error adds near the middle of two digits. The
    ± of what the page does not show takes five sixths of the time of the command, and is left out."""
    monkeypatch.setattr("study.commands.point._spreads_of_derived", lambda contact: {})
    solved, away, times, other = 0, [], [], 0
    for case in contacts(260):
        hash_ = "&".join(f"{name}={quote(text)}" for name, text in case.items())
        shown = explorer.evaluate(SHOWN, hash_)
        answer = of_python(shown["command"])
        if shown["trouble"]:
            elsewhere = (
                "1/256" in shown["trouble"]
                or answer.get("asperities_used") == "layer"
                and "farther apart" in shown["trouble"]
            )
            assert elsewhere or answer["status"] != "converged", (case, shown["trouble"])
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
def test_copies_are_the_same_contact(explorer, form, tmp_path):
    """README's contact, one that has only what must be given, one with strengths: the digits are those of the page."""
    for hash_ in (
        "R=10 mm&E_punch=210 GPa&nu_punch=0.3&E1=200 ± 20 GPa&nu1=0.2&h=2.0 ± 0.1 um&bonding=bonded&E2=210 GPa&nu2=0.3"
        "&P=10 N&micro=disc_cell&Nbar=2 1/um^2&Ra=10 um",
        "R=1 mm&punch=rigid&base=half_space&body=PTFE&D=3 um&micro=smooth",
        "R=5 mm&E_punch=207 GPa&nu_punch=0.29&Y_punch=2.8 GPa&layer=TiN&h=3 um&E2=70 ± 2 GPa&nu2=0.33"
        "&Y2=300 MPa&a=80 um",
    ):
        explorer.check("input[value=command]", force=True)
        answer = of_python(explorer.evaluate(SHOWN, quote(hash_, safe="=&"))["command"])
        explorer.check(f"input[value={form}]", force=True)
        shown = explorer.evaluate(SHOWN, quote(hash_, safe="=&"))
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
    explorer.check("input[value=command]", force=True)


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
def test_the_copy_for_stresses_runs(explorer, tmp_path, monkeypatch):
    """Of a bare body; the largest stresses, and a picture of them."""
    monkeypatch.chdir(tmp_path)
    explorer.check("input[value=stresses]", force=True)
    text = explorer.evaluate(SHOWN, quote("R=1 mm&punch=rigid&base=half_space&body=PTFE&P=1 N", safe="=&"))["command"]
    names = {}
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(text, names)
    assert "mises2" in printed.getvalue() and (tmp_path / "stresses.png").stat().st_size > 10_000
    explorer.check("input[value=command]", force=True)
