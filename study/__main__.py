"""Command line of roughcoat: python -m study COMMAND, one of

list | check | run | retry | status | verify | clean | plot | table | tradeoff.

Exit codes: 0 all right, 1 something could not be computed or written, 2 bad input, 130 interrupted (also a
`run` or `retry` whose reader has left before the end).
"""

import argparse
import logging
import os
import signal
import sys
from pathlib import Path

from .arguments import STUDIES, part, positive, study_file

# The solver computes on one BLAS thread. A BLAS library that is told so before numpy is imported does not start the
# others at all, of which each worker process would have one for each processor.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

INTERRUPTED = 130  # exit code
SIGNALS = (signal.SIGINT, signal.SIGTERM)
KEPT = "; finished blocks are kept, the same command goes on from there"


def parser() -> argparse.ArgumentParser:
    """All subcommands and their options."""
    top = argparse.ArgumentParser(prog="python -m study", description="Parameter studies of rough coated contacts.")
    top.add_argument("-v", "--verbose", action="store_true", help="show the log")
    top.add_argument("--version", action=Version, nargs=0, help="say which version this is")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(function, text: str, *arguments: str) -> argparse.ArgumentParser:
        sub = commands.add_parser(function.__name__.removesuffix("_"), help=text, description=text)
        sub.set_defaults(function=function)
        for argument in arguments:
            sub.add_argument(argument, nargs="+", metavar=argument.upper().removesuffix("S"))
        sub.add_argument("--results", default="results", metavar="DIR", help="folder of the results (default: results)")
        return sub

    command(list_, "list the study files, their size and state").add_argument("folder", nargs="?", default=STUDIES)
    command(check, "check study files without computing", "files")
    sub = command(run, "compute what is missing and write the results", "files")
    _add_engine(sub)
    sub.add_argument("--part", type=part, default=(1, 1), metavar="I/N", help="compute the I-th of N parts only")
    sub.add_argument("--force", action="store_true", help="replace results of which cases would be lost")
    sub.add_argument("--dry-run", action="store_true", help="say what it would cost, compute a sample only")
    sub = command(retry, "compute cases of some status again", "files")
    _add_engine(sub)
    sub.add_argument("--status", required=True, action="append", metavar="NAME", help="such as iteration_limit")
    command(status, "say what has been computed", "files")
    command(verify, "compare results with their checksums: exit code 1 for what is damaged or has none", "files")
    command(clean, "remove blocks that do not serve a study as it is now, say which; never results", "files")
    sub = command(plot, "draw figures from results", "names")
    sub.add_argument("--figures", default="figures", metavar="DIR", help="folder of the figures (default: figures)")
    sub = command(table, "write tables from results", "names")
    sub.add_argument("--tables", default="tables", metavar="DIR", help="folder of the tables (default: tables)")
    sub = command(tradeoff, "measure error against time of every way to solve, and write the page about it")
    sub.add_argument("--docs", default="docs", metavar="DIR", help="folder of the page (default: docs)")
    sub.add_argument("--force", action="store_true", help="measure again what has been measured")
    return top


class Version(argparse.Action):
    """Print the versions of the program and of its numerics, and end."""

    def __call__(self, parser, *_) -> None:
        from .dataset import package_version
        from .definition import NUMERICS_VERSION

        print(f"roughcoat {package_version('roughcoat')}, numerics {NUMERICS_VERSION}")
        parser.exit()


def _add_engine(sub: argparse.ArgumentParser) -> None:
    """Options of the commands that compute."""
    sub.add_argument("--workers", type=positive, metavar="N", help="threads or processes (default: one per processor)")
    sub.add_argument("--scheduler", default="", metavar="ADDRESS", help="compute on the workers of this dask scheduler")
    either = sub.add_mutually_exclusive_group()
    either.add_argument("--fail-fast", action="store_true", help="stop at the first block with a failed case")
    either.add_argument("--keep-going", action="store_false", dest="fail_fast", help="compute the others (default)")
    sub.add_argument("--yes", action="store_true", help="go on however large the study is")


def list_(options) -> int:
    from .api import load

    files = sorted(Path(options.folder).glob("*.toml"))
    if not files:
        print(f"no study files in {options.folder}")
    return _each(files, lambda file: _print_state(load(file, options.results)))


def check(options) -> int:
    from .definition import read

    def one(file):
        definition = read(study_file(file))
        dims = " x ".join(f"{name} {size}" for name, size in definition.grid.sizes.items()) or "one case"
        print(f"{file}: {definition.grid.size} cases ({dims}), digest {definition.digest[:16]}")
        return 0

    return _each(options.files, one)


