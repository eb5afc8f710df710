"""The look of all figures."""

import io
import sys
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib import font_manager

import study
from study.__main__ import main
from study.figures.style import FONT, style

MANY_SWITCHES = 100  # settings of matplotlib 3.9 that are yes or no, or numbers: 158


def test_fonts_that_a_list_of_another_installation_lacks_are_added(monkeypatch):
    added = []
    monkeypatch.setattr(font_manager.fontManager, "addfont", lambda file: added.append(file.name))
    monkeypatch.setattr(font_manager.fontManager, "get_font_names", lambda: ["DejaVu Sans"])
    with style():
        assert matplotlib.rcParams["font.family"] == [FONT]
    assert {"STIXGeneral.ttf", "STIXGeneralItalic.ttf"} <= set(added)
    added.clear()
    monkeypatch.setattr(font_manager.fontManager, "get_font_names", lambda: [FONT])
    with style():
        assert not added


@pytest.fixture(scope="module")
def contacts():
    loads = np.geomspace(1e-6, 1e-3, 7)
    return study.solve(P=loads, nu2=[0.2, 0.3], micro="smooth", base="half_space", x=2, title="of a test")


def otherwise() -> dict:
    """Every setting that is yes or no the other way, every number by a third larger."""
    changed = {}
    for name in matplotlib.rcParamsDefault:
        if name in ("backend", "interactive"):
            continue
        value = matplotlib.rcParamsDefault[name]
        if isinstance(value, bool):
            changed[name] = not value
        elif isinstance(value, float) and value > 0:
            changed[name] = 1.3 * value
    return changed


#: What users have set: words, and what `otherwise` hides. Where there is no LaTeX, figures broke under text.usetex, and
#: with it text.parse_math means nothing.
SAVED = {"savefig.bbox": "tight", "savefig.transparent": True, "savefig.format": "svg", "savefig.dpi": 30}
SETTINGS = {"styles": ["dark_background", SAVED, {"text.parse_math": False}], "all": "all"}


def using(given):
    """A context in which matplotlib has other settings."""
    if given == "all":
        changed = otherwise()
        assert len(changed) > MANY_SWITCHES and changed["text.usetex"]
        return matplotlib.rc_context(changed)
    return matplotlib.style.context(given)


def images(figure) -> list[bytes]:
    """A figure of `study.plot` as notebooks show it, with and without pyplot, and as `savefig` writes it."""
    shown, saved = io.BytesIO(), io.BytesIO()
    figure.canvas.print_figure(shown, format="png", dpi=100, bbox_inches="tight", pad_inches=0.1)
    alone = figure._repr_png_()
    figure.savefig(saved)
    return [shown.getvalue(), alone, saved.getvalue()]


def written(contacts, folder: Path) -> list[bytes]:
    """The files of the command."""
    contacts.to_netcdf(folder / "contacts.nc")
    call = ["plot", f"{folder}/contacts.nc", "--x", "P", "--y", "p_max", "--hue", "nu2", "--figures", str(folder)]
    assert main(call) == 0
    return [(folder / f"contacts_p_max.{kind}").read_bytes() for kind in ("csv", "pdf", "png")]


def plotted(contacts):
    return study.plot(contacts, "P", "p_max", hue="nu2")


@pytest.fixture(scope="module")
def usual(contacts, tmp_path_factory):
    return images(plotted(contacts)), written(contacts, tmp_path_factory.mktemp("figures"))


@pytest.mark.parametrize("given", SETTINGS.values(), ids=SETTINGS)
def test_settings_of_the_user_change_no_figure(given, usual, contacts, tmp_path):
    assert all(image.startswith(b"\x89PNG") for image in usual[0])
    made_before = plotted(contacts)
    with using(given):
        before = dict(matplotlib.rcParams)
        assert images(plotted(contacts)) == usual[0]
        assert images(made_before) == usual[0]
        assert written(contacts, tmp_path) == usual[1]
        assert dict(matplotlib.rcParams) == before, "and they stay"


def test_plot_leaves_pyplot_alone(contacts, monkeypatch):
    """As the first use of it in a notebook `plot` switched later figures off, and was shown twice itself."""
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)  # importing it is an error
    assert study.plot(contacts, "P", "a")._repr_png_().startswith(b"\x89PNG")


CELLS = {
    "import study; c = study.solve(P=[1e-6, 1e-5], micro='smooth', base='half_space')": 0,
    "study.plot(c, 'P', 'a')": 1,
    "import matplotlib.pyplot as plt; plt.plot([1, 2]);": 1,
    "figure = study.plot(c, 'P', 'a')": 0,
    "for i in range(2): display(study.plot(c, 'P', 'D'))": 2,
    "plt.plot([3, 4]);": 1,
    "assert plt.figure().number == 1; plt.close()": 0,
    "study.plot(c, 'P', 'p_max')": 1,
}


def test_a_notebook_shows_each_figure_once(tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [sum("image/png" in found.get("data", {}) for found in cell.outputs) for cell in notebook.cells]
    assert shown == list(CELLS.values())
