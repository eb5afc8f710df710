"""What stands here of scipy.special, without importing it: the same bits."""

import subprocess
import sys

import numpy as np
import pytest
import scipy.special
from make_radau import lines

from solver.numerics import special
from solver.numerics.ladder import LADDER


def test_the_elliptic_integral_has_the_bits_of_scipy():
    """Also where the series ends, below 1e-16, and at the ends."""
    rng = np.random.default_rng(3)
    x = np.concatenate([rng.random(20_000), 10 ** rng.uniform(-300, 0, 20_000), [1.0, 1.2e-16, 1.1e-16, 5e-324]])
    assert np.array_equal(special.ellipkm1(x), scipy.special.ellipkm1(x))
    assert special.ellipkm1(x[:6].reshape(2, 3)).shape == (2, 3)


def test_many_numbers_are_left_to_scipy(monkeypatch):
    asked = []
    monkeypatch.setattr(scipy.special, "ellipkm1", lambda x: asked.append(x.size) or x)
    special.ellipkm1(np.full(special._MOST, 0.5))
    special.ellipkm1(np.full(special._MOST + 1, 0.5))
    special.ellipkm1(np.full(3, 0.5), many=True)
    assert asked == [special._MOST + 1, 3]


@pytest.mark.parametrize("n", [*LADDER, 7])
def test_radau_points_are_those_of_scipy(n):
    """The file is of one version of scipy; others may round the last digit otherwise."""
    np.testing.assert_allclose(
        special.radau_points(n), scipy.special.roots_jacobi(n - 1, 1.0, 0.0)[0], rtol=0, atol=4e-16
    )


def test_the_file_is_what_its_maker_writes():
    """But for the last digit, as above."""
    stored = special.FILE.read_text(encoding="utf-8").splitlines()
    assert stored[0] == lines()[0] and len(stored) == 1 + len(LADDER)
    assert [len(line.split(",")) for line in stored[1:]] == [n - 1 for n in LADDER]


def test_scipy_special_is_imported_for_tables_alone():
    """Contacts on a half-space and on bonded thin layers need none of it; those on exact layers have tables.

    numpy.f2py and numpy.testing, which scipy would import too, are imported when somebody asks for them.
    """
    code = (
        "import sys, numpy, solver\n"
        "for base in ('half_space', 'thin_layer', 'layered'):\n"
        "    problem = solver.Problem.of(P=1e-5, h=0.1, n=0.1, base=base, bonding='bonded', Nbar=1e5, Ra=1e-3)\n"
        "    solver.solve(problem, [0.0, 0.5, 1.0])\n"
        "    assert ('scipy.special' in sys.modules) == (base == 'layered'), base\n"
        "for name in ('f2py', 'testing'):\n"
        "    assert f'numpy.{name}' not in sys.modules and name not in vars(numpy)\n"
        "    assert getattr(numpy, name).__name__ == f'numpy.{name}'\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
