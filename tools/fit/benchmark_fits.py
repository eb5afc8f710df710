"""Fits of curves and scans of surfaces: time and memory, compared with a numpy reader and, if it is installed, with the
fit of nanite.

    python tools/fit/benchmark_fits.py

prints the tables of docs/speed.md. The processor times are the least of three in a warm process.
"""

import os
import tempfile
import tracemalloc
import warnings
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from time import process_time

import numpy as np
from scipy.ndimage import gaussian_filter

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
#: Fits of the same kind without intervals, of one curve.
PLAIN = {
    "E on a half-space, plain": (BARE, {"E2": "5 kPa"}),
    "E1 of a layer on a rigid base, plain": (GEL, {"E1": "5 kPa"}),
    "E1 of a layer on a soft base, plain": (GEL | SOFT, {"E1": "5 kPa"}),
}
#: Depths of the curves, and those of the plain fits.
DEPTHS, MANY = (np.linspace(-0.5e-6, 1e-6, points) for points in (80, 200))
#: What may be asked beside the heights of a map.
WAYS = (
    ({}, {}),
    ({}, {"form": "sphere", "rows": "median", "cutoff": [3e-6, 6e-6]}),
    ({"despike": 5}, {"method": "summits"}),
)
#: What a text has -> whether its lines have x, y and z of a point, the separator, the share of the points that are
#: missing, and the word in their place.
TEXTS = {
    "points": (False, " ", 0.0, "nan"),
    "points, 1 % of them nan": (False, " ", 0.01, "nan"),
    "points, 5 % of them Bad": (False, "\t", 0.05, "Bad"),
    "points, 5 % of them empty fields": (False, ",", 0.05, ""),
    "points x, y, z, 1 % of z nan": (True, " ", 0.01, "nan"),
    "points x, y, z, 1 % of z empty fields": (True, ",", 0.01, ""),
}
#: After a first call the shortest of so many times counts.
TIMES = 3


def least(function) -> float:
    """Processor seconds of a call in a warm process."""
    function()
    return min(seconds(function) for _ in range(TIMES))


def curves(inputs: dict, true: dict, count: int, depths: np.ndarray = DEPTHS) -> np.ndarray:
    """Loads (count, points) with noise of 1 % of the largest."""
    deep = [f"{depth!r} m" for depth in depths.tolist() if depth > 0 or "w_adhesion" in true]
    P = np.nan_to_num(study.solve(**inputs, **true, D=deep, x=2, profiles=False, progress=False).P.values)
    P = np.concatenate([np.zeros(len(depths) - len(P)), P])
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

        rows.append({"fit": name, "curves": count, "points": len(DEPTHS), "seconds_a_curve": least(fit) / count})
    for name, (inputs, true) in PLAIN.items():
        measured = {"D": (MANY, "m"), "P": (curves(inputs, true, 1, MANY), "N")}

        def plain(measured=measured, true=true, inputs=inputs):
            return study.fit(measured, free=[*true], intervals=None, progress=False, **inputs)

        rows.append({"fit": name, "curves": 1, "points": len(MANY), "seconds_a_curve": least(plain)})
    return [*rows, *nanite_fit()]


def nanite_fit() -> list[dict]:
    """The same for Hertz's model by nanite, through lmfit; no row if it is not installed."""
    if find_spec("nanite") is None:
        return []
    import lmfit
    from nanite.model import models_available

    model, loads = models_available["hertz_para"], curves(BARE, {"E2": "5 kPa"}, 1, MANY)[0]
    params = model.get_parameter_defaults()
    params["R"].value, params["nu"].value = 5e-6, 0.45
    shortest = least(lambda: lmfit.minimize(model.residual, params, args=(-MANY, loads)))
    name = f"Hertz by nanite {version('nanite')}, E on a half-space, plain"
    return [{"fit": name, "curves": 1, "points": len(MANY), "seconds_a_curve": shortest}]


def scans(points: int = 2048) -> list[dict]:
    """The time of reading a text over that of numpy, and the memory of reading a map, in arrays of its size."""
    z, rows = gaussian_filter(np.random.default_rng(1).standard_normal((points, points)), 2), []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in TEXTS.items():
            ratio = over_numpy(Path(folder), z, *text)
            rows.append(
                {
                    "scan": f"text of {points} × {points} {name}, time over numpy.loadtxt",
                    "measured": ratio,
                }
            )
        np.save(Path(folder) / "map.npy", z)
        most = max(most_memory(Path(folder) / "map.npy", *way) for way in WAYS)
    name = f"memory of {points} × {points} points and their statistics, in arrays of their size"
    return [*rows, {"scan": name, "measured": most / z.nbytes}]


def over_numpy(folder: Path, z: np.ndarray, has_positions: bool, separator: str, share: float, word: str) -> float:
    """The time of reading a text with missing points over that of numpy of the same text without: the median of turns.

    has_positions : lines of x, y and z of a point; otherwise lines of z
    share : of the points that are missing, with `word` in their place
    """
    whole, gaps = folder / "whole.txt", folder / "gaps.txt"
    for path, part in ((whole, 0.0), (gaps, share)):
        heights = np.where(np.random.default_rng(2).random(z.shape) < part, np.nan, z)
        y, x = np.indices(z.shape) / 2
        columns = np.column_stack([x.ravel(), y.ravel(), heights.ravel()]) if has_positions else heights
        np.savetxt(path, columns, fmt="%.6e", delimiter=separator)
        path.write_bytes(path.read_bytes().replace(b"nan", word.encode()))
    how = {"unit": "um", "height_unit": "nm", "missing": "skip"} | ({} if has_positions else {"dx": 1.0})
    turns = (
        (seconds(lambda: roughness.read(gaps, **how)), seconds(lambda: np.loadtxt(whole, delimiter=separator)))
        for _ in range(TIMES)
    )
    return float(np.median([ours / numpys for ours, numpys in turns]))


def seconds(function) -> float:
    """Processor seconds of a call."""
    start = process_time()
    function()
    return process_time() - start


def most_memory(path: Path, how: dict, what: dict) -> int:
    """The largest memory that reading and measuring a map takes, in bytes."""
    tracemalloc.start()
    try:
        roughness.measure(roughness.read(path, unit="um", height_unit="nm", dx=1.0, **how), **what)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


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
    print(table(fits()), table(scans()), sep="\n\n")
