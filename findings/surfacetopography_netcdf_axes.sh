#!/bin/sh
# SurfaceTopography 1.27.1: a netCDF map whose dimensions are (y, x), as xarray and the CF conventions order them, is read with
# its axes exchanged, though the dimensions are named x and y: the first one is taken for x, and given the length of x. 64 rows
# 1 um apart of 96 points 0.5 um apart give
#
#     64 x 96 points in an area of 48.0 x 64.0 um, right is 96 x 64
#
# without a warning: steps of 0.75 um and 0.667 um in place of 0.5 um and 1 um, so slopes and curvatures are wrong. The same
# file with the dimensions (x, y) is read rightly.
# Exits 0 while this is so, 1 when it has changed.
set -e
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "SurfaceTopography==1.27.1" "xarray==2026.2.0" "scipy<2"
cat > "$folder/try.py" <<'PYTHON'
import sys

import numpy as np
import SurfaceTopography
import xarray as xr

heights = xr.DataArray(np.random.default_rng(0).normal(size=(64, 96)), dims=("y", "x"), attrs={"unit": "um"})
positions = {axis: (axis, step * np.arange(n), {"unit": "um", "length": n * step}) for axis, step, n in (("x", 0.5, 96), ("y", 1.0, 64))}
maps = {}
for name, each in {"yx": heights, "xy": heights.transpose("x", "y")}.items():
    path = f"{sys.argv[1]}/{name}.nc"
    each.to_dataset(name="heights").assign_coords(positions).to_netcdf(path, format="NETCDF3_64BIT", engine="scipy")
    maps[name] = SurfaceTopography.read_topography(path)
points, sizes = maps["yx"].heights().shape, maps["yx"].physical_sizes
print(f"{points[0]} x {points[1]} points in an area of {sizes[0]} x {sizes[1]} um, right is 96 x 64")
right = maps["xy"].heights().shape == (96, 64) and tuple(maps["xy"].physical_sizes) == (48.0, 64.0)
sys.exit(0 if right and points == (64, 96) and tuple(sizes) == (48.0, 64.0) else 1)
PYTHON
"$folder/venv/bin/python" "$folder/try.py" "$folder"
