"""Write film_reference.csv: rough contacts on films, with the whole quadrature in k in place of the convolution.

It uses this solver, with octaves of h/a down to 2^-13 instead of 2^-8 and with 96 nodes: a far finer answer, but
independent only of film.py. A random search chose the cases for which the error of the convolution is largest.
Run it from anywhere: ``python tools/references/make_film_reference.py``.
"""

import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COLUMNS = ("micro", "bonding", "h", "n", "nu1", "nu2", "Nbar", "Ra", "P", "D", "p0", "p_max", "Ar_An")
#: The first columns; also a = 0.04, B = 0.3 and beta = 0.5.
CASES = (
    ("disc_cell", "bonded", 3.90625e-05, 0.00411, 0.3, 0.0, 416448.2, 2.586e-4),
    ("disc_cell", "bonded", 6.7214e-05, 1.705e-05, 0.45, 0.3, 392855942.7, 3.455e-05),
    ("power_law", "frictionless", 7.8125e-05, 0.01717, 0.45, 0.0, 37747.4, 0.003574),
)


def main():
    """Write the table into tests/references."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "solver", Path(folder) / "solver")
        file = Path(folder) / "solver" / "body" / "wave_rule.py"
        text = file.read_text(encoding="utf-8")
        assert "OCTAVES = (-8, 40)" in text
        file.write_text(text.replace("OCTAVES = (-8, 40)", "OCTAVES = (-13, 40)"), encoding="utf-8")
        sys.path.insert(0, folder)
        import solver

    assert Path(solver.__file__).is_relative_to(folder)
    lines = [",".join(COLUMNS)]
    for case in CASES:
        inputs = dict(zip(COLUMNS, case, strict=False))
        s = solver.solve(solver.Problem.of(a=0.04, B=0.3, beta=0.5, base="layered", rtol=1e-9, nodes=96, **inputs))
        lines.append(",".join([*map(str, case), *(f"{getattr(s, name)[0]:.15g}" for name in COLUMNS[8:])]))
    path = ROOT / "tests/references/film_reference.csv"
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")


if __name__ == "__main__":
    main()
