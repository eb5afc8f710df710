#!/bin/sh
# ContactMechanics 1.8.3: ReferenceSolutions.Cone.deformation(r, alpha), the surface below a rigid cone (r and the result in
# units of the penetration), depends on which points are asked for together. Inside the contact it measures from the largest
# r of the call that lies in the contact, in place of the contact radius a; outside it is right. At r = 0, where the surface
# has gone down by the penetration (1, Sneddon), a cone of 45 degrees gives
#
#     r = 0 alone: 0.3634; with 11 points up to 2: 0.9634; with 101: 0.9834; with the contact radius among them: 1.0000
#
# without a warning (points that are all outside raise ValueError). A comparison of a simulation with this reference "converges" with the grid of the comparison, and an
# error of up to 1 - 2/pi of the depth is the reference's. Adding a = 2 tan(alpha)/pi to the points makes it exact.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "ContactMechanics==1.8.3" "SurfaceTopography==1.27.1" "numpy==2.4.6"
cat > "$folder/try.py" <<'PYTHON'
import sys

import numpy as np
from ContactMechanics.ReferenceSolutions import Cone

alpha = np.pi / 4
radius = Cone.contact_radius_and_area(alpha)[0]
few, many = np.linspace(0, 2, 11), np.linspace(0, 2, 101)
points = {"alone": np.zeros(1), "11": few, "101": many, "with a": np.sort(np.append(few, radius))}
depths = {name: float(Cone.deformation(r, alpha)[0]) for name, r in points.items()}
print("depth at r = 0:", {name: round(depth, 4) for name, depth in depths.items()}, "right is 1")
outside = np.array([1.0, 2.0]) / radius
exact = 2 / np.pi * (np.arcsin(1 / outside) - outside + np.sqrt(outside**2 - 1))
assert np.allclose(Cone.deformation(np.array([0.0, 1.0, 2.0]), alpha)[1:], exact, rtol=1e-12)
seen = {"alone": 1 - 2 / np.pi, "11": 0.96338, "101": 0.98338, "with a": 1.0}
sys.exit(0 if all(abs(depths[name] - seen[name]) < 1e-4 for name in seen) else 1)
PYTHON
"$folder/venv/bin/python" "$folder/try.py" 2>/dev/null
