"""Results as datasets: flat arrays -> labelled Dataset with CF-1.11 attributes; numbers of flags as names."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from solver import Model, Status
from solver.status import NO_SOLUTION

from ..inputs.definition import Definition
from ..inputs.grid import along, unflatten
from ..inputs.identity import law_versions
from ..inputs.laws import COMMENT
from ..inputs.scene.scene import bare_variable
from ..inputs.vocabulary import (
    BY_INPUT,
    CONTROLS,
    INTEGERS,
    NOT_RUN,
    NUMERICS,
    PARAMETERS,
    WITH_SPREADS,
    attributes,
    names,
)
from ..rules.rule import validity_attributes, validity_of, whole
from ..specimen.materials import strength_of
from .provenance import provenance


def failed_cases(status: np.ndarray) -> np.ndarray:
    """The places in `status` (n,) of the cases that have failed."""
    return np.flatnonzero(~np.isin(status, (0, *NO_SOLUTION)))


def not_run(definition: Definition, size: int) -> dict[str, np.ndarray]:
    """What `arrays_of` gives for `size` cases that were never computed: NaN, status NOT_RUN, counts 0."""
    found = {
        name: np.full(size, np.nan, definition.dtype) for name in (*CONTROLS, *definition.results, *definition.stresses)
    }
    found |= {name: np.full((size, len(definition.x)), np.nan, definition.dtype) for name in definition.profiles}
    if definition.inputs:
        with_spreads = [(name, found[name]) for name in (*WITH_SPREADS, *definition.profiles)]
        shape = size, len(definition.inputs)
        found |= {f"{n}{BY_INPUT}": np.full((*shape, *own.shape[1:]), np.nan, own.dtype) for n, own in with_spreads}
    found |= {name: np.zeros(size, dtype) for name, dtype in INTEGERS.items()}
    found["status"][:] = NOT_RUN
    return found


class Parts(NamedTuple):
    """What a dataset is made of. The dataset is made once, last: that takes as long as solving a contact.

    by_input : result -> its derivatives by the inputs of the definition, (*grid.shape, k) and (*grid.shape, k, m)
    """

    variables: dict[str, xr.Variable]
    coords: dict[str, xr.Variable]
    attributes: dict
    by_input: dict[str, np.ndarray] = {}

    def dataset(self) -> xr.Dataset:
        """The dataset of these parts, settings last: `study.solve` has them as attributes, and `xr.concat` compares no
        coordinate behind one that only the first dataset has."""
        last = {name: own for name, own in self.coords.items() if name in NUMERICS}
        coords = {name: own for name, own in self.coords.items() if name not in NUMERICS} | last
        return without_fill_values(xr.Dataset(self.variables, coords, self.attributes))

    def settings_apart(self) -> "Parts":
        """The parts with numerical settings that all cases share as attributes, not as coordinates.

        It is done before the dataset is made, since dropping variables of a dataset copies all others.
        """
        shared = [name for name in NUMERICS if name in self.coords and not self.coords[name].ndim]
        coords = {name: own for name, own in self.coords.items() if name not in shared}
        attributes = {name: self.coords[name].values.item() for name in shared}
        return self._replace(coords=coords, attributes=self.attributes | attributes)


def parts(definition: Definition, arrays: dict[str, np.ndarray], command: str) -> Parts:
    """The parts of the dataset of a grid, from flat arrays (B, ...): dimensions in the order of the study, then `x`."""
    found = labelled(definition, arrays, command)
    found.variables["status"].attrs |= status_attributes()
    found.variables["model_used"].attrs |= model_attributes()
    radii = definition.scene.radii() if definition.scene else {}
    strengths = _strengths(definition) if definition.stresses and definition.scene else {}
    found.variables["validity"] = validity_of(strengths | found.variables | found.coords | radii)
    return found


def _strengths(definition: Definition) -> dict[str, xr.Variable]:
    """Yield strengths of the materials that are named, over the unit of moduli; NaN of those that have none."""
    scene, found = definition.scene, {}
    for body, name in (("layer", "Y1"), ("body", "Y2")):
        if body in scene.names:
            dim, texts = scene.names[body]
            values = np.array([strength_of(text) for text in texts])
            found[name] = xr.Variable(dim, values) if dim else xr.Variable((), values[0])
            found[name] = found[name] / bare_variable(scene.unit)
    return found


def labelled(definition: Definition, arrays: dict[str, np.ndarray], command: str) -> Parts:
    """`parts` of any of the arrays, even none, without `validity` and the names of flags."""
    grid = definition.grid
    rigid = bool((along(grid, "n") == 0).any())  # if one layer is on a rigid base, all are
    values = grid.values | grid.labels
    known = {name: attributes(name, rigid) for name in (*PARAMETERS, *names("coordinate")) if name in values}
    for name in ("B", "beta") if grid.fitted else ():
        known[name]["comment"] = COMMENT
    coordinates = {name: xr.Variable(dims, array, known.get(name, {})) for name, (dims, array) in values.items()}
    coordinates["x"] = xr.Variable(("x",), definition.x, attributes("x"))
    dims = tuple(grid.sizes)
    variables = {
        name: xr.Variable(dims + ("x",) * (flat.ndim - 1), unflatten(grid, flat), attributes(name, rigid))
        for name, flat in arrays.items()
        if name not in grid.values and not name.endswith(BY_INPUT)
    }
    by_input = {name.removesuffix(BY_INPUT): unflatten(grid, arrays[name]) for name in arrays if BY_INPUT in name}
    laws = law_versions(grid)
    about = provenance(definition, command) | ({"micro_laws": "\n".join(laws)} if laws else {})
    return Parts(variables, coordinates, about, by_input)


def without_fill_values(dataset: xr.Dataset) -> xr.Dataset:
    """The same dataset, changed so that a user's `to_netcdf` writes no _FillValue of coordinates: CF forbids it."""
    for name in dataset.coords:
        dataset.variables[name].encoding["_FillValue"] = None
    return dataset


