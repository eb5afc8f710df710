"""Physical units there and back."""

import numpy as np
import pytest
import xarray as xr

import study
from solver.yields.below.central_spot import SPOT_EXTREMES
from solver.yields.extremes import EXTREMES
from study.data import derived
from study.data.units import factor
from study.inputs.lexicon import PACKAGE
from study.inputs.punch.stresses import OF_STACKS
from study.inputs.vocabulary import PARAMETERS, VOCABULARY

SCALE = {"R": 5e-3, "E2_star": 2e11}


# SI sizes of dimensionless ones on a sphere of 5 mm on 200 GPa.
FACTORS = {
    **dict.fromkeys(("a", "D", "h", "Ra", "sigma", "A0", "b0", "r_ring", "D_body"), 5e-3),  # m
    **dict.fromkeys(("flat_radius", "tip_radius", "edge_radius", "z0", "table_unit", "D_off", "a_off", "a_in"), 5e-3),
    **dict.fromkeys(
        (
            "p0",
            "p_max",
            "p",
            "p_mean",
            "p_peak",
            "p_ring",
            "E_eff",
            "hardness",
            "yield_strength",
            "Y1",
            "Y2",
            "Y_punch",
            "sigma0",
            "p_spot",
            *EXTREMES,
            *OF_STACKS,
            *SPOT_EXTREMES,
        ),
        2e11,
    ),  # Pa
    **dict.fromkeys(("P", "P_off", "P_in"), 5e6),  # N: 2e11 Pa (5e-3 m)²
    "Nbar": 4e4,  # 1/(5 mm)²
    **dict.fromkeys(("dP_dD", "w_adhesion", "k_machine"), 1e9),  # N/m: 2e11 Pa 5e-3 m
    "An": 25e-6,  # (5 mm)²
}


@pytest.mark.parametrize("name", VOCABULARY)
def test_factors(name):
    assert factor(name, **SCALE) == pytest.approx(FACTORS.get(name, 1.0), rel=1e-14)  # a few roundings


def test_scenes_of_another_size_and_stiffness_are_the_same_contact():
    """All lengths times 2, pressures times 3: areas grow by 4, loads by 12."""
    scene = {"R": 5e-3, "E2_star": 2e11, "P": 10.0, "a": 5e-5, "D": 5e-7, "h": 2e-5, "Nbar": 1e10, "Ra": 8e-6}
    scaled = {"R": 1e-2, "E2_star": 6e11, "P": 120.0, "a": 1e-4, "D": 1e-6, "h": 4e-5, "Nbar": 2.5e9, "Ra": 1.6e-5}
    pure = {"n": 0.5, "nu1": 0.3, "B": 0.1, "k": 2.0, "nodes": 16, "micro": "smooth"}
    first, second = (study.from_physical(**given) for given in (scene, scaled))
    assert first == pytest.approx(second, rel=1e-14)  # a few roundings
    assert study.from_physical(**scene, **pure) == first | pure


def test_rough_contact_in_physical_units():
    """Equations (6), (11) and (13) and the equilibrium, in SI units, from the numbers as they are."""
    s, w = np.polynomial.legendre.leggauss(40)
    s, w = (1 - s) / 2, w / 2
    x = np.sqrt(1 - s**2)
    given = study.from_physical(**SCALE, P=10.0, Nbar=1e10, Ra=20e-6)
    found = study.solve(**given, base="half_space", rtol=1e-10, x=[0.0, *x, 1.0])
    quantities = (derived.nominal_area, derived.mean_pressure, derived.spot_radius, derived.peak_pressure)
    more = xr.merge([found, *(quantity(found) for quantity in quantities)])
    physical = study.to_physical(more, **SCALE)
    si = {name: physical[name].values for name in (*FACTORS, "lam0") if name in physical}
    assert si["P"] == pytest.approx(10, rel=1e-14) and si["Nbar"] == pytest.approx(1e10, rel=1e-14)  # a few roundings
    E, Ra, p0, lam = 2e11, 20e-6, si["p0"], si["lam0"]
    b, cell = np.sqrt(lam / (np.pi * 1e10)), np.sqrt(1 / (np.pi * 1e10))
    exact = {"rel": 1e-10}  # identities of one state; A0 is a difference of numbers some times larger
    assert si["p_max"] == pytest.approx(2 * E * b / (np.pi * Ra) + 2 * p0 / np.pi * np.arcsin(b / cell), **exact)
    assert si["A0"] == pytest.approx(b**2 / Ra - 2 * p0 / E * np.sqrt(cell**2 - b**2), **exact)
    assert si["b0"] == pytest.approx(b, **exact) and si["p_peak"] == pytest.approx(si["p_max"], **exact)
    assert si["An"] == pytest.approx(np.pi * si["a"] ** 2, **exact)
    assert si["p_mean"] == pytest.approx(10 / si["An"], **exact)
    assert 2 * np.pi * si["a"] ** 2 * (si["p"][1:-1] * s * w).sum() == pytest.approx(10, rel=1e-8)  # rtol is 1e-10


