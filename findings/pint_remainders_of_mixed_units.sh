#!/bin/sh
# pint 0.25.3 with NumPy 2.4.6: numpy.mod, fmod, remainder and floor_divide of quantities in different units of one dimension
# take the bare numbers, and so do arguments that numpy.diff, ediff1d and sum take by name. Positions of 0.5, 1.5, 2.5 and
# 3.5 m, folded into a stroke of 2000 mm:
#
#     positions % stroke                          0.5  1.5  0.5  1.5 m      right (also positions // stroke)
#     numpy.mod(positions, stroke)                0.5  1.5  2.5  3.5 m      0.5 modulo 2000
#     numpy.fmod(positions, stroke)               the same
#     numpy.floor_divide(positions, stroke)       0    0    0    0 m/mm     right is 0 0 1 1
#     the same of 500 ... 3500 mm by 2 m          250 750 1250 1750 mm/m    which are no whole numbers: 0.25 0.75 1.25 1.75
#     numpy.diff(positions, prepend=-500 mm)      first step 500.5 m        right is 1 m
#     numpy.ediff1d(positions, to_begin=500 mm)   first value 500 m         right is 0.5 m
#     numpy.sum(positions, initial=1000 mm)       1008 m                    right is 9 m
#
# without an error or a UnitStrippedWarning (the script turns all warnings into errors), and the result carries a unit of
# length or a ratio of lengths. numpy.max(..., initial=), clip, pad, insert, interp, hypot, where and isclose convert as they
# should. Use the operators % and //, or bring all to one unit (.to_base_units()) before.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "pint==0.25.3" "numpy==2.4.6" 2>/dev/null
cat > "$folder/try.py" <<'PYTHON'
import sys
import warnings

import numpy as np
import pint

warnings.simplefilter("error")
Q = pint.UnitRegistry().Quantity
positions, stroke = Q(np.array([0.5, 1.5, 2.5, 3.5]), "m"), Q(2000.0, "mm")
results = {
    "%": positions % stroke,
    "//": positions // stroke,
    "mod": np.mod(positions, stroke),
    "fmod": np.fmod(positions, stroke),
    "remainder": np.remainder(positions, stroke),
    "floor_divide": np.floor_divide(positions, stroke),
    "floor_divide, mm by m": np.floor_divide(positions.to("mm"), stroke.to("m")),
    "diff": np.diff(positions, prepend=Q(-500.0, "mm")),
    "ediff1d": np.ediff1d(positions, to_begin=Q(500.0, "mm")),
    "sum": np.sum(positions, initial=Q(1000.0, "mm")),
    "max": np.max(positions, initial=Q(5000.0, "mm")),
    "clip": np.clip(positions, Q(1000.0, "mm"), Q(300.0, "cm")),
}
seen = {"%": [0.5, 1.5, 0.5, 1.5], "//": [0, 0, 1, 1], "max": 5, "clip": [1, 1.5, 2.5, 3]}
seen |= dict.fromkeys(("mod", "fmod", "remainder"), [0.5, 1.5, 2.5, 3.5])
seen |= {"floor_divide": [0, 0, 0, 0], "floor_divide, mm by m": [0.25, 0.75, 1.25, 1.75]}
seen |= {"diff": [500.5, 1, 1, 1], "ediff1d": [500, 1, 1, 1], "sum": 1008}
same = True
for name, result in results.items():
    print(f"{name}:", result)
    number = result.to_base_units()
    same &= np.allclose(number.magnitude, seen[name], rtol=1e-12, atol=1e-12)
    same &= number.dimensionless == (name.startswith("floor_divide") or name == "//")
sys.exit(0 if same else 1)
PYTHON
"$folder/venv/bin/python" "$folder/try.py"
