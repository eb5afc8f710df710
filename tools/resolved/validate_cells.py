"""Cells of a lattice on a coated body with every point resolved, compared with the laws of asperities that feel the
layer alone ("half_space") and of asperities that feel the coated body ("layer").

The pressures come from :func:`solver.laws.cell.periodic.pressed`, the solver of `periodic_rows`; the kernel from
layered_independent.py. They share only the conjugate gradients with the equation of one spot, which is a mean over the
angle. Units E = Ra = l = 1, in which l = 1/sqrt(Nbar) and E = E1*/(1 + m).
"""

from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from influence import Layer
from layered_independent import kernel
from rough_sphere import touched_share
from validate_cases import richardson, stored

from solver.laws import LAWS, cell_rows
from solver.laws.cell.periodic import pressed, response_of
from solver.laws.cell.sums import LATTICES

#: L - 1 is below e^-60 above this kh.
_SHORTEST = 40.0
#: Order of the errors of A and p_max in the side of an element. The error of λ, which has corrected edges, is random
#: and falls about as fast.
ORDER = 2
#: Compared quantities.
QUANTITIES = ("A", "lam", "p_max")


class Cell(NamedTuple):
    """Asperities on a lattice, "square" or "hex", at the pressure at which the law on the coated body has the contact
    fraction λ; l/h, the layer (of any h), and m = E1*/E3* of an elastic punch."""

    lattice: str
    lam: float
    pitch: float
    layer: Layer
    m: float = 0.0


