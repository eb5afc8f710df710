"""How often `error` is below the truth under rough punches of every shape: `python tools/errors/rough_shapes.py [SIZE
[SEED]]`, some minutes.

SIZE random contacts (10 by default) of each shape, of random laws on half-spaces and layers, are solved at a given
load, radius or depth, and rtol 1e-9, which is the truth; and again at rtol 1e-3 and 1e-6. It prints a line for each
shape: the names of the statuses; the number of answers whose `error` is ten times that of the truth, the number of
these that are farther from the truth than `error`, and the largest distance in units of `error`; seconds of processor
time per case. The names of some shapes may follow SIZE and SEED.
"""

import sys
from collections import Counter
from time import process_time

import numpy as np

from solver import Problem, Status, solve

SHAPES = ("sphere", "cone", "power", "frustum", "blunt_cone", "rounded_flat", "flat")
LAWS = ("disc_cell", "power_law", "square_lattice", "normal_heights", "elastic_plastic")
RTOL, TRUTH = (1e-3, 1e-6), 1e-9
JUDGED = ("a", "P", "D", "p0", "p_max", "Ar_An")


def log_uniform(random: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def contact(shape: str, random: np.random.Generator) -> dict:
    """Arguments of ``Problem.of``: one contact of about the radius a, from a smooth one to one whose asperities yield
    as much as the body. A half-space of the softer material gives its approximate load."""
    a, h_a, n = log_uniform(random, 1e-3, 0.3), log_uniform(random, 3e-2, 30), log_uniform(random, 1e-2, 1e2)
    sharp, part = log_uniform(random, 0.02, 0.5), random.uniform(0.1, 1.5)
    case = {"shape": shape, "half_angle": np.degrees(np.arctan(1 / sharp)), "flat_radius": part * a}
    case |= {"tip_radius": part * a / sharp, "edge_radius": a / sharp}
    k = random.choice([1.0, 1.5, 3.0, 4.0, 6.5])
    case |= {"shape_power": k, "shape_coefficient": sharp / k * a ** (1 - k)}
    case |= {"base": random.choice(["half_space", "layered"]), "h": h_a * a, "n": n, "micro": random.choice(LAWS)}
    case |= {"bonding": random.choice(["bonded", "frictionless"]), "m": random.choice([0.0, 0.3])}
    A = a * sharp * log_uniform(random, 1e-5, 0.3)
    case |= {"Ra": A * log_uniform(random, 1, 1e3), "B": log_uniform(random, 0.03, 1), "beta": random.uniform(0.3, 0.9)}
    case |= {"Nbar": log_uniform(random, 0.1, 1) / (np.pi * case["Ra"] * A), "hardness": log_uniform(random, 1e-3, 1)}
    case |= {"sigma": A}
    modulus = n if case["base"] == "layered" and h_a > 1 else 1.0
    control = random.choice(["P", "D"] if shape == "flat" else ["P", "a", "D"])
    value = {"P": modulus * sharp * a**2, "a": max(a, 1.05 * part * a), "D": sharp * a}[str(control)]
    case[str(control)] = value * (1.0 if control == "a" else random.uniform(0.3, 1))
    names = Problem.of(P=1.0, micro="smooth", base="half_space").parameters
    return {name: v for name, v in case.items() if name in names or name in "PaD"}


def distance(answer, truth) -> float:
    """Largest distance of an answer from the truth, in units of its `error`; NaN if the truth is not known enough."""
    ended = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)
    if answer.status[0] not in ended or truth.status[0] not in ended or not truth.error[0] < 0.1 * answer.error[0]:
        return np.nan
    far = [abs(getattr(answer, name)[0] / getattr(truth, name)[0] - 1) for name in JUDGED]
    return float(np.nanmax(far) / answer.error[0])


def main(size: int = 10, seed: int = 1, show: float = 1.0) -> None:
    np.seterr(all="ignore")
    for shape in SHAPES if len(sys.argv) < 4 else sys.argv[3:]:
        ends, far, before = Counter(), [], process_time()
        for i in range(size):
            case = contact(shape, np.random.default_rng([seed, i, SHAPES.index(shape)]))
            truth = solve(Problem.of(**case, rtol=TRUTH))
            ends[f"truth {Status(truth.status[0]).name.lower()}"] += 1
            for rtol in RTOL:
                answer = solve(Problem.of(**case, rtol=rtol))
                ends[Status(answer.status[0]).name.lower()] += 1
                far.append(distance(answer, truth))
                if far[-1] > show or answer.status[0] != Status.CONVERGED:
                    print(shape, i, rtol, Status(answer.status[0]).name, far[-1], case)
        ratios, seconds = np.array(far)[~np.isnan(far)], (process_time() - before) / size / (1 + len(RTOL))
        above, most = np.count_nonzero(ratios > 1), ratios.max(initial=0)
        print(f"{shape:12s} {dict(ends)}; {len(ratios)} answers, {above} above, at most {most:.2f}; {seconds:.2f} s")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
