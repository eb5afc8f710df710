"""The tables of formulas for cones, flat punches and balls, and of pull-off loads, against what is known of them."""

import csv

import pytest

import study

LAYER = {"E2": "rigid", "R": "1 mm", "E1": "1 MPa", "bonding": "bonded", "micro": "smooth"}


def rows(tables, name):
    with open(tables / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_limits_and_signs_of_pull_off(tables):
    """A layer that is squeezed out, of ν = 1/2, holds up to twice the load of a half-space, springs 4/3 of it."""
    table = {row["layer"]: row for row in rows(tables, "literature_pull_off")}
    assert {label: float(row["limit"]) for label, row in table.items()} == {
        "frictionless": pytest.approx(1 / 3),
        "bonded, ν = 0.3": pytest.approx(1 / 3),
        "bonded, ν = 0.45": pytest.approx(1 / 3),
        "bonded, ν = 0.5": pytest.approx(1.0),
    }
    for row in table.values():  # the shrunken results have few thicknesses: the curve between them is rough
        assert 0 < float(row["a/h = 1"]) < float(row["a/h = 4"]) < float(row["limit"]) + 0.1


def test_a_pull_off_load_of_the_table(tables):
    """Of the layer of ν = 1/2 at a/h = 1, by one contact whose thickness is that of its own radius of pull-off."""
    w, off = 1e-3, None
    for h in (2e-4, 3e-4):
        contact = study.solve(**LAYER, nu1=0.5, h=f"{h} m", w_adhesion=f"{w} J/m^2", P="0 N")
        ratio = float(contact.P_off) / (-1.5 * 3.141592653589793 * 1e-3 * w) - 1
        off = (*off, (float(contact.a_off) / h, ratio)) if off else ((float(contact.a_off) / h, ratio),)
    assert 0 < off[1][1] < off[0][1] and off[1][0] < off[0][0], "the thinner, the more"


def test_formulas_for_thin_layers_are_right_where_the_layer_is_thick(tables):
    """Of two terms and more, at a/h = 0.1, but for what few thicknesses leave to the curve between them; a half-space
    errs by about a/h."""
    table = rows(tables, "literature_shapes")
    assert {row["shape"] for row in table} >= {"cone", "flat"}
    for row in table:
        error = abs(float(row["a/h = 0.1"]))
        if row["formula"].startswith("Garcia"):
            assert error < 0.05, row
        if row["formula"].startswith("Sneddon"):
            assert 0.05 < error < 0.15, row
