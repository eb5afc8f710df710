"""Sums over waves at single points by the compiled core, against those by numpy (solver/fields/points)."""

import numpy as np
import pytest
from both_paths import ROOT, of_the_sources  # noqa: F401
from make_bessel import tables
from numpy.testing import assert_allclose
from scipy.special import jv

from solver import Problem, solve
from solver.compiled.library import VARIABLE, available
from solver.compiled.wave_sums import STATES, sums_in_c
from solver.fields.points import wave_points
from solver.fields.pressure import Pressure
from solver.fields.stacks.section import Section
from solver.kernels.transfer import StatePart
from solver.kernels.two_layers import TwoLayers
from solver.numerics.mesh import mesh_of
from solver.scaling import dimensionless
from solver.yields.contact import of_contacts
from solver.yields.search.jets import JetLoad, loads_of
from solver.yields.stacked.stack_jets import StackJets

pytestmark = pytest.mark.skipif(not available(), reason="no compiled core was built here")
NORMAL, SLIDING = loads_of(0.3)
#: Of the largest of the integrals, and of their derivatives: second ones multiply waves by k², and their sums cancel.
SAME, FIRST, SECOND = 1e-13, 5e-13, 2e-11
#: The numpy path goes on to the waves of that point of a group which needs most. What is left out is e^(-END).
AT_THE_END = 1e-12
N, NU1, NU2 = np.array([3.0, 0.4, 20.0, 0.0]), np.array([0.2, 0.4, 0.25, 0.5]), np.array([0.3, 0.5, 0.3, 0.3])
BONDED = np.array([True, False, True, True])


def pressures(cases: int) -> Pressure:
    mesh = mesh_of(16)
    return Pressure(mesh, np.stack([mesh.s**3 - (0.5 - 0.1 * i) * mesh.s**5 for i in range(cases)]))


def rules(h: float) -> tuple:
    """The waves of four bodies: without friction, on a rigid base, stiff and soft."""
    layers, thickness = TwoLayers(N, NU1, NU2, BONDED), h * np.array([1.0, 1.3, 1.7, 1.9])
    tractions = [NORMAL.traction, SLIDING.traction]
    return wave_points.waves_of(layers, thickness, pressures(4), 3.0, 0.8, tractions)


