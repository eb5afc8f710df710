"""The cost of a run: time from a sample of the cases, memory and disk from their number."""

import time
from dataclasses import dataclass

import numpy as np

from solver.bases import is_thin_layer, may_be_layered
from solver.numerics.ladder import LADDER, STACK

from ..data.dataset import not_run
from ..inputs.definition import Definition, StudyError
from ..store.windows import PART, is_large
from ..store.writer import AT_ONCE
from ..terminal import rounded
from .cases import compute, parcel
from .engine import AHEAD, MANY, available_workers, core_takes, number_of_helpers
from .progress import duration

SAMPLE, OF_STRESSES = 256, 16  # number of cases whose time is measured; of those with their largest stresses
PROCESS = 250_000_000  # bytes of this process, Python and the packages
WORKER = 110_000_000  # bytes of a worker process, which has fewer packages
PER_CASE = 100  # bytes for the key of a case, and for the search for it
WORKING = 5  # memory of the arrays (B, m) of a block while it is solved, over that of its result
# Each worker takes SOLVING bytes more, and has MATRICES matrices (B, n, n) at a time, by the peaks of runs on 17 to 256
# nodes, and of 300 cases of the study extremes_layered, which fill every table (0.86 GB in one process).
SOLVING, MATRICES = 80_000_000, 3
KEY = 16  # bytes of the key of a case, in a block and in the record of the results file
# A results file takes HEAD bytes besides its numbers, which take ROOM times their size, since chunks at the edges of a
# grid are stored whole. Measured on files of 3000 and of 1e6 cases.
HEAD, ROOM = 300_000, 1.05
TABLES = 600_000_000  # bytes that each process keeps for the exact layer: 0.4 GB of tables, and the data they come from


@dataclass(frozen=True)
class Estimate:
    """The expected cost of a run.

    cases, present : number of cases in the study, and on disk
    seconds : time for the missing cases
    memory : largest number of bytes in memory
    size : bytes of the results
    disk : largest number of bytes of the results and the new blocks
    refused : the error with which `run` would end because of the results file
    """

    cases: int
    present: int
    seconds: float
    memory: float
    size: float
    disk: float
    refused: StudyError | None = None


def estimate(definition: Definition, workers: int | None = None, present: int = 0) -> Estimate:
    """The cost of the cases that are not present. The time is that of a sample spread over all cases."""
    cases = definition.grid.size
    missing = cases - present
    blocks = -(-missing // definition.block)
    count = max(1, min(workers or available_workers(), blocks))  # more workers would have no work
    seconds = missing * seconds_per_case(definition) / count if missing else 0.0
    size = definition.numbers * np.dtype(definition.dtype).itemsize
    block = size / cases * min(definition.block, cases)
    caller_solves = blocks < MANY or count == 1  # whether the calling thread computes too
    large, threads = is_large(definition), core_takes(definition)
    processes = 0 if threads else number_of_helpers(count, blocks, caller_solves)
    keyed = min(cases, 2 * PART * cases // size) if large else cases  # those of two windows at a time, or all
    memory = PROCESS + WORKER * processes + PER_CASE * keyed + 3 * min(size, PART if large else AT_ONCE)
    memory += (AHEAD + WORKING) * count * block
    base, judged = (definition.grid.values[name][1] for name in ("base", "model_check"))
    # whether some case may need the operator of the exact layer: as its base, or for the error of the thin layer
    exact = may_be_layered(base).any() or is_thin_layer(base).any() and (judged == "first_order").any()
    nodes = max(LADDER[-1], int(definition.grid.values["nodes"][1].max()))
    matrices = nodes**2 * min(definition.block, cases), nodes * (3 * STACK if exact else STACK)
    memory += (
        count * (SOLVING + 8 * MATRICES * min(matrices)) + (processes + (caller_solves or threads)) * TABLES * exact
    )
    if large:  # the results, and the blocks of two windows at a time
        disk = HEAD * (size // PART + 1) + ROOM * size * missing / cases + 2 * min(PART, size * missing / cases)
        return Estimate(cases, present, seconds, memory, size, disk)
    # the blocks of the missing cases, and the record of the cases in the results file
    stored = KEY * cases + missing * (KEY + sum(array.nbytes for array in not_run(definition, 1).values()))
    return Estimate(cases, present, seconds, memory, size, HEAD + ROOM * size + stored if missing else 0.0)


def seconds_per_case(definition: Definition) -> float:
    """Time of a case on one worker.

    The first call prepares tables that all cases share, and is not counted. The second call solves the neighbouring
    cases: where their layer or pitch differs, laws of asperities that feel the layer have to be computed again.
    """
    sample = OF_STRESSES if definition.stresses else SAMPLE
    places = np.linspace(0, definition.grid.size - 1, min(sample, definition.grid.size)).astype(int)
    compute(parcel(definition, places))
    neighbours = parcel(definition, (places + 1) % definition.grid.size)
    start = time.perf_counter()
    compute(neighbours)
    return (time.perf_counter() - start) / len(places)


def describe(cost: Estimate) -> str:
    """ "about 2 min 5 s, at most 0.5 GB of memory and 1.4 GB of disk; the results are 0.7 GB"."""
    memory, disk, size = (f"{rounded(number / 1e9)} GB" for number in (cost.memory, cost.disk, cost.size))
    return f"about {duration(cost.seconds)}, at most {memory} of memory and {disk} of disk; the results are {size}"
