"""Units of scans as people spell them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from study import roughness

Z = np.cos(np.arange(40.0))


@pytest.mark.parametrize(
    ("spellings", "metres"),
    [
        (
            ("ångström", "Ångström", "ÅNGSTRÖM", "a\u030angstro\u0308m", "Angstrom", "angstroms", "\u212b", "A\u030a"),
            1e-10,
        ),
        (("pm", "picometer", "Picometres"), 1e-12),
        (("micron", "Microns", "micrometre"), 1e-6),
        (("nanometers", "Nanometre"), 1e-9),
    ],
)
def test_units_as_people_spell_them(tmp_path, spellings, metres):
    """ångström was unknown as an argument, and read in a heading."""
    np.savetxt(tmp_path / "a.txt", 9e3 * Z)
    for unit in spellings:
        scan = roughness.read(tmp_path / "a.txt", unit="um", height_unit=unit, dx=5e4, huge=True)
        assert_allclose(scan.z, 9e3 * Z * metres, rtol=1e-12)
        assert roughness.profile(Z, dx=2, unit=unit, huge=True).steps == (2 * metres,)
    for unit in ("A", "ang", "s", "", 5, ["um"]):
        with pytest.raises(ValueError, match="the unit .* is unknown; allowed are m, mm, um"):
            roughness.profile(Z, dx=2, unit=unit)
