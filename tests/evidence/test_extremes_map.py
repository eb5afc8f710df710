"""Figure and table of the extremes show their datasets."""

import numpy as np
import pytest
from conftest import opened
from drawn import frame, legend, lines, mesh
from matplotlib.figure import Figure

from solver import Status
from study.studies.evidence.extremes_map import BINS, ROWS, binned, maps, shares


@pytest.fixture(scope="module")
def datasets(results):
    """The two studies, with some cases that failed or have no solution, and a largest error."""
    found = [opened(results / f"{name}.nc") for name in ("extremes", "extremes_layered")]
    half_space, thin_layer = ({"base": base, "micro": 1} for base in (0, 1))
    found[0]["status"][half_space] = [Status.CONVERGED, Status.DIVERGED, Status.LIFT_OFF]
    found[0]["status"][thin_layer] = [Status.TOLERANCE_NOT_MET, Status.THIN_LAYER_NOT_APPLICABLE, Status.CONVERGED]
    found[0]["error"][thin_layer] = [1e-3, np.nan, 7e-7]
    found[0]["iterations"][thin_layer] = [99, 0, 5]
    found[1]["error"].loc[{"micro": "power_law"}] = [1e-7, 5e-7, 3e-7]
    found[1]["iterations"].loc[{"micro": "power_law"}] = [7, 9, 30]
    return found


def test_table_counts_every_case(datasets):
    rows = {row[:2]: row[2:] for row in shares(*datasets)}
    assert len(rows) == 9
    third = 1 / 3
    assert rows["half-space", "disc cell"][:7] == (3, 0, third, 0, 0.5, 0, 0.5)
    assert rows["thin layer", "disc cell"] == (3, third, 0, 0, 0.5, 0.5, 0, *[pytest.approx(0.7)] * 3, 5, 5)
    # of three: the median, and 0.998 of the way from it to the largest
    assert rows["exact layer", "power law"] == (3, 0, 0, 0, 1, 0, 0, *map(pytest.approx, (0.3, 0.4996, 0.5)), 9, 30)
    assert rows["half-space", "smooth"][:7] == rows["exact layer", "smooth"][:7] == (3, 0, 0, 0, 1, 0, 0)
    assert rows["exact layer", "disc cell"][3] == np.mean(datasets[1].status.sel(micro="disc_cell") == 10) > 0


def test_maps_hold_every_case_once(drawing, results):
    _, columns, _ = drawing("extremes")
    assert (columns["cases"] > 0).all() and set(columns["row"]) == set(range(len(ROWS)))
    for i, (base, *_) in enumerate(ROWS):
        found = opened(results / ("extremes_layered.nc" if base == "layered" else "extremes.nc"))
        assert columns["cases"][columns["row"] == i].sum() == found.sizes["case"] * found.sizes["micro"]
    assert columns["largest error/rtol"].max() <= 1


def test_a_cell_without_a_converged_case_has_no_error(datasets):
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


# Base, parameters and labels of the abscissa and of the ordinate.
SHOWN = (
    ("half_space", "P", "N Ra^2", r"$P/(E_2^* R^2)$", "half-space\n$\\bar N R_a^2$"),
    ("thin_layer", "P", "N Ra^2", r"$P/(E_2^* R^2)$", "thin layer\n$\\bar N R_a^2$"),
    ("thin_layer", "h", "n", "$h/R$", "thin layer\n$n$"),
    ("layered", "P", "N Ra^2", r"$P/(E_2^* R^2)$", "exact layer\n$\\bar N R_a^2$"),
    ("layered", "h", "n", "$h/R$", "exact layer\n$n$"),
)
WORDS = {
    "converged": 0,
    "thin layer not applicable": 4,
    "lift off": 8,
    "outside law": 10,
    "diverged": 3,
    "tolerance not met": 5,
}


@pytest.fixture(scope="module")
def figure(datasets) -> Figure:
    figure = Figure()
    figure.shown = maps(figure.subplots(len(ROWS), 3), *datasets)
    return figure


