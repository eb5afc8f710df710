"""The thickness of a layer that protects the body."""

from typing import Any

import numpy as np
import xarray as xr

from solver.yields.protect import protection

from ..again import strengths
from ..fields import carried, friction, units_of
from ..inputs.definition import StudyError
from .first import about_of, contacts, labelled, own_materials, refuse, without_control


def h_protect(*, P: Any, Y2: Any = None, mu: float = 0.0, **parameters: Any) -> xr.Dataset:
    """The thickness above which a layer protects the body from yielding: docs/stresses.md.

    Under a stiff layer the largest stress of the body first rises with the thickness, before it falls.

    Parameters
    ----------
    P : load
    Y2 : yield strength of the body, > 0; without it that of the material that is named
    mu : >= 0; with mu > 0 the punch slides in full
    parameters : those of `study.solve` without h, a and D

    Returns
    -------
    xarray.Dataset : over the dimensions of the parameters: h_protect, above which the body yields for no larger
        thickness, 0 if it yields for none; h_yields, the least thickness at which the body yields where a bare one
        would not, NaN if there is none. Where a search has no answer the variable is NaN and has a `message`

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
    given = {"P": P} | ({} if Y2 is None else {"Y2": Y2})
    refuse("h_protect", parameters, ("h",), "it is what is looked for")
    refuse("h_protect", parameters, ("a", "D", "cases"), "the load P is given")
    if np.any(np.asarray(parameters.get("base", "layered")) == "half_space"):
        raise StudyError(['h_protect: base = "half_space" has no layer that could protect it'])
    contact, again = contacts("h_protect", parameters | given, "h", 0.01)
    known = strengths(contact, again, own_materials(parameters))["body"]
    if np.isnan(known[again.problem.n > 0]).any():
        raise StudyError(["h_protect needs Y2, the yield strength of the body: it is not given, or not known of it"])
    stiff = again.problem.n == 0
    found = protection(again.problem.but(n=np.where(stiff, 1.0, again.problem.n)), np.where(stiff, np.nan, known), mu)
    _, size = units_of(again)
    lacking = found.unsolved & np.isnan(found.protects)
    words = {
        "h_protect": ("thickness above which the body does not yield", found.protects, lacking),
        "h_yields": ("least thickness at which the body yields and a bare one would not", found.yields, found.unsolved),
    }
    variables = {}
    for name, (long_name, values, unsolved) in words.items():
        about = about_of(again, long_name, (0, 1))
        if np.isnan(values).any():
            count = int(np.isnan(values).sum())
            reason = "contacts on the way have no solution" if unsolved.any() else "there is no such thickness"
            about["message"] = f"{name} of {count} of {values.size} cases: {reason}"
        variables[name] = labelled(again, values * size, about)
    return without_control(carried(contact, variables), "h")
