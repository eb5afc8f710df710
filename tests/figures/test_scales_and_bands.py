"""Scales of the axes of `plot`, and the bands of ± where the abscissa is what has a spread."""

import numpy as np
import pytest
import xarray as xr
from drawn import frame, lines
from matplotlib.figure import Figure

import study
from study.figures.labels import wrapped
from study.figures.plots import drawn

LOADS = np.geomspace(1e-6, 1e-4, 5)


def smooth(**axes) -> xr.Dataset:
    return study.solve(micro="smooth", base="half_space", x=2, **axes)


def scales(dataset, x, y) -> tuple[str, str]:
    axes = drawn(dataset, x, y, "", {}, Figure)[0].axes[0]
    return axes.get_xscale(), axes.get_yscale()


@pytest.mark.parametrize(
    ("y", "factor", "expected"),
    [("D", 21.5, ("log", "linear")), ("P", 100.0, ("log", "log"))],
)
def test_the_ordinate_is_logarithmic_only_over_more_than_a_decade_and_a_half(y, factor, expected):
    """Over loads that grow by factors, D ~ P^(2/3). P against a, which grows by 4.6, is linear along a."""
    found = smooth(P=LOADS)
    assert float(found[y].max() / found[y].min()) == pytest.approx(factor, rel=2e-2)  # 21.5 is 100^(2/3)
    assert scales(found.assign(P2=found.P * 1.0) if y == "P" else found, "P", "P2" if y == "P" else y) == expected


def test_evenly_spaced_loads_and_what_may_be_zero():
    even = smooth(P=np.linspace(1e-6, 1e-4, 5))
    assert scales(even.assign(P2=even.P * 1.0), "P", "P2") == ("linear", "linear"), "though P2 grows a hundredfold"
    found = smooth(P=LOADS)
    assert scales(found, "P", "A0") == ("log", "linear"), "a smooth punch has A0 = 0"
    assert scales(found, "a", "P") == ("linear", "linear"), "a grows by less than a decade"
    for least in (0.0, -1e-6):
        partly = found.assign(P2=("P", [least, *LOADS[1:]]))
        assert scales(partly, "P", "P2") == ("log", "linear"), "a logarithm of it is not there"
    lost = found.assign(P2=("P", [np.nan, *(1e3 * LOADS[1:])]))
    assert scales(lost, "P", "P2") == ("log", "log"), "a failed case has no say"


def test_the_band_lies_across_where_the_abscissa_has_the_spread():
    """P was given and a follows from it: a ± its spread at each load, in the units of the axes."""
    ball = {"R": "5 mm", "E2": "210 ± 20 GPa", "base": "half_space", "micro": "smooth"}
    found = study.solve(**ball, P=["1 mN", "10 mN"], x=2)
    figure, columns = drawn(found, "a", "P", "", {}, Figure)
    assert frame(figure.axes[0])[0:3:2] == ("$a$, µm", "$P$, mN")
    (band,) = figure.axes[0].collections
    corners = {(round(x, 6), round(y, 6)) for x, y in band.get_paths()[0].vertices.tolist()}
    a, half = 1e6 * found.a.values, 1e6 * found.a_spread.values
    expected = {(round(x, 6), y) for sign in (-1, 1) for x, y in zip(a + sign * half, (1.0, 10.0), strict=True)}
    assert expected <= corners and half.min() > 0
    np.testing.assert_allclose(lines(figure.axes[0])[0].x, a, rtol=1e-14)  # one product
    np.testing.assert_array_equal(columns["a_spread [m]"], found.a_spread)


def test_the_line_above_a_figure_is_broken_where_it_is_full():
    """Texts of four letters and ", ": as many on a line as it holds, and one in any case. Signs of mathtext do not
    count."""
    texts = [f"$R_{i}$=1" for i in range(7)]  # printed as R0=1
    for most, count in ((5, 7), (6, 7), (11, 7), (12, 4), (18, 3), (41, 2), (42, 1)):
        found = wrapped(texts, most)
        assert found.count("\n") + 1 == count and found.replace(",\n", ", ").split(", ") == texts
