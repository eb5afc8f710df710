"""A second process that takes tasks from the end of a list, while the caller takes tasks from the front."""

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from .cases import Failure
from .processes import Processes


class SecondProcess:
    """Tasks `function(*arguments)` in order, by name. The process starts with the last task, and ends with the caller,
    or when `end` is called.

    Like the processes of `study.work.processes`, it imports this package and not the calling program.
    """

    def __init__(self, function: Callable, tasks: dict[str, tuple]):
        self._function, self._waiting, self._taken = function, dict(tasks), dict[str, Future]()
        self._changing, self._processes = threading.Lock(), Processes()
        threading.Thread(target=self._work, daemon=True).start()

    def _work(self) -> None:
        while True:
            with self._changing:
                if not self._waiting:
                    return
                name, arguments = self._waiting.popitem()
                future = self._taken[name] = Future()
            try:
                result = self._processes.call(self._function, *arguments)
            except Exception as error:  # the process cannot be started, say
                result = Failure(str(error), "")
            future.set_result(result)

    def result_of(self, name: str) -> Any:
        """The result of a task that the second process has begun, once it is done.

        None if the process has not begun the task, or has failed: then the caller does it. The process will not begin
        it.
        """
        with self._changing:
            self._waiting.pop(name, None)
            future = self._taken.pop(name, None)
        result = future.result() if future else None
        return None if isinstance(result, Failure) else result

    def end(self) -> None:
        """End the process, whatever it computes."""
        with self._changing:
            self._waiting.clear()
        self._processes.end()
