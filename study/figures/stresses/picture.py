"""`plot_stresses`: the stresses in layer and body, at the surface and at the interface."""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ...fields import contact_of, friction
from ...in_words.stated_inputs import is_rigid
from ...inputs.definition import StudyError
from ...rules.rule import RULES, broken
from ...terminal import shown as shown_text
from ..labels import stated, value_text, wrapped
from ..registry import TWO_COLUMNS
from ..style import StyledFigure, style
from .regions import DEPTH, Stresses, of_one_contact
from .sections import NAMES, Units, along, mark, outline, section
from .spot_stresses import of_central_spot

#: Layer and body share a scale of colours if their largest stresses differ by less than this factor.
_ONE_SCALE = 2.0
_BOTH, _MAPS = "viridis", {"layer": "Oranges", "body": "Blues"}  # colours of a common scale, and of two scales
_SHARE = 0.3, 0.6  # bounds of the layer's share in the height
_LETTERS = 130  # number of letters on a line above the figure
_BELOW = ("contact", "spot")


def plot_stresses(
    contact: xr.Dataset | None = None,
    mu: float = 0.0,
    sigma_res: float | str = 0.0,
    below: str = "contact",
    **parameters: Any,
) -> Figure:
    """A figure of the stresses of one contact: docs/stresses.md.

    Panels: von Mises' stress in a section of the layer and of the body under it, with a cross where it is largest; the
    stresses on the surface; the stresses on both sides of the interface, in a stack of the interface with the largest
    shear. Rings mark the largest tension on the surface, and the largest tension and shear at the interface. A grey
    line is the edge of the contact. Where the yield strength is known, from Y1, Y2 or the named material, a red line
    surrounds the part that exceeds it. Like the figure of `study.plot` it does not belong to pyplot.

    Parameters
    ----------
    contact : one contact of `study.solve` or of a results file: a dataset without dimensions, except for `x`
    mu, sigma_res : as in `study.stresses`; with mu > 0 the section is the plane y = 0, and the punch moves to the right
    below : "contact"; or "spot", the central spot of asperities that feel the layer, up to half of the pitch from its
        axis, with mu = 0. The stresses are then means over the angle, and include those of the nominal pressure
    parameters : of `study.solve` for one contact, in place of `contact`

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    StudyError : several contacts, a contact without a solution, a spot of asperities that do not feel the layer, or as
        in `study.stresses`

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, h=0.02, n=4.0, bonding="bonded", micro="smooth", base="layered")
    >>> figure = study.plot_stresses(contact)
    """
    mu = friction(mu)
    contact = contact_of("plot_stresses", contact, parameters)
    with style():
        return drawn(contact, mu, sigma_res, StyledFigure, _checked(below, mu))


def _checked(below: str, mu: float) -> str:
    if below not in _BELOW:
        raise StudyError([f'plot_stresses: below = {shown_text(below)}: must be "contact" or "spot"'])
    if below == "spot" and mu > 0:
        raise StudyError(['plot_stresses: below = "spot" is drawn without friction: leave out mu'])
    return below


def drawn(
    contact: xr.Dataset, mu: float, sigma_res: float | str, new: Callable[..., Figure], below: str = "contact"
) -> Figure:
    """The figure of `plot_stresses`.

    new : makes an empty figure
    """
    spot = below == "spot"
    contact, shown = of_central_spot(contact, sigma_res) if spot else of_one_contact(contact, mu, sigma_res)
    largest = {name: _shown_most(shown, name) for name in NAMES if getattr(shown, name)}
    lines = {"surface": shown.surface} | ({"interface": shown.interface} if shown.interface else {})
    figure = new(figsize=(TWO_COLUMNS, 3.0 if len(lines) == 1 else 5.0), layout="constrained")
    left, right = figure.add_gridspec(1, 2, width_ratios=(1.2, 1))
    heights = _heights(shown)
    sections = left.subgridspec(len(heights), 1, height_ratios=heights).subplots(sharex=True, squeeze=False)[:, 0]
    curves = right.subgridspec(len(lines), 1).subplots(sharex=True, squeeze=False)[:, 0]
    _draw_sections(sections, contact, shown, largest, mu > 0)
    for axes, (name, values) in zip(curves, lines.items(), strict=True):
        finite = [np.abs(stress[np.isfinite(stress)]).max() for stress in values.values()]
        units = Units.of(contact, max(finite), mu > 0)
        along(axes, name, values, shown, units)
        if name == "interface" and shown.number:
            axes.set_title(f"interface {shown.number}", loc="left")
    for letter, axes in zip("abcd", (*sections, *curves), strict=False):
        axes.set_title(f"({letter}) {axes.get_title(loc='left')}", loc="left", fontsize=8)
        for side in (1, -1) if mu > 0 or spot else (1,):
            axes.axvline(side * shown.edge * units.a, color="0.5", linewidth=0.6, zorder=2)
    for axes in (sections[-1], curves[-1]):
        axes.set_xlabel(units.length("x" if mu > 0 else "r"))
    above = [*["Below the central spot; means over the angle"] * spot, *_above(contact, mu, sigma_res)]
    figure.suptitle("\n".join(above), fontsize=7)
    return figure


