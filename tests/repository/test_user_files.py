"""Every file of a user comes through one door, which waits for no pipe and reads no device, nor what is too large."""

import ast
import gzip
import os
import re
import zipfile
from functools import cache

import pytest
from conftest import ROOT

import study
from solver.numerics import userfile
from solver.numerics.userfile import NoFile, TooLarge, begins, checked, content, unpacked

DOOR = "solver/numerics/userfile.py"
#: Functions, methods and constructors that open a file, or take a path to one.
OPENERS = {"open", "fdopen", "read_bytes", "read_text", "load", "loadtxt", "genfromtxt", "fromfile", "memmap"}
OPENERS |= {"open_memmap", "open_dataset", "open_mfdataset", "open_dataarray", "load_dataset", "open_zarr", "Dataset"}
OPENERS |= {"File", "GzipFile", "BZ2File", "LZMAFile", "ZipFile", "netcdf_file", "read_csv", "read_table", "read_excel"}
OPENERS |= {
    "decompress",
    "read_topography",
    "open_topography",
    "load_data",
    "FileIO",
    "imread",
    "loadmat",
    "read_array",
}
WORDS = re.compile(rf"\b({'|'.join(OPENERS - {'load', 'Dataset', 'File'})}|load\(|netCDF4|h5py)\b")
#: Of names that mean something else too, the modules in which they open a file.
MODULES = {"load": {"np", "numpy", "json", "tomllib", "pickle", "marshal", "joblib", "yaml"}, "Dataset": {"netCDF4"}}
MODULES |= {"File": {"h5py", "h5netcdf"}}
#: Where the program opens what is its own, or what the door has let through.
OWN = {
    "solver/laws/lattice.py": "a table of the package",
    "solver/numerics/special.py": "a table of the package",
    "study/explorer/page.py": "scripts of the package",
    "study/commands/beginning.py": "a template of the package, and a file that it makes",
    "study/inputs/places.py": "the book in the package",
    "study/inputs/vocabulary.py": "tables of the package",
    "study/pages.py": "pages of the package",
    "study/specimen/materials/__init__.py": "the table of the package",
    "study/specimen/materials/works.py": "the table of the package",
    "study/terminal.py": "the null device",
    "study/data/provenance.py": "the name of the processor",
    "study/catalogue.py": "pictures that are drawn by hand, in the book",
    "study/figures/figure_files.py": "scripts that the door has opened before, and those of the package",
    "study/figures/record.py": "the record of drawn figures, whose kind and size it has looked at",
    "study/files/": "results: whoever reads them looks for pipes and folders (tests/files/test_unusable.py)",
    "study/work/processes.py": "the pipe to a process of its own",
    "study/store/": "blocks of results: likewise",
    "study/inverse/fits/block.py": "a field of a tuple",
    "study/inverse/force_curves.py": "by afmformats, what the door has checked",
    "study/specimen/scan_files.py": "by SurfaceTopography, what the door has checked",
    "study/specimen/scan_grids.py": "numpy, from a file that the door has opened",
    "study/specimen/texts/plain_rows.py": "numpy, from lines of a text that the door has opened",
    "study/specimen/netcdf_heights.py": "netCDF, from bytes",
    "study/specimen/x3p.py": "a zip, from bytes",
}


@cache
def opening() -> dict[str, set[str]]:
    """File -> the openers that it calls, or hands on."""
    calls: dict[str, set[str]] = {}
    for path in [*(ROOT / "solver").rglob("*.py"), *(ROOT / "study").rglob("*.py")]:
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)) if WORDS.search(text) else ():
            name, base = (node.attr, node.value) if isinstance(node, ast.Attribute) else (getattr(node, "id", ""), None)
            of = getattr(base, "id", "")
            if of not in MODULES.get(name, {of}) or (name == "open" and of in ("study", "self")):
                continue  # the load of a contact, a Dataset of xarray, the results of a study
            if name in OPENERS and isinstance(node.ctx, ast.Load):
                calls.setdefault(path.relative_to(ROOT).as_posix(), set()).add(name)
    return calls


