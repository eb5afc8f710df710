"""Runs from the command line that are killed at random moments; seeded, 40 kills by default, which takes minutes:

    python tools/fuzz/kill_runs.py [KILLS [SEED [parts]]]

A run that has ended before its kill is started anew, from nothing or with its results removed. At the end the results
must have the same digest as those of an undisturbed run; the exit code is then 0. With `parts` the study has many
windows, and blocks of more than a tenth of a second are on the disk.
"""

import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import study
from study.files.results_file import numbers_digest
from study.work.processes import python_command

TEXT = """
[model]
micro = "smooth"
n = 0.5
base = "thin_layer"
[axes]
h = [0.001, 0.002, 0.003]
P = { start = 1e-6, stop = 1e-4, num = 2000 }
[numerics]
block = 20
"""
#: Code for windows of a thousand cases, whose blocks are on the disk after a tenth of a second.
IN_PARTS = """
from study.store import windows
from study.work import run
windows.CASES, windows.BLOCKS, windows.usual_block, run.BRIEF = 1000, 2, lambda grid: 500, 0.1
"""


def main(kills: int, seed: int, parts: bool) -> int:
    chance, prepared, place = random.Random(seed), IN_PARTS * parts, "many" if parts else "many.nc"
    exec(prepared, {})
    program = "import sys\nfrom study.__main__ import main\nsys.exit(main(sys.argv[1:]))"
    command, environment = python_command(prepared + program)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "many.toml").write_text(TEXT, encoding="utf-8")
        killed, undisturbed = (study.load(folder / "many.toml", folder / word) for word in ("results", "apart"))
        undisturbed.run(workers=1)
        command += ["run", str(folder / "many.toml"), "--results", str(killed.results), "--workers", "2"]
        path, right = killed.results / place, numbers_digest(undisturbed.results / place)
        start = time.monotonic()
        subprocess.run(command, env=environment, capture_output=True, check=True)
        lasts, wrong = time.monotonic() - start, 0
        for _ in range(kills):
            if killed.status()["state"] == "done":
                wrong += numbers_digest(path) != right
                shutil.rmtree(killed.results) if parts or chance.random() < 0.5 else path.unlink()
            run = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(chance.uniform(0, lasts))
            run.kill()
            run.wait()
        subprocess.run(command, env=environment, capture_output=True, check=True)
        wrong += numbers_digest(path) != right
        wrong += killed.verify().kind != "sound"
    print(f"{kills} kills, {wrong} results that differ, seed {seed}")
    return bool(wrong)


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:] if word != "parts"]
    sys.exit(main(*(numbers + [40, 1][len(numbers) :]), "parts" in sys.argv))
