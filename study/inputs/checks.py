"""What the inputs, or a grid, lack as a whole, though each parameter is right: defaults, and mistakes."""

from collections.abc import Callable, Collection, Iterable
from functools import partial

import numpy as np

from solver.bases import STACKS
from solver.laws import untried
from solver.parameters import one_of
from solver.scaling import dimensionless, law_of

from ..terminal import shown
from .grid import Grid, along, same_labels, twins
from .lexicon import Lexicon
from .request import OBJECTS, Request
from .vocabulary import BODIES, CONTROLS, SCENE

LOADING = 'micro = "elastic_plastic" is for loading. Spots that have yielded stay flat when the load falls, so \
these contacts do not describe unloading (docs/model.md, Microscale).'
"""The end of the sentence about loads that fall though asperities yield."""
OWNER = {"shape": "shape", "adhesion": "w_adhesion"}
"""Role of parameters -> the one without which a grid has none of this role."""
FITTED = ("B", "beta")
"""Parameters that are fitted to Nbar and Ra if the user gives neither (`laws.fitted`)."""


def fill_in(request: Request, labels: dict[str, np.ndarray]) -> None:
    """Give what is left out its default; messages for what is missing, and for dimensions on which two inputs disagree.

    labels : axes that are not among the values, as they are in SI
    """
    values, errors, lexicon = request.values, request.errors, request.lexicon
    errors += one_control(request.sections)
    arrays = {name: array for name, (dims, array) in values.items() if dims}
    errors += dimensions_that_differ(request, labels | arrays)
    parameters = lexicon.parameters_of(request.sections)
    for name in [name for name in parameters if name not in request.sections]:
        parameter = lexicon.parameter(name)  # those of a law or a shape that no case has stay away
        selector, owners, *_ = parameter.needed_by
        if name.rpartition(".")[2] in ("cn", "ct", "profile") or name == "asperities_on":
            continue
        owner = OWNER.get(lexicon.rows[name].role)
        if owner and owner not in request.sections:
            continue
        words = values.get(selector, ((), ""))[1]  # "": micro has been refused
        if parameter.default is not None and (selector not in OBJECTS or np.any([words == word for word in owners])):
            values[name] = (), np.array(parameter.default)
    names = {*request.sections, *["n"] * request.physical}  # n follows from moduli
    names |= {name for name in parameters if request.physical and name.endswith(".n")}
    words = {name: array for name, (_, array) in values.items()}
    errors += missing_everywhere(lexicon, names, lambda name: words.get(name, ()), errors)
    if not errors:
        rows = [repr(sorted(((k, v) for k, v in row.items() if k != "label"), key=str)) for row in request.rows]
        errors += equal_cases(rows)


def missing_everywhere(
    lexicon: Lexicon, names: Collection[str], texts_of: Callable[[str], Iterable], errors: list[str]
) -> list[str]:
    """Messages for parameters without a default that some case needs but no input gives.

    names : of the parameters that the user gives
    texts_of : a function: name of a parameter such as base -> its values
    errors : messages so far. One about an unknown name or section, or about layers, may be about the missing
        parameter: then there are no messages
    """
    messages = []
    if any(text in error for error in errors for text in ("is not a parameter", "is not a section", "layers")):
        return []
    stacked = [word for word in STACKS if word in texts_of("base")]
    if stacked and "h" not in names and not any(name.startswith("layers.") and name.endswith(".h") for name in names):
        return [f"layers are missing: base = {shown(stacked[0])} needs them"]
    neither = not {*FITTED} & {*names}  # if neither is given, both are fitted, and one message is about both
    for name in lexicon.parameters_of(names):
        parameter = lexicon.parameter(name)
        selector, words, *_ = parameter.needed_by
        needed = parameter.default is None and parameter.instead != ""
        if {name, parameter.instead} & {*names} or name in CONTROLS or not needed:
            continue
        values = texts_of(selector)
        users = " or ".join(shown(word) for word in words if word in values)
        if name in FITTED and neither:
            if users and name == FITTED[0] and not {"Nbar", "Ra"} <= {*names}:
                messages.append("B and beta may be given; if neither is, they are fitted to Nbar and Ra")
        elif users:
            either = f" or {parameter.instead}" * bool(parameter.instead)
            messages.append(f"{name}{either} is missing: {selector} = {users} needs it")
    sticks = ", which w_adhesion wants" * ("w_adhesion" in names)
    if messages and "micro = " in messages[-1] and (sticks or "micro" not in names):
        messages[-1] += f' (without asperities: micro = "smooth"{sticks})'
    return messages


