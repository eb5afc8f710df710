#!/bin/sh
# afmformats 0.18.7 (igor2 0.5.15): a force curve of Asylum Research (.ibw) comes as one segment. `appr`, documented as the
# approach, has the approach and the retraction, and `retr` is empty. A curve of 40 points down and 40 points back, with half
# the force on the way back, gives
#
#     approach 80 points, retraction 0 points
#
# without a warning. Whoever fits `appr` fits both ways at once, and gets a modulus between those of the two.
# Exits 0 while this is so, 1 when it has changed.
set -e
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet "afmformats==0.18.7" "igor2==0.5.15"
cat > "$folder/try.py" <<'PYTHON'
import pathlib
import struct
import sys

import afmformats
import numpy as np

down = np.linspace(2e-7, -2e-7, 40)
height = np.append(down, down[::-1])
bending = np.append(np.maximum(-down, 0), np.maximum(-down, 0)[::-1] / 2) / 3
data, labels = np.stack([-height, bending, -height], axis=1), ["Raw", "Defl", "ZSnsr"]
said = {"ScanSize": 1, "ImagingMode": "Contact", "NumPtsPerSec": 1, "InvOLS": 4e-8, "TriggerChannel": "Raw"}
said |= {"InputTime": 1, "SpringConstant": 0.05, "ApproachVelocity": 1, "RetractVelocity": 1, "MicroscopeModel": "MFP3D"}
said |= {"Version": 1, "Date": "2018-08-01", "Time": "1:07:47 PM"}
note = "\r".join(f"{key}: {value}" for key, value in said.items()).encode()
names = b"".join(label.encode().ljust(32, b"\0") for label in ["", *labels])
wave = struct.pack("<4xIIi h h 6x h 32s 4x 4x", 0, 0, data.size, 2, 0, 1, b"curve")  # a wave of Igor, version 5
wave += struct.pack("<4i 4d 4d", *data.shape, 0, 0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
wave += struct.pack("<4s 4s4s4s4s h 2x dd", b"m", b"s", b"", b"", b"", 0, 0.0, 0.0)
wave, content = wave.ljust(320, b"\0"), data.astype("<f4").tobytes(order="F")
head = struct.pack("<hH15i", 5, 0, 320 + len(content), 0, len(note), *[0] * 6, len(names), *[0] * 5)
words = int(np.frombuffer(head + wave, dtype="<i2").astype(int).sum())
head = head[:2] + struct.pack("<H", -words & 0xFFFF) + head[4:]
path = pathlib.Path(sys.argv[1]) / "curve.ibw"
path.write_bytes(head + wave + content + note + names)

(curve,) = afmformats.load_data(path)
approach, retraction = len(curve.appr["force"]), len(curve.retr["force"])
print(f"approach {approach} points, retraction {retraction} points")
sys.exit(0 if (approach, retraction) == (80, 0) else 1)
PYTHON
"$folder/venv/bin/python" "$folder/try.py" "$folder"
