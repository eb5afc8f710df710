"""A law of somebody else's (cones.py): through study.solve and study files, by name and as an object, in processes."""

import dataclasses
import os
import pickle
import subprocess
import sys

import cones
import numpy as np
import pages
import pytest
from conftest import ROOT
from numpy.testing import assert_allclose
from scipy.special import ellipe, ellipk

import study
from solver import Problem, laws, solve
from solver.known import PARAMETERS, register
from solver.parameters import Parameter
from study.figures.labels import stated
from study.in_words.stated_inputs import used_inputs
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables
from study.work.cases import parcel

pytestmark = pytest.mark.usefixtures("forgetful")

CASE = {"h": 0.02, "n": 0.5, "Nbar": 250_000.0}
ALPHA = [1.2, 1.4]


def alike(alpha):
    """B of the power law that is this law, A = B Ra (p/E)^(1/2), with Ra = 1."""
    E = 1.0
    p_star, A_star = cones.scales(E, CASE["Nbar"], alpha)
    return A_star / np.sqrt(p_star)


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered", "auto"])
def test_a_grid_of_cones_is_one_of_power_laws(base):
    """The same a, P, D, p(0) as A = B p^(1/2), for every control; status and error keep their contract."""
    for control, value in (("P", [1e-6, 1e-5]), ("a", [0.02, 0.04]), ("D", [2e-4, 1e-3])):
        given = CASE | {control: value, "base": base, "rtol": 1e-8, "x": 5, "accuracy": 1e-3}
        found = study.solve(**given, micro=cones.CONES, alpha=ALPHA)
        assert (found.status == 0).all() and (found.error <= 1e-8).all()
        assert found.alpha.attrs["symbol"] == "α" and found.p.dims == (control, "alpha", "x")
        for i, alpha in enumerate(ALPHA):
            same = study.solve(**given, micro="power_law", B=alike(alpha), beta=0.5, Ra=1.0)
            for name in {"a", "P", "D", "p0", "A0", "dP_dD", "p"} - {control}:
                assert_allclose(found[name][:, i], same[name], rtol=3e-8, atol=1e-12)
        p_star, _ = cones.scales(1.0 if base == "half_space" else CASE["n"], CASE["Nbar"], np.array(ALPHA))
        assert_allclose(found.lam, found.p / p_star[:, None], rtol=1e-9, atol=0)
        assert_allclose(found.p_max, np.broadcast_to(p_star, found.p_max.shape), rtol=1e-14, atol=0)
        assert_allclose(study.derived.peak_pressure(found), found.p_max, rtol=1e-14, atol=0)
        assert_allclose(study.derived.spot_radius(found), np.sqrt(found.lam0 / (np.pi * CASE["Nbar"])), rtol=1e-14)


def test_its_parameter_is_told_in_words_and_in_figures():
    found = study.solve(**CASE, P=1e-5, micro=cones.CONES, alpha=1.3, x=2)
    text = str(study.summary(found))
    assert "cones, Nbar = 2.5e+05 R^-2, alpha = 1.3\n" in text and "nu1" not in text, "without friction ν is not used"
    assert stated([found])[-1] == "$\\alpha$ = 1.3"
    spheres = study.solve(**CASE, P=1e-5, Ra=0.004, x=2)
    assert "alpha" not in used_inputs(spheres.assign_coords(alpha=1.3)), "which another law has"


def test_against_rings_of_constant_pressure():
    """On a half-space under a given load, by other means: A(p) as Sneddon has it, rings of uniform pressure (Johnson
    1985, 3.29), Newton on the loads of the rings and a. Two numbers of rings, of second order, extrapolated."""
    P, alpha, Nbar = 1e-5, 1.3, CASE["Nbar"]

    def circle(r, radius):
        """Displacement at r under a unit pressure within the radius."""
        m = np.minimum(r / radius, radius / r) ** 2
        outside = 4 / np.pi * r * (ellipe(m) - (1 - m) * ellipk(np.where(r > radius, m, 0.0)))
        return np.where(r <= radius, 4 / np.pi * radius * ellipe(m), outside)

    def rings(count):
        edges = np.sin(np.pi / 2 * np.linspace(0, 1, count + 1))
        middle = (edges[1:] + edges[:-1]) / 2
        points = np.append(middle, 1.0)[:, None]
        U = circle(points, edges[None, 1:])
        U[:, 1:] -= circle(points, edges[None, 1:-1])
        delta, a = 2e-5 * np.sqrt(1 - middle**2), 0.03
        for _ in range(60):  # unknowns: δ of the cones on each ring, and a
            p = Nbar * 2 / np.pi * np.tan(alpha) * delta**2
            slope = 2 * p / delta
            u = a * (U @ p)
            residual = np.append(u[:-1] + delta - u[-1] - a**2 / 2 * (1 - middle**2),
                                 np.pi * a**2 * np.diff(edges**2) @ p / P - 1)  # fmt: skip
            J = np.empty((count + 1, count + 1))
            J[:-1, :-1] = a * (U[:-1] - U[-1]) * slope + np.eye(count)
            J[:-1, -1] = (u[:-1] - u[-1]) / a - a * (1 - middle**2)
            J[-1, :-1] = np.pi * a**2 * np.diff(edges**2) * slope / P
            J[-1, -1] = 2 * (residual[-1] + 1) / a
            step = np.linalg.solve(J, -residual)
            delta, a = np.clip(delta + step[:-1], 0.2 * delta, 5 * delta), a * np.exp(np.clip(step[-1] / a, -0.5, 0.5))
        return np.array([a, a**2 / 2 + u[-1], p[0] + (p[0] - p[1]) / (middle[1] ** 2 / middle[0] ** 2 - 1)])

    coarse, middle, fine = (rings(count) for count in (40, 80, 160))
    assert_allclose(((coarse - middle) / (middle - fine))[:2], 4, rtol=0.02, atol=0)
    found = study.solve(P=P, micro=cones.CONES, alpha=alpha, Nbar=Nbar, base="half_space", rtol=1e-9)
    assert_allclose([found.a, found.D], (fine + (fine - middle) / 3)[:2], rtol=1e-7, atol=0)
    assert_allclose(found.p0, fine[2], rtol=1e-4, atol=0)


