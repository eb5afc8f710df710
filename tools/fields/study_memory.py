"""The peak memory of a study that stores the largest stresses: `python tools/fields/study_memory.py [CASES]`.

It runs a study of smooth contacts on a half-space in this process, in a folder that is deleted, and prints the peak.
"""

import resource
import sys
import tempfile
from pathlib import Path

import study

STUDY = """
[model]
micro = "smooth"
base = "half_space"
nu2 = 0.3
[axes]
P = {{ start = 1e-6, stop = 1e-4, num = {cases}, spacing = "log" }}
[output]
profiles = false
stresses = true
"""


def main() -> None:
    cases = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "loads.toml"
        path.write_text(STUDY.format(cases=cases), encoding="utf-8")
        study.load(path, Path(folder) / "results").run(workers=1)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    print(f"{cases:,} cases: {peak / 1e6:.0f} MB")


if __name__ == "__main__":
    main()
