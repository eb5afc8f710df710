"""Maps of contacts over two axes, and scale and limits of curves."""

import csv
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import LogNorm
from numpy.testing import assert_allclose

import study
from study.__main__ import main

AXES = {"P": [1e-6, 1e-5, 1e-3], "h": [0.1, 0.01], "bonding": ["bonded", "frictionless"]}


@pytest.fixture(scope="module")
def contacts() -> xr.Dataset:
    return study.solve(**AXES, n=0.5, micro="smooth", x=2, profiles=False)


def test_a_map_has_the_numbers_and_hatches_what_is_not_valid(contacts):
    figure = study.plot(contacts, "h", "P", colour="p0", bonding="bonded")
    axes, bar = figure.axes
    shades, hatched = axes.collections
    expected = contacts.p0.sel(bonding="bonded").sortby("h").transpose("P", "h").values
    assert_allclose(shades.get_array(), expected, rtol=1e-12)
    validity = contacts.validity.sel(bonding="bonded")
    cells = hatched.get_paths()  # its array is all cells or those drawn, by the version of matplotlib
    drawn = [[any(cell.contains_point((h, P)) for cell in cells) for P in contacts.P.values] for h in contacts.h.values]
    valid = validity.transpose("h", "P").values == 0
    assert 0 < valid.sum() < valid.size and (valid == ~np.array(drawn)).all() and hatched.get_hatch()
    assert axes.get_xlabel() == "$h/R$" and "p(0)" in bar.get_ylabel() and axes.get_yscale() == "log"


def test_scale_and_limits_of_a_map(contacts):
    shades = study.plot(contacts, "h", "P", colour="a", bonding="bonded", scale="log", limits=(0.01, 0.05)).axes[0]
    norm = shades.collections[0].norm
    assert isinstance(norm, LogNorm) and (norm.vmin, norm.vmax) == (0.01, 0.05)
    plain = study.plot(contacts, "h", "P", colour="a", bonding="bonded", scale="linear").axes[0].collections[0].norm
    assert not isinstance(plain, LogNorm) and plain.vmax == contacts.a.sel(bonding="bonded").max()


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_scale_and_limits_of_curves_with_units():
    lining = {"R": "5 mm", "layer": "PTFE", "body": "steel 52100", "bonding": "bonded", "micro": "smooth"}
    loads = study.solve(**lining, h="1 mm", P=["0.1 N", "0.2 N"], x=2, profiles=False)
    axes = study.plot(loads, "P", "p0", scale="log", limits=("1 MPa", 1e8)).axes[0]
    assert axes.get_yscale() == "log" and close(axes.get_ylim(), (1, 100))


def close(*pair) -> bool:
    return np.allclose(*pair, rtol=1e-12)


@pytest.mark.parametrize(
    ("x", "y", "more", "message"),
    [
        ("h", "P", {"colour": "p0"}, "one of bonding (2)"),
        ("h", "n", {"colour": "p0", "bonding": "bonded"}, "n is none; there are P, h"),
        ("h", "P", {"colour": "q"}, '"q" is not in these results'),
        ("h", "P", {"colour": "p0", "hue": "bonding"}, "a map has no hue"),
        ("h", "P", {"colour": "p0", "bonding": "bonded", "scale": "cubic"}, "must be linear or log"),
        ("h", "P", {"colour": "p0", "bonding": "bonded", "limits": (2, 1)}, "must be two, the lower first"),
        ("h", "P", {"colour": "p0", "bonding": "bonded", "limits": (0, 1), "scale": "log"}, "not above 0"),
    ],
)
def test_what_is_refused(contacts, x, y, more, message):
    with pytest.raises(study.StudyError) as error:
        study.plot(contacts, x, y, **more)
    assert message in str(error.value)


def test_a_map_from_the_command_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = '[model]\nmicro = "smooth"\nn = 0.5\n[axes]\nP = [1e-6, 1e-5]\nh = [0.01, 0.02]\n'
    Path("mine.toml").write_text(text, encoding="utf-8")
    words = "plot mine.toml --run --x h --y P --colour a --limits 0.001,0.1 --scale log"
    assert main(words.split()) == 0
    with open("figures/mine_a.csv", encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    a = study.open_results("results/mine.nc").a
    assert [cell.split()[0].split("/")[0] for cell in heading] == ["h", "P", "a", "valid"] and len(rows) == 4
    for h, P, value, _ in np.array(rows, float):
        assert value == a.sel(h=h, P=P).item()
