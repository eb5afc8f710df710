"""docs/tradeoff.md: what the work-precision study says, written from its dataset."""

import textwrap

import numpy as np
import xarray as xr

from ..paper import paper_error
from .tradeoff import COPIES
from .tradeoff_view import MODELS

TARGETS = (1e-2, 1e-3, 1e-4, 1e-6, 1e-9)
ERRORS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
"""Where the paper's way is set beside Newton."""
SETTLED = 0.95
"""A setting reaches a target when this share of the cases ends and 95 % of all are within it."""

TEXT = """
# Work and precision

Written by `make tradeoff`, which measured every number on this page.

![Error against time per case of every way, a panel for each problem set](tradeoff.png)

Time is processor time of one thread for one batch, the shortest of several runs, over the number of cases ({cpu}); for
Newton's method each case of the paper's sets stands {copies} times in the batch. The error of a case is its largest
relative error over a, P, D, p(0), pmax and Ar/An against the solution at rtol 1e-11; a case without an answer, or more
than 100 % off, counts as 100 %. The figure shows the error below which 95 % of the cases are. The sets (units R = E2* =
1; cases: {sizes}):

- **paper, layer** and **paper, half-space**: the five roughnesses of Table 1 as power laws, P from 1e-6 to 5e-5
- **coatings**: exact layer and law, both interfaces, n from 1e-3 to 1e3, h from 1e-3 to 0.1, P from 1e-7 to 1e-3
- **extremes**: thin layer and half-space, both laws and interfaces, P from 1e-12 to 0.1, h from 1e-8 to 1e3, n from
  1e-6 to 1, N̄Ra² from 1e-6 to 1e6, β from 0.3 to 0.95; cases without a solution, as `status` says, are left out (the
  exact layer has its own extremes, `make extremes`)

*The paper's way*: N equal intervals, pressure linear between them, the kernel integrated exactly against it, Eqs (8)
and (10) with k, from p = 0 and, at each further radius, from the pressure at the one before; the radius by halving.
Both stop at 0.3/N², so that the mesh is the largest error, or after 200 approximations, 40 (1 + k) if that is more. It
is measured on {slow} cases spread over a set, with k = 35 on {slowest}, in the same batched numpy as the rest: only the
method differs. Which mesh and stopping rule the paper used it does not say.

Time per case in µs of the cheapest setting with which 95 % of the cases are within the error; - where there is none:

{cheapest}

On the paper's layer, the paper's way at its cheapest beside Newton (rtol):

{factors}

**Reading.** Each further digit takes the paper's way three times as many intervals, for the mesh is of second order,
and a larger k, for the last node is nearer to the edge. Without a layer the scheme (10) is the bottleneck: on its
worst mesh {ended} of the cases end. The models differ by more than the methods err: the exact layer for the thin one
changes half of the paper's cases by {main:.1%} or more; to {refused:.0%} of the coatings the thin layer does not apply
at all. The power law for the exact law changes half of the coatings by {law:.1%} or more. To solve the simpler models
to more than two or three digits is work without precision.

## Where the paper's 0.6 % may come from

With k = 0, the plain form of Eq. (8), the iterates at a = 0.04 alternate about the answer and close in on it slowly.
Iterate {number} has the printed load, iterate {next} the printed depth of the rough layered contact; and the other
contacts have nearly the printed depths and area if they are given the load of the latter:

{origin}

The mesh hardly matters: iterate {number} has P = {meshes} (intervals). So an iteration stopped early explains the load,
the depths and the area within {within:.1%}. It does not explain A[p(0)], and it is one whole number fitted to six: an
explanation, not a proof.
"""
EXPLAINED = ("load", "D,", "An over")


