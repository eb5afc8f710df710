"""Study files: TOML text -> a checked, frozen Definition with the digest of what determines its numbers."""

import hashlib
import json
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from solver import NUMERICS_VERSION

from .draft import Draft
from .grid import Grid, shown
from .vocabulary import MICRO_LAW_PARAMETERS, NUMERICS, PARAMETERS, VOCABULARY, check, suggest

BLOCK = 2000
POINTS = 33
MOST_VALUES = (
    500_000_000  # numbers in one results file, 4 GB: a larger grid is a slip of the pen or wants to be several studies
)
PER_CASE = 16  # numbers per case besides the profiles, roughly
SECTIONS = {
    "contact": ("title", "kind", "model", "axes", "cases", "numerics", "output"),
    "micro_law": ("title", "kind", "model", "axes", "cases", "fit"),
}


class StudyError(ValueError):
    """Input that cannot be used; `messages` has every reason, one line each."""

    def __init__(self, messages):
        self.messages = tuple(messages)
        super().__init__("\n".join(self.messages))


@dataclass(frozen=True, eq=False)
class Definition:
    """What a study computes.

    kind : "contact" or "micro_law"; text : the study file, goes into the dataset; x : (m,) points r/a of the
        profiles; fit : arguments of `solver.fit_power_law` (micro_law only); block : cases computed and stored at a
        time; digest : sha256 of all that determines the numbers.
    """

    name: str
    kind: str
    title: str
    text: str
    grid: Grid
    x: np.ndarray
    profiles: bool
    fit: dict
    block: int
    digest: str


def read(path) -> Definition:
    """Definition of a study file. Raises StudyError with all that is wrong with it."""
    path = Path(path)
    where = path.as_posix()
    if path.suffix != ".toml" or not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", path.stem):
        raise StudyError([f"{where}: a study file is called NAME.toml, NAME of letters, digits, _, - and ."])
    try:
        text = path.read_text(encoding="utf-8-sig")
        tables = tomllib.loads(text)
    except OSError as error:
        raise StudyError([f"{where}: cannot be read: {error.strerror}"]) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise StudyError([f"{where}: is not valid TOML: {error}"]) from None
    return from_tables(tables, path.stem, text, where)


def from_tables(tables: dict, name: str, text: str, where: str) -> Definition:
    """Definition of the parsed TOML tables; `where` begins every message."""
    kind = tables.get("kind", "contact")
    if kind not in SECTIONS:
        raise StudyError([f'{where}: kind = {shown(kind)}: must be one of "contact", "micro_law"'])
    draft = Draft(known=PARAMETERS if kind == "contact" else MICRO_LAW_PARAMETERS)
    for key in tables:
        if key not in SECTIONS[kind]:
            draft.errors.append(f'"{key}" is not a section{suggest(key, SECTIONS[kind])}')
    numerics = dict(_table(tables, "numerics", draft))
    block = numerics.pop("block", BLOCK)
    if type(block) is not int or not 1 <= block <= 1_000_000:
        draft.errors.append(f"[numerics] block = {shown(block)}: must be a whole number in [1, 1000000]")
    for key, value in _table(tables, "model", draft).items():
        draft.scalar(key, value, "[model]")
    for key, value in numerics.items():
        if key in NUMERICS:
            draft.scalar(key, value, "[numerics]")
        else:
            draft.errors.append(f'[numerics] "{key}" is not known{suggest(key, (*NUMERICS, "block"))}')
    if "cases" in tables:
        draft.cases(tables["cases"])
    for key, value in _table(tables, "axes", draft).items():
        draft.axis(key, value, "[axes]")
    output = _table(tables, "output", draft)
    for key in output:
        if key not in ("x", "profiles"):
            draft.errors.append(f'[output] "{key}" is not known{suggest(key, ("x", "profiles"))}')
    fit = fit_arguments(_table(tables, "fit", draft), draft.errors) if kind == "micro_law" else {}
    title = tables.get("title", "")
    if not isinstance(title, str):
        draft.errors.append(f"title = {shown(title)}: must be text")
    x, profiles = output.get("x", POINTS), output.get("profiles", True)
    return complete(
        draft, where, name=name, kind=kind, title=title, text=text, x=x, profiles=profiles, fit=fit, block=block
    )


