"""A list of layers as flat parameters, with one name for each number of a layer, for problems, calls and study files.

The first layer, at the surface, has the names of a case with one layer, h, n, nu1 and bonding; n = 0 is a rigid base
here too. Its other numbers, and all numbers of the other layers, have names like layers.2.h, where the layers are
counted from 1.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .bases import is_exact, is_stack
from .numerics import profiles
from .parameters import FIRST, LAYER, MOST, NAME_OF_LAYER, full_name, numbers_of, row

__all__ = ["LAYER", "MOST", "expanded", "full_name", "numbers_of", "row"]

RIGID = "rigid_base"
#: Base -> its name if there is a list of layers.
_BASES = {"auto": "stack", "thin_layer": "thin_stack"}


@dataclass(frozen=True)
class LayerWords:
    """The keys that a list of layers may have, and the wording of messages about it.

    keys : the keys that a layer may have
    first : key of the first layer -> its name in a case with one layer
    conflicts : names that are refused together with a list of layers
    rigid : inputs by which a base is rigid without `rigid_base`
    example : an example of a list, for a message
    shown : function from a value to its text in a message
    hint : function from an unknown key to the end of the message about it
    arrays : whether a number may be an array, with a value for each case
    """

    keys: Collection[str]
    first: Mapping[str, str]
    conflicts: Collection[str]
    rigid: Collection[str]
    example: str
    shown: Callable[[Any], str]
    hint: Callable[[str], str]
    arrays: bool

    def name(self, number: int, key: str) -> str:
        """The name of a number of a layer: (1, "nu") gives "nu1"."""
        return full_name(number, key, self.first)

    def short(self, name: Any) -> Any:
        """The name in results: "h" for "layers.1.h", any other name as it is."""
        key = name.removeprefix("layers.1.") if isinstance(name, str) else name
        return name if key == name else self.name(1, key)

    def list_of(self, layers: Any) -> tuple[dict[str, Any], list[str]]:
        """The numbers of a list of layers by their names, and messages about mistakes in the list."""
        is_list = hasattr(layers, "__len__") and not isinstance(layers, (str, Mapping)) and len(layers)
        if not is_list or not all(isinstance(layer, Mapping) for layer in layers):
            words = "; in a terminal write layers.1.h=..., layers.2.h=... instead" * isinstance(layers, str)
            return {}, [f"layers = {self.shown(layers)}: must be a list of layers, {self.example}{words}"]
        if len(layers) > MOST:
            return {}, [_too_many(len(layers))]
        numbers, errors = {}, []
        for number, layer in enumerate(layers, 1):
            try:
                fields = fields_of(layer, number)
            except ValueError as error:
                errors.append(str(error) if str(error).startswith("layers") else f"layers.{number}: {error}")
                continue
            for key, value in fields.items():
                name = f"layers.{number}.{key}"
                if key not in self.keys:
                    errors.append(f"{name}: is not a key of a layer{self.hint(str(key))}")
                elif not self.arrays and isinstance(value, (list, tuple, range)):
                    errors.append(f"{name} has several values: an axis stands beside layers, as {self.shown(name)}")
                else:
                    numbers[self.name(number, key)] = value
        return numbers, errors

    def flat(
        self,
        parameters: dict[str, Any],
        errors: list[str],
        elsewhere: Collection[str] = (),
        listed: tuple[dict[str, Any], list[str]] | None = None,
    ) -> dict[str, Any]:
        """Parameters with one name for each number of a layer, and with the base of a stack.

        errors : messages are appended to this list
        elsewhere : names of parameters that are given elsewhere, and replace those of the list of layers
        listed : the answer of `list_of`, if the caller has it already
        """
        if not any(map(is_of_layers, (*parameters, *elsewhere))):
            return parameters
        errors += self.twice(parameters)
        named = {name: value for name, value in parameters.items() if name.startswith("layers.")}
        others = {name: v for name, v in parameters.items() if name not in ("layers", RIGID) and name not in named}
        stack = {}
        if "layers" in parameters:
            errors += self.conflicts_among(others)
            others = {name: value for name, value in others.items() if name not in self.conflicts}
            stack, wrong = listed or self.list_of(parameters["layers"])
            errors += wrong
        stack = {name: value for name, value in stack.items() if name not in elsewhere}
        stack |= {self.short(name): value for name, value in named.items()}
        stack |= self._on_base(parameters.get(RIGID, False), others | dict.fromkeys(elsewhere) | stack, errors)
        count = max(numbers_of((*stack, *elsewhere)), 1)
        if count > MOST:
            errors.append(_too_many(count))
            return others
        base = others.get("base", "stack")
        if "base" not in elsewhere and (isinstance(base, str) or not self.arrays):
            others = others | {"base": base_of_layers(base, errors)}
        return others | stack | {"sublayers": others.get("sublayers", 0)}

    def twice(self, names: Collection[str]) -> list[str]:
        """Messages about numbers of the first layer that are among the `names` under both of their names."""
        both = [(self.short(name), name) for name in names if self.short(name) != name]
        return [f"{name} is {short}, which is given too: leave out one" for short, name in both if short in names]

    def conflicts_among(self, names: Collection[str]) -> list[str]:
        """A list with a message about the first of the `names` that is refused together with a list of layers."""
        wrong = [name for name in self.conflicts if name in names]
        return [f"{name} is given beside layers: each of the layers has its own" for name in wrong[:1]]

    def _on_base(self, rigid: Any, numbers: dict[str, Any], errors: list[str]) -> dict[str, float]:
        """{"n": 0.0} on a rigid base, which must be the same for all cases; {} on any other base."""
        if not isinstance(rigid, (bool, np.bool_)):
            errors.append(f"{RIGID} = {self.shown(rigid)}: must be true or false")
        if not isinstance(rigid, (bool, np.bool_)) or not rigid:
            return {}
        if any(name in numbers for name in self.rigid):
            errors.append(f'{RIGID} is for studies without units: give E2 = "rigid"')
            return {}
        n = numbers.get("n", 1)
        if not (np.all(np.asarray(n) == 1) if self.arrays else isinstance(n, (int, float)) and n == 1):
            errors.append(f"layers.1.n = {self.shown(n)}: on a rigid base n is E_j*/E1*, and that of the first layer 1")
        return {"n": 0.0}


def is_of_layers(name: Any) -> bool:
    """Whether the name of a parameter implies a stack of layers."""
    return isinstance(name, str) and (name in ("layers", RIGID, "sublayers") or name.startswith("layers."))


def base_of_layers(base: Any, errors: list[str]) -> Any:
    """The name of a base, or of each in a list of bases, if there is a list of layers.

    errors : a message about a base with one layer is appended to this list
    """
    several = base if isinstance(base, (list, tuple)) else [base]
    if any(isinstance(word, str) and is_exact(word) and not is_stack(word) for word in several):
        errors.append('base = "layered" has one layer; several layers need base = "stack"')
    words = [_BASES.get(word, word) if isinstance(word, str) else word for word in several]
    return words if isinstance(base, (list, tuple)) else words[0]


#: The words of :meth:`solver.problem.Problem.of`.
_WORDS = LayerWords(
    keys=LAYER,
    first=FIRST,
    conflicts=tuple(FIRST.values()),
    rigid=(),
    example="each like {'h': 0.01, 'n': 2.0}",
    shown=lambda value: f"{value!r:.60}",
    hint=lambda key: f"; known: {', '.join(LAYER)}",
    arrays=True,
)


def expanded(parameters: dict[str, Any]) -> dict[str, Any]:
    """The parameters of a problem, with one name for each number in the list `layers`.

    Parameters
    ----------
    parameters : those of :meth:`solver.problem.Problem.of`. `layers` is a list of mappings, the layer at the surface
        first: h; n = E_j*/E2*; nu = 0.3; and `bonding` of the interface below, "frictionless", "bonded" or
        {"cn": ..., "ct": ...}. A graded layer has a pair, [top, bottom], for n, perhaps one for nu, and the `profile`
        "exponential" or "linear"; or, without n, "table:FILE.csv", a :class:`~solver.numerics.profiles.Profile`. With
        `rigid_base` n is E_j*/E1*. A parameter like "layers.2.h" replaces the number in the list

    Returns
    -------
    dict : the parameters without `layers` and `rigid_base`. `base` becomes "stack" if it is not given or "auto", and
        "thin_stack" if it is "thin_layer"

    Raises
    ------
    ValueError : too many layers, a key that no layer has, a number that is given in two ways, another base

    Examples
    --------
    >>> layers = [{"h": 0.01, "n": 2.0, "bonding": "bonded"}, {"h": 0.03, "n": 0.5, "bonding": "bonded"}]
    >>> expanded({"P": 1e-4, "layers": layers})["layers.2.n"]
    0.5
    """
    if not any(name in ("layers", RIGID) or name.startswith("layers.") for name in parameters):
        return parameters
    for name in parameters:
        if name.startswith("layers.") and not NAME_OF_LAYER.fullmatch(name):
            keys = ", ".join(LAYER)
            raise ValueError(f"{name}: a number of a layer is layers.NUMBER.KEY, NUMBER from 1, KEY one of {keys}")
    errors: list[str] = []
    flat = _WORDS.flat(parameters, errors)
    if errors:
        raise ValueError(errors[0])
    return flat


def fields_of(layer: Mapping, number: int) -> dict[str, Any]:
    """A layer of a list, in which springs, and the top and bottom of a graded layer, have keys of their own.

    Parameters
    ----------
    layer : as in :func:`expanded`
    number : number of the layer, for messages

    Returns
    -------
    dict : key of `LAYER`, or any other key of `layer`, which has no meaning here -> value

    Raises
    ------
    ValueError : a wrong key of springs, or a wrong pair
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
        moduli = [field for field in ("n", "E1", "material") if field in fields]
        if moduli:
            raise ValueError(f"{where}.{moduli[0]} is given beside a table of E*/E2*: the table contains it")
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


def _too_many(count: int) -> str:
    return f"layers: {count} layers: at most {MOST} are allowed"
