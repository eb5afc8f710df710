"""A model file of nanite (`nanite.model.load_model_from_file`): a bead on a layer that is bonded to a rigid base.

The force is exact for any thickness, by roughcoat: F = 4/3 E/(1 - nu²) sqrt(R) d^(3/2) g(d R/h², nu), with the depth d
= contact_point - tip position. g is a table that is computed at the first use of a Poisson ratio (docs/afm.md).
"""

from functools import lru_cache

import numpy as np
from numpy.polynomial import Chebyshev

import roughcoat  # noqa: F401  (so that `solver` is that of roughcoat, whatever lies beside the data)
from solver import Problem, solve

_LOW, _HIGH, _NODES = np.log(1e-6), np.log(1e4), 80  # range of ln(d R/h²), a/h from 0.001 to some 100; right to 1e-6
_THIN = 1e-3  # h/R of the solved contacts; only d R/h² matters


@lru_cache(maxsize=64)
def _table(nu):
    """ln g as a function of ln(d R/h²), a Chebyshev series."""

    def log_g(u):
        D = np.exp(u) * _THIN**2
        layer = {"h": _THIN, "n": 0.0, "nu1": nu, "bonding": "bonded", "micro": "smooth", "rtol": 1e-8}
        return np.log(solve(Problem.of(D=D, **layer)).P / (4 / 3 * D**1.5))

    return Chebyshev.interpolate(log_g, _NODES - 1, (_LOW, _HIGH))


def get_parameter_defaults():
    """Parameters of lmfit, in the order of `parameter_keys`."""
    from lmfit import Parameters  # nanite brings it

    params = Parameters()
    params.add("E", value=3e3, min=0)
    params.add("R", value=5e-6, min=0, vary=False)
    params.add("nu", value=0.49, min=0, max=0.5, vary=False)
    params.add("h", value=2e-6, min=1e-12, vary=False)
    params.add("contact_point", value=0)
    params.add("baseline", value=0)
    return params


def layer_on_rigid_base(delta, E, R, nu, h, contact_point=0, baseline=0):
    """Force of a paraboloid on a layer bonded to a rigid base.

    Parameters
    ----------
    delta : 1d ndarray, tip position [m], which falls into the sample
    E, nu : Young's modulus [Pa] and Poisson's ratio of the layer
    R, h : radius of the tip and thickness of the layer [m]
    contact_point, baseline : offsets of tip position [m] and force [N]

    Returns
    -------
    1d ndarray : force [N]
    """
    depth = contact_point - delta
    touching = depth > 0
    force = np.zeros_like(delta, dtype=float)
    u, d = np.log(depth[touching] * R / h**2), depth[touching]
    g = np.exp(_table(round(float(nu), 12))(np.clip(u, _LOW, _HIGH)))
    force[touching] = 4 / 3 * E / (1 - nu**2) * np.sqrt(R) * d**1.5 * g
    return force + baseline


model_doc = layer_on_rigid_base.__doc__
model_func = layer_on_rigid_base
model_key = "roughcoat_layer"
model_name = "bead on a layer on a rigid base (roughcoat)"
parameter_keys = ["E", "R", "nu", "h", "contact_point", "baseline"]
parameter_names = [
    "Young's Modulus",
    "Tip Radius",
    "Poisson's Ratio",
    "Layer Thickness",
    "Contact Point",
    "Force Baseline",
]
parameter_units = ["Pa", "m", "", "m", "m", "N"]
valid_axes_x = ["tip position"]
valid_axes_y = ["force"]
