"""The commands that compute studies and examine results, and their output. Each takes one file."""

import sys
from pathlib import Path

from ..api import Study, load
from ..data.dataset import NO_SOLUTION, status_words
from ..files.examine import Condition, examine
from ..files.parts_folder import named
from ..in_words import doubts
from ..inputs.definition import Definition, StudyError
from ..inputs.places import STUDIES, chapter, files_here, files_in, packaged, study_file
from ..inputs.vocabulary import NOT_RUN
from ..terminal import answer, counted, on_one_line, say
from ..work.cost import Estimate, describe
from ..work.plan import Report, status_values


def items(options) -> list:
    """The files for which the command is called. `list` takes those in a folder, by default in the working folder and
    in `studies`."""
    if options.command != "list":
        return options.items
    folder = STUDIES if STUDIES.is_dir() else packaged()
    if options.folder:
        folder = chapter(options.folder) or Path(options.folder)
    files = files_in(folder) if folder.is_dir() else [folder]
    files = files if options.folder else [*files_here(), *files]
    if not files:
        answer(f"no study files in {folder.as_posix()}")
    return files


def list_(options, file: Path) -> int:
    """Say the size and the state of a study."""
    if file.suffix != ".toml":
        raise StudyError([f"{file.as_posix()}: is not a folder"])
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
    from .checking import doubtful_lines

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
    """Compare results with their digest."""
    condition = named(examine(file)) if Path(file).suffix == ".nc" else _opened(options, file).verify()
    say(verified_line(condition.path, condition), sys.stdout if condition.good else sys.stderr)
    return 0 if condition.kind == "sound" else 2 if condition.kind == "missing" else 1


def clean(options, file: str) -> int:
    """Remove blocks that hold no case of a study, and say which."""
    answer(*_opened(options, file).clean())
    return 0


def _opened(options, file: str) -> Study:
    return load(study_file(file), options.results)


def _compute(study: Study, options, **more) -> int:
    chosen = {name: getattr(options, name) for name in ("workers", "scheduler", "fail_fast", "yes")}
    return completed(study, **chosen, **more)


def completed(study: Study, **options) -> int:
    """Run a study and say what came of it; returns the exit code."""
    name, report = study.definition.name, study.run(**options, stream=sys.stderr)
    if report.failures:
        say("\n".join(failure_lines(report, name)), sys.stderr)
        return 1
    answer(report_line(report, name))
    in_parts = report.path.is_dir()  # parts are too large to be read again: their `validity` has the flags
    if study.definition.scene and report.complete and report.computed and not in_parts:  # as study.solve warns
        from .checking import doubtful_lines

        earlier_lines = doubtful_lines(study.definition)  # `run` wrote these before it computed
        for line in (f"{name}: beware: {text}" for text in doubts(study.open())):
            if line not in earlier_lines:
                say(line, sys.stderr)
    return 0


def state_line(definition: Definition, state: dict) -> str:
    """ "fig04                  2000 cases  partial (500 of 2000 cases)  title"."""
    cases, missing = state["cases"], state["counts"].get(NOT_RUN, 0)
    text = {"partial": " ({} of {} cases)", "outdated": " ({} of {} cases can be used again)"}.get(state["state"], "")
    done = text.format(cases - missing, cases) if state["counts"] else ""
    number = f"{cases:>6} {'cases' if cases != 1 else 'case '}"
    line = f"{definition.name:<20} {number}  {state['state']}{done}  {on_one_line(definition.title, 200)}"
    return line + f"\n    {state['path']}: {state['reason']}" * bool(state["reason"])


def verified_line(name: str | Path, condition: Condition) -> str:
    """The words of `verify` on a results file."""
    texts = {
        "sound": "verified: every number is as it was written"
        + f"; it holds results of the study {condition.name}" * (condition.name not in ("", Path(name).stem)),
        "unverified": "xarray or an earlier version wrote it, without a digest to compare; no damage was found",
        "missing": "does not exist",
    }
    return f"{name}: {texts.get(condition.kind, condition.reason)}"


def cost_line(name: str, cost: Estimate) -> str:
    return f"{name}: {counted(cost.cases, 'case')}, {cost.present} of them computed; the others: {describe(cost)}"


def failure_lines(report: Report, name: str) -> list[str]:
    lines = [f"{name}: block {block} failed: {reason}" for block, reason in sorted(report.failures.items())]
    return [
        *lines,
        f"{name}: {counted(len(lines), 'block')} failed; the others are kept, and the same command tries again",
    ]


def report_line(report: Report, name: str) -> str:
    """The work of a run without failed blocks, in words."""
    if not report.counts and not report.computed:
        return f"{report.path} is up to date ({counted(report.cases, 'case')}), nothing to do"
    if not report.complete:
        missing = report.counts.get(NOT_RUN, 0)
        now = counted(report.computed, "case")
        return f"{name}: {now} computed now, {missing} of {report.cases} are left to other parts"
    refused = {value: count for value, count in report.counts.items() if value in NO_SOLUTION}
    failed = {value: count for value, count in report.counts.items() if value and value not in NO_SOLUTION}
    remarks = [f"{report.path}: {counted(report.cases, 'case')}", f"{report.computed} computed now"]
    if refused:
        remarks.append(f"{by_status(refused)}: no solution exists, which is not a failure")
    if failed:
        remarks.append(f"{sum(failed.values())} of them not converged ({by_status(failed)}): see `status` in the file")
    return ", ".join(remarks)


def by_status(counts: dict[int, int]) -> str:
    """ "896 thin_layer_not_applicable, 5 lift_off"."""
    return ", ".join(f"{count} {status_words()[value]}" for value, count in sorted(counts.items()))
