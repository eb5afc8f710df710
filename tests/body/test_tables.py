"""The tables of the layered operator: how much of them is kept, and that it does not matter to the numbers."""

from collections import OrderedDict

import numpy as np
import pytest
from solver_cases import difference, one

from solver.body import tables as module
from solver.numerics.mesh import mesh


@pytest.fixture
def tables(monkeypatch):
    """No tables yet."""
    monkeypatch.setattr(module, "_tables", OrderedDict())
    return lambda: module._tables


def size(tables):
    return sum(array.nbytes for found in tables.values() for array in found if isinstance(array, np.ndarray))


def test_no_more_than_400_megabytes_are_kept(tables, monkeypatch):
    """The oldest go, those that were used last stay. The arrays are not touched, and take no memory."""
    none = np.empty(0)
    big = module.Table(none, np.empty(20_000_000), none, none, none, none, None, None)
    monkeypatch.setattr(module, "_table", lambda *key: big._replace(k=np.array(key[1:])))
    grid, sizes = mesh(5), []
    for octave in range(6):
        module.table(grid, octave, 0)
        module.table(grid, 0, 0)  # in use
        sizes.append(size(tables()))
    assert max(sizes) <= 4e8 and sizes[-1] > 2e8
    assert [found.k[0] for found in tables().values()] == [5, 0]


def test_a_table_larger_than_all_is_kept_alone(tables, monkeypatch):
    monkeypatch.setattr(module, "_MOST_BYTES", 1.0)
    first, again = (module.table(mesh(5), 0, 0) for _ in range(2))
    assert first is again
    assert module.table(mesh(5), 1, 0) is not first and len(tables()) == 1


def test_numbers_do_not_depend_on_what_is_kept(tables, monkeypatch):
    """Eight octaves of h/a, films, and tables too large to be kept whole; to the rounding of the operator."""
    case = {"a": 0.04, "h": 0.04 * 2.0 ** np.arange(-10.5, 6, 2), "n": 0.5, "base": "layered", "nodes": 12}
    whole = one(**case)
    assert len(tables()) > 7
    monkeypatch.setattr(module, "_tables", OrderedDict())
    monkeypatch.setattr(module, "_MOST_BYTES", 1.0)
    monkeypatch.setattr(module, "_KEEP", 0)
    assert difference(one(**case), whole).max() < 1e-11
    assert len(tables()) == 1
