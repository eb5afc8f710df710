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
"""Endings of files that only afmformats reads."""
PARTS = {"approach": "appr", "retraction": "retr"}
"""Part of a curve -> its name in afmformats."""
_UNITS = {"spring_constant": ("N/m",), "sensitivity": ("m/V", "m/A")}  # the detector's signal of NT-MDT is a current
_HEAD = 4096  # number of bytes in which a text shows that an instrument has written it
_BACK = 0.1  # a curve has a retraction if the tip goes back by at least this share of its way
_INTERRUPTS = (KeyboardInterrupt, SystemExit, GeneratorExit, MemoryError)


class Reading(NamedTuple):
    """Options for the files of instruments: `part` of each curve, number of the `curve` or None for all, and constants
    of the cantilever, in N/m and m/V, or None for those in the file."""

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
    except (OSError, ValueError):  # the reader of text reports it
        return False
    if ending == ".csv":
        return "Force-Distance Curve" in head  # AFM Workshop
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

    Raises StudyError: afmformats is not installed, or cannot read the file; no curve in it has two points.
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
        warnings.simplefilter("ignore")  # on incomplete columns, which are reported where they are needed
        try:
            return _columns(_loaded(afmformats, path, reading), reading, where)
        except (StudyError, MemoryError, *_INTERRUPTS):
            raise
        except BaseException as error:  # errors of afmformats are not Exceptions
            raise StudyError([f"{where}: {_in_words(error)}"]) from None


def _in_words(error: BaseException) -> str:
    """An error of afmformats in one line."""
    if lacking := [key.replace(" ", "_") for key in getattr(error, "meta_keys", ())]:
        such = {"spring_constant": 'spring_constant="0.05 N/m"', "sensitivity": 'sensitivity="45 nm/V"'}
        return f"the file has no {' and no '.join(lacking)}: give {', '.join(such.get(key, key) for key in lacking)}"
    first = next(iter(str(error).strip().splitlines()), "")
    if isinstance(error, (AssertionError, KeyError, IndexError)) or not first:  # their messages alone say nothing
        first = f"{type(error).__name__} {first}".strip()
    return f"afmformats cannot read it: {first}"


class ForceCurve(NamedTuple):
    """A curve of afmformats, the factor of its force, and the spring constant (N/m), None if it is not known."""

    data: Any
    factor: float
    spring_constant: float | None


def _loaded(afmformats: Any, path: Path, reading: Reading) -> list[ForceCurve]:
    """The curves, with the constants of the cantilever in the call."""
    overrides = {"spring constant": reading.spring_constant, "sensitivity": reading.sensitivity}
    overrides = {key: value for key, value in overrides.items() if value is not None}
    try:
        loaded, factors = afmformats.load_data(path, meta_override=overrides or None), ()
    except NotImplementedError:  # .ibw, .h5 and .tab hold a computed force, which is proportional to both constants
        loaded, factors = afmformats.load_data(path), tuple(overrides)
    curves = []
    for data in loaded:
        about = data.metadata
        if "sensitivity" in factors and "sensitivity" not in about:
            raise StudyError(
                [f"{path.as_posix()}: the file does not state the sensitivity that its force was computed with"]
            )
        factor = float(np.prod([overrides[key] / about[key] for key in factors if key in about]))
        curves.append(ForceCurve(data, factor, overrides.get("spring constant", about.get("spring constant"))))
    return curves


def _columns(loaded: list[ForceCurve], reading: Reading, where: str) -> dict[str, tuple[np.ndarray, str]]:
    """The chosen curves, padded with NaN to the longest. Raises StudyError."""
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
    """The number of a curve, counted from 0, or from the end if it is negative. Raises StudyError for any other."""
    if isinstance(curve, bool) or not isinstance(curve, (int, np.integer)) or not -curves <= curve < curves:
        there = f"{curves} curves, 0 to {curves - 1}" if curves > 1 else "one curve, 0"
        raise StudyError([f"{where}: curve = {shown(curve)}: the file has {there}"])
    return int(curve)


def _of_curve(curve: ForceCurve, part: str) -> tuple[np.ndarray, np.ndarray]:
    """Depth and load of one part of one curve."""
    data, factor, spring_constant = curve
    names = [name for name in ("tip position", "height (measured)", "height (piezo)") if name in data.columns]
    if factor != 1.0:  # the tip position was computed with the force of the file
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
    return -height - force / spring_constant, force  # the position of the piezo less the deflection of the cantilever


