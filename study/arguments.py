"""What the words of a command line stand for: study files, numbers, parts."""

import argparse
from pathlib import Path

STUDIES = Path("studies")


def study_file(text: str) -> Path:
    """The study file at a path, or of a study in studies/ by its name. Raises StudyError when there is none."""
    from .definition import StudyError
    from .vocabulary import suggest

    given, short = Path(text), STUDIES / f"{text}.toml"
    by_path = given.suffix == ".toml"
    for path in (given,) if by_path else (given, short):
        if path.exists():
            return path
    folders = [given.parent, STUDIES] if by_path else [STUDIES]
    known = [path.as_posix() if by_path else path.stem for folder in folders for path in sorted(folder.glob("*.toml"))]
    looked = "" if by_path else f" (looked for {given.as_posix()} and {short.as_posix()})"
    raise StudyError([f"{text}: not found{looked}{suggest(text, known) if known else ''}"])


def positive(text: str) -> int:
    """A whole number > 0."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be a whole number > 0")
    return int(text)


def part(text: str) -> tuple[int, int]:
    """I/N, the I-th of N parts."""
    numbers = text.split("/")
    if len(numbers) != 2 or not all(map(str.isdecimal, numbers)) or not 1 <= int(numbers[0]) <= int(numbers[1]):
        raise argparse.ArgumentTypeError(f"{text}: must be I/N, whole numbers with 1 <= I <= N")
    return int(numbers[0]), int(numbers[1])
