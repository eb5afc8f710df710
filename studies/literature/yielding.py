"""Published laws of one yielding sphere, compared with micro = "elastic_plastic": a figure that needs no study.

Each law takes the approach w over w_c, the approach at which the sphere first yields by that law. It gives the mean
pressure of the spot, and its area. E is the modulus E* of sphere and flat together, R = 1, Y the yield strength.
"""

import numpy as np

from solver.closed_forms import yield_pressure
from solver.laws.elastic_plastic import LAW, TABOR
from study.figures.registry import TWO_COLUMNS, Columns, figure, joined

NU, Y = 0.3, 1e-3  # of a steel, Y over E*
W = np.geomspace(0.3, 600, 400)
"""w/w_c in the figure: 0.3 is elastic by all laws, 110 is full plasticity by Kogut and Etsion."""


def ceb(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Chang, Etsion and Bogy 1987: Hertz to w_c, then the mean pressure K H on the area π R (2 w - w_c); H = 2.8 Y."""
    pressure = (0.454 + 0.41 * NU) * 2.8
    return np.where(w < 1, 2 / 3 * np.sqrt(w), 1.0) * pressure, np.where(w < 1, 1.0, 2 - 1 / w)


def ke(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Kogut and Etsion 2002: powers of w/w_c fitted to finite elements, then H on 2 π R w; H = 2.8 Y."""
    at_yield = 2 / 3 * (0.454 + 0.41 * NU) * 2.8
    load = np.select([w < 1, w < 6], [w**1.5, 1.03 * w**1.425], 1.40 * w**1.263)
    area = np.select([w < 1, w < 6, w < 110], [w, 0.93 * w**1.136, 0.94 * w**1.146], 2 * w)
    return np.where(w < 110, at_yield * load / area, 2.8), area / w


def jg(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Jackson and Green 2005: fitted to finite elements, with a hardness that falls as b/R grows."""
    C = 1.295 * np.exp(0.736 * NU)
    area = w * np.maximum(w / 1.9, 1.0) ** (0.14 * np.exp(23 * Y))
    b = np.pi * C * Y / 2 * np.sqrt(area)
    hardness = 2.84 * (1 - np.exp(-0.82 * b**-0.7))
    plastic = np.exp(-(w ** (5 / 12)) / 4) * w**1.5 + 4 * hardness / C * (1 - np.exp(-(w ** (5 / 9)) / 25)) * w
    return 2 / 3 * C * np.where(w < 1.9, w**1.5, plastic) / area, area / w


def ours(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The law of this program with H = 2.84 Y, for a spot far from others: the mean pressure is p/λ for p → 0."""
    b = np.geomspace(0.5, 100, 4000) * np.pi / 2 * yield_pressure(NU) * Y  # in units of b at first yield
    cell = 1e5 * b.max()  # so large that the spot does not feel its neighbours
    p_star, A_star, X, bound = LAW.scales(1.0, 1 / (np.pi * cell**2), 1.0, TABOR * Y, Y, NU)
    t = b / cell
    y = t / np.sqrt((1 - t) * (1 + t))
    curve = LAW.curve(y, X, bound)
    approach, first_yield = A_star * curve.g, (np.pi / 2 * yield_pressure(NU) * Y) ** 2
    pressure = np.interp(w, approach / first_yield, p_star * curve.q / LAW.area(y, curve.q, X, bound) / Y)
    return pressure, np.interp(w, approach / first_yield, b**2 / approach)


LAWS = {
    "Chang, Etsion, Bogy 1987": (ceb, "#1b7837", (0, (1, 1.2))),
    "Kogut, Etsion 2002": (ke, "#2166ac", (0, (4, 1.5))),
    "Jackson, Green 2005": (jg, "#e08214", (0, (6, 1.5, 1, 1.5))),
    "elastic_plastic": (ours, "black", "-"),
}
"""Name -> law, colour, dashes."""


@figure("yielding", size=(TWO_COLUMNS, 2.9), panels=(1, 2))
def yielding(panels) -> Columns:
    """A sphere that yields, by published laws and by micro = "elastic_plastic": the mean pressure of the spot over the
    yield strength, and the square of its radius over $R_a w$, 1 by Hertz and 2 by Abbott and Firestone, over the
    approach w in units of that at first yield. $Y/E^*$ = 0.001, $\\nu$ = 0.3, each law with its own hardness."""
    parts = []
    for number, (name, (law, colour, dashes)) in enumerate(LAWS.items()):
        pressure, area = law(W)
        look = {"color": colour, "linestyle": dashes, "linewidth": 1.6 if law is ours else 1.1, "label": name}
        panels[0].plot(W, pressure, **look)
        panels[1].plot(W, area, **look)
        parts.append({"law": np.full(len(W), number), "w/w_c": W, "p/Y": pressure, "b^2/(Ra w)": area})
    for axes, words, (bottom, top) in zip(
        panels, ("mean pressure$/Y$", "$b^2/(R_a w)$"), ((0, 3.2), (0.8, 2.4)), strict=True
    ):
        axes.set(xscale="log", xlim=(W[0], W[-1]), ylim=(bottom, top), xlabel="$w/w_c$", ylabel=words)
    panels[0].legend(loc="lower right", fontsize=7, frameon=False, handlelength=2.6)
    return joined(parts)
