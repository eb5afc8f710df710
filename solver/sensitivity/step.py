"""One Newton step: from solved contacts to the same contacts with an input moved a little, at the same radius.

There are two equations, that of the contact and that of its slope t = dq/d ln a along the branch of solutions:

    F = 0,      (dF/dq) t + dF/d ln a = 0.

Both are evaluated for the moved input at the solved q and t, and the inverse of the solved matrix removes their
residuals. The remaining error is of second order in the step, and equal for the input moved up and down: it cancels in
the difference.

The radius is fixed, because the kinks of a punch then stay in place, or move with an input by a known distance. So do
the ends of the panels of a case with kinks. The radius itself is moved like an input.
"""

from typing import NamedTuple

import numpy as np

from ..body.operator import Operator
from ..laws import Curve
from ..numerics.linalg import solve_stack
from ..numerics.mesh import panel_mesh
from ..rough.equation import Evaluation, Unknowns, evaluate_with, jacobian
from ..rough.panels import ends_of, stretch
from ..rough.results import quantities
from .inputs import STEP

#: Decimal places of the places of kinks, in s, above which only rounding is different.
_DIGITS = 14


class Solved(NamedTuple):
    """The solved equation of B cases.

    at : the equation at the solutions
    inverse : (B, n, n), the inverse of dF/dq over X
    tangent : (B, n), dq/d ln a along the branch of solutions
    meshes : the meshes of moved contacts whose panels follow kinks, by the places of these
    """

    at: Evaluation
    inverse: np.ndarray
    tangent: np.ndarray
    meshes: dict

    @classmethod
    def of(cls, at):
        diagonal, dF_deta = jacobian(at)
        unit = np.broadcast_to(np.eye(at.mesh.n), (*diagonal.shape, at.mesh.n))
        inverse = np.ascontiguousarray(solve_stack(at.operator.K, diagonal, unit))
        return cls(at, inverse, -np.einsum("bij,bj->bi", inverse, dF_deta), {})

    def correction(self, residual):
        """The change of q, or of its slope, (m B, n), whose subtraction removes the `residual` over X, (m B, n), of the
        equations of moved cases."""
        size, n = self.tangent.shape
        change = self.inverse @ residual.reshape(-1, size, n).transpose(1, 2, 0)
        return change.transpose(2, 0, 1).reshape(residual.shape)


class Moved(NamedTuple):
    """The equation `at` the solutions of moved cases, m blocks of the B solved ones, and their `tangent` (m B, n)."""

    at: Evaluation
    tangent: np.ndarray


def moved_contacts(start, cases, eta, count=1):
    """Yield the numbers of blocks of the moved `cases`, at ln a = `eta` (m B,), and their :class:`Moved`: all blocks
    together, or those that share a mesh. `count`: number of steps with the same inverse, each of which adds an
    order."""
    size = len(start.at.state.eta)
    changed = _changed(start.at, cases, eta)
    for mesh, blocks in _meshes(start, cases, eta).items():
        rows = (np.array(blocks)[:, None] * size + np.arange(size)).ravel()
        part = cases.take(rows), eta[rows]
        operator = _operator(start.at, *part, mesh, changed[blocks] | (mesh != start.at.mesh))
        yield blocks, _after_steps(start, *part, operator, count)


def _after_steps(start, cases, eta, operator, count):
    times, before = len(eta) // len(start.tangent), start.at
    y, tangent = np.tile(before.state.y, (times, 1)), np.tile(start.tangent, (times, 1))
    curve = moved_curve(cases.law, before.cases.law, before.state.y, before.curve)
    now = evaluate_with(operator, cases, Unknowns(y, eta), curve)
    for _ in range(count):
        y = cases.law.limit(y - start.correction(now.F / now.X) / now.curve.dq, y)
        now = evaluate_with(operator, cases, Unknowns(y, eta))
    diagonal, dF_deta = jacobian(now)
    residual = operator.products(tangent)[0] + diagonal * tangent + dF_deta
    return Moved(now, tangent - start.correction(residual))


def moved_curve(law, before, y, curve):
    """The :class:`~solver.laws.law.Curve` of moved laws at y (B, c), where the solved laws, `before`, have `curve`. It
    is computed only for the blocks in which the numbers of the law have changed, since it is most of the work for a law
    that is a table."""
    size, blocks = len(y), len(law.p_star) // len(y)
    changed = np.zeros(blocks, dtype=bool)
    for values, old in zip(law.own, before.own, strict=True):
        changed |= np.any(values.reshape(blocks, size, -1) != old, axis=(1, 2))
    parts, rows = [np.tile(part, (blocks, 1)) for part in curve], np.flatnonzero(np.repeat(changed, size))
    if len(rows):
        anew = law.take(rows).evaluate(np.tile(y, (np.count_nonzero(changed), 1)))
        for part, values in zip(parts, anew, strict=True):
            part[rows] = values
    return Curve(*parts)


def on_kinks(ev):
    """Whether `ev` belongs to a single case whose panels have ends at kinks of the punch inside the contact."""
    return ev.mesh.order < ev.mesh.n and len(_ends(ev)) > 2


def _ends(ev):
    return ends_of(ev.cases.shape, float(np.exp(ev.state.eta[0])))


