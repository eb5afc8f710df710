"""What the core needs beside the cases: meshes, points between their nodes, and the tables of layers, as C has them."""

from ctypes import addressof

import numpy as np

from ..body.tables import between, table
from ..body.wave_rule import few
from ..kernels.two_layers import SAMPLER
from ..numerics.kept import Kept
from ..numerics.ladder import finer_mesh
from ..numerics.mesh import mesh_of
from ..rough.answer import denser_rule
from ..rough.error import another_rule
from ..rough.results import stiffness_between
from .library import CMesh, CPoints, CRows, CTable, pointer

#: Most numbers k of a quadrature for which there is room in the core. The thinnest layer that is no film has 2,180.
MOST_WAVES = 4096
#: On meshes of up to this many nodes the matrices are products with one table. On finer ones that takes long to make.
_PRODUCT = 32
#: All that is kept for later calls takes at most this many bytes.
_kept = Kept(2e8)


class Made(tuple):
    """A structure of C and the arrays to which it points: ``(structure, [arrays])``."""

    @property
    def address(self):
        return addressof(self[0])


def mesh_for(n, s_bytes):
    """:class:`Made` of the :class:`.library.CMesh` of n nodes, with the points of profiles."""
    return _kept.get(("mesh", n, s_bytes), lambda: _mesh(mesh_of(n), np.frombuffer(s_bytes)))


def table_for(n, octave, stiffness, s_bytes):
    """:class:`Made` of the :class:`.library.CTable` of an octave of h/a and a class of stiffness on n nodes; None if
    the core has no room for it."""
    key = "table", n, octave, stiffness, s_bytes
    return _kept.get(key, lambda: _table(mesh_of(n), octave, stiffness, np.frombuffer(s_bytes)))


def _mesh(mesh, profile):
    arrays, fine = [], finer_mesh(mesh)

    def at(array):
        arrays.append(np.ascontiguousarray(array, dtype=float))
        return pointer(arrays[-1])

    def points(s, w=None):
        s = np.ascontiguousarray(s)
        w = s if w is None else w
        summed = (at(_blocks(values.T)) for values in (mesh.basis(s), mesh.rows(s)))
        return CPoints(len(s), at(s), at(w), at(stiffness_between(mesh, s)), *summed)

    def operator(mesh):
        return at(np.vstack([mesh.K, mesh.edge]))

    (s, w), (dense, dense_w) = another_rule(mesh), denser_rule(mesh)
    made = CMesh(
        *(mesh.n, at(mesh.s), at(mesh.w), operator(mesh), at(stiffness_between(mesh, mesh.s))),
        *(at(mesh.basis(np.zeros(1))[0]), at(fine.s), at(fine.w), operator(fine)),
        *(points(fine.s), points(s, 2 * w * s), points(dense, dense_w * dense), points(profile)),
    )
    return Made((made, arrays))


def _blocks(array):
    """The numbers of an array (r, c), 8 of c together, zeros behind the last: (blocks, r, 8), four or eight or so."""
    padded = np.pad(array, ((0, 0), (0, -array.shape[1] % 32)))
    return padded.reshape(len(array), -1, 8).transpose(1, 0, 2)


def _table(mesh, octave, stiffness, profile):
    arrays = []

    def at(array):
        arrays.append(np.ascontiguousarray(array, dtype=float))
        return pointer(arrays[-1])

    def rows(mesh):
        """Whether the product is there does not depend on the number of cases: nor do their bits."""
        of_mesh = table(mesh, SAMPLER, octave, stiffness, mesh.n <= _PRODUCT)
        J, phi, columns = of_mesh.J, of_mesh.phi, at(_blocks(of_mesh.phi.T))
        if mesh.n <= _PRODUCT:
            return of_mesh, CRows(at(_blocks(of_mesh.product)), None, None, None, columns)
        return of_mesh, CRows(None, at(J.T), at(_blocks(J)), at(_blocks(phi)), columns)

    (of_mesh, own), (_, fine) = rows(mesh), rows(finer_mesh(mesh))
    if of_mesh.spread.shape[1] > MOST_WAVES:
        return None
    s, _ = another_rule(mesh)
    points = (_blocks(between(octave, stiffness, np.ascontiguousarray(v))) for v in (finer_mesh(mesh).s, s, profile))
    k = at(few(SAMPLER, octave, stiffness).k)
    made = CTable(*of_mesh.spread.shape, k, at(_blocks(of_mesh.spread)), own, fine, *map(at, points))
    return Made((made, arrays))
