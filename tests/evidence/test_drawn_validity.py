"""The maps of the thin layer's error: bands, lines, hatching, stars and estimates against the datasets."""

import numpy as np
import pytest
import xarray as xr
from conftest import opened
from drawn import contours, frame, legend, lines, same_contours, texts, ticks
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure

from solver.models.thin_layer_error import thin_layer_error

# Figure -> its rows: symbol, micro law, quantity.
ROWS = {
    "validity": (
        ("$a$", "disc_cell", "a"),
        ("$p(0)$", "disc_cell", "p0"),
        ("$D$", "disc_cell", "D"),
        ("$A_r/A_n$", "disc_cell", "Ar_An"),
        (r"$p_{\max}$", "disc_cell", "p_max"),
    ),
    "validity_load": (("$P$, smooth", "smooth", "P"), ("$P$, rough", "disc_cell", "P")),
}
# Title -> Poisson ratios, interface, in the order of the studies.
MATERIALS = {
    "frictionless": (0.3, 0.3, False),
    r"bonded, $\nu = 0$": (0.0, 0.0, True),
    r"bonded, $\nu = 0.3$": (0.3, 0.3, True),
    r"bonded, $\nu = 0.45$": (0.45, 0.45, True),
    "bonded, $\\nu_1 = 0.45$,\n$\\nu_2 = 0.3$": (0.45, 0.3, True),
}
BANDS = {  # words of the legend -> error
    "more than 10 % too small": (-10, -0.1),
    "1 to 10 % too small": (-0.1, -0.01),
    "within 1 %": (-0.01, 0.01),
    "1 to 10 % too large": (0.01, 0.1),
    "more than 10 % too large": (0.1, 10),
}
FIGURES = pytest.mark.parametrize("name", ROWS)


def panels(drawing, results, name: str) -> list[tuple]:
    """(axes, row, number of the material, the dataset of the panel) of every panel."""
    figure, _, _ = drawing(name)
    found = opened(results / f"{name}.nc")
    axes = np.reshape(figure.axes, (len(ROWS[name]), 5))
    return [
        (axes[i, j], i, j, found.sel(micro=micro).isel(case=j))
        for i, (_, micro, _) in enumerate(ROWS[name])
        for j in range(5)
    ]


