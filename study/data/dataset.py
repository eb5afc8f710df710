"""Results as datasets: flat arrays -> labelled Dataset with CF-1.11 attributes and provenance."""

import json
import os
import platform
import shlex
import subprocess
import sys
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

import numpy as np
import xarray as xr

from solver import NUMERICS_VERSION, Model, Status

from ..spec.definition import Definition
from ..spec.grid import unflatten
from ..spec.identity import law_versions
from ..spec.vocabulary import CONTROLS, INTEGERS, NOT_RUN, PARAMETERS, attributes, names
from .derived import validity

NO_SOLUTION = (Status.THIN_LAYER_NOT_APPLICABLE, Status.LIFT_OFF)
"""Statuses of cases whose equations have no solution that the model means: no failure of the solver."""
REFERENCE = "Goryacheva & Yakovenko, Lubricants 2024, 12(3), 68, doi:10.3390/lubricants12030068"


def not_run(definition: Definition, size: int) -> dict[str, np.ndarray]:
    """What `arrays_of` gives for `size` cases that were never computed: NaN, status NOT_RUN, counts 0."""
    found = {name: np.full(size, np.nan, definition.dtype) for name in (*CONTROLS, *names("result"))}
    found |= {name: np.full((size, len(definition.x)), np.nan, definition.dtype) for name in definition.profiles}
    found |= {name: np.zeros(size, dtype) for name, dtype in INTEGERS.items()}
    found["status"][:] = NOT_RUN
    return found


def labelled(definition: Definition, arrays: dict[str, np.ndarray], command: str) -> xr.Dataset:
    """Dataset of the whole grid from flat arrays (B, ...): dimensions in the order of the study, then `x`."""
    dataset = assembled(definition, arrays, "x", definition.x, command)
    dataset["status"].attrs |= status_attributes()
    dataset["model_used"].attrs |= model_attributes()
    return dataset.assign(validity=validity(dataset))


def assembled(
    definition: Definition, arrays: dict[str, np.ndarray], last: str, points: np.ndarray, command: str
) -> xr.Dataset:
    """Dataset of flat arrays: (B,) over the grid, (B, m) over the grid and the dimension `last` with its m points."""
    grid = definition.grid
    known = {name: attributes(name) for name in (*PARAMETERS, *names("coordinate"))}
    coordinates = {
        name: (dims, array, known.get(name, {})) for name, (dims, array) in (grid.values | grid.labels).items()
    }
    coordinates[last] = (last,), points, attributes(last)
    dims = tuple(grid.sizes)
    variables = {
        name: (dims + (last,) * (flat.ndim - 1), unflatten(grid, flat), attributes(name))
        for name, flat in arrays.items()
        if name not in grid.values
    }
    told = {"micro_laws": "\n".join(found)} if (found := law_versions(grid)) else {}
    return plainly_written(xr.Dataset(variables, coordinates, provenance(definition, command) | told))


def plainly_written(dataset: xr.Dataset) -> xr.Dataset:
    """The same dataset, marked so that a user's `to_netcdf` gives coordinates no _FillValue, which CF forbids there."""
    for name in dataset.coords:
        dataset.variables[name].encoding["_FillValue"] = None
    return dataset


def status_words() -> dict[int, str]:
    """What the values of `status` are called: the solver's statuses and 127, not run."""
    return {int(status): status.name.lower() for status in Status} | {NOT_RUN: "not_run"}


def status_attributes() -> dict:
    """CF flags of `status`."""
    words = status_words()
    sentences = {int(status): status.meaning for status in Status} | {NOT_RUN: "the case has not been computed"}
    return {
        "flag_values": np.array(list(words), dtype=np.int8),
        "flag_meanings": " ".join(words.values()),
        "comment": "; ".join(f"{value}: {text}" for value, text in sentences.items()),
    }


def model_attributes() -> dict:
    """CF flags of `model_used`."""
    values = np.array([int(model) for model in Model], dtype=np.int8)
    return {"flag_values": values, "flag_meanings": " ".join(model.name.lower() for model in Model)}


def provenance(definition: Definition, command: str) -> dict:
    """Global attributes: what was computed, by which code, on what machine."""
    created = datetime.now(UTC).isoformat(timespec="seconds")
    return {
        "Conventions": "CF-1.11",
        "title": definition.title or definition.name,
        "source": f"roughcoat {package_version('roughcoat')}",
        "references": REFERENCE,
        "history": f"{created} {command}",
        "study": definition.text,
        "study_name": definition.name,
        "study_digest": definition.digest,
        "numerics_version": NUMERICS_VERSION,
        "command": command,
        "git_commit": git_commit(),
        "versions": json.dumps(
            {"python": platform.python_version()}
            | {p: package_version(p) for p in ("numpy", "scipy", "xarray", "dask", "netCDF4")}
        ),
        "cpu": cpu(),
        "blas": blas(),
        "created": created,
    }


def command_line() -> str:
    """The command that is running, without the folder of the interpreter."""
    program = Path(sys.argv[0])
    first = "python -m study" if program.name == "__main__.py" and program.parent.name == "study" else program.name
    text = f"{first} {shlex.join(sys.argv[1:])}".strip()
    return text.encode("utf-8", "backslashreplace").decode()  # a path may be other bytes, an attribute may not


def git_commit() -> str:
    """Commit of the checkout that holds this package, "-dirty" if tracked files were changed; "unknown" without one."""
    root = Path(__file__).resolve().parents[2]
    if not (root / ".git").exists():  # installed: a repository further up would be another project's
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
    found = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{found[0]} ({os.cpu_count()} logical)" if found else platform.processor() or platform.machine()


def blas() -> str:
    """Name and version of the BLAS library that numpy was built with."""
    found = np.show_config(mode="dicts").get("Build Dependencies", {}).get("blas", {})
    return f"{found.get('name', 'unknown')} {found.get('version', '')}".strip()


def package_version(package: str) -> str:
    """Of an installed package; "unknown" without one."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "unknown"
