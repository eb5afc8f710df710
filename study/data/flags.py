"""Numbers of flags as names."""

import numpy as np
import xarray as xr

from .dataset import model_attributes, status_attributes
from .derived import ASSUMPTIONS

MASKS = {"flag_masks": list(ASSUMPTIONS), "flag_meanings": " ".join(ASSUMPTIONS.values())}


def decode(flags: xr.DataArray) -> xr.DataArray:
    """The names of `status`, `model_used` or `validity`, in an array of texts over the same dimensions.

    Several assumptions that a case violates are separated by blanks; where none is, the text is empty. A number without
    a name stays a number.

    Raises
    ------
    ValueError : the array has none of these names, and no attribute `flag_meanings`

    Examples
    --------
    >>> import study
    >>> found = study.solve(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> study.decode(found.model_used).values.tolist()
    ['smooth_half_space', 'smooth_half_space']
    """
    known = {"status": status_attributes, "model_used": model_attributes, "validity": lambda: MASKS}
    told = flags.attrs
    if "flag_meanings" not in told:  # arithmetic of xarray loses attributes
        if flags.name not in known:
            raise ValueError(f"{flags.name or 'the array'} is none of {', '.join(known)}")
        told = known[flags.name]()
    words = told["flag_meanings"].split()
    if "flag_masks" in told:
        masks = np.atleast_1d(told["flag_masks"]).tolist()
        names = {v: " ".join(w for m, w in zip(masks, words, strict=True) if v & m) for v in _values(flags)}
    else:
        names = dict(zip(np.atleast_1d(told["flag_values"]).tolist(), words, strict=True))
    texts = [names.get(value, str(value)) for value in flags.values.ravel().astype(int).tolist()]
    named = np.array(texts, dtype=str).reshape(flags.shape)
    return xr.DataArray(named, flags.coords, flags.dims, flags.name)


def broken(validity: xr.DataArray | xr.Variable) -> dict[str, np.ndarray]:
    """Name of each assumption -> where it is violated, of the shape of the flags; in the order of the masks."""
    told = validity.attrs
    masks = zip(np.atleast_1d(told["flag_masks"]).tolist(), told["flag_meanings"].split(), strict=True)
    return {name: (validity.values & mask) != 0 for mask, name in masks}


def _values(flags: xr.DataArray) -> list[int]:
    return np.unique(flags.values).astype(int).tolist()
