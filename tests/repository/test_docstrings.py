"""What `help` and editors show of every public name: its parameters, what it returns, what it raises, their types."""

import doctest
import inspect
import re
from collections.abc import Iterator
from functools import cache
from types import ModuleType

import pytest

import roughcoat
import solver


def public() -> Iterator[tuple[str, object]]:
    """Dotted name -> each public function and class, and the methods of these classes."""
    for package in (roughcoat, solver):
        yield from within(package.__name__, {name: getattr(package, name) for name in package.__all__})


def within(place: str, objects: dict) -> Iterator[tuple[str, object]]:
    for name, value in objects.items():
        full = f"{place}.{name}"
        if isinstance(value, ModuleType):
            names = getattr(value, "__all__", None) or [one for one in vars(value) if is_own(value, one)]
            yield from within(full, {one: getattr(value, one) for one in names})
        elif inspect.isfunction(value) or inspect.ismethod(value):
            yield full, value
        elif inspect.isclass(value):
            yield full, value
            yield from within(full, {one: getattr(value, one) for one in vars(value) if not one.startswith("_")})


def is_own(module: ModuleType, name: str) -> bool:
    """Whether a module without `__all__` defines a public function or class of this name itself."""
    value = getattr(module, name)
    documented = module is not roughcoat.derived or value in [*value_of_quantities(), module.quantity]
    return not name.startswith("_") and getattr(value, "__module__", "") == module.__name__ and documented


def value_of_quantities() -> list:
    return list(roughcoat.derived.QUANTITIES.values())


PUBLIC = dict(public())
FUNCTIONS = {name: value for name, value in PUBLIC.items() if not inspect.isclass(value)}
CLASSES = {name: value for name, value in PUBLIC.items() if inspect.isclass(value)}


def sections(value: object) -> dict[str, str]:
    """Heading -> text of the numpydoc sections of a docstring."""
    pieces = re.split(r"^(\w+)\n-+\n", inspect.getdoc(value) or "", flags=re.MULTILINE)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


@cache
def run_of(module: ModuleType) -> set[str]:
    """The docstrings of a module whose examples `--doctest-modules` runs."""
    return {found.docstring for found in doctest.DocTestFinder().find(module) if found.examples}


def names_in(section: str) -> list[str]:
    """The names before the colon of each entry."""
    heads = re.findall(r"^([*\w, ]+) : ", section, flags=re.MULTILINE)
    return [name for head in heads for name in head.split(", ")]


def test_there_are_many():
    assert {"roughcoat.solve", "roughcoat.Study.run", "solver.Problem.of", "solver.closed_forms.hertz"} <= set(
        FUNCTIONS
    )
    assert {"roughcoat.derived.peak_pressure", "roughcoat.roughness.Roughness.parameters"} <= set(FUNCTIONS)
    assert len(FUNCTIONS) > 60 and len(CLASSES) > 12


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_has_its_sections(name):
    value = FUNCTIONS[name]
    found = sections(value)
    parameters = [one for one in inspect.signature(value).parameters if one not in ("self", "cls")]
    assert sorted(names_in(found.get("Parameters", ""))) == sorted(parameters)
    assert found.get("Returns"), "what it returns"
    source = inspect.getsource(inspect.unwrap(value))
    assert "Raises" in found or not re.search(r"^\s+raise \w", source, flags=re.MULTILINE)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_has_its_types(name):
    signature = inspect.signature(FUNCTIONS[name])
    bare = [one.name for one in signature.parameters.values() if one.annotation is one.empty]
    assert [one for one in bare if one not in ("self", "cls")] == []
    assert signature.return_annotation is not signature.empty


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_explains_its_fields(name):
    value = CLASSES[name]
    fields = getattr(value, "__dataclass_fields__", getattr(value, "_fields", ()))
    known = names_in(re.sub(r" = [^:\n]* :", " :", sections(value).get("Attributes", "")))
    assert set(fields) <= {*known, *["parameters"] * (value is solver.Problem)} and inspect.getdoc(value)


@pytest.mark.parametrize("name", PUBLIC)
def test_a_name_has_an_example_that_is_run(name):
    value = PUBLIC[name]
    assert ">>> " in sections(value).get("Examples", ""), "an example under the heading Examples"
    assert value.__doc__ in run_of(inspect.getmodule(inspect.unwrap(value)))
