"""Works of adhesion of pairs of materials."""

from pathlib import Path

import pytest

from study.specimen import materials
from study.specimen.materials import works

ROOT = Path(__file__).resolve().parents[2]


def test_pairs_that_stick():
    """Each is of materials of the table, plausible, found in any order; the page has the table of the file."""
    for pair in materials.pairs():
        assert all(materials.get(name).name == name for name in pair.bodies)
        assert 0.01 <= pair.w <= 0.2 and 0 < pair.w_spread < pair.w / 2  # J/m²; van der Waals' forces make some 0.05
        assert pair.checked or "not read" in pair.source
        assert materials.work_of_adhesion(*reversed(pair.bodies)) == pair
    with pytest.raises(LookupError, match="known: PDMS and PDMS"):
        materials.work_of_adhesion("PDMS", "copper")
    assert works.markdown() in (ROOT / "docs/materials.md").read_text(encoding="utf-8")