def test_units():
    """A parameter has the unit that its law says: here the spacing of the cones, the same case in metres."""
    spacing = {"spacing": Parameter(interval="(0, 1)", powers=(0, 1)), "alpha": cones.CONES.parameters["alpha"]}
    spaced = dataclasses.replace(cones.CONES, name="spaced", parameters=spacing, scales=of_spacing)
    R, E2 = 0.01, 2e11
    one = solve(Problem.of(P=1e-5, micro=cones.CONES, alpha=1.3, **CASE))
    many = {"h": CASE["h"] * R, "n": CASE["n"], "spacing": CASE["Nbar"] ** -0.5 * R, "alpha": 1.3}
    s = solve(Problem.of(P=1e-5 * R * R * E2, micro=spaced, **many, R=R, E2=E2))
    assert_allclose([s.a, s.D, s.p_max], [one.a * R, one.D * R, one.p_max * E2], rtol=1e-12, atol=0)
    found = study.solve(P=1e-5, micro=spaced, h=0.02, n=0.5, alpha=1.3, spacing=[0.002, 0.003], x=2)
    physical = study.to_physical(found, R=R, E2_star=E2)
    assert_allclose(physical.spacing, [20e-6, 30e-6], rtol=1e-14)
    assert physical.spacing.attrs["units"] == "m" and np.isnan(study.derived.spot_radius(found)).all()


def of_spacing(E, spacing, alpha):
    return cones.scales(E, spacing**-2, alpha)


def test_picard_solves_cones_too():
    found = study.solve(
        P=1e-5, micro=cones.CONES, alpha=1.2, **CASE, scheme="picard", k=20.0, rtol=1e-3, base="thin_layer"
    )
    newton = study.solve(P=1e-5, micro=cones.CONES, alpha=1.2, **CASE, rtol=1e-8, base="thin_layer")
    assert found.status == 0 and abs(found.a / newton.a - 1) < 1e-3


@pytest.mark.parametrize("scheme", [{}, {"scheme": "picard", "k": 20.0, "rtol": 1e-3}], ids=["newton", "picard"])
@pytest.mark.parametrize("base", ["half_space", "thin_layer"])
def test_a_law_needs_no_inverses_of_its_own(base, scheme):
    """The exact law without those it has: the same numbers, from isolated spots to nearly full contact."""
    none = dict.fromkeys(("from_pressure", "from_displacement", "guess"))
    plain = dataclasses.replace(laws.LAWS["disc_cell"], name="plain", version="1", **none)
    given = CASE | {"a": [0.01, 0.04], "Ra": [0.0005, 0.004], "base": base, "x": 5, "rtol": 1e-9} | scheme
    one, other = (study.solve(**given, micro=law) for law in (plain, "disc_cell"))
    assert (one.status == other.status).all()
    for name in ("P", "D", "p0", "p_max", "Ar_An", "p", "lam"):
        assert_allclose(one[name], other[name], rtol=1e-10, atol=1e-13)


def message(**given):
    with pytest.raises(study.StudyError) as error:
        study.solve(**CASE | {"P": 1e-5, "x": 2} | given)
    return str(error.value)


def test_messages_are_those_of_any_parameter():
    assert message(micro=cones.CONES) == 'solve: alpha is missing: micro = "cones" needs it'
    assert message(micro=cones.CONES, alpha=2.0) == "solve: alpha = 2.0: must be in (0, 1.57)"
    register(cones.CONES)
    assert message(micro="conse", alpha=1.0).endswith(
        '"hex_lattice", "normal_heights", "uniform_heights", "elastic_plastic", "cones", or "table:FILE.csv"'
    )
    unnamed = dataclasses.replace(cones.CONES, version="")
    assert "version must be a text" in message(micro=unnamed, alpha=1.0)
    for name in ("smooth", "", "two words", "steep-cones", "1cone", "cones\n", "cônes!", "_cones"):
        named = dataclasses.replace(cones.CONES, name=name)
        assert f'micro law "{name}": must have a name of its own' in message(micro=named, alpha=1.0)
    other = dataclasses.replace(cones.CONES, name="blunt", parameters={"h": PARAMETERS["h"]})
    assert "the name of the parameter h is that of something else" in message(micro=other)
    assert "the name of the parameter lam is that of something else" in message(
        micro=dataclasses.replace(
            cones.CONES, name="blunt", parameters={"lam": PARAMETERS["h"]._replace(needed_by=("", ()))}
        )
    )


