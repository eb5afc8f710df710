"""Quantities that follow from a dataset: validity of the model's assumptions, areas, mean pressure, number of spots.

Every function takes an opened dataset. The attributes of its result come from the vocabulary.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, wraps
from inspect import cleandoc

import numpy as np

from solver import Model
from solver.bases import is_bare
from solver.kernels.two_layers import layer_modulus
from solver.known import Known
from solver.laws import identity, name_in
from solver.problem import feels
from solver.scaling import law_of, of_one_law

from ..arrays import xarray_later as xr
from ..inputs.lexicon import Lexicon, lexicon_in
from ..inputs.punch.micro_laws import USED
from ..inputs.scene.scene import without_unit
from ..inputs.vocabulary import CONTROLS, NUMERICS, ROWS, VOCABULARY, attributes
from ..rules import rule
from ..rules.assumptions import (  # noqa: F401 - names of study.derived
    COMPRESSED,
    FEW_SPOTS,
    MERGING,
    NOT_THIN,
    PITCH_OVER_LAYER,
    SPOT_OVER_LAYER,
    STEEP,
    STEEP_SPOT,
    STRETCHED,
)
from ..rules.rule import ASSUMPTIONS, validity  # noqa: F401 - names of study.derived
from ..rules.slope_and_adhesion import SLOPE, ZONE  # noqa: F401 - names of study.derived
from .units import physical_attributes, reduced_modulus

ROUNDING = 1e-12
"""Pressures of a profile count as equal if their relative difference is smaller, and so may be rounding."""
LEAST_POINTS, LOAD_MISSED = 5, 5e-3
"""`D_body` needs so many points of a profile, and at most this relative error of the load. D_body has a smaller one."""
QUANTITIES: dict[str, Callable[[xr.Dataset], xr.DataArray]] = {}
"""Name -> function of a dataset: the formulas with the decorator `quantity`, which can be drawn like results."""
SECTIONS_OF_QUANTITIES = """

Parameters
----------
dataset : of contacts, dimensionless, or in SI units as `study.solve` gives it

Returns
-------
xarray.DataArray : over the dimensions of the contacts, with the name, the unit and the words of the vocabulary

Raises
------
ValueError : the dataset is in multiples of SI units, or lacks what the quantity follows from
"""


def quantity(name: str) -> Callable:
    """Decorator of a formula: its result gets the name and attributes of the vocabulary, and QUANTITIES holds it.

    Parameters
    ----------
    name : of a row of the vocabulary

    Returns
    -------
    a decorator of a function of a dataset, which is then one of `study.derived` (docs/extending.md)

    Raises
    ------
    ValueError : there is no row of this name

    Examples
    --------
    >>> QUANTITIES["An"] is nominal_area  # which has the decorator @quantity("An")
    True
    >>> quantity("mean_depth")
    Traceback (most recent call last):
    ValueError: mean_depth has no row in study/inputs/vocabulary.toml: a quantity needs one
    """
    if name not in VOCABULARY:
        raise ValueError(f"{name} has no row in study/inputs/vocabulary.toml: a quantity needs one")

    def register(formula: Callable) -> Callable:
        @wraps(formula)
        def computed(dataset: xr.Dataset) -> xr.DataArray:
            rows = lexicon_in(dataset).rows
            for key, variable in dataset.variables.items():
                unit = variable.attrs.get("units", "1")
                if key in rows and unit not in ("1", rows[key].unit):  # as in datasets of study.readable
                    raise ValueError(f"{key} is in {unit}: {name} follows from results in SI units, or without units")
            return named(formula(dataset), name, rule.has_units(dataset))

        words, heading, examples = cleandoc(formula.__doc__ or "").partition("\n\nExamples\n")
        computed.__doc__ = words + SECTIONS_OF_QUANTITIES + heading.removeprefix("\n") + examples
        QUANTITIES[name] = computed
        return computed

    return register


@quantity("An")
def nominal_area(dataset: xr.Dataset) -> xr.DataArray:
    """Nominal contact area An = πa², in R².

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, base="half_space", Nbar=250000, Ra=0.004)
    >>> print(f"{nominal_area(contact).item():.5f}")
    0.00157
    """
    return np.pi * dataset["a"] ** 2


def nominal_area_ratio(dataset: xr.Dataset, a0: float | xr.DataArray) -> xr.DataArray:
    """Nominal contact area over that of the radius a0, An/(π a0²).

    Parameters
    ----------
    dataset, a0 : of contacts; radius, in the unit of `a`

    Returns
    -------
    xarray.DataArray : over the dimensions of the contacts

    Examples
    --------
    >>> import study
    >>> contact = study.solve(a=0.04, base="half_space", micro="smooth")
    >>> nominal_area_ratio(contact, 0.02).item()
    4.0
    """
    return named((dataset["a"] / a0) ** 2, "An_ratio")


@quantity("p_mean")
def mean_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Mean nominal pressure P/An, in E2*.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, base="half_space", micro="smooth")
    >>> print(f"{(contact.p0 / mean_pressure(contact)).item():.3f}")
    1.500
    """
    return dataset["P"] / (np.pi * dataset["a"] ** 2)


