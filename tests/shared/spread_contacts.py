"""Contacts whose inputs have spreads, of every law, base and control. See tools/references/make_moved_spreads.py."""

from pathlib import Path

TABLE = Path(__file__).resolve().parents[1] / "references/golden_law.csv"
STEEL = {"E_punch": "207 ± 6 GPa", "nu_punch": "0.29 ± 0.01", "E2": "210 ± 6 GPa", "nu2": "0.29 ± 0.01"}
DLC = {"E1": "200 ± 8 GPa", "nu1": "0.22 ± 0.02", "h": "2.0 ± 0.1 um", "bonding": "bonded"}
SOFT = {"E1": "1.0 ± 0.05 GPa", "nu1": "0.4 ± 0.01", "h": "100 ± 5 um", "bonding": "bonded"}
FINE = {"Nbar": "2.0 ± 0.1 1/um^2", "Ra": "10.0 ± 0.5 um"}
WIDE = {"Nbar": "2e9 ± 1e8 1/m^2", "Ra": "10.0 ± 0.5 um"}
BALL, FILM = {"R": "10.0 ± 0.1 mm"}, {"base": "thin_layer", "rtol": 1e-8}
CONTACTS = {
    "readme": {"R": "10 mm", "E_punch": "210 GPa", "nu_punch": 0.3, "Nbar": "2 1/um^2", "Ra": "10 um", "P": "10 N"}
    | {"E1": "200 ± 20 GPa", "nu1": 0.2, "h": "2.0 ± 0.1 um", "bonding": "bonded", "E2": "210 GPa", "nu2": 0.3},
    "disc_cell": BALL | STEEL | DLC | FINE | {"P": "10.0 ± 0.2 N"},
    "frictionless": BALL | STEEL | SOFT | WIDE | {"bonding": "frictionless", "D": "20.0 ± 0.5 um"},
    "hertz": {"R1": "10.0 ± 0.1 mm", "R2": "-25 ± 0.2 mm", "base": "half_space", "micro": "smooth", "D": "2.0 ± 0.1 um"}
    | STEEL,
    "rough_half_space": BALL | STEEL | {"base": "half_space", "a": "100 ± 2 um"} | FINE,
    "rigid_base": BALL | SOFT | {"E2": "rigid", "micro": "smooth", "a": "300 ± 10 um"},
    "fitted": BALL | STEEL | SOFT | WIDE | {"micro": "power_law", "P": "10.0 ± 0.2 N"},
    "fitted_film": BALL | SOFT | WIDE | FILM | {"micro": "power_law", "bonding": "frictionless", "P": "100.0 ± 2 N"}
    | {"E2": "210 ± 6 GPa"},
    "power_film": BALL | SOFT | WIDE | FILM | {"E2": "210 ± 6 GPa", "D": "10.0 ± 0.2 um", "bonding": "frictionless"}
    | {"micro": "power_law", "B": "0.100 ± 0.005", "beta": "0.50 ± 0.01"},
    "smooth_film": BALL | SOFT | FILM | {"E2": "210 ± 6 GPa", "micro": "smooth", "P": "100.0 ± 2 N"},
    "auto": BALL | STEEL | SOFT | {"base": "auto", "accuracy": 0.1, "P": "1.0 ± 0.02 N", "h": "20 ± 1 mm"} | WIDE,
    "square_lattice": BALL | STEEL | SOFT | WIDE | {"micro": "square_lattice", "P": "10.0 ± 0.2 N"},
    "hex_lattice": BALL | STEEL | DLC | FINE | {"micro": "hex_lattice", "D": "700 ± 20 nm"},
    "normal_heights": BALL | STEEL | SOFT | WIDE | {"micro": "normal_heights", "sigma": "1.0 ± 0.05 um"}
    | {"cut": "3.5 ± 0.1", "P": "10.0 ± 0.2 N"},
    "uniform_heights": BALL | STEEL | SOFT | WIDE | {"micro": "uniform_heights", "sigma": "1.0 ± 0.05 um"}
    | {"a": "400 ± 10 um"},
    "table": STEEL | SOFT | WIDE | {"R": "10 mm", "micro": f"table:{TABLE}", "P": "10.0 ± 0.2 N"},
    "one_piece": BALL | {"punch": "PMMA", "body": "PMMA", "base": "half_space", "micro": "smooth", "P": "10.0 ± 0.2 N"}
    | {"same_piece": True},
}  # fmt: skip
"""Name -> parameters of `study.solve`."""
AT = (0.0, 0.5, 0.9)
"""Radii r/a of the profiles."""
