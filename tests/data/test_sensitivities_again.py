"""`study.sensitivities`: derivatives of results that are there, from their inputs alone."""

import warnings

import numpy as np
import pytest

import study

POWERS = {"P": (1, 2), "R": (0, 1), "h": (0, 1), "Ra": (0, 1), "Nbar": (0, -2), "E1": (1, 0), "E2": (1, 0)}
POWERS |= {"E_punch": (1, 0), "a": (0, 1), "D": (0, 1), "p0": (1, 0), "p_max": (1, 0), "Ar_An": (0, 0), "dP_dD": (1, 1)}
"""Power of a modulus and of a length in each quantity."""
LAYER = {"R": "5 mm", "E1": "2 ± 0.2 GPa", "E2": "210 GPa", "E_punch": "70 GPa", "h": ["100 um", "300 um"], "nu1": 0.4}
ROUGH = {"Nbar": "2e9 1/m^2", "Ra": "10 um", "P": ["1 N", "10 N"], "bonding": "bonded", "x": 2, "workers": 1}


def quiet(**given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**given)


@pytest.fixture(scope="module")
def contact():
    return quiet(**LAYER, **ROUGH)


@pytest.fixture(scope="module")
def found(contact):
    return study.sensitivities(contact)


def test_what_a_change_of_units_says(found):
    """Lengths c times as large, with a load c² times as large, make lengths c times as large; so do moduli."""
    names = [name for name in found.input.values.tolist() if name in POWERS]
    assert len(names) == 8
    for result in ("a", "D", "p0", "p_max", "Ar_An", "dP_dD"):
        values = found[f"{result}_sensitivity"].sel(input=names).values
        sums = values @ [POWERS[name] for name in names]
        # derivatives of p_max, Ar_An and dP_dD are differences: tests/sensitivity/test_sensitivities.py
        np.testing.assert_allclose(sums, np.broadcast_to(POWERS[result], sums.shape), rtol=0, atol=2e-6, err_msg=result)


def test_they_are_those_of_solve(contact, found):
    at_once = quiet(**LAYER, **ROUGH, sensitivities=True)
    assert list(found.data_vars) == [name for name in at_once.data_vars if name.endswith("_sensitivity")]
    for name, variable in found.data_vars.items():
        assert variable.identical(at_once[name])
    assert set(found.dims) == {"h", "P", "input"} and found.E1_spread == contact.E1_spread


@pytest.mark.parametrize("part", [{"P": 1}, {"P": 1, "h": [0]}, {"h": slice(None, None, -1)}])
def test_a_selected_part(contact, found, part):
    alone = study.sensitivities(contact.isel(part))
    assert alone.a_sensitivity.dims == found.a_sensitivity.isel(part).dims
    for name, variable in found.isel(part).data_vars.items():
        # another batch: the last bits of the stacked linear systems
        np.testing.assert_allclose(alone[name], variable, rtol=0, atol=1e-9, err_msg=name)


