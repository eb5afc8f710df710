"""The layers of a stack: their names in the table of parameters, and a list of layers as such parameters.

The first layer, at the surface, is the one of a case with one layer: h, n, nu1 and bonding are its numbers, and n = 0
is a rigid base here too. What it has besides, and all of the others, is called layers.2.h, counted from 1.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from .bases import is_exact, is_stack
from .numerics import profiles
from .parameters import FIRST, LAYER, MOST, full_name, numbers_of, row
from .parameters import NAME_OF_LAYER as _NAME

__all__ = ["LAYER", "MOST", "expanded", "full_name", "numbers_of", "row"]


def expanded(parameters: dict[str, Any]) -> dict[str, Any]:
    """Parameters of a problem with a list `layers` in one name for each number.

    Parameters
    ----------
    parameters : of :meth:`solver.problem.Problem.of`. `layers` is a list of mappings, the layer at the surface first:
        h, n = E_j*/E2*, nu = 0.3, `bonding` of the interface below, "frictionless", "bonded" or {"cn": ..., "ct": ...}.
        Of a graded layer n is a pair, top and bottom, nu may be one, and `profile` is "exponential" or "linear"; or,
        without n, "table:FILE.csv", a :class:`~solver.numerics.profiles.Profile`. With `rigid_base` n is E_j*/E1*. A
        parameter like "layers.2.h" takes the place of what the list says

    Returns
    -------
    dict : the parameters without `layers` and `rigid_base`. `base` becomes "stack" where it is left out or "auto", and
        "thin_stack" where it is "thin_layer"

    Raises
    ------
    ValueError : too many layers, a key that no layer has, a number that is given in two ways, another base

    Examples
    --------
    >>> layers = [{"h": 0.01, "n": 2.0, "bonding": "bonded"}, {"h": 0.03, "n": 0.5, "bonding": "bonded"}]
    >>> expanded({"P": 1e-4, "layers": layers})["layers.2.n"]
    0.5
    """
    named = {name: value for name, value in parameters.items() if name.startswith("layers.")}
    parameters = {"sublayers": 0} | parameters if named or "layers" in parameters else parameters
    if "layers" not in parameters and "rigid_base" not in parameters and not named:
        return parameters
    others = {name: v for name, v in parameters.items() if name not in ("layers", "rigid_base") and name not in named}
    beside = [name for name in FIRST.values() if name in others]
    if beside and "layers" in parameters:
        raise ValueError(f"{beside[0]} is given beside layers: each of the layers has its own")
    stack = _of_list(parameters.get("layers", [])) | {_short(name): value for name, value in named.items()}
    count = numbers_of(f"layers.{name}" if name[0].isdigit() else name for name in named) or 1
    count = max(count, len(parameters.get("layers", [])))
    if count > MOST:
        raise ValueError(f"layers: {count} layers: at most {MOST}")
    return _with_base(others) | _on_base(stack, parameters.get("rigid_base", False))


def _short(name):
    """ "layers.1.h" as "h", all others as they are. ValueError for a name that no layer has."""
    match = _NAME.fullmatch(name)
    if not match:
        raise ValueError(
            f"{name}: a number of a layer is layers.NUMBER.KEY, NUMBER from 1, KEY one of {', '.join(LAYER)}"
        )
    return full_name(int(match[1]), match[2])


def _of_list(layers):
    if isinstance(layers, (str, Mapping)) or not hasattr(layers, "__len__"):
        raise ValueError(f"layers = {layers!r:.60}: must be a list of layers, each like {{'h': 0.01, 'n': 2.0}}")
    if len(layers) > MOST:
        raise ValueError(f"layers: {len(layers)} layers: at most {MOST}")
    stack = {}
    for number, layer in enumerate(layers, 1):
        if not isinstance(layer, Mapping):
            raise ValueError(f"layers[{number}] = {layer!r:.60}: must be like {{'h': 0.01, 'n': 2.0}}")
        stack |= {full_name(number, field): value for field, value in fields_of(layer, number).items()}
    return stack


def fields_of(layer: Mapping, number: int) -> dict[str, Any]:
    """A layer of a list with its springs, and top and bottom of a graded one, as keys of their own.

    Parameters
    ----------
    layer : as in :func:`expanded`
    number : of the layer, for messages

    Returns
    -------
    dict : key of `LAYER`, or another one of `layer` that has no meaning here -> value

    Raises
    ------
    ValueError : a key of springs, or a pair, that is not right
    """
    fields = dict(layer)
    where = f"layers.{number}"
    if isinstance(fields.get("bonding"), Mapping):
        springs = fields.pop("bonding")
        wrong = sorted({*springs} - {"cn", "ct"})
        if wrong or not springs:
            raise ValueError(
                f"{where}.bonding = {dict(springs)!r:.60}: springs have cn and ct, a length over a pressure"
            )
        fields |= {"bonding": "bonded", **springs}
    profile = fields.get("profile", "uniform")
    if isinstance(profile, str) and profile.startswith(profiles.PREFIX):
        own = [field for field in ("n", "E1", "material") if field in fields]
        if own:
            raise ValueError(f"{where}.{own[0]} is given beside a table of E*/E2*: the table says it")
        return fields | {"n": float(profiles.read(profile).n[0])}
    graded = profile != "uniform"
    for field in ("n", "nu", "E1") if graded else ():
        pair = fields.get(field)
        if isinstance(pair, (list, tuple)):
            if len(pair) != 2:
                raise ValueError(f"{where}.{field} = {pair!r:.60}: of a graded layer must be [top, bottom]")
            fields[field], fields[f"{field}_bottom"] = pair
        elif profile in profiles.GRADED and field in fields and field != "nu":
            raise ValueError(f"{where}.{field} = {pair!r:.60}: of a graded layer must be [top, bottom]")
    return fields


def _with_base(others):
    words = {"auto": "stack", "thin_layer": "thin_stack"}
    base = others.get("base", "stack")
    if isinstance(base, str):
        others = others | {"base": words.get(base, base)}
        if is_exact(base) and not is_stack(base):
            raise ValueError('base = "layered" has one layer: layers are for base = "stack"')
    return others


def _on_base(stack, rigid):
    """The parameters with n = 0 where the base is rigid, which must be one for all cases."""
    if isinstance(rigid, str) or np.ndim(rigid) or rigid not in (False, True):
        raise ValueError(f"rigid_base = {rigid!r:.60}: must be true or false, for all cases alike")
    if not rigid:
        return stack
    if "n" in stack and not np.all(np.asarray(stack["n"]) == 1):
        raise ValueError(f"layers.1.n = {stack['n']}: on a rigid base n is E_j*/E1*, so that of the first layer is 1")
    return stack | {"n": 0.0}
