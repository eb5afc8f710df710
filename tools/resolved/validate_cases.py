"""The contacts of `make validate` whose asperities have one height: resolved, predicted on two scales, and compared."""

import hashlib
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from influence import Layer
from rough_sphere import Punch, Resolved, cell_means, real_area, resolved, width

import study

RA = 0.004
#: Values of `asperities_on`, and the laws that are compared over bases, and over `asperities_on`.
ON = ("layer", "half_space")
LAWS = {"base": ("power_law", "disc_cell", "square_lattice"), "asperities_on": ("disc_cell", "square_lattice")}
#: Compared quantity -> its name in the results of the two scales.
QUANTITIES = {"D": "D", "a": "width", "p_max": "p_max", "Ar_An": "area"}
#: Relative change of the pressure in the last step of the conjugate gradients.
TOLERANCE = 1e-6


class Case(NamedTuple):
    """A sphere under the load P with asperities of RA at this pitch; R = E2* = 1. Cells a side, an odd number, and
    elements a side on each mesh, twice as many as on the mesh before. They are no multiple of the cells: each spot lies
    differently on the elements, and so the errors of the area at the edges of the spots differ as well."""

    name: str
    P: float
    pitch: float
    cells: int
    points: tuple[int, ...]
    layer: Layer | None = None


HALF_SPACE = (
    Case("a half-space, few spots", 2e-5, 0.0054, 13, (318, 636, 1272)),
    Case("a half-space", 2e-5, 0.0027, 25, (410, 820, 1640)),
    Case("a half-space, many spots", 2e-5, 0.00135, 51, (644, 1288)),
)
LAYERED = (
    Case("the paper's layer", 2.704e-5, 0.002, 41, (344, 688, 1376), Layer(0.02, 0.5)),
    Case("a soft bonded film", 2e-5, 0.003, 27, (336, 672, 1344), Layer(0.006, 0.2, bonded=True)),
    Case("a hard bonded coating", 4e-5, 0.002, 29, (360, 720, 1440), Layer(0.015, 4.0, bonded=True)),
)
#: Layers thinner than the pitch: one in ever smaller thickness, and four of other stiffness; the hardest also with four
#: times as many spots.
THINNER = tuple(
    Case(f"h = {h:g}", 2e-5, 0.0054, 15, (366, 732), Layer(h, 0.5)) for h in (0.016, 0.008, 0.004, 0.002, 0.001)
)
THIN = (
    Case("n = 0.2, bonded", 2e-5, 0.0054, 15, (366, 732, 1464), Layer(0.0018, 0.2, bonded=True)),
    Case("n = 2.06, bonded", 4e-5, 0.0054, 15, (366, 732, 1464), Layer(0.00045, 2.06, bonded=True)),
    Case("n = 5, bonded", 6e-5, 0.0054, 17, (394, 788, 1576), Layer(0.0012, 5.0, bonded=True)),
    Case("n = 20, frictionless", 6e-5, 0.0054, 17, (394, 788, 1576), Layer(0.0009, 20.0)),
    Case("n = 20, more spots", 6e-5, 0.0027, 31, (752, 1504), Layer(0.00045, 20.0)),
)


def stored(folder: Path, key: tuple, solve) -> dict[str, np.ndarray]:
    """The arrays that `solve` returns. They come from the folder if an earlier run had the same key."""
    name = hashlib.sha256(repr(key).encode()).hexdigest()[:16]
    path = folder / f"{name}.npz"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part.npz")
        np.savez_compressed(part, **solve())
        part.replace(path)
        print(path, *key, flush=True)
    with np.load(path) as data:
        return dict(data)


def solved(case: Case, folder: Path) -> list[Resolved]:
    """The contact on each of its meshes, from the folder or solved now; each solution starts from the coarser one."""
    solutions, start = [], None
    for points in case.points:

        def solve(points=points, start=start):
            half = case.cells * case.pitch / 2
            solution = resolved(Punch(case.pitch, RA), case.P, half, points, case.layer, start, TOLERANCE)
            return solution._asdict()

        data = stored(folder, ("sphere", RA, case._replace(name="", points=()), points), solve)
        solutions.append(Resolved(float(data["D"]), data["p"], data["middle"], float(data["side"])))
        start = np.kron(solutions[-1].p, np.ones((2, 2)))
    return solutions


