"""The contacts on which the page of the explorer is compared with the program: many, of all that the page solves."""

import numpy as np

CONTROLS = ("P", "a", "D")
#: Results that are compared; `error` of the page is the largest relative error of these.
RESULTS = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
#: Contacts of each control. Some are left out: too thin a layer, or a punch that lifts off.
MANY = 6900
#: So many apart the indices of the controls begin.
_APART = 8000


def parameters(control: str) -> dict[str, np.ndarray]:
    """Parameters (MANY,) of `solver.Problem` with one control. They are multiples of roots modulo 1, evenly spread and
    the same with every version of numpy."""
    index = np.arange(1, MANY + 1) + _APART * CONTROLS.index(control)
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
        "asperities_on": np.full(MANY, "half_space"),  # which core.js has, whatever the pitch; contact.js judges that
        "Nbar": 10 ** (3 * of_Nbar + 4),
        "Ra": 10 ** (2 * of_Ra - 3.5),
    }
