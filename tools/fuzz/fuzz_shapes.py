"""Random punches of every shape, smooth, rough and sticking: no result may be silently wrong, and there is no warning.

    python tools/fuzz/fuzz_shapes.py [GROUPS [SEED]]

Each group is a batch of one shape, base, control and kind of contact: smooth, one of the models of adhesion, or rough.
Numbers are drawn between the bounds of the solver, half of them near usual ones. A converged case must be a contact:
its numbers are finite, except those that are infinite or unknown under a point, at an edge or at pull-off, and its
radius gives the same contact. In some smooth groups the stresses at the surface must be those of the pressure, and
nowhere above the largest stress if there is one. Violations are printed with their cases; the exit code is then 1.
"""

import sys
import tempfile
import warnings
from collections import Counter
from pathlib import Path
from time import perf_counter

import numpy as np

from solver import Problem, Solution, Status, solve
from solver.fields.contact import have_fields
from solver.fields.contact import of_contacts as fields_of
from solver.fields.invariants import mises
from solver.known import PARAMETERS
from solver.parameters import ADHESIONS, BRANCHES, CONTROL, ends
from solver.shapes import SHAPES
from solver.yields.contact import of_contacts as extremes_of

X = np.array([0.0, 0.3, 0.7, 0.95, 1.0])
#: A table of random rows; its path is added when the rows are drawn.
TABLE = "table:"
#: The folder of random tables; it is removed at the end of the program.
FOLDER = tempfile.TemporaryDirectory()
NAMES = (*(name for name in SHAPES if not name.startswith(TABLE)), TABLE)
WAYS = ("smooth", *ADHESIONS, "rough")
BASES = ("half_space", "layered", "stack")
LAWS = ("disc_cell", "power_law", "square_lattice")
#: Cases of a group: a rough one takes a second.
SIZES = {"smooth": 12, "jkr": 6, "dmt": 12, "maugis": 1, "rough": 2}
#: Usual ranges; the other parameters are drawn between their bounds.
USUAL = {"h": (1e-3, 10), "n": (1e-3, 1e3), "half_angle": (20, 88), "flat_radius": (1e-3, 0.3), "tip_radius": (1e-2, 1),
         "edge_radius": (1e-2, 1), "shape_power": (1, 8), "shape_coefficient": (1e-2, 10), "w_adhesion": (1e-9, 1e-2),
         "sigma0": (1e-5, 1), "z0": (1e-7, 1e-2), "k_machine": (1e-5, 10), "P": (1e-8, 1e-2), "D": (1e-6, 0.1),
         "a": (1e-4, 0.5), "Nbar": (1e3, 1e6), "Ra": (1e-5, 1e-2), "B": (0.02, 1), "beta": (0.3, 0.9)}  # fmt: skip
#: In one of so many groups of smooth cases the stresses are computed, which takes a second.
STRESSED = 4
#: On layers that are thinner than this share of a no stresses are computed: they take minutes and more.
THICK = 2e-3
#: A contact may differ from the contact with its radius by so many errors.
AGREE = 10.0


def drawn(random, name, size, usual):
    """Numbers (size,) of a parameter, uniform in their logarithm."""
    low, high = USUAL[name] if usual else ends((CONTROL | PARAMETERS)[name].interval)[:2]
    low, high = max(low, 1e-9 if name != "w_adhesion" else 1e-15), min(high, 1e9)
    if name == "half_angle":
        return random.uniform(low or 1e-3, min(high, 89.999), size)
    return np.exp(random.uniform(np.log(low), np.log(high), size)).clip(low, high)


def table(random, seed, number):
    """The word of a table of random rows, some of them straight or with jumps of f''."""
    count = int(random.integers(3, 40))
    r = np.cumsum(np.exp(random.uniform(-3, 1, count))) * np.exp(random.uniform(-8, 1))
    slopes = np.cumsum(random.choice([0.0, 0.0, 1.0, 3.0], count) * random.random(count) + 1e-6) * random.uniform(
        0.01, 2
    )
    r, f = np.append(0.0, r), np.append(0.0, np.cumsum(slopes * np.diff(r, prepend=0.0)))
    file = Path(FOLDER.name, f"{seed}_{number}.csv")
    np.savetxt(file, np.stack([r, f], axis=1), delimiter=",", fmt="%.17g")
    return f"{TABLE}{file}"


