"""The solver of the page, core.js, run by node, against the program on 20,000 contacts, or a part of these."""

import json
import os
import shutil
import subprocess

import numpy as np
import pytest
from conftest import ROOT
from explorer_cases import CONTROLS, RESULTS, parameters

from study.explorer.page import contents

ROOM = ROOT / "study/explorer"
NODE = shutil.which("node")
#: Every so many-th contact is looked at; `make explorer-test` looks at all.
EVERY = int(os.environ.get("EXPLORER_EVERY", "4"))
RUN = """
const Core = require(process.argv[1] + "/core.js"), [meshes, cases] = JSON.parse(require("fs").readFileSync(0));
Core.load(meshes);
const names = process.argv[2].split(",");
console.log(JSON.stringify(cases.map((p) => {
  const found = Core.solve(p);
  return [found.status, found.error, ...names.map((name) => found.Q && found.Q[name])];
})));
"""

pytestmark = pytest.mark.skipif(NODE is None, reason="node is not installed (make explorer-test)")


def cases(control: str) -> list[dict]:
    """The contacts with a control, as core.js takes them."""
    columns = parameters(control)
    columns["value"] = columns.pop(control)
    columns["bonded"], columns["rough"] = columns.pop("bonding") == "bonded", columns.pop("micro") == "disc_cell"
    columns["layered"], _ = columns.pop("base") == "layered", columns.pop("asperities_on")
    columns["n"] = np.where(columns["layered"], columns["n"], 1.0)
    rows = zip(*(column[::EVERY].tolist() for column in columns.values()), strict=True)
    return [dict(zip(columns, row, strict=True), control=control) for row in rows]


def test_contacts_of_all_kinds():
    """All within 5e-4, 99 % of layers of a/20 and thicker within 1e-5; few are farther off than the page says."""
    given = [case for control in CONTROLS for case in cases(control)]
    command = [NODE, "-e", RUN, "--", str(ROOM), ",".join(RESULTS)]
    text = json.dumps([contents()["meshes"], given])
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=True, timeout=600)
    status, stated, *results = zip(*json.loads(done.stdout), strict=True)
    with np.load(ROOT / "tests/references/explorer.npz") as reference:
        wanted = np.concatenate([reference[control][:, ::EVERY] for control in CONTROLS], axis=1).astype(float)
    h, layered = (np.array([case[name] for case in given]) for name in ("h", "layered"))
    known, solved = np.isfinite(wanted).all(axis=0), np.array(status) == "converged"
    assert (known & ~solved & ((h > wanted[0] / 255) | ~layered)).sum() <= 3, "what the program solves the page solves"
    both = known & solved
    error = np.abs(np.array(results, float)[:, both] / wanted[:, both] - 1).max(axis=0)
    thick = error[(h > wanted[0] / 20)[both]]
    beyond = np.mean(error > np.maximum(1e-6, 2 * np.array(stated, float)[both]))  # as contact.js states it
    print(f"{error.size} contacts: {error.max():.1e} at most, {np.quantile(error, 0.99):.1e} for 99 %", end="; ")
    print(f"h > a/20: {np.quantile(thick, 0.99):.1e} for 99 %; {beyond:.1%} beyond the stated error")
    assert error.size * EVERY >= 20_000
    assert error.max() < 5e-4
    assert np.quantile(thick, 0.99) < 1e-5
    assert beyond < 0.01


PROFILES = """
const Core = require(process.argv[1] + "/core.js"), [meshes, cases, x] = JSON.parse(require("fs").readFileSync(0));
Core.load(meshes);
console.log(JSON.stringify(cases.map((p) => {
  const { status, Q, ev } = Core.solve(p);
  return status === "converged" ? [Q.a, Q.P, Q.p0, Q.lam0, ...x.map((x) => Core.profile(ev, x))] : null;
})));
"""


def test_profiles_bear_the_load():
    """P = 2π a² ∫ p x dx; p and λ in the centre are those of the contact, and there is no pressure at the edge."""
    s, weights = (np.polynomial.legendre.leggauss(40)[0] + 1) / 2, np.polynomial.legendre.leggauss(40)[1] / 2
    x = [0.0, 1.0, *np.sqrt(1 - s**2).tolist()]
    text = json.dumps([contents()["meshes"], cases("P")[::25], x])
    done = subprocess.run(
        [NODE, "-e", PROFILES, "--", str(ROOM)], input=text, capture_output=True, text=True, check=True
    )
    lines = [line for line in json.loads(done.stdout) if line]
    rough = [line for line in lines if line[3] < 1]
    assert len(lines) > 20 and 10 < len(rough) < len(lines)
    for a, P, p0, lam0, centre, edge, *profile in lines:
        p = np.array([at["p"] for at in profile])
        assert (centre["p"], edge["p"]) == (pytest.approx(p0, rel=1e-9), 0)
        assert 2 * np.pi * a**2 * (p * s * weights).sum() == pytest.approx(P, rel=1e-3)
        assert centre["lam"] == pytest.approx(lam0, rel=1e-9)
