"""A table of one's own as the micro law: its curves, its range, its mistakes, and how a study uses it."""

import pickle
import warnings
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver import Problem, Status, laws, solve
from solver.laws import own_table
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables
from study.work.cases import compute, parcel

ASPERITIES = {"Nbar": 250_000.0, "Ra": 0.004}
CASE = {"h": 0.02, "n": 0.5, "x": 3}
HEAD = "p,A,lam,p_max\n"
ROWS = ["0.001,1,0.01,0.1", "0.002,2,0.02,0.2", "0.003,3,0.03,0.3", "0.004,4,0.04,0.4", "0.005,5,0.05,0.5"]


@pytest.fixture
def table(tmp_path, monkeypatch):
    """Writes mine.csv in an empty folder, the current one: of the disc cell, or a text."""
    monkeypatch.chdir(tmp_path)

    def write(text=None, noise=0.0):
        if text is None:
            p = np.geomspace(1e-5, 0.3, 40)
            spots = laws.LAWS["disc_cell"].at(p, 1.0, **ASPERITIES)
            wave = 1 + noise * np.sin(37 * np.arange(40))
            rows = zip(p, spots.A * wave, spots.lam, spots.p_max, strict=True)
            text = "# of the disc cell\n" + HEAD + "".join(",".join(map(repr, map(float, row))) + "\n" for row in rows)
        (tmp_path / "mine.csv").write_text(text, encoding="utf-8")
        return "table:mine.csv"

    return write


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered", "auto"])
def test_the_table_of_a_law_is_that_law(table, base):
    """For every control, within the error that the table itself has, which is part of the model error."""
    name = table()
    error = own_table.read(name).error
    assert 1e-6 < error < 1e-3
    for control, value in (("P", [1e-6, 1e-5]), ("a", [0.02, 0.04]), ("D", [2e-4, 1e-3])):
        found = study.solve(**CASE, **{control: value}, base=base, micro=name)
        disc = study.solve(**CASE, **{control: value}, base=base, micro="disc_cell", **ASPERITIES)
        assert (found.status == 0).all() and (found.error <= 1e-6).all()
        for quantity in {"a", "P", "D", "p0", "p_max", "Ar_An", "A0"} - {control}:
            assert_allclose(found[quantity], disc[quantity], rtol=2 * error, atol=0)
        assert_allclose(found.model_error, disc.model_error + error, rtol=1e-3, atol=0)
        assert_allclose(found.nodes_used, disc.nodes_used, rtol=0.5)


def test_noise_is_smoothed_and_said(table):
    name = table(noise=0.01)
    law = own_table.read(name)
    assert 0.003 < law.error < 0.03
    p = np.geomspace(1e-5, 0.3, 500)
    assert (np.diff(law.at(p, 1.0).A) > 0).all()
    found = study.solve(P=1e-5, **CASE, micro=name)
    assert found.status == 0 and found.model_error == law.error


@pytest.mark.parametrize("rows", [7, 10, 20])
def test_the_error_covers_what_is_between_few_rows(rows):
    def disc(p):
        return laws.LAWS["disc_cell"].at(p, 1.0, **ASPERITIES)

    rows, between = np.geomspace(1e-5, 0.03, rows), np.geomspace(1e-5, 0.03, 300)
    law = own_table.fitted_law("table:few.csv", rows, *disc(rows))
    truth = max(np.abs(found / true - 1).max() for found, true in zip(law.at(between, 1.0), disc(between), strict=True))
    assert truth < law.error < 10 * truth