def points_of(kind: StatePart, h: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cases, radii and depths: the axis, the edge, and elsewhere."""
    random = np.random.default_rng(int(kind))
    case = np.arange(count) % 4
    r = np.where(
        np.arange(count) % 7 == 0, 0.0, np.where(np.arange(count) % 5 == 0, 1.0, random.uniform(0.7, 3, count))
    )
    low, high = {StatePart.DIFFERENCE: (0.0, 0.8), StatePart.LAYER: (0.8, 1.0), StatePart.BODY: (1.0, 4.0)}[kind]
    return case, r, h[case] * random.uniform(low, high, count)


def sums(path: str, waves, load: JetLoad, kind, case, r, z) -> np.ndarray:
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv(VARIABLE, path)
        return wave_points.sums(waves, load.integrands, load.traction, load.orders, kind, case, r, z)


def one_by_one(path: str, waves, load: JetLoad, kind, *points) -> np.ndarray:
    count = range(len(points[0]))
    return np.concatenate([sums(path, waves, load, kind, *(v[[i]] for v in points)) for i in count], axis=2)


def are_the_same(core: np.ndarray, numpy: np.ndarray, end: float = 0.0) -> None:
    scale = np.abs(numpy).max(axis=(1, 2))
    assert np.isfinite(numpy).all() and (scale > 0).all()
    for jet, same in enumerate((SAME, FIRST, FIRST, SECOND, SECOND, SECOND)):
        assert_allclose(core[jet], numpy[jet], rtol=0, atol=(same + end) * scale[jet])


@pytest.mark.parametrize("variant", available())
@pytest.mark.parametrize("load", [NORMAL, SLIDING], ids=["normal", "sliding"])
@pytest.mark.parametrize("kind", list(StatePart))
@pytest.mark.parametrize("h", [0.03, 0.4, 2.0])
def test_they_are_those_of_numpy(h, kind, load, variant):
    long, short = rules(h)
    assert (short is not None) == (h < 0.05) and 0 < long.thin < len(long.k)
    for waves in filter(None, (long, short)):
        case, r, z = points_of(kind, waves.h, 40)
        r = r if waves is long else 1 + (r - 1) / 100
        are_the_same(
            one_by_one(variant, waves, load, kind, case, r, z), one_by_one("numpy", waves, load, kind, case, r, z)
        )


@pytest.mark.parametrize("variant", available())
def test_of_many_points(variant):
    waves, _ = rules(0.4)
    case, r, z = points_of(StatePart.LAYER, waves.h, 300)
    core, numpy = (sums(path, waves, NORMAL, StatePart.LAYER, case, r, z) for path in (variant, "numpy"))
    are_the_same(core, numpy, AT_THE_END)
    some = [7, 8, 250]
    assert (core[..., some] == sums(variant, waves, NORMAL, StatePart.LAYER, case[some], r[some], z[some])).all()


@pytest.mark.parametrize("variant", available())
@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_of_stacks(mu, variant, monkeypatch):
    layers = [{"h": 0.15, "n": 3.0, "nu": 0.2, "bonding": "bonded"}, {"h": 0.3, "n": 0.4, "nu": 0.45}]
    scaled = dimensionless(Problem.of(a=1.0, micro="smooth", nu2=0.3, layers=layers))
    jets = StackJets(Section.of(scaled, np.ones(1), pressures(1), mu, np.zeros(2)))
    zero, r = np.zeros(3, dtype=int), np.array([0.0, 0.97, 1.6])
    for number, depth in ((0, 0.03), (0, 0.14), (1, 0.3), (2, 0.6)):
        for i in range(3):
            one = (number, "layer"), zero[:1], zero[:1], zero[:1] > 0, r[[i]], np.array([depth])
            monkeypatch.setenv(VARIABLE, "numpy")
            numpy = jets(*one)
            monkeypatch.setenv(VARIABLE, variant)
            core = jets(*one)
            scale = np.abs(numpy).max(axis=(1, 2), keepdims=True)
            assert_allclose(core / scale, numpy / scale, rtol=0, atol=SECOND)


@pytest.mark.parametrize(("mu", "count"), [(0.0, 20), (0.3, 3)])
def test_largest_stresses(mu, count, monkeypatch):
    """Of contacts from films to thick layers: both paths of the search end at the same maxima."""
    random = np.random.default_rng(4)
    h, n = (np.exp(random.uniform(np.log(low), np.log(high), count)) for low, high in ((0.006, 3), (0.05, 100)))
    bonding = np.where(np.arange(count) % 3, "bonded", "frictionless")
    problem = Problem.of(a=0.03, h=0.03 * h, n=n, nu1=0.25, bonding=bonding, Nbar=2.5e7, Ra=0.004)
    solution, largest = solve(problem), []
    for path in ("numpy", available()[0]):
        monkeypatch.setenv(VARIABLE, path)
        largest.append(of_contacts(problem, solution, mu))
    scale = np.max([np.abs(values[0]) for values in largest[0].values()], axis=0)
    for name, values in largest[0].items():
        assert_allclose(largest[1][name][0] / scale, values[0] / scale, rtol=0, atol=3e-12)


@pytest.mark.parametrize("variant", available())
def test_bessel_functions(variant, monkeypatch):
    """A single wave with k = 1 and a unit stress sz, at radii up to a million."""
    monkeypatch.setenv(VARIABLE, variant)
    x = np.concatenate([[0.0], np.geomspace(1e-9, 1e6, 20_001), np.nextafter([2.0, 8.0], 0), [2.0, 8.0]])
    points, states = len(x), np.zeros((6, len(x), 1))
    states[2] = 1.0
    arrays = {"r": x, "z": 0 * x, "nu": 0 * x, "cases": 0 * x, "ends": 1 + 0 * x, "k": np.ones(1), "states": states}
    numbers = {"kind": STATES, "size": 1, "columns": 1}
    for order in (0, 1, 2, 3):
        jets = sums_in_c(numbers, arrays | {"orders": np.full(6, order)})
        assert jets.shape == (6, 6, points)
        slope, second = (
            (jv(order - 1, x) - jv(order + 1, x)) / 2,
            jv(order - 2, x) - 2 * jv(order, x) + jv(order + 2, x),
        )
        for jet, exact in ((0, jv(order, x)), (1, slope), (3, second / 4)):
            # x itself is rounded, by which the phase moves
            assert np.all(np.abs(jets[jet, 3] - exact) <= 4e-15 + 2e-16 * np.sqrt(x))


def test_the_tables_are_what_their_maker_prints():
    text = (ROOT / "solver/compiled/bessel.h").read_text(encoding="utf-8")
    for name, rows in tables().items():
        of_file = text.partition(f"double {name}[")[2].partition("= {")[2].partition("};")[0]
        numbers = [float(number) for number in of_file.replace("{", " ").replace("}", " ").replace(",", " ").split()]
        assert numbers == [float(value) for row in rows for value in row]
