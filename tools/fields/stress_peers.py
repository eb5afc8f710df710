"""The largest Mises stress below a sphere with other codes, if they are installed: time against error.

    python tools/fields/stress_peers.py [--json]

All have the pressure of Hertz on a half-space, nu = 0.3, whose largest stress is 0.6200 p0 at the depth 0.481 a. Tamaas
has a periodic body, 8 a wide, and 33 depths down to a; slippy (its kernels of Love alone, with the FFT of scipy) a free
one, 2.5 a wide, and 16 depths from 0.1 a to a. Both compute the stresses of all points, and neither has layers.
roughcoat solves the contact too.
"""

import importlib.util
import json
import sys
from collections.abc import Callable
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import perf_counter
from types import ModuleType

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.signal import fftconvolve

from solver import Problem, solve
from solver.yields.contact import of_contacts

NU, LOAD = 0.3, 1e-5
#: The largest Mises stress of Hertz's contact over p0, on the axis: (1 + nu)(1 - y atan 1/y) - 1.5/(1 + y²), y = z/a.
EXACT = -minimize_scalar(
    lambda y: (1 + NU) * (1 - y * np.arctan(1 / y)) - 1.5 / (1 + y * y), bracket=(0.3, 0.5, 0.7), tol=1e-12
).fun
GRIDS = (32, 64, 128)
TIMES = 3
BATCH = 64


def traction(points: int, width: float) -> np.ndarray:
    """Hertz's pressure over p0 on points x points of a square around it; lengths in a."""
    x = (np.arange(points) - points // 2) * width / points
    return np.sqrt(np.maximum(0, 1 - x[:, None] ** 2 - x**2))


def of_tensor(xx, yy, zz, xy, yz, xz) -> float:
    """The largest Mises stress of arrays of stresses."""
    shear = xy**2 + yz**2 + xz**2
    return float(np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * shear).max())


def tamaas(points: int) -> float:
    """By the operators of a volume: gradients of Boussinesq's displacements, and Hooke's law."""
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    model = tm.Model(tm.model_type.volume_2d, [1.0, 8.0, 8.0], [33, points, points])
    model.E, model.nu = 1.0, NU
    tm.ModelFactory.registerVolumeOperators(model)
    model["traction"][..., 2] = traction(points, 8.0)
    strain = np.zeros([33, points, points, 6])
    stress = np.zeros_like(strain)
    model.operators["boussinesq_gradient"](model["traction"], strain)
    model.operators["hooke"](strain, stress)
    mises = np.zeros([33, points, points, 1])
    tm.compute.von_mises(tm.model_type.volume_2d, mises, stress)
    return float(mises.max())


@cache
def _kernels() -> Callable:
    """The function of slippy that makes its kernels, from its file alone: the package needs numpy before 1.21."""
    [folder] = importlib.util.find_spec("slippy").submodule_search_locations
    sys.modules.setdefault("slippy", ModuleType("slippy"))
    spec = importlib.util.spec_from_file_location("kernels", Path(folder) / "core/_elastic_sub_surface_stresses.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.normal_conv_kernels


def slippy(points: int) -> float:
    """By convolution of the pressure with the stresses below one square."""
    step = 2.5 / points
    kernels = _kernels()((2 * points, 2 * points), np.linspace(0.1, 1, 16), [step, step], 1.0, NU)
    pressure = traction(points, 2.5)[None]
    tensor = {name: fftconvolve(kernel, pressure, mode="same", axes=(1, 2)) for name, kernel in kernels.items()}
    return of_tensor(*(tensor[name] for name in ("xx", "yy", "zz", "xy", "yz", "xz")))


def ours(count: int) -> float:
    """The largest stress over p0 of `count` contacts at once; each is solved and searched."""
    problem = Problem.of(P=np.full(count, LOAD), micro="smooth", base="half_space", nu2=NU)
    solution = solve(problem)
    return float((of_contacts(problem, solution, names=("mises2",))["mises2"][0] / solution.p0)[0])


CODES = {"tamaas": tamaas, "slippy": slippy}


def least(action) -> tuple[float, float]:
    """The result of an action, and the shortest wall time of several runs after a first one."""
    action()
    times = []
    for _ in range(TIMES):
        start = perf_counter()
        result = action()
        times.append(perf_counter() - start)
    return result, min(times)


def stress_peers() -> list[dict]:
    """A row for each code and grid: seconds and the relative error of the largest Mises stress; or that it is not
    installed."""
    rows = []
    for name, code in CODES.items():
        try:
            title = f"{name} {version(name)}"
        except PackageNotFoundError:
            rows.append({"code": name, "skipped": "not installed"})
            continue
        for points in GRIDS:
            value, seconds = least(lambda: code(points))  # noqa: B023
            error = abs(value / EXACT - 1)
            rows.append({"code": title, "points": f"{points} × {points}", "seconds": seconds, "error": error})
    for count in (1, BATCH):
        value, seconds = least(lambda: ours(count))  # noqa: B023
        error = abs(value / EXACT - 1)
        rows.append({"code": "roughcoat", "points": f"batch of {count}", "seconds": seconds / count, "error": error})
    return rows


if __name__ == "__main__":
    if sys.argv[1:] == ["--json"]:
        print(json.dumps(stress_peers()))
    else:
        print(*stress_peers(), sep="\n")
