"""The micro law of a scan: lattices of a known law, random surfaces between two theories, layers, files, refusals."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver.laws import lattice
from solver.laws.cell.periodic import waves_times
from study import StudyError, roughness, samples
from study.scan_laws.bodies import body_of
from study.scan_laws.patch import Pressing, patch_of

pytestmark = pytest.mark.filterwarnings("ignore:this contact is beyond what the model")
#: A wavy surface of 32 × 32 µm, 64 × 64 points: enough for what is compared with itself.
SURFACE = roughness.self_affine((64, 64), "0.5 um", hurst=0.8, rms="20 nm", seed=3)
LAYER = {"h": "2 um", "n": 10, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded"}
FEW = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2]
BALL = {"R": "5 mm", "E2": "5 GPa", "P": "0.3 N"}


def of_surface(**arguments):
    return roughness.law(SURFACE, **{"pressures": FEW, "periodic": "given", "progress": False} | arguments)


@pytest.fixture(scope="module")
def on_layer():
    return of_surface(on=LAYER)


def test_a_lattice_of_paraboloids_has_the_law_of_the_square_lattice():
    """Within 1 %, λ within a row of points around each spot: 9 % at a spot of 30 points."""
    x = (np.arange(96) + 0.5) / 96 - 0.5
    z = -(x**2 + x[:, None] ** 2) / 2 * 1e-6
    scan = roughness.height_map(z, dx=1e-5 / 96, name="paraboloid")
    of_scan = roughness.law(scan, pressures=[0.002, 0.006, 0.012], periodic="given", form="mean", progress=False)
    law = lattice.SQUARE.at(of_scan.p, 1.0, Nbar=1e10, Ra=1e-4)
    assert_allclose([of_scan.A, of_scan.p_max], [law.A, law.p_max], rtol=0.01)
    assert_allclose(of_scan.lam, law.lam, rtol=0.03)


@pytest.mark.parametrize("hurst", [0.5, 0.9])
def test_real_area_of_random_surfaces_is_between_two_theories(hurst):
    """λ h' E*/p: 1.60 of Persson, 2.51 of Bush, Gibson and Thomas. Here λ is 0.1 to 0.25: at smaller ones, of eight
    points a wave of the shortest, it is up to 2.8, as points at the borders of spots count whole."""
    ratios = []
    for seed in range(2):
        scan = roughness.self_affine((128, 128), 1e-7, hurst=hurst, rms=5e-9, longest=3.2e-6, shortest=8e-7, seed=seed)
        of_scan = roughness.law(scan, pressures=[0.001, 0.002], periodic="given", form="mean", progress=False)
        waves = [2 * np.pi * np.fft.fftfreq(128, 1e-7), 2 * np.pi * np.fft.fftfreq(128, 1e-7)]
        q = np.hypot(waves[0][:, None], waves[1])
        slope = np.sqrt(np.sum(q**2 * np.abs(np.fft.fft2(scan.z) / scan.z.size) ** 2))
        ratios += (of_scan.lam * slope / of_scan.p).tolist()
    print(f"H = {hurst}: λ h'E*/p = {np.mean(ratios):.2f}, {np.mean(ratios) / 1.5958:.2f} times Persson's")
    assert 1.596 < np.mean(ratios) < 2.507


def test_at_small_lambda_the_area_of_fine_points_is_between_them_too():
    """With one, two and four points a pixel λ h' E*/p is 2.75, 2.55 and 2.47 at λ = 0.025."""
    scan = roughness.self_affine((128, 128), 1e-7, hurst=0.9, rms=5e-9, longest=3.2e-6, shortest=8e-7, seed=0)
    ratios = [roughness.contact_map(scan, 1.68e-4, periodic="given", form="mean", refine=r).lam / 0.01 for r in (1, 4)]
    assert 1.596 < ratios[1] < 2.507 < ratios[0]


def test_the_pressures_cover_the_range():
    of_scan = roughness.law(SURFACE, periodic="given", progress=False)
    assert 0.7e-3 < of_scan.lam[0] < 1.4e-3  # four points, or about
    assert 0.6 <= of_scan.lam[-1] < 0.8
    assert 10 < len(of_scan.p) < 30 and all(np.diff(values).min() >= 0 for values in (of_scan.p, of_scan.lam))
    assert of_scan.error == max(of_scan.errors.values()) and {"pixel", "patch"} == {*of_scan.errors}
    contact = study.solve(**BALL, base="half_space", micro=of_scan)
    assert contact.status == 0 and contact.model_error >= of_scan.error
    assert "errs by about" in study.summary(contact)


