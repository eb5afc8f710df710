"""The error of a law of a scan encloses what finer points change: four points a pixel along each side are the truth."""

import numpy as np
import pytest

from study import roughness
from study.scan_laws.patch import Pressing, patch_of


def self_affine(shortest, **numbers):
    return roughness.self_affine((64, 64), "0.1 um", rms="20 nm", shortest=shortest, **numbers)


def spiked():
    """Single points that stand out: the Fourier series between them is wider and higher than they are."""
    scan, random = self_affine("0.8 um", hurst=0.8, seed=2), np.random.default_rng(0)
    z = scan.z.copy()
    z.flat[random.choice(z.size, 5)] += 4 * z.std()
    return roughness.height_map(z, dx=1e-7, steep=True)


def paraboloids():
    """Sixteen summits of random heights, which meet in grooves that no series follows."""
    x = np.arange(64)
    heights = np.random.default_rng(1).uniform(0, 2e-8, (4, 4))[x // 16][:, x // 16]
    away = (x + 0.5) / 16 % 1 - 0.5
    return roughness.height_map(heights - (away**2 + away[:, None] ** 2) * 2e-7, dx=1e-7)


SURFACES = {
    "H = 0.8, 8 points a wave": lambda: self_affine("0.8 um", hurst=0.8, seed=1),
    "H = 0.8, 4 points a wave": lambda: self_affine("0.4 um", hurst=0.8, seed=3),
    "H = 0.5, 2 points a wave": lambda: self_affine("0.2 um", hurst=0.5, seed=4),
    "spiked": spiked,
    "paraboloids": paraboloids,
}


@pytest.mark.parametrize("name", SURFACES)
def test_it_encloses_finer_points(name):
    """From λ = 0.001 on; where it counts for the law as a whole, from 0.01, the error of the points alone does. Twice
    what half the distance changes does not enclose the paraboloids: their tops lie midway between points."""
    scan = SURFACES[name]()
    slope = patch_of(scan, "mean", None, "given", 1, "law").slope
    pressures = np.array([0.5e-3, 2e-3, 0.01, 0.05, 0.2]) * slope
    of_scan = roughness.law(scan, pressures=pressures, periodic="given", form="mean", progress=False)
    fine = Pressing(patch_of(scan, "mean", None, "given", 4, "law"), None)
    truth = np.array([fine.at(p) for p in pressures]).T
    off = np.abs(np.log(truth / [of_scan.A, of_scan.lam, of_scan.p_max])).max(axis=0)
    print(name, "off", np.round(off, 3), "errors", np.round(of_scan.row_errors, 3), of_scan.errors)
    assert (off < np.log1p(of_scan.row_errors)).all()
    counts = of_scan.lam >= 0.01
    assert off[counts].max() < np.log1p(of_scan.errors["pixel"])
    assert of_scan.error == max(of_scan.errors.values()) < 3


def test_under_resolved_spots_are_said_with_their_error():
    scan = self_affine("0.2 um", hurst=0.5, seed=4)
    of_scan = roughness.law(scan, periodic="given", form="mean", progress=False)
    note = next(note for note in of_scan.notes if "fewer than 4 points" in note)
    assert "under-resolved" in note and "λ mostly too large" in note
    assert of_scan.lam[0] < 1.4e-3 and of_scan.row_errors[0] > of_scan.error > 0.1
