"""Print the lowest versions that pyproject.toml allows, in the format of pip: `make lowest` tests with them."""

import tomllib
from pathlib import Path

#: matplotlib 3.9 calls names of pyparsing of which later versions warn, and a warning fails a test.
FURTHER = ["pyparsing==3.1.0"]
EXTRAS = ("cluster", "test")


def lowest(pyproject: dict) -> list[str]:
    """Requirements "name==version" of the lowest versions."""
    project = pyproject["project"]
    allowed = pyproject["build-system"]["requires"] + project["dependencies"]
    allowed += [requirement for extra in EXTRAS for requirement in project["optional-dependencies"][extra]]
    return [requirement.replace(">=", "==") for requirement in allowed] + FURTHER


if __name__ == "__main__":
    text = Path(__file__).parents[1].joinpath("pyproject.toml").read_text(encoding="utf-8")
    print(*lowest(tomllib.loads(text)))
