"""A micro law from a user's table, ``micro = "table:mine.csv"``; docs/microscale.md describes the file.

Smooth curves are fitted to the rows. The law's `error` is the larger of two distances: that of a row from the curve
fitted to the other rows, and, between the rows, that of the curve from one of a lower degree. Below the first row A is
the power of p that goes through the first two rows. A table with the columns z and share is a histogram
(``heights.py``).

A column "A [um]", with a unit, has lengths in place of multiples of R. A line "# scan: {...}" above the heading, which
the law of a scan writes, has in JSON the error of the rows and the body for which they are valid.
"""

import csv
import hashlib
import json
import re
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from ..numerics.userfile import NoFile, TooLarge, content, place
from ..parameters import Parameter
from . import heights
from .law import Law
from .tabulated import LawTable, fitted, law_of, t_of

PREFIX = "table:"
#: A scan, whose rows `study` computes before the contacts: "scan:FILE". The laws that are named after a file.
OF_SCAN = "scan:"
OF_FILES = PREFIX, OF_SCAN
COLUMNS = ("p", "A", "lam", "p_max")
#: A column that the law of a scan has besides: the relative error of each row.
ERROR = "error"
#: The parameter of a law whose A is a length: the length, in the unit of R, that 1 in its column stands for.
LAW_UNIT = "law_unit"
_LAW_UNIT = Parameter(
    interval="(0, inf)", powers=(0, 1), instead="", long_name="length that 1 in the table of the law stands for"
)
#: Units of length of the column A, in m.
_UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "nm": 1e-9}
#: A heading of A with a unit; and the beginning of the line with the error and the body of a scan's law.
_WITH_UNIT, STATED = re.compile(r"A \[(\w+)\]"), "# scan: "
#: Most bytes of the file. 10,000 rows of 17 digits are 0.9 MB; time and memory of the fit grow with the number of rows.
LARGEST = 10_000_000
#: Columns of a histogram, and its largest number of rows: the time of its first use grows with it.
HEIGHTS, _MOST = ("z", "share"), 32
#: For a table of a law: its smallest number of rows, and the highest degree of a polynomial. A polynomial that is
#: within _NEAR of the rows needs no higher degree. A polynomial farther than _FAR from a row is refused. Both are
#: relative distances.
_FEWEST, _DEGREE, _NEAR, _FAR = 5, 14, 1e-4, 0.05
#: The largest distance of a curve from the rows of a scan. They have steps where few points touch; `error` includes it.
_OF_SCAN = 0.3
#: The exponent of A at the edge is that of the first two rows. The first rows of a scan have a spot or two, which are
#: springs of some points: there it is that over a decade of p, or the curves need more degrees than there are.
_OF_FIRST_ROWS, _OF_SPOTS = 1.0, 10.0
#: Rows of errors up to this count alike.
_TRUSTED = 0.02
#: The degree that is chosen is the lowest whose distance from the rows is at most this times the smallest one: higher
#: degrees follow the noise.
_HARDLY = 1.5
#: The error of a curve between the rows is estimated as _MARGIN times its distance from the curve one degree lower, at
#: _STEPS points in each gap. p may rise at most by the factor _GAP from row to row: in wider gaps both curves have the
#: same error (tests/laws/test_own_table_range.py).
_MARGIN, _STEPS, _GAP = 2.0, 8, 30.0
#: Curves of neighbouring degrees may have the same error. So the distance from curves of the next _HIGHER degrees
#: counts, if they are as near to the rows and have less than _PART coefficients a row. So does _OF_ENDS times the
#: distance of the first and the last row from the curve through the others. They are chosen so that `error` encloses
#: all tables of tests/laws/test_own_table_range.py; it also encloses all 90 random ones of
#: `python tools/errors/own_tables.py`.
_HIGHER, _PART, _OF_ENDS = 3, 0.5, 0.15
#: Largest exponent of A(p) over the rows. In a contact it is at most 1; the rest allows for noise.
_BENT = 1.05
#: Where λ is below _LIGHT and A rises with an exponent below _ROUND (2/3 for round summits, 1 for flat ones), λ rises
#: faster than p_max in all laws of this package (tests/laws/test_own_table.py). Otherwise the columns are exchanged.
_ROUND, _LIGHT = 0.7, 0.5
#: Exponents of the edge, A ~ p^β, that the curves can have.
_BETA = (0.2, 1.5)


