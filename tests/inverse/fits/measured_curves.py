"""Curves that tests fit: solved by `study.solve`, with noise of a fixed seed."""

import warnings

import numpy as np
import xarray as xr

import study

GEL = {"R": "5 um", "nu1": 0.49, "h": "1.5 um", "E2": "70 GPa", "nu2": 0.2, "bonding": "bonded", "micro": "smooth"}
DEPTHS = np.linspace(-0.2, 1.0, 120) * 0.8e-6  # m


def solved(x, y, values, **given):
    """y at x, both in SI; 0 where x is not above 0."""
    inside = np.asarray(values) > 0
    control = xr.DataArray(np.asarray(values)[inside], dims="point", attrs={"units": {"P": "N"}.get(x, "m")})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of validity, which is not the question here
        contact = study.solve(**given, **{x: control}, x=2, profiles=False, progress=False, rtol=1e-9)
    result = np.zeros(len(values))
    result[inside] = contact[y].values
    return result


def gel(E1="5 kPa", depths=DEPTHS, noise=0.01, seed=1, **changed):
    """Loads on a gel on glass at depths in m, and the standard deviation of their noise."""
    P = solved("D", "P", depths, **GEL | changed, E1=E1)
    sigma = noise * P.max()
    return P + sigma * np.random.default_rng(seed).standard_normal(len(P)), sigma


def fit(D, P, free=("E1",), intervals="fisher", **options):
    given = GEL | options
    given = {name: value for name, value in given.items() if value is not None}
    return study.fit({"D": (D, "m"), "P": (P, "N")}, free=list(free), intervals=intervals, progress=False, **given)


def status(fitted):
    """Names of the statuses of all curves."""
    about = fitted.fit_status.attrs
    meanings = dict(zip(about["flag_values"].tolist(), about["flag_meanings"].split(), strict=True))
    return [meanings[value] for value in fitted.fit_status.values.tolist()]
