"""The command that reads study files only; it answers at once, for it imports neither xarray nor netCDF4."""

from ..physical.study_file import read
from ..terminal import answer
from .arguments import study_file


def check(_, file: str) -> int:
    """Read a study file and say its size."""
    definition = read(study_file(file))
    dims = " x ".join(f"{name} {size}" for name, size in definition.named(definition.grid.sizes).items()) or "one case"
    return answer(f"{file}: {definition.grid.size} cases ({dims}), digest {definition.digest[:16]}")
