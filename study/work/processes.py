"""Worker processes of one machine, each fed by a thread of the process that runs the study.

They are ours and no `dask.distributed.LocalCluster`, which starts 2.5 s later: first answers of two workers after 2.0 s
against 4.5 s, means of three in alternation on two processors that others used too. With a run of 100,000 thin rough
cases and the two starts it takes 11.5 s against 18.1 s of processor time, and a run twice as much with dask's own
settings, which make workers give memory back after each block. `python tests/benchmark_engine.py 3 100` measures it.
Dask's own process scheduler is a pool of `concurrent.futures` inside: it holds all results in memory, and one killed
process ends it.
"""

import os
import pickle
import subprocess
import sys
import threading
import traceback
from collections.abc import Callable
from contextlib import suppress
from queue import Empty, SimpleQueue

from ..files.apart import python
from .cases import Failure

#: Times that a block is tried before it is given up: a process may be killed for the memory that others take, but a
#: block that is itself too large for the machine must not kill processes for ever.
ATTEMPTS = 3
KILLED = f"the process that computed it was killed, {ATTEMPTS} times, perhaps for want of memory"
#: Seconds after which a process ends that nobody gives a task, with its memory: it is started again when there is one.
IDLE = 60
SERVE = "from study.work.processes import serve; serve()"


class Processes:
    """A process of its own for each thread that calls; it is started at the first call, and again when it is killed."""

    def __init__(self):
        self._mine = threading.local()
        self._all: list[subprocess.Popen] = []
        self._changing = threading.Lock()
        self._ended = False

    def call(self, function: Callable, *given) -> object:
        """function(*given), computed in the process of this thread; Failure when that was killed ATTEMPTS times."""
        task = pickle.dumps((function, given))
        for _ in range(ATTEMPTS):
            try:
                process = self._mine.process = getattr(self._mine, "process", None) or self._started()
                pickle.dump(task, process.stdin)
                process.stdin.flush()
                return pickle.load(process.stdout)
            except (EOFError, OSError, pickle.UnpicklingError):  # nobody reads, nobody writes, or only a part
                self._mine.process = None
        return Failure(KILLED, "")

    def end(self) -> None:
        """End all processes, whatever they compute."""
        with self._changing:
            self._ended = True
        for process in self._all:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                with suppress(OSError):  # of what was written and nobody has read
                    pipe.close()

    def _started(self) -> subprocess.Popen:
        """A new process, in a group of its own: Ctrl-C in a terminal is for the process that runs the study alone."""
        command, environment = python(SERVE)
        with self._changing:
            if self._ended:
                raise EOFError
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
            self._all.append(subprocess.Popen(command, env=environment, process_group=0, **pipes))
            return self._all[-1]


def serve() -> None:
    """What a worker process does: read pairs (function, its arguments) from stdin, write the results to stdout.

    It ends when stdin is closed, which the system does however the process that runs the study ends, or without tasks.
    """
    tasks, answers = SimpleQueue(), os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what a library prints is no answer

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
            function, given = pickle.loads(task)
            found = function(*given)
        except Exception as error:  # of a function, say, that is not defined here
            found = Failure(f"{type(error).__name__}: {error}", traceback.format_exc())
        pickle.dump(found, answers)
        answers.flush()
