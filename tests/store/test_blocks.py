"""Blocks on the disk: what is damaged is noticed, what serves a study and what does not, which block a case is from.
Blocks as versions before wrote them are taken."""

import json
import logging
import zlib
from dataclasses import replace

import numpy as np
import pytest
from line_study import load

from study.data.dataset import not_run
from study.files.seal import seal
from study.inputs.definition import Definition
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables
from study.store import blocks
from study.store.block_file import Block, Damaged, read_block, write_block
from study.store.blocks import add, count_statuses, facts, gather, inventory, put, usable
from study.store.windows import Store
from study.work import cases


def line(**output) -> Definition:
    model, axes = {"micro": "smooth", "base": "half_space"}, {"P": [1e-6, 2e-6, 3e-6, 4e-6]}
    return from_tables({"model": model, "axes": axes, "output": {"x": 3} | output}, "line", "", "line")


@pytest.fixture
def path(tmp_path):
    """A small block with columns of all types."""
    keys = np.array([[1, 2], [3, 2**64 - 1], [5, 6]], dtype=np.uint64)
    arrays = {"a": np.array([0.1, np.nan, -0.0]), "p": np.arange(12.0).reshape(6, 2)[::2], "status": np.int8([0, 3, 1])}
    arrays["lam"] = np.float32([[0.5], [0.25], [1]])
    write_block(tmp_path / "some.block", Block({"x": [0, 1], "numerics_version": "7"}, keys, arrays))
    return tmp_path / "some.block"


def test_a_block_is_read_as_it_was_written(path):
    found = read_block(path)
    assert found.facts == {"x": [0, 1], "numerics_version": "7"}
    assert found.keys.tolist() == [[1, 2], [3, 2**64 - 1], [5, 6]]
    assert [(name, array.dtype.str) for name, array in found.arrays.items()] == [
        ("a", "<f8"), ("p", "<f8"), ("status", "|i1"), ("lam", "<f4")
    ]  # fmt: skip
    np.testing.assert_array_equal(found.arrays["a"], [0.1, np.nan, 0])
    assert found.arrays["p"].tolist() == [[0, 1], [4, 5], [8, 9]]
    assert found.arrays["status"].tolist() == [0, 3, 1] and found.arrays["lam"].tolist() == [[0.5], [0.25], [1]]


def test_a_flipped_bit_anywhere_is_noticed(path):
    data = path.read_bytes()
    for place in range(len(data)):
        path.write_bytes(data[:place] + bytes([data[place] ^ 1 << place % 8]) + data[place + 1 :])
        with pytest.raises(Damaged, match="is not a complete block; the same command computes its cases again"):
            read_block(path)


def test_a_file_cut_off_anywhere_is_noticed(path):
    data = path.read_bytes()
    for length in range(len(data)):
        path.write_bytes(data[:length])
        with pytest.raises(Damaged):
            read_block(path)


def sealed(path, *arrays) -> None:
    with open(path, "wb") as file:
        for array in arrays:
            np.save(file, array)
    seal(path)


HEAD = np.array(json.dumps({"facts": {}, "columns": ["a"]}))
KEYS = np.zeros((3, 2), np.uint64)


@pytest.mark.parametrize(
    "arrays",
    [
        (),
        (np.array("no json"),),
        (np.array("[1, 2]"),),
        (np.array('{"columns": []}'), KEYS),
        (HEAD, KEYS),
        (HEAD, KEYS.astype(float), np.zeros(3)),
        (HEAD, KEYS[:, :1], np.zeros(3)),
        (HEAD, KEYS, np.zeros(2)),
        (HEAD, KEYS, np.array([print] * 3)),
    ],
    ids=["empty", "no json", "no head", "no facts", "no column", "keys of floats", "half keys", "short", "objects"],
)
def test_what_is_no_block_is_refused_in_spite_of_its_checksum(path, arrays):
    sealed(path, HEAD, KEYS, np.zeros(3))
    assert read_block(path).arrays["a"].tolist() == [0, 0, 0]
    sealed(path, *arrays)
    with pytest.raises(Damaged, match="is not a complete block"):
        read_block(path)


@pytest.fixture
def wanted() -> Definition:
    return line()


def columns(definition: Definition, size: int = 4) -> dict[str, np.ndarray]:
    return not_run(definition, size)


COLUMNS = {"P", "a", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", "lam0", "error", "profile_error", "model_error",
           "residual", "status", "model_used", "iterations", "nodes_used", "p", "lam"}  # fmt: skip


def test_a_block_has_every_column(wanted):
    assert set(columns(wanted)) == COLUMNS
    assert set(columns(line(profiles=["lam"]))) == COLUMNS - {"p"}


@pytest.mark.parametrize("name", sorted(COLUMNS))
def test_a_block_without_a_column_does_not_serve(wanted, name):
    arrays = columns(wanted)
    keys = np.zeros((4, 2), np.uint64)
    assert usable(wanted, Block(facts(wanted.x), keys, arrays))
    others = {other: arrays[other] for other in arrays if other != name}
    assert not usable(wanted, Block(facts(wanted.x), keys, others))


