"""Blocks as versions before wrote them, byte by byte: they are taken, or computed again, and the run says so."""

import json
import zlib

import numpy as np
import pytest
from line_study import load

from study.inputs.identity import case_keys
from study.store import blocks
from study.store.windows import Store
from study.work import cases


def write_as_before(path, head: dict, *arrays: np.ndarray) -> None:
    """A text in JSON, keys and columns as numpy.save writes them, and a checksum."""
    with open(path, "wb") as file:
        for array in (np.array(json.dumps(head)), *arrays):
            np.save(file, array)
    data = path.read_bytes()
    path.write_bytes(data + b"\nroughcoat crc32 %08x" % zlib.crc32(data))


@pytest.fixture
def former(file):
    """A study with the block of its first five cases in the former form, and the arguments of `write_as_before`."""
    opened = load(file)
    store = Store(opened.definition, opened.results)
    store.folder.mkdir(parents=True)
    columns = cases.compute(cases.parcel(opened.definition, np.arange(5)))
    facts = {"numerics_version": blocks.NUMERICS_VERSION, "x": [0.0, 0.5, 1.0]}
    head = {"facts": facts, "columns": [*columns]}
    return opened, store.folder / "former.block", head, case_keys(opened.definition.grid)[:5], columns


def test_a_block_of_before_is_taken(former, computed):
    opened, path, head, keys, columns = former
    write_as_before(path, head, keys, *columns.values())
    assert opened.status()["counts"] == {0: 5, 127: 18}
    computed.clear()
    assert opened.run(workers=1).computed == 18 and computed == [5, 10, 15, 20]
    contacts = opened.open()
    for name in ("a", "D", "p0", "lam"):
        np.testing.assert_array_equal(contacts[name].values[:5], columns[name])


def test_a_block_without_a_part_of_the_form_is_computed_again(former, caplog):
    """Without a checksum it is said; of other numerics it is another study's."""
    opened, path, head, keys, columns = former
    write_as_before(path, head, keys, *columns.values())
    path.write_bytes(path.read_bytes()[:-25])
    other = path.with_name("other.block")
    write_as_before(other, head | {"facts": head["facts"] | {"numerics_version": "1"}}, keys, *columns.values())
    assert opened.run(workers=1).computed == 23
    assert f"{path}: is no whole block; the same command computes its cases again" in caplog.text
    assert path.exists() and other.exists()
    assert (opened.open().status == 0).all()
