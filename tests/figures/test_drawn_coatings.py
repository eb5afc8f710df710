"""The master curves of coatings: every curve against the dataset, by formulas of its own; and what lies under them in
the pressure of asperities, against the law on the coated body."""

import numpy as np
import pytest
import xarray as xr
from conftest import opened
from drawn import frame, legend, lines, ticks
from numpy.testing import assert_allclose

from solver.laws import LAWS, cell_rows
from study import materials
from study.studies.systems import substrate
from study.studies.systems.figures import COLOURS, PALE, power

# Row -> label, scale of the ordinate, column of the CSV.
ROWS = (
    (r"$E_{\mathrm{eff}}/E_1^*$", "log", "E_eff/E1*"),
    ("largest real pressure\nover that of the uncoated body", "log", "p_peak/p_peak uncoated"),
    ("$A_r/A_n$", "linear", "Ar/An"),
)
INTERFACES = ("frictionless", "bonded")
NAMES = {1e-3: "$n = 10^{-3}$", 1.0: "$n = 1$", 1e3: "$n = 10^{3}$"}


def quantities(case: xr.Dataset, bare: xr.Dataset) -> tuple:
    """What the three rows show for a curve over P; `bare`: the same punch on the body alone."""
    return case.dP_dD / (2 * case.a * case.n), peak(case) / peak(bare), case.Ar_An


def peak(case: xr.Dataset) -> xr.DataArray:
    """Largest real pressure over the profile, Eq. (13) with E1* = n E2*."""
    if case.micro == "smooth":
        return case.p.max("x")
    b = (case.lam / np.pi / case.Nbar) ** 0.5
    return (2 * case.n * b / (np.pi * case.Ra) + 2 / np.pi * case.p * np.arcsin(case.lam**0.5)).max("x")


@pytest.fixture(scope="module")
def found(results) -> xr.Dataset:
    return opened(results / "coatings.nc")


def curves(found, bonding: str) -> list[tuple[xr.Dataset, xr.Dataset, np.ndarray]]:
    """(case over P, the same without a coating, where it is drawn) in the order of drawing."""
    wanted = []
    for n in NAMES:
        for micro in ("disc_cell", "smooth"):
            case, bare = found.sel(bonding=bonding, n=n, micro=micro), found.sel(bonding="bonded", n=1, micro=micro)
            many = (found.Nbar * np.pi * case.a**2 >= 100) | (micro == "smooth")
            wanted.append((case, bare, many.values))
    return wanted


def test_curves_are_the_datasets(drawing, found):
    figure, _, _ = drawing("coatings")
    assert found.n.values.tolist() == list(NAMES)
    assert not np.all([many for _, _, many in curves(found, "bonded")]), "some are left out"
    assert any((case.validity.values[many] != 0).any() for case, _, many in curves(found, "bonded")), "some are pale"
    told = figure.get_suptitle()
    assert "$\\bar N\\,R^2$ = $4\\times10^{8}$, $R_a/R$ = 0.0001, $P/(E_2^* R^2)$ from $10^{-14}$ to 0.001" in told
    for i, axes in enumerate(figure.axes):
        row, bonding = divmod(i, 2)[0], INTERFACES[i % 2]
        shown = [c for c in curves(found, bonding) if row == 0 or c[0].micro == "disc_cell"]
        for pale, line, (case, bare, many) in zip(lines(axes)[::2], lines(axes)[1::2], shown, strict=True):
            valid = (case.validity == 0).values[many]
            for drawn, where in ((pale, np.ones(len(valid), bool)), (line, valid)):
                np.testing.assert_allclose(drawn.x, (case.a / found.h).values[many], rtol=1e-14)  # one division
                wanted = np.where(where, quantities(case, bare)[row].values[many], np.nan)
                np.testing.assert_allclose(drawn.y, wanted, rtol=1e-13)  # the same arithmetic
        assert [line.get_alpha() for line in axes.lines] == [PALE, None] * len(shown)


def test_the_csv_holds_the_curves_of_both_punches(drawing, found):
    _, columns, _ = drawing("coatings")
    assert list(columns) == ["bonded", "rough", "n", "P/(E2* R^2)", "a/h", *(name for _, _, name in ROWS)]
    count = 0
    for bonding in INTERFACES:
        for case, bare, many in curves(found, bonding):
            at = (columns["bonded"] == (bonding == "bonded")) & (columns["n"] == float(case.n))
            at &= columns["rough"] == (case.micro == "disc_cell").item()
            np.testing.assert_array_equal(columns["P/(E2* R^2)"][at], found.P.values[many])
            np.testing.assert_allclose(columns["a/h"][at], (case.a / 0.005).values[many], rtol=1e-14)  # one division
            for (_, _, name), values in zip(ROWS, quantities(case, bare), strict=True):
                np.testing.assert_allclose(columns[name][at], values.values[many], rtol=1e-13)  # the same arithmetic
            count += at.sum()
    assert all(len(column) == count for column in columns.values())


