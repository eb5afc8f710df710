"""What a results file says about itself, and the quantities derived from it."""

import json
import signal
import subprocess

import numpy as np
import pytest
import xarray as xr

import study
from solver import Model
from study import dataset, derived
from study.vocabulary import NOT_RUN, PARAMETERS, VOCABULARY, attributes

CASES = [
    {"label": "smooth", "P": 1e-5, "micro": "smooth", "base": "half_space"},
    {"label": "layer", "P": 2e-5, "h": 0.02, "n": 0.5, "Nbar": 250000, "Ra": 0.004},
]


@pytest.fixture(scope="module")
def solved() -> xr.Dataset:
    return study.solve(cases=CASES, bonding=["frictionless", "bonded"], x=5)


@pytest.fixture(scope="module")
def reread(solved, tmp_path_factory) -> xr.Dataset:
    path = tmp_path_factory.mktemp("results") / "file.nc"
    dataset.write(solved, path)
    return study.open_results(path)


def test_nothing_is_lost_in_the_file(solved, reread):
    xr.testing.assert_identical(solved.drop_vars("label"), reread.drop_vars("label"))
    assert reread.label.values.tolist() == ["smooth", "layer"]
    for name in (*solved.coords, *solved.data_vars):
        assert solved[name].dtype.kind == reread[name].dtype.kind or solved[name].dtype.kind == "U"


def test_plain_xarray_opens_it(reread, tmp_path):
    dataset.write(reread, tmp_path / "again.nc")
    with xr.open_dataset(tmp_path / "again.nc") as plain:
        assert plain.sel(bonding="bonded").sizes == {"case": 2, "x": 5}
        assert plain.status.dtype == np.int8
        assert plain.validity.dtype == np.int32
        assert plain.nodes.dtype.kind == plain.iterations.dtype.kind == plain.nodes_used.dtype.kind == "i"
        assert "_FillValue" not in plain.status.encoding
        assert not [name for name in plain.coords if "_FillValue" in plain[name].encoding]


def test_every_variable_has_its_attributes(reread):
    for name, variable in reread.variables.items():
        expected = attributes(name)
        assert expected["long_name"]
        assert {key: variable.attrs[key] for key in expected} == expected, name
        assert name.isascii()
    assert reread.P.attrs["scale"] == "E2* R^2"
    assert reread.Nbar.attrs["scale"] == "R^-2"
    assert reread.p_max.attrs == {
        "long_name": VOCABULARY["p_max"].long_name,
        "symbol": "pmax",
        "scale": "E2*",
        "equation": "(13)",
        "units": "1",
    }
    assert "units" not in reread.bonding.attrs


def test_flags_follow_cf(reread):
    for name in ("status", "model_used", "validity"):
        array = reread[name]
        values = array.attrs["flag_masks" if name == "validity" else "flag_values"]
        assert values.dtype == array.dtype
        assert len(set(array.flag_meanings.split())) == len(values) == len(set(values.tolist()))
    assert (
        dict(zip(reread.status.flag_values.tolist(), reread.status.flag_meanings.split(), strict=True))[NOT_RUN]
        == "not_run"
    )
    assert f"{NOT_RUN}: the case has not been computed" in reread.status.comment


def test_provenance(reread):
    found = reread.attrs
    assert found["Conventions"] == "CF-1.11"
    assert "10.3390/lubricants12030068" in found["references"]
    assert len(found["study_digest"]) == 64
    assert set(json.loads(found["versions"])) == {"python", "numpy", "scipy", "xarray", "dask", "netCDF4"}
    assert json.loads(found["versions"])["numpy"] == np.__version__
    assert np.datetime64(found["created"].removesuffix("+00:00")) <= np.datetime64("now")
    assert all(
        found[name] for name in ("source", "history", "command", "git_commit", "cpu", "blas", "numerics_version")
    )
    assert all(isinstance(text, str) for text in found.values())


@pytest.fixture
def interruptible():
    """Ctrl-C interrupts, also where the tests run in the background and ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_waits_until_netcdf_is_done():
    """An exception inside xarray's locks would leave one locked, and the next access would hang."""
    reached = []
    with pytest.raises(KeyboardInterrupt), dataset.interrupts_wait():
        signal.raise_signal(signal.SIGINT)
        reached.append("end of the block")
    assert reached
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


