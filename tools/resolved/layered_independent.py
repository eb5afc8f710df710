"""Two formulations of the layered base that share nothing with the solver; the tests of `base="layered"` use them.

Smooth: the Fredholm equation of the second kind of the dual integral equations. With p̂(k) = ∫ p J0(kr) r dr and
p(r) = -∫_r^a φ'(t)/sqrt(t² - r²) dt, φ(a) = 0 (no pressure at the edge), p̂(k) = ∫₀^a φ(t) cos(kt) dt. The displacement
(2/E1*) ∫ L p̂ J0(kr) dk = D - r²/(2R), under the operator d/dt ∫₀^t · r dr/sqrt(t² - r²), which makes cos(kt) of
J0(kr), becomes

    φ(t) + (1/π) ∫₀^a N(t, τ) φ(τ) dτ = (E1*/π)(D - t²/R),   N = ∫₀^∞ (L(kh) - 1)(cos k(t - τ) + cos k(t + τ)) dk,

because ∫₀^∞ cos(kt) cos(kτ) dk is half of π δ(t - τ). In units of a, f = π R φ/(E1* a²) = d f₁ - f₂ with the
right-hand sides 1 and t²; f(1) = 0 gives d = D R/a² = f₂(1)/f₁(1), and P R/(E1* a³) = 2 ∫ f, (dP/dD)/(E1* a) = 2 ∫ f₁
(the flat punch of that radius, as p(a) = 0), p(0) R/(E1* a) = -(1/π) ∫ f'/t dt. The last one needs f' by the equation:
∫₀¹ sin(kt)/t dt = Si(k).

Rough: collocation of D - r²/(2R) - A[p] = u at Gauss-Legendre nodes in s = sqrt(1 - r²/a²), p a polynomial in s. By the
same φ,

    φ(t) = (2/π) ∫_t^a r p dr/sqrt(r² - t²),
    u(r) = (2/E1*) [∫₀^{π/2} φ(r sin θ) dθ + ∫₀^∞ (L(kh) - 1) p̂(k) J0(kr) dk],

which has the half-space as two smooth integrals instead of an elliptic one, and the layer as cosine transforms of φ.
"""

from functools import cache, lru_cache

import numpy as np
from scipy.special import factorial, j0, sici

#: Results of :func:`rough`.
NAMES = ("P", "D", "p0", "p_max", "Ar_An")

_rule = lru_cache(maxsize=None)(np.polynomial.legendre.leggauss)


def legendre(count, low=0.0, high=1.0):
    """Gauss-Legendre nodes and weights on [low, high]."""
    t, w = _rule(count)
    return low + (high - low) * (t + 1) / 2, (high - low) / 2 * w


def kernel(u, n, nu1, nu2, bonded):
    """L(u) - 1 at u (m,) from the closed forms, regrouped so that nothing cancels; test_layered.py checks this."""
    if bonded:
        return bonded_kernel(u, n, nu1, nu2)
    s = np.sinh(u)  # above the line (n - 1)(sc + u - s²) + nu² with c - s = e^-u
    return ((n - 1) * (s * np.exp(-u) + u) + n * u * u) / (s * np.cosh(u) + u + n * gap(u))


def bonded_kernel(u, n, nu1, nu2):
    """The bonded L - 1: as printed, but above n = 100, where a and b near 1 cancel, with A = 1 - a and B = 1 - b, and
    over e = e^-2u."""
    alpha, g1, g2, e = n * (1 - nu1) / (1 - nu2), 3 - 4 * nu1, 3 - 4 * nu2, np.exp(-2 * u)
    if n <= 100:
        a, b = (alpha * g2 - g1) / (1 + alpha * g2), (alpha - 1) / (alpha + g1)
        below = 1 - (a + b + 4 * b * u * u) * e + a * b * e * e
        return e * (4 * b * u * (1 + u) + a + b - 2 * a * b * e) / below
    A, B, E = (1 + g1) / (1 + alpha * g2), (1 + g1) / (alpha + g1), -np.expm1(-2 * u)
    above = 4 * (1 - B) * u * (1 + u) + A + B - 2 * A * B + 2 * (1 - A) * (1 - B) * E
    return above / (4 * gap(u) + (A + B) * E + A * B * e + 4 * B * u * u)


