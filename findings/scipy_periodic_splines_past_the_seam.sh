#!/bin/sh
# SciPy 1.17.1, scipy.interpolate: periodic splines, as one fits to the profile of a ring over its angle, are right on the first
# turn, and three functions leave the period there. Of h = cos(2 t) + cos(5 t + 1)/2 at 33 angles from 0 to 2 pi:
#
# 1. CubicSpline(t, h, bc_type="periodic").roots() and .solve(y) go on along the first and the last polynomial. "None (default)
#    uses self.extrapolate, 'periodic' works the same as False", says the documentation; here both work as True does:
#        roots(), roots(extrapolate="periodic")    7, three of them outside the turn, where the spline is up to 0.76
#        roots(extrapolate=False)                  4, right; extremes: derivative().roots() has 12, right is 10
# 2. PPoly.from_spline(make_interp_spline(t, h, bc_type="periodic")) says that it is periodic too. Its period is 2 pi + 1.178,
#    since it counts the knots beyond both ends:
#        at 7 rad -0.059, right is 0.073; at 9 rad -1.370, right is 0.444
# 3. make_splrep(t, h, s=s, bc_type="periodic") is periodic for s = 0, and for s = 1e-6, 1e-4 and 0.01 it is not:
#        at 7 rad 0.073 (s = 0), -1.396 (s = 1e-6)
#
# all without a warning, and all of them agree with the data. Pass extrapolate=False to roots and solve; take CubicSpline in
# place of PPoly.from_spline; set spline.extrapolate = "periodic" after make_splrep, which mends it.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "scipy==1.17.1" "numpy==2.4.6" 2>/dev/null
cat > "$folder/try.py" <<'PYTHON'
import sys
import warnings

import numpy as np
from scipy.interpolate import CubicSpline, PPoly, make_interp_spline, make_splrep

warnings.simplefilter("error")
t = np.linspace(0, 2 * np.pi, 33)
h = np.cos(2 * t) + np.cos(5 * t + 1) / 2
h[-1] = h[0]
cubic = CubicSpline(t, h, bc_type="periodic")
roots = {str(option): cubic.roots(extrapolate=option) for option in (None, "periodic", False)}
for name, values in roots.items():
    print("roots", name, values.round(4), "where the spline is", cubic(values).round(4))
extremes = cubic.derivative().roots(), cubic.derivative().roots(extrapolate=False)
print("extremes", [values.size for values in extremes])
spline = make_interp_spline(t, h, bc_type="periodic")
pieces = PPoly.from_spline(spline)
print("pieces", pieces.extrapolate, "period", np.ptp(pieces.x), "at 7 and 9:", pieces([7, 9]), "right:", spline([7, 9]))
smooth = {s: make_splrep(t, h, s=s, bc_type="periodic") for s in (0, 1e-6)}
for s, each in smooth.items():
    print("make_splrep", s, each.extrapolate, "at 7:", each(7.0))
smooth[1e-6].extrapolate = "periodic"
same = [roots[name].size for name in roots] == [7, 7, 4] and [values.size for values in extremes] == [12, 10]
same &= 0.6 < np.abs(cubic(roots["None"])).max() and np.abs(cubic(roots["False"])).max() < 1e-12
same &= np.allclose(pieces(t), h, atol=1e-12) and np.allclose(pieces([7, 9]), [-0.0593, -1.3701], atol=1e-3)
same &= np.allclose(spline([7, 9]), cubic([7, 9])) and np.allclose(spline([7, 9]), [0.0732, 0.4441], atol=1e-3)
same &= abs(smooth[0](7.0) - 0.0732) < 1e-3 and abs(smooth[1e-6](7.0) - 0.0732) < 1e-2
same &= make_splrep(t, h, s=1e-6, bc_type="periodic")(7.0) < -0.3
sys.exit(0 if same else 1)
PYTHON
"$folder/venv/bin/python" "$folder/try.py"