def page(found: xr.Dataset) -> str:
    """The page, in Markdown."""
    counts = found["cases"].max("way")
    words = {
        "cpu": found.attrs["cpu"],
        "sizes": "; ".join(f"{name}: {int(counts.sel(set=name))}" for name in found["set"].values.tolist()),
        "slow": int(found["cases"].sel(way="paper k = 1").max()),
        "copies": COPIES,
        "slowest": int(found["cases"].sel(way="paper k = 35").max()),
        "factors": factors(found.sel(set="paper, layer")),
    }
    filled = TEXT.format(**words, **cheapest(found), **reading(found), **origin(found)).strip()
    return "\n\n".join(map(wrapped, filled.split("\n\n"))) + "\n"


def wrapped(block: str) -> str:
    """A paragraph of prose with lines of 120; anything else as it is."""
    prose = block[0] not in "#!|-"
    return textwrap.fill(block, 120, break_long_words=False, break_on_hyphens=False) if prose else block


def table(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def cheapest(found: xr.Dataset) -> dict:
    """Time per case of the cheapest setting that reaches each target, for each way and set."""
    rows = []
    for name in found["set"].values.tolist():
        for way in found["way"].values.tolist():
            part = found.sel(set=name, way=way)
            if way not in MODELS and int(part["cases"]):
                times = [time_to(part, target) for target in TARGETS]
                rows.append([name, way, *(f"{t:.3g}" if np.isfinite(t) else "-" for t in times)])
    return {"cheapest": table(["set", "way", *(f"{target:g}" for target in TARGETS)], rows)}


def time_to(part: xr.Dataset, target: float) -> float:
    """µs per case of the cheapest setting of one way that reaches the target; inf when none does."""
    reached = (part["most"].values <= target) & (part["ended"].values >= SETTLED)
    return 1e6 * float(np.min(part["time"].values[reached], initial=np.inf))


def papers_ways(found: xr.Dataset) -> list[str]:
    """The ways that are the paper's and were measured."""
    measured = found["way"].values[found["cases"].values > 0].tolist()
    return [way for way in measured if way.startswith("paper")]


def factors(layer: xr.Dataset) -> str:
    """Table of how many times the paper's way takes what Newton takes for the same error, on one set."""
    rows = []
    for target in ERRORS:
        theirs, way = min((time_to(layer.sel(way=way), target), way) for way in papers_ways(layer))
        newton = time_to(layer.sel(way="newton, rtol"), target)
        if np.isfinite(theirs):
            words = way.removeprefix("paper ")
            rows.append([f"{target:g}", f"{theirs:.3g}", words, f"{newton:.3g}", f"{theirs / newton:.0f}"])
    return table(["error", "the paper's way, µs", "with", "Newton, µs", "factor"], rows)


def reading(found: xr.Dataset) -> dict:
    """Numbers of the paragraph of reading."""
    layer, bare, coatings = (found.sel(set=name) for name in ("paper, layer", "paper, half-space", "coatings"))
    shares = [
        f"{float(bare.sel(way=way)['ended'].min()):.0%} ({way.removeprefix('paper ')})" for way in papers_ways(bare)
    ]
    return {
        "ended": ", ".join(shares),
        "main": float(layer["median"].sel(way="the other layer")[0]),
        "law": float(coatings["median"].sel(way="the other law")[0]),
        "refused": 1 - float(coatings["ended"].sel(way="the other layer")[0]),
    }


def origin(found: xr.Dataset) -> dict:
    """Numbers of the section on the paper's 0.6 %."""
    pair = paper_error.nearest_pair(found)
    number = int(found["iterate"][pair["iterate"]])
    loads = found["iterate_P"].isel(iterate=pair["iterate"])
    rows, misses = [], []
    for quantity, printed, *ours in paper_error.explained(found):
        rows.append([quantity, f"{printed:.4g}"])
        for value in ours:
            rows[-1] += [f"{value:.5g}", f"{value / printed - 1:+.2%}"]
        misses += [abs(ours[-1] / printed - 1)] if quantity.startswith(EXPLAINED) else []
    return {
        "number": number,
        "next": number + 1,
        "meshes": ", ".join(f"{float(load):.4e} ({int(load['intervals'])})" for load in loads),
        "origin": table(["quantity", "paper", "converged", "", f"iterates {number}, {number + 1}", ""], rows),
        "within": max(misses),
    }
