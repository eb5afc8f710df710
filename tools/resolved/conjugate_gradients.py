"""A rigid shape pressed on an elastic grid by conjugate gradients: Polonsky and Keer, Wear 231, 1999, 206.

For grids that are not periodic; for periodic ones there is :func:`solver.laws.cell.periodic.pressed`.
"""

import numpy as np

#: Largest number of steps; the tests take some 100.
_STEPS = 500


def pressed(displaced, height, p, mean, tolerance):
    """Approach of the shape, and the pressure at the points of the grid.

    displaced : function pressure -> displacement of the surface
    height : of the shape above its lowest point
    p : first pressure, whose size does not matter
    mean : of the pressure over the grid, which gives the load
    tolerance : relative change of the pressure in a step that ends the search
    """
    p = p * mean / p.mean()
    direction, size, conjugate = np.zeros_like(p), 1.0, 0.0
    for _ in range(_STEPS):
        inside, gap = p > 0, displaced(p) + height
        approach = gap[inside].mean()
        gap -= approach
        old_size, size = size, (gap[inside] ** 2).sum()
        direction = np.where(inside, gap + conjugate * size / old_size * direction, 0.0)
        change = displaced(direction)
        change -= change[inside].mean()
        step = (gap * direction)[inside].sum() / (change * direction)[inside].sum()
        old, p = p, np.maximum(p - step * direction, 0.0)
        returning = (p == 0) & (gap < 0)
        conjugate = 0.0 if returning.any() else 1.0
        p = np.where(returning, p - step * gap, p)
        p *= mean / p.mean()
        if np.abs(p - old).mean() < tolerance * mean:
            return approach, p
    raise AssertionError("conjugate gradients did not end")
