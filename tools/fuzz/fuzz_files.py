"""Random bit flips over results and block files of five studies; seeded, 10,000 by default:

    python tools/fuzz/fuzz_files.py [FLIPS [SEED]]

After each flip in a results file, or in a block of a stopped run, `status`, `open`, `verify` and `run` must end without
a traceback, and every number that they return must be the one that was computed. Half of the damaged results files get
a seal that fits, so that only netCDF and the digest can find the damage. HDF5 may end the interpreter on such a file,
which is counted but is no fault. Exit code 0 if there is no fault.
"""

import json
import logging
import os
import random
import shutil
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr

import study
from study.files import seal
from study.files.examine import examine
from study.store.blocks import inventory
from study.store.windows import Store

CONTACT = '[model]\nmicro = "smooth"\nbase = "half_space"\n{model}\n[axes]\n{axes}\n[numerics]\nblock = {block}\n'
STUDIES = {
    "one": CONTACT.format(model="P = 1e-5", axes="", block=1) + "[output]\nx = 9\n",
    "twelve": CONTACT.format(model="", axes="P = [1e-6, 2e-6, 4e-6]\nrtol = [1e-3, 1e-4, 1e-5, 1e-6]", block=5),
    "many": CONTACT.format(model="", axes="P = {start = 1e-6, stop = 1e-4, num = 2400}", block=400)
    + "[output]\nprofiles = ['lam']\nx = 3\n",
    "law": CONTACT.replace("smooth", "square_lattice")
    .replace("half_space", "thin_layer")
    .format(
        model="h = 0.02\nn = 0.5\nRa = 0.004\nNbar = 250000",
        axes="P = {start = 1e-6, stop = 1e-4, num = 30}",
        block=10,
    )
    + "[output]\nx = 5\n",
    "scalars": CONTACT.format(model="", axes="P = {start = 1e-6, stop = 1e-4, num = 30}", block=10)
    + "[output]\nprofiles = false\n",
}
#: A process that opens a damaged file is ended after so many seconds: HDF5 may read on for ever.
ENDLESS = 60
SEALED, ENDED = 0.5, "ended by HDF5"


class Example:
    """A finished study, its results file and its blocks, as they were written."""

    def __init__(self, name: str, folder: Path):
        (folder / f"{name}.toml").write_text(STUDIES[name], encoding="utf-8")
        self.opened = study.load(folder / f"{name}.toml", folder / "results")
        self.path = folder / "results" / f"{name}.nc"
        self.opened.run(workers=1)
        self.file, self.expected = self.path.read_bytes(), self.opened.open()
        store = Store(self.opened.definition, self.opened.results)
        self.folder = store.folder
        self.blocks = {path.name: path.read_bytes() for path in inventory(store).blocks}

    def restore(self, with_results: bool) -> None:
        """Restore the folder as a finished run leaves it, or as a run that was stopped before its end."""
        shutil.rmtree(self.opened.results)
        self.folder.mkdir(parents=True)
        for name, data in self.blocks.items():
            (self.folder / name).write_bytes(data)
        if with_results:
            self.path.write_bytes(self.file)

    def check(self, contact: xr.Dataset, what: str) -> None:
        """Check that all numbers, coordinates, units and meanings are those that were computed."""
        if set(contact.variables) != set(self.expected.variables):
            raise AssertionError(f"{what}: other variables")
        # blocks of other sizes sum in another order: 1e-12; error and residual are differences of nearly equal numbers
        for name in set(self.expected.variables) - {"error", "residual", "model_error"}:
            values, expected = contact[name], self.expected[name]
            same = values.dims == expected.dims and repr(values.attrs) == repr(expected.attrs)
            numbers = values.dtype.kind == "f"
            near = (
                np.allclose(values, expected, 1e-12, 0, equal_nan=True)
                if numbers
                else (values.values == expected.values).all()
            )
            if not (same and near):
                raise AssertionError(f"{what}: {name} is silently wrong")
        if "status" in contact and not np.isfinite(contact.a.values[contact.status.values == 0]).all():
            raise AssertionError(f"{what}: NaN with status 0")


