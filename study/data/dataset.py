"""Results as datasets: flat arrays -> labelled Dataset with CF-1.11 attributes; flags as words."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np

from solver import Model, Status
from solver.known import Known
from solver.numerics.caches import once
from solver.parameters import one_of
from solver.status import NO_SOLUTION

from ..arrays import xarray_later as xr
from ..arrays.labelled import Labelled, as_xarray
from ..inputs.definition import Definition
from ..inputs.grid import along, unflatten
from ..inputs.identity import law_versions
from ..inputs.lexicon import KNOWN, TABLES, encoding_of
from ..inputs.punch.micro_laws import COMMENT, USED, used
from ..inputs.punch.stresses import LAYER_NUMBER, numbered, words
from ..inputs.scene.scene import bare_variable
from ..inputs.vocabulary import (
    BY_INPUT,
    CONTROLS,
    FIRST_MATERIAL,
    INTEGERS,
    NOT_RUN,
    NUMERICS,
    TRUTHS,
    WITH_SPREADS,
    attributes,
    names,
)
from ..rules.rule import validity_attributes, validity_of, whole
from ..rules.strength import FROM_HARDNESS, OF_MATERIAL
from .provenance import provenance


def failed_cases(status: np.ndarray) -> np.ndarray:
    """The positions in `status` (n,) of the cases that have failed."""
    return np.flatnonzero(~one_of(status, (0, *NO_SOLUTION)))


def not_run(definition: Definition, size: int) -> dict[str, np.ndarray]:
    """Arrays of `size` cases that were never computed: NaN, status NOT_RUN, counts 0."""
    numbers = (*CONTROLS, *definition.results, *definition.stresses)
    shapes = {name: (size, *definition.shape_of(name)) for name in (*numbers, *definition.profiles)}
    arrays = {name: np.full(shape, np.nan, definition.dtype) for name, shape in shapes.items() if name not in TRUTHS}
    if definition.inputs:
        with_spreads = [(name, arrays[name]) for name in (*WITH_SPREADS, *definition.profiles)]
        shape = size, len(definition.inputs)
        for name, array in with_spreads:
            arrays[f"{name}{BY_INPUT}"] = np.full((*shape, *array.shape[1:]), np.nan, array.dtype)
    whole_numbers = INTEGERS | {name: dtype for name, dtype in TRUTHS.items() if name in definition.results}
    arrays |= {name: np.zeros(size, dtype) for name, dtype in whole_numbers.items()}
    arrays["status"][:] = NOT_RUN
    return arrays


STRENGTHS = {"layer": "Y1", "body": "Y2", "punch": "Y_punch"}
"""Body -> the input with its yield strength."""


class DatasetParts(NamedTuple):
    """The parts of a dataset. The dataset itself is built last and once: that takes as long as solving a contact.

    by_input : result -> its derivatives by the inputs of the definition, (*grid.shape, k), or (*grid.shape, k, m) for
        a profile
    """

    variables: dict[str, Labelled]
    coords: dict[str, Labelled]
    attributes: dict
    by_input: dict[str, np.ndarray] = {}

    def dataset(self) -> xr.Dataset:
        """The dataset of these parts, with the numerical settings as the last coordinates.

        In datasets of `study.solve` these settings are attributes. `xr.concat` compares coordinates in order, and stops
        at the first that the second dataset lacks.
        """
        variables, coords = (
            {name: as_xarray(variable, name) for name, variable in table.items()}
            for table in (self.variables, self.coords)
        )
        last = {name: variable for name, variable in coords.items() if name in NUMERICS}
        coords = {name: variable for name, variable in coords.items() if name not in NUMERICS} | last
        return without_fill_values(xr.Dataset(variables, coords, self.attributes))

    def settings_as_attributes(self) -> DatasetParts:
        """The parts in which the numerical settings that all cases share are attributes instead of coordinates.

        It is done here since dropping variables from a dataset would copy all others.
        """
        shared = [name for name in NUMERICS if name in self.coords and not self.coords[name].ndim]
        coords = {name: variable for name, variable in self.coords.items() if name not in shared}
        attributes = {name: self.coords[name].values.item() for name in shared}
        return self._replace(coords=coords, attributes=self.attributes | attributes)


class OneCase:
    """A contact without dimensions except `x`, read like a dataset: `contact["a"]`, `"h" in contact`, `contact.attrs`.
    Only `as_dataset` builds the dataset: xarray takes as long to import as a thousand contacts to solve.

    variables, coords : name -> Labelled; `variables` includes the coordinates
    attrs : the attributes of the dataset
    """

    def __init__(self, parts: DatasetParts):
        self.variables, self.coords, self.attrs = parts.variables | parts.coords, parts.coords, parts.attributes
        self._parts = parts

    @once
    def dataset(self) -> xr.Dataset:
        """The dataset of the contact."""
        return self._parts.dataset()

    def __contains__(self, name: str) -> bool:
        return name in self.variables

    def __getitem__(self, name: str) -> Labelled:
        return self.variables[name]

    def get(self, name: str, default: Any = None) -> Any:
        """The variable of a name, or the default."""
        return self.variables.get(name, default)


def as_dataset(contact: xr.Dataset | OneCase) -> xr.Dataset:
    """The contact as a dataset."""
    return contact.dataset if isinstance(contact, OneCase) else contact


def is_contact(value: Any) -> bool:
    """Whether the value is a dataset or a OneCase."""
    return isinstance(value, OneCase) or xr.is_dataset(value)


def validity_of_rows(arrays: dict[str, np.ndarray], known: Known, times: float = 1.0) -> Labelled:
    """`validity_of` for a row of cases: name -> (n,), their parameters and their results."""
    variables = {name: Labelled("case", array) for name, array in arrays.items()}
    variables["micro"].encoding = {KNOWN: known}
    variables["model_used"].attrs = model_attributes()
    return validity_of(variables, times)


def parts(definition: Definition, arrays: dict[str, np.ndarray], command: str) -> DatasetParts:
    """The parts of the dataset of a grid, from flat arrays (B, ...): dimensions in the order of the study, then `x`."""
    dataset_parts = labelled(definition, arrays, command)
    variables = dataset_parts.variables
    variables["status"].attrs |= status_attributes()
    variables["model_used"].attrs |= model_attributes()
    if definition.says_what_is_felt:
        flags = attributes("asperities_used") | asperities_attributes()
        variables["asperities_used"] = Labelled(tuple(definition.grid.sizes), used(definition.grid), flags)
    radii = definition.scene.radii() if definition.scene else {}
    strengths = _strengths(definition) if definition.scene else {}
    variables["validity"] = validity_of(strengths | variables | dataset_parts.coords | radii)
    return dataset_parts


def _strengths(definition: Definition) -> dict[str, Labelled]:
    """Yield strengths of the named materials over the unit of moduli, and whether they come from hardness."""
    scene, variables = definition.scene, {}
    layers = {body: body.replace(".material", ".Y") for body in scene.strengths if body.startswith("layers.")}
    for body, name in (STRENGTHS | layers).items():
        if body in scene.strengths:
            dim, strengths = scene.strengths[body]
            values, _, hard = zip(*strengths, strict=True)
            dims, place = (dim, slice(None)) if dim else ((), 0)
            variables[f"{name}{OF_MATERIAL}"] = Labelled(dims, np.array(values)[place]) / bare_variable(scene.unit)
            variables[f"{name}{FROM_HARDNESS}"] = Labelled(dims, np.array(hard)[place])
    return variables


def labelled(definition: Definition, arrays: dict[str, np.ndarray], command: str) -> DatasetParts:
    """Like `parts` but without `validity` and the words of flags. Arrays may be missing, even all."""
    grid = definition.grid
    rigid = bool((along(grid, "n") == 0).any())  # if one layer is on a rigid base, all are
    values = grid.values | grid.labels
    attributed = [name for name in (*grid.lexicon.parameters_of(values), *names("coordinate")) if name in values]
    attributes_of = {name: attributes(name, rigid, grid.lexicon.rows) for name in attributed}
    for name in ("B", "beta") if grid.fitted else ():
        attributes_of[name]["comment"] = COMMENT
    coordinates = {name: Labelled(*pair, attributes_of.get(name, {})) for name, pair in values.items()}
    coordinates["micro"].encoding = encoding_of(grid.lexicon, {name: array for name, (_, array) in grid.values.items()})
    coordinates["x"] = Labelled(("x",), definition.x, attributes("x"))
    coordinates |= _numbers_of_layers(definition) if definition.layers else {}
    dims = tuple(grid.sizes)
    flats = {name: flat.astype(bool) if name in TRUTHS else flat for name, flat in arrays.items()}
    variables = {
        name: Labelled(dims + definition.dims_of(name), unflatten(grid, flat), _about(definition, name, rigid))
        for name, flat in flats.items()
        if name not in grid.values and not name.endswith(BY_INPUT)
    }
    by_input = {name.removesuffix(BY_INPUT): unflatten(grid, arrays[name]) for name in arrays if BY_INPUT in name}
    laws = law_versions(grid)
    about = provenance(definition, command) | ({"micro_laws": "\n".join(laws)} if laws else {})
    if definition.tables:
        about[TABLES] = json.dumps(dict(definition.tables), ensure_ascii=False)
    if "shape" in grid.values:  # the length that is 1
        about["scale"] = (definition.scene.scale or "R") if definition.scene else "1"
    return DatasetParts(variables, coordinates, about, by_input)


def _numbers_of_layers(definition: Definition) -> dict[str, Labelled]:
    """The coordinates of layers and interfaces, while `layer` may still be an axis of materials."""
    coords = {}
    for name, (_, numbers, words_of) in numbered(definition.layers, "layer", "interface").items():
        dim = LAYER_NUMBER if name == "layer" else name
        coords[dim] = Labelled((dim,), numbers, words_of)
    return coords


def _about(definition: Definition, name: str, rigid: bool) -> dict:
    """The attributes of a dimensionless result."""
    about = attributes(name, rigid)
    return about | {"long_name": words(name, definition.layers > 0)} if name in definition.stresses else about


def with_numbered_layers(parts: DatasetParts) -> DatasetParts:
    """The parts of a study that stores stresses of stacks: `layer` is the number of a layer, and the material of the
    first layer has a name as those of the others."""
    names = {"layer": FIRST_MATERIAL, LAYER_NUMBER: "layer"}

    def renamed(table: dict[str, Labelled]) -> dict[str, Labelled]:
        return {
            names.get(name, name): Labelled(tuple(names.get(dim, dim) for dim in v.dims), v.data, v.attrs, v.encoding)
            for name, v in table.items()
        }

    return parts._replace(variables=renamed(parts.variables), coords=renamed(parts.coords))


def are_numbers(layer: xr.DataArray | Labelled) -> bool:
    """Whether a coordinate `layer` has numbers of layers, and not materials."""
    return layer.dtype.kind in "iu"


def material_name(dataset: xr.Dataset | OneCase, body: str) -> str:
    """The name of the coordinate that has the materials of a body; that of the first layer has another one where
    `layer` is the number of a layer."""
    return FIRST_MATERIAL if body == "layer" and body in dataset and are_numbers(dataset[body]) else body


def without_numbered_layers(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset without what it has over layers and interfaces of stacks: `layer` is the material of the first."""
    if "layer" not in dataset.coords or not are_numbers(dataset["layer"]):
        return dataset
    over = [name for name, variable in dataset.variables.items() if {"layer", "interface"} & {*variable.dims}]
    there = dataset.drop_vars([*over, *{"layer", "interface"} & {*dataset.coords} - {*over}])
    return there.rename({FIRST_MATERIAL: "layer"}) if FIRST_MATERIAL in there.coords else there


