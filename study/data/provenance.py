"""Where results come from: the study, the command, the code and the machine."""

import json
import os
import platform
import shlex
import subprocess
import sys
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from pathlib import Path

import numpy as np

from solver import NUMERICS_VERSION

from ..inputs.definition import Definition

REFERENCE = "Goryacheva & Yakovenko, Lubricants 2024, 12(3), 68, doi:10.3390/lubricants12030068"


OF_THE_RUN = ("history", "command", "created", "source", "git_commit", "versions", "cpu", "blas")
"""Attributes about the run that computed the numbers: command, time, code and machine."""


def provenance(definition: Definition, command: str) -> dict:
    """Global attributes: the study, the code and the machine."""
    created = datetime.now(UTC).isoformat(timespec="seconds")
    return {
        "Conventions": "CF-1.11",
        "title": definition.title or definition.name,
        "references": REFERENCE,
        "history": f"{created} {command}",
        "study": definition.text,
        "study_name": definition.name,
        "study_digest": definition.digest,
        "numerics_version": NUMERICS_VERSION,
        "command": command,
        **machine(),
        "created": created,
    }


@cache  # reading versions and asking git takes 10 ms
def machine() -> dict:
    """The attributes that do not change while a program runs."""
    packages = ("numpy", "scipy", "xarray", "dask", "netCDF4")
    versions = {"python": platform.python_version()} | {name: package_version(name) for name in packages}
    return {
        "source": f"roughcoat {package_version('roughcoat')}",
        "git_commit": git_commit(),
        "versions": json.dumps(versions),
        "cpu": cpu(),
        "blas": blas(),
    }


def command_line() -> str:
    """The command that is running, without the folder of the interpreter."""
    program = Path(sys.argv[0])
    ours = program.name == "__main__.py" and program.parent.name in ("roughcoat", "study")
    first = f"python -m {program.parent.name}" if ours else program.name
    text = f"{first} {shlex.join(sys.argv[1:])}".strip()
    # a path may have bytes that are not UTF-8, which no attribute can hold
    return text.encode("utf-8", "backslashreplace").decode()


def git_commit() -> str:
    """Commit of the checkout that holds this package, with "-dirty" if tracked files have changed; else "unknown"."""
    root = Path(__file__).resolve().parents[2]
    if not (root / ".git").exists():  # the package is installed: a repository further up belongs to another project
        return "unknown"
    command = ["git", "-C", str(root), "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=10, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def cpu() -> str:
    """Name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{models[0]} ({os.cpu_count()} logical)" if models else platform.processor() or platform.machine()


def blas() -> str:
    """Name and version of the BLAS library that numpy was built with."""
    library = np.show_config(mode="dicts").get("Build Dependencies", {}).get("blas", {})
    return f"{library.get('name', 'unknown')} {library.get('version', '')}".strip()


def package_version(package: str) -> str:
    """Version of an installed package; "unknown" if it is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "unknown"
