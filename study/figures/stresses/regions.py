"""The stresses that the picture of one contact shows: in a section of layer and body, and along two lines."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from solver.bases import is_bare
from solver.layers import full_name, numbers_of

from ...data.body_strengths import strengths
from ...data.contacts import Contacts
from ...data.dataset import decode
from ...fields import friction, stress_extremes, stress_fields
from ...in_words.stated_inputs import is_rigid
from ...inputs.definition import StudyError

_NEAR = np.linspace(0, 0.4, 17) ** 2 / 0.4
#: Radii of the picture in a. They include 1, where the pressure ends, and are closer to each other there.
_RADII = np.unique(np.concatenate([np.linspace(0, 2, 51), 1 - _NEAR, 1 + _NEAR]).round(12))
_LAYER, _BODY = 41, 49  # number of depths in each
_JUST_BELOW = 1e-9  # distance below an interface between layers, over its depth
_AT_INTERFACE = "trz_above", "sz_above", "sr_above", "sr_below"
DEPTH = 1.6  # of the body, in a: the largest stress of a half-space, at 0.48, is in the upper third
THICKEST = 3.0  # thickest layer that is shown completely, in a; below a thicker one, interface and body are not shown,
_BENT = 0.3  # unless it bends: the tension at its lower side exceeds this share of its largest stress


class Region(NamedTuple):
    """Layer or body in the section.

    r, z : in a
    mises : von Mises stress, (z, r)
    """

    r: np.ndarray
    z: np.ndarray
    mises: np.ndarray


class Stresses(NamedTuple):
    """The stresses of a picture, in Pa or in units of the solver.

    layer, body : None without a layer, and for a body that is rigid or not shown
    surface, interface : name -> values along r; the interface is {} without a layer, or under a thick one
    largest : from `study.extremes`
    Y : yield strength of "layer" and "body", from the call or the named material; NaN where it is not known
    h : thickness in a; None without a layer
    edge : radius of the contact, or of a spot, in a
    inner : depths in a of the interfaces between the layers of a stack
    number : of the interface of a stack that is shown; 0: there is only one
    """

    layer: Region | None
    body: Region | None
    surface: dict[str, np.ndarray]
    interface: dict[str, np.ndarray]
    r: np.ndarray
    largest: xr.Dataset | dict[str, float]
    Y: dict[str, float]
    h: float | None
    edge: float = 1.0
    inner: tuple[float, ...] = ()
    number: int = 0


def of_one_contact(contact: xr.Dataset, mu: float, sigma_res: float | str) -> tuple[xr.Dataset, Stresses]:
    """The contact without dimensions, and its stresses. Raises StudyError for several contacts, or an unsolved one."""
    contact = one_contact(contact)
    contacts = Contacts.of(contact, "plot_stresses")
    contacts.refuse_without_stresses("plot_stresses")
    ends, number = _ends(contacts), 0
    mu = friction(mu)
    largest = stress_extremes(contacts, mu, sigma_res)
    if len(ends) > 1:
        largest, number = _of_several_layers(largest)
    bare, rigid = is_bare(str(contact["base"].values)), is_rigid(contact, "base")
    h = None if bare else ends[-1]
    r = np.concatenate([-_RADII[:0:-1], _RADII]) if mu > 0 else _RADII
    whole = h is not None and (h <= THICKEST or bool(largest["sr_interface1"] > _BENT * largest["mises1"]))
    within = np.linspace(0, h if whole else THICKEST, _LAYER) if h else np.zeros(0)
    inner = tuple(end for end in ends[:-1] if end < (h if whole else THICKEST))
    within = np.unique([*within, *inner, *(end * (1 + _JUST_BELOW) for end in inner)])
    below = (h or 0.0) + np.linspace(0, DEPTH, _BODY) if not h or whole and not rigid else np.zeros(0)
    inside = within[:-1] if whole else within  # stresses at the interface are read from each side
    fields = stress_fields(contacts, r, np.concatenate([inside, below[1:] if h else below]), mu, sigma_res)
    if len(ends) > 1:
        deepest, fields = fields.isel(interface=-1), fields.sel(interface=number)
        fields = fields.assign({name: deepest[name] for name in ("mises_above", "mises_below")})
    elif "interface" in fields.dims:
        fields = fields.isel(interface=0)
    mises = fields["mises"].values.T
    mises = np.where(np.isfinite(mises), mises, mises[np.isfinite(mises)].max())  # it is infinite at a sharp tip
    above, under = (fields[f"mises_{side}"].values[None] for side in ("above", "below"))
    layer = np.concatenate([mises[: len(inside)], *([above] if whole else [])])
    body = np.concatenate([*([under] if h else []), mises[len(inside) :]])
    surface = {name: fields[name].values[:, 0] for name in ("sr", "st")} | {"p": -fields["sz"].values[:, 0]}
    names = [name for name in _AT_INTERFACE if whole and np.isfinite(fields[name]).any()]  # none in a rigid body
    interface = {name: fields[name].values for name in names}
    return contact, Stresses(
        Region(r, within, layer) if h else None,
        Region(r, below, body) if len(below) else None,
        *(surface, interface, r, largest, yield_strengths(contacts), h, 1.0, inner, number),
    )


def _ends(contacts: Contacts) -> list[float]:
    """Depths of the interfaces of one contact in a; meaningless for a bare body."""
    numbers = range(1, max(1, numbers_of(contacts.problem.parameters)) + 1)
    a = float(contacts.dataset["a"]) / contacts.units[1].item()
    return (np.cumsum([getattr(contacts.problem, full_name(number, "h"))[0] for number in numbers]) / a).tolist()


def _of_several_layers(largest: xr.Dataset) -> tuple[dict[str, float], int]:
    """The extremes of a stack under the names of a single layer, and the number of the chosen interface.

    They come from the layer with the largest stress, and from the interface with the largest shear.
    """
    layer, interface = (int(np.nanargmax(largest[name].values)) for name in ("mises_layer", "tau_interface"))
    layers, interfaces = largest.isel(layer=layer), largest.isel(interface=interface)
    names = {"mises1": "mises_layer", "sr_interface1": "sr_interface"}
    extremes_of_layer = {}
    for name in ("mises1", "mises2", "s1_surface", "sr_interface1", "tau_interface"):
        source = layers if name == "mises1" else interfaces
        for end in ("", "_r", "_z"):
            extremes_of_layer[f"{name}{end}"] = float(source[f"{names.get(name, name)}{end}"])
    return extremes_of_layer, interface + 1


def yield_strengths(contacts: Contacts) -> dict[str, float]:
    """Yield strengths of layer and body of one contact, in Pa or in units of the solver; NaN: not known."""
    (unit,), strengths_of_bodies = contacts.units[0].tolist(), strengths(contacts, {})
    if numbers_of(contacts.problem.parameters) > 1:  # each layer has another
        strengths_of_bodies["layer"] = np.full(1, np.nan)
    return {body: strengths_of_bodies[body].item() * unit for body in ("layer", "body")}


def one_contact(contact: xr.Dataset) -> xr.Dataset:
    """A contact without dimensions. Raises StudyError for several, and for one that has no solution."""
    if not isinstance(contact, xr.Dataset) or "status" not in contact:
        raise StudyError(["plot_stresses takes a dataset of study.solve or of a results file, with its status"])
    several = {dim: contact.sizes[dim] for dim in contact["status"].dims if contact.sizes[dim] != 1}
    if several:
        sizes = ", ".join(f"{dim} ({size})" for dim, size in several.items())
        way_out = ", ".join(f"{dim}=0" for dim in several)
        raise StudyError([f"plot_stresses draws one contact, not those of {sizes}: choose one, as .isel({way_out})"])
    contact = contact.squeeze([*contact["status"].dims])
    if int(contact["status"]) != 0:
        raise StudyError([f"plot_stresses: the contact has no solution: {decode(contact['status']).item()}"])
    return contact
