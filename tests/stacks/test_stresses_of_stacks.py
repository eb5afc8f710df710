"""Stresses of contacts on stacks: as on one layer where they are one, and what each layer and interface has."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study

LAYER = {"h": 0.02, "n": 5.0, "bonding": "bonded"}
CUT = [{"h": 0.008, "n": 5.0, "nu": 0.2, "bonding": "bonded"}, {"h": 0.012, "n": 5.0, "nu": 0.2, "bonding": "bonded"}]
TWO = [
    {"h": 0.01, "n": 5.0, "nu": 0.2, "bonding": "bonded"},
    {"h": 0.02, "n": 0.5, "nu": 0.4, "bonding": "frictionless"},
]
NAMES = ("sr", "st", "sz", "trz", "ur", "uz", "mises", "tresca", "s1", "s2", "s3")


def on_one_layer(**inputs):
    return study.solve(**LAYER, nu1=0.2, base="layered", micro="smooth", profiles=False, **inputs)


def on(layers, **inputs):
    return study.solve(layers=layers, micro="smooth", profiles=False, **inputs)


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_one_layer_in_two_pieces(mu):
    """Has the stresses of the one layer, at its interface and where they are largest."""
    r, z = [0.0, 0.7, 1.0, 1.5], [0.0, 0.05, 0.3, 1.0]
    one, two = on_one_layer(a=[0.05, 0.1]), on(CUT, a=[0.05, 0.1])
    wanted, made = (study.stresses(contact, r, z, mu, 0.001) for contact in (one, two))
    size = np.abs(wanted.sz).max()
    assert made.mises_above.dims == ("a", "interface", "r") and made.interface.values.tolist() == [1, 2]
    for name in NAMES:
        assert_allclose(made[name], wanted[name], rtol=0, atol=1e-10 * size, err_msg=name)
        for side in ("above", "below"):
            assert_allclose(made[f"{name}_{side}"][:, 1], wanted[f"{name}_{side}"], rtol=0, atol=1e-10 * size)
    wanted, made = (study.extremes(contact, mu, 0.001) for contact in (one, two))
    assert made.mises_layer.dims == ("a", "layer") and made.tau_interface.dims == ("a", "interface")
    for name, same in {"mises1": "mises_layer", "s1_layer": "s1_layer", "tresca1": "tresca_layer"}.items():
        assert_allclose(made[same].max("layer"), wanted[name], rtol=1e-7)
    for name, same in {"tau_interface": "tau_interface", "sr_interface1": "sr_interface"}.items():
        assert_allclose(made[same].sel(interface=2), wanted[name], rtol=1e-7)
    for name in ("mises2", "tresca2", "s1_surface"):
        assert_allclose(made[name], wanted[name], rtol=1e-7)


def test_a_stack_of_one_layer_has_its_names_too():
    one, stack = study.extremes(on_one_layer(a=0.1)), study.extremes(on([LAYER | {"nu": 0.2}], a=0.1))
    for name in one.data_vars:
        of_place = str(name).endswith(("_r", "_z"))  # of a maximum: known to the root of what its value is
        atol = 2e-4 if of_place else 1e-12
        assert_allclose(np.squeeze(stack[name]), one[name], rtol=1e-7, atol=atol, err_msg=str(name))


def test_extremes_bound_the_stresses():
    """No point of a dense section has more, and the places have them; without friction nothing shears."""
    contact = on(TWO, a=0.05)
    largest, r = study.extremes(contact), np.concatenate([np.linspace(0, 2, 21), np.linspace(2.2, 6, 10)])
    tops = np.array([0.0, 0.2, 0.6])
    for number, (top, end) in enumerate(zip(tops, [*tops[1:], 3.0], strict=True), 1):
        field = study.stresses(contact, r, np.linspace(top + 1e-9, end, 12)).mises
        value = largest.mises_layer.sel(layer=number) if number < 3 else largest.mises2
        assert field.max() <= value * (1 + 1e-8) and field.max() > 0.8 * value
    for number in (1, 2):
        place = largest.sel(layer=number, interface=number)
        there = study.stresses(contact, [place.mises_layer_r], [place.mises_layer_z])
        assert_allclose(there.mises.squeeze(), place.mises_layer, rtol=1e-6)
        there = study.stresses(contact, [place.sr_interface_r], [0.0])
        assert_allclose(there.sr_above.sel(interface=number).squeeze(), place.sr_interface, rtol=1e-6)
    assert largest.tau_interface[1] == 0 and np.isnan(largest.tau_interface_r[1]) and largest.tau_interface[0] > 0


def test_residual_stresses_of_each_layer():
    contact = on(TWO, a=0.05)
    without, made = (study.stresses(contact, [0.5], [0.1, 0.4, 1.0], sigma_res=s) for s in (0.0, [0.01, -0.02]))
    assert_allclose((made.sr - without.sr).squeeze(), [0.01, -0.02, 0.0], rtol=0, atol=1e-15)
    assert_allclose((made.st_below - without.st_below).squeeze(), [-0.02, 0.0], rtol=0, atol=1e-15)
    with pytest.raises(study.StudyError, match="one for each of the 2 layers"):
        study.extremes(contact, sigma_res=[0.1])


def test_first_yield_of_each_layer():
    """The load of the layer that is cut in two is that of the one layer; at that load it has its strength."""
    one = study.first_yield(**LAYER, nu1=0.2, base="layered", micro="smooth", Y1=0.05, Y2=0.03)
    strong = [CUT[0] | {"Y": 0.05}, CUT[1] | {"Y": 0.05}]
    two = study.first_yield(layers=strong, micro="smooth", Y2=0.03)
    assert_allclose(two.P_Y_layer.min(), one.P_Y1, rtol=1e-6)
    assert_allclose(two.P_Y2, one.P_Y2, rtol=1e-6)
    assert two.first_layer == 1 + np.argmin(two.P_Y_layer.values)
    assert study.decode(two.first_yield) == study.decode(one.first_yield)
    layer = int(two.first_layer)
    at = on(CUT, P=two.P_Y_layer.sel(layer=layer).item())
    assert_allclose(study.extremes(at).mises_layer.sel(layer=layer), 0.05, rtol=1e-5)
    text = str(study.summary(two))
    assert "Layer 1 first yields at P" in text and "to yield, as far as strengths are known: layer" in text


def test_a_layer_without_a_strength():
    found = study.first_yield(layers=CUT, micro="smooth", **{"layers.2.Y": 0.05})
    assert study.decode(found.found_Y_layer).values.tolist() == ["strength_not_known", "first_crossing"]
    assert "layer 1" in found.P_Y_layer.attrs["message"] and "give Y1" in found.P_Y_layer.attrs["message"]


def test_thickness_of_another_layer():
    """That protects the body: at it the body has its strength, and above it less."""
    thick = study.h_protect(P=1e-5, Y2=0.005, by="layers.2.h", layers=CUT, micro="smooth").h_protect.item()
    for factor, more in ((1.0, 0.005), (1.1, np.nan)):
        layers = [CUT[0], CUT[1] | {"h": factor * thick}]
        value = study.extremes(on(layers, P=1e-5)).mises2.item()
        assert value < 0.005 if np.isnan(more) else abs(value / more - 1) < 1e-6
    for number in (0, 3):
        with pytest.raises(study.StudyError, match=f'by = "layers.{number}.h": must be one of the layers 1 to 2$'):
            study.h_protect(P=1e-5, Y2=0.005, by=f"layers.{number}.h", layers=CUT, micro="smooth")
    with pytest.raises(study.StudyError, match='by = "n"'):
        study.h_protect(P=1e-5, Y2=0.005, by="n", layers=CUT, micro="smooth")


def test_a_material_axis_of_the_first_layer():
    """Its coordinate makes room for the numbers of layers."""
    stack = [{"material": "DLC a-C:H", "h": "2 um", "bonding": "bonded"}, {"material": "CrN", "h": "1 um"}]
    given = {"R": "5 mm", "body": "steel 52100", "P": "1 N", "micro": "smooth", "profiles": False}
    largest = study.extremes(study.solve(**given, layers=stack))
    assert largest["layers.1.material"] == "DLC a-C:H" and largest.layer.values.tolist() == [1, 2]


@pytest.mark.parametrize("profile", ["exponential", "linear"])
def test_graded(profile):
    """A layer that is graded by very little has the stresses of a uniform one; a steep one those of finer sublayers, to
    what `stress_error` says, without a jump between sublayers."""
    even = {"h": 0.05, "n": [3.0, 3.0000001], "nu": 0.3, "profile": profile, "bonding": "bonded"}
    uniform = {"h": 0.05, "n": 3.0, "nu": 0.3, "bonding": "bonded"}
    wanted, made = (study.stresses(on([layer], a=0.1), [0.0, 0.8, 1.0], [0.0, 0.2, 0.6]) for layer in (uniform, even))
    assert np.abs(made.sr - wanted.sr).max() < 1e-6 * np.abs(wanted.sr).max()


def test_graded_is_finer_with_more_sublayers():
    steep = {"h": 0.05, "n": [6.0, 1.0], "nu": 0.3, "profile": "exponential", "bonding": "bonded"}
    r, z = [0.0, 0.9, 1.2], [0.0, 0.11, 0.13, 0.4, 0.7]
    usual, fine = (study.stresses(on([steep], a=0.1, **more), r, z) for more in ({}, {"sublayers": 16}))
    assert np.abs(usual.sr - fine.sr).max() <= usual.stress_error * np.abs(fine.sr).max()
    assert usual.stress_error < 1e-3


def test_shapes_and_adhesion():
    """A cone, and what sticks, on a layer that is cut in two."""
    for given in ({"shape": "cone", "half_angle": 80.0}, {"w_adhesion": 1e-5, "adhesion": "jkr"}):
        one, two = on_one_layer(a=0.05, **given), on(CUT, a=0.05, **given)
        wanted, made = (study.stresses(contact, [0.3, 0.8, 1.3], [0.05, 0.5]) for contact in (one, two))
        assert_allclose(made.mises, wanted.mises, rtol=1e-6, err_msg=str(given))


def test_a_rough_contact():
    """Nominal stresses, and asperities on a half-space of the first layer: as on one layer."""
    rough = {"micro": "disc_cell", "Nbar": 1e6, "Ra": 0.001, "P": 1e-4, "hardness": 0.5, "asperities_on": "half_space"}
    one = study.solve(**LAYER, nu1=0.2, base="layered", profiles=False, **rough)
    two = study.solve(layers=CUT, profiles=False, **rough)
    wanted, made = study.extremes(one), study.extremes(two)
    assert_allclose(made.mises2, wanted.mises2, rtol=1e-5)
    del rough["P"]
    loads = [
        study.first_yield(**given, **rough).P_Ya for given in (LAYER | {"nu1": 0.2, "base": "layered"}, {"layers": CUT})
    ]
    assert_allclose(*loads, rtol=1e-5)


def test_the_picture():
    figure = study.plot_stresses(on(TWO, a=0.05))
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles[0].startswith("(a) layers: largest") and any("interface 1" in title for title in titles)


def test_below_a_spot():
    """Asperities that feel the stack: as on one layer, in two pieces too where the interface does not count."""
    rough = {"micro": "disc_cell", "Nbar": 100.0, "Ra": 0.02, "asperities_on": "layer", "hardness": 0.5}
    pieces = [LAYER | {"nu": 0.2}], CUT
    one = study.solve(**LAYER, nu1=0.2, base="layered", P=1e-4, profiles=False, **rough)
    wanted, whole, cut = map(study.extremes, (one, *(study.solve(layers=p, P=1e-4, **rough) for p in pieces)))
    for name in wanted.data_vars:
        if "_spot" in name:
            assert_allclose(whole[name], wanted[name], rtol=1e-6, err_msg=str(name))
    for name in ("mises1_spot", "mises2_spot", "mises1_spot_z", "mises2_spot_z"):
        assert_allclose(cut[name], wanted[name], rtol=1e-6, err_msg=name)
    loads = [study.first_yield(layers=p, **rough).P_Ya for p in pieces]
    assert_allclose(*loads, rtol=1e-5)


def test_a_ridge_that_rises_to_both_interfaces_of_a_layer():
    """The third layer's largest tension is at its upper side, 1e-4 above that at its lower side; from the radii of the
    coarse grid it rises downwards alone."""
    layers = [
        {"h": 0.03041613654859139, "n": 14.906675366903118, "nu": 0.45252754739641143, "bonding": "bonded"},
        {"h": 0.01252007144059987, "n": 0.21605180235547639, "nu": 0.1750607630376496, "bonding": "frictionless"},
        {"h": 0.01183742070253141, "n": 0.2601781051437097, "nu": 0.44478218873662334, "bonding": "frictionless"},
    ]
    contact = study.solve(a=0.05, base="stack", layers=layers, nu2=0.3, micro="smooth")
    top = (layers[0]["h"] + layers[1]["h"]) / 0.05
    along = study.stresses(contact, r=np.linspace(3.6, 3.9, 31), z=[top + 1e-9]).s1.max()
    largest = study.extremes(contact).s1_layer[2]
    assert_allclose(largest, along, rtol=5e-6)


def test_maxima_of_films_next_to_the_edge():
    """Below the edge, at the first interface, the stress is larger than on the axis; the search had no radius there."""
    layers = [
        {"h": 0.00023354, "n": 0.9927, "nu": 0.48222, "bonding": "bonded"},
        {"h": 0.00094802, "n": 0.066764, "nu": 0.16082, "bonding": "bonded"},
    ]
    contact = on(layers, a=0.01, nu2=0.31796)
    largest = study.extremes(contact).tresca_layer[0].item()
    beside = study.stresses(contact, [1.0234], [0.0]).tresca_above[0, 0].item()
    assert largest >= beside * (1 - 1e-9) > 0.4 * contact.p0.item()


def test_weak_tension_far_from_the_edge():
    """A layer on springs bends over a length of its own, at the end of which the interface is pulled."""
    contact = on([{"h": 0.025, "n": 0.061, "nu": 0.38, "bonding": {"cn": 0.41, "ct": 0.41}}], a=0.01, nu2=0.014)
    largest = study.extremes(contact).sz_interface_max.item()
    assert largest >= study.stresses(contact, [8.1], [0.0]).sz_above.item() > 0


def test_the_larger_of_two_ridges_far_from_the_edge():
    """Behind the contact the third layer is pulled along its upper side, and farther out off it, by more: the search
    had no radius there."""
    layers = [
        {"h": 0.002515, "n": 0.0475, "nu": 0.25, "bonding": "bonded"},
        {"h": 0.021213, "n": 0.3136, "nu": 0.1236, "bonding": "frictionless"},
        {"h": 0.016352, "n": 0.0563, "nu": 0.2245, "bonding": "bonded"},
    ]
    contact = on(layers, a=0.01, nu2=0.2376)
    largest = study.extremes(contact, mu=0.3).s1_layer[2].item()
    assert largest >= study.stresses(contact, [-7.8], [0.0], mu=0.3).s1_below[1].item() > 0


def test_two_maxima_that_are_close():
    """On the axis and at r = 0.31 the stresses along the lower side of the first layer differ by 2e-5."""
    layers = [
        {"h": 0.0024931574502, "n": 61.7299404983, "nu": 0.327598127239, "bonding": "frictionless"},
        {"h": 0.0004745194438, "n": 0.168291128597, "nu": 0.409331717022, "bonding": "bonded"},
    ]
    contact = on(layers, a=0.01, nu2=0.202295112129)
    along = study.stresses(contact, np.linspace(0, 0.4, 9), [0.0]).mises_above[0]
    largest = study.extremes(contact).mises_layer[0].item()
    assert largest >= along.max().item() > along[0].item() * (1 + 5e-6)
