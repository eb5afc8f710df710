"""Whole results files go to HDF5 in this process, others in another one first: some flips end the process."""

import subprocess

import netCDF4
import pytest
import xarray as xr
from line_study import load

from study.files import examine, seal


@pytest.fixture
def path(file):
    opened = load(file)
    opened.run(workers=1)
    return opened.results / "line.nc"


def test_every_bit_is_sealed(path):
    """The seal itself, too."""
    data = path.read_bytes()
    assert seal.is_whole(path)
    for place in (0, len(data) // 2, len(data) - seal.LENGTH - 1, len(data) - seal.LENGTH, len(data) - 1):
        path.write_bytes(data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :])
        assert not seal.is_whole(path), place
    path.write_bytes(data[:20])
    assert not seal.is_whole(path)


def test_of_a_large_file_only_the_end_is_read_where_no_number_is_asked_for(path):
    data = path.read_bytes()
    path.write_bytes(b"\0" + data[1:])
    assert seal.is_whole(path, most=1000) and not seal.is_whole(path, most=len(data))
    path.write_bytes(data[:-1])
    assert not seal.is_whole(path, most=1000)


def test_other_programs_read_and_change_a_sealed_file(path):
    assert xr.open_dataset(path).load().sizes["P"] == 23
    with netCDF4.Dataset(path, "a") as file:
        file.setncattr("note", "mine")
    assert not seal.is_whole(path)
    assert examine.examine(path).kind == "sound", "what was summed is as it was"


def test_a_file_that_ends_the_program_which_reads_it_is_damaged(path, monkeypatch):
    """As HDF5 does of some: the child ends by a signal, or reads for ever."""
    path.write_bytes(path.read_bytes()[:-1])
    real = subprocess.run

    def killed(command, **options):
        return real([*command[:2], "import os; os.abort()"], **options)

    monkeypatch.setattr(examine.subprocess, "run", killed)
    examine.examined_in_child.cache_clear()
    found = examine.examine(path)
    assert (found.kind, found.reason) == ("damaged", "is damaged: a program that reads it breaks down")

    def endless(command, **options):
        return real([*command[:2], "while True: pass"], **options | {"timeout": 0.5})

    monkeypatch.setattr(examine.subprocess, "run", endless)
    examine.examined_in_child.cache_clear()
    assert examine.examine(path).kind == "damaged"
    examine.examined_in_child.cache_clear()
