"""The answers of the commands as text."""

from ..data.dataset import NO_SOLUTION, status_words
from ..files.examine import Condition
from ..spec.definition import Definition
from ..spec.vocabulary import NOT_RUN
from ..terminal import counted, on_one_line
from ..work.cost import Estimate, describe
from ..work.plan import Report


def state_line(definition: Definition, state: dict) -> str:
    """ "fig04      2000 cases  partial (500 of 2000 cases)  title".

    Of a study with spreads the first number counts every solution, as `run` does. The statuses of complete results are
    those of the inputs as they were given: so the line says how many these are.
    """
    cases, missing = state["cases"], state["counts"].get(NOT_RUN, 0)
    text = {"partial": " ({} of {} cases)", "outdated": " ({} of {} cases can be used again)"}.get(state["state"], "")
    done = text.format(cases - missing, cases) if state["counts"] else ""
    each = f" ({cases // definition.times}, each {definition.times} times for ±)" if definition.times > 1 else ""
    line = f"{definition.name:<16} {cases:>8} cases{each}  {state['state']}{done}  {on_one_line(definition.title, 200)}"
    return line + f"\n    {state['path']}: {state['reason']}" * bool(state["reason"])


def verified_line(name: str, found: Condition) -> str:
    """What `verify` found."""
    said = {
        "sound": "verified, every number is the one that was written",
        "unverified": "xarray or an earlier version wrote it, without checksums to compare; nothing wrong was seen",
        "missing": "does not exist",
    }
    return f"{name}: {said.get(found.kind, found.reason)}"


def cost_line(name: str, cost: Estimate) -> str:
    return f"{name}: {counted(cost.cases, 'case')}, {cost.present} of them computed; the others: {describe(cost)}"


def failure_lines(report: Report, name: str) -> list[str]:
    lines = [f"{name}: block {block} failed: {reason}" for block, reason in sorted(report.failures.items())]
    return [*lines, f"{name}: {counted(len(lines), 'block')} failed; the others are kept, the same command tries again"]


def report_line(report: Report, name: str) -> str:
    """What a run without failed blocks did."""
    kept = f"\n{report.kept}" if report.kept else ""
    if not report.counts and not report.computed:
        return f"{report.path} is up to date ({counted(report.cases, 'case')}), nothing to do{kept}"
    if not report.complete:
        missing = report.counts.get(NOT_RUN, 0)
        now = counted(report.computed, "case")
        return f"{name}: {now} computed now, {missing} of {report.cases} are missing: other parts"
    refused = {value: count for value, count in report.counts.items() if value in NO_SOLUTION}
    failed = {value: count for value, count in report.counts.items() if value and value not in NO_SOLUTION}
    remarks = [f"{report.path}: {counted(report.cases, 'case')}", f"{report.computed} computed now"]
    if refused:
        remarks.append(f"{by_status(refused)}: no solution exists, which is no failure")
    if failed:
        remarks.append(f"{sum(failed.values())} of them not converged ({by_status(failed)}): see `status` in the file")
    return ", ".join(remarks) + kept


def by_status(counts: dict[int, int]) -> str:
    """ "896 thin_layer_not_applicable, 5 lift_off"."""
    return ", ".join(f"{count} {status_words()[value]}" for value, count in sorted(counts.items()))
