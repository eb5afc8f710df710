"""Names in the code: one name for one thing, and nouns for what they stand for."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from conftest import ROOT

#: Participles and adverbs that say what was done to a thing, or where it is, and not what it is.
VAGUE = {
    *("again", "apart", "asked", "beside", "beyond", "carried", "early", "found", "given", "held", "kept", "made"),
    *("known", "said"),
}
#: The class Known of solver/known has an object by this name wherever its methods are; elsewhere the word says nothing.
OF_KNOWN = {"known"}


def files(*tops: str) -> list[Path]:
    return sorted(path for top in tops for path in (ROOT / top).rglob("*.py"))


@cache
def bound(path: Path) -> list[tuple[str, int, type]]:
    """(name, line, kind of node) of each name that a file binds: modules, classes, functions, arguments, variables."""
    return [(path.stem, 0, ast.Module), *names_in(ast.parse(path.read_text(encoding="utf-8")))]


def names_in(tree: ast.AST) -> Iterator[tuple[str, int, type]]:
    for node in ast.walk(tree):
        match node:
            case ast.ClassDef(name=name) | ast.FunctionDef(name=name) | ast.arg(arg=name):
                yield name, node.lineno, type(node)
            case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
                yield name, node.lineno, type(node)
            case ast.alias(asname=str(name)):
                yield name, node.lineno, type(node)


def vague(path: Path) -> list[str]:
    text = path.read_text(encoding="utf-8")
    allowed = OF_KNOWN if "Known" in text or "lexicon" in text else set()
    of_file = path.relative_to(ROOT).as_posix()
    words = VAGUE - allowed
    return [f"{of_file}:{line} {name}" for name, line, _ in bound(path) if name.strip("_").lower() in words]


def test_names_are_nouns():
    """A reader sees at the use of a name what it is: `pressures`, not `found`."""
    tree = ast.parse("def found(kept): made = self.asked = kept\nfrom a import b as said\nfor _known in kept: pass")
    assert [name for name, *_ in names_in(tree)] == ["found", "said", "_known", "kept", "made", "asked"]
    assert [line for path in files("roughcoat", "solver", "study", "studies", "tools") for line in vague(path)] == []


def test_classes_have_names_of_their_own():
    """So that one name is one thing in the whole tree."""
    homes: dict[str, list[str]] = {}
    for path in files("solver", "study"):
        for name, _, kind in bound(path):
            if kind is ast.ClassDef:
                homes.setdefault(name, []).append(path.relative_to(ROOT).as_posix())
    assert {word: paths for word, paths in homes.items() if len(paths) > 1} == {}
