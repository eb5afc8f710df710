"""The work of adhesion that remains when two rough surfaces are in full contact."""

from typing import Any

import numpy as np

from solver import Problem
from solver.bases import named
from solver.body import BODIES
from solver.scaling import dimensionless, with_rigid_punch

from .inputs.definition import StudyError, from_call
from .specimen.heights.form import without_form
from .specimen.scan import Scan

#: Waves of a scan whose kernel is computed at a time.
_BLOCK = 1 << 16


def effective_work(scan: Scan, *, form: Any = "plane", periodic: bool = False, **parameters: Any) -> float:
    """The work of adhesion less the elastic energy of a rough surface that is pressed flat (Persson):

        w_eff = w - (E/4) ∫ q C(q)/L(qh) d²q.

    C is the spectrum of the heights of a map, E and L belong to the layer or stack together with the punch. A smooth
    punch with this `w_adhesion` stands for a rough one whose asperities are pressed flat. The scan has no waves shorter
    than two of its steps: w_eff is an upper bound.

    Parameters
    ----------
    scan : a map of heights from `roughness.read` or `roughness.height_map`: the punch, the surface or their sum
    form : the form to subtract from the heights first, as in `roughness.measure`
    periodic : whether the map is one period of the surface. If not, a Hann window hides its borders
    parameters : those of `study.solve` with units: w_adhesion, the moduli, and the layer. `R` has no effect

    Returns
    -------
    float : in J/m². If it is not above 0, full contact costs at least the energy that it gains

    Raises
    ------
    StudyError : input that cannot be used, a profile, or a map with missing points

    Examples
    --------
    >>> import numpy as np
    >>> import study
    >>> wave = 1e-8 * np.cos(2 * np.pi * np.arange(64) / 16)
    >>> scan = study.roughness.height_map(np.tile(wave, (64, 1)), dx=1e-7)
    >>> rubber = {"E2": "1 MPa", "nu2": 0.5, "base": "half_space"}
    >>> f"{study.effective_work(scan, w_adhesion='50 mJ/m^2', **rubber, form='mean', periodic=True):.6f}"
    '0.049935'
    """
    if not isinstance(scan, Scan) or scan.z.ndim != 2:
        raise StudyError(["effective_work: needs a map of heights, from roughness.read or roughness.height_map"])
    if np.isnan(scan.z).any():
        raise StudyError([f"effective_work: {scan.name} has missing points: crop it, or fill them"])
    if not isinstance(periodic, (bool, np.bool_)):
        raise StudyError([f"effective_work: periodic = {periodic!r}: must be True or False"])
    scene, problem = _scene_and_problem(parameters)
    q, power = _spectrum(scan, form, periodic)
    body = BODIES[str(problem.base[0])](problem)
    yields = np.ones(len(q))
    for low in range(0, 0 if body.kernel is None else len(q), _BLOCK):
        u = q[None, low : low + _BLOCK] * (body.h[0] * scene.R)
        yields[low : low + _BLOCK] = ((body.kernel.whole(u) + body.m[0]) / (1 + body.m[0]))[0]
    energy = float((q * power / yields).sum()) * float(body.E[0] * problem.E2[0] * scene.unit) / 4
    return float(scene.values["w_adhesion"]) - energy


def _scene_and_problem(parameters: dict[str, Any]) -> tuple[Any, Problem]:
    """The scene of the call's parameters, and their numbers for the solver."""
    defaults = {"R": "1 um", "P": "0 N", "micro": "smooth"}
    inputs = defaults | {name: value for name, value in parameters.items() if value is not None}
    if "w_adhesion" not in inputs:
        raise StudyError(["effective_work: give w_adhesion"])
    definition = from_call(inputs, [], False, {"output": {"profiles": False}}, where="effective_work")
    scene = definition.scene
    assert scene is not None  # R has a unit, so all inputs have one
    if definition.grid.sizes:
        several = ", ".join(definition.grid.sizes)
        raise StudyError([f"effective_work: {several} has several values: one surface at a time"])
    base = named(scene.parameters.get("base", "layered")).item()
    problem = scene.lexicon.problem(scene.parameters, base=base)
    rigid = with_rigid_punch(problem)
    return scene, dimensionless(rigid).but(E2=rigid.E2)


def _spectrum(scan: Scan, form: Any, periodic: bool) -> tuple[np.ndarray, np.ndarray]:
    """Wave numbers (n,) in 1/m, without 0, and the mean squares of the heights in these waves, m²."""
    try:
        z, _ = without_form(scan.z, scan.steps, form, scan.name)
    except ValueError as error:
        raise StudyError([f"effective_work: {error}"]) from None
    if not periodic:
        windows = [np.hanning(n + 2)[1:-1] for n in z.shape]
        window = windows[0][:, None] * windows[1]
        z = z * window / np.sqrt((window**2).mean())
    power = np.abs(np.fft.fft2(z) / z.size) ** 2
    along = [2 * np.pi * np.fft.fftfreq(n, step) for n, step in zip(z.shape, scan.steps, strict=True)]
    q = np.hypot(along[0][:, None], along[1])
    return q.ravel()[1:], power.ravel()[1:]
