"""The text and the tables of docs/validate.md."""

import numpy as np
import xarray as xr
from validate_cases import LAWS, LAYERED, QUANTITIES, RA
from validate_figures import WORDS
from validate_heights import CELLS_DRAWN, CUT, DRAWS, RINGS, SUMMITS

from solver.laws import LAWS as KNOWN

HEADS = {"D": "depth", "a": "width", "p_max": "largest pressure", "Ar_An": "real area"}
BASES = {"half_space": "", "layered": "", "thin_layer": "thin layer, "}
PAGE = """# Two scales against one

`make validate` presses rough spheres with every asperity resolved, by conjugate gradients on square elements that are
not periodic, and compares them with what two scales say: a base and a micro law. It writes this page, its figures and
`docs/validate.nc`. Each contact is kept once it is solved, so a run that was interrupted goes on where it was.
R = E2* = 1 and Ra = {Ra:g}, on square lattices. `tests/laws/lattice/test_lattice_sphere.py`,
`tests/resolved/test_layered_sphere.py` and `tests/laws/heights/test_heights_sphere.py` have coarse ones.

A percentage is the error of the prediction. "Resolved" is extrapolated from the two finest meshes, ± half the change
from the finest to it. The width is sqrt(5/2 <r²>), r² weighted with the pressure: Hertz's radius of a smooth contact,
and defined as well for separate spots. The area is that of the elements with pressure, less what they stand out over
the edges of the spots (Yastrebov, Anciaux and Molinari, Tribology International 114, 2017, 161). Cell means: the
largest difference, over p(0), of the mean pressure of a cell of the lattice from the nominal pressure p(r) in its
middle, in cells that lie inside the contact by a pitch.

![Cell means of the pressure, and what the laws say](validate.png)

## A half-space

{half_space}

With {spots:.0f} spots the lattice law is as right as with many. The disc cell has A 1 % larger than the lattice at
λ = {one_percent:.3f}, 5 % at {five_percent:.2f} and 10 % at {ten_percent:.2f}.

## Layers

The influence coefficients of a layer on a half-space are Love's of the layer's material, and the Hankel transform of
L - 1 by a kernel that shares nothing with the solver's. Nothing tells the asperities which modulus they feel: that it
is the layer's is a result. A hard bonded layer has no `thin_layer`.

{layer}

With the exact layer and the lattice law the depth is right to {layer_D:.2%}, the width to {layer_a:.2%} and the largest
pressure to {layer_p_max:.2%}, as well as on a half-space. The real area is right as well as it is known here.

## A layer that is thin against the pitch

The same sphere, at a pitch of 0.0054, on a layer of n = 0.5 without friction that becomes thinner; the errors of the
exact layer with the lattice law:

{thinner}

The pitch over h decides, and not the spot over h. The mean pressure is left to the base, which is exact. The laws take
L = 1 for waves as long as a cell and shorter, and the longest of these has L(2πh/pitch). A cell of the lattice on a
layer shows what A errs. To the first order in L - 1 it is a sum over the waves k ≠ 0 of the lattice,

```math
\\delta A = \\frac{{2p}}{{E_1^\\ast}}\\sum_k\\frac{{L(kh) - 1}}k\\,F^2(kb), \\qquad
F(x) = \\frac{{3(\\sin x - x\\cos x)}}{{x^3}}
```

The largest |δA|/A of four layers, n = 0.1 to 5, at three nominal pressures (λ = {lams}), and what p_max errs
there, by resolved cells:

{films}

Up to a pitch of h nothing of this is seen, whatever the spots. The mask `spot_not_small_against_h` of
[validity](model.md#four-answers) asks for b(0) ≤ 0.1 h. Where the spots cover a hundredth of the area or more that is
stricter than need be. Sparse spots are different: a stiff layer bends between them, and the
mask `pitch_not_small_against_h` asks for a pitch ≤ 2 h. With b = 0.1 h on a bonded layer, to the first order, which is
too large where it is large, δA/A is

{sparse}

`model_error` is made of such sums on the hexagonal lattice at p(0): the curvature of a spot changes by
s = (p Ra/E1*) Σ (L - 1) k F², so that p_max errs by exp(0.8 s) - 1, and D by δA (`solver/models/cell_error.py`). Beside
cells on the layer with n from 0.2 to 50, at λ = 0.05 and a pitch of 4 to 16 h, that is 0.7 to 1.3 times the error of
p_max where this is below 1. Up to a pitch of h it is 0.

![Thin layers, and random heights](validate_limits.png)

(a) Two scales against spheres on a layer that becomes thinner. (b) What A errs on a cell: points resolved, lines to the
first order. (c) Mean pressure of rings of cells: points resolved, ± two standard errors, lines the mean field; grey
the disc cell of one height. (d) Depth of the mean plane of periodic cells: points resolved, ± two standard errors.

## Random heights

Summits on a square lattice of the pitch 0.0027, {draws} draws each, on a half-space and on the paper's layer, n = 0.5
without friction; A* = 1/(π N̄ Ra), and normal heights are cut at {cut:g} σ. The depth is that of the mean plane of the
summits, D - cσ of the law. "Scatter" is the standard deviation of one draw, ± the standard error of the mean. "One
height" is `disc_cell`: what leaving the heights out says. Rings: the largest difference of the mean pressure of {rings}
rings of equally many cells, over p(0), ± the largest standard error.

{heights}

The disc cell alone has {disc_D:+.2%} in the depth at this pitch. Elements half as large change the depth of a draw by
{finer_D:+.2%} and its real area by {finer_Ar_An:+.1%}, so the real area is known to that only. The `p_max` of the law
is that of the highest summit it knows, in the middle of the contact. Normal draws of so few summits have none that is
as high there.

The same in periodic cells of {summits} × {summits} summits, {cells_drawn} draws: what the mean field is off in the
depth of the mean plane, in A*, and in λ. p is in E pitch/Ra.

{cells}

σ = 0 is the error of the disc cell itself. The rest is what the mean field leaves out. A high summit presses down what
lies under its neighbours. They carry less than the mean, and so they press it down less than the mean field has it,
which is too deep.
"""


