"""The solver computes on one BLAS thread and gives the user's number back."""

import os
import threading
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module

import dask
import numpy as np
import pytest
from solver_cases import random_cases
from threadpoolctl import ThreadpoolController, threadpool_limits

import solver.numerics.threads
from solver import Problem, fit_power_law, solve
from solver.models.thin_layer_error import edge_shift
from solver.numerics.threads import _OfTheProcess, one_blas_thread
from study.studies.paper.uniform import solve_uniform

OWN = 3  # the user's number of threads: neither the 1 of the solver nor the default of a small machine
#: Where the solver multiplies or solves, a function for each way.
WATCHED = (
    "solver.rough.newton.solve_stack",
    "solver.smooth.paraboloids._sums",
    "solver.rough.picard.approximate",
    "scipy.optimize.brentq",
    "solver.models.thin_layer_error._integrated",
    "study.studies.paper.uniform.as_cases",
)
PAPER = {"h": 0.02, "n": 0.5, "Nbar": 250000.0, "Ra": 0.004}


@pytest.fixture(autouse=True)
def own_number():
    if not ThreadpoolController().select(user_api="blas").lib_controllers:
        pytest.fail("numpy here has a BLAS library whose threads cannot be counted")
    with threadpool_limits(OWN, user_api="blas"):
        yield


def counts() -> set[int]:
    """Numbers of threads of the BLAS libraries that are loaded."""
    return {info["num_threads"] for info in ThreadpoolController().select(user_api="blas").info()}


@pytest.fixture
def seen(monkeypatch, numpy_path) -> list[set[int]]:
    """The counts whenever the solver multiplies or solves."""
    found = []

    def watched(function):
        def call(*arguments, **options):
            found.append(counts())
            return function(*arguments, **options)

        return call

    for place in WATCHED:
        module, _, name = place.rpartition(".")
        monkeypatch.setattr(place, watched(getattr(import_module(module), name)))
    return found


def layered():
    return Problem.of(P=1e-5, base="layered", micro="disc_cell", **PAPER)


CALLS = {
    "layered": lambda: solve(layered()),
    "smooth": lambda: solve(Problem.of(P=1e-5, base="thin_layer", micro="smooth", **PAPER)),
    "auto": lambda: solve(Problem.of(P=1e-5, base="auto", micro="disc_cell", **PAPER)),
    "picard": lambda: solve(Problem.of(P=1e-5, base="thin_layer", scheme="picard", max_iterations=3, **PAPER)),
    "uniform": lambda: solve_uniform(Problem.of(P=1e-5, base="thin_layer", **PAPER), 8, 10.0, 1e-2),
    "fit": lambda: fit_power_law(4.0),
    "edge_shift": lambda: edge_shift([0.25, 0.5], 0.3, 0.3, True),
}


@pytest.mark.parametrize("name", CALLS)
def test_one_thread_inside_and_the_own_number_afterwards(name, seen):
    CALLS[name]()
    assert seen and all(found == {1} for found in seen)
    assert counts() == {OWN}


def test_an_exception_gives_the_number_back():
    with pytest.raises(ZeroDivisionError), one_blas_thread():
        assert counts() == {1}
        raise ZeroDivisionError
    assert counts() == {OWN}
    with pytest.raises(ValueError, match="x must be"):
        solve(layered(), [2.0])
    assert counts() == {OWN}


def test_blocks_are_nested_and_a_number_set_inside_stays():
    with one_blas_thread():
        with one_blas_thread():
            pass
        assert counts() == {1}
        for library in ThreadpoolController().select(user_api="blas").lib_controllers:
            solver.numerics.threads._set(library, 2)
        with one_blas_thread():
            assert counts() == {1}, "set meanwhile, by another thread say: what begins now has one thread all the same"
    assert counts() == {2}


def test_a_number_set_inside_the_only_block_stays():
    with one_blas_thread():
        for library in ThreadpoolController().select(user_api="blas").lib_controllers:
            solver.numerics.threads._set(library, 2)
    assert counts() == {2}


def test_the_number_of_an_earlier_block_is_forgotten():
    """A program that has one thread since then keeps it."""
    for number in (2, 1, 3):
        for library in ThreadpoolController().select(user_api="blas").lib_controllers:
            solver.numerics.threads._set(library, number)
        with one_blas_thread():
            assert counts() == {1}
        assert counts() == {number}


def test_overlapping_calls_leave_the_number_of_the_user():
    """The first to enter leaves first: were each to restore what it found, the number would end as 1."""
    second_is_in, first_is_out = threading.Event(), threading.Event()

    def second():
        with one_blas_thread():
            second_is_in.set()
            assert first_is_out.wait(60)
            return counts()

    with ThreadPoolExecutor(1) as pool:
        with one_blas_thread():
            later = pool.submit(second)
            assert second_is_in.wait(60)
        assert counts() == {1}, "the second still computes"
        first_is_out.set()
        assert later.result() == {1}
    assert counts() == {OWN}


def test_dask_workers_give_the_number_back(seen):
    tasks = [dask.delayed(lambda load: solve(Problem.of(P=load, base="layered", **PAPER)).a[0])(load)
             for load in (1e-6, 1e-5, 1e-4, 1e-3)]  # fmt: skip
    found = dask.compute(*tasks, scheduler="threads", num_workers=4)
    assert np.all(np.diff(found) > 0)
    assert all(here == {1} for here in seen) and counts() == {OWN}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no processes are forked on this system")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_process_forked_while_a_thread_computes_has_the_own_number():
    is_in, end = threading.Event(), threading.Event()

    def compute():
        with one_blas_thread():
            is_in.set()
            assert end.wait(60)

    with ThreadPoolExecutor(1) as pool:
        pool.submit(compute)
        assert is_in.wait(60)
        child = os.fork()
        if not child:
            before = counts()
            solve(layered())
            os._exit(0 if before == counts() == {OWN} else 1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
        assert counts() == {1}, "of the process that still computes"
        end.set()
    assert counts() == {OWN}


def test_libraries_with_a_number_for_each_thread_are_asked_in_each_thread(monkeypatch):
    """As OpenMP has them: what one thread sets, another does not see."""

    class Controlled(threading.local):
        num_threads = OWN

        def limit(self, limits):
            return Limited(self, limits)

    class Limited:
        def __init__(self, library, limits):
            self.library, self.limits = library, limits

        def __enter__(self):
            self.before, self.library.num_threads = self.library.num_threads, self.limits

        def __exit__(self, *_):
            self.library.num_threads = self.before

    library, both = Controlled(), threading.Barrier(2)
    monkeypatch.setattr("solver.numerics.threads._blas", lambda: (_OfTheProcess([]), library))

    def compute(_):
        with one_blas_thread():
            both.wait(60)
            inside = library.num_threads
        return inside, library.num_threads

    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(compute, range(2))) == [(1, OWN), (1, OWN)]


def test_two_threads_of_the_caller_get_the_numbers_of_one():
    """Bit by bit: each block is computed by the same operations on one BLAS thread, whoever computes beside it."""
    problem = Problem.of(base="layered", micro="disc_cell", **random_cases(4000, seed=12))
    halves = [problem.take(np.arange(start, start + 2000)) for start in (0, 2000)]
    alone = [solve(half) for half in halves]
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(solve, halves))
    for one, other in zip(alone, together, strict=True):
        for name in ("a", "P", "D", "p_max", "Ar_An", "status", "error", "p"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    assert counts() == {OWN}