def shown(case: xr.Dataset, quantity: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """h/a of the exact layer, n and error over (n, h)."""
    case = case[["a", quantity]].transpose("n", "h", "base", missing_dims="ignore")
    (thin,) = np.flatnonzero(case.base.values == "thin_layer")
    (exact,) = np.flatnonzero(case.base.values == "layered")
    a, values = case.a.values, case[quantity].values
    h_a = case.h.values / a[..., exact] if a.ndim else np.tile(case.h.values / a, (case.sizes["n"], 1))
    return h_a, np.tile(case.n.values[:, None], case.sizes["h"]), values[..., thin] / values[..., exact] - 1


@FIGURES
def test_bands_and_lines_are_those_of_the_error(drawing, results, name):
    for axes, i, j, case in panels(drawing, results, name):
        bonding = str(case.bonding.values) == "bonded"
        assert (float(case.nu1), float(case.nu2), bonding) == list(MATERIALS.values())[j]
        h_a, n, error = shown(case, ROWS[name][i][2])
        rows = np.isfinite(error).all(1)
        assert rows.all() == (j < 4), "the last material has no thin layer for n = 0.95"
        trial = Figure().subplots()
        trial.set(xscale="log", yscale="log")
        grid = h_a[rows], n[rows], error[rows]
        assert np.abs(error[rows]).max() < 10, "no gap beyond the last band"
        filled, edges, *estimate = contours(axes)
        assert same_contours(filled, trial.contourf(*grid, [-10, -0.1, -0.01, 0.01, 0.1, 10]))
        assert same_contours(edges, trial.contour(*grid, [-0.1, -0.01, 0.01, 0.1]))
        assert len(estimate) == (name == "validity_load" and i == 0)


def test_the_estimate_is_that_of_the_load_on_each_material(drawing, results):
    for axes, i, j, _ in panels(drawing, results, "validity_load"):
        if i == 0:
            x, n = np.geomspace(0.01, 20, 200), np.geomspace(0.01, 0.95, 100)
            nu1, nu2, bonded = list(MATERIALS.values())[j]
            error = np.ma.masked_invalid(thin_layer_error(x, n[:, None], nu1, nu2, bonded).P)
            expected = Figure().subplots().contour(x, n, error, [-0.1, -0.01, 0.01, 0.1])
            assert same_contours(contours(axes)[2], expected)


@FIGURES
def test_hatched_where_the_thin_layer_does_not_apply(drawing, results, name):
    for axes, _, j, case in panels(drawing, results, name):
        assert len(axes.patches) == (j == 4)
        for patch in axes.patches:
            box = patch.get_path().get_extents(patch.get_patch_transform())
            refused = (case.status.sel(base="thin_layer") == 4).all("h")
            assert (box.y0, box.y1) == (float(case.n[~refused].max()), 1)
            assert (box.x0, box.x1) == (0, 1), "from side to side"
            assert patch.get_hatch() == "////"


@FIGURES
def test_a_star_at_the_papers_main_case(drawing, results, name):
    """Without friction, n = 0.5, h = 0.02 over the radius of the exact layer there: 0.04 where it is given."""
    for axes, _, j, case in panels(drawing, results, name):
        assert len(lines(axes)) == (j == 0)
        for star in lines(axes):
            a = 0.04
            if name == "validity":
                nearest = case.sel(base="layered").isel(n=int(np.argmin(np.abs(case.n.values - 0.5))))
                a = float(np.interp(0.02, case.h, nearest.a))
            assert star.x == pytest.approx(0.02 / a) and star.y == 0.5 and star.look.marker == "*"


@FIGURES
def test_labels_of_the_maps(drawing, results, name):
    last = len(ROWS[name]) - 1
    for axes, i, j, _ in panels(drawing, results, name):
        title = list(MATERIALS)[j] if i == 0 else ""
        assert frame(axes) == ("$h/a$" if i == last else "", "log", "$n$" if j == 0 else "", "log", title)
        assert list(texts(axes)) == ([ROWS[name][i][0]] if j == 0 else [])
        assert axes.get_xlim() == (0.01, 20) and axes.get_ylim() == (0.01, 0.95)
        assert axes.xaxis.get_major_ticks()[0].label1.get_visible() == (i == last)
        assert axes.yaxis.get_major_ticks()[0].label1.get_visible() == (j == 0)
        if j == 0 and i == last:
            assert ticks(axes) == (["0.01", "0.1", "1", "10"], ["0.01", "0.1"])


@FIGURES
def test_the_legend_names_every_band_by_its_colour(drawing, results, name):
    figure, _, _ = drawing(name)
    (box,) = figure.legends
    entries = legend(box)
    rest = ["does not apply, $C \\leq 0$", "the paper's main case"]
    rest += ["estimate, $\\pm 1$ and $\\pm 10$ %"] if name == "validity_load" else []
    assert list(entries) == [*BANDS, *rest]
    for axes, i, _, _ in panels(drawing, results, name):
        filled, _, *estimate = contours(axes)
        between = list(zip(filled.levels, filled.levels[1:], strict=False))
        colours = {edges: to_hex(colour) for edges, colour in zip(between, filled.get_facecolor(), strict=True)}
        assert colours == {edges: entries[words] for words, edges in BANDS.items()}
        lightness = [sum(to_rgb(colour)) for colour in colours.values()]
        assert lightness[0] < lightness[1] < lightness[2] > lightness[3] > lightness[4], "the darker, the worse"
        for line in estimate:
            assert (to_hex(line.get_edgecolor()[0]), i) == (entries[rest[2]].colour, 0)
            assert line.get_linestyle()[0][1] == pytest.approx([0.9 * dash for dash in entries[rest[2]].dashes])
    assert entries["the paper's main case"].marker == "*"
    assert len({str(entry) for entry in entries.values()}) == len(entries)


@FIGURES
def test_the_csv_holds_the_errors(drawing, results, name):
    _, columns, _ = drawing(name)
    assert list(columns) == ["row", "material", "h/a", "n", "error"]
    count = 0
    for _, i, j, case in panels(drawing, results, name):
        at = (columns["row"] == i) & (columns["material"] == j)
        values = shown(case, ROWS[name][i][2])
        for head, expected in zip(("h/a", "n", "error"), values, strict=True):
            # the same arithmetic
            np.testing.assert_allclose(columns[head][at], expected[np.isfinite(values[2])], rtol=1e-13)
        count += at.sum()
    assert count == len(columns["error"])
