"""The bounds of `base="auto"` compared with the true errors: `python tools/errors/margins.py [SIZE [SEED]]`.

Random cases (1,500 of each control by default, some minutes) are solved on the exact layer and on each cheap model. It
prints a line for each control and model: the number of cases whose bound is between 1e-4 and 0.3, and the largest and
the median ratio of the true error to the bound. Below 1 the bound holds; solver/models/auto.py has the factors.
"""

import sys

import numpy as np

from solver import Problem, solve
from solver.models.auto import _on_model, bounds

JUDGED = ("a", "P", "D", "p0", "p_max", "Ar_An")
RANGES = {"P": (1e-7, 1e-3), "a": (3e-3, 0.1), "D": (1e-5, 1e-2)}


def sample(control: str, size: int, seed: int) -> dict:
    """Arguments of ``Problem.of``: thin to thick, soft to hard layers under rigid and elastic punches,
    asperities from fine to coarse, or none."""
    random = np.random.default_rng([seed, *control.encode()])

    def between(low: float, high: float) -> np.ndarray:
        return np.exp(random.uniform(np.log(low), np.log(high), size))

    return {
        control: between(*RANGES[control]), "h": between(1e-5, 10), "n": between(1e-3, 1e2), "Nbar": between(1e3, 1e9),
        "Ra": between(1e-5, 3e-2), "B": between(0.03, 1), "beta": random.uniform(0.35, 0.9, size),
        "m": np.where(random.random(size) < 0.5, 0.0, between(1e-3, 1e3)),
        "nu1": random.uniform(-0.5, 0.5, size), "nu2": random.uniform(-0.5, 0.5, size),
        "bonding": random.choice(["frictionless", "bonded"], size),
        "micro": random.choice(["smooth", "disc_cell", "power_law"], size),
    }  # fmt: skip


def ratios(control: str, size: int, seed: int) -> dict:
    """Model -> true error over bound, for the cases whose bound is between 1e-4 and 0.3."""
    np.seterr(all="ignore")  # cases that a model cannot have
    cases, ratios_of_models = sample(control, size, seed), {}
    exact = solve(Problem.of(**cases, base="layered"))
    auto = Problem.of(**cases, base="auto")
    for micro in np.unique(auto.micro):
        index = np.flatnonzero((auto.micro == micro) & (exact.status == 0))
        for model, bound in bounds(auto.take(index)).items():
            near = (bound > 1e-4) & (bound < 0.3)
            if not near.any():
                continue
            cheap = _on_model(model, auto.take(index[near]), np.array([0.0, 1.0]))
            errors = [np.abs(getattr(cheap, name) / getattr(exact, name)[index[near]] - 1) for name in JUDGED]
            error = np.where(cheap.status == 0, np.max(errors, axis=0), 0.0)
            ratios_of_models.setdefault(model.name, []).append(np.maximum(error - 2e-6, 0) / bound[near])
    return {name: np.concatenate(parts) for name, parts in ratios_of_models.items()}


def main(size: int = 1500, seed: int = 1) -> None:
    for control in RANGES:
        for name, ratio in ratios(control, size, seed).items():
            most, median = ratio.max(), np.median(ratio)
            print(f"{control} {name:20s} {len(ratio):5d} cases, at most {most:.2f}, median {median:.2f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
