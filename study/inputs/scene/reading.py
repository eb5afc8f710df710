"""From the parameters of `study.solve`, with units, to a scene and its dimensionless parameters.

The scene has the radius R of the punch (or R1 and R2 of two bodies), Young's moduli E1 of the layer, E2 of the body
below and E_punch of the punch, with Poisson ratios nu1, nu2 and nu_punch.
"""

from typing import Any

import numpy as np
import xarray as xr

from ...specimen.foreign import plain
from ...specimen.quantities import READABLE, Quantity, has_unit, quantity
from ...terminal import on_one_line, shown
from ..definition import StudyError
from ..given import label_slips
from ..grid import MOVED, equal_values, same_labels
from ..laws import is_parameter
from ..vocabulary import PARAMETERS, ROWS, SCENE, VOCABULARY, no_parameter
from .bodies import BODIES, assumed, with_materials
from .bounds import beyond_bounds
from .checks import equal_cases, impossible, missing, moving_tables
from .names import NEEDS_NAMES, CaseValues, QuantityList, dim_of, si
from .pieces import move, none_alike
from .scales import make_dimensionless
from .scene import STEP, Scene

_POSITIVE, _POISSON = (0.0, np.inf, "must be > 0"), (-1.0, 0.5, "must be in (-1, 0.5]")
#: Bounds of inputs from which others are derived: must be above, must be at most, words for a message.
_LIMITS = dict.fromkeys(("R", "E1", "E2", "E_punch"), _POSITIVE) | dict.fromkeys(("nu1", "nu2", "nu_punch"), _POISSON)
_E1, _NU1 = ("E1", "E1_spread", "n"), ("nu1", "nu1_spread")
#: Attributes `units` of pure numbers; pint writes the last.
_PURE = ("1", "", "dimensionless")
#: What a case without a layer may leave out -> the coordinates that then have no value there, "" or NaN.
_OF_LAYER = {"layer": ("layer", *_E1, *_NU1), "E1": _E1, "n": _E1, "h": ("h", "h_spread"), "nu1": _NU1, "bonding": ()}


def _has_unit(given: Any) -> bool:
    """Whether a parameter, or one of its values, has a unit or a spread."""
    if isinstance(given, xr.DataArray):
        return given.attrs.get("units", "1") not in _PURE
    if isinstance(given, QuantityList):
        return True
    return any(map(has_unit, given)) if isinstance(given, (list, tuple)) else has_unit(given)


def read(
    parameters: dict, cases: list | None = None, spreads: bool = True, bounds: bool = True, same_piece: bool = False
) -> Scene | None:
    """The physical scene that the parameters of `study.solve` describe; None if they are dimensionless.

    cases : rows of parameters, which become values over the dimension `case`
    spreads : whether the results shall have spreads, for which inputs with spreads are moved
    bounds : whether numbers beyond the bounds of the solver are refused
    same_piece : whether bodies of one material are one piece, so that their inputs with spreads are moved together

    Raises StudyError with a message for each number that cannot be used: no unit, a unit of something else, an unknown
    name, a missing R or modulus.
    """
    rows = cases if isinstance(cases, list) and all(isinstance(row, dict) for row in cases) else []
    parameters, *rows = ({name: plain(value) for name, value in table.items()} for table in (parameters, *rows))
    pairs = [pair for table in (parameters, *rows) for pair in table.items()]
    signs = [(name, one) for name, one in pairs if name in SCENE or name in BODIES or _has_unit(one)]
    if not signs:
        if same_piece:
            raise StudyError([f"same_piece: {NEEDS_NAMES}"])
        return None
    scene, errors = Scene(same_piece=same_piece), []
    parameters = _with_rows(parameters, rows, scene, errors)
    parameters, scene.names = with_materials(parameters, errors)
    parameters = _alike(parameters, scene.names, errors)
    for name, given in parameters.items():
        if name == "label" and isinstance(given, CaseValues):
            scene.labels = given
            errors += label_slips(given)
        elif name == "same_piece":
            errors.append("same_piece is for all cases alike: true or false, no axis and not in cases")
        elif name not in SCENE and not is_parameter(name):
            known = [*PARAMETERS, *SCENE, *BODIES, *["label"] * bool(rows)]
            errors.append(no_parameter(name, known))
        elif name in SCENE or name in _LIMITS or VOCABULARY[name].powers != (0, 0) or _has_unit(given):
            try:
                _add(scene, name, given)
            except ValueError as error:
                errors.append(f"{error}{_material(name, given)}")
        else:
            scene.parameters[name] = xr.DataArray(list(given), dims="case") if isinstance(given, CaseValues) else given
    errors += [f"same_piece: {NEEDS_NAMES}"] * (same_piece and not errors and none_alike(scene.names))
    errors += missing(parameters, {name for name, _ in pairs}, errors)
    errors += [] if errors else impossible(scene) + (equal_cases(scene) if rows else [])
    if errors:
        name, one = min(signs, key=lambda sign: isinstance(sign[1], (list, tuple)))  # a single value rather than a list
        what = f"the unit of {name}" if isinstance(one, xr.DataArray) else f"{name} = {shown(one)}"
        hint = f" ({what} makes this a study with units)"
        raise StudyError([f"{message}{hint * ('has no unit' in message)}" for message in errors])
    scene.assumed = assumed(parameters, scene.given)
    scene.spreads = scene.spreads if spreads else {}
    move(scene)
    make_dimensionless(scene)
    errors = moving_tables(scene) + (beyond_bounds(scene, parameters) if bounds else [])
    if errors:
        raise StudyError(errors)
    return scene


