"""Rows of text files: missing points, words in rows, separators, encodings; x y z of a grid; rounded positions."""

import gzip
import re
import sys
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose

from study import roughness
from study.specimen import scan_texts
from study.specimen.texts import plain_rows, text_lines

RANDOM = np.random.default_rng(0)
Z = np.round(RANDOM.normal(size=(40, 40)), 4)  # nm
X = np.arange(200) * 0.25  # um
P = np.round(RANDOM.normal(size=200), 4)  # nm
Y40, X40 = np.mgrid[:40, :40]
IN = {"unit": "um", "height_unit": "nm"}
MAP = IN | {"dx": 1.0}


def table(values, separator=" ", mark=".") -> list[list[str]]:
    return [[str(value).replace(".", mark) for value in row] for row in values]


def text(rows, separator=" ") -> str:
    return "".join(separator.join(row) + "\n" for row in rows)


def triples(x, y, z=Z) -> list[list[str]]:
    return table(np.c_[np.ravel(x), np.ravel(y), np.ravel(z)].round(6).tolist())


def read(tmp_path, content, name="a.txt", encoding="utf-8", **given):
    file = tmp_path / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
    return roughness.read(file, **given)


SEPARATORS = (" ", ";", "\t", ",")
TOKENS = ("", "nan", "NaN", "Bad", "BAD", "bad", "***", "--", "-", " Bad ")
# between spaces there are no empty fields
PADDED = [pair for pair in product(TOKENS, (" ", "  ", ";", "\t", ", ")) if pair[0] or pair[1].strip(" ")]


# between spaces there are no empty fields
@pytest.mark.parametrize("token, separator", [pair for pair in product(TOKENS, SEPARATORS) if pair != ("", " ")])
def test_a_missing_point_in_the_first_rows_is_one(tmp_path, token, separator):
    """These rows were taken for a heading: of 40 × 40 heights 30 × 40 were left."""
    rows = table(Z)
    for i in range(10):
        rows[i][(5 * i) % 40] = token
    scan = read(tmp_path, text(rows, separator), **MAP)
    kept = np.ones(Z.shape, dtype=bool)
    kept[np.arange(10), (5 * np.arange(10)) % 40] = False
    assert scan.z.shape == (40, 40) and any("10 of 1600" in note for note in scan.notes)
    assert_allclose(scan.z[kept], Z[kept] * 1e-9, rtol=1e-12)
    with pytest.raises(ValueError, match='10 of 1600 heights .* missing="refuse" allows none'):
        read(tmp_path, text(rows, separator), missing="refuse", **MAP)
    skipped = read(tmp_path, text(rows, separator), missing="skip", **MAP)
    assert_allclose(skipped.z, np.where(kept, Z, np.nan) * 1e-9, rtol=1e-12)


def test_rows_of_missing_points_alone(tmp_path):
    """Above the first height, in the middle and at the end: an interferometer writes them where it saw no fringes."""
    for separator, token in ((" ", "Bad"), (";", ""), ("\t", ""), ("\t", "***")):
        rows = table(Z)
        for i in (0, 1, 20, 39):
            rows[i] = [token] * 40
        scan = read(tmp_path, "heading\n" + text(rows, separator), missing="skip", **MAP)
        assert scan.z.shape == (40, 40) and np.isnan(scan.z[[0, 1, 20, 39]]).all() and np.isnan(scan.z).sum() == 160


@pytest.mark.parametrize("word", ["overflow", "inf", "-Infinity", "-1.#IND", "1_000", "0x1F", "1.024,5", "n/a", "----"])
def test_a_word_in_a_row_is_refused(tmp_path, word):
    """Wherever it stands; "-1.#IND" was read as -1, and 1_000 as 1000."""
    for row, message in ((0, "is a row of the table except for"), (25, "has something other than numbers:")):
        for separator in (" ", ";", "\t"):
            rows = table(Z)
            rows[row][7] = word
            with pytest.raises(ValueError, match=f"^a.txt, line {row + 2}: .* {message} '{word}'"):
                read(tmp_path, "a heading\n" + text(rows, separator), **MAP)
    rows = triples(X40, Y40)
    rows[0][2] = word
    with pytest.raises(ValueError, match=f"^a.txt, line 2: .* is a row of the table except for '{word}'"):
        read(tmp_path, "map 12 a\n" + text(rows), **IN)
    rows = table(np.c_[X, P])
    rows[0][1] = word
    with pytest.raises(ValueError, match=f"^a.txt, line 1: .* is a row of the table except for '{word}'"):
        read(tmp_path, text(rows, ";"), **IN)


