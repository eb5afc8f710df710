"""Eight threads that solve, run, open, read lazily and query studies at the same time, for some seconds:

    python tools/fuzz/stress_threads.py SECONDS

Exit code 0 if nothing crashed and every number was right. It is a separate process, since a crash ends the interpreter.
"""

import shutil
import sys
import tempfile
import threading
import time
import traceback
from pathlib import Path

import numpy as np

import study
from study import api
from study.files import results_file
from study.files.examine import examine

MODEL = {"micro": "smooth", "base": "half_space"}
AXES = {"P": [1e-6 * i for i in range(1, 41)]}
TEXT = '[model]\nmicro = "smooth"\nbase = "half_space"\n[axes]\nP = {}\n[numerics]\nblock = 10\n[output]\nx = 9\n'


def right(contacts) -> bool:
    """Whether a is that of Hertz, (3P/4)^(1/3), within rtol 1e-6, which the iteration more than reaches."""
    exact = (0.75 * contacts.P.values) ** (1 / 3)
    return bool((contacts.status.values == 0).all() and np.allclose(contacts.a.values, exact, rtol=1e-6, atol=0))


def solving(folder: Path, number: int) -> None:
    assert right(study.solve(**MODEL, **AXES, x=9))


def running(folder: Path, number: int) -> None:
    """Run a study of this thread alone, started anew each time, then extended."""
    opened = written(folder, f"own{number}", AXES["P"][:20])
    (opened.results / f"own{number}.nc").unlink(missing_ok=True)
    shutil.rmtree(opened.results / f".own{number}.blocks", ignore_errors=True)
    assert opened.run(workers=1).complete
    report = written(folder, f"own{number}", AXES["P"]).run(workers=2)
    assert report.complete and report.computed == 20, report
    assert right(opened_of(folder, f"own{number}").open())


def reading(folder: Path, number: int) -> None:
    """Read a finished study, eagerly and from its file."""
    assert right(opened_of(folder, "shared").open())
    assert right(study.open_results(folder / "results" / "shared.nc"))


def lazily(folder: Path, number: int) -> None:
    dataset = opened_of(folder, "large").open()
    assert dataset.p.chunks and right(dataset.compute())
    assert float(dataset.p.max().compute(num_workers=2)) > 0


def asking(folder: Path, number: int) -> None:
    state = opened_of(folder, "shared").status()
    assert (state["state"], state["counts"]) == ("done", {0: 40}), state
    assert opened_of(folder, "shared").run(workers=1).computed == 0
    state = opened_of(folder, "own0").status()
    assert state["state"] in ("done", "partial", "outdated", "new"), state


def written(folder: Path, name: str, loads: list) -> study.Study:
    """The study of a file that is written under another name and moved: `asking` may read it at any time, but whole."""
    new_file = folder / f"{name}.toml.new"
    new_file.write_text(TEXT.format(loads), encoding="utf-8")
    new_file.replace(folder / f"{name}.toml")
    return opened_of(folder, name)


def opened_of(folder: Path, name: str) -> study.Study:
    return study.load(folder / f"{name}.toml", folder / "results")


def main(seconds: float) -> int:
    faults, end = [], time.monotonic() + seconds
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for size, loads in (("shared", AXES["P"]), ("large", [*AXES["P"], 1e-3])):
            written(folder, size, loads).run(workers=1)
        api.LAZY = results_file.LAZY = examine(folder / "results" / "large.nc").unpacked - 1
        for path in ("shared", "own0", "own1"):
            written(folder, path, AXES["P"])

        def turn(work, number: int) -> None:
            turns = 0
            try:
                while not turns or time.monotonic() < end:
                    work(folder, number)
                    turns += 1
            except BaseException:
                faults.append(f"{work.__name__}, turn {turns}: {traceback.format_exc()}")

        works = [running, running, reading, reading, lazily, lazily, asking, solving]
        threads = [threading.Thread(target=turn, args=(work, number)) for number, work in enumerate(works)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    print("\n".join(faults))
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1])))
