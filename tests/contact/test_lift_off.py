"""Plates under which the punch lifts off inside the contact: no tension and no gap passes for a solution.

On meshes that are given, for there no finer one and no panels come to help; what those find is in
test_layered_limits.py.
"""

import numpy as np

from solver import Problem, Status, solve


def plates(a_h, n, bonding, **more):
    """A smooth punch, or another, on plates of a/h and n."""
    given = {"a": 0.01, "h": 0.01 / np.asarray(a_h), "n": n, "bonding": bonding, "base": "layered", "micro": "smooth"}
    return solve(Problem.of(**given | more))


def test_tension_in_the_centre():
    """On 8 and 10 nodes p(0) is -4 times E2*, and that to better than a tenth; the tension is but 4e-4 of the load."""
    s = plates([3.5126501851845537], 10339326.0, "bonded", nodes=[8, 10])
    assert list(s.status) == [Status.LIFT_OFF] * 2
    assert np.isnan(s.p0).all() and np.isnan(s.p).all()


def test_tension_of_which_nothing_is_known_keeps_its_numbers():
    """Six nodes have p(0) < 0 with an error of 350 %, and say so; the solution is positive."""
    case = [7.187558667226378], 91026.8, "frictionless"
    coarse, fine = plates(*case, nodes=6), plates(*case)
    assert coarse.status[0] == Status.TOLERANCE_NOT_MET and coarse.error[0] > 1 and coarse.p0[0] < 0
    assert fine.status[0] == Status.CONVERGED and fine.p0[0] > 0


def test_tension_in_a_ring():
    """Under plates 1e7 times stiffer it is pressed in the centre, and 1e-3 of the load is tension around it."""
    s = plates([6.011308, 7.0403465, 10.7600884], [6984587.0, 3888109.0, 30663147.0],
               ["frictionless", "bonded", "bonded"], nodes=24)  # fmt: skip
    assert list(s.status) == [Status.LIFT_OFF] * 3
