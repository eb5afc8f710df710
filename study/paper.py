"""The numbers that the paper prints: data only, in its scaling R = 1, E2* = 1."""

TABLE1 = (
    # Ra, Nbar, B E1*^beta in R, beta
    (0.004, 250_000, 4e-4, 0.50),
    (0.004, 62_500, 1.2e-3, 0.53),
    (0.004, 15_625, 4e-3, 0.57),
    (0.002, 250_000, 6e-4, 0.53),
    (0.001, 250_000, 1e-3, 0.57),
)

NUMBERS = {
    # key: (quantity, symbol in LaTeX, printed value)
    "P": ("load at a = a0, rough, layered", r"P", 2.72e-5),
    "p0": ("nominal pressure in the centre, rough, layered", r"p(0)", 0.01),
    "Ar_An": ("real over nominal area, rough, layered", r"A_r/A_n", 0.185),
    "p_max": ("largest real pressure, rough, layered", r"p_{\max}", 0.053),
    "D": ("depth, rough, layered", r"D", 1.038e-3),
    "A0": ("additional displacement in the centre, rough, layered", r"A[p(0)]", 5.711e-5),
    "An_ratio": ("nominal area over pi a0^2, rough, homogeneous", r"A_n/(\pi a_0^2)", 0.564),
    "Ar_An homogeneous": ("real over nominal area, rough, homogeneous", r"A_r/A_n", 0.172),
    "p_max homogeneous": ("largest real pressure, rough, homogeneous", r"p_{\max}", 0.097),
    "D smooth layered": ("depth, smooth, layered", r"D", 1.003e-3),
    "D smooth homogeneous": ("depth, smooth, homogeneous (Hertz)", r"D", 7.418e-4),
    "B": ("coefficient of the fit, N Ra^2 = 4", r"B E_1^{*\beta}/R_a", 0.092),
    "beta": ("exponent of the fit, N Ra^2 = 4", r"\beta", 0.491),
    "error 4": ("largest error of Table 1's law, N Ra^2 = 4", r"\max|A_{fit}/A - 1|", 0.077),
    "error 1": ("largest error of Table 1's law, N Ra^2 = 1", r"\max|A_{fit}/A - 1|", 0.042),
    "error 0.25": ("largest error of Table 1's law, N Ra^2 = 0.25", r"\max|A_{fit}/A - 1|", 0.025),
}
"""Sections 4.1 to 5 of the paper; the load of all contacts is that of the first line."""

ERROR_INTERVAL = (0.0025, 0.025)
"""Pressures in E1* over which the paper states the errors of its fits."""
