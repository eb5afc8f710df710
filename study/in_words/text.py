"""A contact in words: each quantity with its unit and its uncertainty, the solution, and the assumptions behind it."""

from __future__ import annotations

import re

import numpy as np

from ..arrays import xarray_later as xr
from ..data.dataset import decode, is_contact, without_numbered_layers
from ..inputs.lexicon import lexicon_in
from ..inputs.vocabulary import NOT_RUN, VOCABULARY
from ..specimen.pictures import curve, with_picture
from .fits import of_fit
from .margins import closest
from .notes import OF_PULL_OFF
from .numbers import given_text, peak_text, result_text, ring_text, spot_text
from .pressures import largest
from .sentences import sentences
from .stated_inputs import input_lines, is_rigid
from .stress_lines import of_stresses

MOST_CASES = 20  # number of cases of a grid that a summary writes out
SHOWN = ("P", "a", "D", "p0", "p_max", "Ar_An", "dP_dD")
_JUDGED = tuple(name for name in SHOWN if name != "dP_dD")  # results whose largest error is `error`
#: Results that smooth contacts do not show: the real pressure is the nominal one, and the real area the nominal area.
OF_ASPERITIES = ("p_max", "Ar_An")
#: Words after "indentation depth" where the punch gives way too, or may.
OF_BOTH = " (approach of both bodies)"
SPOT_LABEL = "largest real pressure in the central spot"
RING_LABEL, PEAK_LABEL = "largest nominal pressure, in a ring", "largest real pressure, in the ring"


class Summary(str):
    """A text whose repr is the text itself. A notebook shows its lines, and for one contact a small picture of p(r)."""

    picture = ""

    @classmethod
    def of(cls, text: str, case: xr.Dataset) -> Summary:
        """The text on one contact, with a picture if it has a profile."""
        summary_of_case = cls(text)
        if "p" in case and "x" in case.coords:
            summary_of_case.picture = curve(case["x"].values, case["p"].values, "r/a", "nominal pressure p")
        return summary_of_case

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        return with_picture(str(self), self.picture)


def summary(contact: xr.Dataset) -> Summary:
    """The answer of `study.solve` in words.

    The text has the inputs; each quantity with its unit and ±; status, model used and validity as sentences. ± is one
    standard deviation: the root of the sum of the squares of `error`, of `model_error` and of the spread that follows
    from the inputs (`NAME_spread`). `error` and `model_error` belong to the other six quantities; dP/dD is assumed to
    be as accurate. Where the profile p is larger in a ring than in the centre, the text has the pressure and the radius
    of that ring.

    Parameters
    ----------
    contact : from `study.solve`, in physical units or dimensionless; of a grid the first 20 cases are written out. From
        `study.fit` the text has the fitted inputs of each curve, and what the curve could not tell; from `study.design`
        the answer for each contact, or each solution of a single contact; from `study.first_yield`, `h_protect`,
        `extremes` and `stresses` their answers

    Returns
    -------
    Summary : a text, which a notebook shows with its line breaks

    Raises
    ------
    ValueError : the dataset is not one of contacts

    Examples
    --------
    >>> import study
    >>> summary(study.solve(P=1e-5, micro="smooth", base="half_space")).splitlines()[0]
    'Given: a rigid punch'
    """
    if not is_contact(contact):
        kind = type(contact).__name__
        raise ValueError(f"summary takes what study.solve, fit, design or a function of stresses gives, not {kind}")
    if text := of_stresses(contact):
        return Summary(text)
    if "fit_status" in contact:
        return Summary(of_fit(contact))
    contact = without_numbered_layers(contact) if xr.is_dataset(contact) else contact
    if "design_status" in contact and "solution" in contact.dims:
        return _of_design(contact)
    missing = [name for name in ("status", "model_used", "validity", "base", "micro", *SHOWN) if name not in contact]
    if missing:
        raise ValueError(f"this dataset is not one of contacts: it has no {missing[0]}")
    bare = [name for name in ("status", "model_used", "validity") if "flag_meanings" not in contact[name].attrs]
    if bare:
        raise ValueError(f"{bare[0]} has lost its attributes, which say what its numbers mean: keep them (keep_attrs)")
    dims = [str(dim) for dim in contact["status"].dims]
    if not dims:
        return Summary.of(_summary_of_case(contact), contact)
    contact = contact.reset_index([dim for dim in dims if hasattr(contact.indexes.get(dim), "levels")])
    cases = contact.stack({"one": dims}, create_index=False)
    texts = []
    for i in range(min(cases.sizes["one"], MOST_CASES)):
        case = cases.isel(one=i)
        where = str(case["label"].values) if "label" in case else ", ".join(given_text(case, dim) for dim in dims)
        texts.append(f"--- {where}\n{_summary_of_case(case, dims)}")
    if cases.sizes["one"] > MOST_CASES:
        texts.append(f"--- and {cases.sizes['one'] - MOST_CASES} more cases: choose some with sel() or isel()")
    return Summary("\n\n".join(texts))


