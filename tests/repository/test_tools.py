"""The scripts of `tools/` follow the names of the program: nothing else runs them before somebody needs one."""

import ast
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted((ROOT / "tools").rglob("*.py"))
PACKAGES = ("solver", "study", "roughcoat")


def missing_names(path: Path) -> list[str]:
    """The names that a script imports from our packages, or takes from their modules, and that are not there."""
    tree, modules, lost = ast.parse(path.read_text(encoding="utf-8")), {}, []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.split(".")[0] in PACKAGES:
                    module = importlib.import_module(alias.name)
                    modules[alias.asname or alias.name] = module
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in PACKAGES:
            module = importlib.import_module(node.module)
            for alias in node.names:
                if not hasattr(module, alias.name):
                    try:
                        importlib.import_module(f"{node.module}.{alias.name}")
                    except ImportError:
                        lost.append(f"{node.module}.{alias.name}")
                        continue
                value = getattr(module, alias.name)
                if isinstance(value, type(ast)):
                    modules[alias.asname or alias.name] = value
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and isinstance(node.ctx, ast.Load):
            module = modules.get(node.value.id)
            lost += [f"{node.value.id}.{node.attr}"] * (module is not None and not hasattr(module, node.attr))
    return lost


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_names_that_a_tool_takes_are_there(path):
    assert missing_names(path) == []


def test_a_name_that_is_gone_is_seen(tmp_path):
    script = tmp_path / "tool.py"
    script.write_text("from solver import ways, no_such_name\nfrom solver.models import named\nnamed._gone, ways.WAYS")
    assert missing_names(script) == ["solver.no_such_name", "named._gone"]
