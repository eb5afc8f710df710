"""The cost of asperities on the coated body, compared with asperities on a half-space of the layer's material:

    python tools/bench/benchmark_felt.py

Processor times by turns, on one thread. A family is one body with one pitch over h; its law is computed once and
stored. Families are new in every turn: their N̄ differ by 1e-4. On the half-space `model_error` needs the family as
well, at one pressure; so `layer_ms` itself is the bound for the cost of a new family.
"""

import os

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")  # before numpy is imported

from collections.abc import Iterator  # noqa: E402
from itertools import count  # noqa: E402

import numpy as np  # noqa: E402
from benchmark_cases import REPEATS, X, by_turns, processor_seconds  # noqa: E402

from solver import Problem, Status, solve  # noqa: E402

#: Required: the time of a batch of one family over the same on a half-space; the additional milliseconds of a lone
#: contact of a new family; the milliseconds of one of many contacts of as many families.
BARS = {"batch": 1.2, "lone": 60.0, "many": 15.0}
BATCH, LONE, MANY = 10_000, 24, 1000
LAWS = ("disc_cell", "square_lattice")
#: Each turn takes the next number, and N̄ times 1 + _NEW times the number. Families with pitches that differ by more
#: than about 1e-9 are different.
_TURN, _NEW = count(), 1e-4


def contacts(size: int, families: int, micro: str, on: str) -> Problem:
    """Random rough contacts on bonded layers under an elastic punch, of `families` pitches, 1.05 to 16 h."""
    random = np.random.default_rng(3)

    def between(low, high, number):
        return np.exp(random.uniform(np.log(low), np.log(high), number))

    family = np.arange(size) % families
    pitch = between(1.05, 16, families) if families > 1 else np.array([4.0])
    h, n = (between(*ends, families)[family] for ends in ((1e-3, 1e-2), (0.1, 10)))
    inputs = {"P": between(1e-6, 1e-4, size), "h": h, "n": n, "Ra": between(2e-3, 8e-3, size)}
    inputs |= {"Nbar": (1 + _NEW * next(_TURN)) / (pitch[family] * h) ** 2, "m": 0.5, "bonding": "bonded"}
    return Problem.of(**inputs, micro=micro, base="layered", rtol=1e-6, asperities_on=on)


def batch(micro: str) -> dict:
    """The time of a batch of one family, whose law is computed in the first turn, over the same on a half-space."""
    problems = [contacts(BATCH, 1, micro, on) for on in ("layer", "half_space")]
    shares = [float(np.mean(solve(cases, X).status == Status.CONVERGED)) for cases in problems]
    times = by_turns(*(lambda cases=cases: solve(cases, X) for cases in problems))
    ratio = float(times[0] / times[1])
    row = {"what": f"{BATCH:,} contacts, one family", "micro": micro, "layer_ms": 1e3 * times[0]}
    row |= {"half_space_ms": 1e3 * times[1], "converged": shares[0], "ratio": ratio}
    return row | {"bar": BARS["batch"], "met": ratio <= BARS["batch"]}


def new_families(size: int, micro: str, on: str) -> np.ndarray:
    """Processor milliseconds (size,) of lone contacts, each of a new family: the shortest of some turns."""
    turns = []
    for _ in range(REPEATS):
        problem = contacts(size, size, micro, on)
        parts = [problem.take(np.array([i])) for i in range(size)]
        turns.append([processor_seconds(lambda part=part: solve(part, X)) for part in parts])
    return 1e3 * np.min(turns, axis=0)


def lone(micro: str) -> dict:
    """The additional time of a contact of a new family over one on a half-space: the largest, and the mean over
    pitches."""
    layer, bare = (new_families(LONE, micro, on) for on in ("layer", "half_space"))
    more = layer - bare
    row = {
        "what": "a lone contact, a new family",
        "micro": micro,
        "layer_ms": layer.mean(),
        "half_space_ms": bare.mean(),
    }
    row |= {"mean_more_ms": float(more.mean()), "largest_more_ms": float(more.max())}
    return row | {"bar": BARS["lone"], "met": bool(more.max() <= BARS["lone"])}


def many(micro: str) -> dict:
    """Milliseconds of one of many contacts of as many new families, in one call."""
    times = {"layer": [], "half_space": []}
    for _ in range(2):
        for on, took in times.items():
            problem = contacts(MANY, MANY, micro, on)
            took.append(1e3 / MANY * processor_seconds(lambda problem=problem: solve(problem, X)))
    each = min(times["layer"])
    row = {"what": f"{MANY:,} contacts, {MANY:,} families, each", "micro": micro, "layer_ms": each}
    return row | {"half_space_ms": min(times["half_space"]), "bar": BARS["many"], "met": each <= BARS["many"]}


def felt() -> Iterator[dict]:
    """A row for each of the three measurements and each law."""
    return (way(micro) for way in (batch, lone, many) for micro in LAWS)


if __name__ == "__main__":
    for row in felt():
        print(
            ", ".join(
                f"{key} {value:.3g}" if isinstance(value, float) else f"{key} {value}" for key, value in row.items()
            )
        )