def run(options) -> int:
    from .answers import cost_line
    from .api import load

    def one(file):
        study = load(study_file(file), options.results)
        if options.dry_run:
            return _print_lines([cost_line(study.definition.name, study.dry_run(options.workers))])
        return _compute(study, options, part=options.part, force=options.force)

    return _each(options.files, one, KEPT)


def retry(options) -> int:
    from .api import load
    from .order import status_values

    def one(file):
        return _compute(load(study_file(file), options.results), options, retry=status_values(options.status))

    return _each(options.files, one, KEPT)


def _compute(study, options, **more) -> int:
    names = ("workers", "scheduler", "fail_fast", "yes")
    chosen = {name: getattr(options, name) for name in names}
    return _print_report(study.run(**chosen, **more, processes=True, stream=sys.stderr), study.definition.name)


def status(options) -> int:
    from .api import load
    from .dataset import status_words

    def one(file):
        study = load(study_file(file), options.results)
        state = study.status()
        _print_state(study, state)
        for value, count in state["counts"].items():
            print(f"    {status_words()[value]}: {count}")
        return 0

    return _each(options.files, one)


def verify(options) -> int:
    from .answers import verified_line
    from .api import load
    from .examine import examine

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
    from .recipes import draw

    return _each(options.names, lambda name: _print_lines(draw(name, options.results, options.figures)))


def table(options) -> int:
    from .tables import tabulate

    return _each(options.names, lambda name: _print_lines(tabulate(name, options.results, options.tables)))


def tradeoff(options) -> int:
    from .dataset import command_line
    from .outputs import write_text
    from .tradeoff import results
    from .tradeoff_page import page

    def one(_):
        found = results(options.results, force=options.force, command=command_line())
        return _print_lines([write_text(Path(options.docs) / "tradeoff.md", page(found))])

    return _each(["tradeoff"], one)


def _each(items, action, hint: str = "") -> int:
    """Largest exit code of the actions; what is wrong with one item does not keep the others from their turn."""
    return max((_attempt(action, item, hint) for item in items), default=0)


def _attempt(action, item, hint: str) -> int:
    from .definition import StudyError

    try:
        return action(item)
    except StudyError as error:
        print(error, file=sys.stderr)
        return error.code
    except BrokenPipeError:  # no fault of the item: nobody reads
        raise
    except OSError as error:  # a full disk, say, or a scheduler that is gone
        print(f"{item}: {error}{hint}", file=sys.stderr)
        return 1


def _print_state(study, state: dict | None = None) -> int:
    from .answers import state_line

    print(state_line(study.definition, state or study.status()))
    return 0


def _print_report(report, name: str) -> int:
    from .answers import failure_lines, report_line

    if report.failures:
        print("\n".join(failure_lines(report, name)), file=sys.stderr)
        return 1
    print(report_line(report, name))
    return 0


def _print_lines(lines) -> int:
    print("\n".join(map(str, lines)))
    return 0


def _interrupt(*_) -> None:
    """End in good order; a second signal ends at once, which costs the blocks in work and no more."""
    for number in SIGNALS:
        if signal.getsignal(number) is _interrupt:
            signal.signal(number, _end)
    raise KeyboardInterrupt


def _end(*_) -> None:
    os._exit(INTERRUPTED)


def main(arguments=None) -> int:
    """Run one command; returns the exit code."""
    code = 0
    try:
        try:
            options = parser().parse_args(arguments)
            level = logging.DEBUG if options.verbose else logging.WARNING
            logging.basicConfig(level=level, format="%(levelname)s %(name)s: %(message)s")
            code = INTERRUPTED if options.function in (run, retry) else 0  # should the reader leave half-way
            code = options.function(options)
        finally:
            sys.stdout.flush()  # here, where it is no fault that the reader has left
    except KeyboardInterrupt:
        print(f"\ninterrupted{KEPT}", file=sys.stderr)
        code = INTERRUPTED
    except BrokenPipeError:  # the reader, `head` say, has enough
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (sys.stdout, sys.stderr):
            os.dup2(nowhere, stream.fileno())
    return code


if __name__ == "__main__":
    for _number in SIGNALS:
        if signal.getsignal(_number) is not signal.SIG_IGN:
            signal.signal(_number, _interrupt)
    _code = main()
    if _code == INTERRUPTED:
        os._exit(_code)  # does not wait for the blocks in work
    sys.exit(_code)