def _material(name: str, given: Any) -> str:
    """The end of a message about a modulus that is given as a word; "" for all else."""
    body = next((body for body, (modulus, _, _) in BODIES.items() if modulus == name), "")
    word = isinstance(given, str) and given[:1].isalpha()
    return f"; a material is given as {body}, in place of {name}" if body and word else ""


def _with_rows(parameters: dict, rows: list[dict], scene: Scene, errors: list[str]) -> dict:
    """The parameters, with those of the rows as CaseValues. These come first, since `case` is the first dimension. What
    a case without a layer leaves out is taken from another case: no answer depends on it, and results do not show it.
    """
    default = VOCABULARY["base"].own.default
    rows = [{"base": default} | row for row in rows] if any("base" in row for row in rows) else rows
    bases = [row.get("base", parameters.get("base")) for row in rows]
    uncoated = [isinstance(base, str) and base == "half_space" for base in bases]
    found = {}
    for name in dict.fromkeys(name for row in rows for name in row):
        if name == "label":  # a case need not have one
            found[name] = CaseValues([row.get(name, "") for row in rows])
        elif name in parameters or not all(
            name in row or (bare and name in _OF_LAYER) for row, bare in zip(rows, uncoated, strict=True)
        ):
            errors.append(f"{name} must be given in every case, or once for all")
        else:
            given = [row[name] for row in rows if name in row]
            found[name] = CaseValues([row.get(name, given[0]) for row in rows])
            if len(given) < len(rows):
                there = xr.DataArray([name in row for row in rows], dims="case")
                scene.given_in |= dict.fromkeys(_OF_LAYER[name], there)
    return found | {name: given for name, given in parameters.items() if name not in found}


def _alike(parameters: dict, bodies: dict, errors: list[str]) -> dict:
    """The parameters, after a check that DataArrays which share a dimension have the same coordinates along it.

    Otherwise the arithmetic of xarray would leave out the cases that one of them does not have, or take those of one in
    the order of the other. Where h is a DataArray over h, the dimension h of all of them becomes `dim_of` it, without
    coordinates: these are the input itself.
    """
    arrays = {name: given for name, given in parameters.items() if isinstance(given, xr.DataArray)}
    along_itself = {name for name, given in arrays.items() if given.dims == (name,)}
    materials = {body: (body, np.array(texts)) for body, (dim, texts) in bodies.items() if dim == body}
    with_units = {name for name in parameters if name in VOCABULARY and ROWS[name].unit != "1"}
    taken = {MOVED, *SCENE, *BODIES, *with_units} - along_itself - set(materials)  # no dimension may have these names
    # Dimension -> the parameter that gave it first, and its coordinate there; then the same with its length.
    labels = {name: (name, arrays[name].values) for name in along_itself if name not in arrays[name].coords}
    labels |= materials
    lists = {name: given for name, given in parameters.items() if type(given) in (list, tuple, range, CaseValues)}
    lengths = {"case" if type(given) is CaseValues else name: (name, len(given)) for name, given in lists.items()}
    lengths |= {body: (body, len(texts)) for body, (_, texts) in materials.items()}
    for name, given in arrays.items():
        hint = ", unless that is a DataArray over itself"
        errors += [
            f'{name}: a dimension cannot be called "{dim}" here{hint * (dim in parameters)}'
            for dim in given.dims
            if dim in taken
        ]
        for dim, length in given.sizes.items():
            other, expected = lengths.setdefault(dim, (name, length))
            if length != expected:
                errors.append(f"{name} has {length} values along {dim}, {other} has {expected}")
            elif dim in given.coords:
                other, known = labels.setdefault(dim, (name, given[dim].values))
                if not same_labels(known, given[dim].values):
                    errors.append(f"{name} has other values of {dim}, or in another order, than {other}")
    own = {dim: dim_of(dim) for dim in along_itself}
    return parameters | {
        name: _bare(given, own).rename({dim: own[dim] for dim in given.dims if dim in own})
        for name, given in arrays.items()
    }


