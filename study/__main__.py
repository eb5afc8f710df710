"""Command line of roughcoat: python -m study COMMAND, one of

list | check | run | retry | status | verify | clean | plot | table | tradeoff.

Exit codes: 0 all right, 1 something could not be computed or written, 2 bad input, 130 interrupted. They say what
became of the work, whoever hears of it: nothing stops because a terminal is gone, or a reader has left. Only where
the answer is all there is (list, check, status, --dry-run) a full disk under it is 1.
"""

import argparse
import logging
import os
import sys
from pathlib import Path

from .commands import ending
from .commands.arguments import STUDIES, Parser, Version, add_engine, folder, part, study_file
from .commands.ending import INTERRUPTED
from .terminal import FULL, empty_buffers, open_the_closed, say

# The solver computes on one BLAS thread. A BLAS library that is told so before numpy is imported does not start the
# others at all, of which each worker process would have one for each processor.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

DIR = {"type": folder, "metavar": "DIR"}
KEPT = "; finished blocks are kept, the same command goes on from there"


def parser() -> argparse.ArgumentParser:
    """All subcommands and their options."""
    top = Parser(prog="python -m study", description="Parameter studies of rough coated contacts.")
    top.add_argument("-v", "--verbose", action="store_true", help="show the log")
    top.add_argument("--version", action=Version, nargs=0, help="say which version this is")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(function, text: str, *arguments: str) -> argparse.ArgumentParser:
        sub = commands.add_parser(function.__name__.removesuffix("_"), help=text, description=text)
        sub.set_defaults(function=function)
        for argument in arguments:
            sub.add_argument(argument, nargs="+", metavar=argument.upper().removesuffix("S"))
        sub.add_argument("--results", default="results", **DIR, help="folder of the results (default: results)")
        return sub

    sub = command(list_, "list the study files, their size and state")
    sub.add_argument("folder", type=folder, nargs="?", default=STUDIES)
    command(check, "check study files without computing", "files")
    sub = command(run, "compute what is missing and write the results", "files")
    add_engine(sub)
    sub.add_argument("--part", type=part, default=(1, 1), metavar="I/N", help="compute the I-th of N parts only")
    sub.add_argument("--force", action="store_true", help="replace results of which cases would be lost")
    sub.add_argument("--dry-run", action="store_true", help="say what it would cost, compute a sample only")
    sub = command(retry, "compute cases of some status again", "files")
    add_engine(sub)
    sub.add_argument("--status", required=True, action="append", metavar="NAME", help="such as iteration_limit")
    sub = command(status, "say what has been computed", "files")
    sub.add_argument("--yes", action="store_true", help="count however many cases there are")
    command(verify, "compare results with their checksums: exit code 1 for what is damaged or has none", "files")
    command(clean, "remove blocks that do not serve a study as it is now, say which; never results", "files")
    for function, text in ((plot, "draw figures from results"), (table, "write tables from results")):
        kind = text.split()[1]
        sub = command(function, f"{text}; all: those that no long study is needed for", "names")
        sub.add_argument(f"--{kind}", dest="folder", default=kind, **DIR, help=f"their folder (default: {kind})")
        sub.add_argument("--run", action="store_true", help="run the studies that they need; skip what is up to date")
    sub = command(tradeoff, "measure error against time of every way to solve")
    sub.add_argument("--force", action="store_true", help="measure again what has been measured")
    return top


def list_(options) -> int:
    from .api import load
    from .commands.answers import state_line

    files = sorted(Path(options.folder).glob("*.toml"))
    if not files:
        return _answer(f"no study files in {options.folder}")

    def one(file):
        study = load(file, options.results)
        return _answer(state_line(study.definition, study.status()))

    return _each(files, one)


def check(options) -> int:
    from .spec.definition import read

    def one(file):
        definition = read(study_file(file))
        dims = " x ".join(f"{name} {size}" for name, size in definition.grid.sizes.items()) or "one case"
        return _answer(f"{file}: {definition.grid.size} cases ({dims}), digest {definition.digest[:16]}")

    return _each(options.files, one)


def run(options) -> int:
    from .api import load
    from .commands.answers import cost_line

    def one(file):
        study = load(study_file(file), options.results)
        if options.dry_run:
            return _answer(cost_line(study.definition.name, study.dry_run(options.workers, options.yes)))
        return _compute(study, options, part=options.part, force=options.force)

    return _each(options.files, one, KEPT)


def retry(options) -> int:
    from .api import load
    from .work.plan import status_values

    def one(file):
        return _compute(load(study_file(file), options.results), options, retry=status_values(options.status))

    return _each(options.files, one, KEPT)


def _compute(study, options, **more) -> int:
    names = ("workers", "scheduler", "fail_fast", "yes")
    chosen = {name: getattr(options, name) for name in names}
    return _print_report(study.run(**chosen, **more, processes=True, stream=sys.stderr), study.definition.name)


