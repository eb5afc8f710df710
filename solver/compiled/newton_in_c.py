"""Newton's method by the compiled core; numpy solves the cases that the core does not take. Besides the numbers of the
cases the core gets C structures: meshes with the points between their nodes, and tables of layers."""

from ctypes import addressof, byref

import numpy as np

from ..body.half_space import HalfSpace
from ..body.hankel import Hankel
from ..body.tables import between, table
from ..body.wave_rule import OCTAVES, STIFFEST, few
from ..kernels.closed_form import bond_constants
from ..kernels.two_layers import SAMPLER, TwoLayers
from ..laws import LAWS
from ..laws.cell.cell_law import number, spot_curve
from ..numerics.caches import Cache
from ..numerics.ladder import LADDER, finer_mesh
from ..numerics.mesh import mesh_of
from ..parameters import one_of
from ..rough import adaptive
from ..rough.answer import denser_rule
from ..rough.error import STEEP, another_rule
from ..rough.newton import LIMIT
from ..rough.results import off_edge, stiffness_between
from ..shapes.paraboloid import Paraboloid
from ..solution import Solution
from ..status import Status
from .cells import cells_of
from .library import OF_MESH, OF_TABLE, CBatch, CMesh, CPoints, CRows, CTable, core, pointer

#: The laws and controls of the core, in the order of batch.h. There, the law CELL follows these: it stands for all laws
#: on the coated body whose curve is that of a family.
TAKEN, _CONTROLS = ("disc_cell", "power_law", "smooth"), ("P", "a", "D")
#: The bases of the core: it solves nearly all cases with these bases and the laws above.
BASES = ("half_space", "thin_layer", "layered")
_SCALARS = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", "residual", "error", "profile_error")
#: Most cases in one call of the core: so many fill its groups of similar cases, and it needs 14 MB.
_CHUNK = 16_384
#: Most families of cells on a coated body in one call, of 10 to 60 kB each: if there are more, a call has at most
#: _FAMILIES cases.
_FAMILIES = 1024
#: The meshes of the core, and the mesh with which the error on its last one is estimated. Cases that need finer meshes
#: are left to numpy, which continues with panels.
_MESHES, _FINER = LADDER[:-1], LADDER[-1]
#: Most nodes k of a quadrature for which the core has room. The thinnest layer that is not treated as a film has 2,180.
MOST_WAVES = 4096
#: On meshes of at most _PRODUCT nodes the matrices are products with one table, which takes too long to form on finer
#: meshes.
_PRODUCT = 32
#: Meshes and tables for later calls, at most 200 MB.
_cache = Cache(2e8)


def solve_newton(cases, rtol, nodes, limit, x):
    """Like :func:`~solver.rough.adaptive.solve_newton`, which solves the cases that the core does not take or
    returns unsolved."""
    function = core()
    index = np.flatnonzero(_taken(cases, nodes)) if function and not limit else ()
    if not len(index):
        return adaptive.solve_newton(cases, rtol, nodes, limit, x)
    part = cases if len(index) == len(rtol) else cases.take(index)
    solution = _solved(function, part, rtol[index], nodes[index], x)
    solved = np.flatnonzero(solution.nodes)
    if len(solved) == len(rtol):
        return solution
    rest = np.delete(np.arange(len(rtol)), index[solved])
    pieces = [(index[solved], solution.take(solved))]
    pieces.append((rest, adaptive.solve_newton(cases.take(rest), rtol[rest], nodes[rest], limit, x)))
    return Solution.join(len(rtol), len(x), pieces)


def _taken(cases, nodes):
    """(B,) bool: the core has the law, body and punch of the case, and its mesh if the case demands one."""
    law, body = cases.law.law, cases.body
    taken = (nodes == 0) | one_of(nodes, _MESHES)
    if _law_of(law) is None or not isinstance(cases.shape, Paraboloid):
        return np.zeros_like(taken)
    if law.name == "power_law":
        taken = taken & (cases.law.own[0][:, 0] >= STEEP)
    if isinstance(body, HalfSpace):
        return taken & law.rough
    if isinstance(body, Hankel) and isinstance(body.kernel, TwoLayers):
        return taken & (body.kernel.n <= STIFFEST[1])
    return np.zeros_like(taken)


