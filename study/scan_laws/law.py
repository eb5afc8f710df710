"""The micro law of a scan: A, λ and p_max of one period of it, and the difference between two such periods."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TextIO

import numpy as np
from scipy.ndimage import label

from solver.laws import Law, own_table

from ..specimen.foreign import plain
from ..terminal import rounded
from ..work.progress import Progress, screen_of
from .bodies import PressedBody, body_of
from .patch import Patch, Pressing, patch_of

__all__ = ["ScanLaw", "law"]

#: By default the law goes from the first contact fraction to the second, and p grows by this factor from row to row. Up
#: to a given pressure it has at least so many rows, and at most so large a contact fraction: in full contact A stays.
_LEAST, _MOST, _FACTOR, _FEWEST, _FULL = 1e-3, 0.6, 1.38, 8, 0.95
#: λ over p/(E* h') where few points touch; largest number of steps in the search for the first row, and its precision
#: as a factor.
_STIFF, _SEARCH, _NEAR = 2.0, 6, 1.3
#: The contact fraction at which the law is compared with theories for small ones, and λ h'E*/p of Persson's, √(8/π).
_SMALL, _PERSSON = 0.05, math.sqrt(8 / math.pi)
#: Largest number of rows.
_ROWS = 40
#: Number of rows at which the patch is compared with its quarters and with points at half the distance, and the least λ
#: that counts in the error of the whole law: below it a few spots carry the load. The rows there have their own errors.
_COMPARED, _COUNTS = 6, 0.01
#: What finer points change is at most this times what half the distance changes in a part of the patch. An error that
#: falls as the distance is twice that; where the tops of all summits lie midway between points p_max needs 2.8
#: (tests/laws/scans/test_errors_of_scan_laws.py).
_OF_HALVING = 3.0
#: Spots of points are too large by this times their edges, in points: Yastrebov, Anciaux and Molinari, Tribology
#: International 114 (2017) 161. What is left of a spot is at least this share of it.
OUTSIDE, _SHARE = (np.pi - 1 + np.log(2)) / 24, 0.3
#: Least number of points along a side of a quarter for the comparison, and the diameter in points below which a spot is
#: coarse.
_SMALLEST, _COARSE = 16, 4.0
#: Largest number of points along a side of the part of a quarter with points at half the distance: spots are much
#: smaller.
_HALVED = 96


@dataclass(frozen=True, eq=False)
class ScanLaw:
    """The micro law of a scan, rows of a table. `study.solve` takes it as `micro`, and its file as "table:FILE".

    Attributes
    ----------
    p, A, lam, p_max : (n,) nominal pressure over E1*; approach over `scale`, from the highest summit; contact fraction;
        largest pressure over E1*
    scale : m, the length that 1 in A stands for
    error : the largest relative error of λ, p_max and A that `errors` has, from λ = 0.01 on
    errors : "pixel": the change that finer points would make, thrice that of half the distance, or the excess of λ due
        to the points at the borders of spots; "patch": the difference that another patch of this size may have, half
        of the scatter of the four quarters
    body : parameter -> number or word (lengths in m) of the body under the scan; None: a half-space
    name : of the scan
    notes : sentences, also those of the reading
    m : E1*/E_punch* of the body
    row_errors : (n,) error of each row, which is larger where few points touch; None: `error`

    Examples
    --------
    >>> import numpy as np
    >>> rows = np.array([[0.01, 0.02], [1e-9, 2e-9], [0.1, 0.2], [0.2, 0.21]])
    >>> measured = ScanLaw(*rows, error=0.01, errors={}, body=None, name="wafer")
    >>> print(measured.text.splitlines()[2])
    p,A [m],lam,p_max,error
    """

    p: np.ndarray
    A: np.ndarray
    lam: np.ndarray
    p_max: np.ndarray
    error: float
    errors: Mapping[str, float]
    body: Mapping[str, Any] | None
    name: str
    notes: tuple[str, ...] = ()
    scale: float = 1.0
    m: float = 0.0
    row_errors: np.ndarray | None = None

    @property
    def text(self) -> str:
        """The text of the file: notes on the computation, and the table. Its pressures are over the modulus of body and
        punch in series."""
        stated = json.dumps({"error": self.error, "body": None if self.body is None else dict(self.body)})
        lines = [f"# Micro law of {_on_one_line(self.name)}", *(f"# {_on_one_line(note)}" for note in self.notes)]
        lines += [f"{own_table.STATED}{stated}", "p,A [m],lam,p_max,error"]
        factors = (1 + self.m, self.scale, 1.0, 1 + self.m, 1.0)
        errors = np.full(len(self.p), self.error) if self.row_errors is None else self.row_errors
        columns = (self.p, self.A, self.lam, self.p_max, errors)
        rows = zip(*(column * factor for column, factor in zip(columns, factors, strict=True)), strict=True)
        return "\n".join([*lines, *(",".join(repr(float(number)) for number in row) for row in rows), ""])

    @property
    def law(self) -> Law:
        """The law for the solver.

        Returns
        -------
        solver.Law : smooth curves near the rows

        Raises
        ------
        ValueError : no smooth curves are near the rows
        """
        return own_table.of_rows(f"{own_table.PREFIX}law of {_on_one_line(self.name)}", self.text)

    def to_csv(self, path: Any) -> None:
        """Write the table, which `micro="table:FILE"` reads.

        Parameters
        ----------
        path : of the file, which is replaced

        Returns
        -------
        None

        Raises
        ------
        OSError : the file cannot be written

        Examples
        --------
        >>> import pathlib, tempfile
        >>> import numpy as np
        >>> rows = np.array([[0.01, 0.02], [1e-9, 2e-9], [0.1, 0.2], [0.2, 0.21]])
        >>> measured = ScanLaw(*rows, error=0.01, errors={}, body=None, name="wafer")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     measured.to_csv(pathlib.Path(folder, "wafer.csv"))
        ...     print(pathlib.Path(folder, "wafer.csv").read_text().splitlines()[-1])
        0.02,2e-09,0.2,0.21,0.01
        """
        Path(path).write_text(self.text, encoding="utf-8")

    def __repr__(self) -> str:
        return f"ScanLaw({self.name!r}, {len(self.p)} rows, error={self.error:.2g}, body={self.body!r})"

    def __str__(self) -> str:
        on = "a half-space" if self.body is None else ", ".join(f"{k} = {_shown(v)}" for k, v in self.body.items())
        lines = [
            f"Micro law of {self.name} on {on}: {len(self.p)} pressures, λ from {self.lam[0]:.2g} to "
            f"{self.lam[-1]:.2g} at p from {self.p[0]:.2g} to {self.p[-1]:.2g} E1*.",
            f"p_max is {self.p_max[0]:.2g} E1* at the first and {self.p_max[-1]:.2g} E1* at the last.",
        ]
        return "\n".join(lines + [f"Note: {note}." for note in self.notes])


def law(
    scan: Any,
    *,
    pressures: Any = None,
    on: Mapping[str, Any] | None = None,
    periodic: str = "mirror",
    refine: int = 1,
    form: Any = "plane",
    cutoff: float | None = None,
    progress: bool | None = None,
) -> ScanLaw:
    """The micro law of a scan itself: A, λ and p_max of one period of its heights, each point of them an asperity.

    The heights, less their form, make a period, which is pressed flat by conjugate gradients (Polonsky and Keer 1999)
    on a body. A wave p(k) of pressure displaces its surface by 2 L(kh)/k p(k), without k = 0:
    `solver.laws.periodic_rows`.

    Parameters
    ----------
    scan : a map of heights without gaps, made by `read`, `height_map` or `self_affine`
    pressures : (n,), n >= 5, nominal pressures over E1*, > 0; None: those with λ from 0.001, or one point, to 0.6
    on : inputs of `study.solve` for the body: h, n or E1 and E2, nu1, nu2, bonding, or `layers`; E_punch or m. Lengths
        have units. Contacts on another body are then refused. None: a half-space of E1*
    periodic : "mirror", the scan beside its mirror images; "taper", the scan with borders of an eighth that go to the
        mean; "given", the scan is a period
    refine : points per pixel along each side, 1 to 8, by the Fourier series of the period
    form : the form to subtract first, as in `measure`
    cutoff : wavelength, m, of a Gaussian low-pass, as in `measure`
    progress : whether to show the progress; None: where the terminal or a notebook can

    Returns
    -------
    ScanLaw : its `error` becomes part of the `model_error` of contacts

    Raises
    ------
    ValueError : a profile, a map with gaps, or an argument that is not allowed; for `on` a StudyError, a ValueError too

    Examples
    --------
    >>> from study import roughness
    >>> surface = roughness.self_affine((64, 64), "0.5 um", hurst=0.8, rms="20 nm", seed=3)
    >>> of_scan = roughness.law(surface, periodic="given", progress=False)
    >>> print(len(of_scan.p), f"{of_scan.lam[0]:.4f} {of_scan.lam[-1]:.2f}")
    22 0.0012 0.71
    """
    body = body_of(on, "law")
    patch = patch_of(scan, form, cutoff, periodic, refine, "law")
    wanted = None if pressures is None else _wanted(pressures) * (1 + body.m)
    return _computed(scan, patch, body, _Range(wanted), screen_of(plain(progress)))


def law_up_to(scan: Any, body: PressedBody, top: float, stream: TextIO | None) -> ScanLaw:
    """The law of a scan as `law` has it, from λ = 0.001 to the pressure `top`, over the modulus that is felt, or to
    nearly full contact. ValueError as of `law`; stream : where it says how far it is."""
    patch = patch_of(scan, "plane", None, "mirror", 1, "law")
    return _computed(scan, patch, body, _Range(None, top, _FULL), stream)


class _Range(NamedTuple):
    """The pressures of a law, over the modulus that is felt: those that are wanted; or None, and all up to the pressure
    `top` or the contact fraction `most`."""

    wanted: np.ndarray | None
    top: float = np.inf
    most: float = _MOST

    @property
    def count(self) -> int:
        return _ROWS if self.wanted is None else len(self.wanted)

    def ends(self, rows: list) -> bool:
        """Whether the rows suffice."""
        p, lam = rows[-1][0], rows[-1][2]
        return self.wanted is None and (lam >= self.most or (p >= self.top and len(rows) >= _FEWEST))


def _computed(scan: Any, patch: Patch, body: PressedBody, pressures: _Range, stream: TextIO | None) -> ScanLaw:
    """The law of a patch of a scan on a body."""
    pressing, rows, spots, wanted = Pressing(patch, body.kernel), [], [], pressures.wanted
    with Progress(f"law of {scan.name}", pressures.count, stream, passing=True) as bar:
        p = _first(patch, body, scan.name, pressures.top) if wanted is None else 0.0
        for i in range(pressures.count):
            p = p * (_FACTOR if i else 1.0) if wanted is None else float(wanted[i])
            rows.append((p, *pressing.at(p, scan.name)))
            spots.append(_spots(pressing.pressures, patch.mirrored))
            bar.update(1, 0)
            if pressures.ends(rows):
                break
        table, (diameters, borders) = np.array(rows).T, np.array(spots).T
        parts = _differences(patch, body, table, scan.name)
    p, A, lam, p_max = table
    parts["pixel"] = np.maximum(parts.get("pixel", 0.0), borders)
    counts = lam >= _COUNTS if (lam >= _COUNTS).any() else lam == lam[-1]
    errors = {name: float(values[counts].max()) for name, values in parts.items()}
    notes = (*scan.notes, _provenance(scan, patch), *_about(errors), *_coarse(lam, diameters, parts["pixel"]))
    notes += _beside_theory(p, lam, patch.slope) if body.kernel is None else ()
    numbers = {"error": max(errors.values()), "errors": errors, "body": body.inputs, "name": scan.name}
    numbers["row_errors"] = np.max(list(parts.values()), axis=0)
    return ScanLaw(p / (1 + body.m), A, lam, p_max / (1 + body.m), **numbers, notes=notes, m=body.m)


def _wanted(pressures: Any) -> np.ndarray:
    """The pressures in ascending order. Raises ValueError for other values."""
    try:
        values = np.unique(np.asarray(pressures, dtype=float))
    except (TypeError, ValueError):
        values = np.array([])
    if not (values.size and np.ndim(pressures) == 1 and np.all((values > 0) & np.isfinite(values))):
        raise ValueError(f"law: pressures = {pressures!r}: must be numbers > 0, over E1*")
    return values


def _first(patch: Patch, body: PressedBody, name: str, top: float) -> float:
    """The pressure at which about _LEAST of the points touch, over the modulus of body and punch in
    series; a lower one if too few rows would lie below `top`."""
    pressing = Pressing(patch, body.kernel)
    p, fewest = _LEAST * patch.slope / _STIFF, max(_LEAST, 1 / patch.z.size)
    for _ in range(_SEARCH):
        _, lam, _ = pressing.at(p, name)
        if fewest / _NEAR <= lam <= fewest * _NEAR:
            break
        p *= fewest / lam
    return min(p, top / _FACTOR ** (_FEWEST - 1))


def _differences(patch: Patch, body: PressedBody, table: np.ndarray, name: str) -> dict[str, np.ndarray]:
    """What finer points and another patch would change, relative, in each row (n,): of some rows, and interpolated."""
    if min(patch.z.shape) < 2 * _SMALLEST:
        return {}
    chosen = np.unique(np.linspace(0, len(table[0]) - 1, _COMPARED).round().astype(int))
    quarters = patch.quarters()
    pressings = [Pressing(quarter, body.kernel) for quarter in quarters]
    part = quarters[0].within(_HALVED)
    coarse, fine, pixel, scatter = Pressing(part, body.kernel), Pressing(part.halved(), body.kernel), [], []
    for p in table[0, chosen]:
        rows = np.array([pressing.at(p, name) for pressing in pressings])
        halved = np.abs(np.log(np.divide(fine.at(p, name), coarse.at(p, name)))).max()
        pixel.append(_OF_HALVING * np.expm1(halved))
        scatter.append(np.expm1(np.log(rows[:, 1:]).std(axis=0, ddof=1).max() / 2))
    # with fewer points in contact finer ones change no less: what a part of the patch shows there is chance
    pixel = np.maximum.accumulate(pixel[::-1])[::-1]
    places = np.log(table[0])
    return {kind: np.interp(places, places[chosen], values) for kind, values in (("pixel", pixel), ("patch", scatter))}


def _spots(pressures: np.ndarray | None, mirrored: bool) -> tuple[float, float]:
    """Mean diameter of the spots in points, 2 √(points/(π spots)); and by how much their points make λ too large: those
    at their borders count whole."""
    assert pressures is not None
    touching = pressures > 0
    points, spots = np.count_nonzero(touching), max(1, label(touching)[1])
    edges = sum(np.count_nonzero(np.diff(touching, axis=axis)) for axis in (0, 1))
    if not mirrored:
        edges += sum(np.count_nonzero(touching.take(0, axis) != touching.take(-1, axis)) for axis in (0, 1))
    return 2 * math.sqrt(points / (math.pi * spots)), 1 / max(1 - OUTSIDE * edges / points, _SHARE) - 1


def _provenance(scan: Any, patch: Patch) -> str:
    size, step = (" × ".join(f"{1e6 * v:.4g}" for v in pair[::-1]) for pair in (scan.sizes, scan.steps))
    points = " × ".join(map(str, scan.z.shape))
    return f"{points} points, {step} µm apart, {size} µm; {patch.treatment}; rms slope {patch.slope:.3g}"


def _about(errors: Mapping[str, float]) -> list[str]:
    pixel = f"finer points change A, λ or p_max by up to {rounded(100 * errors['pixel'])} % from λ = {_COUNTS:g} on"
    if "patch" not in errors:
        unknown = "the scan is too small to be compared with its quarters: how much another patch differs is not known"
        return [pixel, unknown]
    patch = rounded(100 * errors["patch"])
    return [
        pixel,
        f"another patch of this size may differ by {patch} % in λ or p_max, half of the scatter of its four quarters",
    ]


def _coarse(lam: np.ndarray, diameters: np.ndarray, errors: np.ndarray) -> list[str]:
    """A sentence where spots are less than _COARSE points wide."""
    coarse = diameters < _COARSE
    if not coarse.any():
        return []
    last = lam[np.flatnonzero(coarse)[-1]]
    return [
        f"up to λ = {last:.2g} spots span fewer than {_COARSE:g} points, {diameters.min():.1f} at the least, and are "
        f"under-resolved: λ, A or p_max are off by up to {rounded(100 * errors[coarse].max())} % there, λ mostly too "
        "large; filter the scan with a cutoff, or give refine"
    ]


def _beside_theory(p: np.ndarray, lam: np.ndarray, slope: float) -> tuple[str, ...]:
    """A sentence on λ h'E*/p at a small λ on a half-space, beside two theories; none without such a row."""
    at = int(np.argmin(np.abs(np.log(lam / _SMALL))))
    if not _SMALL / 2 < lam[at] < 2 * _SMALL:
        return ()
    ratio = lam[at] * slope / p[at]
    theories = f"{ratio / _PERSSON:.2f} times Persson's {_PERSSON:.2f}; Bush, Gibson and Thomas have 2.51"
    return (f"λ h'E*/p is {ratio:.2f} at λ = {lam[at]:.2g}, {theories}",)


def _on_one_line(text: str) -> str:
    return " ".join(text.split())


def _shown(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"
