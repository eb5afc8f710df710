"""The cases of a study in blocks: which cases, computed how, kept where until the results file exists."""

import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from solver import Problem, solve

from .dataset import arrays_of, not_run, open_results, write
from .definition import Definition
from .grid import columns


@dataclass(frozen=True, eq=False)
class Blocks:
    """Blocks of one study. Digest and block size are in the name of their folder, so a file there always fits."""

    definition: Definition
    results: Path

    @property
    def folder(self) -> Path:
        return (
            self.results / f".{self.definition.name}.blocks" / f"{self.definition.digest[:16]}-{self.definition.block}"
        )

    @property
    def count(self) -> int:
        return -(-self.definition.grid.size // self.definition.block)


def bounds(blocks: Blocks, i: int) -> tuple[int, int]:
    """First case of block i and the one after its last."""
    start = i * blocks.definition.block
    return start, min(start + blocks.definition.block, blocks.definition.grid.size)


def compute(definition: Definition, start: int, stop: int) -> dict[str, np.ndarray]:
    """Solve the cases start <= i < stop. Touches no file and no shared state: may run in any thread."""
    problem = Problem.of(**columns(definition.grid, start, stop))
    return arrays_of(solve(problem, definition.x), definition.profiles)


def block_path(blocks: Blocks, i: int) -> Path:
    return blocks.folder / f"{i:05d}.nc"


def finished(blocks: Blocks) -> list[int]:
    """Numbers of the blocks on disk."""
    return [i for i in range(blocks.count) if block_path(blocks, i).exists()]


def store(blocks: Blocks, i: int, arrays: dict[str, np.ndarray]) -> None:
    """Write block i (main thread only)."""
    blocks.folder.mkdir(parents=True, exist_ok=True)
    write(
        xr.Dataset({name: (("row", "x")[: array.ndim], array) for name, array in arrays.items()}), block_path(blocks, i)
    )


def join(blocks: Blocks) -> tuple[dict[str, np.ndarray], list[int]]:
    """Arrays of the whole grid from the blocks on disk, and the numbers of the blocks that are not there.

    An unreadable block is deleted, so that the next run computes it again.
    """
    whole, absent = not_run(blocks.definition), []
    for i in range(blocks.count):
        start, stop = bounds(blocks, i)
        try:
            part = open_results(block_path(blocks, i))
            values = {name: part[name].values for name in whole}
            for name, array in whole.items():
                array[start:stop] = values[name]
        except (OSError, KeyError, ValueError):
            block_path(blocks, i).unlink(missing_ok=True)
            absent.append(i)
    return whole, absent


def discard(blocks: Blocks) -> None:
    """Remove the blocks of this definition, and the folder above when nothing else is in it."""
    shutil.rmtree(blocks.folder, ignore_errors=True)
    if blocks.folder.parent.is_dir() and not any(blocks.folder.parent.iterdir()):
        blocks.folder.parent.rmdir()