def stressed(s: Solution, problem: Problem) -> np.ndarray:
    """(B,) bool: smooth converged cases with wrong stresses. The surface must bear the pressure, and von Mises' stress
    must nowhere exceed the largest one."""
    thick = (problem.base == "half_space") | (problem.h > THICK * s.a)
    index = np.flatnonzero((s.status == Status.CONVERGED) & (s.a / problem.R > 1e-8) & thick)
    out = np.zeros(len(s.a), dtype=bool)
    if not len(index) or not have_fields(problem, s)[index].all():
        return out
    part, ended = problem.take(index), s.take(index)
    fields = fields_of(part, ended, X[:-1], np.array([0.0, 0.5]))
    largest = extremes_of(part, ended, names=("mises1", "mises2"))
    inside = mises(*(fields.inside[name] for name in ("sr", "st", "sz", "trz")))
    most = np.fmax(largest["mises1"][0], largest["mises2"][0])
    most = np.where(np.isfinite(ended.p[:, -1]), most, np.inf)  # an edge where the pressure is infinite has no largest
    with np.errstate(all="ignore"):
        p, inside = ended.p[:, 1:4], np.where(np.isfinite(inside), inside, 0.0).max(axis=(1, 2))
        scale = np.abs(p).max(axis=1)
        off = np.abs(fields.inside["sz"][:, 0, 1:] + p).max(axis=1) > 1e-5 * scale + AGREE * fields.error * scale
        out[index] = off | ~(inside <= most * (1 + 1e-5)) | ~np.isfinite(fields.error)
    return out


def under(random, base, size, usual):
    """The parameters of the body under the punch: the numbers of a layer, or one to three layers."""
    if base == "layered":
        case = {name: drawn(random, name, size, usual) for name in ("h", "n")}
        case["n"] *= random.random() > 0.1  # 0: on a rigid base
        case |= {name: random.uniform(-0.9, 0.5, size) for name in ("nu1", "nu2")}
        return case | {"bonding": random.choice(("bonded", "frictionless"), size)}
    if base == "stack":
        layers = []
        for _ in range(random.integers(1, 4)):
            layer = {name: float(drawn(random, name, 1, True)[0]) for name in ("h", "n")}
            springs = {name: float(np.exp(random.uniform(-14, 2))) for name in ("cn", "ct")}
            bonding = ("bonded", "frictionless", springs)[random.integers(3)]
            layers.append(layer | {"nu": float(random.uniform(-0.5, 0.5)), "bonding": bonding})
        rigid = bool(random.random() < 0.3)
        layers[0] |= {"n": 1.0} if rigid else {}
        return {"layers": layers, "rigid_base": rigid}
    return {}


