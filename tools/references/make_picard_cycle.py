"""Write studies/evidence/picard_cycle.csv for the last panel of the figure `picard_domain`.

python tools/references/make_picard_cycle.py: two successive iterates of Eq. (8) with k = 0 for the main case at
a = 0.04 on 64 nodes, long after the load has settled, and the solution, near the edge.
The scheme is written out here once more; tests/evidence/test_picard_domain.py compares it with the solver's.
"""

from pathlib import Path

import numpy as np

from solver import Problem, solve
from solver.laws import LAWS
from solver.numerics.mesh import mesh_of

A, H, N, NODES, LEAST = 0.04, 0.02, 0.5, 64, 0.97
CASE = {"Nbar": 250_000, "Ra": 0.004, "B": 0.1, "beta": 0.5}


def iterates(last: int) -> list[np.ndarray]:
    """The last two of `last` iterates from p = 0, in E2*, at the nodes."""
    mesh, law = (
        mesh_of(NODES),
        LAWS["power_law"].bind(np.array([N]), **{name: np.array([v]) for name, v in CASE.items()}),
    )
    pair = [np.zeros(mesh.n)]
    for _ in range(last):
        p = pair[-1]
        left = A**2 / 2 * mesh.s**2 - 4 / np.pi * A * mesh.K @ p
        pair = [p, np.maximum(left - law.at(p[None])[0][0], 0) / (H / N)]  # C = 2 A2 h/E1*, A2 = 1/2
    return pair


def main() -> None:
    x = mesh_of(NODES).x
    exact = solve(Problem.of(a=A, h=H, n=N, base="thin_layer", micro="power_law", **CASE, nodes=NODES, rtol=1e-9), x)
    table = np.array([x, *iterates(1001), exact.p[0]]).T[x > LEAST]
    path = Path(__file__).parents[2] / "studies/evidence/picard_cycle.csv"
    np.savetxt(path, table, "%.10g", ",", header="r/a,iterate 1000,iterate 1001,solution", comments="")


if __name__ == "__main__":
    main()
