"""The contacts of a design: a grid with one wanted input, solved at any values of that input."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from solver import solve
from solver.laws.trial import going_on
from solver.numerics.caches import once
from solver.status import Status

from ..data.units import with_unit
from ..inputs.definition import Definition
from ..inputs.grid import along, columns
from ..inputs.punch.micro_laws import DIGITS, fits_to
from ..inputs.scene.changes import inputs_of
from ..inputs.scene.scene import Scene, make_dimensionless, over
from ..inputs.vocabulary import VOCABULARY
from ..work.cases import compute, parcel

#: A contact that has pulled off has a load at pull-off too.
_WITH_PULL_OFF = (Status.CONVERGED, Status.PULLED_OFF)
BLOCK = 8000  # largest number of cases that are solved at a time


@dataclass(frozen=True)
class Wanted:
    """A wanted result, and the input that must be determined for it.

    definition : of the grid, in which the input has its lower bound
    target, level : name and value of the wanted result, in SI or dimensionless
    name, low, high : name and bounds of the input, likewise
    """

    definition: Definition
    target: str
    level: float
    name: str
    low: float
    high: float

    @property
    def size(self) -> int:
        return self.definition.grid.size

    def t_of(self, x: Any) -> Any:
        """ln of values of the input, or the values themselves where a bound is not positive."""
        return np.log(x) if self.low > 0 else x

    def x_of(self, t: Any) -> Any:
        """Values of the input at t, within its bounds."""
        return np.clip(np.exp(t) if self.low > 0 else t, self.low, self.high)

    @property
    def width(self) -> float:
        """The unit of t: 1 for an input with a logarithm, otherwise the whole range."""
        return 1.0 if self.low > 0 else self.high - self.low

    @property
    def _refits(self) -> bool:
        """Whether the power law changes with the input."""
        return self.definition.grid.fitted and self.name in ("Nbar", "Ra")

    @once
    def _inputs(self) -> tuple[dict, dict]:
        """SI values of the scene, {} without units, and all other inputs: name -> (B,)."""
        grid, scene = self.definition.grid, self.definition.scene
        others = columns(grid, np.arange(grid.size))
        dims = tuple(grid.sizes)
        values = scene.values if scene else {}
        return {key: np.broadcast_to(over(value, dims), grid.shape).ravel() for key, value in values.items()}, others

    def results(self, t: np.ndarray, index: np.ndarray) -> np.ndarray:
        """The wanted result (b,) of the cases `index` at t (b,); NaN where the contact has no solution."""
        pieces = [slice(start, start + BLOCK) for start in range(0, len(t), BLOCK)]
        return np.concatenate([self._results(t[piece], index[piece]) for piece in pieces])

    def _results(self, t: np.ndarray, index: np.ndarray) -> np.ndarray:
        values, others = ({key: column[index] for key, column in table.items()} for table in self._inputs)
        unit = R = 1.0
        if values:
            whole = self.definition.scene
            metres = np.broadcast_to(over(whole.metres, tuple(self.definition.grid.sizes)), self.definition.grid.shape)
            values |= {self.name: self.x_of(t)}
            scene = Scene(values=values, parameters=others, scale=whole.scale, lexicon=whole.lexicon)
            scene.metres = metres.ravel()[index]
            make_dimensionless(scene)
            others, unit, R = scene.parameters, scene.unit, scene.R
        else:
            others |= {self.name: self.x_of(t)}
        if self._refits:
            others |= _fits(others["Nbar"], others["Ra"])
        with going_on():
            solution = solve(self.definition.grid.lexicon.problem(others))
        solved = np.isin(solution.status, _WITH_PULL_OFF) if self.target == "P_off" else solution.status == 0
        numbers = np.where(solved, getattr(solution, self.target), np.nan)
        return with_unit(numbers, VOCABULARY[self.target].powers, unit, R)

    def at(self, t: np.ndarray) -> Definition:
        """The definition of the contacts at t (B, n): the grid with `solution` as its last dimension.

        Its derivatives are by the inputs with spreads, and by those that the wanted input changes.
        """
        definition, scene = self.definition, self.definition.scene
        grid, dims = definition.grid, (*definition.grid.sizes, "solution")
        x = self.x_of(t).reshape(*grid.shape, -1)
        if not scene:
            values = grid.values | {self.name: (dims, x)}
        else:
            scene = replace(scene, values=scene.values | {self.name: xr.DataArray(x, dims=dims)})
            scene.parameters = dict(scene.parameters)
            make_dimensionless(scene)
            arrays = {key: (getattr(v, "dims", ()), np.asarray(v)) for key, v in scene.parameters.items()}
            values = grid.values | {key: pair for key, pair in arrays.items() if key in grid.lexicon.parameters}
        grid = replace(grid, sizes=grid.sizes | {"solution": x.shape[-1]}, values=values)
        if self._refits:
            products = np.broadcast_arrays(along(grid, "Nbar"), along(grid, "Ra"), x)[:2]
            grid = replace(grid, values=grid.values | {key: (dims, v) for key, v in _fits(*products).items()})
        inputs: tuple[str, ...] = ()
        if scene and scene.spreads:
            moving = replace(scene, spreads=scene.spreads | {self.name: scene.values[self.name]})
            inputs = inputs_of(moving, grid)
        return replace(definition, grid=grid, scene=scene, inputs=inputs)


def solve_into(arrays: dict[str, np.ndarray], definition: Definition, index: np.ndarray) -> None:
    """Solve the cases `index` and put their columns into `arrays`, those of all cases."""
    for name, values in compute(parcel(definition, index)).items():
        arrays[name][index] = values


def _fits(Nbar: Any, Ra: Any) -> dict[str, np.ndarray]:
    """B and beta of the power laws that are fitted to Nbar and Ra."""
    products = np.asarray(Nbar * Ra**2)
    different = np.unique(products[np.isfinite(products)]).tolist()
    values = {}
    for name, fits in fits_to(different).items():
        numbers = [float(f"{fits[product]:.{DIGITS}g}") if product in fits else np.nan for product in products.flat]
        values[name] = np.reshape(numbers, products.shape)
    return values
