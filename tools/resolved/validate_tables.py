"""The tables of docs/validate.md and docs/validate_limits.md."""

from itertools import product

import numpy as np
import xarray as xr
from validate_cases import LAWS, LAYERED, QUANTITIES, THIN
from validate_figures import WORDS
from validate_heights import CELLS_DRAWN, DRAWS

from solver.laws import LAWS as BY_NAME

HEADS = {"D": "depth", "a": "width", "p_max": "largest pressure", "Ar_An": "real area"}
BASES = {"half_space": "", "layered": "", "thin_layer": "thin layer, "}
#: Value of `asperities_on` -> its words in tables of thin layers.
FELT = {"half_space": "half-space, ", "layer": "layer, "}


def table(heads: list[str], rows: list[list[str]]) -> str:
    """Rows in Markdown."""
    return "\n".join(f"| {' | '.join(row)} |" for row in [heads, ["---"] * len(heads), *rows])


def predictions(one: xr.Dataset, over: str = "base") -> list[list[str]]:
    """The properties of a resolved contact, and the errors of every law, over the bases or `asperities_on`."""
    rows = [["resolved", *(f"± {float(one[f'{name}_uncertain']):.3%}" for name in QUANTITIES), ""]]
    for way in one[over].values:
        for law in LAWS[over]:
            answer = one.sel({over: way, "law": law})
            if np.isfinite(answer["D_error"]):
                errors = [f"{float(answer[f'{name}_error']):+.2%}" for name in QUANTITIES]
                words = (BASES if over == "base" else FELT)[way] + WORDS[law]
                rows.append([words, *errors, f"{float(answer['cell_error']):.2%}"])
    return rows


def half_space_table(dataset: xr.Dataset) -> str:
    """The errors, by pitch over a."""
    rows = []
    for name in dataset["case"].values:
        one = dataset.sel(case=name)
        first = [f"{float(one['pitch'] / one['a0']):.3f}", f"{spots(one):.0f}", f"{float(one['lam0']):.3f}"]
        rows += [(first if i == 0 else [""] * 3) + row for i, row in enumerate(predictions(one))]
    return table(["pitch/a", "spots", "λ(0)", "law", *HEADS.values(), "cell means"], rows)


def spots(one: xr.Dataset) -> float:
    """Number of spots by the lattice law, N̄πa²."""
    return float(np.pi * (one["a0"] / one["pitch"]) ** 2)


def off_by(share: float) -> float:
    """λ at which A of the disc cell is larger than A of the square lattice by this share."""
    p = np.geomspace(1e-6, 0.3, 400)
    disc, lattice = (BY_NAME[name].at(p, 1.0, Nbar=1.0, Ra=1.0) for name in ("disc_cell", "square_lattice"))
    return float(np.interp(share, disc.A / lattice.A - 1, lattice.lam))


def layer_table(dataset: xr.Dataset) -> str:
    """The errors, by layer."""
    rows = []
    for case in LAYERED:
        one, layer = dataset.sel(case=case.name), case.layer
        bond = "bonded" if layer.bonded else "frictionless"
        ratios = f"h/a = {layer.h / float(one['a0']):.2f}, pitch/h = {case.pitch / layer.h:.2f}"
        spot = f"λ(0) = {float(one['lam0']):.2f}, b(0)/h = {spot_over_h(one):.3f}"
        first = [case.name, f"n = {layer.n:g}, {bond}", ratios, spot]
        thin_error = float(one["model_error"].sel(base="thin_layer", law="square_lattice"))
        if np.isfinite(thin_error):
            first.append(f"`model_error` of the thin layer {thin_error:.1%}")
        model_rows = predictions(one)
        first += [""] * (len(model_rows) - len(first))
        rows += [[words, *row] for words, row in zip(first, model_rows, strict=True)]
    return table(["layer", "base and law", *HEADS.values(), "cell means"], rows)


