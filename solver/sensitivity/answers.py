"""The answers of contacts with a moved input, and the derivatives that follow from their differences.

The contacts keep their radius; the radius itself is moved as a further input. Let Q_θ and Q_a be the derivatives of
ln Q by an input θ at fixed radius, and by ln a. A contact under the control C = P, a or D has

    d ln a/dθ = -C_θ/C_a,      d ln Q/dθ = Q_θ + Q_a d ln a/dθ,      d ln Q/d ln C = Q_a/C_a.
"""

import numpy as np

from ..models.auto import area_rule, spots_under
from ..rough.newton import stiffness
from ..rough.results import pointed, quantities
from ..scaling import as_cases, law_of
from .inputs import STEP, moved_cases, slope_of
from .points import area_of_corners, between, profiles
from .same_mesh import same, solve_again
from .solved_cases import SolvedCases, solved_cases
from .step import Solved, branch_slope, moved_contacts, on_kinks

#: Quantities that have sensitivities, arrays (B,) of a :class:`~solver.solution.Solution`; and those among them whose
#: unit contains the modulus.
QUANTITIES = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD", "A0")
_OF_MODULUS = ("P", "p0", "p_max", "dP_dD")
#: Those that depend on the pressure on the axis, which is unknown under a point.
_OF_CENTRE = ("p0", "p_max", "A0")


def derivatives_of(scaled, now: SolvedCases, solution, inputs, nodes, x):
    """Three answers for cases of one kind: (B,) bool, whether the derivatives are valid; quantity -> derivatives of its
    logarithm (k, B); and derivatives of p and λ at the radii x (c,), (2, k, B, c).

    scaled, now : the cases as the caller states them, and as they are solved
    nodes : as in :func:`~solver.sensitivity.same_mesh.solve_again`
    """
    others, cases = [name for name in inputs if name != scaled.control], as_cases(now.written)
    iterated = solve_again(cases, nodes, solution.a, now.written.rtol)
    moved = moved_cases(scaled, others, copies=1)  # the radius is moved in the last pair
    solved_as = solved_cases(moved, np.tile(solution.model_used, 2 * (len(others) + 1)))
    answers, at_x = _answers(Solved.of(iterated.at), solved_as, moved, x)
    by = {name: slope_of(np.log(np.abs(values)), len(others) + 1) for name, values in answers.items()}
    p0 = quantities(iterated.at).p0 * now.E2  # not by the logarithm, to agree with the profile, which is 0 at the edge
    by["p0"] = slope_of(answers["p0"], len(others) + 1) / p0
    order, control = [others.index(name) if name in others else -1 for name in inputs], by[scaled.control]
    logs = {name: _under(control, slopes)[order] for name, slopes in by.items()}
    finite = np.ones(len(scaled), dtype=bool)
    for name, values in logs.items():
        finite &= np.isfinite(values).all(axis=0) | (pointed(cases) & (name in _OF_CENTRE))
    good = iterated.closed & finite & same(iterated.at, solution, now.written.rtol)
    return good, logs, np.stack([_under(control, slope_of(values, len(others) + 1))[order] for values in at_x])


def _under(control, slopes):
    """Derivatives (k, B, ...) under the control: by the other inputs, and last by the logarithm of the control.
    `slopes` are the derivatives at fixed radius, and last those by ln a; `control` (k, B) are those of the logarithm of
    the control."""
    control = control.reshape(*control.shape, *[1] * (slopes.ndim - 2))
    along = slopes[-1:] / control[-1:]
    return np.concatenate([slopes[:-1] - control[:-1] * along, along])


def _answers(start, solved_as: SolvedCases, moved, x):
    """Quantity -> (m B,), and p and λ (2, m B, c), of m blocks of the B cases of `start`, each with an input moved; in
    the last two blocks it is the radius. `moved`, `solved_as` : the moved cases as the caller states them, and as they
    are solved."""
    cases, size = as_cases(solved_as.written), len(start.at.state.eta)
    eta = np.tile(start.at.state.eta, len(moved) // size)
    eta[-2 * size :] += np.repeat([STEP, -STEP], size)
    bent, added = start.at.cases.law.bent(start.at.state.y, start.at.curve.q), solved_as.added.any()
    answers, at_x = {name: np.empty(len(moved)) for name in QUANTITIES}, np.empty((2, len(moved), len(x)))
    kinks = on_kinks(start.at)
    for blocks, contacts in moved_contacts(start, cases, eta, count=1 + kinks):
        rows = (np.array(blocks)[:, None] * size + np.arange(size)).ravel()
        values, E2 = quantities(contacts.at)._asdict(), solved_as.E2[rows]
        values["dP_dD"] = stiffness(contacts.at, contacts.tangent, values["P"], values["D"])
        if bent.any():
            corners = area_of_corners(start, contacts)
            values["Ar_An"] = np.where(np.tile(bent, len(blocks)), corners, values["Ar_An"])
        values |= {name: values[name] * E2 for name in _OF_MODULUS}
        unit = (contacts.at.cases.law.p_star * E2)[:, None]
        q, at_x[1, rows] = profiles(start, contacts, x)
        p0 = values["p0"][:, None]
        at_x[0, rows] = np.where((x == 0) & np.isfinite(p0), p0, unit * q)
        if added:  # then for all cases, since they have one law
            p, law = unit * between(start, contacts, np.append(area_rule()[0], 1.0))[0], law_of(moved.take(rows))
            values |= spots_under(law, p[:, -1], p[:, :-1])
            at_x[1, rows] = law.at(at_x[0, rows]).lam
        for name, array in answers.items():
            array[rows] = values[name]
    if kinks:
        logs = np.log([answers["P"] / solved_as.E2, answers["D"]])
        answers["dP_dD"] = branch_slope(start, cases, eta, logs) * answers["P"] / answers["D"]
    return answers, at_x
