"""A kernel of somebody else's in one file, stack.py: layers over layers. Nothing in the solver knows of it."""

import csv
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import j0
from stack import SAMPLER, Stack

from solver import Problem, Status, solve
from solver.body import tables
from solver.body.hankel import Hankel
from solver.body.wave_rule import STIFFEST, few, quadrature
from solver.kernels.closed_form import layered_kernel
from solver.laws import LAWS
from solver.numerics.mesh import mesh_of
from solver.rough.adaptive import solve_newton
from solver.rough.equation import Cases
from solver.shapes.paraboloid import Paraboloid

REFERENCES = Path(__file__).parents[1] / "references"


def rows(name):
    lines = (REFERENCES / name).read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


CONTACTS, KERNELS = rows("stack_contact.csv"), rows("stack_kernel.csv")
SAMPLERS = pytest.mark.parametrize("sampler", [SAMPLER, None], ids=["few nodes", "all nodes"])


def stack_of(row, size=1):
    """The :class:`Stack` of a row, `size` times."""
    h, n, nu = (list(column) for column in zip(*(map(float, v.split()) for v in row["layers"].split("|")), strict=True))
    bonded = [kind.strip() == "bonded" for kind in row["interfaces"].split("|")]
    rigid = row["base"] == "rigid"
    n = np.array(n) / (n[0] if rigid else 1.0)
    nu2 = 0.3 if rigid else float(row["base"].split()[1])
    return Stack(*(np.array([values] * size) for values in (n, nu, h, bonded, nu2, rigid)))


def solved(kernel, h, control, value, rtol=1e-9, sampler=None):
    body = Hankel(kernel._replace(sampler=sampler), h, 0 * h)
    shape = Paraboloid(np.full(np.shape(value), 2.0))
    case = Cases(control, LAWS["smooth"].bind(body.E), body, np.asarray(value, float), shape)
    with np.errstate(all="ignore"):  # as in solver.solve: what goes wrong is a status
        return solve_newton(case, np.full(len(h), rtol), np.zeros(len(h), int), 0, np.array([0.0, 0.5]))


@pytest.mark.parametrize("row", CONTACTS, ids=lambda row: row["stack"])
def test_the_kernel(row):
    """1e-12 of L and, beyond u = 0.7, of L - 1, which falls to 1e-34; below, of 1."""
    own = [other for other in KERNELS if other["stack"] == row["stack"]]
    u, L, L1 = (np.array([[float(other[name]) for other in own]]) for name in ("u", "L", "L1"))
    kernel = stack_of(row)
    assert_allclose(kernel.whole(u), L, rtol=1e-12, atol=0)
    found, slope = kernel.decaying_part(u)
    assert_allclose(found, L1, rtol=1e-12, atol=1e-12 * (u < 0.7).max() * np.minimum(1.0, np.abs(L1)).min())
    low, high = (kernel.decaying_part(u * np.exp(step))[0] for step in (-1e-4, 1e-4))
    # the error of the difference is 1e-8 of third derivatives, which are (2u)² times as large, and rounding over 1e-4
    assert_allclose((high - low) / 2e-4, slope, rtol=0, atol=(1e-7 * (1 + u) ** 3 * np.abs(L1) + 1e-11).max())


@pytest.mark.parametrize("bonded", [True, False])
def test_one_layer_is_the_kernel_of_the_program(bonded):
    """L - 1 and u dL/du against formulas that have nothing in common with the recursion; n = 0 is a rigid base."""
    n, nu, nu2, u = np.array([0.0, 1e-3, 0.5, 3.0, 1e3]), 0.45, 0.2, np.geomspace(1e-4, 30, 60) * np.ones((5, 1))
    one = np.ones((5, 1))
    kernel = Stack(
        np.where(n > 0, n, 1)[:, None], nu * one, one, one > 0 if bonded else one < 0, nu2 * one[:, 0], n == 0
    )
    exact, scale = layered_kernel(u, n[:, None], nu, nu2, bonded), np.maximum(1, n)[:, None]
    L1, uL = kernel.decaying_part(u)
    far = np.where(u > 0.7, np.abs(exact.L1), scale)
    assert np.all(np.abs(L1 - exact.L1) < 1e-12 * far)
    assert np.all(np.abs(uL - exact.uL) < 1e-12 * np.maximum(far, np.abs(exact.uL)))
    assert_allclose(kernel.whole(u), exact.L, rtol=1e-12, atol=0)