def spot_over_h(one: xr.Dataset) -> float:
    """b(0)/h by the lattice law."""
    return float(np.sqrt(one["lam0"] / np.pi) * one["pitch"] / one["h"])


def thin_table(dataset: xr.Dataset) -> str:
    """The errors, by layer and `asperities_on`, with `model_error`."""
    rows = []
    for case in THIN:
        one = dataset.sel(case=case.name)
        ratios = f"h/a = {case.layer.h / float(one['a0']):.3f}, pitch/h = {case.pitch / case.layer.h:.2g}"
        first = [case.name, ratios, f"λ(0) = {float(one['lam0']):.2f}, b(0)/h = {spot_over_h(one):.2f}"]
        model_rows = predictions(one, "asperities_on")
        first += [""] * (len(model_rows) - len(first))
        cells = ["", *(f"{float(value):.1%}" for value in one["model_error"].values.ravel())]
        rows += [[words, *row, error] for words, row, error in zip(first, model_rows, cells, strict=True)]
    return table(["layer", "asperities on, law", *HEADS.values(), "cell means", "`model_error`"], rows)


def thinner_table(dataset: xr.Dataset) -> str:
    """The errors of the lattice law on a half-space and on the layer, by pitch over h."""
    rows = []
    for name in dataset["case"].values:
        one = dataset.sel(case=name, law="square_lattice")
        row = [f"{float(one['pitch'] / one['h']):.2f}", f"{spot_over_h(one):.2f}"]
        for key in ("D_error", "a_error", "p_max_error", "cell_error"):
            form = "{:.2%}" if key == "cell_error" else "{:+.2%}"
            row += [form.format(float(one[key].sel(asperities_on=on))) for on in ("half_space", "layer")]
        rows.append(row)
    heads = [HEADS[key] for key in ("D", "a", "p_max")]
    names = [name for head in (*heads, "cell means") for name in (f"{head}: half-space", "layer")]
    return table(["pitch/h", "b(0)/h", *names], rows)


def cell_table(dataset: xr.Dataset) -> str:
    """The properties of each resolved cell, and the errors of both laws."""
    rows = []
    for i in range(dataset.sizes["cell"]):
        one = dataset.isel(cell=i)
        bond = "bonded" if one["bonded"] else "frictionless"
        row = [
            f"{float(one['pitch_over_h']):g}",
            f"{float(one['lam']):g}",
            one["lattice"].item(),
            f"{float(one['n']):g}, {bond}",
        ]
        row += [f"{float(one[name]):g}" for name in ("nu1", "m")]
        for on, digits in (("half_space", 1), ("layer", 2)):
            row += [f"{float(value):+.{digits}%}" for value in one["error"].sel(on=on).values]
        rows.append(row)
    heads = [name for on in ("half-space", "layer") for name in (f"{on}: A", "λ", "p_max")]
    return table(["pitch/h", "λ", "lattice", "n, interface", "ν1", "m", *heads], rows)


def films_table(dataset: xr.Dataset) -> str:
    """The largest errors over materials and λ, by pitch over h."""
    largest, rows = abs(dataset["error"]).max(["material", "lam"]), []
    for on, words, digits in (("half_space", "half-space", 2), ("layer", "layer", 3)):
        for name, symbol in (("A", "A"), ("p_max", "p_max")):
            values = largest.sel(on=on, quantity=name).values
            rows.append([f"{words}, {symbol}", *(f"{value:.{digits}%}" for value in values)])
    return table(["pitch/h", *(f"{pitch:g}" for pitch in dataset["pitch_over_h"].values)], rows)


def sparse_table(dataset: xr.Dataset) -> str:
    """A over that on a half-space, less 1, by n and λ."""
    columns = zip(dataset["lam"].values, dataset["pitch_over_h"].values, strict=True)
    heads = [f"λ = {lam:g}, pitch/h = {pitch:.1f}" for lam, pitch in columns]
    rows = [
        [f"n = {n:g}", *(f"{value:+.1%}" for value in dataset["change"].sel(n=n).values)] for n in dataset["n"].values
    ]
    return table(["", *heads], rows)


