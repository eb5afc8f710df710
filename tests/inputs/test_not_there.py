"""Names that are no parameters: what is said of them never sends anybody to a parameter that means something else."""

import re
import tomllib
from importlib.resources import files

import pytest

import study
from study.inputs.vocabulary import PARAMETERS, ROWS, SCENE, VOCABULARY, no_parameter

BALL = {"R": "5 mm", "E2": "210 GPa", "P": "5 N", "base": "half_space", "micro": "smooth"}
NONE_HERE = {
    "friction": ["mu", "mu2", "friction", "friction_coeff", "Friction Coefficient", "COF"],
    "plasticity": [
        "sigma_y",
        "Sigma_Y",
        "Y",
        "yield_stress_layer",
        "H",
        "Hv",
        "H_film",
    ],
    "temperature": ["T", "temperature", "temperature_C", "T_body"],
    "motion": ["v", "viscosity", "sliding_speed", "wear_rate", "mass"],
    "time": ["creep", "tau", "relaxation_time"],
    "tilted and elliptic punches, and bodies that are not isotropic,": ["tilt", "ellipse"],
    "stresses": ["mises", "von_mises", "stress", "residual_stress"],
}
CALLED_HERE = {
    "P": ["F", "Fn", "F_N", "load", "force", "normal_force", "P_N", "max_load"],
    "D": ["delta", "indentation", "depth", "max_depth", "penetration", "h_max"],
    "h": ["t", "thickness", "coating_thickness", "t_c", "h_film"],
    "R": ["radius", "R_ball", "diameter", "R_punch"],
    "E1": ["E", "E1*", "E1_star", "E1star", "Estar", "E_star", "E_r", "Er", "E_film", "E_s", "young", "Youngs_modulus"],
    "nu1": ["nu", "nu_layer", "poisson", "poisson_ratio", "nu_s"],
    "sigma": ["Rq", "Sq", "Sa", "Rz", "Sz", "Rt", "roughness", "rms_slope", "cutoff", "Ra_scan"],
    "Nbar": ["N", "eta", "n_asperities", "pitch"],
    "bonding": ["bonded", "frictionless", "no_slip"],
    "w_adhesion": ["w", "gamma", "work_of_adhesion", "adhesion_energy", "surface_energy", "dW", "W12", "jkr", "W"],
    "k_machine": ["k_m", "spring_constant", "cantilever"],
    "shape": ["cone", "berkovich", "flat", "half angle", "punch_shape", "cylinder"],
    "micro": ["law", "macro", "model", "hertz"],
    "rtol": ["tol", "error"],
}


@pytest.mark.parametrize(("lacking", "name"), [(key, name) for key, names in NONE_HERE.items() for name in names])
def test_what_the_model_lacks_is_said(lacking, name):
    with pytest.raises(study.StudyError) as caught:
        study.solve(**BALL, **{name: 0.3})
    text = str(caught.value)
    assert (
        f"{lacking} is not in the model" in text
        or f"{lacking} are not in the model" in text
        or (lacking in ("motion", "stresses") and lacking[:6] in text and "not in the model" in text)
    )
    assert "did you mean" not in text and "\n" not in text


@pytest.mark.parametrize(("here", "name"), [(key, name) for key, names in CALLED_HERE.items() for name in names])
def test_what_is_called_otherwise_here_is_named(here, name):
    said = no_parameter(name, VOCABULARY)
    assert here in re.findall(r"\w+", said.partition("; ")[2]) and "did you mean" not in said


@pytest.mark.parametrize(
    "name", ["p_max", "pmax", "P_max", "p_mean", "p0", "p_0", "Ar", "Ar_An", "pressure", "stiffness"]
)
def test_of_a_wanted_result_the_search_is_told(name, tmp_path):
    """In a call, in a study file and on the command line alike."""
    said = (
        f'"{name}" is not a parameter; of the results P, a or D may be given\n    to reach a wanted {name}: solve for'
    )
    with pytest.raises(study.StudyError) as caught:
        study.solve(**BALL, **{name: "1 GPa"})
    assert said in str(caught.value)
    (tmp_path / "wanted.toml").write_text(f"[model]\n{name} = 0.1\n[axes]\nP = [1e-5]\n", encoding="utf-8")
    with pytest.raises(study.StudyError) as caught:
        study.load(tmp_path / "wanted.toml")
    assert f"[model] {said}" in str(caught.value)


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("Nabr", "Nbar"),
        ("hh", "h"),
        ("bondng", "bonding"),
        ("nu_1", "nu1"),
        ("ra", "Ra"),
        ("sigm", "sigma"),
        ("p", "P"),
    ],
)
def test_a_slip_of_the_pen_is_answered_with_the_name_near(name, near):
    said = no_parameter(name, [*PARAMETERS, *SCENE])
    assert near in re.findall(r"\w+", said.partition("; ")[2])


@pytest.mark.parametrize("name", ["E1x", "unch", "zeta", "gap"])
def test_a_name_that_begins_with_another_letter_is_not_near(name):
    """Symbols are short: E1x is no beta. What may be given is listed."""
    near = no_parameter(name, ["beta", "punch", "cut", "a"])
    assert "did you mean" not in near and ("; known: beta, punch" in near or "E1 and nu1" in near)


def test_no_word_of_the_file_is_answered_in_vain():
    """Each word of not_there.toml gives the sentence of its own section, and none is a parameter that may be given."""
    sections = tomllib.loads(files("study.inputs").joinpath("not_there.toml").read_text(encoding="utf-8"))
    alone = [(word, own["says"]) for own in sections.values() for word in own["words"] if word not in ROWS]
    wrong = [word for word, says in alone if says not in no_parameter(word, VOCABULARY)]
    assert len(alone) > 200 and wrong == []
