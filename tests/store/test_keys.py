"""What a case and a study are recognised by: every parameter is in the key of a case, every input in the digest.

Whatever were left out of them would be served stale after an edit.
"""

import hashlib
import math
import struct
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from line_study import store_block
from same import assert_same

import study
from study.spec.definition import Definition, digest_of, from_tables
from study.spec.grid import Grid
from study.spec.vocabulary import NUMERICS, PARAMETERS
from study.store.keys import case_keys

# Two allowed values of every parameter.
TWO = {
    "P": (1e-5, 1.000001e-5),
    "a": (0.04, 0.05),
    "D": (1e-3, 2e-3),
    "h": (0.02, 0.03),
    "n": (0.5, 0.6),
    "nu1": (0.3, 0.31),
    "nu2": (0.3, 0.0),
    "bonding": ("frictionless", "bonded"),
    "base": ("layered", "thin_layer"),
    "Nbar": (250000, 250001),
    "Ra": (0.004, 0.005),
    "micro": ("disc_cell", "power_law"),
    "B": (0.1, 0.2),
    "beta": (0.5, 0.53),
    "scheme": ("newton", "picard"),
    "k": (1.0, 0.0),
    "rtol": (1e-6, 1e-9),
    "accuracy": (0.01, 0.02),
    "model_check": ("closed_form", "first_order"),
    "nodes": (0, 16),
    "max_iterations": (0, 5),
}


def defined(**given) -> Definition:
    """A study of one case, all of whose parameters but two controls are given."""
    control = {"a", "D"} & set(given) or {"P"}
    values = {name: two[0] for name, two in TWO.items() if name not in ("P", "a", "D") or name in control} | given
    numerics = {name: value for name, value in values.items() if name in NUMERICS}
    model = {name: value for name, value in values.items() if name not in NUMERICS}
    return from_tables({"model": model, "numerics": numerics}, "one", "", "one")


def test_the_table_has_every_parameter():
    assert set(TWO) == set(PARAMETERS)


@pytest.mark.parametrize("name", PARAMETERS)
def test_every_parameter_is_in_key_and_digest(name):
    one, same, other = (defined(**{name: TWO[name][i]}) for i in (0, 0, 1))
    assert (case_keys(one.grid) == case_keys(same.grid)).all() and one.digest == same.digest
    assert (case_keys(one.grid) != case_keys(other.grid)).all(), "both halves of the key"
    assert one.digest != other.digest


def bits(value) -> int:
    if isinstance(value, str):
        return int.from_bytes(hashlib.blake2b(value.encode(), digest_size=8).digest(), "little")
    return struct.unpack("<Q", struct.pack("<d", value))[0]


def mixed(z: int) -> int:
    """The finalizer of splitmix64, as published (Steele, Lea & Flood 2014, variant 13 of Stafford)."""
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
    z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
    return z ^ z >> 31


def test_a_key_is_the_sum_of_the_hashes_of_its_parameters():
    """Other keys would make every block and results file on a disk worthless."""
    values = {name: two[0] for name, two in TWO.items() if name not in ("a", "D")} | {"a": math.nan, "D": math.nan}
    lanes = [0, 0]
    for name, value in values.items():
        seeds = hashlib.blake2b(name.encode(), digest_size=16).digest()
        for i in (0, 1):
            seed = int.from_bytes(seeds[8 * i : 8 * i + 8], "little")
            lanes[i] = (lanes[i] + mixed(bits(value) ^ seed)) % 2**64
    assert case_keys(defined().grid).tolist() == [lanes]


def test_a_nan_is_a_nan():
    """Whatever its sign, which arithmetic on other processors sets."""
    ours, other = (Grid({"h": 1}, {"h": (("h",), np.array([nan]))}) for nan in (np.nan, -np.nan))
    assert np.signbit(-np.nan) and (case_keys(ours) == case_keys(other)).all()


def base() -> Definition:
    """A study of six cases with an axis of words, cases with labels and a label coordinate of dates."""
    tables = {
        "cases": [{"label": "ab", "P": 1e-5}, {"label": "c", "P": 2e-5}],
        "model": {"micro": "smooth", "h": 0.1},
        "axes": {"n": [0.5, 0.6], "bonding": ["bonded", "frictionless"]},
        "output": {"x": [0, 0.5, 1]},
    }
    found = from_tables(tables, "base", "text", "base")
    dates = ("n",), np.array(["2024-01-01", "2025-01-01"], dtype="datetime64[ns]")
    grid = replace(found.grid, labels=found.grid.labels | {"date": dates})
    return replace(found, grid=grid)


def changed(what: str, name: str, dims: tuple, *array) -> dict:
    """The base with one of its `values` or `labels` replaced."""
    grid = base().grid
    return {"grid": replace(grid, **{what: getattr(grid, what) | {name: (dims, np.array(*array))}})}


