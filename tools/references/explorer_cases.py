"""The contacts on which the explorer's page is compared with the program: many, of every kind that the page solves."""

import numpy as np

CONTROLS = ("P", "a", "D")
#: Results that are compared; `error` of the page is their largest relative error.
RESULTS = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
#: Contacts of each control. Some have no result: the layer is too thin, or the punch lifts off.
MANY = 6900
#: Distance between the first indices of the controls.
_OFFSET = 8000


def parameters(control: str) -> dict[str, np.ndarray]:
    """Parameters (MANY,) of `solver.Problem` with one control. They are multiples of roots modulo 1, evenly spread and
    the same with every version of numpy."""
    index = np.arange(1, MANY + 1) + _OFFSET * CONTROLS.index(control)
    primes = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31)
    of_value, of_h, of_n, nu1, nu2, of_m, bonded, rough, of_Nbar, of_Ra, base = (index * np.sqrt(p) % 1 for p in primes)
    value = {"P": 10 ** (4 * of_value - 7), "a": 10 ** (1.5 * of_value - 2.3), "D": 10 ** (3 * of_value - 4.5)}[control]
    a = {"P": np.cbrt(value), "a": value, "D": np.sqrt(value)}[control]  # roughly
    return {
        control: value,
        "h": a * 10 ** (4 * of_h - 2.4),
        "n": np.where(base < 0.03, 0.0, 10 ** (6 * of_n - 3)),
        "nu1": nu1 / 2,
        "nu2": nu2 / 2,
        "m": np.maximum(4 * of_m - 1, 0.0),
        "bonding": np.where(bonded < 0.5, "bonded", "frictionless"),
        "base": np.where(base > 0.97, "half_space", "layered"),
        "micro": np.where(rough < 0.5, "disc_cell", "smooth"),
        "asperities_on": np.full(MANY, "half_space"),  # core.js always takes it; contact.js judges the pitch
        "Nbar": 10 ** (3 * of_Nbar + 4),
        "Ra": 10 ** (2 * of_Ra - 3.5),
    }
