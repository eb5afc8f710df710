"""The figures and tables of the paper. Figures of results are in the modules that are imported here."""

from pathlib import Path

from study.figures.registry import drawing

from . import curves, lattice_laws, law_fits, paper_error  # noqa: F401

DRAWINGS = Path(__file__).with_name("schemes")


@drawing("fig01")
def contact() -> Path:
    """The contact: a sphere of radius R with asperities, pressed by P on a coated half-space."""
    return DRAWINGS / "fig01"


@drawing("fig02")
def cell() -> Path:
    """One asperity of radius Ra and its cell; the contact spot has the radius b."""
    return DRAWINGS / "fig02"
