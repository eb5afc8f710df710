"""Levenberg-Marquardt for many curves at once, beside scipy.optimize.least_squares on the same table of the model."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from study.inputs.definition import from_call
from study.inverse.fits.curve import MeasuredCurves
from study.inverse.fits.intervals import covariance_of
from study.inverse.fits.least_squares import HUBER, Data, minimise, scale
from study.inverse.fits.model import CurveModel
from study.inverse.fits.tables.ratio_table import RatioTable

GEL = {"R": "5 um", "nu1": 0.49, "h": "1.5 um", "E2": "70 GPa", "nu2": 0.2, "bonding": "bonded", "micro": "smooth"}
CURVES, POINTS, DEEP = 12, 120, 0.8e-6  # m


def table(*unknowns):
    definition = from_call({**GEL, "E1": "5 kPa", "D": "1 um"}, [], False, {"output": {"profiles": False}})
    return RatioTable(CurveModel.of(definition, "D", "P", unknowns, ()))


def measured(*unknowns, noise=0.01, outliers=0.0, seed=47):
    """Curves of E1 from 2 to 12 kPa with noise, a share of the largest load, and their true unknowns."""
    rng = np.random.default_rng(seed)
    x = np.linspace(-0.2, 1.0, POINTS) * DEEP * np.ones((CURVES, 1))
    truth = [np.log(rng.uniform(2e3, 12e3, CURVES))]
    truth += [np.log(rng.uniform(1.2e-6, 1.8e-6, CURVES))] * ("h" in unknowns)
    truth += [rng.uniform(-0.05, 0.05, CURVES), rng.uniform(-0.05, 0.05, CURVES)]
    p = np.column_stack(truth)
    curve = MeasuredCurves(table(*unknowns), x, np.full(CURVES, DEEP), np.ones(CURVES), ("D0", "P0"))
    curve.high = curve(np.column_stack([p[:, :-1], 0 * p[:, -1]]))[0].max(axis=1)
    y = curve(p)[0] + noise * rng.standard_normal(x.shape)
    y += 20 * noise * np.sign(rng.standard_normal(x.shape)) * (rng.random(x.shape) < outliers)
    return curve, y, p


def data_of(y, p, huber=False, w=None, half=6.9):  # ln 1e3
    w = np.ones(y.shape) if w is None else w
    none = np.zeros(p.shape)
    return Data(y, w, p - half, p + half, none, none, huber)


def begin(p):
    """Away from the truth: twice the modulus, a contact point and a baseline of 0."""
    away = np.zeros(p.shape)
    away[:, : p.shape[1] - 2] = p[:, : p.shape[1] - 2] + 0.7
    return away


def alone(curve, i):
    return MeasuredCurves(curve.table, curve.x[[i]], curve.wide[[i]], curve.high[[i]], curve.shifts)


def by_scipy(curve, data, start, i, **options):
    """The least squares of curve i by scipy, and their cost as `minimise` counts it."""
    own = alone(curve, i)
    root = np.sqrt(data.stiffness[i])

    def residuals(q):
        parts = data.w[i] * (data.y[i] - own(q[None])[0][0]), root * (data.center[i] - q)
        return np.concatenate([part[part != 0] if part is parts[1] and not root.any() else part for part in parts])

    def slopes(q):
        J = -data.w[i][:, None] * own(q[None])[1][0]
        return J if not root.any() else np.concatenate([J, -np.diag(root)])

    bounds = (data.low[i], data.high[i])
    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15, "max_nfev": 2000, "x_scale": "jac"}
    found = least_squares(residuals, np.clip(start[i], *bounds), slopes, bounds, **tight | options)
    return found.x, 2 * found.cost


@pytest.mark.parametrize("unknowns", [("E1",), ("E1", "h")])
def test_same_minimum_as_scipy(unknowns):
    """To 1e-6 of unknowns of order 1, if the search goes on to the end. With h free the valley is long: to 2e-5."""
    curve, y, truth = measured(*unknowns)
    data = data_of(y, truth, half=np.log(3))
    fit = minimise(curve, data, begin(truth), sure=1e-13, steps=400)
    assert fit.ended.all()
    for i in range(CURVES):
        p, cost = by_scipy(curve, data, begin(truth), i)
        np.testing.assert_allclose(fit.cost[i], cost, rtol=1e-9)
        np.testing.assert_allclose(fit.p[i], p, rtol=0, atol=2e-5 if "h" in unknowns else 1e-6)


@pytest.mark.parametrize("unknowns", [("E1",), ("E1", "h")])
def test_the_search_ends_where_it_is_sure(unknowns):
    """Within 1e-3 of the spreads of the minimum."""
    curve, y, truth = measured(*unknowns)
    data = data_of(y, truth, half=np.log(3))
    fit, best = minimise(curve, data, begin(truth)), minimise(curve, data, begin(truth), sure=1e-13, steps=400)
    sd = np.sqrt(np.einsum("bii->bi", covariance_of(data, best, best.cost / (POINTS - truth.shape[1]))))
    assert fit.ended.all() and (np.abs(fit.p - best.p) < 1e-3 * sd).all()


def test_priors_as_scipy():
    """A prior is a further residual: (ln h - ln 1.5 µm)/0.1, in units of the noise."""
    curve, y, truth = measured("E1", "h")
    center, stiffness = np.zeros(truth.shape), np.zeros(truth.shape)
    center[:, 1], stiffness[:, 1] = np.log(1.5e-6), (0.01 / 0.1) ** 2
    data = data_of(y, truth)._replace(center=center, stiffness=stiffness)
    fit = minimise(curve, data, begin(truth), sure=1e-13, steps=400)
    assert fit.ended.all()
    for i in range(CURVES):
        p, cost = by_scipy(curve, data, begin(truth), i)
        np.testing.assert_allclose(fit.cost[i], cost, rtol=1e-9)
        np.testing.assert_allclose(fit.p[i], p, rtol=0, atol=1e-6)


def test_at_a_bound_as_scipy():
    """E1 must not exceed 0.8 of what the curve says: it ends there, and the others where they are best beside it."""
    curve, y, truth = measured("E1")
    data = data_of(y, truth)
    data.high[:, 0] = truth[:, 0] + np.log(0.8)
    fit = minimise(curve, data, np.minimum(begin(truth), data.high - 0.1))
    assert fit.ended.all() and np.array_equal(fit.p[:, 0], data.high[:, 0])
    for i in range(CURVES):
        p, cost = by_scipy(curve, data, np.minimum(begin(truth), data.high - 0.1), i)
        # scipy stays inside its bounds: it nears this one
        np.testing.assert_allclose(fit.cost[i], cost, rtol=1e-6)
        np.testing.assert_allclose(fit.p[i], p, rtol=0, atol=1e-5)
        assert fit.cost[i] <= cost * (1 + 1e-12)


def test_huber_as_scipy():
    """At the scale that the last residuals have; with 5 % of outliers of 20 sigma."""
    curve, y, truth = measured("E1", outliers=0.05)
    data = data_of(y, truth, huber=True)
    fit = minimise(curve, data, begin(truth), sure=1e-13, steps=400)
    assert fit.ended.all()
    limit = HUBER * scale(data.y - fit.model, data.w)
    for i in range(CURVES):
        p, _ = by_scipy(curve, data, fit.p, i, loss="huber", f_scale=limit[i])
        np.testing.assert_allclose(fit.p[i], p, rtol=0, atol=1e-6)
    plain = minimise(curve, data_of(y, truth), begin(truth))
    errors = [np.sqrt(np.mean((found.p[:, 0] - truth[:, 0]) ** 2)) for found in (fit, plain)]
    assert errors[0] < errors[1] / 2  # what the loss is for


def test_points_of_weight_0_are_none():
    """NaN and what is masked do not count: as if the points were not there."""
    curve, y, truth = measured("E1")
    w = np.ones(y.shape)
    w[:, ::3] = 0.0
    spoilt = np.where(w > 0, y, np.nan)
    fit = minimise(curve, data_of(np.where(w > 0, spoilt, 1e9), truth, w=w), begin(truth))
    kept = w[0] > 0
    shorter = MeasuredCurves(curve.table, curve.x[:, kept], curve.wide, curve.high, curve.shifts)
    other = minimise(shorter, data_of(y[:, kept], truth), begin(truth))
    np.testing.assert_allclose(fit.p, other.p, rtol=0, atol=1e-8)


def test_a_curve_does_not_depend_on_its_company():
    """The bits of a curve are those that it has alone, and in another order, in blocks of one size."""
    curve, y, truth = measured("E1", "h")
    fit = minimise(curve, data_of(y, truth), begin(truth))
    order = np.arange(CURVES)[::-1]
    turned = MeasuredCurves(curve.table, curve.x[order], curve.wide[order], curve.high[order], curve.shifts)
    other = minimise(turned, data_of(y[order], truth[order]), begin(truth[order]))
    assert np.array_equal(fit.p, other.p[order])
    same = np.zeros(CURVES, int) + 3
    filled = MeasuredCurves(curve.table, curve.x[same], curve.wide[same], curve.high[same], curve.shifts)
    again = minimise(filled, data_of(y[same], truth[same]), begin(truth[same]))
    assert (again.p == fit.p[3]).all()