def group(seed, number):
    """Arguments of ``Problem.of`` of a group, and its control."""
    random = np.random.default_rng([seed, number])
    kind, shape, base = WAYS[number % 5], NAMES[number // 5 % len(NAMES)], random.choice(BASES)
    if kind == "dmt" or (kind == "maugis" and shape == "flat"):
        shape = "paraboloid"
    if shape == TABLE:
        shape = table(random, seed, number)
    control = str(random.choice(("P", "D") if shape == "flat" else tuple(CONTROL)))
    size, usual = SIZES[kind], random.random() < 0.5
    numbers = SHAPES[shape].parameters if shape in SHAPES else ()
    case = {name: drawn(random, name, size, usual) for name in numbers if name in USUAL}
    case |= {"shape": shape, "base": str(base), "micro": "smooth", "rtol": 10 ** random.uniform(-9, -2, size)}
    case |= {"m": random.choice((0.0, 1e-3, 1.0, 30.0), size)}
    if "tip_radius" in case:
        case["tip"] = random.choice(("paraboloid", "sphere"), size)
    case |= under(random, base, size, usual)
    value = drawn(random, control, size, usual)
    if kind == "rough":
        case |= {name: drawn(random, name, size, usual) for name in ("Nbar", "Ra", "B", "beta")}
        case["micro"] = str(random.choice(LAWS))
    elif kind != "smooth":
        case |= {"adhesion": kind, "w_adhesion": drawn(random, "w_adhesion", size, usual)}
        case |= {"branch": random.choice(BRANCHES, size, p=[0.8, 0.2])}
        case |= {"k_machine": drawn(random, "k_machine", size, True)} if random.random() < 0.3 else {}
        case |= {"sigma0": drawn(random, "sigma0", size, usual)} if kind == "maugis" else {}
        if control == "P":
            value = np.where(random.random(size) < 0.5, -5 * random.random(size) * case["w_adhesion"], value)
        elif control == "D":
            value *= random.choice([1, 0, -0.01], size)
    return case | {control: value}, control


def wrong_numbers(s: Solution, case: dict) -> np.ndarray:
    """(B,) bool: converged cases whose numbers cannot be those of a contact."""
    sticks, rough = "w_adhesion" in case, case["micro"] != "smooth"
    pointed = case["shape"] in ("cone", "berkovich", "vickers", "cube_corner", "power") or TABLE in case["shape"]
    bad = ~(s.a > 0) | ~(s.error <= case["rtol"]) | ~np.isfinite(s.P) | ~np.isfinite(s.D)
    with np.errstate(all="ignore"):
        inner = s.p[:, 1:-1]
        bad |= ~np.isfinite(inner).all(axis=1) | np.isnan(s.dP_dD) | np.isnan(s.p[:, -1])
        if not pointed:
            bad |= ~np.isfinite(s.p0) | ~np.isfinite(s.p_max)
        if sticks:
            pulls = np.stack([s.P_off, s.D_off, s.a_off, s.P_in, s.a_in])
            bad |= ~np.isfinite(pulls[:3]).all(axis=0) | (s.stable != (s.a >= s.a_off))
        else:
            bad |= ~(s.P > 0) | ~(s.D > 0) | (inner < 0).any(axis=1)
            bad |= s.dP_dD * s.D < s.P * (1 - AGREE * (s.error + case["rtol"]))
        if rough:
            bad |= (s.Ar_An > 1.0001) | ~(s.Ar_An > 0)
    return bad & (s.status == Status.CONVERGED)


def differs(s: Solution, case: dict, control: str) -> np.ndarray:
    """(B,) bool: converged cases for which the solution with their radius is a different contact."""
    out, low = np.zeros(len(s.a), dtype=bool), ends(CONTROL["a"].interval)[0]
    index = np.flatnonzero((s.status == Status.CONVERGED) & (s.a >= low))
    if control == "a" or case["shape"] == "flat" or not len(index):
        return out
    part = {name: v[index] if isinstance(v, np.ndarray) else v for name, v in case.items() if name != control}
    of_radius = solve(Problem.of(**part, a=s.a[index]), X)
    by_radius = np.abs(getattr(of_radius, control) - getattr(s, control)[index])
    # with the radius, P or D has an error from the rounding of a: a - b at a flat end, P near 0 with adhesion
    scale = np.abs(s.dP_dD if control == "P" else 1 / s.dP_dD)[index] * np.abs(s.D if control == "P" else s.P)[index]
    scale = np.maximum(np.abs(getattr(s, control)[index]), np.where(np.isfinite(scale), scale, np.inf))
    allowed = AGREE * (s.error[index] + of_radius.error + 1e-9) * scale
    out[index] = (of_radius.status == Status.CONVERGED) & ~(by_radius <= allowed)
    return out


def violations(seed, number, ended):
    """Texts about the violations in a group; `ended` counts the statuses of its cases."""
    case, control = group(seed, number)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            problem = Problem.of(**case)
            s = solve(problem, X)
            wrong, other = wrong_numbers(s, case), differs(s, case, control)
            strained = stressed(s, problem) if case["micro"] == "smooth" and number % STRESSED == 0 else 0 * wrong
        except Exception as error:
            return [f"group {number}: {type(error).__name__}: {error}: {case}"]
    ended.update(Status(value).name for value in s.status.tolist())
    names = ("status", "a", "P", "D", "p0", "dP_dD", "error", "P_off", "D_off", "a_off", "stable")
    texts = []
    kinds = (("impossible", wrong), ("not the same by its radius", other), ("impossible stresses", strained))
    for words, mask in kinds:
        for i in np.flatnonzero(mask):
            alone = {name: v[i].item() if isinstance(v, np.ndarray) else v for name, v in case.items()}
            ends_with = ", ".join(f"{name} {getattr(s, name)[i]:.6g}" for name in names)
            texts.append(f"{words}: group {number}: {alone}: {ends_with}, p {s.p[i]}")
    return texts


def main(count: int = 500, seed: int = 0) -> int:
    start, ended, texts = perf_counter(), Counter(), []
    for number in range(count):
        new = violations(seed, number, ended)
        texts += new
        print(*new, sep="\n", end="\n" if new else "", flush=True)
    print(f"{sum(ended.values())} cases in {perf_counter() - start:.0f} s: {dict(ended)}; {len(texts)} violations")
    return min(len(texts), 1)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:3])))
