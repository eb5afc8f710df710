"""The parser of the command line, and the meaning of its words: study files, numbers, parts."""

import argparse
import os
import re
import sys
from functools import partial
from pathlib import Path
from typing import NoReturn

from ..inputs.places import STUDIES, files_here, files_in, known_studies
from ..terminal import on_one_line, say
from ..work.scheduler import address_error

SWITCH = {"true": True, "false": False}
MOST_DIGITS = 9  # of a whole number; Python refuses to read 4301 digits


class Parser(argparse.ArgumentParser):
    """A parser whose help may be cut off: `roughcoat --help | head` is not an error."""

    def _print_message(self, message, file=None) -> None:
        say(message.removesuffix("\n"), file or sys.stderr)

    def error(self, message) -> NoReturn:
        """End with exit code 2. A command that is called without its words shows its example too."""
        super().error(f"{message}\n{self.epilog}" if self.epilog and "required" in message else message)


class Version(argparse.Action):
    """Print the versions of the program and of its numerics, and end."""

    def __call__(self, parser, *_) -> None:
        from solver.compiled.library import available

        from ..data.provenance import NUMERICS_VERSION, package_version

        slow = "" if available() else ", without its compiled core (numpy computes, 3 to 6 times slower)"
        say(f"roughcoat {package_version('roughcoat')}, numerics {NUMERICS_VERSION}{slow}", sys.stdout)
        parser.exit()


def add_engine(sub: argparse.ArgumentParser) -> None:
    """Options of the commands that compute."""
    text = "number of threads or processes (default: one per processor)"
    sub.add_argument("--workers", type=positive, metavar="N", help=text)
    sub.add_argument("--scheduler", type=address, metavar="ADDRESS", help="compute on workers of this dask scheduler")
    either = sub.add_mutually_exclusive_group()
    either.add_argument("--fail-fast", action="store_true", help="stop at the first block with a failed case")
    text = "compute the other blocks (default)"
    either.add_argument("--keep-going", action="store_false", dest="fail_fast", help=text)
    sub.add_argument("--yes", action="store_true", help="compute the study, however large it is")


def add_columns(sub: argparse.ArgumentParser) -> None:
    """Options of a table of numbers: which columns, in which units, and beside what."""
    text = "show only these columns, such as h,P,a,p_max"
    option = sub.add_argument("--columns", type=words, metavar="NAME,...", help=text)
    option.completer = partial(proposed, "--x")
    text = "use these units, such as um,N,MPa, where they fit; other columns stay in SI units"
    sub.add_argument("--units", type=words, metavar="UNIT,...", help=text)
    text = "add columns for the same contact on the body without its layer"
    sub.add_argument("--beside", choices=("bare",), help=text)


def words(text: str) -> list[str]:
    """The words of a list with commas."""
    parts = [word.strip() for word in text.split(",")]
    if not all(parts) or len(set(parts)) < len(parts):
        raise argparse.ArgumentTypeError(f'"{on_one_line(text)}": must be different words with commas between them')
    return parts


def add_curves(sub: argparse.ArgumentParser) -> None:
    """Options of `plot` to draw curves of the results of a study, or of a results file, instead of a known figure."""
    group = sub.add_argument_group("curves and maps from the results of a study, or from a .nc file")
    for name, word, text in (
        ("--x", "QUANTITY", "abscissa, such as P, or a"),
        ("--y", "QUANTITY", "ordinate, such as p_max; also An, spots, p_peak, E_eff ..."),
        ("--hue", "AXIS", "draw one curve for each value of this axis, such as n, or label"),
    ):
        option = group.add_argument(name, metavar=word, default="", help=text)
        option.completer = partial(proposed, "--x")
    text = "draw a map of this quantity over the axes x and y"
    option = group.add_argument("--colour", metavar="QUANTITY", default="", help=text)
    option.completer = partial(proposed, "--x")
    group.add_argument("--scale", choices=("linear", "log"), default="", help="scale of y, or of the colour")
    text = "limits of y, or of the colour, such as 0,2GPa"
    group.add_argument("--limits", type=words, metavar="LOW,HIGH", help=text)
    text = "draw only the contacts with this value"
    group.add_argument("--where", action="append", type=assignment, default=[], metavar="AXIS=VALUE", help=text)


def assignment(text: str) -> tuple[str, float | str]:
    """NAME and VALUE of NAME=VALUE, the value as a number if it is one."""
    name, _, value = (part.strip() for part in text.partition("="))
    if not name or not value:
        raise argparse.ArgumentTypeError(f'"{on_one_line(text)}": must be NAME=VALUE')
    try:
        return name, float(value)
    except ValueError:
        return name, value


def proposed(command: str, prefix: str, **_) -> list[str]:
    """Completions of a word of a command or option: names of studies, figures ... that begin with `prefix`."""
    if command in ("point", "design"):
        from ..inputs.vocabulary import BODIES, CONTROLS, SCENE, names

        of_contacts = names("material", "shape", "adhesion", "roughness")
        words = [f"{name}=" for name in (*SCENE, *BODIES, *CONTROLS, *of_contacts, "same_piece")]
    elif command == "docs":
        from ..pages import titles

        words = list(titles())
    elif command == "materials_":
        from ..specimen import materials

        words = list(materials.names())
    elif command == "scan":
        words = sorted(path.as_posix() for path in Path().iterdir())
    elif command in ("plot", "table"):
        from ..figures import figure_files

        words = ["all", *figure_files.names("figure" if command == "plot" else "table")]
        words += known_studies() if command == "plot" else []
        words += [path.as_posix() for path in files_here()]
    elif command == "--x":
        from ..data.derived import QUANTITIES
        from ..inputs.vocabulary import SCENE, VOCABULARY

        words = [*VOCABULARY, *SCENE, *QUANTITIES]
    elif command == "--status":
        from ..data.dataset import status_words

        words = list(status_words().values())
    else:
        files = [*files_here(), *files_in(STUDIES)]
        files += Path("results").glob("*.nc") if command == "verify" else ()
        words = [*known_studies(), *(path.as_posix() for path in sorted(files))]
    return [name for name in words if name.startswith(prefix)]


def folder(text: str) -> str:
    """A folder. A leading ~ is expanded, since the shell does not expand it in --results=~/there."""
    path = os.path.expanduser(text)
    if not path or path.startswith("~"):
        raise argparse.ArgumentTypeError(f'"{text}": must be a folder; write ./{text} if it has this name')
    return path


def positive(text: str) -> int:
    """A whole number > 0."""
    if not text.isdecimal() or len(text) > MOST_DIGITS or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{on_one_line(text)}: must be a whole number > 0, at most 9 digits")
    return int(text)


def address(text: str) -> str:
    """The address of a scheduler."""
    if address_error(text):
        raise argparse.ArgumentTypeError(f'"{text}": {address_error(text)}')
    return text


def part(text: str) -> tuple[int, int]:
    """I/N, the I-th of N parts."""
    match = re.fullmatch(rf"(\d{{1,{MOST_DIGITS}}})/(\d{{1,{MOST_DIGITS}}})", text)
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise argparse.ArgumentTypeError(f"{on_one_line(text)}: must be I/N, whole numbers with 1 <= I <= N")
    return int(match[1]), int(match[2])
