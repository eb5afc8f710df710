"""`make validate`: the two scales against one. Rough spheres on a half-space with every asperity resolved, beside the
predictions of the power law, of the disc cell and of the square lattice: docs/validate.nc, .md and .png.

    python tests/validate.py

Each contact and resolution is kept in results/validate as soon as it is solved; what is there is not solved again.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr
from rough_sphere import Resolved, cell_means, resolved, width

import study
from study.figures.style import style

LOAD, RA = 2e-5, 0.004
#: Pitch -> cells a side, an odd number, so that a summit is in the middle; points a cell, each twice as many.
CASES = {0.0054: (13, (24, 48)), 0.0027: (25, (16, 32)), 0.00135: (51, (8, 16))}
LAWS = ("power_law", "disc_cell", "square_lattice")
QUANTITIES = {"D": "depth", "a": "width sqrt(5/2 <r²>)", "p_max": "largest pressure", "Ar_An": "real contact area"}
WORDS = {"power_law": "power law", "disc_cell": "disc cell", "square_lattice": "square lattice"}
PAGE = """# Two scales against one

`make validate` presses rough spheres on a half-space with every asperity resolved, by conjugate gradients on square
elements that are not periodic, and compares them with what two scales say: base = "half_space" and a micro law. It
writes this page, its figure and `docs/validate.nc`. R = E* = 1, load {load:g}, Ra = {Ra:g}, square lattices of three
pitches. `tests/laws/test_lattice_sphere.py` has a coarse one.

![Cell means of the pressure, and what the laws say](validate.png)

Error of the prediction:

{table}

"Resolved" is extrapolated from the two finest meshes, ± half the change from the finest to it. The width is
sqrt(5/2 <r²>), r² weighted with the pressure: Hertz's radius of a smooth contact, and defined as well for separate
spots. The area is that of the elements with pressure. Cell means: the largest difference, over p(0), of the mean
pressure of a cell of the lattice from the nominal pressure p(r) in its middle, in cells that lie inside the contact
by a pitch.
"""


def solved(pitch: float, folder: Path) -> list[Resolved]:
    """The contact on each of its meshes, from the folder or solved now; each begins with the one before."""
    cells, counts = CASES[pitch]
    found, start = [], None
    for count in counts:
        path = folder / f"{pitch:g}_{count}.npz"
        if not path.exists():
            one = resolved(pitch, RA, LOAD, cells * pitch / 2, cells * count, start, tolerance=1e-6)
            path.parent.mkdir(parents=True, exist_ok=True)
            np.savez_compressed(path.with_suffix(".part.npz"), **one._asdict())
            path.with_suffix(".part.npz").replace(path)
            print(path, flush=True)
        with np.load(path) as data:
            found.append(Resolved(*(data[name] if data[name].ndim else float(data[name]) for name in Resolved._fields)))
        start = np.kron(found[-1].p, np.ones((2, 2)))
    return found


def measured(found: Resolved, pitch: float) -> dict[str, float]:
    """The QUANTITIES of one mesh; the area in R²."""
    r = np.hypot(found.middle[:, None], found.middle[None, :])
    area = np.count_nonzero(found.p) * found.side**2
    return {"D": found.D, "a": width(r, found.p, 1.0), "p_max": found.p.max(), "Ar_An": area}


def predicted(pitch: float) -> xr.Dataset:
    """The two scales, over the laws, in the quantities of `measured`."""
    given = {"P": LOAD, "base": "half_space", "Nbar": pitch**-2, "Ra": RA, "x": 801, "rtol": 1e-6}
    found = study.solve(**given, micro=list(LAWS)).load()
    x, p = found["x"].values, found["p"].transpose("micro", "x").values
    scaled = [width(x, one, x) for one in p]
    found["width"] = ("micro", scaled * found["a"].values)
    found["area"] = found["Ar_An"] * np.pi * found["a"] ** 2
    return found


def compared(folder: Path) -> xr.Dataset:
    """Everything that is shown: over (pitch, law), and the cells."""
    rows = []
    for pitch in CASES:
        meshes, two = solved(pitch, folder), predicted(pitch)
        values = {name: [measured(mesh, pitch)[name] for mesh in meshes] for name in QUANTITIES}
        finest = {name: richardson(list_, 1 if name == "Ar_An" else 2) for name, list_ in values.items()}
        spread = {name: abs(finest[name] - values[name][-1]) / 2 for name in QUANTITIES}
        names = {"D": "D", "a": "width", "p_max": "p_max", "Ar_An": "area"}
        r, mean = cell_means(meshes[-1], pitch)
        data = {f"{name}_resolved": finest[name] for name in QUANTITIES}
        data |= {f"{name}_uncertain": spread[name] / finest[name] for name in QUANTITIES}
        data |= {f"{name}_error": ("law", two[names[name]].values / finest[name] - 1) for name in QUANTITIES}
        data |= {
            "a0": float(two["a"][-1]),
            "lam0": float(two["lam"][-1, 0]),
            "cell_error": ("law", cells(r, mean, two, pitch)),
        }
        padded = np.full((2, 2000), np.nan)
        padded[:, : len(r)] = r, mean
        data |= {"r": ("cell", padded[0]), "mean": ("cell", padded[1])}
        shown = two.isel(x=slice(None, None, 8))
        data["profile_r"] = (("law", "x"), shown["x"].values * shown["a"].values[:, None])
        data["profile"] = (("law", "x"), shown["p"].transpose("micro", "x").values)
        rows.append(xr.Dataset(data))
    found = xr.concat(rows, "pitch").assign_coords(pitch=list(CASES), law=list(LAWS))
    return found.dropna("cell", how="all")


def richardson(values: list[float], order: int) -> float:
    """The limit of values on meshes each twice as fine, from the last two, if the error is of this order."""
    return values[-1] + (values[-1] - values[-2]) / (2**order - 1)


def cells(r, mean, two: xr.Dataset, pitch: float) -> list[float]:
    """Largest difference of a cell's mean from p(r), over p(0), of each law."""
    errors = []
    for one, a in zip(two["p"].transpose("micro", "x").values, two["a"].values, strict=True):
        inside = r < a - pitch
        errors.append(np.abs(np.interp(r[inside], two["x"].values * a, one) - mean[inside]).max() / one[0])
    return errors


