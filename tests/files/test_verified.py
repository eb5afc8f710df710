"""Results files that can be verified: what is damaged is named, computed again, and never given out as right."""

import os
import shutil
import subprocess
import sys

import netCDF4
import numpy as np
import pytest
import xarray as xr
from conftest import ROOT
from line_study import load
from same import assert_same

import study
from study.__main__ import main
from study.files import checksums, results_file
from study.files.checksums import CaseDigests
from study.files.examine import examine, examined

ONE = '[model]\nmicro = "smooth"\nbase = "thin_layer"\nP = 1e-5\nh = 0.02\nn = 0.5\n[output]\nx = 3\n'


@pytest.fixture(scope="module")
def one(tmp_path_factory) -> study.Study:
    """A study of one case: its numbers are scalars, which netCDF stores without a checksum."""
    folder = tmp_path_factory.mktemp("one")
    (folder / "one.toml").write_text(ONE, encoding="utf-8")
    found = study.load(folder / "one.toml", folder / "results")
    found.run()
    return found


@pytest.fixture
def opened(one, tmp_path) -> study.Study:
    """A copy to damage."""
    shutil.copytree(one.results, tmp_path / "results")
    shutil.copy(one.results.parent / "one.toml", tmp_path)
    return study.Study(one.definition, tmp_path / "results")


def damage(opened: study.Study, old: bytes, new: bytes) -> None:
    path = opened.results / f"{opened.definition.name}.nc"
    data = path.read_bytes()
    assert data.count(old) == 1 and len(old) == len(new)
    path.write_bytes(data.replace(old, new))


def flip(opened: study.Study, name: str) -> None:
    """One bit of a number: h 0.02 becomes 0.0161."""
    number = opened.open()[name].values.astype("<f8").tobytes()
    damage(opened, number, number[:6] + bytes([number[6] ^ 4]) + number[7:])


@pytest.mark.usefixtures("read_in_a_fork")
@pytest.mark.parametrize("name", ["h", "a"])
def test_one_flipped_bit_is_named_and_mended(one, opened, name, tmp_path, capsys, caplog):
    flip(opened, name)
    path = opened.results / "one.nc"
    said = f"{path}: is damaged, or another program has changed it: {name}"
    command = [str(tmp_path / "one.toml"), "--results", str(opened.results)]
    assert main(["verify", *command]) == main(["verify", str(path)]) == 1
    assert capsys.readouterr().err.startswith(said)
    for read in (opened.open, lambda: study.open_results(path)):
        with pytest.raises(study.StudyError, match=said):
            read()
    damaged = path.read_bytes()
    assert opened.run().computed == (name == "a"), "what h belongs to can be told by the study"
    assert f"{said}" in caplog.text and f"{path}.damaged keeps it" in caplog.text
    assert_same(opened.open(), one.open())
    assert (opened.results / "one.nc.damaged").read_bytes() == damaged
    assert opened.verify().kind == "sound" and opened.run().computed == 0


def test_status_says_what_is_damaged(opened, tmp_path, capsys):
    flip(opened, "h")
    assert opened.status()["state"] == "damaged"
    assert main(["status", str(tmp_path / "one.toml"), "--results", str(opened.results)]) == 0
    assert "  damaged  \n    " in (said := capsys.readouterr().out) and said.endswith("has changed it: h\n")


@pytest.mark.usefixtures("read_in_a_fork")
@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        (b"CF-1.11", b"CF-1.19", "a part of it cannot be read (NetCDF: Can't open HDF5 attribute)"),
        (b"frictionless", b"frictionlfss", "bonding"),
    ],
)
def test_texts_are_verified(opened, old, new, name):
    damage(opened, old, new)
    assert examine(opened.results / "one.nc", ()).reason.endswith(f": {name}")
    assert opened.run().complete and opened.verify().kind == "sound"
    assert opened.open().bonding.item() == "frictionless"


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """A study of 23 cases, its file with checksums for runs of five."""
    folder = tmp_path_factory.mktemp("runs")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(checksums, "RUN", 5)
        patch.setattr("study.files.examine.CHUNK", 5)
        patch.setattr("study.store.writer.CHUNK", 5)
        # another process would have the usual runs of cases
        patch.setattr("study.files.examine.examined_in_child", lambda *given: examined(*given[:3]))
        found = load(folder / "line.toml")
        found.run()
        yield found


@pytest.fixture
def line(runs, tmp_path) -> study.Study:
    shutil.copytree(runs.results, tmp_path / "results")
    return study.Study(runs.definition, tmp_path / "results")


def flip_profile(opened: study.Study, case: int) -> None:
    raw = opened.open().p.isel(P=case).values.astype("<f8").tobytes()
    damage(opened, raw, raw[:3] + bytes([raw[3] ^ 1]) + raw[4:])


def test_only_the_damaged_run_of_cases_is_computed_again(runs, line, computed):
    flip_profile(line, 7)
    found = line.verify()
    assert np.flatnonzero(~found.intact).tolist() == [5, 6, 7, 8, 9]
    assert found.reason.endswith(": p in 5 of 23 cases, 5 to 9")
    assert line.run().computed == 5 and computed == [5]
    assert_same(line.open(), runs.open())


def test_a_damaged_case_is_not_carried_on_by_an_extension(runs, line, computed, tmp_path):
    flip_profile(line, 7)
    text = runs.definition.text.replace(
        "{start = 1e-6, stop = 1e-4, num = 23}", str([5e-7, *runs.open().P.values.tolist()])
    )
    (tmp_path / "line.toml").write_text(text, encoding="utf-8")
    wider = study.load(tmp_path / "line.toml", line.results)
    assert wider.dry_run().present == 18 and wider.run().computed == 6
    xr.testing.assert_allclose(wider.open().a[1:], runs.open().a, rtol=1e-12, atol=0)


