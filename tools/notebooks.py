"""Notebooks of some scripts of the gallery: `python tools/notebooks.py` writes docs/notebooks."""

import ast
import json
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SCRIPTS = ("plot_01_ball_on_dlc", "plot_03_bead_on_gel")


def notebook(text: str) -> str:
    """The notebook of a script: its docstring and the comments of its cells are text, the rest is code."""
    title, _, rest = ast.get_docstring(ast.parse(text)).partition("\n")
    cells = [_cell("markdown", f"# {title}\n\n{rest.lstrip('=').strip()}")]
    for part in re.split(r"^# %%\n", text.split('"""', 2)[2], flags=re.MULTILINE):
        words = re.match(r"(?:#[^\n]*\n)*", part)[0]
        cells += [_cell("markdown", re.sub(r"^# ?", "", words, flags=re.MULTILINE))] * bool(words)
        cells.append(_cell("code", part[len(words) :]))
    for number, cell in enumerate(cells):
        cell["id"] = f"cell-{number}"
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    contents = {"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(contents, indent=1, ensure_ascii=False) + "\n"


def _cell(kind: str, text: str) -> dict:
    fields = {"execution_count": None, "outputs": []} if kind == "code" else {}
    return {"cell_type": kind, "metadata": {}, "source": text.strip().splitlines(keepends=True), **fields}


def main() -> None:
    folder = ROOT / "docs/notebooks"
    folder.mkdir(exist_ok=True)
    for name in SCRIPTS:
        text = (ROOT / f"docs/gallery/{name}.py").read_text(encoding="utf-8")
        (folder / f"{name[8:]}.ipynb").write_text(notebook(text), encoding="utf-8")


if __name__ == "__main__":
    main()
