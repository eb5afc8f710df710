#!/bin/sh
# ContactMechanics 1.8.3: PeriodicFFTElasticHalfSpace(..., thickness=h) is an elastic layer on a rigid base. With one dimension,
# nb_grid_pts=(n,), a profile in plane strain, the thickness is taken and ignored: the profile presses a half-space. The same
# wave on a map that is constant along y, nb_grid_pts=(n, 8), presses the layer. A wave of period 1 and amplitude 0.01 under a
# mean pressure of 0.005 (E = 1, nu = 0.3) gives
#
#                       contact area          largest pressure
#     thickness       (64,)    (64, 8)        (64,)     (64, 8)
#     none            0.266     0.266         0.0263    0.0263
#     0.05            0.266     0.172         0.0263    0.0414
#     0.02            0.266     0.141         0.0263    0.0566
#
# without a warning; the solver converges in all, and the profile's substrate says that its thickness is 0.02. So a line
# contact on a coating has its pressure too small by half, and a study of thickness finds that it has no influence. Take the
# map of 8 equal rows in place of the profile.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "ContactMechanics==1.8.3" "SurfaceTopography==1.27.1" "muGrid==1.6.1" "numpy==2.4.6" 2>/dev/null
cat > "$folder/try.py" <<'PYTHON'
import sys

import numpy as np
from ContactMechanics import PeriodicFFTElasticHalfSpace
from ContactMechanics.Systems import NonSmoothContactSystem
from SurfaceTopography import Topography, UniformLineScan

wave = 0.01 * np.cos(2 * np.pi * np.arange(64) / 64)
surfaces = {
    (64,): UniformLineScan(wave, 1.0, periodic=True),
    (64, 8): Topography(np.tile(wave[:, None], 8), (1.0, 1.0), periodic=True),
}


def contact(points, thickness):
    """Share of the surface in contact, and the largest pressure, at a mean pressure of 0.005."""
    body = PeriodicFFTElasticHalfSpace(points, 1.0, (1.0,) * len(points), thickness=thickness, poisson=0.3)
    system = NonSmoothContactSystem(substrate=body, surface=surfaces[points])
    assert system.minimize_proxy(external_force=0.005, pentol=1e-10).success and body.thickness == thickness
    pressures = system.force / body.area_per_pt
    return float((pressures > 0).mean()), float(pressures.max())


seen = {None: [0.2656, 0.02627, 0.2656, 0.02627], 0.05: [0.2656, 0.02627, 0.1719, 0.04140]}
seen[0.02] = [0.2656, 0.02627, 0.1406, 0.05660]
same = True
for thickness, numbers in seen.items():
    row = [*contact((64,), thickness), *contact((64, 8), thickness)]
    print("thickness", thickness, "area, pressure of the profile and of the map:", *(f"{number:.4f}" for number in row))
    same &= np.allclose(row, numbers, rtol=1e-3, atol=0)
sys.exit(0 if same else 1)
PYTHON
"$folder/venv/bin/python" -W ignore "$folder/try.py"
