"""Random calls of the solver within all bounds: no result silently wrong, no warning, no case longer than 10 s.

    python tools/fuzz/fuzz_solver.py [--cases 20000] [--seed 0] [--singles 0.1]

Cases of every base, law, control, interface and scheme, from rtol 1e-12 to 0.1, are drawn in groups and solved as
batches. A random part of them is solved once more, alone, and timed. Random user's tables are written to files for each
group. Violations are printed with their case and table; the exit code is then 1.
"""

import argparse
import sys
import time
import warnings
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from solver import Problem, Solution, Status, laws, solve
from solver.known import PARAMETERS
from solver.parameters import BONDINGS, CONTROL, MODEL_CHECKS, ends

#: Points of the profiles. On a plate nearly all of the load may lie in a narrow ring at the edge.
X = np.unique([*np.linspace(0.0, 1.0, 9), *(1 - 2.0 ** -np.arange(4, 20))])
#: Cases of a group, which has one base, law, control and scheme: on the exact layer a case takes a hundred times as
#: long as on the others. ROUND groups have every base, law and control, 5400 cases.
SIZES = {"half_space": 90, "thin_layer": 90, "layered": 10, "auto": 10}
BASES = tuple(SIZES)  # stacks of layers have random tests of their own: tests/stacks
#: The last two are user's tables: rows of a law, and a histogram of heights.
LAWS = ("smooth", "disc_cell", "power_law", "square_lattice", "hex_lattice", "normal_heights", "uniform_heights",
        "rows", "histogram")  # fmt: skip
#: Number of different asperities in a group with a histogram: one table of many classes takes a second.
MOST_TABLES = 9
ROUND = len(BASES) * len(LAWS) * len(CONTROL)
#: Drawn by the logarithm between their bounds; the other parameters have values as in studies.
LOGARITHMIC = ("h", "n", "Nbar", "Ra", "B", "beta", "sigma", "cut")
#: Share of cases with successive approximations, which are the slowest and the least used.
PICARD = 0.1
SLOWEST = 10.0
#: A contact may differ from the contact with its radius by so many errors of both: the estimate is good to a factor of
#: a few.
AGREE = 10.0


def logarithmic(random, name, size):
    """Numbers (size,) between the bounds of a parameter, uniform in their logarithm; one in eight at an end."""
    low, high = ends((CONTROL | PARAMETERS)[name].interval)[:2]
    least = low or 1e-9  # for m and sigma, which may be 0
    values = np.exp(random.uniform(np.log(least), np.log(high), size)).clip(least, high)
    return np.where(random.random(size) < 1 / 8, random.choice([low, high], size), values)


def rows(random):
    """Text of a table of a law, of the disc cell over many decades of pressure, half of them with noise."""
    first, last = random.uniform(-12, -5), random.uniform(-3, 1)
    p = 10.0 ** np.linspace(first, last, random.integers(12, 60))
    Ra = 10 ** random.uniform(-6, 0)
    spots = laws.LAWS["disc_cell"].at(p, 1.0, Nbar=10 ** random.uniform(-3, 3) / Ra**2, Ra=Ra)
    noise = random.choice([0.0, 0.01]) * random.uniform(-1, 1, (3, len(p)))
    return text("p,A,lam,p_max", p, *np.array(spots) * (1 + noise))


def histogram(random):
    """Text of a histogram of heights, from two classes to the most."""
    count = round(2 ** random.uniform(1, 5))
    z, share = 10 ** random.uniform(-9, -1) * np.arange(count), 10 ** random.uniform(-2, 0, count)
    return text("z,share", z, share)


def text(heading, *columns):
    return "\n".join([heading, *(",".join(map(repr, row)) for row in np.stack(columns, axis=1).tolist())])


def table(random, kind, file):
    """Write a random table of a kind, "rows" or "histogram", to the file; returns the name of its law. A table that is
    refused is drawn again."""
    while True:
        file.write_text({"rows": rows, "histogram": histogram}[kind](random), encoding="utf-8")
        try:
            return laws.own_table.read(f"{laws.own_table.PREFIX}{file}").name
        except ValueError:
            pass


