"""From a roughness as people specify it to asperities of the model, or to the micro law of a scan itself.

From a design: `square_lattice`, `hexagonal_lattice`, `area_fraction`, `cap_radius`. From a scan: `read` (a file),
`profile`, `height_map` (arrays), `self_affine` (a random surface), then `measure`, or `law` and `contact_map`. `Ra` is
the radius of an asperity everywhere here, never the roughness Ra of ISO 21920 (formerly ISO 4287), which is a mean
height: `looks_like_iso_ra`. docs/roughness.md has the method.
"""

from ..specimen.heights.self_affine import self_affine
from ..specimen.roughness import (
    Roughness,
    Scan,
    area_fraction,
    cap_radius,
    height_map,
    hexagonal_lattice,
    looks_like_iso_ra,
    measure,
    profile,
    read,
    square_lattice,
)
from .contact_map import contact_map
from .law import ScanLaw, law

__all__ = [
    "Roughness",
    "Scan",
    "ScanLaw",
    "area_fraction",
    "cap_radius",
    "contact_map",
    "height_map",
    "hexagonal_lattice",
    "law",
    "looks_like_iso_ra",
    "measure",
    "profile",
    "read",
    "self_affine",
    "square_lattice",
]
