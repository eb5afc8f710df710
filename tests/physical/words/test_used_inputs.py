"""Which inputs a text or a figure states where the contacts of a dataset differ, and which numbers no body has."""

import warnings

import numpy as np
import pytest
import xarray as xr

import study
from study.in_words.stated_inputs import is_rigid, used_inputs
from study.inputs.vocabulary import ROWS
from study.rules.rule import sentences

FILM = {"base": "layered", "h": "2 um", "E1": "200 GPa"}
BARE = {"base": "half_space"}
SPOTS = {"micro": "disc_cell", "Nbar": "0.01 1/um^2", "Ra": "20 um"}
FLAT = SPOTS | {"micro": "smooth"}


def contacts(*cases: dict) -> xr.Dataset:
    """Two loads of the same bodies, or one load of each of the cases. What all cases have is given once."""
    cases = cases if len(cases) > 1 else [cases[0] | {"P": "1 N"}, cases[0] | {"P": "2 N"}]
    shared = {name: value for name, value in cases[0].items() if all(case.get(name) == value for case in cases)}
    rows = [{name: value for name, value in case.items() if name not in shared} for case in cases]
    load = {} if "P" in rows[0] else {"P": "1 N"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(cases=rows, R="5 mm", E2="210 GPa", x=2, **load, **shared)


@pytest.mark.parametrize(
    ("without", "having", "names"),
    [
        (BARE | {"micro": "smooth"}, FILM | {"micro": "smooth"}, {"h", "E1", "bonding"}),
        (BARE | FLAT, BARE | SPOTS, {"micro", "Nbar", "Ra"}),
        (FILM | FLAT, FILM | SPOTS, {"micro", "Nbar", "Ra"}),
    ],
    ids=["layer", "asperities", "asperities of a layer"],
)
def test_what_some_contact_needs_is_stated(without, having, names):
    assert not names & {*used_inputs(contacts(without))}
    assert names <= {*used_inputs(contacts(having))}
    assert names <= {*used_inputs(contacts(without, having))}, "one of the two contacts has it"


def test_what_is_of_rigid_bodies_is_stated_where_some_are_elastic():
    """ν of a rigid body says nothing; where some contacts have an elastic one it does."""
    punch, base = {"E_punch", "nu_punch"}, {"E2", "nu2"}
    smooth, bonded = {"micro": "smooth", "nu2": 0.25, "nu_punch": 0.2}, {"bonding": "bonded"}
    for names, some in ((punch, {"E_punch": ["rigid", "70 GPa"]}), (base, {"E2": ["rigid", "70 GPa"]})):
        bodies = {"E2": "210 GPa", "E_punch": "1 TPa"} | some
        both = study.solve(R="5 mm", P="1 N", x=2, **FILM, **bodies, **smooth, **bonded)
        (dim,) = some
        assert names <= {*used_inputs(both)}
        assert names <= {*used_inputs(both.isel({dim: [1]}))}
        rigid = both.isel({dim: [0]})
        assert not names & {*used_inputs(rigid)} and is_rigid(rigid, "punch" if names == punch else "base")


def test_the_ratio_of_a_half_space_says_nothing_of_a_base():
    """n = 0 is that of a rigid base under a layer; on the half-space it is a number that is not used."""
    contacts = study.solve(P=1e-5, h=0.02, n=0.0, micro="smooth", base=["half_space", "layered"], bonding="bonded", x=2)
    known = [is_rigid(contacts.isel(base=part), "base") for part in ([0], [0, 1], [1])]
    assert known == [False, False, True]


@pytest.mark.parametrize(("body", "ratio"), [("punch", "m"), ("base", "n")])
def test_ratios_of_which_some_are_0(body, ratio):
    """Without moduli the ratio says what is rigid: the bodies of all contacts, or not."""
    ratios = {"m": 0.5, "n": 0.5} | {ratio: [0.1, 0.5, 1.0]}
    some = study.solve(P=1e-5, h=0.02, micro="smooth", bonding="bonded", x=2, **ratios)
    some = some.assign_coords({ratio: [0.0, 0.5, 1.0]})
    parts = [some.isel({ratio: part}) for part in ([0], [0, 1], [1, 2])]
    assert [is_rigid(part, body) for part in parts] == [True, False, False]
    assert [ratio in used_inputs(part) for part in parts] == [False, True, True]


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_branches_are_stated_where_some_contact_is_unstable():
    sticking = {"R": "5 um", "E2": "5 kPa", "base": "half_space", "micro": "smooth", "w_adhesion": "0.1 mJ/m^2", "x": 2}
    both = study.solve(**sticking, P="-1 nN", branch=["stable", "unstable"])
    assert (both.status == 0).all()
    assert ["branch" in used_inputs(part) for part in (both, both.isel(branch=[1]), both.isel(branch=[0]))] == [
        *(True, True, False)
    ]
    assert "branch" not in used_inputs(study.solve(**sticking, a="1 um")), "a radius has one load"


def test_asperities_of_a_law_that_is_gone():
    """It may depend on whatever there is of asperities."""
    found = contacts(BARE | SPOTS, BARE | FLAT)
    gone = found.assign_coords(sigma=1e-6, micro=("case", ["their_own", "smooth"]))
    assert {"micro", "Nbar", "Ra", "sigma"} <= {*used_inputs(gone)}
    assert "sigma" not in used_inputs(found.assign_coords(sigma=1e-6))


INSIDE = {
    "R": (2e-10, 900.0), "Ra": (2e-10, 900.0), "h": (1e-10, 900.0),
    "E1": (1.5, 1.9e12), "E2": (1.5, 1.9e12), "E_punch": (1.5, 1.9e12),
}  # fmt: skip
"""Tips of atomic force microscopes have radii of some nm and rough ones tips of less; a layer may be some atoms thick;
the softest gels have some Pa, diamond 1.2 TPa."""


@pytest.mark.parametrize("name", INSIDE)
def test_ends_of_what_bodies_have(name):
    def said(value) -> list[str]:
        return sentences({name: xr.Variable("case", np.ravel(value), {"units": ROWS[name].unit})})

    for end, factor in zip(INSIDE[name], (0.25, 4.0), strict=True):
        assert not said(end), "it is far from anything real, but not beyond it"
        (text,) = said([end, end * factor])
        assert text.startswith(f"{name} = ") and text.endswith("is its unit right?")
    assert not said(np.inf), "rigid, or flat"
