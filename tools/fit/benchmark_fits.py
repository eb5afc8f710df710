"""Fits of curves and scans of surfaces: time and memory, compared with a numpy reader and, if it is installed, with the
fit of nanite.

    python tools/fit/benchmark_fits.py

prints the tables of docs/speed.md. The processor times are the least of three in a warm process.
"""

import os
import tempfile
import tracemalloc
import warnings
from datetime import date
from importlib.util import find_spec
from pathlib import Path
from time import process_time

import numpy as np

import study
from study import roughness

GEL = {"R": "5 um", "punch": "rigid", "nu1": 0.45, "E2": "rigid", "h": "3 um", "bonding": "bonded", "micro": "smooth"}
SOFT = {"E2": "20 kPa", "nu2": 0.45}
BARE = {"R": "5 um", "punch": "rigid", "nu2": 0.45, "base": "half_space", "micro": "smooth"}
RING = {"adhesion": "maugis", "sigma0": "2 kPa"}
#: Name of a fit -> the contact, the free inputs and their values, and the number of curves.
FITS = {
    "E on a half-space": (BARE, {"E2": "5 kPa"}, 1),
    "E1 of a layer on a rigid base": (GEL, {"E1": "5 kPa"}, 1),
    "E1 of a layer on a soft base": (GEL | SOFT, {"E1": "5 kPa"}, 1),
    "E1 and w, JKR, of 64 curves": (GEL, {"E1": "5 kPa", "w_adhesion": "0.4 mJ/m^2"}, 64),
    "E2 and w, Maugis, half-space": (BARE | RING, {"E2": "5 kPa", "w_adhesion": "0.4 mJ/m^2"}, 1),
    "E1 and w, Maugis, layer on a rigid base": (GEL | RING, {"E1": "5 kPa", "w_adhesion": "0.4 mJ/m^2"}, 1),
    "E1 and w, Maugis, sphere": (GEL | RING | {"shape": "sphere"}, {"E1": "5 kPa", "w_adhesion": "0.4 mJ/m^2"}, 1),
}
DEPTHS = np.linspace(-0.5e-6, 1e-6, 80)
#: After a first call the shortest of so many times counts.
TIMES = 3


def least(function) -> float:
    """Processor seconds of a call in a warm process."""
    function()
    seconds = []
    for _ in range(TIMES):
        start = process_time()
        function()
        seconds.append(process_time() - start)
    return min(seconds)


def curves(inputs: dict, true: dict, count: int) -> np.ndarray:
    """Loads (count, points) with noise of 1 % of the largest."""
    deep = [f"{depth!r} m" for depth in DEPTHS.tolist() if depth > 0 or "w_adhesion" in true]
    P = np.nan_to_num(study.solve(**inputs, **true, D=deep, x=2, profiles=False, progress=False).P.values)
    P = np.concatenate([np.zeros(len(DEPTHS) - len(P)), P])
    return P + 0.01 * P.max() * np.random.default_rng(3).standard_normal((count, len(P)))


def fits() -> list[dict]:
    """A row for each of FITS: the seconds of a curve."""
    rows = []
    for name, (inputs, true, count) in FITS.items():
        loads, begin = curves(inputs, true, count), dict(true)
        free = dict.fromkeys(true)
        if "w_adhesion" in true:
            free["w_adhesion"], begin["w_adhesion"] = ("0.1 mJ/m^2", "2 mJ/m^2"), "1 mJ/m^2"
        begin = {key: value for key, value in begin.items() if not key.startswith("E")}
        measured = {"D": (DEPTHS, "m"), "P": (loads, "N")}

        def fit(measured=measured, free=free, inputs=inputs | begin):
            return study.fit(measured, free=free, progress=False, **inputs)

        rows.append({"fit": name, "curves": count, "seconds_a_curve": least(fit) / count})
    return [*rows, *nanite_fit()]


def nanite_fit() -> list[dict]:
    """The same for Hertz's model by nanite, through lmfit; no row if it is not installed."""
    if find_spec("nanite") is None:
        return []
    import lmfit
    from nanite.model import models_available

    model, loads = models_available["hertz_para"], curves(BARE, {"E2": "5 kPa"}, 1)[0]
    params = model.get_parameter_defaults()
    params["R"].value, params["nu"].value = 5e-6, 0.45
    seconds = least(lambda: lmfit.minimize(model.residual, params, args=(-DEPTHS, loads)))
    return [{"fit": "Hertz by nanite, E alone without intervals", "curves": 1, "seconds_a_curve": seconds}]


def scans(points: int = 1024) -> list[dict]:
    """The time of reading a text over that of numpy, and the memory of reading a map, in arrays of its size."""
    z = 1e-7 * np.random.default_rng(1).standard_normal((points, points))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.txt"
        np.savetxt(path, 1e9 * z, fmt="%.6e")
        ours = least(lambda: roughness.read(path, unit="um", height_unit="nm", dx=1.0))
        numpy = least(lambda: np.loadtxt(path))
    tracemalloc.start()
    scan = roughness.height_map(z, dx=1e-6)
    roughness.measure(scan)
    most = 1 + tracemalloc.get_traced_memory()[1] / z.nbytes
    tracemalloc.stop()
    return [
        {"scan": f"text of {points} × {points} points, time over numpy.loadtxt", "measured": ours / numpy},
        {"scan": "memory of a map and its statistics, in arrays of its size", "measured": most},
    ]


def table(rows: list[dict]) -> str:
    """The rows in Markdown."""
    heads = [name.replace("_", " ") for name in rows[0]]
    cells = [
        [f"{value:,}" if isinstance(value, int) else f"{value:.3g}" for value in [*row.values()][1:]] for row in rows
    ]
    lines = [
        heads,
        ["---"] + ["---:"] * (len(heads) - 1),
        *([next(iter(row.values())), *rest] for row, rest in zip(rows, cells, strict=True)),
    ]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


if __name__ == "__main__":
    os.environ |= {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")}
    warnings.simplefilter("ignore")
    print(f"These two tables are of {date.today()}.", table(fits()), table(scans()), sep="\n\n")
