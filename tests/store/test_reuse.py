"""Cases are computed once: keys of cases, extending and reordering a study, what is refused and what --force does."""

import itertools
import shutil

import numpy as np
import pytest
import xarray as xr
from line_study import store_block
from same import assert_same

import study
from study.inputs import identity
from study.inputs.grid import Grid
from study.inputs.identity import case_keys, find
from study.store import blocks, window_files

BASE = {"micro": '"smooth"', "base": '"thin_layer"', "n": "0.5"}
AXES = {"P": "[1e-6, 2e-6, 4e-6]", "h": "[0.001, 0.002]"}
MORE = {"P": "[1e-6, 2e-6, 3e-6, 4e-6]", "h": "[0.001, 0.002]"}


@pytest.fixture
def load(tmp_path):
    """A study of these axes, always the same file and folder."""

    def written(axes=AXES, model=BASE, output="x = 3", more="") -> study.Study:
        lines = ["[model]", *(f"{name} = {value}" for name, value in model.items() if name not in axes), "[axes]"]
        lines += [*(f"{name} = {value}" for name, value in axes.items()), "[numerics]\nblock = 2", "[output]", output]
        (tmp_path / "line.toml").write_text("\n".join(lines) + more, encoding="utf-8")
        return study.load(tmp_path / "line.toml", tmp_path / "results")

    return written


def fresh(opened: study.Study, tmp_path) -> xr.Dataset:
    """The same study computed from nothing."""
    there = study.Study(opened.definition, tmp_path / "fresh")
    there.run()
    return there.open()


EXTENDED = {
    "value": (MORE, 2),
    "values of two axes": ({"P": "[2e-6, 1e-6, 0.5e-6, 4e-6]", "h": "[0.002, 0.003, 0.001]"}, 6),
    "axis": (AXES | {"rtol": "[1e-6, 1e-7]"}, 6),
    "axis of what is not used": (AXES | {"nu1": "[0.3, 0.4]"}, 0),
    "axis in front": ({"n": "[0.4, 0.5]"} | AXES, 6),
    "order of axes": ({"h": AXES["h"], "P": AXES["P"]}, 0),
    "order of values": ({"h": "[0.002, 0.001]", "P": "[4e-6, 1e-6, 2e-6]"}, 0),
    "axis of words": ({"bonding": '["bonded", "frictionless"]'} | AXES, 6),
}
STATES = [(name, True) for name in EXTENDED] + [("values of two axes", False), ("axis in front", False)]


