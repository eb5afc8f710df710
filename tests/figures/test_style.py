"""The look of all figures."""

import matplotlib
from matplotlib import font_manager

from study.figures.style import FONT, style


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
