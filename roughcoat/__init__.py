"""Contact of a rough sphere with a coated body: `import roughcoat as rc`.

It gives what the package `study` gives, which comes with it, and takes that one, whatever a user has in the working
folder: no study.py, study/, solver.py or solver/ there is imported. After `import roughcoat` the names `study` and
`solver` are those of roughcoat's packages, in the processes too that it starts.
"""

import os
import sys
from importlib.machinery import ModuleSpec, PathFinder
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from study import *  # noqa: F403
    from study import __version__ as __version__

_BESIDE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # the folder, or zip file, of the packages


class _OwnStudy:
    """A finder of modules that takes `study` from beside this package. Python asks it first."""

    @staticmethod
    def find_spec(name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        return PathFinder.find_spec(name, [_BESIDE]) if name == "study" else None


sys.meta_path.insert(0, _OwnStudy)

import study  # noqa: E402

_taken = next(iter(getattr(study, "__path__", ())), study.__file__ or "")
if os.path.realpath(_taken) != os.path.realpath(os.path.join(_BESIDE, "study")):
    _wrong = "has been imported as study, which is a package of roughcoat as well: give it another name"
    raise ImportError(f"{_taken}: {_wrong}", name="study", path=_taken)

__all__ = study.__all__


def __getattr__(name: str) -> Any:
    if name not in dir(study):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(study, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *dir(study)})
