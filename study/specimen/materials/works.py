"""Works of adhesion of a few pairs of materials, with their spreads and sources."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources

from .entries import plainly, written

__all__ = ["Pair", "pairs", "work_of_adhesion"]


@dataclass(frozen=True)
class Pair:
    """Two materials that stick together.

    Attributes
    ----------
    bodies : names of both, as in the table of materials
    w, w_spread : work of adhesion and its standard deviation, J/m²
    condition : for which state the value holds
    source : of the value
    checked : whether the value was read in the source; if not, it is quoted from memory

    Examples
    --------
    >>> pairs()[0].bodies, pairs()[0].text
    (('PDMS', 'PDMS'), '44 ± 2 mJ/m^2')
    """

    bodies: tuple[str, str]
    w: float
    w_spread: float
    condition: str
    source: str
    checked: bool

    @property
    def text(self) -> str:
        """The value as `study.solve` takes it: "44 ± 2 mJ/m^2"."""
        return f"{self.w * 1e3:g} ± {self.w_spread * 1e3:g} mJ/m^2"


@cache
def pairs() -> tuple[Pair, ...]:
    """All pairs of the table.

    Returns
    -------
    tuple of Pair

    Examples
    --------
    >>> ("PDMS", "PDMS") in [pair.bodies for pair in pairs()]
    True
    """
    rows = tomllib.loads(resources.files(__package__).joinpath("works.toml").read_text("utf-8"))["pair"]
    return tuple(Pair(**row | {"bodies": tuple(row["bodies"])}) for row in rows)


def work_of_adhesion(first: str, second: str) -> Pair:
    """The work of adhesion of two materials, in any order.

    Parameters
    ----------
    first, second : names of materials, such as "PDMS"

    Returns
    -------
    Pair

    Raises
    ------
    LookupError : the table does not have this pair

    Examples
    --------
    >>> work_of_adhesion("PMMA", "gelatin gel").text
    '105 ± 10 mJ/m^2'
    """
    wanted = sorted(map(plainly, (first, second)))
    for pair in pairs():
        if sorted(map(plainly, pair.bodies)) == wanted:
            return pair
    every_pair = "; ".join(" and ".join(pair.bodies) for pair in pairs())
    raise LookupError(f"no work of adhesion is known of {written(first)} and {written(second)}; known: {every_pair}")


def markdown() -> str:
    """The table of docs/materials.md."""
    rows = [("bodies", "$w$", "holds for", "source", "read"), ("---",) * 5]
    for pair in pairs():
        value = f"{pair.text.replace('^2', '²')}"
        rows.append((" and ".join(pair.bodies), value, pair.condition, pair.source, "yes" if pair.checked else "no"))
    return "\n".join(f"| {' | '.join(cell.replace('|', '/') for cell in row)} |" for row in rows)
