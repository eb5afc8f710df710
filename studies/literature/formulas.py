"""Published formulas for a smooth sphere on a layer, as they are written, and the sources of their constants.

A formula of the load gives F/F_H as a function of χ = sqrt(R D)/h on a rigid base: F is the load at the depth D, and
F_H Hertz's load 4/3 E1* sqrt(R) D^(3/2). A formula of the stiffness gives E_eff = (dP/dD)/(2a), the modulus that a flat
punch of the contact's radius feels, as a function of x = a/h: in E1* on a rigid base, in E2* on a half-space with
n = E1*/E2*.
"""

from collections import namedtuple
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

Formula = namedtuple("Formula", "name of bonded nu read thin", defaults=(False,))
"""One formula. name : authors and year; of : (χ, ν) -> F/F_H; bonded : the interface; nu : Poisson ratios of the layer
for which it holds; read : source of its constants; thin : whether it is the limit h << a"""
ATOMICJ = "AtomicJ, github.com/pawelHerm"
PYFMRHEO = "PyFMRheo, github.com/jlopezalo, models/bec.py"
BIOMOMENTUM = "Biomomentum-functions, github.com/RenatoC322: parabolas fitted to its table"
NIMS = "NIMS, github.com/DavidMercier, doc/models.rst"
DERIVED = "derived here from L at small u"


DIMITRIADIS, GARCIA = (1.133, 1.283, 0.769, 0.0975), (1.133, 1.497, 1.469, 0.755)
"""c1 to c4 for a bonded layer of ν = 1/2."""
ALPHA_LOOSE = -0.347  # the first factor of α0 of Dimitriadis et al. for a loose layer


def series(*coefficients: float) -> Callable:
    """1 + c1 χ + c2 χ² + ..."""
    return lambda chi, nu: np.polynomial.polynomial.polyval(chi, (1.0, *coefficients))


def dimitriadis(chi, nu, bonded: bool):
    """The general form of Dimitriadis et al. 2002, with α0 and β0 of the Poisson ratio."""
    if bonded:
        alpha = -(1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1 - nu)
        beta = (0.6387 - 1.0277 * nu + 1.5164 * nu**2) / (1 - nu)
    else:
        alpha, beta = ALPHA_LOOSE * (3 - 2 * nu) / (1 - nu), 0.056 * (5 - 2 * nu) / (1 - nu)
    s, third = 2 * alpha / np.pi, 8 / np.pi**3
    cubic = third * (alpha**3 + 4 * np.pi**2 / 15 * beta)
    quartic = third * s * (alpha**3 + 3 * np.pi**2 / 5 * beta)
    return 1 - s * chi + s**2 * chi**2 - cubic * chi**3 + quartic * chi**4


def hermanowicz(chi, nu, bonded: bool):
    """Hermanowicz 2021, piecewise in RD/h² = χ²; the bonded layer is incompressible."""
    hertz = 4 / 3 * chi**3
    if bonded:
        thick = hertz * (1 + 1.10534164 * chi + 1.60674941 * chi**2 + 1.60182944 * chi**3)
        thin = np.polynomial.polynomial.polyval(chi, (0.61578822, -3.11431569, 6.69297250, -7.17027724, 8.22767315))
        return np.where(chi**2 < 0.4, thick, thin + np.pi / 2 * chi**6) / hertz
    thick = hertz * (1 + 0.72196094 * chi + 0.82214548 * chi**2)
    middle = np.where(chi**2 < 450, -0.06327894 + 0.26025865 * chi, 0.0)
    return np.where(chi**2 < 0.5, thick, middle + np.pi * chi**4) / hertz


HAYES = {
    0.3: ((-0.1263, 0.6325, 1.015), (0.0841, 0.5911, 0.6293)),
    0.45: ((-0.1537, 0.7974, 1.0113), (0.2483, 0.6539, 0.6258)),
    0.5: ((-0.1462, 0.9008, 1.0067), (0.5737, 0.4156, 0.6875)),
}
"""ν -> coefficients of two parabolas in a/h, from the square down: a²/(R D), and κ in P = 2 E1* D a κ."""


def hayes(chi, nu):
    """Hayes et al. 1972 for a sphere: a from the depth, then the load, each by a parabola fitted to their tables."""
    (A, B, C), kappa = HAYES[nu]
    square = 1 / chi**2 - A  # (a/h)² square = B a/h + C
    x = (B + np.sqrt(B**2 + 4 * C * square)) / (2 * square)
    return 1.5 * x * np.polyval(kappa, x) / chi


def springs(chi, nu, bonded: bool):
    """Johnson 1985, 5.8: a layer of springs, P = π R D²/C with C = 2 A2 h/E1*."""
    A2 = (1 - 2 * nu) / (2 * (1 - nu) ** 2) if bonded else 0.5
    return 3 * np.pi / (8 * A2) * chi


def squeezed(chi, nu):
    """Johnson 1985, 5.8 and Jaffar 1989: squeezing of a bonded incompressible layer, P = (π/2) E1* R² D³/h³."""
    return 3 * np.pi / 8 * chi**3