def parameters_of(layer: Layer | None, over: str = "base") -> dict:
    """The layer as parameters of the two scales, with every base that may be used for it, or with every
    `asperities_on`; the best first."""
    if layer is None:
        return {"base": ["half_space"]}
    words = {"bonding": "bonded" if layer.bonded else "frictionless", "base": ["layered", "thin_layer"]}
    words |= {"base": "layered", "asperities_on": [*ON]} if over == "asperities_on" else {}
    return {"h": layer.h, "n": layer.n, "nu1": layer.nu1, "nu2": layer.nu2} | words


def predicted(case: Case, over: str) -> xr.Dataset:
    """The QUANTITIES on two scales, over the bases or `asperities_on`, and the laws."""
    inputs = {"P": case.P, "Nbar": case.pitch**-2, "Ra": RA, "x": 801, "rtol": 1e-6, "micro": list(LAWS[over])}
    results = study.solve(**inputs, **parameters_of(case.layer, over)).load().transpose(over, "micro", "x")
    x, p = results["x"].values, results["p"].values
    scaled = [[width(x, profile, x) for profile in profiles] for profiles in p]
    results["width"] = (over, "micro"), scaled * results["a"].values
    results["area"] = results["Ar_An"] * np.pi * results["a"] ** 2
    return results


def measured(contact: Resolved) -> dict[str, float]:
    """The QUANTITIES of one mesh; the area in R². p_max is that of the central spot, whose summit is a corner of
    elements on every mesh; in other spots the distance from the summit to the elements varies with the mesh."""
    middle = len(contact.p) // 2
    r = np.hypot(contact.middle[:, None], contact.middle[None, :])
    largest = contact.p[middle, middle]
    return {"D": contact.D, "a": width(r, contact.p, 1.0), "p_max": largest, "Ar_An": real_area(contact)}


def richardson(coarse: float, fine: float, order: int) -> float:
    """The limit of the values on a mesh and on one twice as fine, if the error has this order."""
    return fine + (fine - coarse) / (2**order - 1)


def compared(case: Case, folder: Path, over: str = "base") -> xr.Dataset:
    """All data of a case: errors over (base, law), or over (asperities_on, law), the means of the cells, and the
    nominal pressures."""
    meshes, two = solved(case, folder), predicted(case, over)
    coarse, fine = (measured(mesh) for mesh in meshes[-2:])
    finest = {name: richardson(coarse[name], fine[name], 1 if name == "Ar_An" else 2) for name in QUANTITIES}
    r, mean = cell_means(meshes[-1], case.pitch)
    r, mean = r[mean > 0], mean[mean > 0]
    dims = (over, "law")
    best = two.isel({over: 0}).sel(micro="square_lattice")
    data = {f"{name}_resolved": finest[name] for name in QUANTITIES}
    data |= {f"{name}_uncertain": abs(finest[name] / fine[name] - 1) / 2 for name in QUANTITIES}
    data |= {f"{name}_error": (dims, two[result].values / finest[name] - 1) for name, result in QUANTITIES.items()}
    data |= {"a0": float(best["a"]), "lam0": float(best["lam0"]), "p0": float(best["p0"])}
    data |= {"pitch": case.pitch, "h": case.layer.h if case.layer else np.inf}
    data |= {"model_error": (dims, two["model_error"].values), "cell_error": (dims, cell_errors(r, mean, two, case))}
    data |= {"r": ("cell", r), "mean": ("cell", mean)}
    shown = two.isel(x=slice(None, None, 8))
    data["profile_r"] = (*dims, "x"), shown["a"].values[..., None] * shown["x"].values
    data["profile"] = (*dims, "x"), shown["p"].values
    return xr.Dataset(data, {over: two[over].values, "law": list(LAWS[over]), "cell": np.arange(len(r))})


def cell_errors(r, mean, two: xr.Dataset, case: Case) -> np.ndarray:
    """Largest difference of a cell's mean from p(r), over p(0), for each base and law, at least a pitch inside the
    contact."""
    errors = np.full(two["a"].shape, np.nan)
    for place, a in np.ndenumerate(two["a"].values):
        inside = r < a - case.pitch  # no cell if the base may not be used, since a is NaN
        if inside.any():
            p = two["p"].values[place]
            errors[place] = np.abs(np.interp(r[inside], two["x"].values * a, p) - mean[inside]).max() / p[0]
    return errors


def together(cases: tuple[Case, ...], folder: Path, over: str = "base") -> xr.Dataset:
    """`compared` of all cases, along a dimension of their names."""
    cases_together = xr.concat([compared(case, folder, over) for case in cases], "case", join="outer")
    return cases_together.assign_coords(case=[case.name for case in cases])
