"""Another Python process that can import this package, whatever folder the program was started in."""

import os
import sys
from pathlib import Path


def python_command(statement: str) -> tuple[list[str], dict[str, str]]:
    """Command and environment of a Python process that executes a statement.

    It looks for modules in the working folder last, because a user may have a solver.py there.
    """
    where = os.pathsep.join(filter(None, [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH")]))
    command = [sys.executable, "-P", "-c", f"import sys; sys.path.append(''); {statement}"]
    return command, os.environ | {"PYTHONPATH": where}
