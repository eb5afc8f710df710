"""The table of names against one written by hand: dimensions and units from physics, words and equations from the
paper, limits and choices from the model."""

import pytest
from xarray.plot.utils import label_from_attrs

import study
from study.inputs.lexicon import PACKAGE
from study.inputs.vocabulary import PARAMETERS, VOCABULARY, attributes, check, names

# The largest stresses, each with its place.
STRESSES = ("mises1", "mises2", "tresca1", "tresca2", "s1_surface", "s1_layer", "sr_interface1", "tau_interface")
STRESSES += ("sz_interface_max", "sz_interface_min", "mises_layer", "tresca_layer", "sr_interface")
SPOTS = ("mises1_spot", "mises2_spot", "sr_interface1_spot", "sz_interface_spot_max", "tau_interface_spot")
# Dimension in powers of kg, m, s and the printed unit of every quantity that has one.
FORCE, LENGTH, PRESSURE = (1, 1, -2), (0, 1, 0), (1, -1, -2)
STIFFNESS, AREA, PER_AREA = (1, 0, -2), (0, 2, 0), (0, -2, 0)
DIMENSIONS = {
    "P": (FORCE, "N"),
    "a": (LENGTH, "m"),
    "D": (LENGTH, "m"),
    "h": (LENGTH, "m"),
    "Nbar": (PER_AREA, "1/m^2"),
    "Ra": (LENGTH, "m"),
    "sigma": (LENGTH, "m"),
    "hardness": (PRESSURE, "Pa"),
    **dict.fromkeys(("yield_strength", "Y1", "Y2", "Y_punch"), (PRESSURE, "Pa")),
    "p0": (PRESSURE, "Pa"),
    "p_max": (PRESSURE, "Pa"),
    "A0": (LENGTH, "m"),
    "dP_dD": (STIFFNESS, "N/m"),
    "p": (PRESSURE, "Pa"),
    "An": (AREA, "m^2"),
    "p_mean": (PRESSURE, "Pa"),
    "b0": (LENGTH, "m"),
    "p_ring": (PRESSURE, "Pa"),
    "r_ring": (LENGTH, "m"),
    "p_peak": (PRESSURE, "Pa"),
    "D_body": (LENGTH, "m"),
    "E_eff": (PRESSURE, "Pa"),
    **dict.fromkeys((*STRESSES, *SPOTS, "p_spot"), (PRESSURE, "Pa")),
    **dict.fromkeys(("flat_radius", "tip_radius", "edge_radius", "z0", "D_off", "a_off", "a_in"), (LENGTH, "m")),
    **dict.fromkeys(("P_off", "P_in"), (FORCE, "N")),
    "sigma0": (PRESSURE, "Pa"),
    "k_machine": (STIFFNESS, "N/m"),
    "w_adhesion": (STIFFNESS, "J/m^2"),
}
UNITS = {
    "N": FORCE,
    "m": LENGTH,
    "Pa": PRESSURE,
    "1/m^2": PER_AREA,
    "N/m": STIFFNESS,
    "J/m^2": STIFFNESS,
    "m^2": AREA,
    "1": (0, 0, 0),
}
# fmt: off
PURE = {
    "n", "m", "nu1", "nu2", "bonding", "base", "micro", "B", "beta", "cut", "scheme", "k", "rtol", "accuracy",
    "model_check", "nodes", "max_iterations", "Ar_An", "plastic_share", "lam0", "lam", "status", "error",
    "profile_error", "model_error", "model_used", "residual", "iterations", "nodes_used", "validity", "An_ratio",
    "spots", "x", "case", "label", "shape", "half_angle", "tip", "shape_power", "shape_coefficient", "adhesion",
    "branch", "stable", "asperities_on", "asperities_used", "r_spot", *(f"{name}_z" for name in SPOTS),
} | {f"{name}_{axis}" for name in STRESSES for axis in "rz"}
# fmt: on


def test_every_name_is_dimensional_or_pure():
    assert set(VOCABULARY) - {"table_unit"} == set(DIMENSIONS) | PURE


@pytest.mark.parametrize("name", VOCABULARY)
def test_dimensions_and_units(name):
    """E2* is a pressure, R a length: E2*^i R^j has the dimension kg^i m^(j - i) s^(-2i)."""
    dimension, unit = DIMENSIONS.get(name, ((0, 0, 0), "1"))
    entry = VOCABULARY[name]
    i, j = entry.powers
    assert (i, j - i, -2 * i) == dimension
    assert entry.unit == unit and dimension == UNITS[unit]


def words(text: str) -> dict:
    """name : symbol : scale : equation : long_name, a line each."""
    rows = (map(str.strip, line.split(":", 4)) for line in text.strip().splitlines())
    return {name: dict(zip(("symbol", "scale", "equation", "long_name"), rest, strict=True)) for name, *rest in rows}


