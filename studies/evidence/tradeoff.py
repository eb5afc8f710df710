"""Work and precision: time per case and error of every way to solve the model, on fixed problem sets.

docs/tradeoff.md describes the measurement of both.
"""

import json
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from solver import Problem, Solution, Status, solve
from solver.rough.results import difference
from study.figures import registry

from ..paper import paper_error
from ..paper.uniform import solve_uniform, uniform_mesh
from .problem_sets import SETS

REFERENCE = 1e-11  # rtol of the reference solutions
ENDED = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)  # statuses of cases whose iteration ended
X = np.array([0.0, 1.0])  # points of the profiles: as few as possible, since they take time
PATIENCE = 1.0  # seconds after which a measurement is not repeated

PAPERS = ("paper, layer", "paper, half-space")  # the problem sets that the paper's method can solve
TOLERANCES = tuple(10.0**-i for i in range(2, 10))
NODES = (8.0, 12.0, 16.0, 24.0, 32.0)
SLOW = 20  # number of cases of a set with which a slow way is measured
COPIES = 10  # of each case of the paper in a batch of a quick way
#: Intervals of the paper's meshes. Some of them just reach 1e-3, 1e-4, 1e-5 and 1e-6 on the paper's layer.
MESHES = (10.0, 20.0, 45.0, 80.0, 130.0)
FINE = (390.0, 640.0, 1100.0)


@dataclass(frozen=True)
class Way:
    """One way to solve: `run(cases, setting)` for each of its `settings`.

    varied : a word for the settings
    sets : names of the problem sets on which it is measured; most : largest number of cases of a set
    copies : of each of the paper's cases in a batch; several for ways so quick that a hundred cases cannot be timed
    prepare(setting) : is called before, and not timed, since any number of cases can use its result
    """

    run: Callable[[dict, float], Solution]
    varied: str
    settings: tuple[float, ...]
    sets: tuple[str, ...] = tuple(SETS)
    most: int = 10**6
    copies: int = 1
    prepare: Callable[[float], object] = lambda setting: None

    def index(self, size: int) -> np.ndarray:
        """The indices of the cases that it takes, of `size` ones."""
        return np.unique(np.linspace(0, size - 1, min(self.most, size)).round().astype(int))


def changed(**parameters) -> Callable[[dict, float], Solution]:
    """`run` with the solver and some parameters changed, to a value or to a function of the setting."""

    def run(cases: dict, setting: float) -> Solution:
        new = {name: value(setting) if callable(value) else value for name, value in parameters.items()}
        return solve(Problem.of(**cases | new), X)

    return run


def swapped(name: str, first: str, second: str) -> Callable[[dict, float], Solution]:
    """`run` with the solver and two values of the parameter `name` exchanged; the setting is rtol."""

    def run(cases: dict, setting: float) -> Solution:
        values = np.where(cases[name] == first, second, np.where(cases[name] == second, first, cases[name]))
        return solve(Problem.of(**cases | {name: values, "rtol": setting}), X)

    return run


def _picard(k: float) -> Way:
    """The solver's scheme "picard", on the nodes of Newton's method; rtol falls with the number of nodes."""
    options = {"scheme": "picard", "k": k, "nodes": int, "rtol": lambda n: 10 ** (-n / 6), "max_iterations": 400}
    return Way(changed(**options), "nodes", NODES, PAPERS, most=SLOW)


def paper_way(k: float, settings=MESHES, sets=PAPERS, most=SLOW) -> Way:
    """The paper's method with one k, on meshes of `settings` intervals. The tolerance is below the error of the
    mesh."""

    def run(cases: dict, intervals: float):
        return solve_uniform(Problem.of(**cases), int(intervals), k, 0.3 / intervals**2)

    return Way(run, "intervals", settings, sets, most, prepare=lambda intervals: uniform_mesh(int(intervals)))


WAYS = {
    **{f"paper k = {k:g}": paper_way(k) for k in (0.0, 1.0, 2.0)},
    "paper k = 5": paper_way(5.0, sets=(*PAPERS, "extremes")),
    "paper k = 20": paper_way(20.0),
    "paper k = 35": paper_way(35.0, FINE, ("paper, layer",), most=5),
    **{f"picard k = {k:g}": _picard(k) for k in (2.0, 20.0)},
    "newton, nodes": Way(changed(nodes=int, rtol=REFERENCE), "nodes", NODES, copies=COPIES),
    "newton, rtol": Way(changed(rtol=float), "rtol", TOLERANCES, copies=COPIES),
    "auto": Way(
        changed(base="auto", accuracy=float, rtol=lambda accuracy: 0.1 * accuracy),
        "accuracy",
        (0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 1e-3, 1e-4),
        ("coatings",),
    ),
    "the other law": Way(swapped("micro", "power_law", "disc_cell"), "rtol", (1e-6,), (*PAPERS, "coatings")),
    "the other layer": Way(swapped("base", "thin_layer", "layered"), "rtol", (1e-6,), ("paper, layer", "coatings")),
}
SIZE, SEED = 100, 1
WORDS = {
    "setting": "what is varied along step, as `varied` says",
    "time": "processor time per case on one thread",
    "median": "error of half the cases",
    "most": "error of 95 % of the cases",
    "worst": "largest error",
    "ended": "share of cases whose iteration closed",
}