def status(options) -> int:
    from .api import load
    from .commands.answers import count_lines, state_line

    def one(file):
        study = load(study_file(file), options.results)
        state = study.status(options.yes)
        return _answer(state_line(study.definition, state), *count_lines(state["counts"]))

    return _each(options.files, one)


def verify(options) -> int:
    from .api import load
    from .commands.answers import verified_line
    from .files.examine import examine

    def one(file):
        results = Path(file).suffix == ".nc"
        found = examine(file) if results else load(study_file(file), options.results).verify()
        print(verified_line(found.path, found), file=sys.stdout if found.good else sys.stderr)
        return 0 if found.kind == "sound" else 2 if found.kind == "missing" else 1

    return _each(options.files, one)


def clean(options) -> int:
    from .api import load

    return _each(options.files, lambda file: _print_lines(load(study_file(file), options.results).clean()))


def plot(options) -> int:
    from .catalogue import FIGURES, draw

    return _write(options, FIGURES, draw)


def table(options) -> int:
    from .catalogue import TABLES, tabulate

    return _write(options, TABLES, tabulate)


def _write(options, known: dict, make) -> int:
    """Write figures or tables; with --run first compute the studies that they need, each once."""
    from .catalogue import needed, outdated, usual

    codes = {}

    def one(name):
        if options.run:
            for study in needed(name, known):
                codes[study] = codes[study] if study in codes else _prepared(study, options)
            code = max((codes[study] for study in needed(name, known)), default=0)
            if code or not outdated(name, known, options.results, options.folder):
                return code
        return _print_lines(make(name, options.results, options.folder))

    return _each(usual(known) if options.names == ["all"] else options.names, one)


def _prepared(study: str, options) -> int:
    """Compute what is missing of a study of this repository; its results of an older version may be replaced."""
    from .api import load

    if study == "tradeoff":
        return _measured(options, force=False)
    report = load(study_file(study), options.results).run(force=True, processes=True, stream=sys.stderr)
    return _print_report(report, study)


def tradeoff(options) -> int:
    return _each(["tradeoff"], lambda _: _measured(options, options.force))


def _measured(options, force: bool) -> int:
    from .data.dataset import command_line
    from .evidence.tradeoff import results

    results(options.results, force=force, command=command_line())
    return _print_lines([f"{options.results}/tradeoff.nc"])


def _each(items, action, hint: str = "") -> int:
    """Largest exit code of the actions; what is wrong with one item does not keep the others from their turn."""
    ending.now.working = True  # all imports have been made
    return max((_attempt(action, item, hint) for item in items), default=0)


def _attempt(action, item, hint: str) -> int:
    from .spec.definition import StudyError

    try:
        return action(item)
    except StudyError as error:
        text, code = str(error), error.code
    except OSError as error:  # a full disk, say, or a scheduler that is gone
        text, code = f"{item}: {error}{hint}", 1
    if ending.now.came:  # and has been taken for something else on its way here
        raise KeyboardInterrupt
    say(text, sys.stderr)
    return code


def _print_report(report, name: str) -> int:
    from .commands.answers import failure_lines, report_line

    if report.failures:
        say("\n".join(failure_lines(report, name)), sys.stderr)
        return 1
    _answer(report_line(report, name))
    return 0


def _print_lines(lines) -> int:
    _answer(*lines)
    return 0


def _answer(*lines) -> int:
    """Say what was asked for. Returns the exit code if that is all that was: 1 when a disk has no room for it."""
    lost = say("\n".join(map(str, lines)), sys.stdout)
    if lost is None or lost.errno not in FULL:  # else nobody wants to know it, any more
        return 0
    say(f"standard output cannot be written: {lost.strerror}", sys.stderr)
    return 1


def main(arguments=None) -> int:
    """Run one command; returns the exit code."""
    kept = ""
    try:
        options = parser().parse_args(arguments)
        level = logging.DEBUG if options.verbose else logging.WARNING
        logging.basicConfig(level=level, format="%(levelname)s %(name)s: %(message)s")
        kept = KEPT if options.function in (run, retry) else ""
        code = options.function(options)
        ending.now.code = code
    except SystemExit as ended:  # of the parser
        ending.now.code = ended.code
        raise
    except (KeyboardInterrupt, Exception) as error:
        if not (ending.now.came or isinstance(error, KeyboardInterrupt)):  # libraries make other errors of an interrupt
            raise
        say(f"\ninterrupted{kept}", sys.stderr)
        code = INTERRUPTED
    finally:
        empty_buffers()
    return code


if __name__ == "__main__":
    open_the_closed()
    ending.start()
    _code = main()
    if _code == INTERRUPTED:
        os._exit(_code)  # does not wait for the blocks in work
    sys.exit(_code)
