"""Numbers of the page as texts, numbers.js, run by node: what is shown is the value, and what is read is its unit."""

import json
import re
import shutil
import subprocess

import numpy as np
import pytest
from conftest import ROOT

import study
from study.data.body_strengths import strengths
from study.data.contacts import Contacts
from study.explorer.page import contents
from study.specimen.quantities import READABLE, quantity

ROOM = ROOT / "study/explorer"
NODE = shutil.which("node")
#: 1e-6 to 1e6, with what rounding takes to another number of digits.
DIGITS = (1, 1.0049, 2.5, 4.996, 9.949, 9.951, 9.997)
VALUES = [float(f"{digits}e{power}") for power in range(-6, 7) for digits in DIGITS]
#: SI unit -> multiples in which it is written, those of the program.
UNITS = {unit: dict(READABLE[unit][1]) for unit in ("m", "N", "Pa", "1/m^2", "N/m", "1")}
#: A script: the texts of each value by each formatter, and of each value with each spread.
SHOW = """
const N = require(process.argv[1] + "/numbers.js");
const { values, spreads, units } = JSON.parse(require("fs").readFileSync(0));
const written = (v, spread) => units.map((unit) => [1, 2, 3, 4].map((digits) => N.written(v, unit, digits, spread)));
console.log(JSON.stringify({
  plain: values.map((v) => [N.short(v), N.percent(v), N.percent(-v), N.part(v), N.count(v)]),
  written: values.map((v) => written(v, 0)),
  spreads: spreads.map((by) => values.map((v) => written(v, by * v))),
  odd: [0, NaN, Infinity, -Infinity].map((v) => [N.short, N.percent, N.part, N.count].map((f) => f(v))),
  results: [0, NaN, Infinity, -Infinity].map((v) => N.readable(v, "Pa")),
}));
"""
READ = """
const { parse } = require(process.argv[1] + "/numbers.js");
console.log(JSON.stringify(JSON.parse(require("fs").readFileSync(0)).map(([unit, text]) => {
  try { return parse("x", unit, text); } catch (error) { return error.message; }
})));
"""
STRENGTHS = """
globalThis.DATA = JSON.parse(require("fs").readFileSync(0));
const [Contact, Strength] = ["contact", "strength"].map((name) => require(`${process.argv[1]}/${name}.js`));
const all = JSON.parse(process.argv[2]).map((texts) => Strength.strengths(Contact.solve(texts, true)));
console.log(JSON.stringify(all.map((strengths) => strengths.asperities)));
"""
DRAWN = """
const vm = require("vm"), fs = require("fs"), DATA = JSON.parse(fs.readFileSync(0));
const page = vm.createContext({ DATA, atob, slopes: JSON.parse(process.argv[2]) });
const read = (name) => fs.readFileSync(`${process.argv[1]}/${name}.js`, "utf-8");
vm.runInContext(["core", "numbers", "contact", "drawing"].map(read).join("\\n"), page);
console.log(JSON.stringify(vm.runInContext(`slopes.map((slope) => Drawing.tornado(
  { sensitivities: { h: { p0: slope, relative: 1 }, P: { p0: -slope, relative: 1 } } }, "p0", "spread", 800))`, page)));
"""

pytestmark = pytest.mark.skipif(NODE is None, reason="node is not installed (make explorer-test)")


def by_node(script: str, given, *words: str):
    command = [NODE, "-e", script, "--", str(ROOM), *words]
    done = subprocess.run(command, input=json.dumps(given), capture_output=True, text=True, check=True, timeout=60)
    return json.loads(done.stdout)


def is_written(text: str, value: float, digits: int) -> bool:
    """Whether a text is the value to so many digits, without a power of ten."""
    plain = re.fullmatch(r"-?\d+(\.\d+)?", text)
    return bool(plain) and abs(float(text) / value - 1) < 0.5001 * 10 ** (1 - digits) and significant(text) <= digits


def significant(text: str) -> int:
    """The digits of a text that count; zeros before the point are not counted."""
    whole, point, rest = text.replace("-", "").partition(".")
    return len((whole + rest).lstrip("0")) if point else len(whole.strip("0"))


@pytest.fixture(scope="module")
def shown():
    spreads = (0.002, 0.0996, 3.0)
    return spreads, by_node(SHOW, {"values": VALUES, "spreads": spreads, "units": list(UNITS)})


def test_shares_and_counts_are_plain_numbers(shown):
    """0.997 is 100 %, no 1.0e+2 and no 1 %."""
    for value, (short, percent, below, part, count) in zip(VALUES, shown[1]["plain"], strict=True):
        assert is_written(short, value, 2), (value, short)
        assert percent.endswith(" %") and is_written(percent.removesuffix(" %"), 100 * value, 2), (value, percent)
        assert below == f"-{percent}"
        assert is_written(count.replace(",", ""), value, 2), (value, count)
        number, _, word = part.partition(" ")
        assert word == ("times" if value >= 1 else "%"), (value, part)
        assert float(number) == pytest.approx(value if value >= 1 else 100 * value, rel=0.0501), (value, part)


