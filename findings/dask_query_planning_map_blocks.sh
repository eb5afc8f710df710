#!/bin/sh
# dask 2026.8.0 with query planning of arrays (DASK_ARRAY__QUERY_PLANNING=True, which xarray supports since 2026.07).
#
# dask.array.map_blocks takes a dask.delayed object among its arguments, and gives each block its value; without query
# planning it does. With query planning the graph has no task for the delayed object: computing the array raises
#   ValueError: Missing dependency ... for dependents {...}
# and dask.array.from_delayed, the other way to bring such an object in, raises
#   NotImplementedError: Function from_delayed is not implemented for dask-expr.
# An array of one element, dask.array.from_array(numpy object array, chunks=()), works in both modes.
#
# Exits 0 while that is so, 1 when it changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet "dask[array]==2026.8.0" "numpy==2.4.6"
cat > "$folder/map_blocks.py" <<'PYTHON'
import dask
import dask.array
import numpy as np


def added(block, more):
    return block + more


numbers = dask.array.from_array(np.arange(4.0), chunks=2)
result = dask.array.map_blocks(added, numbers, dask.delayed(10.0), meta=np.empty(0))
try:
    print("map_blocks", result.compute().tolist())
except ValueError as error:
    print("map_blocks", type(error).__name__, str(error).split(" ")[0:2])
try:
    print("from_delayed", dask.array.from_delayed(dask.delayed(np.float64)(10.0), (), float).compute())
except NotImplementedError as error:
    print("from_delayed", type(error).__name__)
element = np.empty((), object)
element[()] = 10.0
element = dask.array.from_array(element, chunks=())
print("from_array", dask.array.map_blocks(lambda e, b: b + e.item(), element, numbers, meta=np.empty(0)).compute().tolist())
PYTHON
off=$(DASK_ARRAY__QUERY_PLANNING=False "$folder/venv/bin/python" "$folder/map_blocks.py")
on=$(DASK_ARRAY__QUERY_PLANNING=True "$folder/venv/bin/python" "$folder/map_blocks.py")
printf 'without query planning:\n%s\nwith query planning:\n%s\n' "$off" "$on"
[ "$off" = "map_blocks [10.0, 11.0, 12.0, 13.0]
from_delayed 10.0
from_array [10.0, 11.0, 12.0, 13.0]" ]
[ "$on" = "map_blocks ValueError ['Missing', 'dependency']
from_delayed NotImplementedError
from_array [10.0, 11.0, 12.0, 13.0]" ]
