"""Another Python process that can import this package, whatever folder the program was started in."""

import os
import sys
from pathlib import Path


def python(statement: str) -> tuple[list[str], dict[str, str]]:
    """Command and environment of a Python process that executes a statement."""
    where = os.pathsep.join(filter(None, [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH")]))
    return [sys.executable, "-c", statement], os.environ | {"PYTHONPATH": where}
