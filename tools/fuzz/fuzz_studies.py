"""Mutated study files through the command line: `python tools/fuzz/fuzz_studies.py [COUNT [SEED]]`, 5,000 by default.

Each is a study of the repository, made small, with a few changes: bytes flipped, lines dropped, doubled and swapped,
values replaced by nasty ones, keys misspelled, types changed. All are checked; some of the accepted ones are estimated
(--dry-run) and some are run. Every file must give exit code 0 or 2, no exception, no warning, readable messages, and an
answer in time and within bounded memory.
"""

import contextlib
import io
import os
import random
import re
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 60  # seconds of this process for one file: the slowest file takes some seconds, and more than this is a hang
MEMORY = 6_000_000_000  # bytes that the process may allocate: its libraries and tables need half of them
LONGEST = 31 * 1000  # characters of all messages: thirty, and the number of further ones
FEW = 100  # cases of a study that is estimated or run
ESTIMATED, RUN = 10, 20  # one of so many accepted files is estimated, or run
NASTY = (
    "1e308", "-1e308", "5e-324", "1e-300", "1e400", "nan", "inf", "-inf", "0", "-0.0", "-1", "1.5", "true", '""', '"x"',
    '"\\u001b[31m"', '"\\u0000"', "[]", "{}", "[[]]", "[1, [2]]", "[1e-6, nan]", "[true]", '["x", 1]', "1979-05-27",
    "9" * 5000, "0x" + "f" * 5000, "1" + "0" * 400, "[" * 2000, "{start = 1, stop = 2, num = 3}",
    "{start = -1e308, stop = 1e308, num = 5}", "{start = 1e-308, stop = 1e308, num = 9, spacing = 'log'}",
    "{start = 0, stop = 1, num = 1000000}", "{start = 1, stop = 2}", "{num = 3}", '"layered"', '"picard"', '"auto"',
)  # fmt: skip
LINES = (
    "[model]", "[axes]", "[[cases]]", "[sample]", "[numerics]", "[output]", "[fit]", "x = 2", "block = 0", "size = 7",
    "profiles = []", "P = 1e-5", "a = [0.01, 0.02]", "D = 1e-4", "h = nan", "nodes = 17", 'kind = "micro_law"',
    'dtype = "float32"', ".".join(["a"] * 20_000) + " = 1", "[" + ".".join(["a"] * 20_000) + "]", "= 1", "\x00",
    'shape = "cone"', 'half_angle = "70.3 ± 0.3 deg"', 'shape = "Berkovich"', 'shape = "flat"', "flat_radius = 0.01",
    "edge_radius = 0.1", 'shape = "table:none.csv"', "w_adhesion = 1e-7", 'adhesion = "maugis"', "sigma0 = 1e-3",
    'branch = "unstable"', "k_machine = 0.1", "[[layers]]", 'base = "stack"', 'tip = "sphere"',
)  # fmt: skip
#: Studies of shapes, adhesion and stacks, besides those of the repository.
MORE = (
    '[model]\nbase = "half_space"\nmicro = "smooth"\nshape = "cone"\n[axes]\nP = [1e-5, 1e-4]\nhalf_angle = [60, 70]\n',
    '[model]\nh = 0.1\nn = 0.5\nmicro = "smooth"\nshape = "blunt_cone"\nhalf_angle = 75\ntip_radius = 0.1\n'
    'tip = "sphere"\n[axes]\nD = [1e-3, 1e-2]\n',
    '[model]\nbase = "half_space"\nmicro = "disc_cell"\nNbar = 250000\nRa = 0.004\nshape = "rounded_flat"\n'
    "flat_radius = 0.02\nedge_radius = 0.1\nP = 1e-4\n",
    '[model]\nbase = "half_space"\nmicro = "smooth"\nw_adhesion = 1e-7\nadhesion = "jkr"\nk_machine = 0.1\n'
    '[axes]\nP = [-1e-7, 0.0, 1e-6]\nbranch = ["stable", "unstable"]\n',
    '[model]\nbase = "half_space"\nmicro = "smooth"\nw_adhesion = 1e-7\nadhesion = "dmt"\nD = 1e-3\n',
    '[model]\nbase = "stack"\nmicro = "smooth"\nshape = "sphere"\nP = 1e-4\n[[layers]]\nh = 0.01\nn = 2\n'
    "nu = 0.3\n[[layers]]\nh = 0.1\nn = 0.5\nnu = 0.4\n",
)


class Hang(BaseException):
    """A hang. It is no Exception, so that no handler on its way can catch it."""


def bases() -> list[str]:
    """The studies of the repository with few points."""

    def few(match: re.Match) -> str:
        return f"{match[1]}{min(int(match[2].replace('_', '')), 3)}"

    texts = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "studies").glob("*/*.toml"))]
    texts += MORE
    return [re.sub(r"\b((?:num|size)\s*=\s*)([\d_]+)", few, text) for text in texts]


def mutated(chance: random.Random, text: str) -> bytes:
    """The text with one to four changes."""
    changes = chance.choice((CHANGES, MILD))
    for _ in range(chance.randint(1, 4)):
        lines = text.split("\n")
        at = chance.choice([i for i, line in enumerate(lines) if line.strip()] or [0])
        text = "\n".join(chance.choice(changes)(chance, lines, at))
    raw = bytearray(text.encode("utf-8", "surrogateescape"))
    if chance.random() < 0.1 and raw:
        for _ in range(chance.randint(1, 3)):
            raw[chance.randrange(len(raw))] ^= 1 << chance.randrange(8)
    return bytes(raw)


