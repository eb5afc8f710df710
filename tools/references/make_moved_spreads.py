"""Write moved_spreads.csv: the ± of the contacts of tests/shared/spread_contacts.py, computed with moved inputs.

git worktree add ../before e9acde5c && PYTHONPATH=../before python tools/references/make_moved_spreads.py

That commit solved each contact as given, and with each input that has a spread moved up and down by a tenth of it; ± is
the root of the sum of the squares of the central differences. The script makes sense only there: later commits compute
± from derivatives. rtol is 1e-9, so that only the curvature remains as an error, at most some 1e-4 of ±.
"""

import csv
import sys
import warnings
from pathlib import Path

import numpy as np

import study

TESTS = Path(__file__).resolve().parents[2] / "tests"
sys.path.append(str(TESTS / "shared"))
from spread_contacts import AT, CONTACTS  # noqa: E402


def main() -> None:
    warnings.simplefilter("ignore")  # about validity, which does not matter here
    with open(TESTS / "references/moved_spreads.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["contact", "result", "point", "spread"])
        for name, inputs in CONTACTS.items():
            contact = study.solve(**inputs | {"rtol": 1e-9}, x=[*AT, 1.0])
            assert contact.status == 0, name
            for result in [f"{one}_spread" for one in contact.data_vars if f"{one}_spread" in contact.data_vars]:
                for point, value in enumerate(np.ravel(contact[result])[: len(AT)].tolist()):
                    table.writerow([name, result.removesuffix("_spread"), point, f"{value:.9g}"])


if __name__ == "__main__":
    main()