def _bare(given: xr.DataArray, own: dict) -> xr.DataArray:
    """The array without coordinates but those of its dimensions, and without these along the dimensions in `own`, and
    where they are a MultiIndex: arithmetic of xarray need not carry them (see `carried`)."""
    stacked = {dim for dim in given.dims if hasattr(given.indexes.get(dim), "levels")}
    return given.drop_vars({*given.coords} - ({*given.dims} - {*own} - stacked))


def _add(scene: Scene, name: str, given: Any) -> None:
    """Put the SI values and spreads of an input into the scene. Raises ValueError for values that it cannot have."""
    if isinstance(given, xr.DataArray):
        value, spread = _of_array(name, given, ROWS[name].unit), 0.0
    else:
        found = given if isinstance(given, (QuantityList, Quantity)) else _quantities(name, given)
        if isinstance(found, QuantityList):
            value = xr.DataArray([one.value for one in found.quantities], dims=found.dim)
            spread = xr.DataArray([one.spread for one in found.quantities], dims=found.dim)
        else:
            value, spread = found.value, found.spread
    if isinstance(value, xr.DataArray) and value.dims == (dim_of(name),):
        scene.dims[dim_of(name)] = name
        unit = f" {ROWS[name].unit}".removesuffix(" 1")
        for message in equal_values(name, value.values.tolist(), lambda one: f"{one:g}{unit}"):
            raise ValueError(message)
    if name in ("R1", "R2") and not np.all(value != 0):
        raise ValueError(f"{name} = {on_one_line(str(given))}: must not be 0")
    low, high, limits = _LIMITS.get(name, (-np.inf, np.inf, "must be a number"))
    inside = (value > low) & (value <= high)
    if not np.all(inside):
        text = f"{name} = {on_one_line(str(given))}"
        if isinstance(given, xr.DataArray):
            place, unit = np.argwhere(~inside.values)[0].tolist(), given.attrs.get("units", "1")
            text = f"{name}{place} = {given.values[tuple(place)]:g}" + f" {unit}" * (unit != "1")
        raise ValueError(f"{text}: {limits}")
    if not np.all(spread == 0):
        reach = STEP * spread
        if not np.all((value - reach > low) & (value + reach <= high)):
            text = f"with its spread it {limits}; at the limit itself give no spread"
            raise ValueError(f"{name} = {on_one_line(str(given))}: {text}")
        scene.spreads[name] = spread
    scene.given[name] = value


def _quantities(name: str, given: Any) -> QuantityList | Quantity:
    """The quantities in a list, an array or a single value."""
    if not isinstance(given, (list, tuple, range)):
        return si(name, given)
    if not len(given):
        raise ValueError(f"{name} is empty: must have at least one value")
    found = [si(name, one, f"{name}[{i}]") for i, one in enumerate(given)]
    return QuantityList(found, "case" if isinstance(given, CaseValues) else dim_of(name))


def _of_array(name: str, given: xr.DataArray, unit: str) -> xr.DataArray:
    """SI values of a DataArray, by its attribute `units`."""
    if given.dtype.kind not in "iuf":
        raise ValueError(f"{name}: a DataArray must hold numbers; texts with units may be a list")
    given = given.astype(float)  # 210 GPa of float16 would be infinite in Pa
    if unit == "1" and given.attrs.get("units", "1") in _PURE:
        return given.drop_attrs()
    if "units" not in given.attrs:
        raise ValueError(f'{name}: the DataArray has no attribute "units"; {READABLE[unit][0]} needs one')
    return given.drop_attrs() * quantity(name, f"1 {given.attrs['units']}", unit).value
