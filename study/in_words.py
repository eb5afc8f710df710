"""A contact in words: each quantity with its unit and how sure it is, how it was solved, and what it rests on."""

import numpy as np
import xarray as xr

from solver import Status

from .data.assumptions import assumption_texts
from .data.dataset import broken, decode
from .physical.bodies import BODIES
from .physical.bounds import INPUTS, absurd
from .physical.inputs import is_rigid, used_inputs
from .physical.scene import ASSUMED
from .spec.laws import smooth_laws
from .spec.vocabulary import CONTROLS, ROWS, VOCABULARY
from .specimen.quantities import READABLE, readable
from .specimen.roughness import looks_like_iso_ra

MOST_CASES = 20  # of a grid that a summary writes out
SHOWN = ("P", "a", "D", "p0", "p_max", "Ar_An", "dP_dD")
_JUDGED = tuple(name for name in SHOWN if name != "dP_dD")  # what `error` is the largest error of
#: Left out of smooth contacts: there the real pressure is the nominal one, and the real area is the nominal area.
_OF_ASPERITIES = ("p_max", "Ar_An")
#: Inputs without a default that a contact may have and not use: "sigma" of micro = "disc_cell", "E1" of a half-space.
_OPTIONAL = ("E1", "h", "Nbar", "Ra", "sigma", "B", "beta")
_BASES = {
    "half_space": "a half-space",
    "layer_alone": "a half-space of the layer's material",
    "thin_layer": "the thin-layer equation",
    "layered": "the exact layered half-space",
}
MODELS = {base: f"{words} under the asperities" for base, words in _BASES.items()}
MODELS |= {f"smooth_{base}": f"{words}, without asperities" for base, words in _BASES.items()}
BROKEN = assumption_texts("sentence")
NOT_VIOLATED = "None of the assumptions that are checked is violated (docs/model.md, Four answers)."
OF_SEVERAL_RADII = "A table has A, or the heights z, in R: with several R its asperities grow with the punch. Give \
each R a table of its own, in cases."
SLIDES = 'The layer slides on the body without friction, since bonding is not given. One that is deposited or glued on \
does not slide, and if it is soft it is then much stiffer: bonding = "bonded".'
#: Below this modulus in Pa a material is a rubber or a gel. Nearly all have a Poisson ratio close to 0.5.
_RUBBER = 1e8
#: A body under a sphere yields where p(0) exceeds this times its yield strength (Johnson, Contact Mechanics, 1985).
STRENGTHS = 1.6
#: The yield strength is below E/50 of every metal. Plastics, rubber and gels, softer than 10 GPa, bear a larger share.
YIELD, STIFF = 0.03, 1e10


class Summary(str):
    """A text whose repr is the text itself, so that a notebook shows its lines."""

    def __repr__(self) -> str:
        return str(self)


def summary(contact: xr.Dataset) -> Summary:
    """What `study.solve` found, in words.

    contact : a dataset of `study.solve`, in physical units or dimensionless; of a grid the first cases are written out

    The text has the inputs; each quantity with its unit and ±; status, model used and validity as sentences. ± is one
    standard deviation: the root of the sum of the squares of `error`, of `model_error` and of what the spreads of the
    inputs make of the quantity (`NAME_spread`). `error` and `model_error` are of the other six quantities; dP/dD is
    taken to be as sure. Raises ValueError where the dataset is not one of contacts.
    """
    missing = [name for name in ("status", "model_used", "validity", "base", "micro", *SHOWN) if name not in contact]
    if missing:
        raise ValueError(f"this dataset is not one of contacts: it has no {missing[0]}")
    bare = [name for name in ("status", "model_used", "validity") if "flag_meanings" not in contact[name].attrs]
    if bare:
        raise ValueError(f"{bare[0]} has lost its attributes, which say what its numbers mean: keep them (keep_attrs)")
    dims = list(contact["status"].dims)
    contact = contact.reset_index([dim for dim in dims if hasattr(contact.indexes.get(dim), "levels")])
    if not dims:
        return Summary(_summary_of_case(contact))
    cases = contact.stack({"one": dims}, create_index=False)
    texts = []
    for i in range(min(cases.sizes["one"], MOST_CASES)):
        case = cases.isel(one=i)
        where = str(case["label"].values) if "label" in case else ", ".join(_given(case, dim) for dim in dims)
        texts.append(f"--- {where}\n{_summary_of_case(case, dims)}")
    if cases.sizes["one"] > MOST_CASES:
        texts.append(f"--- and {cases.sizes['one'] - MOST_CASES} more cases: choose some with sel() or isel()")
    return Summary("\n\n".join(texts))