def test_a_file_has_the_same_law(on_layer, tmp_path):
    on_layer.to_csv(tmp_path / "law.csv")
    there = BALL | LAYER | {"base": "layered"}
    kept, read = (study.solve(**there, micro=micro) for micro in (on_layer, f"table:{tmp_path / 'law.csv'}"))
    assert kept.status == 0
    for name in ("a", "p_max", "Ar_An", "D", "model_error"):
        assert kept[name].item() == read[name].item()


def test_an_elastic_punch_adds_to_what_gives_way(on_layer):
    """At one pressure over the modulus that is felt, a punch of the layer's modulus makes the layer half as felt."""
    elastic, half = (of_surface(on=LAYER | {"m": m}) for m in (1.0, 1e-9))
    assert_allclose(half.lam, on_layer.lam, rtol=1e-6)
    assert (elastic.lam > on_layer.lam).all() and elastic.body["m"] == 1
    contact = study.solve(**BALL | LAYER, m=1.0, base="layered", micro=elastic)
    lam = float(contact.lam.sel(x=0)) if "lam" in contact else float(contact.lam0)
    p0 = float(contact.p0) / (10 * 5e9 / 0.91)
    assert_allclose(lam, np.exp(np.interp(np.log(p0), np.log(elastic.p), np.log(elastic.lam))), rtol=0.1)


@pytest.mark.parametrize(
    ("other", "words"),
    [
        ({"h": "3 um"}, "h = 2e-06 m, not 3e-06 m"),
        ({"n": 9}, "n = 10, not 9"),
        ({"bonding": "frictionless"}, '"bonded", not "frictionless"'),
        ({"base": "half_space"}, "not a half-space"),
        ({"m": 0.5}, "m = 0, not 0.5"),
    ],
)
def test_contacts_on_another_body_are_refused(on_layer, other, words):
    with pytest.raises(StudyError, match=words):
        study.solve(**{**BALL, **LAYER, "base": "layered", "micro": on_layer, **other})


def test_the_law_of_a_half_space_is_taken_on_any_body():
    contacts = study.solve(**BALL | LAYER | {"R": ["5 mm", "10 mm"]}, base="layered", micro=of_surface())
    assert (contacts.status == 0).all()
    alone = study.solve(**BALL | LAYER | {"R": "10 mm"}, base="layered", micro=of_surface())
    assert_allclose(contacts.D[1], alone.D, rtol=1e-9)


def test_spots_of_few_points_are_said():
    fine = roughness.self_affine((64, 64), 1e-6, hurst=0.5, rms=1e-7, shortest=3e-6, seed=1)
    of_scan = roughness.law(fine, pressures=FEW, progress=False)
    assert any("fewer than 4 points" in note for note in of_scan.notes)
    assert of_scan.errors["pixel"] > 0.05


def test_a_stack_comes_to_rest():
    """A stiff layer on a soft one, where a half of the points touches: a third of them came and went for ever."""
    layers = [{"h": "1 um", "E1": "50 GPa", "nu": 0.2, "bonding": "bonded"}, {"h": "3 um", "E1": "2 GPa", "nu": 0.4}]
    body = body_of({"layers": layers, "nu2": 0.3, "E2": "5 GPa"}, "law")
    scan = roughness.read(samples.scan())
    pressing = Pressing(patch_of(scan, "plane", None, "mirror", 1, "law").quarters()[1], body.kernel)
    for p in (1e-3, 4e-3, 0.0122):
        A, lam, _ = pressing.at(p)
    assert 0.45 < lam < 0.7 and pressing.pressures.mean() == pytest.approx(0.0122)
    gap = waves_times(pressing.pressures, pressing.response, True) + pressing.depths - A
    assert_allclose(gap[pressing.pressures > 0], 0, atol=1e-14)


def test_what_makes_a_period():
    """A mirrored patch is four times as large; tapered borders go to the mean; points between points change little."""
    mirrored, fine = of_surface(periodic="mirror"), of_surface(refine=2)
    assert_allclose(mirrored.lam[2:], of_surface().lam[2:], rtol=0.15)
    tapered = patch_of(SURFACE, "mean", None, "taper", 1, "law")
    assert_allclose(tapered.z[0], 0, atol=1e-20)
    assert_allclose(tapered.z[8:-8, 8:-8], SURFACE.z[8:-8, 8:-8] - SURFACE.z.mean(), atol=1e-20)
    assert of_surface(periodic="taper").lam[-1] > of_surface().lam[-1]
    assert_allclose(fine.lam[2:], of_surface().lam[2:], rtol=0.1)