def test_hertz_in_physical_units():
    """A steel ball of 5 mm under 10 N: the textbook formulae in SI units."""
    given = study.from_physical(**SCALE, P=10.0, micro="smooth", base="half_space")
    found = study.to_physical(study.solve(**given), **SCALE)
    a = (3 * 10 * 5e-3 / (4 * 2e11)) ** (1 / 3)
    assert found.P.item() == pytest.approx(10, rel=1e-14)  # a few roundings
    assert found.a.item() == pytest.approx(a, rel=1e-12)  # closed form
    assert found.D.item() == pytest.approx(a**2 / 5e-3, rel=1e-12)  # closed form
    assert found.p0.item() == pytest.approx(1.5 * 10 / (np.pi * a**2), rel=1e-12)  # closed form
    assert found.dP_dD.item() == pytest.approx(2 * 2e11 * a, rel=1e-9)
    modulus = study.to_physical(derived.effective_modulus(study.solve(**given)).to_dataset(), **SCALE).E_eff
    assert (modulus.item(), modulus.units) == (pytest.approx(2e11, rel=1e-9), "Pa")
    assert [found[name].units for name in ("P", "a", "p0", "dP_dD")] == ["N", "m", "Pa", "N/m"]
    assert "units" not in found.nu1.attrs and found.P.long_name == "load"
    assert "scale" not in found.P.attrs
    assert found.physical_scale == "R = 0.005 m, E2* = 200000000000.0 Pa"


def test_axes_are_converted_and_stay_selectable():
    found = study.to_physical(study.solve(P=[1e-6, 2e-6], micro="smooth", base="half_space"), **SCALE)
    np.testing.assert_allclose(found.indexes["P"], [5.0, 10.0], rtol=1e-14, atol=0)  # a few roundings
    assert found.sel(P=10, method="nearest").a.notnull()


def test_there_and_back():
    parameters = {name: 0.25 for name in PARAMETERS if not PACKAGE.parameter(name).choices}
    physical = {name: value * factor(name, **SCALE) for name, value in parameters.items()}
    assert study.from_physical(**SCALE, **physical) == pytest.approx(parameters, rel=1e-14)  # a few roundings


def test_forms_are_kept():
    array = xr.DataArray([5e-3, 1e-2], dims="sample")
    found = study.from_physical(**SCALE, h=array, Ra=[5e-3, 1e-2], a=5e-3, bonding=["bonded"])
    assert found["h"].dims == ("sample",)
    np.testing.assert_allclose(found["h"], [1, 2], rtol=1e-15, atol=0)  # one rounding
    np.testing.assert_allclose(found["Ra"], [1, 2], rtol=1e-15, atol=0)  # one rounding
    assert found["a"] == 1
    assert found["bonding"] == ["bonded"]


def test_both_ways_to_physical_units_agree():
    """A scene of `solve`, and dimensionless results converted: one convention, to the rounding of the units."""
    pytest.importorskip("pint")
    modulus = study.reduced_modulus(210e9, 0.3)
    given = {"R": 5e-3, "E2_star": modulus, "P": 10.0, "h": 2e-4, "n": 0.5, "micro": "smooth"}
    converted = study.to_physical(study.solve(**study.from_physical(**given), x=3), R=5e-3, E2_star=modulus)
    scene = study.solve(R="5 mm", E2="210 GPa", nu2=0.3, P="10 N", h="200 um", n=0.5, micro="smooth", x=3)
    for name in ("P", "h", "a", "D", "p0", "p", "dP_dD"):
        np.testing.assert_allclose(converted[name], scene[name], rtol=1e-14, err_msg=name)
        assert converted[name].attrs["units"] == scene[name].attrs["units"]
    assert study.readable(converted).h.attrs["units"] == "µm"


def test_texts_and_quantities_of_pint_are_read_as_solve_reads_them():
    pint = pytest.importorskip("pint")
    smooth = study.solve(P=1e-6, h=0.02, n=0.5, micro="smooth")
    expected = study.to_physical(smooth, **SCALE)
    for R, modulus in (("5 mm", "200 GPa"), (pint.Quantity(0.5, "cm"), pint.Quantity(200, "GPa")), (5e-3, "2e5 MPa")):
        assert study.to_physical(smooth, R=R, E2_star=modulus).identical(expected)
        given = {"P": 10.0, "h": [1e-4, 2e-4], "n": 0.5, "micro": "smooth"}
        texts = given | {"P": "10 N", "h": ["0.1 mm", pint.Quantity(2e-4, "m")]}
        plain, read = study.from_physical(**SCALE, **given), study.from_physical(R=R, E2_star=modulus, **texts)
        assert read.pop("h").tolist() == plain.pop("h").tolist() and read == plain


