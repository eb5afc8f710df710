"""Laws with a slip, which a law of somebody else's may have: each is told by name, before anything is computed."""

import dataclasses
import pickle
import re
from functools import partial
from types import SimpleNamespace

import cones
import numpy as np
import pytest
from numpy.testing import assert_array_equal

import study
from solver import Problem, known, laws, solve
from solver.known import register
from solver.laws import trial
from solver.parameters import Parameter, ends
from study.__main__ import main
from study.inputs.lexicon import lexicon_in
from study.inputs.reading import from_tables
from study.work.cases import can_travel, compute, parcel
from study.work.run import run

pytestmark = pytest.mark.usefixtures("forgetful")

CASE = {"P": [1e-6, 1e-5], "base": "half_space", "Nbar": 250_000.0, "alpha": 1.3, "x": 3}
AT = " (at y = 0.0009, Nbar = 2.5e+05, alpha = 1.3)"
SHAPE = " must return an array of the shape of y, (cases, points)"
FOUR = "curve must return a Curve of four arrays of the shape of y, (cases, points)"
NUMBERS = " must return numbers, one for all or one for each of what it is given"
q, g = (lambda y: y**4), (lambda y: y**2)


def curve(**other):
    """The curve of the cones with another part."""
    return {"curve": lambda y: cones.curve(y)._replace(**{name: part(y) for name, part in other.items()})}


def raises(y):
    raise RuntimeError("boom")


SLIPS = {
    "raises": ({"curve": raises}, r"curve raises RuntimeError: boom \(test_trial.py, line \d+\)"),
    "no Curve": ({"curve": lambda y: (y, y, y, y)}, FOUR),
    "shape of q": (curve(q=lambda y: q(y)[:, :1]), FOUR),
    "shape of area": ({"area": lambda y, q: q[:, 0]}, "area" + SHAPE),
    "one area": ({"area": lambda y, q: 0.3}, "area" + SHAPE),
    "shape of peak": ({"peak": lambda y, q: np.ones(2)}, "peak" + NUMBERS),
    "one of the edge": ({"edge": lambda: 1.0}, "edge must return two values, gamma and beta"),
    "words at the edge": ({"edge": lambda: (1.0, "0.5")}, "edge" + NUMBERS),
    "p* alone": (
        {"scales": lambda E, Nbar, alpha: E},
        "scales must return p*, A* and what else the functions need, each of the shape of E",
    ),
    "no alpha": ({"scales": lambda E, Nbar: (E, E)}, r"scales raises TypeError: .* argument 'alpha'"),
    "touching": ({"touching": lambda A, **given: "x"}, "touching" + NUMBERS),
    "falling q": (curve(q=lambda y: 1 / (1 + q(y))), "curve: q must increase from 0 at y = 0" + AT),
    "q begins above 0": (curve(q=lambda y: 0.1 + q(y)), "curve: q must increase from 0 at y = 0" + AT),
    "a hump": (curve(g=lambda y: np.sin(30 * g(y)) ** 2), "curve: g must increase from 0 at y = 0 (at y = 0.418"),
    "dq": (curve(dq=lambda y: 4.01 * y**3), "curve: dq must be the derivative of q by y" + AT),
    "dg": (curve(dg=lambda y: y), "curve: dg must be the derivative of g by y" + AT),
    "from_pressure": ({"from_pressure": lambda q: q**0.3}, "from_pressure must be the inverse of q of curve" + AT),
    "from_displacement": ({"from_displacement": np.square}, "from_displacement must be the inverse of g of curve" + AT),
}


@pytest.mark.parametrize(("change", "text"), SLIPS.values(), ids=SLIPS)
def test_a_slip_is_told_and_nothing_computed(change, text):
    """dP/dD of a law with a wrong derivative was wrong by 2 %, with the status 0."""
    law = dataclasses.replace(cones.CONES, name="slip", **change)
    pattern = text if "raises" in text else re.escape(text)
    with pytest.raises(study.StudyError, match="^solve: micro law slip: " + pattern):
        study.solve(**CASE, micro=law)
    given = {name: CASE[name] for name in CASE if name != "x"}
    with pytest.raises(ValueError, match="^micro law slip: " + pattern):
        solve(Problem.of(**given, micro=law))


def test_a_slip_is_told_by_check(tmp_path, monkeypatch, capsys):
    """Of a case in the middle of a grid over two laws, with exit code 2."""
    monkeypatch.chdir(tmp_path)
    register(dataclasses.replace(cones.CONES, name="slip", **curve(dq=lambda y: y)))
    (tmp_path / "mine.toml").write_text(
        '[model]\nbase = "half_space"\nNbar = 1e5\nRa = 0.004\nalpha = 1.3\n'
        '[axes]\nmicro = ["disc_cell", "slip"]\nP = [1e-6, 1e-5]\n'
    )
    assert main(["check", "mine.toml"]) == main(["run", "mine.toml"]) == 2
    assert capsys.readouterr().err.startswith("mine.toml: micro law slip: curve: dq must be the derivative of q by y")
    assert not (tmp_path / "results").exists()


