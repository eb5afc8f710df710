"""Text on the terminal of a command. Control characters are written out, and a closed stream raises no error."""

import errno
import os
import re
import sys
from types import SimpleNamespace
from typing import Any, TextIO

#: Control characters of a terminal except ends of lines and tabs; and those that change the direction of writing.
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")
#: Whether a signal has asked this command to end.
interrupt = SimpleNamespace(came=False)
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # the full disk is an error, since the reader never gets the text


def on_one_line(text: str, most: int = 60) -> str:
    """At most `most` characters of a text; control characters, ends of lines and tabs are escaped like "\\x1b"."""
    cut = text if len(text) <= most else text[: most - 3] + "..."
    return CONTROL.sub(_written_out, cut).replace("\n", "\\n").replace("\t", "\\t")


def shown(value: Any) -> str:
    """A value as messages quote it, at most 60 characters."""
    try:
        return on_one_line(f'"{value}"' if isinstance(value, str) else str(value))
    except ValueError:  # Python refuses to write a whole number of more than 4300 digits
        return "a number of more than 4300 digits"


def _written_out(match: re.Match) -> str:
    return match[0].encode("unicode_escape").decode()


def rounded(number: float, digits: int = 2) -> str:
    """A number with few digits as people write it: 100 for 99.7, where "%.2g" gives 1e+02. It has a power of ten from a
    million on, and below 1e-4."""
    return f"{float(f'{number:.{digits}g}'):g}"


def counted(number: int, what: str) -> str:
    """ "1 case", "3 cases"."""
    return f"{number} {what}{'s' * (number != 1)}"


def program() -> str:
    """The words that start this program: "roughcoat" if it was started so, otherwise "python -m" and a package."""
    folder, name = os.path.split(sys.argv[0])
    package = "study" if (os.path.basename(folder), name) == ("study", "__main__.py") else "roughcoat"
    return "roughcoat" if name.startswith("roughcoat") else f"python -m {package}"


def say(text: str, stream: TextIO | None) -> OSError | None:
    """Write a line and flush it. Returns the error if that fails because the reader has left or the disk is full.

    Control characters, and characters that the stream cannot encode, are escaped like "\\x1b".
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
    """Whether the only cause of an error was that there was no memory, or no room for another thread."""
    return isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM or "new thread" in str(error)


def memory_message(error: BaseException) -> str:
    """ "there is not enough memory (Unable to allocate 7.45 GiB ...)"."""
    detail = getattr(error, "strerror", None) or str(error)
    return "there is not enough memory" + f" ({on_one_line(detail, 120)})" * bool(detail)


def answer(*lines) -> int:
    """Print the answer of a command. Returns the exit code of a command that does nothing else: 1 for a full disk."""
    error = say("\n".join(map(str, lines)), sys.stdout)
    if error is None or error.errno not in NO_ROOM:  # a reader who has left needs no answer
        return 0
    say(f"standard output cannot be written: {error.strerror}", sys.stderr)
    return 1


def open_closed_streams() -> None:
    """Open /dev/null for each of stdin, stdout and stderr that the shell has closed (`>&-`).

    Otherwise the next file to be opened, even results, would get the stream's number, and all that is printed to it.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free number, which is this one
            os.set_inheritable(number, True)
            setattr(sys, name, open(number, "w" if number else "r", encoding="utf-8", closefd=False))  # noqa: SIM115


def empty_buffers() -> None:
    """Flush stdout and stderr. Text that cannot be written is dropped: Python would complain of it when it ends."""
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
    """Raise KeyboardInterrupt if a signal has come but a library has swallowed the first one: numpy, for example, drops
    errors that are raised while it looks for attributes."""
    if interrupt.came:
        raise KeyboardInterrupt
