"""The table of rules, the flags `validity` of rules with a mask, and sentences about contacts that violate rules."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from solver.bases import is_bare
from solver.kernels.two_layers import layer_modulus
from solver.known import Known
from solver.parameters import one_of
from solver.problem import can_feel

from ..arrays import xarray_later as xr
from ..arrays.labelled import Labelled, along
from ..inputs.lexicon import lexicon_in
from ..inputs.vocabulary import ROWS, attributes


class Rule(NamedTuple):
    """A row of the table: a condition with the decorator `rule`.

    A condition with a mask is a function (v, times) of `numbers`. It returns bool over the cases: whether a case
    exceeds `times` the limit of the rule. A condition without a mask is a function of the variables of a dataset, any
    of which may be missing. It returns sentences.
    """

    condition: Callable
    mask: int  # in `validity`; 0: none
    text: str  # in a figure, in mathtext
    grey: str  # of the rule's band in a figure
    size: Callable | None  # size(variables, where the rule is violated) -> a sentence on the size of the error
    sentence: str  # for cases that violate the rule: the docstring, in which {NAME} is a constant of the module


RULES: dict[str, Rule] = {}
"""The table: name -> rule. The sentences about a contact follow this order."""
ASSUMPTIONS: dict[int, str] = {}
"""Mask -> name of its rule."""

WORDS: dict[str, Callable] = {}
"""Attribute of `validity` -> a function of the `numbers` of a dataset -> its text, "" for none."""


def rule(mask=0, text="", grey="0.85", *, size=None) -> Callable:
    """Decorator of a condition: adds a `Rule` to the table. Raises ValueError for a mask or name that is in use."""

    def register(condition: Callable) -> Callable:
        name, words = condition.__name__, " ".join((condition.__doc__ or "").split())
        if name in RULES or mask in ASSUMPTIONS or mask < 0 or mask & (mask - 1):
            raise ValueError(f"{name}, {mask}: a rule needs a name, and a power of 2 or 0, that no other rule has")
        sentence = words.format(**condition.__globals__) if mask else ""
        RULES[name] = Rule(condition, mask, text or name.replace("_", " "), grey, size, sentence)
        ASSUMPTIONS.update({mask: name} if mask else {})
        return condition

    return register


def sentences(v: Mapping) -> list[str]:
    """The sentences of all rules about contacts: first by the flags in the dataset, then by the rules without a mask.

    v : the variables of a dataset; before contacts are solved, it has only their inputs
    """
    lines = []
    for name, where in (broken(v["validity"]) if "validity" in v else {}).items():
        row = RULES.get(name)  # results may come from a program that had more rules
        if where.any():
            words = row.sentence if row else f"{name}: a rule that is not known here."

            lines.append(of_cases(where) + words + (row.size(v, where) if row and row.size else ""))
    return lines + [text for row in RULES.values() if not row.mask for text in row.condition(v)]


def of_cases(where: np.ndarray) -> str:
    """The beginning of a sentence about several cases, "2 of 5 cases: "."""
    return f"{where.sum()} of {where.size} cases: " if where.size > 1 else ""


def validity(dataset: xr.Dataset) -> xr.DataArray:
    """Assumptions that each case violates, a sum of the masks of ASSUMPTIONS; 0: all hold. docs/model.md explains them.

    A case without numbers (see `status`) gets only the masks that need none. int32 over the dimensions of `status`.

    Raises ValueError for results with units, which already have `validity`: the masks assume R = 1 and E2* = 1.
    """
    if has_units(dataset):
        raise ValueError(
            "validity is computed from results without units; results with units contain it: dataset.validity"
        )
    return xr.DataArray(validity_of(dataset.variables).to_xarray(), dataset["status"].coords, name="validity")


def validity_of(variables: Mapping, times: float = 1.0) -> Labelled:
    """`validity` of the dimensionless variables of a dataset, with R1 and R2, in R, where both radii are known.

    times : an assumption counts as violated from so many times its limit on
    """
    status, v = variables["status"], numbers(variables)
    violated = (np.int32(mask) * RULES[name].condition(v, times) for mask, name in ASSUMPTIONS.items())
    flags = sum(violated, np.zeros(status.shape, np.int32))
    about = attributes("validity") | validity_attributes()
    about |= {name: text for name, word in WORDS.items() if (text := word(v))}
    if "w_adhesion" in variables and not {"z0", "sigma0"} & {*variables}:
        about["comment"] = "not_jkr: not known, since neither z0 nor sigma0 is given"
    return Labelled(status.dims, flags, about)


def numbers(variables: Mapping) -> Mapping:
    """Name -> array over the dimensions of `status`, perhaps of length 1 along some; NaN for a missing name.

    They are arrays, since computing with DataArrays takes as long as solving a contact.

    In addition to the variables it has: "mises_layer 1" and so on (for stacks whose stresses are stored), layered,
    rough, thin (bool: a thin layer was used), on_half_space (bool: asperities press on a half-space, whatever their
    pitch), E1* (reduced modulus of the layer), spots (number of asperities that touch), b (radius of the central spot),
    slope (f'(a) of the shape of the punch), pressure (p(0), or the mean where p(0) is not finite), known (laws and
    shapes for the words of `micro` and `shape`).
    """
    dims, used = variables["status"].dims, variables["model_used"].attrs
    arrays = {name: along(dims, array) for name, array in variables.items() if set(array.dims) <= set(dims)}
    arrays |= _of_layers(dims, variables["mises_layer"]) if "mises_layer" in variables else {}
    known = lexicon_in(variables).known
    v = defaultdict(lambda: np.nan, {"m": 0.0, "known": known} | arrays)
    models = zip(used["flag_values"], used["flag_meanings"].split(), strict=True)
    v["thin"] = one_of(
        v["model_used"], [value for value, word in models if word.endswith(("thin_layer", "thin_stack"))]
    )
    v |= {"slope": slope(v), "pressure": _pressure(v)}
    on_half_space = v.get("asperities_on", "auto") == "half_space"
    v |= {"on_half_space": ~can_feel(v["base"], v["micro"], known.laws) | on_half_space}
    rough = have("rough", v["micro"], known)
    v |= {"layered": ~is_bare(v["base"]), "rough": rough, "E1*": layer_modulus(v["n"])}
    return v | {"spots": spots(v) * _touching(v), "b": spot_radius(v)}


def _of_layers(dims: tuple, stress: Labelled) -> dict[str, Any]:
    """The largest stress of each layer of stacks, "mises_layer 1" and so on; {} without the dimension of layers."""
    behind = [dim for dim in stress.dims if dim not in dims]
    if len(behind) != 1 or len(stress.dims) != len(dims) + 1:
        return {}
    values = stress.transpose(*dims, *behind).data
    return {f"mises_layer {j + 1}": values[..., j] for j in range(values.shape[-1])}


def slope(v):
    """f'(a) of the shapes of the punches; NaN for an unknown shape."""
    if "shape" not in v:
        return v["a"]
    slopes = np.full(np.broadcast(v["a"], v["shape"]).shape, np.nan)
    for kind in v["known"].shapes.values():
        if np.any(v["shape"] == kind.name):
            arrays = np.broadcast_arrays(*(v[name] for name in ("a", *kind.parameters)), slopes)
            a, *numbers = (array.ravel() for array in arrays[:-1])
            shape = kind.of(**dict(zip(kind.parameters, numbers, strict=True)), size=len(a))
            with np.errstate(all="ignore"):  # for cases without numbers
                at_edge = shape.slope(a[:, None])[:, 0].reshape(arrays[0].shape)
            slopes = np.where(v["shape"] == kind.name, at_edge, slopes)
    return slopes