def test_the_error_covers_tables_of_random_rows():
    """Of a few rows, each of which determines the curve beside it. If that did not count, two of the errors would be
    too small, one by a factor of 2.9."""
    random, missed = np.random.default_rng(3), []
    for _ in range(100):
        asperities = {"Nbar": 250_000.0, "Ra": np.sqrt(10 ** random.uniform(-1.5, 1.5) / 250_000)}
        p = 10 ** random.uniform(-6, -3) * np.geomspace(1, 10 ** random.uniform(1, 2.5), random.integers(6, 14))
        p = np.sort(p * np.exp(random.normal(0, 0.1, len(p))))
        between = np.geomspace(p[0], p[-1], 300)
        table, truth = (laws.LAWS["disc_cell"].at(points, 1.0, **asperities) for points in (p, between))
        law = own_table.fitted_law("table:random.csv", p, *table)
        error = max(np.abs(f / true - 1).max() for f, true in zip(law.at(between, 1.0), truth, strict=True))
        missed.append(error / law.error)
    assert max(missed) < 1


def test_outside_its_range(table):
    """p(0) below the first row, pressures above the last one; in any units."""
    problem = {"h": 0.02, "n": 0.5, "base": ["half_space", "layered", "auto"], "micro": table()}
    for P, status in ((1e-13, Status.OUTSIDE_LAW), (1e-5, Status.CONVERGED), (1.0, Status.OUTSIDE_LAW)):
        found = solve(Problem.of(P=P * 4e9, **problem | {"h": 0.04}, R=2.0, E2=1e9))
        assert found.status.tolist() == [status] * 3
        for name in ("a", "D", "p0", "p_max", "Ar_An", "error", "model_error"):
            assert np.isnan(getattr(found, name)).all() == (status != 0)
        assert_allclose(found.P, P * 4e9)


def test_on_a_rigid_base(table):
    """There E1* is the unit of pressure."""
    given = {"P": 1e-5, "h": 0.02, "n": 0.0, "base": ["thin_layer", "layered"]}
    found = solve(Problem.of(**given, micro=table()))
    disc = solve(Problem.of(**given, micro="disc_cell", **ASPERITIES))
    assert (found.status == 0).all()
    assert_allclose(found.a, disc.a, rtol=1e-4)


def test_the_edge_goes_on_as_the_first_rows(table):
    law = own_table.read(table())
    p = np.array([1e-9, 1e-7, 1e-5])
    slope = np.diff(np.log(law.at(p, 1.0).A)) / np.diff(np.log(p))
    assert_allclose(slope, law.edge()[1], rtol=2e-3)


WRONG = {
    "": "column p: the heading must have it once, with p, A, lam, p_max, separated by commas",
    "p,A,lam\n": "column p_max: the heading must have it once, with p, A, lam, p_max, separated by commas",
    HEAD + "1,1,1,2\n": "has 1 rows: must have at least 5",
    "\n".join([HEAD, *ROWS[:3], "0.004,4,0.04", ROWS[4]]): "row 4: has 3 cells, the heading 4",
    "\n".join([HEAD, *ROWS[:3], "0.004,four,0.04,0.4", ROWS[4]]): 'column A, row 4: "four": must be a finite number',
    "\n".join([HEAD, *ROWS[:3], "0.004,4,0.04,inf", ROWS[4]]): 'column p_max, row 4: "inf": must be a finite number',
    "\n".join([HEAD, *ROWS[:3], "-1,4,0.04,1", ROWS[4]]): 'column p, row 4: "-1": must be a finite number > 0',
    "\n".join([HEAD, *ROWS[:3], "0.003,4,0.04,1", ROWS[4]]): "column p, row 4: 0.003: must be larger than that of the",
    "\n".join([HEAD, *ROWS[:3], "0.004,3,0.04,1", ROWS[4]]): "column A, row 4: 3: must be larger than that of the row",
    "\n".join([HEAD, *ROWS[:3], "0.004,4,0.02,1", ROWS[4]]): "column lam, row 4: 0.02: must not be smaller than that",
    "\n".join([HEAD, *ROWS[:4], "0.005,5,1.05,0.5"]): "column lam, row 5: 1.05: must be at most 1",
    "\n".join([HEAD, *ROWS[:4], "0.005,5,0.05,0.004"]): "column p_max, row 5: 0.004: must be larger than p",
    "\n".join([HEAD, *ROWS[:4], "0.005,5,0.05,0.09"]): "column p_max, row 5: 0.09: must be at least p/lam, the mean",
    "\n".join([HEAD, "0.00001,0.1,0.001,0.01", *ROWS]): "column p, row 2: 0.001: is over 30 times that of the row",
    "\n".join(
        [
            HEAD,
            "0.001,1,0.01,0.2",
            "0.003,1.00005,0.03,0.2005",
            "0.008,1.00006,0.08,0.201",
            "0.022,1.026,0.22,0.2015",
            "0.06,1.045,0.6,0.202",
        ]
    ): "column A: no smooth curve through the rows rises: add rows, or smooth them",
    "\n".join([HEAD, ROWS[0], *(f"{0.02 * i},{2 * 20**0.9 * i**0.5},0.5,0.9" for i in range(1, 6))]): "add rows there",
    "\n".join(
        [HEAD, *ROWS[:4], "0.005,50,0.05,0.5"]
    ): " % off a smooth curve through the other rows: at most 5 % are allowed",
}


