"""The loop of a bead on a gel has the look of the other figures, and says which assumption its contacts break."""

import numpy as np
import pytest
from drawn import frame, lines
from matplotlib.figure import Figure

import study
from study.rules.rule import RULES
from study.studies.systems.adhesion import loop

BEAD = {"R": "5 um", "punch": "rigid", "E1": "5 kPa", "nu1": 0.49, "h": "5 um", "body": "glass soda-lime"}
BEAD |= {"bonding": "bonded", "micro": "smooth", "w_adhesion": "1 mJ/m^2", "k_machine": ["0.02 N/m", "0.2 N/m"]}


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
def test_the_loop_of_a_bead():
    contacts = study.solve(**BEAD, a=[f"{a} um" for a in np.linspace(0.5, 4, 15)], profiles=False, x=2)
    panels = Figure().subplots(1, 2)
    columns = loop(panels, contacts)
    assert bool((contacts.validity == 32).all())
    for axes, k in zip(panels, ("0.02", "0.2"), strict=True):
        assert frame(axes)[0:3:2] == ("$D$, µm", "$P$, nN")
        assert axes.get_title("left") == f"all contacts: {RULES['strain_not_small'].text}" and axes.get_title() == ""
        assert [text.get_text() for text in axes.texts] == [f"$k$ = {k} N/m"]
        curve, approach, retraction = lines(axes)[:3]
        np.testing.assert_allclose(curve.y, contacts.P.sel(k_machine=float(k)) * 1e9, rtol=1e-12)
        for line, way in ((approach, 0), (retraction, 1)):
            shown = (columns["k (N/m)"] == float(k)) & (columns["retraction"] == way)
            np.testing.assert_allclose(line.x, columns["D (m)"][shown] * 1e6, rtol=1e-12)
    entries = [text.get_text() for text in panels[0].get_legend().get_texts()]
    assert entries == ["all contacts", "approach", "retraction"]
