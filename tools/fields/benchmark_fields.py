"""The time of stresses: `python tools/fields/benchmark_fields.py`.

It prints shortest processor times: of maps of one rough contact with 60 x 60 points, including the solution of its
pressure; of the stresses of many contacts at 15 depths and 14 radii each; and, of a single run, of extremes and first
yield of many contacts, with the time for 1,000.
"""

import time

import numpy as np

from solver import Problem, solve
from solver.body import tables
from solver.fields import normal
from solver.fields.contact import of_contacts
from solver.fields.field import integrals
from solver.fields.pressure import Pressure
from solver.kernels.two_layers import TwoLayers
from solver.numerics.mesh import mesh_of
from solver.yields.contact import of_contacts as extremes_of
from solver.yields.first import first_yield

RADII = np.linspace(0, 2, 60)
COARSE = np.array([0, 0.15, 0.3, 0.45, 0.6, 0.7, 0.8, 0.9, 0.95, 1, 1.05, 1.15, 1.3, 1.6])
CASES = 100
#: Loads of each pair of bodies, and strengths.
EACH, YIELDS = 10, 200


def seconds_of(action) -> float:
    """The shortest of three times, with empty caches of transforms."""
    times = []
    for _ in range(3):
        tables._moments.cache_clear()
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def main() -> None:
    rough = {"n": 5.0, "bonding": "bonded", "Nbar": 250000.0, "Ra": 0.004}
    for h in (0.5, 0.3, 0.1, 0.02, 0.01, 0.005, 0.002):
        problem = Problem.of(a=0.03, h=0.03 * h, **rough)
        solution, z = solve(problem), np.linspace(0, max(3 * h, 1.0), 60)
        took = seconds_of(lambda: of_contacts(problem, solution, RADII, z))  # noqa: B023
        print(f"a map, h = {h} a: {took:.2f} s", flush=True)
    for low in (0.02, 0.1, 0.5, 2.0):
        h, mesh = low * 2 ** np.linspace(0, 0.99, CASES), mesh_of(22)
        layers = TwoLayers(*(np.full(CASES, v) for v in (3.0, 0.2, 0.3)), np.ones(CASES, dtype=bool))
        inside, below = np.linspace(0, 1, 7) * h[:, None], h[:, None] + np.linspace(0, 1.3, 8)
        z, pressure = np.concatenate([inside, below], axis=1), Pressure(mesh, np.tile(mesh.s, (CASES, 1)))
        arguments = normal.NORMAL.of_stresses(), layers, h, pressure, COARSE, z, np.arange(15) >= 7
        took = seconds_of(lambda: integrals(*arguments)) / CASES  # noqa: B023
        print(f"stresses of {CASES} contacts, h = {low} a to twice that: {1000 * took:.1f} ms each", flush=True)
    random = np.random.default_rng(1)
    pairs = np.repeat(np.arange(10), EACH)
    n, nu1, nu2 = np.exp(random.uniform(-4.6, 4.6, 10)), random.uniform(0, 0.5, 10), random.uniform(0, 0.5, 10)
    loads = {"P": np.tile(np.geomspace(1e-7, 1e-3, EACH), 10), "h": 0.02, "bonding": "bonded"}
    problem = Problem.of(**loads, n=n[pairs], nu1=nu1[pairs], nu2=nu2[pairs], Nbar=250000.0, Ra=0.004)
    solution = solve(problem)
    print_time("extremes, 10 pairs of bodies", lambda: extremes_of(problem, solution), len(problem))
    h, Y = np.geomspace(1e-3, 0.1, YIELDS), np.exp(random.uniform(np.log(2e-3), np.log(3e-2), YIELDS))
    for micro in ("smooth", "disc_cell"):
        rough_contacts = Problem.of(P=1.0, h=h, n=5.0, nu1=0.25, bonding="bonded", micro=micro, Nbar=250000.0, Ra=0.004)
        for body in ("layer", "body", *["asperities"] * (micro != "smooth")):
            print_time(f"first yield, {micro}, {body}", lambda: first_yield(rough_contacts, body, Y), YIELDS)  # noqa: B023


def print_time(what, action, count) -> None:
    """Print the processor time per contact, of `count` contacts, and that of 1,000."""
    start = time.process_time()
    action()
    each = (time.process_time() - start) / count
    print(f"{what}: {1000 * each:.0f} ms each, 1,000 in {1000 * each:.0f} s", flush=True)


if __name__ == "__main__":
    main()
