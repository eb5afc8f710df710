"""What a notebook shows of summaries, scans and roughness: the text, and a small picture that loads nothing."""

import re
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
import xarray as xr

import study
from study.specimen.pictures import curve, of_contact, show_in, with_picture


def picture(shown: str) -> np.ndarray:
    """The points of the only curve, (n, 2). Raises where the SVG is no XML."""
    (svg,) = re.findall(r"<svg.*</svg>", shown, flags=re.DOTALL)
    (line,) = [node for node in ElementTree.fromstring(svg).iter() if node.tag == "polyline"]
    return np.array([[float(number) for number in point.split(",")] for point in line.get("points").split()])


def test_a_summary_has_the_profile():
    contact = study.solve(P=1e-5, base="half_space", micro="smooth")
    shown = study.summary(contact)._repr_html_()
    points = picture(shown)
    assert len(points) == 33 and len(shown) < 30_000 and "currentColor" in shown
    height = 1 - points[:, 1] / points[-1, 1]
    assert height == pytest.approx(contact.p.values / contact.p0.item(), abs=0.002)
    assert "<svg" not in study.summary(contact.drop_vars("p"))._repr_html_()
    assert "<svg" not in study.summary(study.solve(P=[1e-5, 2e-5], base="half_space", micro="smooth"))._repr_html_()


def test_a_notebook_shows_a_contact_with_its_profile():
    contact = study.solve(P=1e-5, base="half_space", micro="smooth")
    shown = of_contact(contact)
    assert "xr-wrap" in shown, "what xarray shows"
    assert len(picture(shown.partition("</svg>")[0] + "</svg>")) == 33
    for other in (contact.drop_vars("p"), study.solve(P=[1e-5, 2e-5], base="half_space", micro="smooth")):
        assert not of_contact(other).startswith("<svg")
    assert not of_contact(xr.Dataset({"p": ("x", [1.0, 2.0])}, {"x": [0.0, 1.0]})).startswith("<svg")


class Formatter(dict):
    """As that of IPython, by the names of classes."""

    def for_type_by_name(self, module, name, function):
        self[f"{module}.{name}"] = function


def test_what_a_notebook_shows_already_is_left():
    shell = SimpleNamespace(display_formatter=SimpleNamespace(formatters={"text/html": Formatter()}))
    show_in(shell)
    assert shell.display_formatter.formatters["text/html"] == {f"{xr.Dataset.__module__}.Dataset": of_contact}
    shell.display_formatter.formatters["text/html"] = Formatter({"xarray.core.dataset.Dataset": str})
    show_in(shell)
    assert shell.display_formatter.formatters["text/html"] == {"xarray.core.dataset.Dataset": str}


def test_a_text_is_escaped():
    assert with_picture("b > 0.1 h & <b>") == '<pre style="white-space:pre-wrap">b &gt; 0.1 h &amp; &lt;b&gt;</pre>'
    assert "<script" not in curve([0, 1], [0, 1], "<script>", "y")


def test_scans_and_what_is_measured_of_them():
    random = np.random.default_rng(2)
    line = study.roughness.profile(random.normal(size=5000).cumsum() * 1e-9, dx=1e-7, name="wafer.csv")
    shown = line._repr_html_()
    points = picture(shown)
    assert len(points) == 200 and shown.startswith('<pre style="white-space:pre-wrap">wafer.csv: 5000 heights, 500 µm')
    highest = line.z.reshape(200, 25).mean(axis=1)
    assert np.corrcoef(-points[:, 1], highest)[0, 1] > 0.9999
    heights = random.normal(size=(64, 32))
    area = study.roughness.height_map(heights * 1e-9, dx=1e-7, dy=2e-7)
    assert "64 x 32 heights" in area._repr_html_() and len(picture(area._repr_html_())) == 32
    found = study.roughness.measure(line)
    assert found._repr_html_() == with_picture(str(found))


def test_nothing_is_drawn_of_no_numbers():
    assert curve([0.0, 1.0], [np.nan, 1.0], "x", "y") == ""
    assert len(picture(curve([0.0, 1.0, 2.0], [1.0, np.nan, 1.0], "x", "y"))) == 2
