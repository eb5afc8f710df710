"""What a solution says of the way to it: the steps of a case are its own, on all its meshes."""

from solver_cases import LOAD, one

from solver import rough


def test_a_smooth_thin_layer_counts_its_own_steps():
    """Not those of the slowest in the batch; on all meshes: two a mesh under a load, on 12, 16, 22, 32 nodes here."""
    case = {"D": 1e-3, "h": [1e-4, 0.02, 2.0], "base": "thin_layer", "micro": "smooth", "nodes": 12}
    together, alone = one(**case), [one(**case | {"h": h}) for h in case["h"]]
    assert together.iterations.tolist() == [s.iterations[0] for s in alone]
    assert len(set(together.iterations)) > 1
    climbing = one(P=LOAD, h=1e-6, base="thin_layer", micro="smooth", rtol=1e-6)
    assert (climbing.nodes[0], climbing.iterations[0]) == (32, 8)


def test_a_rough_case_counts_the_steps_on_all_its_meshes(monkeypatch):
    steps = []

    def counted(*arguments):
        state, closed, count = iterate(*arguments)
        steps.append(count.sum())
        return state, closed, count

    iterate = rough.iterate
    monkeypatch.setattr(rough, "iterate", counted)
    s = one(P=LOAD, base="thin_layer", micro="power_law", h=2e-4, n=0.5, Ra=0.02, Nbar=1e5)
    assert len([count for count in steps if count > 0]) > 1 and s.iterations[0] == sum(steps)