def _half(height: np.ndarray, force: np.ndarray, part: str) -> tuple[np.ndarray, np.ndarray]:
    """One part of a curve whose file does not separate them (.ibw): the points up to the deepest one, or the points
    after it. If the tip does not go back, the whole curve is the approach."""
    turn = int(np.nanargmin(height)) + 1 if np.isfinite(height).any() else len(height)
    back = np.ptp(height[turn - 1 :]) if turn < len(height) else 0.0
    if not back > _BACK * np.ptp(height):
        turn = len(height)
    points = slice(0, turn) if part == "approach" else slice(turn, None)
    return height[points], force[points]


#: Depth over P/S by which the surface sinks at the edge of the contact, for a paraboloid and a worn pyramid (Oliver and
#: Pharr, J. Mater. Res. 7 (1992) 1564).
SINK = 0.75
_OF_INDENTS = {"h": ("m", "nm"), "P": ("N", "mN"), "S": ("N/m", "mN/nm"), "A": ("m^2", "nm^2")}
_NM = 1e-9
_Columns = dict[str, tuple[Any, str]]


def without_indents(columns: _Columns, area: Any, where: str) -> _Columns:
    """The columns a and dP_dD of a table with the column S; other tables as they are. A point without contact is NaN.

    Raises StudyError: a column is missing, or has another unit, or there is no area function.
    """
    if "S" not in columns:
        if area is not None:
            raise StudyError([f"{where}: area goes with the columns h, P and S: leave it out"])
        return columns
    if "A" in columns and area is not None:
        raise StudyError([f"{where}: there is a column A: leave out area"])
    needed = ("S", "A") if "A" in columns else ("S", "h", "P")
    if missing := [name for name in needed if name not in columns]:
        raise StudyError([f"{where}: beside S there must be h and P, or A; there is no {' and no '.join(missing)}"])
    if "A" not in columns and area is None:
        such = "area=24.5 in `roughcoat fit`, rc.curves(..., area=[24.5])"
        needs = f"S, h and P need the area function of the tip: {such}, or a column A"
        raise StudyError([f"{where}: {needs}"])
    if strange := [name for name in columns if name not in _OF_INDENTS]:
        raise StudyError([f"{where}: {shown(strange[0])} does not go with S: leave it out"])
    si = {name: _in_si(name, *columns[name], where) for name in needed}
    with np.errstate(invalid="ignore", divide="ignore"):
        A = si["A"] if "A" in si else _area(area, si["h"] - SINK * si["P"] / si["S"], where)
        touches = (A > 0) & (si["S"] > 0)
        radius = np.where(touches, np.sqrt(A / np.pi), np.nan)
    return {"a": (radius, "m"), "dP_dD": (np.where(touches, si["S"], np.nan), "N/m")}


def _in_si(name: str, values: Any, unit: str, where: str) -> np.ndarray:
    si, such = _OF_INDENTS[name]
    try:
        if not unit:
            raise ValueError(f"{name} has no unit, such as {such}")
        return np.ma.filled(np.ma.asarray(values, float), np.nan) * quantity(name, f"1 {unit}", si).value
    except (TypeError, ValueError) as error:
        raise StudyError([f"{where}: {error}" if name in str(error) else f"{where}: {name}: {error}"]) from None


def _area(area: Any, hc: np.ndarray, where: str) -> np.ndarray:
    """A(hc), m²; NaN for a depth hc that is not above 0."""
    hc = np.where(hc > 0, hc, np.nan)
    if callable(area):
        return np.asarray(area(hc), float)
    try:
        coefficients = np.atleast_1d(np.asarray(area, float))
    except (TypeError, ValueError):
        coefficients = np.empty(0)
    if coefficients.ndim != 1 or not coefficients.size or not np.isfinite(coefficients).all():
        raise StudyError([f"{where}: area = {shown(area)}: must be numbers C0, C1 ... or a function of hc"])
    powers = [2.0, *(0.5**k for k in range(len(coefficients) - 1))]
    return _NM**2 * sum(C * (hc / _NM) ** power for C, power in zip(coefficients, powers, strict=True))
