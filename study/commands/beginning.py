"""The commands of the first minutes: what is installed, a study to edit or show, and the page for a browser."""

import os
import platform
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

from solver.numerics.userfile import opened

from ..data.provenance import NUMERICS_VERSION, package_version
from ..explorer.page import MARK, page
from ..files.atomic import replacing
from ..inputs.definition import StudyError
from ..inputs.places import study_file
from ..inputs.reading import text_in
from ..terminal import answer, program

EXTRAS = {
    "topography": ("SurfaceTopography", "scans in the formats of instruments"),
    "afm": ("afmformats", "force curves of instruments"),
    "xlsx": ("openpyxl", "tables as .xlsx"),
    "cluster": ("distributed", "run --scheduler"),
    "completion": ("argcomplete", "completion of words in a shell"),
}
"""Extra that a user may install -> the package that shows its presence, and its purpose."""


def new(options, name: str) -> int:
    """Write a study file to edit, NAME.toml: with comments, or a copy of a study. A file that is there stays."""
    path = Path(os.path.expanduser(name))
    path = path if path.suffix == ".toml" else path.with_name(f"{path.name}.toml")
    if options.source:
        text = text_in(study_file(options.source))
    else:
        text = (files("study.inputs") / "template.toml").read_text(encoding="utf-8")
    try:
        with path.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileNotFoundError:
        raise StudyError([f"{path.as_posix()}: there is no folder {path.parent.as_posix()}"]) from None
    except FileExistsError:
        raise StudyError([f"{path.as_posix()}: exists and is not overwritten: choose another name"]) from None
    check, run = (f"`{program()} {command} {path.as_posix()}`" for command in ("check", "run"))
    return answer(f"{path.as_posix()}: edit it, then {check} and {run}")


def show(_, name: str) -> int:
    """Print a study file."""
    return answer(text_in(study_file(name)).rstrip("\n"))


def doctor(*_) -> int:
    """Say what this installation has: versions, the compiled core, processors, extras, where its sample data are.

    Exit code 1 if the contact that it solves is not Hertz's.
    """
    from .. import samples
    from ..solving import solve

    load = 1e-6
    radius = float(solve(P=load, base="half_space", micro="smooth", profiles=False)["a"])
    right = abs(radius / (0.75 * load) ** (1 / 3) - 1) < 1e-6
    packages = ", ".join(f"{name} {package_version(name)}" for name in ("numpy", "scipy", "xarray", "netCDF4", "dask"))
    lines = [
        f"roughcoat      {package_version('roughcoat')}, numerics {NUMERICS_VERSION}",
        f"Python         {platform.python_version()}; {packages}",
        f"compiled core  {_core()}",
        f"processors     {os.cpu_count()}; a run starts one worker for each, with one BLAS thread in each worker",
    ]
    for extra, (package, purpose) in EXTRAS.items():
        state = package_version(package) if find_spec(package) else f"missing: pip install 'roughcoat[{extra}]'"
        lines.append(f"{extra:14} {state} ({purpose})")
    lines += [f"sample data    {samples.scan()}", f"               {samples.curve()}"]
    lines.append(f"one contact    {'solved: its radius is that of Hertz' if right else 'WRONG: not that of Hertz'}")
    return answer(*lines) or int(not right)


def _core() -> str:
    """Words on the path that computes, and on the other variants."""
    from solver.compiled.library import VARIABLE, VARIANTS, available

    variants = available()
    chosen = os.environ.get(VARIABLE, "")
    if variants and chosen != "numpy":
        return f"{chosen or variants[0]}; this processor runs {', '.join(variants)} of the built {', '.join(VARIANTS)}"
    why = f"{VARIABLE} chooses numpy" if variants else "none was built: install a C compiler, then roughcoat again"
    return f"none, numpy computes, 3 to 6 times slower ({why})"


def explore(options, _) -> int:
    """Write the page. A file that is no such page is not replaced."""
    path = Path(options.out)
    if path.is_dir():
        raise StudyError([f"--out {path} is a folder: name a file in it, such as {path / 'contact.html'}"])
    if path.exists() and not _is_page(path):
        raise StudyError([f"--out {path}: the file there is not a page of the explorer and is not overwritten"])
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as temporary:
        temporary.write_text(page(), encoding="utf-8")
    return answer(f"{path}: open it in a browser; it needs no network")


def _is_page(path: Path) -> bool:
    """Whether a file is a page of the explorer. Raises OSError if it cannot be read."""
    try:
        with opened(path) as file:
            return MARK in file.read(10 * len(MARK))
    except ValueError:  # a pipe or device, or far too large
        return False
