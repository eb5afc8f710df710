"""The table of docs/roughness.md on what spheres err, and what the page says of it."""

from pathlib import Path

import pytest
from spheres_of_scans import row, surfaces, text_of

PAGE = (Path(__file__).parents[3] / "docs/roughness.md").read_text(encoding="utf-8")
NAMES = [*surfaces()]


@pytest.mark.parametrize("name", NAMES)
def test_the_page_has_the_numbers(name):
    """And the error that the law states encloses what finer points change."""
    numbers = row(surfaces()[name])
    assert f"| {name} | {text_of(numbers)} |" in PAGE
    for of_scan in ("area", "p_max"):
        assert abs(numbers[f"finer {of_scan}"] / numbers[of_scan] - 1) <= numbers["error"]
    assert (1.6 < numbers["theory"] < 2.51) == (name != "the third, 30 spikes")
