"""The formulas of the literature: values that are known, limits, ranges, and the page that shows them."""

import re

import numpy as np
import pages
import pytest
import xarray as xr
from conftest import opened
from literature_page import page
from matplotlib.figure import Figure
from numpy.testing import assert_allclose
from scipy.integrate import quad

import study
from solver import Problem, solve
from solver.kernels.closed_form import layered_kernel
from study.figures.registry import entry
from study.studies.literature import compared, formulas
from study.studies.literature.figures import SHOWN_AT, STYLES, errors, frame

A = 0.01
NU = (0.0, 0.3, 0.45, 0.5)


def rigid(x) -> xr.Dataset:
    """As the dataset of the study literature, at the a/h of x."""
    h, materials = A / np.asarray(x), [("frictionless", 0.3), *(("bonded", nu) for nu in NU)]
    given = {"a": A, "h": h, "n": 0, "base": "layered", "micro": "smooth", "rtol": 1e-9}
    found = [solve(Problem.of(**given, bonding=bonding, nu1=nu)) for bonding, nu in materials]
    values = {name: (("case", "h"), [getattr(one, name) for one in found]) for name in ("P", "D", "dP_dD")}
    bondings, ratios = zip(*materials, strict=True)
    return xr.Dataset(values, {"a": A, "h": h, "bonding": ("case", list(bondings)), "nu1": ("case", list(ratios))})


@pytest.fixture(scope="module")
def contacts():
    return rigid(SHOWN_AT)


def formula(name: str, bonded: bool):
    (found,) = [one for one in formulas.LOADS if one.name.startswith(name) and one.bonded == bonded]
    return found


def test_an_incompressible_bonded_layer(contacts):
    """Of another solver: F/F_H, and how far three formulas are from it."""
    x, _, exact = compared.over_hertz(compared.contacts_on_layer(contacts, True, 0.5))
    assert_allclose(x, SHOWN_AT, rtol=1e-12)
    assert_allclose(exact, (1.12354, 1.85712, 3.37110, 8.46801, 29.0573), rtol=5e-6)
    off = {name: compared.load_error(formula(name, True), contacts, 0.5)[1]
           for name in ("Hermanowicz", "Dimitriadis et al. 2002, nu", "Garcia")}  # fmt: skip
    assert np.abs(off["Hermanowicz"]).max() < 8.05e-4
    assert_allclose(off["Dimitriadis et al. 2002, nu"], (-0.002, -0.055, -0.135, -0.165, -0.084), atol=6e-4)
    assert_allclose(off["Garcia"][:2], (6e-4, 3e-3), atol=1e-4)
    assert_allclose(off["Garcia"][2:], (0.049, 0.34, 1.15), atol=5e-3)


def test_hermanowicz_without_friction(contacts):
    assert np.abs(compared.load_error(formula("Hermanowicz", False), contacts, 0.3)[1]).max() < 8.05e-4


@pytest.mark.parametrize(("bonded", "nu"), [(True, 0.5), (True, 0.3), (False, 0.3)])
def test_the_series_of_the_load(bonded, nu):
    """c1 = (2/π) ∫ (1 - L) du by quadrature of the kernel, and c2 = (7/6) c1²."""
    found = compared.coefficients(rigid(np.geomspace(0.01, 0.15, 30)), bonded, nu)
    c1 = 2 / np.pi * quad(lambda u: 1 - float(layered_kernel(np.array([u]), 0.0, nu, nu, bonded).L[0]), 0, 30)[0]
    assert_allclose(found[:2], (c1, 7 / 6 * c1**2), rtol=1e-4)


KAPPA_AT = np.arange(0.2, 2.01, 0.2)
"""a/h of the tables that formulas.KAPPA is from, as the two scripts have them."""
KAPPA = {
    "Hayes et al. 1972 in a script of M. Ebrahimi, 2018": {
        0.3: (1.207, 1.472, 1.784, 2.124, 2.480, 2.845, 3.214, 3.586, 3.960, 4.336),
        0.5: (1.268, 1.645, 2.129, 2.704, 3.359, 4.085, 4.878, 5.737, 6.659, 7.644),
    },
    "Hayes et al. 1972 in a script of I. Kafian-Attari, 2021": {
        0.5: (1.281, 1.683, 2.211, 2.855, 3.609, 4.469, 5.441, 6.528, 7.735, 9.069),
    },
}