def _summary_of_case(case: xr.Dataset, dims=()) -> str:
    """The text of one case; inputs along `dims` are not repeated."""
    rough = case["micro"].values not in smooth_laws()
    used = used_inputs(case)
    inputs = [name for name in used if name not in (*dims, *CONTROLS)]
    unsaid = " (assumed)" * ("R" in case and "E_punch" not in case)
    rigid = [f"a rigid punch{unsaid}"] * is_rigid(case, "punch") + ["a rigid base"] * is_rigid(case, "base")
    unused = [name for name in _OPTIONAL if name in case and name not in (*used, *dims)]
    unused = [name for name in unused if np.isfinite(case[name])]  # NaN: given for other cases
    lines = ["Given: " + ", ".join(rigid + [_given(case, name) for name in inputs])]
    lines += [f"Not used: {', '.join(_given(case, name) for name in unused)}"] * bool(unused) + [""]
    names = [name for name in SHOWN if rough or name not in _OF_ASPERITIES]
    width = max(len(VOCABULARY[name].long_name) for name in names)
    for name in names:
        lines.append(f"  {VOCABULARY[name].long_name:{width}}  {VOCABULARY[name].symbol:6} = {_result(case, name)}")
    return "\n".join([*lines, "", *_sentences(case, [name for name in names if name in _JUDGED])])


def _given(case: xr.Dataset, name: str) -> str:
    """An input with its unit: "h = 2 µm"."""
    if name not in case:
        return str(name)
    value = case[name].values[()]
    assumed = " (assumed)" * (case[name].attrs.get("comment") == ASSUMED)
    if isinstance(value, (str, np.str_)):
        return f"{name} of {value}" if name in BODIES else str(value).replace("_", " ") + assumed
    text = f"{name} = {_text(case, name, float(value), _spread(case, name))}"
    text += " Ra/E1*^beta" * (name == "B") + assumed
    return text + " (fitted to Nbar and Ra)" * ("comment" in case[name].attrs and name in ("B", "beta"))


def _text(case: xr.Dataset, name: str, value: float, spread: float = 0.0) -> str:
    unit = case[name].attrs.get("units", "1")
    if unit in READABLE and unit != "1":
        return readable(value, unit, spread)
    scale = case[name].attrs.get("scale", "" if unit == "1" else unit)
    return f"{readable(value, '1', spread)} {scale}".rstrip()


def _spread(case: xr.Dataset, name: str) -> float:
    """The spread of an input, or what the spreads of the inputs make of a result; 0 where there is none."""
    return float(case[f"{name}_spread"]) if f"{name}_spread" in case else 0.0


def _result(case: xr.Dataset, name: str) -> str:
    """A result with its unit and ±."""
    value, spread = float(case[name]), _spread(case, name)
    if not np.isfinite(value):
        return "unknown"
    if not np.isfinite(spread):  # the case was not solved with one of its inputs moved
        return f"{_text(case, name, value)} ± unknown"
    parts = [spread]
    if name not in CONTROLS or name not in case.coords:
        parts += [value * float(case[kind]) for kind in ("error", "model_error") if np.isfinite(case[kind])]
    return _text(case, name, value, float(np.sqrt(np.sum(np.square(parts)))))


