"""What a run would cost: time by a sample of the cases, memory and size by their number."""

import time
from dataclasses import dataclass

import numpy as np

from .blocks import compute, parcel
from .cluster import AHEAD, available_workers, processes_for
from .definition import Definition
from .join import AT_ONCE
from .progress import duration

SAMPLE = 256  # cases
PROCESS, WORKER = 250_000_000, 150_000_000  # bytes of Python and its packages, and of those in a worker process
PER_CASE = 100  # bytes for the key of a case, and to find it
WORKING = 5  # memory that solving a block takes, in sizes of its result


@dataclass(frozen=True)
class Estimate:
    """cases; present, of these on disk; seconds for the rest; memory, bytes at most; size, bytes of the results."""

    cases: int
    present: int
    seconds: float
    memory: float
    size: float


def estimate(definition: Definition, workers: int | None = None, present: int = 0) -> Estimate:
    """The cost of the cases that are not present, by the time of a sample spread over all."""
    count, cases = workers or available_workers(), definition.grid.size
    missing = cases - present
    seconds = missing * seconds_per_case(definition) / count if missing else 0.0
    size = definition.numbers * np.dtype(definition.dtype).itemsize
    block = size / cases * min(definition.block, cases)
    memory = PROCESS + WORKER * processes_for(count, -(-missing // definition.block)) + PER_CASE * cases
    memory += 3 * min(size, AT_ONCE) + (AHEAD + WORKING) * count * block
    return Estimate(cases, present, seconds, memory, size)


def seconds_per_case(definition: Definition) -> float:
    """Time of a case on one worker. The first call prepares what all cases share, and is not counted."""
    places = np.linspace(0, definition.grid.size - 1, min(SAMPLE, definition.grid.size)).astype(int)
    wanted = parcel(definition, places)
    compute(wanted)
    start = time.perf_counter()
    compute(wanted)
    return (time.perf_counter() - start) / len(places)


def describe(cost: Estimate) -> str:
    """ "about 2 min 5 s, at most 0.5 GB of memory, 0.7 GB on disk"."""
    memory, size = (f"{number / 1e9:.2g} GB" for number in (cost.memory, cost.size))
    return f"about {duration(cost.seconds)}, at most {memory} of memory, {size} on disk"