def _value(chance, lines, at):
    """Another value, of any type, or the same one within a list, a table or quotes."""
    key, equals, value = lines[at].partition("=")
    same = value.strip()
    new = chance.choice((*NASTY, f"[{same}]", f"{{x = {same}}}", f'"{same}"', f"-{same}", value * 2))
    return [*lines[:at], f"{key}= {new}" if equals else new, *lines[at + 1 :]]


def _key(chance, lines, at):
    """A letter more, less, or another."""
    key, equals, value = lines[at].partition("=")
    place = chance.randrange(len(key) + 1)
    new = key[:place] + chance.choice(("", "x", ".", '"', "é", " ")) + key[place + chance.randint(0, 1) :]
    return [*lines[:at], new + equals + value, *lines[at + 1 :]]


def _number(chance, lines, at):
    """Another number, of about the same size or of another."""
    numbers = list(re.finditer(r"\d[\d_]*\.?\d*(?:e[-+]?\d+)?", lines[at]))
    if not numbers:
        return lines
    number = chance.choice(numbers)
    value = float(number[0].replace("_", "")) * 10 ** chance.choice((0.1, -0.1, 1, -1, 4, -4))
    new = f"{value:.4g}" if "." in number[0] or "e" in number[0] else str(min(int(value), 10**18))
    return [*lines[:at], lines[at][: number.start()] + new + lines[at][number.end() :], *lines[at + 1 :]]


def _word(chance, lines, at):
    """Another word of the vocabulary in place of a text."""
    words = ("frictionless", "bonded", "layered", "thin_layer", "half_space", "auto", "disc_cell", "smooth", "newton",
             "cone", "sphere", "flat", "rounded_flat", "stack", "jkr", "dmt", "maugis", "unstable")  # fmt: skip
    return [*lines[:at], re.sub(r'"\w+"', f'"{chance.choice(words)}"', lines[at], count=1), *lines[at + 1 :]]


MILD = (_number, _number, _word, lambda chance, lines, at: [*lines[:at], *lines[at + 1 :]])
CHANGES = (
    lambda chance, lines, at: lines[:at] + lines[at + 1 :],
    lambda chance, lines, at: lines[: at + 1] + lines[at:],
    lambda chance, lines, at: lines[:at] + [chance.choice(LINES)] + lines[at:],
    lambda chance, lines, at: lines[at:] + lines[:at],
    lambda chance, lines, at: [*lines[:at], lines[at][: chance.randrange(len(lines[at]) + 1)]],
    _key, _key, _value, _value, _value,
)  # fmt: skip


def exit_and_messages(arguments: list[str]) -> tuple[int, str]:
    """Exit code of a command and its output on stderr."""
    from study.__main__ import main

    errors = io.StringIO()
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(errors), warnings.catch_warnings():
        warnings.simplefilter("error")
        return main(arguments), errors.getvalue()


def fault(arguments: list[str]) -> tuple[int, str]:
    """Exit code of a command, and the fault in its end; "" without a fault."""

    def hang(*_):
        raise Hang

    before = signal.signal(signal.SIGVTALRM, hang)
    # Time of this process, since others may be busy. Repeated, since an error raised while an object is deleted is
    # lost.
    signal.setitimer(signal.ITIMER_VIRTUAL, PATIENCE, PATIENCE)
    try:
        code, text = exit_and_messages(arguments)
    except (Exception, SystemExit, Hang) as error:
        return 1, f"{type(error).__name__}: {str(error)[:300]}"
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
    if code not in (0, 2) or len(text) > LONGEST or bool(code) != bool(text.strip()) and "run" not in arguments:
        return code, f"exit code {code}, {len(text)} characters: {text[:300]}"
    return code, ""


def faults(count: int, seed: int, folder: Path, done: Counter) -> list[str]:
    """The faults in the ends of the commands; `done` counts the commands by exit code."""
    from study.inputs.reading import read

    texts_of_faults, texts, file = [], bases(), folder / "mutated.toml"
    for number in range(count):
        chance = random.Random(f"{seed} {number}")
        file.write_bytes(mutated(chance, chance.choice(texts)))
        code, wrong = fault(["check", str(file)])
        done[f"check {code}"] += 1
        commands = []
        if not code and read(file).grid.size <= FEW:
            commands += [["run", str(file), "--dry-run"]] * (chance.randrange(ESTIMATED) == 0)
            commands += [["run", str(file)]] * (chance.randrange(RUN) == 0)
        for command in commands:
            results = ["--workers", "1", "--results", str(folder / str(number))]
            code, second_fault = fault([*command, *results])
            done[f"{' '.join(command[::2])} {code}"] += 1
            wrong = wrong or second_fault
        if wrong:
            copy_of_file = folder / f"fault{number}.toml"
            copy_of_file.write_bytes(file.read_bytes())
            texts_of_faults.append(f"{copy_of_file}: {wrong}")
    return texts_of_faults


def main() -> int:
    count, seed = ([int(word) for word in sys.argv[1:]] + [5000, 0][len(sys.argv) - 1 :])[:2]
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    start, done = time.monotonic(), Counter()
    texts = faults(count, seed, Path(tempfile.mkdtemp(prefix="fuzz_studies")), done)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024) / 1e9
    print(*texts, sep="\n")
    print(f"{count} study files in {time.monotonic() - start:.0f} s, {peak:.2f} GB: {len(texts)} faults", dict(done))
    return min(len(texts), 1)


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    sys.exit(main())
