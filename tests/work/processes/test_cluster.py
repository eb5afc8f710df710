"""More than one machine: workers and schedulers that die."""

import random
import socket
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from threading import Thread

import pytest
from children import PATIENCE, PROCESSES, held, joined, stored, wait_for
from clusters import Cluster, distributed
from interrupted_study import BLOCK, CASES, TEXT, assert_ends_well, cases_on_disk, written
from same import assert_same_numbers

import study
from study.work import cases, engine
from study.work import cluster as engines
from study.work.scheduler import address_error


@pytest.fixture
def cluster(tmp_path):
    found = Cluster(tmp_path)
    yield found
    found.stop()


def run_on(address: str, file: Path, results: Path, answers) -> None:
    """In a process of its own: run the study on the cluster, answer with the exit code and what was said."""
    import contextlib
    import io

    from study.__main__ import main

    engines.CONNECT = engines.ANSWER = PATIENCE
    engines.CHECK_INTERVAL = 0.1

    with contextlib.redirect_stderr(io.StringIO()) as errors:
        code = main(["run", str(file), "--results", str(results), "--scheduler", address])
    answers.put((code, errors.getvalue()))


def started(cluster: Cluster, opened: study.Study, tmp_path: Path):
    """A run on the cluster in a process of its own, and the queue of its answer."""
    answers = PROCESSES.Queue()
    arguments = (cluster.address, tmp_path / "line.toml", opened.results, answers)
    process = PROCESSES.Process(target=run_on, args=arguments)
    process.start()
    return process, answers


def test_a_killed_worker_costs_its_blocks_only(cluster, tmp_path, undisturbed):
    opened = written(tmp_path)
    workers = [cluster.worker(50), cluster.worker(50)]
    process, answers = started(cluster, opened, tmp_path)
    wait_for(lambda: len(held(tmp_path)) == 2)
    workers[0].kill()
    (tmp_path / "go").touch()
    joined(process)
    code, errors = answers.get(timeout=PATIENCE)
    assert code == 0, errors
    assert_ends_well(opened, undisturbed, 0)


def test_a_killed_scheduler_costs_nothing_that_is_on_disk(cluster, tmp_path, undisturbed):
    opened = written(tmp_path)
    cluster.worker(3 * BLOCK)
    process, answers = started(cluster, opened, tmp_path)
    wait_for(lambda: stored(tmp_path) == 3)
    cluster.processes[0].kill()
    joined(process)
    code, errors = answers.get(timeout=PATIENCE)
    assert code == 1
    said = "line.toml: the scheduler is gone; finished blocks are kept, and the same command continues from there\n"
    assert errors.endswith(said)
    assert cases_on_disk(opened) == set(range(3 * BLOCK))
    assert_ends_well(opened, undisturbed, CASES - 3 * BLOCK)


@contextmanager
def listening(first_words: bytes):
    """The address of somebody who says something else than a scheduler to each who calls, or nothing."""

    def answer():
        with suppress(OSError):  # the server has been closed
            while True:
                calls.append(server.accept()[0])
                calls[-1].sendall(first_words)

    calls, server = [], socket.create_server(("127.0.0.1", 0))
    thread = Thread(target=answer)
    thread.start()
    yield f"127.0.0.1:{server.getsockname()[1]}"
    server.shutdown(socket.SHUT_RDWR)
    thread.join()
    for each in (server, *calls):
        each.close()


def refused(opened, address: str) -> str:
    """Why a scheduler is refused, in one line, with nothing computed."""
    with pytest.raises(study.StudyError) as caught:
        opened.run(scheduler=address)
    (message,) = caught.value.messages
    assert message.startswith(f"--scheduler {address}: ") and "\n" not in message
    assert cases_on_disk(opened) == set()
    return message.removeprefix(f"--scheduler {address}: ")


@pytest.mark.parametrize("scheme", ["tcp://", ""])
@pytest.mark.parametrize(
    ("words", "why"), [(b"SSH-2.0-OpenSSH_9\r\n", "something else listens there"), (b"", "it does not answer within")]
)
def test_a_port_that_is_not_dask(tmp_path, monkeypatch, words, why, scheme):
    monkeypatch.setattr(engines, "ANSWER", PATIENCE if words else 0.5)
    opened = written(tmp_path)
    with listening(words) as address:
        assert f"no scheduler answers there ({why}" in refused(opened, scheme + address)


ABSENT = {
    "tcp://127.0.0.1:1": "no scheduler answers there (Timed out",
    "tcp://nowhere.invalid:8786": "no scheduler answers there (nowhere.invalid: ",
    "tls://127.0.0.1:1": "no scheduler answers there (TLS needs certificates, ",
    "nonsense": "must be the address of a dask scheduler",
    "": "must be the address of a dask scheduler",
}


def test_a_scheduler_that_is_not_there(tmp_path, monkeypatch, undisturbed):
    monkeypatch.setattr(engines, "CONNECT", 0.5)
    opened = written(tmp_path)
    for address, why in ABSENT.items():
        assert why in refused(opened, address)
    assert_ends_well(opened, undisturbed, CASES)


