"""Worker processes of one machine, each fed by a thread of the process that runs the study.

`dask.distributed.LocalCluster` is not used: a run of 100,000 thin rough cases takes 1.3 to 1.6 times as long with it
(`python tools/bench/benchmark_engine.py 3 100`, three runs by turns on 2 busy processors). Nor is the process scheduler
of dask, a pool of `concurrent.futures`: it holds all results in memory, and one killed process ends it.
"""

import os
import pickle
import subprocess
import sys
import threading
import traceback
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue

from .cases import Failure

#: Number of tries of a block. A process may be killed because others use up the memory, so one try is too few. A block
#: may itself be too large, so it must not be tried for ever.
ATTEMPTS = 3
KILLED = f"the process that computed it was killed {ATTEMPTS} times, perhaps because memory ran out"
#: Seconds after which a process without a task ends, and frees its memory. It is started again for the next task.
IDLE = 60
SERVE = "from study.work.processes import serve; serve()"


def python_command(statement: str) -> tuple[list[str], dict[str, str]]:
    """Command and environment of a Python process that executes a statement and can import this package.

    The process searches the working folder for modules last, because a user may have a solver.py there.
    """
    where = os.pathsep.join(filter(None, [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH")]))
    command = [sys.executable, "-P", "-c", f"import sys; sys.path.append(''); {statement}"]
    return command, os.environ | {"PYTHONPATH": where}


class Processes:
    """A process for each calling thread. It is started at the first call, and again after it has ended."""

    def __init__(self):
        self._mine = threading.local()
        self._all: list[subprocess.Popen] = []
        self._changing = threading.Lock()
        self._ended = False

    def call(self, function: Callable, *arguments) -> object:
        """function(*arguments), computed in the process of this thread; Failure if it was killed ATTEMPTS times."""
        task = pickle.dumps((function, arguments))
        for _ in range(ATTEMPTS):
            try:
                process = self._mine.process = getattr(self._mine, "process", None) or self._started()
                pickle.dump(task, process.stdin)
                process.stdin.flush()
                return pickle.load(process.stdout)
            except (EOFError, OSError, ValueError, pickle.UnpicklingError):
                self._mine.process = None  # the process has ended, or `end` has closed its pipe
        return Failure(KILLED, "")

    def end(self) -> None:
        """End all processes, whatever they compute."""
        with self._changing:
            self._ended = True
        for process in self._all:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                with suppress(OSError):  # the pipe holds data that nobody has read
                    pipe.close()

    def _started(self) -> subprocess.Popen:
        """A new process. It has a group of its own, so that Ctrl-C in a terminal does not reach it."""
        command, environment = python_command(SERVE)
        with self._changing:
            if self._ended:
                raise EOFError
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
            self._all.append(subprocess.Popen(command, env=environment, process_group=0, **pipes))
            return self._all[-1]


class Threads:
    """In place of processes, for one call: threads that solve blocks themselves."""

    def reuse(self, most: int) -> int:
        """Number of threads that can begin at once: all of them, since a thread needs no start."""
        return most

    def feed(self, feeder: Callable, count: int) -> list[Future]:
        """Start feeder(call) in `count` threads. There, call(function, task) computes in the thread itself."""
        threads = ThreadPoolExecutor(count)
        futures = [threads.submit(feeder, lambda function, task: function(task)) for _ in range(count)]
        threads.shutdown(wait=False)  # each ends after its last block
        return futures

    def end(self) -> None:
        """Do nothing: waiting tasks are taken away from the feeders, and blocks that have begun are solved to the
        end."""


def serve() -> None:
    """Work as a worker process: read pairs (function, its arguments) from stdin, write the results to stdout.

    The process ends after IDLE seconds without a task, or when stdin is closed. The system closes stdin when the
    process that runs the study ends, in whatever way.
    """
    tasks, answers = SimpleQueue(), os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what a library prints must not be among the answers

    def receive() -> None:
        try:
            while True:
                tasks.put(pickle.load(sys.stdin.buffer))
        finally:
            os._exit(1)

    threading.Thread(target=receive, daemon=True).start()
    while True:
        try:
            task = tasks.get(timeout=IDLE)
        except Empty:
            os._exit(0)
        try:
            function, arguments = pickle.loads(task)
            result = function(*arguments)
        except Exception as error:  # the function is not defined in this process, say
            result = Failure(f"{type(error).__name__}: {error}", traceback.format_exc())
        pickle.dump(result, answers)
        answers.flush()
