"""Command line of roughcoat: python -m study list | check | run | status | plot | table.

Exit codes: 0 all right, 1 something could not be computed or written, 2 bad input, 130 interrupted.
"""

import argparse
import logging
import os
import sys
from pathlib import Path

# One BLAS thread per worker: the systems are small and the workers would compete. Must come before numpy is imported.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

STUDIES = Path("studies")


def parser() -> argparse.ArgumentParser:
    """All subcommands and their options."""
    top = argparse.ArgumentParser(prog="python -m study", description="Parameter studies of rough coated contacts.")
    top.add_argument("-v", "--verbose", action="store_true", help="show the log")
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
    sub.add_argument("--workers", type=_positive, metavar="N", help="threads (default: one per processor)")
    sub.add_argument("--force", action="store_true", help="replace results of another version of the study")
    command(status, "say what has been computed", "files")
    sub = command(plot, "draw figures from results", "names")
    sub.add_argument("--figures", default="figures", metavar="DIR", help="folder of the figures (default: figures)")
    sub = command(table, "write tables from results", "names")
    sub.add_argument("--tables", default="tables", metavar="DIR", help="folder of the tables (default: tables)")
    return top


def list_(options) -> int:
    from .api import load

    files, code = sorted(Path(options.folder).glob("*.toml")), 0
    for file in files:
        code = max(code, _attempt(lambda file=file: _print_state(load(file, options.results)), str(file)))
    if not files:
        print(f"no study files in {options.folder}")
    return code


def check(options) -> int:
    from .definition import read

    def one(file):
        definition = read(_file(file))
        dims = " x ".join(f"{name} {size}" for name, size in definition.grid.sizes.items()) or "one case"
        print(f"{file}: {definition.grid.size} cases ({dims}), digest {definition.digest[:16]}")
        return 0

    return max(_attempt(lambda file=file: one(file), file) for file in options.files)


def run(options) -> int:
    from .api import load

    def one(file):
        study = load(_file(file), options.results)
        report = study.run(workers=options.workers, force=options.force, stream=sys.stderr)
        return _print_report(report, study.definition.name)

    return max(_attempt(lambda file=file: one(file), file) for file in options.files)


def status(options) -> int:
    from .api import load

    def one(file):
        study = load(_file(file), options.results)
        state = _print_state(study)
        if study.status()["state"] == "done" and study.definition.kind == "contact":
            found = study.open()["status"]
            words = dict(zip(found.flag_values.tolist(), found.flag_meanings.split(), strict=True))
            for value, word in words.items():
                count = int((found == value).sum())
                if count:
                    print(f"    {word}: {count}")
        return state

    return max(_attempt(lambda file=file: one(file), file) for file in options.files)


def plot(options) -> int:
    from .recipes import draw

    return max(
        _attempt(lambda name=name: _print_paths(draw(name, options.results, options.figures)), name)
        for name in options.names
    )


def table(options) -> int:
    from .tables import tabulate

    return max(
        _attempt(lambda name=name: _print_paths(tabulate(name, options.results, options.tables)), name)
        for name in options.names
    )


def _attempt(action, name: str) -> int:
    """Exit code of an action on one file; what is wrong with it does not keep the others from their turn."""
    from .definition import StudyError

    try:
        return action()
    except StudyError as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1


def _print_state(study) -> int:
    state, title = study.status(), study.definition.title
    blocks = f" ({state['blocks']} of {state['of']} blocks)" if state["state"] == "partial" else ""
    print(f"{study.definition.name:<16} {state['cases']:>8} cases  {state['state']}{blocks}  {title}")
    return 0


def _print_report(report, name: str) -> int:
    if report.failures:
        for block, reason in sorted(report.failures.items()):
            print(f"{name}: block {block} failed: {reason}", file=sys.stderr)
        print(
            f"{name}: {len(report.failures)} blocks failed; the others are kept, the same command tries again",
            file=sys.stderr,
        )
        return 1
    if not report.computed and not report.counts:
        print(f"{report.path} is up to date ({report.cases} cases), nothing to do")
        return 0
    unsolved = sum(count for value, count in report.counts.items() if value)
    remark = f", {unsolved} of them not converged: see `status` in the file" if unsolved else ""
    print(f"{report.path}: {report.cases} cases, {report.computed} computed now{remark}")
    return 0


def _print_paths(paths) -> int:
    print("\n".join(map(str, paths)))
    return 0


def _file(text: str) -> Path:
    """A path as given, or the name of a study in studies/."""
    short = STUDIES / f"{text}.toml"
    return short if not Path(text).exists() and short.exists() else Path(text)


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be a whole number > 0")
    return int(text)


def main(arguments=None) -> int:
    """Run one command; returns the exit code."""
    options = parser().parse_args(arguments)
    logging.basicConfig(
        level=logging.DEBUG if options.verbose else logging.WARNING, format="%(levelname)s %(name)s: %(message)s"
    )
    try:
        return options.function(options)
    except KeyboardInterrupt:
        print("\ninterrupted; finished blocks are kept, the same command goes on from there", file=sys.stderr)
        return 130
    except BrokenPipeError:  # the reader, `head` say, has enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


if __name__ == "__main__":
    sys.exit(main())
