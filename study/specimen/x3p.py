"""Scans in X3P (ISO 25178-72, formerly ISO 5436-2): a zip with main.xml and the heights, which are in m.

SurfaceTopography reads only one revision of the standard, and fails where the instrument has no name.
"""

import io
import zipfile
from xml.etree import ElementTree

import numpy as np

_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}


def read(raw: bytes, name: str) -> tuple[np.ndarray, list[float]] | None:
    """Heights (y, x) or (x) in m, NaN where a point is not valid, and steps along each axis; None if it is not X3P.

    Raises ValueError: an X3P file that is damaged, or has unequal steps.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(raw)) as archive:
            if "main.xml" not in archive.namelist():
                return None
            return _scan(archive, name)
    except zipfile.BadZipFile:
        return None
    except (KeyError, EOFError, OSError, RuntimeError, NotImplementedError, ElementTree.ParseError) as error:
        reason = error.args[0] if isinstance(error, KeyError) else error
        raise ValueError(f"{name}: the X3P file is damaged: {reason}") from error


def _scan(archive: zipfile.ZipFile, name: str) -> tuple[np.ndarray, list[float]]:
    root = ElementTree.fromstring(archive.read("main.xml"))

    def text(path: str, default: str | None = None) -> str:
        # names of elements may have the namespace of any revision
        content = root.findtext("/".join(f"{{*}}{part}" for part in path.split("/")))
        content = root.findtext(path) if content is None else content
        if content is None or not content.strip():
            if default is None:
                raise ValueError(f"{name}: main.xml has no {path}")
            return default
        return content.strip()

    points = {axis: int(text(f"Record3/MatrixDimension/Size{axis}", "1")) for axis in "XYZ"}
    if points["Z"] != 1:
        raise ValueError(f"{name}: the X3P file has {points['Z']} layers; one is read")
    profile = points["Y"] == 1
    for axis in "X" if profile else "XY":
        if text(f"Record1/Axes/C{axis}/AxisType", "I") != "I":
            raise ValueError(f"{name}: the axis {axis} of the X3P file has no equal steps")
    steps = [float(text(f"Record1/Axes/C{axis}/Increment")) for axis in ("X" if profile else "YX")]
    shape = (points["Y"], points["X"])
    kind = text("Record1/Axes/CZ/DataType")
    if kind not in _TYPES:
        raise ValueError(f"{name}: the X3P file has heights of the type {kind}; {', '.join(_TYPES)} are read")
    z = _points(archive, text("Record3/DataLink/PointDataLink"), np.dtype(_TYPES[kind]), shape, name).astype(float)
    z = float(text("Record1/Axes/CZ/Offset", "0")) + float(text("Record1/Axes/CZ/Increment", "1")) * z
    if link := text("Record3/DataLink/ValidPointsLink", ""):
        bits = np.unpackbits(np.frombuffer(archive.read(link), np.uint8), bitorder="little")
        if bits.size < z.size:
            raise ValueError(f"{name}: {link} of the X3P file has {bits.size} points of {z.size}")
        z = np.where(bits[: z.size].reshape(shape), z, np.nan)
    return (z[0] if profile else z), steps


def _points(archive: zipfile.ZipFile, link: str, kind: np.dtype, shape: tuple, name: str) -> np.ndarray:
    raw = archive.read(link)
    if len(raw) != kind.itemsize * shape[0] * shape[1]:
        raise ValueError(f"{name}: {link} of the X3P file has {len(raw)} bytes, not those of {shape[0]} × {shape[1]}")
    return np.frombuffer(raw, kind).reshape(shape)
