"""Results as datasets: flat arrays -> labelled Dataset with CF-1.11 attributes and provenance; atomic write; open.

netCDF is touched here only, and must be touched by the main thread only: from several threads it crashes, even on
different files.
"""

import json
import os
import platform
import shlex
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

import numpy as np
import xarray as xr

from solver import NUMERICS_VERSION, Model, Solution, Status

from .definition import Definition
from .derived import validity
from .grid import unflatten
from .vocabulary import CONTROLS, NOT_RUN, PARAMETERS, attributes, names

INTEGERS = {"status": np.int8, "model_used": np.int8, "iterations": np.int32, "nodes_used": np.int16}
REFERENCE = "Goryacheva & Yakovenko, Lubricants 2024, 12(3), 68, doi:10.3390/lubricants12030068"


def arrays_of(solution: Solution, profiles: bool) -> dict[str, np.ndarray]:
    """The columns that are stored: vocabulary name -> (B,), and p, lam (B, m) if wanted."""
    special = {"lam0": solution.lam[:, 0], "nodes_used": solution.nodes}
    kept = (*CONTROLS, *names("result"), *INTEGERS)
    found = {name: special[name] if name in special else getattr(solution, name) for name in kept}
    found |= {"p": solution.p, "lam": solution.lam} if profiles else {}
    return {name: np.asarray(array, dtype=INTEGERS.get(name, np.float64)) for name, array in found.items()}


def not_run(definition: Definition) -> dict[str, np.ndarray]:
    """What `arrays_of` gives for cases that were never computed: NaN, status NOT_RUN, counts 0."""
    size = definition.grid.size
    found = {name: np.full(size, np.nan) for name in (*CONTROLS, *names("result"))}
    found |= {name: np.full((size, len(definition.x)), np.nan) for name in names("profile") if definition.profiles}
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
    return xr.Dataset(variables, coordinates, provenance(definition, command))


def status_attributes() -> dict:
    """CF flags of `status`: the solver's statuses and 127, not run."""
    words = {int(status): status.name.lower() for status in Status} | {NOT_RUN: "not_run"}
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
        "source": f"roughcoat {_version('roughcoat')}",
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
            | {p: _version(p) for p in ("numpy", "scipy", "xarray", "dask", "netCDF4")}
        ),
        "cpu": cpu(),
        "blas": blas(),
        "created": created,
    }


def command_line() -> str:
    """The command that is running, without the folder of the interpreter."""
    program = Path(sys.argv[0])
    first = "python -m study" if program.name == "__main__.py" and program.parent.name == "study" else program.name
    return f"{first} {shlex.join(sys.argv[1:])}".strip()


def git_commit() -> str:
    """Commit of the checkout that holds this package, "-dirty" if tracked files were changed; "unknown" without one."""
    root = Path(__file__).resolve().parents[1]
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


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "unknown"


@contextmanager
def interrupts_wait() -> Iterator[None]:
    """Hold SIGINT back until the block is left: an exception inside xarray's locks leaves one locked, and hangs."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    pending = []
    previous = signal.signal(signal.SIGINT, lambda *_: pending.append(True))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous or signal.SIG_DFL)
        if pending:
            signal.raise_signal(signal.SIGINT)


def write(dataset: xr.Dataset, path: Path) -> None:
    """Write netCDF so that `path` either is complete or does not exist: a temporary name beside it, then a rename."""
    encoding = {
        name: {"_FillValue": None}
        for name, array in dataset.variables.items()
        if name in dataset.coords or array.dtype.kind in "iu"
    }
    for name, array in dataset.data_vars.items():
        if array.dtype.kind in "fiu" and array.ndim:
            encoding[name] = encoding.get(name, {}) | {"zlib": True, "complevel": 1, "shuffle": True}
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with interrupts_wait():
            dataset.to_netcdf(temporary, engine="netcdf4", encoding=encoding)
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())  # a rename may reach the disk before the data do
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def open_results(path) -> xr.Dataset:
    """A results file, read into memory and closed. Raises OSError when it does not exist or is no netCDF file."""
    with interrupts_wait(), xr.open_dataset(path, engine="netcdf4") as dataset:
        return dataset.load()


def digest_in(path: Path) -> str:
    """Digest of the study that a results file belongs to; "" for a file that is none of ours."""
    try:
        with interrupts_wait(), xr.open_dataset(path, engine="netcdf4") as dataset:
            return str(dataset.attrs.get("study_digest", ""))
    except (OSError, ValueError):
        return ""
