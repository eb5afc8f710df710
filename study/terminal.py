"""What is said to whoever runs a command: nothing in it moves the cursor, and no harm is done when nobody hears it."""

import errno
import os
import re
import sys
from typing import TextIO

# Characters that a terminal obeys, but for the ends of lines and tabs, and those that change the direction of writing.
OBEYED = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # somebody wants the text and does not get it


def on_one_line(text: str, most: int) -> str:
    """At most so many characters of a text, what a terminal would obey and the ends of lines written out."""
    cut = text if len(text) <= most else text[: most - 3] + "..."
    return OBEYED.sub(_written_out, cut).replace("\n", "\\n").replace("\t", "\\t")


def _written_out(found: re.Match) -> str:
    return found[0].encode("unicode_escape").decode()


def say(text: str, stream: TextIO | None) -> OSError | None:
    """Write a line at once. Returns why it is lost: its reader has left, say, or its disk is full.

    What the stream cannot encode, and what a terminal would obey, is written out as in "\\x1b".
    """
    if stream is None:
        return None
    plain = OBEYED.sub(_written_out, text)
    encoding = stream.encoding or "utf-8"
    try:
        stream.write(plain.encode(encoding, "backslashreplace").decode(encoding) + "\n")
        stream.flush()
    except OSError as error:
        return error
    except ValueError as error:  # it has been closed
        return OSError(errno.EBADF, str(error))
    return None


def answer(*lines) -> int:
    """Say what was asked for. Returns the exit code if that is all that was: 1 when a disk has no room for it."""
    lost = say("\n".join(map(str, lines)), sys.stdout)
    if lost is None or lost.errno not in FULL:  # else nobody wants to know it, any more
        return 0
    say(f"standard output cannot be written: {lost.strerror}", sys.stderr)
    return 1


def open_the_closed() -> None:
    """Open those of the three standard streams that the shell has closed (`>&-`), to nowhere.

    Otherwise the next file that is opened, results even, would have their numbers, and receive what is said to them.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # has the lowest free number
            os.set_inheritable(number, True)
            setattr(sys, name, open(number, "w" if number else "r", encoding="utf-8", closefd=False))  # noqa: SIM115


def empty_buffers() -> None:
    """Flush what is still to be said; what cannot be said is dropped, so that nothing complains about it later."""
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except OSError:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, stream.fileno())
            os.close(nowhere)
            stream.flush()
        except ValueError:  # it has been closed
            continue
