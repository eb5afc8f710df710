"""A block of curves as a task for any process of this machine. Each process keeps the table of a call."""

from typing import Any, NamedTuple

import numpy as np

from .block import fit_block
from .question import Question
from .tables.ratio_table import RatioTable
from .tables.term_table import TermTable

#: Call -> its table. There are several, for calls in several threads. Tables of worker processes end with these.
_tables: dict[str, RatioTable | TermTable] = {}
_MOST = 8


class Task(NamedTuple):
    """Some curves of a call: x, y (B, n) and the standard deviations of y, as in `fit_block`.

    call : a word that identifies the call in its process
    """

    call: str
    question: Question
    x: np.ndarray
    y: np.ndarray
    sigma: np.ndarray | None


def fit_task(task: Task) -> dict[str, Any]:
    """The numbers that `fit_block` returns for these curves."""
    table = _tables.get(task.call)
    if table is None:
        for oldest in list(_tables)[: max(0, len(_tables) - _MOST + 1)]:
            forget(oldest)
        model = task.question.model
        table = _tables[task.call] = TermTable(model) if model.sticks else RatioTable(model)
    with np.errstate(all="ignore"):
        return fit_block(task.question, table, task.x, task.y, task.sigma)


def forget(call: str) -> None:
    """Free the table of a call in this process."""
    _tables.pop(call, None)
