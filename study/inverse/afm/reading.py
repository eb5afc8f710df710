"""Force curves in the files of instruments, by afmformats."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from ...inputs.definition import StudyError

ENDINGS = (".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".ibw", ".tab", ".h5", ".spm", ".dat")
"""Of files that are given to afmformats."""


def is_of_instrument(path: Path) -> bool:
    return path.name.lower().endswith(ENDINGS)


def read(path: Path) -> dict[str, tuple[np.ndarray, str]]:
    """Columns D (m) and P (N) over (curve, point), of the approach; D grows into the sample, from any origin.

    Raises StudyError: afmformats is not there, or cannot read the file.
    """
    where = path.as_posix()
    if not path.exists():
        raise StudyError([f"{where}: there is no such file"])
    try:
        afmformats: Any = import_module("afmformats")
    except ImportError:
        raise StudyError([f"{where}: needs the package afmformats: pip install 'roughcoat[afm]'"]) from None
    try:
        loaded = afmformats.load_data(path)
        curves = [_of_curve(data) for data in (loaded if isinstance(loaded, list) else [loaded])]
    except MemoryError:
        raise
    except Exception as error:  # its classes depend on the format
        raise StudyError([f"{where}: afmformats cannot read it: {error}"]) from None
    if not curves:
        raise StudyError([f"{where}: has no force curve"])
    longest = max(len(D) for D, _ in curves)
    columns = [
        np.array([np.pad(part, (0, longest - len(part)), constant_values=np.nan) for part in parts])
        for parts in zip(*curves, strict=True)
    ]
    return {"D": (columns[0], "m"), "P": (columns[1], "N")}


def _of_curve(data: Any) -> tuple[np.ndarray, np.ndarray]:
    """Depth and load of the approach of one curve."""
    part = data.appr
    force = np.asarray(part["force"], float)
    if "tip position" in data.columns:
        tip = np.asarray(part["tip position"], float)
    else:  # the piezo less what the cantilever gives way
        height = next(name for name in ("height (measured)", "height (piezo)") if name in data.columns)
        tip = np.asarray(part[height], float) + force / data.metadata["spring constant"]
    return -tip, force
