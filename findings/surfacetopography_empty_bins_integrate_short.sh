#!/bin/sh
# SurfaceTopography 1.27.1 with NumPy 2.4.6 and SciPy 1.17.1: the power spectrum of a line scan comes, unless asked
# otherwise, on points even in the logarithm of the wave number. There are fewer long waves than such points, so several
# bins are empty: masked, with 0 below the mask. No function that people hand a spectrum to says a word about the mask.
# White noise of 128 x 128 points, period 12.8 um, has m0 = 0.983 um^2, and C1D should integrate to pi m0. Over pi:
#
#     numpy.trapezoid, resampling_method=None          0.972   (half of the first interval is missing)
#     numpy.trapezoid, the points that are not masked  0.910   (means over bins on a coarse grid)
#     numpy.trapezoid, the spectrum as it comes        0.849   both intervals beside each empty bin are dropped
#     scipy.integrate.trapezoid, as it comes           0.849
#     scipy.integrate.simpson, as it comes             0.882
#     numpy.interp at the wave number of an empty bin  0.000   where both its neighbours are above 0.08
#
# A moment or an interpolated spectrum from the default call is therefore too small by a share that depends on the bins,
# while the drawn curve looks right, since matplotlib leaves masked points out.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "SurfaceTopography==1.27.1" "numpy==2.4.6" "scipy==1.17.1" 2>/dev/null
cat > "$folder/try.py" <<'PYTHON'
import sys

import numpy as np
from scipy import integrate
from SurfaceTopography import Topography

heights = np.random.default_rng(1).normal(size=(128, 128))
scan = Topography(heights, (12.8, 12.8), periodic=True, unit="um")
q, c = scan.power_spectrum_from_profile()
empty = np.ma.getmaskarray(c)
right = scan.rms_height_from_profile() ** 2
first = int(np.flatnonzero(empty)[0])
q_all, c_all = scan.power_spectrum_from_profile(resampling_method=None)
values = {
    "unsampled": np.trapezoid(c_all, q_all) / np.pi,
    "not masked": np.trapezoid(np.asarray(c[~empty]), np.asarray(q[~empty])) / np.pi,
    "numpy": np.trapezoid(c, q) / np.pi,
    "scipy": integrate.trapezoid(c, q) / np.pi,
    "simpson": integrate.simpson(c, x=q) / np.pi,
    "interp": np.interp(np.asarray(q)[first], q, c),
}
print("empty bins:", int(empty.sum()), "of", len(c), "m0:", round(float(right), 4))
print({name: round(float(value), 4) for name, value in values.items()})
print("beside the first empty bins:", c[~empty][:2])
seen = {"unsampled": 0.9719, "not masked": 0.9103, "numpy": 0.8486, "scipy": 0.8486, "simpson": 0.8816, "interp": 0.0}
same = all(abs(values[name] - seen[name]) < 5e-4 for name in seen)
sys.exit(0 if same and abs(right - 0.9831) < 5e-4 and (c[~empty][:2] > 0.08).all() else 1)
PYTHON
"$folder/venv/bin/python" -W ignore "$folder/try.py"