@pytest.mark.parametrize(
    "heading",
    [
        *("x [um]  z [nm]", "x [um];z [nm]", "Time 12:30 2024", "100 x 100 points", "100 × 100", "Points: 200", "x z"),
        *("x;z\nµm;nm", "x;z\num;nm\n-;-", "x (um);z (nm)", "x in µm;z in nm", "x/um;z/nm", "Date;12.03.2024", "- -"),
        *("Lateral um;Raw nm", "Channel: Topography", "# Channel: Roughness\n# Value units: nm", "50 um\n2 um/s", ""),
        *("Magnification: 50", "Scan size 10", "Filter cutoff 0.8", "Ra 0.05", '"Sample";"A 12"', "\n\n***\n\n", "---"),
        *("Scale factor: 1", "z-scale = 1 nm", "Color scale: 0 - 100 nm", "Scale bar: 10 um", "Xscale = 1e-6", "200;"),
        *("Position;2 nm", "Number of points;200", "Version 1.2.3", "12 / 2024", "Bit2nm = 1\nz-unit = nm"),
    ],
)
def test_true_headings_are_headings(tmp_path, heading):
    scan = read(tmp_path, f"{heading}\n" + text(table(np.c_[X, P]), ";"), **IN)
    assert_allclose(scan.z, P * 1e-9, rtol=1e-12)
    assert_allclose(scan.steps, 0.25e-6, rtol=1e-12)


def test_separators_marks_and_quotes(tmp_path):
    for content in (
        "".join(";".join(row) + ";\n" for row in table(Z)),  # a trailing separator
        "".join("\t".join(row) + "\t\r\n" for row in table(Z)),
        "".join(",".join(f'"{field}"' for field in row) + "\n" for row in table(Z)),
        "".join(",".join(f'"{field}"' for field in row) + "\n" for row in table(Z, mark=",")),
        text(table(Z, mark=","), "\t"),
        text(table(Z, mark=","), ";").replace("-", "−"),  # the minus of printed text
        "\n".join([*text(table(Z), ";").splitlines(), ";;", ""]),
    ):
        assert_allclose(read(tmp_path, content, **MAP).z, Z * 1e-9, rtol=1e-12)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1", "cp1252"])
@pytest.mark.parametrize("packed", [False, True])
def test_encodings(tmp_path, encoding, packed):
    content = ("Größe µm\n" + text(table(Z), "\t")).encode(encoding)
    name = "a.csv.gz" if packed else "a.csv"
    assert_allclose(read(tmp_path, gzip.compress(content) if packed else content, name, **MAP).z, Z * 1e-9, rtol=1e-12)


def test_a_damaged_packed_file(tmp_path):
    with pytest.raises(ValueError, match=r"^a.csv.gz: the packed file is damaged: "):
        read(tmp_path, gzip.compress(text(table(Z)).encode())[:300], "a.csv.gz", **MAP)


