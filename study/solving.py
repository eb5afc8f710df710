"""The public function `solve`: from parameters in Python to a labelled dataset."""

from __future__ import annotations

import inspect
import time
import warnings
from collections.abc import Sequence
from typing import Any, TextIO, Unpack

import numpy as np

from .arrays import xarray_later as xr
from .data.dataset import DatasetParts, OneCase, labelled, parts, status_attributes
from .data.si import dataset_in_units, in_units
from .derivatives import sensitivities as derivatives_of
from .in_words import FarOutside, beside_rules, doubts, far_outside
from .inputs.checks import unloading
from .inputs.definition import POINTS, Definition, StudyError, from_call
from .inputs.lexicon import PACKAGE
from .inputs.punch.stresses import none_in
from .inputs.scene.hints import Parameters
from .inputs.vocabulary import NOT_RUN, VOCABULARY
from .scan_laws.words import with_rows
from .specimen.foreign import plain
from .terminal import shown
from .work.engine import solved
from .work.progress import screen_of


def solve(
    *,
    cases: list[dict] | None = None,
    x: int | Sequence[float] | np.ndarray = POINTS,
    profiles: bool | Sequence[str] = True,
    title: str = "",
    workers: int | None = None,
    same_piece: bool = False,
    correlations: dict[tuple[str, str], float] | None = None,
    progress: bool | None = None,
    chunks: dict | int | str | None = None,
    sensitivities: bool = False,
    **parameters: Unpack[Parameters],
) -> xr.Dataset:
    """Solve the contact problem on a grid and return a labelled dataset.

    Each parameter is a scalar, a 1-D sequence (which makes a dimension of that name, in the given order) or a DataArray
    with its own dimensions. Without units all is dimensionless: lengths in R, pressures in E2*, loads in E2* R². With
    R, E1, E2 or a value with a unit ("5 mm", "200 ± 10 GPa", pint, or a DataArray with an attribute `units`) the
    contact is physical: n and m follow from the moduli, and numbers without their unit are refused.

    Parameters
    ----------
    P, a, D : load, radius of the nominal contact area, indentation depth; exactly one of them
    h, n : thickness of the layer, and E1*/E2*; needed by every base but "half_space"
    m : E1*/E3* of layer and punch (E2*/E3* without a layer); 0 is a rigid punch
    nu1, nu2 : Poisson ratios of the layer and of the body under it
    Y1, Y2, Y_punch : yield strengths of layer, body and punch; by default those of the named materials. They change no
        result except `validity`
    bonding : the interface of layer and body
    base : model of the body under the punch
    layers : a stack of layers in place of h, n, nu1 and bonding, from the surface down: a list of dictionaries with h,
        one of n, E1 and material, nu, and the `bonding` of the interface below: "frictionless", "bonded" or springs,
        {"cn": ..., "ct": ...}. Graded layers have `profile` and n (E1) = [top, bottom]: docs/stacks.md. An axis is
        written `**{"layers.2.h": [...]}`, where layers count from 1
    rigid_base : whether the body under the layers is rigid; with units E2 = "rigid" says so
    Nbar, Ra : number of asperities per unit area, and the radius of an asperity; not needed by micro = "smooth"
    micro : law of the asperities, "table:" and the path of a CSV file (docs/model.md), "scan:" and the path of a scan
        whose own law is computed first (docs/roughness.md), a `ScanLaw`, or a `solver.laws.Law` itself
    B, beta : for micro = "power_law", A = B Ra (p/E1*)^beta, so B is in Ra/E1*^beta. Without both the law is fitted to
        Nbar and Ra, as in the paper
    sigma, cut : for micro = "normal_heights", the standard deviation of the heights, and the largest height above the
        mean over sigma; "uniform_heights" has sigma alone
    asperities_on : the body that asperities press on: "layer", the coated body itself; "half_space", a half-space of
        the material of the layer; "auto", the coated body if their pitch 1/sqrt(Nbar) is above h (docs/model.md)
    hardness, yield_strength : for micro = "elastic_plastic", of the asperity or of the surface under it, whichever is
        softer. One of the two is enough: the hardness is 2.84 times the yield strength. With other rough laws they only
        set `validity`
    R, E1, E2, E_punch : radius of the punch, Young's moduli of layer, body and punch; a punch without one is rigid, and
        so is a body of E2 = "rigid"
    R1, R2 : radii of two bodies, in place of R = 1/(1/R1 + 1/R2); a cup has a negative one, a flat body "flat"
    punch, layer, body : materials, or their names (docs/materials.md), in place of moduli and Poisson ratios
    nu_punch : Poisson ratio of the punch, by default 0.3
    shape : of the punch: "paraboloid", r^2/(2R); "sphere", "cone", "berkovich", "vickers", "cube_corner", "power",
        "frustum", "blunt_cone", "flat", "rounded_flat", or "table:" and the path of a CSV file of r and f
        (docs/shapes.md)
    half_angle : from the axis to the side of a cone, in degrees, or "70.3 deg"
    flat_radius, tip_radius, edge_radius : of a flat end, of the tip of a blunt cone, of a rounded edge
    tip : of a blunt cone, "paraboloid" or "sphere"
    shape_power, shape_coefficient : k and c of f/R = c (r/R)^k
    w_adhesion : work of adhesion of a smooth punch, "50 mJ/m^2"; P and D may then be 0 and negative (docs/adhesion.md)
    adhesion, sigma0, z0 : the model of adhesion, "jkr", "dmt" or "maugis"; the last one takes its stress or its range
    branch : which of two contacts under one load or at one depth: "stable", with the larger radius, or "unstable"
    k_machine : stiffness of the cantilever or machine that moves the punch; it decides when the contact breaks
    scheme, k : numerical scheme, and the relaxation of "picard"
    rtol : required relative error
    accuracy : allowed relative model error of base = "auto"
    model_check : how the model error of base = "thin_layer" is estimated
    nodes, max_iterations : of the numerical solution; 0: chosen automatically
    cases : list of dictionaries of parameters (and `label`), for cases that are no full grid: the dimension `case`,
        which comes first
    x : number of points r/a of the profiles, or the points, from 0 to 1
    profiles : whether the dataset holds p and lam, or a list of the wanted ones
    title : of the dataset
    workers : most processors that a large grid uses; 1: the calling thread alone; None: all. It changes no number
    same_piece : whether bodies of one material (`punch`, `layer`, `body` of one name) are cut from one piece, so that E
        and ν deviate equally in all of them; otherwise their spreads are independent
    correlations : pair of inputs with spreads -> their correlation, such as {("E1", "h"): 0.5}; 0 for other pairs
    progress : whether a call of more than two seconds reports its progress, in a notebook or on stderr; None: only in a
        notebook or on a terminal
    chunks : dimension -> cases in a chunk, such as {"P": 10}: the results are dask arrays. The active scheduler of dask
        solves them when their numbers are needed, one task a chunk. A dimension without an entry is one chunk. A whole
        number holds for every dimension; "auto" makes chunks of some thousand cases
    sensitivities : whether the dataset holds `a_sensitivity` and the like over `input`: d ln a/d ln input for each
        input that is a number, as `study.sensitivities` gives them
    parameters : of registered laws

    Returns
    -------
    xarray.Dataset over the dimensions of the grid and `x`. A failed case has NaN and its reason in `status`; it raises
    no error. Physical parameters give results in SI units, and `NAME_spread` if inputs have spreads: one standard
    deviation, to first order. Numerical settings with a single value are attributes. `study.summary` puts the results
    into words. Further coordinates of a DataArray, such as who measured its loads, become coordinates of the results;
    the levels of a MultiIndex lose their index, so that netCDF can hold them. A warning tells which coordinates are
    left out, which physical cases violate an assumption of the model, and which inputs must have a wrong unit. For
    rough contacts on soft layers, far outside the model, the warning comes before they are solved.

    Raises
    ------
    StudyError : a ValueError with a message for each input that cannot be used

    Examples
    --------
    >>> import study
    >>> found = study.solve(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> found.a.sel(P=2e-5).round(5).item()
    0.02466
    """
    start, workers = time.monotonic(), plain(workers)
    stream = _stream(workers, progress, chunks, sensitivities)
    _refuse_ranges(parameters)
    rows = [row for row in cases if isinstance(row, dict)] if isinstance(cases, list) else []
    if cases is not None and not (rows and len(rows) == len(cases)):
        table = ' (of a table of pandas: cases=table.to_dict("records"))' * hasattr(cases, "to_dict")
        raise StudyError([f"cases must be a list of dictionaries, at least one{table}"])
    tables = {"title": title, "output": {"x": x, "profiles": profiles}}
    definition = with_rows(from_call(parameters, rows, same_piece, tables, correlations), stream)
    for text in unloading(definition):
        warnings.warn(text, stacklevel=2)
    if far := far_outside(definition):
        warnings.warn("\n".join(far), FarOutside, stacklevel=2)
    if chunks is None:
        solved_parts = _solved_parts(definition, workers, stream, start)
        dataset = dataset_in_units(definition, solved_parts)
        dataset = dataset.assign(derivatives_of(dataset).data_vars) if sensitivities else dataset
    else:
        from .lazy import lazily  # imported here, since dask arrays take a while

        dataset = lazily(definition, plain(chunks), "study.solve")
    dataset, left_out = _with_coordinates(dataset, parameters)
    for text in left_out:
        warnings.warn(text, stacklevel=2)
    if chunks is None:
        contacts = dataset if definition.grid.sizes else OneCase(solved_parts)
        warning_lines = doubts(contacts) if definition.scene else beside_rules(contacts)
        if warning_lines:
            warnings.warn("\n".join(["this contact is beyond what the model describes:", *warning_lines]), stacklevel=2)
    return dataset


