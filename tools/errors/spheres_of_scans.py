"""What spheres of random heights err on a scan: six surfaces, the table of docs/roughness.md, Which law when.

    python tools/errors/spheres_of_scans.py

The real area and p_max of the surface itself, at p = 0.1 h'E* (h' is its rms slope), over those of `normal_heights`
with the numbers of `measure`; the error that the law of the surface states at this pressure; the same ratios and
λ h'E*/p with four times as many points along each side. It takes half a minute of a processor.
"""

import numpy as np

from solver.laws import LAWS
from study import roughness
from study.scan_laws.patch import Pressing, patch_of

#: Nominal pressure over h'E*, and the factors of the pressures beside it: a law has five rows or more. Points a pixel
#: along each side, of the finer contact.
PRESSURE, SHARES, FINER = 0.1, (0.5, 0.7, 1.0, 1.4, 2.0), 4
_RATIOS = ("area", "p_max", "finer area", "finer p_max", "theory")
_HEADING = """\
| surface | kurtosis | area | $p_{max}$ | error of the law | finer: area | $p_{max}$ | $\\lambda h'E^\\ast/p$ |
| --- | --- | --- | --- | --- | --- | --- | --- |"""


def surfaces() -> dict[str, roughness.Scan]:
    """Self-affine surfaces by Hurst exponent and shortest wave, of 128 × 128 points 0.1 µm apart. On the last two
    single points stand out."""
    smooth, fine = surface("0.8 um", hurst=0.8, seed=2), surface("0.4 um", hurst=0.8, seed=3)
    return {
        "H = 0.8, from 1.6 µm": surface("1.6 um", longest="12 um", hurst=0.8, seed=1),
        "H = 0.8, from 0.8 µm": smooth,
        "H = 0.8, from 0.4 µm": fine,
        "H = 0.5, from 0.4 µm": surface("0.4 um", hurst=0.5, seed=4),
        "the second, 5 spikes": spiked(smooth, 5, 4),
        "the third, 30 spikes": spiked(fine, 30, 8),
    }


def surface(shortest: str, **numbers) -> roughness.Scan:
    return roughness.self_affine((128, 128), "0.1 um", rms="20 nm", shortest=shortest, **numbers)


def spiked(scan: roughness.Scan, spikes: int, height: float) -> roughness.Scan:
    """The map with so many single points that stand out by about `height` of its standard deviations."""
    random, z = np.random.default_rng(0), scan.z.copy()
    z.flat[random.choice(z.size, spikes)] += height * z.std() * random.uniform(0.5, 1.5, spikes)
    return roughness.height_map(z, dx=scan.steps[1], steep=True)


def row(scan: roughness.Scan) -> dict[str, float]:
    """The numbers of a row of the table."""
    z, asperities = scan.z - scan.z.mean(), roughness.measure(scan, form="mean")
    p = PRESSURE * patch_of(scan, "mean", None, "given", 1, "row").slope
    law = roughness.law(scan, pressures=p * np.array(SHARES), form="mean", periodic="given", progress=False)
    patch = patch_of(scan, "mean", None, "given", FINER, "row")
    _, lam, p_max = Pressing(patch, None).at(p)
    numbers = {"Nbar": asperities.Nbar, "Ra": asperities.Ra, "sigma": asperities.sigma, "cut": asperities.cut}
    spheres = LAWS["normal_heights"].at(p, 1.0, **numbers)
    at = SHARES.index(1.0)
    return {
        "kurtosis": float((z**4).mean() / z.var() ** 2),
        "area": float(law.lam[at] / spheres.lam),
        "p_max": float(law.p_max[at] / spheres.p_max),
        "error": float(law.row_errors[at]),
        "finer area": float(lam / spheres.lam),
        "finer p_max": float(p_max / spheres.p_max),
        "theory": float(lam * patch.slope / p),
    }


def text_of(numbers: dict[str, float]) -> str:
    """The cells of a row, without its name."""
    area, p_max, *finer = (f"{numbers[name]:.2f}" for name in _RATIOS)
    return " | ".join([f"{numbers['kurtosis']:.1f}", area, p_max, f"{100 * numbers['error']:.0f} %", *finer])


def main() -> None:
    print(_HEADING)
    for name, scan in surfaces().items():
        print(f"| {name} | {text_of(row(scan))} |")


if __name__ == "__main__":
    main()
