"""The table of materials: complete, plausible, found by name; what a user's own file is told; the spread of E*."""

import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest

from study.specimen import materials
from study.specimen.materials.entries import STRENGTHS

ROOT = Path(__file__).resolve().parents[2]
#: What each class of materials lies between: E in Pa, nu. A unit slip or exchanged numbers fall outside.
CLASSES = {
    ("steel 52100", "steel M50", "steel M2", "steel 316L", "steel carbon"): (185e9, 220e9, 0.26, 0.32),
    ("aluminium 6061", "titanium Ti-6Al-4V", "copper", "brass"): (65e9, 135e9, 0.3, 0.37),
    ("glass soda-lime", "glass borosilicate", "silica"): (60e9, 76e9, 0.15, 0.25),
    ("silicon", "zirconia", "silicon nitride", "alumina", "sapphire"): (150e9, 470e9, 0.2, 0.32),
    ("WC-Co", "diamond"): (550e9, 1200e9, 0.05, 0.25),
    ("DLC ta-C", "DLC a-C:H", "TiN", "CrN", "chromium"): (100e9, 800e9, 0.1, 0.32),
    ("PTFE", "PEEK", "PMMA", "polycarbonate", "polyimide"): (0.3e9, 5e9, 0.3, 0.49),
    ("polyurethane", "PDMS", "natural rubber"): (0.5e6, 30e6, 0.49, 0.5),
    ("polyacrylamide gel", "agarose gel", "gelatin gel"): (1e3, 300e3, 0.46, 0.5),
    ("cartilage",): (0.3e6, 2e6, 0, 0.1),
}
STEEL = '["my steel"]\nE = 210e9\nnu = 0.3\nE_spread = 5e9\nnu_spread = 0.01\n'


@pytest.fixture
def mine(tmp_path):
    """Write a file of materials; gives its path."""

    def write(text: str | bytes) -> Path:
        path = tmp_path / "mine.toml"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    return write


def test_every_material_has_a_class():
    assert sorted(materials.names()) == sorted(name for names in CLASSES for name in names)


@pytest.mark.parametrize("name", materials.names())
def test_every_entry_is_complete_and_plausible(name):
    entry = materials.get(name)
    low, high, least, most = next(limits for names, limits in CLASSES.items() if name in names)
    assert low <= entry.E - entry.E_spread
    assert entry.E + entry.E_spread <= high
    assert least <= entry.nu - entry.nu_spread
    assert entry.nu + entry.nu_spread <= most
    assert 0.005 * entry.E <= entry.E_spread <= 0.4 * entry.E  # no two pieces agree better than to half a per cent
    assert 0.002 <= entry.nu_spread <= 0.05 or 0.49 < entry.nu <= 0.5
    assert len(entry.condition) > 10
    assert len(entry.source) > 20
    assert entry.checked != bool(re.search("not read|assumed|not\\)|table not", entry.source))


@pytest.mark.parametrize("name", materials.names())
def test_strengths_have_spread_and_source_and_are_plausible(name):
    """Metals and plastics yield below E/20, and no hardness is above E/5."""
    entry = materials.get(name)
    known = [key for key in STRENGTHS if getattr(entry, key) is not None]
    assert bool(known) == bool(entry.strength_source)
    for key in known:
        value, spread = getattr(entry, key), getattr(entry, f"{key}_spread")
        assert 0.02 <= spread / value <= 0.25, key
        assert entry.E / 2000 < value < entry.E / (20 if key == "yield_strength" else 5), key


def test_strengths_of_a_file(mine):
    own = materials.read(mine(STEEL + "hardness = 8e9\nhardness_spread = 0\n"))["my steel"]
    assert (own.hardness, own.hardness_spread, own.yield_strength) == (8e9, 0.0, None)
    for line, message in (
        ("hardness = 8", "hardness = 8: must be a number of Pa from 1000 to 2e"),
        *((line, "hardness and hardness_spread go together") for line in ("hardness = 8e9", "hardness_spread = 1e9")),
        ("hardness = 8e9\nhardness_spread = 8e9", "hardness_spread = 8e+09: must be 0 or less than the strength"),
        ("hardness = 8e9\nhardness_spread = -1", "hardness_spread = -1: must be 0 or less than the strength"),
        ("strength_source = 1", "strength_source = 1: must be a text"),
    ):
        with pytest.raises(ValueError, match=re.escape(message)):
            materials.read(mine(STEEL + line + "\n"))


def test_a_steel_by_its_names():
    steel = materials.get("steel 52100")
    assert materials.get("100Cr6") is materials.get(" Steel-52100 ") is steel
    assert steel.reduced_modulus == pytest.approx(207e9 / (1 - 0.29**2), rel=1e-14)
    with pytest.raises(AttributeError):
        steel.E = 1