def group(seed, number, folder, share=1):
    """Arguments of ``Problem.of`` of a group, and its control. A table is written in the folder."""
    random = np.random.default_rng([seed, number])
    base, law = BASES[number % len(BASES)], LAWS[number // len(BASES) % len(LAWS)]
    control = tuple(CONTROL)[number // (len(BASES) * len(LAWS)) % len(CONTROL)]
    size = max(1, SIZES[base] // share)
    case = {name: logarithmic(random, name, size) for name in LOGARITHMIC}
    case |= {name: random.uniform(-0.99, 0.5, size) for name in ("nu1", "nu2")}
    case |= {"k": 10 ** random.uniform(-3, 3, size), "rtol": 10.0 ** random.uniform(-12, -1, size)}
    case |= {"bonding": random.choice(BONDINGS, size), "accuracy": 10 ** random.uniform(-6, -0.3, size)}
    case |= {"nodes": random.choice([0, 0, 0, 0, 4, 17, 48], size), "model_check": random.choice(MODEL_CHECKS, size)}
    case |= {"m": np.where(random.random(size) < 0.5, 0.0, logarithmic(random, "m", size))}
    case |= {"n": np.where(random.random(size) < 0.1, 0.0, case["n"])}
    if law in ("rows", "histogram"):
        few = random.integers(0, min(size, MOST_TABLES), size)  # a histogram has a table for each Nbar and Ra
        case |= {name: case[name][few] for name in ("Nbar", "Ra")}
        law = table(random, law, folder / f"{number}.csv")
    scheme = "picard" if law != "smooth" and random.random() < PICARD else "newton"
    return case | {control: logarithmic(random, control, size), "base": base, "micro": law, "scheme": scheme}, control


def wrong_numbers(s: Solution, rtol, bonded) -> np.ndarray:
    """(B,) bool: converged cases whose numbers cannot be those of a contact, whatever error the solver states."""
    with np.errstate(all="ignore"):
        mean = s.P / (np.pi * s.a**2)
        error = AGREE * (s.error + rtol)
        bad = np.zeros(len(s.a), dtype=bool)
        for value in (s.a, s.P, s.D, s.p0, s.p_max, s.Ar_An, s.dP_dD):
            bad |= ~(value > 0) | ~np.isfinite(value)
        bad |= ~np.isfinite(s.p).all(axis=1) | (s.p < 0).any(axis=1) | (s.lam < 0).any(axis=1)
        bad |= (s.lam > 1.0001).any(axis=1)
        bad |= ~(s.error <= rtol) | (s.Ar_An > 1.0001)
        # Hertz has a² = D, springs a² = 2 D, an incompressible bonded film a² = 4 D; asperities add to D alone.
        bad |= s.a**2 > np.where(bonded, 4, 2) * s.D * (1 + error)
        # The stiffness of a contact grows with its depth: dP/dD >= P/D.
        bad |= s.dP_dD * s.D < s.P * (1 - error)
        # A spot carries more than the nominal pressure, and the mean is below the largest.
        bad |= (s.p_max < s.p0 * (1 - error)) | (mean > s.p.max(axis=1) * (1 + error))
    return bad & (s.status == Status.CONVERGED)


def differs(s: Solution, case: dict, control: str) -> np.ndarray:
    """(B,) bool: converged cases for which the solution with their radius is a different contact."""
    out = np.zeros(len(s.a), dtype=bool)
    low, high = ends(CONTROL["a"].interval)[:2]
    index = np.flatnonzero((s.status == Status.CONVERGED) & (s.a >= low) & (s.a <= high))
    if control == "a" or not len(index):
        return out
    part = {name: value[index] if np.ndim(value) else value for name, value in case.items() if name != control}
    of_radius = solve(Problem.of(**part, a=s.a[index]), X)
    of_load, of_same_radius = getattr(s, control)[index], getattr(of_radius, control)
    both_converged = of_radius.status == Status.CONVERGED
    allowed = AGREE * (s.error[index] + of_radius.error + 1e-12)
    out[index] = both_converged & ~(np.abs(of_same_radius / of_load - 1) <= allowed)
    if case["base"] == "auto":  # with its radius it may take another model
        out[index] &= of_radius.model_used == s.model_used[index]
    return out


def fuzz(groups, seed, singles=0, share=1):
    """Violations (list of text), statuses of the cases (Counter), seconds of the cases solved alone (list).

    singles : part of the cases that are solved alone; share : groups are this many times smaller.
    """
    texts, ended, times = [], Counter(), []
    with TemporaryDirectory() as folder:
        for number in groups:
            wrong = [*violations(seed, number, Path(folder), singles, share, ended, times)]
            table_file = Path(folder) / f"{number}.csv"
            texts += [
                f"{text}\n{table_file.read_text(encoding='utf-8')}" if table_file.exists() else text for text in wrong
            ]
    return texts, ended, times


def violations(seed, number, folder, singles, share, ended, times):
    """Yield the violations of a group; `ended` gets the statuses, and `times` the seconds of cases solved alone."""
    case, control = group(seed, number, folder, share)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            s = solve(Problem.of(**case), X)
            wrong = wrong_numbers(s, case["rtol"], case["bonding"] == "bonded")
            other = differs(s, case, control)
        except Exception as error:
            yield f"group {number}: {type(error).__name__}: {error}"
            return
    ended.update(Status(value).name for value in s.status.tolist())
    for words, mask in (("impossible", wrong), ("not the same by its radius", other)):
        yield from (f"{words}: {alone(case, i)}: {shown(s, i)}" for i in np.flatnonzero(mask))
    for i in np.flatnonzero(np.random.default_rng([seed, number, 1]).random(len(s.a)) < singles):
        start = time.process_time()
        lone = solve(Problem.of(**alone(case, i)), X)
        times.append(time.process_time() - start)
        if times[-1] > SLOWEST:
            yield f"{times[-1]:.1f} s: {alone(case, i)}: {Status(lone.status[0]).name}"


def alone(case, i):
    """The arguments of one case of a group."""
    return {name: value[i].item() if np.ndim(value) else value for name, value in case.items()}


def shown(s, i):
    """The result of a case, as text."""
    names = ("status", "model_used", "a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD", "error", "nodes")
    return ", ".join(f"{name} {getattr(s, name)[i]:.6g}" for name in names)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cases", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--singles", type=float, default=0.1, help="part of the cases solved once more, and timed")
    options = parser.parse_args(arguments)
    start = time.perf_counter()
    texts, ended, times = fuzz(range(ROUND * -(-options.cases // 5400)), options.seed, options.singles)
    print("\n".join(texts[:50]))
    seconds = np.array(times) if times else np.zeros(1)
    ends_of = ", ".join(f"{count} {name}" for name, count in ended.most_common())
    print(f"{sum(ended.values())} cases in {time.perf_counter() - start:.0f} s: {ends_of}")
    median, most = np.median(seconds), np.quantile(seconds, 0.99)
    print(f"{len(times)} alone: median {median:.3f} s, 99 % below {most:.2f} s, longest {seconds.max():.1f} s")
    print(f"{len(texts)} violations")
    return 1 if texts else 0


if __name__ == "__main__":
    sys.exit(main())
