"""Asperities on the coated body by the compiled core: as by numpy, in any company; and cores of other sources."""

import ctypes

import numpy as np
import pytest
from both_paths import SCALARS, X, contacts, of_the_sources  # noqa: F401
from numpy.testing import assert_allclose, assert_array_equal

from solver import Problem
from solver.compiled import cells, library, newton_in_c
from solver.compiled.library import available
from solver.kernels.two_layers import TwoLayers
from solver.laws import LAWS
from solver.laws.cell import cell_law
from solver.rough.equation import Cases
from solver.scaling import as_cases

pytestmark = pytest.mark.skipif(not available(), reason="no compiled core was built here")
LATTICES = ("square_lattice", "hex_lattice", "disc_cell")


def problem_of(size: int, micro: str, seed: int, **change) -> Problem:
    """Rough contacts on layers of random bodies at a pitch of 0.3 to 16 h."""
    random = np.random.default_rng(seed)

    def between(low, high):
        return np.exp(random.uniform(*np.log((low, high)), size))

    h, n = between(3e-4, 2e-2), between(0.05, 50)
    pitch = between(0.3, 16)
    case = {"P": between(1e-7, 2e-5), "h": h, "n": n, "m": random.choice([0.0, 0.0, 0.5], size), "micro": micro}
    case |= {"Nbar": 1 / (pitch * h) ** 2, "Ra": between(0.5, 5) * pitch * h, "rtol": random.choice([1e-4, 1e-7], size)}
    return contacts(size, seed, base="layered", **case | change)


def cases_of(problem: Problem) -> Cases:
    """The contacts with their asperities on the coated body."""
    cases, few = as_cases(problem), {"Nbar": problem.Nbar, "Ra": problem.Ra}
    micro = LAWS[str(problem.micro[0])]
    E = problem.n / (1 + problem.m)
    return cases._replace(law=micro.on_body(cases.body.kernel, problem.m, problem.h, E, **few))


def solved(problem: Problem, path: str, cases: Cases | None = None):
    with pytest.MonkeyPatch.context() as patched, np.errstate(all="ignore"):
        patched.setenv(library.VARIABLE, path)
        return newton_in_c.solve_newton(cases or cases_of(problem), problem.rtol, problem.nodes, 0, X)


@pytest.mark.parametrize("micro", LATTICES)
def test_numbers_of_random_contacts(micro):
    """1e-12, and 1e-10 of p_max: the polynomials of a plate's are as noisy as its series."""
    problem = problem_of(20, micro, seed=2)
    cases = cases_of(problem)
    numpy = solved(problem, "numpy", cases)
    for variant in available():
        core = solved(problem, variant, cases)
        inside = numpy.p0 < cell_law.end(cases.law)
        assert inside.sum() > 10
        for name in ("status", "nodes"):
            assert_array_equal(getattr(core, name), getattr(numpy, name), name)
        for name in SCALARS:
            rtol = 1e-10 if name == "p_max" else 1e-12
            assert_allclose(getattr(core, name)[inside], getattr(numpy, name)[inside], rtol=rtol, err_msg=name)
        assert_allclose(core.lam[inside], numpy.lam[inside], rtol=0, atol=1e-11)
        largest = numpy.p0[inside, None]
        assert_allclose(core.p[inside] / largest, numpy.p[inside] / largest, rtol=0, atol=1e-11)


def test_most_contacts_are_solved_by_the_core(monkeypatch):
    """Also those beyond the end of the law, unless their corner there needs finer meshes."""
    handed, plain = [], newton_in_c.adaptive.solve_newton
    monkeypatch.setattr(newton_in_c.adaptive, "solve_newton", lambda *case: handed.append(len(case[1])) or plain(*case))
    solved(problem_of(30, "hex_lattice", seed=3), "")
    assert sum(handed) <= 3