WORDS = words("""
    P       : P        : E2* R^2 : (5)      : load
    a       : a        : R       : (4)      : radius of the nominal contact area
    D       : D        : R       : (14)     : indentation depth
    h       : h        : R       :          : thickness of the layer
    n       : n        :         :          : ratio of the reduced moduli of layer and half-space
    m       : m        :         :          : ratio of the reduced moduli of layer and punch, 0: rigid
    nu1     : ν1       :         :          : Poisson ratio of the layer
    nu2     : ν2       :         :          : Poisson ratio of the half-space
    bonding :          :         :          : interface of layer and half-space
    base    :          :         :          : elastic base
    Nbar    : N̄        : R^-2    :          : number of asperities per unit area
    Ra      : Ra       : R       :          : radius of an asperity
    micro   :          :         : (6), (7) : micro law A[p]
    B       : B        :         :          : coefficient of the power law A = B p^β, in Ra/E1*^β
    beta    : β        :         :          : exponent of the power law A = B p^β
    sigma   : σ        : R       :          : standard deviation of the heights of the asperities
    cut     : c        :         :          : largest height of an asperity above the mean, over σ
    k       : k        :         : (8)      : iteration parameter of the successive approximations
    rtol    :          :         :          : required relative error
    accuracy :         :         :          : largest relative model error that base = auto allows
    p0      : p(0)     : E2*     : (3)      : nominal pressure in the centre
    p_max   : pmax     : E2*     : (13)     : real pressure in the middle of the central spot
    Ar_An   : Ar/An    :         : (12)     : real over nominal contact area
    A0      : A[p(0)]  : R       : (6)      : additional displacement of the rough layer in the centre
    dP_dD   : dP/dD    : E2* R   :          : contact stiffness
    lam0    : λ(0)     :         : (11)     : relative contact area in the centre
    p       : p(r)     : E2*     : (3)      : nominal contact pressure
    lam     : λ(r)     :         : (11)     : relative contact area
    error   :          :         :          : estimated relative error of a, P, D, p(0), pmax and Ar/An
    model_error :      :         :          : estimated relative error of the model used, against the exact layered one
    residual :         :         :          : relative residual of the discrete equation
    An      : An       : R^2     :          : nominal contact area
    An_ratio : An/(π a0²) :      :          : nominal contact area over a reference area
    p_mean  : P/An     : E2*     :          : mean nominal pressure
    spots   : N̄ An     :         :          : number of contact spots
    b0      : b(0)     : R       : (7)      : radius of the central contact spot
    p_peak  : ppeak    : E2*     : (13)     : largest real pressure in the contact, wherever it is
    E_eff   : Eeff     : E2*     :          : effective reduced modulus (dP/dD)/(2a)
    x       : r/a      :         :          : radius over the radius of the nominal contact area
""")
CHOICES = {
    "bonding": {"frictionless", "bonded"},
    "base": {"half_space", "thin_layer", "layered", "auto", "stack", "thin_stack"},
    "micro": {"smooth", "disc_cell", "power_law", "square_lattice", "hex_lattice", "normal_heights", "uniform_heights",
              "elastic_plastic"},
    "asperities_on": {"auto", "layer", "half_space"},
    "scheme": {"newton", "picard"},
    "model_check": {"closed_form", "first_order"},
    "shape": {"paraboloid", "sphere", "cone", "berkovich", "vickers", "cube_corner", "power", "frustum", "blunt_cone",
              "flat", "rounded_flat"},
    "tip": {"paraboloid", "sphere"},
    "adhesion": {"jkr", "dmt", "maugis"},
    "branch": {"stable", "unstable"},
}  # fmt: skip
AXES = {
    "P": "P/(E2* R^2)", "a": "a/R", "D": "D/R", "h": "h/R", "n": "n", "m": "m", "nu1": "ν1", "nu2": "ν2",
    "Nbar": "N̄ R^2", "Ra": "Ra/R", "B": "B", "beta": "β", "sigma": "σ/R", "cut": "c", "k": "k", "p0": "p(0)/E2*",
    "p_max": "pmax/E2*", "Ar_An": "Ar/An", "A0": "A[p(0)]/R", "dP_dD": "(dP/dD)/(E2* R)", "lam0": "λ(0)",
    "p": "p(r)/E2*", "lam": "λ(r)", "An": "An/R^2", "An_ratio": "An/(π a0²)", "p_mean": "(P/An)/E2*",
    "spots": "N̄ An", "b0": "b(0)/R", "p_peak": "ppeak/E2*", "E_eff": "Eeff/E2*", "x": "r/a",
}  # fmt: skip


@pytest.mark.parametrize("name", WORDS)
def test_words_and_equations_are_those_of_the_paper(name):
    expected = {key: text for key, text in WORDS[name].items() if text}
    if name in AXES:
        expected["long_name"] += f", {AXES[name]}"
    assert attributes(name) == expected