def _shown_most(shown: Stresses, name: str) -> float:
    """The largest von Mises stress of the layer or the body, or that of the section where it is infinite."""
    largest = float(shown.largest[NAMES[name]])
    return largest if np.isfinite(largest) else float(getattr(shown, name).mises.max())


def _draw_sections(panels, contact: xr.Dataset, shown: Stresses, largest: dict[str, float], sliding: bool) -> None:
    """Draw layer and body, with one scale of colours or with two.

    largest : largest von Mises stress of each
    """
    top = max(largest.values())
    one_scale = len(largest) == 2 and top < _ONE_SCALE * min(largest.values())
    for axes, (name, largest_of_part) in zip(panels, largest.items(), strict=True):
        region, Y = getattr(shown, name), shown.Y[name]
        units = Units.of(contact, top if one_scale else largest_of_part, sliding)
        filled = section(
            axes, region, top if one_scale else largest_of_part, _BOTH if one_scale else _MAPS[name], units
        )
        limit = (
            f"largest {units.text(largest_of_part)}"
            if np.isfinite(shown.largest[NAMES[name]])
            else "infinite at the cross"
        )
        title = [f"{'layers' if name == 'layer' and shown.inner else name}: {limit}"]
        if np.isfinite(Y):
            title.append(f"yields at {Units.of(contact, Y, units.sliding).text(Y)}")
        if shown.largest[NAMES[name]] > Y:
            outline(axes, region, Y, units)
        if name == "layer" and region.z[-1] < shown.h:
            title.append(f"interface at $z$ = {shown.h:.3g}$\\,a$")
        for depth in shown.inner if name == "layer" else ():
            axes.axhline(depth * units.a, color="black", linewidth=1.0)
        mark(axes, shown.largest, NAMES[name], units)
        axes.set_title(", ".join(title), loc="left")
        if not one_scale:
            axes.figure.colorbar(filled, ax=axes, label=units.stress("von Mises stress"), aspect=15, pad=0.02)
    if one_scale:
        axes.figure.colorbar(filled, ax=list(panels), label=units.stress("von Mises stress"), aspect=35, pad=0.02)
    if len(largest) == 2:
        panels[0].spines["bottom"].set_linewidth(2)
        panels[1].spines["top"].set_linewidth(2)


def _heights(shown: Stresses) -> list[float]:
    """The heights of the panels of layer and body, to scale unless the layer is very thin or very thick."""
    if not (shown.layer and shown.body):
        return [1.0]
    depth = DEPTH if shown.edge == 1 else shown.body.z[-1] - shown.h  # below a spot it is given in pitches
    share = np.clip(shown.h / (shown.h + depth), *_SHARE)
    return [share, 1 - share]


def _above(contact: xr.Dataset, mu: float, sigma_res: float | str) -> list[str]:
    """The texts above the panels: the inputs, and the assumptions of the model that the contact violates."""
    stress = str(sigma_res).replace("-", "\u2212")
    sliding = [rf"$\mu$ = {mu:g}"] * (mu > 0) + [rf"$\sigma_{{\mathrm{{res}}}}$ = {stress}"] * bool(sigma_res != 0)
    bodies = [name for name in ("nu1", "nu2") if name in contact and not (name == "nu2" and is_rigid(contact, "base"))]
    ratios = [value_text(name, contact[name], contact[name].item()) for name in bodies]
    texts = dict.fromkeys([*stated([contact]), *ratios, *sliding])  # the pressure may not depend on the ratios
    violated = [name for name, where in broken(contact["validity"]).items() if where.any()]
    names = [RULES[name].text if name in RULES else name for name in violated]
    return [wrapped([*texts], _LETTERS), *([f"not valid: {', '.join(names)}"] if names else [])]
