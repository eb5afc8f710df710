"""Loose operators: where they are taken, and that they cost no accuracy that was asked for."""

import numpy as np
from solver_cases import difference, layer_of

from solver import Problem, Status, solve
from solver.body.hankel import _COUNTS, Hankel
from solver.numerics.mesh import mesh_of

X = np.linspace(0, 1, 5)
SIZE, RTOL = 1000, 1e-6


def coatings(micro):
    """Ordinary loads, and layers of every thickness and stiffness that a loose operator serves."""
    random = np.random.default_rng(21)

    def between(low, high):
        return np.exp(random.uniform(np.log(low), np.log(high), SIZE))

    return {
        "P": between(1e-8, 1e-2),
        "h": between(1e-3, 3),
        "n": between(1e-3, 1e3),
        "nu1": random.uniform(-0.5, 0.5, SIZE),
        "bonding": random.choice(["bonded", "frictionless"], SIZE),
        "Nbar": between(1e4, 1e7),
        "Ra": between(1e-3, 1e-2),
        "base": "layered",
        "micro": micro,
        "rtol": RTOL,
    }


def test_they_are_right_to_a_hundredth_of_rtol(monkeypatch):
    """Against the same meshes with the operator right to rounding. What is left out counts more than once in some
    solutions, and in none more often than the error of the operator says."""
    for micro in ("smooth", "disc_cell"):
        case, one = coatings(micro), np.ones(SIZE)
        body = layer_of(h=case["h"], n=case["n"], nu1=case["nu1"], bonded=case["bonding"] == "bonded")
        loose = solve(Problem.of(**case), X)
        with monkeypatch.context() as tight:
            tight.setattr(Hankel, "within", lambda body, rtol, a: body)
            exact = solve(Problem.of(**case), X)
        same = (loose.nodes == exact.nodes) & (exact.status == Status.CONVERGED)
        assert np.array_equal(loose.status, exact.status) and same.mean() > 0.99
        moved, body = difference(loose, exact), body.within(RTOL * one, exact.a)
        assert np.all(moved[same] <= 0.01 * RTOL)
        counts = (_COUNTS * moved / body.error(exact.a, 1))[same & body.loose]
        assert 1 < counts.max() <= _COUNTS


def is_loose(rtol=RTOL, **given):
    """Whether the operator is at a = 1, and how many values of L it takes."""
    body = layer_of(**given).within(np.array([rtol]), np.ones(1))
    (part,) = body.at(np.ones(1), mesh_of(5)).parts
    return bool(body.loose[0]), part.L1.shape[1]


def test_ordinary_layers_take_fewer_values_of_L():
    assert is_loose() == (True, 36) and is_loose(n=100.0) == (True, 61)
    assert is_loose(rtol=1e-9) == (False, 52) and is_loose(rtol=0.0, n=100.0) == (False, 90)


def test_soft_layers_plates_and_films_do_not():
    """Of a soft layer little is left of the half-space's term; the pressure under a plate can be a small difference."""
    assert is_loose(rtol=1e-7) == (True, 36) and is_loose(rtol=1e-7, n=1e-4, h=0.01) == (False, 52)
    assert is_loose(n=900.0) == (False, 90)
    assert is_loose(rtol=0.1, n=1e4) == (False, 104) and is_loose(rtol=0.1, n=1e7) == (False, 104)
    film, one = layer_of(h=1e-3, n=1e5), np.ones(1)
    assert not film.within(one, one).loose[0]
    # one that has become a film on the way to its radius
    loose = film._replace(loose=one > 0)
    (part,), (other,) = (body.at(one, mesh_of(5)).parts for body in (film, loose))
    assert part.film is not None and np.array_equal(part.L1, other.L1)
    assert loose.error(one, 5) == film.error(one, 5)


def test_a_stiff_film_that_is_none_at_its_radius():
    """At the radius that is guessed it is a film, of which the class of stiffness is another."""
    body = layer_of(h=1e-3, n=1e5).within(np.ones(1), np.ones(1))
    (part,) = body.at(np.full(1, 0.1), mesh_of(5)).parts
    assert part.film is None and part.L1.shape[1] == 104