def _chosen() -> tuple[Cell, ...]:
    """Six pitches times four contact fractions; the other parameters take turns, so that each value meets many
    others."""
    chosen, grid = [], product(enumerate((1.0, 1.7, 3.0, 5.5, 10.0, 16.0)), enumerate((0.02, 0.1, 0.25, 0.4)))
    for i, ((row, pitch), (column, lam)) in enumerate(grid):
        n, nu1 = (0.2, 0.5, 2.06, 5.0, 20.0)[i % 5], (0.2, 0.28, 0.35, 0.4, 0.47)[(i + i // 5) % 5]
        lattice, bonded = ("square", "hex")[(row + column) % 2], i % 3 != 1
        chosen.append(Cell(lattice, lam, pitch, Layer(1.0, n, nu1, bonded=bonded), 0.7 if i % 7 in (2, 4) else 0.0))
    return tuple(chosen)


#: Cells, and the numbers of elements along a period of the lattice on the two meshes.
CELLS, MESHES = _chosen(), (256, 512)
#: Layers, pitches over h, and contact fractions of the map; elements along a period.
MATERIALS = {
    "n = 20, bonded": Layer(1.0, 20.0, bonded=True),
    "n = 5, bonded": Layer(1.0, 5.0, bonded=True),
    "n = 0.5, frictionless": Layer(1.0, 0.5),
    "n = 0.2, frictionless": Layer(1.0, 0.2),
    "n = 0.2, bonded, ν1 = 0.45": Layer(1.0, 0.2, nu1=0.45, bonded=True),
}
PITCHES, LAMS, POINTS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0, 16.0), (0.03, 0.12, 0.4), 128
#: Pitches over h of the curves of the law, and the contact fraction that is drawn.
FINE, SHOWN = np.geomspace(1, 16, 57), 0.12
#: Stiffness of bonded layers, and contact fractions of spots of b = 0.1 h.
STIFF, SPARSE = (0.2, 2.0, 5.0, 20.0), (1e-4, 1e-3, 3e-3, 1e-2, 3e-2)


def body(cell: Cell):
    """The kernel of the coated body, k -> L, in units of 1/l."""

    def whole(k):
        u, layer = k / cell.pitch, cell.layer
        L1 = kernel(np.minimum(u, _SHORTEST), layer.n, layer.nu1, layer.nu2, layer.bonded)
        return 1 + np.where(u < _SHORTEST, L1, 0.0) / (1 + cell.m)

    return whole


def period(lattice: str, points: int) -> tuple[np.ndarray, float, float]:
    """Depths below the summits of one period, one of which is the first point, and the steps dx, dy: a square with one
    asperity, or a rectangle with two of a hexagonal lattice."""
    d = LATTICES[lattice]
    rows = points if lattice == "square" else 2 * round(points * np.sqrt(3) / 2)
    height = d if lattice == "square" else np.sqrt(3) * d
    dx, dy = d / points, height / rows
    x, y = np.arange(points) * dx, np.arange(rows)[:, None] * dy
    summits = [(0.0, 0.0)] if lattice == "square" else [(0.0, 0.0), (d / 2, height / 2)]
    away = [
        (x - i - d * np.round((x - i) / d)) ** 2 + (y - j - height * np.round((y - j) / height)) ** 2
        for i, j in summits
    ]
    return np.min(away, axis=0) / 2, dx, dy


def resolved(cell: Cell, p: float, points: int) -> np.ndarray:
    """A, λ and p_max, the pressure on the summit, under the nominal pressure p; then the largest pressure."""
    depths, dx, dy = period(cell.lattice, points)
    answer = response_of(depths.shape, dx, dy, body(cell))
    pressure, A, closed = pressed(depths, answer, p, np.full(depths.shape, p))
    if not closed:
        raise AssertionError(f"conjugate gradients did not end: {cell}")
    return np.array([A, touched_share(pressure), pressure[0, 0], pressure.max()])


def laws(cell: Cell) -> tuple[float, np.ndarray]:
    """The nominal pressure, and there A, λ and p_max of the laws: rows "half_space" and "layer"."""
    layer = cell.layer
    bonding = "bonded" if layer.bonded else "frictionless"
    rows = cell_rows(cell.lattice, cell.lam, cell.pitch, layer.n, layer.nu1, layer.nu2, bonding, cell.m)
    p, A, p_max = rows[0] * (1 + cell.m), rows[1], rows[2] * (1 + cell.m)
    bare = LAWS[f"{cell.lattice}_lattice"].at(p, 1.0, Nbar=1.0, Ra=1.0)
    return p, np.array([[bare.A, bare.lam, bare.p_max], [A, cell.lam, p_max]])


def cells(folder: Path) -> xr.Dataset:
    """The resolved numbers of CELLS, ± half the change between the meshes, and the errors of both laws."""
    parts = []
    for cell in CELLS:
        p, predictions = laws(cell)
        key = ("layer cell", *cell[:3], *cell.layer, cell.m, MESHES)
        meshes = stored(
            folder, key, lambda cell=cell, p=p: {"meshes": [resolved(cell, p, points) for points in MESHES]}
        )
        coarse, fine = meshes["meshes"][-2:]
        limit = richardson(coarse[:3], fine[:3], ORDER)
        data = {"p": p, "resolved": ("quantity", limit), "uncertain": ("quantity", np.abs(limit / fine[:3] - 1) / 2)}
        data |= {"error": (("on", "quantity"), predictions / limit - 1), "largest": fine[3] / fine[2]}
        data |= {"lattice": cell.lattice, "lam": cell.lam, "pitch_over_h": cell.pitch, "m": cell.m}
        parts.append(xr.Dataset(data | {name: getattr(cell.layer, name) for name in ("n", "nu1", "nu2", "bonded")}))
    return xr.concat(parts, "cell").assign_coords(on=["half_space", "layer"], quantity=list(QUANTITIES))


def films() -> xr.Dataset:
    """Over (material, λ, pitch/h): A, λ and p_max of resolved cells over those on a half-space, less 1, and the errors
    of both laws; over (material, λ, fine): A by the law over that on a half-space, less 1."""
    shape = (len(MATERIALS), len(LAMS), len(PITCHES))
    change, error, law = np.empty((*shape, 3)), np.empty((*shape, 2, 3)), np.empty((*shape[:2], len(FINE)))
    for i, layer in enumerate(MATERIALS.values()):
        for j, lam in enumerate(LAMS):
            for k, pitch in enumerate(PITCHES):
                cell = Cell("square", lam, pitch, layer)
                p, predictions = laws(cell)
                exact = resolved(cell, p, POINTS)[:3]
                change[i, j, k], error[i, j, k] = exact / predictions[0] - 1, predictions / exact - 1
            A = np.array([laws(Cell("square", lam, pitch, layer))[1][:, 0] for pitch in FINE.tolist()])
            law[i, j] = A[:, 1] / A[:, 0] - 1
    dims = ("material", "lam", "pitch_over_h")
    data = {"change": ((*dims, "quantity"), change), "error": ((*dims, "on", "quantity"), error)}
    data["law"] = (*dims[:2], "fine"), law
    where = {"material": list(MATERIALS), "lam": list(LAMS), "pitch_over_h": list(PITCHES), "fine": FINE}
    return xr.Dataset(data, where | {"on": ["half_space", "layer"], "quantity": list(QUANTITIES)})


def sparse() -> xr.Dataset:
    """A over that on a half-space, less 1, of spots of a tenth of the layer's thickness, over (n, λ); and pitch/h."""
    pitch = 0.1 / np.sqrt(np.array(SPARSE) / np.pi)
    changes = np.empty((len(STIFF), len(SPARSE)))
    for i, n in enumerate(STIFF):
        for j, (lam, l_h) in enumerate(zip(SPARSE, pitch, strict=True)):
            _, (on_half_space, on_layer) = laws(Cell("square", lam, l_h, Layer(1.0, n, bonded=True)))
            changes[i, j] = on_layer[0] / on_half_space[0] - 1
    return xr.Dataset(
        {"change": (("n", "lam"), changes), "pitch_over_h": ("lam", pitch)}, {"n": list(STIFF), "lam": list(SPARSE)}
    )