def heights_table(dataset: xr.Dataset) -> str:
    """The errors of the law and of one height, and the scatter of the draws."""
    rows, names = [], ("D", "a", "Ar_An", "p_max")
    for case in dataset["case"].values:
        one = dataset.sel(case=case)
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


def cells_table(dataset: xr.Dataset) -> str:
    """The errors of the mean field, by σ and p."""
    rows = []
    for spread in dataset["spread"].values:
        one = dataset.sel(spread=spread)
        row = [f"σ = {spread:g} A*"]
        for p in dataset["p"].values:
            patches = one.sel(p=p)
            unsure = float(patches["A"].std("draw", ddof=1)) / np.sqrt(CELLS_DRAWN)
            share = float(patches["law_lam"] / patches["lam"].mean("draw")) - 1
            row.append(f"{float(patches['law_A'] - patches['A'].mean('draw')):+.3f} ± {unsure:.3f}, λ {share:+.1%}")
        rows.append(row)
    return table(["", *(f"p = {p:g}" for p in dataset["p"].values)], rows)


def layer_cells_table(dataset: xr.Dataset) -> str:
    """The errors of the mean field on a half-space and on the layer, by layer, σ and p."""
    rows = []
    for layer, spread in product(dataset["layer"].values, dataset["spread"].values):
        some = dataset.sel(layer=layer, spread=spread)
        for on, words in (("half_space", "half-space"), ("layer", "layer")):
            row = [f"{layer}, σ = {spread:g} A*", words]
            for p in dataset["p"].values:
                one = some.sel(p=p)
                unsure = float(one["A"].std("draw", ddof=1)) / np.sqrt(CELLS_DRAWN)
                off = float(one["law_A"].sel(on=on) - one["A"].mean("draw"))
                share = float(one["law_lam"].sel(on=on) / one["lam"].mean("draw")) - 1
                row.append(f"{off:+.3f} ± {unsure:.3f}, λ {share:+.1%}")
            rows.append(row)
    return table(["layer", "asperities on", *(f"p = {p:g}" for p in dataset["p"].values)], rows)


def thick_table(dataset: xr.Dataset) -> str:
    """The difference of A from the half-space of the layer's material, also over L(Gh) - 1, by pitch over h."""
    off, over = (dataset[name].sel(quantity="A") for name in ("thick", "over"))
    rows = []
    for n in dataset["n"].values:
        rows.append([f"A, n = {n:g}", *(f"{value:+.1e}" for value in off.sel(n=n).values)])
        rows.append(["over L(Gh) - 1", *(f"{value:.4f}" for value in over.sel(n=n).values)])
    return table(["pitch/h", *(f"{pitch:g}" for pitch in dataset["thick_pitch"].values)], rows)


def alike_table(dataset: xr.Dataset) -> str:
    """The differences of p, A and p_max from those of the body, by n - 1."""
    rows = [
        [name, *(f"{value:+.1e}" for value in dataset["alike"].sel(quantity=name).values)]
        for name in ("p", "A", "p_max")
    ]
    return table(["n - 1", *(f"{more:g}" for more in dataset["more"].values)], rows)


def thin_rates_table(dataset: xr.Dataset) -> str:
    """The differences of p, A and p_max from those of the body alone, by pitch over h."""
    rows = []
    for n in dataset["n"].values:
        for name in ("p", "A", "p_max"):
            off = dataset["thin"].sel(n=n, quantity=name).values
            left = [f"{value:+.2%}" + (f", x {value / before:.2f}" if before else "")
                    for before, value in zip([0.0, *off[:-1]], off, strict=True)]  # fmt: skip
            rows.append([f"{name}, n = {n:g}", *left])
    return table(["pitch/h", *(f"{pitch:g}" for pitch in dataset["thin_pitch"].values)], rows)
