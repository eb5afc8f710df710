"""A dask scheduler and its workers as processes of this machine, which tests kill."""

import asyncio
import multiprocessing
import os
import re
import sys
from pathlib import Path

import pytest
from children import PATIENCE, holding, started, wait_for
from interrupted_study import CASES

from study.work import cases

distributed = pytest.importorskip("distributed")


class Cluster:
    """A scheduler and workers, processes of this machine that have imported everything: what the commands of dask
    start, which the walk-through does start by them."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.file = folder / "scheduler.json"
        self.processes = []
        self.start({"scheduler_file": str(self.file), "port": 0}, "Scheduler", {})

    def start(self, options: dict, kind: str, environment: dict[str, str]) -> multiprocessing.Process:
        self.processes.append(started(_serve, kind, options, environment, self.folder / "cluster.log"))
        return self.processes[-1]

    def worker(self, first: int = CASES, numerics: str = "") -> multiprocessing.Process:
        """Start a worker that holds its blocks from case `first` on until folder/go is there.

        numerics : the version that it has in place of ours
        """
        environment = holding(self.folder, first) | ({"OTHER_NUMERICS": numerics} if numerics else {})
        return self.start({"scheduler_ip": self.address, "nthreads": 1}, "Worker", environment)

    def wait_for_workers(self, count: int) -> list[str]:
        """The addresses of the workers, when there are so many."""
        with distributed.Client(self.address, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=PATIENCE)
            return list(client.nthreads())

    @property
    def address(self) -> str:
        wait_for(lambda: self.file.exists() and self.file.stat().st_size > 0)  # the file exists before the address
        return re.search(r'"address": "(tcp://[^"]+)"', self.file.read_text())[1]

    def stop(self) -> None:
        for process in self.processes:
            process.kill()
            process.join()


def _serve(kind: str, options: dict, environment: dict[str, str], log: Path) -> None:
    """Be a scheduler or a worker until killed."""
    os.environ |= environment
    os.dup2(os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND), sys.stderr.fileno())
    if environment:
        import hold  # noqa: F401
    if "OTHER_NUMERICS" in environment:
        cases.NUMERICS_VERSION = environment["OTHER_NUMERICS"]

    async def serve():
        async with getattr(distributed, kind)(host="127.0.0.1", dashboard=False, **options) as served:
            await served.finished()

    asyncio.run(serve())
