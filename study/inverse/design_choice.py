"""The contacts that keep to limits (`feasible`), and those that no other contact beats (`front`)."""

import operator
from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..data.derived import QUANTITIES
from ..inputs.definition import StudyError
from ..inputs.lexicon import lexicon_in
from ..inputs.vocabulary import suggest
from ..specimen.quantities import quantity
from ..terminal import shown

_COMPARED = {"<=": operator.le, ">=": operator.ge, "<": operator.lt, ">": operator.gt}
_FLAGS = ("validity", "status", "model_used")  # variables that are compared with whole numbers


def feasible(contacts: xr.Dataset, **limits: str | int) -> xr.DataArray:
    """Whether contacts keep to all limits.

    Parameters
    ----------
    contacts : from `study.solve` or `study.design`, or of a results file
    limits : name of an input, a result or a derived quantity -> "< 250 MPa", "<= 6 um", "> 0.1", ">= 1 N"; without
        units "< 0.02". validity -> the sum of the allowed masks, 0 for none; status, model_used -> their number

    Returns
    -------
    xarray.DataArray : bool, over the dimensions of `status`; False where the contact is not solved or a number is NaN.
        A profile, such as p, must keep to its limit at every x

    Raises
    ------
    StudyError : no contacts, no quantity of this name, no limit, or one in a wrong unit

    Examples
    --------
    >>> import study
    >>> contacts = study.solve(P=[1e-6, 1e-5, 1e-4], micro="smooth", base="half_space")
    >>> study.feasible(contacts, p0="< 0.02", validity=0).values.tolist()
    [True, True, False]
    """
    good = _solved(contacts, "feasible")
    for name, limit in limits.items():
        values = _quantity(contacts, name, "feasible")
        if name in _FLAGS:
            if isinstance(limit, bool) or not isinstance(limit, (int, np.integer)):
                raise StudyError([f"feasible: {name} = {shown(limit)}: must be a whole number, such as {name}=0"])
            keeps = (values & ~np.int64(limit)) == 0 if name == "validity" else values == limit
        else:
            compare, number = _limit(name, limit, values)
            keeps = compare(values, number)
        good = good & (keeps.all("x") if "x" in keeps.dims else keeps)
    return good.transpose(*contacts["status"].dims).rename("feasible")


def front(contacts: xr.Dataset, least: Sequence[str] = (), most: Sequence[str] = ()) -> xr.Dataset:
    """The contacts of a dataset that no other contact in it beats.

    A contact beats another if it is better in one of the quantities, and worse in none.

    Parameters
    ----------
    contacts : from `study.solve` or `study.design`, or of a results file
    least, most : names of inputs, results or derived quantities of which less, or more, is better

    Returns
    -------
    xarray.Dataset : the contacts, with bool `on_front` over the dimensions of `status`; False where the contact is not
        solved or a number is NaN

    Raises
    ------
    StudyError : no contacts, or no quantity of this name

    Examples
    --------
    >>> import study
    >>> contacts = study.solve(P=[1e-5, 2e-5], h=[0.01, 0.04], n=0.1, bonding="bonded", micro="smooth")
    >>> study.front(contacts, least=["p0", "D"]).on_front.values.tolist()
    [[True, True], [False, False]]
    """
    wrong = [f"{key} = {shown(names)}: must be a list of names" for key, names in (("least", least), ("most", most))
             if isinstance(names, str)]  # fmt: skip
    names = [*least, *most]
    wrong += ["give at least one name: least, most"] * (not names and not wrong)
    if wrong:
        raise StudyError(f"front: {text}" for text in wrong)
    good, signs = _solved(contacts, "front"), [1.0] * len(least) + [-1.0] * len(most)
    arrays = [sign * _quantity(contacts, name, "front") for sign, name in zip(signs, names, strict=True)]
    for array, name in zip(arrays, names, strict=True):
        if "x" in array.dims:
            raise StudyError([f"front: {name} is a profile: take a number of each contact"])
    costs = np.stack([array.broadcast_like(good).transpose(*good.dims).values.ravel() for array in arrays], axis=1)
    rows = np.flatnonzero(good.values.ravel() & np.isfinite(costs).all(axis=1))
    on_front = np.zeros(good.size, bool)
    on_front[rows[_unbeaten(costs[rows])]] = True
    words = " and ".join([*(f"less {name}" for name in least), *(f"more {name}" for name in most)])
    about = {"long_name": f"whether no other contact beats it, with {words}"}
    return contacts.assign(on_front=(good.dims, on_front.reshape(good.shape), about))


def _unbeaten(costs: np.ndarray) -> np.ndarray:
    """(n,) bool: the rows of costs (n, k) that no other row beats."""
    alive = np.ones(len(costs), bool)
    for i in np.lexsort(costs.T[::-1]):  # in this order no later row beats an earlier one
        if alive[i]:
            alive &= ~((costs >= costs[i]).all(axis=1) & (costs > costs[i]).any(axis=1))
    return alive


def _solved(contacts: xr.Dataset, who: str) -> xr.DataArray:
    if not isinstance(contacts, xr.Dataset) or "status" not in contacts:
        raise StudyError([f"{who} takes a dataset of study.solve, study.design or of a results file, with its status"])
    return contacts["status"] == 0


def _quantity(contacts: xr.Dataset, name: str, who: str) -> xr.DataArray:
    """A variable of the dataset, or a quantity derived from it."""
    if name in contacts.variables:
        return contacts[name]
    if name in QUANTITIES:
        try:
            return QUANTITIES[name](contacts)
        except (KeyError, ValueError) as error:
            raise StudyError([f"{who}: {name} does not follow from this dataset: {error}"]) from None
    names = [str(key) for key in contacts.variables]
    raise StudyError([f"{who}: the dataset has no {shown(name)}{suggest(str(name), names)}"])


def _limit(name: str, limit: str, values: xr.DataArray) -> tuple:
    """The comparison of a limit, and its number in the unit of the values."""
    text = limit.strip() if isinstance(limit, str) else ""
    sign = next((sign for sign in _COMPARED if text.startswith(sign)), "")
    unit = values.attrs.get("units", "1")
    if not sign or values.dtype.kind not in "iuf":
        example = "< 250 MPa" if unit != "1" else "< 0.02"
        words = f'must be a text that begins with <, <=, > or >=, such as "{example}"'
        words = words if values.dtype.kind in "iuf" else f"{name} is not a number"
        raise StudyError([f"feasible: {name} = {shown(limit)}: {words}"])
    rows = lexicon_in(values.coords).all_rows
    si_unit = rows[name].unit if name in rows and unit != "1" else unit
    try:
        number = quantity(name, text.removeprefix(sign).strip(), si_unit)
        size = 1.0 if unit == si_unit else quantity(name, f"1 {unit}", si_unit).value  # from study.readable
    except ValueError as error:
        raise StudyError([f"feasible: {error}"]) from None
    if number.spread:
        raise StudyError([f"feasible: {name} = {shown(limit)}: a limit has no ±"])
    return _COMPARED[sign], number.value / size