def test_without_the_extra_text_is_read_all_the_same(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    assert_allclose(read(tmp_path, text(table(Z)), "a.foo", **MAP).z, Z * 1e-9, rtol=1e-12)
    for name in ("a.dat", "a.asc", "a.xyz", "a.gz", "a.csv"):
        with pytest.raises(ValueError, match=rf"^{name}: not a text file; .* pip install 'roughcoat\[topography\]'"):
            read(tmp_path, bytes(range(256)), name, **MAP)


def test_the_number_of_points_first(tmp_path):
    profile, grid = text(table(np.c_[X, P])), text(triples(X40 * 0.5, Y40 * 0.5))
    for count, content, given, z in (
        ("200", profile, IN, P),
        ("40 40", text(table(Z)), MAP, Z),
        ("1600", grid, IN, Z),
        ("200", text([[str(value)] for value in P]), IN | {"dx": 0.25}, P),
    ):
        scan = read(tmp_path, f"{count}\n{content}", **given)
        assert_allclose(scan.z, z * 1e-9, rtol=1e-12)
        assert any(f"line 1, '{count}', is taken for the size of the table" in note for note in scan.notes)
    for wrong in ("0.25", "1e-9", "199", "7 200"):  # a distance, a scale, a number of something else
        with pytest.raises(ValueError, match=rf"^a.txt, line 1: '{wrong}' before a table of 1600 rows of 3"):
            read(tmp_path, f"{wrong}\n{grid}", **IN)
    whole = [[str(value)] for value in (20, *(X[:20] % 3 > 1).astype(int))]
    with pytest.raises(ValueError, match="^a.txt, line 1: 20 may be a height or the number of the others"):
        read(tmp_path, text(whole), **MAP)


def test_points_of_a_grid_in_any_order(tmp_path):
    """The docs of four instruments call this their export; it was "rows of 3 column(s)", and a circle of messages."""
    rows = triples(X40 * 0.5, Y40 * 0.25)
    shuffled = [rows[i] for i in RANDOM.permutation(1600)]
    for content in (text(rows), text(shuffled, ";"), "X[um];Y[um];Z[nm]\n" + text(rows, ";"), text(rows[::-1], "\t")):
        scan = read(tmp_path, content, "a.xyz", **IN)
        assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
        assert_allclose(scan.steps, (0.25e-6, 0.5e-6), rtol=1e-12)
    falling = read(tmp_path, text(triples(X40 * 0.5, -Y40 * 0.25)), **IN)
    assert_allclose(falling.z, Z[::-1] * 1e-9, rtol=1e-12)
    more = [[row[0], "7", row[1], row[2]] for row in rows]
    assert_allclose(read(tmp_path, text(more), columns=(0, 2, 3), **IN).z, Z * 1e-9, rtol=1e-12)
    numbered = text(triples(X40 + 3, Y40))
    assert_allclose(read(tmp_path, numbered, dx=0.5, dy=0.25, **IN).steps, (0.25e-6, 0.5e-6), rtol=1e-12)
    assert read(tmp_path, text(rows), dx=0.5, dy=0.25, **IN).notes == ()
    other = read(tmp_path, text(rows), dx=2, dy=1, **IN)  # the file has 0.5 and 0.25; this was refused
    assert_allclose(other.steps, (1e-6, 2e-6), rtol=1e-12)
    assert_allclose(other.z, Z * 1e-9, rtol=1e-12)
    assert other.notes == ("points are dx = 2 and dy = 1 um apart, as the call says; the file states 0.5 and 0.25 um",)
    with pytest.raises(ValueError, match="give dx beside dy"):
        read(tmp_path, text(rows), dy=1, **IN)


@pytest.mark.parametrize(
    ("x", "y", "steps"),
    [
        (np.round(X40 / 3, 2), np.round(Y40 / 7, 2), (1 / 7, 1 / 3)),
        (np.round(X40 / 3, 1), np.round(Y40 * 1.1 / 3, 1), (1.1 / 3, 1 / 3)),
        (X40 * 0.5 + RANDOM.uniform(-0.02, 0.02, Z.shape), Y40 * 0.5, (0.5, 0.5)),
        (X40 * 0.1 * 3, Y40 * 1e-3, (1e-3, 0.3)),
    ],
)
def test_positions_of_a_grid_are_rounded(tmp_path, x, y, steps):
    scan = read(tmp_path, text(triples(x, y)), **IN)
    assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
    assert_allclose(scan.steps, np.multiply(steps, 1e-6), rtol=0.01)


@pytest.mark.parametrize("no_data", ["No Data", "no data", "***", "nan", None])
def test_missing_points_of_a_grid(tmp_path, no_data):
    """None: their rows are not there."""
    rows, there = triples(X40 * 0.5, Y40 * 0.5), np.ones(1600, dtype=bool)
    there[[0, 5, 777]] = False
    rows = [row if there[i] else [*row[:2], no_data] for i, row in enumerate(rows) if there[i] or no_data]
    for separator in (" ", ";", "\t"):
        scan = read(tmp_path, text(rows, separator), missing="skip", **IN)
        assert_allclose(scan.z.ravel(), np.where(there, Z.ravel(), np.nan) * 1e-9, rtol=1e-12)
        assert any("3 of 1600" in note for note in read(tmp_path, text(rows, separator), **IN).notes)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (
            triples(RANDOM.uniform(size=1600), Y40),
            "they are not the x, y, z of a grid: x has no equal steps. Choose others",
        ),
        (
            triples(X40 * 0.5 + Y40 * 0.1, Y40 * 0.5 - X40 * 0.1),
            "they are not the x, y, z of a grid: .* have 1600 heights",
        ),
        (
            triples(X40, 0 * Y40)[:40],
            r"they are not the x, y, z of a grid: all y are equal. .*columns=\(0, 2\) for x and z",
        ),
        (triples(X40, Y40) + triples(X40, Y40)[:1], "x = 0, y = 0 stands there twice"),
        ([["Bad", "0", "1"], *triples(X40, Y40)[1:]], "1 positions are not numbers"),
    ],
)
def test_what_is_no_grid(tmp_path, rows, message):
    with pytest.raises(ValueError, match=rf"^a.txt: {len(rows)} rows of 3 column\(s\).*{message}"):
        read(tmp_path, text(rows), **IN)


