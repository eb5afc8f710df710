"""The rows of reference numbers of smooth contacts of shapes, as parameters of problems."""

import csv
from pathlib import Path

import numpy as np

REFERENCES = Path(__file__).parents[1] / "references"
SMOOTH = {"micro": "smooth"}


def rows(name):
    """The rows of a file, its numbers as numbers."""
    with open(REFERENCES / name, newline="") as file:
        return [{key: _number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text


def material(row):
    return {key: row[key] for key in ("h", "n", "nu1", "nu2", "bonding")}


def shape(row):
    """The parameters of the shape of a row; "b=0.3a" is in units of its a."""
    a, name = row["a"], row["shape"]
    if name in ("sphere", "paraboloid"):
        return {"shape": name}
    if name == "flat":
        return {"shape": name, "flat_radius": a}
    if name == "blunt_cone":
        slope = 0.35
        return {"shape": name, "tip_radius": 0.4 * a / slope, "half_angle": angle(slope)}
    numbers = dict(part.split("=") for part in str(row["parameters"]).split())
    of = {
        "cone": lambda cot: {"half_angle": angle(float(cot))},
        "power": lambda c, k: {"shape_coefficient": float(c), "shape_power": float(k)},
        "frustum": lambda b, cot: {"flat_radius": float(b[:-1]) * a, "half_angle": angle(float(cot))},
        "rounded_flat": lambda b, rho: {"flat_radius": float(b[:-1]) * a, "edge_radius": float(rho)},
    }
    return {"shape": name} | of[name](**numbers)


def angle(slope):
    """Half-angle, in degrees, of a cone of this slope."""
    return np.degrees(np.arctan2(1.0, slope))
