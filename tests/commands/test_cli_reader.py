"""Nobody need hear what a command says: closed streams, readers that leave, full disks under them, terminals that obey.

The exit code says what became of the work.
"""

import contextlib
import io
import os
import subprocess
import sys
from pathlib import Path

import pytest
from children import PATIENCE, PROCESSES
from conftest import ROOT
from line_study import leftovers
from line_study import load as line
from test_cli import GOOD, studies  # noqa: F401

from study.__main__ import main
from study.api import load
from study.terminal import open_closed_streams, say
from study.work import progress
from study.work.progress import Progress

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="/dev/full, POSIX pipes")


@contextlib.contextmanager
def lines_to(target):
    """A stream of lines that cannot be written; it cannot be closed without an error either."""
    with contextlib.suppress(OSError), open(target, "w", buffering=1, encoding="utf-8") as stream:
        yield stream


def without_a_reader():
    """A stream of lines into a pipe that nobody reads any more."""
    inside, outside = os.pipe()
    os.close(inside)
    return lines_to(outside)


def full():
    return lines_to("/dev/full")


def closed():
    """As Python has a stream that was closed before it began."""
    return contextlib.nullcontext()


def said(capsys) -> set[str]:
    """Lines on stderr, but for those of the progress."""
    return {text for text in capsys.readouterr().err.splitlines() if " of 3 cases, " not in text}


# The command, and whether its answer is all that it is for.
COMMANDS = [
    ("list studies", True),
    ("point P=1e-5 base=half_space micro=smooth", True),
    ("check good other", True),
    ("status good other", True),
    ("run good other", False),
    ("retry good other --status converged", False),
    ("run good other --dry-run", True),
    ("plot good other", False),
    ("table table1 validity", False),
    ("tradeoff", False),
]


@pytest.mark.parametrize("lost", [without_a_reader, full, closed])
@pytest.mark.parametrize(("command", "answer"), COMMANDS, ids=[command for command, _ in COMMANDS])
def test_every_command_does_its_work_without_stdout(studies, lost, command, answer, monkeypatch, capsys):  # noqa: F811
    """And blames no file for it. What is asked for last is done as well."""
    from study import catalogue
    from study.figures import figure_results

    done = []
    (studies / "other.toml").write_text(GOOD, encoding="utf-8")
    for name in ("draw", "tabulate"):
        monkeypatch.setattr(catalogue, name, lambda given, *_: done.append(given) or [given])
    monkeypatch.setattr(figure_results, "results", lambda *_, **__: done.append("measured"))
    with lost() as out, monkeypatch.context() as patched:
        patched.setattr(sys, "stdout", out)
        code = main(command.split())
    unheard = "standard output cannot be written: No space left on device"
    assert said(capsys) == ({unheard} if lost is full else set())
    assert code == (1 if answer and lost is full else 0)
    if command.startswith(("plot", "table")):
        assert done == command.split()[1:3]
    if command == "tradeoff":
        assert done == ["measured"]
    if command in ("run good other", "retry good other --status converged"):
        assert [load(studies / f"{name}.toml").status()["state"] for name in ("good", "other")] == ["done", "done"]


def test_curves_are_drawn_though_nobody_hears_where(monkeypatch, capsys, studies):  # noqa: F811
    """As known figures are: what `plot` is for is the files."""
    from study import catalogue

    done = []
    monkeypatch.setattr(catalogue, "save", lambda stem, *_: done.append(stem.name) or [stem])
    with full() as out, monkeypatch.context() as patched:
        patched.setattr(sys, "stdout", out)
        code = main(["plot", "good", "--run", "--x", "P", "--y", "a"])
    assert (code, done) == (0, ["good_a"])
    assert said(capsys) == {"standard output cannot be written: No space left on device"}


@pytest.mark.parametrize("lost", [without_a_reader, full, closed])
def test_every_command_says_what_is_wrong_to_nobody(studies, lost, monkeypatch, capsys):  # noqa: F811
    (studies / "bad.toml").write_text("[", encoding="utf-8")
    for command in ("check bad good", "run bad good", "status bad good", "plot nothing"):
        with lost() as errors, monkeypatch.context() as patched:
            patched.setattr(sys, "stderr", errors)
            assert main(command.split()) == 2
    assert "results/good.nc: 3 cases, 3 computed now" in capsys.readouterr().out