def without_fill_values(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset itself. From now on its coordinates are written without _FillValue, which CF forbids for them."""
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


def asperities_attributes() -> dict:
    """CF flags of `asperities_used`."""
    return {"flag_values": np.arange(len(USED), dtype=np.int8), "flag_meanings": " ".join(USED)}


#: Flag that a dataset may have -> function that makes its attributes.
_FLAGS = {
    "status": status_attributes,
    "model_used": model_attributes,
    "validity": validity_attributes,
    "asperities_used": asperities_attributes,
}


def decode(flags: xr.DataArray) -> xr.DataArray:
    """The names of `status`, `model_used`, `validity` or `asperities_used`.

    If a case violates several assumptions, blanks separate them; if it violates none, the text is empty. A number
    without a name stays a number. `where`, `reindex` and `concat` of xarray leave NaN where there is no case: there
    status and validity are "not_run", and the model is "none".

    Parameters
    ----------
    flags : one of these arrays of a dataset of contacts

    Returns
    -------
    xarray.DataArray : texts, over the same dimensions

    Raises
    ------
    ValueError : it is no array; or it has neither one of these names nor the attribute `flag_meanings`; or its numbers
        belong to no case, like a mean over several

    Examples
    --------
    >>> import study
    >>> found = study.solve(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> study.decode(found.model_used).values.tolist()
    ['smooth_half_space', 'smooth_half_space']
    """
    if not hasattr(flags, "attrs") or not hasattr(flags, "dims") or hasattr(flags, "data_vars"):
        flagged = getattr(flags, "data_vars", {})
        names = [name for name in flagged if name in _FLAGS or "flag_meanings" in flagged[name].attrs]
        which = f"take one of its arrays {', '.join(map(str, names))}" if names else "take an array, contacts.status"
        raise ValueError(f"a {type(flags).__name__} is none of {', '.join(_FLAGS)}: {which}")
    return xr.DataArray(flag_words(flags), flags.coords, flags.dims, flags.name)


def flag_words(flags: xr.DataArray | Labelled) -> np.ndarray:
    """The words of flags, as :func:`decode` gives them, as an array of the same shape."""
    attributes = flags.attrs
    if "flag_meanings" not in attributes:  # arithmetic of xarray loses attributes
        name = getattr(flags, "name", f"a {type(flags).__name__}")
        if name not in _FLAGS:
            raise ValueError(f"{name or 'the array'} is none of {', '.join(_FLAGS)}")
        attributes = _FLAGS[name]()
    words, values = attributes["flag_meanings"].split(), whole(flags.values, attributes)
    if "flag_masks" in attributes:
        masks = np.atleast_1d(attributes["flag_masks"]).tolist()
        present = np.unique(values).tolist()
        names = {v: " ".join(w for m, w in zip(masks, words, strict=True) if v & m) for v in present}
    else:
        names = dict(zip(np.atleast_1d(attributes["flag_values"]).tolist(), words, strict=True))
    texts = [names.get(value, str(value)) for value in values.ravel().tolist()]
    meanings = np.array(texts, dtype=str).reshape(flags.shape)
    if "flag_masks" in attributes and flags.dtype.kind == "f":  # NaN must not be read as the mask 0: a good case
        meanings = np.where(np.isfinite(flags.values), meanings, status_words()[NOT_RUN])
    return meanings
