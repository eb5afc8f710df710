"""Results of every study of the repository, shrunken so that all of them take seconds."""

import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
STUDIES = sorted((ROOT / "studies").glob("*.toml"))


def shrunken(tables: dict) -> dict:
    """The tables of a study file with long axes cut down: ranges to 4 points, lists to first, middle and last."""
    axes = {}
    for name, values in tables.get("axes", {}).items():
        if isinstance(values, dict):
            axes[name] = values | {"num": min(values["num"], 4)}
        else:
            axes[name] = values if len(values) <= 3 else [values[0], values[len(values) // 2], values[-1]]
    return tables | ({"axes": axes} if axes else {})


@pytest.fixture(scope="session")
def results(tmp_path_factory) -> Path:
    """Folder with the results of every study, shrunken."""
    from study.definition import from_tables
    from study.run import run

    folder = tmp_path_factory.mktemp("project") / "results"
    for file in STUDIES:
        text = file.read_text(encoding="utf-8")
        run(from_tables(shrunken(tomllib.loads(text)), file.stem, text, file.name), folder)
    return folder
