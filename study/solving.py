"""The public function `solve`: a grid given in Python, a labelled dataset back."""

from __future__ import annotations

import inspect
import time
import warnings
from collections.abc import Sequence
from typing import Any, TextIO, Unpack

import numpy as np

from .arrays import xarray_later as xr
from .data.coordinates import with_coordinates
from .data.dataset import DatasetParts, OneCase, labelled, parts, status_attributes
from .data.si import dataset_in_units, in_units
from .derivatives import sensitivities as derivatives_of
from .in_words import FarOutside, beside_rules, doubts, far_outside
from .inputs.checks import unloading
from .inputs.definition import POINTS, Definition, StudyError
from .inputs.lexicon import PACKAGE
from .inputs.punch.stresses import none_in
from .inputs.reading import from_call
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

    Each parameter is a scalar, a 1-D sequence (which makes a dimension of that name, in the order given) or a DataArray
    over dimensions of its own. Without units all is dimensionless: lengths in R, pressures in E2*, loads in E2* R².
    With R, E1, E2 or a text with a unit it is physical ("5 mm", "200 ± 10 GPa", pint, or a DataArray with an attribute
    `units`): n and m follow from the moduli, and what has no unit is refused.

    Parameters
    ----------
    P, a, D : load, radius of the nominal contact area, indentation depth; exactly one of them
    h, n : thickness of the layer, and E1*/E2*; needed by every base but "half_space"
    m : E1*/E3* of layer and punch (E2*/E3* without a layer); 0 is a rigid punch
    nu1, nu2 : Poisson ratios of the layer and of the body under it
    Y1, Y2, Y_punch : yield strengths of layer, body and punch, if they are known; else those of the materials that are
        named. They change no number, and set `validity`
    bonding : the interface of layer and body
    base : what lies under the punch
    layers : in place of h, n, nu1 and bonding a stack of layers, the one at the surface first: a list of dictionaries
        of h, n or E1 or material, nu, and `bonding` of the interface below, "frictionless", "bonded" or {"cn": ...,
        "ct": ...}, springs. Graded layers have `profile` and n (E1) = [top, bottom]: docs/stacks.md. An axis is
        `**{"layers.2.h": [...]}`, counted from 1
    rigid_base : whether what lies under the layers is rigid; with units E2 = "rigid" says so
    Nbar, Ra : number of asperities per unit area, and the radius of an asperity; not needed by micro = "smooth"
    micro : law of the asperities, "table:" and the path of a CSV file (docs/model.md), "scan:" and the path of a scan
        whose own law is computed first (docs/roughness.md), a `ScanLaw`, or a `solver.laws.Law` itself
    B, beta : of micro = "power_law", A = B Ra (p/E1*)^beta, so B is in Ra/E1*^beta. Without both the law is fitted to
        Nbar and Ra, as the paper's is
    sigma, cut : of micro = "normal_heights", standard deviation of the heights, and the largest above the mean over it;
        "uniform_heights" has sigma alone
    asperities_on : what asperities press on: "layer", the coated body itself; "half_space", one of the material of the
        layer; "auto", the coated body where their pitch 1/sqrt(Nbar) is above h (docs/model.md)
    hardness, yield_strength : of micro = "elastic_plastic", of the softer of asperity and what it presses on. One of
        both is enough: the hardness is then 2.84 times the yield strength. Beside
        other rough laws they set `validity`
    R, E1, E2, E_punch : radius of the punch, Young's moduli of layer, body and punch; a punch without one is rigid, and
        so is a body of E2 = "rigid"
    R1, R2 : in place of R, of two bodies: R = 1/(1/R1 + 1/R2), a cup negative, a flat body "flat"
    punch, layer, body : materials, or names of some (docs/materials.md), in place of their moduli and Poisson ratios
    nu_punch : Poisson ratio of the punch, 0.3 if not given
    shape : of the punch: "paraboloid", r^2/(2R); "sphere", "cone", "berkovich", "vickers", "cube_corner", "power",
        "frustum", "blunt_cone", "flat", "rounded_flat", or "table:" and the path of a CSV file of r and f
        (docs/shapes.md)
    half_angle : from the axis to the side of a cone, in degrees, or "70.3 deg"
    flat_radius, tip_radius, edge_radius : of a flat end, of the tip of a blunt cone, of a rounded edge
    tip : of a blunt cone, "paraboloid" or "sphere"
    shape_power, shape_coefficient : k and c of f/R = c (r/R)^k
    w_adhesion : work of adhesion of a smooth punch, "50 mJ/m^2"; P and D may then be 0 and negative (docs/adhesion.md)
    adhesion, sigma0, z0 : its model, "jkr", "dmt" or "maugis"; and of the last one its stress or its range
    branch : of two contacts under one load or at one depth the "stable", with the larger radius, or "unstable"
    k_machine : stiffness of the cantilever or machine that moves the punch; it decides when the contact comes off
    scheme, k : how it is solved, and the relaxation of "picard"
    rtol : wanted relative error
    accuracy : allowed relative model error of base = "auto"
    model_check : how the model error of base = "thin_layer" is estimated
    nodes, max_iterations : of the numerical solution; 0: chosen
    cases : list of dictionaries of parameters (and `label`): points that are not a product, the dimension `case`,
        which comes first
    x : number of points r/a of the profiles, or the points, from 0 to 1
    profiles : whether the dataset holds p and lam, or a list of those that it shall hold
    title : of the dataset
    workers : most processors that a large grid uses, with the same numbers; 1: the calling thread alone; None: all
    same_piece : whether bodies of one material (`punch`, `layer`, `body` of one name) are one piece, whose E and ν are
        off together; otherwise each is a piece of its own, and their spreads are independent
    correlations : pair of inputs with spreads -> the correlation of these, such as {("E1", "h"): 0.5}; others have none
    progress : whether a call of more than two seconds says how far it is, in a notebook or on stderr; None: in a
        notebook or on a terminal
    chunks : dimension -> cases in a chunk, such as {"P": 10}: the results are dask arrays, which are solved when they
        are asked for, by the scheduler of dask that is then active, one task a chunk. A dimension that is not there is
        one chunk. A whole number holds for every dimension; "auto" makes chunks of some thousand cases
    sensitivities : whether the dataset holds `a_sensitivity` and so on over `input`: d ln a/d ln input, of each input
        that is a number, as `study.sensitivities` gives them
    parameters : of registered laws

    Returns
    -------
    xarray.Dataset over the dimensions of the grid and `x`. A failed case has NaN and its reason in `status`; nothing
    is raised for it. Physical parameters make physical results, in SI units, and `NAME_spread` where inputs have
    spreads: one standard deviation, to first order. Numerical settings of one value are attributes. `study.summary`
    says it in words. The results also have what a DataArray brings as further coordinates, such as who measured its
    loads; the levels of a MultiIndex are coordinates without an index, which netCDF can hold. A warning tells of those
    that are left out, of physical cases that violate an assumption of the model, or that have inputs of which the unit
    must be wrong. Rough contacts on soft layers that are far outside the model are warned of before they are solved.

    Raises
    ------
    StudyError : a ValueError with every message, for input that cannot be used

    Examples
    --------
    >>> import study
    >>> found = study.solve(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> found.a.sel(P=2e-5).round(5).item()
    0.02466
    """
    begun, workers = time.monotonic(), plain(workers)
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
        made = _solved_parts(definition, workers, stream, begun)
        found = dataset_in_units(definition, made)
        found = found.assign(derivatives_of(found).data_vars) if sensitivities else found
    else:
        from .lazy import lazily  # the arrays of dask take a while to import

        found = lazily(definition, plain(chunks), "study.solve")
    found, left_out = with_coordinates(found, parameters)
    for text in left_out:
        warnings.warn(text, stacklevel=2)
    if chunks is None:
        contacts = found if definition.grid.sizes else OneCase(made)
        beyond = doubts(contacts) if definition.scene else beside_rules(contacts)
        if beyond:
            warnings.warn("\n".join(["this contact is beyond what the model describes:", *beyond]), stacklevel=2)
    return found


def unsolved(who: str, parameters: dict[str, Any]) -> xr.Dataset:
    """The contacts of inputs, which are not solved: what :func:`solve` gives, except for results. Their status is
    NOT_RUN.

    who : the name of the public function, for messages
    parameters : of `solve`; those that say how it solves are checked, and count for nothing. An input that a contact
        must have, and on which nothing depends, may be an :class:`~.inputs.request.AnyValue`
    """
    call = solve.__kwdefaults__ | parameters
    options = {name: call.pop(name) for name in solve.__kwdefaults__}
    _stream(plain(options["workers"]), options["progress"], options["chunks"], options["sensitivities"])
    _refuse_ranges(call)
    tables = {"title": options["title"], "output": {"x": 2, "profiles": False}}
    definition = with_rows(from_call(call, [], options["same_piece"], tables, options["correlations"], who))
    made = labelled(definition, {"status": np.full(definition.grid.size, NOT_RUN, np.int8)}, "study.solve")
    made.variables["status"].attrs |= status_attributes()
    contacts, _ = with_coordinates(dataset_in_units(definition, in_units(definition, made.settings_apart())), call)
    return contacts


def _stream(workers: Any, progress: Any, chunks: Any, sensitivities: Any) -> TextIO | None:
    """Where a call says how far it is. Raises StudyError for options that it cannot have, or not together."""
    if workers is not None and (type(workers) is not int or workers < 1):
        raise StudyError([f"workers = {shown(workers)}: must be a whole number, 1 or more"])
    stream = screen_of(plain(progress))
    if chunks is not None and (workers is not None or plain(progress)):
        raise StudyError(["chunks: dask divides the work and says how far it is: leave out workers and progress"])
    if not isinstance(sensitivities, (bool, np.bool_)) or (sensitivities and chunks is not None):
        raise StudyError([f"sensitivities = {shown(sensitivities)}: must be true or false, and false beside chunks"])
    return stream


def _refuse_ranges(parameters: dict[str, Any]) -> None:
    ranges = [name for name, given in parameters.items() if isinstance(given, dict) and {"start", "stop"} <= {*given}]
    if ranges:
        hint = "a range stands in study files; here give its values, as of numpy.geomspace"
        raise StudyError([f"{name}: {hint}" for name in ranges])


def solve_one(stresses: str = "", /, *, same_piece: bool = False, **parameters: Any) -> OneCase:
    """One contact, as of :func:`solve`, without a dataset, and without warnings of what its summary says.

    stresses : what asks for stresses besides, in messages: a contact that has none is refused before it is solved
    """
    begun = time.monotonic()
    definition = from_call(parameters, [], same_piece, {"title": "", "output": {"x": POINTS, "profiles": True}})
    if stresses and (reason := none_in(definition.grid)):
        raise StudyError([f"{stresses}: {reason}"])
    definition = with_rows(definition, screen_of(None))
    if far := far_outside(definition):
        warnings.warn("\n".join(far), FarOutside, stacklevel=2)
    return OneCase(_solved_parts(definition, None, screen_of(None), begun))


def _solved_parts(definition: Definition, workers: int | None, stream: TextIO | None, begun: float) -> DatasetParts:
    arrays = solved(definition, workers, stream, begun)
    return in_units(definition, parts(definition, arrays, "study.solve").settings_apart())


def signature() -> inspect.Signature:
    """The signature of `solve` with each parameter, its choices and its default, for `help` and notebooks.

    In the code `solve` takes **parameters, which keep the order of the call: it is that of the dimensions. Without this
    signature IPython 9 completes no name of a parameter, and `help` lists 10 names in place of 44. It takes 0.3 ms.
    """
    kept, named = inspect.signature(solve).parameters.values(), []
    for name, hint in Parameters.__annotations__.items():
        default = PACKAGE.parameter(name).default if name in VOCABULARY else None
        hint = getattr(hint, "__forward_arg__", hint)
        named.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=hint))
    return inspect.Signature([*named, *kept], return_annotation="xr.Dataset")


solve.__signature__ = signature()
