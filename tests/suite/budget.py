"""What each room of the tests costs in processor seconds, children included; `make test` holds it to tests/budget.toml.

A room is a folder of tests/; "examples" are those in docstrings. How slow a machine is, a fixed piece of numpy tells,
timed in the same run: the rows of the table are for a machine on which it takes `piece` seconds.
"""

import json
import resource
import statistics
import time
import tomllib
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

TABLE = Path(__file__).resolve().parents[1] / "budget.toml"
ABOVE = 1.5  # times its row that a room may take
LEAST = 3.0  # seconds that a room may take besides: what is loaded once counts for the room that asks first
WITHOUT_CORE = 1.5  # times its row that a room may take more without the compiled core: `inverse` took 1.7 of its row
OFTEN = 15.0  # seconds between two timings of the piece in one process


def spent() -> float:
    """Processor seconds of this process so far, and of its children that have ended."""
    uses = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(use.ru_utime + use.ru_stime for use in uses)


def piece() -> float:
    """Processor seconds of a fixed piece of numpy and Python, like what the tests run."""
    matrices = np.eye(17) + np.linspace(0.0, 0.1, 200 * 17 * 17).reshape(200, 17, 17)
    begun = time.process_time()
    for _ in range(4):
        np.linalg.solve(matrices, matrices)
        np.exp(np.cos(np.linspace(0.0, 9.0, 50_000)))
        sum(i * i for i in range(30_000))
    return time.process_time() - begun


def room(node: str) -> str:
    """The room of a test, by the name that pytest gives it."""
    parts = node.partition("::")[0].split("/")
    return parts[1] if parts[0] == "tests" and len(parts) > 2 else "examples"


class Clock:
    """Plugin of the processes that run tests: each report carries the seconds since the one before it."""

    def __init__(self):
        self.before, self.last = spent(), -OFTEN

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item):
        """What was spent before the first test is of no room: on a clean tree it is imports and the collection."""
        self.before = self.before if self.last > 0 else spent()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item, call):
        report = yield
        report.processor, self.before = spent() - self.before, spent()
        if call.when == "teardown" and time.monotonic() - self.last > OFTEN:
            report.piece, self.last, self.before = piece(), time.monotonic(), spent()
        return report


class Budget:
    """Plugin of the process that prints: adds the seconds up, shows the dearest rooms, fails where one is too dear."""

    def __init__(self, file: str | None):
        self.file, self.tests, self.pieces, self.above = file, defaultdict(float), [], []

    def pytest_runtest_logreport(self, report):
        self.tests[report.nodeid] += getattr(report, "processor", 0.0)
        self.pieces += [report.piece] if hasattr(report, "piece") else []

    def rooms(self) -> dict[str, float]:
        """Seconds of each room, the dearest first."""
        rooms = defaultdict(float)
        for node, seconds in self.tests.items():
            rooms[room(node)] += seconds
        return dict(sorted(rooms.items(), key=lambda item: -item[1]))

    def pytest_sessionfinish(self, session):
        if not self.tests:
            return
        table, rooms = tomllib.loads(TABLE.read_text()), self.rooms()
        self.slower = max(1.0, statistics.median(self.pieces) / table["piece"]) if self.pieces else 1.0
        from solver.compiled.library import available  # here: what is imported before the tests is in no room

        self.above = too_dear(rooms, table["rooms"], self.slower * (1.0 if available() else WITHOUT_CORE))
        if self.above and session.exitstatus == pytest.ExitCode.OK:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED
        if self.file:
            Path(self.file).write_text(
                json.dumps({"pieces": self.pieces, "rooms": rooms, "tests": self.tests}, indent=1)
            )

    def pytest_terminal_summary(self, terminalreporter):
        rooms = self.rooms()
        if rooms:
            dearest = ", ".join(f"{name} {seconds:.0f}" for name, seconds in list(rooms.items())[:5])
            terminalreporter.write_line(
                f"{sum(rooms.values()):.0f} s of processor time, on a machine {self.slower:.2f} times as slow as that "
                f"of tests/budget.toml; the dearest rooms: {dearest}"
            )
        for line in self.above:
            terminalreporter.write_line(line, red=True)


def too_dear(rooms: dict[str, float], table: dict[str, float], slower: float) -> list[str]:
    """A sentence for each room that took more than ABOVE times its row and LEAST more seconds."""
    lines = []
    for name, seconds in rooms.items():
        most = slower * (ABOVE * table.get(name, 0.0) + LEAST)
        if seconds > most:
            row = f"its row in {TABLE.name} allows" if name in table else "a room that has no row there may take"
            lines.append(f"BUDGET: the room {name} took {seconds:.1f} s of processor time; {row} {most:.1f} s here")
    return lines


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("budget")
    group.addoption("--budget", action="store_true", help="hold each room to its row in tests/budget.toml")
    group.addoption("--verify", action="store_true", help="all tests, also those in tests/verify.txt")
    group.addoption("--times", metavar="FILE", help="write the processor seconds of every test to a JSON file")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("budget") or config.getoption("times"):
        config.pluginmanager.register(Clock())
        if not hasattr(config, "workerinput"):  # of pytest-xdist
            config.pluginmanager.register(Budget(config.getoption("times")))
