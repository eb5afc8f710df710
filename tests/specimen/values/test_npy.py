"""Files called .npy that are none, or of which numpy says so by an error of its own."""

import os
import struct
import zipfile

import numpy as np
import pytest

from study import roughness


def npy(header: str, body: bytes = bytes(72)) -> bytes:
    return b"\x93NUMPY\x02\x00" + struct.pack("<I", len(header)) + header.encode() + body


def real(shape: str) -> bytes:
    return npy(f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}\n")


BAD = {
    "empty": (b"", "it is empty"),
    "text": (b"1 2 3\n4 5 6\n", "it is of another format"),
    "long header": (npy("{}" + " " * 200_000 + "\n"), "Header info length (200003) is large and may not"),
    "deep header": (npy("(" * 9000 + "\n"), ""),
    "huge": (real("(3000000, 3000000)"), "Unable to allocate"),
    "beyond integers": (real(f"({10**30},)"), "Python int too large"),
    "negative": (real("(-3, 3)"), "Failed to read all data"),
    "cut off": (real("(30, 30)"), "Failed to read all data"),
    "no type": (npy("{'descr': None, 'fortran_order': False, 'shape': (3,)}\n"), "descr is not a valid"),
}


@pytest.mark.parametrize("kind", BAD)
def test_what_is_no_array(kind, tmp_path):
    content, reason = BAD[kind]
    (tmp_path / "a.npy").write_bytes(content)
    with pytest.raises(ValueError) as said:
        roughness.read(tmp_path / "a.npy", unit="um", dx=1)
    assert str(said.value).startswith(f"a.npy: not a .npy file of real numbers: {reason}")
    assert "\n" not in str(said.value)


@pytest.mark.parametrize("archive", [True, False], ids=["npz", "zip"])
def test_a_zip(tmp_path, archive):
    """numpy opens it, and gives something that is no array."""
    with open(tmp_path / "a.npy", "wb") as file:
        if archive:
            np.savez(file, z=np.ones((20, 20)))
        else:
            with zipfile.ZipFile(file, "w") as packed:
                packed.writestr("a.txt", "1 2 3")
    with pytest.raises(ValueError, match=r"^a.npy: .*: it is a zip file: save one array of it by numpy.save$"):
        roughness.read(tmp_path / "a.npy", unit="um", dx=1)


@pytest.mark.skipif(os.name == "nt", reason="POSIX files")
@pytest.mark.parametrize("name", ["a.npy", "a.csv", "a.sur"])
def test_a_pipe_is_not_waited_for(tmp_path, name):
    os.mkfifo(tmp_path / name)
    (tmp_path / f"endless-{name}").symlink_to("/dev/zero")
    for each in (name, f"endless-{name}"):
        with pytest.raises(ValueError, match=f"^{each}: is not a file but a pipe or device"):
            roughness.read(tmp_path / each, unit="um", dx=1)
