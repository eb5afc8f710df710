"""Cells of one layer on a body, as tests of the room take them."""

import numpy as np

from solver.kernels.two_layers import TwoLayers
from solver.laws.cell.rows import of_kernel
from solver.laws.cell.spot import Cell


def layers(n: float, nu1: float = 0.25, nu2: float = 0.3, bonded: bool = True) -> TwoLayers:
    return TwoLayers(*(np.array([value]) for value in (n, nu1, nu2, bonded)))


def cell(lattice: str, pitch: float, n: float, *rest, m: float = 0.0) -> Cell:
    return Cell(lattice, pitch, of_kernel(layers(n, *rest), m))
