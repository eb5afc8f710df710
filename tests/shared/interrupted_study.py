"""A study of 300 cases to which something happens, and how it must end: in the dataset of an undisturbed run."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from line_study import leftovers
from same import assert_same

import study

CASES, BLOCK = 300, 5
TEXT = f"""
[model]
micro = "smooth"
n = 0.5
base = "thin_layer"
[axes]
h = [0.001, 0.002, 0.003]
P = {{start = 1e-6, stop = 1e-4, num = {CASES // 3}}}
[numerics]
block = {BLOCK}
[output]
x = 3
"""


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory) -> xr.Dataset:
    folder = tmp_path_factory.mktemp("undisturbed")
    opened = written(folder)
    opened.run()
    return opened.open()


def written(folder: Path, text: str = TEXT) -> study.Study:
    (folder / "line.toml").write_text(text, encoding="utf-8")
    return study.load(folder / "line.toml", folder / "results")


def assert_ends_well(opened: study.Study, undisturbed: xr.Dataset, computed: int | None = None) -> None:
    """The next run computes so many cases, gives the dataset of an undisturbed run and leaves nothing but that and the
    blocks; all cases are in these."""
    report = opened.run(workers=2)
    assert report.complete and (computed is None or report.computed == computed)
    assert_same(opened.open(), undisturbed)
    assert opened.verify().kind == "sound" and leftovers(opened.results) == []
    assert (opened.open(partial=True).status != 127).all()


def cases_on_disk(opened: study.Study) -> set[int]:
    return set(np.flatnonzero(opened.open(partial=True).status.values.ravel() != 127).tolist())