def test_nan_is_no_slip():
    """Of a law that does not know a case: that is a status, and the other cases go on."""
    law = dataclasses.replace(cones.CONES, name="shy", scales=shy)
    found = study.solve(**CASE | {"alpha": [1.2, 1.3, 1.4]}, micro=law)
    assert_array_equal(found.status, [[0, 3, 0]] * 2)


def shy(E, Nbar, alpha):
    p_star, A_star = cones.scales(E, Nbar, alpha)
    return np.where(alpha == 1.3, np.nan, p_star), A_star


@pytest.mark.parametrize("name", [name for name, law in laws.LAWS.items() if law.rough])
def test_laws_of_this_package_pass(name, monkeypatch):
    """With parameters from all of their intervals, and where a derivative errs by more than 1e-5 at no point."""
    monkeypatch.setattr(trial, "_WRONG", 1e-5)
    monkeypatch.setattr(trial, "_PART", 0.0)
    random, law = np.random.default_rng(0), laws.LAWS[name]

    def drawn(own):
        low, high, *_ = ends(own.interval)
        return high * 10 ** random.uniform(np.log10(low / high) if low else -8, 0, 3)

    for usual in [{}, {"Nbar": np.full(3, 250_000.0), "Ra": np.full(3, 0.004)}] * 20:
        E, given = 10 ** random.uniform(-6, 6, 3), {key: drawn(row) for key, row in law.parameters.items()} | usual
        given |= {"nu": random.uniform(0, 0.5, 3), "yield_strength": np.full(3, np.nan)} if "hardness" in given else {}
        trial.tried(law, E, given)


def declared(name="alpha", **other) -> dict:
    return {name: Parameter(**{"interval": "(0, 1)"} | other)}


OTHER = "has another interval, default, unit or words than that of disc_cell: give it another name"
DECLARED = {
    "no dictionary": (["alpha"], "parameters must be a dictionary, name -> Parameter"),
    "no Parameter": ({"alpha": (0, 1)}, "the parameter alpha must be a Parameter with an interval"),
    "no interval": ({"alpha": Parameter()}, "the parameter alpha must be a Parameter with an interval"),
    "no blank": (declared(interval="(0,1)"), "the parameter alpha must be a Parameter with an interval"),
    "backwards": (declared(interval="(1, 0)"), "the parameter alpha must be a Parameter with an interval"),
    "words": ({"alpha": Parameter(choices=("a", "b"))}, "the parameter alpha must be a Parameter with an interval"),
    "default": (declared(default=3.0), "the parameter alpha has the default 3.0, outside (0, 1)"),
    "of another law": (declared("Ra"), f"the parameter Ra {OTHER}"),
}
for powers in ((1,), (0.5, 1.0), (1.0, -1.0), [1, -1]):
    said = "the parameter alpha must have powers of two whole numbers, (i, j) of E2*^i R^j"
    DECLARED[f"powers {powers}"] = declared(powers=powers), said
for name in ("al pha", "_alpha", "1alpha", "", 1):
    DECLARED[f"name {name!r}"] = declared(name), f"the parameter {name!r} must have a name of letters"
for name in ("E", "E1", "punch", "workers", "a_spread", "P", "rtol", "take", "p_max"):
    DECLARED[f"name {name}"] = declared(name), f"the name of the parameter {name} is that of something else"


@pytest.mark.parametrize(("parameters", "text"), DECLARED.values(), ids=DECLARED)
def test_what_a_law_declares_is_checked(parameters, text):
    before = known.default()
    with pytest.raises(ValueError, match=re.escape(f"micro law slip: {text}")):
        register(dataclasses.replace(cones.CONES, name="slip", parameters=parameters))
    assert known.default() is before


@pytest.mark.parametrize("version", [1, 1.5, True, None, "", ("1",)])
def test_a_version_is_a_text(version):
    with pytest.raises(ValueError, match="micro law slip: version must be a text, which changes whenever"):
        register(dataclasses.replace(cones.CONES, name="slip", version=version))


def test_no_law_can_hide_an_attribute_of_a_problem():
    assert {name for name in dir(Problem) if name[0] != "_"} <= known.RESERVED


def defined(law):
    register(law)
    tables = {"model": {name: CASE[name] for name in ("base", "Nbar", "alpha")} | {"Ra": 0.004}}
    tables["axes"] = {"P": CASE["P"], "micro": ["disc_cell", law.name]}
    return from_tables(tables, "mine", "", "mine.toml")


def test_which_laws_can_go_to_other_processes(monkeypatch):
    """Functions without a name, and those of the program, cannot; also where the first case has another law."""
    assert can_travel(defined(cones.CONES))
    assert not can_travel(defined(dataclasses.replace(cones.CONES, name="nameless", edge=lambda: (1.0, 0.5))))
    monkeypatch.setattr(cones.edge, "__module__", "__main__")
    assert not can_travel(defined(dataclasses.replace(cones.CONES, name="mine", edge=cones.edge)))