@pytest.mark.parametrize(("step", "decimals"), [(1 / 3, 1), (0.0123, 2), (0.3037, 1), (0.037, 2), (1 / 7, 1)])
def test_rounded_positions_are_uniform(tmp_path, step, decimals):
    """A Dektak writes x with few digits: it was "not uniform", though only its last digit was uneven."""
    x = np.round(3 + np.arange(600) * step, decimals)
    scan = read(tmp_path, text(table(np.c_[x, np.resize(P, 600)])), unit="um", height_unit="pm")
    assert_allclose(scan.steps, step * 1e-6, rtol=3e-3)
    assert any("the positions x are rounded: their mean step" in note for note in scan.notes)


def test_uneven_positions_are_not_rounded_ones(tmp_path):
    for x in (
        np.delete(np.arange(201.0), 100),
        np.delete(np.arange(201) * 0.25, 90),
        np.sort(RANDOM.uniform(size=200)),
    ):
        with pytest.raises(ValueError, match="the positions x are not uniform"):
            read(tmp_path, text(table(np.c_[x, P])), **IN)


@pytest.mark.parametrize("separator, mark", [(";", ","), ("\t", "."), (",", "."), (" ", ".")])
def test_plain_rows_are_those_that_are_read_one_by_one(separator, mark):
    """All digits of all numbers, and the lines of the heading; a word in the last row leaves the rows to the reader of
    single ones, and a row that is too short is refused as there."""
    heights = np.random.default_rng(0).standard_normal((20, 20)) * 10.0 ** np.arange(-10, 10)
    rows = [separator.join(map(repr, row)).replace(".", mark) for row in heights.tolist()]
    text = "\n".join(["# heights", "width: 3", *rows, ""])
    table = scan_texts.table_of(text, "map.txt")
    assert (table.numbers == heights).all() and table.heading == ((1, "# heights"), (2, "width: 3"))
    with_word = "\n".join([*rows[:-1], rows[-1].rpartition(separator)[0] + separator + '"nan"'])
    several = scan_texts.table_of(with_word, "map.txt").numbers
    assert (several[:-1] == heights[:-1]).all() and np.isnan(several[-1, -1])
    with pytest.raises(ValueError, match="line 20: 19 number"):
        scan_texts.table_of("\n".join([*rows[:-1], rows[-1].rpartition(separator)[0]]), "map.txt")


