"""No table of a module is written to while a call runs: what a call knows travels with its values."""

import sys
import warnings
from contextlib import suppress
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from laws import cones

import study
from solver.known import default

#: Caches of pure functions: bounded, and locked or written in one step.
CACHES = {
    "study.inverse.fits.tasks._tables",
}


def refuse(self, *_, **__):
    raise AssertionError(f"a table of a module is written to: {self.where}")


def frozen(value, where: str):
    """The table as one that refuses to be changed."""
    base = type(value)
    writing = [name for name in dir(base) if name in _WRITING]
    kind = type(f"Frozen{base.__name__}", (base,), {"where": where} | dict.fromkeys(writing, refuse))
    table = base.__new__(kind)
    if isinstance(value, dict):
        dict.update(table, value)
        vars(table).update(getattr(value, "__dict__", {}))
    elif isinstance(value, list):
        list.extend(table, value)
    else:
        set.update(table, value)
    return table


_WRITING = {
    *("__setitem__", "__delitem__", "__ior__", "__iadd__", "__iand__", "__isub__", "__ixor__", "__missing__"),
    *("update", "setdefault", "pop", "popitem", "clear", "append", "extend", "insert", "remove", "sort", "reverse"),
    *("add", "discard", "difference_update", "intersection_update", "symmetric_difference_update"),
}


@pytest.fixture
def frozen_tables(monkeypatch) -> int:
    """All tables of modules refuse to be changed; their number."""
    for path in [*(ROOT / "solver").rglob("*.py"), *(ROOT / "study").rglob("*.py")]:
        module = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        if not module.endswith("__main__"):
            with suppress(ImportError):  # of an extra that is not installed here
                import_module(module)
    tables = {}
    modules = {name: module for name, module in sys.modules.items() if name.partition(".")[0] in ("solver", "study")}
    for name, module in modules.items():
        for key, value in list(vars(module).items()):
            if key.startswith("__") or type(value) not in (dict, list, set) or f"{name}.{key}" in CACHES:
                continue
            tables.setdefault(id(value), frozen(value, f"{name}.{key}"))
            monkeypatch.setattr(module, key, tables[id(value)])
    return len(tables)


def test_no_table_is_written_to(frozen_tables, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("tip.csv").write_text("".join(f"{r},{r**2}\n" for r in np.linspace(0, 0.2, 9).tolist()))
    Path("rows.csv").write_text("0,1\n0.5,2\n1,4\n")
    Path("mine.toml").write_text('[model]\nmicro = "smooth"\nbase = "half_space"\n[axes]\nP = [1e-5, 2e-5]\n')
    before, rough = default(), {"Nbar": 1e5, "base": "half_space"}
    smooth = {"micro": "smooth", "profiles": False}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        own = study.solve(P=1e-4, alpha=0.1, micro=cones.CONES, **rough)
        study.derived.peak_pressure(own)
        study.sensitivities(own)
        study.solve(P=1e-4, Ra=0.01, sigma=0.001, micro="normal_heights", **rough)
        study.stresses(study.solve(P=1e-4, shape="table:tip.csv", base="half_space", **smooth), r=[0.0], z=[0.5])
        graded = [{"h": 0.05, "bonding": "bonded", "profile": "table:rows.csv"}]
        study.solve(a=0.05, layers=graded, rtol=1e-3, **smooth)
        study.solve(D=0.01, shape="cone", half_angle=70.0, w_adhesion=1e-4, base="half_space", **smooth)
        steel = {"R": "5 mm", "E2": "200 ± 10 GPa", "base": "half_space", "micro": "smooth"}
        str(study.summary(study.solve(P="1 N", **steel)))
        study.first_yield(Y2="1 GPa", R="5 mm", E2="200 GPa", base="half_space", micro="smooth")
        study.design({"a": "30 um"}, by={"P": ("0.1 N", "10 N")}, **steel)
        curve = {"D": ([1e-7, 3e-7, 6e-7, 1e-6], "m"), "P": (1e6 * np.array([1e-7, 3e-7, 6e-7, 1e-6]) ** 1.5, "N")}
        study.fit(curve, free="E2", R="5 mm", base="half_space", micro="smooth", nu2=0.3)
        study.load("mine.toml").run()
        study.open_results("results/mine.nc")
    assert default() is before
    assert frozen_tables > 100


def test_a_write_would_be_noticed(frozen_tables):
    from solver.laws import disc_cell

    with pytest.raises(AssertionError, match="a table of a module is written to: solver.laws.disc_cell.PARAMETERS"):
        disc_cell.PARAMETERS["h"] = None