def branch_slope(start, cases, eta, logs):
    """d ln P/d ln D (m,) of moved cases whose panels follow kinks, at which the slope for a fixed place is infinite. It
    is from differences of contacts with two radii. Each takes two steps: the result is a second derivative, and needs
    terms of second order.

    cases, eta : pairs of moved contacts, up and down; in the last pair it is the radius that is moved
    logs : (2, m), ln P and ln D there

    Each pair is moved once more: with the input up the radius goes up, and down with the input down. So kinks whose
    place is an input come back to where they were, and need no further mesh.
    """
    sign, last = np.tile([1.0, -1.0], len(eta) // 2), len(eta) - 2  # the case of the last pair is the solved one
    further = np.empty((2, last + 1))
    moved = np.append(eta[:last] + STEP * sign[:last], start.at.state.eta)
    for blocks, contacts in moved_contacts(start, cases.take(np.arange(last + 1)), moved, count=2):
        numbers = quantities(contacts.at)
        further[:, blocks] = np.log(numbers.P), np.log(numbers.D)
    (high, low), middle = logs[:, last:].T, further[:, last]
    slope, bend = (high - low) / (2 * STEP), (high - 2 * middle + low) / STEP**2
    change = ((further[:, :last] - logs[:, :last]) * sign[:last]).reshape(2, -1, 2)
    mixed = (change[..., 0] - change[..., 1]) / (2 * STEP**2) - bend[:, None] / 2
    by_input = np.column_stack([mixed, bend]) / slope[:, None]
    return slope[0] / slope[1] * np.exp(STEP * sign * np.repeat(by_input[0] - by_input[1], 2))


def _changed(ev, cases, eta):
    """(m,) bool: the blocks whose body or radius differs from that of the solved cases."""
    size = len(ev.state.eta)

    def differ(values, old):
        return np.any(values.reshape(-1, size, *values.shape[1:]) != old, axis=tuple(range(1, values.ndim + 1)))

    changed = differ(eta, ev.state.eta)
    for values, old in zip(_numbers(cases.body), _numbers(ev.cases.body), strict=True):
        changed |= differ(values, old)
    return changed


def _numbers(body):
    """Yield each array of numbers of a body."""
    for part in body:
        if hasattr(part, "_fields"):
            yield from _numbers(part)
        elif isinstance(part, np.ndarray) and part.dtype.kind == "f":
            yield part


def _meshes(start, cases, eta):
    """Mesh -> its blocks. There is one mesh, that of the solved cases, unless panels end at kinks: then the panels of
    each block follow its kinks. Blocks whose kinks are at the same places, but for rounding, share their mesh, which is
    most of the work for a case with kinks."""
    ev, size = start.at, len(start.at.state.eta)
    blocks = range(len(eta) // size)
    if not on_kinks(ev):
        return {ev.mesh: list(blocks)}
    before, of_mesh = _ends(ev), {}
    places = start.meshes or {_rounded(before): ev.mesh}
    start.meshes.update(places)
    for block in blocks:
        ends = ends_of(cases.shape.take([block]), float(np.exp(eta[block])))
        if len(ends) != len(before):
            mesh = ev.mesh
        elif (mesh := start.meshes.get(_rounded(ends))) is None:
            mesh = panel_mesh(ev.mesh.order, stretch(ev.mesh.breaks, before, ends))
            start.meshes[_rounded(ends)] = mesh
        of_mesh.setdefault(mesh, []).append(block)
    return of_mesh


def _rounded(ends):
    """Places of kinks to _DIGITS: a key for places that differ by rounding."""
    return tuple(round(end, _DIGITS) for end in ends)


def _operator(ev, cases, eta, mesh, changed):
    """The operator of moved cases on a mesh: a new one for the blocks that have `changed`, (m,) bool, and that of the
    solved cases for the others."""
    if cases.body.kernel is None:  # one operator for all bodies and radii
        return cases.body.at(np.exp(eta), mesh)
    anew = np.flatnonzero(np.repeat(changed, len(ev.state.eta)))
    operator = cases.body.take(anew).at(np.exp(eta[anew]), mesh) if len(anew) else None
    return operator if changed.all() else BlockOperator(ev.operator, operator, changed)


class BlockOperator(NamedTuple):
    """The :class:`~solver.body.operator.Operator` of m blocks of B cases, as far as a step needs it.

    solved : operator of the B solved cases, which most of the blocks share
    anew : that of the cases in the blocks that have `changed`, (m,) bool; None where no block has
    """

    solved: Operator
    anew: Operator | None
    changed: np.ndarray

    @property
    def mesh(self):
        return self.solved.mesh

    @property
    def edge(self):
        rows = np.repeat(self.solved.edge[None], len(self.changed), axis=0)
        if self.anew is not None:
            rows[self.changed] = self.anew.edge.reshape(-1, *rows.shape[1:])
        return rows.reshape(-1, rows.shape[-1])

    def products(self, q):
        return self._of_blocks("products", q)

    def slopes(self, q):
        return self._of_blocks("slopes", q)

    def _of_blocks(self, name, q):
        blocks = q.reshape(len(self.changed), -1, q.shape[-1])
        rows, edge = np.empty_like(blocks), np.empty(blocks.shape[:2])
        for number in np.flatnonzero(~self.changed):
            rows[number], edge[number] = getattr(self.solved, name)(blocks[number])
        if self.anew is not None:
            anew, at_edge = getattr(self.anew, name)(blocks[self.changed].reshape(-1, q.shape[-1]))
            rows[self.changed] = anew.reshape(-1, *blocks.shape[1:])
            edge[self.changed] = at_edge.reshape(-1, blocks.shape[1])
        return rows.reshape(q.shape), edge.ravel()