@pytest.mark.parametrize(("change", "finished"), STATES)
def test_only_new_cases_are_computed(load, tmp_path, computed, change, finished):
    """Of a finished study, and of one that was stopped."""
    axes, new = EXTENDED[change]
    if finished:
        load().run()
    else:
        for start in range(0, 6, 2):
            store_block(load(), start, start + 2)
    extended = load(axes)
    size = extended.definition.grid.size
    assert extended.dry_run().present == size - new
    assert extended.status()["counts"] == {0: size - new} | ({127: new} if new else {})
    computed.clear()
    assert extended.run().computed == new
    assert len(computed) == -(-new // 2)
    assert_same(extended.open(), fresh(extended, tmp_path))


def test_regrouping_axes_to_single_cases_computes_nothing(load, tmp_path):
    load().run()
    rows = "".join(f"[[cases]]\nP = {P}\nh = {h}\n" for h, P in itertools.product((0.002, 0.001), (4e-6, 1e-6, 2e-6)))
    regrouped = load({}, output="x = 3\n", more=rows)
    assert regrouped.run().computed == 0
    assert_same(regrouped.open(), fresh(regrouped, tmp_path))


def test_results_that_would_lose_cases_are_refused(load):
    load().run()
    before = load().open()
    with pytest.raises(study.StudyError, match="definition .* 2 of its 6 cases are not in this one: --force replaces"):
        load(AXES | {"P": "[1e-6, 2e-6]"}).run()
    assert_same(load().open(), before)
    assert load(AXES | {"P": "[1e-6, 2e-6, 8e-6]"}).run(force=True).computed == 2
    assert load().run(force=True).computed == 0, "the blocks keep what the results have lost"
    assert_same(load().open(), before)


def test_results_of_which_no_block_tells_the_cases_are_refused(load):
    """Such as those of an earlier version, which removed its blocks."""
    load().run()
    shutil.rmtree(load().results / ".line.blocks")
    with pytest.raises(study.StudyError, match="definition .* which cases cannot be told: --force replaces them"):
        load(MORE).run()
    assert load(MORE).run(force=True).computed == 8


def test_fewer_outputs_are_taken_from_what_is_there_but_not_more(load, tmp_path):
    load().run()
    for output, new in (
        ('x = 3\nprofiles = ["lam"]', 0),
        ("x = 3\nprofiles = false", 0),
        ('x = 3\nprofiles = false\ndtype = "float32"', 0),
    ):
        opened = load(output=output)
        assert opened.run().computed == new
        xr.testing.assert_allclose(opened.open(), fresh(opened, tmp_path / output), rtol=1e-6, atol=0)
    assert load().run().computed == 0, "the first blocks have all of it"
    assert load(output="x = 5").run().computed == 6
    (load().results / "line.nc").unlink()
    assert load().status()["counts"] == {0: 6}


@pytest.mark.parametrize(
    ("output", "names", "dtype"),
    [
        ("x = 3", {"p", "lam"}, "f8"),
        ('profiles = ["lam"]\nx = 3', {"lam"}, "f8"),
        ("profiles = false\nx = 3", set(), "f8"),
        ('dtype = "float32"\nx = 3', {"p", "lam"}, "f4"),
    ],
)
def test_outputs_are_chosen_in_the_study(load, output, names, dtype):
    opened = load(output=output)
    opened.run()
    found = opened.open()
    assert {"p", "lam"} & set(found) == names
    assert {found[name].dtype for name in {"a", "p_max", *names}} == {np.dtype(dtype)}
    assert found.h.dtype == np.float64, "what is given stays as given"


def test_wrong_outputs_are_named(load):
    with pytest.raises(study.StudyError, match=r'profiles = \[\'q\'\]: must be true or false, or a list of "p", "lam"'):
        load(output='profiles = ["q"]')
    with pytest.raises(study.StudyError, match=r'dtype = "half": must be one of "float64", "float32"'):
        load(output='dtype = "half"')


def renumber(monkeypatch, version: str) -> None:
    from study.data import provenance
    from study.work import cases, plan

    for module in (identity, blocks, window_files, plan, cases, provenance):
        monkeypatch.setattr(module, "NUMERICS_VERSION", version)


def test_another_version_of_the_numerics_is_refused_with_a_choice(load, monkeypatch, tmp_path):
    load().run()
    renumber(monkeypatch, "next")
    with pytest.raises(study.StudyError, match=r"of version \S+ of the numerics, this is next: --force computes them"):
        load(MORE).run()
    with pytest.raises(study.StudyError, match="holds results of another version of the numerics; run the study first"):
        load().open()
    assert load(MORE).run(force=True).computed == 8


def test_blocks_of_another_version_of_the_numerics_are_not_used(load, monkeypatch):
    path = store_block(load(), 0, 2)
    with monkeypatch.context() as patched:
        renumber(patched, "next")
        assert load().run().computed == 6
        assert path.exists()
        assert load().clean()[0].endswith("removed 1 block of 2 cases; the study needs the other 3 blocks")


def test_a_worker_of_another_version_computes_nothing(load, monkeypatch):
    from study.work import cases

    wanted = cases.parcel(load().definition, np.arange(2))
    monkeypatch.setattr(cases, "NUMERICS_VERSION", "next")
    assert "the worker has version next of the numerics" in cases.guarded(wanted).message


def grid(**values) -> Grid:
    sizes = {name: len(array) for name, array in values.items()}
    return Grid(sizes, {name: ((name,), np.array(array)) for name, array in values.items()})


def test_keys_tell_cases_apart():
    keys = case_keys(grid(P=np.geomspace(1e-7, 1e-3, 100), h=np.linspace(0.001, 0.1, 100), n=np.linspace(0, 1, 100)))
    assert keys.shape == (1_000_000, 2)
    assert len(np.unique(keys[:, 0])) == len(np.unique(keys[:, 1])) == 1_000_000
    near = case_keys(grid(P=[1.0, np.nextafter(1.0, 2.0)]))
    assert (near[0] != near[1]).all()


def test_keys_are_of_names_and_values():
    assert (case_keys(grid(P=[1.0, 2.0])) != case_keys(grid(a=[1.0, 2.0]))).all()
    assert (case_keys(grid(h=[1.0], n=[2.0])) != case_keys(grid(h=[2.0], n=[1.0]))).all()
    assert (case_keys(grid(bonding=["bonded"])) != case_keys(grid(bonding=["frictionless"]))).all()
    np.testing.assert_array_equal(case_keys(grid(k=[0.0])), case_keys(grid(k=[-0.0])))
    np.testing.assert_array_equal(case_keys(grid(P=[1.0], h=[np.nan])), case_keys(grid(P=[1.0])))
    np.testing.assert_array_equal(case_keys(grid(nodes=[16])), case_keys(grid(nodes=[16.0])))


def test_keys_do_not_depend_on_the_order_of_the_axes():
    h, n = [1.0, 2.0, 3.0], [4.0, 5.0]
    one = case_keys(grid(h=h, n=n)).reshape(3, 2, 2)
    np.testing.assert_array_equal(one.transpose(1, 0, 2), case_keys(grid(n=n, h=h)).reshape(2, 3, 2))
    n_of_h = np.array([[4.0, 5.0, 4.0], [5.0, 4.0, 5.0]])
    crossed = Grid({"h": 3, "n": 2}, {"h": (("h",), np.array(h)), "n": (("n", "h"), n_of_h)})
    np.testing.assert_array_equal(case_keys(crossed).reshape(3, 2, 2)[::2], one[::2])
    np.testing.assert_array_equal(case_keys(crossed).reshape(3, 2, 2)[1], one[1, ::-1])


def test_find_takes_the_row_of_lowest_rank():
    known = np.array([[5, 1], [3, 1], [5, 1], [3, 2]], dtype=np.uint64)
    keys = np.array([[5, 1], [3, 1], [4, 1], [5, 2]], dtype=np.uint64)
    assert find(keys, known, np.array([3, 0, 1, 9])).tolist() == [2, 1, -1, -1]
    assert find(keys, known[:0], np.empty(0)).tolist() == [-1] * 4
