"""The four terms of a contact with adhesion: powers of inputs times functions of the radius and of the other inputs.

P = P₀ - pull_P and D = D₀ - pull_D, :mod:`solver.smooth.adhesion.curve_terms`. P₀ and pull_P have the modulus E of
the touched body as a factor. With :mod:`~solver.smooth.adhesion.jkr` both pulls are proportional to the root of w/E,
and under a paraboloid or a cone lengths act only through a/h. So w and k_machine are not coordinates of a table, and
often E, h, R and half_angle are not either. For :mod:`~solver.smooth.adhesion.maugis` the terms here are those of JKR;
its pulls follow from a :class:`.ring_table.RingTable`.
"""

from typing import Any, NamedTuple

import numpy as np

from solver.bases import named
from solver.shapes import PARABOLOID
from solver.smooth.adhesion.curve_terms import curve_terms, radii_of

from ....inputs.scene.scene import Scene, with_unit
from ..model import CurveModel, is_ratio

#: Powers of E, w, the unit of a, R and the cotangent in P₀, D₀, pull_P and pull_D.
_USUAL = {"E": (1, 0, 0.5, -0.5), "w": (0, 0, 0.5, 0.5)}
_USUAL |= dict.fromkeys(("length", "R", "cotangent"), (0, 0, 0, 0))
_SIMILAR = {"length": (3, 2, 1.5, 0.5), "R": (-1, -1, 0, 0)}
#: A cone has no length, but the cotangent of its half angle.
_CONE = {"length": (2, 1, 1.5, 0.5), "cotangent": (1, 1, 0, 0)}
_DMT = {"E": (1, 0, 0, 0), "w": (0, 0, 1, 0)}
_DMT_SIMILAR = {"length": (3, 2, 0, 0), "R": (-1, -1, 1, 0)}
#: SI powers of the modulus and of R in these terms.
_OF_PARTS = ((1, 2), (0, 1), (1, 2), (0, 1))
#: Stands for the logarithm of 0, such as that of pull_D with "dmt".
_NOTHING = -700.0
#: Relative change of inputs for derivatives by their logarithms (ratios: change of the ratio).
_MOVE = 1e-5


def is_modulus(name: str) -> bool:
    """Whether an input is the Young's modulus of a body or layer."""
    return name.rpartition(".")[2].startswith("E")


