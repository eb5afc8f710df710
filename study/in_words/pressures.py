"""The largest pressures of a contact, in the centre or in a ring, and the yield strengths that bodies need there."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from ..data import derived
from ..data.dataset import decode
from ..inputs.vocabulary import BODIES
from ..specimen.quantities import readable
from .inputs import is_rigid

#: A half-space under a sphere yields where p(0) exceeds this times its yield strength (Johnson, Contact Mechanics,
#: 1985), with ν = 0.3. Under a uniform pressure it is 1.5, under a narrow ring of pressure 1.7.
STRENGTHS = 1.6
#: Below this modulus in Pa a material is a rubber or a gel. Nearly all have a Poisson ratio close to 0.5.
RUBBER = 1e8
#: A ring is one whose pressure exceeds p(0) by this. What is less does not change the two digits of a strength.
RING = 1.01
#: Largest step of x = r/a at which the points of a profile show a ring: of rings on layers up to 8 times thinner than a
#: they then miss at most 6 % of the pressure, the usual 33 points 3 % (tests/physical/words/test_largest_pressure.py).
_STEP = 1 / 16
BENDS = "The layer is not assessed: where it bends over a softer body it may need many times more"
UNKNOWN = (
    "Which strengths they need follows from the largest pressure. That may be in a ring here, which these results \
do not show: solve with the profile p, at 17 points x or more"
)


class Largest(NamedTuple):
    """The largest pressures of a case.

    nominal, real : of the ring, if there is one, else p(0) and p_max; real is NaN where it is not known
    place : index of the ring in the profile; None: the centre
    known : whether a ring would be seen
    """

    nominal: float
    real: float
    place: int | None
    known: bool


def largest(case: xr.Dataset) -> Largest:
    """The largest pressures of one case, over the points of its profile."""
    p0, p_max = float(case["p0"]), float(case["p_max"])
    fine = "p" in case and "x" in case and np.diff(case["x"].values).max(initial=0.0) <= _STEP
    p = case["p"].values if "p" in case else np.array([p0])
    place = int(np.argmax(p)) if np.isfinite(p).all() else 0
    if not p[place] > RING * p0:
        return Largest(p0, p_max, None, fine or not _may_have_a_ring(case))
    try:
        real = float(derived.peak_pressure(case))
    except ValueError:  # the moduli are not known, as of a mean
        real = np.nan
    return Largest(float(p[place]), real, place, fine)


def largest_of_all(contact: xr.Dataset) -> dict[str, xr.Variable]:
    """p_ring, p_peak: the largest nominal and real pressures of each case that are known, in the centre or a ring."""
    v = contact.variables
    nominal, real = v["p0"], v["p_max"]
    top = v["p"].max("x") if "p" in v else nominal
    ring = top > RING * nominal
    if ring.any():
        try:
            peak = derived.peak_pressure(contact).variable
        except ValueError:  # the moduli are not known, as of a mean
            peak = top
        nominal, real = top.where(ring, nominal), peak.where(ring & (peak > real), real)
    return {"p_ring": nominal, "p_peak": real}


def _may_have_a_ring(case: xr.Dataset) -> bool:
    """Whether the layer may bend like a plate: harder than the body, and a > h.

    Of smooth contacts, at any Poisson ratios, none with n of 2.5 or less, or with a of h or less, had a ring; one with
    n = 3, and one with a = 1.1 h, had (tests/physical/words/test_largest_pressure.py).
    """
    hard = "n" not in case or float(case["n"]) > 2
    return decode(case["model_used"]).item().endswith("layered") and hard and bool(case["a"] > case["h"])


def not_checked(case: xr.Dataset, rough: bool) -> str:
    """What nothing looks at. Of contacts with units, unless there is a rubber, also the strengths that they need.

    The strength is that of a half-space under the largest pressure. The body under a layer needs less, or as much. If
    the layer is thin against the pitch, single spots press on it through the layer: it may need as much as what meets
    at the asperities. A layer may need far more (docs/model.md, Limits).
    """
    words = "adhesion, and whether the bodies stay elastic"
    moduli = [case[name] for name, _, _ in BODIES.values() if name in case and case[name].attrs.get("units") == "Pa"]
    if not moduli or min(moduli) < RUBBER:
        return words
    top, coated = largest(case), str(case["base"].values) != "half_space"
    if not top.known:
        return f"{words}. {UNKNOWN}"
    elastic, apart = not is_rigid(case, "base"), "pitch_not_small_against_h" in decode(case["validity"]).item().split()
    through = elastic and coated and rough and apart
    bodies = ["the body below" if coated else "the body"] * (elastic and not through)
    bodies += ["the punch"] * (not is_rigid(case, "punch"))
    parts = []
    if bodies:
        needs = f"{' and '.join(bodies)} {'needs' if len(bodies) == 1 else 'need'}"
        parts.append(f"{needs} a yield strength above some {_strength(top.nominal)}")
    if rough and np.isfinite(top.real):
        who = "what meets at the asperities" + (", and the body below so thin a layer, need" if through else " needs")
        parts.append(f"{who}{'' if bodies else ' a yield strength'} above some {_strength(top.real)}")
    found = [words, *["; ".join(parts)] * bool(parts)]
    if coated:
        found.append(BENDS if not is_rigid(case, "base") else BENDS.partition(":")[0])
    return ". ".join(sentence if i == 0 else sentence[0].upper() + sentence[1:] for i, sentence in enumerate(found))


def _strength(pressure: float) -> str:
    return readable(float(f"{pressure / STRENGTHS:.2g}"), "Pa")