def _law_of(law):
    """The number of a law in batch.h; None if the core does not have it."""
    if law.curve is spot_curve:
        return len(TAKEN)
    return next((i for i, name in enumerate(TAKEN) if law is LAWS[name]), None)


def _solved(function, cases, rtol, nodes, x):
    """:class:`~solver.solution.Solution` by the core; its `nodes` are 0 for cases that are returned unsolved."""
    size, points, s = len(rtol), len(x), np.sqrt((1 - x) * (1 + x))
    place = np.flatnonzero(s > 0)
    solved_at = off_edge(s[place], cases.law.rough)
    shrink, ladder = s[place] / solved_at, np.array([*_MESHES, _FINER], dtype=np.int64)
    scalars, (p, lam) = np.empty((len(_SCALARS), size)), np.zeros((2, size, points))
    last, iterations = np.zeros((2, size), dtype=np.int32)
    rows = _inputs(cases, rtol) | {"p": p, "lam": lam, "nodes": last, "iterations": iterations}
    rows["fixed"] = np.ascontiguousarray(nodes, dtype=np.int64)
    callbacks = _Callbacks(solved_at.tobytes())
    shared = {"stride": size, "points": len(place), "rungs": len(ladder), "control": _CONTROLS.index(cases.control)}
    shared |= {"law": _law_of(cases.law.law), "layered": isinstance(cases.body, Hankel), "steps": LIMIT}
    shared |= {"octaves": OCTAVES[1] - OCTAVES[0] + 1, "first_octave": OCTAVES[0], "columns": points}
    shared |= {"ladder": pointer(ladder), "shrink": pointer(shrink), "place": pointer(place)}
    shared |= {"mesh": OF_MESH(callbacks.address_of(mesh_for)), "table": OF_TABLE(callbacks.address_of(table_for))}
    on_body, chunk = cases.law.law.curve is spot_curve, _CHUNK
    if on_body and len(np.unique(number(cases.law.own[0], "digest"))) > _FAMILIES:
        chunk = min(chunk, _FAMILIES)
    for low in range(0, size, chunk):
        of_chunk = {name: pointer(values, low) for name, values in rows.items()}
        if on_body:
            families, addresses = cells_of(cases.law.own[0][low : low + chunk])
            of_chunk["cells"] = pointer(addresses)
        of_chunk |= {"size": min(chunk, size - low), "scalars": pointer(scalars.T, low)}
        if not function(byref(CBatch(**shared, **of_chunk)), -(-max(3 * _MESHES[-1], len(place)) // 32) * 32):
            raise MemoryError("no memory for the compiled core")
        callbacks.raise_what_was_raised()
    values = dict(zip(_SCALARS, scalars, strict=True))
    missed = values["error"] > rtol  # on a mesh that the case asks for
    values["status"] = np.where(missed, Status.TOLERANCE_NOT_MET, Status.CONVERGED).astype(np.int8)
    values |= {"nodes": last, "iterations": iterations}
    return Solution.of(size, points, **values, p=p, lam=lam)


def _inputs(cases, rtol):
    """Name in batch.h -> contiguous array (B,) of the numbers of the cases."""
    law, body, ones = cases.law, cases.body, np.ones(len(rtol))
    inputs = {"value": cases.value, "rtol": rtol, "p_star": law.p_star, "A_star": law.A_star, "E": body.E, "C": body.C}
    beta, ratio = (numbers[:, 0] for numbers in law.own) if law.law.name == "power_law" else (ones, ones)
    inputs |= {"beta": beta, "ratio": ratio}
    if isinstance(body, Hankel):
        kernel = body.kernel
        inputs |= {"h": body.h, "m": body.m, "n": kernel.n, "bonded": kernel.bonded}
        inputs |= bond_constants(kernel.n, kernel.nu1, kernel.nu2)._asdict()
    return {name: np.ascontiguousarray(values, dtype=float) for name, values in inputs.items()}


class _Callbacks:
    """The callbacks of the core. Errors that they raise are collected here, because they cannot pass through C."""

    def __init__(self, s_bytes):
        self.s_bytes, self.structures, self.raised = s_bytes, [], []

    def address_of(self, make):
        """A callback that returns the address of the structure from `make`, or 0 if there is none. The structures live
        as long as this object."""

        def of(*key):
            try:
                structure = None if self.raised else make(*key, self.s_bytes)
            except BaseException as error:  # Ctrl-C too
                self.raised.append(error)
                return 0
            self.structures.append(structure)
            return structure.address if structure else 0

        return of

    def raise_what_was_raised(self):
        if self.raised:
            raise self.raised[0]


class CStructure(tuple):
    """A C structure and the arrays to which it points: ``(structure, [arrays])``."""

    @property
    def address(self):
        return addressof(self[0])


def mesh_for(n, s_bytes):
    """:class:`CStructure` with the :class:`.library.CMesh` of n nodes and the points of profiles."""
    return _cache.get(("mesh", n, s_bytes), lambda: _mesh(mesh_of(n), np.frombuffer(s_bytes)))


def table_for(n, octave, stiffness, s_bytes):
    """:class:`CStructure` with the :class:`.library.CTable` of an octave of h/a and a class of stiffness on n nodes;
    None if the core has no room for it."""
    key = "table", n, octave, stiffness, s_bytes
    return _cache.get(key, lambda: _table(mesh_of(n), octave, stiffness, np.frombuffer(s_bytes)))


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
    structure = CMesh(
        *(mesh.n, at(mesh.s), at(mesh.w), operator(mesh), at(stiffness_between(mesh, mesh.s))),
        *(at(mesh.basis(np.zeros(1))[0]), at(fine.s), at(fine.w), operator(fine)),
        *(points(fine.s), points(s, 2 * w * s), points(dense, dense_w * dense), points(profile)),
    )
    return CStructure((structure, arrays))


def _blocks(array):
    """An array (r, c) as blocks of 8 columns, (blocks, r, 8), where zeros fill the columns up to a multiple of 32: the
    number of blocks is a multiple of 4."""
    padded = np.pad(array, ((0, 0), (0, -array.shape[1] % 32)))
    return padded.reshape(len(array), -1, 8).transpose(1, 0, 2)


def _table(mesh, octave, stiffness, profile):
    arrays = []

    def at(array):
        arrays.append(np.ascontiguousarray(array, dtype=float))
        return pointer(arrays[-1])

    def rows(mesh):
        """The product is formed for any number of cases, so that the bits of a case do not depend on the number."""
        of_mesh = table(mesh, SAMPLER, octave, stiffness, mesh.n <= _PRODUCT)
        J, phi, columns = of_mesh.J, of_mesh.phi, at(_blocks(of_mesh.phi.T))
        if mesh.n <= _PRODUCT:
            return of_mesh, CRows(at(_blocks(of_mesh.product)), None, None, None, columns)
        return of_mesh, CRows(None, at(J.T), at(_blocks(J)), at(_blocks(phi)), columns)

    (of_mesh, coarse), (_, fine) = rows(mesh), rows(finer_mesh(mesh))
    if of_mesh.spread.shape[1] > MOST_WAVES:
        return None
    s, _ = another_rule(mesh)
    points = (_blocks(between(octave, stiffness, np.ascontiguousarray(v))) for v in (finer_mesh(mesh).s, s, profile))
    k = at(few(SAMPLER, octave, stiffness).k)
    structure = CTable(*of_mesh.spread.shape, k, at(_blocks(of_mesh.spread)), coarse, fine, *map(at, points))
    return CStructure((structure, arrays))
