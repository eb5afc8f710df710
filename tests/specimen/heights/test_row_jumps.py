"""Row jumps of a scanning probe: seen and named where they matter, never on a surface without them, and taken off."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from surfaces import rough

from study import roughness
from study.specimen.heights.row_jumps import jumps

#: Correlation lengths along y and x, in points, of surfaces that are ground along one axis.
GROUND = [(1, 40), (1.4, 8), (2, 40), (8, 100), (40, 1), (8, 1.4), (40, 2), (100, 8)]


def correlated(shape, lengths, seed) -> np.ndarray:
    """Gaussian heights (nm), rms 50, correlated over these lengths along y and x, in points."""
    k = np.meshgrid(*map(np.fft.fftfreq, shape), indexing="ij")
    power = np.exp(-sum((2 * np.pi * q * length) ** 2 for q, length in zip(k, lengths, strict=True)))
    white = np.fft.fft2(np.random.default_rng(seed).normal(size=shape))
    z = np.fft.ifft2(white * np.sqrt(power)).real
    return 50 * z / z.std()


def self_affine(points, hurst, seed, ground=1) -> np.ndarray:
    """Heights with waves of 4 to 60 points along y, and `ground` times as long along x."""
    along_x, along_y = np.meshgrid(*[np.fft.fftfreq(points)] * 2)
    k = np.hypot(ground * along_x, along_y)
    power = np.where((k > 0) & (k < 1 / 4), np.maximum(k, 1 / 60) ** (-2 * hurst - 2), 0)
    z = np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).normal(size=k.shape)) * np.sqrt(power)).real
    return 50 * z / z.std()


def offsets(rows: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed + 1000).normal(size=rows)[:, None]


def surfaces():
    """200 surfaces without jumps."""
    for seed in range(8):
        for shape in ((64, 64), (128, 100)):
            yield from (correlated(shape, lengths, seed) for lengths in GROUND)
    for seed in range(12):
        yield from (rough(96, shortest, seed, 50.0) for shortest in (3, 6, 24))
        yield from (self_affine(96, hurst, seed, ground) for hurst, ground in ((0.3, 1), (0.5, 20)))
    for seed in range(12):
        yield np.random.default_rng(seed).normal(size=(80, 80))


def test_no_jumps_are_seen_on_surfaces_without_them():
    """Isotropic, ground along x or y, and white."""
    seen = [(jumps(z), jumps(z.T)) for z in surfaces()]
    assert len(seen) == 200 and seen == [(None, None)] * 200


def said(z, **given):
    answer = roughness.measure(roughness.height_map(z, dx=100.0, unit="nm"), **given)
    return answer, [note for note in answer.notes if "jump against each other" in note]


@pytest.mark.parametrize("size", [2.0, 5.0])
@pytest.mark.parametrize("seed", range(4))
def test_jumps_are_named_with_their_size_and_taken_off(size, seed):
    """2 nm on 50 nm made N̄ 1.5 times larger without a note; of 5 nm the note blamed long asperities."""
    z = rough(128, 12, seed, 50.0)
    jumped = z + size * offsets(128, seed)
    before, nothing = said(z)
    after, (note,) = said(jumped)
    assert not nothing and after.Nbar > 1.3 * before.Nbar
    stated = float(note.split("by some ")[1].split(" nm")[0])
    assert_allclose(stated, size, rtol=0.25)  # of 128 offsets
    assert note.startswith("the rows jump") and 'rows="median" removes them' in note
    assert not any("long, not round" in one for one in after.notes)
    mended, quiet = said(jumped, rows="median")
    assert not quiet and mended.filter.startswith(
        "the median of the differences of neighbouring rows removed; plane removed"
    )
    # of the surface itself goes what all points of a row have in common; the median of each row would make N̄ 1.6
    assert_allclose([mended.Nbar, mended.Ra], [before.Nbar, before.Ra], rtol=0.1)


def test_jumps_of_every_kind():
    """Independent offsets, those that add up, and steps now and then; also with a fifth of the points missing."""
    random, rows = np.random.default_rng(7), 256
    z = rough(rows, 8, 3, 50.0)
    for steps in (
        4 * random.normal(size=rows),
        4 * np.cumsum(random.normal(size=rows)),
        20 * np.cumsum((random.random(rows) < 0.06) * random.normal(size=rows)),
    ):
        jumped = z + steps[:, None]
        assert jumps(jumped) is not None and jumps(jumped.T) is None
        assert jumps(np.where(random.random(z.shape) < 0.2, np.nan, jumped)) is not None


@pytest.mark.parametrize("shortest", [6, 12, 24])
def test_aligning_rows_without_jumps_does_no_harm(shortest):
    """The median of each row made N̄ 1.6 times larger here."""
    for seed in range(3):
        z = rough(128, shortest, seed, 50.0)
        plain, shifted = said(z)[0], said(z, rows="median")[0]
        assert_allclose(shifted.Nbar, plain.Nbar, rtol=0.1)
        # a fifth of the waves that lie along the rows goes where a row has five
        assert_allclose(shifted.Ra, plain.Ra, rtol=0.1 if shortest < 24 else 0.2)


def test_jumps_along_the_other_axis_need_the_map_turned():
    z = (rough(128, 12, 1, 50.0) + 5 * offsets(128, 1)).T
    _, (note,) = said(z)
    assert note.startswith("the columns jump") and "turn the map, z.T with dx and dy exchanged" in note


def test_jumps_are_named_beside_a_low_pass_and_once():
    answer, notes = said(rough(128, 12, 1, 50.0) + 5 * offsets(128, 1), cutoff=[4e-7, 8e-7])
    assert len(notes) == 1 and notes[0].startswith("the rows jump")  # at both cutoffs


def test_a_grating_has_long_asperities():
    """And no slope along them, by which was divided."""
    z = np.tile(5 * np.sin(np.arange(64) / 2)[:, None], (1, 64))
    answer, notes = said(z, form="mean")
    assert not notes and any("infinitely many times those along the other" in note for note in answer.notes)


def test_rows_that_cannot_be():
    scan = roughness.height_map(rough(64), dx=1e-7, name="afm.csv")
    for rows in ("mean", True, 1, "Median"):
        with pytest.raises(ValueError, match=f'^afm.csv: rows = {rows!r}; allowed are "median" and None'):
            roughness.measure(scan, rows=rows)
    line = roughness.profile(rough(64)[0], dx=1e-7, name="line.csv")
    with pytest.raises(ValueError, match="^line.csv: rows = 'median'; a profile has no rows"):
        roughness.measure(line, rows="median")


def test_medians_leave_missing_points_and_empty_rows():
    z = rough(64, 12, 2, 50.0) + 5 * offsets(64, 2)
    z[5] = np.nan
    z[7, :20] = np.nan
    scan = roughness.height_map(z, dx=100.0, unit="nm", missing="skip")
    answer = roughness.measure(scan, rows="median")
    whole = roughness.measure(roughness.height_map(rough(64, 12, 2, 50.0), dx=100.0, unit="nm"))
    assert_allclose([answer.Nbar, answer.Ra], [whole.Nbar, whole.Ra], rtol=0.15)
