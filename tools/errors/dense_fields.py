"""Does a dense field have more than the search found? `python tools/errors/dense_fields.py [BODIES [SEED]]`.

Random smooth contacts on one layer, on two or three, bonded, sliding, on springs and on rigid bases, with friction and
without; two in three of one layer without springs are no stack, and one punch in ten is no ball. A line a body: its
seed, its layers, friction, and by how much of the largest stress some extreme is less than the field on a dense grid,
or 0, with the name of that extreme. The last line counts those that miss more than MISSED.
"""

import sys
import warnings

import numpy as np

from solver import Problem, solve
from solver.fields.contact import of_contacts as fields_of
from solver.fields.sliding import in_plane
from solver.yields.contact import of_contacts as of_one_layer
from solver.yields.extremes import VALUES
from solver.yields.stacked.largest import DIMENSION, EXTREMES
from solver.yields.stacked.mixture import of_mixture

#: Radius of the contacts, in that of the punch; the least and the most of h/a and of n.
RADIUS, THICKNESS, MODULUS = 0.01, (0.01, 10.0), (0.01, 200.0)
#: Part of the largest stress: more is a place that the search missed.
MISSED = 1e-6
#: Points of the dense grid: in a layer, below the last one, along the surface in each length beyond the edge.
DEPTHS, BELOW, OUTSIDE = 12, np.geomspace(0.03, 3, 12), np.geomspace(0.05, 8, 14)
#: Punches that are no balls: their inputs from a random generator.
SHAPES = (
    lambda random: {"shape": "power", "shape_coefficient": 1.0, "shape_power": random.uniform(1.2, 8)},
    lambda random: {"shape": "rounded_flat", "flat_radius": RADIUS * random.uniform(0.2, 0.98), "edge_radius": 1.0},
    lambda random: {"shape": "blunt_cone", "tip_radius": RADIUS * random.uniform(0.1, 3), "half_angle": 85.0},
    lambda random: {"shape": "sphere"},
)


def body(seed: int) -> tuple[Problem, float]:
    """A random contact and its friction."""
    random = np.random.default_rng(seed)
    rigid, layers = random.random() < 0.1, []
    for j in range(int(random.integers(1, 4))):
        h, n = np.exp(random.uniform(np.log([THICKNESS[0], MODULUS[0]]), np.log([THICKNESS[1], MODULUS[1]])))
        layer = {"h": RADIUS * h, "n": 1.0 if rigid and not j else n, "nu": random.uniform(0, 0.5)}
        spring = {"cn": RADIUS * h / n, "ct": RADIUS * h / n}
        kinds = ["bonded", "frictionless"] + ([] if rigid else [spring])
        layers.append(layer | {"bonding": kinds[random.choice(len(kinds), p=[0.6, 0.4] if rigid else [0.6, 0.3, 0.1])]})
    inputs = {"rigid_base": True} if rigid else {}
    inputs |= {"a": RADIUS, "micro": "smooth", "nu2": random.uniform(0, 0.5)}
    mu, more = float(random.choice([0, 0, 0.3])), np.random.default_rng([seed, 1])
    if more.random() < 0.1:
        inputs |= SHAPES[more.integers(len(SHAPES))](more)
    if len(layers) == 1 and not isinstance(layers[0]["bonding"], dict) and more.random() < 2 / 3:
        return Problem.of(**inputs, nu1=layers[0].pop("nu"), **layers[0]), mu
    return Problem.of(**inputs, layers=layers), mu


def extremes(problem: Problem, solution, mu: float) -> dict[str, np.ndarray]:
    """Name -> the largest value of each layer, interface or of the whole, as the search has them."""
    if problem.base[0] == "stack":
        values = of_mixture(problem, solution, mu)
        return {name: values[name][0, 0] if DIMENSION[EXTREMES[name][1]] else values[name][0] for name in EXTREMES}
    values = of_one_layer(problem, solution, mu)
    of_layer = {"mises_layer": "mises1", "tresca_layer": "tresca1", "sr_interface": "sr_interface1"}
    return {name: values[of_layer.get(name, name)][0] for name in EXTREMES}


