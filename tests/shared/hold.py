"""Runs that do not end before a test has done its thing: the blocks of case HOLD_FROM (an environment variable) and of
later ones are computed when the file HOLD_UNTIL exists. Who waits writes a line with its process id to HOLD_UNTIL.log.

Importing this module makes it so, in a dask worker or as the main module of a run, whose worker processes import it
too; `python hold.py ...` is `python -m study ...`.
"""

import os
import runpy
import time

from study.work import cases, processes

FROM, UNTIL = int(os.environ["HOLD_FROM"]), os.environ["HOLD_UNTIL"]
unheld = cases.compute


def compute(wanted):
    if wanted.first >= FROM:
        with open(f"{UNTIL}.log", "a", encoding="utf-8") as log:
            log.write(f"{os.getpid()}\n")
        while not os.path.exists(UNTIL):
            time.sleep(0.005)
    return unheld(wanted)


cases.compute = compute
processes.SERVE = f"import hold; {processes.SERVE}"

if __name__ == "__main__":
    runpy.run_module("study", run_name="__main__")
