"""What the tests of the solver share: the paper's main case, random cases, and the size of a difference."""

import numpy as np

from solver import Problem, solve
from solver.body.hankel import Hankel
from solver.kernels.two_layers import TwoLayers

#: The paper's main case, a = 0.04 on a thin layer, without its control and its base.
MAIN = {"h": 0.02, "n": 0.5, "Nbar": 250000.0, "Ra": 0.004, "B": 0.1, "beta": 0.5}
#: The load that belongs to a = 0.04 with the power law, to eight digits.
LOAD = 2.7040777e-5

BASES = ("half_space", "thin_layer")
ROUGH = ("disc_cell", "power_law")
#: Every kind of case: base and micro law.
KINDS = [(base, micro) for base in BASES for micro in (*ROUGH, "smooth")]
ROUGH_KINDS = [kind for kind in KINDS if kind[1] != "smooth"]
#: With the exact layered base, for what holds on any base.
ALL_KINDS = [*KINDS, *(("layered", micro) for micro in (*ROUGH, "smooth"))]

#: Quantities whose relative error `error` promises.
JUDGED = ("a", "P", "D", "p0", "p_max", "Ar_An")

#: The ranges over which every case must converge; NR is Nbar Ra².
RANGES = {"P": (1e-7, 1e-3), "Ra": (5e-4, 1e-2), "NR": (0.1, 10), "n": (0.05, 0.95), "h": (1e-3, 0.1)}
#: Far beyond any scene.
EXTREMES = {"P": (1e-12, 1e-1), "Ra": (1e-5, 1e-1), "NR": (1e-6, 1e6), "n": (1e-6, 0.999999), "h": (1e-8, 1e3)}


def random_cases(size, seed, ranges=RANGES):
    """Keyword arguments of ``Problem.of``: `size` cases, log-uniform over `ranges`; the power law is a possible fit.
    Asperities are on a half-space, whatever their pitch: their law on a layer ends where spots merge."""
    rng = np.random.default_rng(seed)
    drawn = {name: np.exp(rng.uniform(*np.log(limits), size)) for name, limits in ranges.items()}
    drawn["Nbar"] = drawn.pop("NR") / drawn["Ra"] ** 2
    bonding = np.where(rng.random(size) < 0.5, "bonded", "frictionless")
    return drawn | {
        "bonding": bonding,
        "asperities_on": "half_space",
        "B": np.exp(rng.uniform(-2.5, 0.2, size)),
        "beta": rng.uniform(0.45, 0.62, size),
    }


def one(x=(0.0, 1.0), **case):
    """Solution of the main case, which is on a thin layer, with changes."""
    return solve(Problem.of(**({"base": "thin_layer"} | MAIN | case)), np.asarray(x))


def layer_of(**given):
    """The exact body of layers, arrays (B,) as broadcast: h = 1 and so on unless `given`."""
    case = {"h": 1.0, "n": 0.5, "nu1": 0.3, "nu2": 0.3, "bonded": True, "m": 0.0} | given
    h, n, nu1, nu2, bonded, m = np.broadcast_arrays(np.ones(1), *case.values())[1:]
    return Hankel(TwoLayers(n, nu1, nu2, bonded), h, m)


def difference(first, second, names=JUDGED):
    """Largest relative difference of two solutions in `names`, (B,)."""
    return np.max([np.abs(getattr(first, name) / getattr(second, name) - 1) for name in names], axis=0)
