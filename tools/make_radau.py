"""Write the Gauss-Radau nodes of the meshes of the ladder: `python tools/make_radau.py solver/numerics/radau.csv`."""

import sys
from pathlib import Path

from scipy.special import roots_jacobi

from solver.numerics.ladder import LADDER

HEAD = "# Roots of the Jacobi polynomials (1, 0) of degree n - 1 of each mesh of the ladder: tools/make_radau.py"


def lines() -> list[str]:
    """A comment, and a line for each mesh."""
    return [HEAD, *(",".join(map(repr, roots_jacobi(n - 1, 1.0, 0.0)[0].tolist())) for n in LADDER)]


if __name__ == "__main__":
    Path(sys.argv[1]).write_text("\n".join(lines()) + "\n", encoding="utf-8")