@pytest.mark.usefixtures("interruptible")
def test_an_interrupted_write_is_finished_first(reread, monkeypatch, tmp_path):
    real = xr.Dataset.to_netcdf

    def to_netcdf(self, *arguments, **options):
        signal.raise_signal(signal.SIGINT)
        return real(self, *arguments, **options)

    monkeypatch.setattr(xr.Dataset, "to_netcdf", to_netcdf)
    with pytest.raises(KeyboardInterrupt):
        dataset.write(reread, tmp_path / "file.nc")
    assert list(tmp_path.iterdir()) == []


def test_commit_is_unknown_outside_a_checkout(monkeypatch, tmp_path):
    """Also when the environment lies inside somebody else's repository."""
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    (tmp_path / "site-packages").mkdir()
    who = ["-c", "user.name=n", "-c", "user.email=e"]
    subprocess.run(["git", "-C", tmp_path, *who, "commit", "-q", "--allow-empty", "-m", "x"], check=True)
    monkeypatch.setattr(dataset, "__file__", str(tmp_path / "site-packages" / "study" / "dataset.py"))
    assert dataset.git_commit() == "unknown"
    monkeypatch.setattr(dataset, "__file__", str(tmp_path / "study" / "dataset.py"))
    assert len(dataset.git_commit()) == 40


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        ("/home/someone/lib/study/__main__.py", "python -m study run 'a b.toml'"),
        ("/usr/bin/tool", "tool run 'a b.toml'"),
    ],
)
def test_command_line_without_machine_paths(monkeypatch, program, expected):
    monkeypatch.setattr(dataset.sys, "argv", [program, "run", "a b.toml"])
    assert dataset.command_line() == expected


def made(**variables) -> xr.Dataset:
    """A dataset of one case as the results of a solver would give it, to set single quantities at will."""
    given = {
        "base": "thin_layer",
        "micro": "disc_cell",
        "P": 2.0,
        "Nbar": 1e6,
        "h": 0.01,
        "n": 0.5,
        "a": 0.02,
        "D": 3e-4,
        "p0": 0.01,
        "lam0": 0.2,
        "model_error": 0.05,
    }
    given |= {"status": np.int8(0), "model_used": np.int8(Model.THIN_LAYER)} | variables
    made = xr.Dataset({name: ((), value) for name, value in given.items() if value is not None})
    made["model_used"].attrs = dataset.model_attributes()
    return made


EXACT = {"model_used": np.int8(Model.LAYERED), "model_error": 0.0}


@pytest.mark.parametrize(
    ("variables", "expected"),
    [
        ({}, 0),
        ({"model_error": 0.101}, 1),
        ({"model_error": 0.099, "h": 0.02}, 0),
        ({"model_error": 0.2, "base": "auto"}, 1),
        ({"model_error": 0.2, "base": "auto", "micro": "smooth", "model_used": np.int8(Model.SMOOTH_THIN_LAYER)}, 1),
        ({"model_error": 0.2, "base": "auto", "model_used": np.int8(Model.LAYER_ALONE)}, 0),
        ({"Nbar": 99 / (np.pi * 0.02**2), "lam0": 1e-3}, 2),
        ({"Nbar": 101 / (np.pi * 0.02**2), "lam0": 1e-3}, 0),
        ({"lam0": 0.4, "Nbar": 0.99e4 * 0.4 / np.pi, "a": 0.19, "h": 0.1}, 4),
        ({"lam0": 0.4, "Nbar": 1.01e4 * 0.4 / np.pi, "a": 0.19, "h": 0.1}, 0),
        ({"n": 1.0}, 8),
        ({"n": 1.0, "base": "auto"}, 0),
        ({"n": 1.0, "model_error": 0.3, "Nbar": 1.0, "lam0": 0.5, "a": 0.3}, 1 | 2 | 4 | 8 | 16 | 32),
        ({"lam0": 0.401}, 16),
        ({"lam0": 0.399}, 0),
        ({"lam0": 1.0, "micro": "smooth"}, 0),
        ({"a": 0.201}, 32),
        ({"a": 0.199}, 0),
        ({"D": 1.1e-3, "p0": 0.051}, 32),
        ({"D": 1.1e-3, "p0": 0.049}, 0),
        ({"D": 0.9e-3, "p0": 0.051}, 0),
        ({"D": 1.1e-3, "p0": 0.051, "base": "half_space", "model_used": np.int8(Model.HALF_SPACE)}, 0),
        ({"n": 0.999}, 0),
        ({"base": "layered", "n": 1.0, "h": 0.03, **EXACT}, 0),
        ({"base": "layered", "Nbar": 1.0, **EXACT}, 2 | 4),
        ({"base": "half_space", "h": 0.001, "n": 2.0, **EXACT}, 0),
        ({"base": "half_space", "h": None, "n": None, **EXACT}, 0),
        ({"micro": "smooth", "Nbar": 1.0}, 0),
        ({"micro": "smooth", "Nbar": None}, 0),
        ({"a": np.nan, "lam0": np.nan, "model_error": np.nan, "n": 2.0, "status": np.int8(3)}, 8),
    ],
    ids=str,
)
def test_validity(variables, expected):
    found = derived.validity(made(**variables))
    assert found.item() == expected
    assert found.dtype == np.int32


