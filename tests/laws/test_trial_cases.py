"""A law of somebody else's that slips in some of its cases only: it is told, and of which case."""

import dataclasses

import cones
import numpy as np
import pytest

import study
from solver.laws import trial

GIVEN = {"Nbar": np.full(3, 250_000.0), "alpha": np.array([1.2, 1.3, 1.4])}


def refused(law, **given) -> str:
    with pytest.raises(ValueError) as caught:
        trial.tried(law, np.ones(3), GIVEN | given)
    return str(caught.value)


@pytest.mark.parametrize("wrong", [1.2, 1.3, 1.4])
@pytest.mark.parametrize("name", ["dq", "dg"])
def test_the_case_that_slips_is_named(name, wrong):
    def scales(E, Nbar, alpha):
        return *cones.scales(E, Nbar, alpha), np.where(alpha == wrong, 1.1, 1.0)

    def curve(y, factor):
        found = cones.curve(y)
        return found._replace(**{name: getattr(found, name) * factor})

    functions = {"area": lambda y, q, factor: cones.CONES.area(y, q), "edge": lambda factor: cones.CONES.edge()}
    functions |= {"peak": lambda y, q, factor: cones.CONES.peak(y, q), "from_pressure": None, "from_displacement": None}
    law = dataclasses.replace(cones.CONES, name="slips", scales=scales, curve=curve, guess=None, **functions)
    said = refused(law)
    assert f"curve: {name} must be the derivative of {name[1]} by y (at y = " in said
    assert f", Nbar = 2.5e+05, alpha = {wrong:.3g})" in said


def test_a_slip_counts_among_the_points_that_the_law_knows():
    """Spots so stiff that p is above E at all but three of the y: there a law may be what it likes."""
    hard = dataclasses.replace(
        cones.CONES, name="hard", scales=lambda E, **given: (1e9 * E, cones.scales(E, **given)[1])
    )
    trial.tried(hard, np.ones(3), GIVEN)
    slips = dataclasses.replace(hard, curve=lambda y: cones.curve(y)._replace(dq=4.1 * y**3))
    assert "curve: dq must be the derivative of q by y" in refused(slips)


def test_a_law_may_be_given_in_cases_and_beside_others():
    """An object is known by its parameters there too, before it itself is read; of what is no dictionary the
    whole list is refused."""
    rows = [{"alpha": 1.3, "micro": cones.CONES}, {"micro": "smooth"}]
    common = {"P": 1e-5, "base": "half_space", "Nbar": 250_000.0, "x": 2}
    found = study.solve(cases=rows, **common)
    alone = study.solve(micro=cones.CONES, alpha=1.3, **common)
    assert found.micro.values.tolist() == ["cones", "smooth"] and float(found.a[0]) == float(alone.a)
    for wrong in ([rows[0], 3], [None], "P", []):
        with pytest.raises(study.StudyError, match="^cases must be a list of dictionaries, at least one$"):
            study.solve(cases=wrong, **common)


@pytest.mark.parametrize("shape", [np.s_[:, :1], np.s_[:1], np.s_[0], np.s_[0, 0]])
def test_an_area_of_another_shape_is_refused(shape):
    """One number for all points of a case, or for all cases, would be broadcast without a word."""
    law = dataclasses.replace(cones.CONES, name="short", area=lambda y, q: q[shape])
    assert "area must return an array of the shape of y, (cases, points)" in refused(law)
