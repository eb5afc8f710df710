"""Spreads of results, propagated to first order, compared with random draws of the inputs, for six real systems.

python tools/errors/monte_carlo.py [DRAWS]      10,000 draws of each system

The draws are normal, transformed to have exactly the means, the spreads and no correlation: the deviation of a nearly
linear result is then known far better than to the 0.7 % of 10,000 plain draws. The spreads are those of measured parts,
1 to 10 %. Results are not linear over wider spreads: the last systems are a rubber of E ± 23 %, and the DLC a-C:H of
study.materials, 200 ± 35 GPa.
"""

import sys
import warnings

import numpy as np
import xarray as xr

import study
from study.inputs.scene.scene import si
from study.inputs.vocabulary import ROWS

DRAWS = 10_000
NAMES = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
STEEL = {"E_punch": "207 ± 3 GPa", "nu_punch": "0.29 ± 0.01", "E2": "207 ± 3 GPa", "nu2": "0.29 ± 0.01"}
SYSTEMS = {
    "DLC on steel": STEEL
    | {"R": "5 ± 0.01 mm", "E1": "200 ± 16 GPa", "nu1": "0.25 ± 0.03", "h": "2 ± 0.1 um", "P": "10 ± 0.1 N"}
    | {"Nbar": "4 ± 0.2 1/um^2", "Ra": "2 ± 0.1 um", "bonding": "bonded"},
    "TiN on steel": {"E_punch": "400 ± 20 GPa", "nu_punch": "0.23 ± 0.01", "E2": "210 ± 5 GPa", "nu2": "0.29 ± 0.01"}
    | {"R": "3 ± 0.01 mm", "E1": "460 ± 30 GPa", "nu1": "0.26 ± 0.02", "h": "3 ± 0.1 um", "P": "5 N"}
    | {"bonding": "bonded", "micro": "smooth"},
    "PTFE lining on bearing steel": STEEL
    | {"R": "25 mm", "E1": "490 ± 30 MPa", "nu1": "0.45 ± 0.01", "h": "0.5 ± 0.02 mm", "P": "100 ± 2 N"}
    | {"bonding": "bonded", "micro": "smooth"},
    "polymer film on glass": {"E_punch": "1143 ± 10 GPa", "nu_punch": "0.069 ± 0.005", "E2": "71 ± 1 GPa"}
    | {"R": "10 ± 0.2 um", "E1": "3 ± 0.15 GPa", "nu1": "0.38 ± 0.01", "h": "0.5 ± 0.01 um", "D": "50 ± 1 nm"}
    | {"bonding": "bonded", "micro": "smooth"},
    "rubber on metal": {"R": "30 mm", "E2": "69 ± 1 GPa", "nu2": 0.33, "P": "5 ± 0.1 N"}
    | {"E1": "2.2 ± 0.15 MPa", "nu1": "0.495 ± 0.001", "h": "5 ± 0.1 mm", "bonding": "bonded", "micro": "smooth"},
    "gel on glass": {"R": "2.5 ± 0.05 um", "E2": "rigid", "D": "100 ± 3 nm", "h": "2 ± 0.1 um", "nu1": "0.48 ± 0.004"}
    | {"E1": "8.6 ± 0.7 kPa", "bonding": "bonded", "micro": "smooth"},
}
WIDE = {
    "rubber on metal, E ± 23 %": SYSTEMS["rubber on metal"] | {"E1": "2.2 ± 0.5 MPa"},
    "DLC on steel, E ± 18 %": STEEL
    | {"R": "5 mm", "E1": "200 ± 35 GPa", "nu1": "0.25 ± 0.05", "h": "2 um", "P": "10 N", "bonding": "bonded"}
    | {"Nbar": "4 1/um^2", "Ra": "2 um"},
}


def compared(inputs: dict, draws: int, seed: int = 0) -> dict[str, tuple[float, float]]:
    """Result -> its spread to first order and the deviation of its draws, both over its value."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # about validity, which does not matter here
        results = study.solve(**inputs, x=2, profiles=False)
        sampled = study.solve(**random_draws(inputs, draws, seed), x=2, profiles=False)
    assert results.status == 0 and (sampled.status == 0).all()
    return {
        name: (float(results[f"{name}_spread"] / results[name]), float(sampled[name].std("draw") / results[name]))
        for name in NAMES
        if f"{name}_spread" in results and float(results[f"{name}_spread"]) > 0
    }


def random_draws(parameters: dict, draws: int, seed: int) -> dict:
    """The parameters with `draws` values for each that has a spread, along the dimension `draw`."""
    inputs = {name: si(name, text) for name, text in parameters.items() if isinstance(text, str) and "±" in text}
    normal = np.random.default_rng(seed).normal(size=(draws, len(inputs)))
    normal -= normal.mean(axis=0)
    normal = normal @ np.linalg.inv(np.linalg.cholesky(np.cov(normal.T, ddof=0))).T
    columns = zip(inputs.items(), normal.T, strict=True)
    return parameters | {
        name: xr.DataArray(measured.value + measured.spread * column, dims="draw", attrs={"units": ROWS[name].unit})
        for (name, measured), column in columns
    }


def main() -> None:
    draws = int(sys.argv[1]) if len(sys.argv) > 1 else DRAWS
    print(f"relative spread of each result: to first order, and of {draws} draws (their ratio, less 1)")
    for system, inputs in (SYSTEMS | WIDE).items():
        print(system)
        for name, (first, sampled) in compared(inputs, draws).items():
            print(f"  {name:6} {first:9.3%} {sampled:9.3%}  ({first / sampled - 1:+.2%})")


if __name__ == "__main__":
    main()
