"""Table 1 and Figures 9 and 10 with a lattice beside the paper's: cells, lines and columns against the law and the
datasets."""

import numpy as np
import pytest
from conftest import opened
from drawn import frame, legend, lines, texts

from solver import laws
from solver.laws.disc_cell import displacement
from study.catalogue import entry
from study.studies.paper import lattice_laws

P = 1e-4 * np.arange(1, 251)
PRINTED = {4.0: (0.1, 0.50), 1.0: (0.3, 0.53), 0.25: (1.0, 0.57)}  # in Ra


def lattice(Ra, Nbar):
    return laws.LAWS["square_lattice"].at(P, 1.0, Nbar=Nbar, Ra=Ra).A


def test_table_1_against_a_lattice():
    """Errors from 0.0025 E1* on; the fit leaves nothing that a change of B or beta would take away."""
    for row in entry("table", "table1_lattice").rows():
        Ra, Nbar, density, paper, disc, B, beta, error = row
        true, inside = lattice(Ra, Nbar), P > 0.00249
        factor, power = PRINTED[round(density, 9)]
        for found, A in ((paper, factor * Ra * P**power), (disc, displacement(P, 1.0, Nbar, Ra)), (error, B * P**beta)):
            assert found == pytest.approx(np.abs(A / true - 1)[inside].max(), rel=1e-12)
        least = np.sum((B * P**beta - true) ** 2)
        for more in (1 - 1e-4, 1 + 1e-4):
            assert np.sum((more * B * P**beta - true) ** 2) > least < np.sum((B * P ** (more * beta) - true) ** 2)


def test_figure_9_shows_the_lattice_and_the_papers_laws(drawing):
    figure, columns, _ = drawing("fig09_lattice")
    panels = [{rf"$\bar N R^2 = {N}$": (0.004, N) for N in (250000, 62500, 15625)},
              {f"$R_a/R = {Ra}$": (Ra, 250000) for Ra in (0.004, 0.002, 0.001)}]  # fmt: skip
    for axes, cases in zip(figure.axes, panels, strict=True):
        drawn = lines(axes)
        entries = legend(axes.get_legend())
        assert list(entries) == ["square lattice", "disc cell, Eqs (6), (7)", "with the paper's $B$, $\\beta$"]
        for true, disc, paper, (name, (Ra, Nbar)) in zip(*(drawn[i::3] for i in range(3)), cases.items(), strict=True):
            factor, power = PRINTED[round(Nbar * Ra**2, 9)]
            expected = lattice(Ra, Nbar), displacement(P, 1.0, Nbar, Ra), factor * Ra * P**power
            kinds = ("lattice", "disc", "paper")
            for line, kind, look, A in zip((true, disc, paper), kinds, entries.values(), expected, strict=True):
                np.testing.assert_allclose(line.y, 1e4 * A, rtol=1e-11)
                np.testing.assert_allclose(columns[f"A/R Ra={Ra} N={Nbar} {kind}"], A, rtol=1e-11)
                assert line.look.dashes == look.dashes
            assert name in texts(axes) and paper.look.colour == true.look.colour
        assert frame(axes) == ("$p/E_1^*$", "linear", r"$A[p]\ /\ (10^{-4} R)$", "linear", "")


def test_figure_10_shows_the_lattice_and_what_the_paper_is_off(drawing, results):
    figure, columns, _ = drawing("fig10_lattice")
    left, right = figure.axes
    found, paper = (opened(results / f"{name}.nc") for name in ("spot_density_lattice", "spot_density"))
    a0 = float(paper.a[0])
    pressures, differences = lines(left), lines(right)[:6]
    for i in range(3):
        true, disc, power = found.isel(micro=1, Nbar=i), found.isel(micro=0, Nbar=i), paper.isel(case=3 + i)
        assert (str(true.micro.values), str(disc.micro.values)) == ("square_lattice", "disc_cell")
        assert float(true.Nbar) == float(power.Nbar)
        for line, case in zip(pressures[2 * i : 2 * i + 2], (true, power), strict=True):
            np.testing.assert_allclose(line.x, case.x * case.a / a0, rtol=1e-12)
            np.testing.assert_allclose(line.y, 100 * case.p, rtol=1e-12)
        for line, case, kind in zip(
            differences[2 * i : 2 * i + 2], (power, disc), ("power law", "disc cell"), strict=True
        ):
            r = line.x * a0
            assert r[-1] == pytest.approx(max(float(case.a), float(true.a)))
            p, q = (np.interp(r, one.x * one.a, one.p, right=0) for one in (case, true))
            np.testing.assert_allclose(line.y, 100 * (p - q) / float(true.p0), atol=1e-9)
            np.testing.assert_allclose(columns[f"off/p(0) ({i + 1}, {kind})"], line.y / 100, atol=1e-15)
    assert list(legend(left.get_legend()))[-1] == "power law (the paper)"
    assert list(legend(right.get_legend())) == ["power law (the paper)", "disc cell"]


def test_what_is_too_small_is_off_as_well():
    true = lattice_laws.exact(0.004, 62500, "square_lattice")
    assert lattice_laws.largest_error(0.9 * true, true) == pytest.approx(0.1)