def test_a_batch_from_before_a_law_has_none_of_its_parameters():
    before = Problem.of(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    register(cones.CONES)
    assert (solve(before).status == 0).all()
    with pytest.raises(AttributeError, match="^Problem has no alpha$"):
        _ = before.alpha
    after = Problem.of(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    assert np.isnan(after.alpha).all() and after.alpha.shape == (2,)


def test_a_law_can_be_registered_anew_with_other_bounds():
    register(cones.CONES)
    narrow = cones.CONES.parameters | {"alpha": cones.CONES.parameters["alpha"]._replace(interval="(1, 1.5)")}
    assert message(micro=dataclasses.replace(cones.CONES, parameters=narrow), alpha=0.9).endswith("must be in (1, 1.5)")
    register(dataclasses.replace(cones.CONES, parameters={}))
    assert '"alpha" is not a parameter' in message(micro="cones", alpha=1.2)
    assert len(Problem.of(P=1e-5, micro="cones", base="half_space")) == 1  # alpha is not missed


def test_keys_and_digests_carry_the_version():
    tables = {"model": CASE | {"micro": "cones", "P": 1e-5}, "axes": {"alpha": ALPHA}}
    found = []
    for version in ("1", "1", "2"):
        register(dataclasses.replace(cones.CONES, version=version))
        definition = from_tables(tables, "mine", "", "mine.toml")
        found.append((definition.digest, case_keys(definition.grid).tolist()))
    assert found[0] == found[1]
    assert found[0][0] != found[2][0]
    assert not {tuple(key) for key in found[0][1]} & {tuple(key) for key in found[2][1]}


STUDY = """
[model]
P = 1e-5
base = "half_space"
micro = "cones"
Nbar = 250000.0
[axes]
alpha = {start = 1.0, stop = 1.5, num = 40}
[numerics]
block = 4
"""
CALLS = "import sys; from study.__main__ import main; sys.exit(max([main(call.split()) for call in sys.argv[1:]]))"


def test_a_study_of_an_installed_law_in_processes(tmp_path):
    """The entry point of a package; another version of the law computes all anew, though the file is there."""
    (tmp_path / "cones_law-1.dist-info").mkdir()
    (tmp_path / "cones_law-1.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: cones-law\nVersion: 1\n")
    (tmp_path / "cones_law-1.dist-info/entry_points.txt").write_text("[roughcoat.laws]\ncones = cones:CONES\n")
    (tmp_path / "mine.toml").write_text(STUDY)
    source = (ROOT / "tests/laws/cones.py").read_text()
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}

    def run(*calls, text=source):
        (tmp_path / "cones.py").write_text(text)
        command = [sys.executable, "-c", CALLS, *calls]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)

    first = run("run mine.toml --workers 2")
    assert first.returncode == 0, first.stderr
    with study.open_results(tmp_path / "results/mine.nc") as found:
        assert (found.status == 0).all() and found.attrs["micro_laws"] == "cones 1"
        same = study.solve(P=1e-5, base="half_space", micro=cones.CONES, alpha=found.alpha.values, Nbar=250_000.0)
        assert_allclose(found.a, same.a, rtol=1e-12, atol=0)
    newer = source.replace('version="1"', 'version="2"')
    refused = run("status mine.toml", "run mine.toml", text=newer)
    assert "outdated (0 of 40 cases can be used again)" in refused.stdout
    assert "40 of its 40 cases are not in this one" in refused.stderr
    broken = run("run mine.toml", text="raise OSError('no disk')\n")
    assert broken.returncode == 2
    assert "entry point cones = cones:CONES of roughcoat.laws: no disk" in broken.stderr


def test_a_law_given_as_an_object_travels_with_its_cases(tmp_path):
    """To a process that has not registered it."""
    register(cones.CONES)
    (tmp_path / "mine.toml").write_text(STUDY)
    definition = study.load(tmp_path / "mine.toml").definition
    (tmp_path / "parcel").write_bytes(pickle.dumps(parcel(definition, np.arange(40))))
    script = "import pickle, study.work.cases as w; print(w.compute(pickle.load(open('parcel', 'rb')))['status'].sum())"
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests/laws")])}
    command = [sys.executable, "-c", script]
    ran = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120)
    assert ran.stdout == "0\n", ran.stderr


def test_the_page_shows_this_law(tmp_path):
    """docs/own_law.md quotes the file, and what it prints is true."""
    assert (ROOT / "tests/laws/cones.py").read_text(encoding="utf-8") in pages.examples("docs/own_law.md")[0]
    pages.check_examples("docs/own_law.md", tmp_path, 2)
