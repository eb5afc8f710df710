"""A reader that leaves, `head` say, ends a command quietly."""

import os
import subprocess
import sys

import pytest
from conftest import ROOT
from test_cli import studies  # noqa: F401

from study import progress
from study.__main__ import main
from study.api import load

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX pipes")


def without_a_reader():
    """A stream of lines into a pipe that nobody reads any more."""
    inside, outside = os.pipe()
    os.close(inside)
    return open(outside, "w", buffering=1, encoding="utf-8")


@pytest.fixture
def said(tmp_path, monkeypatch):
    """What a command without a reader says on stderr, but for its progress; `main` redirects the streams themselves."""
    with open(tmp_path / "errors", "w", encoding="utf-8") as errors:
        monkeypatch.setattr(sys, "stderr", errors)
        yield lambda: [line for line in (tmp_path / "errors").read_text().splitlines() if " of 3 cases, " not in line]


COMMANDS = [
    ("list studies", 0),
    ("check good other", 0),
    ("status good other", 0),
    ("run good other", 130),  # the other has not been computed
    ("retry good other --status diverged", 130),
    ("run good other --dry-run", 130),
    ("plot good other", 0),
    ("table good other", 0),
    ("tradeoff", 0),
]


@pytest.mark.parametrize(("command", "code"), COMMANDS, ids=[command for command, _ in COMMANDS])
def test_every_command_ends_quietly(studies, command, code, monkeypatch, said):  # noqa: F811
    from study import recipes, tables, tradeoff, tradeoff_page

    (studies / "other.toml").write_text("not asked for [", encoding="utf-8")
    for module, name in ((recipes, "draw"), (tables, "tabulate")):
        monkeypatch.setattr(module, name, lambda given, *_: [given] if given == "good" else 1 / 0)
    monkeypatch.setattr(tradeoff, "results", lambda *_, **__: None)
    monkeypatch.setattr(tradeoff_page, "page", lambda _: "a page")
    with without_a_reader() as out, monkeypatch.context() as patched:
        patched.setattr(sys, "stdout", out)
        assert main(command.split()) == code
    assert said() == []


def test_what_is_complete_is_complete_though_nobody_reads_its_last_line(studies, monkeypatch, said):  # noqa: F811
    with without_a_reader() as out, monkeypatch.context() as patched:
        out.reconfigure(line_buffering=False)
        patched.setattr(sys, "stdout", out)
        assert main(["run", "good"]) == 0
    assert said() == []
    assert load(studies / "good.toml").status()["state"] == "done"


def test_nobody_reads_the_progress(studies, monkeypatch):  # noqa: F811
    monkeypatch.setattr(progress, "EVERY", 0)
    with without_a_reader() as errors, open(os.devnull, "w") as out, monkeypatch.context() as patched:
        patched.setattr(sys, "stdout", out)
        patched.setattr(sys, "stderr", errors)
        assert main(["run", "good", "--workers", "1"]) == 130
    assert load(studies / "good.toml").status()["counts"] == {0: 1, 127: 2}, "what was computed is kept"


@pytest.mark.parametrize("arguments", [["--help"], ["check", "good"]], ids=str)
def test_nothing_is_said_as_the_process_ends(studies, arguments):  # noqa: F811
    command = [sys.executable, "-m", "study", *arguments]
    with without_a_reader() as out:
        environment = os.environ | {"PYTHONPATH": str(ROOT)}
        done = subprocess.run(command, stdout=out, stderr=subprocess.PIPE, text=True, env=environment)
    assert (done.returncode, done.stderr) == (0, "")