@pytest.mark.parametrize(("text", "expected"), WRONG.items(), ids=list(WRONG.values()))
def test_mistakes(table, text, expected):
    """One message, with file, column and row, before anything is solved."""
    with pytest.raises(study.StudyError) as error:
        study.solve(P=1e-5, **CASE, micro=table(text))
    (message,) = error.value.messages
    assert message.startswith("solve: micro: mine.csv: ") and expected in message


def checked(*columns):
    """The checks of the columns of a user's table."""
    own_table._check(*columns)
    own_table._check_order(*columns)


@pytest.mark.parametrize(("micro", "more"), [("disc_cell", {}), ("normal_heights", {"sigma": 1e-4, "cut": 3.0})])
@pytest.mark.parametrize("density", [0.25, 1, 4, 100])
@pytest.mark.parametrize("first", [1e-7, 1e-4])
def test_exchanged_columns_are_refused(micro, more, density, first):
    """Any two, with noise of 1 %; the columns in their places are taken."""
    p, wave = np.geomspace(first, 0.2, 40), 1 + 0.01 * np.sin(37 * np.arange(40))
    spots = laws.LAWS[micro].at(p, 1.0, Nbar=density / 0.004**2, Ra=0.004, **more)
    columns = [p, spots.A, np.maximum.accumulate(np.minimum(spots.lam * wave, 1)), spots.p_max * wave]
    checked(*columns)
    for i, j in combinations(range(4), 2):
        order = {i: j, j: i}
        with pytest.raises(ValueError, match="^columns? "):
            checked(*(columns[order.get(k, k)] for k in range(4)))


def test_pressures_in_another_unit_are_beyond_validity(table):
    """p and p_max a thousand times too large: the real pressure is above the modulus. There is no Ra to tell."""
    read = own_table._columns((table(), Path("mine.csv").read_text(encoding="utf-8"))[1], own_table.COLUMNS, 5)
    assert study.solve(P=1e-5, **CASE, micro="table:mine.csv").validity == 0
    rows = zip(1e3 * read["p"], read["A"], read["lam"], 1e3 * read["p_max"], strict=True)
    name = table(HEAD + "".join(",".join(map(str, row)) + "\n" for row in rows))
    assert study.solve(P=1e-5, **CASE, micro=name).validity == 64


def test_files_that_cannot_be_read(table):
    told = (("table:none.csv", "none.csv: cannot be read: No such"), ("table:a\nb.csv", "has a line break"))
    Path("latin.csv").write_bytes("# p in µN/µm²\n".encode("latin-1"))
    told += (("table:latin.csv", r"latin.csv: is not UTF-8 \(byte 7\): save it with the encoding UTF-8"),)
    for name, words in (*told, ("a.csv", 'is "table:a.csv"$'), ("Table:a.csv", 'table of your own is "table:a.csv"$')):
        with pytest.raises(study.StudyError, match=words):
            study.solve(P=1e-5, **CASE, micro=name)


