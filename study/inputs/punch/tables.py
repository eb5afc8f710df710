"""Tables of micro laws in studies: tables whose A is a length, and tables that hold on a single body."""

from typing import Any

import numpy as np

from solver.bases import is_bare
from solver.laws import Law, own_table

from ...terminal import shown
from ..grid import Grid, along
from ..lexicon import Lexicon

#: Numbers of a body count as equal if they differ by a smaller share: moduli and their ratios round differently.
_SAME = 1e-6
_WAY_OUT = "compute the law on the body of the contact, rc.roughness.law(scan, on=...)"


def in_metres(words: Any, lexicon: Lexicon) -> bool:
    """Whether some word of `micro` is a table whose A is a length."""
    there = {name for name, law in lexicon.known.laws.items() if own_table.in_metres(law)}
    return bool(there) and not there.isdisjoint(np.unique(np.asarray(words).astype(str)).tolist())


def mistakes(grid: Grid, physical: bool) -> list[str]:
    """Messages about tables with lengths in a call without units, and about contacts on a body that is not the body of
    a scan's law."""
    laws = grid.lexicon.known.laws
    names = [name for name, law in laws.items() if own_table.in_metres(law)] if "micro" in grid.values else []
    if not names:
        return []
    micro = along(grid, "micro")
    names = [name for name in names if (micro == name).any()]
    if names and not physical:
        example = 'R = "5 mm", E2 = "200 GPa"'
        return [f"micro = {shown(names[0])}: A is a length: give the other inputs with units too ({example})"]
    return [text for name in names if laws[name].body for text in _on_another_body(grid, laws[name], micro == name)]


def _on_another_body(grid: Grid, law: Law, cases: np.ndarray) -> list[str]:
    """At most one message, if some of the `cases` of the law are not on the law's body."""
    assert law.body is not None
    if (is_bare(along(grid, "base")) & cases).any():
        return [f"micro = {shown(law.name)}: is the law of a scan on a coated body, not a half-space: {_WAY_OUT}"]
    for name, value in law.body.items():
        unit = "m" if name in grid.lexicon.rows and grid.lexicon.rows[name].powers == (0, 1) else ""
        if name not in grid.values:
            there, differs = np.array("none"), np.array(True)
        elif isinstance(value, str):
            there = along(grid, name)
            differs = there != value
        else:
            there = along(grid, name) / (along(grid, own_table.LAW_UNIT) if unit else 1.0)
            differs = ~np.isclose(there, value, rtol=_SAME, atol=0)
        if (wrong := differs & cases).any():
            other = np.broadcast_to(there, wrong.shape)[wrong][0]
            is_of = f"{name} = {_text(value, unit)}, not {_text(other, unit)}"
            return [f"micro = {shown(law.name)}: is the law of a scan on a body with {is_of}: {_WAY_OUT}"]
    return []


def _text(value: Any, unit: str) -> str:
    return shown(str(value)) if isinstance(value, str) else f"{value:.6g} {unit}".strip()
