#!/bin/sh
# netCDF4 1.7.5.1.post1 (netCDF-C 4.10.1), xarray 2026.9.0: a variable written with `significant_digits`, the lossy step before
# compression, should keep that many digits of each number. Infinity comes back as something else, without a warning:
#
#     written                              inf  -inf   inf  -inf     (four in a row; significant_digits=3)
#     GranularBitRound                    -0.0   0.0  -0.0   0.0     finite, with the sign changed
#     BitGroom (what `significant_digits` takes unless told otherwise)
#                                          inf   nan   inf   nan     every second one is lost, and stands for "missing"
#     BitRound (12 significant bits)       inf  -inf   inf  -inf     right
#
# NaN stays NaN, and the usual finite numbers keep their digits (in single precision 3.4e38, next to the largest one, may round
# up to infinity). In a study whose largest load without yield, or life, is infinite where there is no limit, GranularBitRound
# turns the safest case into one that bears nothing, and `min`, `isfinite` and `isnull` see a usual number. Write such variables
# without quantization or by BitRound.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "netCDF4==1.7.5.1.post1" "xarray==2026.9.0" "numpy==2.4.6" 2>/dev/null
cat > "$folder/try.py" <<'PYTHON'
import sys

import netCDF4
import numpy as np
import xarray as xr

inf, nan = np.inf, np.nan
strengths = np.array([inf, -inf, inf, -inf, nan, 0.0, 1.23456789, -9.87654321e-9])
rounding = {
    "BitGroom": {"significant_digits": 3, "quantize_mode": "BitGroom"},
    "default": {"significant_digits": 3},
    "GranularBitRound": {"significant_digits": 3, "quantize_mode": "GranularBitRound"},
    "BitRound": {"significant_digits": 12, "quantize_mode": "BitRound"},
}
print("netCDF-C", netCDF4.__netcdf4libversion__)
same = True
for kind in (np.float64, np.float32):
    for name, options in rounding.items():
        path = f"{sys.argv[1]}/{name}_{np.dtype(kind)}.nc"
        dataset = xr.Dataset({"strength": ("case", strengths.astype(kind))})
        dataset.to_netcdf(path, engine="netcdf4", encoding={"strength": {"zlib": True, **options}})
        with xr.open_dataset(path, engine="netcdf4") as back:
            limits = back.strength.values
        print(f"{np.dtype(kind)} {name:>16}:", *(f"{value:g}" for value in limits))
        seen = {"GranularBitRound": [-0.0, 0.0, -0.0, 0.0], "BitRound": [inf, -inf, inf, -inf]}.get(name, [inf, nan, inf, nan])
        same &= np.array_equal(limits[:4], seen, equal_nan=True)
        same &= np.array_equal(np.signbit(limits[[0, 2]]), [name == "GranularBitRound"] * 2)
        same &= np.isnan(limits[4]) and limits[5] == 0 and np.allclose(limits[6:], strengths[6:], rtol=2e-3, atol=0)
sys.exit(0 if same else 1)
PYTHON
"$folder/venv/bin/python" -W ignore "$folder/try.py" "$folder"
