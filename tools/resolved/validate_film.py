"""What a micro law errs on a layer that is thin against the pitch: one cell of a square lattice of equal asperities.

The two scales let a wave as long as the cell or shorter feel the layer alone. It feels a share L(kh) - 1 more. By
reciprocity A changes, to the first order in it, by what the pressure of the spots displaces under itself,

    δA = (2 p/E1*) Σ_k (L(kh) - 1) F(kb)²/k,   F(x) = 3 (sin x - x cos x)/x³ of Hertz's pressure,

with a sum over the waves k of the lattice but k = 0. Units E1* = Ra = pitch = 1.
"""

import numpy as np
import xarray as xr
from conjugate_gradients import pressed
from influence import Layer
from layered_independent import kernel
from scipy import fft

from solver.laws import LAWS

MATERIALS = {
    "n = 5, bonded": Layer(1.0, 5.0, bonded=True),
    "n = 0.5, frictionless": Layer(1.0, 0.5),
    "n = 0.1, frictionless": Layer(1.0, 0.1),
    "n = 0.1, bonded, ν1 = 0.45": Layer(1.0, 0.1, nu1=0.45, bonded=True),
}
#: Pitch over thickness of the cells, the nominal pressures in E1* pitch/Ra, and elements a side of the cell.
PITCHES, PRESSURES, POINTS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0), (1e-3, 1e-2, 0.1), 64
#: Waves of the lattice along an axis, of which twice as many change no shown digit, and the largest kh: L - 1 is then
#: below e^-60.
_WAVES, _SHORTEST = 64, 40.0
#: Stiffness of bonded layers, and shares of the area in contact, of which the first order is tabulated at b = 0.1 h.
STIFF, SPARSE = (0.2, 2.0, 5.0, 20.0), (1e-4, 1e-3, 3e-3, 1e-2, 3e-2)


def difference(kh: np.ndarray, layer: Layer) -> np.ndarray:
    """L - 1 at kh > 0."""
    found = kernel(np.minimum(kh.ravel(), _SHORTEST), layer.n, layer.nu1, layer.nu2, layer.bonded)
    return np.where(kh < _SHORTEST, found.reshape(kh.shape), 0.0)


def cell(p: float, layer: Layer | None) -> tuple[float, float]:
    """A and p_max of a cell under the nominal pressure p, by conjugate gradients; None: a half-space."""
    k = 2 * np.pi * POINTS * np.hypot(fft.fftfreq(POINTS)[:, None], fft.rfftfreq(POINTS))
    k[0, 0] = 1.0
    answer = 2 / k * (1 + (difference(k * layer.h, layer) if layer else 0.0))
    answer[0, 0] = 0.0  # the mean displacement is dropped
    x = (np.arange(POINTS) + 0.5) / POINTS - 0.5
    shape = (x[:, None] ** 2 + x[None, :] ** 2) / 2
    A, found = pressed(lambda q: fft.irfft2(answer * fft.rfft2(q)), shape, np.ones_like(shape), p, 1e-7)
    return A, found.max()


def first_order(p: float, b: float, layer: Layer) -> float:
    """δA of spots of the radius b."""
    axis = 2 * np.pi * np.arange(-_WAVES, _WAVES + 1)
    k = np.hypot(axis[:, None], axis[None, :])
    k = k[k > 0]
    form = 3 * (np.sin(k * b) - k * b * np.cos(k * b)) / (k * b) ** 3
    return 2 * p * (difference(k * layer.h, layer) / k * form**2).sum()


def films() -> xr.Dataset:
    """δA/A over (material, p, pitch/h), of cells and by the formula; p_max of cells over that of the law."""
    shape = (len(MATERIALS), len(PRESSURES), len(PITCHES))
    change, formula, peak = np.empty(shape), np.empty(shape), np.empty(shape)
    law = LAWS["square_lattice"].at(np.array(PRESSURES), 1.0, Nbar=1.0, Ra=1.0)
    for j, p in enumerate(PRESSURES):
        A, p_max = cell(p, None)
        for i, material in enumerate(MATERIALS.values()):
            for k, pitch in enumerate(PITCHES):
                layer = material._replace(h=1 / pitch)
                own, highest = cell(p, layer)
                change[i, j, k], peak[i, j, k] = (own - A) / law.A[j], highest / p_max - 1
                formula[i, j, k] = first_order(p, np.sqrt(law.lam[j] / np.pi), layer) / law.A[j]
    dims = ("material", "p", "pitch_over_h")
    data = {"change": (dims, change), "formula": (dims, formula), "peak": (dims, peak), "lam": ("p", law.lam)}
    return xr.Dataset(data, {"material": list(MATERIALS), "p": list(PRESSURES), "pitch_over_h": list(PITCHES)})


def sparse() -> xr.Dataset:
    """δA/A to the first order where the spots are a tenth of the layer's thickness, over (n, λ), and pitch over h."""
    law, p = LAWS["square_lattice"], np.geomspace(1e-8, 0.1, 400)
    known = law.at(p, 1.0, Nbar=1.0, Ra=1.0)
    found = np.empty((len(STIFF), len(SPARSE)))
    radius = np.sqrt(np.array(SPARSE) / np.pi)
    for j, lam in enumerate(SPARSE):
        own = np.exp(np.interp(np.log(lam), np.log(known.lam), np.log(p)))
        A = float(law.at(own, 1.0, Nbar=1.0, Ra=1.0).A)
        for i, n in enumerate(STIFF):
            found[i, j] = first_order(own, radius[j], Layer(radius[j] / 0.1, n, bonded=True)) / A
    data = {"formula": (("n", "lam"), found), "pitch_over_h": ("lam", 0.1 / radius)}
    return xr.Dataset(data, {"n": list(STIFF), "lam": list(SPARSE)})
