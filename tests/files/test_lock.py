"""The lock of a run: one at a time, shared by parts, released by death, never left behind on a file that is gone."""

import shutil
import signal
import threading

import pytest
from children import PATIENCE, PROCESSES

from study.files import lock
from study.files.lock import lock_file

pytestmark = pytest.mark.skipif(lock.fcntl is None, reason="POSIX locks")


@pytest.fixture
def path(tmp_path):
    return tmp_path / "folder" / "lock"


@pytest.mark.parametrize(
    ("first", "second", "free"), [(False, False, False), (True, False, False), (False, True, False), (True, True, True)]
)
def test_exclusive_and_shared(path, first, second, free):
    with lock_file(path, shared=first) as mine:
        assert mine
        with lock_file(path, shared=second, wait=False) as other:
            assert other == free
    with lock_file(path, shared=second, wait=False) as other:
        assert other


def hold(path, ready) -> None:
    with lock_file(path):
        ready.set()
        signal.pause()


def test_the_lock_of_a_killed_process_is_free(path):
    ready = PROCESSES.Event()
    process = PROCESSES.Process(target=hold, args=(path, ready))
    process.start()
    assert ready.wait(PATIENCE)
    with lock_file(path, wait=False) as mine:
        assert not mine
    process.kill()
    process.join()
    with lock_file(path, wait=False) as mine:
        assert mine


def test_who_waited_for_a_lock_that_was_removed_holds_the_one_that_is_there(path):
    waiting, acquired, release, said = threading.Event(), threading.Event(), threading.Event(), []

    def wait() -> None:
        said.append("waiting")
        waiting.set()

    def second():
        with lock_file(path, waiting=wait) as mine:
            assert mine
            acquired.set()
            release.wait(PATIENCE)

    with lock_file(path):
        thread = threading.Thread(target=second)
        thread.start()
        assert waiting.wait(PATIENCE)
        shutil.rmtree(path.parent)
    assert acquired.wait(PATIENCE)
    with lock_file(path, wait=False) as third:
        assert not third
    release.set()
    thread.join()
    assert said == ["waiting"]
    with lock_file(path, waiting=wait) as mine:
        assert mine and said == ["waiting"], "there is nothing to wait for"


def test_a_file_system_without_locks_counts_as_free(path, monkeypatch):
    def flock(*_):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(lock.fcntl, "flock", flock)
    with lock_file(path) as mine, lock_file(path, wait=False) as other:
        assert mine and other
