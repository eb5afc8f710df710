"""Results in other programs: what makes Octave, CDO, kerchunk, virtualizarr and SQL stumble is not in the files."""

import re

import netCDF4
import numpy as np
import pytest
import xarray as xr
from conftest import ROOT

import study
from study.data.frames import frames
from study.files import netcdf

BALL = {"R": "5 mm", "E1": "2 MPa", "nu1": 0.4, "h": "1 mm", "E2": "70 GPa", "nu2": 0.2, "punch": "rigid"}
BALL |= {"Nbar": "100 1/mm^2", "Ra": "20 um", "bonding": ["bonded", "frictionless"]}
ATTRIBUTES = {"long_name": "relative contact area, λ(r)", "symbol": "N̄", "plain": "a/R", "empty": ""}
PURE = {"h": 0.02, "n": 0.5, "Nbar": 250_000, "Ra": 0.004, "bonding": ["bonded", "frictionless"]}


def test_texts_of_attributes_are_characters(tmp_path):
    """They are read as they were; h5py, where it is there, sees that none is a string of variable length."""
    attributes = {
        "long_name": "relative contact area, λ(r)",
        "symbol": "N̄",
        "plain": "a/R",
        "empty": "",
        "masks": [1, 2],
    }
    kinds = {name: type(value) for name, value in netcdf._as_characters(attributes).items()}
    assert kinds == {"long_name": bytes, "symbol": bytes, "plain": str, "empty": str, "masks": list}
    with netcdf.File(tmp_path / "texts.nc", "w") as file:
        file.define({}, {"title": "ν₁"})
        file.add("lam", "f8", (), ATTRIBUTES, {})
    with netCDF4.Dataset(tmp_path / "texts.nc") as file:
        assert file.title == "ν₁"
        assert {name: file["lam"].getncattr(name) for name in ATTRIBUTES} == ATTRIBUTES


def test_no_attribute_is_a_string_of_variable_length(tmp_path):
    """netCDF4 does not tell one from the other; HDF5 does."""
    h5py = pytest.importorskip("h5py")
    with netcdf.File(tmp_path / "texts.nc", "w") as file:
        file.add("lam", "f8", (), ATTRIBUTES, {})
    with h5py.File(tmp_path / "texts.nc") as file:
        kinds = [file["lam"].attrs.get_id(name).dtype.kind for name in ("long_name", "symbol", "plain")]
        assert kinds == ["S", "S", "S"]


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
@pytest.mark.parametrize("given", [BALL | {"P": ["1 mN", "2 mN"]}, PURE | {"P": [1e-5, 2e-5]}], ids=["SI", "pure"])
def test_headings_differ_without_regard_to_case(given):
    """SQL takes P and p for one name: of a load and a pressure the units differ."""
    for table in frames(study.solve(**given, x=3)).values():
        names = [name.lower() for name in table.columns]
        assert len({*names}) == len(names), sorted(names)


def test_what_the_page_advises_makes_no_axis_of_texts_and_no_string(tmp_path, monkeypatch):
    """The same numbers and texts; the text of an axis lies beside it."""
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs/other_programs.md").read_text(encoding="utf-8")
    names = {}
    exec(re.search(r"```python\n(.*?)```", page, re.DOTALL).group(1), names)
    contacts, plain = names["contacts"], xr.open_dataset("plain.nc")
    with netCDF4.Dataset("plain.nc") as file:
        assert all(variable.dtype is not str for variable in file.variables.values())
        assert all(variable.ndim < 2 or name not in variable.dimensions for name, variable in file.variables.items())
    np.testing.assert_array_equal(plain.a.values, contacts.a.values)
    assert plain.bonding.values.tolist() == contacts.bonding.values.tolist()
    assert plain.lam.attrs["long_name"] == contacts.lam.attrs["long_name"]
    plain.close()
