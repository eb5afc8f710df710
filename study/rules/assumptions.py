"""The assumptions of the model: limits, and the rules with a mask that say where a contact exceeds them."""

import numpy as np

from solver.bases import is_thin_layer
from solver.shapes import PARABOLOID

from ..inputs.vocabulary import ROWS
from ..terminal import rounded
from .rule import have, rule

FEW_SPOTS = 100.0
"""Least number of asperities in touch: the model spreads them evenly, so there must be many. With equal heights N̄πa²
of them touch."""
SPOT_OVER_LAYER = 0.1
"""On a half-space of the layer's material the central spot must be small against the layer, b <= 0.1 h."""
PITCH_OVER_LAYER = 2.0
"""A layer bends between asperities whose pitch 1/sqrt(N̄) exceeds this times h. With a half-space of its material A[p]
then errs: by up to 2.4 % at a pitch of 2 h, by up to 11 % at 3 h (`make validate`, docs/validate.md)."""
NOT_THIN = 0.1  # largest model error of a thin layer: `make validity` prints and draws where it reaches 10 %
MERGING = 0.4
"""Largest λ(0) of spots that do not merge. At this λ(0) the disc cell overestimates A[p] by 10 % against a square
lattice of asperities and by 11 % against a hexagonal one; λ and p_max err by 3 %
(tests/laws/lattice/test_micro_lattice.py)."""
STEEP = 0.2
"""Largest a/R: Tabor's representative strain 0.2 a/R (The Hardness of Metals, 1951) is then 4 %, and at r = a the
sphere is (a/R)²/4 = 1 % deeper than the paraboloid r²/2R. For two bodies with known radii R1 and R2 it is also the
largest a over the smaller radius: in a close cup R is far larger than both."""
COMPRESSED = 0.1
"""Largest compressive strain of the layer; linear elasticity errs by about as much. If the layer gives way, its strain
is D/h. If the body below gives way instead, the strain of the layer is at most p(0)/E1*."""
STRETCHED = 0.1
"""A layer bent to the sphere is under tension, which bears a part of the pressure. Linear elasticity leaves that out.
This is the largest share of p(0) that the tension may bear. With a free edge at r = a it bears E1* h a²/(8 R³) if h < a
(Föppl's equations; tests/data/test_validity_stretched.py), and E1* h f'(a)³/(8 a) under another shape f(r)."""
STEEP_SPOT = 0.5
"""Largest b(0)/Ra: the strain under an asperity, 0.2 b/Ra, is then 10 %, the sphere is 6 % deeper than the paraboloid,
and p_max = 0.32 E1* is above the hardness of any metal."""
OTHERWISE = 'asperities_on = "auto", on an exact base, takes the coated body itself'
"""The way out for asperities that press on a half-space."""
#: Pitch over h -> largest error in % of A and of p_max in the resolved cells of docs/validate.md, for n from 0.2 to
#: HARDEST. By the first-order sums there, a harder layer errs more.
HARDEST = 20
SEEN = {
    1: (0.02, 0.03),
    1.5: (0.59, 0.94),
    2: (3.09, 5.12),
    3: (14.64, 29.80),
    4: (29.27, 80.71),
    6: (51.06, 247.86),
    10: (68.50, 445.78),
    16: (89.39, 543.81),
}


def by_pitch(v, where: np.ndarray) -> str:
    """A sentence on the error of the asperities' part in the worst case, which follows from the pitch over h."""
    if any(name not in v or v[name].attrs.get("units", ROWS[name].unit) != ROWS[name].unit for name in ("Nbar", "h")):
        return ""  # from study.readable, or a mean
    pitch = (0.0 * v["validity"] + 1 / (np.sqrt(v["Nbar"]) * v["h"])).values[where].max()
    worst = f" {'The largest' if where.sum() > 1 else 'Here the'} pitch 1/sqrt(Nbar) is {rounded(pitch)} h"
    if not pitch > min(SEEN):
        return f"{worst}: up to a pitch of h the test cases of docs/validate.md show no such error."
    of_A, of_p_max = zip(*SEEN.values(), strict=True)
    errors = (np.exp(np.interp(np.log(pitch), np.log([*SEEN]), np.log(column))) for column in (of_A, of_p_max))
    about = "A[p] by about {} % and pmax by {} %".format(*map(rounded, errors))
    harder = "; a harder layer errs more" * bool("n" in v and (v["n"] > HARDEST).any())
    cases = f"test cases of docs/validate.md (n from 0.2 to {HARDEST})"
    if pitch > max(SEEN):
        return f"{worst}, more than in the {cases}, which at {max(SEEN)} h missed {about}{harder}."
    return f"{worst}, at which the {cases} missed {about} at worst{harder}."


