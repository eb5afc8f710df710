"""Our worker processes compared with those of a local dask cluster, in turns, with two workers:

    python tools/bench/benchmark_engine.py [REPEATS [THOUSANDS]]

It prints for each the wall and processor time of a run of so many thousand thin rough cases, 200 by default, with the
start of the workers. Each measurement has a process of its own. The module `study.work.processes` has the results.
"""

import os
import resource
import subprocess
import sys
import time
import tomllib
from contextlib import contextmanager, nullcontext
from tempfile import TemporaryDirectory

from benchmark_study import STUDY, WORKERS

from study.inputs.reading import from_tables
from study.work import run


@contextmanager
def local_cluster():
    """The address of a dask cluster of this machine, as lean as it can be configured."""
    import dask
    from dask.distributed import LocalCluster

    # by dask's settings malloc would give memory back after each block, which doubles the processor time
    dask.config.set({"distributed.nanny.pre-spawn-environ": {}, "distributed.worker.profile.enabled": False})
    options = {"n_workers": WORKERS, "threads_per_worker": 1, "memory_limit": 0, "dashboard_address": ":0"}
    with LocalCluster(**options) as cluster:
        yield cluster.scheduler_address


ENGINES = {"ours": nullcontext, "dask": local_cluster}


def measure(name: str, thousands: int) -> str:
    """The line about an engine, measured in this process."""
    text = STUDY.replace("num = 100,", f"num = {thousands // 10},")
    definition = from_tables(tomllib.loads(text), "many", text, "many")
    start = time.perf_counter()
    with TemporaryDirectory() as folder, ENGINES[name]() as scheduler:
        run.run(definition, folder, workers=WORKERS, scheduler=scheduler, yes=True)
    wall = time.perf_counter() - start
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    processor = sum(usage.ru_utime + usage.ru_stime for usage in used)
    return f"{name}: {thousands},000 cases {wall:.1f} s, all processor time {processor:.1f} s"


def main(repeats: int = 3, thousands: int = 200) -> None:
    for _ in range(repeats):
        for name in ENGINES:
            subprocess.run([sys.executable, __file__, name, str(thousands)], check=True)


if __name__ == "__main__":
    for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    if sys.argv[1:2] and sys.argv[1] in ENGINES:
        print(measure(sys.argv[1], int(sys.argv[2])))
    else:
        main(*map(int, sys.argv[1:]))