def cases_of(datasets, base: str) -> list[dict]:
    """The cases on one base, one by one."""
    found = datasets[1] if base == "layered" else datasets[0].sel(base=base)
    found = found.assign({"N Ra^2": found["Nbar"] * found["Ra"] ** 2, "ratio": found["error"] / found["rtol"]})
    names = ("P", "h", "n", "N Ra^2", "ratio", "status", "iterations")
    return [
        {name: float(one[name].sel(micro=law) if "micro" in one[name].dims else one[name]) for name in names}
        for i in range(found.sizes["case"])
        for one in [found.isel(case=i)]
        for law in found["micro"].values
    ]


def test_points_are_the_cases_by_their_status(figure, datasets):
    entries = legend(figure.legends[0])
    assert list(entries) == list(WORDS) and len({entry.colour for entry in entries.values()}) == len(WORDS)
    for axes, (base, x, y, _, _) in zip(figure.axes[: 3 * len(SHOWN) : 3], SHOWN, strict=True):
        drawn, cases = lines(axes), cases_of(datasets, base)
        for word, value in WORDS.items():
            points = [
                (a, b)
                for line in drawn
                if line.look.colour == entries[word].colour
                for a, b in zip(line.x, line.y, strict=True)
            ]
            expected = [(case[x], case[y]) for case in cases if case["status"] == value]
            # as drawn
            np.testing.assert_allclose(sorted(points), sorted(expected), rtol=1e-14, err_msg=f"{base}, {word}")
        assert sum(len(line.x) for line in drawn) == len(cases)
        assert drawn[0].look.colour == entries["converged"].colour, "the others are drawn over them"


def test_cells_are_coloured_by_median_error_and_most_iterations(figure, datasets):
    """Both of the converged cases; a cell without one is left grey."""
    for i, (base, x, y, _, _) in enumerate(SHOWN):
        cases = cases_of(datasets, base)
        cells = {}
        for case in cases:
            if case["status"] == 0:
                cells.setdefault(tuple(place(case[name], [c[name] for c in cases]) for name in (y, x)), []).append(case)
        for axes, name, reduce, least in zip(
            figure.axes[3 * i + 1 : 3 * i + 3], ("ratio", "iterations"), (np.median, max), (1e-8, 1), strict=True
        ):
            image = mesh(axes).get_array().reshape(BINS, BINS)
            assert set(zip(*np.nonzero(~np.ma.getmaskarray(image)), strict=True)) == set(cells)
            for cell, held in cells.items():
                # as drawn
                assert image[cell] == pytest.approx(max(reduce([case[name] for case in held]), least), rel=1e-12)
            corners = mesh(axes).get_coordinates()
            for k, parameter in enumerate((x, y)):
                values = [case[parameter] for case in cases]
                edges = np.exp(np.linspace(np.log(min(values)), np.log(max(values)), BINS + 1))
                np.testing.assert_allclose(  # exponentials of logarithms down to -28
                    corners[:, :, k], [edges] * (BINS + 1) if k == 0 else edges[:, None].repeat(BINS + 1, 1), rtol=1e-12
                )


def place(value: float, values: list[float]) -> int:
    share = np.log(value / min(values)) / np.log(max(values) / min(values))
    return min(int(BINS * share), BINS - 1)


def test_scales_of_colours_and_axes(figure, datasets):
    titles = ("status", "error / rtol, median", "iterations, largest")
    for i, (base, x, y, xlabel, ylabel) in enumerate(SHOWN):
        cases = cases_of(datasets, base)
        for j, axes in enumerate(figure.axes[3 * i : 3 * i + 3]):
            assert frame(axes) == (xlabel, "log", ylabel if j == 0 else "", "log", titles[j] if i == 0 else "")
            for limits, name in ((axes.get_xlim(), x), (axes.get_ylim(), y)):
                values = [case[name] for case in cases]
                assert limits == (pytest.approx(min(values)), pytest.approx(max(values)))
        errors, iterations = (mesh(axes).norm for axes in figure.axes[3 * i + 1 : 3 * i + 3])
        assert (errors.vmin, errors.vmax) == (1e-8, 1) and errors(1e-4) == pytest.approx(0.5), "logarithmic"
        assert iterations.boundaries.tolist() == [1, 5, 10, 15, 20, 30, 50, 100, 200, 500]
    assert len(figure.axes) == 3 * len(SHOWN) + 2, "two bars of colours"
