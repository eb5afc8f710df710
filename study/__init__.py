"""Parameter studies of rough coated contacts: labelled grids, results that resume, figures and tables.

Start with `solve` and `load`; `summary` puts the results of `solve` into words, and `plot` draws them. `roughcoat`, or
`python -m study`, does the same from a shell. `import roughcoat as rc` has the same names as this package, even if the
working folder has a study.py. `__all__` lists the public names; docs/python.md has a line for each. A name is imported
when it is first used, so that `roughcoat --help` and complaints about a study file appear at once.

After `import study` the names `solver` and `roughcoat` mean roughcoat's packages, whatever the working folder has.
"""

import os
import sys
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import catalogue, samples
    from .adhesion import effective_work
    from .api import Study, load
    from .creep import effective_load
    from .data import derived, units
    from .data.dataset import decode
    from .data.units import from_physical, readable, reduced_modulus, to_physical
    from .derivatives import sensitivities
    from .fields import extremes, stresses
    from .figures.plots import plot
    from .figures.registry import drawing, figure, table
    from .figures.stresses.picture import plot_stresses
    from .files.results_file import open_results
    from .in_words import summary
    from .inputs import vocabulary
    from .inputs.definition import StudyError
    from .inverse.curves import curves
    from .inverse.design import design
    from .inverse.design_choice import feasible, front
    from .inverse.fit import fit
    from .scan_laws import roughness
    from .solving import solve
    from .specimen import materials
    from .yields.first_yield import first_yield
    from .yields.protecting_layer import h_protect

    __version__: str

__all__ = [
    "Study",
    "StudyError",
    "catalogue",
    "curves",
    "decode",
    "derived",
    "design",
    "drawing",
    "effective_load",
    "effective_work",
    "extremes",
    "feasible",
    "figure",
    "first_yield",
    "fit",
    "from_physical",
    "front",
    "h_protect",
    "load",
    "materials",
    "open_results",
    "plot",
    "plot_stresses",
    "readable",
    "reduced_modulus",
    "roughness",
    "samples",
    "sensitivities",
    "solve",
    "stresses",
    "summary",
    "table",
    "to_physical",
    "units",
    "vocabulary",
]
_HOME = {
    "solve": "solving",
    "sensitivities": "derivatives",
    "extremes": "fields",
    "design": "inverse.design",
    "feasible": "inverse.design_choice",
    "front": "inverse.design_choice",
    "effective_load": "creep",
    "effective_work": "adhesion",
    "first_yield": "yields.first_yield",
    "h_protect": "yields.protecting_layer",
    "fit": "inverse.fit",
    "curves": "inverse.curves",
    "stresses": "fields",
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
    "plot": "figures.plots",
    "plot_stresses": "figures.stresses.picture",
    "figure": "figures.registry",
    "table": "figures.registry",
    "drawing": "figures.registry",
}
_MODULES = {
    "catalogue": "catalogue",
    "derived": "data.derived",
    "materials": "specimen.materials",
    "roughness": "scan_laws.roughness",
    "samples": "samples",
    "units": "data.units",
    "vocabulary": "inputs.vocabulary",
}
_PLACE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # the folder, or zip file, of both packages


class _OurPackages:
    """A finder of modules that takes `solver` and `roughcoat` from the folder that has this package. Python asks it
    first: otherwise a solver.py, or a folder solver, in the working folder would be imported, and run, instead.

    In a clone it takes `study.studies`, the book, from the same folder; in a wheel the book lies in this package."""

    @staticmethod
    def find_spec(name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        in_a_clone = name == "study.studies" and not os.path.isdir(os.path.join(*__path__, "studies"))
        return PathFinder.find_spec(name, [_PLACE]) if in_a_clone or name in ("roughcoat", "solver") else None


def _take_our_solver() -> None:
    """Let `import solver` find roughcoat's solver. Raises ImportError if the program has imported another one
    before."""
    ours, other = _OurPackages.find_spec("solver"), sys.modules.get("solver")
    if ours and other:
        folders = list(getattr(other, "__path__", ()))  # a module that is a file has none
        if [os.path.realpath(folder) for folder in folders] != [os.path.realpath(os.path.dirname(ours.origin or ""))]:
            file = getattr(other, "__file__", None) or folders[0]
            wrong = "has been imported as solver, which is also a package of roughcoat: give it another name"
            raise ImportError(f"{file}: {wrong}", name="solver", path=file)
    sys.meta_path.insert(0, _OurPackages)


def _show_in_notebook() -> None:
    """Let a running notebook show a contact with a small picture of its pressure."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if hasattr(shell, "kernel"):  # the shell of IPython in a terminal has none
        import_module(".specimen.pictures", __name__).show_in(shell)


_take_our_solver()
_show_in_notebook()


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f".{_MODULES[name]}", __name__)
    if name == "__version__":
        from .data.provenance import package_version

        return package_version("roughcoat")
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_HOME[name]}", __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, "__version__"})
