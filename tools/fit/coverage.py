"""The errors and the speed of `study.fit`: `python tools/fit/coverage.py [CURVES [PART ...]]`, some ten minutes with
10,000 curves; the parts are hertz, bias, known, prior, free and times.

Curves P(D) of a rigid ball on a bonded layer have random E1*/E2*, 0.01 to 100, and random a/h at the deepest point,
0.05 to 5: exact loads from `solver.solve`, at 200 depths from -0.2 to 1 of the largest. The contact point is off by up
to 5 % of the largest depth, the baseline by up to 5 % of the largest load, the noise has a standard deviation of 1 %
of the largest load. With a prior of ± 10 % the true thickness of each curve is drawn from the prior. If h is free, the
true thickness differs from the value in the call by a factor of up to 3, and its bounds are a decade to either side.
It prints:

- bias: |E1/true E1 - 1| without noise, for E1*/E2* from 1e-3 to 100 and a/h from 0.05 to 10;
- covered: the share of curves whose 95 % interval of E1 contains the true E1, with the share's standard deviation;
- statuses, and the processor time of the fits alone;
- Hertz: the same for a half-space, whose loads follow Hertz's formula.
"""

import os
import sys
import time

os.environ |= {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")}

import numpy as np
import xarray as xr
from numpy.polynomial import chebyshev

import study
from solver import Problem, solve
from study.work import engine

START = engine.START  # a process is started for so many seconds of work
R, E2, NU1, NU2 = 1e-4, 70e9, 0.4, 0.2
H = 1e-6  # in the call
SCENE = {"R": "100 um", "nu1": NU1, "E2": "70 GPa", "nu2": NU2, "bonding": "bonded", "micro": "smooth"}
POINTS, TIMED = 200, 4096
NODES, EXACT = 40, 120  # depths that are solved: loads are right to 1e-5 of the largest, and to 2e-9
#: Knowledge of h -> the intervals that are counted.
KINDS = {"known": ("fisher",), "prior": ("fisher", "profile"), "free": ("profile", "fisher")}


def between(random: np.random.Generator, low: float, high: float, count: int) -> np.ndarray:
    return np.exp(random.uniform(np.log(low), np.log(high), count))


def exact(n: np.ndarray, wide: np.ndarray, h: np.ndarray, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Depths and loads (curves, POINTS) in SI of layers with E1* = n E2*, and with a/h = wide at the deepest point.

    The solver's loads over D^1.5 at some depths are interpolated by a polynomial in the root of the depth.
    """
    scene = {"nu1": NU1, "nu2": NU2, "bonding": "bonded", "micro": "smooth", "base": "layered", "rtol": 1e-9}
    center = np.array([0.0])
    deepest = solve(Problem.of(a=wide * h / R, h=h / R, n=n, **scene), center)
    assert not deepest.status.any()
    root = (chebyshev.chebpts1(nodes) + 1) / 2
    depths = deepest.D[:, None] * root**2
    columns = {"h": h / R, "n": n}
    columns = {name: np.repeat(value, nodes) for name, value in columns.items()}
    loads = solve(Problem.of(D=depths.ravel(), **columns, **scene), center)
    assert not loads.status.any()
    polynomials = chebyshev.chebfit(2 * root - 1, np.log(loads.P.reshape(depths.shape) / depths**1.5).T, nodes - 1)
    share = np.linspace(-0.2, 1.0, POINTS)
    inside = np.sqrt(np.maximum(share, 0.0))
    x = deepest.D[:, None] * share
    y = np.maximum(x, 0.0) ** 1.5 * np.exp(chebyshev.chebval(2 * inside - 1, polynomials))
    modulus = E2 / (1 - NU2**2)
    return x * R, y * modulus * R**2


def curves(
    count: int, seed: int, noise: float, n=(0.01, 100.0), wide=(0.05, 5.0), h="known"
) -> tuple[xr.Dataset, dict]:
    """Measured curves, and true E1, h, D0, P0 of each."""
    random = np.random.default_rng(seed)
    n, wide = between(random, *n, count), between(random, *wide, count)
    factor = {"known": np.ones(count), "prior": np.exp(0.1 * random.standard_normal(count))}
    h = H * (factor[h] if h in factor else between(random, 1 / 3, 3.0, count))
    x, y = exact(n, wide, h, NODES if noise else EXACT)
    D0, P0 = (random.uniform(-0.05, 0.05, count) * A[:, -1] for A in (x, y))
    largest = y.max(axis=1, keepdims=True)
    y = y + P0[:, None] + noise * largest * random.standard_normal(y.shape)
    measured = study.curves({"D": (x + D0[:, None], "m"), "P": (y, "N")})
    return measured, {"E1": n * E2 * (1 - NU1**2) / (1 - NU2**2), "h": h, "D0": D0, "P0": P0}


def fitted(measured: xr.Dataset, h="known", intervals="fisher", alone=True) -> tuple[xr.Dataset, float]:
    """The fit, and its processor time in this process; alone : whether no other process may help."""
    engine.START = np.inf if alone else START
    inputs = SCENE | {"h": "1 ± 0.1 um" if h == "prior" else "1 um"}
    start = time.process_time()
    fit = study.fit(
        measured, free=["E1", "h"] if h == "free" else ["E1"], intervals=intervals, progress=False, **inputs
    )
    return fit, time.process_time() - start


def statuses(fit: xr.Dataset) -> str:
    counts = np.bincount(fit.fit_status.values.astype(int), minlength=7)
    names = fit.fit_status.attrs["flag_meanings"].split()
    return ", ".join(f"{name} {count}" for name, count in zip(names, counts, strict=True) if count)


def report_bias(count: int) -> None:
    for h in ("known", "free"):
        measured, truth = curves(count, 1, 0.0, n=(1e-3, 100.0), wide=(0.05, 10.0), h=h)
        fit, seconds = fitted(measured, h)
        off = np.abs(fit.E1.values / truth["E1"] - 1)
        off = np.where(np.isfinite(off), off, np.inf)
        print(f"bias, h {h:5}: median {np.median(off):.0e}, 99 % {np.quantile(off, 0.99):.0e}, largest {off.max():.0e}")
        print(f"             {count} curves in {seconds:.1f} s: {statuses(fit)}", flush=True)


def report_coverage(h: str, count: int) -> None:
    measured, truth = curves(count, 2, 0.01, h=h)
    for intervals in KINDS[h]:
        fit, seconds = fitted(measured, h, intervals)
        inside = (fit.E1_low.values <= truth["E1"]) & (truth["E1"] <= fit.E1_high.values)
        share = inside.mean()
        sure = np.sqrt(share * (1 - share) / count)
        print(f"h {h:5} {intervals:7}: covered {100 * share:.1f} ± {100 * sure:.1f} %", end="; ")
        print(f"{count} curves in {seconds:.1f} s: {statuses(fit)}", flush=True)


def report_times() -> None:
    for h, intervals in (("known", "fisher"), ("free", "profile")):
        measured, _ = curves(TIMED, 3, 0.01, h=h)
        _, seconds = fitted(measured, h, intervals)
        start = time.perf_counter()
        fitted(measured, h, intervals, alone=False)
        wall = time.perf_counter() - start
        times = f"{seconds:.1f} s of processor time alone, {wall:.1f} s by {engine.available_workers()} processors"
        print(f"h {h}, {intervals}: {TIMED} x {POINTS}, {times}", flush=True)


def report_hertz(count: int = 100) -> None:
    random = np.random.default_rng(4)
    E, deep = between(random, 1e2, 1e12, count), between(random, 1e-9, 1e-5, count)
    x = np.linspace(-0.2, 1.0, POINTS) * deep[:, None]
    y = 4 / 3 * (E / (1 - NU2**2))[:, None] * np.sqrt(R) * np.maximum(x, 0.0) ** 1.5
    inputs = {"R": "100 um", "nu2": NU2, "micro": "smooth", "base": "half_space"}
    fit = study.fit({"D": (x, "m"), "P": (y, "N")}, free=["E2"], progress=False, **inputs)
    print(f"Hertz: largest |E/true E - 1| {np.abs(fit.E2.values / E - 1).max():.0e}; {statuses(fit)}", flush=True)


def speed() -> float:
    """Milliseconds of processor time of 1,000 solutions of 17 unknowns, to compare machines."""
    A, b = np.random.default_rng(0).random((17, 17)) + 17 * np.eye(17), np.ones(17)
    start = time.process_time()
    for _ in range(1000):
        np.linalg.solve(A, b)
    return 1e3 * (time.process_time() - start)


if __name__ == "__main__":
    number = int(sys.argv[1]) if sys.argv[1:] else 10_000
    parts = sys.argv[2:] or ["hertz", "bias", *KINDS, "times"]
    print(f"1,000 times numpy.linalg.solve of 17 unknowns: {speed():.1f} ms")
    if "hertz" in parts:
        report_hertz()
    if "bias" in parts:
        report_bias(min(number, 1000))
    for kind in (kind for kind in KINDS if kind in parts):
        report_coverage(kind, number)
    if "times" in parts:
        report_times()
