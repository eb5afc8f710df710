"""What can be wrong with inputs, or a grid, as a whole, though each parameter is right."""

from collections.abc import Callable, Collection, Iterable
from functools import partial

import numpy as np

from solver import Problem
from solver.laws import LAWS, untried
from solver.scaling import dimensionless, law_of

from ..terminal import shown
from .given import Given
from .grid import Grid, along, same_labels, twins
from .laws import smooth_laws
from .vocabulary import BODIES, CONTROLS, PARAMETERS, ROWS, SCENE, VOCABULARY, cases_with

LOADING = 'micro = "elastic_plastic" is for loading. Spots that have yielded stay flat when the load falls, so that \
these contacts are no unloading (docs/model.md, Microscale).'
"""What is said of loads that fall though asperities yield."""
FITTED = ("B", "beta")
"""Parameters that are fitted to Nbar and Ra where neither is given (`fitted.py`)."""


def not_given(names: Collection[str], texts: Callable[[str], Iterable], errors: list[str]) -> list[str]:
    """Messages for parameters without a default that are not given, though some case needs them.

    names : of those that are given; texts : a function, name of a parameter such as base -> its values
    errors : found before. If one is of an unknown name or section, the missing parameter may be there: no messages then
    """
    messages = []
    if any("is not a parameter" in error or "is not a section" in error for error in errors):
        return []
    neither = not {*FITTED} & {*names}  # is given: then both are fitted, and it is said once to what
    for name in PARAMETERS:
        parameter = VOCABULARY[name].own
        selector, words, *_ = parameter.needed_by
        needed = parameter.default is None and parameter.instead != ""
        if {name, parameter.instead} & {*names} or name in CONTROLS or not needed:
            continue
        values = texts(selector)
        users = " or ".join(shown(word) for word in words if word in values)
        if name in FITTED and neither:
            if users and name == FITTED[0] and not {"Nbar", "Ra"} <= {*names}:
                messages.append("B and beta may be given; if neither is, they are fitted to Nbar and Ra")
        elif users:
            either = f" or {parameter.instead}" * bool(parameter.instead)
            messages.append(f"{name}{either} is missing: {selector} = {users} needs it")
    if messages and "micro = " in messages[-1] and "micro" not in names:
        messages[-1] += ' (without asperities: micro = "smooth")'
    return messages


def one_control(names: Collection[str]) -> list[str]:
    """A message if the names of the parameters have none of P, a and D, or several."""
    controls = [name for name in CONTROLS if name in names]
    return [f"exactly one of P, a, D must be given, not {' and '.join(controls) or 'none'}"] * (len(controls) != 1)


def equal_cases(cases: list) -> list[str]:
    """A message for two of the cases that are the same."""
    return [f"cases {i} and {j} are the same" for i, j in twins(cases)]


def dimensions_that_differ(given: Given, values: dict[str, np.ndarray]) -> list[str]:
    """Messages for dimensions whose name is taken, and for inputs that have other lengths or coordinates along one.

    values : of axes without units, and names of materials; along a dimension called like it an input is the coordinate
    """
    inputs = {name: entry for name, entry in given.inputs.items() if not entry.is_wrong}
    arrays = {name: entry for name, entry in inputs.items() if entry.array is not None}
    messages = dict.fromkeys(text for name in arrays for text in _taken(given, name))
    itself = {name: entry for name, entry in inputs.items() if entry.dims in ((name,), ("case",))}
    lengths = {entry.dims[0]: (name, len(entry.values)) for name, entry in itself.items() if entry.array is None}
    labels = {name: (name, values.get(name, entry.array)) for name, entry in itself.items() if entry.dims == (name,)}
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


def _taken(given: Given, name: str) -> list[str]:
    """Messages for dimensions of a DataArray whose name is that of something else."""
    said = []
    for dim in given.inputs[name].dims:
        owner = given.inputs.get(dim)
        of_scene = dim in SCENE or dim in BODIES
        if of_scene and not given.physical:  # a study without units has no such parameter
            continue
        parameter = dim in PARAMETERS or of_scene
        of_units = given.physical and dim in ROWS and ROWS[dim].unit != "1"
        if parameter and dim not in given.sections:
            said.append(f"the dimension {dim} is called like a parameter that is not given: rename it")
        elif owner and owner.dims != (dim,):
            said.append(f"{dim} is a dimension and a parameter over other dimensions")
        elif owner and of_units and owner.array is None:
            said.append(f'{name}: a dimension cannot be called "{dim}" here, unless that is a DataArray over itself')
        elif not parameter and dim in VOCABULARY and dim != "case":
            said.append(f'a dimension cannot be called "{dim}", which is the name of a result')
    return said