def gap(u):
    """sinh² u - u² as a product; sinh u - u from its series below u = 2, where the difference cancels."""
    j = np.arange(1, 14)
    series = (np.minimum(u, 2.0)[:, None] ** (2 * j + 1) / factorial(2 * j + 1)).sum(axis=1)
    return np.where(u < 2, series, np.sinh(u) - u) * (np.sinh(u) + u)


def wave_rule(eta, n, reach=2.0):
    """k and weights of ∫₀^∞ (L(kη) - 1)(…) dk: panels that double from below kη = 1/n, nodes for cos(k reach)."""
    finest = 2.0 ** -np.ceil(7 + np.log2(max(1.0, n)))
    ends = [0.0, *(finest * 2.0 ** np.arange(0, np.log2(2 / finest) + 0.5)), *np.arange(4.0, 23.0, 2.0)]
    parts = [
        legendre(24 + int(0.75 * reach * (high - low) / eta), low / eta, high / eta)
        for low, high in zip(ends[:-1], ends[1:], strict=True)
    ]
    return tuple(np.concatenate(v) for v in zip(*parts, strict=True))


def fredholm(eta, n, nu1, nu2, bonded, count=None, m=0.0, radii=()):
    """P R/(E1* a³), D R/a², p(0) R/(E1* a), (dP/dD)/(E1* a) of a smooth sphere at h/a = η; with a sphere of E1*/m,
    whose displacement adds m to L, over Ec = E1*/(1 + m) in place of E1*. Then p(r) R/(E1* a) at the radii r/a."""
    t, w = legendre(count or 48 + int(6 / eta))
    k, kw = wave_rule(eta, n)
    weight = kw * kernel(k * eta, n, nu1, nu2, bonded) / (1 + m)
    wave = np.cos(np.outer(k, t))
    system = np.eye(len(t)) + (2 / np.pi) * (wave.T * weight) @ wave * w
    f1, f2 = np.linalg.solve(system, np.stack([np.ones_like(t), t * t], axis=1)).T
    images = weight * np.cos(k)  # f at the edge by the equation itself
    edge1, edge2 = (1 - (2 / np.pi) * images @ (wave @ (w * f1)), 1 - (2 / np.pi) * images @ (wave @ (w * f2)))
    d = edge2 / edge1
    f = d * f1 - f2
    transform = wave @ (w * f)
    p0 = 2 / np.pi - (2 / np.pi**2) * (weight * k * sici(k)[0]) @ transform
    root, root_w = (v * np.sqrt(1 - np.array(radii))[:, None] for v in legendre(60))  # t = r + root²
    t = np.array(radii)[:, None] + root**2
    slope = -2 * t + (2 / np.pi) * np.sin(t[..., None] * k) @ (weight * k * transform)
    p = -(root_w * 2 / np.sqrt(t + np.array(radii)[:, None]) * slope).sum(axis=1) / np.pi
    return np.array([2 * w @ f, d, p0, 2 * w @ f1, *p])


def polynomial_basis(nodes, s):
    """Lagrange polynomials of the nodes and of s = 0 (where all vanish) at s: the shape of s and one more axis."""
    t = np.concatenate([[0.0], nodes])
    gaps = 4 * (t[:, None] - t)
    np.fill_diagonal(gaps, 1.0)
    weights = 1 / gaps.prod(axis=1)
    distance = s[..., None] - t
    distance[distance == 0] = 1e-300
    terms = weights / distance
    return terms[..., 1:] / terms.sum(axis=-1, keepdims=True)


