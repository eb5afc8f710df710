"""Rows of tests/fields/references, and the pressures that they are of."""

from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parents[1] / "fields" / "references"
#: By `shape`.
SHAPES = (lambda x: np.sqrt(1 - x**2), lambda x: np.sqrt(1 - x**2) ** 3)


def table(name: str) -> np.ndarray:
    """A file of references, as an array with names."""
    return np.genfromtxt(FOLDER / f"{name}.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")


def body_of(row: np.void) -> dict:
    """The arguments of `of_pressure` of a row. A rigid body has no nu2: any will do."""
    nu2 = row["nu2"] if np.isfinite(row["nu2"]) else 0.3
    bonding = "bonded" if row["bonded"] else "frictionless"
    return {"h": row["h"], "n": row["n"], "nu1": row["nu1"], "nu2": nu2, "bonding": bonding}