def test_labels_of_xarray_are_fit_for_a_plot():
    """No "[1]" behind them: pure numbers have no units, in files and in physical results either."""
    assert all(attributes(name)["long_name"] and "units" not in attributes(name) for name in VOCABULARY)
    found = study.solve(P=[1e-5, 2e-5], h=0.02, n=0.5, micro="smooth", x=3)
    physical = study.to_physical(found, R=0.01, E2_star=2e11)
    assert label_from_attrs(found.a) == "radius of the nominal contact\narea, a/R"
    assert label_from_attrs(found.P) == "load, P/(E2* R^2)" and label_from_attrs(physical.P) == "load [N]"
    assert (
        label_from_attrs(physical.lam0) == label_from_attrs(found.lam0) == "relative contact area in the\ncentre, λ(0)"
    )
    rigid = study.solve(P=1e-5, h=0.02, n=0, micro="smooth", x=3)
    assert label_from_attrs(rigid.p0) == "nominal pressure in the\ncentre, p(0)/E1*" and rigid.p0.scale == "E1*"


def test_parameters_are_in_their_order():
    """In this order they are columns of an inventory, and coordinates of a file."""
    assert " ".join(name for name in PARAMETERS if name != "table_unit") == (  # which comes with a table of a shape
        "P a D h n m nu1 nu2 Y1 Y2 Y_punch bonding base shape half_angle flat_radius tip_radius tip edge_radius "
        "shape_power shape_coefficient w_adhesion adhesion sigma0 z0 branch k_machine Nbar Ra micro B beta sigma cut "
        "hardness yield_strength asperities_on scheme k rtol accuracy model_check nodes max_iterations"
    )
    assert names("control") == ("P", "a", "D") and names("profile") == ("p", "lam")


INF = float("inf")
# name: smallest and largest values that are allowed, and just outside of them; None: no such end.
LIMITS = {
    "P": (1e-24, 0.99e-24, 1e3, 1.01e3),
    "a": (1e-9, 0.99e-9, 1e3, 1.01e3),
    "D": (1e-18, 0.99e-18, 1e3, 1.01e3),
    "h": (1e-12, 0.99e-12, 1e6, 1.01e6),
    "n": (1e-9, 0.99e-9, 1e9, 1.01e9),
    "m": (0, -1e-9, 1e9, 1.01e9),
    "Nbar": (1e-4, 0.99e-4, 1e18, 1.01e18),
    "Ra": (1e-9, 0.99e-9, 100, 101),
    "B": (1e-8, 0.99e-8, 1e4, 1.01e4),
    "nu1": (-0.999, -1, 0.5, 0.501),
    "nu2": (-0.999, -1, 0.5, 0.501),
    "beta": (0.01, 0.0099, 1, 1.001),
    "sigma": (0, -1e-9, 10, 10.1),
    "cut": (3, 2.99, 5, 5.01),
    "hardness": (1e-15, 0.99e-15, 1e15, 1.01e15),
    **dict.fromkeys(("yield_strength", "Y1", "Y2", "Y_punch"), (1e-15, 0.99e-15, 1e15, 1.01e15)),
    "flat_radius": (1e-9, 0.99e-9, 1e3, 1.01e3),
    **dict.fromkeys(("tip_radius", "edge_radius"), (1e-12, 0.99e-12, 1e6, 1.01e6)),
    "shape_power": (1, 0.99, 100, 101),
    "shape_coefficient": (1e-12, 0.99e-12, 1e12, 1.01e12),
    "half_angle": (1e-3, 0, 89.99, 90),
    "w_adhesion": (0, -1e-12, 1e3, 1.01e3),
    "sigma0": (1e-15, 0.99e-15, 1e15, 1.01e15),
    "z0": (1e-15, 0.99e-15, 1e3, 1.01e3),
    "k_machine": (0, -1e-9, INF, float("nan")),
    "k": (0, -1e-9, 1e6, 1.01e6),
    "rtol": (1e-12, 0.99e-12, 0.1, 0.101),
    "accuracy": (1e-12, 0, 0.999, 1),
    "nodes": (4, 3, 256, 257),
    "max_iterations": (1, -1, 100_000, 100_001),
}


def test_every_parameter_has_limits_or_choices():
    assert set(LIMITS) | set(CHOICES) == {*PARAMETERS} - {"table_unit"}
    assert not set(LIMITS) & set(CHOICES)


@pytest.mark.parametrize("name", LIMITS)
def test_limits(name):
    own, (low, below, *ends) = PACKAGE.parameter(name), LIMITS[name]
    high, above = ends or (1e300, INF)
    assert [check(own, value) for value in (low, high)] == ["", ""]
    assert all(check(own, value) for value in (below, above, float("nan"), True, "1", None))


@pytest.mark.parametrize("name", CHOICES)
def test_choices(name):
    own = PACKAGE.parameter(name)
    assert {word for word in own.choices if not word.startswith("table:")} == CHOICES[name]
    assert all(check(own, value) == "" for value in CHOICES[name])
    assert all(check(own, value) for value in ("glued", "", 1, None))


def test_zero_leaves_nodes_and_iterations_to_the_solver():
    for name in ("nodes", "max_iterations"):
        assert check(PACKAGE.parameter(name), 0) == "" and check(PACKAGE.parameter(name), 16.0) == ""
        assert check(PACKAGE.parameter(name), 16.5) == "must be a whole number"