@pytest.mark.parametrize("word, separator", PADDED)
def test_numpy_reads_neighbours_that_are_missing(separator, word):
    """Maps and points x, y, z whose missing points touch each other, where one reading row by row takes ten times as
    long."""
    for columns in (3, 20):
        heights = np.random.default_rng(0).normal(size=(5, columns)).round(3)
        heights[1:4, -3:] = heights[2, :3] = np.nan
        heights[1:4, 0] = 1.0, 2.0, 3.0  # ;; is no row
        rows = np.where(np.isnan(heights), word, heights.astype(str)).tolist()
        lines = text_lines.Lines([separator.join(row) for row in rows], 1)
        numbers, places = scan_texts.plain_rows(lines, (separator.strip(" ") or None, "."))
        np.testing.assert_array_equal(numbers, heights)
        assert places.tolist() == [1, 2, 3, 4, 5]


@pytest.mark.parametrize("end", ["", "\n"])
def test_a_profile_that_ends_with_a_separator_may_be_cut_off(end):
    with pytest.raises(ValueError, match=re.escape("line 4: 1 number(s) after lines of 2: the file may be cut off")):
        scan_texts.table_of("0.5;1.5\n1;2.5\n2;3\n3;" + end, "t.txt")
    within = scan_texts.table_of("0.5;1.5\n1;\n2;3\n3;4" + end, "t.txt")
    np.testing.assert_array_equal(within.numbers[:, 1], [1.5, np.nan, 3, 4])


@pytest.mark.parametrize("word", ["-nan", "+NaN", "inf", "1_000", "0x1", "nannan"])
def test_a_word_that_is_no_missing_point_is_named(word):
    """Also after rows of whole numbers, which leave the decimal mark open."""
    for first in ("1.0 2.0 3.0", "1.5 2.5 3.5"):
        with pytest.raises(
            ValueError, match=re.escape(f"line 4: '2.0 1.0 {word}' has something other than numbers: '{word}'")
        ):
            scan_texts.table_of(f"heading\n{first}\n{first}\n2.0 1.0 {word}\n{first}\n", "t.txt")


WORDS = ["", "nan", "NaN", "Bad", "***", "--", "-", "-nan", "x", "inf", "nannan", " nan "]


@pytest.mark.parametrize("separator, mark", [(s, m) for s, m in product([",", ";", "\t", " "], ".,") if s != m])
def test_numpy_reads_tables_with_missing_points_as_the_reader_of_single_rows(separator, mark, monkeypatch):
    """The same numbers, heading and message, and most tables by numpy, whatever stands for a missing point, in blocks
    of one row and of all."""
    by_numpy, random = [], np.random.default_rng(5)
    plain = scan_texts.plain_rows
    for _ in range(120):
        monkeypatch.setattr(plain_rows, "CHARACTERS", int(random.choice([1, 60, 10**6])))
        columns, words = random.choice([2, 3, 16, 20]), random.choice(WORDS[:7] if random.random() < 0.8 else WORDS, 2)
        rows = random.normal(size=(random.choice([3, 9]), columns)).round(3).astype(str)
        missing = random.random(rows.shape) < random.choice([0, 0.1, 0.3])
        rows = np.where(missing, random.choice(words, rows.shape), np.char.replace(rows, ".", mark))
        lines = text(rows, separator).split("\n")
        if random.random() < 0.5:  # what is no row may stand anywhere
            lines.insert(random.integers(len(lines)), random.choice(["", "  ", "# remark", separator * 2]))
        content = "heading\n" + "\n".join(lines) + "\n" * random.choice([0, 1])
        answers = []
        for numpy_first in (True, False):
            monkeypatch.setattr(scan_texts, "plain_rows", plain if numpy_first else lambda *_: None)
            try:
                table = scan_texts.table_of(content, "t.txt")
                answers.append((np.nan_to_num(table.numbers, nan=9e9).tolist(), table.heading, table.separator))
            except ValueError as error:
                answers.append(str(error))
        assert answers[0] == answers[1], content
        lines = text_lines.Lines(content.split("\n")[1:-1], 2)
        by_numpy.append(
            isinstance(answers[0], tuple) and plain(lines, (separator.strip(" ") or None, mark)) is not None
        )
    assert np.mean(by_numpy) > 0.3
