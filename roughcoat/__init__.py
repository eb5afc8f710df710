"""Contact of a rough sphere with a coated body: `import roughcoat as rc`.

It gives what the package `study` gives, which comes with it, and takes that one, whatever a user has in the working
folder: no study.py, study/, solver.py or solver/ there is imported. After `import roughcoat` the names `study` and
`solver` are those of roughcoat's packages, in the processes too that it starts. `study` is imported when a name of it
is asked for.
"""

import os
import sys
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from study import *  # noqa: F403
    from study import __version__ as __version__

_PLACE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # the folder, or zip file, of the packages


class _OwnPackages:
    """A finder of modules that takes `study` and `solver` from beside this package. Python asks it first."""

    @staticmethod
    def find_spec(name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        return PathFinder.find_spec(name, [_PLACE]) if name in ("study", "solver") else None


def _refuse_others() -> None:
    """Raise ImportError if the program has imported another study or solver before."""
    for name in ("study", "solver"):
        other = sys.modules.get(name)
        place = next(iter(getattr(other, "__path__", ())), getattr(other, "__file__", None) or "")
        if other and os.path.realpath(place) != os.path.realpath(os.path.join(_PLACE, name)):
            wrong = f"has been imported as {name}, which is also a package of roughcoat: give it another name"
            raise ImportError(f"{getattr(other, '__file__', None) or place}: {wrong}", name=name, path=place)


_refuse_others()
sys.meta_path.insert(0, _OwnPackages)


def __getattr__(name: str) -> Any:
    if name.startswith("__") and name not in ("__all__", "__version__"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    study = import_module("study")
    if name != "__all__" and name not in dir(study):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(study, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *dir(import_module("study"))})