def test_random_blocks_and_orders_on_a_cluster(cluster, tmp_path, undisturbed):
    """Blocks of random size, axes in another order; the second worker comes while the run is on."""
    cluster.worker(60)
    text = TEXT.replace("[0.001, 0.002, 0.003]", "[0.003, 0.001, 0.002]")
    opened = written(tmp_path, text.replace(f"block = {BLOCK}", f"block = {random.randint(3, 60)}"))
    process, answers = started(cluster, opened, tmp_path)
    wait_for(lambda: held(tmp_path))
    cluster.worker()
    cluster.wait_for_workers(2)
    (tmp_path / "go").touch()
    joined(process)
    assert answers.get(timeout=PATIENCE)[0] == 0
    assert_same_numbers(opened.open().sel(h=undisturbed.h), undisturbed)


def test_a_block_that_raises_on_a_worker_costs_that_block_only(cluster, tmp_path, monkeypatch, undisturbed):
    cluster.worker()
    opened = written(tmp_path)
    real = engine.parcel

    def parcel(definition, index):
        found = real(definition, index)
        return found if found.first != 50 else replace(found, numerics="another")

    monkeypatch.setattr(engine, "parcel", parcel)
    report = opened.run(scheduler=cluster.address)
    monkeypatch.undo()
    ((_, reason),) = report.failures.items()
    assert reason.startswith("cases 50 to 54: RuntimeError: the worker has version")
    assert report.computed == CASES - BLOCK
    assert_ends_well(opened, undisturbed, BLOCK)


def test_blocks_that_a_worker_of_another_version_refuses_go_elsewhere(cluster, tmp_path, undisturbed):
    """71 of 72 blocks failed: a worker that refuses is the first to be idle again."""
    cluster.worker(numerics="22")
    (other,) = cluster.wait_for_workers(1)
    cluster.worker(0)
    good = {*cluster.wait_for_workers(2)} - {other}
    opened = written(tmp_path)
    process, answers = started(cluster, opened, tmp_path)
    wait_for(lambda: held(tmp_path))
    (tmp_path / "go").touch()
    joined(process)
    code, errors = answers.get(timeout=PATIENCE)
    assert code == 0, errors
    said = f"the worker {other} has version 22 of the numerics, not {cases.NUMERICS_VERSION}: it is left out"
    assert errors.count(said) == 1 and not any(each in errors for each in good)
    assert_ends_well(opened, undisturbed, 0)


def test_only_workers_of_other_versions(cluster, tmp_path, undisturbed):
    for numerics in ("21", "22"):
        cluster.worker(numerics=numerics)
    workers, opened = cluster.wait_for_workers(2), written(tmp_path)
    process, answers = started(cluster, opened, tmp_path)
    joined(process)
    code, errors = answers.get(timeout=PATIENCE)
    assert code == 1 and all(f"the worker {worker} has version 2" in errors for worker in workers)
    assert "cases 0 to 4: RuntimeError: the worker has version 2" in errors
    assert_ends_well(opened, undisturbed, CASES)


def test_blocks_wait_for_no_worker_that_is_gone_when_another_is_left_out(cluster, tmp_path, undisturbed):
    """They are to be computed by the good worker alone; a new one comes, and it is killed."""
    cluster.worker(numerics="22")
    cluster.wait_for_workers(1)
    few = TEXT.replace(f"block = {BLOCK}", "block = 50")  # all are under way at once: none is submitted later
    good, opened = cluster.worker(0), written(tmp_path, few)
    cluster.wait_for_workers(2)
    process, answers = started(cluster, opened, tmp_path)
    wait_for(lambda: held(tmp_path) and "out-of-band" in (tmp_path / "cluster.log").read_text())  # both have been asked
    cluster.worker()
    cluster.wait_for_workers(3)
    good.kill()
    joined(process)
    code, errors = answers.get(timeout=PATIENCE)
    assert code == 0 and errors.count("it is left out") == 1, errors
    assert_same_numbers(opened.open(), undisturbed)


def test_a_block_whose_worker_is_lost_when_it_is_here_has_not_failed(monkeypatch):
    with distributed.Client(n_workers=1, processes=False, dashboard_address=":0", set_as_default=False) as client:
        gather = client._gather

        async def lost(futures, *arguments, **more):
            found = await gather(futures, *arguments, **more)
            futures[0]._state.lose()
            return found

        monkeypatch.setattr(client, "_gather", lost)
        monkeypatch.setattr(engines, "connected", lambda *_: client)
        found = engines.computed_on_cluster("any", None, str.split, ["one two"])
        assert list(found) == [(0, ["one", "two"])]


ADDRESSES = {"tcp://127.0.0.1:1": True, "host:65535": True, "tls://[::1]:8786": True, "inproc://10.0.0.1/7/1": True}
ADDRESSES |= dict.fromkeys(("host", "host:0", "host:65536", "tcp://host:99999", "http://host:1", "tcp://:1"), False)


@pytest.mark.parametrize(("address", "allowed"), ADDRESSES.items())
def test_forms_of_an_address(address, allowed):
    assert (address_error(address) == "") == allowed
