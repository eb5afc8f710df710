"""Write golden_numbers.csv: the solver's results for some 80 cases of every kind. They are no independent reference.

Its first line names the NUMERICS_VERSION that made it. test_golden_numbers.py solves the cases again. If a change of
the solver moves the numbers, it needs a new NUMERICS_VERSION, and this script must run again:
``python tools/references/make_golden_numbers.py``. Read the difference before you commit it.
"""

from pathlib import Path

from solver import NUMERICS_VERSION, Problem, solve
from solver.laws.own_table import PREFIX

FOLDER = Path(__file__).parents[2] / "tests/references"
FILE = FOLDER / "golden_numbers.csv"
#: Radii r/a of the profiles.
X = (0.3, 0.95)
#: The case from which the others differ; every parameter is named, so that no default counts.
MAIN = {
    "control": "P", "value": 2.7e-5, "h": 0.02, "n": 0.5, "nu1": 0.3, "nu2": 0.3, "bonding": "frictionless",
    "Nbar": 250000.0, "Ra": 0.004, "base": "layered", "accuracy": 0.01, "model_check": "closed_form",
    "micro": "disc_cell", "B": 0.1, "beta": 0.5, "scheme": "newton", "k": 1.0, "rtol": 1e-6, "nodes": 0,
    "max_iterations": 0, "R": 1.0, "E2": 1.0, "m": 0.0, "sigma": 1e-4, "cut": 4.0,
}  # fmt: skip
TEXT = {name for name, value in MAIN.items() if isinstance(value, str)}
WHOLE = {"nodes", "max_iterations"}
EXACT = ("status", "model_used", "nodes_used", "iterations")
ERRORS = ("error", "profile_error", "model_error")
NUMBERS = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", *(f"{name}_{x:g}" for name in ("p", "lam") for x in X))

SMOOTH, POWER = {"micro": "smooth"}, {"micro": "power_law"}
SQUARE, HEX = {"micro": "square_lattice"}, {"micro": "hex_lattice"}
NORMAL, EVEN = {"micro": "normal_heights"}, {"micro": "uniform_heights"}
#: A user's tables, which lie beside the numbers: rows of a law, and a histogram of heights.
TABLE, BINS = {"micro": "table:golden_law.csv"}, {"micro": "table:golden_histogram.csv"}
RIGID = {"n": 0.0}
HALF, THIN, AUTO = {"base": "half_space"}, {"base": "thin_layer"}, {"base": "auto"}
BONDED, PICARD, FINE = {"bonding": "bonded"}, {"scheme": "picard", "nodes": 24}, {"rtol": 1e-9}
RADIUS, DEPTH = {"control": "a", "value": 0.04}, {"control": "D", "value": 1e-3}
FILM = {"control": "a", "value": 0.04, "h": 1e-4}
STIFF = {"control": "a", "value": 0.04, "n": 1e5}
CORNER = {"control": "a", "value": 0.1, "h": 1e-4, "n": 1e-2, "Ra": 0.02, "Nbar": 1.5e4}
FINE_ASPERITIES = {"Ra": 1e-6, "Nbar": 1e12}

