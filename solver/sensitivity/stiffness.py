"""Derivatives of the contact stiffness dP/dD by inputs: of the slope S = d ln P/d ln D of the curve.

At a fixed depth the derivative dS/dθ by an input θ is the derivative of d ln P/dθ by ln D. So d ln P/dθ at a fixed
depth is formed at two states next to the solution, on the tangent of the branch: their error is even in the distance
and cancels. At such a state one transposed system serves all inputs. Then, under the control,

    d ln S/dθ = [d(d ln P/dθ)/d ln D + (dS/d ln D) (d ln D/dθ)]/S,    dP/dD = S P/D.

Where the punch has kinks inside the contact, the panels follow them, and the states beside are solved anew.
"""

from dataclasses import replace

import numpy as np

from ..numerics.linalg import solve_stack
from ..numerics.mesh import panel_mesh
from ..rough.equation import State, control_gradient, evaluate, jacobian
from ..rough.newton import solve_on
from ..rough.panels import ends_of, followed
from .changes import changes_of
from .state import explicit, moving_numbers, of_law, operators_of

#: Distance of the two states in ln a.
STEP = 3e-4


def stiffness_slopes(ev, part, derivatives, operators):
    """Derivatives (k, B) of ln dP/dD. `part`: the moved cases; `derivatives`: :class:`.state.Implicit` of `ev`;
    `operators`: input -> :class:`.state.OperatorChange` at the radii of the solutions."""
    by_depth = control_gradient("D", ev)
    D_eta = (by_depth[0] * derivatives.tangent).sum(axis=1) + by_depth[1]
    ends = [_beside(ev, part, derivatives, operators, sign * STEP) for sign in (1, -1)]
    loads, slopes = (np.subtract(*both) / (2 * STEP * D_eta) for both in zip(*ends, strict=True))
    S = (ends[0][1] + ends[1][1]) / 2
    logs = derivatives.logs
    return (loads + slopes * logs["D"]) / S + logs["P"] - logs["D"]


def _beside(ev, part, derivatives, operators, step):
    """d ln P/dθ at a fixed depth (k, B), and S (B,), at the state with η + `step` on the tangent of the branch."""
    tangent, kinked = derivatives.tangent, ev.cases.shape is not None and ev.cases.shape.kinks().size > 0
    anew = kinked and ev.mesh.order < ev.mesh.n and len(_ends(ev, 0.0)) == len(_ends(ev, step))
    at = _solved_beside(ev, step) if anew else _on_tangent(ev, tangent, step)
    changes = changes_of(part, at.state.eta, len(derivatives.eta))
    law = of_law(at.cases.law, at.state.y, at.curve, moving_numbers(changes))
    if anew:
        moved = {i: change.products(at.curve.q) for i, change in operators_of(at, changes).items()}
    else:
        moved = {i: _beside_products(change, ev.curve.q, tangent, step) for i, change in operators.items()}
    fixed = explicit(at, changes, {i: slopes[0] for i, slopes in law.by_own.items()}, moved)
    diagonal, dF_deta = jacobian(at)
    gradients = [control_gradient(name, at) for name in ("P", "D")]
    right = np.stack([by_q for by_q, _ in gradients], axis=-1)
    adjoint = solve_stack(np.swapaxes(at.operator.K, 1, 2), diagonal, right)
    P, D = adjoint[..., 0], adjoint[..., 1]
    P_eta, D_eta = (by_eta - (v * dF_deta).sum(axis=1) for v, (_, by_eta) in zip((P, D), gradients, strict=True))
    S = P_eta / D_eta
    of_load, of_depth = (np.einsum("bn,kbn->kb", v, fixed.F) for v in (P, D))
    return fixed.P - of_load - S * (fixed.D - of_depth), S


def _on_tangent(ev, tangent, step):
    y = ev.state.y + step * tangent / ev.curve.dq
    return evaluate(ev.cases, State(y, ev.state.eta + step), ev.mesh)


def _solved_beside(ev, step):
    """The equation of one case at its solution for a radius beside that of `ev`, on the panels of `ev` that follow the
    kinks: so errors of the mesh are those of the other side, and cancel."""
    case = ev.cases._replace(control="a", value=np.exp(ev.state.eta + step))
    mesh = panel_mesh(ev.mesh.order, followed(ev.mesh.breaks, _ends(ev, 0.0), _ends(ev, step)))
    at = solve_on(evaluate(case, State(ev.state.y, ev.state.eta + step), mesh)).at
    return replace(at, cases=ev.cases)


def _ends(ev, step):
    return ends_of(ev.cases.shape, float(np.exp(ev.state.eta[0] + step)))


def _beside_products(change, q, tangent, step):
    """Derivatives of K q and edge @ q by an input that changes the operator, at the state beside the solution. They are
    to first order, from the operator at the radius of the solution."""
    parts = change.products(q), change.products(tangent), change.slopes(q)
    return tuple(here + step * (along + slope) for here, along, slope in zip(*parts, strict=True))
