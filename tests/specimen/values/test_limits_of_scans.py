"""What is just taken of a scan and what is just refused, on maps whose axes differ; and which place a message names."""

import numpy as np
import pytest

from study.specimen import roughness

RANDOM = np.random.default_rng(5)
Z = RANDOM.normal(size=(24, 40))  # 24 rows, 40 columns
MAP = {"unit": "um", "height_unit": "nm"}


def message(call, *arguments, **options) -> str:
    with pytest.raises(ValueError) as caught:
        call(*arguments, **options)
    return str(caught.value)


def test_a_cutoff_is_three_of_the_larger_steps():
    for dx, dy in ((0.1, 0.2), (0.2, 0.1)):
        scan = roughness.height_map(np.repeat(np.repeat(Z, 4, 0), 4, 1), dx=dx, dy=dy, **MAP)
        assert roughness.measure(scan, cutoff=0.6001e-6).cutoff is None
        assert "at least three steps, 6e-07 m" in message(roughness.measure, scan, cutoff=0.599e-6)


@pytest.mark.parametrize(("shape", "dx", "dy", "axis"), [((40, 20), 1.0, 2.0, "x"), ((20, 40), 2.0, 1.0, "y")])
def test_the_axis_with_too_few_points_is_named(shape, dx, dy, axis):
    """20 points at the smaller step are 10 at the larger one."""
    scan = roughness.height_map(RANDOM.normal(size=shape), dx=dx, dy=dy, **MAP)
    said = message(roughness.measure, scan)
    assert f"10 points so far apart are on the 19 µm along {axis}; at least 16 are needed" in said


@pytest.mark.parametrize("sign", [1, -1])
def test_a_sphere_is_larger_than_the_diagonal(sign):
    scan = roughness.height_map(Z, dx=1.0, **MAP)
    diagonal = np.hypot(23e-6, 39e-6)
    assert "a sphere of radius" in roughness.measure(scan, form=sign * 1.01 * diagonal).filter
    assert "a sphere must be larger than the scan" in message(roughness.measure, scan, form=sign * 0.99 * diagonal)


@pytest.mark.parametrize(("row", "column"), [(0, 0), (3, 31), (17, 2), (23, 39)])
def test_the_place_that_stands_twice_or_is_missing_is_named(tmp_path, row, column):
    rows = [f"{0.5 * j} {2.0 * i} {Z[i, j]}" for i in range(24) for j in range(40)]
    file = tmp_path / "map.txt"
    file.write_text("\n".join([*rows, rows[40 * row + column]]), encoding="utf-8")
    assert f"x = {0.5 * column:g}, y = {2.0 * row:g} stands there twice" in message(roughness.read, file, **MAP)
    z = np.where((np.arange(24)[:, None] == row) & (np.arange(40) == column), np.nan, Z)
    said = message(roughness.height_map, z, dx=1.0, missing="refuse", **MAP)
    assert f"the first in row {row + 1}, column {column + 1}: 0.1 % missing" in said
    said = message(roughness.height_map, np.where(np.isnan(z), -np.inf, z), dx=1.0, **MAP)
    assert f"are infinite, the first in row {row + 1}, column {column + 1};" in said


@pytest.mark.parametrize("heading", [[], ["x z"], ["# a", "", "x z", "um nm"]])
@pytest.mark.parametrize("row", [2, 5, 19])
def test_the_line_that_is_no_row_is_named(tmp_path, heading, row):
    """Its number in the file, with the heading and empty lines."""
    for wrong, words in (("1 2 3", "3 number(s) after lines of 2"), ("5 x", "'5 x' has something other than numbers")):
        lines = [*heading, *(f"{i} {z}" for i, z in enumerate(Z[0, :20]))]
        lines[len(heading) + row] = wrong
        (tmp_path / "a.txt").write_text("\n".join(lines), encoding="utf-8")
        said = message(roughness.read, tmp_path / "a.txt", unit="um", height_unit="um")
        assert said.startswith(f"a.txt, line {len(heading) + row + 1}: {words}")


def test_each_axis_has_its_step():
    scan = roughness.height_map(Z, dx=0.5, dy=2.0, **MAP)
    assert scan.steps == pytest.approx((2e-6, 0.5e-6)) and scan.sizes == pytest.approx((46e-6, 19.5e-6))
    tall = roughness.measure(roughness.height_map(np.tile(Z, (4, 1)), dx=0.5, dy=0.2, **MAP))
    assert tall.resolution.endswith("40 × 96 points 500 nm × 200 nm apart, 19.5 µm × 19 µm")


@pytest.mark.parametrize("end", range(4))
def test_a_crop_may_end_a_step_outside_the_scan(tmp_path, end):
    """Of its own axis: ends are rounded, and nothing is there to be kept."""
    np.savetxt(tmp_path / "map.txt", Z)
    step, outwards = (0.1, 0.2)[end // 2], (-1, 1)[end % 2]
    crop = [0.0, 3.9, 0.0, 4.6]

    def of_steps(count):
        return {
            "crop": [*crop[:end], crop[end] + count * outwards * step, *crop[end + 1 :]],
            "dx": 0.1,
            "dy": 0.2,
        } | MAP

    assert roughness.read(tmp_path / "map.txt", **of_steps(0.9)).z.shape == Z.shape
    said = message(roughness.read, tmp_path / "map.txt", **of_steps(1.2))
    assert f" um in {'xy'[end // 2]}: must rise and lie in the scan" in said
