"""A contact in words: each quantity with its unit and how sure it is, how it was solved, and what it rests on."""

import numpy as np
import xarray as xr

from ..data.si import SAME_PIECE
from ..inputs.laws import smooth_laws
from ..inputs.vocabulary import BODIES, CONTROLS, VOCABULARY
from ..specimen.pictures import curve, with_picture
from .inputs import is_rigid, used_inputs
from .numbers import given_text, peak_text, result_text, ring_text, spread_of
from .pressures import largest
from .sentences import sentences

MOST_CASES = 20  # of a grid that a summary writes out
SHOWN = ("P", "a", "D", "p0", "p_max", "Ar_An", "dP_dD")
_JUDGED = tuple(name for name in SHOWN if name != "dP_dD")  # what `error` is the largest error of
#: Left out of smooth contacts: there the real pressure is the nominal one, and the real area is the nominal area.
OF_ASPERITIES = ("p_max", "Ar_An")
#: Inputs without a default that a contact may have and not use: "sigma" of micro = "disc_cell", "E1" of a half-space.
_OPTIONAL = ("E1", "h", "Nbar", "Ra", "sigma", "B", "beta", "hardness", "yield_strength", "Y1", "Y2", "Y_punch")
#: What stands behind "indentation depth" where the punch yields too, or may.
OF_BOTH = " (approach of both bodies)"
RING_LABEL, PEAK_LABEL = "largest nominal pressure, in a ring", "largest real pressure, in the ring"


class Summary(str):
    """A text whose repr is the text itself. A notebook shows its lines, and of one contact a small picture of p(r)."""

    picture = ""

    @classmethod
    def of(cls, text: str, case: xr.Dataset) -> "Summary":
        """The text on one contact, with its picture, if it has a profile."""
        made = cls(text)
        if "p" in case and "x" in case.coords:
            made.picture = curve(case["x"].values, case["p"].values, "r/a", "nominal pressure p")
        return made

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        return with_picture(str(self), self.picture)


def summary(contact: xr.Dataset) -> Summary:
    """What `study.solve` found, in words.

    The text has the inputs; each quantity with its unit and ±; status, model used and validity as sentences. ± is one
    standard deviation: the root of the sum of the squares of `error`, of `model_error` and of what the spreads of the
    inputs make of the quantity (`NAME_spread`). `error` and `model_error` are of the other six quantities; dP/dD is
    taken to be as sure. Where the profile p is larger in a ring than in the centre, the text has the pressure of that
    ring and its radius.

    Parameters
    ----------
    contact : of `study.solve`, in physical units or dimensionless; of a grid the first 20 cases are written out

    Returns
    -------
    Summary : a text, which a notebook shows with its lines

    Raises
    ------
    ValueError : the dataset is not one of contacts

    Examples
    --------
    >>> import study
    >>> summary(study.solve(P=1e-5, micro="smooth", base="half_space")).splitlines()[0]
    'Given: a rigid punch'
    """
    missing = [name for name in ("status", "model_used", "validity", "base", "micro", *SHOWN) if name not in contact]
    if missing:
        raise ValueError(f"this dataset is not one of contacts: it has no {missing[0]}")
    bare = [name for name in ("status", "model_used", "validity") if "flag_meanings" not in contact[name].attrs]
    if bare:
        raise ValueError(f"{bare[0]} has lost its attributes, which say what its numbers mean: keep them (keep_attrs)")
    dims = [str(dim) for dim in contact["status"].dims]
    contact = contact.reset_index([dim for dim in dims if hasattr(contact.indexes.get(dim), "levels")])
    if not dims:
        return Summary.of(_summary_of_case(contact), contact)
    cases = contact.stack({"one": dims}, create_index=False)
    texts = []
    for i in range(min(cases.sizes["one"], MOST_CASES)):
        case = cases.isel(one=i)
        where = str(case["label"].values) if "label" in case else ", ".join(given_text(case, dim) for dim in dims)
        texts.append(f"--- {where}\n{_summary_of_case(case, dims)}")
    if cases.sizes["one"] > MOST_CASES:
        texts.append(f"--- and {cases.sizes['one'] - MOST_CASES} more cases: choose some with sel() or isel()")
    return Summary("\n\n".join(texts))