def test_results_are_in_their_unit_with_their_digits(shown):
    """Of all units of the page; what is too small for the smallest multiple has a power of ten."""
    for value, units in zip(VALUES, shown[1]["written"], strict=True):
        for (unit, sizes), texts in zip(UNITS.items(), units, strict=True):
            for digits, own in enumerate(texts, 1):
                size = sizes[own["unit"]]
                assert own["whole"] == f"{own['text']} {own['unit']}".strip()
                if value / size > 2e-3:
                    assert is_written(own["text"], value / size, digits), (value, unit, own)
                    assert all(other <= size or other > float(own["text"]) * size for other in sizes.values()), own
                assert float(own["text"]) * size == pytest.approx(value, rel=0.501 * 10 ** (1 - digits)), (unit, own)


def test_a_spread_is_in_the_unit_of_its_number(shown):
    """Number and ± end at one place, with two digits of ± at most; what is below the last digit is left out."""
    spreads, answer = shown
    for by, rows in zip(spreads, answer["spreads"], strict=True):
        for value, units in zip(VALUES, rows, strict=True):
            for sizes, texts in zip(UNITS.values(), units, strict=True):
                own, size = texts[-1], sizes[texts[-1]["unit"]]
                number, more = own["text"].split(" ± ")
                last = 10.0 ** (np.floor(np.log10(by * value / size) + 1e-9) - 1)
                assert abs(float(more) * size - by * value) <= (0.5001 * last * size + 1e-3 * by * value), own
                assert abs(float(number) * size - value) <= 5.001 * last * size, own


def test_what_is_no_number_is_said(shown):
    words = ["unknown", "infinite", "minus infinite"]
    assert shown[1]["odd"] == [["0", "0 %", "0 %", "0"], *([word] * 4 for word in words)]
    assert shown[1]["results"] == ["0 Pa", *words]


def test_the_tornado_shows_how_much_a_result_changes():
    changes = [1e-5, 0.997, 0.9951, 1.5, 12.3, 1e6]
    for by, drawn in zip(changes, by_node(DRAWN, contents(), json.dumps(changes)), strict=True):
        label = re.search(r'aria-label="[^"]*: ([^"]*) %\."', drawn).group(1)
        numbers = [label, *re.findall(r">([^<]*) %<", drawn)]
        assert len(numbers) == 3 and all(is_written(number, 100 * by, 2) for number in numbers), (by, numbers)


#: Texts with ±: in the same unit, in another, in per cent.
QUANTITIES = [
    ("Pa", "200 ± 20 GPa"), ("Pa", "200 GPa ± 20000 MPa"), ("Pa", "0.2 TPa ± 20 GPa"), ("m", "2 um ± 100 nm"),
    ("m", "2 ± 0.1 µm"), ("m", "2 mm +/- 5 um"), ("m", "2 ± 5 % um"), ("m", "2 um ± 5 %"), ("N", "1 N ± 100 mN"),
    ("N", "3 kN +- 20 N"), ("1", "0.3 ± 0.02"), ("1", "0.3 ± 5 %"), ("1/m^2", "2 1/um² ± 3e5 1/mm^2"),
    ("m", "2 um ± 0.1"), ("m", "2 um ± 5 % um"), ("m", "2 um ± 3 N"), ("m", "2 um ± -1 um"),
]  # fmt: skip


def test_the_unit_of_a_spread_is_read_as_by_the_program():
    for (unit, text), own in zip(QUANTITIES, by_node(READ, QUANTITIES), strict=True):
        try:
            wanted = quantity("x", text, unit)
        except ValueError:
            assert isinstance(own, str), text
            continue
        assert own["value"] == pytest.approx(wanted.value, rel=1e-14), text
        assert own["spread"] == pytest.approx(wanted.spread, rel=1e-14), text


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
def test_asperities_have_the_strength_of_the_softer_surface():
    """Of punches on bodies, bare and coated, whichever is softer; where one is not known, as the program has it."""
    punches, bodies = ["steel 52100", "steel carbon", "PTFE", "copper", "rigid"], ["steel 52100", "PTFE", "copper"]
    given = {"R": "5 mm", "P": "1 N", "micro": "disc_cell", "Nbar": "1 1/um^2", "Ra": "5 um"}
    bare, coated = given | {"base": "half_space"}, given | {"h": "1 mm", "bonding": "bonded", "body": "silica"}
    texts, wanted = [], []
    for form, surface in ((bare, "body"), (coated, "layer")):
        texts += [form | {"punch": punch, surface: body} for punch in punches for body in bodies]
        contacts = study.solve(**form, punch=punches, **{surface: bodies}, x=2).transpose("punch", surface, ...)
        contacts = Contacts.of(contacts, "test")
        wanted += [*(strengths(contacts, {})["asperities"] * contacts.units[0])]
    shown = np.array(by_node(STRENGTHS, contents(), json.dumps(texts)), float)
    np.testing.assert_allclose(shown, wanted, rtol=1e-10)
    soft_punch = shown[texts.index(bare | {"punch": "steel carbon", "body": "steel 52100"})]
    assert soft_punch == 250e6
