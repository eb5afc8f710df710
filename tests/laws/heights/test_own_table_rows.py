"""Messages about tables of one's own name the row that is wrong, wherever it stands."""

import numpy as np
import pytest

from solver import laws
from solver.laws import heights, own_table

P = np.geomspace(1e-5, 0.03, 30)
NAMES = ("p", "A", "lam", "p_max")


def written(tmp_path, columns: dict[str, np.ndarray]) -> str:
    """The name of the law of a table with these columns."""
    path = tmp_path / "mine.csv"
    rows = ["# remarks are no rows", ",".join(columns)]
    rows += [",".join(map(repr, map(float, row))) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join(rows), encoding="utf-8")
    return f"table:{path}"


def read(tmp_path, columns: dict[str, np.ndarray]) -> str:
    """What is said of a table with these columns."""
    with pytest.raises(ValueError) as caught:
        own_table.read(written(tmp_path, columns))
    return str(caught.value)


@pytest.fixture
def disc() -> dict[str, np.ndarray]:
    spots = laws.LAWS["disc_cell"].at(P, 1.0, Nbar=250_000.0, Ra=0.004)
    return {"p": P.copy(), "A": spots.A, "lam": spots.lam, "p_max": spots.p_max}


@pytest.mark.parametrize("row", [2, 3, 17, 30])
@pytest.mark.parametrize("name", ["p", "A", "lam"])
def test_a_column_that_does_not_rise(tmp_path, disc, name, row):
    before = disc[name][row - 2]
    disc[name][row - 1] = before * (1 if name != "lam" else 0.99)
    assert f"column {name}, row {row}: {disc[name][row - 1]:g}: must " in read(tmp_path, disc)


@pytest.mark.parametrize("row", [1, 2, 17, 30])
def test_numbers_that_cannot_be(tmp_path, disc, row):
    for name, value, words in (
        ("p_max", 0.99 * P[row - 1], "must be larger than p"),
        ("p_max", 1.01 * P[row - 1], "must be at least p/lam, the mean over the spots"),
    ):
        message = read(tmp_path, disc | {name: np.where(np.arange(1, 31) == row, value, disc[name])})
        assert f"column {name}, row {row}: {value:g}: {words}" in message
    for name in NAMES:
        message = read(tmp_path, disc | {name: np.where(np.arange(1, 31) == row, -1.0, disc[name])})
        assert f'column {name}, row {row}: "-1.0": must be a finite number > 0' in message
    above = np.where(np.arange(1, 31) >= row, 1.5 + 0.01 * np.arange(30), disc["lam"])
    assert f"column lam, row {row}: {above[row - 1]:g}: must be at most 1" in read(tmp_path, disc | {"lam": above})


def test_what_is_just_allowed_and_what_is_not(tmp_path, disc):
    """The fewest rows, the most of a histogram, full contact in a row."""
    few = {name: values[10:15] for name, values in disc.items()}
    assert own_table.read(written(tmp_path, few)).least == few["p"][0]
    assert read(tmp_path, {name: values[:4] for name, values in few.items()}).endswith(
        "has 4 rows: must have at least 5"
    )
    full = few | {"lam": np.array([0.6, 0.8, 0.95, 0.99, 1.0]), "p_max": 2 * few["p"]}
    assert own_table.read(written(tmp_path, full)).most == full["p"][-1]
    for rows in (2, 32):
        z = 1e-7 * np.arange(rows)
        assert own_table.read(written(tmp_path, {"z": z, "share": np.ones(rows)})).error == heights.STEPPED
    for rows, words in ((1, "has 1 rows: must have at least 2"), (33, "has 33 rows: must have at most 32")):
        assert read(tmp_path, {"z": 1e-7 * np.arange(rows), "share": np.ones(rows)}).endswith(words)


@pytest.mark.parametrize("column", ["A", "lam", "p_max"])
def test_the_error_is_that_of_the_worst_column(tmp_path, disc, column):
    """Noise of 1 % on one of them."""
    noisy = {
        name: values * (1 + 0.01 * (name == column) * np.sin(2.4 * np.arange(30))) for name, values in disc.items()
    }
    quiet, found = (own_table.read(written(tmp_path, columns)).error for columns in (disc, noisy))
    assert quiet < 1e-3 and 0.005 < found < 0.05


@pytest.mark.parametrize("row", [2, 9, 29])
@pytest.mark.parametrize("name", ["A", "lam", "p_max"])
def test_a_row_off_the_curve_of_the_others(tmp_path, name, row):
    """15 % are far more than the distance of a smooth curve, and the column still rises: the rows are far apart."""
    p = np.geomspace(1e-6, 0.03, 30)
    spots = laws.LAWS["disc_cell"].at(p, 1.0, Nbar=250_000.0, Ra=0.004)
    columns = {"p": p, "A": spots.A, "lam": spots.lam, "p_max": spots.p_max}
    columns[name] = np.where(np.arange(1, 31) == row, 0.85 * columns[name], columns[name])
    assert f"column {name}, row {row}: " in read(tmp_path, columns)


@pytest.mark.parametrize("gap", [2, 3, 5, 7])
def test_a_gap_that_noise_leaves_open(tmp_path, gap):
    """The rows are 1.3 apart, with noise of 3 %, and those of the gap 20: there any two curves part."""
    p = 1e-5 * np.cumprod([1, *np.where(np.arange(1, 8) == gap, 20, 1.3)])
    spots = laws.LAWS["disc_cell"].at(p, 1.0, Nbar=250_000.0, Ra=0.004)
    A = spots.A * (1 + 0.03 * np.sin(2.4 * np.arange(8)))
    message = read(tmp_path, {"p": p, "A": A, "lam": spots.lam, "p_max": spots.p_max})
    assert f"column A, rows {gap} and {gap + 1}: smooth curves through the rows differ by" in message