def test_what_serves_a_study(wanted):
    scalars, half, other = line(profiles=False), line(dtype="float32"), np.array([0, 0.4, 1])
    here = facts(wanted.x)
    assert here == {"numerics_version": blocks.NUMERICS_VERSION, "x": [0, 0.5, 1]}
    for definition, given, arrays, expected in (
        (wanted, here, columns(wanted), True),
        (wanted, facts(other), columns(wanted), False),
        (wanted, {"numerics_version": blocks.NUMERICS_VERSION}, columns(wanted), False),
        (wanted, here | {"numerics_version": "another"}, columns(wanted), False),
        (wanted, {"x": wanted.x.tolist()}, columns(wanted), False),
        (wanted, here, columns(half), False),
        (wanted, here, columns(scalars), False),
        (half, here, columns(wanted), True),
        (scalars, here, columns(wanted), True),
        (scalars, facts(other), columns(wanted), True),
        (scalars, here | {"numerics_version": "another"}, columns(wanted), False),
    ):
        block = Block(given, np.zeros((4, 2), np.uint64), arrays)
        assert usable(definition, block) == expected, (definition.profiles, definition.dtype, given)


@pytest.fixture
def some(tmp_path, wanted) -> Store:
    made = Store(wanted, tmp_path)
    made.folder.mkdir()
    return made


def block(some: Store, index, status, first: float = 0.0, **fact) -> Block:
    """A block of the cases at `index` with numbers of its own."""
    definition = some.definition
    arrays = columns(definition, len(index)) | {"status": np.array(status, dtype=np.int8)}
    arrays = arrays | {"a": first + np.arange(len(index), dtype=float)}
    return Block(facts(definition.x) | fact, case_keys(definition.grid)[index], arrays)


def test_blocks_of_other_contents_have_other_names(some):
    first = block(some, [0, 1], [0, 0])
    paths = [put(some, first), put(some, first), put(some, block(some, [0, 2], [0, 0]))]
    paths.append(put(some, replace(first, facts=facts(np.array([0, 1.0])))))
    paths.append(put(some, replace(first, arrays={name: first.arrays[name] for name in ("a", "status")})))
    assert paths[0] == paths[1] and len(set(paths)) == 4
    assert sorted(some.folder.iterdir()) == sorted(set(paths))


def test_of_two_blocks_the_case_that_ended_better_is_taken(some):
    put(some, block(some, [0, 1, 2], [5, 0, 3], first=10))
    put(some, block(some, [2, 1, 0], [0, 2, 1], first=20))
    known = inventory(some)
    assert known.status.tolist() == [1, 0, 0, 127] and known.missing.tolist() == [3]
    np.testing.assert_array_equal(gather(some, known, 0, 4)["a"], [22, 11, 20, np.nan])
    assert count_statuses(known.status) == {0: 2, 1: 1, 127: 1}
    assert inventory(some, retry=(1, 2)).status.tolist() == [5, 0, 0, 127]
    assert inventory(some, retry=(0, 1, 2, 3)).missing.tolist() == [1, 2, 3]


def test_a_part_of_the_cases_is_gathered_from_its_blocks(some):
    put(some, block(some, [3, 1], [0, 2], first=10))
    put(some, block(some, [0], [1], first=20))
    found = gather(some, inventory(some), 1, 4)
    np.testing.assert_array_equal(found["a"], [11, np.nan, 10])
    assert found["status"].tolist() == [2, 127, 0]
    assert found["nodes_used"].tolist() == [0, 0, 0] and found["p"].shape == (3, 3)
    assert np.isnan(found["p"][1]).all() and np.isnan(found["D"][1])


def test_what_is_added_is_in_the_inventory_as_on_the_disk(some):
    known = inventory(some)
    add(some, known, np.array([2, 0]), block(some, [2, 0], [0, 4], first=10).arrays)
    add(some, known, np.array([1]), block(some, [1], [3], first=20).arrays)
    again = inventory(some)
    for found in (known, again):
        assert found.status.tolist() == [4, 3, 0, 127] and found.missing.tolist() == [3]
        np.testing.assert_array_equal(gather(some, found, 0, 4)["a"], [11, 20, 10, np.nan])
    assert {source.path for source in again.sources} == {source.path for source in known.sources}


def test_blocks_of_other_numerics_are_left_alone(some):
    old = put(some, block(some, [0], [0], numerics_version="old"))
    new = put(some, block(some, [1], [0]))
    assert inventory(some).status.tolist() == [127, 0, 127, 127]
    assert old.exists() and new.exists()


def test_a_damaged_block_is_said_and_its_cases_are_missing(some, caplog):
    put(some, block(some, [0], [0]))
    bad = put(some, block(some, [1], [0]))
    bad.write_bytes(bad.read_bytes()[:-1])
    with caplog.at_level(logging.WARNING, logger="study.store.blocks"):
        assert inventory(some).status.tolist() == [0, 127, 127, 127]
    assert [record.getMessage().split(":")[0] for record in caplog.records] == [str(bad)]


def test_a_block_that_has_just_gone_is_missing(some, monkeypatch):
    """The run that it belonged to has ended."""
    path = put(some, block(some, [0], [0]))
    put(some, block(some, [1], [0]))
    real = blocks.read_block

    def read(at):
        path.unlink(missing_ok=True)
        return real(at)

    monkeypatch.setattr(blocks, "read_block", read)
    assert inventory(some).status[0] == 127


def test_litter_is_removed_and_blocks_are_not(some):
    kept = put(some, block(some, [0], [0]))
    (some.folder / ".line.nc.0123.tmp").touch()
    some.remove_litter()
    assert list(some.folder.iterdir()) == [kept]


def test_studies_in_one_folder_keep_apart(tmp_path, wanted):
    other = replace(wanted, name="other")
    assert Store(wanted, tmp_path).folder != Store(other, tmp_path).folder
    assert Store(wanted, tmp_path).lock.parent == Store(wanted, tmp_path).folder


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
    assert f"{path}: is not a complete block; the same command computes its cases again" in caplog.text
    assert path.exists() and other.exists()
    assert (opened.open().status == 0).all()
