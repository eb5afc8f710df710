"""The names of the parameters of `study.solve` with their types, for editors. Registered laws have further ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, TypedDict

import numpy as np

from solver.laws import Law

from ...specimen.materials import Material

Many = Sequence | np.ndarray | Any
"""Several values: along a dimension with the name of the parameter, or over the dimensions of a DataArray."""
Value = float | str | Many | Any
"""A number, a text with a unit ("5 mm", "200 ± 10 GPa"), a quantity of pint, or several of these."""


class Parameters(TypedDict, total=False):
    """The parameters of `solve`, for editors. Registered laws have others besides."""

    P: Value
    a: Value
    D: Value
    h: Value
    n: Value
    m: Value
    nu1: Value
    nu2: Value
    Y1: Value
    Y2: Value
    Y_punch: Value
    bonding: Literal["frictionless", "bonded"] | Many
    base: Literal["half_space", "thin_layer", "layered", "auto", "stack", "thin_stack"] | Many
    layers: list[dict]
    rigid_base: bool
    Nbar: Value
    Ra: Value
    micro: (
        Literal[
            "disc_cell",
            "power_law",
            "smooth",
            "square_lattice",
            "hex_lattice",
            "normal_heights",
            "uniform_heights",
            "elastic_plastic",
        ]
        | str
        | Law
        | Many
    )
    shape: (
        Literal[
            "paraboloid",
            "sphere",
            "cone",
            "berkovich",
            "vickers",
            "cube_corner",
            "power",
            "frustum",
            "blunt_cone",
            "flat",
            "rounded_flat",
        ]
        | str
        | Many
    )
    half_angle: Value
    flat_radius: Value
    tip_radius: Value
    tip: Literal["paraboloid", "sphere"] | Many
    edge_radius: Value
    shape_power: Value
    shape_coefficient: Value
    w_adhesion: Value
    adhesion: Literal["jkr", "dmt", "maugis"] | Many
    sigma0: Value
    z0: Value
    branch: Literal["stable", "unstable"] | Many
    k_machine: Value
    B: Value
    beta: Value
    sigma: Value
    cut: Value
    asperities_on: Literal["auto", "layer", "half_space"] | Many
    hardness: Value
    yield_strength: Value
    R: Value
    R1: Value
    R2: Value
    E1: Value
    E2: Value
    E_punch: Value
    nu_punch: Value
    punch: str | Material | Many
    layer: str | Material | Many
    body: str | Material | Many
    scheme: Literal["newton", "picard"] | Many
    k: Value
    rtol: Value
    accuracy: Value
    model_check: Literal["closed_form", "first_order"] | Many
    nodes: int | Many
    max_iterations: int | Many