def flipped(data: bytes, chance: random.Random) -> bytes:
    changed = bytearray(data)
    changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def attempt(function, refusals: Counter):
    """What a function returns; None, counted, when it refuses with a message."""
    try:
        return function()
    except (study.StudyError, OSError) as error:
        if not str(error) or "\n" in str(error).strip():
            raise AssertionError(f"no message of one line: {error!r}") from error
        refusals[function.__name__] += 1
        return None


def flip_results(example: Example, chance: random.Random, seen: Counter) -> None:
    example.restore(with_results=True)
    if sealed := chance.random() < SEALED:
        example.path.write_bytes(flipped(example.file[: -seal.LENGTH], chance))
        seal.seal(example.path)
    else:
        example.path.write_bytes(flipped(example.file, chance))
    opened = example.opened
    state = opened.status()
    if state["state"] not in ("done", "damaged", "foreign") + ("outdated",) * sealed:
        raise AssertionError(f"status says {state['state']}")
    kind = examine(example.path).kind
    results = attempt(opened.open, seen)
    if results is not None:
        example.check(results, f"open, {kind}")
    if (results is None) != (kind in ("damaged", "foreign")) and state["state"] != "outdated":
        raise AssertionError(f"open and verify disagree: {kind}")
    report = attempt(opened.run, seen)
    seen[f"{kind}, sealed anew" if sealed else kind] += 1
    if report is None:
        if kind not in ("foreign", "unreadable"):
            raise AssertionError("run did not mend")
        return
    example.check(opened.open(), "open after run")
    if not report.complete or report.computed or opened.verify().kind not in ("sound", kind):
        raise AssertionError("run did not mend")
    if kind == "damaged" and not list(opened.results.glob("*.nc.damaged")):
        raise AssertionError("the damaged file was not kept")


def flip_block(example: Example, chance: random.Random, seen: Counter) -> None:
    example.restore(with_results=False)
    path = example.folder / chance.choice(sorted(example.blocks))
    path.write_bytes(flipped(path.read_bytes(), chance))
    state = example.opened.status()
    if state["state"] not in ("partial", "new") or not state["counts"].get(127):
        raise AssertionError(f"a damaged block is not noticed: {state}")
    report = example.opened.run(workers=1)
    if not report.complete or report.computed != state["counts"][127]:
        raise AssertionError("run computed other cases than those of the damaged block")
    example.check(example.opened.open(), "open after run")
    seen["block"] += 1


def in_a_process(flip, example: Example, seed: float, seen: Counter, output: Path) -> str:
    """Run `flip` in a separate process; returns the fault or "". Damaged files corrupt the memory of HDF5: after some
    hundred of them in one process it ends the interpreter."""
    chance = random.Random(seed)
    may_end = flip is flip_results and random.Random(seed).random() < SEALED
    child = os.fork()
    if not child:
        counts, fault = Counter(), ""
        signal.alarm(ENDLESS)
        try:
            flip(example, chance, counts)
        except Exception:
            fault = traceback.format_exc()
        output.write_text(json.dumps([counts, fault]), encoding="utf-8")
        os._exit(0)
    _, ending = os.waitpid(child, 0)
    if ending:
        seen[ENDED] += may_end
        return "" if may_end else f"the process ended by signal {ending}"
    counts, fault = json.loads(output.read_text(encoding="utf-8"))
    seen.update(counts)
    return fault


def main(flips: int, seed: int) -> int:
    chance, faults = random.Random(seed), []
    warnings.simplefilter("ignore")
    logging.disable()
    os.fsync = lambda _: None  # it takes most of the time, and no power is cut here
    with tempfile.TemporaryDirectory() as name:
        for kind in STUDIES:
            folder = Path(name) / kind
            folder.mkdir()
            example, seen = Example(kind, folder), Counter()
            for number in range(flips // len(STUDIES)):
                flip = flip_block if example.blocks and number % 4 == 3 else flip_results
                fault = in_a_process(flip, example, chance.random(), seen, Path(name) / "said")
                if fault:
                    faults.append(f"{kind}, flip {number}: {fault}")
            print(f"{kind}: {dict(seen)}", flush=True)
    print("\n".join(faults[:10]), f"{len(faults)} faults in {flips} flips, seed {seed}", sep="\n")
    return bool(faults)


if __name__ == "__main__":
    arguments = [int(word) for word in sys.argv[1:]]
    sys.exit(main(*(arguments + [10_000, 1][len(arguments) :])))
