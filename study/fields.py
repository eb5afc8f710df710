"""Stresses of contacts: at points of layer and body, and their largest values."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from solver import Status, solve
from solver.bases import is_bare
from solver.fields.contact import of_contacts as fields_of
from solver.fields.invariants import invariants
from solver.fields.sliding import in_plane
from solver.fields.waves import farthest
from solver.layers import full_name, numbers_of
from solver.yields.below.central_spot import of_contacts as below_spots
from solver.yields.contact import of_contacts as extremes_of
from solver.yields.stacked.mixture import of_mixture

from .data.contacts import Contacts
from .data.dataset import are_numbers
from .inputs.definition import StudyError
from .inputs.punch import stresses as largest
from .inputs.vocabulary import FIRST_MATERIAL, VOCABULARY
from .solving import solve as solve_inputs
from .specimen.foreign import plain
from .specimen.quantities import quantity
from .terminal import shown

SIGNS = "tension is positive; z points down from the surface"
#: Default radii and depths, in a. They include r = 1, where p ends.
_RADII, _DEPTHS = np.linspace(0, 2, 41), np.linspace(0, 2, 41)
#: Larger coefficients of friction, or residual stresses over E2*, must be typing errors.
_MOST_FRICTION, _MOST_RESIDUAL = 1e3, 1e6
_LONG_NAMES = {
    "sr": "radial stress",
    "st": "circumferential stress",
    "sz": "axial stress",
    "trz": "shear stress",
    "ur": "radial displacement",
    "uz": "axial displacement",
    "s1": "largest principal stress",
    "s2": "middle principal stress",
    "s3": "smallest principal stress",
    "mises": "von Mises stress",
    "tresca": "Tresca stress, s1 - s3",
}


def stresses(
    contact: xr.Dataset | None = None,
    r: ArrayLike | None = None,
    z: ArrayLike | None = None,
    mu: float = 0.0,
    sigma_res: float | str = 0.0,
    **parameters: Any,
) -> xr.Dataset:
    """Stresses and displacements in layer and body of solved contacts: docs/stresses.md.

    z points down from the surface; tension is positive. The contacts are solved again from the inputs in the dataset. A
    thin layer has the field of the exact layer under the same pressure.

    Parameters
    ----------
    contact : results of `study.solve` or of a results file, in SI units or dimensionless, or a part of them
    r, z : radii and depths >= 0 in units of a, one-dimensional; if mu > 0, r may be negative: behind the contact. The
        largest radius is 27,000 h, or 5.6 a if that is more; without a layer 1e9 a
    mu : coefficient of friction >= 0; if mu > 0 the punch slides everywhere, and the results belong to the plane y = 0:
        r is x, trz is sxz, ur is ux
    sigma_res : residual biaxial stress of the layer, tension positive; "-2 GPa" if the contact has units. Stacks take
        one value for all layers or a list with one for each
    parameters : the parameters of `study.solve`, in place of the contact

    Returns
    -------
    xarray.Dataset : over the dimensions of the contact, `r` and `z`: sr, st, sz, trz, ur, uz, the principal stresses
        s1, s2, s3, mises, tresca; NAME_above and NAME_below at the interface, in the layer and in the body; for stacks
        these have the dimension `interface`, 1 below the first layer. `stress_error` is the error of any stress,
        relative to the largest. NaN for cases that have not converged, in a rigid body, and at an interface that does
        not exist. Stresses are infinite at the edge of a flat punch and of surfaces that stick

    Raises
    ------
    StudyError : an argument is out of bounds or not finite, or the dataset cannot be solved again

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, micro="smooth", base="half_space")
    >>> round(study.stresses(contact, r=[0.0], z=[0.0]).sz.item() / contact.p0.item(), 9)
    -1.0
    """
    mu = friction(mu)
    contact = contact_of("stresses", contact, parameters)
    r = _axis("r", _mirrored(_RADII) if r is None and mu > 0 else _RADII if r is None else r, mu > 0)
    z = _axis("z", _DEPTHS if z is None else z, False)
    contacts = Contacts.of(contact, "stresses")
    contacts.refuse_without_stresses("stresses", largest=False)
    return stress_fields(contacts, r, z, mu, sigma_res)


def stress_fields(contacts: Contacts, r: np.ndarray, z: np.ndarray, mu: float, sigma_res: Any) -> xr.Dataset:
    """What :func:`stresses` returns, of contacts that have stresses, at radii and depths (R,), (Z,) in a."""
    unit, size = contacts.units
    solution = _solved(contacts)
    _refuse_far_away(r, contacts, solution)
    fields = fields_of(contacts.problem, solution, np.abs(r), z, mu)
    residual, bare = residual_stresses(sigma_res, contacts), is_bare(contacts.problem.base)
    residual = np.where(bare[:, None], 0.0, np.pad(residual, ((0, 0), (0, 1))))  # the last one belongs to the body
    layer = np.sum(
        z[:, None] > (_ends(contacts) / solution.a[:, None])[:, None], axis=2
    )  # number of the layer with the depth z, from 0
    at_places = np.take_along_axis(residual, layer, axis=1), residual[:, :-1], residual[:, 1:]
    compressible, variables = np.where(bare, contacts.problem.nu2, contacts.problem.nu1) < 0.5, {}
    stacked = numbers_of(contacts.problem.parameters) > 0
    at_interface = ("r", "interface") if stacked else ("r",)
    places = ("", "r", "z"), ("_above", *at_interface), ("_below", *at_interface)
    for (end, *axes), field, added in zip(places, fields[:3], at_places, strict=True):
        field = in_plane(field, r < 0) if mu > 0 else field
        for name in ("sr", "st"):
            field[name] = field[name] + added[..., None]
        field = {name: values if len(axes) > 1 else values[:, 0] for name, values in field.items()}
        field |= invariants(*(field[name] for name in ("sr", "st", "sz", "trz")))._asdict()
        tips = np.isinf(field["sz"]) & np.expand_dims(compressible, tuple(range(1, field["sz"].ndim)))
        for name in ("mises", "tresca"):  # a difference of infinite stresses
            field[name] = np.where(tips, np.inf, field[name])
        for name, long_name in _LONG_NAMES.items():
            length = name.startswith("u")
            values = field[name] * ((size if length else 1) * (1 if length else unit))[(...,) + (None,) * len(axes)]
            about = _about(contacts, long_name + _WHERE[end], "m" if length else "Pa")
            axes = ("interface", "r") if "interface" in axes else axes
            values = values if "interface" in axes else values.swapaxes(1, -1)
            variables[f"{name}{end}"] = _labelled(contacts, values, axes, about)
    about = {"long_name": "error of any stress, relative to the largest"}
    variables["stress_error"] = _labelled(contacts, fields.error, (), about)
    coords = {"r": ("r", r, {"long_name": "radius over a" if mu == 0 else "x over a, negative behind the contact"})}
    coords["z"] = ("z", z, {"long_name": "depth over a"})
    coords |= numbered(contacts, "interface") if stacked else {}
    if contacts.scene:
        lengths = (solution.a * size)[:, None]
        for name, axis in (("r", r), ("z", z)):
            about = {"long_name": "radius" if name == "r" else "depth", "units": "m"}
            coords[f"{name}_length"] = _labelled(contacts, lengths * axis, (name,), about)
    return with_coordinates_of(contacts.dataset, variables).assign_coords(coords)


def _ends(contacts: Contacts) -> np.ndarray:
    """Depths of the interfaces (B, N) in the unit of the solver."""
    numbers = range(1, max(1, numbers_of(contacts.problem.parameters)) + 1)
    return np.cumsum([getattr(contacts.problem, full_name(number, "h")) for number in numbers], axis=0).T


def with_numbered_layers(contacts: Contacts) -> Contacts:
    """The contacts with the material of the first layer of a stack named like those of the other layers. `layer` is
    then free to be the number of a layer."""
    there = contacts.dataset.coords
    named = "layer" in (*there, *contacts.dims) and not ("layer" in there and are_numbers(there["layer"]))
    names = {"layer": FIRST_MATERIAL} if named else {}
    dims = tuple(names.get(dim, dim) for dim in contacts.dims)
    return contacts._replace(dataset=contacts.dataset.rename(names), dims=dims)


def numbered(contacts: Contacts, *dims: str) -> dict:
    """Coordinates of the layers and interfaces of stacks: numbers from 1 at the surface."""
    return largest.numbered(numbers_of(contacts.problem.parameters), *dims)


def _refuse_far_away(r: np.ndarray, contacts: Contacts, solution: Any) -> None:
    """Raise StudyError for radii whose fields would take minutes."""
    bare = is_bare(contacts.problem.base)
    largest = np.nanmin(farthest(np.where(bare, np.inf, contacts.problem.h / solution.a)), initial=np.inf)
    if (far := np.abs(r).max()) > largest:
        why = "" if bare.all() else ": farther away the field of the layer takes minutes"
        raise StudyError([f"r = {far:g}: must be at most {largest:.3g} in units of a{why}"])


_WHERE = {"": "", "_above": ", in the layer at the interface", "_below": ", in the body at the interface"}


def extremes(
    contact: xr.Dataset | None = None, mu: float = 0.0, sigma_res: float | str = 0.0, **parameters: Any
) -> xr.Dataset:
    """The largest stresses of contacts, and their places: docs/stresses.md.

    z points down from the surface; tension is positive; 1 is the layer, 2 the body under it. Without a layer the body
    is 2. The contacts are solved again from the inputs in the dataset.

    Parameters
    ----------
    contact : results of `study.solve` or of a results file, in SI units or dimensionless, or a part of them
    mu : coefficient of friction >= 0; if mu > 0 the punch slides everywhere, and the extremes are those in the plane
        y = 0
    sigma_res : residual biaxial stress of the layer, tension positive; "-2 GPa" if the contact has units. Stacks take
        one value for all layers or a list with one for each
    parameters : the parameters of `study.solve`, in place of the contact

    Returns
    -------
    xarray.Dataset : over the dimensions of the contact: mises1, mises2, tresca1, tresca2, s1_surface, s1_layer,
        sr_interface1 (which cracks a layer that bends), tau_interface, sz_interface_max, sz_interface_min; each with
        its place NAME_r and NAME_z in units of a. If mu > 0, NAME_r is x, < 0 behind the contact. If a contact has no
        tension or shear, the value is 0 and its place NaN. NaN for cases that have not converged, and for bodies that
        are rigid or do not exist.

        If asperities feel the layer: also mises1_spot, mises2_spot and sr_interface1_spot below the middle of the
        central spot, sz_interface_spot_max and tau_interface_spot up to half of the pitch beside it, each with its
        depth NAME_z; they include the stresses of the nominal pressure.

        Stacks have s1_surface, mises2 and tresca2; mises_layer, tresca_layer and s1_layer over `layer`; and
        sr_interface, tau_interface, sz_interface_max and sz_interface_min over `interface`. Layers and interfaces
        count from 1 at the surface

    Raises
    ------
    StudyError : an argument is out of bounds or not finite, or the dataset cannot be solved again

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, micro="smooth", base="half_space", nu2=0.3)
    >>> round(study.extremes(contact).mises2.item() / contact.p0.item(), 5)
    0.62004
    """
    mu = friction(mu)
    contact = contact_of("extremes", contact, parameters)
    contacts = Contacts.of(contact, "extremes")
    contacts.refuse_without_stresses("extremes")
    return stress_extremes(contacts, mu, sigma_res)


def stress_extremes(contacts: Contacts, mu: float, sigma_res: Any) -> xr.Dataset:
    """What :func:`extremes` returns, of contacts that have largest stresses."""
    unit, _ = contacts.units
    residual = residual_stresses(sigma_res, contacts)
    solution = _solved(contacts)
    stacked, variables = numbers_of(contacts.problem.parameters) > 0, {}
    if stacked:
        values = of_mixture(contacts.problem, solution, mu, residual)
        contacts = with_numbered_layers(contacts)
    else:
        values = extremes_of(contacts.problem, solution, mu, residual[:, 0])
    for name, (value, r, z) in values.items():
        axes = (largest.dimension(name),) if stacked and largest.dimension(name) else ()
        long_name = largest.words(name, stacked)
        place = {"long_name": f"{long_name}: its {'radius' if mu == 0 else 'x, behind the contact < 0,'} over a"}
        value = value * unit.reshape(-1, *[1] * len(axes))
        variables[name] = _labelled(contacts, value, axes, _about(contacts, long_name, "Pa"))
        variables[f"{name}_r"] = _labelled(contacts, r, axes, place)
        variables[f"{name}_z"] = _labelled(contacts, z, axes, {"long_name": f"{long_name}: its depth over a"})
    if contacts.problem.feels_layer().any():
        for name, (value, z) in below_spots(contacts.problem, solution, mu, residual[:, 0]).items():
            long_name = VOCABULARY[name].long_name
            variables[name] = _labelled(contacts, value * unit, (), _about(contacts, long_name, "Pa"))
            variables[f"{name}_z"] = _labelled(contacts, z, (), {"long_name": f"{long_name}: its depth over a"})
    variables = with_coordinates_of(contacts.dataset, variables)
    return variables.assign_coords(numbered(contacts, "layer", "interface") if stacked else {})


def _solved(contacts: Contacts) -> Any:
    """The solution of the cases. A case that is not converged in the dataset counts as invalid."""
    solution = solve(contacts.problem)
    converged = contacts.dataset["status"].values.ravel() == Status.CONVERGED
    return replace(solution, status=np.where(converged, solution.status, Status.INVALID_INPUT))


def contact_of(who: str, contact: Any, parameters: dict[str, Any]) -> xr.Dataset:
    """The contact, or the solution of the parameters of `study.solve`. Raises StudyError for both and for neither.

    who : the name of the public function, for messages
    """
    refuse_both(who, contact, parameters)
    if contact is not None:
        return contact
    try:
        return solve_inputs(**{"profiles": False} | parameters)
    except StudyError as error:
        raise StudyError(re.sub("^solve: ", f"{who}: ", message) for message in error.messages) from None


def refuse_both(who: str, contact: Any, parameters: dict[str, Any]) -> None:
    """Raise StudyError if a call has both a contact and inputs, or neither."""
    if contact is not None and parameters:
        raise StudyError([f"{who}: {next(iter(parameters))}: give a contact or its inputs, not both"])
    if contact is None and not parameters:
        raise StudyError([f"{who}: give a contact, which is a dataset of study.solve, or its inputs"])


def friction(mu: Any) -> float:
    """The coefficient of friction as a number. Raises StudyError."""
    mu = plain(mu.item() if np.ndim(mu) == 0 and hasattr(mu, "item") else mu)
    if type(mu) not in (int, float) or not (np.isfinite(mu) and mu >= 0):
        raise StudyError([f"mu = {shown(mu)}: must be a finite number, at least 0"])
    if mu > _MOST_FRICTION:
        raise StudyError([f"mu = {shown(mu)}: must be at most {_MOST_FRICTION:g}"])
    return float(mu)


def _mirrored(r: np.ndarray) -> np.ndarray:
    return np.concatenate([-r[:0:-1], r])


def _axis(name: str, values: Any, signed: bool) -> np.ndarray:
    try:
        if np.asarray(values).dtype == bool:
            raise TypeError("True is not a number")
        values = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError):
        raise StudyError([f"{name} = {shown(values)}: must be numbers, in units of a"]) from None
    bad = values[~np.isfinite(values) | ((values < 0) & (not signed))]
    if values.ndim != 1 or not values.size or bad.size:
        wrong = f"{name} = {bad[0]:g}" if bad.size else f"{name} of shape {values.shape}"
        bound = "" if signed else ", and at least 0" + (" where mu is 0" if name == "r" else "")
        raise StudyError([f"{wrong}: must be one-dimensional, with finite numbers in units of a{bound}"])
    return values


def residual_stresses(sigma_res: Any, contacts: Contacts) -> np.ndarray:
    """The residual stress (B, N) of each layer in the unit of the solver, N = 1 without a stack. Raises StudyError.

    sigma_res : of all layers, or a list of one for each layer of a stack
    """
    layers, (unit, _) = numbers_of(contacts.problem.parameters), contacts.units
    if not isinstance(sigma_res, (list, tuple)) and not np.ndim(sigma_res):
        return np.repeat((residual_stress(sigma_res, contacts) / unit)[:, None], max(1, layers), axis=1)
    if len(sigma_res) != layers:
        many = f"one for each of the {layers} layers" if layers else "one number"
        raise StudyError([f"sigma_res = {shown(sigma_res)}: must be {many}"])
    return np.stack([residual_stress(value, contacts) / unit for value in sigma_res], axis=1)


def residual_stress(sigma_res: Any, contacts: Contacts) -> float:
    """The residual stress in Pa, or without a unit if the contact has none. Raises StudyError."""
    single = not contacts.scene and np.ndim(sigma_res) == 0 and hasattr(sigma_res, "item")
    sigma_res = plain(sigma_res.item() if single else sigma_res)
    number = type(sigma_res) in (int, float)
    try:
        if contacts.scene and not (number and sigma_res == 0):
            value = quantity("sigma_res", sigma_res, "Pa").value
        elif sigma_res is None or isinstance(sigma_res, bool):
            raise ValueError(f"sigma_res = {shown(sigma_res)}: must be a finite number")
        elif not number:
            raise ValueError(f"sigma_res = {shown(sigma_res)}: the contact has no units: must be a number, over E2*")
        else:
            value = float(sigma_res)
    except (OverflowError, ValueError) as error:
        raise StudyError([str(error)]) from None
    if not np.isfinite(value):
        raise StudyError([f"sigma_res = {shown(sigma_res)}: must be finite"])
    unit, _ = contacts.units
    if np.any(np.abs(value) > _MOST_RESIDUAL * unit):
        most = f"{_MOST_RESIDUAL:g} times E2*, or E1* on a rigid base"
        raise StudyError([f"sigma_res = {shown(sigma_res)}: must be at most {most}"])
    return value


def _about(contacts: Contacts, long_name: str, unit: str) -> dict[str, str]:
    scale = {"Pa": "E2*, E1* on a rigid body", "m": "R"}[unit]
    return {"long_name": long_name, "comment": SIGNS} | ({"units": unit} if contacts.scene else {"scale": scale})


def _labelled(contacts: Contacts, values: np.ndarray, axes: Any, about: dict[str, str]) -> xr.Variable:
    return xr.Variable((*contacts.dims, *axes), values.reshape((*contacts.shape, *values.shape[1:])), about)


def with_coordinates_of(contact: xr.Dataset, variables: dict[str, xr.Variable]) -> xr.Dataset:
    """A dataset of these variables with the coordinates of the contact except `x`."""
    dims = {*contact["status"].dims}
    left_out = [
        name for name, variable in contact.variables.items() if name in contact.data_vars or {*variable.dims} - dims
    ]
    return contact.drop_vars(left_out).assign(variables)
