"""Principal stresses, and those of von Mises and Tresca, of stresses without shear across the plane of r and z."""

from typing import NamedTuple

import numpy as np


class Invariants(NamedTuple):
    """Principal stresses s1 >= s2 >= s3, and the equivalent stresses of von Mises and of Tresca, s1 - s3; arrays of one
    shape."""

    s1: np.ndarray
    s2: np.ndarray
    s3: np.ndarray
    mises: np.ndarray
    tresca: np.ndarray


@np.errstate(invalid="ignore")  # stresses may be infinite: beneath a tip, at the edge of a flat punch
def invariants(sr, st, sz, trz):
    """:class:`Invariants` of the stresses; arrays of any shape. For sliding in the plane y = 0, trz is sxz.

    Where sr, st and sz are all infinite, so are s1, s2 and s3, and the equivalent stresses, which are made of
    differences, are NaN.
    """
    middle, radius = (sr + sz) / 2, np.hypot(np.where(sr == sz, 0.0, sr - sz) / 2, trz)
    s3, s2, s1 = np.sort(np.stack([middle - radius, middle + radius, st]), axis=0)
    return Invariants(s1, s2, s3, mises(sr, st, sz, trz), s1 - s3)


@np.errstate(invalid="ignore")
def mises(sr, st, sz, trz):
    """The equivalent stress of von Mises; arrays of any shape."""
    return np.sqrt(((sr - st) ** 2 + (st - sz) ** 2 + (sz - sr) ** 2) / 2 + 3 * trz * trz)
