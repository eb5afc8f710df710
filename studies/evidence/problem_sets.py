"""The problem sets of the work-precision study: arguments of `solver.Problem.of`."""

from functools import partial

import numpy as np

from solver import fit_power_law

from ..paper import numbers

#: N̄ Ra² of the coatings, as in the paper's Table 1, so that the law needs only three fits.
DENSITIES = (0.25, 1.0, 4.0)


def paper_cases(base: str, size: int, seed: int) -> dict:
    """The paper's contacts on one base: its five roughnesses as power laws, under the loads of its figures."""
    del seed  # nothing here is random
    loads = np.geomspace(1e-6, 5e-5, max(size // len(numbers.TABLE1), 1))
    row, load = (v.ravel() for v in np.indices((len(numbers.TABLE1), len(loads))))
    Ra, Nbar, B, beta = np.array(numbers.TABLE1).T[:, row]
    parameters = {"P": loads[load], "Ra": Ra, "Nbar": Nbar, "B": B / Ra, "beta": beta, "h": 0.02, "n": 0.5}
    return parameters | {"base": np.full(len(row), base), "micro": np.full(len(row), "power_law")}


def coatings(size: int, seed: int) -> dict:
    """Soft to hard coatings on the exact layer with the exact law. B and beta are fits to it, for the power law."""
    random = np.random.default_rng(seed)
    Ra, density = _between(random, 5e-4, 1e-2, size), random.integers(len(DENSITIES), size=size)
    B, beta, _ = np.array([fit_power_law(value) for value in DENSITIES]).T[:, density]
    parameters = {"Ra": Ra, "Nbar": np.array(DENSITIES)[density] / Ra**2, "B": B, "beta": beta}
    ranges = {"P": (1e-7, 1e-3), "h": (1e-3, 0.1), "n": (1e-3, 1e3)}
    parameters |= {name: _between(random, *ends, size) for name, ends in ranges.items()}
    parameters |= {"bonding": random.choice(["frictionless", "bonded"], size)}
    return parameters | {"base": np.full(size, "layered"), "micro": np.full(size, "disc_cell")}


def extremes(size: int, seed: int) -> dict:
    """Random cases far beyond real contacts, on the thin layer and the half-space, with both laws and interfaces.

    The exact layer is left out: it takes seconds a case at the tolerance of the reference. `make extremes` has it.
    """
    random = np.random.default_rng(seed)
    ranges = {"Ra": (1e-5, 0.1), "P": (1e-12, 0.1), "h": (1e-8, 1e3), "n": (1e-6, 0.999999)}
    parameters = {name: _between(random, *ends, size) for name, ends in ranges.items()}
    return parameters | {
        "bonding": random.choice(["frictionless", "bonded"], size),
        "Nbar": _between(random, 1e-6, 1e6, size) / parameters["Ra"] ** 2,
        "B": _between(random, 1e-2, 10, size),
        "beta": random.uniform(0.3, 0.95, size),
        "base": random.choice(["half_space", "thin_layer"], size),
        "micro": random.choice(["disc_cell", "power_law"], size),
    }


SETS = {
    "paper, layer": partial(paper_cases, "thin_layer"),
    "paper, half-space": partial(paper_cases, "half_space"),
    "coatings": coatings,
    "extremes": extremes,
}


def _between(random, low: float, high: float, size: int) -> np.ndarray:
    """Log-uniform numbers."""
    return np.exp(random.uniform(np.log(low), np.log(high), size))