def one_control(names: Collection[str]) -> list[str]:
    """A message if none of P, a and D is among the names of the parameters, or several are."""
    controls = [name for name in CONTROLS if name in names]
    return [f"exactly one of P, a, D must be given, not {' and '.join(controls) or 'none'}"] * (len(controls) != 1)


def equal_cases(cases: list) -> list[str]:
    """A message for two of the cases that are the same."""
    return [f"cases {i} and {j} are the same" for i, j in twins(cases)]


def dimensions_that_differ(request: Request, values: dict[str, np.ndarray]) -> list[str]:
    """Messages for dimensions whose name is taken, and for inputs that disagree on the length or coordinate of one.

    values : of axes without units, and names of materials. An input over the dimension of its own name is the
        coordinate of that dimension
    """
    inputs = {name: entry for name, entry in request.inputs.items() if not entry.is_wrong}
    arrays = {name: entry for name, entry in inputs.items() if entry.array is not None}
    messages = dict.fromkeys(text for name in arrays for text in _taken(request, name))
    axes = {name: entry for name, entry in inputs.items() if entry.dims in ((name,), ("case",))}
    lengths = {entry.dims[0]: (name, len(entry.values)) for name, entry in axes.items() if entry.array is None}
    labels = {name: (name, values.get(name, entry.array)) for name, entry in axes.items() if entry.dims == (name,)}
    labels = {name: (name, np.asarray(values)) for name, (_, values) in labels.items() if values is not None}
    for name, entry in arrays.items():
        if entry.dims == (name,) and name in entry.array.coords:
            labels[name] = name, entry.array.coords[name].values
    for name, entry in arrays.items():
        for dim, length in zip(entry.dims, entry.shape, strict=True):
            other, expected = lengths.setdefault(dim, (name, length))
            coordinate = entry.array.coords[dim].values if dim in entry.array.coords else None
            if length == 0:
                messages[f"{name} is empty: must have at least one value"] = None
            elif length != expected:
                messages[f"{name} has {length} values along {dim}, {other} has {expected}"] = None
            elif coordinate is not None:
                other, expected = labels.setdefault(dim, (name, coordinate))
                if not same_labels(expected, coordinate):
                    messages[f"{name} has other values of {dim}, or in another order, than {other}"] = None
    return list(messages)


def _taken(request: Request, name: str) -> list[str]:
    """Messages for dimensions of a DataArray whose name is already taken."""
    messages, rows = [], request.lexicon.all_rows
    for dim in request.inputs[name].dims:
        owner = request.inputs.get(dim)
        in_scene = dim in SCENE or dim in BODIES
        if in_scene and not request.physical:  # a study without units has no such parameter
            continue
        parameter = dim in request.lexicon.parameters or in_scene
        in_units = request.physical and dim in rows and rows[dim].unit != "1"
        if parameter and dim not in request.sections:
            messages.append(f"the dimension {dim} has the name of a parameter that is not given: rename it")
        elif owner and owner.dims != (dim,):
            messages.append(f"{dim} is a dimension and a parameter over other dimensions")
        elif owner and in_units and owner.array is None:
            way_out = "unless that is a DataArray over itself"
            messages.append(f'{name}: a dimension cannot be called "{dim}" here, {way_out}')
        elif not parameter and dim in request.lexicon.rows and dim != "case":
            messages.append(f'a dimension cannot be called "{dim}", which is the name of a result')
    return messages