def missing_parameters(grid: Grid) -> list[str]:
    """Messages for parameters that are given, but not in some case that needs them."""
    messages = []
    for name in (name for name in PARAMETERS if {name, VOCABULARY[name].own.instead} & {*grid.values}):
        own = VOCABULARY[name].own
        gaps = np.isnan(along(grid, name)) if own.default is None and own.instead != "" else np.False_
        gaps = gaps & np.isnan(along(grid, own.instead)) if own.instead else gaps
        gaps = gaps & cases_with(name, partial(along, grid)) if gaps.any() else gaps
        if gaps.any():
            selector, words, *_ = own.needed_by
            case = np.argwhere(gaps)[0][list(grid.sizes).index("case")]
            users = " or ".join(shown(word) for word in words if word in along(grid, selector))
            reason = f": {selector} = {users} needs it" if users else ""
            messages.append(f"{name}{f' or {own.instead}' * bool(own.instead)} is missing in case {case}{reason}")
    return messages


def mixed_units(grid: Grid) -> list[str]:
    """A message if layers on a rigid base, whose numbers are in E1*, are among others, whose numbers are in E2*."""
    n, layered = np.broadcast_arrays(along(grid, "n"), cases_with("n", partial(along, grid)))
    if not (n == 0).any() or not (n[layered] > 0).any():
        return []
    return [
        "n = 0, a rigid base, is among others: its numbers are in E1*, theirs in E2*. Make two studies, or give "
        'physical values (R, E1, E2 = "rigid", ... with units)'
    ]


def picard_for_nothing(grid: Grid) -> list[str]:
    """A message if all cases with the scheme "picard" are smooth: it solves rough cases only.

    In a grid that has it for rough cases too, each smooth case is refused by its status.
    """
    asked, smooth = along(grid, "scheme") == "picard", smooth_laws()
    if not asked.any() or (asked & ~np.isin(along(grid, "micro"), smooth)).any():
        return []
    others = " or ".join(shown(name) for name in VOCABULARY["micro"].own.choices if name not in smooth)
    names = " or ".join(map(shown, smooth))
    return [f'scheme = "picard" has no case to solve: micro must be {others} there, not {names}']


def heights_that_yield(grid: Grid) -> list[str]:
    """A message if heights are given for asperities that yield, and no other case has a use for them."""
    micro = along(grid, "micro")
    heights = [name for name in ("sigma", "cut") if name in grid.values]
    if not heights or not (micro == "elastic_plastic").any() or cases_with(heights[0], partial(along, grid)).any():
        return []
    of_heights = " or ".join(map(shown, VOCABULARY[heights[0]].own.needed_by[1]))
    text = "asperities that yield have one height; random heights, elastic, are micro ="
    return [f'{heights[0]} is given with micro = "elastic_plastic": {text} {of_heights}']


def unloading(definition) -> list[str]:
    """A sentence if asperities that yield have an axis of loads, radii or depths that falls somewhere."""
    grid = definition.grid
    if not (along(grid, "micro") == "elastic_plastic").any():
        return []
    given = definition.scene.given if definition.scene else {name: array for name, (_, array) in grid.values.items()}
    axes = [name for name in CONTROLS if name in definition.in_results(grid.sizes).keys() & {*given}]
    values = {name: np.asarray(given[name]) for name in axes}
    falls = [name for name, array in values.items() if (np.diff(array.reshape(len(array), -1)[:, 0]) < 0).any()]
    return [f"{name} falls along its axis: {LOADING}" for name in falls]


def slips_of_laws(grid: Grid) -> list[str]:
    """Messages for micro laws of somebody else's that fail when they are tried at a few cases of the grid."""
    messages, (dims, micro) = [], grid.values["micro"]
    for word in sorted(word for word in set(micro.ravel().tolist()) if untried(LAWS[word])):
        having = np.argwhere(micro == word)
        few = {dim: having[np.linspace(0, len(having) - 1, 3).astype(int), axis] for axis, dim in enumerate(dims)}
        few = {dim: few.get(dim, np.linspace(0, size - 1, 3).astype(int)) for dim, size in grid.sizes.items()}
        cases = {name: array[tuple(few[dim] for dim in over)] for name, (over, array) in grid.values.items()}
        try:
            law_of(dimensionless(Problem.of(**cases)))
        except ValueError as error:
            messages.append(str(error))
    return messages
