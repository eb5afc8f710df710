"""`make validate`: the model of two scales against resolved asperities. Rough spheres with every asperity resolved, on
a half-space and on layers, of one height and of random heights, and cells of a lattice on layers, are compared with the
predictions: docs/validate.nc, .md, .png, validate_cells.png, validate_limits.md, .png.

    python tools/resolved/validate.py

Each contact is stored in results/validate as soon as it is solved, and is not solved again. Delete that folder after a
change of this code.
"""

import sys
from pathlib import Path

import xarray as xr
from validate_cases import HALF_SPACE, LAYERED, THIN, THINNER, together
from validate_cells import cells as layer_cells
from validate_cells import films, sparse
from validate_figures import draw_cells, draw_limits, draw_means
from validate_heights import SPHERES, cells, compared, finer, height_cells
from validate_page import texts
from validate_rates import rates


def all_data(folder: Path) -> dict[str, xr.Dataset]:
    """All data of the pages and figures; contacts that are missing in the folder are solved."""
    spheres = xr.concat([compared(sphere, folder) for sphere in SPHERES], "case")
    spheres["finer"] = "quantity", finer(folder)
    return {
        "half_space": together(HALF_SPACE, folder),
        "layer": together(LAYERED, folder),
        "thin": together(THIN, folder, "asperities_on"),
        "thinner": together(THINNER, folder, "asperities_on"),
        "layer_cells": layer_cells(folder),
        "films": films(),
        "sparse": sparse(),
        "rates": rates(),
        "heights": spheres.assign_coords(case=[sphere.name for sphere in SPHERES]),
        "cells": cells(folder),
        "height_cells": height_cells(folder),
    }


def main(docs: Path, folder: Path) -> None:
    """Solve the missing contacts, and write the files."""
    parts = all_data(folder)
    tree = xr.DataTree.from_dict({"/": xr.Dataset(attrs={"command": "make validate"}), **parts})
    small = {"zlib": True, "dtype": "float32"}
    packed = {
        f"/{name}": {variable: small for variable in part.data_vars if part[variable].size > 500}
        for name, part in parts.items()
    }
    tree.to_netcdf(docs / "validate.nc", encoding=packed)
    draw_means(parts["half_space"], parts["layer"], docs / "validate.png")
    draw_cells(parts["layer_cells"], docs / "validate_cells.png")
    draw_limits(parts, docs / "validate_limits.png")
    for name, text in texts(parts).items():
        (docs / f"{name}.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(*sys.argv[1:2] or ["docs"]), Path("results/validate"))
