"""A sentence on the parts of the ± of the largest pressure, and on its dependence on the thickness of the layer."""

from __future__ import annotations

import numpy as np

from ..arrays import xarray_later as xr
from ..data.contacts import Contacts
from ..derivatives import correlated, relative_spreads, sensitivities_of_case
from ..inputs.vocabulary import VOCABULARY
from ..terminal import rounded

#: An input with a larger share of the variance makes "nearly all" of it.
_NEARLY = 0.99
#: If the thickness must change by more than this share of itself, it to change a result by 1 % hardly acts; a
#: derivative does not reach so far.
_FAR = 0.5
#: Largest change in % that no printed digit shows; none is written that is smaller.
_LITTLE = 0.01
#: A relative spread that no printed digit shows. Its parts are lost in the error of the solution, which is below
#: 1e-9, so that the sentence says it in words.
_UNSEEN = 1e-7


def influence(case: xr.Dataset, contact: Contacts | None, name: str) -> list[str]:
    """A sentence on the input that makes most of the ± of a result of one case, and on the effect of h.

    The case is solved again, for the derivatives. [] without a spread, and where it cannot be solved again, without a
    `contact`.
    """
    if contact is None or not float(case.get(f"{name}_spread", 0.0)) > 0:
        return []
    by_input, symbol = sensitivities_of_case(contact, name), VOCABULARY[name].symbol
    parts = {key: by_input[key] * part for key, part in relative_spreads(case, by_input).items()}
    texts = []
    if float(case[f"{name}_spread"]) < _UNSEEN * abs(float(case[name])):
        texts = [f"the ± of the inputs changes {symbol} by less than a part in ten million"]
    elif not correlated(case):
        largest = max(parts, key=lambda key: abs(parts[key]))
        share = parts[largest] ** 2 / sum(part**2 for part in parts.values())
        most = "nearly all" if share > _NEARLY else f"{100 * share:.0f} %"
        texts = [f"{largest} contributes {most} of the variance of {symbol}"]
    by_h = by_input.get("h", 0.0)
    if abs(by_h) * _FAR > 0.01:
        thickness = f"a {rounded(1 / abs(by_h))} % {'larger' if by_h > 0 else 'smaller'} h"
        texts.append(f"{thickness} makes {symbol} 1 % larger")
    elif by_h:
        change = 10 * abs(by_h)  # in %
        size = f"{rounded(change)} %" if change > _LITTLE else f"less than {_LITTLE:g} %"
        texts.append(f"10 % of h changes {symbol} by {size}")
    return ["; ".join(texts) + "."] if texts and np.isfinite([*by_input.values()]).all() else []