def unsolved(who: str, parameters: dict[str, Any]) -> xr.Dataset:
    """The dataset of :func:`solve` without results: contacts that are not solved. Their status is NOT_RUN.

    who : the name of the public function, for messages
    parameters : of `solve`; those about the way of solving are checked, but have no effect. An input that a contact
        must have, but on which nothing depends, may be an :class:`~.inputs.request.AnyValue`
    """
    call = solve.__kwdefaults__ | parameters
    options = {name: call.pop(name) for name in solve.__kwdefaults__}
    _stream(plain(options["workers"]), options["progress"], options["chunks"], options["sensitivities"])
    _refuse_ranges(call)
    tables = {"title": options["title"], "output": {"x": 2, "profiles": False}}
    definition = with_rows(from_call(call, [], options["same_piece"], tables, options["correlations"], who))
    unsolved_parts = labelled(definition, {"status": np.full(definition.grid.size, NOT_RUN, np.int8)}, "study.solve")
    unsolved_parts.variables["status"].attrs |= status_attributes()
    contacts, _ = _with_coordinates(
        dataset_in_units(definition, in_units(definition, unsolved_parts.settings_as_attributes())), call
    )
    return contacts


def _with_coordinates(dataset: xr.Dataset, parameters: dict[str, Any]) -> tuple[xr.Dataset, list[str]]:
    """The dataset with the coordinates of the DataArrays among the parameters, and messages about those left out."""
    if not any(hasattr(value, "dims") for value in parameters.values()):
        return dataset, []
    from .data.coordinates import with_coordinates  # here: it imports xarray, which whoever has a DataArray has

    return with_coordinates(dataset, parameters)