def table(heads: list[str], rows: list[list[str]]) -> str:
    """Rows in Markdown."""
    return "\n".join(f"| {' | '.join(row)} |" for row in [heads, ["---"] * len(heads), *rows])


def predictions(one: xr.Dataset) -> list[list[str]]:
    """What is known of a resolved contact, and the errors of every base and law that is claimed for it."""
    rows = [["resolved", *(f"± {float(one[f'{name}_uncertain']):.3%}" for name in QUANTITIES), ""]]
    for base in one["base"].values:
        for law in LAWS:
            own = one.sel(base=base, law=law)
            if np.isfinite(own["D_error"]):
                errors = [f"{float(own[f'{name}_error']):+.2%}" for name in QUANTITIES]
                rows.append([BASES[base] + WORDS[law], *errors, f"{float(own['cell_error']):.2%}"])
    return rows


def half_space_table(found: xr.Dataset) -> str:
    """The errors, by pitch over a."""
    rows = []
    for name in found["case"].values:
        one = found.sel(case=name)
        first = [f"{float(one['pitch'] / one['a0']):.3f}", f"{spots(one):.0f}", f"{float(one['lam0']):.3f}"]
        rows += [(first if i == 0 else [""] * 3) + row for i, row in enumerate(predictions(one))]
    return table(["pitch/a", "spots", "λ(0)", "law", *HEADS.values(), "cell means"], rows)


def spots(one: xr.Dataset) -> float:
    """Number of spots by the lattice law, N̄πa²."""
    return float(np.pi * (one["a0"] / one["pitch"]) ** 2)


def off_by(share: float) -> float:
    """λ at which A of the disc cell is larger by this share than that of the square lattice."""
    p = np.geomspace(1e-6, 0.3, 400)
    disc, lattice = (KNOWN[name].at(p, 1.0, Nbar=1.0, Ra=1.0) for name in ("disc_cell", "square_lattice"))
    return float(np.interp(share, disc.A / lattice.A - 1, lattice.lam))


def layer_table(found: xr.Dataset) -> str:
    """The errors, by layer."""
    rows = []
    for case in LAYERED:
        one, layer = found.sel(case=case.name), case.layer
        bond = "bonded" if layer.bonded else "frictionless"
        ratios = f"h/a = {layer.h / float(one['a0']):.2f}, pitch/h = {case.pitch / layer.h:.2f}"
        spot = f"λ(0) = {float(one['lam0']):.2f}, b(0)/h = {spot_over_h(one):.3f}"
        first = [case.name, f"n = {layer.n:g}, {bond}", ratios, spot]
        if np.isfinite(one["thin_error"]):
            first.append(f"`model_error` of the thin layer {float(one['thin_error']):.1%}")
        own = predictions(one)
        first += [""] * (len(own) - len(first))
        rows += [[words, *row] for words, row in zip(first, own, strict=True)]
    return table(["layer", "base and law", *HEADS.values(), "cell means"], rows)


def spot_over_h(one: xr.Dataset) -> float:
    """b(0)/h by the lattice law."""
    return float(np.sqrt(one["lam0"] / np.pi) * one["pitch"] / one["h"])


