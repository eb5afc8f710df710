"""numpy reads a status, and each other code, without Python code in which a signal would be lost."""

import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

from solver import Model, Status
from solver.kernels.transfer import StatePart
from solver.rough.answer import Verdict
from study.inverse.fits.block import FitStatus


def test_all_codes_are_of_this_kind():
    files = [path for folder in ("solver", "study") for path in (ROOT / folder).rglob("*.py")]
    assert [path.name for path in files if "IntEnum" in path.read_text(encoding="utf-8")] == ["status.py"]


@pytest.mark.parametrize("kind", [Status, Model, Verdict, StatePart, FitStatus], ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("use", [np.equal, np.bitwise_and, np.add, np.full_like])
def test_no_function_of_enum_is_called(kind, use):
    """A function of Python, before which a signal would be heard."""
    array, one, called = np.zeros(3, np.int8), next(iter(kind)), []
    sys.setprofile(lambda frame, event, _: called.append(frame.f_code.co_filename) if event == "call" else None)
    try:
        use(array, one)
    finally:
        sys.setprofile(None)
    assert "enum.py" not in {Path(file).name for file in called}


def test_they_are_numbers_with_names():
    assert Status.CONVERGED == 0 and Status(11) is Status.PULLED_OFF and Status["LIFT_OFF"].meaning
    with pytest.raises(AttributeError, match="FLOWN_AWAY"):
        _ = Status.FLOWN_AWAY
