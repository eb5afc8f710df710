"""The contacts of `make validate` whose asperities have random heights: draws of a sphere, and of periodic cells.

Both have their summits on a square lattice. Cells are in units E = Ra = pitch = 1. Depths count from the mean plane of
the law's heights, which is c σ below its highest summit; the micro laws count from the touch of that summit.
"""

from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from influence import Layer
from rough_sphere import Punch, asperities, cell_means, real_area, resolved, touched_share, width
from scipy.special import ndtr, ndtri
from validate_cases import RA, TOLERANCE, parameters_of, richardson, stored
from validate_cells import Cell, body

import study
from solver.kernels.two_layers import TwoLayers
from solver.laws import LAWS
from solver.laws.cell.periodic import pressed, response_of
from solver.laws.heights import UNIFORM

CUT = 4.0
#: Numbers of draws of a sphere, and of a periodic cell: means are then known to a third of the scatter of a sphere.
DRAWS, CELLS_DRAWN = 8, 8
#: Orders of the errors of depth, width, area and largest pressure in the side of an element.
ORDERS = np.array([2, 2, 1, 2])
#: Rings of cells within the contact of the law.
RINGS = 8
#: Summits a side of a periodic cell, elements a side, no multiple of them, and the nominal pressures in E pitch/Ra.
SUMMITS, MESHES, PRESSURES = 15, (124, 248), (0.01, 0.03, 0.1, 0.3)
#: σ over A* = 1/(π N̄ Ra), which is three times the displacement of equal asperities at full contact.
SPREADS = (0.0, 0.1, 0.3)
ONES = {"Nbar": 1.0, "Ra": 1.0}
#: Layers under periodic cells, of a pitch of 6 h, their spreads and nominal pressures.
LAYERS = {f"n = {n:g}": Cell("square", np.nan, 6.0, Layer(1.0, n, bonded=True)) for n in (5.0, 0.2)}
LAYER_SPREADS, LAYER_PRESSURES = (0.1, 0.3), (0.003, 0.01, 0.03)


class Sphere(NamedTuple):
    """A sphere on a half-space, or on a layer, under the load P; σ = spread A*. Cells a side, an odd number, and
    elements a side of a cell on each mesh."""

    name: str
    micro: str
    spread: float
    cells: int
    P: float = 2e-5
    pitch: float = 0.0027
    counts: tuple[int, ...] = (8, 16)
    layer: Layer | None = None

    @property
    def sigma(self) -> float:
        """Standard deviation of the heights."""
        return self.spread * self.pitch**2 / (np.pi * RA)


SPHERES = (
    Sphere("normal, σ = 0.05 A*", "normal_heights", 0.05, 27),
    Sphere("normal, σ = 0.2 A*", "normal_heights", 0.2, 33),
    Sphere("normal, σ = 0.2 A*, the paper's layer", "normal_heights", 0.2, 33, P=1e-5, layer=Layer(0.02, 0.5)),
    Sphere("uniform, σ = 0.2 A*", "uniform_heights", 0.2, 29),
)


def random_heights(micro: str, sigma: float, count: int, seed: list[int]) -> np.ndarray:
    """Random heights (count, count) of summits above the mean, distributed as in the law."""
    share = np.random.default_rng(seed).uniform(size=(count, count))
    if micro == "uniform_heights":
        return sigma * UNIFORM * (2 * share - 1)
    return sigma * ndtri(ndtr(-CUT) + share * (ndtr(CUT) - ndtr(-CUT)))


def highest(micro: str, sigma: float) -> float:
    """The height of the highest summit of the law above the mean plane, c σ."""
    return sigma * (UNIFORM if micro == "uniform_heights" else CUT)


def sphere(case: Sphere, draw: int) -> dict[str, np.ndarray]:
    """One draw: depth, width, area and largest pressure on each mesh, and means of the cells on the finest one."""
    punch = Punch(case.pitch, RA, random_heights(case.micro, case.sigma, case.cells, [1, draw]))
    rows, start = [], None
    for count in case.counts:
        half, points = case.cells * case.pitch / 2, case.cells * count
        solution = resolved(punch, case.P, half, points, case.layer, start, TOLERANCE)
        across = np.hypot(solution.middle[:, None], solution.middle[None, :])
        rows.append([solution.D, width(across, solution.p, 1.0), real_area(solution), solution.p.max()])
        start = np.kron(solution.p, np.ones((2, 2)))
    r, mean = cell_means(solution, case.pitch)
    return {"meshes": np.array(rows), "r": r, "mean": mean}


