"""Plates under which the punch lifts off inside the contact: no tension and no gap passes for a solution.

On meshes that are given, for there no finer one and no panels come to help; what those find is in
test_layered_limits.py.
"""

import numpy as np
from layered_independent import fredholm

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


def test_a_ring_of_tension_between_the_nodes():
    """Two plates just stiff enough: the independent pressure is below 0 in a narrow ring, 1e-4 of the largest. Panels
    whose nodes lie beside that ring took both for contacts."""
    for n, bonding in ((3.91e5, "frictionless"), (4.25e5, "bonded")):
        p = fredholm(0.18, n, 0.3, 0.3, bonding == "bonded", radii=np.linspace(0.25, 0.97, 73))[4:]
        assert -2e-4 < p.min() / p.max() < -1e-5
        s = plates([1 / 0.18], n, bonding, nodes=[0, 22, 32, 48, 96])
        assert list(s.status) == [Status.LIFT_OFF] * 5


def test_tension_that_no_finer_mesh_will_judge():
    """On meshes that are given the tensile part of the load is an error: 3e-6 of the load here."""
    s = plates([4.0], 1e5, "bonded", nodes=[64, 96])
    assert list(s.status) == [Status.TOLERANCE_NOT_MET] * 2
    assert np.all((s.error > 1e-6) & (s.error < 1e-5)) and np.isfinite(s.P).all()


def test_tension_above_the_error_of_the_mesh_is_the_error():
    """16 nodes err by 7e-5, and their polynomial has 2e-4 of the load in tension: whoever allows 1e-4 gets no contact,
    whoever allows 1e-2 reads of the larger."""
    s = plates([5.0], 4.9e5, "bonded", nodes=16, rtol=[1e-4, 1e-2])
    assert list(s.status) == [Status.TOLERANCE_NOT_MET, Status.CONVERGED]
    assert np.all((s.error > 1.5e-4) & (s.error < 3e-4))


def test_a_gap_is_an_error_of_all_of_the_contact():
    """Asperities in a ring hang over so stiff a plate. The mesh is off by less than a
    half, and says that nothing is right."""
    rough = {"micro": "power_law", "Nbar": 1e12, "Ra": 1e-6, "B": 1.0, "beta": 0.6, "rtol": 0.9}
    s = plates([7.0403465, 10.7600884], [3888109.0, 30663147.0], "bonded", nodes=48, **rough)
    assert list(s.status) == [Status.TOLERANCE_NOT_MET] * 2 and list(s.error) == [1.0, 1.0]
    assert np.all(s.p0 > 0), "it is pressed in the centre"
