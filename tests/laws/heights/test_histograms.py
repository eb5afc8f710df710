"""Histograms of heights whose classes are very unequal: their tables are within the error that the law states."""

from functools import partial

import numpy as np
import pytest

from solver.laws import heights, spread
from solver.laws.own_table import read

NORMAL = np.exp(-(np.linspace(-4, 4, 32) ** 2) / 2)
SHARES = {
    "normal": NORMAL,
    "counted": np.maximum(np.random.default_rng(3).multinomial(10_000, NORMAL / NORMAL.sum()), 0.5),
    "rare": [0.2, 0.4, 0.3] + [0.01] * 5,
    "rarer": [0.2, 0.4, 0.3] + [0.001] * 20,
    "apart": [0.1, 0.3, 0.1, 1e-12, 1e-12, 1e-12, 0.1, 0.3, 0.1],
}


@pytest.mark.parametrize("step", [0.03, 3.0])
@pytest.mark.parametrize("kind", SHARES)
def test_the_tables_keep_to_the_error(kind, step):
    """At equal pressures A and λ are those of the means over the classes. The stated error is at most 100 times λ's,
    so that it says something."""
    share = np.array(SHARES[kind], dtype=float)
    law = heights.histogram("table:x", step * np.arange(len(share)), share, "1")
    one, c, y = np.ones(1), np.zeros((1, 1)), np.exp(np.linspace(np.log(2e-4), np.log(1e5), 3000))[None]
    own, bins = law.bind(one, Nbar=one / np.pi, Ra=one), law.curve.args[0]  # A* = 1
    relief = bins.mean(c) + 1 / 3
    at = partial(bins.at, cut=c[..., None, None])
    with np.errstate(all="ignore"):
        q, true = spread.pressure(bins.edges(c), at, 1.0, y, one[None], relief)
        found = own.evaluate(y)
    pairs = (found.g, spread.depth(y, q, relief)[0]), (own.area(y, found.q), true.area)
    errors = [np.log(mine[0]) - np.interp(np.log(found.q[0]), np.log(q[0]), np.log(value[0])) for mine, value in pairs]
    worst = np.abs(errors)[:, 5:-5].max()
    assert worst < law.error < max(100 * worst, 2 * heights.STEPPED)


def test_a_few_summits_far_above_the_many_are_refused(tmp_path):
    file = tmp_path / "mine.csv"
    file.write_text("z,share\n0,0.5\n1e-4,0.5\n2e-4,1e-6\n")
    with pytest.raises(ValueError, match="mine.csv: column share: a few summits stand far above the many: leave out"):
        read(f"table:{file}")


def test_means_of_a_few_spots_at_a_time_are_the_same_bits(monkeypatch):
    """Of two laws of random heights at 50 points: in one piece, and a few points at a time."""
    sigma, cut = np.array([[0.01], [1.0]]), np.array([[3.0], [5.0]])
    at = partial(heights.NORMAL.at, cut=cut[..., None, None])
    delta, q = np.geomspace(1e-4, 20, 50) * np.ones((2, 1)), np.geomspace(1e-6, 1, 50) * np.ones((2, 1))
    found = []
    for most in (10**9, 200):
        monkeypatch.setattr(spread, "_AT_A_TIME", most)
        found.append(np.array(spread.means(heights.NORMAL.edges(cut), at, 1.0, q, delta, sigma)))
    assert found[0].shape == (5, 2, 50)
    np.testing.assert_array_equal(found[0], found[1])


@pytest.mark.parametrize("kind", ["counted", "rare"])
def test_few_spots_are_those_of_the_highest_class(kind):
    """A ~ p^0.4 as the pressure goes to 0, of the density of the highest summits alone."""
    share = np.array(SHARES[kind], dtype=float)
    law, one = heights.histogram("table:x", 0.3 * np.arange(len(share)), share, "1"), np.ones(1)
    own, y = law.bind(one, Nbar=one / np.pi, Ra=one), np.array([[1e-4, 2e-4, 1e-3]])  # A* = 1, and A = y²
    with np.errstate(all="ignore"):
        q, (gamma, beta) = own.evaluate(y).q, own.edge()
    np.testing.assert_allclose(gamma * q**beta, y**2, rtol=1e-3)
    np.testing.assert_allclose(own.from_pressure(q), y, rtol=1e-9)


def test_the_version_is_of_all_numbers(tmp_path):
    """Results of other shares or heights would be served after an edit. A remark or a blank is no number."""
    file = tmp_path / "mine.csv"

    def version(text):
        file.write_text(text)
        return read(f"table:{file}").version

    rows = np.array([[0, 0.2], [1e-4, 0.5], [2e-4, 0.3]])
    text = "z,share\n" + "\n".join(f"{z!r},{share!r}" for z, share in rows.tolist())
    found = [version(text)]
    assert version("# the same\n" + text.replace(",", " , ") + "\n") == found[0]
    for row in range(3):
        changed = rows.copy()
        changed[row, 1] *= 1 + 1e-12
        found.append(version("z,share\n" + "\n".join(f"{z!r},{share!r}" for z, share in changed.tolist())))
    moved = rows + [1e-4, 0]
    found.append(version("z,share\n" + "\n".join(f"{z!r},{share!r}" for z, share in moved.tolist())))
    assert len(set(found)) == 5
