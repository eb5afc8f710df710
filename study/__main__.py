"""Command line of roughcoat: `roughcoat COMMAND`, or `python -m study COMMAND`, which does the same. The commands are

point | fit | design | explore | scan | materials | docs | doctor | new | show | list | check | run | retry | status |
verify | clean | plot | table | tradeoff.

Exit codes: 0 all right, 1 something could not be computed or written, 2 bad input, 130 interrupted. A command goes on
when its terminal is gone or its reader has left. If the disk is too full for what a command prints, it ends with 1 only
if it does nothing but print (point, fit, design, scan, materials, docs, doctor, show, list, check, status, --dry-run).
"""

import argparse
import logging
import os
import sys
from contextlib import suppress
from functools import partial
from importlib import import_module
from pathlib import Path

from .commands import signals
from .commands.arguments import Parser, Version, add_columns, add_curves, add_engine, folder, part, proposed
from .commands.signals import INTERRUPTED
from .terminal import empty_buffers, interrupt, memory_message, open_closed_streams, program, say, short_of_memory

# The solver computes on one BLAS thread. BLAS libraries read these variables when numpy is imported; otherwise they
# would start a thread for each processor in every worker process.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
    os.environ.setdefault(_name, "1")

DIR = {"type": folder, "metavar": "DIR"}
BLOCKS_STAY = "; finished blocks are kept, and the same command continues from there"


