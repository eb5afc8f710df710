"""A dataset in a file and back: nothing is lost, attributes and flags follow CF, interrupts wait."""

import copy
import pickle
import signal
import threading

import numpy as np
import pytest
import xarray as xr

import study
from solver import Status
from study.arrays.labelled import Labelled
from study.data import dataset
from study.files import access, results_file
from study.files.examine import examine
from study.inputs.vocabulary import NOT_RUN, PARAMETERS, attributes

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
    results_file.write(solved, path, examine(path))
    return study.open_results(path)


def test_nothing_is_lost_in_the_file(solved, reread):
    xr.testing.assert_identical(solved.drop_vars("label"), reread.drop_vars("label"))
    assert reread.label.values.tolist() == ["smooth", "layer"]
    for name in (*solved.coords, *solved.data_vars):
        assert solved[name].dtype.kind == reread[name].dtype.kind or solved[name].dtype.kind == "U"


def test_results_of_a_file_go_before_those_of_solve(tmp_path):
    """In this order `xr.concat` raised: the labels stood behind the settings, which `study.solve` has as attributes."""
    shared = {"base": "half_space", "micro": "smooth"}
    (tmp_path / "one.toml").write_text(
        '[model]\nbase = "half_space"\nmicro = "smooth"\n[[cases]]\nlabel = "a"\nP = 1e-5\n'
    )
    one = study.load(tmp_path / "one.toml", tmp_path)
    one.run(workers=1)
    both = [one.open(), study.solve(cases=[{"label": "b", "P": 2e-5}], **shared)]
    for order in (both, both[::-1]):
        joined = xr.concat(order, "origin")
        assert joined.label.values.tolist() == [[found.label.item()] for found in order]


def test_plain_xarray_opens_it(reread, tmp_path):
    results_file.write(reread, tmp_path / "again.nc", examine(tmp_path / "again.nc"))
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
        "long_name": "real pressure in the middle of the central spot, pmax/E2*",
        "symbol": "pmax",
        "scale": "E2*",
        "equation": "(13)",
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
    with pytest.raises(KeyboardInterrupt), access.interrupts_wait():
        signal.raise_signal(signal.SIGINT)
        reached.append("end of the block")
    assert reached
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


@pytest.mark.usefixtures("interruptible")
def test_an_interrupted_write_is_finished_first(reread, monkeypatch, tmp_path):
    ended, real = [], results_file.stored

    class Interrupting:
        """Values that netCDF asks for while it writes."""

        def __array__(self, dtype=None, copy=None):
            signal.raise_signal(signal.SIGINT)
            ended.append("written")
            return reread.a.values

    monkeypatch.setattr(results_file, "stored", lambda array: Interrupting() if array.name == "a" else real(array))
    with pytest.raises(KeyboardInterrupt):
        results_file.write(reread, tmp_path / "file.nc", examine(tmp_path / "file.nc"))
    assert ended and list(tmp_path.iterdir()) == []


def test_vocabulary_names_every_parameter_of_the_solver():
    from solver.known import PARAMETERS as OF_THE_SOLVER
    from solver.parameters import CONTROL

    assert set(CONTROL) | (set(OF_THE_SOLVER) - {"R", "E2"}) == set(PARAMETERS)


def test_cases_without_a_solution_have_not_failed():
    """The model says so of them: `--fail-fast` goes on."""
    status = np.array([0, Status.THIN_LAYER_NOT_APPLICABLE, Status.DIVERGED, 0, Status.LIFT_OFF, Status.INVALID_INPUT])
    assert dataset.failed_cases(status).tolist() == [2, 5]


def test_arrays_with_names_are_copied_and_sent_to_processes():
    """Before there is a dataset; what is asked of a copy that has no array yet is not asked of xarray."""
    array = Labelled(("h", "x"), np.arange(6.0).reshape(2, 3), {"units": "m"}, {"dtype": "f4"})
    for twin in (copy.copy(array), copy.deepcopy(array), pickle.loads(pickle.dumps(array))):
        assert (twin.dims, twin.attrs, twin.encoding) == (array.dims, array.attrs, array.encoding)
        assert (twin.data == array.data).all()
    assert array.mean().item() == 2.5 and not hasattr(array, "_nothing_of_xarray")


def test_an_interrupt_while_another_thread_has_netcdf_leaves_the_lock_free(monkeypatch):
    """Of xarray, which reads a lazily opened file under this lock alone."""
    lock = access.Access("file.nc")

    class Interrupted:
        def acquire(self, blocking):
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(access, "NETCDF4_PYTHON_LOCK", Interrupted())
        with pytest.raises(KeyboardInterrupt):
            lock.acquire()
    taken = []
    thread = threading.Thread(target=lambda: taken.append(lock.acquire(blocking=False)) or lock.release())
    thread.start()
    thread.join()
    assert taken == [True] and access.Access._depth == 0
