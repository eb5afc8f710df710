"""The public function `design`: the value of one input that makes a wanted result, with its ±."""

import time
import warnings
from typing import Any

import numpy as np
import xarray as xr

from ..data.coordinates import with_coordinates
from ..in_words import beside_rules, doubts
from ..inputs.definition import StudyError
from ..inputs.vocabulary import NOT_RUN
from ..specimen.foreign import plain
from ..work.progress import screen_of
from .design_cases import Wanted
from .design_messages import messages
from .design_question import read_wanted
from .design_search import STATUSES, Outcome, answered, searched, solutions, solved


def design(
    targets: dict[str, Any],
    by: dict[str, tuple],
    *,
    progress: bool | None = None,
    cases: list[dict] | None = None,
    same_piece: bool = False,
    correlations: dict[tuple[str, str], float] | None = None,
    **parameters: Any,
) -> xr.Dataset:
    """The value of one input at which a result is as wanted: docs/design.md.

    Every solution within the bounds is found: the result is scanned over the input, its turns are looked for, and each
    crossing of the wanted value is a solution.

    Parameters
    ----------
    targets : one wanted result and its value, {"p_max": "180 MPa"}: a, P, D, p0, p_max, Ar_An or dP_dD;
        or P_off, the load at pull-off, < 0, of a punch that adheres: its ± is not known, NaN
    by : one input that is a number, and two bounds, {"h": ("1 um", "1 mm")}; also P, a or D, which controls then
    progress : whether a call of more than two seconds says how far it is; None: in a notebook or on a terminal
    cases, same_piece, correlations, parameters : as of `study.solve`, without the target and the input of `by`

    Returns
    -------
    xarray.Dataset : contacts as of `study.solve` over the dimensions of the parameters and `solution`, with NaN and
        the status "not_run" where there are fewer solutions. The input, say `h`, is a coordinate over the same
        dimensions; `h_spread` its standard deviation, to first order, of the spreads of the other inputs; `h_low`,
        `h_high` where the result is one standard deviation off, NaN if it is nowhere on that side. Without spreads
        `h_spread` is 0. Over the dimensions of the parameters: `design_status` (found; several; none_below, none_above:
        the target is below, or above, all that is reached; at_edge: a solution within 1e-6 of a bound, in ln; unsolved:
        where it would be, contacts have no solution, or the result jumps) and `message`, the answer in words

    Raises
    ------
    StudyError : input that cannot be used

    Notes
    -----
    An interrupt ends the search. Cases searched until then are returned, the others are "not_run".

    Examples
    --------
    >>> import study
    >>> layer = {"n": 0.5, "bonding": "bonded", "micro": "smooth"}
    >>> designed = study.design({"p0": 0.01}, by={"h": (1e-3, 0.1)}, P=1e-5, **layer)
    >>> round(designed.h.item(), 5), study.decode(designed.design_status).item()
    (0.01012, 'found')
    """
    begun, stream = time.monotonic(), screen_of(plain(progress))
    if cases is not None and not (isinstance(cases, list) and cases and all(isinstance(row, dict) for row in cases)):
        raise StudyError(["design: cases must be a list of dictionaries, at least one"])
    want = read_wanted(targets, by, parameters, cases or [], same_piece, correlations)
    pieces = searched(want, stream, begun)
    t = solutions(want, pieces)
    contacts, change = solved(want, t, stream)
    outcome = answered(want, pieces, t, change, stream)
    designed = contacts.assign(_variables(want, outcome, contacts))
    designed, left_out = with_coordinates(designed, parameters)
    beyond = doubts(designed) if want.definition.scene else beside_rules(designed)
    left_out += ["\n".join(["a contact found is beyond what the model describes:", *beyond])] * bool(beyond)
    for text in left_out:
        warnings.warn(text, stacklevel=2)
    return designed


def _variables(want: Wanted, outcome: Outcome, contacts: xr.Dataset) -> dict[str, xr.Variable]:
    """The variables of a design beside those of its contacts: the spread and the ends of the input, status, message."""
    name, dims = want.name, contacts["status"].dims
    unit = want.definition.grid.lexicon.all_rows[name].unit if want.definition.scene else ""
    about = {"units": unit} if unit not in ("", "1") else {}
    about |= {key: contacts[name].attrs[key] for key in ("scale",) if key in contacts[name].attrs}
    x, change = want.x_of(outcome.t), outcome.change
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(change.spread == 0, 0.0, change.spread / want.level / change.by_input)
    numbers = {
        f"{name}_spread": (np.abs(x) * relative, f"standard deviation of {name}, from the spreads of other inputs"),
        f"{name}_low": (want.x_of(outcome.low), f"{name} below, where {want.target} is one standard deviation off"),
        f"{name}_high": (want.x_of(outcome.high), f"{name} above, where {want.target} is one standard deviation off"),
    }
    shape = contacts["status"].shape
    variables = {
        key: xr.Variable(dims, values.reshape(shape), {"long_name": words} | about)
        for key, (values, words) in numbers.items()
    }
    flags = {
        "long_name": f"whether {want.target} is as wanted for some {name} within its bounds",
        "flag_values": np.array([*range(len(STATUSES)), NOT_RUN], dtype=np.int8),
        "flag_meanings": " ".join((*STATUSES, "not_run")),
    }
    texts = np.array(messages(want, outcome, contacts.assign(variables)), dtype=object).reshape(shape[:-1])
    variables["design_status"] = xr.Variable(dims[:-1], outcome.status.reshape(shape[:-1]), flags)
    variables["message"] = xr.Variable(dims[:-1], texts.astype(str), {"long_name": "what was found"})
    return variables
