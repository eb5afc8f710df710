"""Stresses, first yield and protecting layers of stacks whose inputs have units, as texts and as quantities."""

import numpy as np
import pint
from numpy.testing import assert_allclose

import study

UNITS = pint.UnitRegistry()
SCENE = {"R": "5 mm", "E2": "230 GPa", "nu2": 0.3, "micro": "smooth", "punch": "rigid"}
LAYERS = [
    {"h": "4 um", "E1": "200 GPa", "nu": 0.25, "bonding": "bonded"},
    {"h": "2 um", "E1": "290 GPa", "nu": 0.21, "bonding": "bonded"},
]
QUANTITIES = [
    {"h": 4e-3 * UNITS.mm, "E1": 0.2 * UNITS.TPa, "nu": 0.25, "bonding": "bonded"},
    {"h": 2e-6 * UNITS.m, "E1": 290 * UNITS.GPa, "nu": 0.21, "bonding": "bonded"},
]


def test_stresses_of_stacks_with_units():
    """In Pa and m, the same for texts and quantities, and those of numbers times E2*."""
    text, quantity = (study.solve(**SCENE, layers=layers, P="5 N") for layers in (LAYERS, QUANTITIES))
    r, z = [0.0, 0.7, 1.0], [0.0, 0.03, 0.5]
    ours, theirs = study.stresses(text, r, z), study.stresses(quantity, r, z)
    for name in ("sr", "sz_above", "uz", "z_length"):
        assert_allclose(theirs[name], ours[name], rtol=1e-12, err_msg=name)
    assert ours.sr.attrs["units"] == "Pa" and ours.z_length.attrs["units"] == "m"
    E2 = 230e9 / (1 - 0.3**2)
    pure = [
        {"h": h / 5e-3, "n": E / (1 - nu**2) / E2, "nu": nu, "bonding": "bonded"}
        for h, E, nu in ((4e-6, 200e9, 0.25), (2e-6, 290e9, 0.21))
    ]
    numbers = study.solve(layers=pure, nu2=0.3, micro="smooth", P=5 / (E2 * 25e-6))
    assert_allclose(study.stresses(numbers, r, z).sr * E2, ours.sr, rtol=1e-6, atol=1e-8 * np.abs(ours.sr).max())


def test_first_yield_and_protecting_layers_with_units():
    """Strengths and lengths as texts and as quantities; under more load a thicker second layer protects, in m."""
    loads = [
        study.first_yield(**SCENE | {"R": R}, layers=layers, Y2=Y2).P_Y2
        for R, layers, Y2 in (("5 mm", LAYERS, "2 GPa"), (5 * UNITS.mm, QUANTITIES, 2e9 * UNITS.Pa))
    ]
    assert loads[0].attrs["units"] == "N" and 1 < loads[0] < 1000
    assert_allclose(loads[1], loads[0], rtol=1e-9)
    load = f"{1.2 * loads[0].item()} N"
    thickness = study.h_protect(**SCENE, layers=QUANTITIES, P=load, Y2="2 GPa", by="layers.2.h").h_protect
    assert thickness.attrs["units"] == "m" and 2e-6 < thickness < 1e-4
