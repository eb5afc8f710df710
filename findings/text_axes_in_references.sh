#!/bin/sh
# An axis of texts in a netCDF-4 file is misread by both tools that make references of such files for zarr.
#
# Versions: kerchunk 0.2.10, virtualizarr 2.5.1, xarray 2026.9.0, netCDF4 1.7.5.1.post1, h5py 3.16.0, zarr 3.1.6.
# Valid input: a coordinate variable of texts, which xarray writes either as characters, as CF has them,
# bonding(bonding, string12), or as netCDF's own strings, bonding(bonding).
# Behaviour:
#   characters, kerchunk and virtualizarr: the length of the texts is taken for the length of the axis;
#   strings, virtualizarr: AttributeError, since h5py's fill value is of type bytes; kerchunk reads them.
# A file whose text coordinate has another name than its dimension is read by both.
# Output seen:
#   characters kerchunk: conflicting sizes for dimension 'bonding': length 12 on 'bonding' and length 2 on {'bonding': 'a'}
#   characters virtualizarr: conflicting sizes for dimension 'bonding': length 12 on 'bonding' and length 2 on {'bonding': 'a'}
#   strings kerchunk: read
#   strings virtualizarr: 'bytes' object has no attribute 'item'
#   renamed kerchunk: read
#   renamed virtualizarr: read
# Exits with 1 if the behaviour is another.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/python -m pip install --quiet kerchunk==0.2.10 virtualizarr==2.5.1 xarray==2026.9.0 netCDF4==1.7.5.1.post1 \
  h5py==3.16.0 zarr==3.1.6 2>pip.log || { cat pip.log; exit 2; }
cat > try.py <<'PY'
import sys
import warnings
from pathlib import Path

import xarray as xr
from kerchunk.hdf import SingleHdf5ToZarr
from obspec_utils.registry import ObjectStoreRegistry
from obstore.store import LocalStore
from virtualizarr import open_virtual_dataset
from virtualizarr.parsers import HDFParser

warnings.simplefilter("ignore")


def by_kerchunk(path):
    references = SingleHdf5ToZarr(path).translate()
    options = {"storage_options": {"fo": references}, "consolidated": False}
    return xr.open_dataset("reference://", engine="zarr", backend_kwargs=options)


def by_virtualizarr(path):
    registry = ObjectStoreRegistry({"file://": LocalStore()})
    return open_virtual_dataset(Path(path).absolute().as_uri(), registry=registry, parser=HDFParser())


texts = xr.Dataset({"a": ("bonding", [1.0, 2.0])}, {"bonding": ["bonded", "frictionless"]})
texts.to_netcdf("characters.nc", encoding={"bonding": {"dtype": "S1"}})
texts.to_netcdf("strings.nc")
texts.rename_dims(bonding="interface").to_netcdf("renamed.nc", encoding={"bonding": {"dtype": "S1"}})
for name in ("characters", "strings", "renamed"):
    assert xr.open_dataset(f"{name}.nc").bonding.values.tolist() == ["bonded", "frictionless"]
seen = {}
for name in ("characters", "strings", "renamed"):
    for tool, read in (("kerchunk", by_kerchunk), ("virtualizarr", by_virtualizarr)):
        try:
            read(f"{name}.nc")
            seen[name, tool] = "read"
        except Exception as error:
            seen[name, tool] = str(error)
        print(name, f"{tool}:", seen[name, tool])
sizes, item = "length 12 on 'bonding'", "has no attribute 'item'"
wanted = {("characters", "kerchunk"): sizes, ("characters", "virtualizarr"): sizes, ("strings", "virtualizarr"): item}
sys.exit(any(wanted.get(key, "read") not in text for key, text in seen.items()))
PY
venv/bin/python try.py
