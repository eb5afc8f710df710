"""Cases of smooth punches of all shapes, and with adhesion, for tests of keys."""

from study.inputs.definition import Definition
from study.inputs.reading import from_tables

CONE, FLAT = {"shape": "cone", "half_angle": 70.0}, {"shape": "flat", "flat_radius": 0.1}
BLUNT = {"shape": "blunt_cone", "half_angle": 70.0, "tip_radius": 0.1}
ROUND = {"shape": "rounded_flat", "flat_radius": 0.1, "edge_radius": 0.1}
POWER = {"shape": "power", "shape_power": 4.0, "shape_coefficient": 1.0}
STICKS = {"w_adhesion": 1e-6}
PUNCH = {  # allowed values of what describes a shape or adhesion, and the rest of the case, which is smooth
    "shape": (CONE, ("cone", "frustum")),
    "half_angle": (CONE, (70.0, 71.0)),
    "flat_radius": (FLAT, (0.1, 0.2)),
    "tip_radius": (BLUNT, (0.1, 0.2)),
    "tip": (BLUNT, ("paraboloid", "sphere")),
    "edge_radius": (ROUND, (0.1, 0.2)),
    "shape_power": (POWER, (4.0, 3.0)),
    "shape_coefficient": (POWER, (1.0, 2.0)),
    "w_adhesion": (STICKS, (1e-6, 2e-6)),
    "adhesion": (STICKS, ("jkr", "dmt")),
    "sigma0": (STICKS | {"adhesion": "maugis"}, (1e-3, 2e-3)),
    "z0": (STICKS | {"adhesion": "maugis"}, (1e-3, 2e-3)),
    "branch": (STICKS, ("stable", "unstable")),
    "k_machine": (STICKS, (0.1, 0.2)),
}


def punched(name, value) -> Definition:
    """A study of one case with a shape or adhesion."""
    frustum = {"flat_radius": 0.1} if value == "frustum" else {}
    model = {"P": 1e-5, "h": 0.02, "n": 0.5, "micro": "smooth"} | PUNCH[name][0] | frustum | {name: value}
    return from_tables({"model": model}, "one", "", "one")