@quantity("spots")
def number_of_spots(dataset: xr.Dataset) -> xr.DataArray:
    """Number of contact spots N̄ An; NaN where there is no roughness.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, base="half_space", Nbar=250000, Ra=0.004)
    >>> print(f"{number_of_spots(contact).item():.0f}")
    392
    """
    return rule.spots(dataset).where(rule.have("rough", dataset["micro"], lexicon_in(dataset).known))


@quantity("b0")
def spot_radius(dataset: xr.Dataset) -> xr.DataArray:
    """Radius of the central contact spot b = sqrt(λ/(π N̄)), Eq. (11), in R; NaN where there is no roughness.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, base="half_space", Nbar=250000, Ra=0.004)
    >>> print(f"{spot_radius(contact).item():.6f}")
    0.000513
    """
    return rule.spot_radius(dataset).where(rule.have("rough", dataset["micro"], lexicon_in(dataset).known))


@quantity("p_ring")
def largest_nominal_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Largest nominal pressure over the points of the profile, in E2*: p(0), or more in a ring.

    A hard coating with a > h bends like a plate and presses most in a ring near the edge. 33 points miss up to 3 % of
    it, 17 up to 6 % (tests/physical/words/test_largest_pressure.py). It needs the profile p.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-3, h=0.02, n=30, bonding="bonded", micro="smooth")
    >>> print(f"{largest_nominal_pressure(contact).item():.3f}, in the centre {contact.p0.item():.3f}")
    0.118, in the centre 0.065
    """
    return _profile(dataset, "p_ring").max("x", skipna=False)


@quantity("r_ring")
def ring_radius(dataset: xr.Dataset) -> xr.DataArray:
    """Radius in R at which the nominal pressure is largest, a point of the profile. Needs the profile p.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-3, h=0.02, n=30, bonding="bonded", micro="smooth")
    >>> print(f"{(ring_radius(contact) / contact.a).item():.2f}")
    0.81
    """
    p = _profile(dataset, "r_ring")
    return dataset["a"] * dataset["x"].where(p >= (1 - ROUNDING) * p.max("x", skipna=False)).min("x")


@quantity("p_peak")
def peak_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Largest real pressure over the points of the profile, Eq. (13) at each, in E2*; `p_max` is that at the centre.

    The two differ where p peaks in a ring (`p_ring`). Needs the profile p; NaN for a law that is not registered in the
    version of the results. Results with units must have R and E2 in SI units: the laws take their parameters in R and
    E2*.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, base="half_space", Nbar=250000, Ra=0.004)
    >>> print(f"{peak_pressure(contact).item():.4f}")
    0.0851
    """
    pressures = _profile(dataset, "p_peak")
    unit, R = _scales(dataset, "p_peak")
    E1 = _surface_modulus(dataset) / (1 + dataset.get("m", 0.0))  # of layer and punch in series
    peaks, lexicon = xr.full_like(pressures, np.nan), lexicon_in(dataset)
    felt = _feel_layer(dataset, lexicon.known)
    stated = {name_in(line): line for line in dataset.attrs.get("micro_laws", "").splitlines()}
    for law in [law for name, law in lexicon.known.laws.items() if (dataset["micro"] == name).any()]:
        if stated.get(law.name, identity(law)) != identity(law):
            continue
        numbers = {name: dataset.get(name, np.nan) for name in law.parameters}
        arguments = [without_unit(value, lexicon.rows[name].powers, unit, R) for name, value in numbers.items()]
        nu = xr.where(is_bare(dataset["base"]), dataset.get("nu2", np.nan), dataset.get("nu1", np.nan))
        arguments = [pressures / unit, E1, *arguments, *[nu] * law.poisson]
        at_spots = xr.apply_ufunc(_largest(law), *arguments, dask="parallelized", output_dtypes=[float])
        peaks = xr.where(dataset["micro"] == law.name, at_spots, peaks)
    if felt.any():
        peaks = xr.where(felt, _peaks_on_bodies(dataset, pressures / unit, unit, R), peaks)
    return unit * peaks.max("x", skipna=False)


