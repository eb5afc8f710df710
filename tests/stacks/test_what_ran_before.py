"""No call depends on what ran before: in a fresh process each has the answer that it has after all the others."""

import json
import subprocess
import sys

import study

PURE = [{"h": 0.01, "n": 2.0, "bonding": "bonded"}, {"h": 0.03, "n": 0.5, "bonding": "bonded"}]
CALLS = """
import json, sys, warnings
import numpy as np
import roughcoat as rc
warnings.simplefilter("ignore")
PURE = [{"h": 0.01, "n": 2.0, "bonding": "bonded"}, {"h": 0.03, "n": 0.5, "bonding": "bonded"}]
ALL = {"P": 1e-4, "micro": "smooth"}
BALL = {"R": "5 mm", "E2": "210 GPa", "micro": "smooth"}
TOP, LOW = {"h": "2 um", "E1": "400 GPa", "bonding": "bonded"}, {"h": "5 um", "nu": 0.3, "bonding": "bonded"}
ONE = {"D": ([1e-7], "m"), "P": ([1e-3], "N")}

def refused(call):
    try:
        call()
    except (rc.StudyError, ValueError) as error:
        return str(error)

CALLS = {
    "fit": lambda: refused(lambda: rc.fit(ONE, free={"layers.2.E1": ("50 GPa", "900 GPa")}, layers=[TOP, LOW], **BALL)),
    "cases": lambda: rc.solve(layers=PURE, cases=[{"layers.2.h": 0.02}, {"layers.1.h": 0.02}, {}], **ALL).a,
    "plain": lambda: rc.solve(base="half_space", **ALL).a,
    "no layer of three": lambda: refused(lambda: rc.solve(h=0.01, n=1.0, **ALL, **{"layers.3.k": 1.0})),
    "no stack": lambda: refused(lambda: rc.solve(h=0.01, n=1.0, **ALL, Layers=2)),
    "five layers": lambda: rc.solve(layers=PURE * 2 + PURE[:1], **ALL).a,
    "stack": lambda: rc.solve(layers=PURE, **ALL).a,
    "assumed": lambda: rc.summary(rc.solve(base="half_space", P="1 uN", **BALL | {"E2": "1 MPa"})),
    "in words": lambda: rc.summary(rc.solve(layers=[TOP, LOW | {"E1": "90 GPa"}], P="1 N", **BALL)),
    "design": lambda: rc.design({"p0": 0.02}, by={"layers.2.h": (2e-2, 1e-1)}, layers=PURE, **ALL)["layers.2.h"],
}

def answer(kind):
    value = CALLS[kind]()
    return value if isinstance(value, str) else np.ravel(value).tolist()

print(json.dumps({kind: answer(kind) for kind in eval(sys.argv[1])(CALLS)}))
"""


def answers(order: str) -> dict:
    found = subprocess.run([sys.executable, "-c", CALLS, order], capture_output=True, text=True, check=True)
    return json.loads(found.stdout)


def test_first_and_last():
    """`fit` and `design`, the first calls of a process, were refused, and the cases of a stack were."""
    forward, backward = answers("lambda calls: [*calls]"), answers("lambda calls: [*calls][::-1]")
    assert forward == backward
    assert "not an input that can be fitted" not in forward["fit"] and min(forward["cases"]) > 0
    assert 0.02 < forward["design"][0] < 0.1 and abs(forward["cases"][2] / forward["stack"][0] - 1) < 1e-12


def test_a_design_of_the_first_layer():
    designed = study.design({"p0": 0.03}, by={"layers.1.h": (2e-2, 4e-2)}, layers=PURE, P=1e-4, micro="smooth")
    assert 0.02 < designed.h.item() < 0.04


def test_a_figure_of_the_first_layer():
    """`plot --x layers.1.h` proposed layers.2.h, another layer."""
    contact = study.solve(layers=PURE, P=1e-4, micro="smooth", **{"layers.1.h": [0.01, 0.02]})
    figure = study.plot(contact, x="layers.1.h", y="a")
    assert figure.axes[0].lines[0].get_xdata().tolist() == [0.01, 0.02]
