"""The commands that compute studies and look at results. Each takes one file and returns an exit code."""

import sys
from pathlib import Path

from ..api import Study, load
from ..data.dataset import status_words
from ..files.examine import examine
from ..in_words import doubts
from ..spec.definition import StudyError
from ..terminal import answer, say
from ..work.plan import status_values
from .answers import cost_line, failure_lines, report_line, state_line, verified_line
from .arguments import STUDIES, packaged, study_file
from .checking import doubtful_lines


def items(options) -> list:
    """The files for which the command is called: those that were given, or of `list` those in a folder."""
    if options.command != "list":
        return options.items
    folder = Path(options.folder) if options.folder else STUDIES if STUDIES.is_dir() else packaged()
    files = sorted(folder.glob("*.toml")) if folder.is_dir() else [folder]
    if not files:
        answer(f"no study files in {folder.as_posix()}")
    return files


def list_(options, file: Path) -> int:
    """Say the size and the state of a study."""
    if file.suffix != ".toml":
        raise StudyError([f"{file.as_posix()}: is no folder"])
    study = load(file, options.results)
    return answer(state_line(study.definition, study.status()))


def status(options, file: str) -> int:
    """Say what has been computed."""
    study = _opened(options, file)
    state = study.status(options.yes)
    counts = (f"    {status_words()[value]}: {count}" for value, count in state["counts"].items())
    return answer(state_line(study.definition, state), *counts)


def run(options, file: str) -> int:
    """Compute what is missing, or say what that would cost."""
    study = _opened(options, file)
    for line in doubtful_lines(study.definition):
        say(line, sys.stderr)
    if options.dry_run:
        return _dry_run(study, options)
    return _compute(study, options, part=options.part, force=options.force)


def _dry_run(study: Study, options) -> int:
    """Say what a run would cost, and that it would be refused; the exit code is then that of the run."""
    name, cost = study.definition.name, study.dry_run(options.workers, options.yes, options.force)
    code = answer(cost_line(name, cost))
    if cost.refused is None:
        return code
    say(f"{name}: `run` would be refused: {cost.refused}", sys.stderr)
    return max(code, cost.refused.code)


def retry(options, file: str) -> int:
    """Compute cases of some status again."""
    return _compute(_opened(options, file), options, retry=status_values(options.status))


def verify(options, file: str) -> int:
    """Compare results with their checksums."""
    found = examine(file) if Path(file).suffix == ".nc" else _opened(options, file).verify()
    say(verified_line(found.path, found), sys.stdout if found.good else sys.stderr)
    return 0 if found.kind == "sound" else 2 if found.kind == "missing" else 1


def clean(options, file: str) -> int:
    """Remove blocks that serve nothing, and say which."""
    answer(*_opened(options, file).clean())
    return 0


def _opened(options, file: str) -> Study:
    return load(study_file(file), options.results)


def _compute(study: Study, options, **more) -> int:
    chosen = {name: getattr(options, name) for name in ("workers", "scheduler", "fail_fast", "yes")}
    return completed(study, **chosen, **more)


def completed(study: Study, **options) -> int:
    """Run a study and say what came of it; returns the exit code."""
    name, report = study.definition.name, study.run(**options, processes=True, stream=sys.stderr)
    if report.failures:
        say("\n".join(failure_lines(report, name)), sys.stderr)
        return 1
    answer(report_line(report, name))
    if study.definition.scene and report.complete and report.computed:  # what study.solve would warn of
        said = doubtful_lines(study.definition)  # by `run`, before it computed
        for line in (f"{name}: beware: {text}" for text in doubts(study.open())):
            if line not in said:
                say(line, sys.stderr)
    return 0
