"""Parameter studies of rough coated contacts: labelled grids, results that resume, figures and tables.

`solve` and `load` are the entrance, `summary` says in words what `solve` found, `plot` draws it; `python -m study`, or
`roughcoat`, is the same from a shell. `study.derived`, `study.materials`, `study.roughness`, `study.units` and
`study.vocabulary` are there without an import of their own. Names are imported when they are first used, so that
`python -m study --help` and complaints about a study file answer at once.

After `import study` the name `solver` is that of roughcoat's package, whatever a user has in the working folder.
"""

import os
import sys
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder

_HOME = {
    "solve": "solving",
    "load": "api",
    "Study": "api",
    "open_results": "files.results_file",
    "StudyError": "inputs.definition",
    "decode": "data.dataset",
    "to_physical": "data.units",
    "from_physical": "data.units",
    "reduced_modulus": "data.units",
    "summary": "in_words",
    "readable": "data.units",
    "plot": "figures.lines",
}
_MODULES = {
    "derived": "data.derived",
    "materials": "specimen.materials",
    "roughness": "specimen.roughness",
    "units": "data.units",
    "vocabulary": "inputs.vocabulary",
}
__all__ = list(_HOME)
_BESIDE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # the folder, or zip file, of both packages


class _OwnSolver:
    """A finder of modules that takes `solver` from beside this package. Python asks it first: otherwise a solver.py, or
    a folder solver, in the working folder would be imported, and run, in its place.

    And `study.studies`, the book, in a clone, where it lies there too: a wheel has it in this package."""

    @staticmethod
    def find_spec(name: str, path=None, target=None) -> ModuleSpec | None:
        if name == "solver" or (name == "study.studies" and not os.path.isdir(os.path.join(*__path__, "studies"))):
            return PathFinder.find_spec(name, [_BESIDE])
        return None


def _take_own_solver() -> None:
    """Let `import solver` mean roughcoat's. Raises ImportError if the program has imported another one before."""
    own, other = _OwnSolver.find_spec("solver"), sys.modules.get("solver")
    if own and other:
        folders = list(getattr(other, "__path__", ()))  # none of a module that is a file
        if [os.path.realpath(folder) for folder in folders] != [os.path.realpath(os.path.dirname(own.origin))]:
            file = getattr(other, "__file__", None) or folders[0]
            wrong = "has been imported as solver, which is a package of roughcoat as well: give it another name"
            raise ImportError(f"{file}: {wrong}", name="solver", path=file)
    sys.meta_path.insert(0, _OwnSolver)


_take_own_solver()


def __getattr__(name: str):
    if name in _MODULES:
        return import_module(f".{_MODULES[name]}", __name__)
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f".{_HOME[name]}", __name__), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_MODULES})
