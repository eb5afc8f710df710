#!/bin/sh
# AFMReader 0.0.7, by which TopoStats 2.4.2 reads scans: a Gwyddion file (.gwy) of a rectangular scan comes as another picture. A
# data field is stored row by row, yres rows of xres points, and the reader reshapes it to (xres, yres). Of a scan of 4 um by
# 1 um, 64 rows of 256 points, with waves 2 um long along the rows, it gives (gwyfile 0.3.0 reads the same file rightly)
#
#                     shape      nm a pixel   rms slope along rows   across rows   rms height
#     AFMReader     256 x 64       62.5              0.0028             0.1131      3.54 nm
#     right          64 x 256      15.625            0.0111             0.0000      3.54 nm
#
# without a warning: each row of the picture is a quarter of a line of the scan, and waves along the rows are steps across
# them. Sa, Sq and the histogram of heights are right, so a check of these passes, while every length, slope, spectrum and
# area is wrong. Square scans are read rightly. Reading by gwyfile, or reshaping to (yres, xres), mends it.
# Exits 0 while this is so, 1 when it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "AFMReader==0.0.7" "gwyfile==0.3.0" "numpy==2.4.6" 2>/dev/null
cat > "$folder/try.py" <<'PYTHON'
import sys

import gwyfile
import numpy as np
from AFMReader.gwy import load_gwy
from gwyfile.objects import GwyContainer, GwyDataField, GwySIUnit
from loguru import logger

logger.remove()
rows, points = 64, 256
wave = 5e-9 * np.cos(2 * np.pi * np.arange(points) * 2 / points) * np.ones((rows, 1))
metre = GwySIUnit(unitstr="m")
container = GwyContainer()
container["/0/data"] = GwyDataField(wave, xreal=4e-6, yreal=1e-6, si_unit_xy=metre, si_unit_z=metre)
container["/0/data/title"] = "Height"
path = sys.argv[1] + "/scan.gwy"
container.tofile(path)


def row(name, heights, pixel):
    """Prints and returns the shape, the pixel (nm), the rms slopes along and across the rows, and the rms height (nm)."""
    along, across = (float(np.std(np.diff(heights, axis=axis) / pixel)) for axis in (1, 0))
    print(f"{name:10} {heights.shape} {pixel:.4g} nm, slopes {along:.4f} and {across:.4f}, rms height {heights.std():.3f} nm")
    return [*heights.shape, pixel, along, across, float(heights.std())]


field = gwyfile.load(path)["/0/data"]
right = row("gwyfile", 1e9 * field.data, 1e9 * field.xreal / field.data.shape[1])
seen = row("AFMReader", *load_gwy(path, "Height"))
same = np.allclose(seen, [256, 64, 62.5, 0.0028, 0.11314, 3.5355], rtol=1e-3, atol=0)
sys.exit(0 if same and np.allclose(right, [64, 256, 15.625, 0.01113, 0, 3.5355], rtol=1e-3, atol=1e-12) else 1)
PYTHON
"$folder/venv/bin/python" -W ignore "$folder/try.py" "$folder"
