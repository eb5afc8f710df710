"""The page of the explorer: its parts, and what it takes from the program, in one HTML file."""

import base64
import json
from importlib.resources import files

import numpy as np

from solver.numerics.mesh import mesh_of
from solver.parameters import ends

from ..data import assumptions
from ..data.provenance import package_version
from ..in_words import beyond, pressures
from ..inputs.vocabulary import VOCABULARY
from ..specimen import materials

#: Nodes of the two meshes that the page solves on; their difference is its error (tests/explorer/test_core.py).
NODES = (16, 22)
_SCRIPTS = ("core.js", "contact.js", "drawing.js", "map.js", "page.js")
#: λ(0) -> by how much disc_cell overestimates what the asperities yield, against a square lattice
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
    """What the scripts take from the program: meshes, materials, bounds, limits of assumptions."""
    names = ("STEEP", "COMPRESSED", "STRETCHED", "FEW_SPOTS", "MERGING", "STEEP_SPOT", "SPOT_OVER_LAYER")
    limits = {name: getattr(assumptions, name) for name in (*names, "PITCH_OVER_LAYER")}
    limits |= {name: getattr(beyond, name) for name in ("YIELD", "STIFF", "HARDEST")}
    limits |= {name: getattr(pressures, name) for name in ("STRENGTHS", "RUBBER", "RING")}
    known = (materials.get(name) for name in materials.names())
    numbers = ("name", "also", "E", "nu", "E_spread", "nu_spread", "condition", "source")
    return {
        "version": package_version("roughcoat"),
        "meshes": {n: mesh(n) for n in NODES},
        "materials": [{key: getattr(own, key) for key in numbers} for own in known],
        "bounds": {name: ends(VOCABULARY[name].own.interval)[:2] for name in ("P", "a", "D", "h", "n", "m", "Nbar", "Ra")},
        "limits": limits,
        "seen": [(pitch, *errors) for pitch, errors in beyond.SEEN.items()],
        "merging": _MERGING,
    }


def mesh(n: int) -> str:
    """The mesh of n nodes: s, x, w, edge (n,) and K (n, n) as float64, little endian, in base64."""
    own = mesh_of(n)
    numbers = np.concatenate([own.s, own.x, own.w, own.edge, own.K.ravel()])
    return base64.b64encode(numbers.astype("<f8").tobytes()).decode("ascii")
