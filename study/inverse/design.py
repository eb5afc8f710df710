"""The public function `design`: the value of one input for a wanted result, with its ±, and the message for each
contact: the answer, or the reason why there is none and the input that would help."""

import time
import warnings
from typing import Any

import numpy as np
import xarray as xr

from ..data.coordinates import with_coordinates
from ..data.dataset import decode
from ..derivatives import QUANTITIES, sensitivities
from ..in_words import beside_rules, doubts
from ..inputs.definition import StudyError
from ..inputs.scene.scene import is_ratio
from ..inputs.vocabulary import NOT_RUN
from ..specimen.foreign import plain
from ..specimen.quantities import readable
from ..work.progress import screen_of
from .design_cases import Wanted
from .design_question import read_wanted
from .design_search import STATUSES, Outcome, answered, searched, solutions, solved

#: Follows a target within the range that is reached.
_JUMPS = 'contacts have no solution, or the result jumps, for example where base = "auto" changes its model'
_FLAT = 1e-9  # a result whose relative change is smaller does not depend on the input
_MOST = 0.99  # an input with a larger share of the variance makes "nearly all" of it


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
    """The value of one input at which a result has a wanted value: docs/design.md.

    Every solution within the bounds is found: the result is scanned over the input, its turns are located, and each
    crossing of the wanted value is a solution.

    Parameters
    ----------
    targets : one wanted result and its value, {"p_max": "180 MPa"}: a, P, D, p0, p_max, Ar_An or dP_dD; or P_off, the
        load at pull-off, < 0, of a punch with adhesion, whose ± is not known, NaN
    by : one numerical input and two bounds, {"h": ("1 um", "1 mm")}; P, a or D is then the control
    progress : whether a call of more than two seconds shows its progress; None: in a notebook or on a terminal
    cases, same_piece, correlations, parameters : as in `study.solve`, without the target and the input of `by`

    Returns
    -------
    xarray.Dataset : contacts as from `study.solve` over the dimensions of the parameters and `solution`, with NaN and
        the status "not_run" where there are fewer solutions. The input, say `h`, is a coordinate over the same
        dimensions. `h_spread` is its standard deviation, to first order, from the spreads of the other inputs, 0
        without spreads. At `h_low` and `h_high` the result is one standard deviation off; NaN if that is nowhere on
        that side. Over the dimensions of the parameters: `design_status` (found; several; none_below, none_above: the
        target is below, or above, the whole range that is reached; at_edge: a solution within 1e-6 of a bound, in ln;
        unsolved: at the place of a solution contacts have no solution, or the result jumps) and `message`, the answer
        in words

    Raises
    ------
    StudyError : input that cannot be used

    Notes
    -----
    An interrupt ends the search. Cases that were searched before are returned, the others are "not_run".

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
    sentences = doubts(designed) if want.definition.scene else beside_rules(designed)
    if sentences:
        left_out.append("\n".join(["a contact of the answer is beyond what the model describes:", *sentences]))
    for text in left_out:
        warnings.warn(text, stacklevel=2)
    return designed


def _variables(want: Wanted, outcome: Outcome, contacts: xr.Dataset) -> dict[str, xr.Variable]:
    """Variables of a design besides those of its contacts: the spread and the ends of the input, status, message."""
    name, dims = want.name, contacts["status"].dims
    unit = want.definition.grid.lexicon.all_rows[name].unit if want.definition.scene else ""
    about = {"units": unit} if unit not in ("", "1") else {}
    about |= {key: contacts[name].attrs[key] for key in ("scale",) if key in contacts[name].attrs}
    x, change = want.x_of(outcome.t), outcome.change
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(change.spread == 0, 0.0, change.spread / want.level / change.by_input)
    numbers = {
        f"{name}_spread": (np.abs(x) * relative, f"standard deviation of {name}, from the spreads of other inputs"),
        f"{name}_low": (
            want.x_of(outcome.low),
            f"{name} on its lower side at which {want.target} is one standard deviation off",
        ),
        f"{name}_high": (
            want.x_of(outcome.high),
            f"{name} on its upper side at which {want.target} is one standard deviation off",
        ),
    }
    shape = contacts["status"].shape
    variables = {
        key: xr.Variable(dims, values.reshape(shape), {"long_name": words} | about)
        for key, (values, words) in numbers.items()
    }
    flags = {
        "long_name": f"whether {want.target} has its wanted value for some {name} within the bounds",
        "flag_values": np.array([*range(len(STATUSES)), NOT_RUN], dtype=np.int8),
        "flag_meanings": " ".join((*STATUSES, "not_run")),
    }
    texts = np.array(_messages(want, outcome, contacts.assign(variables)), dtype=object).reshape(shape[:-1])
    variables["design_status"] = xr.Variable(dims[:-1], outcome.status.reshape(shape[:-1]), flags)
    variables["message"] = xr.Variable(dims[:-1], texts.astype(str), {"long_name": "answer of the search"})
    return variables


def _messages(want: Wanted, outcome: Outcome, contacts: xr.Dataset) -> list[str]:
    """A text for each case (B,).

    contacts : the solutions, with the spread and the ends of the input
    """
    helps = _helps(want, outcome)
    valid = decode(contacts["validity"]).values.reshape(outcome.t.shape)
    ends = [contacts[f"{want.name}{end}"].values.reshape(outcome.t.shape) for end in ("", "_spread", "_low", "_high")]
    texts = []
    for row, status in enumerate(outcome.status.tolist()):
        if status == NOT_RUN:
            texts.append("not searched, because the call was interrupted")
        elif not np.isfinite(outcome.t[row]).any():
            texts.append(_none(want, outcome, row) + helps.get(row, ""))
        else:
            each = []
            for number in np.flatnonzero(np.isfinite(outcome.t[row])).tolist():
                text = _solution(want, outcome, row, number, [end[row, number] for end in ends])
                violated = valid[row, number].replace(" ", ", ")
                each.append(text + f"; outside the model there: {violated}" * bool(violated))
            solutions = "; or ".join(each)
            edge = f". {want.name} is at a bound there: beyond it there may be more" * (status == 4)
            texts.append(f"{_value(want, want.target, want.level)} at {solutions}{edge}")
    return texts


def _text(want: Wanted, name: str, value: float, spread: float = 0.0) -> str:
    """A number with its unit and ±."""
    row = want.definition.grid.lexicon.all_rows[name]
    if want.definition.scene:
        return readable(value, row.unit, spread)
    return f"{value:.5g} {row.scale}".rstrip()


def _value(want: Wanted, name: str, value: float, spread: float = 0.0) -> str:
    return f"{name} = {_text(want, name, value, spread)}"


def _solution(want: Wanted, outcome: Outcome, row: int, number: int, ends: list[float]) -> str:
    """One solution in words, with its ± and the input that makes most of it."""
    x, spread, low, high = ends
    text = _value(want, want.name, x, spread)
    if not spread > 0:
        return text
    rounded = [_text(want, want.name, float(f"{end:.4g}")) if np.isfinite(end) else "none" for end in (low, high)]
    text += f" ({' to '.join(rounded)})"
    least, _, largest, _ = outcome.reach[row]
    off = outcome.change.spread[row, number]
    if not (np.isfinite(low) and np.isfinite(high)):
        never = [f"below {_text(want, want.target, least)}"] * bool(least > want.level - off)
        never += [f"above {_text(want, want.target, largest)}"] * bool(largest < want.level + off)
        text += f", since {want.target} is never {' or '.join(never)} within the bounds" * bool(never)
    if outcome.change.shares:
        most = max(outcome.change.shares, key=lambda name: outcome.change.shares[name][row, number])
        share = outcome.change.shares[most][row, number]
        text += f"; {most} contributes {'nearly all' if share > _MOST else f'{100 * share:.0f} %'} of its variance"
    return text


def _none(want: Wanted, outcome: Outcome, row: int) -> str:
    """The reason why there is no solution, with the range that is reached."""
    least, t_least, largest, t_largest = outcome.reach[row]
    span = f"{want.name} from {_text(want, want.name, want.low)} to {_text(want, want.name, want.high)}"
    wish = _value(want, want.target, want.level)
    if not np.isfinite(least):
        return f"no {wish}: with {span} no contact has a solution"
    if largest - least <= _FLAT * abs(least):
        return f"no {wish}: it is {_text(want, want.target, least)}, whatever {span}"
    at = [_value(want, want.name, float(want.x_of(t))) for t in (t_least, t_largest)]
    reached = f"{_text(want, want.target, least)} (at {at[0]}) to {_text(want, want.target, largest)} (at {at[1]})"
    if outcome.status[row] == 5:
        return f"no {wish}: with {span} it is {reached}, and where it would be as wanted {_JUMPS}"
    return f"no {wish}: with {span} it is {reached}"


def _helps(want: Wanted, outcome: Outcome) -> dict[int, str]:
    """Case without a solution -> the input that would move the result most, where it is closest to the target."""
    lacking = np.isin(outcome.status, (2, 3))
    if not lacking.any() or want.target not in QUANTITIES:
        return {}
    nearest = np.where(outcome.status == 2, outcome.reach[:, 1], outcome.reach[:, 3])
    contacts, _ = solved(want, np.where(lacking, nearest, np.nan)[:, None])
    by_input = sensitivities(contacts)[f"{want.target}_sensitivity"]
    fits = ("B", "beta") if want.definition.grid.fitted else ()
    names = [name for name in by_input["input"].values.tolist() if name not in (want.name, *fits)]
    slopes = by_input.sel(input=names).values.reshape(want.size, len(names)).copy()
    for column, name in enumerate(names):
        if is_ratio(name):  # derivatives by ratios are not by their logarithms
            slopes[:, column] *= contacts[name].broadcast_like(contacts["status"]).values.ravel()
    slopes, texts = np.nan_to_num(slopes), {}  # NaN: the case does not have the input
    for row in np.flatnonzero(lacking).tolist():
        best = int(np.argmax(np.abs(slopes[row])))
        slope = float(slopes[row, best])
        if slope:
            smaller = outcome.status[row] == 2
            direction = "less" if (slope > 0) == smaller else "more"
            change = f"{float(f'{abs(slope):.2g}'):g} % {'smaller' if smaller else 'larger'}"
            texts[row] = f". {names[best]} would move it most: 1 % {direction} makes it {change}"
    return texts
