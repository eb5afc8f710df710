"""The numbers printed in the paper beside ours, and a reason why they may be 0.6 % off (docs/tradeoff.md).

They are compared with converged numbers, and with single iterates of the paper's successive approximations.
"""

import numpy as np
import xarray as xr

from solver import Problem, solve
from solver.closed_forms import hertz
from study import derived
from study.figures.registry import pick, table

from . import numbers
from .law_fits import bound, exact, fitted, largest_error, printed
from .uniform import solve_uniform

MAIN = {"base": "thin_layer", "h": 0.02, "n": 0.5, "Nbar": 250_000, "Ra": 0.004}
MAIN |= {"micro": "power_law", "B": 0.1, "beta": 0.5}
RADIUS = 0.04  # a0 of the paper's main case
INTERVALS = (20, 40, 80, 160)  # of the uniform meshes that the paper may have had
STEPS = 40  # iterates on each
SHARED = ("P", "D", "A0", "Ar_An", "p_max")
"""Quantities of the rough layered contact that are compared; keys of `numbers.NUMBERS`."""


def measured() -> xr.Dataset:
    """The iterates of the paper's main case at its radius by scheme (8) with k = 0, and the numbers of two of them.

    Over (intervals, iterate): iterate_P, iterate_D, ... of SHARED, in R = E2* = 1. Over `quantity`, keys of
    `numbers.NUMBERS`: `converged`, and `by_iterates`, see `explained`. `pair`: number of intervals, and the iterate.
    """
    problem = Problem.of(a=RADIUS, **MAIN)
    solutions = [[solve_uniform(problem, n, 0.0, 1e-12, m) for m in range(1, STEPS + 1)] for n in INTERVALS]
    variables = {
        f"iterate_{name}": (("intervals", "iterate"), [[float(getattr(s, name)[0]) for s in row] for row in solutions])
        for name in SHARED
    }
    iterates = xr.Dataset(variables, {"intervals": list(INTERVALS), "iterate": np.arange(1, STEPS + 1)})
    return iterates.merge(explained(iterates))


def nearest_pair(iterates: xr.Dataset) -> dict[str, int]:
    """Indices of mesh and iterate for which the iterate's load and the next one's depth are nearest to the paper's."""
    load = np.abs(iterates["iterate_P"] / numbers.NUMBERS["P"][1] - 1).isel(iterate=slice(None, -1)).values
    depth = np.abs(iterates["iterate_D"] / numbers.NUMBERS["D"][1] - 1).isel(iterate=slice(1, None)).values
    mesh, step = np.unravel_index(np.argmin(np.maximum(load, depth)), load.shape)
    return {"intervals": int(mesh), "iterate": int(step)}


def explained(iterates: xr.Dataset) -> xr.Dataset:
    """The paper's numbers of Section 5, from converged solutions and from the nearest pair of iterates.

    The first iterate of the pair gives the load. The second gives the other numbers of the rough layered contact. The
    other contacts are converged solutions under the load of the second iterate.
    """
    pair = nearest_pair(iterates)
    first, second = iterates.isel(pair), iterates.isel(pair | {"iterate": pair["iterate"] + 1})
    converged = contacts(float(solve(Problem.of(a=RADIUS, **MAIN, rtol=1e-9)).P[0]))
    theirs = contacts(float(second["iterate_P"]))
    theirs |= {name: float(second[f"iterate_{name}"]) for name in SHARED} | {"P": float(first["iterate_P"])}
    variables = {"converged": [converged[key] for key in theirs], "by_iterates": list(theirs.values())}
    table = xr.Dataset({name: ("quantity", values) for name, values in variables.items()}, {"quantity": list(theirs)})
    return table.assign(pair=("end", [int(first["intervals"]), int(first["iterate"])]))


def contacts(load: float) -> dict[str, float]:
    """The numbers of Section 5 from converged solutions under one load; keys of `numbers.NUMBERS`."""
    changes = {}, {"base": "half_space"}, {"micro": "smooth"}
    layered, bare, smooth = (solve(Problem.of(P=load, **MAIN | change, rtol=1e-9)) for change in changes)
    ours = {name: float(getattr(layered, name)[0]) for name in SHARED} | {"An_ratio": float(bare.a[0] / RADIUS) ** 2}
    return ours | {"D smooth layered": float(smooth.D[0]), "D smooth homogeneous": float(hertz(P=load).D)}


@table(
    "paper_error",
    "tradeoff",
    long=True,
    columns="quantity; paper | .4g; converged | .5g; converged off | +.2%; iterates | .5g; iterates off | +.2%",
)
def rows(study: xr.Dataset) -> list[tuple]:
    """The paper's numbers, the converged ones, and those by two successive iterates of Eq. (8) with k = 0: the load by
    the first, the rest by the second, or under its load."""
    table = []
    for key, *ours in zip(*(study[name].values for name in ("quantity", "converged", "by_iterates")), strict=True):
        quantity, printed = numbers.NUMBERS[str(key)]
        table.append((quantity, printed, *(float(v) for value in ours for v in (value, value / printed - 1))))
    return table


@table(
    "paper_numbers",
    "reference_load",
    "main_case",
    columns="quantity; paper | .4g; roughcoat | .5e; difference | +.2%",
)
def paper_numbers(reference: xr.Dataset, main: xr.Dataset) -> list[tuple]:
    """Numbers printed in the paper and the converged ones of the same model.

    Of a bound it tells whether it holds.
    """
    rough, homogeneous = (pick(main, label=f"rough, {base}") for base in ("layered", "homogeneous"))
    Ra, Nbar, *_ = numbers.TABLE1[0]
    fit = fitted(Ra, Nbar)
    ours = {"P": reference["P"]}
    ours |= {name: rough[name] for name in ("p0", "Ar_An", "p_max", "D", "A0")}
    ours |= {"An_ratio": derived.nominal_area_ratio(homogeneous, reference["a"])}
    ours |= {f"{name} homogeneous": homogeneous[name] for name in ("Ar_An", "p_max")}
    ours |= {f"D smooth {base}": pick(main, label=f"smooth, {base}")["D"] for base in ("layered", "homogeneous")}
    ours |= {"B": fit.B / Ra, "beta": fit.beta}
    rows = [
        (quantity, printed, float(ours[key]), float(ours[key]) / printed - 1)
        for key, (quantity, printed) in numbers.NUMBERS.items()
    ]
    for Ra, Nbar, *_ in numbers.TABLE1[:3]:
        error, density = largest_error(printed(Ra, Nbar), exact(Ra, Nbar)), Nbar * Ra**2
        holds = "holds" if error <= numbers.ERROR_BOUNDS[round(density, 9)] else "does not hold"
        rows.append((f"error of the paper's fit, N Ra^2 = {density:g}", bound(Ra, Nbar), error, holds))
    return rows