def test_validity_has_the_dimensions_of_status():
    given = {"P": 1e-5, "Nbar": [250000, 1e4], "h": [0.1, 0.001], "n": 0.5, "Ra": 0.004, "base": "thin_layer"}
    found = study.solve(**given, bonding=["frictionless", "bonded"])
    assert found.validity.dims == found.status.dims == ("Nbar", "h", "bonding")
    assert ((found.validity & 1).values == np.reshape([1, 0], (1, 2, 1))).all()
    assert ((found.validity & 2).values == np.reshape([0, 2], (2, 1, 1))).all()


def test_derived_quantities(reread):
    np.testing.assert_allclose(derived.nominal_area(made()), np.pi * 4e-4, rtol=1e-14, atol=0)
    np.testing.assert_allclose(derived.nominal_area_ratio(made(), 0.04), 0.25, rtol=1e-14, atol=0)
    np.testing.assert_allclose(derived.mean_pressure(made()), 2 / (np.pi * 4e-4), rtol=1e-14, atol=0)
    np.testing.assert_allclose(derived.number_of_spots(made()), np.pi * 400, rtol=1e-14, atol=0)
    np.testing.assert_allclose(derived.spot_radius(made()) ** 2 * np.pi * 1e6, 0.2, rtol=1e-14, atol=0)
    assert np.isnan(derived.number_of_spots(reread).sel(case=0)).all()
    for function in (derived.nominal_area, derived.mean_pressure, derived.number_of_spots, derived.spot_radius):
        array = function(reread)
        assert array.attrs == attributes(array.name)
        assert array.attrs["units"] == "1"


def test_derived_quantities_refuse_physical_units(reread):
    with pytest.raises(ValueError, match="derive first, then convert"):
        derived.mean_pressure(study.to_physical(reread, R=0.01, E2_star=1e11))


def test_the_exact_layer_is_the_default_and_has_no_assumption_of_thinness():
    given = {"P": 1e-5, "Nbar": 250000, "Ra": 0.004, "bonding": "bonded", "nu1": 0.5}
    found = study.solve(**given, h=[0.01, 1.0], n=[0.5, 100.0], x=3)
    assert found.base.item() == "layered"
    assert (found.status == 0).all() and ((found.validity & 9) == 0).all()
    thin = study.solve(**given, h=0.01, n=0.5, base="thin_layer")
    assert thin.status.item() == 4, "the thin-layer equation does not apply to bonded rubber"


def test_vocabulary_names_every_parameter_of_the_solver():
    from solver.equation import CONTROLS
    from solver.parameters import PARAMETERS as OF_THE_SOLVER

    assert set(CONTROLS) | (set(OF_THE_SOLVER) - {"R", "E2"}) == set(PARAMETERS)