@pytest.mark.parametrize("variant", available())
def test_the_same_bits_in_any_company_and_in_calls_of_few_families(variant, monkeypatch):
    problem = problem_of(24, "square_lattice", seed=4, n=3.0, nu1=0.25, nu2=0.3, bonding="bonded", m=0.0)
    problem = problem.but(n=np.where(np.arange(24) % 3 == 0, 5.0, 3.0))
    whole = solved(problem, variant)
    for size in (1, 3, 9):
        index = np.random.default_rng(size).permutation(24)[:size]
        part = solved(problem.take(index), variant)
        for name in SCALARS:
            assert getattr(part, name).tobytes() == getattr(whole, name)[index].tobytes(), (size, name)
    monkeypatch.setattr(newton_in_c, "_FAMILIES", 5)
    assert solved(problem, variant).P.tobytes() == whole.P.tobytes()


def rows_of(n: float, pitch: float) -> np.ndarray:
    one = np.ones(1)
    kernel = TwoLayers(n * one, 0.25 * one, 0.3 * one, one > 0)
    return cell_law.rows_of("hex", kernel, 0 * one, one / pitch, one)


@pytest.mark.parametrize(("n", "pitch"), [(3.0, 0.1), (0.05, 4.0), (5.0, 8.0), (100.0, 16.0), (30.0, 40.0)])
def test_the_polynomials_are_the_series(n, pitch):
    """exp(P) and exp(G) to 3e-13, exp(Q) to 1e-11, and the guess to 1e-5, at all pieces, and where one ends."""
    row = rows_of(n, pitch)
    table = cells._family(row)
    kappa, end, top, kappa_r, end_r, top_r, *_, at_Q, at_r = table[:16]
    assert_allclose([1 + kappa * end, 1 + kappa_r * end_r], [top, top_r], rtol=1e-14)
    y = np.concatenate([np.linspace(0, end, 500), end * 2.0 ** -np.arange(1, 40)])

    def at(z, start, stride, count):
        """The polynomial of the piece of z < top."""
        octave = np.frexp(z)[1] - 1
        place = (np.ldexp(z, -octave) - 1) * cells.PIECES
        index = np.minimum(place.astype(int), cells.PIECES - 1)
        where = int(start) + stride * (octave * cells.PIECES + index)
        powers = (2 * (place - index) - 1)[:, None] ** np.arange(count)
        return (table[where[:, None] + np.arange(count)] * powers).sum(axis=1)

    z = np.minimum(1 + kappa * y, top)
    row_size = cells.ROW
    wanted = [np.exp(cell_law.exponent(row, which, y[None])[0][0]) for which in range(3)]
    assert_allclose(at(z, 16, 2 * row_size, row_size), wanted[0], rtol=3e-13)
    assert_allclose(at(z, 16 + row_size, 2 * row_size, row_size), wanted[1], rtol=3e-13)
    assert_allclose(at(z, at_Q, row_size, row_size), wanted[2], rtol=1e-11)
    r = np.geomspace(1e-9, 1, 300) * end_r
    guess = cell_law.spot_guess(2 / np.pi * r[None] ** 3, row)[0] / r
    assert_allclose(at(np.minimum(1 + kappa_r * r, top_r), at_r, row_size // 2, row_size // 2), guess, rtol=1e-5)


def test_a_core_of_other_sources_is_not_taken(monkeypatch, tmp_path):
    """Its structures have other sizes, or their number is another: it would read and write elsewhere."""
    core = library._library()
    assert library._fits(core) and core.roughcoat_layout() == library.layout()
    monkeypatch.setattr(library, "LAYOUT", library.LAYOUT + 1)
    assert not library._fits(core)
    monkeypatch.undo()

    class Longer(ctypes.Structure):
        _fields_ = [("batch", library.CBatch), ("more", ctypes.c_int64)]

    monkeypatch.setattr(library, "CBatch", Longer)
    assert not library._fits(core)
    monkeypatch.undo()
    assert not library._fits(ctypes.CDLL(None))  # which has no layout, as cores built before there was one
