"""The numbers that the paper prints, in its scaling R = 1, E2* = 1."""

TABLE1 = (
    (0.004, 250000, 4e-4, 0.50),
    (0.004, 62500, 1.2e-3, 0.53),
    (0.004, 15625, 4e-3, 0.57),
    (0.002, 250000, 6e-4, 0.53),
    (0.001, 250000, 1e-3, 0.57),
)
"""Ra, Nbar, B E1*^beta in R, beta."""
ERROR_INTERVAL = (0.0025, 0.025)
"""Pressures in E1* over which the paper states the errors of its fits."""
ERROR_BOUNDS = {4.0: 0.08, 1.0: 0.05, 0.25: 0.05}
"""Nbar Ra^2 of a row of Table 1 -> upper bound of the error of its fit. The paper prints only the two bounds. The wider
one must belong to the first row, by the errors of its constants that we find."""
NUMBERS = {
    "P": ("load P at a = a0, rough, layered", 2.72e-5),
    "p0": ("p(0), rough, layered", 0.01),
    "Ar_An": ("Ar/An, rough, layered", 0.185),
    "p_max": ("pmax, rough, layered", 0.053),
    "D": ("D, rough, layered", 1.038e-3),
    "A0": ("A[p(0)], rough, layered", 5.711e-5),
    "An_ratio": ("An over that of a0, rough, homogeneous", 0.564),
    "Ar_An homogeneous": ("Ar/An, rough, homogeneous", 0.172),
    "p_max homogeneous": ("pmax, rough, homogeneous", 0.097),
    "D smooth layered": ("D, smooth, layered", 1.003e-3),
    "D smooth homogeneous": ("D, smooth, homogeneous (Hertz)", 7.418e-4),
    "B": ("B of the fit, in Ra/E1*^beta, first row of Table 1", 0.092),
    "beta": ("beta of the fit, first row of Table 1", 0.491),
}
"""Sections 4.1 to 5: key -> quantity and printed value. The load of all contacts is the first one."""
