"""How large a study may be: what is refused as a slip, at once and with a reason, and what is just allowed."""

import numpy as np
import pytest

import study
from study import solving
from study.inputs import definition, request, sample
from study.inputs.reading import from_tables

SMOOTH = {"micro": "smooth", "base": "half_space"}


def sized(*points: int, block=None, **output):
    """A study of so many loads and Poisson ratios."""
    ends = {"P": (1e-6, 1e-4), "nu1": (0.0, 0.4), "nu2": (0.0, 0.4)}
    axes = {
        name: {"start": low, "stop": high, "num": num}
        for (name, (low, high)), num in zip(ends.items(), points, strict=False)
    }
    tables = {"model": SMOOTH, "axes": axes, "output": output}
    return from_tables(tables | ({"numerics": {"block": block}} if block is not None else {}), "s", "", "s")


def test_numbers_of_a_study():
    """16 for each case, and the points of each profile."""
    assert sized(2, 5).numbers == 10 * (16 + 2 * 33)
    assert sized(2, 5, x=5, profiles=["lam"]).numbers == 10 * (16 + 5)
    assert sized(2, 5, profiles=False).numbers == 160


def test_a_call_that_is_absurdly_large_is_refused_before_it_computes(monkeypatch):
    """More than 4 GB: half a billion numbers."""

    def solved(*_):
        raise AssertionError("computed")

    monkeypatch.setattr(solving, "solved", solved)
    loads, ratios = np.linspace(1e-6, 1e-4, 10_000), np.linspace(0.0, 0.4, 1_000)
    with pytest.raises(
        study.StudyError,
        match=r"^solve: 10000000 cases make 8.2e\+08 numbers: at most 5e\+08 \(fewer points, or profiles = false\)$",
    ):
        study.solve(P=loads, nu1=ratios, **SMOOTH)
    with pytest.raises(AssertionError, match="computed"):
        study.solve(P=loads, nu1=ratios, profiles=False, **SMOOTH)


def test_a_study_file_may_be_ten_times_larger():
    assert sized(10_000, 1_000).numbers == 820_000_000, "run asks before it computes this"
    with pytest.raises(study.StudyError, match=r"^s: 100000000 cases make 8.2e\+09 numbers: at most 5e\+09"):
        sized(10_000, 10_000)
    assert sized(10_000, 10_000, profiles=False).numbers == 1_600_000_000
    assert (definition.LARGE, definition.MOST_VALUES) == (5e8, 5e9)


LAYER = {"base": "layered", "h": 0.01, "n": 0.5}
ROUGH = {"micro": "disc_cell", "Nbar": 1e5, "Ra": 0.01}


@pytest.mark.parametrize(
    ("model", "axes", "size"),
    [
        (LAYER, {}, 8000),
        (LAYER, {"n": [0.5, 1e4, 0.4]}, 100),
        (LAYER, {"rtol": [1e-4, 1e-10, 1e-6]}, 100),
        (LAYER | {"n": 1e4}, {}, 100),
        (LAYER | {"base": "auto"}, {"rtol": [1e-10, 1e-6]}, 100),
        (LAYER | ROUGH, {"scheme": ["newton", "picard"]}, 100),
        (LAYER | ROUGH | {"base": "thin_layer"}, {"scheme": ["newton", "picard"]}, 1000),
        (LAYER, {"nodes": [12, 120]}, 1000),
        (LAYER | {"base": "thin_layer"}, {"n": [0.5, 1e4], "rtol": [1e-4, 1e-10]}, 8000),
    ],
)
def test_the_slowest_case_gives_the_usual_block(model, axes, size):
    """One is enough, wherever it stands: a block of thousands of its kind would take minutes."""
    fixed = {name: value for name, value in (SMOOTH | model).items() if name not in axes}
    tables = {"model": fixed, "axes": {"P": [1e-6, 2e-6]} | axes}
    assert definition.usual_block(from_tables(tables, "s", "", "s").grid) == size


def test_blocks_with_stresses_are_shorter():
    """A contact takes 5 to 50 ms with its largest stresses, one on a stack half a second."""
    tables = {"model": SMOOTH | LAYER, "axes": {"P": [1e-6, 2e-6]}, "output": {"stresses": True, "profiles": False}}
    assert from_tables(tables, "s", "", "s").block == 1000
    stack = {"layers": [{"h": 0.01, "n": 2.0, "nu": 0.3, "bonding": "bonded"}], "axes": tables["axes"]}
    assert from_tables(stack | {"model": SMOOTH, "output": tables["output"]}, "s", "", "s").block == 100


def test_just_allowed_and_just_refused():
    for text, right, wrong in (
        ("block", {"block": 1_000_000}, {"block": 1_000_001}),
        ("block", {"block": 1}, {"block": 0}),
        ("x", {"x": 10_000}, {"x": 10_001}),
        ("x", {"x": 2}, {"x": 1}),
    ):
        assert sized(1 + 1, **right)
        with pytest.raises(study.StudyError, match=f"{text} = "):
            sized(1 + 1, **wrong)
    assert sized(2).block == 8000 and len(sized(2).x) == 33 and sized(2, block=7).block == 7


def test_longest_axis(monkeypatch):
    assert sample.LONGEST_AXIS == request.LONGEST_AXIS == sample.LIMITS["size"][1] == 1_000_000
    for module in (sample, request):
        monkeypatch.setattr(module, "LONGEST_AXIS", 100)
    assert sized(100).grid.size == 100
    with pytest.raises(study.StudyError, match=r"P: num = 101: must be a whole number in \[2, 100\]"):
        sized(101)
    for values in (range(1, 102), list(range(1, 102)), range(1, 10**12), np.arange(1.0, 102.0)):
        with pytest.raises(study.StudyError, match="P is too long: at most 100 values are allowed"):
            study.solve(P=values, **SMOOTH)
    assert study.solve(P=range(1, 101), **SMOOTH).sizes["P"] == 100
    with pytest.raises(study.StudyError, match="P is too long"):
        from_tables({"model": SMOOTH, "axes": {"P": [1.0] * 101}}, "s", "", "s")
    assert from_tables({"model": SMOOTH, "axes": {"P": list(range(1, 101))}}, "s", "", "s").grid.size == 100