def read(name):
    """:class:`~solver.laws.law.Law` of the table whose path follows "table:" in `name`. Its version is a digest of the
    numbers. Raises ValueError, with file, column and row."""
    file = name.removeprefix(PREFIX)
    try:
        if "\n" in file:
            raise ValueError("the path has a line break; give the file another name")
        return _of_text(name, _text_of(place(file)))
    except OSError as error:
        raise ValueError(f"{file}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"{file}: is not UTF-8 (byte {error.start}): save it with the encoding UTF-8") from None
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{file}: {error}") from None


def _text_of(path):
    """The text of a file of numbers. Raises ValueError if it is not a file, or too large; OSError if it cannot be
    read."""
    no_table = "a table is a text file of numbers"
    try:
        return content(path, LARGEST).decode("utf-8-sig")
    except IsADirectoryError:
        raise ValueError(f"is not a file but a folder: {no_table}") from None
    except NoFile as error:
        raise ValueError(f"{error}: {no_table}") from None
    except TooLarge as error:
        raise ValueError(f"{error}, some 100,000 rows") from None


@lru_cache(maxsize=16)
def _of_text(name, text):
    """The law of a table. It is cached, because a study needs it several times."""
    heading = next((line for line in text.splitlines() if line.strip() and not line.startswith("#")), "")
    words = [word.strip() for word in heading.split(",")]
    if "share" in words:
        return _histogram(name, **_columns(text, HEIGHTS, 2))
    unit = next((match[1] for word in words if (match := _WITH_UNIT.fullmatch(word))), "")
    if unit and unit not in _UNITS:
        raise ValueError(f"column A: [{unit}] is not a unit of length: one of {', '.join(_UNITS)}")
    columns, stated = _columns(text, COLUMNS, _FEWEST), _stated(text)
    _check(**columns)
    if not stated:
        _check_order(**columns)
    if stated and ERROR in words:
        stated["errors"] = _columns(text, (ERROR,), _FEWEST)[ERROR]
    columns["A"] = columns["A"] * _UNITS.get(unit, 1.0)
    return fitted_law(name, **columns, metres=bool(unit), **stated)


def _stated(text):
    """`error` and `body` of a scan's rows, from their line of JSON; an empty dictionary for any other table."""
    line = next((line for line in text.splitlines() if line.startswith(STATED)), None)
    if line is None:
        return {}
    try:
        stated = json.loads(line.removeprefix(STATED))
        error, body = float(stated["error"]), dict(stated["body"] or {})
        if not 0 <= error < np.inf or not all(isinstance(value, (str, float, int)) for value in body.values()):
            raise ValueError
    except (ValueError, KeyError, TypeError):
        raise ValueError(f'the line "{STATED.strip()}" has been changed: write the table of the scan anew') from None
    return {"error": error, "body": body}


def _histogram(name, z, share):
    """The law of a histogram with the columns z and share (n,). Raises ValueError if it cannot be used."""
    steps = np.diff(z)
    if len(z) > _MOST:
        raise ValueError(f"has {len(z)} rows: must have at most {_MOST}")
    if not (steps > 0).all() or np.ptp(steps) > 1e-6 * steps.mean():
        raise ValueError("column z: must ascend in equal steps")
    law = heights.histogram(name, z, share, _digest(z, share))
    if law.error > _FAR:
        raise ValueError(
            "column share: a few summits stand far above the many: leave out the highest rows, which describe so few"
        )
    return law


def _digest(*columns):
    return hashlib.sha256(np.stack(columns).astype("<f8").tobytes()).hexdigest()[:16]


def _columns(text, names, fewest):
    """Name -> numbers (n,) of the columns of a table."""
    rows = [row for row in csv.reader(text.splitlines()) if row and not row[0].startswith("#")]
    heading = [_WITH_UNIT.sub("A", word.strip()) for word in rows[0]] if rows else []
    missing = [name for name in names if heading.count(name) != 1]
    if missing:
        words = f"the heading must have it once, with {', '.join(names)}, separated by commas"
        raise ValueError(f"column {missing[0]}: {words}")
    if len(rows) <= fewest:
        raise ValueError(f"has {len(rows) - 1} rows: must have at least {fewest}")
    return {name: np.array([_number(name, i, row, heading) for i, row in enumerate(rows[1:], 1)]) for name in names}


def _number(name, i, row, heading):
    """The number in the column `name` of row i."""
    if len(row) != len(heading):
        raise ValueError(f"row {i}: has {len(row)} cells, the heading {len(heading)}")
    cell = row[heading.index(name)].strip()
    try:
        number = float(cell)
    except ValueError:
        number = np.nan
    if not (0 < number < np.inf or name == "z" and np.isfinite(number)):
        raise ValueError(f'column {name}, row {i}: "{cell}": must be a finite number > 0')
    return number


def _check(p, A, lam, p_max):
    """Raise ValueError if the rows cannot be those of a law."""
    rules = (
        ("p", p[1:] > p[:-1], 2, "must be larger than that of the row before"),
        ("p", p[1:] <= _GAP * p[:-1], 2, f"is over {_GAP:g} times that of the row before: add rows between them"),
        ("A", A[1:] > A[:-1], 2, "must be larger than that of the row before"),
        ("lam", lam[1:] >= lam[:-1], 2, "must not be smaller than that of the row before"),
        ("lam", lam <= 1, 1, "must be at most 1"),
        ("p_max", p_max > p, 1, "must be larger than p"),
        ("p_max", lam * p_max > (1 - _FAR) * p, 1, "must be at least p/lam, the mean over the spots"),
    )
    for name, holds, first, words in rules:
        if not holds.all():
            row = first + int(np.argmin(holds))
            value = {"p": p, "A": A, "lam": lam, "p_max": p_max}[name][row - 1]
            raise ValueError(f"column {name}, row {row}: {value:g}: {words}")
    if np.median(np.log(A[1:] / A[0]) / np.log(p[1:] / p[0])) > _BENT:  # one wrong row is named below
        raise ValueError(f"column A, rows 1 to {len(p)}: rises faster than p, but growing spots deform less and less")


def _check_order(p, A, lam, p_max):
    """Raise ValueError where two columns seem to be exchanged."""
    last = max(1, int(((p <= 10 * p[0]) & (lam < _LIGHT)).sum())) - 1
    rise = {name: np.log(X[last] / X[0]) for name, X in (("p", p), ("A", A), ("lam", lam), ("p_max", p_max))}
    if rise["lam"] < 0.75 * rise["p_max"] and rise["A"] < _ROUND * rise["p"]:
        words = "lam rises more slowly than p_max: are they exchanged?"
        raise ValueError(f"columns lam and p_max, rows 1 to {last + 1}: {words}")


def of_rows(name, text):
    """:class:`~solver.laws.law.Law` of a table that a program has written. Raises ValueError as :func:`read`."""
    return _of_text(name, text)


def awaiting_rows(name, version, body=None):
    """:class:`~solver.laws.law.Law` of a scan, "scan:FILE", whose rows have not been computed. It has all that a study
    is checked by; each of its functions raises RuntimeError.

    version : text that tells the rows from all others; body : as of :func:`fitted_law`
    """
    functions = dict.fromkeys(("scales", "curve", "area", "peak", "edge"), _without_rows)
    return Law(name=name, version=version, parameters={LAW_UNIT: _LAW_UNIT}, body=body or None, **functions)


def _without_rows(*_, **__):
    raise RuntimeError("the rows of the law of a scan have not been computed")


def in_metres(law):
    """Whether a law comes from a table whose A is a length."""
    return LAW_UNIT in law.parameters


def of_scan(name, text, version):
    """:class:`~solver.laws.law.Law` of a table whose rows follow from what `version` tells; ValueError as of
    :func:`read`."""
    return replace(_of_text(name, text), version=version)


def fitted_law(name, p, A, lam, p_max, metres=False, error=0.0, body=None, errors=None):
    """:class:`~solver.laws.law.Law` near the rows (n,) of a table that has been checked.

    metres : whether A is in m; otherwise it is in R
    error : error of the rows themselves; the curves may be as far from them
    body : the body for which they are valid, parameter -> number or word, lengths in m
    errors : (n,), error of each row; None: `error`. Rows with larger errors than `error` count less for the curve of λ,
        which goes in steps where few points touch
    """
    trust = np.ones(len(p)) if errors is None else np.minimum(max(error, _TRUSTED) / errors, 1.0)
    beta = _edge_exponent(p, A, _OF_FIRST_ROWS if errors is None else _OF_SPOTS)
    s, q = 2 / beta - 1, p / p[-1]
    t = t_of(q, s)
    quantities = (("A", A / A[-1], 2), ("lam", lam, 2), ("p_max", (p_max - p) / p[-1], 1))
    stated = json.dumps([error, body], sort_keys=True) * bool(error or body)
    allowed = max(_OF_SCAN, error) if stated else _FAR
    rows = (p, A, lam, p_max, *([] if errors is None else [errors]))
    even = np.ones(len(p))
    hows = [(power, allowed, trust if column == "lam" else even) for column, _, power in quantities]
    curves = [_curve(column, t, q, X, how) for (column, X, _), how in zip(quantities, hows, strict=True)]
    return law_of(
        LawTable(*(curve for curve, _ in curves), s),
        name=name,
        version=_digest(*rows) + hashlib.sha256(stated.encode()).hexdigest()[:8] * bool(stated),
        scales=partial(_scales_in_metres if metres else _scales, p[-1], A[-1]),
        parameters={LAW_UNIT: _LAW_UNIT} if metres else {},
        body=body or None,
        error_at=None if errors is None else partial(_error_at, np.log(p), errors),
        error=max(error, *(error for _, error in curves)),
        least=p[0],
        most=p[-1],
        smears=False,
        rise=1.1,
    )


def _scales(p_star, A_star, E):
    return p_star * E, A_star


def _scales_in_metres(p_star, A_star, E, law_unit):
    return p_star * E, A_star * law_unit


def _edge_exponent(p, A, reach):
    """The exponent of A in p over the first rows, up to `reach` times the first pressure, two rows at least."""
    last = max(1, int(np.count_nonzero(p <= reach * p[0])) - 1)
    return np.clip(np.log(A[last] / A[0]) / np.log(p[last] / p[0]), *_BETA)


def _error_at(ln_p, errors, p):
    """The error of the rows of a scan at the pressures p (B,), over the modulus that is felt."""
    return np.interp(np.log(p), ln_p, errors)


def _curve(column, t, q, X, how):
    """:class:`~solver.laws.tabulated.TableCurve` near the rows X (n,), of the lowest degree that is near enough, and
    its largest error at and between them. Raises ValueError if for every degree it is more than `allowed` away, or
    falls.

    how : power of the curve, `allowed`, and how much each row counts (n,), 1 at most
    """
    power, allowed, trust = how
    degrees = range(min(_DEGREE, len(t) - 2) + 1)
    fits = [fitted(t, q, X, degree, trust=trust, power=power, span=(t[0], t[-1])) for degree in degrees]
    differences = _differences([curve for curve, _ in fits], t) * np.interp(_between(len(t)), np.arange(len(t)), trust)
    fits = [(curve, error * trust) for curve, error in fits[1:]]  # degree 1 is compared with degree 0
    far = np.array([error[1:-1].max() for _, error in fits])  # no curve through the others tells the ends
    if far.min() > allowed:
        row = int(np.argmax(fits[far.argmin()][1][1:-1])) + 2
        raise ValueError(
            f"column {column}, row {row}: is {100 * far.min():.0f} % off a smooth curve through the other rows: "
            f"at most {100 * allowed:.0f} % are allowed"
        )
    at_rows, far = far, np.maximum(far, differences.max(axis=1))
    if far.min() > allowed:
        row = int(np.argmax(differences[far.argmin()])) // _STEPS + 1
        raise ValueError(
            f"column {column}, rows {row} and {row + 1}: smooth curves through the rows differ by "
            f"{100 * far.min():.0f} % between them: at most {100 * allowed:.0f} % are allowed: add rows there"
        )
    falls = np.array([column == "A" and _falls(curve, t) for curve, _ in fits])
    good = ~falls & (far <= max(_NEAR, _HARDLY * far[~falls].min(initial=np.inf))) & (far <= allowed)
    if not good.any():
        raise ValueError(f"column {column}: no smooth curve through the rows rises: add rows, or smooth them")
    best = int(np.argmax(good))
    error = max(far[best], _OF_ENDS * fits[best][1][[0, -1]].max())
    for other in range(best + 1, best + 1 + _HIGHER):
        if other < _PART * len(t) - 1 and other < len(fits) and at_rows[other] <= _HARDLY * far[best]:
            weights = np.interp(_between(len(t)), np.arange(len(t)), trust)
            changes = _differences([fits[best][0], fits[other][0]], t) * weights
            error = max(error, changes.max())
    return fits[best][0], float(error)


def _differences(curves, t):
    """_MARGIN times the differences (k - 1, m) of k curves from the curve before, at _STEPS points in each gap of the
    rows t."""
    rows = np.arange(len(t))
    points = np.exp(np.interp(_between(len(t)), rows, np.log(t)))
    V = np.array([curve.exponent(points)[0] for curve in curves])
    return _MARGIN * np.expm1(np.minimum(np.abs(np.diff(V, axis=0)), 9.0))  # 9 is far above _FAR, and does not overflow


def _between(count):
    """Places in so many rows, _STEPS a gap."""
    return np.arange(0, count - 1, 1 / _STEPS)


def _falls(quantity, t):
    """Whether a :class:`~solver.laws.tabulated.TableCurve` falls between the rows at t (n,), or below them."""
    points = np.append(np.geomspace(1e-6, t[0], 50), np.linspace(t[0], 1, 2000)[:-1])
    return bool((quantity.power / points + quantity.exponent(points)[1] <= 0).any())
