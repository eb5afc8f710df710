"""Text for whoever runs a command. It holds no control characters, and a closed stream is no error."""

import errno
import os
import re
import sys
from types import SimpleNamespace
from typing import Any, TextIO

#: Control characters of a terminal, without ends of lines and tabs, and those that change the direction of writing.
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")
#: Whether a signal has asked this command to end.
interrupt = SimpleNamespace(came=False)
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # a reader waits for the text in vain


def on_one_line(text: str, most: int = 60) -> str:
    """At most `most` characters of a text; control characters, ends of lines and tabs are written as in "\\x1b"."""
    cut = text if len(text) <= most else text[: most - 3] + "..."
    return CONTROL.sub(_written_out, cut).replace("\n", "\\n").replace("\t", "\\t")


def shown(value: Any) -> str:
    """A value as a message quotes it, at most 60 characters."""
    try:
        return on_one_line(f'"{value}"' if isinstance(value, str) else str(value))
    except ValueError:  # Python writes no whole number of more than 4300 digits
        return "a number of more than 4300 digits"


def _written_out(match: re.Match) -> str:
    return match[0].encode("unicode_escape").decode()


def rounded(number: float, digits: int = 2) -> str:
    """A number with few digits as a reader writes it: 100 for 99.7, which "%.2g" makes 1e+02; from a million on, and
    below 1e-4, with a power of ten."""
    return f"{float(f'{number:.{digits}g}'):g}"


def counted(number: int, what: str) -> str:
    """ "1 case", "3 cases"."""
    return f"{number} {what}{'s' * (number != 1)}"


def program() -> str:
    """What a user types to start this program: "roughcoat", or "python -m roughcoat" if it was not started so."""
    folder, name = os.path.split(sys.argv[0])
    package = "study" if (os.path.basename(folder), name) == ("study", "__main__.py") else "roughcoat"
    return "roughcoat" if name.startswith("roughcoat") else f"python -m {package}"


def say(text: str, stream: TextIO | None) -> OSError | None:
    """Write a line and flush it. Returns the error if that fails: the reader has left, say, or the disk is full.

    Control characters, and what the stream cannot encode, are written as in "\\x1b".
    """
    if stream is None:
        return None
    plain = CONTROL.sub(_written_out, text)
    encoding = stream.encoding or "utf-8"
    try:
        stream.write(plain.encode(encoding, "backslashreplace").decode(encoding) + "\n")
        stream.flush()
    except OSError as error:
        return error
    except ValueError as error:  # the stream has been closed
        return OSError(errno.EBADF, str(error))
    return None


def short_of_memory(error: BaseException) -> bool:
    """Whether an error says that there was no memory, or no room for another thread: nothing else is wrong then."""
    return isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM or "new thread" in str(error)


def memory_message(error: BaseException) -> str:
    """ "there is not enough memory (Unable to allocate 7.45 GiB ...)"."""
    said = getattr(error, "strerror", None) or str(error)
    return "there is not enough memory" + f" ({on_one_line(said, 120)})" * bool(said)


def answer(*lines) -> int:
    """Print the answer of a command. Returns its exit code, for a command that does nothing else: 1 for a full disk."""
    lost = say("\n".join(map(str, lines)), sys.stdout)
    if lost is None or lost.errno not in NO_ROOM:  # a reader that has left wants no answer
        return 0
    say(f"standard output cannot be written: {lost.strerror}", sys.stderr)
    return 1


def open_closed_streams() -> None:
    """Open to /dev/null whichever of stdin, stdout and stderr the shell has closed (`>&-`).

    Otherwise the next file that is opened, even results, would get the number of the stream and what is printed to it.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free number, which is this one
            os.set_inheritable(number, True)
            setattr(sys, name, open(number, "w" if number else "r", encoding="utf-8", closefd=False))  # noqa: SIM115


def empty_buffers() -> None:
    """Flush stdout and stderr. What cannot be written is dropped: Python would complain of it when it ends."""
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except OSError:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, stream.fileno())
            os.close(nowhere)
            stream.flush()
        except ValueError:  # the stream has been closed
            continue


def end_if_interrupted() -> None:
    """Raise KeyboardInterrupt if a signal has come and a library has lost the first one: numpy, for one, forgets what
    is raised while it looks for attributes."""
    if interrupt.came:
        raise KeyboardInterrupt