def finer(folder: Path) -> np.ndarray:
    """Relative changes of depth, width, area and largest pressure (4,) in one draw, with elements half as large."""
    case = SPHERES[0]._replace(counts=(*SPHERES[0].counts, 2 * SPHERES[0].counts[-1]))
    meshes = stored(folder, ("heights", RA, CUT, case[1:], 0), lambda: sphere(case, 0))["meshes"]
    return richardson(meshes[1], meshes[2], ORDERS) / richardson(meshes[0], meshes[1], ORDERS) - 1


def draws(case: Sphere, folder: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Depth, width, area and largest pressure (draw, 4), extrapolated; r (cell,), and means of cells (draw, cell)."""
    spheres = [
        stored(folder, ("heights", RA, CUT, case[1:], draw), lambda draw=draw: sphere(case, draw))
        for draw in range(DRAWS)
    ]
    values = [richardson(*draw["meshes"][-2:], ORDERS) for draw in spheres]
    return np.array(values), spheres[0]["r"], np.array([draw["mean"] for draw in spheres])


def rings(r, mean, a) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean r, mean and its standard error (RINGS,) for the cells (draw, cell) within a, in rings with equal numbers."""
    inside = r < a
    ring = np.arange(np.count_nonzero(inside)) * RINGS // np.count_nonzero(inside)  # r ascends
    count = np.bincount(ring)
    means = np.array([np.bincount(ring, cells_of_draw[inside]) / count for cells_of_draw in mean])
    return np.bincount(ring, r[inside]) / count, means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(len(means))


def compared(case: Sphere, folder: Path) -> xr.Dataset:
    """All data of a sphere, over the laws: the law of its heights, and the laws of one height, at the mean height."""
    values, r, mean = draws(case, folder)
    laws = [case.micro, "disc_cell"]
    inputs = {"P": case.P, "Nbar": case.pitch**-2, "Ra": RA, "x": 401, "rtol": 1e-5}
    inputs |= parameters_of(case.layer) | {"base": "layered" if case.layer else "half_space"}
    of_heights = {"sigma": case.sigma} | ({"cut": CUT} if case.micro == "normal_heights" else {})
    two = [study.solve(**inputs, micro=law, **(of_heights if law == case.micro else {})).load() for law in laws]
    x = two[0]["x"].values
    depth = [float(two[0]["D"]) - highest(case.micro, case.sigma), float(two[1]["D"])]
    wide = [width(x, one["p"].values, x) * float(one["a"]) for one in two]
    area = [float(one["Ar_An"] * np.pi * one["a"] ** 2) for one in two]
    guesses = np.array([depth, wide, area, [float(one["p_max"]) for one in two]]).T
    exact, scatter = values.mean(axis=0), values.std(axis=0, ddof=1)
    data = {"error": (("law", "quantity"), guesses / exact - 1), "scatter": ("quantity", scatter / exact)}
    data |= {"resolved": ("quantity", exact), "spots": float((mean > 0).sum(axis=1).mean())}
    data |= {"sigma": case.sigma, "pitch": case.pitch, "p0": float(two[0]["p0"]), "a0": float(two[0]["a"])}
    data |= dict(zip(("r", "mean", "unsure"), (("ring", one) for one in rings(r, mean, data["a0"])), strict=True))
    at = [np.interp(r, x * float(one["a"]), one["p"].values, right=0.0) for one in two]
    data["law_mean"] = ("law", "ring"), [rings(r, np.stack([one, one]), data["a0"])[1] for one in at]
    names = {"law": ["heights", "one height"], "quantity": ["D", "a", "Ar_An", "p_max"]}
    return xr.Dataset(data, names)


def cell(
    spread: float, p: float, draw: int, layer: Cell | None = None, meshes: tuple[int, ...] = MESHES
) -> dict[str, np.ndarray]:
    """A of the mean plane and λ of one periodic cell of normal heights on each mesh (mesh, 2), on a half-space or on
    the layer of a :class:`.validate_cells.Cell`."""
    heights, rows, start = random_heights("normal_heights", spread / np.pi, SUMMITS, [2, draw]), [], None
    around = np.pad(heights, 1, mode="wrap")
    for points in meshes:
        side = SUMMITS / points
        at = (np.arange(points) + 0.5) * side - SUMMITS / 2
        shape = asperities(*np.meshgrid(at, at, indexing="ij"), 1.0, 1.0, around)
        answer = response_of(shape.shape, side, side, body(layer) if layer else None)
        pressure, A, closed = pressed(shape, answer, p, np.full(shape.shape, p) if start is None else start)
        if not closed:
            raise AssertionError("conjugate gradients did not end")
        rows.append([A, touched_share(pressure)])
        start = np.kron(pressure, np.ones((2, 2)))
    return {"meshes": np.array(rows)}


def cells(folder: Path) -> xr.Dataset:
    """A of the mean plane over A*, and λ, of periodic cells and of the law, over (spread, p, draw)."""
    shape = (len(SPREADS), len(PRESSURES), CELLS_DRAWN)
    limits = np.empty((*shape, 2))
    for i, spread in enumerate(SPREADS):
        for j, p in enumerate(PRESSURES):
            for k in range(CELLS_DRAWN):
                draw = k if spread else 0
                key = ("periodic cell", CUT, SUMMITS, MESHES, spread, p, draw)
                one = stored(folder, key, lambda spread=spread, p=p, draw=draw: cell(spread, p, draw))
                limits[i, j, k] = richardson(*one["meshes"][-2:], np.array([2, 1]))
    dims, where = ("spread", "p", "draw"), {"spread": list(SPREADS), "p": list(PRESSURES)}
    laws = [LAWS["normal_heights"].at(np.array(PRESSURES), 1.0, **ONES, sigma=s / np.pi, cut=CUT) for s in SPREADS]
    data = {"A": (dims, np.pi * limits[..., 0]), "lam": (dims, limits[..., 1])}
    data["law_A"] = dims[:2], [np.pi * one.A - CUT * s for s, one in zip(SPREADS, laws, strict=True)]
    data["law_lam"] = dims[:2], [one.lam for one in laws]
    return xr.Dataset(data, where)


def height_cells(folder: Path) -> xr.Dataset:
    """A of the mean plane over A*, and λ, of periodic cells on LAYERS, over (layer, spread, p, draw), and those of
    the law on a half-space and on the layer."""
    shape, law = (len(LAYERS), len(LAYER_SPREADS), len(LAYER_PRESSURES)), LAWS["normal_heights"]
    limits, laws = np.empty((*shape, CELLS_DRAWN, 2)), np.empty((*shape, 2, 2))
    for (i, layer), (j, spread), (k, p) in product(
        enumerate(LAYERS.values()), enumerate(LAYER_SPREADS), enumerate(LAYER_PRESSURES)
    ):
        for draw in range(CELLS_DRAWN):
            key = ("periodic cell", CUT, SUMMITS, MESHES, spread, p, draw, layer)
            one = stored(folder, key, lambda spread=spread, p=p, draw=draw, layer=layer: cell(spread, p, draw, layer))
            limits[i, j, k, draw] = richardson(*one["meshes"][-2:], np.array([2, 1]))
        parameters = {name: np.array([value]) for name, value in (ONES | {"sigma": spread / np.pi, "cut": CUT}).items()}
        n, nu1, nu2, bonded = (np.array([value]) for value in layer.layer[1:])
        on_body = law.on_body(
            TwoLayers(n, nu1, nu2, bonded), np.zeros(1), 1 / np.array([layer.pitch]), np.ones(1), **parameters
        )
        for at, bound in enumerate((law.bind(np.ones(1), **parameters), on_body)):
            with np.errstate(invalid="ignore"):  # summits that do not touch
                spots = bound.at(np.array([[p]]))
            laws[i, j, k, at] = np.pi * spots.A[0, 0] - CUT * spread, spots.lam[0, 0]
    dims = ("layer", "spread", "p")
    data = {"A": ((*dims, "draw"), np.pi * limits[..., 0]), "lam": ((*dims, "draw"), limits[..., 1])}
    data |= {"law_A": ((*dims, "on"), laws[..., 0]), "law_lam": ((*dims, "on"), laws[..., 1])}
    where = {"layer": list(LAYERS), "spread": list(LAYER_SPREADS), "p": list(LAYER_PRESSURES)}
    return xr.Dataset(data, where | {"on": ["half_space", "layer"]})