def test_one_quotation_of_hayes_is_right():
    rigid_base = rigid(np.geomspace(0.1, 4, 40))
    assert {script: {nu: said[4] for nu, said in of.items()} for script, of in KAPPA.items()} == formulas.KAPPA
    for script, tables in KAPPA.items():
        for nu, said in tables.items():
            off = np.abs(np.array(said) / compared.kappa(rigid_base, nu, KAPPA_AT) - 1).max()
            assert (0.15 < off < 0.17) if (nu == 0.5 and "Ebrahimi" in script) else (off < 0.01)


def test_the_other_quotation_is_of_another_poisson_ratio():
    """ν = 0.48, as docs/literature.md says: of no other within 1 %."""
    (said,) = [tables[0.5] for script, tables in KAPPA.items() if "Ebrahimi" in script]
    given = {"a": A, "h": A / KAPPA_AT, "n": 0, "bonding": "bonded", "base": "layered", "micro": "smooth"}
    for nu, alike in ((0.47, False), (0.48, True), (0.49, False)):
        exact = solve(Problem.of(**given, nu1=nu)).dP_dD / (2 * A)
        assert (np.abs(np.array(said) / exact - 1).max() < 0.01) == alike


@pytest.mark.parametrize("n", [0.1, 0.9, 10.0])
@pytest.mark.parametrize("name", formulas.STIFFNESSES)
def test_stiffnesses_tend_to_the_layer_and_to_the_base(name, n):
    of, _ = formulas.STIFFNESSES[name]
    assert_allclose(of(1e-5, n, 0.3), n, rtol=2e-4)
    assert_allclose(of(1e6, n, 0.3), 1, rtol=1e-4)
    assert_allclose(of(np.array([0.1, 1.0, 10.0]), 1 + 1e-9, 0.3), 1, rtol=0 if "Hay" not in name else 0.2, atol=1e-8)


def test_gao_is_exact_to_first_order():
    x, n = np.array([0.1, 0.5, 1.0, 3.0]), 1.001
    given = {"a": A, "h": A / x, "n": n, "bonding": "bonded", "base": "layered", "micro": "smooth", "x": 2}
    for nu in (0.0, 0.3, 0.45):
        found = study.solve(**given, nu1=nu, nu2=nu, rtol=1e-9)
        slope = (study.derived.effective_modulus(found).values - 1) / (n - 1)
        assert_allclose(slope, formulas.gao_weight(x, nu), atol=4e-4)


def test_the_safe_range():
    x = np.array([1.0, 10.0, 100.0])
    assert compared.safe_range(x, np.array([0.0, 0.02, 0.04]), 0.01) == (1.0, pytest.approx(10**0.5))
    assert compared.safe_range(x, np.array([0.0, -0.02, 0.0]), 0.01)[1] == pytest.approx(10**0.5)
    assert compared.safe_range(x, np.array([0.04, 0.02, 0.0]), 0.01, last=True) == (pytest.approx(10**1.5), 100.0)
    assert compared.safe_range(x, np.zeros(3), 0.01) == (1.0, 100.0)
    assert np.isnan(compared.safe_range(x, np.ones(3), 0.01)).all()
    assert compared.range_of(x, np.ones(3), 0.01, thin=False) == "nowhere"
    assert compared.range_of(x, np.array([0.04, 0.02, 0.0]), 0.01, thin=True) == "from 31.6"
    n = np.array([0.01, 0.1, 0.999, 1.001, 10.0, 100.0])
    assert compared.around_one(n, np.array([1, 0.005, 0, 0, 0.005, 1]), 0.01) == "0.099 to 10"


def cells(text: str) -> list[list[str]]:
    """The rows of the tables of a page, without heads."""
    return [line.strip("| ").split(" | ") for line in text.splitlines() if re.match(r"\| [^-f]", line)]