def _sentences(case: xr.Dataset, judged: list[str]) -> list[str]:
    """How well the case is solved, by which model, and which assumptions it violates. judged : those of `_JUDGED`."""
    word, used = decode(case["status"]).item(), decode(case["model_used"]).item()
    if word == "converged":
        *first, last = (VOCABULARY[name].symbol for name in judged)
        within = f"{', '.join(first)} and {last} are within a relative {float(case['error']):.1g}"
        found = [f"Solved: {within} of the model's solution."]
    else:
        known = {one.name.lower(): one.meaning for one in Status}
        meaning = known.get(word, "the case has not been computed")
        found = [f"NOT SOLVED ({word}): {meaning}."]
    model = MODELS.get(used)
    if model:
        error = float(case["model_error"])
        exact = used in ("half_space", "layered")  # then `model_error` is that of the micro law
        against = "the micro law itself errs" if exact else "against the exact layered contact it errs"
        errs = f"; {against} by about {100 * error:.2g} %" if error > 0 else ""
        found.append(f"Model: {model}{errs}.")
    beyond = doubts(case)
    found += [f"Beware: {sentence}" for sentence in beyond]
    found += [NOT_VIOLATED] * (not beyond and word == "converged")
    found += [f"Not checked (docs/model.md, Limits): {_not_checked(case, judged)}."] * (word == "converged")
    return found + [f"Assumed: {sentence}" for sentence in _assumed(case.variables)]


def _not_checked(case: xr.Dataset, judged: list[str]) -> str:
    """What nothing looks at. Of contacts with units, unless there is a rubber, also the strengths that they need."""
    moduli = [case[name] for name, _, _ in BODIES.values() if name in case and case[name].attrs.get("units") == "Pa"]
    if not moduli or min(moduli) < _RUBBER:
        return "adhesion, and whether the bodies stay elastic"
    needed = (float(f"{float(case[name]) / STRENGTHS:.2g}") for name in ("p0", "p_max"))
    below, at_spots = (readable(strength, "Pa") for strength in needed)
    words = f"adhesion, and whether the bodies stay elastic. They need a yield strength above some {below}"
    return words + f", at the asperities above some {at_spots}" * ("p_max" in judged)


def doubts(contact: xr.Dataset) -> list[str]:
    """A sentence for each assumption of the model that some cases violate, and for inputs that nothing real has."""
    v = contact.variables  # arithmetic of DataArrays takes longer than solving a contact
    found = []
    for word, where in broken(v["validity"]).items():
        of_all = f"{where.sum()} of {where.size} cases: " if where.size > 1 else ""
        found += [of_all + BROKEN[word]] if where.any() else []
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
    return found + _yielding(v) + absurd(given, {name: v[f"{name}_spread"] for name in given if f"{name}_spread" in v})


def _assumed(v) -> list[str]:
    """A sentence for each default that stands for an input which was not given, and may be far from it."""
    taken = {name for name in v if v[name].attrs.get("comment") == ASSUMED}
    found = [SLIDES] * bool("bonding" in taken and v["base"] != "half_space")
    for modulus, ratio, _ in BODIES.values():
        if ratio in taken and modulus in v and v[modulus].attrs.get("units") == "Pa" and v[modulus] < _RUBBER:
            found.append(f"{ratio} = {v[ratio].item():g}. Of rubbers and gels, as soft as this, it is nearly 0.5.")
    return found


def _yielding(v) -> list[str]:
    """A sentence if a body of a scene in SI units is pressed so hard that a metal would yield; of the worst case.

    What lies under a layer has p(0) where the contact is wide against that, and less elsewhere.
    """
    moduli = {name: v[name] for name, _, _ in BODIES.values() if name in v and v[name].attrs.get("units") == "Pa"}
    stiff = [E[(E >= STIFF) & np.isfinite(E)] for E in (own.values for own in moduli.values())]
    least = min((E.min() for E in stiff if E.size), default=np.inf)
    if v["p_max"].attrs.get("units") != "Pa" or not (v["p_max"] > YIELD * least).any():
        return []
    bare, shares = v["base"] == "half_space", {}
    under = v["p_max"].where(bare, v["p0"].where(v["a"] > v["h"]) if "h" in v else np.nan)
    pressures = {"punch": v["p_max"], "layer": v["p_max"].where(~bare), "body": under}
    for body, (name, _, _) in BODIES.items():
        E = moduli.get(name, xr.Variable((), np.inf))
        shares[body] = (pressures[body] / E.where(E >= STIFF)).fillna(0)
    body = max(shares, key=lambda one: shares[one].max())
    beyond = sum(share > YIELD for share in shares.values()) > 0
    of_all = f"{beyond.values.sum()} of {beyond.size} cases: " if beyond.size > 1 else ""
    share = f"The pressure on the {body} comes to {float(shares[body].max()):.2g} of its Young's modulus"
    return [f"{of_all}{share}: metals yield before that, which the model leaves out."] * bool(beyond.any())
