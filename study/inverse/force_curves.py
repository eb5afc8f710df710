"""Force curves in the files of instruments, by afmformats."""

import warnings
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from solver.numerics.userfile import checked, opened

from ..inputs.definition import StudyError
from ..specimen.quantities import quantity
from ..terminal import shown

ENDINGS = (".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".ibw", ".tab", ".h5", ".zip")
"""Of files that only afmformats reads."""
PARTS = {"approach": "appr", "retraction": "retr"}
"""Part of a curve -> its name in afmformats."""
_UNITS = {"spring_constant": ("N/m",), "sensitivity": ("m/V", "m/A")}  # of NT-MDT the detector's signal is a current
_HEAD = 4096  # bytes in which a text says that an instrument has written it
_BACK = 0.1  # a curve has a retraction where the tip goes back by this part of its way
_INTERRUPTS = (KeyboardInterrupt, SystemExit, GeneratorExit, MemoryError)


class Reading(NamedTuple):
    """How the files of instruments are read: `part` of each curve, number of the `curve` or None for all, and what is
    known of the cantilever, in N/m and m/V, or None for what the file says."""

    part: str = "approach"
    curve: int | None = None
    spring_constant: float | None = None
    sensitivity: float | None = None


def reading_of(part: str, curve: Any, spring_constant: Any, sensitivity: Any) -> Reading:
    """The arguments of `curves`, checked. Raises StudyError."""
    if part not in PARTS:
        raise StudyError([f"curves: part = {shown(part)}: must be one of {', '.join(PARTS)}"])
    constants = {"spring_constant": spring_constant, "sensitivity": sensitivity}
    numbers = {name: _positive(name, value) for name, value in constants.items() if value is not None}
    return Reading(part, curve, **numbers)


def _positive(name: str, value: Any) -> float:
    units, errors = _UNITS[name], []
    for unit in units:
        try:
            if isinstance(value, str) or hasattr(value, "magnitude"):
                number = float(quantity(name, value, unit).value)
            elif isinstance(value, bool):
                raise TypeError
            else:
                number = float(value)
            if 0 < number < np.inf:
                return number
            errors.append(f"{name} = {shown(value)}: must be above 0, in {units[0]} or with a unit")
        except (TypeError, ValueError) as error:
            errors.append(str(error) if name in str(error) else f"{name} = {shown(value)}: must be a number of {unit}")
    raise StudyError([f"curves: {errors[0]}"])


def is_of_instrument(path: Path, reading: Reading) -> bool:
    """Whether afmformats reads the file. A text that ends in .csv or .txt may be ours: its content decides."""
    ending = path.suffix.lower()
    if ending not in (".csv", ".txt") or not path.is_file():
        return path.name.lower().endswith(ENDINGS)
    try:
        with opened(path) as file:
            head = file.read(_HEAD).decode("latin-1")
    except (OSError, ValueError):  # the reader of text says it
        return False
    if ending == ".csv":
        return "Force-Distance Curve" in head  # of AFM Workshop
    first = next((line.split() for line in head.splitlines() if line.strip()), [])
    bare = len(first) == 3 and all(_is_number(cell.replace(",", ".")) for cell in first)  # of NT-MDT
    return "Device:\tChiaro" in head or (bare and {reading.spring_constant, reading.sensitivity} != {None})


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def read(path: Path, reading: Reading) -> dict[str, tuple[np.ndarray, str]]:
    """Columns D (m) and P (N) over (curve, point), of one part; D grows into the sample, from any origin.

    Raises StudyError: afmformats is not there, or cannot read the file; no curve in it has two points.
    """
    where = path.as_posix()
    if not path.exists():
        raise StudyError([f"{where}: there is no such file"])
    try:
        checked(path)
    except IsADirectoryError:
        raise StudyError([f"{where} is a folder: name a file in it"]) from None
    except OSError as error:
        raise StudyError([f"{where}: cannot be read: {error.strerror}"]) from None
    except ValueError as error:
        raise StudyError([f"{where}: {error}"]) from None
    try:
        afmformats: Any = import_module("afmformats")
    except ImportError:
        raise StudyError([f"{where}: needs the package afmformats: pip install 'roughcoat[afm]'"]) from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of columns that are not complete: they are said where they are needed
        try:
            return _columns(_loaded(afmformats, path, reading), reading, where)
        except (StudyError, MemoryError, *_INTERRUPTS):
            raise
        except BaseException as error:  # those of afmformats are no Exceptions
            raise StudyError([f"{where}: {_said(error)}"]) from None


def _said(error: BaseException) -> str:
    """One line of what afmformats says."""
    if lacking := [key.replace(" ", "_") for key in getattr(error, "meta_keys", ())]:
        such = {"spring_constant": 'spring_constant="0.05 N/m"', "sensitivity": 'sensitivity="45 nm/V"'}
        return f"the file has no {' and no '.join(lacking)}: give {', '.join(such.get(key, key) for key in lacking)}"
    first = next(iter(str(error).strip().splitlines()), "")
    if isinstance(error, (AssertionError, KeyError, IndexError)) or not first:  # they say nothing by themselves
        first = f"{type(error).__name__} {first}".strip()
    return f"afmformats cannot read it: {first}"


class ForceCurve(NamedTuple):
    """A curve of afmformats, the factor of its force, and the spring constant (N/m), None if nobody knows it."""

    data: Any
    factor: float
    spring_constant: float | None


def _loaded(afmformats: Any, path: Path, reading: Reading) -> list[ForceCurve]:
    """The curves, with the cantilever of the call."""
    overrides = {"spring constant": reading.spring_constant, "sensitivity": reading.sensitivity}
    overrides = {key: value for key, value in overrides.items() if value is not None}
    try:
        loaded, factors = afmformats.load_data(path, meta_override=overrides or None), ()
    except NotImplementedError:  # of .ibw, .h5 and .tab, in which the force is made: it is proportional to both
        loaded, factors = afmformats.load_data(path), tuple(overrides)
    curves = []
    for data in loaded:
        about = data.metadata
        if "sensitivity" in factors and "sensitivity" not in about:
            raise StudyError([f"{path.as_posix()}: the file does not say with which sensitivity its force was made"])
        factor = float(np.prod([overrides[key] / about[key] for key in factors if key in about]))
        curves.append(ForceCurve(data, factor, overrides.get("spring constant", about.get("spring constant"))))
    return curves


def _columns(loaded: list[ForceCurve], reading: Reading, where: str) -> dict[str, tuple[np.ndarray, str]]:
    """The chosen curves, filled up with NaN to the longest. Raises StudyError."""
    if not loaded:
        raise StudyError([f"{where}: has no force curve"])
    if reading.curve is not None:
        loaded = [loaded[place(reading.curve, len(loaded), where)]]
    curves = [_of_curve(curve, reading.part) for curve in loaded]
    longest = max(len(D) for D, _ in curves)
    if longest < 2:
        points = "1 point" if longest else "no points"
        whose = "the curve has" if len(curves) == 1 else f"each of the {len(curves)} curves has"
        raise StudyError([f"{where}: {whose} {points} in its {reading.part}: a fit needs several"])
    columns = np.full((2, len(curves), longest), np.nan)
    for i, parts in enumerate(curves):
        columns[:, i, : len(parts[0])] = parts
    return {"D": (columns[0], "m"), "P": (columns[1], "N")}


def place(curve: Any, curves: int, where: str) -> int:
    """The number of a curve, counted from 0, or from the end where it is negative. Raises StudyError for none."""
    if isinstance(curve, bool) or not isinstance(curve, (int, np.integer)) or not -curves <= curve < curves:
        there = f"{curves} curves, 0 to {curves - 1}" if curves > 1 else "one curve, 0"
        raise StudyError([f"{where}: curve = {shown(curve)}: the file has {there}"])
    return int(curve)


def _of_curve(curve: ForceCurve, part: str) -> tuple[np.ndarray, np.ndarray]:
    """Depth and load of one part of one curve."""
    data, factor, spring_constant = curve
    names = [name for name in ("tip position", "height (measured)", "height (piezo)") if name in data.columns]
    if factor != 1.0:  # a tip position was made with the force of the file
        names = [name for name in names if name != "tip position"]
    if "force" not in data.columns or not names:
        raise ValueError(f"a curve has no complete column of the {'height' if 'force' in data.columns else 'force'}")
    if names[0] != "tip position" and spring_constant is None:
        raise ValueError('a curve has no spring constant: give spring_constant="0.05 N/m"')
    height, force = (np.asarray(getattr(data, PARTS[part])[name], float) for name in (names[0], "force"))
    if not np.any(np.asarray(data["segment"])):
        height, force = _half(*(np.asarray(data[name], float) for name in (names[0], "force")), part)
    force = force * factor
    if names[0] == "tip position":
        return -height, force
    return -height - force / spring_constant, force  # the piezo less what the cantilever gives way


def _half(height: np.ndarray, force: np.ndarray, part: str) -> tuple[np.ndarray, np.ndarray]:
    """One part of a curve whose file does not tell them apart (.ibw): the points before the deepest one, and
    it, or what comes after it. Where the tip does not go back, all of it is the approach."""
    turn = int(np.nanargmin(height)) + 1 if np.isfinite(height).any() else len(height)
    back = np.ptp(height[turn - 1 :]) if turn < len(height) else 0.0
    if not back > _BACK * np.ptp(height):
        turn = len(height)
    kept = slice(0, turn) if part == "approach" else slice(turn, None)
    return height[kept], force[kept]
