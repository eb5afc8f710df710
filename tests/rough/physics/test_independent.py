"""The whole rough problem by another method: rings of constant pressure, Eqs (3), (6), (7) as printed, Richardson.

Nothing of the solver is used: the displacement under a ring is the difference of two uniformly loaded circles
(Johnson 1985, 3.29), the pressure on a ring is that of a contact radius b or of the power law, and the rings are
narrower towards the edge. The radius a is given; P, D, p(0) follow. The error is of second order, which is asserted,
and extrapolated; what is left of it is below 1e-6.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import ellipe, ellipk
from solver_cases import MAIN, one

pytestmark = pytest.mark.usefixtures("each_path")


def circle(r, radius):
    """Surface displacement times E* under a uniform unit pressure on a circle, at r (m,) for radii (k,): (m, k)."""
    r, radius = r[:, None], radius[None, :]
    inner = np.minimum(r / radius, 1.0)
    outer = np.minimum(radius / r, 1.0)
    m = np.where(outer < 1, outer, 0.0) ** 2
    within = 4 / np.pi * radius * ellipe(inner**2)
    beyond = 4 / np.pi * r * (ellipe(m) - (1 - m) * ellipk(m))
    return np.where(r <= radius, within, beyond)


def spots(b, n, Nbar, Ra):
    """p and A of Eqs (7) and (6) for contact radii b; any number type."""
    cell = 1 / np.sqrt(np.pi * Nbar)
    gap = np.sqrt(cell**2 - b**2)
    p = 2 * n * b**3 / (3 * Ra) / (cell**2 * np.arccos(b / cell) + b * gap)
    return p, b**2 / Ra - 2 * p / n * gap


def rings(count, micro, a, h, n, Nbar, Ra, B, beta, C):
    """P, D and p(0) on `count` rings (R = E2* = 1), by Newton on b/B̄ or on p^(β/2), derivatives by a complex step."""
    edges = a * np.sin(np.pi / 2 * np.linspace(0, 1, count + 1))
    middle = 0.5 * (edges[1:] + edges[:-1])
    area = np.pi * np.diff(edges**2)
    U = circle(np.append(middle, a), edges[1:])
    U[:, 1:] -= circle(np.append(middle, a), edges[1:-1])
    U = U[:-1] - U[-1]  # relative to the edge
    right = (a**2 - middle**2) / 2
    cell = 1 / np.sqrt(np.pi * Nbar)

    def law(v):
        if micro == "power_law":
            return n * v ** (2 / beta), B * Ra * v**2
        return spots(cell * v, n, Nbar, Ra)

    v = 0.3 * np.sqrt(1 - (middle / a) ** 2)
    for _ in range(100):
        p, A = law(v)
        dp, dA = (d.imag / 1e-30 for d in law(v + 1e-30j))
        step = np.linalg.solve(U * dp + np.diag(C * dp + dA), right - U @ p - C * p - A)
        new = v + step
        v = np.where(new <= 0, 0.2 * v, np.where((new >= 1) & (micro != "power_law"), 0.5 * (1 + v), new))
        if np.abs(step).max() < 1e-13:
            break
    p, _ = law(v)
    edge = circle(np.array([a]), edges[1:])[0]
    edge[1:] -= circle(np.array([a]), edges[1:-1])[0]
    centre = p[0] + (p[0] - p[1]) / (middle[1] ** 2 / middle[0] ** 2 - 1)  # even in r
    return np.array([area @ p, a**2 / 2 + edge @ p, centre])


CASES = [
    {"a": 0.04},
    {"a": 0.03, "Nbar": 15625.0},
    {"a": 0.02, "h": 0.005, "n": 0.1},
    {"a": 0.05, "n": 2.5},  # a hard coating
    {"a": 0.03, "bonding": "bonded"},
    {"a": 0.03, "base": "half_space"},
    {"a": 0.06, "base": "half_space"},
]


@pytest.mark.parametrize("micro", ["disc_cell", "power_law"])
@pytest.mark.parametrize("case", CASES, ids=str)
def test_rings(micro, case):
    full = MAIN | {"bonding": "frictionless", "base": "thin_layer"} | case
    n, nu = full["n"], 0.3
    A2 = 0.5
    if full.pop("bonding") == "bonded":
        A2 = (1 - n) * (1 - 2 * nu) * (1 + n * (1 - 2 * nu)) / (2 * (1 - nu) ** 2)  # (2)
    if full.pop("base") == "half_space":
        full |= {"n": 1.0}
        A2 = 0.0
    coarse, middle, fine = (rings(count, micro, C=2 * A2 * full["h"] / full["n"], **full) for count in (40, 80, 160))
    assert_allclose((coarse - middle) / (middle - fine), 4, rtol=0.06, atol=0)  # so 1e-6 is earned
    found = one(micro=micro, rtol=1e-11, **case)
    assert found.status[0] == 0
    assert_allclose([found.P[0], found.D[0], found.p0[0]], fine + (fine - middle) / 3, rtol=1e-6, atol=0)
