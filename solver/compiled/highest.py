"""The largest values of functions of stresses in boxes by the compiled core. The numpy path is in
solver/yields/search/climb.py."""

from ctypes import byref

import numpy as np

from .library import CBoxes, boxes_core, pointer

#: The functions, in the order of boxes.h.
FUNCTIONS = ("mises", "tresca", "s1", "sr", "tau", "tension", "compression")


def highest_in_c(numbers, models, centre, low, high):
    """Places (T, 2) and values (T,) of the largest values; None where numpy is to compute.

    numbers : (T,), indices of :data:`FUNCTIONS`
    models : (6, 4, T), stresses at the `centre` of each model and their derivatives; centre, low, high : (T, 2)
    """
    if (function := boxes_core()) is None:
        return None
    arrays = {"functions": np.ascontiguousarray(numbers, np.int64)}
    for name, array in (("models", models), ("centre", centre), ("low", low), ("high", high)):
        arrays[name] = np.ascontiguousarray(array, float)
    places, values = np.empty((len(numbers), 2)), np.empty(len(numbers))
    pointers = {name: pointer(array) for name, array in arrays.items()}
    function(byref(CBoxes(tasks=len(numbers), **pointers, places=pointer(places), values=pointer(values))))
    return places, values
