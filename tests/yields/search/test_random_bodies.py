"""Largest stresses of random bodies: no point of a dense grid has more. And of films, which dense grids do not see."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver.fields.pressure import Pressure
from solver.kernels.two_layers import TwoLayers
from solver.numerics.mesh import mesh_of
from solver.yields.extremes import EXTREMES, VALUES, extremes
from solver.yields.loaded import Loaded

MESH = mesh_of(16)


def body(n, nu1, nu2, bonded, h, mu=0.0, power=1):
    layers = TwoLayers(*(np.array([value]) for value in (n, nu1, nu2, bonded)))
    return Loaded(layers, np.array([h]), Pressure(MESH, MESH.s[None] ** power), False, mu, np.zeros(1))


def random_body(seed):
    """Layers from a film to ten radii, from soft to hard ones, bonded and sliding interfaces, with friction and not."""
    random = np.random.default_rng(seed)
    h, n = np.exp(random.uniform(np.log([0.01, 0.01]), np.log([10.0, 200.0])))
    nu1, nu2 = random.uniform(0, 0.5, 2)
    return body(n, nu1, nu2, random.random() < 0.6, h, float(random.choice([0, 0, 0.3])), random.choice([1, 3]))


def dense(loaded):
    """Name -> the largest value on a dense grid."""
    h, breadth = loaded.h[0], loaded.h[0] * max(1.0, np.cbrt(loaded.layers.n[0]))
    near = h * np.geomspace(0.05, 8, 14)
    r = np.concatenate([np.linspace(0, 1.6, 33), 1 - near, 1 + near, 1 + breadth * np.linspace(0.1, 6, 20)])
    r = np.unique(r[r >= 0])
    inside = np.concatenate([h * np.linspace(0.04, 1, 12), np.linspace(0.03, 1.2, 14)])
    below = np.concatenate([np.linspace(0, 1.4, 16), h * np.linspace(0.1, 1.3, 6)])
    depths = {"layer": inside[inside <= h], "surface": np.zeros(1), "above": np.array([h]), "body": h + below}
    stresses = {place: loaded.stresses(r, np.sort(z), place == "body")[:, 0] for place, z in depths.items()}
    return {
        name: max(
            VALUES[function](*stresses["surface" if kind in ("inside", "outside") else kind]).max() for kind in kinds
        )
        for name, (function, kinds, _) in EXTREMES.items()
    }


@pytest.mark.parametrize("seed", [3, 14, 15, 92, 65])
def test_no_point_of_a_dense_grid_has_more(seed):
    loaded = random_body(seed)
    largest = extremes(loaded)
    for name, value in dense(loaded).items():
        sign = -1 if name == "sz_interface_min" else 1
        assert sign * largest[name][0, 0] >= max(value, 0.0) * (1 - 1e-7) - 1e-9, name


def test_weak_tension_far_from_the_contact():
    """At 2.8 radii, where a coarse grid of lengths of the layer sees that at 5.6 alone, which is half as large."""
    largest = extremes(body(0.014, 0.21, 0.34, True, 0.895), ("sr_interface1",))["sr_interface1"]
    assert 2 < largest[1, 0] < 4
    assert largest[0, 0] > 4e-5


def test_films_become_like_each_other():
    """The body has the stress of a bare half-space; next to the edge lengths are those of the film."""
    thin, thinner = (extremes(body(2.0, 0.3, 0.3, True, h)) for h in (2e-4, 1e-4))
    assert_allclose(thinner["mises2"][:, 0], [0.620, 0.0, 0.481], rtol=1e-3, atol=1e-6)
    for name in ("tau_interface", "sr_interface1"):
        away = [abs(made[name][1, 0] - 1) / h for made, h in ((thin, 2e-4), (thinner, 1e-4))]
        assert_allclose(away[0], away[1], rtol=0.4, err_msg=name)
    # a pressure that ends like the root of the distance makes shear like the root of the thickness
    assert_allclose(thin["tau_interface"][0] / thinner["tau_interface"][0], np.sqrt(2), rtol=0.01)
