"""Parameter studies of rough coated contacts: labelled grids, results that resume, figures and tables.

`solve` and `load` are the entrance, `summary` says in words what `solve` found, `plot` draws it; `python -m study`, or
`roughcoat`, is the same from a shell. `study.derived`, `study.materials`, `study.roughness`, `study.units` and
`study.vocabulary` are there without an import of their own. Names are imported when they are first used, so that
`python -m study --help` and complaints about a study file answer at once.
"""

from importlib import import_module

_HOME = {
    "solve": "solving",
    "load": "api",
    "Study": "api",
    "open_results": "files.results_file",
    "StudyError": "spec.definition",
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
    "vocabulary": "spec.vocabulary",
}
__all__ = list(_HOME)


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