def transposed() -> dict:
    grid = base().grid
    return {"grid": replace(grid, sizes=dict(reversed(grid.sizes.items())))}


OTHERS = {
    "a number, in its last bit": lambda: changed("values", "P", ("case",), [1e-5, np.nextafter(2e-5, 1)]),
    "a word": lambda: changed("values", "bonding", ("bonding",), ["bonded", "bonded"]),
    "name of a parameter": lambda: changed("values", "nu1", (), 0.1),
    "order of values": lambda: changed("values", "n", ("n",), [0.6, 0.5]),
    "dimension of a parameter": lambda: changed("values", "P", ("n",), [1e-5, 2e-5]),
    "order of dimensions": transposed,
    "label": lambda: changed("labels", "label", ("case",), ["ab", "d"]),
    "labels run together": lambda: changed("labels", "label", ("case",), ["a", "bc"]),
    "numbers of the cases": lambda: changed("labels", "case", ("case",), [1, 2]),
    "dates": lambda: changed("labels", "date", ("n",), ["2024-01-01", "2026-01-01"], "datetime64[ns]"),
    "points": lambda: {"x": np.array([0, 0.6, 1])},
    "number of points": lambda: {"x": np.array([0, 0.5, 0.6, 1])},
    "profiles": lambda: {"profiles": ("p",)},
    "order of profiles": lambda: {"profiles": ("lam", "p")},
    "type": lambda: {"dtype": "float32"},
}


def test_every_input_is_in_the_digest(monkeypatch):
    digests = {"base": digest_of(base())} | {name: digest_of(replace(base(), **new())) for name, new in OTHERS.items()}
    monkeypatch.setattr(study.spec.definition, "NUMERICS_VERSION", "other")
    digests["numerics"] = digest_of(base())
    twins = [(a, b) for a in digests for b in digests if a < b and digests[a] == digests[b]]
    assert not twins


def test_what_changes_no_number_is_not_in_the_digest():
    same = [{"title": "t"}, {"text": "t"}, {"name": "t"}, {"block": 7}]
    assert {digest_of(replace(base(), **new)) for new in same} == {digest_of(base())}
    whole, real = (replace(base(), **changed("values", "nodes", (), zero)) for zero in (0, -0.0))
    assert digest_of(whole) == digest_of(real)


@pytest.fixture
def load(tmp_path):
    """A study of two contacts, always the same file and folder."""

    def written(numerics: str = "", model: str = "", label: str = "light") -> study.Study:
        text = f'[model]\nh = 0.5\nn = 0.5\nmicro = "smooth"\n{model}\n[numerics]\n{numerics}\n[output]\nx = 3\n'
        text += f'[[cases]]\nP = 1e-7\nlabel = "{label}"\n[[cases]]\nP = 1e-3\nlabel = "heavy"\n'
        (tmp_path / "two.toml").write_text(text, encoding="utf-8")
        return study.load(tmp_path / "two.toml", tmp_path / "results")

    return written


def fresh(opened: study.Study, folder) -> xr.Dataset:
    there = study.Study(opened.definition, folder)
    there.run()
    return there.open()


AUTO = 'base = "auto"'
EDITS = {
    "rtol": ({"numerics": "rtol = 1e-2"}, {"numerics": "rtol = 1e-10"}, "nodes_used"),
    "accuracy": (
        {"model": AUTO, "numerics": "accuracy = 1e-6"},
        {"model": AUTO, "numerics": "accuracy = 0.5"},
        "model_used",
    ),
}


@pytest.mark.parametrize(("before", "after", "seen"), EDITS.values(), ids=EDITS)
@pytest.mark.parametrize("finished", [True, False])
def test_an_edit_of_the_numerics_computes_again(load, tmp_path, before, after, seen, finished):
    """Of a finished study, and of one that stopped half-way and goes on after the edit."""
    if finished:
        load(**before).run()
        old = load(**before).open()
    else:
        old = load(**before)
        store_block(old, 0, 1)
        old = old.open(partial=True)
    edited = load(**after)
    assert edited.dry_run().present == 0
    if finished:
        with pytest.raises(study.StudyError, match="2 of its 2 cases are not in this one"):
            edited.run()
    assert edited.run(force=finished).computed == 2
    found = edited.open()
    assert_same(found, fresh(edited, tmp_path / "fresh"))
    assert found[seen].values[0] != old[seen].values[0]


def test_an_edit_of_a_label_is_in_the_results_and_computes_nothing(load):
    load().run()
    edited = load(label="small")
    assert edited.run().computed == 0
    assert edited.open().label.values.tolist() == ["small", "heavy"]