def dense(problem: Problem, solution, mu: float, tops: np.ndarray) -> dict[str, np.ndarray]:
    """Name -> the largest value of each layer, interface or of the whole, on a dense grid."""
    lengths = np.concatenate([[1.0], np.diff(tops), tops[1:]])
    near = np.outer(lengths, OUTSIDE).ravel()
    r = np.concatenate([np.linspace(0, 1.6, 25), 1 - near, 1 + near])
    r = np.unique(np.round(r[(r >= 0) & (r < 12 * (1 + tops[-1]))], 6))
    inside = [top + (end - top) * np.linspace(0.02, 0.98, DEPTHS) for top, end in zip(tops[:-1], tops[1:], strict=True)]
    below = tops[-1] + np.unique(np.outer(lengths, BELOW))
    fields = fields_of(problem, solution, r, np.concatenate([[0.0], *inside, below]), mu)
    places = [in_all(part, mu) for part in fields[:3]]
    whole, above, under = places
    ends = np.cumsum([1, *map(len, inside)])
    of_layers = [whole[..., a:b, :] for a, b in zip(ends[:-1], ends[1:], strict=True)]
    for j, stresses in enumerate(of_layers):
        top = whole[..., :1, :] if j == 0 else under[..., j - 1 : j, :]
        of_layers[j] = np.concatenate([top, stresses, above[..., j : j + 1, :]], axis=-2)
    of_places = {
        "layer": of_layers,
        "lower": [above[..., j : j + 1, :] for j in range(len(inside))],
        "surface": [whole[..., :1, :]],
        "body": [np.concatenate([under[..., -1:, :], whole[..., ends[-1] :, :]], axis=-2)],
    }
    return {
        name: np.array([np.nanmax(VALUES[function](*part), initial=-np.inf) for part in of_places[place]])
        for name, (function, place) in EXTREMES.items()
    }


def in_all(part: dict, mu: float) -> np.ndarray:
    """sr, st, sz, trz (4, S, Z, R) of one contact, ahead and behind if it slides."""
    sides = [in_plane(part, behind) for behind in (False, True)] if mu > 0 else [part]
    return np.array([[side[name][0] for side in sides] for name in ("sr", "st", "sz", "trz")])


def missed(seed: int) -> tuple[str, float, str]:
    """The body in words, by how much the search fell short, and of what."""
    problem, mu = body(seed)
    solution = solve(problem)
    names = ["h", *(f"layers.{j}.h" for j in range(2, 5))]
    thickness = [getattr(problem, name)[0] for name in names if name == "h" or name in problem.parameters]
    tops = np.append(0.0, np.cumsum(thickness)) / solution.a[0]
    words = f"{problem.shape[0]} on {len(thickness)} layers, {problem.base[0]}, h/a {' '.join(f'{h:.3g}' for h in np.diff(tops))}, mu {mu:g}"
    if solution.status[0] != 0:
        return f"{words}, status {solution.status[0]}", 0.0, ""
    largest, worst, of_what = extremes(problem, solution, mu), 0.0, ""
    grid = dense(problem, solution, mu, tops)
    size = max(np.abs(values[np.isfinite(values)]).max(initial=0.0) for values in grid.values())
    for name, values in grid.items():
        sign = -1 if name == "sz_interface_min" else 1
        mine = np.where(np.isnan(largest[name]), 0.0, sign * largest[name])
        short = np.max((np.maximum(values, 0.0) - mine) / size, initial=0.0)
        if short > worst:
            worst, of_what = float(short), name
    return words, worst, of_what


def main() -> None:
    bodies, first = (int(text) for text in (sys.argv[1:] + ["100", "1"][len(sys.argv) - 1 :]))
    warnings.simplefilter("ignore")
    count = 0
    for seed in range(first, first + bodies):
        words, worst, of_what = missed(seed)
        count += worst > MISSED
        print(f"{seed}: {words}: {worst:.1e} {of_what}", flush=True)
    print(f"{bodies} bodies: {count} where a point of a dense grid has more, by {MISSED:g} of the largest stress")


if __name__ == "__main__":
    main()