@pytest.mark.parametrize("lost", [without_a_reader, full, closed])
def test_a_run_whose_progress_nobody_reads(studies, lost, monkeypatch, capsys):  # noqa: F811
    monkeypatch.setattr(progress, "EVERY", 0)
    with lost() as errors, monkeypatch.context() as patched:
        patched.setattr(sys, "stderr", errors)
        assert main(["run", "good", "--workers", "1"]) == 0
    assert capsys.readouterr().out == "results/good.nc: 3 cases, 3 computed now\n"


def test_a_reader_that_leaves_half_way(studies, monkeypatch, capsys):  # noqa: F811
    """It has read the first line of the progress; the lines after it go nowhere, and all is computed."""
    inside, outside = os.pipe()
    real, lines = Progress._write, []

    def write(self, now):
        real(self, now)
        if not lines:
            lines.append(os.read(inside, 100))
            os.close(inside)

    monkeypatch.setattr(progress, "EVERY", 0)
    monkeypatch.setattr(Progress, "_write", write)
    with open(outside, "w", encoding="utf-8") as errors, monkeypatch.context() as patched:
        patched.setattr(sys, "stderr", errors)
        assert main(["run", "good", "--workers", "1"]) == 0
    assert lines[0].startswith(b"good: 1 of 3 cases, 0 failed")
    assert capsys.readouterr().out == "results/good.nc: 3 cases, 3 computed now\n"


def test_progress_of_a_stream_that_its_owner_has_closed(tmp_path):
    opened, stream = line(tmp_path / "line.toml"), io.StringIO()
    stream.close()
    assert opened.run(workers=1, stream=stream).complete


@pytest.mark.parametrize(
    ("streams", "workers", "unbuffered"), [(">&- 2>&- <&-", 2, "1"), ("2>&1 | true", 1, "1"), ("2>&1 | true", 1, "")]
)
def test_a_shell_that_takes_the_streams_away(studies, streams, workers, unbuffered):  # noqa: F811
    """Worker processes inherit those of the run."""
    (studies / "many.toml").write_text(GOOD.replace("[1e-6, 2e-6, 3e-6]", "{start = 1, stop = 2, num = 8}"))
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHON": sys.executable, "PYTHONUNBUFFERED": unbuffered}
    command = f'{{ "$PYTHON" -m study run many --workers {workers}; echo $? > code; }} {streams}'
    subprocess.run(["sh", "-c", command], env=environment, timeout=PATIENCE, check=False)
    assert Path("code").read_text() == "0\n"
    assert load(studies / "many.toml").status()["state"] == "done" and leftovers(Path("results")) == ["many.nc"]


def _numbers_of_files(answers) -> None:
    for number in range(3):
        os.close(number)
    sys.stdin = sys.stdout = sys.stderr = None
    open_closed_streams()
    with open(os.devnull) as file:
        answers.put((file.fileno(), [os.get_inheritable(number) for number in range(3)]))
    print("not heard")
    print("not heard", file=sys.stderr)
    answers.put((sys.stdout.fileno(), sys.stdin.read()))


def test_no_file_takes_the_place_of_a_closed_stream():
    """HDF5 complains to number 2, which must not be a results file; worker processes inherit the three."""
    answers = PROCESSES.Queue()
    process = PROCESSES.Process(target=_numbers_of_files, args=(answers,))
    process.start()
    number, inherited = answers.get(timeout=PATIENCE)
    assert number > 2 and inherited == [True] * 3
    assert answers.get(timeout=PATIENCE) == (1, "")
    process.join(PATIENCE)
    assert process.exitcode == 0


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["check", "good"]], ids=str)
def test_nothing_is_said_as_the_process_ends(studies, arguments):  # noqa: F811
    command = [sys.executable, "-m", "study", *arguments]
    with without_a_reader() as out:
        environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}
        done = subprocess.run(command, stdout=out, stderr=subprocess.PIPE, text=True, env=environment)
    assert (done.returncode, done.stderr) == (0, "")


def test_what_a_terminal_would_obey_is_written_out():
    screen = io.StringIO()
    assert say("a\x1b[31m\x07\r\x9b2J\u202eb\tc\nd", screen) is None
    assert screen.getvalue() == "a\\x1b[31m\\x07\\r\\x9b2J\\u202eb\tc\nd\n"


@pytest.mark.parametrize(("encoding", "shown"), [("ascii", b"\\u03bc \\udcff\n"), ("utf-8", b"\xce\xbc \\udcff\n")])
def test_what_a_terminal_cannot_show_is_written_out(encoding, shown):
    """The second is a byte of a path that is not UTF-8."""
    raw = io.BytesIO()
    stream = io.TextIOWrapper(raw, encoding)
    assert say("μ \udcff", stream) is None
    assert raw.getvalue() == shown
