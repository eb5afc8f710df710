"""What a design refuses, before it computes: one message with the input, its value and what is allowed."""

import pytest

import study

LINING = {"R": "5 mm", "punch": "steel 52100", "layer": "PTFE", "body": "steel 52100", "bonding": "bonded",
          "micro": "smooth", "P": "1 N"}  # fmt: skip
TARGET, BY = {"p0": "20 MPa"}, {"h": ("1 um", "1 mm")}


@pytest.mark.parametrize(
    ("target", "by", "more", "message"),
    [
        ("p0", BY, {}, '"p0": give exactly one wanted result with its value, such as {"p_max": "180 MPa"}'),
        (TARGET | {"D": "1 um"}, BY, {}, "2 targets: give exactly one wanted result"),
        ({"p_maxx": "1 MPa"}, BY, {}, '"p_maxx" is not a result that can be wanted; did you mean "p_max"?'),
        ({"p0": "20 um"}, BY, {}, 'p0 = "20 um" is a length: must be a pressure'),
        ({"p0": 20}, BY, {}, "p0 = 20 has no unit: must be a pressure"),
        ({"p0": "20 ± 1 MPa"}, BY, {}, "a wanted value has no ±"),
        ({"p0": "-20 MPa"}, BY, {}, 'p0 = "-20 MPa": must be > 0'),
        ({"Ar_An": 1.5}, BY, {}, "Ar_An = 1.5: must be in (0, 1]"),
        ({"p0": ["20 MPa", "30 MPa"]}, BY, {}, "p0 = ['20 MPa', '30 MPa']: must be a pressure"),
        ({"P": "1 N"}, BY, {}, "P is the target, and P is given: leave it out"),
        ({"h": "1 um"}, BY, {}, '"h" is not a result that can be wanted'),
        (TARGET, {"h": ("1 mm", "1 um")}, {}, 'by: h = ("1 mm", "1 um"): the first bound must be below the second'),
        (TARGET, {"h": ("1 um", "1000 nm")}, {}, "the first bound must be below the second"),
        (TARGET, {"h": (1, 2)}, {}, 'h = 1 has no unit: must be a length, such as "2 mm"'),
        (TARGET, {"h": ("1 N", "2 N")}, {}, 'h = "1 N" is a force: must be a length'),
        (TARGET, {"h": ("-1 um", "1 mm")}, {}, "h = -1 um: must be in [5e-09, 5e+09] um"),
        (TARGET, {"h": ("1 um", "9 km")}, {}, "h = 9 km: must be in"),
        (TARGET, {"h": ("1 um", "1 ± 0.1 mm")}, {}, "a bound has no ±"),
        (TARGET, {"h": "1 um"}, {}, 'by: h = "1 um": must be two bounds, such as by={"h": ("1 um", "1 mm")}'),
        (TARGET, {"h": ("1 um", "2 um", "3 um")}, {}, "must be two bounds"),
        (TARGET, {"h": (["1 um"], "2 um")}, {}, "must be two bounds"),
        (TARGET, ["h"], {}, "by = ['h']: give exactly one input with two bounds"),
        (TARGET, BY | {"E1": ("1 GPa", "2 GPa")}, {}, "give exactly one input with two bounds"),
        (TARGET, {"bonding": ("bonded", "frictionless")}, {}, "by: bonding is not a number of the contact"),
        (TARGET, {"rtol": (1e-6, 1e-3)}, {}, "by: rtol is not a number of the contact"),
        (TARGET, {"thickness": ("1 um", "1 mm")}, {}, 'by: "thickness" is not a parameter; the thickness of the layer'),
        (TARGET, {"P": ("1 N", "2 N")}, {}, "P is both given and searched for (by): leave one of them out"),
        (TARGET, {"D": ("1 um", "2 um")}, {"h": "1 um"}, "exactly one of P, a, D must be given, not P and D"),
        (TARGET, {"E1": ("1 GPa", "2 GPa")}, {"h": "1 um"}, "layer and E1 are both given"),
        (TARGET, BY, {"h": "1 um"}, "h is both given and searched for (by): leave one of them out"),
        (TARGET, BY, {"P": None}, "exactly one of P, a, D must be given, not none"),
        (TARGET, BY, {"cases": []}, "cases must be a list of dictionaries, at least one"),
        (TARGET, BY, {"colour": 1}, '"colour" is not a parameter'),
        (TARGET, BY, {"progress": "yes"}, "must be True, False or None"),
    ],
)
def test_what_a_design_refuses(target, by, more, message, monkeypatch):
    monkeypatch.setattr("study.inverse.design_cases.solve", lambda *_: pytest.fail("it computes"))
    with pytest.raises(study.StudyError) as refusal:
        study.design(target, by=by, **LINING | more)
    assert message in str(refusal.value) and "\n" not in str(refusal.value)


def test_without_units():
    layer = {"n": 0.5, "P": 1e-5, "bonding": "bonded", "micro": "smooth"}
    for target, by, message in (
        ({"p0": "0.01 GPa"}, {"h": (1e-3, 0.1)}, 'p0 = "0.01 GPa": no other input has a unit: give a number, in E2*'),
        ({"p0": float("nan")}, {"h": (1e-3, 0.1)}, "p0 = nan: must be one finite number"),
        ({"p0": 0.01}, {"h": (0.0, 0.1)}, "h = 0.0: must be in [1e-12, 1e6]"),
        ({"p0": 0.01}, {"h": (1e-3, float("inf"))}, "h = inf: must be a finite number"),
    ):
        with pytest.raises(study.StudyError, match=r"^design: ") as refusal:
            study.design(target, by=by, **layer)
        assert message in str(refusal.value)