@rule(1, "layer not thin", "0.87")
def layer_not_thin(v, times):
    """The layer is not thin: the thin-layer equation errs by more than {NOT_THIN:.0%} here. Take base = "layered"."""
    return v["thin"] & (v["model_error"] > times * NOT_THIN)


@rule(2, f"fewer than {FEW_SPOTS:g} spots", "0.74")
def few_spots(v, times):
    """Fewer than {FEW_SPOTS:.0f} asperities touch: the model, which spreads them evenly, describes an average over many
    contacts."""
    return v["rough"] & (v["spots"] < FEW_SPOTS / times)


@rule(4, rf"spots not small, $b > {SPOT_OVER_LAYER:g}\,h$", "0.8", size=by_pitch)
def spot_not_small_against_h(v, times):
    """The contact spots are not small against the layer (b > {SPOT_OVER_LAYER:g} h), and press on a half-space of its
    material ({OTHERWISE})."""
    return v["layered"] & v["rough"] & v["on_half_space"] & (v["b"] > times * SPOT_OVER_LAYER * v["h"])


@rule(8, r"layer not soft, $n \geq 1$", "0.93")
def n_not_below_one(v, times):
    """The layer is not softer than the body (n >= 1), which the paper's thin layer assumes. Take base = "layered"."""
    return is_thin_layer(v["base"]) & (v["n"] >= times)


@rule(16, rf"spots merge, $\lambda(0) > {MERGING:g}$", "0.83")
def spots_merging(v, times):
    """The contact spots merge (λ(0) > {MERGING:g}): the micro law, which spreads the pressure around a spot evenly,
    overestimates the displacement of the asperities by 10 % or more."""
    return v["rough"] & have("smears", v["micro"], v["known"]) & (v["lam0"] > times * MERGING)


@rule(32, rf"$a > {STEEP:g}\,R$ or layer strained", "0.9")
def strain_not_small(v, times):
    """The strain is not small (a > {STEEP:g} R, or the layer is compressed by more than {COMPRESSED:.0%}, or stretched
    like a membrane): linear elasticity is roughly right at best."""
    compressed = (v["D"] > times * COMPRESSED * v["h"]) & (v["pressure"] > times * COMPRESSED * v["E1*"])
    tension = v["E1*"] * np.minimum(v["h"], v["a"]) * (v["a"] ** 2 if "shape" not in v else v["slope"] ** 3 / v["a"])
    stretched = tension > 8 * times * STRETCHED * v["pressure"]
    wide = (v["a"] > times * STEEP) & (v["shape"] == PARABOLOID if "shape" in v else True)
    return wide | v["layered"] & (compressed | stretched)


@rule(64, rf"spots steep, $b > {STEEP_SPOT:g}\,R_a$", "0.78")
def asperity_strain_not_small(v, times):
    """The strain under the asperities is not small (b > {STEEP_SPOT:g} Ra, or pmax as of such a spot): most materials
    yield before that, and pmax is larger than any real pressure."""
    E = np.where(v["layered"], v["E1*"], 1.0) / (1 + v["m"])  # of layer and punch in series
    # By (13) this is at most b/Ra of the central spot. It also serves laws whose b(0) is a mean, and laws without Ra.
    with np.errstate(invalid="ignore"):  # both pressures are infinite under sharp tips
        steep = np.pi / 2 * (v["p_max"] - v["p0"]) / E
    return v["rough"] & ((v["b"] > times * STEEP_SPOT * v["Ra"]) | (steep > times * STEEP_SPOT))


@rule(128, rf"asperities far apart, pitch $> {PITCH_OVER_LAYER:g}\,h$", "0.71", size=by_pitch)
def pitch_not_small_against_h(v, times):
    """The asperities are far apart compared with h (1/sqrt(Nbar) > {PITCH_OVER_LAYER:g} h): it bends between them,
    which a half-space of its material leaves out ({OTHERWISE})."""
    return v["layered"] & v["rough"] & v["on_half_space"] & (v["Nbar"] * (times * PITCH_OVER_LAYER * v["h"]) ** 2 < 1)


@rule(256, rf"wide in a cup, $a > {STEEP:g}\,\min(|R_1|, |R_2|)$", "0.68")
def wide_in_cup(v, times):
    """The contact is wide compared with the smaller body (a > {STEEP:g} of its radius), as in a cup that fits closely:
    the bodies are not half-spaces there."""
    return v["a"] > times * STEEP * np.minimum(np.abs(v["R1"]), np.abs(v["R2"]))
