"""Studies of the micro law alone (Table 1 of the paper)."""

import tomllib

import numpy as np
import pytest
import xarray as xr

import study
from solver import fit_power_law
from solver.laws import disc_cell as micro
from study.spec.definition import from_tables

TEXT = """
kind = "micro_law"
[[cases]]
Ra = 0.004
Nbar = 250000
label = "first"
[[cases]]
Ra = 0.002
Nbar = 250000
[fit]
step = 1e-3
mesh = "graded"
"""


@pytest.fixture(scope="module")
def opened(tmp_path_factory) -> study.Study:
    folder = tmp_path_factory.mktemp("laws")
    (folder / "table1.toml").write_text(TEXT, encoding="utf-8")
    found = study.load(folder / "table1.toml", folder / "results")
    assert found.run().cases == 2
    return found


def test_exact_law_and_fit(opened):
    found = opened.open()
    assert found.A_exact.dims == found.A_fit.dims == ("case", "p")
    assert found.label.values.tolist() == ["first", ""]
    p = found.p.values
    for i, Ra in enumerate((0.004, 0.002)):
        fit = fit_power_law(250000 * Ra**2, step=1e-3, mesh="graded")
        # the same function
        np.testing.assert_allclose(found.A_exact[i], micro.displacement(p, 1.0, 250000, Ra), rtol=1e-14, atol=0)
        # a power and two products
        np.testing.assert_allclose(found.A_fit[i], fit.B * Ra * p**fit.beta, rtol=1e-14, atol=0)
        assert (found.B[i], found.beta[i], found.max_error[i]) == (fit.B, fit.beta, fit.max_error)
    relative = abs(found.A_fit / found.A_exact - 1).where((found.p >= 0.0025) & (found.p <= 0.025))
    assert (relative.max("p") <= found.max_error + 1e-12).all()  # a rounding of a ratio
    assert (found.max_error < 0.1).all()


def test_it_is_a_results_file_like_the_others(opened):
    assert opened.run().computed == 0
    assert opened.status()["state"] == "done"
    with xr.open_dataset(opened.results / "table1.nc") as found:
        assert found.attrs["study"] == TEXT
        assert found.p.attrs["scale"] == "E1*"
        with pytest.raises(ValueError, match="pressures of a micro-law study are in E1"):
            study.to_physical(found, R=1e-2, E2_star=1e11)


def test_there_are_no_partial_results_of_a_law(opened, tmp_path):
    with pytest.raises(study.StudyError, match="does not exist; run the study first"):
        study.load(opened.results.parent / "table1.toml", tmp_path).open(partial=True)


def test_a_law_replaces_another_but_no_contacts_nor_what_is_not_ours(opened, tmp_path):
    results = tmp_path / "results"
    contacts = study.Study(
        from_tables({"model": {"micro": "smooth", "base": "half_space", "P": 1e-6}}, "table1", "", "t"), results
    )
    contacts.run()
    law = study.Study(opened.definition, results)
    with pytest.raises(study.StudyError, match="another definition .* 1 of its 1 cases are not in this one: --force"):
        law.run()
    assert contacts.status()["state"] == "done"
    (results / "table1.nc").write_bytes(b"no results")
    for force in (False, True):
        with pytest.raises(study.StudyError, match="is no netCDF file; move it away, or use --results DIR"):
            law.run(force=force)
    (results / "table1.nc").unlink()
    assert law.run().computed == 2
    coarser = study.Study(from_tables(tomllib.loads(TEXT.replace("1e-3", "5e-3")), "table1", "", "t"), results)
    assert coarser.run().computed == 2 and coarser.open().sizes["p"] == 6