def test_labels_scales_and_limits(drawing):
    figure, _, _ = drawing("coatings")
    for i, axes in enumerate(figure.axes):
        row, column = divmod(i, 2)
        label, scale, _ = ROWS[row]
        title = INTERFACES[column] if row == 0 else ""
        assert frame(axes) == ("$a/h$" if row == 2 else "", "log", label if column == 0 else "", scale, title)
        assert axes.get_xlim() == (0.05, 20) and ticks(axes)[0] == ["0.1", "1", "10"]
        own = [margins(both, np.log if scale == "log" else np.asarray) for both in figure.axes[2 * row : 2 * row + 2]]
        (low, _), (_, high) = np.min(own, 0), np.max(own, 0)
        limits = np.log(axes.get_ylim()) if scale == "log" else axes.get_ylim()
        np.testing.assert_allclose(limits, (low, high), rtol=1e-9, err_msg="both interfaces on one scale")


def margins(axes, scale) -> tuple[float, float]:
    """What matplotlib leaves around curves: a twentieth of what they span."""
    y = scale(np.concatenate([line.y for line in lines(axes)[::2]]))
    return y.min() - 0.05 * np.ptp(y), y.max() + 0.05 * np.ptp(y)


def test_the_legend_tells_the_coatings_and_the_punches_apart(drawing):
    figure, _, _ = drawing("coatings")
    (box,) = figure.legends
    entries = legend(box)
    assert list(entries) == [*NAMES.values(), "smooth punch", "outside validity"]
    assert len({entry.colour for entry in entries.values()}) == len(NAMES), "black serves n = 1 and the smooth punch"
    for i, axes in enumerate(figure.axes):
        names = [name for name in NAMES.values() for _ in range(2 if i < 2 else 1)]
        for j, (line, name) in enumerate(zip(lines(axes)[::2], names, strict=True)):
            assert line.look.colour == entries[name].colour
            assert line.look.dashes == entries["smooth punch" if i < 2 and j % 2 else name].dashes
    assert entries["smooth punch"].dashes != entries["$n = 1$"].dashes


def test_every_ratio_of_the_study_has_a_name_and_a_colour():
    names = {0.001: "10^{-3}", 0.01: "10^{-2}", 0.1: "0.1", 1.0: "1", 10.0: "10", 100.0: "10^{2}", 1000.0: "10^{3}"}
    assert {n: power(n) for n in names} == names
    assert list(COLOURS) == list(names) and len(set(COLOURS.values())) == len(names)


def test_ratios_are_those_of_one_nominal_pressure(monkeypatch):
    """At their λ the law on the coated body has the p that the half-space has at its λ, and p_max."""
    monkeypatch.setattr(substrate, "PITCH", np.array([0.5, 8.0]))
    coating, body = materials.get("TiN"), materials.get("steel 52100")
    p_max, lam = substrate.ratios(coating, body)
    assert_allclose([p_max[0], lam[0]], 1, rtol=2e-5)  # the error of the table
    n = coating.reduced_modulus / body.reduced_modulus
    p, _, felt = cell_rows("square", substrate.LAM * lam[1], 8.0, n, coating.nu, body.nu, "bonded")
    bare = LAWS["square_lattice"].at(p, 1.0, Nbar=1.0, Ra=1.0)
    assert_allclose([bare.lam, felt / bare.p_max], [substrate.LAM, p_max[1]], rtol=4e-5)


def test_soft_coatings_press_more_and_hard_ones_less(monkeypatch):
    monkeypatch.setattr(substrate, "PITCH", np.array([10.0]))
    ratios = [substrate.ratios(materials.get(name), materials.get(under)) for name, under, *_ in substrate.COATINGS]
    p_max, lam = np.array(ratios)[..., 0].T
    assert (np.diff(p_max) > 0).all() and (np.diff(lam) < 0).all()  # from hard to soft


@pytest.mark.parametrize(("power", "at"), [(0.1, 1.05**10), (-0.2, 1.05**5), (0.001, None)])
def test_where_the_pressure_is_five_per_cent_off(power, at):
    curve = np.maximum(substrate.PITCH, 1.0) ** power
    assert substrate.felt_from(curve) == (None if at is None else pytest.approx(at, rel=1e-6))
