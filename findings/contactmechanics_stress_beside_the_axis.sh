#!/bin/sh
# ContactMechanics 1.8.3: the functions of Hertz's stresses (ReferenceSolutions.Hertz.stress, stress_Cartesian and
# stress_for_tangential_loading) have formulas of their own at r = 0, and divide differences of nearly equal numbers by r^2 or
# r^4 beside it. The centre of numpy.arange(-1, 1.0001, 0.01) is 9e-16 in place of 0, that of numpy.linspace(-1, 1, 201) is 0.
# On these two grids, in units of the largest pressure p0 and at nu = 0.3,
#
#                                                          linspace                 arange
#     stress: largest shear of a map of r, z           0.310 at z = 0.48 a     0.393 at z = 0.43 a
#     stress: largest von Mises stress                 0.620 at z = 0.48 a     0.683 at z = 0.44 a
#     stress_Cartesian: largest von Mises, z = 0.48 a      0.620                   3.9e+13
#     the same with 0.3 times the tangential one           0.657                   3.0e+27
#
# without a warning of it (both grids alike warn of divisions by zero at z = 0). The large numbers are seen at once; the first
# two look right, and with a shear strength the load at first yield, as p0^3, comes out 0.49 of what it is. Points nearer to
# the axis than 1e-4 a may be set to 0, where all are right; that changes the stresses by no more than 1e-4 p0.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "ContactMechanics==1.8.3" "SurfaceTopography==1.27.1" "numpy==2.4.6" 2>/dev/null
cat > "$folder/try.py" <<'PYTHON'
import sys

import numpy as np
from ContactMechanics.ReferenceSolutions import Hertz

NU = 0.3


def von_mises(xx, yy, zz, yz, xz, xy):
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (yz**2 + xz**2 + xy**2))


def largest(values, depths):
    place = np.unravel_index(np.argmax(values), values.shape)
    return float(values[place]), float(depths[place])


def row(x):
    """Largest shear and von Mises stress of a map, each with its depth, then von Mises of a plane: pressed, and pressed and pulled."""
    r, z = np.meshgrid(np.abs(x), np.arange(150) * 0.01, indexing="ij")
    tt, rr, zz, rz = Hertz.stress(r, z, NU)
    shear = np.maximum(np.abs(tt - zz), np.hypot(rr - zz, 2 * rz)) / 2
    numbers = [*largest(shear, z), *largest(von_mises(tt, rr, zz, rz, 0, 0), z)]
    plane = [*np.meshgrid(x, x, indexing="ij"), np.full((x.size, x.size), 0.48)]
    pressed, pulled = Hertz.stress_Cartesian(*plane, NU), Hertz.stress_for_tangential_loading(*plane, NU)
    both = [a + 0.3 * b for a, b in zip(pressed, pulled)]
    return [*numbers, float(von_mises(*pressed).max()), float(von_mises(*both).max())]


even, stepped = np.linspace(-1, 1, 201), np.arange(-1, 1.0001, 0.01)
rows = {"linspace": row(even), "arange": row(stepped)}
print("centres:", even[100], stepped[100])
for name, numbers in rows.items():
    print(name, *(f"{number:.4g}" for number in numbers))
right = np.allclose(rows["linspace"], [0.3100, 0.48, 0.6200, 0.48, 0.6200, 0.6570], rtol=1e-3, atol=0)
seen = np.allclose(rows["arange"][:4], [0.3929, 0.43, 0.6828, 0.44], rtol=1e-3, atol=0) and min(rows["arange"][4:]) > 1e10
sys.exit(0 if right and seen else 1)
PYTHON
"$folder/venv/bin/python" -W ignore "$folder/try.py"
