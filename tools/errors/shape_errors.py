"""How often `error` of smooth contacts of every shape is below the truth: `python tools/errors/shape_errors.py [SIZE
[SEED]] [adhesion ...]`, a minute for a SIZE of 2.

SIZE random contacts (2 by default) of each shape on each base, under each control, with each law of adhesion (all, or
the named ones: none, jkr, maugis, dmt) are solved. They are solved again for the truth: with half as many more
functions in the basis, at all nodes of a finer quadrature, without tables of the kernel. The truth of a half-space is a
layer of its own material. The tolerances are from 1e-4 to 1e-10. It prints a line for each law and base:

- the statuses of the answers;
- judged: the number with a truth; the number farther from it than `error`, and the largest distance over `error`;
- the same for `profile_error` and the pressures;
- honest: the median of error over distance, for answers farther than 1e-14 from the truth;
- hard: the number that miss their tolerance although the truth is within it.
"""

import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np

from solver import Problem, Status, solve
from solver.body import wave_rule
from solver.smooth import contact, galerkin, products
from solver.smooth.adhesion import maugis

SHAPES = (
    "paraboloid", "sphere", "cone", "power", "frustum", "blunt_cone", "ball_cone", "rounded_flat", "table", "flat",
)  # fmt: skip
BASES, LAWS = ("half_space", "layered", "stack"), ("none", "jkr", "maugis", "dmt")
X = np.array([0.0, 0.3, 0.6, 0.9, 0.99])
ENDED = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)
#: Smaller distances are rounding of the numbers themselves.
ROUNDING = 1e-15


def log_uniform(random: np.random.Generator, low: float, high: float, size: int) -> np.ndarray:
    return np.exp(random.uniform(np.log(low), np.log(high), size))


def shape_of(name: str, a: np.ndarray, random: np.random.Generator, folder: Path) -> tuple[dict, np.ndarray]:
    """Parameters of shapes, and possible contact radii near `a`."""
    size, sharp, part = len(a), log_uniform(random, 0.02, 0.8, len(a)), random.uniform(0.05, 1.2, len(a))
    b = np.minimum(part, 0.97) * a
    half_angle = np.degrees(np.arctan(1 / sharp))
    if name in ("paraboloid", "sphere"):
        return {"shape": name}, a
    if name == "table":
        rows = np.linspace(0, 0.6, 13)
        np.savetxt(path := folder / "tip.csv", np.column_stack([rows, rows**2 / 2 + 0.1 * rows]), delimiter=",")
        return {"shape": f"table:{path}"}, a
    if name == "power":
        k = random.choice([1.0, 1.5, 2.0, 3.0, 4.0, 6.5], size)
        return {"shape": name, "shape_power": k, "shape_coefficient": sharp / k * a ** (1 - k)}, a
    if name in ("blunt_cone", "ball_cone"):
        word = {"tip": "sphere"} if name == "ball_cone" else {}
        return {"shape": "blunt_cone", "tip_radius": part * a / sharp, "half_angle": half_angle} | word, a
    numbers = {"cone": {"half_angle": half_angle}, "frustum": {"flat_radius": b, "half_angle": half_angle}}
    numbers |= {"flat": {"flat_radius": a}, "rounded_flat": {"flat_radius": b, "edge_radius": a / sharp}}
    return {"shape": name} | numbers[name], a


def body_of(base: str, a: np.ndarray, random: np.random.Generator) -> dict:
    size = len(a)
    h_a = np.where(
        random.random(size) < 0.1, log_uniform(random, 1e-4, 1e-2, size), log_uniform(random, 0.03, 30, size)
    )
    n = np.where(random.random(size) < 0.1, 0.0, log_uniform(random, 1e-2, 1e3, size))
    nu = np.where(random.random(size) < 0.2, 0.5, random.uniform(0, 0.5, size))
    if base == "half_space":
        return {"base": base}
    if base == "layered":
        m = random.choice([0.0, 0.4], size)
        return {"h": h_a * a, "n": n, "nu1": nu, "bonding": random.choice(["bonded", "frictionless"], size), "m": m}
    below = {"h": log_uniform(random, 0.1, 5, size) * h_a * a, "n": log_uniform(random, 1e-2, 1e2, size), "nu": 0.35}
    return {"layers": [{"h": h_a * a, "n": np.maximum(n, 0.01), "nu": nu}, below]}


def cases(name: str, base: str, control: str, law: str, size: int, seed: int, folder: Path) -> dict:
    """Arguments of ``Problem.of`` of random contacts; a load or depth makes a contact of about the radius."""
    random = np.random.default_rng([seed, SHAPES.index(name), BASES.index(base), "aPD".index(control), LAWS.index(law)])
    a = log_uniform(random, 1e-3, 0.4, size)
    shape, a = shape_of(name, a, random, folder)
    case = shape | body_of(base, a, random) | {"micro": "smooth", "rtol": 10.0 ** -random.integers(4, 11, size)}
    free = solve(Problem.of(a=a, **case) if name != "flat" else Problem.of(D=0.1 * a, **case))
    if law != "none":
        G = np.abs(free.P) ** 2 / (8 * np.pi * a**3) * log_uniform(random, 1e-3, 1, size)
        case |= {"adhesion": law, "w_adhesion": np.where(np.isfinite(G) & (G > 0), G, 1e-9)}
    if law == "maugis":
        case |= {
            "sigma0": np.nan_to_num(np.abs(free.P), nan=1e-6) / (np.pi * a**2) * log_uniform(random, 0.1, 30, size)
        }
    value = {"a": a, "P": free.P, "D": free.D}[control]
    return case | {control: np.where(np.isfinite(value), value * random.uniform(0.3, 1, size), 1e-9)}


