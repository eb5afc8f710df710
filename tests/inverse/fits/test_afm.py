"""The model file in nanite itself, and force curves in files of instruments, where nanite is installed (extra afm)."""

import copy
import sys
import warnings

import numpy as np
import pytest
from conftest import ROOT

import study
from solver import Problem, solve

nanite = pytest.importorskip("nanite", reason="pip install 'roughcoat[afm]'")
afmformats = pytest.importorskip("afmformats", reason="pip install 'roughcoat[afm]'")
FILE = ROOT / "study/inverse/nanite_layer.py"
GEL = {"R": 5e-6, "nu": 0.49, "h": 1.5e-6}


@pytest.fixture(scope="module")
def model():
    return nanite.model.load_model_from_file(FILE, register=True)


@pytest.fixture(scope="module")
def curve(tmp_path_factory):
    """A force curve of a bead on 1.5 µm of a gel of 5 kPa on glass, as an instrument would store it: exact layer."""
    tip = np.linspace(5e-7, -5e-7, 300)
    force = np.zeros(300)
    D, E = -tip[tip < 0] / GEL["R"], 5e3 / (1 - GEL["nu"] ** 2)
    layer = {"h": GEL["h"] / GEL["R"], "n": 0.0, "nu1": GEL["nu"], "bonding": "bonded", "micro": "smooth"}
    force[tip < 0] = solve(Problem.of(D=D, **layer, rtol=1e-9)).P * E * GEL["R"] ** 2
    height, segment = tip - force / 0.05, np.repeat(np.array([0, 1], np.uint8), 300)
    columns = {
        "force": np.concatenate([force, force[::-1]]),
        "height (measured)": np.concatenate([height, height[::-1]]),
    }
    columns |= {"time": np.arange(600) * 1e-3, "segment": segment}
    about = {"spring constant": 0.05, "imaging mode": "force-distance", "point count": 600, "enum": 0}
    path = tmp_path_factory.mktemp("afm") / "curve.h5"
    about |= {"path": path, "format": "made", "software": "made"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data = afmformats.mod_force_distance.AFMForceDistance(columns, afmformats.meta.MetaData(about))
        data.export_data(path, fmt="hdf5")
    return path


def fitted(curve, key: str, **known) -> float:
    """Young's modulus that nanite fits."""
    indentation = nanite.load_group(curve)[0]
    indentation.apply_preprocessing(["compute_tip_position"])
    parameters = nanite.model.models_available[key].module.get_parameter_defaults()
    for name, value in known.items():
        parameters[name].value = value
    indentation.fit_model(model_key=key, params_initial=parameters, range_x=(0, 0), weight_cp=False)
    return indentation.fit_properties["params_fitted"]["E"].value


@pytest.mark.filterwarnings("ignore")
def test_nanite_finds_the_gel_that_hertz_takes_for_a_stiff_one(model, curve):
    assert model.model_key == "roughcoat_layer"
    assert fitted(curve, "roughcoat_layer", **GEL) == pytest.approx(5e3, rel=1e-4)
    hertz = fitted(curve, "hertz_para", R=GEL["R"], nu=GEL["nu"])
    assert hertz > 4 * 5e3, "the base under the gel makes Hertz's modulus several times too large"


def test_nanite_moves_the_modulus_and_the_offsets_within_what_the_model_has(model):
    """Lengths, the ratio and the modulus of a body are not below 0; an offset may be anything."""
    parameters = model.module.get_parameter_defaults()
    assert list(parameters) == model.module.parameter_keys
    assert [name for name in parameters if parameters[name].vary] == ["E", "contact_point", "baseline"]
    bounds = {name: (parameter.min, parameter.max) for name, parameter in parameters.items()}
    assert bounds.pop("nu") == (0, 0.5)
    assert bounds.pop("h") == (1e-12, np.inf)  # above 0: of no layer at all there is no force
    assert bounds.pop("E") == bounds.pop("R") == (0, np.inf)
    assert set(bounds.values()) == {(-np.inf, np.inf)}
    values = parameters.valuesdict()
    assert values["contact_point"] == values["baseline"] == 0
    assert values["E"] > 0 and 0.4 < values["nu"] < 0.5 and 1e-7 < values["h"] < values["R"] < 1e-4  # a bead on a gel


@pytest.mark.filterwarnings("ignore")
def test_nanite_fits_again_only_with_parameters_of_their_own(model, curve):
    """What docs/afm.md says: one object that is edited gets the old modulus, as nanite compares it with itself."""
    indentation = nanite.load_group(curve)[0]
    indentation.apply_preprocessing(["compute_tip_position"])

    def modulus(parameters):
        indentation.fit_model(model_key="roughcoat_layer", params_initial=parameters, range_x=(0, 0), weight_cp=False)
        return indentation.fit_properties["params_fitted"]["E"].value

    def parameters(h):
        made = model.module.get_parameter_defaults()
        for name, value in (GEL | {"h": h}).items():
            made[name].value = value
        return made

    kept = parameters(1.5e-6)
    assert modulus(kept) == pytest.approx(5e3, rel=1e-4)
    assert modulus(parameters(2e-6)) == pytest.approx(8.1e3, rel=0.02)
    first = modulus(kept)
    kept["h"].value = 3e-6
    assert modulus(kept) == first, "with h = 3 um: nanite fits edited parameters again, docs/afm.md says it does not"
    assert modulus(copy.deepcopy(kept)) == first, "nor their copy, since the object it has kept is edited too"


def test_nanite_s_own_layer_wants_the_reduced_modulus():
    """What docs/afm.md says: with the layer endlessly thick it is Hertz with E_L in place of E/(1 - nu²)."""
    tip = np.linspace(0, -5e-7, 20)
    layer = nanite.model.models_available["power_layer_clifford_2009"].module.power_layer_clifford_2009
    hertz = nanite.model.models_available["hertz_para"].module.hertz_paraboloidal
    forces = layer(tip, 1e3, 5e3 / (1 - 0.49**2), 5e-6, 0.49, 0.49, 1.0), hertz(tip, 5e3, 5e-6, 0.49)
    np.testing.assert_allclose(*forces, rtol=1e-3)


def test_on_a_thick_layer_it_is_hertz(model):
    tip = np.linspace(1e-7, -5e-7, 50)
    thick = model.module.model_func(tip, 5e3, 5e-6, 0.49, 1.0)  # h = 1 m
    hertz = 4 / 3 * 5e3 / (1 - 0.49**2) * np.sqrt(5e-6) * np.maximum(-tip, 0) ** 1.5
    np.testing.assert_allclose(
        thick, hertz, rtol=2e-3, atol=0, err_msg="P/Hertz - 1 = 1.1 a/h, of the table at least 1e-3"
    )


@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_the_table_is_that_of_the_solver(model, nu):
    u = np.random.default_rng(0).uniform(np.log(1e-6), np.log(1e4), 100)
    D, h = np.exp(u) * 1e-8, 1e-4
    exact = solve(Problem.of(D=D, h=h, n=0.0, nu1=nu, bonding="bonded", micro="smooth", rtol=1e-9)).P
    assert np.isfinite(exact).all()
    table = sys.modules["nanite_layer"]._table(nu)
    np.testing.assert_allclose(4 / 3 * D**1.5 * np.exp(table(u)), exact, rtol=1e-6)


@pytest.mark.filterwarnings("ignore")
def test_curves_of_an_instrument(curve):
    curves = study.curves(curve)
    assert curves.D.shape == (1, 300) and curves.D.attrs["units"] == "m"
    np.testing.assert_allclose(curves.D.values[0, [0, -1]], [-5e-7, 5e-7], rtol=1e-6)
    bead = {"R": "5 um", "punch": "rigid", "nu1": 0.49, "h": "1.5 um", "E2": "rigid", "bonding": "bonded"}
    answer = study.fit(curve, **bead, micro="smooth", free=["E1"], progress=False)
    assert answer.E1.item() == pytest.approx(5e3, rel=1e-4)
