"""What tells one case, and one study, from another: only the values that can change a number.

A value counts where its case uses the parameter (`needed_by`, `used_by` in the solver's table) and where it is not the
default. So keys and digests stay as they are when an unused value is edited, or a parameter with a default is added to
the program. Whoever changes a default must change NUMERICS_VERSION, which is in the digest and beside every key.
"""

import hashlib
import json
from functools import partial

import numpy as np

from solver import NUMERICS_VERSION
from solver.laws import identity
from solver.parameters import uses

from .grid import Grid, along
from .vocabulary import PARAMETERS, VOCABULARY


def counts(grid: Grid, name: str) -> np.ndarray:
    """Where the value of a parameter counts: bool along the dimensions of the grid, of length 1 where all are alike."""
    value, default = along(grid, name), VOCABULARY[name].own.default
    given = ~np.isnan(value) if default is None else value != default
    return given & uses(name, partial(along, grid))


def law_versions(grid: Grid) -> list[str]:
    """ "NAME VERSION" of each micro law in the grid that does not come with this package."""
    words = set(grid.values["micro"][1].ravel().tolist()) if "micro" in grid.values else ()
    return sorted(identity(word) for word in words if identity(word) != word)


def digest_of(definition) -> str:
    """sha256 over what determines the results of a `Definition`: not title, comments or block size.

    The values of a dimension are always in it, since results are selected by them. Of the other parameters only the
    values that count are.
    """
    grid = definition.grid
    arrays = {**grid.labels, "x": (("x",), definition.x)}
    arrays |= {name: (dims, array) for name, (dims, array) in grid.values.items() if name in grid.sizes}
    content = {
        "numerics_version": NUMERICS_VERSION,
        "sizes": list(grid.sizes.items()),
        "arrays": {name: (dims, digest_of_array(array)) for name, (dims, array) in arrays.items()},
        "values": {name: _digest_of_values(grid, name) for name in PARAMETERS if name not in grid.sizes},
        "profiles": definition.profiles,
        "dtype": definition.dtype,
    }
    content["values"] = {name: found for name, found in content["values"].items() if found}
    content |= {"laws": law_versions(grid)} if law_versions(grid) else {}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _digest_of_values(grid: Grid, name: str) -> tuple:
    """Shape of a parameter, digest of the places whose value counts for some case, digest of these values; () if none
    does."""
    dims, array = grid.values.get(name, ((), None))
    if not dims and (array is None or array == VOCABULARY[name].own.default):  # quick: most parameters end here
        return ()
    values = along(grid, name)
    several = tuple(np.flatnonzero(np.array(values.shape) == 1))
    mask = np.broadcast_to(counts(grid, name).any(axis=several, keepdims=True), values.shape)
    return (values.shape, digest_of_array(mask), digest_of_array(values[mask])) if mask.any() else ()


def digest_of_array(array: np.ndarray) -> str:
    """Numbers by their float64 bytes, all else (labels of a DataArray may be dates) by its text."""
    numbers = array.dtype.kind in "iufb"
    raw = (array.astype("<f8") + 0.0).tobytes() if numbers else "\0".join(map(str, array.ravel().tolist())).encode()
    return hashlib.sha256(raw).hexdigest()
