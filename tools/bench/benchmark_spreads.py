"""Spreads: processor time of 4,000 layered contacts with seven of them, over that of the same contacts without.

python tools/bench/benchmark_spreads.py [CASES]
"""

import sys
import time
import warnings

import numpy as np

import study

warnings.simplefilter("ignore")
BALL = {"R": "10.0 ± 0.1 mm", "E_punch": "207 ± 3 GPa", "E2": "210 ± 5 GPa", "nu2": 0.3, "bonding": "bonded"}
LAYER = {"E1": "200 ± 16 GPa", "nu1": "0.25 ± 0.03", "Nbar": "4.0 ± 0.2 1/um^2", "Ra": "2.0 ± 0.1 um"}
EXACT = {"R": "10 mm", "E_punch": "207 GPa", "E2": "210 GPa", "E1": "200 GPa", "nu1": 0.25, "Nbar": "4 1/um^2"}


def seconds(cases: int, spreads: bool) -> float:
    h = [f"{value} um" for value in np.geomspace(1, 20, cases // 100)]
    P = [f"{value} N" for value in np.geomspace(0.1, 100, 100)]
    inputs = BALL | LAYER | ({} if spreads else EXACT | {"Ra": "2 um"})
    start = time.process_time()
    results = study.solve(**inputs, h=h, P=P, profiles=False, workers=1)
    assert (results.status == 0).all() and ("a_spread" in results) == spreads
    return time.process_time() - start


def main() -> None:
    cases = int(sys.argv[1]) if len(sys.argv) > 1 else 4000
    seconds(100, True)  # tables of the exact layer
    alone, whole = (min(seconds(cases, spreads) for _ in range(2)) for spreads in (False, True))
    print(
        f"{cases} contacts: {alone:.2f} s; with seven spreads {whole:.2f} s, {(whole - alone) / alone:.2f} solves more"
    )


if __name__ == "__main__":
    main()