def test_a_damaged_coordinate_stops_an_extension(runs, line, tmp_path):
    raw = runs.open().P.values.astype("<f8")[9:10].tobytes()
    data = (line.results / "line.nc").read_bytes()
    (line.results / "line.nc").write_bytes(data.replace(raw, raw[:6] + bytes([raw[6] ^ 1]) + raw[7:]))
    text = runs.definition.text.replace("num = 23", "num = 24")
    (tmp_path / "line.toml").write_text(text, encoding="utf-8")
    with pytest.raises(study.StudyError, match="has changed it: P; which cases it holds cannot be told: run the study"):
        study.load(tmp_path / "line.toml", line.results).run()
    assert line.run().computed == 0
    assert_same(line.open(), runs.open())


def test_a_file_of_an_earlier_version_is_used_but_cannot_be_verified(runs, line, capsys):
    path = line.results / "line.nc"
    with netCDF4.Dataset(path, "a") as file:
        file.delncattr("checksums")
    assert main(["verify", str(path)]) == 1
    assert "xarray or an earlier version wrote it, without checksums to compare" in capsys.readouterr().out
    assert line.status()["state"] == "done" and line.run().computed == 0
    flip_profile(line, 12)
    assert line.run().computed == 5, "the profiles had checksums before"
    assert_same(line.open(), runs.open())


def test_exit_codes_of_verify(opened, tmp_path, capsys):
    assert main(["verify", str(opened.results / "one.nc")]) == 0
    assert capsys.readouterr().out.endswith("one.nc: verified, every number is the one that was written\n")
    assert main(["verify", str(tmp_path / "none.nc")]) == 2
    assert main(["verify", str(opened.results / "one.nc"), str(tmp_path / "one.toml"), "--results", "none"]) == 2


def test_added_attributes_and_the_history_are_nobodys_damage(opened):
    with netCDF4.Dataset(opened.results / "one.nc", "a") as file:
        file.comment, file.history = "mine", "ncatted"
    assert opened.verify().kind == "sound"


def test_lazily_read_chunks_are_verified_and_the_file_is_named(line, monkeypatch):
    flip_profile(line, 7)
    monkeypatch.setattr(study.api, "LAZY", 0)
    found = line.open()
    with pytest.raises(study.StudyError, match=r"line.nc: is damaged: a part of it cannot be read \(NetCDF: HDF error"):
        found.p.compute()
    assert found.p.isel(P=slice(10, 23)).compute().notnull().all()


def test_the_checksums_stay_in_the_file(opened, tmp_path):
    found = opened.open()
    found.isel(x=[0, 2]).to_netcdf(tmp_path / "part.nc")
    assert "checksums" not in found.attrs
    assert examine(tmp_path / "part.nc").kind == "unverified"


def test_digests_do_not_depend_on_the_pieces(monkeypatch):
    monkeypatch.setattr(checksums, "RUN", 4)
    numbers, found = np.arange(22.0).reshape(11, 2), []
    for pieces in ([11], [4, 4, 3], [1, 2, 8], [3, 3, 3, 2]):
        rows = CaseDigests(11)
        for piece in np.split(numbers, np.cumsum(pieces)[:-1]):
            rows.add("p", piece)
        found.append(rows.lines())
    assert all(lines == found[0] for lines in found) and len(found[0]["=runs"]) == 3 * 32
    assert CaseDigests(10**9).run == -(-(10**9) // 1024), "the attribute stays small"


def test_a_damaged_file_is_kept_under_a_name_of_its_own(tmp_path, monkeypatch):
    path, names = tmp_path / "f.nc", []
    for link in (os.link, lambda *_: (_ for _ in ()).throw(OSError(95, "no links"))):
        monkeypatch.setattr(os, "link", link)
        path.write_bytes(b"damaged")
        names += [results_file.set_aside(path).name]
        path.unlink(missing_ok=True)
    assert names == ["f.nc.damaged", "f.nc.damaged-2"]


@pytest.mark.parametrize("links", [True, False], ids=["hard links", "no hard links"])
def test_a_damaged_file_behind_a_symbolic_link_is_kept_and_mended_there(one, opened, tmp_path, monkeypatch, links):
    path, there = opened.results / "one.nc", tmp_path / "disk" / "large.nc"
    there.parent.mkdir()
    path.rename(there)
    path.symlink_to(there)
    flip(opened, "a")
    damaged = there.read_bytes()
    (there.parent / ".large.nc.01234567.tmp").touch()  # of a run that was killed
    if not links:
        monkeypatch.setattr(os, "link", lambda *_: (_ for _ in ()).throw(OSError(95, "no links")))
    opened.run()
    assert path.is_symlink() and sorted(os.listdir(there.parent)) == ["large.nc", "large.nc.damaged"]
    assert (there.parent / "large.nc.damaged").read_bytes() == damaged
    assert_same(opened.open(), one.open())


def test_a_sample_of_random_flips():
    """The whole of it is `make fuzz`."""
    command = [sys.executable, "-W", "ignore", str(ROOT / "tests/fuzz/fuzz_files.py"), "20", "3"]
    found = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(ROOT)})
    assert found.returncode == 0, found.stdout + found.stderr
    assert "0 faults in 20 flips" in found.stdout and "'damaged'" in found.stdout and "'block'" in found.stdout