def test_a_law_of_this_package_may_have_a_version(monkeypatch):
    """It has a key of its own by that, and does not travel: a worker has it."""
    law = register(dataclasses.replace(cones.CONES, name="ours"))
    definition = defined(law)
    monkeypatch.setattr(laws, "BUILT_IN", (*laws.BUILT_IN, law))
    sent = parcel(definition, np.arange(4))
    assert "ours" not in pickle.loads(pickle.dumps(sent)).known.laws
    assert (compute(sent)["status"] == 0).all()


@pytest.fixture
def entries(monkeypatch):
    """entries(NAME=law, ...): entry points that give these objects; an exception is raised."""

    def load(given):
        if isinstance(given, Exception):
            raise given
        return given

    def make(**given):
        made = [SimpleNamespace(name=name, value=f"{name}:LAW", load=partial(load, law)) for name, law in given.items()]
        monkeypatch.setattr("importlib.metadata.entry_points", lambda group: made)
        known.installed.laws.cache_clear()

    yield make
    known.installed.laws.cache_clear()


def test_a_file_has_parameters_of_an_installed_law(entries, tmp_path):
    """They are read before `micro`, which names the law."""
    entries(ours=dataclasses.replace(cones.CONES, name="ours"))
    (tmp_path / "mine.toml").write_text(
        '[model]\nalpha = 1.2\nNbar = 1e4\nP = 1e-5\nbase = "half_space"\nmicro = "ours"\n'
    )
    assert study.load(tmp_path / "mine.toml").definition.grid.values["alpha"][1] == 1.2


def test_two_installed_laws_of_one_name_are_refused(entries):
    """Which of them a study meant cannot be told. Other laws can be used."""
    one, two, other = (dataclasses.replace(cones.CONES, name=name) for name in ("twin", "twin", "single"))
    entries(first=one, second=[two, other])
    with pytest.raises(study.StudyError) as error:
        study.solve(**CASE, micro="twin")
    places = "entry point first = first:LAW of roughcoat.laws and entry point second = second:LAW of roughcoat.laws"
    assert f"{places} have laws of one name, twin: one must go" in str(error.value)
    assert (study.solve(**CASE, micro="single").status == 0).all()


def test_a_broken_package_does_not_keep_others_from_being_used(entries):
    good = dataclasses.replace(cones.CONES, name="good")
    entries(broken=OSError("no disk"), good=good)
    assert (study.solve(**CASE, micro="good").status == 0).all()
    with pytest.raises(study.StudyError, match="entry point broken = broken:LAW of roughcoat.laws: no disk"):
        study.solve(**CASE, micro="unheard_of")


def test_a_law_that_the_program_registered_stays(entries):
    """When the laws of installed packages are loaded, of which one has its name."""
    mine = register(dataclasses.replace(cones.CONES, name="named_twice"))
    entries(theirs=[dataclasses.replace(mine, version="theirs"), dataclasses.replace(mine, name="more")])
    found = study.solve(**CASE, micro="more")
    assert (found.status == 0).all()
    assert lexicon_in(study.solve(**CASE, micro=["more", "named_twice"])).known.laws["named_twice"] is mine


def test_results_find_their_law_again(tmp_path, entries):
    """In a program that has not named it: `p_peak` was NaN, and `Nbar` was told as not used."""
    tables = {"model": {name: CASE[name] for name in ("base", "Nbar", "alpha")} | {"micro": "cones", "P": 1e-5}}
    register(cones.CONES)
    run(from_tables(tables, "mine", "", "mine.toml"), tmp_path)
    same = study.derived.peak_pressure(study.solve(**CASE | {"P": 1e-5}, micro="cones"))

    def opened(**installed):
        known._default.known = known.PACKAGE
        entries(**installed)
        return study.open_results(tmp_path / "mine.nc")

    found = opened(cones=cones.CONES)
    assert_array_equal(study.derived.peak_pressure(found), same)
    assert "Not used" not in str(study.summary(found)) and "alpha = 1.3" in str(study.summary(found))
    newer = opened(cones=dataclasses.replace(cones.CONES, version="2"))
    assert np.isnan(study.derived.peak_pressure(newer))
    unknown = opened()
    assert np.isnan(study.derived.peak_pressure(unknown)) and "Not used" not in str(study.summary(unknown))


def test_a_loaded_study_runs_with_the_law_that_it_was_loaded_with(tmp_path):
    """Its results have the digest of that version, whatever is registered meanwhile."""
    definition = defined(cones.CONES)
    register(dataclasses.replace(cones.CONES, version="2", area=lambda y, q: 0.5 * q / (1 + q)))
    assert run(definition, tmp_path).computed == 4
    same = study.solve(**CASE, micro=cones.CONES)
    assert_array_equal(study.open_results(tmp_path / "mine.nc").Ar_An.sel(micro="cones"), same.Ar_An)
