"""Calls of all kinds by several threads at once: each has the numbers, and the key, that it has alone."""

import dataclasses
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor

import cones
import numpy as np
import pytest

import study
from solver import laws
from study.inputs.identity import case_keys
from study.inputs.reading import from_call

SMOOTH = {"P": 1e-4, "micro": "smooth", "profiles": False}
OWN = [dataclasses.replace(cones.CONES, name=f"cones_{i}") for i in range(3)]
STACKS = [
    [{"h": 0.01, "n": 2.0, "bonding": "bonded"}, {"h": 0.03, "n": n, "bonding": "bonded"}][: 2 - (n == 3.0)]
    for n in (0.5, 0.7, 3.0)
]
CURVE = np.array([1e-7, 3e-7, 6e-7, 1e-6])


def of_law(i: int):
    return study.solve(P=1e-4, base="half_space", Nbar=1e5, alpha=0.1, micro=OWN[i], profiles=False).a.item()


def of_fit():
    curve = {"D": (CURVE, "m"), "P": (1e6 * CURVE**1.5, "N")}
    return study.fit(curve, free="E2", R="5 mm", base="half_space", micro="smooth", nu2=0.3).E2.item()


def key_of(stack: list) -> tuple:
    call = {"P": 1e-4, "micro": "smooth", "layers": stack}
    return tuple(case_keys(from_call(call, [], False, {}).grid)[0].tolist())


def calls(tip: str) -> dict:
    """Kind -> a call that gives numbers, each of a millisecond or few."""
    half_space = {"base": "half_space", **SMOOTH}
    kinds = {
        "plain": lambda: study.solve(h=0.01, n=2.0, bonding="bonded", **SMOOTH).a.item(),
        "cone": lambda: study.solve(shape="cone", half_angle=70.0, **half_space).a.item(),
        "tip": lambda: study.solve(shape=tip, **half_space).a.item(),
        "fit": of_fit,
        "message": lambda: str(pytest.raises(study.StudyError, study.solve, **SMOOTH, **{"layers.2.k": 1.0}).value),
    }
    kinds |= {f"own law {i}": lambda i=i: of_law(i) for i in range(len(OWN))}
    kinds |= {f"key of stack {i}": lambda stack=stack: key_of(stack) for i, stack in enumerate(STACKS)}
    return kinds | {"stack": lambda: study.solve(layers=STACKS[0], **SMOOTH).a.item()}


@pytest.fixture
def busy():
    """Threads change a hundred times as often as they do by themselves."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(before)


def test_each_call_is_as_it_is_alone(tmp_path, busy):
    """The vocabulary was emptied and filled at each call: 21 of 236 failed so, and stacks had one key."""
    tip = tmp_path / "tip.csv"
    tip.write_text("".join(f"{r},{r**2}\n" for r in np.linspace(0, 0.2, 9).tolist()))
    kinds = calls(f"table:{tip}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        alone = {kind: call() for kind, call in kinds.items()}
        for law in OWN:  # so that they are registered at once too
            laws.LAWS.pop(law.name)
        names = [*kinds] * 6
        with ThreadPoolExecutor(8) as threads:
            together = [*threads.map(lambda kind: kinds[kind](), names)]
    assert {kind: value for kind, value in zip(names, together, strict=True) if value != alone[kind]} == {}
    assert len({alone[f"key of stack {i}"] for i in range(len(STACKS))}) == len(STACKS)
