"""What the commands answer, as text."""

from .definition import Definition
from .estimate import Estimate, describe
from .order import Report
from .vocabulary import NOT_RUN


def state_line(definition: Definition, state: dict) -> str:
    """ "fig04      2000 cases  partial (500 of 2000 cases)  title"."""
    cases, missing = state["cases"], state["counts"].get(NOT_RUN, 0)
    text = {"partial": " ({} of {} cases)", "outdated": " ({} of {} cases can be used again)"}.get(state["state"], "")
    done = text.format(cases - missing, cases) if state["counts"] else ""
    return f"{definition.name:<16} {cases:>8} cases  {state['state']}{done}  {definition.title}"


def cost_line(name: str, cost: Estimate) -> str:
    return f"{name}: {cost.cases} cases, {cost.present} of them computed; the others: {describe(cost)}"


def failure_lines(report: Report, name: str) -> list[str]:
    lines = [f"{name}: block {block} failed: {reason}" for block, reason in sorted(report.failures.items())]
    return [*lines, f"{name}: {len(lines)} blocks failed; the others are kept, the same command tries again"]


def report_line(report: Report, name: str) -> str:
    """What a run without failed blocks did."""
    if not report.counts and not report.computed:
        return f"{report.path} is up to date ({report.cases} cases), nothing to do"
    if not report.complete:
        missing = report.counts.get(NOT_RUN, 0)
        return f"{name}: {report.computed} cases computed now, {missing} of {report.cases} are missing: other parts"
    unsolved = sum(count for value, count in report.counts.items() if value)
    remark = f", {unsolved} of them not converged: see `status` in the file" if unsolved else ""
    return f"{report.path}: {report.cases} cases, {report.computed} computed now{remark}"
