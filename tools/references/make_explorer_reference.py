"""Write explorer.npz: the solver's results for the 20,700 contacts of explorer_cases.py.

They are no independent reference: the page of the explorer solves the same equation (tests/explorer/test_core.py). NaN
if the program has no solution. Rounding of float32, 6e-8, is far below the tested differences. It takes a minute:
``python tools/references/make_explorer_reference.py``.
"""

from pathlib import Path

import numpy as np
from explorer_cases import CONTROLS, RESULTS, parameters

from solver import Problem, solve

FILE = Path(__file__).parents[2] / "tests/references/explorer.npz"


def results(control: str) -> np.ndarray:
    """Results (RESULTS, MANY) with one control."""
    solution = solve(Problem.of(**parameters(control), rtol=1e-7))
    return np.where(solution.status == 0, [getattr(solution, name) for name in RESULTS], np.nan)


if __name__ == "__main__":
    np.savez_compressed(FILE, **{control: results(control).astype("f4") for control in CONTROLS})
