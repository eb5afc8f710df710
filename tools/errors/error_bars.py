"""The effect of the factors in solver/rough/error.py: `python tools/errors/error_bars.py [SIZE]`, a minute.

SIZE random cases (2,000 by default) of each law on each base, far outside real contacts, are solved on few nodes, and
on 96 nodes, which is the truth. If SIZE is small, no case may remain; shares are then nan. It prints a line for each
number of nodes:

- cases: those whose error on 96 nodes is below a tenth of the judged error;
- blind: of cases whose estimate is multiplied by _BLIND, the share whose truth is above the estimate without that
  factor, and the share above the estimate with it;
- ring: the number of cases whose truth is above the estimate, and whose λ has risen before the first node; and their
  largest error of Ar/An over λ s²/2 at that node, in units of Ar/An;
- above: the share of cases whose truth is above the error bar, and the largest factor.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[2] / "tests/shared"))  # under pytest it is there already
from solver_cases import EXTREMES, ROUGH_KINDS, random_cases  # noqa: E402

from solver import Problem
from solver.numerics.ladder import MARGIN
from solver.numerics.mesh import mesh_of
from solver.rough.equation import evaluate
from solver.rough.error import _BLIND, _RISEN, completed, estimate, margin, refine
from solver.rough.newton import solve_on
from solver.rough.results import difference, quantities
from solver.rough.start import first_guess
from solver.scaling import as_cases, dimensionless

NODES = (6, 12, 22, 32)


def judged(base: str, law: str, size: int) -> dict[int, np.ndarray]:
    """Nodes -> rows of cases: truth, difference of two meshes, estimate, error bar, error of Ar/An over its ring, and
    the factor of the estimate."""
    case = random_cases(size, 1, EXTREMES) | {"beta": np.random.default_rng(1).uniform(0.3, 0.95, size)}
    cases, rows = as_cases(dimensionless(Problem.of(**case, base=base, micro=law))), {}

    def solved(n):
        at = solve_on(evaluate(cases, first_guess(cases, mesh_of(n)), mesh_of(n)))
        of_mesh = quantities(at.at)
        refined = refine(at.at, of_mesh)
        return at, of_mesh, difference(of_mesh, refined.numbers), estimate(at.at, of_mesh, refined)

    fine, true, _, own_error = solved(96)
    for n in NODES:
        (ev, closed, _), of_mesh, moved, error = solved(n)
        lam = cases.law.area(ev.state.y[:, :1], ev.curve.q[:, :1])[:, 0]
        ring = np.where(lam > _RISEN, lam * ev.mesh.s[0] ** 2 / 2, 0.0) / of_mesh.Ar_An
        truth, area = difference(of_mesh, true), np.abs(of_mesh.Ar_An / true.Ar_An - 1)
        bar = completed(ev, of_mesh.Ar_An, error, np.arange(size))[1]
        is_judged = closed & fine.closed & (own_error < 0.1 * truth) & (truth > 1e-9)
        rows[n] = np.stack([truth, moved, error, bar, area / ring, margin(ev)], axis=1)[is_judged]
    return rows


def main(size: int = 2000) -> None:
    np.seterr(all="ignore")
    parts = [judged(base, law, size) for base, law in ROUGH_KINDS]
    for n in NODES:
        truth, moved, error, bar, rings, factor = np.concatenate([part[n] for part in parts]).T
        blind = factor > MARGIN
        counts_above = [(truth[blind] > times * MARGIN * moved[blind]).sum() for times in (1, _BLIND)]
        seen = [f"{count / blind.sum():.1%}" for count in counts_above]
        needed = rings[np.isfinite(rings) & (truth > error)]
        above = truth / bar
        print(
            f"{n:2d} nodes, {len(truth)} cases; blind: {seen[0]} and {seen[1]} of {blind.sum()}; "
            f"ring: {len(needed)}, {needed.max(initial=0):.1f}; above: {(above > 1).sum()}, {above.max(initial=0):.1f}"
        )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