CASES = [
    # each base and law, each control, three tolerances
    HALF, HALF | POWER | RADIUS | FINE, HALF | SMOOTH | DEPTH, HALF | DEPTH | {"rtol": 1e-3},
    THIN, THIN | RADIUS | FINE | BONDED, THIN | DEPTH | {"rtol": 1e-3},
    THIN | POWER, THIN | POWER | RADIUS | FINE, THIN | POWER | DEPTH | BONDED | {"nu1": 0.2, "nu2": 0.4},
    THIN | SMOOTH, THIN | SMOOTH | RADIUS | {"rtol": 1e-3}, THIN | SMOOTH | DEPTH | FINE | BONDED,
    {}, RADIUS | FINE | BONDED, DEPTH | {"rtol": 1e-3},
    POWER | FINE, POWER | RADIUS | BONDED | {"n": 10.0}, POWER | DEPTH | {"n": 0.01},
    SMOOTH, SMOOTH | RADIUS | FINE | BONDED | {"nu1": 0.5}, SMOOTH | DEPTH | {"h": 2.0, "n": 30.0},
    # thin, thick, soft, stiff, rubber; films; another scale
    {"h": 1.0, "n": 0.01, "nu1": 0.49} | BONDED, STIFF | {"h": 0.04}, STIFF | {"h": 0.012} | SMOOTH,
    FILM, FILM | SMOOTH | {"n": 0.01, "nodes": 48}, FILM | POWER | BONDED | {"n": 300.0}, FILM | {"h": 4e-8},
    {"R": 0.01, "E2": 2e11, "value": 540.0, "h": 2e-4, "Ra": 4e-5, "Nbar": 2.5e9},
    # asperities that saturate, or touch fully or not at all; a power law that acts like springs
    THIN | CORNER, THIN | CORNER | {"nodes": 32}, {"Ra": 0.1, "Nbar": 1.0, "value": 1e-7}, FINE_ASPERITIES,
    HALF | POWER | {"beta": 1.0, "B": 3.0}, THIN | SMOOTH | {"h": 1e-6, "nodes": 12},
    # a fixed number of nodes or steps
    THIN | {"nodes": 8}, THIN | {"max_iterations": 2, "rtol": 1e-9}, {"nodes": 10},
    # the cheapest sufficient model, and the error of a thin layer
    AUTO | {"accuracy": 0.9, "h": 0.05}, AUTO | {"accuracy": 0.1, "h": 0.003}, AUTO | {"h": 3e-4} | SMOOTH,
    AUTO | {"h": 5.0, "n": 2.0}, AUTO | {"accuracy": 0.1, "h": 1e-5} | FINE_ASPERITIES, AUTO | {"h": 1.0} | SMOOTH,
    AUTO | {"accuracy": 0.1} | FINE_ASPERITIES, AUTO | {"accuracy": 3e-5, "h": 1e-4} | SMOOTH,
    AUTO | {"accuracy": 0.1, "nu1": 0.5, "h": 1e-4} | BONDED | POWER,
    THIN | RADIUS | SMOOTH, THIN | BONDED | {"model_check": "first_order", "h": 0.005},
    THIN | DEPTH | BONDED | {"nu1": 0.45, "h": 0.005, "n": 0.1}, THIN | POWER | {"model_check": "first_order"},
    # the paper's scheme
    THIN | POWER | PICARD | {"k": 10.0, "rtol": 1e-4}, HALF | POWER | PICARD | {"k": 40.0, "rtol": 1e-4},
    # no numbers
    {"value": -1.0}, THIN | BONDED | {"n": 2.0},
    # elastic punches; rigid bases
    HALF | SMOOTH | RADIUS | {"m": 0.5}, THIN | SMOOTH | DEPTH | {"m": 2.0, "n": 1e-9}, {"m": 0.3} | RADIUS | BONDED,
    THIN | SMOOTH | RIGID | DEPTH, THIN | RIGID | BONDED | {"m": 0.2}, RIGID, RIGID | DEPTH | SMOOTH | {"m": 3.0},
    THIN | RIGID | RADIUS | {"h": 0.002, "model_check": "first_order"}, AUTO | RIGID | {"h": 3e-4, "m": 1.0},
    # lattices; heights with no, small and large spread, and with other cuts
    HALF | SQUARE, SQUARE | RADIUS | BONDED, HALF | HEX | {"m": 0.5}, THIN | HEX | DEPTH,
    HALF | NORMAL | {"sigma": 0.0}, HALF | NORMAL, NORMAL | RADIUS | {"cut": 3.0, "sigma": 1e-3},
    THIN | NORMAL | DEPTH | {"cut": 5.0, "sigma": 1e-5}, HALF | EVEN, EVEN | DEPTH | BONDED | {"m": 0.3},
    # tables; one that does not reach the pressures
    HALF | TABLE, TABLE | RADIUS, HALF | TABLE | {"value": 1e-2}, HALF | BINS, BINS | DEPTH,
    # the error of a law, and of its first row, is part of that of the model; another scale
    AUTO | NORMAL | {"h": 20.0, "n": 2.0}, AUTO | HEX | {"h": 1e-4},
    HALF | TABLE | {"value": 1e-10, "m": 1.0},
    {"R": 0.01, "E2": 2e11, "value": 540.0, "h": 2e-4, "Ra": 4e-5, "Nbar": 2.5e9, "sigma": 1e-6, "m": 0.1} | NORMAL,
]  # fmt: skip


def answers(problem):
    """EXACT, ERRORS and NUMBERS (dict of arrays) for the arguments of ``Problem.of``, `micro` one name or a list."""
    solution = solve(Problem.of(**problem | {"micro": with_paths(problem["micro"])}), X)
    profiles = {f"{name}_{x:g}": getattr(solution, name)[:, i] for name in ("p", "lam") for i, x in enumerate(X)}
    values = vars(solution) | profiles | {"nodes_used": solution.nodes}
    return {name: values[name] for name in (*EXACT, *ERRORS, *NUMBERS)}


def with_paths(micro):
    """The name of a law, or a list of them, with the path of each table."""
    if isinstance(micro, list):
        return [with_paths(name) for name in micro]
    return micro.replace(PREFIX, f"{PREFIX}{FOLDER}/")


def main():
    """Write the table into tests/references."""
    lines = [f"# NUMERICS_VERSION {NUMERICS_VERSION}", ",".join([*MAIN, *EXACT, *ERRORS, *NUMBERS])]
    for change in CASES:
        case = MAIN | change
        inputs = [str(value) for value in case.values()]
        results = answers({case.pop("control"): case.pop("value")} | case)
        texts = [str(results[name][0]) for name in EXACT] + [f"{results[name][0]:.15g}" for name in (*ERRORS, *NUMBERS)]
        lines.append(",".join([*inputs, *texts]))
    FILE.write_text("\n".join([*lines, ""]), encoding="utf-8")


if __name__ == "__main__":
    main()