def test_a_map_of_the_spots():
    spots = roughness.contact_map(SURFACE, 0.002, periodic="given")
    assert_allclose(spots.pressure.mean(), 0.002, rtol=1e-12)
    assert spots.gap.min() == 0 and ((spots.gap > 0) == (spots.pressure == 0)).mean() > 0.999
    assert_allclose([(spots.pressure > 0).mean(), spots.pressure.max()], [spots.lam, spots.p_max])
    assert_allclose(spots.x[1] - spots.x[0], 0.5e-6)
    in_pascal = roughness.contact_map(SURFACE, "20 MPa", E1="10 GPa", periodic="given")
    assert_allclose(in_pascal.pressure, 1e10 * spots.pressure, rtol=1e-6, atol=1e-3)
    assert in_pascal.pressure.units == "Pa"
    assert [spots.A_units, spots.p_max_units, in_pascal.p_max_units] == ["m", "E1*", "Pa"]


def test_a_map_takes_the_modulus_of_the_body_it_is_on():
    """n = 10 on E2* = 5 GPa/0.91; and an E1 that contradicts it is refused."""
    E1 = 10 * 5e9 / 0.91
    on = {"on": LAYER | {"E2": "5 GPa"}, "periodic": "given"}
    spots = roughness.contact_map(SURFACE, "50 MPa", **on)
    by_ratio = roughness.contact_map(SURFACE, 5e7 / E1, **on | {"on": LAYER})
    assert_allclose(spots.pressure.mean(), 5e7, rtol=1e-12)
    assert_allclose([spots.A, spots.lam, spots.p_max / E1], [by_ratio.A, by_ratio.lam, by_ratio.p_max], rtol=1e-6)
    assert spots.pressure.units == "Pa" and by_ratio.p_max_units == "E1*"
    stiff = {"E_punch": "20 GPa", "nu_punch": 0.2}
    felt = roughness.contact_map(SURFACE, "50 MPa", **on | {"on": on["on"] | stiff})
    assert_allclose(felt.pressure.mean(), 5e7, rtol=1e-12)
    with pytest.raises(ValueError, match=r"E1 = '20 GPa', but `on` has E1\* = 5.49\d*e\+10 Pa: leave E1 out"):
        roughness.contact_map(SURFACE, "50 MPa", E1="20 GPa", **on)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: roughness.law(SURFACE.z), "a map of heights"),
        (lambda: of_surface(pressures=[0.1, -1]), "pressures"),
        (lambda: of_surface(periodic="twice"), 'allowed are "mirror"'),
        (lambda: of_surface(refine=0), "refine = 0"),
        (lambda: of_surface(cutoff=1e-9), "three steps"),
        (lambda: of_surface(on={"h": "2 um", "n": "10 MPa"}), "on"),
        (lambda: of_surface(on={"h": ["2 um", "3 um"], "n": 10}), "several values"),
        (lambda: of_surface(on={"R": "2 mm"}), "on has R"),
        (lambda: of_surface(on="DLC"), "dictionary"),
        (lambda: roughness.contact_map(SURFACE, "2 MPa"), "give E1"),
        (lambda: roughness.contact_map(SURFACE, "2 MPa", on=LAYER), "or moduli in `on`"),
        (lambda: roughness.contact_map(SURFACE, 0), "p = 0"),
        (lambda: roughness.self_affine((64, 64), 1e-6, hurst=2, rms=1e-8), "hurst"),
        (lambda: roughness.self_affine((64, 8), 1e-6, hurst=1, rms=1e-8), "shape"),
        (lambda: roughness.self_affine((64, 64), -1e-6, hurst=1, rms=1e-8), "dx"),
        (lambda: roughness.self_affine((64, 64), 1e-6, hurst=1, rms=1e-8, longest=1e-6), "no wave"),
    ],
)
def test_what_is_refused(call, words):
    with pytest.raises(ValueError, match=words):
        call()


def test_a_random_surface_has_its_spectrum():
    scan = roughness.self_affine((128, 128), "1 um", hurst=0.7, rms="30 nm", longest="32 um", shortest="4 um", seed=5)
    assert_allclose(scan.z.std(), 30e-9)
    power = np.abs(np.fft.fft2(scan.z)) ** 2
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(128), np.fft.fftfreq(128)))
    assert power[(q > 1 / 3.9) | (q < 1 / 33)].max() < 1e-20 * power.max()
    inside = (q > 1 / 31) & (q < 1 / 4.1)
    slope = np.polyfit(np.log(q[inside]), np.log(power[inside]), 1)[0]
    assert slope == pytest.approx(-3.4, abs=0.15)
    again = roughness.self_affine((128, 128), 1e-6, hurst=0.7, rms=3e-8, longest=32e-6, shortest=4e-6, seed=5)
    assert_allclose(again.z, scan.z, rtol=1e-12)
