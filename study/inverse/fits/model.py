"""The curve y(x) of a scene as a function of its unknown inputs: exact, from the solver, in SI units."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solver import Problem, solve
from solver.parameters import COMMON as LIMITS
from solver.parameters import ends
from solver.shapes import PARABOLOID

from ...inputs.definition import Definition, StudyError
from ...inputs.punch.shapes import ANGLES
from ...inputs.scene.scene import Scene, make_dimensionless, with_unit, without_unit
from ...inputs.vocabulary import VOCABULARY

#: Two rows of exponents for each pair (x, y). The first has q, e, r of Hertz's contact on a half-space of the layer's
#: material, y = x^q E^e R^r. The second has those of x, h, R, E in a dimensionless number u. The only length in the
#: contact of a smooth paraboloid is h²/R: so y over Hertz's y depends only on u and on ratios of moduli.
HERTZ = {
    ("D", "P"): ((1.5, 1.0, 0.5), (1.0, -2.0, 1.0, 0.0)),
    ("P", "a"): ((1 / 3, -1 / 3, 1 / 3), (1.0, -3.0, 1.0, -1.0)),
    ("a", "dP_dD"): ((1.0, 1.0, 0.0), (1.0, -1.0, 0.0, 0.0)),
}
PAIRS = tuple(HERTZ)
_RTOL = 1e-7  # of the solutions, and so of the tables
_SMOOTH = ("layered", "half_space")  # bases on which a smooth contact depends on u


def is_ratio(name: str) -> bool:
    """Whether an input is a Poisson ratio, which may be 0: its coordinate is the ratio itself, not a logarithm."""
    return name in ("nu1", "nu2", "nu_punch")


@dataclass(frozen=True)
class CurveModel:
    """A curve y(x) of one contact.

    scene : inputs of the contact in SI; those in `unknowns` have arbitrary values
    x, y : ("D", "P"), ("P", "a") or ("a", "dP_dD")
    unknowns : names of inputs. The coordinate of an input is the logarithm of its SI value; of a Poisson ratio the
        ratio; of an angle the logarithm of its tangent, since the load of a cone is a power of that, and any number is
        then an angle
    moved : other inputs for derivatives, by their logarithms (by ratios themselves)
    """

    scene: Scene
    x: str
    y: str
    unknowns: tuple[str, ...]
    moved: tuple[str, ...] = ()

    @classmethod
    def of(
        cls, definition: Definition, x: str, y: str, unknowns: tuple[str, ...], moved: tuple[str, ...]
    ) -> "CurveModel":
        """The model of a checked call. Raises StudyError for an input with several values."""
        several = [*definition.grid.sizes]
        if several:
            raise StudyError([f"fit: {name} has several values: one for all curves is allowed" for name in several])
        assert definition.scene is not None
        return cls(definition.scene, x, y, unknowns, moved)

    @property
    def modulus(self) -> str:
        """The modulus of the touched body: E1 with a layer, otherwise E2."""
        return "E1" if "E1" in self.scene.values else "E2"

    @property
    def is_similar(self) -> bool:
        """Whether h and R act only through u: under a smooth paraboloid on the exact layer or a half-space."""
        numbers = self.scene.parameters
        usual = numbers.get("shape", PARABOLOID) == PARABOLOID and not self.sticks
        return usual and numbers.get("micro") == "smooth" and numbers.get("base", "layered") in _SMOOTH

    @property
    def sticks(self) -> bool:
        """Whether a work of adhesion above 0 is among the inputs."""
        return "w_adhesion" in self.unknowns or bool(np.any(self.scene.values.get("w_adhesion", 0.0) > 0))

    @property
    def scales_only(self) -> bool:
        """Whether the modulus of the touched body is the only finite modulus: then it is a mere factor of y."""
        values = self.scene.values
        others = {"E1", "E2", "E_punch"} - {self.modulus}
        return self.is_similar and all(np.isinf(values.get(name, np.inf)) for name in others)

    @property
    def axes(self) -> tuple[str, ...]:
        """Unknown inputs on which y over Hertz's y depends, besides u."""
        left_out = {"h", "R"} if self.is_similar else set()
        left_out |= {self.modulus} if self.scales_only else set()
        return tuple(name for name in self.unknowns if name not in left_out)

    def value(self, name: str) -> float:
        return float(self.scene.values[name] if name in self.scene.values else self.scene.parameters[name])

    def coordinate(self, name: str, value: Any) -> np.ndarray:
        """The coordinate of a value in SI."""
        if name in ANGLES:
            return np.log(np.tan(np.radians(value)))
        return np.asarray(value, float) if is_ratio(name) else np.log(value)

    def of_coordinate(self, name: str, coordinate: Any) -> Any:
        """The value in SI of a coordinate."""
        with np.errstate(over="ignore"):  # at the end of the interval of an input that the curve hardly determines
            if name in ANGLES:
                return np.degrees(np.arctan(np.exp(coordinate)))
            return np.asarray(coordinate) if is_ratio(name) else np.exp(coordinate)

    def slope(self, name: str, value: Any) -> Any:
        """d(value in SI)/d(its coordinate)."""
        if name in ANGLES:
            return np.degrees(np.sin(2 * np.radians(value)) / 2)
        return np.ones_like(value, float) if is_ratio(name) else np.asarray(value, float)

    def within(self, values: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Values (M,) moved into the range of the solver: ratios up to 0.5, and n = E1*/E2* within its interval.
        Outside this interval y over Hertz's y no longer changes."""
        values = values | {name: np.minimum(values[name], 0.5) for name in ("nu1", "nu2") if name in values}
        every = self.scene.values | values
        if {"E1", "E2"} <= {*every} and np.isfinite(every["E2"]).all() and {"E1", "E2"} & {*values}:
            low, high, *_ = ends(LIMITS["n"].interval)
            nu1, nu2 = (every.get(name, 0.3) for name in ("nu1", "nu2"))
            n = every["E1"] / (1 - nu1**2) / every["E2"] * (1 - nu2**2)
            factor = np.clip(n, 2 * low, high / 2) / n  # within the ends, to leave room for derivatives
            values = values | ({"E1": values["E1"] * factor} if "E1" in values else {"E2": values["E2"] / factor})
        return values

    def hertz(self, values: dict[str, Any], x: Any, power: tuple) -> Any:
        """x^q E^e R^r, with E the reduced modulus of the touched body."""
        q, e, r = power
        E, R = self.touched(values), values.get("R", self.scene.R)
        return x**q * E**e * R**r

    def touched(self, values: dict[str, Any]) -> Any:
        """The reduced modulus in Pa of the touched body."""
        nu = {"E1": "nu1", "E2": "nu2"}[self.modulus]
        E = values.get(self.modulus, self.scene.values[self.modulus])
        return E / (1 - values.get(nu, self.scene.values.get(nu, 0.3)) ** 2)

    def log_u(self, values: dict[str, Any], x: Any) -> Any:
        """ln u; without similarity ln x."""
        if not self.is_similar:
            return np.log(x)
        return np.log(x) + self.shift(values)

    def shift(self, values: dict[str, Any]) -> Any:
        """ln u - ln x."""
        if not self.is_similar:
            return 0.0
        _, (_, h, R, E) = HERTZ[self.x, self.y]
        thickness = values.get("h", self.scene.values.get("h", 1.0))
        return h * np.log(thickness) + R * np.log(values.get("R", self.scene.R)) + E * np.log(self.touched(values))

    def scene_of(self, values: dict[str, Any]) -> Scene:
        """The scene with other values of inputs, and its numbers for the solver."""
        changed = replace(self.scene, values=self.scene.values | values, parameters=dict(self.scene.parameters))
        make_dimensionless(changed)
        return changed

    def contacts_at(self, values: dict[str, np.ndarray], x: np.ndarray, **numerics: float) -> tuple[Scene, Problem]:
        """The scene with other values of inputs, and the problem of its contacts at x (M,) in SI.

        numerics : parameters of the numerical solution that are not those of the scene
        """
        scene = self.scene_of(values)
        control = without_unit(x, VOCABULARY[self.x].powers, scene.unit, scene.R)
        return scene, self.scene.lexicon.problem(scene.parameters, **numerics, **{self.x: control})

    def solved(self, values: dict[str, np.ndarray], x: np.ndarray) -> np.ndarray:
        """y (M,) at x (M,), both in SI, for values (M,) of inputs; NaN where a contact has no solution.

        A tile of a table may extend past the end of a law of asperities: only the fitted contacts are judged.
        """
        scene, problem = self.contacts_at(values, x, rtol=_RTOL)
        solution = solve(problem, np.array([0.0]), extrapolate=True)
        y = with_unit(getattr(solution, self.y), VOCABULARY[self.y].powers, scene.unit, scene.R)
        return np.where(solution.status == 0, y, np.nan)
