"""What asperities press on, in calls and study files: refusals, what results say, chunks, spreads, keys."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import study
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables

CASE = {"P": [1e-5, 4e-5], "h": [0.001, 0.02], "n": 5.0, "Nbar": 250000.0, "Ra": 0.004, "bonding": "bonded"}
PHYSICAL = {"R": "5 mm", "punch": "rigid", "E1": "200 ± 16 GPa", "nu1": 0.25, "E2": "70 GPa", "nu2": 0.3, "P": "2 N"}
PHYSICAL |= {"bonding": "bonded", "Nbar": "0.04 1/um^2", "Ra": "20 um", "h": "1.0 ± 0.1 um"}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"micro": "smooth", "asperities_on": "layer"},
            '"layer" is given with micro = "smooth", which has no asperities',
        ),
        ({"micro": "smooth", "asperities_on": "half_space"}, '"half_space" is given with micro = "smooth"'),
        ({"micro": "power_law", "asperities_on": "layer"}, 'micro = "power_law", whose A[p] is given'),
        ({"micro": ["disc_cell", "smooth"], "asperities_on": "layer"}, '"layer" is given with micro = "smooth"'),
        (
            {"base": "thin_layer", "n": 0.5, "asperities_on": "layer"},
            'with base = "thin_layer", on which they press on',
        ),
        ({"base": ["layered", "half_space"], "asperities_on": "layer"}, 'with base = "half_space"'),
        ({"asperities_on": "body"}, 'asperities_on = "body": must be one of "auto", "layer", "half_space"'),
    ],
    ids=lambda value: " ".join(map(str, value.values())) if isinstance(value, dict) else "",
)
def test_refusals(given, message):
    """One message: the key, its value, and what is allowed; the same of a file."""
    with pytest.raises(study.StudyError) as raised:
        study.solve(**CASE | given)
    (text,) = raised.value.messages
    assert message in text and text.startswith("solve: asperities_on = ")
    assert "must be" in text or "take" in text
    axes = {name: value for name, value in (CASE | given).items() if isinstance(value, list)}
    model = {name: value for name, value in (CASE | given).items() if name not in axes}
    with pytest.raises(study.StudyError) as raised:
        from_tables({"model": model, "axes": axes}, "mine", "", "mine.toml")
    assert raised.value.messages == (text.replace("solve: ", "mine.toml: "),)


def test_laws_without_asperities_ignore_auto_and_stand_beside_others():
    rows = {"micro": ["disc_cell", "smooth", "power_law"], "asperities_on": ["auto", "half_space"]}
    found = study.solve(**CASE | rows, x=2)
    used = study.decode(found.asperities_used).sel(P=1e-5)
    assert used.sel(h=0.001, asperities_on="auto").values.tolist() == ["layer", "none", "half_space"]
    assert (used.sel(h=0.02) == used.sel(h=0.001, asperities_on="half_space")).all()


def test_results_say_it_only_where_it_may_differ():
    """A study that names nothing and has no pitch above h has the variables that it had."""
    close, far = (study.solve(**CASE | {"h": h}, x=2) for h in (0.02, 0.001))
    assert "asperities_used" not in close and "asperities_on" not in close.coords
    assert far.asperities_used.dtype == np.int8 and (far.asperities_used == 2).all()
    assert far.asperities_used.attrs["flag_meanings"] == "none half_space layer" and "asperities_on" not in far.coords
    named = study.solve(**CASE | {"h": 0.02}, asperities_on="auto", x=2)
    assert named.asperities_on == "auto" and (named.asperities_used == 1).all()
    for name in close.data_vars:
        assert_array_equal(named[name], close[name], name)


def test_chunks_have_the_same():
    """Also the chunk in which none feels the layer."""
    whole, lazy = study.solve(**CASE, x=2), study.solve(**CASE, x=2, chunks={"h": 1})
    computed = lazy.compute()
    for name in ("asperities_used", "p_max", "validity"):
        assert_allclose(computed[name], whole[name], rtol=1e-11, err_msg=name)
    assert_allclose(study.derived.peak_pressure(computed), study.derived.peak_pressure(whole), rtol=1e-11)


def test_keys():
    """Cases with a pitch above h have keys of their own version, on exact layers and auto; others those that they had.
    What is named counts, but for "auto"."""

    def keys(**given):
        model = {"P": 1e-5} | {name: value for name, value in CASE.items() if name not in ("P", "h")} | given
        return tuple(case_keys(from_tables({"model": model}, "s", "", "s").grid)[0].tolist())

    far, close = keys(h=0.001), keys(h=0.02)
    assert far == keys(h=0.001, asperities_on="auto") and close == keys(h=0.02, asperities_on="auto")
    assert len({far, keys(h=0.001, asperities_on="half_space"), keys(h=0.001, asperities_on="layer")}) == 3
    assert close == (2531940216230990244, 4794406287168177999), "as it was before asperities could feel the layer"
    assert keys(h=0.001, base="auto") != far


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_spreads_and_peaks_are_those_of_the_layer():
    """± by derivatives of contacts that feel the layer: those of moved inputs. The largest pressure is of its law."""
    found = study.solve(**PHYSICAL, x=5)
    moved = [study.solve(**PHYSICAL | {"h": f"{h} um", "E1": f"{E1} GPa"}, x=2) for h, E1 in ((1.05, 200), (1, 208))]
    changes = [float(np.log(one.p_max / found.p_max)) * 2 for one in moved]  # h by 0.1, E1 by 16: twice as much
    assert float(found.p_max_spread / found.p_max) == pytest.approx(np.hypot(*changes), rel=0.05)
    assert_allclose(study.derived.peak_pressure(found), found.p_max, rtol=1e-12)
    assert "which press on the coated body itself" in study.summary(found)


def test_what_is_outside_of_the_law_has_its_reason():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        soft = study.solve(**PHYSICAL | {"E1": "0.5 GPa", "nu1": 0.46, "P": "5 N"}, x=2)
    (text,) = (str(one.message) for one in caught if "hex_lattice" in str(one.message))
    assert soft.status == 10 and "On a layer this soft the disc cell fails where spots cover more than 0." in text
    assert text.splitlines()[-1] in study.summary(soft)
