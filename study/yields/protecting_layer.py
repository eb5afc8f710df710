"""The thickness of a layer that protects the body."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from solver.bases import is_bare
from solver.yields.protect import protection

from ..data.body_strengths import strengths
from ..data.contacts import Contacts
from ..fields import friction, refuse_both, with_coordinates_of
from ..inputs.definition import StudyError
from ..terminal import shown
from .first_yield import about_of, labelled
from .yielding_contacts import materials_in, of_dataset, of_inputs, refuse, without_control


def h_protect(
    contact: xr.Dataset | None = None,
    *,
    P: Any = None,
    Y2: Any = None,
    by: str = "h",
    mu: float = 0.0,
    **parameters: Any,
) -> xr.Dataset:
    """The thickness above which a layer protects the body from yielding: docs/stresses.md.

    Under a stiff layer the largest stress of the body first rises with the thickness, and then falls.

    Parameters
    ----------
    contact : contacts of `study.solve` or of a results file on layers, in place of P and the parameters. Their load
        matters, and their h does not
    P : load
    Y2 : yield strength of the body, > 0; by default that of the named material
    by : the thickness to determine: "h", or that of another layer of a stack, "layers.2.h"; the others stay
    mu : >= 0; with mu > 0 the punch slides in full
    parameters : of `study.solve`, except that thickness, a and D

    Returns
    -------
    xarray.Dataset : over the dimensions of the parameters: h_protect, above which the body yields for no larger
        thickness, 0 if it yields for none; h_yields, the least thickness at which the body yields where a bare one, or
        a stack without that layer, would not, NaN if there is none. Where a search has no answer the variable is NaN
        and has a `message`

    Raises
    ------
    StudyError : input that cannot be used; a strength that is not known

    Examples
    --------
    >>> import study
    >>> found = study.h_protect(P=1e-5, Y2=0.005, n=2.0, bonding="bonded", micro="smooth")
    >>> round(found.h_protect.item(), 4)
    0.0238
    """
    mu = friction(mu)
    strength_of_call = {} if Y2 is None else {"Y2": Y2}
    if contact is not None:
        refuse_both("h_protect", contact, parameters | ({} if P is None else {"P": P}))
        contacts = _controlled_by_load(of_dataset("h_protect", contact, strength_of_call, (by,)))
    else:
        contacts = _of_inputs(P, parameters, strength_of_call, by)
    problem = contacts.problem
    by = "h" if by == "layers.1.h" else by
    if by not in problem.parameters or not (by == "h" or _THICKNESS.fullmatch(by)):
        raise StudyError(
            [f'h_protect: by = {shown(by)}: must be "h", or of a stack the thickness of one of its layers']
        )
    if np.any(is_bare(problem.base)):
        raise StudyError(['h_protect: base = "half_space" has no layer that could protect it'])
    strength = strengths(contacts, materials_in(parameters))["body"]
    if np.isnan(strength[problem.n > 0]).any():
        raise StudyError(["h_protect needs Y2, the yield strength of the body: it is not given, or not known of it"])
    stiff = problem.n == 0
    protecting = protection(problem.but(n=np.where(stiff, 1.0, problem.n)), np.where(stiff, np.nan, strength), mu, by)
    _, size = contacts.units
    lacking = protecting.unsolved & np.isnan(protecting.protects)
    words = {
        "h_protect": ("thickness above which the body does not yield", protecting.protects, lacking),
        "h_yields": (
            "least thickness at which the body yields and a bare one would not",
            protecting.yields,
            protecting.unsolved,
        ),
    }
    variables = {}
    for name, (long_name, values, unsolved) in words.items():
        about = about_of(contacts, long_name, (0, 1))
        if np.isnan(values).any():
            count = int(np.isnan(values).sum())
            reason = "contacts on the way have no solution" if unsolved.any() else "no such thickness exists"
            about["message"] = f"{name} of {count} of {values.size} cases: {reason}"
        variables[name] = labelled(contacts, values * size, about)
    return without_control(with_coordinates_of(contacts.dataset, variables), by)


_THICKNESS, _OF_LAYER = re.compile(r"layers\.\d+\.h"), re.compile(r"layers\.(\d+)\.")


def _of_inputs(P: Any, parameters: dict, strengths: dict, by: str) -> Contacts:
    if P is None:
        raise StudyError(["h_protect: give the load P, or a contact, which is a dataset of study.solve"])
    if not isinstance(by, str) or not (by == "h" or _THICKNESS.fullmatch(by)):
        raise StudyError(
            [f'h_protect: by = {shown(by)}: must be "h", or of a stack the thickness of one of its layers']
        )
    refuse("h_protect", parameters, (by,), "it is what is looked for")
    refuse("h_protect", parameters, ("a", "D", "cases"), "the load P is given")
    if np.any(is_bare(np.asarray(parameters.get("base", "layered")))):
        raise StudyError(['h_protect: base = "half_space" has no layer that could protect it'])
    stack = "layers" in parameters or any(name.startswith("layers.") for name in parameters)
    by = "layers.1.h" if stack and by == "h" else by
    if isinstance(parameters.get("layers"), (list, tuple)) and by.startswith("layers."):
        j = int(by.split(".")[1]) - 1  # the thickness in the list does not matter
        numbers = [int(match[1]) for name in parameters if (match := _OF_LAYER.match(name))]
        last = max([len(parameters["layers"]), *numbers])
        if not 0 <= j < last:
            raise StudyError([f"h_protect: by = {shown(by)}: must be one of the layers 1 to {last}"])
        layers = [
            {key: value for key, value in layer.items() if not (i == j and key == "h")}
            if isinstance(layer, dict)
            else layer
            for i, layer in enumerate(parameters["layers"])
        ]
        parameters = parameters | {"layers": layers}
    return of_inputs("h_protect", parameters | {"P": P} | strengths, by, 0.01)


def _controlled_by_load(contacts: Contacts) -> Contacts:
    """The contacts with the load as their control, whatever controlled them."""
    if contacts.problem.control == "P":
        return contacts
    if "P" not in contacts.dataset:
        raise StudyError(["h_protect: the dataset has no load P"])
    stress, size = contacts.units
    load = contacts.column(contacts.dataset["P"].variable) / (stress * size**2)
    return contacts._replace(problem=replace(contacts.problem, control="P", value=load))