LOADS = (
    Formula("Hertz 1882", series(), True, (0.0, 0.3, 0.45, 0.5), "closed"),
    Formula("Hertz 1882", series(), False, (0.3,), "closed"),
    Formula("Hayes et al. 1972", hayes, True, (0.3, 0.45, 0.5), BIOMOMENTUM),
    Formula("Dimitriadis et al. 2002, nu = 1/2", series(*DIMITRIADIS), True, (0.5,), PYFMRHEO),
    Formula("Dimitriadis et al. 2002, nu = 1/2", series(0.884, 0.781, 0.386, 0.0048), False, (0.5,), PYFMRHEO),
    Formula(
        "Dimitriadis et al. 2002, general", partial(dimitriadis, bonded=True), True, (0.0, 0.3, 0.45, 0.5), ATOMICJ
    ),
    Formula("Dimitriadis et al. 2002, general", partial(dimitriadis, bonded=False), False, (0.0, 0.3, 0.5), ATOMICJ),
    Formula("Garcia and Garcia 2018", series(*GARCIA), True, (0.5,), PYFMRHEO),
    Formula("Hermanowicz 2021", partial(hermanowicz, bonded=True), True, (0.5,), ATOMICJ + ", his program"),
    Formula("Hermanowicz 2021", partial(hermanowicz, bonded=False), False, (0.3,), ATOMICJ + ", his program"),
    Formula("Johnson 1985, springs", partial(springs, bonded=True), True, (0.0, 0.3, 0.45), DERIVED, thin=True),
    Formula("Johnson 1985, springs", partial(springs, bonded=False), False, (0.3,), DERIVED, thin=True),
    Formula("Johnson 1985, Jaffar 1989, nu = 1/2", squeezed, True, (0.5,), DERIVED, thin=True),
)

KAPPA = {
    "Hayes et al. 1972 in a script of M. Ebrahimi, 2018": {0.3: 2.480, 0.5: 3.359},
    "Hayes et al. 1972 in a script of I. Kafian-Attari, 2021": {0.5: 3.609},
}
"""ν -> κ at a/h = 1, the stiffness of a flat punch on a bonded layer on a rigid base, over 2 E1* a: two quotations of
the same table, in programs for cartilage. tests/literature/test_literature.py has the whole table."""


def gao_weight(x, nu):
    """φ0 of Gao, Chiu and Lee 1992: the layer's share of the stiffness, to first order in the difference of moduli."""
    far = (1 - 2 * nu) * np.log1p(x**2) / x - x / (1 + x**2)
    return 2 / np.pi * np.arctan(1 / x) + far / (2 * np.pi * (1 - nu))


def hay_crawford(x, n, nu, F=0.0626):
    """Hay and Crawford 2011: 1/E_eff = (1 - φ0)/(1 + F φ0 n) + φ0/n for equal Poisson ratios."""
    share = gao_weight(x, nu)
    return 1 / ((1 - share) / (1 + F * share * n) + share / n)


def perriot_barthel(x, n, nu):
    """Perriot and Barthel 2004: n + (1 - n)/(1 + (k0/x)^1.27), log10 k0 = -0.093 - 0.792 log10 n + 0.05 log10² n."""
    log_n = np.log10(n)
    return n + (1 - n) / (1 + (10 ** (-0.093 - 0.792 * log_n + 0.05 * log_n**2) / x) ** 1.27)


def doerner_nix(x, n, nu, alpha):
    """Doerner and Nix 1986 with the contact radius, as in King 1987: 1/E_eff = 1/n + (1 - 1/n) exp(-α/x)."""
    return 1 / (1 / n + (1 - 1 / n) * np.exp(-alpha / x))


STIFFNESSES = {
    "Gao, Chiu and Lee 1992": (lambda x, n, nu: 1 + (n - 1) * gao_weight(x, nu), NIMS),
    "Hay and Crawford 2011, F = 0.0626": (hay_crawford, NIMS),
    "Hay and Crawford 2011, F = 0.626": (lambda x, n, nu: hay_crawford(x, n, nu, 0.626), "an older file of NIMS"),
    "Perriot and Barthel 2004": (perriot_barthel, NIMS + "; the exponent from its plotting script"),
    # layer and half-space as two springs in series
    "Bec et al. 2006": (lambda x, n, nu: 1 / (1 / (n * (1 + np.pi * x / 2)) + 1 / (1 + 2 / (np.pi * x))), NIMS),
}
"""Name -> E_eff/E2* on a bonded layer as a function of (x, n, ν), and the source of its constants."""

_FILE = Path(__file__).with_name("greenwood_tripp.csv")
GREENWOOD_TRIPP: dict[int, dict[float, tuple[float, float]]] = {}
"""μ -> α -> p(0) and effective radius over those of Hertz, by the equations of Greenwood and Tripp (1967), which
tools/references/make_greenwood_tripp.py solves."""
for _mu, _alpha, *_ratios in np.loadtxt(_FILE, delimiter=",", skiprows=1).tolist():
    GREENWOOD_TRIPP.setdefault(int(_mu), {})[_alpha] = tuple(_ratios)
