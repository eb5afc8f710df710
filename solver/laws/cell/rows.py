"""The micro law of a lattice on a coated body at given contact fractions, from the equation itself, without tables."""

import numpy as np
from numpy.typing import ArrayLike

from ...kernels.kernel import Kernel
from ...kernels.stack import Stack
from ...kernels.two_layers import TwoLayers
from ...parameters import BONDINGS
from .spot import Cell, spots

__all__ = ["cell_rows"]

#: The largest contact fraction. Beyond, the series of the neighbours has too few terms, and the spots merge.
MOST = {"square": 0.78, "hex": 0.78, "disc": 0.78}


def cell_rows(
    lattice: str,
    lam: ArrayLike,
    l_over_h: ArrayLike,
    n: ArrayLike | None = None,
    nu1: ArrayLike | None = None,
    nu2: ArrayLike | None = None,
    bonding: ArrayLike | None = None,
    m: ArrayLike = 0.0,
    *,
    layers: list | None = None,
    interfaces: list | None = None,
    rigid_base: bool = False,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The micro law of equal asperities on a coated body: docs/coated_body.md.

    Parameters
    ----------
    lattice : "square", "hex", or "disc", the disc cell of Eqs (6), (7), whose layer has the waves of "hex"
    lam : contact fraction pi Nbar b² in (0, 0.78]; the angular mean of the spots is right up to 0.4
    l_over_h : pitch l = 1/sqrt(Nbar) over the thickness of the layer at the surface, > 0
    n, nu1, nu2, bonding : for one layer: E1*/E2*, 0 on a rigid base; Poisson ratios; "bonded" or "frictionless"
    m : E1*/E3* of layer and punch, >= 0
    layers : for a stack, in place of n and nu1: [(h, n, nu), ...] from the top, n = E_j*/E2*
    interfaces : for a stack, below each layer "bonded", "frictionless" or (cn, ct), compliances in h/E2*; None: all are
        bonded
    rigid_base : whether a stack is on a rigid base: then n = E_j*/E1*, and nu2 is not used

    Returns
    -------
    p, A, p_max : arrays of the shape to which the arguments broadcast; nominal pressure, approach and the pressure in
        the middle of the spot, in units of E1* l/Ra, l²/Ra, E1* l/Ra

    Raises
    ------
    ValueError : an argument is out of its bounds

    Examples
    --------
    >>> p, A, p_max = cell_rows("square", 0.05, 8.0, 10.0, 0.25, 0.3, "bonded")
    >>> print(f"{p:.4e} {A:.4e} {p_max:.4e}")
    1.6169e-03 1.9879e-02 4.4544e-02
    """
    if layers is None:
        values = lam, l_over_h, m, *(np.nan if v is None else v for v in (n, nu1, nu2))
        words = np.asarray("" if bonding is None else bonding)
        lam, pitch, m, n, nu1, nu2, words = np.broadcast_arrays(*(np.asarray(v, float) for v in values), words)
        refuse_layers(n, nu1, nu2, words)
        kernel = TwoLayers(*(np.ravel(v) for v in (n, nu1, nu2, words == "bonded")))
    else:
        lam, pitch, m = np.broadcast_arrays(*(np.asarray(v, float) for v in (lam, l_over_h, m)))
        kernel = _stack(layers, interfaces, nu2, rigid_base)
    refuse_cells(lattice, lam, pitch, m)
    out = np.empty((3, lam.size))
    for i, (fraction, l_h, of_punch) in enumerate(zip(lam.ravel(), pitch.ravel(), m.ravel(), strict=True)):
        cell = Cell(lattice, float(l_h), of_kernel(kernel.take([0 if layers is not None else i]), of_punch))
        spot = spots(cell, [np.sqrt(fraction / np.pi)])
        out[:, i] = spot.p[0] / (1 + of_punch), spot.A[0], spot.p_max[0] / (1 + of_punch)
    return tuple(v.reshape(lam.shape)[()] for v in out)


def refuse_cells(lattice, lam, pitch, m) -> None:
    """Raise ValueError if the lattice, the contact fraction, the pitch over h or m is out of its bounds."""
    if lattice not in MOST:
        raise ValueError(f'lattice = "{lattice}": must be one of {", ".join(MOST)}')
    _refuse(lam=(lam, (lam > 0) & (lam <= MOST[lattice])), l_over_h=(pitch, (pitch > 0) & (pitch <= 1e4)))
    _refuse(m=(m, (m >= 0) & (m < np.inf)))


def refuse_layers(n, nu1, nu2, bonding) -> None:
    """Raise ValueError if a number of a layer or its body is out of its bounds."""
    _refuse(n=(n, n >= 0), nu1=(nu1, _is_nu(nu1)), nu2=(nu2, _is_nu(nu2)))
    _refuse(bonding=(bonding, np.isin(bonding, BONDINGS)))


def of_kernel(kernel: Kernel, m: float):
    """The function u (W,) -> (L - 1)/(1 + m) (W,) of one case, from its kernel."""
    return lambda u: kernel.decaying_part(u[None, :])[0][0] / (1 + m)


def _stack(layers, interfaces, nu2, rigid_base):
    """The :class:`Stack` of one case."""
    h, n, nu = (np.array([float(layer[i]) for layer in layers]) for i in range(3))
    nu2 = 0.3 if nu2 is None else float(nu2)
    _refuse(h=(h, (h > 0) & (h < np.inf)), n=(n, (n > 0) & (n < np.inf)), nu=(nu, _is_nu(nu)), nu2=(nu2, _is_nu(nu2)))
    words = ["bonded"] * len(h) if interfaces is None else list(interfaces)
    if len(words) != len(h):
        raise ValueError(f"interfaces: has {len(words)} of {len(h)}, one below each layer")
    springs = [(0.0, 0.0) if isinstance(word, str) else word for word in words]
    wrong = [word for word in words if isinstance(word, str) and word not in BONDINGS]
    if wrong:
        raise ValueError(f'interfaces: "{wrong[0]}" must be bonded, frictionless or (cn, ct)')
    cn, ct = np.array(springs, dtype=float).T * n[0] / h[0]
    slips = np.array([isinstance(word, str) and word == "frictionless" for word in words])
    arrays = (n, nu, h / h[0], slips, cn, ct)
    return Stack(*(v[None] for v in arrays), np.array([nu2]), np.array([bool(rigid_base)]))


def _is_nu(nu):
    return (np.asarray(nu) > -1) & (np.asarray(nu) <= 0.5)


def _refuse(**checks):
    """Raise ValueError for the first of the checks, name=(value, allowed), that is not allowed everywhere."""
    for name, (value, allowed) in checks.items():
        if not np.all(allowed):
            raise ValueError(f"{name} = {np.asarray(value)[~np.asarray(allowed)].ravel()[0]}: is out of its bounds")
