"""Figure and table of the extremes show their datasets."""

import csv

import numpy as np
import pytest

from solver import Status
from study import open_results
from study.extremes_map import BINS, ROWS, binned, maps, shares
from study.recipes import draw


@pytest.fixture(scope="module")
def datasets(results):
    """The two studies, with some cases that failed or have no solution, and a largest error."""
    found = [open_results(results / f"{name}.nc") for name in ("extremes", "extremes_layered")]
    half_space, thin_layer = ({"base": base, "micro": 1} for base in (0, 1))
    found[0]["status"][half_space] = [Status.CONVERGED, Status.DIVERGED, Status.LIFT_OFF]
    found[0]["status"][thin_layer] = [Status.TOLERANCE_NOT_MET, Status.THIN_LAYER_NOT_APPLICABLE, Status.CONVERGED]
    found[0]["error"][thin_layer] = [1e-3, np.nan, 7e-7]
    found[0]["iterations"][thin_layer] = [99, 0, 5]
    return found


def test_table_counts_every_case(datasets):
    rows = {row[:2]: row[2:] for row in shares(*datasets)}
    assert len(rows) == 9
    third = 1 / 3
    assert rows["half-space", "disc cell"][:6] == (3, 0, third, 0.5, 0, 0.5)
    assert rows["thin layer", "disc cell"] == (3, third, 0, 0.5, 0.5, 0, *[pytest.approx(0.7)] * 3, 5, 5)
    assert rows["half-space", "smooth"][:6] == rows["exact layer", "smooth"][:6] == (3, 0, 0, 1, 0, 0)


def test_maps_hold_every_case_once(results, tmp_path):
    with open(draw("extremes", results, tmp_path)[0], encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    columns = dict(zip(head, np.array(rows, dtype=float).T, strict=True))
    assert (columns["cases"] > 0).all() and set(columns["row"]) == set(range(len(ROWS)))
    for i, (base, *_) in enumerate(ROWS):
        found = open_results(results / ("extremes_layered.nc" if base == "layered" else "extremes.nc"))
        assert columns["cases"][columns["row"] == i].sum() == found.sizes["case"] * found.sizes["micro"]
    assert columns["largest error/rtol"].max() <= 1


def test_a_cell_without_a_converged_case_has_no_error(datasets):
    from matplotlib.figure import Figure

    broken = datasets[0].copy(deep=True)
    broken["status"][{"case": 0}] = Status.DIVERGED
    columns = maps(Figure().subplots(len(ROWS), 3), broken, datasets[1])
    none = columns["converged"] == 0
    assert none.any() and not none.all()
    for name, values in columns.items():
        wanted = none if name.split()[-1] in ("error/rtol", "iterations") else none & False
        np.testing.assert_array_equal(np.isnan(values), wanted, err_msg=name)


def test_cells_take_median_and_largest_of_the_converged():
    edges = [np.geomspace(1, 2**BINS, BINS + 1)] * 2
    middle, last = 2.0**0.5, 2.0 ** (BINS - 0.5)
    cases = {
        "x": np.array([middle] * 4 + [last, last, 2.0**BINS]),
        "y": np.array([last] * 4 + [middle, middle, 1.0]),
        "status": np.array([0, 0, 0, Status.DIVERGED, Status.TOLERANCE_NOT_MET, Status.LIFT_OFF, 0]),
        "error/rtol": np.array([0.1, 0.2, 0.9, np.nan, 30.0, np.nan, 0.5]),
        "iterations": np.array([3, 5, 4, 99, 88, 77, 6]),
    }
    found = {name: values.reshape(BINS, BINS) for name, values in binned(cases, "x", "y", edges).items()}
    first, other = (0, BINS - 1), (BINS - 1, 0)
    counts = ("cases", "converged", "failed", "largest iterations")
    assert [found[name][first] for name in counts] == [4, 3, 1, 5]
    assert [found[name][other] for name in counts] == [3, 1, 1, 6]
    assert (found["median error/rtol"][first], found["largest error/rtol"][first]) == (0.2, 0.9)
    assert found["cases"].sum() == 7 and np.isnan(found["median error/rtol"]).sum() == BINS**2 - 2
    assert found["x"][first] == pytest.approx(middle) and found["y"][first] == pytest.approx(last)


def test_points_and_legend_name_the_statuses(datasets):
    from matplotlib.figure import Figure

    figure = Figure()
    panels = figure.subplots(len(ROWS), 3)
    maps(panels, *datasets)
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words == ["converged", "thin layer not applicable", "lift off", "diverged", "tolerance not met"]
    drawn = sum(len(line.get_xdata()) for line in panels[0, 0].lines)
    assert drawn == datasets[0].sizes["case"] * 3
