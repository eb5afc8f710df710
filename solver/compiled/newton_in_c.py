"""Newton's method by the compiled core: the cases that it takes, and numpy for the rest."""

from ctypes import byref

import numpy as np

from ..body.half_space import HalfSpace
from ..body.hankel import Hankel
from ..body.wave_rule import OCTAVES, STIFFEST
from ..kernels.closed_form import bond_constants
from ..kernels.two_layers import TwoLayers
from ..laws import LAWS
from ..laws.cell.cell_law import number, spot_curve
from ..numerics.ladder import LADDER
from ..parameters import one_of
from ..rough import adaptive
from ..rough.error import STEEP
from ..rough.newton import LIMIT
from ..rough.results import apart
from ..shapes.paraboloid import Paraboloid
from ..solution import Solution
from ..status import Status
from .cells import cells_of
from .library import OF_MESH, OF_TABLE, CBatch, core, pointer
from .structures import mesh_for, table_for

#: The laws and controls of the core, in the order of batch.h. Behind these laws, CELL stands for those on the coated
#: body whose curve is that of a family.
TAKEN, _CONTROLS = ("disc_cell", "power_law", "smooth"), ("P", "a", "D")
#: The bases of the core: it solves nearly all cases of these and the laws above.
BASES = ("half_space", "thin_layer", "layered")
_SCALARS = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", "residual", "error", "profile_error")
#: Most cases of one call of the core. Its memory is 14 MB, and groups of like cases are full.
_CHUNK = 16_384
#: Most families of cells on a coated body in one call: of 10 to 60 kB each. Where there are more, a call has no more
#: cases than this.
_FAMILIES = 1024
#: Meshes of the core, and the finer one of the last. What needs more is left to numpy, which goes on to panels.
_MESHES, _FINER = LADDER[:-1], LADDER[-1]


def solve_newton(cases, rtol, nodes, limit, x):
    """As :func:`~solver.rough.adaptive.solve_newton`, which solves the cases that the core hands back."""
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
    """(B,) bool: the cases of which the core knows law, body and punch, and whose mesh is free."""
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
    """The number of a law in batch.h; None of those that the core does not know."""
    if law.curve is spot_curve:
        return len(TAKEN)
    return next((i for i, name in enumerate(TAKEN) if law is LAWS[name]), None)


def _solved(function, cases, rtol, nodes, x):
    """:class:`~solver.solution.Solution` by the core; `nodes` is 0 of the cases that are handed back."""
    size, points, s = len(rtol), len(x), np.sqrt((1 - x) * (1 + x))
    place = np.flatnonzero(s > 0)
    solved_at = apart(s[place], cases.law.rough)
    shrink, ladder = s[place] / solved_at, np.array([*_MESHES, _FINER], dtype=np.int64)
    scalars, (p, lam) = np.empty((len(_SCALARS), size)), np.zeros((2, size, points))
    last, iterations = np.zeros((2, size), dtype=np.int32)
    rows = _inputs(cases, rtol) | {"p": p, "lam": lam, "nodes": last, "iterations": iterations}
    rows["fixed"] = np.ascontiguousarray(nodes, dtype=np.int64)
    given = _Given(solved_at.tobytes())
    shared = {"stride": size, "points": len(place), "rungs": len(ladder), "control": _CONTROLS.index(cases.control)}
    shared |= {"law": _law_of(cases.law.law), "layered": isinstance(cases.body, Hankel), "steps": LIMIT}
    shared |= {"octaves": OCTAVES[1] - OCTAVES[0] + 1, "first_octave": OCTAVES[0], "columns": points}
    shared |= {"ladder": pointer(ladder), "shrink": pointer(shrink), "place": pointer(place)}
    shared |= {"mesh": OF_MESH(given.address_of(mesh_for)), "table": OF_TABLE(given.address_of(table_for))}
    on_body, chunk = cases.law.law.curve is spot_curve, _CHUNK
    if on_body and len(np.unique(number(cases.law.own[0], "digest"))) > _FAMILIES:
        chunk = min(chunk, _FAMILIES)
    for low in range(0, size, chunk):
        own = {name: pointer(values, low) for name, values in rows.items()}
        if on_body:
            families, addresses = cells_of(cases.law.own[0][low : low + chunk])
            own["cells"] = pointer(addresses)
        own |= {"size": min(chunk, size - low), "scalars": pointer(scalars.T, low)}
        if not function(byref(CBatch(**shared, **own)), -(-max(3 * _MESHES[-1], len(place)) // 32) * 32):
            raise MemoryError("no memory for the compiled core")
        given.raise_what_was_raised()
    values = dict(zip(_SCALARS, scalars, strict=True))
    missed = values["error"] > rtol  # on a mesh that the case asks for
    values["status"] = np.where(missed, Status.TOLERANCE_NOT_MET, Status.CONVERGED).astype(np.int8)
    values |= {"nodes": last, "iterations": iterations}
    return Solution.of(size, points, **values, p=p, lam=lam)


def _inputs(cases, rtol):
    """Name in batch.h -> contiguous array (B,) of the numbers of the cases."""
    law, body, one = cases.law, cases.body, np.ones(len(rtol))
    inputs = {"value": cases.value, "rtol": rtol, "p_star": law.p_star, "A_star": law.A_star, "E": body.E, "C": body.C}
    beta, ratio = (own[:, 0] for own in law.own) if law.law.name == "power_law" else (one, one)
    inputs |= {"beta": beta, "ratio": ratio}
    if isinstance(body, Hankel):
        kernel = body.kernel
        inputs |= {"h": body.h, "m": body.m, "n": kernel.n, "bonded": kernel.bonded}
        inputs |= bond_constants(kernel.n, kernel.nu1, kernel.nu2)._asdict()
    return {name: np.ascontiguousarray(values, dtype=float) for name, values in inputs.items()}


class _Given:
    """What the core asks for while it solves, and what is raised meanwhile: in a callback of C that would be lost."""

    def __init__(self, s_bytes):
        self.s_bytes, self.held, self.raised = s_bytes, [], []

    def address_of(self, make):
        """A callback: the address of what `make` returns, or 0. What it has returned is there until the call ends."""

        def of(*key):
            try:
                made = None if self.raised else make(*key, self.s_bytes)
            except BaseException as error:  # Ctrl-C too
                self.raised.append(error)
                return 0
            self.held.append(made)
            return made.address if made else 0

        return of

    def raise_what_was_raised(self):
        if self.raised:
            raise self.raised[0]
