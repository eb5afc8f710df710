"""What a case and a study are recognised by: what counts for a case is in its key, every input in the digest.

Whatever were left out would be served stale after an edit. What changes no number is in neither.
"""

import hashlib
import struct
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from punched import PUNCH

import solver
from solver.parameters import CONTROL, EVERY, NamedRows, Parameter
from study.inputs import identity
from study.inputs.definition import Definition
from study.inputs.grid import Grid
from study.inputs.identity import case_keys, digest_of
from study.inputs.lexicon import PACKAGE, Lexicon
from study.inputs.reading import from_tables
from study.inputs.vocabulary import NUMERICS, PARAMETERS, VOCABULARY, Entry, Names
from study.work.cases import compute, parcel

OF_ALL = CONTROL | solver.known.PARAMETERS
COMPARED = ("hardness", "yield_strength", "Y1", "Y2", "Y_punch")  # with the answer, which does not depend on them

TWO = {  # allowed values of every parameter
    "P": (1e-5, 1.000001e-5),
    "a": (0.04, 0.05),
    "D": (1e-3, 2e-3),
    "h": (0.02, 0.03),
    "n": (0.5, 0.6),
    "m": (0.0, 0.1),
    "nu1": (0.3, 0.31),
    "nu2": (0.3, 0.0),
    "bonding": ("frictionless", "bonded"),
    "base": ("layered", "thin_layer"),
    "Nbar": (250000, 250001),
    "Ra": (0.004, 0.005),
    "micro": ("disc_cell", "power_law"),
    "asperities_on": ("auto", "half_space"),
    "B": (0.1, 0.2),
    "beta": (0.5, 0.53),
    "sigma": (1e-5, 2e-5),
    "cut": (4.0, 3.5),
    **dict.fromkeys(COMPARED, (0.02, 0.021)),
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
    refused = ("sigma", "cut") if values["micro"] == "elastic_plastic" else ()
    model = {name: value for name, value in values.items() if name not in (*NUMERICS, *refused)}
    return from_tables({"model": model, "numerics": numerics}, "one", "", "one")


def test_the_table_has_every_parameter():
    assert {*TWO, *PUNCH} == {*PARAMETERS} - {"table_unit"}, "that is of a file, whose numbers are in the key"


#: Where a parameter is used that the case of `defined` does without.
USED = {
    **dict.fromkeys(("nu1", "nu2"), {"bonding": "bonded"}),
    **dict.fromkeys(("B", "beta"), {"micro": "power_law"}),
    **dict.fromkeys(("sigma", "cut"), {"micro": "normal_heights"}),
    **dict.fromkeys(("hardness", "yield_strength"), {"micro": "elastic_plastic"}),
    "k": {"scheme": "picard"},
    "accuracy": {"base": "auto"},
    "model_check": {"base": "thin_layer"},
}
#: Where it is not.
BASES = [{"base": base} for base in ("half_space", "thin_layer", "layered", "auto")]
SMOOTH, HALF_SPACE = {"micro": "smooth"}, BASES[0]
UNUSED = {
    **dict.fromkeys(("h", "n", "bonding"), [HALF_SPACE]),
    **dict.fromkeys(("nu1", "nu2"), [HALF_SPACE | {"bonding": "bonded"}, *BASES]),
    **dict.fromkeys(("Nbar", "Ra"), [SMOOTH]),
    **dict.fromkeys(("B", "beta"), [SMOOTH, *BASES]),
    **dict.fromkeys(("sigma", "cut"), [SMOOTH, HALF_SPACE]),
    "asperities_on": [HALF_SPACE],
    **dict.fromkeys(COMPARED, [SMOOTH, *BASES, {"micro": "normal_heights"}]),
    "k": BASES,
    "accuracy": BASES[:3],
    "model_check": [*BASES[:1], *BASES[2:], BASES[3] | SMOOTH],
}


@pytest.mark.parametrize("name", [name for name in TWO if name not in COMPARED[2:]])
def test_every_parameter_is_in_key_and_digest(name):
    """Of the cases that use it."""
    one, same, other = (defined(**USED.get(name, {}) | {name: TWO[name][i]}) for i in (0, 0, 1))
    assert (case_keys(one.grid) == case_keys(same.grid)).all() and one.digest == same.digest
    assert (case_keys(one.grid) != case_keys(other.grid)).all(), "both halves of the key"
    assert one.digest != other.digest


@pytest.mark.parametrize("name", UNUSED)
def test_what_a_case_does_not_use_changes_nothing(name):
    """Neither its key, nor a single bit of its numbers, nor the digest of the study, but where its flags may differ."""
    for where in UNUSED[name]:
        one, other = (defined(**where | {name: two}) for two in TWO[name])
        assert_array_equal(case_keys(one.grid), case_keys(other.grid), str(where))
        assert (one.digest == other.digest) == (name not in COMPARED), where
        found = [compute(parcel(definition, np.arange(1))) for definition in (one, other)]
        for number, values in found[0].items():
            assert_array_equal(values, found[1][number], f"{number} {where}")


def test_every_parameter_is_used_by_all_or_tested():
    always = {name for name in TWO if OF_ALL[name].needed_by == OF_ALL[name].used_by == EVERY}
    assert always | {*UNUSED, *PUNCH, "table_unit"} >= set(PARAMETERS)


def of_tomorrow() -> Lexicon:
    """A lexicon with one parameter more."""
    known = replace(PACKAGE.known)
    known.__dict__["parameters"] = NamedRows({**known.parameters, "tilt": Parameter(0.0, interval="[0, 1]")})
    lexicon = Lexicon(known)
    lexicon.__dict__["rows"] = NamedRows({**VOCABULARY, "tilt": Entry("tilt", "material", "tilt of the punch")})
    lexicon.__dict__["parameters"] = Names((*PARAMETERS, "tilt"))
    return lexicon


def test_a_parameter_of_tomorrow_changes_nothing_until_it_is_given():
    """A tilt of the punch, say, 0 by default. Results and blocks of today stay those of their cases."""
    today = defined()
    grid = replace(today.grid, lexicon=of_tomorrow())
    for tilt, same in ((None, True), (0.0, True), (0.5, False)):
        values = today.grid.values | ({} if tilt is None else {"tilt": ((), np.array(tilt))})
        tilted = replace(today, grid=replace(grid, values=values))
        assert (case_keys(tilted.grid) == case_keys(today.grid)).all() == same
        assert (digest_of(tilted) == today.digest) == same


def test_what_counts_for_some_cases_alone(monkeypatch):
    """h along the cases, along an axis beside that of the bases, and over both."""
    rows = [{"base": "half_space", "h": 0.02}, {"base": "layered", "h": 0.02}]
    model = {"P": 1e-5, "n": 0.5, "micro": "smooth"}

    def cases(first: float, second: float) -> Definition:
        given = [row | {"h": h} for row, h in zip(rows, (first, second), strict=True)]
        return from_tables({"model": model, "cases": given}, "two", "", "two")

    one, unused, used = cases(0.02, 0.02), cases(0.03, 0.02), cases(0.02, 0.03)
    assert (case_keys(one.grid) == case_keys(unused.grid)).all() and one.digest == unused.digest
    assert (case_keys(one.grid) == case_keys(used.grid)).all(axis=1).tolist() == [True, False]
    assert one.digest != used.digest

    crossed = from_tables({"model": model, "axes": {"base": ["half_space", "layered"], "h": [0.02, 0.03]}}, "", "", "")
    found = case_keys(crossed.grid).reshape(2, 2, 2)
    assert (found[0, 0] == found[0, 1]).all() and (found[1, 0] != found[1, 1]).all()
    assert (found[0, 0] == case_keys(one.grid)[0]).all() and (found[1, 0] == case_keys(one.grid)[1]).all()

    def over_both(*h) -> Grid:
        thick = ("h0", "base"), np.array(h)  # in another order than that of the grid
        return replace(crossed.grid, sizes={"base": 2, "h0": 2}, values=crossed.grid.values | {"h": thick})

    one, unused, used = (over_both([0.02, 0.02], h) for h in ([0.02, 0.03], [0.05, 0.03], [0.02, 0.04]))
    assert (case_keys(one) == case_keys(unused)).all() and (case_keys(one) != case_keys(used)).any()
    digests = [digest_of(replace(crossed, grid=grid)) for grid in (one, unused, used)]
    assert digests[0] == digests[1] != digests[2]


def bits(value) -> int:
    if isinstance(value, str):
        return int.from_bytes(hashlib.blake2b(value.encode(), digest_size=8).digest(), "little")
    return struct.unpack("<Q", struct.pack("<d", value))[0]


def mixed(z: int) -> int:
    """The finalizer of splitmix64, as published (Steele, Lea & Flood 2014, variant 13 of Stafford)."""
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
    z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
    return z ^ z >> 31


def summed(values: dict) -> list[int]:
    """The key of these names and values."""
    lanes = [0, 0]
    for name, value in values.items():
        seeds = hashlib.blake2b(name.encode(), digest_size=16).digest()
        for i in (0, 1):
            seed = int.from_bytes(seeds[8 * i : 8 * i + 8], "little")
            lanes[i] = (lanes[i] + mixed(bits(value) ^ seed)) % 2**64
    return lanes


def test_a_key_is_the_sum_of_the_hashes_of_what_counts():
    """Other keys would make every block and results file on a disk worthless."""
    one = {name: TWO[name][0] for name in ("P", "h", "n", "Nbar", "Ra")}
    assert case_keys(defined().grid).tolist() == [summed(one)]
    law = one | {"micro": "power_law", "B": 0.2, "beta": 0.53, "rtol": 1e-9}
    assert case_keys(defined(**law).grid).tolist() == [summed(law)]


@pytest.mark.parametrize("one", [np.nan, 0.0])
def test_nan_and_nought_have_no_sign(one):
    """Arithmetic on other processors sets that of NaN; a range may end in -0.0."""
    ours, other = (Grid({"h": 1}, {"h": (("h",), np.array([value]))}) for value in (one, -one))
    assert np.signbit(-one) and (case_keys(ours) == case_keys(other)).all()


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
    monkeypatch.setattr(identity, "NUMERICS_VERSION", "other")
    digests["numerics"] = digest_of(base())
    twins = [(a, b) for a in digests for b in digests if a < b and digests[a] == digests[b]]
    assert not twins


def test_what_changes_no_number_is_not_in_the_digest():
    same = [{"title": "t"}, {"text": "t"}, {"name": "t"}, {"block": 7}]
    assert {digest_of(replace(base(), **new)) for new in same} == {digest_of(base())}
    whole, real = (replace(base(), **changed("values", "nodes", (), zero)) for zero in (0, -0.0))
    assert digest_of(whole) == digest_of(real)


def test_asperities_far_apart_on_a_layer_have_keys_of_their_own(monkeypatch):
    """Of these alone `model_error` has changed; those of others stay. So do the digests."""
    model, keys, digests = {"n": 0.5, "Nbar": 250000.0, "Ra": 0.004, "bonding": "bonded", "P": 1e-5}, [], []
    for word in ("as it was", "raised"):
        monkeypatch.setattr(identity, "_OF_CELLS", word)
        studies = [
            from_tables({"model": model, "axes": {"h": h}}, "one", "", "one")
            for h in ([0.0019, 0.0021], [0.0021, 0.02])
        ]
        keys.append(case_keys(studies[0].grid))
        digests.append([study.digest for study in studies])
    assert (keys[0] != keys[1]).any(axis=1).tolist() == [True, False]
    assert [one != other for one, other in zip(*digests, strict=True)] == [True, False]


def test_strengths_of_materials_are_in_the_digest(monkeypatch):
    """The flags in a file compare with them: of materials without a strength nothing has changed."""
    model = {"R": "5 mm", "punch": "rigid", "base": "half_space", "micro": "smooth", "P": "1 N"}
    for body, counts in (("PMMA", True), ("copper", False)):
        digests = []
        for word in ("2", "raised"):
            monkeypatch.setattr(identity, "_OF_STRENGTHS", word)
            digests.append(from_tables({"model": model | {"body": body}}, "one", "", "one").digest)
        assert (digests[0] != digests[1]) == counts