def table(found: xr.Dataset) -> str:
    """The errors in Markdown, and how sure the resolved contact is."""
    heads = ["pitch/a", "λ(0)", "law", *QUANTITIES.values(), "cell means"]
    lines = [heads, ["---"] * len(heads)]
    for pitch in found["pitch"].values:
        one = found.sel(pitch=pitch)
        first = [f"{pitch / float(one['a0']):.3f}", f"{float(one['lam0']):.3f}"]
        sure = [f"± {float(one[f'{name}_uncertain']):.3%}" for name in QUANTITIES]
        lines.append([*first, "resolved", *sure, ""])
        for law in LAWS:
            errors = [f"{float(one[f'{name}_error'].sel(law=law)):+.2%}" for name in QUANTITIES]
            lines.append(["", "", WORDS[law], *errors, f"{float(one['cell_error'].sel(law=law)):.2%}"])
    return "\n".join(f"| {' | '.join(row)} |" for row in lines)


def draw(found: xr.Dataset, path: Path) -> None:
    """Cell means over r/a with the nominal pressure of each law; below, the differences from the lattice."""
    from matplotlib.figure import Figure

    looks = {"power_law": ("C1", (0, (1, 1.2))), "disc_cell": ("C2", (0, (4, 2))), "square_lattice": ("C0", "-")}
    with style():
        figure = Figure(figsize=(6.9, 3.9), layout="constrained")
        panels = figure.subplots(2, len(CASES), sharex=True, height_ratios=(2, 1), sharey="row")
        for (top, below), pitch in zip(panels.T, CASES, strict=True):
            one = found.sel(pitch=pitch)
            a, p0 = float(one["a0"]), float(one["profile"][-1, 0])
            r, mean = one["r"].values, one["mean"].values
            for law in LAWS:
                profile = one.sel(law=law)
                colour, dashes = looks[law]
                x, p = profile["profile_r"].values, profile["profile"].values
                top.plot(x / a, 100 * p, color=colour, linestyle=dashes, label=WORDS[law], linewidth=1)
                below.plot(
                    r / a,
                    100 * (np.interp(r, x, p, right=0) - mean) / p0,
                    color=colour,
                    marker="o",
                    linestyle="",
                    ms=1.6,
                )
            top.plot(r / a, 100 * mean, "k.", markersize=3, label="resolved, mean of a cell")
            top.set_title(f"pitch = {pitch / a:.3f} a", fontsize=8)
            below.axhline(0, color="0.5", linewidth=0.6)
            below.set(xlabel="$r/a$", xlim=(0, 1.05))
        panels[0, 0].set_ylabel("$100\\,p/E^*$")
        panels[1, 0].set_ylabel("off / $p(0)$ (%)")
        panels[0, 0].legend(fontsize=6.5, loc="lower left")
        figure.savefig(path)


def main(docs: Path, folder: Path) -> None:
    """Solve what is missing, and write the three files."""
    found = compared(folder)
    found.attrs |= {"load": LOAD, "Ra": RA, "command": "make validate"}
    found.to_netcdf(docs / "validate.nc")
    draw(found, docs / "validate.png")
    (docs / "validate.md").write_text(PAGE.format(load=LOAD, Ra=RA, table=table(found)), encoding="utf-8")


if __name__ == "__main__":
    main(Path(*sys.argv[1:2] or ["docs"]), Path("results/validate"))