@SAMPLERS
@pytest.mark.parametrize("row", CONTACTS, ids=lambda row: row["stack"])
def test_contacts(row, sampler):
    """Under each control, against another equation of another code; 1e-9 is the rtol that is asked for."""
    kernel, h = stack_of(row), np.full(1, 0.01)  # R is 100 h1
    modulus = float(row["layers"].split()[1]) if row["base"] == "rigid" else 1.0
    exact = {"a": float(row["a"]) / 100, "P": float(row["P"]) / 1e4 / modulus, "D": float(row["D"]) / 100}
    for control, value in exact.items():
        found = solved(kernel, h, control, [value], sampler=sampler)
        for name, other in exact.items():
            assert_allclose(getattr(found, name), other, rtol=1e-9, atol=0)


@SAMPLERS
@pytest.mark.parametrize("control", ["a", "P", "D"])
def test_one_layer_is_a_contact_of_the_program(control, sampler):
    """1e-10, which is asked for; ten octaves of h/a, bonded and not, soft and stiff."""
    h, n = np.tile(10.0 ** np.linspace(-2, 0.6, 5), 2), np.repeat([0.05, 20.0], 5)
    bonded, a, one = np.arange(10) % 2 == 0, np.full(10, 0.05), np.ones((10, 1))
    layer = {"h": h, "n": n, "nu1": 0.4, "nu2": 0.2, "bonding": np.where(bonded, "bonded", "frictionless")}
    case = {"base": "layered", "micro": "smooth", "rtol": 1e-10}
    value = a if control == "a" else getattr(solve(Problem.of(a=a, **layer, **case)), control)
    exact = solve(Problem.of(**{control: value}, **layer, **case))
    kernel = Stack(n[:, None], 0.4 * one, one, bonded[:, None], 0.2 * one[:, 0], n < 0)
    found = solved(kernel, h, control, value, 1e-10, sampler)
    assert exact.status.tolist() == found.status.tolist() == [Status.CONVERGED] * 10
    for name in ("a", "P", "D", "dP_dD"):
        assert_allclose(getattr(found, name), getattr(exact, name), rtol=1e-10, atol=0)


@pytest.mark.parametrize("stiffness", range(4))
@pytest.mark.parametrize("octave", [-8, -3, 0, 3])
def test_few_nodes_determine_a_stack(octave, stiffness):
    """Other stacks than those by which they were chosen, beside all nodes, over the size of the operator: 4e-12 is left
    out at most."""
    random, mesh = np.random.default_rng(octave + 100), mesh_of(16)
    low, high = np.log([1e-9, *STIFFEST][stiffness : stiffness + 2])
    kernel = SAMPLER.draw(random, np.exp(random.uniform(low, high, 60)))
    k, weight = quadrature(octave, stiffness)
    nodes, eta = few(SAMPLER, octave, stiffness), 2.0 ** (octave + random.random((60, 1)))
    left = kernel.decaying_part(nodes.k * eta)[0] @ nodes.spread - weight * (
        all_of_it := kernel.decaying_part(k * eta)[0]
    )
    J, phi = j0(k[:, None] * mesh.x) - j0(k)[:, None], tables.transform(mesh, k)
    scale = np.maximum(np.abs(weight * all_of_it / (1 + k * k)).sum(axis=1), 1.0)
    matrix = np.einsum("bk,ki,kj->bij", left, J, phi, optimize=True)
    assert (np.abs(matrix).max(axis=(1, 2)) / scale).max() < 1e-11
