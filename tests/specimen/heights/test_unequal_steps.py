"""Points that are not as far apart along x as along y: N̄ and Ra are those of the larger distance, along both axes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from study import roughness


def surface(seed=0, points=480, hurst=0.3):
    """Isotropic self-affine heights, rms 50 nm, with waves of 2.5 points and more, so that the step decides."""
    k = np.hypot(*np.meshgrid(*[np.fft.fftfreq(points)] * 2))
    power = np.where((k > 0) & (k < 0.4), np.maximum(k, 1 / 80) ** (-2 * hurst - 2), 0)
    z = np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).normal(size=k.shape)) * np.sqrt(power)).real
    return 50e-9 * z / z.std()


@pytest.mark.parametrize("method", ["moments", "summits"])
@pytest.mark.parametrize(("along_y", "along_x"), [(4, 1), (1, 4), (3, 2), (2, 5), (5, 4)])
def test_pixels_that_are_not_square_are_those_of_the_larger_step(along_y, along_x, method):
    """Means of two resolutions made N̄ 6.5 where 2.9 per µm² were right."""
    larger = max(along_y, along_x)
    for seed in range(2):
        z = surface(seed)
        unequal = roughness.measure(
            roughness.height_map(z[::along_y, ::along_x], dx=along_x * 1e-7, dy=along_y * 1e-7), method=method
        )
        equal = roughness.measure(roughness.height_map(z[::larger, ::larger], dx=larger * 1e-7), method=method)
        # four standard errors of some 1200 summits or more, of which the two have the most part in common
        for name in ("Nbar", "Ra", "sigma_summits"):
            assert_allclose(getattr(unequal, name), getattr(equal, name), rtol=0.06, err_msg=name)
        (note,) = (note for note in unequal.notes if "apart along x and y" in note)
        assert note.startswith(f"points are {100 * along_x} nm and {100 * along_y} nm apart")
        assert note.endswith(f"both are those over {100 * larger} nm")
        assert not any("apart along x and y" in note for note in equal.notes)
        assert not any("long, not round" in note for note in unequal.notes)


def test_fewer_than_sixteen_points_over_the_larger_step_are_refused():
    """The finer axis looks as if it had enough."""
    z = surface()
    wide = roughness.height_map(z[::10, :150], dx=1e-7, dy=1e-6, name="narrow.csv")
    words = "larger of the two steps, 1 µm, and 15 points so far apart are on the 14.9 µm along x; at least 16"
    with pytest.raises(ValueError, match=f"^narrow.csv: .*{words}"):
        roughness.measure(wide)
    with pytest.raises(ValueError, match="14.9 µm along y; at least 16"):
        roughness.measure(roughness.height_map(z[:150, ::10], dx=1e-6, dy=1e-7))
    assert roughness.measure(roughness.height_map(z[::10, :151], dx=1e-7, dy=1e-6)).Nbar > 0
    # what a low-pass leaves of the finer axis
    with pytest.raises(ValueError, match="at least 16 are needed"):
        roughness.measure(roughness.height_map(z[::10, :200], dx=1e-7, dy=1e-6), cutoff=4e-6)


@pytest.mark.parametrize("row", [2, 17, 39])
def test_the_row_of_a_position_out_of_step_is_named(row):
    """Counted from 1, as the rows of a table are."""
    x = np.arange(40) * 1e-6
    x[row - 1] += 0.4e-6
    with pytest.raises(ValueError, match=f"but x = {x[row - 1]:g} in row {row} is 4e-07 off"):
        roughness.profile(np.sin(np.arange(40)) * 1e-8, x=x)
