"""The message of each contact of a design: the answer with its ±, or why there is none and what would help."""

import numpy as np
import xarray as xr

from ..data.dataset import decode
from ..derivatives import QUANTITIES, sensitivities
from ..inputs.scene.scene import is_ratio
from ..inputs.vocabulary import NOT_RUN
from ..specimen.quantities import readable
from .design_cases import Wanted
from .design_search import Outcome, solved

#: Behind a target that lies within the range that is reached.
_JUMPS = 'contacts have no solution, or it jumps, as where base = "auto" changes its model'
_FLAT = 1e-9  # a result that changes by less of itself does not depend on the input
_MOST = 0.99  # an input that makes more of the variance makes "nearly all" of it


def messages(want: Wanted, outcome: Outcome, contacts: xr.Dataset) -> list[str]:
    """A text for each case (B,).

    contacts : the solutions, with the spread and the ends of the input
    """
    helps = _helps(want, outcome)
    valid = decode(contacts["validity"]).values.reshape(outcome.t.shape)
    ends = [contacts[f"{want.name}{end}"].values.reshape(outcome.t.shape) for end in ("", "_spread", "_low", "_high")]
    texts = []
    for row, status in enumerate(outcome.status.tolist()):
        if status == NOT_RUN:
            texts.append("not searched: interrupted before")
        elif not np.isfinite(outcome.t[row]).any():
            texts.append(_none(want, outcome, row) + helps.get(row, ""))
        else:
            each = []
            for number in np.flatnonzero(np.isfinite(outcome.t[row])).tolist():
                text = _solution(want, outcome, row, number, [end[row, number] for end in ends])
                beyond = valid[row, number].replace(" ", ", ")
                each.append(text + f"; outside the model there: {beyond}" * bool(beyond))
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
    """One solution with its ±, and which input makes most of it."""
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
        text += f", for {want.target} is never {' or '.join(never)} within the bounds" * bool(never)
    if outcome.change.shares:
        most = max(outcome.change.shares, key=lambda name: outcome.change.shares[name][row, number])
        share = outcome.change.shares[most][row, number]
        text += f"; {most} makes {'nearly all' if share > _MOST else f'{100 * share:.0f} %'} of its variance"
    return text


def _none(want: Wanted, outcome: Outcome, row: int) -> str:
    """Why there is no solution, with the range that is reached."""
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
    """Case without a solution -> which input would move the result most, where it is nearest to what is wanted."""
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
        if is_ratio(name):  # whose derivatives are not by the logarithm
            slopes[:, column] *= contacts[name].broadcast_like(contacts["status"]).values.ravel()
    slopes, texts = np.nan_to_num(slopes), {}  # NaN: by what a case does not have
    for row in np.flatnonzero(lacking).tolist():
        best = int(np.argmax(np.abs(slopes[row])))
        slope = float(slopes[row, best])
        if slope:
            smaller = outcome.status[row] == 2
            way = "less" if (slope > 0) == smaller else "more"
            change = f"{float(f'{abs(slope):.2g}'):g} % {'smaller' if smaller else 'larger'}"
            texts[row] = f". {names[best]} would move it most: 1 % {way} makes it {change}"
    return texts
