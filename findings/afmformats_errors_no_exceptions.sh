#!/bin/sh
# afmformats 0.18.7: its errors (FileFormatNotSupportedError, MissingMetaDataError ...) derive from BaseException. The usual
# `except Exception` around load_data lets them through, and a batch over a folder of files ends at the first one that is no
# force curve, or that lacks a spring constant. A valid HDF5 file without a curve gives
#
#     except Exception: not caught; FileFormatNotSupportedError < AFMFileFormatError < BaseException
#
# Exits 0 while this is so, 1 when it has changed.
set -e
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "afmformats==0.18.7"
cat > "$folder/try.py" <<'PYTHON'
import sys

import afmformats
import h5py

path = sys.argv[1] + "/table.h5"
with h5py.File(path, "w") as file:
    file["rating"] = [1.0, 2.0]
try:
    try:
        afmformats.load_data(path)
    except Exception:
        print("except Exception: caught")
        sys.exit(1)
except BaseException as error:
    if isinstance(error, SystemExit):
        raise
    print("except Exception: not caught;", " < ".join(kind.__name__ for kind in type(error).__mro__[:-1]))
PYTHON
"$folder/venv/bin/python" "$folder/try.py" "$folder"