def _feel_layer(dataset: xr.Dataset, known: Known) -> xr.DataArray:
    """Where the asperities feel the coated body below the surface: as the results say, or else their inputs."""
    if "asperities_used" in dataset:
        return dataset["asperities_used"] == USED.index("layer")
    names = {"base": "layered", "micro": "", "asperities_on": "auto", "Nbar": np.nan, "h": np.nan}
    values = (dataset.get(name, default) for name, default in names.items())
    return xr.apply_ufunc(partial(feels, laws=known.laws), *values)


def _peaks_on_bodies(dataset: xr.Dataset, p: xr.DataArray, unit, R) -> xr.DataArray:
    """p_max in E2* of asperities that feel the coated body, at nominal pressures p in E2*."""
    left_out, lexicon = {*CONTROLS, *NUMERICS, "asperities_on"}, lexicon_in(dataset)
    names = lexicon.parameters_of(map(str, dataset.variables))
    names = [name for name in names if name in dataset and name not in left_out]
    values = [dataset[name] for name in names]
    values = [v if v.dtype.kind not in "fi" else without_unit(v, lexicon.rows[name].powers, unit, R)
              for name, v in zip(names, values, strict=True)]  # fmt: skip
    dims = [["x"], *[[]] * len(values)]
    options = {"input_core_dims": dims, "output_core_dims": [["x"]], "dask": "parallelized", "output_dtypes": [float]}
    return xr.apply_ufunc(partial(_at_bodies, lexicon, names), p, *values, **options)


def _at_bodies(lexicon: Lexicon, names: list[str], p: np.ndarray, *values: np.ndarray) -> np.ndarray:
    """p_max at the pressures p (..., m) of contacts whose parameters, (...) each, have these names."""
    flat = {name: np.broadcast_to(v, p.shape[:-1]).ravel() for name, v in zip(names, values, strict=True)}
    problem = lexicon.problem(flat, a=1.0, asperities_on="layer")
    pressures = p.reshape(-1, p.shape[-1])
    peaks = np.full(pressures.shape, np.nan)
    index = np.flatnonzero(problem.can_feel())
    for rows in of_one_law(problem.take(index)):
        places = index[rows]
        peaks[places] = law_of(problem.take(places)).at(pressures[places]).p_max
    return peaks.reshape(p.shape)


@quantity("D_body")
def depth_of_the_body(dataset: xr.Dataset) -> xr.DataArray:
    """Depth by which the coated body alone is pressed in, in R: D less the deformation of the punch.

    D is the approach of distant points of both bodies. The punch, a half-space of E3* = E1*/m, deforms in the centre
    by (2/E3*) ∫ p dr, and by the share m/(1 + m) of the asperities' A[p(0)]. The coated body gives way by the rest. A
    rigid punch does not give way. The integrand is a cubic spline through the profile p, in arcsin(r/a). The depth is
    NaN where that spline misses the load by more than LOAD_MISSED. It needs all that `peak_pressure` needs, and p at 5
    points.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, m=0.5, base="half_space", micro="smooth")
    >>> print(f"{(depth_of_the_body(contact) / contact.D).item():.4f}")
    0.6667
    """
    m = dataset.get("m", xr.DataArray(0.0))
    if (m == 0).all():
        return dataset["D"] + 0 * m
    p = _profile(dataset, "D_body")
    if dataset.sizes["x"] < LEAST_POINTS:
        raise ValueError(f"D_body needs the profile p at {LEAST_POINTS} points or more, such as x = 33")
    along, over_area = (xr.DataArray(weights, dims="x") for weights in _weights(dataset["x"].values))
    integral, load = (p * along).sum("x", skipna=False), 2 * np.pi * dataset["a"] ** 2 * (p * over_area).sum("x")
    share = m / (1 + m) * dataset["A0"].where(_rough_model(dataset["model_used"]), 0.0)
    modulus = _surface_modulus(dataset) * _scales(dataset, "D_body")[0]
    depth = dataset["D"] - 2 * m / modulus * dataset["a"] * integral - share
    return depth.where((m == 0) | (abs(load / dataset["P"] - 1) <= LOAD_MISSED))