def parser() -> argparse.ArgumentParser:
    """All subcommands and their options."""
    top = Parser(prog=program(), description="Parameter studies of rough coated contacts.")
    top.add_argument("-v", "--verbose", action="store_true", help="show the log")
    top.add_argument("--version", action=Version, nargs=0, help="print the version")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(module: str, name: str, text: str, items: str = "", *, least: str = "+") -> argparse.ArgumentParser:
        sub = commands.add_parser(name.removesuffix("_"), help=text, description=text)
        sub.set_defaults(action=(module, name), items=[name])
        if items:
            argument = sub.add_argument("items", nargs=least, metavar=items, default=[])
            argument.completer = partial(proposed, name)
        if module not in ("point", "fitting", "designing", "beginning", "lookup"):
            sub.add_argument("--results", default="results", **DIR, help="folder of the results (default: results)")
        return sub

    sub = command("point", "point", "solve one contact and describe the result in words", "NAME=VALUE")
    sub.add_argument("--json", action="store_true", help="print the numbers as JSON, for a program")
    sub.add_argument("--stresses", type=folder, metavar="FILE", help="also draw its stresses: .png, .pdf or .svg")
    add_columns(sub)
    sub.epilog = (
        f'for example: {program()} point R="5 mm" punch="steel 52100" h="2 um" layer="DLC a-C:H" bonding=bonded '
        'body="steel 52100" P="10 N" micro=smooth'
    )
    sub = command("fitting", "fit", "fit inputs of a contact to a measured curve, with intervals", "FILE")
    sub.usage = "%(prog)s FILE NAME=VALUE ... [--json] [--plot FILE]"
    sub.add_argument("--json", action="store_true", help="print the numbers as JSON, for a program")
    sub.add_argument("--plot", type=folder, metavar="FILE", help="draw the fit over the points: .png, .pdf or .svg")
    sub.epilog = (
        f'for example: {program()} fit curve.csv R="5 um" punch=rigid nu1=0.49 h="1.5 ± 0.1 um" bonding=bonded '
        'body="glass soda-lime" micro=smooth free=E1; curve.csv has the columns "D [nm]" and "P [nN]"'
    )
    text = "find the input that gives a wanted result, with its ±"
    sub = command("designing", "design", text, "NAME=VALUE")
    sub.add_argument("--json", action="store_true", help="print the numbers as JSON, for a program")
    sub.epilog = (
        f'for example: {program()} design p_max="180 MPa" h="1 um .. 1 mm" R="5 mm" punch="steel 52100" layer=PTFE '
        'bonding=bonded body="steel 52100" P="5 N" Nbar="1e5 1/mm^2" Ra="2 um"'
    )
    sub = command("beginning", "explore", "write a page that solves contacts in a browser and needs no network")
    sub.add_argument("--out", type=folder, default="contact.html", metavar="FILE", help="default: contact.html")
    sub = command("lookup", "scan", "measure the asperities of a scan of a rough surface", "FILE")
    sub.usage = "%(prog)s FILE [NAME=VALUE ...]"
    text = "write the micro law of the scan itself, without spheres in its place"
    sub.add_argument("--law", type=folder, metavar="OUT.csv", help=text)
    sub.epilog = (
        f"for example: {program()} scan wafer.csv unit=um height_unit=nm cutoff='2.5 um'; "
        f"all names are in {program()} docs roughness"
    )
    text = "list the materials that have a name; print all that is known of one"
    command("lookup", "materials_", text, "NAME", least="*")
    command("lookup", "docs", "list the pages of the documentation, or print one", "PAGE", least="*")
    command("beginning", "doctor", "report what is installed, and whether it solves a contact correctly")
    sub = command("beginning", "new", "write a study file with comments, NAME.toml, for you to edit", "NAME")
    text = "start from a copy of this study, such as dlc_on_steel"
    source = sub.add_argument("--from", dest="source", metavar="STUDY", help=text)
    source.completer = partial(proposed, "show")
    command("beginning", "show", "print a study file of yours or of this package", "STUDY")
    sub = command("computing", "list_", "list the study files with their size and state")
    text = "folder to look in (default: the working folder and ./studies, or the studies of this package)"
    sub.add_argument("folder", type=folder, nargs="?", help=text)
    command("checking", "check", "check study files without computing", "FILE")
    sub = command("computing", "run", "compute what is missing and write the results", "FILE")
    add_engine(sub)
    sub.add_argument("--part", type=part, default=(1, 1), metavar="I/N", help="compute only part I of N")
    sub.add_argument("--force", action="store_true", help="replace results even if some of their cases are lost")
    text = "estimate time, memory and disk from a sample, and compute no more"
    sub.add_argument("--dry-run", action="store_true", help=text)
    sub = command("computing", "retry", "compute again the cases that ended with one status", "FILE")
    add_engine(sub)
    status_option = sub.add_argument(
        "--status", required=True, action="append", metavar="NAME", help="such as iteration_limit"
    )
    status_option.completer = partial(proposed, "--status")
    sub = command("computing", "status", "report what has been computed", "FILE")
    sub.add_argument("--yes", action="store_true", help="count the cases, however many there are")
    text = "compare results with their digest: exit code 1 if a file is damaged or has no digest"
    command("computing", "verify", text, "FILE")
    text = "remove the blocks that a study no longer needs, and list them; results are never removed"
    command("computing", "clean", text, "FILE")
    for name, text in (("plot", "draw figures from results"), ("table", "write tables from results")):
        kind = text.split()[1]
        sub = command("drawing", name, f"{text}; all: those that need no long study", "NAME")
        text = f"folder of the {kind} (default: {kind})"
        sub.add_argument(f"--{kind}", dest="folder", default=kind, **DIR, help=text)
        sub.add_argument("--run", action="store_true", help="first run the studies needed; skip what is up to date")
        if name == "plot":
            text = "leave out the parameters above a figure, which are in its caption"
            sub.add_argument("--bare", action="store_true", help=text)
            add_curves(sub)
        else:
            text = "format for the rows of a study or of a .nc file (default: csv)"
            sub.add_argument("--format", choices=("csv", "xlsx"), default="csv", help=text)
            add_columns(sub)
    sub = command("drawing", "tradeoff", "measure error against time for every way to solve")
    sub.add_argument("--force", action="store_true", help="measure again what has been measured")
    return top


