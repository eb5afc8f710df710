"""What is beyond the model: assumptions that a contact violates, with their size, and inputs that nothing real has."""

import numpy as np
import xarray as xr

from ..data import derived
from ..data.assumptions import assumption_texts
from ..data.dataset import broken
from ..inputs.laws import smooth_laws
from ..inputs.scene.bounds import INPUTS, absurd
from ..inputs.vocabulary import BODIES, ROWS
from ..specimen.roughness import looks_like_iso_ra
from .pressures import RING

BROKEN = assumption_texts("sentence")
OF_SEVERAL_RADII = "A table has A, or the heights z, in R: with several R its asperities grow with the punch. Give \
each R a table of its own, in cases."
#: The yield strength is below E/50 of every metal. Plastics, rubber and gels, softer than 10 GPa, bear a larger share.
YIELD, STIFF = 0.03, 1e10
#: Assumptions whose error goes with the pitch of the asperities over the thickness of the layer.
_BY_PITCH = ("spot_not_small_against_h", "pitch_not_small_against_h")
#: Pitch over h -> largest error in % of A and of p_max in the resolved cells of docs/validate.md, of n from 0.1 to
#: HARDEST. By its first-order sums a harder layer errs more.
HARDEST = 5
SEEN = {1: (0.02, 0.03), 1.5: (0.48, 0.87), 2: (2.37, 4.34), 3: (10.80, 18.73), 4: (24.21, 36.38), 6: (50.79, 69.19)}


def doubts(contact: xr.Dataset) -> list[str]:
    """A sentence for each assumption of the model that some cases violate, and for inputs that nothing real has."""
    v = contact.variables  # arithmetic of DataArrays takes longer than solving a contact
    found = []
    for word, where in broken(v["validity"]).items():
        if where.any():
            of_all = f"{where.sum()} of {where.size} cases: " if where.size > 1 else ""
            found.append(of_all + BROKEN[word] + (_size(v, where) if word in _BY_PITCH else ""))
    if "Ra" in v and "Nbar" in v and not np.isin(v["micro"].values, smooth_laws()).all():
        sharp = looks_like_iso_ra(
            (v["Ra"] + 0 * v["Nbar"]).values, (v["Nbar"] + 0 * v["Ra"]).values, si="units" in v["Ra"].attrs
        )
        found += [sharp] if sharp else []
    tables = "R" in v and np.char.startswith(v["micro"].values.astype(str), "table:").any()
    if tables and np.ptp(v["R"].values) > 0 and not (v["R"].dims and {*v["R"].dims} <= {*v["micro"].dims}):
        found.append(OF_SEVERAL_RADII)
    given = {name: v[name] for name in INPUTS if name in v and v[name].attrs.get("units") == ROWS[name].unit}
    given |= {ratio: v[ratio] for _, ratio, _ in BODIES.values() if ratio in v}
    found += _yielding(contact)
    return found + absurd(given, {name: v[f"{name}_spread"] for name in given if f"{name}_spread" in v})


def _size(v, where: np.ndarray) -> str:
    """How large the error of the asperities' part is, of the worst case: the pitch over h decides (docs/validate.md).

    where : the cases, of the shape of `validity`
    """
    if any(name not in v or v[name].attrs.get("units", ROWS[name].unit) != ROWS[name].unit for name in ("Nbar", "h")):
        return ""  # of study.readable, or a mean
    pitch = (0.0 * v["validity"] + 1 / (np.sqrt(v["Nbar"]) * v["h"])).values[where].max()
    worst = f" {'The largest' if where.sum() > 1 else 'Here the'} pitch 1/sqrt(Nbar) is {pitch:.2g} h"
    if not pitch > min(SEEN):
        return f"{worst}: up to h nothing of it was seen in the test cases of docs/validate.md."
    of_A, of_p_max = zip(*SEEN.values(), strict=True)
    errors = (np.exp(np.interp(np.log(pitch), np.log([*SEEN]), np.log(own))) for own in (of_A, of_p_max))
    about = "A[p] by about {:.2g} % and pmax by {:.2g} %".format(*errors)
    harder = "; a harder layer errs more" * bool("n" in v and (v["n"] > HARDEST).any())
    cases = f"test cases of docs/validate.md (n from 0.1 to {HARDEST})"
    if pitch > max(SEEN):
        return f"{worst}, more than in the {cases}, which at {max(SEEN)} h missed {about}{harder}."
    return f"{worst}, at which the {cases} missed {about} at worst{harder}."


def _yielding(contact: xr.Dataset) -> list[str]:
    """A sentence if a body of a scene in SI units is pressed so hard that a metal would yield; of the worst case.

    What lies under a layer has the largest nominal pressure where the contact is wide against that, and less elsewhere.
    """
    v = contact.variables
    moduli = {name: v[name] for name, _, _ in BODIES.values() if name in v and v[name].attrs.get("units") == "Pa"}
    stiff = [E[(E >= STIFF) & np.isfinite(E)] for E in (own.values for own in moduli.values())]
    least = min((E.min() for E in stiff if E.size), default=np.inf)
    if v["p_max"].attrs.get("units") != "Pa" or not np.isfinite(least):
        return []
    nominal, real = _largest(contact)
    if not (real > YIELD * least).any():
        return []
    bare, shares = v["base"] == "half_space", {}
    under = real.where(bare, nominal.where(v["a"] > v["h"]) if "h" in v else np.nan)
    pressures = {"punch": real, "layer": real.where(~bare), "body": under}
    for body, (name, _, _) in BODIES.items():
        E = moduli.get(name, xr.Variable((), np.inf))
        shares[body] = (pressures[body] / E.where(E >= STIFF)).fillna(0)
    body = max(shares, key=lambda one: shares[one].max())
    beyond = sum(share > YIELD for share in shares.values()) > 0
    of_all = f"{beyond.values.sum()} of {beyond.size} cases: " if beyond.size > 1 else ""
    share = f"The pressure on the {body} comes to {float(shares[body].max()):.2g} of its Young's modulus"
    return [f"{of_all}{share}: metals yield before that, which the model leaves out."] * bool(beyond.any())


def _largest(contact: xr.Dataset) -> tuple[xr.Variable, xr.Variable]:
    """The largest nominal and real pressures that are known: those of the centre, or of a ring that the profile has."""
    v = contact.variables
    nominal, real = v["p0"], v["p_max"]
    if "p" not in v:
        return nominal, real
    top = v["p"].max("x")
    ring = top > RING * nominal
    if not ring.any():
        return nominal, real
    try:
        peak = derived.peak_pressure(contact).variable
    except ValueError:  # the moduli are not known, as of a mean
        peak = top
    return top.where(ring, nominal), peak.where(ring & (peak > real), real)
