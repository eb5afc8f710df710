#!/bin/sh
# nanite 4.2.3 (afmformats 0.18.7, lmfit 1.3.4): Indentation.fit_model(params_initial=p) stores the object p itself and
# compares the next p with it. Whoever edits a parameter of the same object, p["R"].value = ..., and fits again, compares
# p with p: nothing is fitted, and the modulus of the first radius is returned, with success = True. An object of its own
# for each fit gives the right modulus. So a loop over radii, ratios or thicknesses with one Parameters object returns
# one modulus for all of them. Output seen:
#   R = 5 um: edited 5000 Pa, new 5000 Pa
#   R = 10 um: edited 5000 Pa, new 3536 Pa
#   R = 20 um: edited 5000 Pa, new 2500 Pa
#   nanite returns the modulus of the first radius for all radii of an edited Parameters object
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
./venv/bin/pip install --quiet nanite==4.2.3 afmformats==0.18.7 lmfit==1.3.4
cat > check.py <<'PYTHON'
import sys
import warnings

import numpy as np

warnings.simplefilter("ignore")
import afmformats
import nanite

tip = np.linspace(5e-7, -5e-7, 300)
force = 4 / 3 * 5e3 / (1 - 0.5**2) * np.sqrt(5e-6) * np.maximum(-tip, 0) ** 1.5
height = tip - force / 0.05
columns = {"force": np.concatenate([force, force[::-1]])}
columns |= {"height (measured)": np.concatenate([height, height[::-1]]), "time": np.arange(600) * 1e-3}
columns |= {"segment": np.repeat(np.array([0, 1], np.uint8), 300)}
about = {"spring constant": 0.05, "imaging mode": "force-distance", "point count": 600, "enum": 0}
about |= {"path": "curve.h5", "format": "made", "software": "made"}
data = afmformats.mod_force_distance.AFMForceDistance(columns, afmformats.meta.MetaData(about))
data.export_data("curve.h5", fmt="hdf5")


def parameters(radius):
    p = nanite.model.models_available["hertz_para"].module.get_parameter_defaults()
    p["R"].value, p["nu"].value = radius, 0.5
    return p


def modulus(curve, p):
    curve.fit_model(model_key="hertz_para", params_initial=p, range_x=(0, 0), weight_cp=False)
    assert curve.fit_properties["success"]
    return curve.fit_properties["params_fitted"]["E"].value


curves = [nanite.load_group("curve.h5")[0] for _ in range(2)]
for curve in curves:
    curve.apply_preprocessing(["compute_tip_position"])
p, rows = parameters(5e-6), []
for radius in (5e-6, 10e-6, 20e-6):
    p["R"].value = radius
    rows.append((modulus(curves[0], p), modulus(curves[1], parameters(radius))))
    print(f"R = {1e6 * radius:.0f} um: edited {rows[-1][0]:.0f} Pa, new {rows[-1][1]:.0f} Pa")
stale = len({round(edited) for edited, _ in rows}) == 1
right = all(abs(new / (5e3 * np.sqrt(5e-6 / R)) - 1) < 1e-3 for (_, new), R in zip(rows, (5e-6, 10e-6, 20e-6)))
if not (stale and right):
    sys.exit("nanite does not do this any more")
print("nanite returns the modulus of the first radius for all radii of an edited Parameters object")
PYTHON
./venv/bin/python check.py