def _pressure(v):
    """p(0), or the mean pressure where p(0) is not finite, as under a sharp tip."""
    with np.errstate(all="ignore"):
        return np.where(np.isfinite(v["p0"]), v["p0"], v["P"] / (np.pi * v["a"] ** 2)) if "shape" in v else v["p0"]


def have(feature: str, micro, known: Known):
    """Whether the law of each case has a feature, such as "rough". An unknown law is assumed to have it."""
    return sum(micro == name for name, law in known.laws.items() if not getattr(law, feature)) == 0


def _touching(values):
    """Share of the summits in the centre that touch: 1 for equal heights."""
    share = np.ones(())
    for law in [law for name, law in values["known"].laws.items() if law.touching and np.any(values["micro"] == name)]:
        touch = law.touching(values["A0"], **{name: values.get(name, np.nan) for name in law.parameters})
        share = np.where(values["micro"] == law.name, touch, share)
    return share


def spots(values):
    return values.get("Nbar", np.nan) * np.pi * values["a"] ** 2


def spot_radius(values):
    return np.sqrt(values["lam0"] / (np.pi * values.get("Nbar", np.nan)))


def validity_attributes() -> dict:
    """CF flags of `validity`."""
    masks = np.array(list(ASSUMPTIONS), dtype=np.int32)
    return {"flag_masks": masks, "flag_meanings": " ".join(ASSUMPTIONS.values())}


def broken(validity: xr.DataArray | xr.Variable | Labelled) -> dict[str, np.ndarray]:
    """Name of each assumption -> whether it is violated, in the shape of the flags; in the order of the masks."""
    attributes = validity.attrs
    masks = zip(np.atleast_1d(attributes["flag_masks"]).tolist(), attributes["flag_meanings"].split(), strict=True)
    values = whole(validity.values, attributes)
    return {name: (values & mask) != 0 for mask, name in masks}


def whole(flags: np.ndarray, attributes: dict) -> np.ndarray:
    """Flags as whole numbers. `where`, `reindex` and `interp` of xarray make them floats, with NaN for absent cases.

    For NaN the status is "not run", and other flags are 0. Raises ValueError for numbers that cannot be flags.
    """
    if flags.dtype.kind in "iu":
        return flags
    if flags.dtype.kind != "f" or (np.isfinite(flags) & (flags % 1 != 0)).any():
        raise ValueError("these flags belong to no case: they have been compared, averaged or interpolated")
    words = attributes["flag_meanings"].split()
    absent = np.atleast_1d(attributes["flag_values"])[words.index("not_run")] if "not_run" in words else 0
    return np.where(np.isfinite(flags), flags, absent).astype(int)


def has_units(dataset: xr.Dataset) -> bool:
    """Whether the numbers are in SI units, even if the dataset has lost the coordinates that say so."""
    rows = lexicon_in(dataset).rows
    return any(variable.attrs.get("units", "1") != "1" for name, variable in dataset.variables.items() if name in rows)


def in_si(v: Mapping, name: str) -> bool:
    """Whether an input exists and is in its SI unit; in a dataset of `study.readable` it has another unit."""
    return name in v and v[name].attrs.get("units") == ROWS[name].unit
