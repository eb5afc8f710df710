"""Figure and tables of the work-precision study show what is in its dataset, number by number."""

import numpy as np
import pytest
import xarray as xr
from drawn import frame, legend, lines, texts, ticks
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from study.studies.evidence import tradeoff_view
from study.studies.evidence.tradeoff_view import work_precision

SETS = ("paper, layer", "paper, half-space", "coatings", "extremes")
LABELS = {  # of the ways that are curves, in the order of the legend
    "paper k = 0": "the paper's way, $k$ = 0",
    "paper k = 1": "the paper's way, $k$ = 1",
    "paper k = 2": "the paper's way, $k$ = 2",
    "paper k = 5": "the paper's way, $k$ = 5",
    "paper k = 20": "the paper's way, $k$ = 20",
    "paper k = 35": "the paper's way, $k$ = 35",
    "picard k = 2": "(8), (10) on Newton's nodes, $k$ = 2",
    "picard k = 20": "(8), (10) on Newton's nodes, $k$ = 20",
    "newton, nodes": "Newton, 8 to 32 nodes",
    "newton, rtol": "Newton, rtol $10^{-2}$ to $10^{-9}$",
    "auto": "base auto, accuracy 0.5 to $10^{-4}$",
}
DRAWN = ("paper k = 5", "paper k = 20", "paper k = 35", "picard k = 20", "newton, rtol", "auto")
"""The ways that the figure shows; the tables and the CSV have all."""
MODELS = {"the other law": "power law", "the other layer": "thin layer"}
WAYS = (*LABELS, *MODELS)
STEPS = 4


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    """Made-up measurements, all different; each set lacks a way, some ways a step, and a few cases did not end."""
    random = np.random.default_rng(5)
    shape = len(SETS), len(WAYS), STEPS
    arrays = {
        "setting": random.uniform(1, 9, shape),
        "time": 10 ** random.uniform(-5, -1, shape),
        "median": 10 ** random.uniform(-14, -1, shape),
        "most": 10 ** random.uniform(-11, -1, shape),
        "worst": 10 ** random.uniform(-9, 0, shape),
        "ended": random.choice([0.5, 0.949, 0.951, 0.985, 0.99, 1.0], shape),
    }
    arrays["most"][0, 9] = (9e-14, 2e-10, 2e-7, 2e-4)  # below what is told apart, first
    cases = random.integers(3, 60, shape[:2])
    for i in range(len(SETS)):
        cases[i, 7 - i] = 0
        for array in arrays.values():
            array[i, 7 - i] = array[i, 1 + i :: 5, STEPS - 1] = np.nan
    made = xr.Dataset({name: (("set", "way", "step"), array) for name, array in arrays.items()})
    made["cases"] = ("set", "way"), cases
    made["varied"] = "way", [f"size{i}" for i in range(len(WAYS))]
    return made.assign_coords(set=list(SETS), way=list(WAYS))


@pytest.fixture(scope="module")
def figure(found) -> Figure:
    figure = Figure()
    figure.shown = work_precision(figure.subplots(2, 2), found)
    return figure


def measured(found, name: str, way: str) -> tuple[np.ndarray, ...]:
    here = found.sel(set=name, way=way)
    known = np.isfinite(here.time.values)
    return tuple(here[kind].values[known] for kind in ("time", "most", "ended"))


def test_every_way_is_a_curve_of_error_against_time(figure, found):
    (box,) = figure.legends
    entries = legend(box)
    for name, axes in zip(SETS, figure.axes, strict=True):
        drawn = iter(lines(axes))
        for way in DRAWN:
            label = LABELS[way]
            time, error, ended = measured(found, name, way)
            if not len(time):
                continue
            curve, error = next(drawn), np.maximum(error, 1e-12)
            np.testing.assert_allclose(curve.x, 1e6 * time, rtol=1e-14)  # one product
            np.testing.assert_allclose(curve.y, error, rtol=1e-14)  # as drawn
            assert (curve.look.colour, curve.look.dashes) == (entries[label].colour, ("solid",))
            for where, face in ((ended >= 0.99, curve.look.colour), (ended < 0.99, "#ffffff")):
                if where.any():
                    marks = next(drawn)
                    np.testing.assert_allclose(marks.x, 1e6 * time[where], rtol=1e-14)  # one product
                    np.testing.assert_allclose(marks.y, error[where], rtol=1e-14)  # as drawn
                    assert (marks.look.marker, marks.look.colour) == (entries[label].marker, curve.look.colour)
                    assert (marks.look.face, marks.look.dashes) == (face, ())
        for line, way in zip(drawn, MODELS, strict=True):
            np.testing.assert_allclose(line.y, found["median"].sel(set=name, way=way)[0], rtol=1e-14)  # as drawn
            assert line.look == entries["a simpler model: error of half the cases"]


