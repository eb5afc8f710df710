"""The operator of a body with a kernel on a mesh: its matrix, and the products and slopes that follow from it."""

from typing import NamedTuple

import numpy as np

from ..numerics.mesh import Mesh
from .film import MANY
from .part import united
from .tables import between, felt, film_rows


class HankelOperator(NamedTuple):
    """The :class:`~solver.body.operator.Operator` of bodies with a kernel.

    parts : list of :class:`.part.Part`, the values of the kernel
    rows : (B, n + 1, n), the matrix K and under it the row of the edge. In memory the index of the case runs fastest
    """

    mesh: Mesh
    parts: list
    rows: np.ndarray

    @property
    def K(self):
        return self.rows[:, :-1]

    @property
    def edge(self):
        return self.rows[:, -1]

    def take(self, index):
        """The operator of a sub-batch; `index` must ascend."""
        place = np.full(len(self.rows), -1)
        place[index] = np.arange(len(index))
        at = [np.flatnonzero(place[part.index] >= 0) for part in self.parts]
        parts = [part.take(r) for part, r in zip(self.parts, at, strict=True) if len(r)]
        parts = [part._replace(index=place[part.index]) for part in parts]
        rows = np.take(self.rows.transpose(1, 2, 0), index, axis=2).transpose(2, 0, 1)
        return HankelOperator(self.mesh, parts, rows)

    @classmethod
    def assemble(cls, operators, places):
        """The operator of a batch from the `operators` of its sub-batches, each at its `places` (b,) in it."""
        mesh, size = operators[0].mesh, sum(len(place) for place in places)
        n = mesh.n
        rows, groups = np.empty((n + 1, n, size)).transpose(2, 0, 1), {}
        for operator, place in zip(operators, places, strict=True):
            rows[place] = operator.rows
            for part in operator.parts:
                part = part._replace(index=place[part.index])
                groups.setdefault(part.kind, []).append(part)
        return cls(mesh, [united(parts) for parts in groups.values()], rows)

    def at_edge(self, q):
        return (self.edge * q).sum(axis=1)

    def products(self, q):
        displacements = np.einsum("bij,bj->bi", self.rows, q)
        return displacements[:, :-1], displacements[:, -1]

    def slopes(self, q):
        out = np.empty((len(q), self.mesh.n + 1))
        for part in self.parts:
            for tab, rows in part.tables(self.mesh):
                index, uL = part.index[rows], part.uL[rows]
                pressures = q[index]
                if tab.is_small:
                    matrices = (uL @ tab.product).reshape(len(pressures), -1, self.mesh.n)
                    out[index] = np.einsum("bij,bj->bi", matrices, pressures)
                else:
                    out[index] = (tab.weights(uL) * (pressures @ tab.phi.T)) @ tab.J
                if part.film is not None:
                    out[index] += np.matmul(_film(part.d_film[rows], tab, self.mesh.n), pressures[..., None])[..., 0]
        return out[:, :-1], out[:, -1]

    def between(self, q, s, half_space):
        out, x = np.empty(half_space.shape), np.sqrt((1 - s) * (1 + s))
        for part in self.parts:
            for tab, rows in part.tables(self.mesh):
                index = part.index[rows]
                J = between(int(part.octave[rows][0]), part.stiffness, s)
                out[index] = (tab.weights(part.L1[rows]) * (q[index] @ tab.phi.T)) @ J
            if part.film is not None:
                index, near = part.index, felt(self.mesh, x)
                away = film_rows(self.mesh, s[near].tobytes(), len(part.film) >= MANY).of(part.film)
                out[index] -= ((part.film @ tab.film.edge) * q[index]).sum(axis=1)[:, None]
                out[np.ix_(index, near)] += np.matmul(away, q[index][:, :, None])[..., 0]
            out[part.index] += part.share * half_space[part.index]
        return out


def rows_of(parts, mesh):
    """K and under it the row of the edge, (B, n + 1, n); in memory the index of the case runs fastest."""
    order, n, end = np.concatenate([np.arange(0), *(part.index for part in parts)]), mesh.n, 0
    flat, half_space = np.empty(((n + 1) * n, len(order))), np.vstack([mesh.K, mesh.edge]).reshape(-1, 1)
    for part in parts:
        begin = end
        for tab, rows in part.tables(mesh):
            low, end = end, end + rows.stop - rows.start
            block, L1 = flat[:, low:end], part.L1[rows]
            of_cases = block.reshape(n + 1, n, -1).transpose(2, 0, 1)
            if tab.product is None:
                for matrix, w in zip(of_cases, tab.weights(L1), strict=True):
                    matrix[:] = (tab.J * w[:, None]).T @ tab.phi
            else:
                np.matmul(tab.product.T, L1.T, out=block)
            if part.film is not None:
                of_cases[:] += _film(part.film[rows], tab, n)
        flat[:, begin:end] += half_space * np.transpose(part.share)
    if np.any(np.diff(order) < 0):
        flat = np.take(flat, np.argsort(order), axis=1)
    return flat.reshape(n + 1, n, -1).transpose(2, 0, 1)


def _film(c, tab, n):
    """The contribution (b, n + 1, n) of the convolutions c (b, T) to the matrix and, under it, to the row of the
    edge."""
    rows, at_edge = np.zeros((len(c), n + 1, n)), c @ tab.film.edge
    rows[:, :-1] -= at_edge[:, None]
    rows[:, tab.film.nodes] += tab.film.rows.of(c)
    rows[:, -1] = at_edge
    return rows
