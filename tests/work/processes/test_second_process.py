"""A second process that takes tasks from the end, while the caller takes them from the front."""

import os
import time

import pytest

from study.work.second_process import SecondProcess


@pytest.fixture
def second(request):
    made = []

    def start(function, tasks):
        made.append(SecondProcess(function, tasks))
        return made[-1]

    yield start
    for one in made:
        one.end()


def test_each_task_is_done_once(second):
    """By the caller, or by the other process, which takes the last one first."""
    tasks = {str(i): (f"result {i}",) for i in range(30)}
    both, own = second(str, tasks), []
    while "29" not in both._taken:
        time.sleep(0.01)
    for name in tasks:
        result = both.result_of(name)
        own += [name] * (result is None)
        assert result in (None, f"result {name}")
    assert "29" not in own and own == [str(i) for i in range(len(own))], "the caller has those at the front"


def test_it_is_another_process(second):
    other = second(os.getpid, {"only": ()})
    while not other._taken:
        time.sleep(0.01)
    assert other.result_of("only") not in (None, os.getpid())


def test_the_caller_does_what_failed_there(second):
    failing = second(int, {"only": ("no number",)})
    while not failing._taken:
        time.sleep(0.01)
    assert failing.result_of("only") is None


def test_what_it_has_begun_ends_with_it(second):
    slow = second(time.sleep, {"only": (60,)})
    while not slow._taken:
        time.sleep(0.01)
    begun = time.monotonic()
    slow.end()
    assert slow.result_of("only") is None and time.monotonic() - begun < 20