def missing_in_cases(grid: Grid) -> list[str]:
    """Messages for parameters that a case needs and lacks, though other cases have them."""
    messages = []
    for name in grid.lexicon.parameters_of(grid.values):
        parameter = grid.lexicon.parameter(name)
        if not {name, parameter.instead} & {*grid.values}:
            continue
        gaps = np.isnan(along(grid, name)) if parameter.default is None and parameter.instead != "" else np.False_
        gaps = gaps & np.isnan(along(grid, parameter.instead)) if parameter.instead else gaps
        gaps = gaps & grid.lexicon.cases_with(name, partial(along, grid)) if gaps.any() else gaps
        if gaps.any():
            selector, words, *_ = parameter.needed_by
            case = np.argwhere(gaps)[0][list(grid.sizes).index("case")]
            users = " or ".join(shown(word) for word in words if word in along(grid, selector))
            reason = f": {selector} = {users} needs it" if users else ""
            either = f" or {parameter.instead}" * bool(parameter.instead)
            messages.append(f"{name}{either} is missing in case {case}{reason}")
    return messages


def mixed_units(grid: Grid) -> list[str]:
    """A message if layers on a rigid base, whose numbers are in E1*, are among others, whose numbers are in E2*."""
    n, layered = np.broadcast_arrays(along(grid, "n"), grid.lexicon.cases_with("n", partial(along, grid)))
    if not (n == 0).any() or not (n[layered] > 0).any():
        return []
    return [
        "n = 0, a rigid base, is among other values: its numbers are in E1*, theirs in E2*. Make two studies, or give "
        'physical values (R, E1, E2 = "rigid", ... with units)'
    ]


def picard_for_nothing(grid: Grid) -> list[str]:
    """A message if all cases with the scheme "picard" are smooth: it solves rough cases only.

    If the grid also has it for rough cases, the status of each smooth case refuses it.
    """
    by_picard, smooth = along(grid, "scheme") == "picard", grid.lexicon.smooth_laws()
    if not by_picard.any() or (by_picard & ~one_of(along(grid, "micro"), smooth)).any():
        return []
    others = " or ".join(shown(name) for name in grid.lexicon.known.laws if name not in smooth)
    names = " or ".join(map(shown, smooth))
    return [f'scheme = "picard" has no case to solve: micro must be {others} there, not {names}']


def heights_that_yield(grid: Grid) -> list[str]:
    """A message if sigma or cut is given together with asperities that yield, and no other case uses it."""
    micro = along(grid, "micro")
    heights = [name for name in ("sigma", "cut") if name in grid.values]
    if not heights or not (micro == "elastic_plastic").any():
        return []
    if grid.lexicon.cases_with(heights[0], partial(along, grid)).any():
        return []
    laws = " or ".join(map(shown, grid.lexicon.parameter(heights[0]).needed_by[1]))
    text = "asperities that yield have one height; random heights, elastic, are micro ="
    return [f'{heights[0]} is given with micro = "elastic_plastic": {text} {laws}']


def unloading(definition) -> list[str]:
    """A sentence if asperities that yield have an axis of loads, radii or depths that falls somewhere."""
    grid = definition.grid
    if not (along(grid, "micro") == "elastic_plastic").any():
        return []
    arrays = definition.scene.values if definition.scene else {name: array for name, (_, array) in grid.values.items()}
    axes = [name for name in CONTROLS if name in definition.in_results(grid.sizes).keys() & {*arrays}]
    values = {name: np.asarray(arrays[name]) for name in axes}
    falls = [name for name, array in values.items() if (np.diff(array.reshape(len(array), -1)[:, 0]) < 0).any()]
    return [f"{name} falls along its axis: {LOADING}" for name in falls]


def slips_of_laws(grid: Grid) -> list[str]:
    """Messages for micro laws of users that fail at a few cases of the grid, where they are tried."""
    messages, (dims, micro), known = [], grid.values["micro"], grid.lexicon.known
    for word in sorted(word for word in set(micro.ravel().tolist()) if untried(known.laws[word])):
        places = np.argwhere(micro == word)
        indices = {dim: places[np.linspace(0, len(places) - 1, 3).astype(int), axis] for axis, dim in enumerate(dims)}
        indices = {dim: indices.get(dim, np.linspace(0, size - 1, 3).astype(int)) for dim, size in grid.sizes.items()}
        cases = {name: array[tuple(indices[dim] for dim in over)] for name, (over, array) in grid.values.items()}
        try:
            law_of(dimensionless(grid.lexicon.problem(cases)))
        except ValueError as error:
            messages.append(str(error))
    return messages