def test_a_model_that_was_not_measured_has_no_line(found):
    axes = Figure().subplots(2, 2)
    work_precision(axes, found.assign(median=found["median"].where(found["way"] != "the other law")))
    for name, panel in zip(SETS, axes.ravel(), strict=True):
        error = float(found["median"].sel(set=name, way="the other layer")[0])
        assert texts(panel) == {f"thin layer: {error:.1%}": (0.02, error)}


def test_labels_of_the_panels_and_of_the_legend(figure, found):
    for i, (name, axes) in enumerate(zip(SETS, figure.axes, strict=True)):
        time = "processor time per case (µs)" if i > 1 else ""
        error = "error, 95 % of the cases below" if i % 2 == 0 else ""
        assert frame(axes) == (time, "log", error, "log", name)
        assert axes.get_xlim() == (5, 4e6) and axes.get_ylim() == (5e-13, 3)
        assert len(ticks(axes)[1]) == 5
        np.testing.assert_allclose(axes.get_yticks(), [1e-12, 1e-9, 1e-6, 1e-3, 1])
        errors = {words: float(found["median"].sel(set=name, way=way)[0]) for way, words in MODELS.items()}
        assert texts(axes) == {f"{words}: {error:.1%}": (0.02, error) for words, error in errors.items()}
    entries = legend(figure.legends[0])
    open_mark, model = "open: fewer than 99 % ended", "a simpler model: error of half the cases"
    assert list(entries) == [*(LABELS[way] for way in DRAWN), open_mark, model]
    assert len({(entry.colour, entry.marker) for entry in entries.values()}) == len(entries)
    assert entries[open_mark].face == to_hex("white") and entries[model].dashes not in ((), ("solid",))


def test_columns_of_the_csv(figure, found):
    order = [(i, j, k) for i in range(len(SETS)) for j in range(len(WAYS)) for k in range(STEPS)]
    known = [place for place in order if np.isfinite(found["time"].values[place])]
    assert list(figure.shown) == ["set", "way", "cases", "setting", "time", "median", "most", "worst", "ended"]
    for column, axis in (("set", 0), ("way", 1)):
        assert figure.shown[column].tolist() == [place[axis] for place in known]
    assert figure.shown["cases"].tolist() == [found["cases"].values[place[:2]] for place in known]
    for column in list(figure.shown)[3:]:
        assert figure.shown[column].tolist() == [found[column].values[place] for place in known]


def cheapest(found, name: str, way: str, target: float) -> float:
    """µs: the quickest step with 95 % of the cases within the target and 95 % ended."""
    times = [t for t, e, ended in zip(*measured(found, name, way), strict=True) if e <= target and ended >= 0.95]
    return 1e6 * min(times, default=np.inf)


def test_the_cheapest_settings(found):
    targets = (1e-2, 1e-3, 1e-4, 1e-6, 1e-9)
    expected = []
    for name in SETS:
        for way in LABELS:
            if len(measured(found, name, way)[0]):
                times = [cheapest(found, name, way, target) for target in targets]
                expected.append((name, way, *("-" if time == np.inf else pytest.approx(time) for time in times)))
    assert tradeoff_view.cheapest(found) == expected


def test_the_papers_way_beside_newton(found):
    expected = []
    for target in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
        ways = [way for way in LABELS if way.startswith("paper")]
        time, way = min((cheapest(found, "paper, layer", way, target), way) for way in ways)
        newton = cheapest(found, "paper, layer", "newton, rtol", target)
        if time < np.inf:
            expected.append((target, pytest.approx(time), way[6:], pytest.approx(newton), pytest.approx(time / newton)))
    assert expected and tradeoff_view.factors(found) == expected
