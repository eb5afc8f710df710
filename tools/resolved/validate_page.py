"""The texts of docs/validate.md and docs/validate_limits.md."""

import xarray as xr
from validate_cases import RA
from validate_cells import MATERIALS, MESHES, POINTS
from validate_heights import CELLS_DRAWN, CUT, DRAWS, RINGS, SUMMITS
from validate_rates import LAM
from validate_tables import (
    alike_table,
    cell_table,
    cells_table,
    films_table,
    half_space_table,
    heights_table,
    layer_cells_table,
    layer_table,
    off_by,
    sparse_table,
    spots,
    thick_table,
    thin_rates_table,
    thin_table,
    thinner_table,
)

#: On one processor, an AMD EPYC, measured without stored contacts.
MINUTES = 7
PAGE = """# Two scales against one

Are two scales, a base and a micro law, right? `make validate` presses rough spheres with every asperity resolved, by
conjugate gradients on square elements that are not periodic, and compares them with the two scales. It writes this
page, [the limits and random heights](validate_limits.md), the figures and `docs/validate.nc`. It takes {minutes}
minutes of a processor. Each contact is kept once it is solved, so a run that was interrupted goes on where it was.
R = E2* = 1 and Ra = {Ra:g}, on square lattices.
`tests/laws/lattice/test_lattice_sphere.py`, `tests/resolved/test_layered_sphere.py` and
`tests/laws/heights/test_heights_sphere.py` have coarse ones.

A percentage is the error of the prediction. "Resolved" is extrapolated from the two finest meshes, ± half the change
from the finest to it. The width is sqrt(5/2 <r²>), r² weighted with the pressure: Hertz's radius of a smooth contact,
and defined for separate spots as well. The area is that of the elements with pressure, less the parts of them beyond
the edges of the spots (Yastrebov, Anciaux and Molinari, Tribology International 114, 2017, 161). "Cell means" is the
largest difference, over p(0), between the mean pressure of a cell of the lattice and the nominal pressure p(r) in its
middle, in cells that lie inside the contact by a pitch.

![Cell means of the pressure, and what the laws say](validate.png)

## A half-space

{half_space}

With {spots:.0f} spots the lattice law is as right as with many. The disc cell has A 1 % larger than the lattice at
λ = {one_percent:.3f}, 5 % at {five_percent:.2f} and 10 % at {ten_percent:.2f}.

## Layers

The influence coefficients of a layer on a half-space are Love's of the layer's material, and the Hankel transform of
L - 1 by a kernel that shares nothing with the solver's. Nothing tells the asperities which modulus they feel: it is a
result that they feel the layer's. A hard bonded layer has no `thin_layer`.

{layer}

With the exact layer and the lattice law the depth is right to {layer_D:.2%}, the width to {layer_a:.2%} and the largest
pressure to {layer_p_max:.2%}, as well as on a half-space. The real area is right as well as it is known here.

## A layer that is thin compared with the pitch

Asperities may press on a half-space of the layer's material, as in the paper, `asperities_on = "half_space"`, or on the
[coated body itself](coated_body.md), `"layer"`. `"auto"`, the default, takes the coated body where their pitch is above
h. The base, which is exact in both cases, gives the mean pressure.

### Spheres

The same sphere, at a pitch of 0.0054, on four layers, and on the hardest also with half the pitch and half of h:

{thin}

On the coated body the lattice law is right to {thin_D:.2%} in the depth, {thin_a:.2%} in the width and {thin_p_max:.2%}
in the largest pressure, which is known to {known_p_max:.2%}; the real area is right as well as it is known. The
remaining errors of depth and width are those of two scales with few spots, {thin_spots}: with four times as many the
hardest layer has {more_D:.2%} and {more_a:.2%}. `model_error` of asperities on the half-space is the change that the
coated body would make; that of the disc cell includes the change that a lattice would make.

The next table has a layer of n = 0.5 without friction that becomes thinner. The errors are those of the lattice law on
a half-space of the layer's material and on the layer:

{thinner}

### Cells

Twenty-four cells of a lattice, on the kernel of the layer, by the conjugate gradients of `solver.laws.periodic_rows`
on {mesh} elements along a period. λ is that of the law on the coated body, from which the nominal pressure follows;
m is E1*/E3* of an elastic punch.

{cell_rows}

The largest errors on the coated body are {cells_A:.2%} in A, {cells_lam:.2%} in λ, which is counted in elements, and
{cells_p_max:.2%} in p_max. On a half-space of the layer's material they are {bare_A:.0%}, {bare_lam:.0%} and
{bare_p_max:.0%}.

![Errors of A and of the largest pressure of 24 cells](validate_cells.png)

Full points are on the coated body, open points on a half-space of the layer's material. The dotted line is 1 %.

### From which pitch on

The largest errors of {materials} layers, n = 0.2 to 20, at the contact fractions λ = {lams}, by resolved cells
of {points} elements a side:

{films}

Up to a pitch of h the body has no visible effect, whatever the spots: there `"auto"` stays with the half-space. Beyond,
the pitch over h decides, not the spot over h alone. For asperities on a half-space, the mask `spot_not_small_against_h`
of [validity](four_answers.md#validity) asks for b(0) ≤ 0.1 h, and `pitch_not_small_against_h` for a pitch ≤ 2 h. The
next table has b = 0.1 h on a bonded layer, and shows A on the coated body, over that on a half-space, less 1:

{sparse}

Where the spots cover a hundredth of the area or more the first mask is stricter than necessary. Sparse spots are
different: a stiff layer bends between them.

![Thin layers, and random heights](validate_limits.png)

(a) Two scales against spheres on a layer that becomes thinner. (b) The change that the coated body makes in A of a
cell: points resolved, lines the law. (c) Mean pressure of rings of cells: points resolved, ± two standard errors, lines
the mean field; grey the disc cell of one height. (d) Depth of the mean plane of periodic cells: points resolved, ± two
standard errors.
"""
LIMITS = """# Two scales at their limits

How fast does the law on the coated body tend to its limits, and is the mean field of random heights right? This page
goes on where [validate.md](validate.md) ends, and says "resolved" as that page does.

## Limits of the coated body

How fast the law on the coated body tends to its limits, on a square lattice with λ = {rate_lam:g}, bonded, ν1 = 0.25. A
*thick* layer differs from a half-space of its material as L(Gh) - 1 of the longest wave G = 2π/pitch, which falls as
e^(-2Gh): the ratio of both tends to one number for all bodies.

{thick}

The difference of a layer *nearly like its body*, with the same ν, is proportional to n - 1. The table is for a pitch of
8 h. A layer of the same material does not differ at all:

{alike}

A layer that is *thin against the spots* is the half-space of the body, with the modulus E2*. The differences fall a
little more slowly than h, as h ln(l/h):

{thin_rates}

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

σ = 0 is the error of the disc cell itself. The rest is the error of the mean field. A high summit presses down the
surface under its neighbours. The neighbours carry less than the mean load, and so they press the surface down less than
the mean field assumes. So the depth of the mean field is too large.

The same cells on bonded layers of a sixth of the pitch, compared with the mean field of asperities on a half-space of
the layer's material and on the layer:

{height_cells}
"""