def status_words() -> dict[int, str]:
    """Value of `status` -> its name: the solver's statuses, and 127, not run."""
    return {int(status): status.name.lower() for status in Status} | {NOT_RUN: "not_run"}


def status_attributes() -> dict:
    """CF flags of `status`."""
    words = status_words()
    sentences = {int(status): status.meaning for status in Status} | {NOT_RUN: "the case has not been computed"}
    return {
        "flag_values": np.array(list(words), dtype=np.int8),
        "flag_meanings": " ".join(words.values()),
        "comment": "; ".join(f"{value}: {text}" for value, text in sentences.items()),
    }


def model_attributes() -> dict:
    """CF flags of `model_used`."""
    values = np.array([int(model) for model in Model], dtype=np.int8)
    return {"flag_values": values, "flag_meanings": " ".join(model.name.lower() for model in Model)}


def decode(flags: xr.DataArray) -> xr.DataArray:
    """The names of `status`, `model_used` or `validity`.

    Several assumptions that a case violates are separated by blanks; where none is, the text is empty. A number without
    a name stays a number. Where `where`, `reindex` or `concat` of xarray have left no case, NaN, status and
    validity are "not_run", and the model is "none".

    Parameters
    ----------
    flags : one of these three arrays of a dataset of contacts

    Returns
    -------
    xarray.DataArray : texts, over the same dimensions

    Raises
    ------
    ValueError : it is no array, or one that has none of these names, and no attribute `flag_meanings`; its numbers are
        of no case, such as the mean of several

    Examples
    --------
    >>> import study
    >>> found = study.solve(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> study.decode(found.model_used).values.tolist()
    ['smooth_half_space', 'smooth_half_space']
    """
    known = {"status": status_attributes, "model_used": model_attributes, "validity": validity_attributes}
    attributes = flags.attrs
    if "flag_meanings" not in attributes:  # arithmetic of xarray loses attributes
        name = getattr(flags, "name", f"a {type(flags).__name__}")
        if name not in known:
            raise ValueError(f"{name or 'the array'} is none of {', '.join(known)}")
        attributes = known[name]()
    words, values = attributes["flag_meanings"].split(), whole(flags.values, attributes)
    if "flag_masks" in attributes:
        masks = np.atleast_1d(attributes["flag_masks"]).tolist()
        present = np.unique(values).tolist()
        names = {v: " ".join(w for m, w in zip(masks, words, strict=True) if v & m) for v in present}
    else:
        names = dict(zip(np.atleast_1d(attributes["flag_values"]).tolist(), words, strict=True))
    texts = [names.get(value, str(value)) for value in values.ravel().tolist()]
    named = np.array(texts, dtype=str).reshape(flags.shape)
    if "flag_masks" in attributes and flags.dtype.kind == "f":  # the mask 0 would say that the case is a good one
        named = np.where(np.isfinite(flags.values), named, status_words()[NOT_RUN])
    return xr.DataArray(named, flags.coords, flags.dims, flags.name)
