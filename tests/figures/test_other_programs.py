"""netCDF files of other programs, in which there may be anything: what can be drawn is, the rest is named."""

import netCDF4
import numpy as np
import pytest

import study
from study.__main__ import main


def _enum(file) -> None:
    kinds = file.createEnumType("i1", "kinds", {"one": 1, "two": 2})  # 0, the fill value, is none of them
    file.createVariable("z", kinds, ("P",))


def _compound(file) -> None:
    pair = np.dtype([("a", "f8"), ("b", "i4")])
    file.createVariable("z", file.createCompoundType(pair, "pair"), ("P",))[:] = np.zeros(3, pair)


def _lists(file) -> None:
    variable = file.createVariable("z", file.createVLType(np.int32, "list"), ("P",))
    for i in range(3):
        variable[i] = np.arange(i + 1, dtype=np.int32)


def _characters(file) -> None:
    file.createVariable("z", "S1", ("P",))


def _texts(file) -> None:
    file.createVariable("z", str, ("P",))


def _dates(file) -> None:
    variable = file.createVariable("z", "f8", ("P",))
    variable.units, variable[:] = "days since 2000-01-01", [1, 2, 3]


def _square(file) -> None:
    file.createVariable("z", "f8", ("P", "P"))[:] = 1


def _sparse(file) -> None:
    file.createDimension("t", 2_000_000_000)
    file.createVariable("z", "f8", ("t",), chunksizes=(1000,))
    file.createVariable("t", "f8", ("t",), chunksizes=(1000,))


def _attributes(file) -> None:
    file["P"].units, file["P"].long_name, file["y"].units = np.array([1.0, 2.0]), 5, 3
    file["y"].setncattr("scale", 7)
    file.micro_laws, file.title = np.array([1, 2]), 5
    file.createVariable("z", "f8", ("P",))[:] = [1, 2, 3]


def _words_of_ours(file) -> None:
    for name in ("validity", "y_spread", "status"):
        file.createVariable(name, str, ("P",))
    file.createVariable("z", "f8", ("P",))[:] = [1, 2, 3]


#: What the file has -> how the message of `plot` begins for its variable z, "" where it is drawn.
FILES = {
    _enum: "",
    _compound: "z has compound values: they are not drawn",
    _lists: "z has lists or other objects: they are not drawn",
    _characters: "z has bytes: they are not drawn",
    _texts: "z has texts: they are not drawn, but may be the hue",
    _dates: "z has dates: they are not drawn",
    _square: "z has a dimension twice: it is not drawn",
    _sparse: "z against P has 6000000000 points, of P (3), t (2000000000): at most 20000000",
    _attributes: "",
    _words_of_ours: "",
}


def _written(path, add) -> None:
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("P", 3)
        for name in ("P", "y"):
            file.createVariable(name, "f8", ("P",))[:] = [1, 2, 3]
        add(file)


@pytest.mark.filterwarnings("ignore:Duplicate dimension names")  # of xarray, which draws no variable of this kind
@pytest.mark.parametrize("add", FILES, ids=lambda add: add.__name__)
def test_what_can_be_drawn_is_drawn(add, tmp_path, monkeypatch, capsys):
    """Each but a few ended in a traceback, or in dask graphs of two million chunks."""
    monkeypatch.chdir(tmp_path)
    _written(tmp_path / "a.nc", add)
    assert main(["plot", "a.nc", "--x", "P", "--y", "y"]) == 0
    assert main(["plot", "a.nc", "--x", "P", "--y", "z"]) == (2 if FILES[add] else 0)
    assert capsys.readouterr().err.strip() == FILES[add]
    assert (tmp_path / "figures" / "a_z.png").exists() == (not FILES[add])


def test_units_that_xarray_cannot_decode(tmp_path, capsys):
    _written(tmp_path / "a.nc", _dates)
    with netCDF4.Dataset(tmp_path / "a.nc", "a") as file:
        file["z"].units = "days since nonsense"
    assert main(["plot", str(tmp_path / "a.nc"), "--x", "P", "--y", "y"]) == 2
    said = capsys.readouterr().err
    assert "a.nc: is a netCDF file of another program, which xarray cannot read: unable to decode time" in said
    assert len(said.splitlines()) == 1
    with pytest.raises(study.StudyError, match="which xarray cannot read"):
        study.open_results(tmp_path / "a.nc")


def test_a_large_file_of_another_program_has_indexes_and_is_not_read(tmp_path):
    """By its size in memory: nearly all of this file was never written."""
    _written(tmp_path / "a.nc", _sparse)
    assert (tmp_path / "a.nc").stat().st_size < 100_000
    found = study.open_results(tmp_path / "a.nc")
    assert found.sizes["t"] == 2_000_000_000 and "t" not in found.indexes
    assert float(found.y.sel(P=2.0)) == 2.0
    assert found.z[-1].item() == netCDF4.default_fillvals["f8"]
    found.close()


def test_anything_else_that_fails_is_said_in_a_line(tmp_path, monkeypatch, capsys):
    _written(tmp_path / "a.nc", _characters)

    def fails(*_, **__):
        raise RuntimeError("what it is")

    monkeypatch.setattr("study.figures.plots.shaped", fails)
    assert main(["plot", str(tmp_path / "a.nc"), "--x", "P", "--y", "y"]) == 1
    said = f"{tmp_path / 'a.nc'}: cannot be drawn: RuntimeError: what it is; -v before the command shows where\n"
    assert capsys.readouterr().err == said