def test_keys_carry_the_numbers(table):
    """Not the words: a comment changes nothing, a number all."""
    tables = {"model": {"h": 0.02, "n": 0.5, "P": 1e-5}, "axes": {"micro": [table(), "smooth"]}}
    found = []
    text = HEAD + "\n".join(ROWS)
    for changed in (text, "# the same\n" + text, text.replace("0.004,4,", "0.00401,4,")):
        table(changed)
        definition = from_tables(tables, "mine", "", "mine.toml")
        found.append((definition.digest, case_keys(definition.grid).tolist()))
    assert found[0] == found[1] and found[0][0] != found[2][0]
    assert found[0][1][0] != found[2][1][0] and found[0][1][1] == found[2][1][1]


def test_every_column_is_in_the_version(table):
    """Another λ or p_max alone is another law."""
    rows = [list(map(float, row.split(","))) for row in ROWS]
    found = [own_table.read(table(HEAD + "\n".join(ROWS))).version]
    for column in range(4):
        changed = [[*row[:column], row[column] * (1 + 1e-12), *row[column + 1 :]] for row in rows]
        found.append(own_table.read(table(HEAD + "\n".join(",".join(map(repr, row)) for row in changed))).version)
    assert len(set(found)) == 5


def test_a_path_with_blanks(table):
    """In /home/me/My Data: what is computed is found again, and computed again when a number of the table changes."""
    table()
    text = Path("mine.csv").read_text(encoding="utf-8")
    own, found = Path("My Data", "mine  2.csv"), []
    own.parent.mkdir()
    for P, rows in (("[1e-5]", 40), ("[1e-5, 2e-5]", 40), ("[1e-5, 2e-5]", 39)):
        own.write_text("".join(text.splitlines(keepends=True)[: 2 + rows]), encoding="utf-8")
        model = f'h = 0.02\nn = 0.5\nmicro = "table:{own}"'
        Path("s.toml").write_text(f"[model]\n{model}\n[axes]\nP = {P}\n", encoding="utf-8")
        found.append(study.load("s.toml").run(force=True).computed)
    assert found == [1, 1, 2]
    assert study.load("s.toml").open().micro == f"table:{own}"


def test_it_travels_with_its_cases(table):
    """To a process that has not read it, and may not be able to."""
    definition = from_tables({"model": {"h": 0.02, "n": 0.5, "P": 1e-5, "micro": table()}}, "mine", "", "mine.toml")
    sent = pickle.dumps(parcel(definition, np.arange(1)))
    Path("mine.csv").unlink()
    assert compute(pickle.loads(sent))["status"] == 0


def test_a_table_of_several_radii_is_doubted(table):
    """A/R is of one R: A of a ball twice as large was that of asperities twice as large, without a word."""
    pytest.importorskip("pint")
    given = {"E2": "2 GPa", "base": "half_space", "P": "0.1 N", "micro": table(), "x": 2}
    with pytest.warns(UserWarning, match="with several R its asperities grow with the punch"):
        study.solve(**given, R=["5 mm", "10 mm"])
    Path("own.csv").write_text("".join(Path("mine.csv").read_text().splitlines(True)[:-1]), encoding="utf-8")
    rows = [{"R": "5 mm", "micro": given.pop("micro")}, {"R": "10 mm", "micro": "table:own.csv"}]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study.solve(**given, cases=rows)
        study.solve(**given, **rows[0])


@pytest.mark.parametrize("column", own_table.COLUMNS)
def test_a_row_of_no_contact_is_refused(table, column):
    """Many tables begin with zeros; no power law goes through them."""
    first = dict(zip(own_table.COLUMNS, ROWS[0].split(","), strict=True)) | {column: "0"}
    with pytest.raises(study.StudyError, match=f'column {column}, row 1: "0": must be a finite number > 0$'):
        study.solve(P=1e-5, **CASE, micro=table("\n".join([HEAD + ",".join(first.values()), *ROWS[1:]])))
