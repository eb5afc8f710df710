"""Pages of text with Python in them: what stands in a block is run, what it prints is the block of text after it."""

import re
from pathlib import Path

from children import PATIENCE, run_forked
from conftest import ROOT

PAGES = (
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    *sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").glob("*.md")),
)
_END = "-- end of block --"
_SCRIPT = """
import os, sys, traceback, warnings
os.chdir({folder!r})
os.environ["MPLBACKEND"] = "agg"
warnings.simplefilter("error", FutureWarning)
try:
    exec({code!r}, {{"__name__": "__main__"}})
except BaseException:
    traceback.print_exc(file=sys.stdout)
"""


def read(page: str) -> str:
    """The text of a page, by its path in the repository."""
    return (ROOT / page).read_text(encoding="utf-8")


def blocks(page: str, language: str) -> list[str]:
    """Its blocks of one language."""
    return re.findall(rf"^```{language}\n(.*?)^```", read(page), flags=re.DOTALL | re.MULTILINE)


def examples(page: str) -> list[tuple[str, str]]:
    """Each Python block with the text block that follows it, or "" if none does."""
    return re.findall(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```)?", read(page), flags=re.DOTALL | re.MULTILINE)


def check_examples(page: str, folder: Path, most: int | None = None) -> None:
    """Run the Python of a page, or its first blocks, in `folder`, in one process; compare what it prints.

    The process is forked from one that has imported `study`: an interpreter that starts takes a second or two longer.
    """
    found = examples(page)[:most]
    script = _SCRIPT.format(folder=str(folder), code="".join(f"{code}\nprint({_END!r})\n" for code, _ in found))
    *outputs, rest = run_forked([script], input=b"", timeout=PATIENCE).stdout.decode().split(_END + "\n")
    assert len(outputs) == len(found), f"after {len(outputs)} blocks: {rest}"
    for (code, text), printed in zip(found, outputs, strict=True):
        assert not text or same(printed.split(), text.split()), f"{code}\nprints\n{printed}\nnot\n{text}"


#: The share of itself by which a printed number may differ. The solver's numbers on other processors differ by 1e-9 at
#: most, the SAME of tests/rough/errors/test_golden_numbers.py. That moves the last of six digits in one number of a
#: thousand, and that of three digits in one of a million. One in the last of three digits is more than 1e-3, and so a
#: wrong page. Under four kernels of OpenBLAS (`make kernels`) all pages are the same to the last digit.
_SHARE = 1e-3


def same(printed: list[str], expected: list[str]) -> bool:
    """Whether two lists of words are the same; numbers of four digits or more may differ by one in the last decimal."""
    return len(printed) == len(expected) and all(map(_same_word, printed, expected))


def _same_word(printed: str, expected: str) -> bool:
    """Words and whole numbers are equal. Decimal numbers may differ by one in the last, and by _SHARE of themselves."""
    mantissa, _, exponent = expected.partition("e")
    decimals = mantissa.partition(".")[2]
    if printed == expected or not decimals:
        return printed == expected
    try:
        difference, known = abs(float(printed) - float(expected)), abs(float(expected))
        last = 10.0 ** (int(exponent or 0) - len(decimals))
    except ValueError:
        return False
    return len(printed) == len(expected) and difference < 1.01 * last and difference <= _SHARE * known
