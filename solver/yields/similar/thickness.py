"""The thickness of a layer under which the body first yields, under a smooth punch and a given load, by the tables of
its pair of bodies."""

from typing import NamedTuple

import numpy as np

from ...scaling import dimensionless
from .node_search import Line, first_place
from .stress_table import StressTable, node_at
from .unit_contacts import Sought, unit_contacts


class Ends(NamedTuple):
    """Between which thicknesses is searched, (B,) each, in the unit of R.

    thin, thick : the thicknesses
    bare : contact radius without the layer
    up : bool, from thin to thick, and not the other way
    """

    thin: np.ndarray
    thick: np.ndarray
    bare: np.ndarray
    up: bool = False

    def upwards(self):
        """From thin to thick."""
        return self._replace(up=True)


def put_thicknesses(crossing, problem, index, strength, mu, ends):
    """Put into `crossing`, a :class:`~..crossing.Crossing`, whether the body first yields under the cases `index`, and
    the thickness there as `at`.

    problem : B cases under a load, of which those of the `index` are :func:`~.unit_contacts.are_similar`
    strength : (B,), in the unit of E2; mu : >= 0, friction
    """
    if not len(index):
        return
    part = problem.take(index)
    scaled = dimensionless(part)
    table = StressTable(scaled, Sought("body", float(mu)), np.zeros(len(index)))
    thin, thick, bare = (values[index] / part.R for values in ends[:3])
    P, Y = np.log(scaled.value), np.log(strength[index] / part.E2)
    # a layer so thick is a half-space: the load at a = R hardly depends on it
    alone = unit_contacts(scaled, np.full(len(index), _THICK)).P
    nodes = (
        np.floor(node_at(np.log(thick) - (P - np.log(alone)) / 3)).astype(int) - 1,
        np.ceil(node_at(np.log(thin / bare))).astype(int) + 1,
    )
    line = Line(P, Y, np.ones(len(index), dtype=bool), *(nodes[::-1] if ends.up else nodes))
    place = first_place(table, line)
    log_t = np.where(np.isfinite(place.log_t), place.log_t, 0.0)
    contact = unit_contacts(scaled, np.exp(log_t))
    h = np.exp(place.log_t + line.radius(log_t[:, None], np.log(contact.P)[:, None])[:, 0])
    there = (h >= thin) & (h <= thick)
    crossing.unsolved[index] = place.unsolved | ((h < thin) if ends.up else (h > thick))  # it is before the first one
    crossing.crossed[index], crossing.at[index] = there, np.where(there, h, np.nan) * part.R


#: h/a of a layer below which nothing is felt.
_THICK = 1e6
