"""Panels with ends where the profile of a punch has kinks, at s = sqrt(1 - (b/a)²) for a kink at the radius b.

When the contact radius moves, so do these ends, and the panels between them are stretched with them. The values at
their nodes are a first guess on the new panels.
"""

import numpy as np

#: Panels from the edge, over the length to the first kink or to the centre, in s; and the last of them.
_FROM_EDGE, _LAST = (0.0, 0.0625, 0.25, 0.5, 0.75), 1.0
#: Panels shrink by this factor towards a kink, and so many times: towards a kink, the axis and a point. Coarse panels
#: there would spoil the solution far from it as well, and too many would be halved.
_SHRINK, _LEVELS, _ON_AXIS, _TO_POINT = 0.4, 4, 6, 10
#: Most kinks that get panels of their own. A profile with more of them is a table, whose kinks are small: panels are
#: halved where its pressure asks for it, as everywhere.
MOST = 12
#: A kink so near to the edge or to the axis, in s, gets no panel of its own: rounding of its place would count.
_AT_EDGE, _AT_AXIS = 1e-6, 1e-12
#: Panels follow until the last step moves ln(a - b) by less than this part of rtol. What a kink in the wrong place adds
#: to the pressure is far below its distance from the right one.
_SETTLED, _ROUNDING = 0.01, 1e-13


def ends_of(shape, a):
    """Ends (tuple) in s of what is smooth, from 0 to 1, in the contact of radius a, a float, under one `shape`; (0, 1)
    if that is None or has no kinks."""
    inside = () if shape is None else np.unique(shape.kinks()[0])
    inside = np.array([b for b in inside if 0 < b < a])
    s = np.sqrt((1 - inside / a) * (1 + inside / a))
    s = np.sort(s[(s > _AT_EDGE) & (s < 1 - _AT_AXIS)])
    return (0.0, *s.tolist(), 1.0) if len(s) <= MOST else (0.0, 1.0)


def panels_between(ends, shape=None):
    """Ends of panels (tuple) to begin with between the `ends`, under one `shape`."""
    breaks = [0.0]
    for low, high in zip(ends, ends[1:], strict=False):
        levels = _LEVELS if high < 1.0 else _on_axis(shape)
        inner = [part for part in _FROM_EDGE[1:] if not levels or part < 0.75] if low == 0.0 else _graded(_LEVELS)[::-1]
        inner = sorted([*inner, *(1 - part for part in _graded(levels))])
        breaks += [low + (high - low) * part for part in dict.fromkeys([*inner, _LAST])]
    return tuple(breaks)


def _graded(levels):
    """Distances from a kink, over the length to the next one: up to the middle."""
    return [0.5 * _SHRINK**level for level in range(levels)]


def _on_axis(shape):
    """How often panels shrink towards the axis."""
    if shape is not None and shape.pointed[0]:
        return _TO_POINT
    return _ON_AXIS * bends_on_axis(shape)


def bends_on_axis(shape):
    """Whether a profile without a point is not smooth on the axis all the same: it is no function of r², and has no
    kink that would say why."""
    if shape is None or shape.even[0] or shape.pointed[0]:
        return False
    return bool(np.isnan(shape.kinks()[0]).all())


def followed(breaks, ends, new):
    """The panels `breaks` between the `ends`, stretched to the `new` ends, as many; a tuple that begins with 0 and ends
    with 1."""
    return tuple(np.interp(breaks, ends, new).tolist())


def settled(shape, before, a, rtol):
    """Whether the kinks are where they were when the contact radius was `before`; both floats."""
    if shape is None or len(ends_of(shape, a)) == len(ends_of(shape, before)) == 2:
        return True
    least = float(shape.least()[0])
    rounding = _ROUNDING * a / (a - least)
    return abs(np.log((a - least) / (before - least))) <= max(_SETTLED * rtol, rounding)
