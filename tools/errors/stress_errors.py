"""Is `error` of `solver.fields.contact` honest? `python tools/errors/stress_errors.py [CONTACTS [SEED]]`.

Random contacts are solved at their rtol, and again with many times the nodes and the smallest rtol. For each contact
the largest difference of any stress at some points, over the largest stress, is compared with its stated error.
"""

import sys

import numpy as np

from solver import Problem, solve
from solver.fields.contact import of_contacts

R, Z = np.array([0.0, 0.3, 0.6, 0.9, 1.0, 1.1, 1.5]), np.array([0.0, 0.05, 0.2, 0.5, 1.0])
STRESSES = ("sr", "st", "sz", "trz")
#: Smaller differences are rounding.
ROUNDING = 1e-13


def contacts(size: int, seed: int) -> dict:
    """Inputs of random contacts, rough and smooth, with layers from 0.03 a to 30 a."""
    random = np.random.default_rng(seed)

    def between(low, high):
        return np.exp(random.uniform(np.log(low), np.log(high), size))

    a = between(1e-3, 0.1)
    return {
        "a": a,
        "h": a * between(0.03, 30.0),
        "n": between(1e-2, 1e2),
        "nu1": random.uniform(0, 0.5, size),
        "nu2": random.uniform(0, 0.5, size),
        "bonding": random.choice(["bonded", "frictionless"], size),
        "micro": random.choice(["smooth", "disc_cell"], size),
        "Nbar": between(1e4, 1e7),
        "Ra": between(1e-3, 1e-2),
    }


def stresses(problem: Problem):
    """(B, points) of all stresses, inside, and at the interface on both sides; and their error."""
    fields = of_contacts(problem, solve(problem), R, Z)
    parts = [part[name].reshape(len(problem), -1) for part in fields[:3] for name in STRESSES]
    return np.concatenate(parts, axis=1), fields.error


def worst(size: int, seed: int) -> np.ndarray:
    """Largest difference, less the error of the better solution, over the stated error, of each contact."""
    inputs = contacts(size, seed)
    values, error = stresses(Problem.of(**inputs, rtol=1e-4))
    true_values, true_error = stresses(Problem.of(**inputs, rtol=1e-11))
    largest = np.nanmax(np.abs(true_values), axis=1)
    missed = np.nanmax(np.abs(values - true_values), axis=1) / largest
    return np.maximum(missed - true_error - ROUNDING, 0.0) / error


def main() -> None:
    size, seed = (int(text) for text in (sys.argv[1:] + ["300", "1"][len(sys.argv) - 1 :]))
    ratios = worst(size, seed)
    ratios = ratios[np.isfinite(ratios)]
    above = int((ratios > 1).sum())
    print(f"{len(ratios)} contacts: {above} above their error, the largest {ratios.max():.2g} of it")


if __name__ == "__main__":
    main()
