"""Numbers of flags as names."""

import numpy as np
import xarray as xr

from .dataset import model_attributes, status_attributes
from .derived import validity_attributes


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
    known = {"status": status_attributes, "model_used": model_attributes, "validity": validity_attributes}
    attributes = flags.attrs
    if "flag_meanings" not in attributes:  # arithmetic of xarray loses attributes
        if flags.name not in known:
            raise ValueError(f"{flags.name or 'the array'} is none of {', '.join(known)}")
        attributes = known[flags.name]()
    words, values = attributes["flag_meanings"].split(), whole(flags.values, attributes)
    if "flag_masks" in attributes:
        masks = np.atleast_1d(attributes["flag_masks"]).tolist()
        present = np.unique(values).tolist()
        names = {v: " ".join(w for m, w in zip(masks, words, strict=True) if v & m) for v in present}
    else:
        names = dict(zip(np.atleast_1d(attributes["flag_values"]).tolist(), words, strict=True))
    texts = [names.get(value, str(value)) for value in values.ravel().tolist()]
    named = np.array(texts, dtype=str).reshape(flags.shape)
    return xr.DataArray(named, flags.coords, flags.dims, flags.name)


def broken(validity: xr.DataArray | xr.Variable) -> dict[str, np.ndarray]:
    """Name of each assumption -> where it is violated, of the shape of the flags; in the order of the masks."""
    attributes = validity.attrs
    masks = zip(np.atleast_1d(attributes["flag_masks"]).tolist(), attributes["flag_meanings"].split(), strict=True)
    values = whole(validity.values, attributes)
    return {name: (values & mask) != 0 for mask, name in masks}


def whole(flags: np.ndarray, attributes: dict) -> np.ndarray:
    """Flags as whole numbers. `where`, `reindex` and `interp` of xarray make them floats, NaN where no case is left.

    There the status is that of a case that was not run, and all else is 0.
    """
    if flags.dtype.kind in "iu":
        return flags
    words = attributes["flag_meanings"].split()
    absent = np.atleast_1d(attributes["flag_values"])[words.index("not_run")] if "not_run" in words else 0
    return np.where(np.isfinite(flags), flags, absent).astype(int)