def test_incompressible_is_allowed(mine):
    assert materials.get("gelatin gel").nu == 0.5
    assert materials.read(mine(STEEL.replace("0.3", "0.5", 1)))["my steel"].nu == 0.5


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("zir", '"zir" is not a material; did you mean "zirconia"?'),
        ("stel 52100", '"stel 52100" is not a material; did you mean "steel 52100"'),
        ("DLC", 'did you mean "DLC ta-C" or "DLC a-C:H"?'),
        ("teflonn", 'did you mean "PTFE"?'),
        ("xyzzy", "known: steel 52100, "),
        ("", "known: steel 52100, "),
        ("\x1b[2J" + "x" * 100, r'"\\x1b\[2Jx+\.\.\. is not a material'),
    ],
)
def test_an_unknown_name_is_answered_with_those_near(name, message):
    with pytest.raises(LookupError, match=message if "\\" in message else re.escape(message)):
        materials.get(name)


def test_a_file_of_ones_own(mine):
    text = STEEL + 'also = ["X210"]\ncondition = "nitrided"\nsource = "own test"\nchecked = true\n\n'
    found = materials.read(mine("\ufeff" + text + STEEL.replace("my steel", "X 2").replace("210e9", "210_000_000_000")))
    assert list(found) == ["my steel", "X 2"]
    assert materials.get("x210", found) == materials.Material(
        "my steel", 210e9, 0.3, 5e9, 0.01, "nitrided", "own test", ("X210",), True
    )
    assert (type(found["X 2"].E), found["X 2"].source) == (float, "")
    with pytest.raises(LookupError, match='did you mean "my steel"'):
        materials.get("steel", found)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("E = 210e9\n", "", "E is missing: must be a number of Pa from 1000 to 2e+12 (210 GPa is 210e9)"),
        ("nu_spread = 0.01", "", "nu_spread is missing: must be a number from 0 to 0.5, one standard deviation"),
        ("E = 210e9", "E = 210", "E = 210: must be a number of Pa from 1000 to 2e+12 (210 GPa is 210e9)"),
        ("E = 210e9", "E = 210e12", "E = 2.1e+14: must be a number of Pa from 1000 to 2e+12"),
        ("E = 210e9", "E = 0", "E = 0: must be a number of Pa"),
        ("E = 210e9", "E = -210e9", "E = -2.1e+11: must be a number of Pa"),
        ("E = 210e9", "E = nan", "E = nan: must be a number of Pa"),
        ("E = 210e9", "E = inf", "E = inf: must be a number of Pa"),
        ("E = 210e9", 'E = "210 GPa"', 'E = "210 GPa": must be a number of Pa'),
        ("E = 210e9", "E = true", "E = True: must be a number of Pa"),
        ("nu = 0.3", "nu = 0.51", "nu = 0.51: must be a number above -1 and at most 0.5"),
        ("nu = 0.3", "nu = -1", "nu = -1: must be a number above -1 and at most 0.5"),
        ("nu = 0.3", "nu = [0.3]", "nu = [0.3]: must be a number above -1 and at most 0.5"),
        ("nu = 0.3", "nu = false", "nu = False: must be a number above -1 and at most 0.5"),
        ("5e9", "5", "E_spread = 5: must be 0 or a number of Pa from 1e-06 E to E (5 GPa is 5e9)"),
        ("5e9", "-5e9", "E_spread = -5e+09: must be 0 or"),
        ("5e9", "210e9", "E_spread = 2.1e+11: must be 0 or"),
        ("0.01", "0.6", "nu_spread = 0.6: must be a number from 0 to 0.5"),
        ("nu = 0.3", "nu = 0.3\nsource = 3", "source = 3: must be a text"),
        ("nu = 0.3", 'nu = 0.3\nalso = "x"', 'also = "x": must be a list of texts'),
        ("nu = 0.3", "nu = 0.3\nalso = [1]", "also = [1]: must be a list of texts"),
        ("nu = 0.3", "nu = 0.3\nchecked = 1", "checked = 1: must be true or false"),
        (
            "nu = 0.3",
            "nu = 0.3\npoisson = 0.3",
            '"poisson" is not a key; known: E, nu, E_spread, nu_spread, condition, ',
        ),
    ],
)
def test_a_bad_value_is_named_with_what_is_allowed(mine, old, new, message):
    assert STEEL.count(old) == 1
    with pytest.raises(ValueError, match=re.escape(f'mine.toml: ["my steel"] {message}')) as raised:
        materials.read(mine(STEEL.replace(old, new)))
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("E = 210e9", 'mine.toml: ["E"] = 2.1e+11: must be a section with the keys E, nu, E_spread, nu_spread'),
        ("[steel\n", "mine.toml is not a TOML file: "),
        (b"\xff\xfe", "mine.toml is not UTF-8 (byte 0): "),
        ("x = " + "[" * 5000, "mine.toml is not a TOML file: "),
        (
            STEEL + STEEL.replace("my steel", "other") + 'also = ["My-Steel"]',
            'mine.toml: ["other"] is called "My-Steel", and so is ["my steel"]',
        ),
    ],
)
def test_a_bad_file_is_named(mine, text, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        materials.read(mine(text))


def test_every_complaint_about_a_file_is_made_at_once(mine):
    with pytest.raises(ValueError, match="my steel") as raised:
        materials.read(mine(STEEL.replace("210e9", "210").replace("0.3", "3") + STEEL.replace("my steel", "b") + "x=1"))
    assert [line.split("]")[0] for line in str(raised.value).splitlines()] == [
        'mine.toml: ["my steel"',
        'mine.toml: ["my steel"',
        'mine.toml: ["b"',
    ]


def test_no_spread_is_allowed_and_no_file_is_an_oserror(mine, tmp_path):
    exact = materials.read(mine(STEEL.replace("5e9", "0").replace("0.01", "0")))["my steel"]
    assert exact.reduced_modulus_spread == 0
    with pytest.raises(OSError, match="nowhere"):
        materials.read(tmp_path / "nowhere.toml")


@pytest.mark.parametrize("name", materials.names())
def test_the_spread_of_the_reduced_modulus_is_that_of_draws(name):
    """The standard deviation of N draws is known to 1/sqrt(2N), 0.16 % of it: 5 of these and 0.2 % for second order."""
    entry = materials.get(name)
    draws = np.random.default_rng(1).standard_normal((2, 200_000))
    E, nu = entry.E + entry.E_spread * draws[0], entry.nu + entry.nu_spread * draws[1]
    assert np.std(E / (1 - nu**2)) == pytest.approx(entry.reduced_modulus_spread, rel=0.01)


def test_the_spread_of_nu_alone(mine):
    """Where E is exact the whole spread is that of nu: for nu = 0.45 +- 0.001 the second order is below 1e-4 of it."""
    text = STEEL.replace("5e9", "0").replace("0.3", "0.45").replace("0.01", "0.001")
    entry = materials.read(mine(text))["my steel"]
    high, low = (210e9 / (1 - nu**2) for nu in (0.451, 0.449))
    assert entry.reduced_modulus_spread == pytest.approx((high - low) / 2, rel=1e-4)


def test_the_table_is_aligned_and_fits_a_terminal():
    head, *lines = materials.table().splitlines()
    assert len(lines) == len(materials.names())
    assert max(map(len, lines)) <= 80
    for column in ("E  ", "nu  ", "E/("):
        start = head.index(column)
        assert all(line[start - 2 : start] == "  " and line[start].isdigit() for line in lines), column
    assert re.search(r"^polyacrylamide gel +8\.6 ± 1\.5 kPa +0\.480 ± 0\.012 +11\.2 ± 2\.0 kPa$", lines[-4])


def test_the_page_has_the_table():
    page = (ROOT / "docs/materials_table.md").read_text(encoding="utf-8")
    command = re.search(r'python -c "(.+?)"', page)[1]
    run = subprocess.run(
        [sys.executable, "-X", "utf8", "-c", command], cwd=ROOT, capture_output=True, text=True, encoding="utf-8"
    )
    assert run.stdout == materials.markdown() + "\n", run.stderr
    written = "\n".join(line for line in page.splitlines() if line.startswith("|"))
    assert written == materials.markdown(), "docs/materials_table.md: write its table anew with the command above it"


def test_the_table_comes_with_an_installed_package(tmp_path):
    """From a zip file of what setuptools packs, sources and `package-data`: importlib.resources alone reads there."""
    packed = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    files = [*(ROOT / "study").rglob("*.py")]
    for package, patterns in packed.items():
        files += [path for pattern in patterns for path in (ROOT / package.replace(".", "/")).glob(pattern)]
    wheel = tmp_path / "roughcoat.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        for path in files:
            archive.write(path, path.relative_to(ROOT).as_posix())
    script = f"import sys; sys.path.insert(0, {str(wheel)!r}); import study; m = study.materials"
    script += "; assert m.__file__.startswith(sys.path[0]); print(m.get('ta-C').E)"
    ended = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert ended.stdout == "625000000000.0\n", ended.stderr


def test_a_name_goes_before_the_other_name_of_another():
    """In whichever order they stand; of an own list, which may have both."""
    steel = materials.Material("steel", 2e11, 0.3, 0.0, 0.0, also=("iron", "Fe"))
    iron = materials.Material("iron", 1.9e11, 0.29, 0.0, 0.0, also=("steel",))
    for own in ({"steel": steel, "iron": iron}, {"iron": iron, "steel": steel}):
        assert [materials.get(name, own) for name in ("steel", "Iron", "fe")] == [steel, iron, steel]