def _of_design(designed: xr.Dataset) -> Summary:
    """The answer of `study.design` for each contact, or each solution in words for a single contact."""
    dims = [str(dim) for dim in designed["design_status"].dims]
    if not dims:
        solutions = [designed.isel(solution=number) for number in range(designed.sizes["solution"])]
        solutions = [solution for solution in solutions if solution["status"] != NOT_RUN]
        text = "\n\n".join([str(designed["message"].values) + ".", *map(_summary_of_case, solutions)])
        return Summary.of(text, solutions[0]) if len(solutions) == 1 else Summary(text)
    cases, texts = designed.stack({"one": dims}, create_index=False), []
    for i in range(min(cases.sizes["one"], MOST_CASES)):
        case = cases.isel(one=i)
        where = str(case["label"].values) if "label" in case else ", ".join(given_text(case, dim) for dim in dims)
        texts.append(f"--- {where}\n{case['message'].values}.")
    more = cases.sizes["one"] - MOST_CASES
    return Summary("\n".join([*texts, *[f"--- and {more} more: choose some with sel() or isel()"] * (more > 0)]))


def _summary_of_case(case: xr.Dataset, dims=()) -> str:
    """The text on one case; inputs along `dims` are not repeated."""
    rough = case["micro"].values not in lexicon_in(case).smooth_laws()
    names = [name for name in SHOWN if rough or name not in OF_ASPERITIES]
    names += [name for name in OF_PULL_OFF if name in case]
    names += ["plastic_share"] * bool("plastic_share" in case and np.isfinite(case["plastic_share"]))
    rows = _rows(case, names)
    width = max(len(label) for label, _, _ in rows)
    lines = [f"  {label:{width}}  {symbol:6} = {text}" for label, symbol, text in rows]
    judged = [name for name in names if name in _JUDGED]
    return "\n".join([*input_lines(case, dims), "", *lines, "", *sentences(case, judged)])


def _rows(case: xr.Dataset, names: list[str]) -> list[tuple[str, str, str]]:
    """Long name, symbol and text of each result; results of the centre are followed by larger ones in a ring."""
    top, rows = largest(case), []
    for name in names:
        label = VOCABULARY[name].long_name + OF_BOTH * (name == "D" and not is_rigid(case, "punch"))
        rows.append((label, VOCABULARY[name].symbol, result_text(case, name)))
        if name == "p0" and top.place is not None:
            rows.append((RING_LABEL, VOCABULARY["p_ring"].symbol, ring_text(case, top.place)))
        if name == "p_max" and "p_spot" in case and case["r_spot"] > 0:
            rows.append((SPOT_LABEL, VOCABULARY["p_spot"].symbol, spot_text(case)))
        if name == "p_max" and top.place is not None and np.isfinite(top.real):
            rows.append((PEAK_LABEL, VOCABULARY["p_peak"].symbol, peak_text(case, top.real)))
    return rows


def columns(contacts: xr.Dataset) -> str:
    """A line for each contact of a grid: the inputs that differ, the results of `summary`, status, validity; where
    strengths are known, the body or spots closest to their limit, with their share of it.

    contacts : from `study.solve`, over one dimension or more; of more than 20 contacts the rest is only counted
    """
    dims = list(contacts["status"].dims)
    cases = contacts.stack({"case": dims}, create_index=False)
    shown = [cases.isel(case=i) for i in range(min(cases.sizes["case"], MOST_CASES))]
    laws = lexicon_in(contacts).smooth_laws()
    smooth = all(case["micro"].values in laws for case in shown)
    names = [name for name in SHOWN if name not in dims and not (smooth and name in OF_ASPERITIES)]
    heading = [*map(str, dims), *names, "status", "strength", "validity"]
    rows: list[list[str]] = [heading, *(_row(case, dims, names) for case in shown)]
    left = [-1] * (not any(row[-1] for row in rows[1:])) + [-2] * all(row[-2] == "-" for row in rows[1:])
    rows = [[cell for place, cell in enumerate(row, -len(row)) if place not in left] for row in rows]
    widths = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
    lines = ["  ".join(f"{cell:{w}}" for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows]
    more = cases.sizes["case"] - len(shown)
    return "\n".join([*lines, *[f"... and {more} more contacts"] * bool(more)])


def _row(case: xr.Dataset, dims: list, names: list[str]) -> list[str]:
    """The cells of one contact. A result that is not known is "-"."""
    inputs = [re.sub(rf"^{re.escape(dim)} (= |of )?", "", given_text(case, dim)) for dim in dims]
    results = ["-" if np.isnan(case[name]) else result_text(case, name) for name in names]
    flags = [str(decode(case[name]).values) for name in ("status", "validity")]
    return [*inputs, *results, flags[0], closest(case), flags[1]]
