"""Tables of a micro law whose A is a length: one file for punches of every radius."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver.laws import LAWS
from study import StudyError

pytestmark = pytest.mark.filterwarnings("ignore:this contact is beyond what the model")
CASE = {"E2": "5 GPa", "P": "1 N", "base": "half_space"}
PRESSURES = np.geomspace(1e-6, 0.03, 30)
ROWS = LAWS["disc_cell"].at(PRESSURES, 1.0, Nbar=1e10, Ra=1e-4)  # in m


@pytest.fixture
def write(tmp_path, monkeypatch):
    """A function that writes the rows under a heading, with A over a length, and gives the word of `micro`."""
    monkeypatch.chdir(tmp_path)

    def write(heading, length, first=""):
        columns = PRESSURES, ROWS.A / length, ROWS.lam, ROWS.p_max
        lines = [",".join(map(repr, map(float, row))) for row in zip(*columns, strict=True)]
        (tmp_path / "law.csv").write_text("\n".join([*[first] * bool(first), f"p,{heading},lam,p_max", *lines]))
        return "table:law.csv"

    return write


def test_a_length_serves_every_radius_and_a_multiple_of_r_one(write):
    radii = ["2 mm", "5 mm"]
    lengths = study.solve(**CASE, R=radii, micro=write("A [um]", 1e-6))
    assert (lengths.status == 0).all()
    for i, R in enumerate((2e-3, 5e-3)):
        multiples = study.solve(**CASE, R=radii[i], micro=write("A", R))
        for name in ("a", "D", "p_max", "Ar_An"):
            assert_allclose(lengths[name][i], multiples[name], rtol=1e-10)
    spheres = study.solve(**CASE, R="5 mm", Nbar="1e10 1/m^2", Ra="100 um")
    assert_allclose(lengths.D[1], spheres.D, rtol=1e-3)


def test_a_radius_may_have_a_spread_and_a_result_is_a_contact_again(write):
    found = study.solve(**CASE, R="5 ± 0.1 mm", micro=write("A [nm]", 1e-9))
    moved = study.solve(**CASE, R="5.005 mm", micro="table:law.csv")
    nominal = study.solve(**CASE, R="5 mm", micro="table:law.csv")
    slope = np.log(moved.D / nominal.D) / np.log(5.005 / 5)
    assert_allclose(found.D_spread, abs(slope) * 0.02 * nominal.D, rtol=0.01)
    assert study.extremes(nominal).mises2 > 0
    assert "law_unit" not in study.summary(found)


def test_what_is_refused(write):
    with pytest.raises(StudyError, match=r"A is a length: give the other inputs with units too"):
        study.solve(P=1e-5, base="half_space", micro=write("A [m]", 1.0))
    with pytest.raises(StudyError, match=r"column A: \[GPa\] is not a unit of length"):
        study.solve(**CASE, R="5 mm", micro=write("A [GPa]", 1.0))
    with pytest.raises(StudyError, match="has been changed"):
        study.solve(**CASE, R="5 mm", micro=write("A [m]", 1.0, '# scan: {"error": -1, "body": null}'))


def test_the_error_that_a_file_states_is_that_of_contacts(write):
    found = study.solve(**CASE, R="5 mm", micro=write("A [m]", 1.0, '# scan: {"error": 0.25, "body": null}'))
    assert 0.25 <= found.model_error < 0.3
