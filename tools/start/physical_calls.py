"""The cost of units: 1,000 calls of study.solve with physical values, and for the same contacts without units.

python tools/start/physical_calls.py      prints processor times and their ratio, which must be at most 1.2
"""

import statistics
import time
import warnings

import study

CALLS, ROUND = 1000, 50
R, E1, E2 = 5e-3, 200e9 / (1 - 0.25**2), 210e9 / (1 - 0.3**2)
UNITS = {"R": "5 mm", "E1": "200 GPa", "nu1": 0.25, "E2": "210 GPa", "nu2": 0.3, "E_punch": "210 GPa", "nu_punch": 0.3}
UNITS |= {"h": "2 um", "Nbar": "4 1/um^2", "Ra": "2 um", "bonding": "bonded"}
PLAIN = {"n": E1 / E2, "m": E1 / E2, "nu1": 0.25, "nu2": 0.3, "h": 2e-6 / R, "Nbar": 4e12 * R**2, "Ra": 2e-6 / R}
PLAIN |= {"bonding": "bonded"}
HERTZ = {"base": "half_space", "micro": "smooth"}


def seconds(inputs: dict, loads: list) -> float:
    """Processor time of a call for each of the loads, one after the other."""
    begun = time.process_time()
    for P in loads:
        study.solve(**inputs, P=P)
    return time.process_time() - begun


def compare(name: str, units: dict, plain: dict) -> None:
    """Print the median of the ratios. Both take turns, round by round, since the machine may have other work."""
    ratios, times = [], [0.0, 0.0]
    for first in range(0, CALLS, ROUND):
        newtons = [5.0 + 0.01 * i for i in range(first, first + ROUND)]
        pair = seconds(units, [f"{P!r} N" for P in newtons]), seconds(plain, [P / (E2 * R**2) for P in newtons])
        ratios.append(pair[0] / pair[1])
        times = [total + used for total, used in zip(times, pair, strict=True)]
    each = ", ".join(f"{total / CALLS * 1e3:.1f} ms" for total in times)
    print(f"{name}: {each} a call with and without units, ratio {statistics.median(ratios):.3f}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    seconds(UNITS, ["1 N"] * 3), seconds(PLAIN, [1e-6] * 3)
    compare("rough on a bonded layer", UNITS, PLAIN)
    bodies = {name: UNITS[name] for name in ("R", "E2", "nu2", "E_punch", "nu_punch")} | HERTZ
    compare("smooth, no layer", bodies, {"m": 1.0} | HERTZ)