def test_no_file_is_opened_elsewhere():
    """A new reader comes through the door; what is the program's own is named above, with the reason."""
    assert {"open", "ZipFile", "GzipFile"} <= opening()[DOOR], "the search finds what it looks for"
    others = {file: names for file, names in opening().items() if file != DOOR and not file.startswith(tuple(OWN))}
    assert others == {}


def test_what_is_named_is_there():
    assert [name for name in OWN if not any(file.startswith(name) for file in opening())] == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes")
def test_the_door(tmp_path, monkeypatch):
    file, pipe = tmp_path / "a", tmp_path / "pipe"
    file.write_bytes(b"12345")
    os.mkfifo(pipe)
    (tmp_path / "link").symlink_to(pipe)
    for path in (pipe, tmp_path / "link", "/dev/zero"):
        for read in (content, begins, checked):
            with pytest.raises(NoFile, match="^is not a file but a pipe or device$"):
                read(path)
    with pytest.raises(IsADirectoryError):
        content(tmp_path)
    with pytest.raises(FileNotFoundError):
        checked(tmp_path / "nothing")
    assert content(file) == content(file, 5) == b"12345" and begins(file, size=2) == b"12" and checked(file) == file
    with pytest.raises(TooLarge, match="^has 5 bytes: must have at most 4$"):
        content(file, 4)
    monkeypatch.setattr(type(file), "stat", lambda self, **_: os.stat(tmp_path / "a"))
    with pytest.raises(NoFile):  # it has become a pipe since it was looked at
        content(pipe)


def test_what_is_packed_is_not_unpacked_beyond_the_limit(tmp_path):
    packed = gzip.compress(b"0" * 1_000_000)
    assert unpacked(packed) == b"0" * 1_000_000 and unpacked(b"12") == b"12"
    assert unpacked(packed + packed) == b"0" * 2_000_000, "of two members"
    with pytest.raises(TooLarge, match="^has more than 999999 bytes once unpacked: must have at most that$"):
        unpacked(packed, 999_999)
    with pytest.raises(ValueError, match="^the packed file is damaged: "):
        unpacked(packed[:-9])
    with zipfile.ZipFile(tmp_path / "a.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a", b"0" * 1_000_000)
    assert checked(tmp_path / "a.zip").name == "a.zip"
    with pytest.raises(TooLarge, match="^has 1000000 bytes once unpacked: must have at most 10000$"):
        checked(tmp_path / "a.zip", 10_000)
    assert userfile.LARGEST_TEXT < userfile.LARGEST


READERS = {
    "curves": study.curves,
    "fit": lambda path: study.fit(path, free=["E2"], R="1 mm", base="half_space", micro="smooth"),
    "scan": lambda path: study.roughness.read(path, unit="um"),
    "materials": study.materials.read,
    "study file": study.load,
    "tip": lambda path: study.solve(P=1e-5, base="half_space", micro="smooth", shape=f"table:{path}"),
    "graded layer": lambda path: study.solve(
        P=1e-5, base="stack", micro="smooth", layers=[{"h": 0.1, "nu": 0.3, "profile": f"table:{path}"}]
    ),
    "law": lambda path: study.solve(P=1e-5, base="half_space", micro=f"table:{path}"),
}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes")
@pytest.mark.parametrize("name", READERS)
def test_each_reader_comes_through_it(tmp_path, name):
    """A pipe was waited for, /dev/zero read until the memory was full."""
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "zero.toml").symlink_to("/dev/zero")
    for path in (str(tmp_path / "pipe.toml"), str(tmp_path / "zero.toml")):
        with pytest.raises(ValueError, match="is not a file but a pipe or device|is not a regular file"):
            READERS[name](path)