@pytest.mark.parametrize(
    "text",
    [
        '[model]\nbase = "auto"\nmicro = "power_law"\nn = 0.5\nNbar = 1e5\nRa = 1e-3\n'
        "[axes]\nP = [1e-6, 2e-6]\nh = [0.02]",
        '[model]\nbody = "steel 52100"\nR1 = "5 mm"\nR2 = "flat"\nmicro = "smooth"\nbase = "half_space"\n'
        '[axes]\nP = ["1 N", "2 N"]',
    ],
)
def test_of_a_results_file(tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(text + "\n[numerics]\nrtol = 1e-8\n")
    loaded = study.load(tmp_path / "mine.toml")
    loaded.run(workers=1, progress=False)
    with loaded.open() as results:
        mine = study.sensitivities(results)
    given = {"P": [1e-6, 2e-6], "h": [0.02], "n": 0.5, "Nbar": 1e5, "Ra": 1e-3, "base": "auto", "micro": "power_law"}
    if "R1" in mine.coords:
        given = {"body": "steel 52100", "R1": "5 mm", "R2": "flat", "micro": "smooth", "base": "half_space"}
        given |= {"P": ["1 N", "2 N"]}
    wanted = quiet(**given, rtol=1e-8, x=2, sensitivities=True, workers=1)
    assert mine.input.values.tolist() == wanted.input.values.tolist()
    for name, variable in mine.data_vars.items():
        np.testing.assert_array_equal(variable, wanted[name].transpose(*variable.dims), err_msg=name)


SHARED = {"P": 1e-5, "micro": "smooth", "x": 2, "workers": 1, "rtol": 1e-4, "Y1": 1e-3, "max_iterations": 50}
ONE = SHARED | {"h": 0.02, "n": 0.5, "nu1": 0.4, "nu2": 0.2}
PICARD = {"micro": "power_law", "Nbar": 1e5, "Ra": 1e-3, "nodes": 16, "scheme": "picard", "k": 2.0}
LAYERS = [{"h": 0.02, "n": [0.5, 0.8], "nu": 0.4, "profile": "linear", "bonding": "bonded"}, {"h": 0.02, "n": 0.7}]


@pytest.mark.parametrize(
    ("inputs", "more"),
    [
        (ONE, []),
        (ONE | {"bonding": "bonded"}, ["nu1", "nu2"]),
        (ONE | PICARD, ["Nbar", "Ra", "B", "beta"]),
        (
            SHARED | {"base": "thin_stack", "layers": LAYERS, "sublayers": 2},
            ["nu1", "nu2", "layers.1.n_bottom", "layers.2.h", "layers.2.n", "layers.2.nu"],
        ),
    ],
    ids=["frictionless", "bonded", "rough", "graded"],
)
def test_inputs_are_numbers_on_which_an_answer_depends(inputs, more):
    """No settings, no words, no strengths, and no Poisson ratio of a layer without friction."""
    assert study.sensitivities(quiet(**inputs)).input.values.tolist() == ["P", "h", "n", "m", *more]


def test_cases_without_a_layer():
    """The inputs of the layer are NaN there; the case is as if it stood alone, and the layer does not act."""
    shared = {"R": "5 mm", "E2": "210 GPa", "E_punch": "70 GPa", "micro": "smooth", "P": "1 N", "x": 2, "workers": 1}
    layer = {"E1": "2 GPa", "nu1": 0.4, "h": "100 um", "base": "layered"}
    both = study.sensitivities(quiet(cases=[{"base": "half_space"}, layer], **shared)).isel(case=0)
    alone = quiet(**shared, base="half_space", sensitivities=True)
    for name in ("a", "D", "p0"):
        mine = both[f"{name}_sensitivity"]
        assert (mine.sel(input=["E1", "nu1", "h"]) == 0).all()
        names = alone.input.values
        np.testing.assert_allclose(mine.sel(input=names), alone[f"{name}_sensitivity"], rtol=0, atol=1e-9)


def test_what_has_failed_or_was_not_run_is_nan():
    contact = study.solve(P=[1e-5, 2e-5], h=0.02, n=0.5, Nbar=1e5, Ra=1e-3, max_iterations=[0, 1], x=2, workers=1)
    assert ((contact.status == 0) == (contact.max_iterations == 0)).all() and contact.a.notnull().all()
    found = study.sensitivities(contact)
    for variable in found.data_vars.values():
        assert (variable.notnull() == (contact.status == 0)).all()
    partial = study.sensitivities(contact.assign(status=contact.status.where(contact.P > 1e-5, 127)))
    assert partial.a_sensitivity.sel(P=1e-5).isnull().all() and partial.a_sensitivity.sel(P=2e-5).notnull().any()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda contact: contact.a, "takes a dataset of study.solve"),
        (lambda contact: contact.isel(P=0, drop=True), "must have one of P, a and D"),
        (lambda contact: contact.drop_vars("micro"), "has no coordinate micro"),
        (study.readable, "needs all inputs in SI units"),
        (lambda contact: contact.drop_vars("R"), "needs all inputs in SI units"),
        (lambda contact: contact.assign_coords(micro="of_another"), 'micro = "of_another": no law of this name'),
    ],
)
def test_what_is_refused(contact, change, message):
    with pytest.raises(study.StudyError, match=message):
        study.sensitivities(change(contact))