def test_the_page_is_that_of_the_program(results):
    """Its words stay, and the names in its tables; the numbers are of larger studies."""
    written = pages.read("docs/literature.md")
    found = page(re.sub(r"^[|].*\n", "", written, flags=re.MULTILINE), results)

    def words(text):
        return [line for line in text.splitlines() if not line.startswith("|")]

    assert words(written) == words(found)
    assert [row[0] for row in cells(written)] == [row[0] for row in cells(found)]


def test_the_numbers_on_the_page_are_those_of_the_solver(contacts):
    """Of the first table, to its last digit: a spline in ln(a/h) goes through the points of the study."""
    rows = [row for row in cells(pages.read("docs/literature.md")) if row[1:2] and row[1] in ("bonded", "frictionless")]
    expected = [(one, nu) for one in formulas.LOADS for nu in one.nu]
    for row, (one, nu) in zip(rows, expected, strict=True):
        assert row[0] == one.name
        shown = np.array([float(cell.rstrip("%")) / 100 for cell in row[6:11]])
        assert_allclose(shown, compared.load_error(one, contacts, nu)[1], rtol=0, atol=6e-5)


def test_greenwood_and_tripp_are_right_where_spots_are_far_apart(results):
    """And Greenwood, Johnson and Matsubara where μ is not small; the page has the same numbers."""
    rows = entry("table", "literature_rough").rows(opened(results / "literature_rough.nc"))
    covered, p0, radius = np.array([[row[3], row[6], row[9]] for row in rows]).T
    assert np.all(p0 < 0) and np.all(radius > 0), "who leaves the neighbours out has too soft a surface"
    sparse = covered < 0.01
    assert np.abs(p0[sparse]).max() < 0.012 and np.abs(radius[sparse]).max() < 0.006
    assert np.abs(p0[~sparse]).max() > 0.1 and np.abs(radius[~sparse]).max() > 0.05
    lower = {row[1]: 1 - row[4] for row in rows if row[0] == 0.05}
    assert max(lower[4], lower[17]) < 0.07 and round(lower[1], 2) == 0.12
    written = [row for row in cells(pages.read("docs/literature.md")) if len(row) == len(rows[0]) and row[0] != "alpha"]
    shown = np.array([[float(cell.rstrip("%")) / (100 if "%" in cell else 1) for cell in row] for row in written])
    assert_allclose(shown, np.array(rows), rtol=0.04, atol=6e-4)


def test_what_is_decided_is_drawn_from_the_results(results):
    rigid_base, coated = (opened(results / f"{name}.nc") for name in ("literature", "literature_coatings"))
    for row in entry("table", "literature_decided").rows(rigid_base, coated):
        assert row[4] == row[2] / row[3] - 1 or np.isnan(row[4])


def test_one_colour_is_one_formula():
    colours = [colour for colour, _ in STYLES.values()]
    assert len(set(colours)) == len(colours) == 12


def test_what_is_drawn_is_made_for_the_interface(contacts, monkeypatch):
    """Of nearly incompressible layers that are bonded, and of layers that slide."""
    monkeypatch.setattr(compared, "stiffness", lambda _: (None, np.ones(1), None))
    monkeypatch.setattr(compared, "stiffness_errors", lambda _: {"Gao, Chiu and Lee 1992": np.ones((1, 1))})
    panels = Figure().subplots(1, 3)
    columns = errors(panels, contacts, None)
    names = [[line.get_label().split()[0] for line in axes.lines] for axes in panels]
    both = ["Hertz", "Dimitriadis", "Dimitriadis", "Hermanowicz", "Johnson"]
    assert names == [[both[0], "Hayes", *both[1:3], "Garcia", *both[3:]], both, ["Gao,"]]
    assert [np.unique(columns["curve"][columns["panel"] == panel]).size for panel in range(3)] == [7, 5, 1]


def test_errors_are_drawn_in_percent():
    axes = Figure().subplots()
    axes.plot([1, 10], [1e-3, 1.0], label="formula")
    frame(axes, "error of the load")
    shown = axes.yaxis.get_major_formatter()
    assert [shown(value, 0) for value in (1e-3, 0.05, 10.0)] == ["0.1 %", "5 %", "1000 %"]
