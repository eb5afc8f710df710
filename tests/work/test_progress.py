"""The progress line: what it says, when it is written, and that it fits the terminal."""

import io
import os

import pytest

from study.work import progress
from study.work.progress import Progress, columns, describe, duration


class Terminal(io.StringIO):
    """A terminal that does not know its width."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch) -> list[float]:
    """The time in seconds, which stands still, before a terminal that can erase a line."""
    monkeypatch.setenv("TERM", "xterm")
    now = [1000.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    return now


def begun(name: str, total: int, stream, done: int = 0) -> Progress:
    """Progress that begins at the time at which the clock stands."""
    return Progress(name, total, stream, done, begun=1000.0, written=1000.0)


def test_on_a_terminal_it_is_one_line_rewritten_ten_times_a_second(clock):
    screen = Terminal()
    shown = begun("fig04", 20, screen, done=4)
    for seconds, cases, failed in ((0.09, 3, 1), (0.02, 3, 1), (0.05, 3, 0), (0.01, 7, 0)):
        clock[0] += seconds
        shown.update(cases, failed)
    shown.close()
    assert screen.getvalue() == (
        "\r\x1b[Kfig04: 10 of 20 cases, 2 failed, 54.5/s, 0 s left"  # 6 in 0.11 s; before and after it was too soon
        "\r\x1b[Kfig04: 20 of 20 cases, 2 failed, 94.1/s\n"  # 16 in 0.17 s; the last is always written
    )


@pytest.mark.parametrize("stream", [io.StringIO, Terminal], ids=["file", "terminal that cannot erase"])
def test_elsewhere_it_is_a_plain_line_every_ten_seconds_and_at_the_end(clock, monkeypatch, stream):
    monkeypatch.setenv("TERM", "dumb")
    log = stream()
    shown = begun("fig04", 100, log)
    for _ in range(100):
        clock[0] += 0.25
        shown.update(1, failed=0)
    shown.close()
    assert log.getvalue().splitlines() == [
        "fig04: 40 of 100 cases, 0 failed, 4/s, 15 s left",
        "fig04: 80 of 100 cases, 0 failed, 4/s, 5 s left",
        "fig04: 100 of 100 cases, 0 failed, 4/s",
    ]


def test_a_run_that_computes_nothing_leaves_the_terminal_alone():
    screen = Terminal()
    Progress("fig04", 20, screen, done=20).close()
    assert screen.getvalue() == ""


def test_nothing_is_written_after_the_end(clock):
    """The thread that says how far it is may wake up once more, after an interrupt."""
    screen = Terminal()
    shown = Progress("solving", 20, screen, begun=1000.0, passing=True)
    shown.tell()
    shown.close()
    clock[0] += 100
    shown.tell()
    assert screen.getvalue() == "\r\x1b[Ksolving: 0 s\r\x1b[K"


def test_without_a_stream_nothing_is_written():
    shown = Progress("fig04", 20, None)
    shown.update(20, failed=20)
    shown.close()
    assert (shown.done, shown.failed) == (20, 20)


def test_rate_and_time_left_count_only_what_is_computed_now():
    line = describe("s", done=600, total=1000, failed=3, computed=100, seconds=10)
    assert line == "s: 600 of 1000 cases, 3 failed, 10/s, 40 s left"
    assert describe("s", done=500, total=1000, failed=0, computed=0, seconds=0) == "s: 500 of 1000 cases, 0 failed, 0/s"


def test_durations():
    given = {0.4: "0 s", 59.4: "59 s", 59.6: "1 min 0 s", 200: "3 min 20 s", 3599.4: "59 min 59 s"}
    given |= {3600: "1 h 0 min", 7559: "2 h 5 min", 360000: "100 h 0 min"}
    assert {seconds: duration(seconds) for seconds in given} == given


LONG = {"name": "parameter_map", "done": 12000, "total": 25000, "failed": 3, "computed": 8000, "seconds": 77}


@pytest.mark.parametrize(
    ("width", "line"),
    [
        (None, "parameter_map: 12000 of 25000 cases, 3 failed, 104/s, 2 min 5 s left"),
        (68, "parameter_map: 12000 of 25000 cases, 3 failed, 104/s, 2 min 5 s left"),
        (67, "parameter_map: 12000 of 25000 cases, 3 failed, 2 min 5 s left"),
        (60, "parameter_map: 48 %, 3 failed, 2 min 5 s left"),
        (44, "parameter_map: 48 %, 2 min 5 s left"),
        (34, "parameter_map: 48 %"),
        (18, "parameter_ma: 48 %"),
        (6, ": 48 %"),
        (5, "48 %"),
    ],
)
def test_a_narrow_terminal_gets_what_matters_most(width, line):
    assert describe(**LONG, width=width) == line


def test_a_share_is_100_only_at_the_end():
    assert describe("s", done=999, total=1000, failed=0, computed=0, seconds=0, width=9) == "s: 99 %"


def screen_of(text: str, width: int) -> list[str]:
    """The lines of a terminal on which `text` was written; at its edge a line goes on in the next one."""
    lines, column = [""], 0
    for sign in text.replace("\x1b[K", "\0"):
        if sign == "\r":
            column = 0
        elif sign == "\0":
            lines[-1] = lines[-1][:column]
        else:
            if sign == "\n" or column == width:
                lines.append("")
                column = 0
            if sign != "\n":
                lines[-1] = lines[-1][:column] + sign + lines[-1][column + 1 :]
                column += 1
    return lines


@pytest.mark.skipif(os.name == "nt", reason="POSIX terminals")
def test_nothing_is_left_over_on_a_terminal_of_any_width(clock):
    import fcntl
    import struct
    import termios

    inside, outside = os.openpty()
    with open(outside, "w", encoding="utf-8") as stream:
        for width in range(9, 100):
            fcntl.ioctl(outside, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
            clock[0], text = 1000.0, ""
            shown = begun("parameter_map_of_coatings", 25000, stream)
            for _ in range(3):
                clock[0] += 123.4
                shown.update(8000, failed=3)
            shown.update(1000, failed=0)
            shown.close()
            stream.flush()
            while not text.endswith("\n"):
                text += os.read(inside, 10_000).decode()
            found = screen_of(text, width)
            assert len(found) == 2 and found[1] == "", (width, found)
            assert len(found[0]) < width and found[0].startswith("parameter_map_of_coatings: "[: width - 8])
            assert text.count("\r\x1b[K") == 4 and ("96 %" in text or "24000 of 25000" in text)
    os.close(inside)


def test_a_terminal_that_does_not_say_its_width_has_80_columns():
    assert columns(Terminal()) == 80
    inside, outside = os.openpty()  # 0 columns until somebody says how many
    with open(outside, "w", encoding="utf-8") as stream:
        assert columns(stream) == 80
    os.close(inside)
