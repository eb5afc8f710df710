"""The micro law of a scan itself, compared with the law of spheres that are measured on the scan."""

import numpy as np

from solver.laws import LAWS
from study import roughness
from study.figures.registry import TWO_COLUMNS, Columns, figure

#: A surface of Hurst exponent 0.8 with waves from 0.8 to 3.2 µm, 0.1 µm between points: spots are some points wide.
SURFACE = {"shape": (128, 128), "dx": "0.1 um", "hurst": 0.8, "rms": "20 nm", "shortest": "0.8 um", "seed": 2}
#: Nominal pressure of the map of spots, over E1*.
PRESSURE = 0.004
_BLUE, _RED = "#2878b8", "#dd5f21"


@figure("scan_law", size=(TWO_COLUMNS, 3.2), panels=(1, 3))
def scan_law(panels) -> Columns:
    """A scan and its law: (a) heights of a random self-affine surface; (b) where it touches a flat body at the nominal
    pressure 0.004 E1*, pressures from light to dark; (c) contact fraction and largest pressure of the scan itself
    (lines) and of spheres with the heights that are measured on it (dashes, `normal_heights`), which touch less
    from some ten spots on; dots: the pressure of (b)."""
    scan = roughness.self_affine(**SURFACE)
    of_scan = roughness.law(scan, periodic="given", form="mean", progress=False)
    of_spheres = spheres(scan, of_scan.p)
    spots = roughness.contact_map(scan, PRESSURE, periodic="given", form="mean")
    maps, curves = panels[:2], panels[2]
    extent = [0, 1e6 * scan.steps[1] * scan.z.shape[1]] * 2
    heights = maps[0].imshow(1e9 * scan.z, origin="lower", extent=extent, cmap="cividis")
    pressed = np.ma.masked_equal(spots.pressure.values, 0)
    pressures = maps[1].imshow(pressed, origin="lower", extent=extent, cmap="viridis_r", interpolation="none")
    for axes, image, letter, label in zip(maps, (heights, pressures), "ab", ("height (nm)", "$p/E_1^*$"), strict=True):
        axes.set(xlabel="x (µm)", ylabel="y (µm)")
        axes.set_title(f"({letter})", fontsize=9, loc="left")
        axes.figure.colorbar(image, ax=axes, label=label, location="bottom", shrink=0.9)
    for values_of_scan, values_of_spheres, colour, label in (
        (of_scan.lam, of_spheres.lam, _BLUE, r"$\lambda$"),
        (of_scan.p_max, of_spheres.p_max, _RED, r"$p_{\max}/E_1^*$"),
    ):
        curves.loglog(of_scan.p, values_of_scan, color=colour, linestyle="-", label=f"{label}, scan")
        curves.loglog(of_scan.p, values_of_spheres, color=colour, linestyle="--", label=f"{label}, spheres")
    curves.axvline(PRESSURE, ymin=0.45, color="0.6", linewidth=0.8, linestyle=":", label="$p$ of (b)")
    curves.set(xlabel="$p/E_1^*$")
    curves.set_title("(c)", fontsize=9, loc="left")
    curves.set_box_aspect(1)
    curves.legend(fontsize=7)
    return {
        "p": of_scan.p,
        **{f"{name}_scan": getattr(of_scan, name) for name in ("lam", "p_max")},
        **{f"{name}_spheres": getattr(of_spheres, name) for name in ("lam", "p_max")},
    }


def spheres(scan: roughness.Scan, p: np.ndarray):
    """A, λ and p_max of spheres of random heights that are measured on a scan; p : pressures over E1*."""
    asperities = roughness.measure(scan, form="mean")
    numbers = {"Nbar": asperities.Nbar, "Ra": asperities.Ra, "sigma": asperities.sigma, "cut": asperities.cut}
    return LAWS["normal_heights"].at(p, 1.0, **numbers)