def thinner_table(found: xr.Dataset) -> str:
    """The errors of the best prediction, by pitch over h."""
    rows = []
    for name in found["case"].values:
        one = found.sel(case=name)
        best = one.sel(base="layered", law="square_lattice")
        first = [
            f"{float(one['pitch'] / one['h']):.2f}",
            f"{spot_over_h(one):.2f}",
            f"{float(one['h'] / one['a0']):.2f}",
        ]
        errors = [f"{float(best[f'{key}_error']):+.2%}" for key in ("D", "a", "p_max")]
        rows.append([*first, *errors, f"{float(best['cell_error']):.2%}"])
    heads = [HEADS[key] for key in ("D", "a", "p_max")]
    return table(["pitch/h", "b(0)/h", "h/a", *heads, "cell means"], rows)


def films_table(found: xr.Dataset) -> str:
    """The largest changes over materials and pressures, by pitch over h."""
    largest = abs(found).max(["material", "p"])
    rows = [[words] for words in ("A", "p_max")]
    for row, name in zip(rows, ("change", "peak"), strict=True):
        row += [f"{value:.2%}" for value in largest[name].values]
    return table(["pitch/h", *(f"{pitch:g}" for pitch in found["pitch_over_h"].values)], rows)


def sparse_table(found: xr.Dataset) -> str:
    """δA/A by n and λ."""
    columns = zip(found["lam"].values, found["pitch_over_h"].values, strict=True)
    heads = [f"λ = {lam:g}, pitch/h = {pitch:.1f}" for lam, pitch in columns]
    rows = [[f"n = {n:g}", *(f"{value:+.1%}" for value in found["formula"].sel(n=n).values)] for n in found["n"].values]
    return table(["", *heads], rows)


def heights_table(found: xr.Dataset) -> str:
    """The errors of the law and of one height, and the scatter of the draws."""
    rows, names = [], ("D", "a", "Ar_An", "p_max")
    for case in found["case"].values:
        one = found.sel(case=case)
        scatter = [
            f"± {value / np.sqrt(DRAWS):.2%}, scatter {value:.1%}"
            for value in one["scatter"].sel(quantity=list(names)).values
        ]
        p0 = float(one["p0"])
        rows.append([case, "resolved", *scatter, f"± {float(one['unsure'].max()) / p0:.2%}"])
        for law, words in (("heights", "mean field"), ("one height", "one height")):
            errors = [f"{value:+.1%}" for value in one["error"].sel(law=law, quantity=list(names)).values]
            off = abs(one["law_mean"].sel(law=law) - one["mean"]).max()
            rows.append(["", words, *errors, f"{float(off) / p0:.2%}"])
    return table(["heights", "", *(HEADS[name] for name in names), "rings"], rows)


def cells_table(found: xr.Dataset) -> str:
    """What the mean field is off, by σ and p."""
    rows = []
    for spread in found["spread"].values:
        one = found.sel(spread=spread)
        row = [f"σ = {spread:g} A*"]
        for p in found["p"].values:
            own = one.sel(p=p)
            unsure = float(own["A"].std("draw", ddof=1)) / np.sqrt(CELLS_DRAWN)
            share = float(own["law_lam"] / own["lam"].mean("draw")) - 1
            row.append(f"{float(own['law_A'] - own['A'].mean('draw')):+.3f} ± {unsure:.3f}, λ {share:+.1%}")
        rows.append(row)
    return table(["", *(f"p = {p:g}" for p in found["p"].values)], rows)


TABLES = {
    "half_space": half_space_table,
    "layer": layer_table,
    "thinner": thinner_table,
    "films": films_table,
    "sparse": sparse_table,
    "heights": heights_table,
    "cells": cells_table,
}


def page(parts: dict[str, xr.Dataset]) -> str:
    """The page in Markdown."""
    best = parts["layer"].sel(base="layered", law="square_lattice")
    words = {f"layer_{name}": float(abs(best[f"{name}_error"]).max()) for name in ("D", "a", "p_max")}
    words |= {"Ra": RA, "draws": DRAWS, "rings": RINGS, "cut": CUT, "summits": SUMMITS, "cells_drawn": CELLS_DRAWN}
    words["lams"] = ", ".join(f"{lam:.2f}" for lam in parts["films"]["lam"].values)
    words |= {"one_percent": off_by(0.01), "five_percent": off_by(0.05), "ten_percent": off_by(0.1)}
    words["spots"] = spots(parts["half_space"].isel(case=0))
    words["disc_D"] = float(parts["half_space"]["D_error"].sel(law="disc_cell").isel(case=1, base=0))
    finer = parts["heights"]["finer"]
    words |= {f"finer_{name}": float(finer.sel(quantity=name)) for name in ("D", "Ar_An")}
    return PAGE.format(**words, **{name: write(parts[name]) for name, write in TABLES.items()})
