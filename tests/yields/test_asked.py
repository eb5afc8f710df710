"""What functions of stresses take: a contact, or the inputs of `study.solve`; and what `summary` says of it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from yielding import first_yield

import study

LAYER = {"h": 0.02, "n": 5.0, "nu2": 0.3, "bonding": "bonded", "micro": "smooth"}
STEEL = {"R": "5 mm", "E2": "210 GPa", "nu2": 0.3, "base": "half_space", "micro": "smooth"}


@pytest.fixture(scope="module")
def loads():
    return study.solve(P=[1e-5, 2e-5], **LAYER)


def test_first_yield_of_a_contact_is_that_of_its_inputs(loads):
    """Its load does not count, whatever controls it; a strength of the call goes before that of the contact."""
    wanted = first_yield("body", Y2=0.005, **LAYER)
    depths = study.solve(D=[1e-4, 2e-4], Y2=0.02, **LAYER)
    for contact in (loads, loads.isel(P=1), depths):
        yielding = first_yield("body", contact=contact, Y2=0.005)
        assert yielding.P_Y2.item() == wanted.P_Y2.item()
        assert not {"P", "a", "D"} & {*yielding.variables}
    assert first_yield("body", contact=depths).P_Y2.item() > 5 * wanted.P_Y2.item()


def test_strengths_of_a_contact_have_units_and_spreads():
    contact = study.solve(P="1 N", Y2="900 ± 90 MPa", **STEEL)
    wanted = first_yield("body", Y2="500 ± 50 MPa", **STEEL)
    yielding = first_yield("body", contact=contact, Y2="500 ± 50 MPa")
    for name in ("P_Y2", "P_Y2_spread"):
        assert yielding[name].item() == pytest.approx(wanted[name].item(), rel=1e-12)
    assert "P_Y2_spread" not in first_yield("body", contact=contact, Y2="500 MPa")


def test_no_contact_is_solved_to_know_the_inputs(monkeypatch):
    """The load that a contact must have is any, and is never named: the first input with a unit is the user's own."""
    monkeypatch.setattr(study.solving, "solved", None)
    assert first_yield("body", Y2=0.005, **LAYER).P_Y2 > 0
    assert study.h_protect(P=1e-5, Y2=0.005, n=2.0, bonding="bonded", micro="smooth").h_protect > 0
    with pytest.raises(study.StudyError, match='E2 = "1 GPa" makes this a study with units'):
        study.first_yield(E2=["1 GPa", "2 GPa"], h=0.1)


def test_the_load_of_a_contact_counts_for_what_protects(loads):
    """And its thickness does not; the load of a contact with a or D is the one that was found."""
    wanted = study.h_protect(P=1e-5, Y2=0.005, **{name: v for name, v in LAYER.items() if name != "h"})
    of_contacts = study.h_protect(loads, Y2=0.005)
    # not the same bits: `rows_of` of solver/body/hankel_operator.py is one product of BLAS for a batch, which sums
    # in another order when it has one column, or with OpenBLAS on processors with AVX-512 when it is small
    assert of_contacts.h_protect.sel(P=1e-5).item() == pytest.approx(wanted.h_protect.item(), rel=1e-14)
    assert "h" not in of_contacts.variables
    several = study.solve(a=[loads.a[0].item()], **LAYER | {"h": [0.02, 0.05]})
    assert_allclose(study.h_protect(several.isel(a=0), Y2=0.005).h_protect, wanted.h_protect, rtol=1e-6)


def test_stresses_of_inputs_are_those_of_the_contact(loads):
    contact = loads.isel(P=0)
    one, other = (
        study.stresses(*of, r=[0.5], z=[0.2], **more) for of, more in (([contact], {}), ([], LAYER | {"P": 1e-5}))
    )
    assert one.mises.item() == other.mises.item()
    bare = study.extremes(R="5 mm", E2="210 GPa", base="half_space", micro="smooth", P="1 N")
    assert bare.mises2.attrs["units"] == "Pa" and bare.mises2 > 0
    assert study.plot_stresses(P=1e-5, micro="smooth", base="half_space").axes


FUNCTIONS = (study.stresses, study.extremes, study.first_yield, study.h_protect, study.plot_stresses)


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_what_is_no_contact_is_told(function, loads):
    name = function.__name__
    for arguments, inputs, message in (
        ([5], {}, f"^{name} takes a dataset of study.solve"),
        ([loads], {"nu1": 0.2}, f"^{name}: nu1: give a contact or its inputs, not both"),
        ([], {}, f"^{name}: (give|h is missing)"),
        ([], {"R": "5 mm", "P": None if name == "first_yield" else "1 N"}, f"^{name}: "),
        ([loads.isel(P=0)], {"mu": None}, "^mu = None: must be a finite number"),
        ([loads.isel(P=0)], {"mu": True}, "^mu = True: must be a finite number"),
        ([loads.isel(P=0)], {"mu": 1e300}, "^mu = 1e.300: must be at most 1000"),
    ):
        with pytest.raises(study.StudyError, match=message):
            function(*arguments, **inputs)


@pytest.mark.parametrize("residual", [None, True, 1e300, -1e300, [1.0]])
def test_what_is_no_residual_stress_is_told(residual, loads):
    steel = study.solve(P="1 N", **STEEL)
    for contact in (loads.isel(P=0), steel):
        for function in (study.stresses, study.extremes, study.first_yield, study.plot_stresses):
            with pytest.raises(study.StudyError, match="^sigma_res = "):
                function(contact, sigma_res=residual)
    with pytest.raises(study.StudyError, match="^sigma_res = .1e200 GPa.: must be at most 1e.06 times E2"):
        study.extremes(steel, sigma_res="1e200 GPa")


@pytest.mark.parametrize("strength", [-1.0, True, [1, 2], "1 GPa", np.inf])
def test_what_is_no_strength_of_a_contact_is_told(strength, loads):
    with pytest.raises(study.StudyError, match="^first_yield: Y2 = "):
        study.first_yield(loads, Y2=strength)


def test_answers_have_summaries(loads):
    yielding = study.summary(study.first_yield(loads, Y2=0.005, Y1=50.0)).splitlines()
    assert yielding[0] == "First to yield, as far as strengths are known: the body."
    assert yielding[1].startswith("No load up to a = 0.2 R was found at which the layer yields")
    assert yielding[2].startswith("The body first yields at P = 9.317e-06 E2* R^2, a = 0.01163 R, D = ")
    assert yielding[2].endswith("on the axis, 1.72 a deep.")
    assert yielding[3:] == ["The punch is smooth: there are no asperities.", "The strength of the punch is not known."]
    protected = study.summary(study.h_protect(loads, Y2=0.005))
    assert "--- P = 1e-05 E2* R^2\nThe body does not yield below a layer thicker than 0.0208 R." in protected
    cone = study.first_yield(shape="cone", half_angle=80, base="half_space", micro="smooth", Y2=0.01)
    assert "The body yields under any load: below a sharp tip" in study.summary(cone)
    ball = study.solve(P="1 N", **STEEL)
    largest = study.summary(study.extremes(ball))
    assert "largest von Mises stress of the body" in largest and "MPa, on the axis, 0.48" in largest
    field = study.summary(study.stresses(ball, r=[0.0, 1.0], z=[0.0, 0.5]))
    assert field.startswith("Stresses at 2 radii and 2 depths.\nvon Mises stress, maximum: ")