def plan(ways: dict[str, Way] = WAYS, size: int = SIZE) -> str:
    """The plan of the measurements, as text."""
    settings = {name: [way.varied, way.settings, way.sets, way.most, way.copies] for name, way in ways.items()}
    iterates = [paper_error.INTERVALS, paper_error.STEPS]
    return json.dumps({"size": size, "seed": SEED, "ways": settings, "iterates": iterates})


@registry.measured("tradeoff", plan, title="Work and precision of every way to solve the model")
def measure(size: int = SIZE, repeats: int = 3, ways: dict[str, Way] = WAYS) -> xr.Dataset:
    """Work and precision over (set, way, step), with the number of measured `cases`, and the variables of
    `paper_error`.

    size : cases of each set; those that the model cannot solve (`status` of the reference) are left out
    """
    shape = len(SETS), len(ways), max(len(way.settings) for way in ways.values())
    arrays = {name: np.full(shape, np.nan) for name in WORDS}
    counts = np.zeros(shape[:2], dtype=np.int32)
    for i, (name, make) in enumerate(SETS.items()):
        cases_and_reference = with_reference(make(size, SEED))
        for j, way in enumerate(ways.values()):
            if name not in way.sets:
                continue
            cases, reference = selection(*cases_and_reference, way.index(len(cases_and_reference[1].a)))
            counts[i, j] = len(reference.a)
            for step, setting in enumerate(way.settings):
                copies = way.copies if name in PAPERS else 1
                for key, value in measured(way, setting, cases, reference, repeats, copies).items():
                    arrays[key][i, j, step] = value
    return assembled(arrays, counts, ways)


def measured(way: Way, setting: float, cases: dict, reference: Solution, repeats: int, copies=1) -> dict[str, float]:
    """The numbers that WORDS lists, for one way and setting; `copies` of the cases are timed together."""
    way.prepare(setting)
    batch, reference = selection(cases, reference, np.tile(np.arange(len(reference.a)), copies))
    seconds, solution = timed(lambda: way.run(batch, setting), repeats)
    error = errors(solution, reference)
    median, most = np.quantile(error, (0.5, 0.95), method="higher")
    ended = np.isin(solution.status, ENDED).mean()
    numbers = (setting, seconds / len(error), median, most, error.max(), ended)
    return dict(zip(WORDS, numbers, strict=True))


def with_reference(cases: dict) -> tuple[dict, Solution]:
    """The cases that have a solution, and their solutions at the tolerance REFERENCE."""
    reference = solve(Problem.of(**cases | {"rtol": REFERENCE}), X)
    return selection(cases, reference, np.flatnonzero(np.isin(reference.status, ENDED)))


def selection(cases: dict, reference: Solution, index: np.ndarray) -> tuple[dict, Solution]:
    """The cases at `index` and their reference solutions."""
    part = {name: value[index] if np.ndim(value) else value for name, value in cases.items()}
    return part, reference.take(index)


def timed(action: Callable[[], Solution], repeats: int) -> tuple[float, Solution]:
    """Shortest time of up to 1 + repeats runs of an action, and its result; long runs are not repeated."""
    times, solution = [], None
    for _ in range(1 + repeats):
        start = time.process_time()
        solution = action()
        times.append(time.process_time() - start)
        if sum(times) > PATIENCE:
            break
    return min(times), solution


def errors(solution: Solution, reference: Solution) -> np.ndarray:
    """(B,) the largest of the relative errors of each case, at most 1; 1 without an answer."""
    with np.errstate(all="ignore"):
        largest = difference(solution, reference)
    return np.minimum(np.nan_to_num(largest, nan=1.0, posinf=1.0), 1.0)


def assembled(arrays: dict, counts: np.ndarray, ways: dict[str, Way]) -> xr.Dataset:
    """The dataset of `measure`."""
    variables = {
        name: (("set", "way", "step"), array, {"long_name": WORDS[name]} | ({"units": "s"} if name == "time" else {}))
        for name, array in arrays.items()
    }
    variables["cases"] = ("set", "way"), counts, {"long_name": "cases measured"}
    variables["varied"] = "way", [way.varied for way in ways.values()]
    return xr.Dataset(variables, {"set": list(SETS), "way": list(ways)}).merge(paper_error.measured())
