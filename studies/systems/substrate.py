"""The pitch from which on asperities feel the body under a coating."""

import numpy as np

from solver.kernels.two_layers import TwoLayers
from solver.laws import LAWS
from study import materials
from study.figures.registry import TWO_COLUMNS, Columns, figure, joined

#: Coating and body, names in the table of materials, with words, colour and dashes of the curve; soft coatings are
#: blue.
COATINGS = (
    ("alumina", "aluminium 6061", "alumina on aluminium", "#8c2d04", "-"),
    ("DLC ta-C", "silicon", "DLC ta-C on silicon", "#dd5f21", (0, (5, 1.5))),
    ("TiN", "steel 52100", "TiN on steel", "#e8a03c", (0, (3, 1.2, 1, 1.2))),
    ("DLC a-C:H", "steel 52100", "DLC a-C:H on steel", "0.2", "-"),
    ("silica", "silicon", "silica on silicon", "#7fb5d8", (0, (5, 1.5))),
    ("PMMA", "silicon", "PMMA on silicon", "#2878b8", "-"),
    ("PTFE", "steel 52100", "PTFE on steel", "#08306b", (0, (3, 1.2, 1, 1.2))),
)
PITCH = np.array([0.5, 1.0, *np.geomspace(1.5, 30, 20)])  # over h
LAM = 0.05  # on a half-space of the coating
FELT = 0.05  # relative change of p_max at the point on each curve


def ratios(coating: materials.Material, body: materials.Material) -> tuple[np.ndarray, np.ndarray]:
    """p_max and λ, at each PITCH, of asperities on a square lattice that feel a bonded coating on its body, over those
    on a half-space of the coating under the same nominal pressure."""
    law, ones = LAWS["square_lattice"], np.ones(len(PITCH))
    loads = np.geomspace(1e-4, 1e-2, 2000)
    p = np.interp(LAM, law.at(loads, 1.0, Nbar=1.0, Ra=1.0).lam, loads)
    on_half_space = law.at(p, 1.0, Nbar=1.0, Ra=1.0)
    n = coating.reduced_modulus / body.reduced_modulus
    layer = TwoLayers(n * ones, coating.nu * ones, body.nu * ones, ones > 0)
    on_body = law.on_body(layer, 0 * ones, 1 / PITCH, ones, Nbar=ones, Ra=ones).at(p * ones[:, None])
    return on_body.p_max[:, 0] / on_half_space.p_max, on_body.lam[:, 0] / on_half_space.lam


@figure("substrate", size=(TWO_COLUMNS, 3.6), panels=(1, 2))
def substrate(panels) -> Columns:
    """When an asperity feels the substrate: (a) real pressure in the middle of a spot and (b) share of the area in real
    contact, of asperities on a coating that is bonded to its body, over those on a half-space of the coating under the
    same nominal pressure. The pitch of the asperities, on a square lattice, grows over the thickness of the coating.
    At this nominal pressure a twentieth of a half-space of the coating would be in contact. Points: from here on the
    pressure is 5 % off. Up to a pitch of h (dotted) nothing is felt."""
    parts = []
    for name, under, words, colour, dashes in COATINGS:
        coating, body = materials.get(name), materials.get(under)
        n = coating.reduced_modulus / body.reduced_modulus
        curves = ratios(coating, body)
        look = {"color": colour, "linestyle": dashes, "label": f"{words}, $n$ = {float(f'{n:.2g}'):g}"}
        for axes, curve in zip(panels, curves, strict=True):
            axes.plot(PITCH, curve, **look)
        if at := felt_from(curves[0]):
            value = np.exp(np.interp(np.log(at), np.log(PITCH), np.log(curves[0])))
            panels[0].plot(at, value, color=colour, marker="o", markersize=4, linestyle="none")
        parts.append(
            {"n": np.full(len(PITCH), n), "pitch/h": PITCH} | dict(zip(("p_max", "lambda"), curves, strict=True))
        )
    for axes, letter, label in zip(panels, "ab", (r"$p_{\max}$", r"$\lambda$"), strict=True):
        axes.axvline(1, color="0.6", linestyle=":", linewidth=0.8, zorder=0)
        axes.set(xscale="log", yscale="log", xlim=(PITCH[0], PITCH[-1]), xlabel="pitch/$h$")
        axes.set_xticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
        ticks = [
            tick for tick in (0.3, 0.4, 0.5, 0.7, 1, 1.5, 2, 3, 4) if axes.get_ylim()[0] <= tick <= axes.get_ylim()[1]
        ]
        axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.set_ylabel(f"{label} over that on a half-space of the coating")
        axes.set_title(f"({letter})", fontsize=9, loc="left")
        axes.minorticks_off()
    panels[0].figure.legend(loc="outside lower center", ncols=3, handles=panels[0].get_legend_handles_labels()[0])
    return joined(parts)


def felt_from(curve: np.ndarray) -> float | None:
    """The pitch over h from which on p_max differs by FELT; None if it never does."""
    off = np.abs(np.log(curve))
    if off.max() < np.log1p(FELT):
        return None
    last = np.flatnonzero(off < np.log1p(FELT))[-1]
    return float(np.exp(np.interp(np.log1p(FELT), off[last : last + 2], np.log(PITCH[last : last + 2]))))