def _stream(workers: Any, progress: Any, chunks: Any, sensitivities: Any) -> TextIO | None:
    """The stream for reports of progress. Raises StudyError for options that are wrong or exclude each other."""
    if workers is not None and (type(workers) is not int or workers < 1):
        raise StudyError([f"workers = {shown(workers)}: must be a whole number, 1 or more"])
    stream = screen_of(plain(progress))
    if chunks is not None and (workers is not None or plain(progress)):
        raise StudyError(["chunks: dask divides the work and shows its progress: leave out workers and progress"])
    if not isinstance(sensitivities, (bool, np.bool_)) or (sensitivities and chunks is not None):
        raise StudyError([f"sensitivities = {shown(sensitivities)}: must be true or false, and false beside chunks"])
    return stream


def _refuse_ranges(parameters: dict[str, Any]) -> None:
    ranges = [name for name, value in parameters.items() if isinstance(value, dict) and {"start", "stop"} <= {*value}]
    if ranges:
        hint = "ranges are for study files; here give the values, as numpy.geomspace makes them"
        raise StudyError([f"{name}: {hint}" for name in ranges])


def solve_one(stresses: str = "", /, *, same_piece: bool = False, **parameters: Any) -> OneCase:
    """One contact, solved as by :func:`solve`, but without a dataset, and without the warnings that its summary
    repeats.

    stresses : the option, for messages, that needs stresses: a contact without them is refused before it is solved
    """
    start = time.monotonic()
    definition = from_call(parameters, [], same_piece, {"title": "", "output": {"x": POINTS, "profiles": True}})
    if stresses and (reason := none_in(definition.grid)):
        raise StudyError([f"{stresses}: {reason}"])
    definition = with_rows(definition, screen_of(None))
    if far := far_outside(definition):
        warnings.warn("\n".join(far), FarOutside, stacklevel=2)
    return OneCase(_solved_parts(definition, None, screen_of(None), start))


def _solved_parts(definition: Definition, workers: int | None, stream: TextIO | None, start: float) -> DatasetParts:
    arrays = solved(definition, workers, stream, start)
    return in_units(definition, parts(definition, arrays, "study.solve").settings_as_attributes())


def signature() -> inspect.Signature:
    """The signature of `solve` with each parameter, its choices and its default, for `help` and notebooks.

    In the code `solve` takes **parameters, since they keep the order of the call, which orders the dimensions. Without
    this signature IPython 9 completes no name of a parameter, and `help` lists 10 names instead of 44. It takes 0.3 ms.
    """
    options, inputs = inspect.signature(solve).parameters.values(), []
    for name, hint in Parameters.__annotations__.items():
        default = PACKAGE.parameter(name).default if name in VOCABULARY else None
        hint = getattr(hint, "__forward_arg__", hint)
        inputs.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=hint))
    return inspect.Signature([*inputs, *options], return_annotation="xr.Dataset")


solve.__signature__ = signature()
