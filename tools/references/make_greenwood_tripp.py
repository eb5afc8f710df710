"""Print p(0) and a_eff of rough spheres by the equations of Greenwood and Tripp (1967), over those of Hertz.

python tools/references/make_greenwood_tripp.py: for each μ and α = σ R/a_H², on two meshes. The numbers are in
studies/literature/greenwood_tripp.csv. Without the solver: p*(ρ) = μ F(d* + ρ² + w*), F(h) = ∫ (z - h)^(3/2) φ(z) dz
over z > h, lengths in sqrt(2 R σ), heights in σ, pressures in E* sqrt(σ/(8 R)), and
w* = (2/π) ∫ p* t/(ρ + t) K(4 ρ t/(ρ + t)²) dt.
"""

import numpy as np
from scipy.special import ellipkm1

MU_AND_ALPHAS = {
    1: (3.257, 0.4124, 0.05),
    4: (3.257, 1.168, 0.4124, 0.1953, 0.0682, 0.05, 0.0255),
    17: (3.257, 0.4124, 0.05, 0.0255),
}
#: Gap in σ from which on the pressure is neglected: F is 1e-12 there.
FAR = 6.6


def rule(count):
    """Gauss-Legendre nodes and weights on [0, 1]."""
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1) / 2, w / 2


def summits(gap):
    """F(h) and F'(h) for gaps h (m,), by z = max(h, -9) ... 9 with z - h = v²."""
    x, w = rule(100)
    low, high = np.sqrt(np.maximum(-9 - gap, 0)), np.sqrt(np.maximum(9 - gap, 0))
    v = low + (high - low) * x[:, None]
    share = w[:, None] * (high - low) * 2 * v * np.exp(-((gap + v * v) ** 2) / 2) / np.sqrt(2 * np.pi)
    return np.sum(share * v**3, axis=0), -1.5 * np.sum(share * v, axis=0)


def displacement(s, basis):
    """w* (n, n) over R at ρ = R sqrt(1 - s²) for polynomials in s, by rules whose nodes crowd at the ring t = ρ."""
    x, w = rule(60)
    rows = []
    for rho in np.sqrt(np.maximum((1 - s) * (1 + s), 1e-20)):
        part = []
        for end in (0.0, 1.0):
            t = rho + (end - rho) * x**4
            weight = np.abs(end - rho) * 4 * x**3 * w * t / (rho + t)
            part.append((weight * ellipkm1(np.maximum(((rho - t) / (rho + t)) ** 2, 1e-300))) @ basis(t))
        rows.append(2 / np.pi * sum(part))
    return np.array(rows)


def sphere(mu, alpha, n):
    """p(0) and a_eff = (3π/4) ∫ r p dr/∫ p dr over those of Hertz."""
    s = np.append((1 - np.cos(np.pi * (np.arange(n - 1) + 0.5) / (n - 1))) / 2, 1.0)
    to_powers = np.linalg.inv(np.polynomial.chebyshev.chebvander(2 * s - 1, n - 1))

    def basis(t):
        return np.polynomial.chebyshev.chebvander(2 * np.sqrt(np.maximum(1 - t * t, 0.0)) - 1, n - 1) @ to_powers

    unit, (x, w) = displacement(s, basis), rule(200)
    angle, weight = np.pi / 2 * x, np.pi / 2 * w
    at, radius = basis(np.sin(angle)), np.sin(angle)
    area, length = (weight * np.cos(angle) * radius) @ at, (weight * np.cos(angle)) @ at
    hertz_a, hertz_p = 1 / np.sqrt(2 * alpha), 8 / np.pi / np.sqrt(2 * alpha)
    load, R = 2 / 3 * np.pi * hertz_p * hertz_a**2, np.sqrt(hertz_a**2 + FAR)
    for _ in range(12):  # until the gap at the end is FAR
        rho2 = R * R * (1 - s * s)
        gap, d = np.maximum(rho2 - hertz_a**2, 0.0) + 0.5, -(hertz_a**2)
        for _ in range(200):
            f, slope = (mu * v for v in summits(gap))
            missed = np.append(gap - d - rho2 - R * unit @ f, 2 * np.pi * R * R * area @ f - load)
            jacobian = np.zeros((n + 1, n + 1))
            jacobian[:n, :n], jacobian[:n, n] = np.eye(n) - R * unit * slope, -1
            jacobian[n, :n] = 2 * np.pi * R * R * area * slope
            step = -np.linalg.solve(jacobian, missed)
            gap, d = gap + (share := min(1.0, 1.5 / np.abs(step).max())) * step[:n], d + share * step[n]
            if np.abs(step).max() < 1e-10:
                break
        if abs(gap[0] - FAR) < 0.5:
            break
        R = np.sqrt(max(R * R + FAR - gap[0], 0.5))
    p = mu * summits(gap)[0]
    return p[-1] / hertz_p, 3 * np.pi / 4 * R * (area @ p) / (length @ p) / hertz_a


if __name__ == "__main__":
    for mu, spreads in MU_AND_ALPHAS.items():
        for alpha in spreads:
            print(mu, alpha, *(f"{value:.6f}" for n in (40, 56) for value in sphere(mu, alpha, n)))
