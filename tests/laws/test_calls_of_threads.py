"""Calls of all kinds by several threads at once: each has the numbers, and the key, that it has alone."""

import dataclasses
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor

import cones
import numpy as np
import pytest

import study
from solver.known import PACKAGE, default
from study.inputs.definition import from_call
from study.inputs.identity import case_keys

THREADS, ROUNDS = 8, 20
#: Calls of a thread in a round: with all rounds (make verify) each thread makes 1,000.
CALLS = 1000 // ROUNDS
SMOOTH = {"P": 1e-4, "micro": "smooth", "profiles": False}
#: Laws of one name, of which each call has another.
OWN = [
    cones.CONES,
    dataclasses.replace(cones.CONES, version="2", edge=lambda: (2.0, 0.5), curve=lambda y: cones.curve(y)._replace(
        g=2 * cones.curve(y).g, dg=2 * cones.curve(y).dg)),
    dataclasses.replace(cones.CONES, version="3", area=lambda y, q: 0.5 * cones.area(y, q)),
]  # fmt: skip
STACKS = [
    [{"h": 0.01, "n": 2.0, "bonding": "bonded"}, {"h": 0.03, "n": n, "bonding": "bonded"}][: 2 - (n == 3.0)]
    for n in (0.5, 0.7, 3.0)
]
CURVE = np.array([1e-7, 3e-7, 6e-7, 1e-6])


def of_law(i: int) -> tuple:
    contact = study.solve(P=1e-4, base="half_space", Nbar=1e5, alpha=0.1, micro=OWN[i], profiles=False, rtol=1e-3)
    return contact.a.item(), contact.Ar_An.item(), contact.attrs["micro_laws"]


def of_fit():
    curve = {"D": (CURVE, "m"), "P": (1e6 * CURVE**1.5, "N")}
    return study.fit(curve, free="E2", R="5 mm", base="half_space", micro="smooth", nu2=0.3).E2.item()


def key_of(stack: list) -> tuple:
    call = {"P": 1e-4, "micro": "smooth", "layers": stack}
    return tuple(case_keys(from_call(call, [], False, {}).grid)[0].tolist())


def refusal(**call) -> str:
    return str(pytest.raises(study.StudyError, study.solve, **call).value)


def calls(tip: str, rows: str) -> dict:
    """Kind -> a call that gives numbers, each of a millisecond or few. A fit takes longer, and is one of many."""
    half_space = {"base": "half_space", **SMOOTH}
    graded = [{"h": 0.05, "bonding": "bonded", "profile": rows}]
    kinds = {
        "plain": lambda: study.solve(h=0.01, n=2.0, bonding="bonded", **SMOOTH).a.item(),
        "cone": lambda: study.solve(shape="cone", half_angle=70.0, **half_space).a.item(),
        "tip": lambda: study.solve(shape=tip, **half_space).a.item(),
        "key of graded": lambda: key_of(graded),
        "message": lambda: refusal(**SMOOTH, **{"layers.2.k": 1.0}),
        "unknown law": lambda: refusal(**half_space | {"micro": "cones"}),
    }
    kinds |= {f"own law {i}": lambda i=i: of_law(i) for i in range(len(OWN))}
    kinds |= {f"key of stack {i}": lambda stack=stack: key_of(stack) for i, stack in enumerate(STACKS)}
    return kinds | {"stack": lambda: study.solve(layers=STACKS[0], **SMOOTH).a.item(), "fit": of_fit}


@pytest.fixture
def busy():
    """Threads change a hundred times as often as they do by themselves."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(before)


@pytest.mark.parametrize("seed", range(ROUNDS))
def test_each_call_is_as_it_is_alone(tmp_path, busy, seed):
    """The vocabulary was emptied and filled at each call: 21 of 236 failed so, and stacks had one key."""
    tip, rows = tmp_path / "tip.csv", tmp_path / "rows.csv"
    tip.write_text("".join(f"{r},{r**2}\n" for r in np.linspace(0, 0.2, 9).tolist()))
    rows.write_text("0,1\n0.5,2\n1,4\n")
    kinds, random = calls(f"table:{tip}", f"table:{rows}"), np.random.default_rng(seed)
    often = [kind for kind in kinds if kind != "fit"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        alone = {kind: call() for kind, call in kinds.items()}
        names = [*random.choice(often, THREADS * CALLS - THREADS // 2).tolist(), *["fit"] * (THREADS // 2)]
        random.shuffle(names)
        with ThreadPoolExecutor(THREADS) as threads:
            together = [*threads.map(lambda kind: kinds[kind](), names)]
    assert {kind: value for kind, value in zip(names, together, strict=True) if value != alone[kind]} == {}
    assert len({alone[f"key of stack {i}"] for i in range(len(STACKS))}) == len(STACKS)
    assert len({alone[f"own law {i}"] for i in range(len(OWN))}) == len(OWN)
    assert default() is PACKAGE, "no call has registered anything"