def main(arguments=None) -> int:
    """Run one command; returns the exit code."""
    remark = ""
    try:
        commands = parser()
        complete(commands)
        if not (sys.argv[1:] if arguments is None else arguments):
            commands.print_help(sys.stderr)
            commands.exit(2)
        options = commands.parse_args(arguments)
        level = logging.DEBUG if options.verbose else logging.WARNING
        logging.basicConfig(level=level, format="%(levelname)s %(name)s: %(message)s")
        remark = signals.state.remark = BLOCKS_STAY if options.command in ("run", "retry") else ""
        code = perform(options, remark)
        signals.state.code = code
    except SystemExit as ended:  # raised by the parser
        signals.state.code = ended.code
        raise
    except (KeyboardInterrupt, Exception) as error:
        # a library may have turned the interrupt into another error
        if not (interrupt.came or isinstance(error, KeyboardInterrupt)):
            raise
        say(f"\ninterrupted{remark}", sys.stderr)
        code = INTERRUPTED
    finally:
        empty_buffers()
    return code


def complete(commands: argparse.ArgumentParser) -> None:
    """If a shell asks for completions, answer with argcomplete (an extra), if it is installed, and end."""
    if "_ARGCOMPLETE" in os.environ:
        with suppress(ImportError):
            import argcomplete

            argcomplete.autocomplete(commands)


def perform(options, remark: str) -> int:
    """Run a command on each of its items, even if it fails on others. Returns the largest exit code."""
    module, name = options.action
    if wrong := wrong_core() if module not in ("lookup", "beginning", "checking") else "":
        say(wrong, sys.stderr)
        return 2
    commands = import_module(f".commands.{module}", __package__)
    items = commands.items(options) if hasattr(commands, "items") else options.items
    signals.state.working = True  # until here, during imports, a signal ends the process at once
    return max((_attempt(getattr(commands, name), options, item, remark) for item in items), default=0)


def wrong_core() -> str:
    """A message if the environment chooses a compiled core that does not exist (docs/extending.md); otherwise ""."""
    if os.environ.get("ROUGHCOAT_CORE"):
        from solver.compiled.library import core

        try:
            core()
        except ValueError as error:
            return str(error)
    return ""


def _attempt(act, options, item, remark: str) -> int:
    from .inputs.definition import StudyError

    try:
        return act(options, item)
    except StudyError as error:
        text, code = str(error), error.code
    except (OSError, MemoryError, RuntimeError) as error:  # such as a full disk, or a scheduler that is gone
        what = item if isinstance(item, str) else options.command
        if short_of_memory(error):
            text, code = f"{what}: {memory_message(error)}{remark}", 1
        elif isinstance(error, OSError):
            text, code = f"{what}: {error}{remark}", 1
        else:
            raise
    except SystemExit as ended:  # foreign code, such as the function of a figure, must not end the command
        text, code = f"{item}: something that it needs calls sys.exit({ended})", 1
    if interrupt.came:  # a library has turned the interrupt into this error
        raise KeyboardInterrupt
    say(text, sys.stderr)
    return code


def search_working_folder_last() -> None:
    """Look for modules in the working folder last. `python -m` looks there first, where a user may have a dask.py."""
    with suppress(FileNotFoundError):  # the working folder has been deleted: nothing is in it
        first = Path(sys.path[0]).resolve()
        if not sys.flags.safe_path and first == Path.cwd() != Path(__file__).resolve().parents[1]:
            sys.path.append(sys.path.pop(0))


def command() -> None:
    """Run `main` as the process of a command line, which ends with its exit code."""
    os.environ["MPLBACKEND"] = "agg"  # figures are files; a notebook that calls this may have set another backend
    open_closed_streams()
    signals.listen()
    code = main()
    if code == INTERRUPTED:
        os._exit(code)  # without waiting for the threads that compute blocks
    sys.exit(code)


if __name__ == "__main__":
    search_working_folder_last()
    command()
