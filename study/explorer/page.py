"""The page of the explorer: one HTML file with its parts and the data of the program."""

import base64
import json
from importlib.resources import files

import numpy as np

from solver.numerics.mesh import mesh_of
from solver.parameters import ends

from ..data.provenance import package_version
from ..in_words import margins, pressures
from ..inputs.lexicon import PACKAGE
from ..rules import assumptions, doubts
from ..specimen import materials

#: The beginning of the page, by which it is recognised.
MARK = b"<!-- a page of roughcoat explore -->"
#: Nodes of the two meshes that the page solves on; their difference is its error (tests/explorer/test_core.py).
NODES = (16, 22)
_SCRIPTS = ("core.js", "stress.js", "numbers.js", "contact.js", "strength.js", "drawing.js", "map.js", "page.js")
#: Module -> limits of assumptions and doubts, which the page applies as the program does.
_LIMITS = {
    assumptions: ("STEEP", "COMPRESSED", "STRETCHED", "FEW_SPOTS", "MERGING", "STEEP_SPOT"),
    doubts: ("YIELD", "STIFF"),
    pressures: ("RING",),
    margins: ("RUBBER",),
}
#: λ(0) -> relative error by which disc_cell overestimates the compression of the asperities against a square lattice
#: (docs/model.md, Microscale; tests/laws/lattice/test_lattice.py).
_MERGING = ((0.0, 0.0), (0.04, 0.02), (0.17, 0.05), (0.4, 0.10), (1.0, 0.27))


def page() -> str:
    """The whole page as HTML: opened from disk it needs neither a network nor a server."""
    room = files(__package__)
    data = json.dumps(contents(), ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
    scripts = "\n".join(room.joinpath(name).read_text("utf-8") for name in _SCRIPTS)
    text = room.joinpath("page.html").read_text("utf-8")
    text = text.replace("/* style */", room.joinpath("style.css").read_text("utf-8"))
    return text.replace("/* scripts */", f"const DATA = {data};\n{scripts}")


def contents() -> dict:
    """The data of the program for the scripts: meshes, materials, bounds, limits of assumptions."""
    entries = (materials.get(name) for name in materials.names())
    numbers = ("name", "E", "nu", "E_spread", "nu_spread", "condition", "source")
    bounded = ("P", "a", "D", "h", "n", "m", "Nbar", "Ra")
    return {
        "version": package_version("roughcoat"),
        "meshes": {n: mesh(n) for n in NODES},
        "materials": [{key: getattr(entry, key) for key in numbers} | strengths(entry) for entry in entries],
        "bounds": {name: ends(PACKAGE.parameter(name).interval)[:2] for name in bounded},
        "limits": {name: getattr(module, name) for module, names in _LIMITS.items() for name in names},
        "merging": _MERGING,
    }


def strengths(material: materials.Material) -> dict[str, float | None]:
    """Strengths in Pa, or None: Y against yielding, cracks of a layer under tension."""
    Y = materials.strength_of(material)
    return {"Y": None if np.isnan(Y) else Y, "cracks": material.fracture_strength or None}


def mesh(n: int) -> str:
    """The mesh of n nodes: s, x, w, edge (n,) and K (n, n) as float64, little endian, in base64."""
    points = mesh_of(n)
    numbers = np.concatenate([points.s, points.x, points.w, points.edge, points.K.ravel()])
    return base64.b64encode(numbers.astype("<f8").tobytes()).decode("ascii")
