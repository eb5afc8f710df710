"""A sphere on a half-space with other codes, if they are installed (extra `peers`): time against error of D.

    python tools/bench/benchmark_peers.py

The other codes solve on a square grid with a free (not periodic) kernel, three contact radii wide for the smooth
sphere. This solver takes the exact layer, bonded to a half-space of the same material: a Hertz contact that it does not
recognize. Its basis contains the pressure of Hertz, so that its only error is rounding.

The rough sphere has spherical asperities on a square lattice, with a pitch of a tenth of the contact radius. The other
codes resolve each of them; this solver replaces them by a micro law. Its D is that of another model, so each code is
judged by its own finest grid, and this one by its smallest rtol: the comparison is of times to reach some error of its
own answer.
"""

from importlib.metadata import version
from importlib.util import find_spec
from time import perf_counter

import numpy as np

from solver import Problem, solve
from solver.closed_forms import hertz

LOAD = 1e-5
SMOOTH_WIDTH = 3.0 * float(hertz(P=LOAD).a)  # of the grid
GRIDS = (16, 32, 64, 128)
BATCH = 1000
#: Pitch and radius of the asperities, in R: at this load the contact radius is about 0.022.
PITCH, RA = 0.002, 0.004
#: Width of the grid for the rough sphere, whole pitches; and points per pitch, from the coarsest to the finest grid.
ROUGH_WIDTH, IN_A_PITCH = 32 * PITCH, (3, 4, 6, 8, 12)


def smooth(x: np.ndarray) -> np.ndarray:
    """Depth of the sphere below its apex at the points x (n,) in both directions: (n, n)."""
    return (x[:, None] ** 2 + x**2) / 2


def rough(x: np.ndarray) -> np.ndarray:
    """Depth of the rough sphere, with an asperity at its apex, at the same points."""
    from_apex = x - PITCH * np.round(x / PITCH)
    return smooth(x) + smooth(from_apex) / RA


def points_of(points: int, width: float) -> np.ndarray:
    return (np.arange(points) - points // 2) * width / points


def tamaas(depth, points: int, width: float) -> float:
    """D of Tamaas (Polonsky-Keer on DC-FFT) on points x points."""
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    model = tm.Model(tm.model_type.basic_2d, [width, width], [points, points])
    model.E, model.nu = 1.0, 0.0
    surface = -depth(points_of(points, width))
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(
        model, surface, 1e-10, tm.PolonskyKeerRey.pressure, tm.PolonskyKeerRey.pressure
    )  # fmt: skip
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 5000
    solver.solve(LOAD / width**2)
    displacement = np.zeros_like(model.traction)
    model.operators["dcfft"](model.traction, displacement)
    return float((displacement - surface)[model.traction > 0].mean())


def contact_mechanics(depth, points: int, width: float) -> float:
    """D of ContactMechanics (constrained conjugate gradients, free boundaries) on points x points."""
    from ContactMechanics import FreeFFTElasticHalfSpace
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import Topography

    half_space = FreeFFTElasticHalfSpace((points, points), 1.0, (width, width))
    surface = Topography(-depth(points_of(points, width)), (width, width))
    system = make_system(substrate=half_space, surface=surface)
    system.minimize_proxy(external_force=LOAD, pentol=1e-8 * float(hertz(P=LOAD).D), maxiter=5000)
    return float(system.offset)


CODES = {"tamaas": tamaas, "ContactMechanics": contact_mechanics}


def ours(rtol: float, size: int) -> float:
    """D of this solver for `size` smooth cases at once."""
    h = float(hertz(P=LOAD).a)
    case = {"h": h, "n": 1.0, "micro": "smooth", "bonding": "bonded", "base": "layered"}
    return float(solve(Problem.of(P=np.full(size, LOAD), rtol=rtol, **case)).D[0])


def ours_rough(rtol: float, size: int) -> float:
    """D of this solver for `size` rough cases at once, on the half-space."""
    case = {"Nbar": PITCH**-2, "Ra": RA, "base": "half_space"}
    return float(solve(Problem.of(P=np.full(size, LOAD), rtol=rtol, **case)).D[0])


def _missing(name: str) -> list[dict]:
    """The row of a code that is not installed."""
    if find_spec(name):
        return []
    return [{"code": name, "skipped": "not installed: pip install roughcoat[peers]"}]


def peers(seconds) -> list[dict]:
    """The smooth sphere: seconds a case and relative error of D of every code."""
    exact, rows = float(hertz(P=LOAD).D), []
    for name, code in CODES.items():
        rows += _missing(name)
        for points in () if _missing(name) else GRIDS:
            error = abs(code(smooth, points, SMOOTH_WIDTH) / exact - 1)
            used = seconds(lambda: code(smooth, points, SMOOTH_WIDTH))  # noqa: B023
            rows.append({"code": f"{name} {version(name)}", "grid": points, "seconds": used, "error": error})
    for rtol in (1e-3, 1e-6, 1e-9):
        for size in (1, BATCH):
            error = abs(ours(rtol, size) / exact - 1)
            used = seconds(lambda: ours(rtol, size)) / size  # noqa: B023
            rows.append({"code": "roughcoat", "rtol": rtol, "batch": size, "seconds": used, "error": error})
    return rows


def _timed(action) -> tuple[float, float]:
    """The result of an action, and the seconds of a single run: runs of the other codes take up to minutes."""
    start = perf_counter()
    result = action()
    return result, perf_counter() - start


def rough_peers() -> list[dict]:
    """The rough sphere: seconds a case, D, and its relative error against the finest of each code."""
    rows = []
    for name, code in CODES.items():
        rows += _missing(name)
        grids = () if _missing(name) else [32 * points for points in IN_A_PITCH]
        answers = [(points, *_timed(lambda: code(rough, points, ROUGH_WIDTH))) for points in grids]  # noqa: B023
        for points, D, used in answers:
            code_and_grid = {"code": f"{name} {version(name)}", "grid": points}
            rows.append(code_and_grid | {"seconds": used, "D": D, "error": abs(D / answers[-1][1] - 1)})
    exact = ours_rough(1e-12, 1)
    for rtol in (1e-1, 1e-3, 1e-6):
        for size in (1, BATCH):
            ours_rough(rtol, size)
            D, used = _timed(lambda: ours_rough(rtol, size))  # noqa: B023
            rows.append({"code": "roughcoat", "rtol": rtol, "batch": size, "seconds": used / size, "D": D,
                         "error": abs(D / exact - 1)})  # fmt: skip
    return rows


if __name__ == "__main__":
    for row in rough_peers():
        print(row)
