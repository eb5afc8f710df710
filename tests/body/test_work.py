"""How much is computed for a lone case that needs a mesh of its own: counted, not timed."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import layer_of

from solver import Problem, Status, solve
from solver.body import film, hankel, tables
from solver.body.wave_rule import CUT, FILM, quadrature
from solver.numerics.caches import Cache
from solver.numerics.mesh import mesh_of, panel_mesh
from solver.rough.start import smooth_start
from solver.scaling import as_cases

#: Panels towards the edge, as a film asks for.
PANELS = (0.0, *(2.0 ** -np.arange(12, -1, -1)).tolist())
FILMS = layer_of(h=1e-4, n=1e3, bonded=False)


@pytest.fixture
def counted(monkeypatch):
    """Numbers of J0 and of points where c is wanted so far, with no tables kept from before."""
    found = {"j0": 0, "c": 0}

    def watch(module, name, key):
        plain = getattr(module, name)

        def counting(values):
            found[key] += np.size(values)
            return plain(values)

        monkeypatch.setattr(module, name, counting)

    watch(tables.special, "j0", "j0")
    watch(film, "_in_octaves", "c")
    monkeypatch.setattr(tables, "_tables", Cache(4e8))
    tables._moments.cache_clear()
    return found


def test_meshes_of_the_same_panels_have_their_bessel_functions_in_common(counted):
    """The mesh of a solution and that of its error estimate, a third finer: the moments are those of one."""
    k, _ = quadrature(FILM, 0)
    for order in (12, 16):
        tables.transform(panel_mesh(order, PANELS), k)
        first = counted["j0"]
    tables.transform(panel_mesh(12, PANELS), k)
    assert counted["j0"] == first
    for order in (8, 12, 32, 48):
        tables.transform(mesh_of(order), k)
    assert counted["j0"] < 2 * first + 3 * 2000 * len(k)


def test_a_panel_that_is_near_has_as_many_points_as_its_distance_asks_for(counted):
    """2700 points of rules were taken for each point, however far it was."""
    mesh = panel_mesh(12, PANELS)
    points = mesh.s[tables.felt(mesh, mesh.x)]
    film.convolution(mesh, points, CUT)
    assert counted["c"] < 1800 * len(points)


def test_fewer_points_are_as_good_as_all(monkeypatch):
    """Of a stiff film, with those that a point inside the panel would take."""
    mesh = panel_mesh(12, PANELS)
    points, c = mesh.s[tables.felt(mesh, mesh.x)], FILMS.at(np.ones(1), mesh_of(5)).parts[0].film
    found = film.convolution(mesh, points, CUT).of(c)[0]
    monkeypatch.setattr(film, "_SMOOTH", 0.0)
    assert_allclose(found, film.convolution(mesh, points, CUT).of(c)[0], rtol=0, atol=1e-11 * np.abs(found).max())


def test_a_lone_case_makes_no_table_for_many_on_a_fine_mesh(counted):
    """The product of a table is as much work as the matrices of 36 to 104 cases."""
    for h in (1e-4, 0.3):
        mesh, layer = mesh_of(32), FILMS._replace(h=np.array([h]))
        layer.at(np.ones(1), mesh)
        layer.take(np.zeros(film.MANY, dtype=int)).at(np.ones(film.MANY), mesh)
    made = [value for value in tables._tables.values() if isinstance(value, tables.OctaveTable)]
    assert sorted(found.product is None for found in made) == [False, False, True, True]


def test_the_operator_at_the_same_radius_is_made_once():
    """Newton at a given radius changes the pressure alone."""
    first = FILMS.at(np.ones(1), panel_mesh(12, (0.0, *PANELS[6:])))
    again = FILMS.at(np.ones(1), first.mesh, first)
    assert again is first
    assert (
        FILMS.at(np.ones(1), mesh_of(5), first) is not first
        and FILMS.at(np.full(1, 1.1), first.mesh, first) is not first
    )


def test_a_search_for_the_radius_makes_one_operator_a_radius(monkeypatch):
    """Each began with that of the smooth contact, and threw it away."""
    made, plain = [], hankel.rows_of
    monkeypatch.setattr(hankel, "rows_of", lambda *arguments: made.append(1) or plain(*arguments))
    case = Problem.of(a=0.04, h=1e-5, n=1e3, Nbar=250000.0, Ra=0.004)
    ev = smooth_start(as_cases(case), mesh_of(12))
    assert len(made) == 1 and ev.operator.mesh == mesh_of(12)


def test_a_lone_stiff_film(counted):
    """39 million J0 were taken on its five meshes."""
    s = solve(Problem.of(a=1.0, R=20.0, h=1e-4, n=1e4, micro="smooth", rtol=1e-6, base="layered"))
    assert (s.status[0], s.nodes[0]) == (Status.CONVERGED, 96)
    assert counted["j0"] < 2.5e7