def test_scales_that_are_no_length_and_no_pressure():
    pytest.importorskip("pint")
    smooth = study.solve(P=1e-6, micro="smooth", base="half_space")
    length, pressure = 'must be a length, such as "2 mm"', 'must be a pressure, such as "2 MPa"'
    for name, given, said in (
        ("R", "5 GPa", f'R = "5 GPa" is a pressure: {length}'),
        ("R", "5", f'R = "5" has no unit: {length}'),
        ("R", "5 ± 1 mm", 'R = "5 ± 1 mm": must have no spread here; study.solve takes spreads, with R and E2'),
        ("R", None, f"R = None: {length}"),
        ("R", [5e-3], f"R = [0.005]: {length}"),
        ("R", "-5 mm", "R = -0.005: must be > 0 and finite"),
        ("E2_star", "5 mm", f'E2_star = "5 mm" is a length: {pressure}'),
        ("E2_star", True, f"E2_star = True: {pressure}"),
    ):
        for call in (
            lambda **scale: study.to_physical(smooth, **scale),
            lambda **scale: study.from_physical(**scale, P=1),
        ):
            with pytest.raises(ValueError) as caught:
                call(**SCALE | {name: given})
            assert str(caught.value) == said
    with pytest.raises(ValueError, match='P = "10 mm" is a length: must be a force'):
        study.from_physical(**SCALE, P="10 mm")


def test_reduced_modulus():
    assert study.reduced_modulus(210e9, 0.3) == pytest.approx(230.769230769e9, rel=1e-11)


def test_a_part_of_physical_results_is_not_converted_twice():
    """It has no attributes of the dataset; metres were taken for radii."""
    given = {"R": "5 mm", "E2": "210 GPa", "base": "half_space", "micro": "smooth", "P": "1 N"}
    with pytest.raises(ValueError, match="in physical units already: a has units = 'm'"):
        study.to_physical(study.solve(**given, x=2).a.to_dataset().reset_coords(drop=True), R="5 mm", E2_star="1 GPa")


def test_arrays_with_units_are_read_as_solve_reads_them():
    """1 mN was taken for 1 N, and R = 10 mm for 10 m."""
    scale = {"R": xr.DataArray(10.0, attrs={"units": "mm"}), "E2_star": "230 GPa"}
    loads = xr.DataArray([1.0, 2.0], dims="P", attrs={"units": "mN"})
    expected = [1e-3 / (230e9 * 1e-4), 2e-3 / (230e9 * 1e-4)]
    pint = pytest.importorskip("pint")
    for P in (loads, np.array(["1 mN", "2 mN"]), pint.UnitRegistry().Quantity([1.0, 2.0], "mN")):
        found = study.from_physical(**scale, P=P)["P"]
        np.testing.assert_allclose(found, expected, rtol=1e-15, atol=0)  # a few roundings
    assert study.solve(**study.from_physical(**scale, P=loads), base="half_space", micro="smooth", x=2).a.dims == ("P",)
    with pytest.raises(ValueError, match='P = "1 mm" is a length'):
        study.from_physical(**scale, P=loads.assign_attrs(units="mm"))


def test_wrong_calls():
    smooth = study.solve(P=1e-6, micro="smooth", base="half_space")
    with pytest.raises(ValueError, match="in physical units already: R = 0.005 m"):
        study.to_physical(study.to_physical(smooth, **SCALE), **SCALE)
    for bad in (0, -1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="^R = .*: must be > 0 and finite"):
            study.to_physical(smooth, R=bad, E2_star=1e11)
        with pytest.raises(ValueError, match="^E2_star = .*: must be > 0 and finite"):
            study.from_physical(R=1.0, E2_star=bad, P=1.0)
    with pytest.raises(ValueError, match='"p_max" is not a parameter'):
        study.from_physical(**SCALE, p_max=3)
    for bad in (None, True, {"start": 1}, [1.0, None]):
        with pytest.raises(ValueError, match='^P = .*: must be a force, such as "2 N"$'):
            study.from_physical(**SCALE, P=bad)
    with pytest.raises(ValueError, match='"Nabr" is not a parameter; did you mean "Nbar"?'):
        study.from_physical(**SCALE, Nabr=3)