def complete(draft: Draft, where: str, *, name, kind, title, text, x, profiles, fit, block) -> Definition:
    """Finish a draft: the checks of the whole, and the digest. Raises StudyError with every message collected."""
    grid = draft.finish()
    x = profile_points(x, draft.errors)
    if not isinstance(profiles, bool):
        draft.errors.append(f"profiles = {shown(profiles)}: must be true or false")
    count = grid.size * (PER_CASE + 2 * len(x) * bool(profiles))
    if count > MOST_VALUES:
        draft.errors.append(
            f"{grid.size} cases make {count:.1e} numbers: at most {MOST_VALUES:.0e} (fewer points, or profiles = false)"
        )
    if draft.errors:
        raise StudyError(f"{where}: {message}" for message in draft.errors)
    digest = digest_of(kind, grid, x, profiles, fit)
    return Definition(name, kind, title, text, grid, x, profiles, fit, block, digest)


def digest_of(kind: str, grid: Grid, x: np.ndarray, profiles: bool, fit: dict) -> str:
    """sha256 over what determines the numbers: not title, comments or block size."""
    content = {
        "numerics_version": NUMERICS_VERSION,
        "kind": kind,
        "sizes": list(grid.sizes.items()),
        "values": {name: (dims, np.asarray(array).tolist()) for name, (dims, array) in grid.values.items()},
        "labels": {
            name: (dims, [str(label) for label in array.tolist()]) for name, (dims, array) in grid.labels.items()
        },
        "x": x.tolist(),
        "profiles": profiles,
        "fit": fit,
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def profile_points(x, errors: list[str]) -> np.ndarray:
    """Points r/a from their number or their list: increasing from 0 to 1."""
    if type(x) is int and 2 <= x <= 10_000:
        return np.linspace(0.0, 1.0, x)
    points = x.tolist() if isinstance(x, np.ndarray) else x
    if not isinstance(points, (list, tuple)) or not all(type(point) in (int, float) for point in points):
        errors.append(f"x = {shown(x)}: must be a whole number in [2, 10000] or a list of numbers from 0 to 1")
    elif (
        len(points) < 2
        or points[0] != 0
        or points[-1] != 1
        or not all(a < b for a, b in zip(points, points[1:], strict=False))
    ):
        errors.append("x: a list must increase from 0 to 1, both included")
    else:
        return np.array(points, dtype=float)
    return np.linspace(0.0, 1.0, 2)


def fit_arguments(given: dict, errors: list[str]) -> dict:
    """Arguments of the least-squares fit from the table [fit], defaults filled in, pressures in E1*."""
    known = [name.removeprefix("fit.") for name in VOCABULARY if name.startswith("fit.")]
    fit = {key: given.get(key, VOCABULARY[f"fit.{key}"].default) for key in known}
    errors += [
        f'[fit] "{key}" is not known{suggest(key, (*known, "check"))}' for key in given if key not in (*known, "check")
    ]
    for key, value in fit.items():
        text = check(VOCABULARY[f"fit.{key}"], value)
        if text:
            errors.append(f"[fit] {key} = {shown(value)}: {text}")
    fit["check"] = given.get("check", [0.0025, 0.025])
    limits = fit["check"]
    if (
        not isinstance(limits, list)
        or len(limits) != 2
        or any(check(VOCABULARY["fit.p_min"], end) for end in limits)
        or limits[0] >= limits[1]
    ):
        errors.append(f"[fit] check = {limits}: must be [low, high] with 0 < low < high")
    return fit


def law_points(fit: dict, errors: list[str]) -> np.ndarray:
    """Pressures p of a micro-law study in E1*: from p_min to p_max in steps as near to `step` as fits."""
    if errors:
        return np.array([])
    steps = (fit["p_max"] - fit["p_min"]) / fit["step"]
    if not 1 <= steps <= 1e6:
        errors.append("[fit] p_max must be at least one step, and at most a million steps, above p_min")
        return np.array([])
    return np.linspace(fit["p_min"], fit["p_max"], 1 + round(steps))


def _table(tables: dict, key: str, draft: Draft) -> dict:
    found = tables.get(key, {})
    if isinstance(found, dict):
        return found
    draft.errors.append(f"{key} = {shown(found)}: must be a table [{key}]")
    return {}
