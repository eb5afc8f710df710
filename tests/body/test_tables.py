"""The tables of the layered operator: how much of them is kept, and that it does not matter to the numbers."""

import numpy as np
import pytest
from scipy.special import j1
from solver_cases import difference, one

from solver.body import tables as module
from solver.body.wave_rule import FILM
from solver.kernels.two_layers import SAMPLER
from solver.numerics.caches import Cache
from solver.numerics.mesh import mesh_of
from solver.numerics.quadrature import gauss_legendre


@pytest.fixture
def tables(monkeypatch):
    """No tables yet."""

    def emptied(most):
        monkeypatch.setattr(module, "_tables", Cache(most))
        return module._tables

    return emptied


def test_no_more_than_400_megabytes_are_kept():
    assert module._tables.most == 4e8


def test_what_tables_have_in_common_is_kept_once(tables):
    """J0 and φ, for many cases and for few; φ is also that of the waves."""
    kept = tables(4e8)
    first, *others = (module.table(mesh_of(8), SAMPLER, 0, *kind) for kind in ((0, True), (0, False)))
    assert all(other.J is first.J and other.phi is first.phi for other in others)
    whole = [v for table in (first, *others) for v in (table.product, table.spread) if v is not None]
    distinct = {id(v): v.nbytes for v in (first.J, first.phi, *whole)}
    assert kept.nbytes == sum(distinct.values())


def test_a_film_has_the_convolution_of_many_or_of_few(tables):
    tables(4e8)
    many, few = (module.table(mesh_of(8), SAMPLER, FILM, 0, kind).film.rows for kind in (True, False))
    c = np.random.default_rng(0).random((2, many.table.shape[0]))
    np.testing.assert_allclose(many.of(c), few.of(c), rtol=0, atol=1e-12 * np.abs(few.of(c)).max())


def test_numbers_do_not_depend_on_what_is_kept(tables, monkeypatch):
    """Eight octaves of h/a, films, and tables too large to be kept whole; to the rounding of the operator."""
    case = {"a": 0.04, "h": 0.04 * 2.0 ** np.arange(-10.5, 6, 2), "n": 0.5, "base": "layered", "nodes": 12}
    kept = tables(4e8)
    whole = one(**case)
    assert len(kept.values()) > 7
    kept = tables(1.0)
    monkeypatch.setattr(module, "_KEEP", 0)
    assert difference(one(**case), whole).max() < 1e-11
    assert len(kept.values()) == 1


def test_waves_less_those_at_the_edge():
    """J0(kx) - J0(k) = k ∫ J1(kt) dt from x to 1, in which nothing cancels. A plain difference has no digit at the
    smallest s; away from the edge, where it is taken, it is rounded to a few 1e-16."""
    k, s = np.geomspace(1e-3, 5e3, 60), np.geomspace(1e-9, 0.03, 60)
    gap, (t, w) = s * s / (1 + np.sqrt((1 - s) * (1 + s))), gauss_legendre(16)
    expected = k[:, None] * gap * (j1(k[:, None, None] * (1 - gap[:, None] * t)) @ w)
    found, largest = module.less_edge(k, s), k[:, None] * gap * np.minimum(k, 1 / np.sqrt(k))[:, None]
    assert (np.abs(found - expected) < 1e-10 * largest + np.where(s > 3e-3, 1e-15, 0.0)).all()