class Terms(NamedTuple):
    """The dependence of the terms of a model on its inputs.

    powers : name of a factor, "E", "w", "length", "R", "cotangent" -> its power (4,) in each term
    axes : unknown inputs on which the terms depend besides these factors
    length : the input that is the unit of the radius: "h" or "R"
    """

    model: CurveModel
    powers: dict[str, np.ndarray]
    axes: tuple[str, ...]
    length: str

    @classmethod
    def of(cls, model: CurveModel) -> "Terms":
        values, numbers = model.scene.values, model.scene.parameters
        law = numbers.get("adhesion", "jkr")
        powers = _USUAL | (_DMT if law == "dmt" else {})
        left_out = {"k_machine", "w_adhesion", "sigma0", "z0"}
        shape = numbers.get("shape", PARABOLOID)
        similar = shape in (PARABOLOID, "cone")
        similar &= numbers.get("base", "layered") in ("layered", "half_space", "auto")
        length = "h" if "h" in values and similar and numbers.get("base", "layered") != "half_space" else "R"
        if similar:
            powers = powers | (_DMT_SIMILAR if law == "dmt" else _CONE if shape == "cone" else _SIMILAR)
            left_out |= {"h", "R", "half_angle"}
        moduli = {name for name in values if is_modulus(name)} - {model.modulus}
        if all(np.all(np.isinf(values[name])) for name in moduli):
            left_out.add(model.modulus)
        axes = tuple(name for name in model.unknowns if name not in left_out)
        return cls(model, {name: np.array(row, float) for name, row in powers.items()}, axes, length)

    def factors(self, values: dict[str, Any]) -> np.ndarray:
        """The logarithm (4, ...) of the product of the factors, for values (...) of inputs in SI."""
        every = self.model.scene.values | {"R": self.model.scene.R} | values
        numbers = {"E": self.model.touched(values), "w": every["w_adhesion"], "length": every[self.length]}
        numbers["R"] = every["R"]
        if self.powers["cotangent"].any():
            angle = values.get("half_angle", self.model.scene.parameters["half_angle"])
            numbers["cotangent"] = 1 / np.tan(np.radians(angle))
        shape = np.broadcast_shapes(*(np.shape(value) for value in numbers.values()))
        total = np.zeros((4, *shape))
        for name, value in numbers.items():
            total += self.powers[name].reshape(4, *[1] * len(shape)) * np.log(value)
        return total

    def by(self, name: str, values: dict[str, Any]) -> np.ndarray:
        """Derivatives (4,) or (4, B, 1) of the logarithms of the factors by the coordinate of an input."""
        total = np.zeros(4)
        nu = {"E1": "nu1", "E2": "nu2"}[self.model.modulus]
        if name == self.model.modulus:
            total = total + self.powers["E"]
        if name == nu:
            ratio = values.get(nu, self.model.value(nu))
            return self.powers["E"].reshape(4, *[1] * np.ndim(ratio)) * (2 * ratio / (1 - ratio**2))
        total = total + self.powers["w"] * (name == "w_adhesion") - self.powers["cotangent"] * (name == "half_angle")
        return total + self.powers["length"] * (name == self.length) + self.powers["R"] * (name == "R")

    def numbers(self, values: dict[str, np.ndarray]) -> tuple[Scene, dict[str, Any]]:
        """The scene with other values (C,) of inputs, and its numbers for the solver except load, depth and radius."""
        changed = self.model.scene_of(values)
        names = {name: value for name, value in changed.parameters.items() if name in changed.lexicon.parameters}
        names = {name: value for name, value in names.items() if name not in ("P", "a", "D", "k_machine", "branch")}
        names["base"] = named(names.get("base", "layered")).item()
        return changed, names

    def logarithms(self, values: dict[str, np.ndarray], x: np.ndarray) -> np.ndarray:
        """The logarithms of the terms without their factors, and their slopes by x, (8, C, m), for values (C,) of
        inputs.

        x : (m,), logarithm of the radius over the length, or the solver's variable for shapes that end or are flat
            around the axis
        """
        count = len(next(iter(values.values()), np.zeros(1)))
        changed, names = self.numbers(values)
        names |= {"adhesion": "jkr"} if names.get("adhesion") == "maugis" else {}
        problem = changed.lexicon.problem(names, a=np.full(count, 0.01))
        shift = np.log(names["h"]) if self.length == "h" else 0.0
        terms = curve_terms(problem, np.broadcast_to(x + np.reshape(shift, (-1, 1)), (count, len(x))))
        factors = np.broadcast_to(self.factors(values).reshape(4, -1), (4, count))
        out = np.empty((8, count, len(x)))
        for i, powers in enumerate(_OF_PARTS):
            unit = np.broadcast_to(with_unit(1.0, powers, changed.unit, changed.R), (count,))
            positive = np.where(terms.values[i] > 0, terms.values[i], np.where(terms.values[i] == 0, 1.0, np.nan))
            nothing = terms.values[i] == 0
            out[i] = np.where(nothing, _NOTHING, np.log(positive) + (np.log(unit) - factors[i])[:, None])
            out[4 + i] = np.where(nothing, 0.0, terms.slopes[i] / positive)
        return out

    def radii(self, values: dict[str, np.ndarray], x: np.ndarray) -> np.ndarray:
        """The radii (C, m) in m at x (C, m), as of :meth:`logarithms`."""
        changed, names = self.numbers(values)
        problem = changed.lexicon.problem(names, a=np.full(len(x), 0.01))
        shift = np.reshape(np.log(names["h"]) if self.length == "h" else 0.0, (-1, 1))
        return radii_of(problem, x + shift) * np.reshape(changed.R, (-1, 1))

    def moved(self, name: str, values: dict[str, np.ndarray], x: np.ndarray, still: np.ndarray) -> np.ndarray:
        """Derivatives of `logarithms` by the logarithm of an input that is not unknown (by a Poisson ratio itself).

        still : (8, C, m), the logarithms without a change of the input
        """
        if name in ("k_machine", "w_adhesion", "sigma0", "z0"):
            return 0 * still
        value = np.full(still.shape[1], self.model.value(name))
        by = _MOVE * (-1.0 if is_ratio(name) else value)  # a ratio of 0.5 must not rise
        return (self.logarithms(values | {name: value + by}, x) - still) / (-_MOVE if is_ratio(name) else _MOVE)