def finer() -> None:
    """Let the solver take more functions, all nodes and finer rules from now on."""
    wave_rule._LESS, wave_rule._MORE, wave_rule._LEAST = 0.0, 16, (18, 22)
    wave_rule._END, wave_rule._END_MIDDLE = 30.0, 26.0
    wave_rule.quadrature.cache_clear()
    products.has_few = galerkin.has_few = lambda *_: False
    products._WAVES = products.Cache(products._MOST)
    few = products.size_of
    galerkin.size_of = maugis.size_of = lambda octave, even: int(1.5 * few(octave, even)) + 6
    contact.Tabulated = type("Untabulated", (), {"of": staticmethod(lambda body: body)})


def truth_of(case: dict) -> dict:
    """The same contacts; half-spaces as layers of their material."""
    if case.get("base") != "half_space":
        return case
    like = {"h": np.full(len(case["rtol"]), 0.05), "n": 1.0, "nu1": 0.3, "nu2": 0.3, "bonding": "bonded"}
    return {key: v for key, v in case.items() if key != "base"} | like


def distances(answer, truth) -> tuple[np.ndarray, np.ndarray]:
    """Largest relative distances of a, P, D, p0 and of P_off or D_off, and of pressures over the largest, (B,) each."""
    names = ["a", "P", "D", "p0"]
    pulls = "D_off" if answer.control == "D" else "P_off"
    parts = []
    for name in [*names, pulls]:
        value, exact = getattr(answer, name), getattr(truth, name)
        parts.append(np.where(np.isfinite(exact) & (exact != 0), np.abs(value / exact - 1), 0.0))
    p = np.where(np.isfinite(truth.p), truth.p, 0.0)
    off = np.where(np.isfinite(truth.p), np.abs(answer.p - truth.p), 0.0).max(axis=1)
    return np.max(parts, axis=0), off / np.abs(p).max(axis=1)


def main(size: int = 2, seed: int = 1, laws: tuple = LAWS) -> None:
    np.seterr(all="ignore")
    runs, before = [], process_time()
    with TemporaryDirectory() as folder:
        for law in laws:
            for name in SHAPES:
                for base in BASES:
                    for control in "aPD":
                        if (control == "a" and name == "flat") or (law == "dmt" and name != "paraboloid"):
                            continue
                        if (law, name) in (("none", "paraboloid"), ("maugis", "flat")):
                            continue
                        case = cases(name, base, control, law, size, seed, Path(folder))
                        runs.append((law, name, base, control, case, solve(Problem.of(**case), X)))
        seconds, before = process_time() - before, process_time()
        finer()
        report([(*run, solve(Problem.of(**truth_of(run[4])), X)) for run in runs])
    print(f"{seconds:.0f} s, and {process_time() - before:.0f} s for the truth")


def report(runs: list) -> None:
    groups: dict = {}
    for law, name, base, control, case, answer, truth in runs:
        answer = type("Answer", (), vars(answer) | {"control": control})
        of_error, of_profile = distances(answer, truth)
        judged = np.isin(answer.status, ENDED) & np.isin(truth.status, ENDED)
        for i in range(len(judged)):
            row = groups.setdefault((law, base), {"ends": Counter(), "error": [], "profile": [], "hard": 0})
            row["ends"][Status(answer.status[i]).name.lower()] += 1
            if (answer.status[i] in ENDED) != (truth.status[i] in ENDED):
                words = Status(answer.status[i]).name, Status(truth.status[i]).name
                print("ends otherwise:", law, name, base, control, i, *words)
            if not judged[i]:
                continue
            row["error"].append((of_error[i], answer.error[i]))
            row["profile"].append((of_profile[i], answer.profile_error[i]))
            hard = answer.status[i] == Status.TOLERANCE_NOT_MET and of_error[i] < case["rtol"][i] / 10
            row["hard"] += hard
            untrue = max(of_error[i] / answer.error[i], of_profile[i] / answer.profile_error[i]) > 1
            if hard or (untrue and max(of_error[i], of_profile[i]) > ROUNDING):
                words = "hard" if hard else "untrue"
                numbers = of_error[i], answer.error[i], of_profile[i], answer.profile_error[i]
                h_a = np.ravel(case.get("h", case.get("layers", [{"h": np.inf}])[0]["h"]) / answer.a)[i]
                print(words, law, name, base, control, i, *(f"{v:.2g}" for v in (*numbers, h_a, case["rtol"][i])))
    for (law, base), row in groups.items():
        print(f"{law} {base}: {dict(row['ends'])}; error {summary(row['error'])}; profile {summary(row['profile'])}; "
              f"hard {row['hard']}")  # fmt: skip


def summary(pairs: list) -> str:
    distance, error = np.array(pairs).reshape(-1, 2).T
    untrue = (distance > error) & (distance > ROUNDING)
    loose = (error / distance)[distance > 1e-14]
    most = (distance / error)[distance > ROUNDING].max(initial=0.0)
    return f"{len(error)} judged, {untrue.sum()} above, at most {most:.2f}, honest {np.median(loose):.3g}"


if __name__ == "__main__":
    numbers = [int(v) for v in sys.argv[1:] if v.isdigit()]
    main(*(numbers + [2, 1][len(numbers) :]), tuple(v for v in sys.argv[1:] if not v.isdigit()) or LAWS)
