"""The figure of a scan, its spots and its law: what the caption says of spheres."""

import matplotlib.pyplot as plt
import numpy as np

from study.studies.systems import scan_law


def test_what_is_drawn(monkeypatch):
    monkeypatch.setattr(scan_law, "SURFACE", scan_law.SURFACE | {"shape": (64, 64)})
    drawn, panels = plt.subplots(1, 3)
    columns = scan_law.scan_law(panels)
    covers = (columns["lam_scan"] > 0.1) & (columns["lam_scan"] < 0.5)
    assert np.all(columns["lam_scan"][covers] > 1.2 * columns["lam_spheres"][covers])
    assert np.all(columns["p_max_scan"] > columns["p"])
    assert [line.get_linestyle() for line in panels[2].lines] == ["-", "--"] * 2 + [":"]
    assert panels[2].lines[-1].get_xdata() == [scan_law.PRESSURE] * 2, "the pressure of the spots"
    heights, spots = (panel.images[0].get_array() for panel in panels[:2])
    assert heights.shape == spots.shape == (64, 64)
    assert 0.02 < 1 - np.ma.getmaskarray(spots).mean() < 0.3
    plt.close(drawn)