def _weights(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights of the points x = r/a in the integrals of p dx and of p x dx, from 0 to 1.

    They integrate a cubic spline in arcsin(x), since p is smooth in arcsin(x) up to the edge. The slope of the spline
    is 0 in the centre.
    """
    from scipy.interpolate import CubicSpline  # imported here, since it takes a while

    angle = np.arcsin(x)
    spline = CubicSpline(angle, np.eye(len(x)), bc_type=((1, np.zeros(len(x))), "not-a-knot"))
    nodes, weights = np.polynomial.legendre.leggauss(8)  # exact to rounding for a cubic times a sine of less than π/2
    half, middle = np.diff(angle)[:, None] / 2, (angle[1:] + angle[:-1])[:, None] / 2
    angles, factors = (middle + half * nodes).ravel(), (half * weights * np.cos(middle + half * nodes)).ravel()
    return factors @ spline(angles), (factors * np.sin(angles)) @ spline(angles)


def _profile(dataset: xr.Dataset, name: str) -> xr.DataArray:
    if "p" not in dataset:
        raise ValueError(f"{name} needs the profile p, which profiles = false leaves out")
    return dataset["p"]


def _surface_modulus(dataset: xr.Dataset):
    """The reduced modulus of the body that the punch touches, layer or half-space, in the unit of moduli."""
    return xr.where(is_bare(dataset["base"]), 1.0, layer_modulus(dataset.get("n", np.nan)))


def _rough_model(used: xr.DataArray) -> xr.DataArray:
    """Whether the model that was used has asperities. Then D has their A[p(0)]."""
    return used.isin([int(model) for model in Model if not model.name.startswith(("SMOOTH", "NONE"))])


def _scales(dataset: xr.Dataset, name: str) -> tuple:
    """The modulus and the radius that are 1 for the solver, in SI units: E2*, E1* on a rigid base, and R."""
    if not rule.has_units(dataset):
        return 1.0, 1.0
    if any(name not in dataset or dataset[name].attrs.get("units") != ROWS[name].unit for name in ("R", "E2", "p")):
        raise ValueError(f"{name} needs R, E2 and p in SI units, as study.solve gives them, or all without units")
    unit = reduced_modulus(dataset["E2"], dataset["nu2"])
    if np.isinf(unit).any():
        unit = xr.where(np.isinf(unit), reduced_modulus(dataset["E1"], dataset["nu1"]), unit)
    return unit, dataset["R"]


def _largest(law):
    """The law's p_max as a function of nominal pressures, the modulus of the asperities and the law's arguments."""
    return lambda p, E, *arguments: law.at(p, E, **dict(zip(law.arguments, arguments, strict=True))).p_max


@quantity("E_eff")
def effective_modulus(dataset: xr.Dataset) -> xr.DataArray:
    """Effective reduced modulus E_eff = (dP/dD)/(2a), in E2*.

    A smooth punch on a half-space has E_eff = E*. On a layer E_eff is that of a flat punch of radius a, whatever the
    shape of the smooth punch, since dP/dD at p(a) = 0 does not change with a; roughness lowers it.

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, base="half_space", micro="smooth")
    >>> print(f"{effective_modulus(contact).item():.4f}")
    1.0000
    """
    return dataset["dP_dD"] / (2 * dataset["a"])


def named(array: xr.DataArray, name: str, in_si: bool = False) -> xr.DataArray:
    """The array with a name of the vocabulary and its attributes."""
    array = array.rename(name)
    array.attrs = attributes(name, rigid="n" in array.coords and bool((array.coords["n"] == 0).any()))
    if in_si and VOCABULARY[name].powers != (0, 0):
        array.attrs = physical_attributes(VOCABULARY[name], array.attrs)
    return array
