"""The notebooks are those of their scripts, and run."""

import pytest
from conftest import ROOT
from notebooks import SCRIPTS, notebook


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_notebook_is_that_of_its_script(name):
    """`python tools/notebooks.py` writes them."""
    made = notebook((ROOT / f"docs/gallery/{name}.py").read_text(encoding="utf-8"))
    assert made == (ROOT / f"docs/notebooks/{name[8:]}.ipynb").read_text(encoding="utf-8")
    assert made.count('"cell_type": "code"') == 3


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_notebook_runs(name, tmp_path, monkeypatch):
    nbformat = pytest.importorskip("nbformat", reason="make docs installs nbclient")
    nbclient = pytest.importorskip("nbclient", reason="make docs installs nbclient")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    made = nbformat.read(ROOT / f"docs/notebooks/{name[8:]}.ipynb", as_version=4)
    limits = {
        "timeout": 120,
        "startup_timeout": 120,
    }  # seconds, of a cell and of a kernel that starts on a busy machine
    nbclient.NotebookClient(made, **limits, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in made.cells if cell.cell_type == "code" for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in shown)