@cache
def collocation(count):
    """Nodes s and weights of ∫ · ds, x; and for the basis functions: centre, t with weights, Φ(t), ∫ Φ(x sin θ) dθ at
    x."""
    s, w = legendre(count)
    x = np.sqrt((1 - s) * (1 + s))
    psi, psi_w = legendre(count // 2 + 30, 0, np.pi / 2)

    def potential(sigma):
        """Φ = (π/2a) φ as a function of sqrt(1 - t²)."""
        values = polynomial_basis(s, sigma[..., None] * np.cos(psi))
        return sigma[..., None] * np.einsum("...kj,k->...j", values, psi_w * np.cos(psi))

    ends = np.pi / 2 * np.concatenate([[0], 1 - 2.0 ** -np.arange(1, 12), [1]])  # towards the edge r sin θ = 1
    theta, theta_w = (
        np.concatenate(v) for v in zip(*(legendre(20, *ends[i : i + 2]) for i in range(len(ends) - 1)), strict=True)
    )
    H = np.stack([theta_w @ potential(np.sqrt(1 - (r * np.sin(theta)) ** 2)) for r in [*x, 1.0]])
    chi, chi_w = legendre(160, 0, np.pi / 2)
    centre = polynomial_basis(s, np.array([1.0]))[0]
    return s, w, np.append(x, 1.0), centre, np.sin(chi), chi_w * np.cos(chi), potential(np.cos(chi)), H


def spot(v, E, Nbar, Ra):
    """p, A of Eqs (7), (6); v = b/B̄ may have any type of number."""
    cell = 1 / np.sqrt(np.pi * Nbar)
    b, rest = cell * v, cell * np.sqrt(1 - v * v)
    p = 2 * E * b**3 / (3 * Ra) / (cell**2 * np.arccos(v) + b * rest)
    return p, b**2 / Ra - 2 * p / E * rest


def spot_radius(p, E, Nbar, Ra):
    """b/B̄ (m,) at the pressures p (m,), Eq. (7), by halving; 0 for no pressure."""
    low, high = np.zeros_like(p), np.ones_like(p)
    for _ in range(80):
        middle = (low + high) / 2
        below = spot(middle, E, Nbar, Ra)[0] < p
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(p > 0, (low + high) / 2, 0.0)


def rough(count, micro, a, h, n, nu1, nu2, bonded, Nbar, Ra, B=0.1, beta=0.5, base="layered", m=0.0):
    """The NAMES of a rough sphere at the contact radius a, R = E2* = 1, on `count` nodes; `m` on the exact layer."""
    s, w, x, centre, t, tw, potential, H = collocation(count)
    if base == "layered":
        k, kw = wave_rule(h / a, n)
        transform = (np.cos(np.outer(k, t)) * tw) @ potential
        layer = (j0(np.outer(x, k)) * (kw * kernel(k * h / a, n, nu1, nu2, bonded) / (1 + m))) @ transform
        n = n / (1 + m)  # from here on n is that of both surfaces together
        u, springs = 4 * a / (np.pi * n) * (H + layer), 0.0
    else:  # (3) with A1 = n: a half-space of E2* and springs
        n = 1.0 if base == "half_space" else n
        alpha = n * (1 - nu1) / (1 - nu2)
        A2 = (1 + alpha * (1 - 2 * nu2)) * (1 - 2 * nu1 - alpha * (1 - 2 * nu2)) / (2 * (1 - nu1) ** 2)
        u, springs = 4 * a / np.pi * H, 2 * h / n * (A2 if bonded else 0.5) * (base == "thin_layer")
    edge, U = u[-1], u[:-1] - u[-1] + springs * np.eye(count)

    def law(v):
        return (n * v ** (2 / beta), B * Ra * v**2) if micro == "power_law" else spot(v, n, Nbar, Ra)

    v = 0.3 * s
    for _ in range(200):
        p, A = law(v)
        dp, dA = (d.imag / 1e-30 for d in law(v + 1e-30j))
        step = np.linalg.solve(U * dp + np.diag(dA), (a * s) ** 2 / 2 - U @ p - A)
        new = v + step
        v = np.where(new <= 0, 0.2 * v, np.where((new >= 1) & (micro != "power_law"), 0.5 * (1 + v), new))
        if np.abs(step / v).max() < 1e-11:
            break
    p = np.append(law(v)[0], 0.0)
    p[-1] = centre @ p[:-1]
    b = spot_radius(p, n, Nbar, Ra)
    p_max = 2 * n * b[-1] / (np.pi * Ra * np.sqrt(np.pi * Nbar)) + 2 * p[-1] / np.pi * np.arcsin(b[-1])  # (13)
    Ar_An = 2 * (w * s) @ b[:-1] ** 2  # (12)
    return np.array([2 * np.pi * a**2 * (w * s) @ p[:-1], a**2 / 2 + edge @ p[:-1], p[-1], p_max, Ar_An])


def answers(solution, i):
    """The NAMES of the case i of a solution."""
    return np.array([getattr(solution, name)[i] for name in NAMES])