def _summary_of_case(case: xr.Dataset, dims=()) -> str:
    """The text of one case; inputs along `dims` are not repeated."""
    rough = case["micro"].values not in smooth_laws()
    used = used_inputs(case)
    inputs = [name for name in used if name not in (*dims, *CONTROLS) and not name.startswith("layers.")]
    unsaid = " (assumed)" * ("R" in case and "E_punch" not in case)
    rigid = [f"a rigid punch{unsaid}"] * is_rigid(case, "punch") + ["a rigid base"] * is_rigid(case, "base")
    unused = [name for name in _OPTIONAL if name in case and name not in (*used, *dims)]
    unused = [name for name in unused if np.isfinite(case[name])]  # NaN: given for other cases
    given = [*rigid, *(given_text(case, name) for name in inputs), *_pieces(case, used)]
    lines = ["Given: " + ", ".join(given)] + _stack(case, used)
    lines += [f"Not used: {', '.join(given_text(case, name) for name in unused)}"] * bool(unused) + [""]
    names = [name for name in SHOWN if rough or name not in OF_ASPERITIES]
    names += ["plastic_share"] * bool("plastic_share" in case and np.isfinite(case["plastic_share"]))
    rows = _rows(case, names)
    width = max(len(label) for label, _, _ in rows)
    lines += [f"  {label:{width}}  {symbol:6} = {text}" for label, symbol, text in rows]
    return "\n".join([*lines, "", *sentences(case, [name for name in names if name in _JUDGED], not dims)])


def _stack(case: xr.Dataset, used: list[str]) -> list[str]:
    """A line of the geometry of a stack of layers, from the second one down to the base; [] of one layer."""
    parts: dict[str, list[str]] = {}
    for name in (name for name in used if name.startswith("layers.") and name in case and not case[name].dims):
        number, _, field = name.removeprefix("layers.").partition(".")
        text = given_text(case, name).replace(f"layers.{number}.", "").removeprefix("material ")
        if text not in ("uniform", "nan") and not text.endswith("= nan"):
            parts.setdefault(number, []).append(text)
    below = "a rigid base" if is_rigid(case, "base") else "the body"
    texts = [f"layer {number}: {', '.join(texts)}" for number, texts in parts.items()]
    return [f"Stack, from the surface down: {'; '.join(texts)}; then {below}"] if texts else []


def _rows(case: xr.Dataset, names: list[str]) -> list[tuple[str, str, str]]:
    """Long name, symbol and text of each result; after those of the centre those of a ring, where that has more."""
    top, rows = largest(case), []
    for name in names:
        label = VOCABULARY[name].long_name + OF_BOTH * (name == "D" and not is_rigid(case, "punch"))
        rows.append((label, VOCABULARY[name].symbol, result_text(case, name)))
        if name == "p0" and top.place is not None:
            rows.append((RING_LABEL, VOCABULARY["p_ring"].symbol, ring_text(case, top.place)))
        if name == "p_max" and top.place is not None and np.isfinite(top.real):
            rows.append((PEAK_LABEL, VOCABULARY["p_peak"].symbol, peak_text(case, top.real)))
    return rows


def _pieces(case: xr.Dataset, used: list[str]) -> list[str]:
    """Of bodies of one material whose moduli have a spread, whether these are independent: it changes every ±."""
    of_material: dict[str, list[str]] = {}
    for body, (modulus, ratio, _) in BODIES.items():
        if body in case and modulus in used and spread_of(case, modulus) + spread_of(case, ratio) > 0:
            of_material.setdefault(str(case[body].values), []).append(body)
    texts = []
    for material, bodies in of_material.items():
        one = all(case[body].attrs.get("comment") == SAME_PIECE for body in bodies)
        which = "one piece" if one else "independent pieces"
        bodies = [body.removesuffix(".material").replace("layers.", "layer ") for body in bodies]
        texts += [f"{', '.join(bodies[:-1])} and {bodies[-1]} {which} of {material}"] * (len(bodies) > 1)
    return texts
