"""The errors and the speed of fits of curves that stick: `python tools/fit/sticking.py [CURVES [FREE ...]]`. FREE is w,
contact or h: the unknown besides E1 and w_adhesion. It takes some five minutes with 210 curves.

Curves P(D) of paraboloids, spheres and cones are at most 0.2 R and h/2 deep: on half-spaces, and on gels of h = 0.1,
0.5 and 3 R on a rigid base and on one of E2* = 3 E1*. A third of the curves are approaches, with load 0 before the
surfaces meet; the others go back to pull-off and beyond. The pull-off load is 1 to 100 % of the largest load, the noise
of the 80 points is 0.5 to 5 % of it, and contact point (not in the part w) and baseline are off. Exact loads come from
`solver.solve`, each with five draws of noise. The call of `study.fit` has bounds of w_adhesion that are three times
wider than the works of its curves, and no value of E1; in the part h its thickness is wrong by a factor of up to 3. It
prints, for each shape and for all:

- covered: the shares of converged curves whose 95 % intervals of E1, and of w_adhesion, contain the true value, with
  their standard deviations;
- far: converged curves that are more than five spreads and 1 % off, which should not happen;
- statuses, and the processor time of a curve in its batch; of one curve alone.
"""

import os
import sys
import time
import warnings

os.environ |= {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")}

import numpy as np

import study
from solver import Problem, solve
from study.work import engine

POINTS, E1, R, NU = 80, 5e3, 5e-6, 0.45
SHAPES = {"paraboloid": {}, "sphere": {"shape": "sphere"}, "cone": {"shape": "cone", "half_angle": 70.0}}
#: A base -> its numbers for the solver at a thickness of h R, and for `study.fit`.
BASES = {"half_space": (0.0,), "rigid": (0.1, 0.5, 3.0), "compliant": (0.1, 0.5, 3.0)}
SOFTER = 3.0  # E2*/E1* of the compliant base
CENTER = np.array([0.0])
DRAWS = 5  # of noise, for each curve that is solved
KINDS = {"w": {"contact_point": False}, "contact": {}, "h": {}}


def scene(base: str, h: float) -> tuple[dict, dict]:
    """Numbers for the solver in units R = E1* = 1, and inputs of `study.fit`."""
    if base == "half_space":
        return {"base": base}, {"base": base, "nu2": NU, "punch": "rigid"}
    numbers = {"base": "layered", "h": h, "n": 0.0 if base == "rigid" else 1 / SOFTER, "nu1": NU, "nu2": NU}
    inputs = {"nu1": NU, "h": f"{h * R!r} m", "E2": "rigid", "punch": "rigid", "bonding": "bonded"}
    if base == "compliant":
        inputs |= {"E2": f"{SOFTER * E1!r} Pa", "nu2": NU}
    return numbers | {"bonding": "bonded"}, inputs


def curves(numbers: dict, shape: dict, share: np.ndarray, random: np.random.Generator) -> tuple:
    """Depths and loads (curves, POINTS) in units R = E1* = 1, and the works of adhesion: pull-off is at `share` of the
    largest load."""
    unit = SOFTER if numbers.get("n") else 1.0  # of E2*, the unit of the solver, in E1*
    deep = min(0.2, numbers.get("h", 1.0) / 2)
    about = {**numbers, **shape, "micro": "smooth"}
    deepest, low, high = np.full(len(share), deep), np.full(len(share), -16.0), np.full(len(share), 3.0)  # of ln w
    for _ in range(14):
        w = np.exp((low + high) / 2)
        ends = solve(Problem.of(D=deepest, w_adhesion=w / unit, **about), CENTER)
        too_much = ~(-ends.P_off / share < ends.P)  # also where all loads are pulls
        low, high = np.where(too_much, low, np.log(w)), np.where(too_much, np.log(w), high)
    w = np.exp(low)
    ends = solve(Problem.of(D=deepest, w_adhesion=w / unit, **about), CENTER)
    assert (np.abs(-ends.P_off / ends.P / share - 1) < 0.05).all()
    approach = random.random(len(share)) < 1 / 3
    span = deepest - ends.D_off
    first = np.where(approach, -0.3 * deepest, ends.D_off - 0.25 * span)
    D = first[:, None] + (deepest - first)[:, None] * np.linspace(0, 1, POINTS)
    flat = D.ravel()
    loads = solve(Problem.of(D=flat, w_adhesion=np.repeat(w / unit, POINTS), **about), CENTER)
    assert np.isin(loads.status, (0, 11)).all(), np.unique(loads.status)
    P = np.nan_to_num(loads.P).reshape(D.shape) * unit
    P = np.where(approach[:, None] & (D < 0), 0.0, P)
    return D, P, w


def fitted(kind: str, count: int) -> dict[str, np.ndarray]:
    """The numbers of the fits of `count` curves of each scene, over the curves."""
    rows: list[dict] = []
    random, engine.START = np.random.default_rng(7), np.inf
    for name, shape in SHAPES.items():
        for base, h in ((base, h) for base, thicknesses in BASES.items() for h in thicknesses):
            numbers, inputs = scene(base, h)
            share = 10 ** random.uniform(-2, 0, count // DRAWS)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                D, P, w = curves(numbers, shape, share, random)
            share, D, P, w = (np.repeat(A, DRAWS, axis=0) for A in (share, D, P, w))
            noise = 10 ** random.uniform(np.log10(0.005), np.log10(0.05), len(w))
            P = P + (noise * P.max(axis=1))[:, None] * random.standard_normal(P.shape)
            D0, P0 = (random.uniform(-0.05, 0.05, (count, 1)) * A[:, -1:] for A in (D, P))
            inputs |= {"micro": "smooth", **shape} | ({} if name == "cone" else {"R": f"{R!r} m"})
            if kind == "h" and h:
                inputs |= {"h": f"{float(h * R * 3 ** random.uniform(-1, 1))!r} m"}
            row = of_scene(kind, inputs, (R * (D + D0 * (kind != "w")), P + P0, w))
            rows.append(row | {"shape": np.full(count, name), "share": share, "noise": noise})
    return {key: np.concatenate([row[key] for row in rows]) for key in rows[0]}


def of_scene(kind: str, inputs: dict, data: tuple) -> dict[str, np.ndarray]:
    """The results of `study.fit` and the true values; data : depths in m, loads and works in units R = E1* = 1."""
    D, P, w = data
    unit = E1 / (1 - NU**2)
    low, middle, high = (
        f"{float(v * unit * R)!r} J/m^2" for v in (w.min() / 3, np.sqrt(w.min() * w.max()), 3 * w.max())
    )
    modulus = "E2" if inputs.get("base") == "half_space" else "E1"
    free = {modulus: None, "w_adhesion": (low, high)} | ({"h": None} if kind == "h" and "h" in inputs else {})
    begun = time.process_time()
    measured = {"D": (D, "m"), "P": (unit * R**2 * P, "N")}
    fit = study.fit(measured, free=free, progress=False, w_adhesion=middle, **KINDS[kind], **inputs)
    row = {
        "seconds": np.full(len(w), (time.process_time() - begun) / len(w)),
        "status": study.decode(fit.fit_status).values,
    }
    for letter, name, true in (("E", modulus, np.full(len(w), E1)), ("w", "w_adhesion", w * unit * R)):
        row |= {f"{letter} {end}": fit[f"{name}_{end}"].values for end in ("low", "high", "spread")}
        row |= {f"{letter} value": fit[name].values, f"{letter} true": true}
    return row


def report(kind: str, count: int) -> dict[str, np.ndarray]:
    rows = fitted(kind, count)
    for name in (*SHAPES, "all"):
        of_shape = (rows["shape"] == name) | (name == "all")
        words, far, good = [], np.zeros(len(of_shape), bool), of_shape & (rows["status"] == "converged")
        for letter in "Ew":
            value, low, high, spread, true = (
                rows[f"{letter} {end}"] for end in ("value", "low", "high", "spread", "true")
            )
            share = ((low <= true) & (true <= high))[good].mean()
            words.append(f"{letter} {100 * share:.1f} ± {100 * np.sqrt(share * (1 - share) / good.sum()):.1f} %")
            far |= good & (np.abs(value - true) > np.maximum(5 * spread, 0.01 * true))
        counts = dict(zip(*np.unique(rows["status"][of_shape], return_counts=True), strict=True))
        texts = ", ".join(f"{word} {number}" for word, number in counts.items())
        print(f"{kind:7} {name:10} covered {', '.join(words)}; far {far.sum()}", end="; ")
        print(f"{texts}; {rows['seconds'][of_shape].mean():.2f} s a curve", flush=True)
    return rows


if __name__ == "__main__":
    number = int(sys.argv[1]) if sys.argv[1:] else 210
    scenes = len(SHAPES) * sum(map(len, BASES.values()))
    for part in sys.argv[2:] or KINDS:
        report(part, DRAWS * max(1, round(number / scenes / DRAWS)))