#: Name in the text -> the part of the results, and the function of its table.
TABLES = {
    "half_space": ("half_space", half_space_table),
    "layer": ("layer", layer_table),
    "thin": ("thin", thin_table),
    "thinner": ("thinner", thinner_table),
    "cell_rows": ("layer_cells", cell_table),
    "films": ("films", films_table),
    "sparse": ("sparse", sparse_table),
    "thick": ("rates", thick_table),
    "alike": ("rates", alike_table),
    "thin_rates": ("rates", thin_rates_table),
    "heights": ("heights", heights_table),
    "cells": ("cells", cells_table),
    "height_cells": ("height_cells", layer_cells_table),
}


def texts(parts: dict[str, xr.Dataset]) -> dict[str, str]:
    """Name of a page -> its Markdown."""
    words = {"Ra": RA, "draws": DRAWS, "rings": RINGS, "cut": CUT, "summits": SUMMITS, "cells_drawn": CELLS_DRAWN}
    words |= {"one_percent": off_by(0.01), "five_percent": off_by(0.05), "ten_percent": off_by(0.1)}
    words |= {"minutes": MINUTES} | of_spheres(parts) | of_cells(parts) | {"rate_lam": LAM}
    finer = parts["heights"]["finer"]
    words |= {f"finer_{name}": float(finer.sel(quantity=name)) for name in ("D", "Ar_An")}
    words |= {name: write(parts[part]) for name, (part, write) in TABLES.items()}
    return {name: text.format(**words) for name, text in (("validate", PAGE), ("validate_limits", LIMITS))}


def of_spheres(parts: dict[str, xr.Dataset]) -> dict:
    """Numbers in the text about spheres with asperities of one height."""
    thin = parts["thin"].sel(asperities_on="layer", law="square_lattice")
    best = {"layer": parts["layer"].sel(base="layered", law="square_lattice"), "thin": thin}
    words = {
        f"{part}_{name}": float(abs(one[f"{name}_error"]).max())
        for part, one in best.items()
        for name in ("D", "a", "p_max")
    }
    words["spots"] = spots(parts["half_space"].isel(case=0))
    counts = [spots(parts["thin"].isel(case=i)) for i in range(parts["thin"].sizes["case"] - 1)]
    words["thin_spots"] = f"{min(counts):.0f} to {max(counts):.0f}"
    words["known_p_max"] = float(parts["thin"]["p_max_uncertain"].max())
    words |= {f"more_{name}": abs(float(thin[f"{name}_error"][-1])) for name in ("D", "a")}
    words["disc_D"] = float(parts["half_space"]["D_error"].sel(law="disc_cell").isel(case=1, base=0))
    return words


def of_cells(parts: dict[str, xr.Dataset]) -> dict:
    """Numbers in the text about cells on layers."""
    cells, words = parts["layer_cells"], {"mesh": MESHES[-1], "materials": len(MATERIALS), "points": POINTS}
    words["lams"] = ", ".join(f"{lam:g}" for lam in parts["films"]["lam"].values)
    for start, on in (("cells", "layer"), ("bare", "half_space")):
        largest = abs(cells["error"]).sel(on=on).max("cell")
        words |= {f"{start}_{name}": float(largest.sel(quantity=name)) for name in ("A", "lam", "p_max")}
    return words
