"""Every study runs, every figure draws from it, and the numbers beside a figure are those of the datasets."""

import csv
import re
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from conftest import STUDIES, opened
from scipy.integrate import simpson

from study import StudyError
from study.catalogue import draw, entry, names, save, tabulate
from study.data.derived import effective_modulus, peak_pressure
from study.figures.formats import as_text
from study.figures.registry import DataTable, column, pick
from study.studies.evidence.validity_maps import error_over_thickness, from_layered
from study.studies.paper.curves import CURVES, EXACT_LAYER


@pytest.fixture(scope="module")
def figures(drawing, tmp_path_factory):
    """The path, without its suffix, of the files of a figure: written when they are first asked for."""
    folder = tmp_path_factory.mktemp("figures")

    @cache
    def written(name: str) -> Path:
        save(folder / name, *drawing(name))
        return folder / name

    return written


def numbers(figures, name: str) -> dict[str, np.ndarray]:
    with open(figures(name).with_suffix(".csv"), encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    return dict(zip(head, np.array(rows, dtype=float).T, strict=True))


DRAWINGS = ("fig01", "fig02")
FIGURES = {name: entry("figure", name) for name in names("figure") if name not in DRAWINGS}

# picard_domain maps what does not converge: test_picard_domain.py
CONVERGING = [file for file in STUDIES if file.stem != "picard_domain"]


@pytest.mark.parametrize("file", CONVERGING, ids=lambda file: file.stem)
def test_every_study_runs_and_converges(results, file):
    found = opened(results / f"{file.stem}.nc")
    refused = (found["status"] == 4) & (found["base"] == "thin_layer")
    beyond = (found["status"] == 10) & (found["base"] == "layered")  # the law of asperities that feel the layer
    assert ((found["status"] == 0) | refused | beyond).all()
    assert bool(refused.any()) == file.stem.startswith("validity")
    assert float(found["error"].max()) <= float(found["rtol"])


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_is_written(figures, name):
    from PIL import Image

    image = np.asarray(Image.open(figures(name).with_suffix(".png")))  # bytes: as floats it takes several times as long
    assert image.shape[1] == pytest.approx(300 * FIGURES[name].size[0], abs=1)
    darkest = np.minimum(np.minimum(image[..., 0], image[..., 1]), image[..., 2])
    assert 0.01 < np.mean(darkest < 0.9 * 255) < 0.9, "nearly blank, or nearly black"
    pdf = (figures(name).with_suffix(".pdf")).read_bytes()
    assert pdf.startswith(b"%PDF") and b"/Type3" not in pdf and b"CreationDate" not in pdf
    columns = numbers(figures, name)
    assert len(columns) >= 3
    assert all(np.isfinite(column).all() for column in columns.values())


def test_the_same_results_give_the_same_bytes(figures, results, tmp_path):
    for path in draw("fig04", results, tmp_path):
        assert path.read_bytes() == figures("fig04").with_suffix(path.suffix).read_bytes(), path.name


def test_profiles_of_figures_3_7_and_10_carry_the_load(figures, results):
    main = opened(results / "main_case.nc")
    a0, P0 = float(pick(main, label=CURVES["1"])["a"]), float(main["P"])
    for name in ("fig03", "fig07", "fig10", "fig03_layered", "fig07_layered", "fig10_layered"):
        columns = list(numbers(figures, name).values())
        for r, p in zip(columns[::2], columns[1::2], strict=True):
            load = 2 * np.pi * a0**2 * simpson(p * r, x=r)
            assert load == pytest.approx(P0, rel=2e-3), name  # Hertz has a vertical tangent at its edge
    assert numbers(figures, "fig03")["r/a0 (1)"][-1] == pytest.approx(1, rel=1e-12)  # a product with the same factor


def test_a_layer_spreads_the_contact_and_lowers_the_pressure(figures):
    found = numbers(figures, "fig03")
    assert found["r/a0 (1)"][-1] > found["r/a0 (2)"][-1]
    assert found["p/E2* (1)"][0] < found["p/E2* (2)"][0]


def test_figures_against_load_show_the_dataset(figures, results):
    sweep = opened(results / "load_sweep.nc")
    for name, quantity, curves in (("fig04", "Ar_An", 2), ("fig05", "p_max", 2), ("fig06", "D", 2), ("fig08", "D", 4)):
        found = numbers(figures, name)
        for curve in list(CURVES)[:curves]:
            expected = pick(sweep, label=CURVES[curve])[quantity]
            np.testing.assert_array_equal(found[f"{quantity} ({curve})"], expected)
            assert (np.diff(expected) > 0).all()


def test_companions_show_the_exact_layer_and_the_papers_beside_it(figures, results):
    assert {name.removesuffix("_layered") for name in FIGURES if name.endswith("_layered")} == {
        f"fig{number}" for number in ("03", "04", "05", "06", "07", "08", "10")
    }
    sweep = opened(results / "load_sweep.nc")
    for name, quantity in (("fig04", "Ar_An"), ("fig05", "p_max"), ("fig06", "D"), ("fig08", "D")):
        found = numbers(figures, f"{name}_layered")
        np.testing.assert_array_equal(found[f"{quantity} (1)"], pick(sweep, label=EXACT_LAYER["1"])[quantity])
        np.testing.assert_array_equal(found[f"{quantity} (1, thin layer)"], pick(sweep, label=CURVES["1"])[quantity])
        np.testing.assert_array_equal(found[f"{quantity} (2)"], numbers(figures, name)[f"{quantity} (2)"])
    paper, exact = numbers(figures, "fig10"), numbers(figures, "fig10_layered")
    for curve in "123":
        np.testing.assert_array_equal(exact[f"p/E2* ({curve}, thin layer)"], paper[f"p/E2* ({curve})"])
        assert exact[f"r/a0 ({curve})"][-1] < paper[f"r/a0 ({curve})"][-1], "the thin layer spreads the contact too far"


def test_validity_maps_show_the_error_and_leave_out_what_does_not_apply(figures, results):
    found, shown = opened(results / "validity.nc"), numbers(figures, "validity")
    a = found.a.sel(micro="disc_cell", case=0).transpose("base", "n", "h")
    first = (shown["row"] == 0) & (shown["material"] == 0)
    expected = a.sel(base="thin_layer") / a.sel(base="layered") - 1
    np.testing.assert_allclose(shown["error"][first], expected.values.ravel(), rtol=1e-12)  # the same arithmetic
    # the same arithmetic
    np.testing.assert_allclose(shown["h/a"][first], (found.h / a.sel(base="layered")).T.values.ravel(), rtol=1e-12)
    assert shown["n"][shown["material"] == 4].max() < 0.25 / (0.55 / 0.7), "there C <= 0"
    assert set(shown["row"]) == set(range(5)) and set(shown["material"]) == set(range(5))
    h_a, error = error_over_thickness(found.isel(case=4, micro=0), "D")
    assert h_a.dims == error.dims == ("n", "h") and "base" not in h_a.coords and "base" not in error.coords
    error = from_layered(found.isel(case=4), "D")
    assert error.dims == ("micro", "n", "h") and np.isnan(error.sel(n=0.95)).all() and "units" not in error.attrs


def test_coatings_go_from_the_film_to_the_body(results):
    found = opened(results / "coatings.nc")
    smooth = effective_modulus(found).sel(micro="smooth")
    np.testing.assert_allclose(smooth.sel(n=1, bonding="bonded"), 1, rtol=1e-6)  # no layer at all
    over_film = smooth / found.n
    soft, hard = over_film.sel(n=1e-3), over_film.sel(n=1e3)
    assert (soft.diff("P") > 0).all() and (soft > 1).all() and (soft < 1e3).all()
    assert (hard.diff("P") < 0).all() and (hard < 1).all() and (hard > 1e-3).all()
    rough = effective_modulus(found).sel(micro="disc_cell")
    assert (rough.isel(P=0) < smooth.isel(P=0)).all(), "asperities yield too"


def test_the_largest_pressure_of_a_hard_coating_is_not_in_the_middle(results):
    found = opened(results / "coatings.nc")
    peak = peak_pressure(found)
    rough = {"micro": "disc_cell"}
    np.testing.assert_allclose(peak.sel(n=1e-3, **rough), found.p_max.sel(n=1e-3, **rough), rtol=1e-9)
    assert (peak >= found.p_max * (1 - 1e-9)).all()
    assert (peak / found.p_max).sel(n=1e3, **rough).max() > 1.5


def test_figure_9_fits_the_exact_law(figures):
    found = numbers(figures, "fig09")
    for name, values in found.items():
        if name.endswith("exact"):
            where = found["p/E1*"] >= 0.0025
            np.testing.assert_allclose(found[name.replace("exact", "fit")][where], values[where], rtol=0.05)


@pytest.mark.parametrize(("name", "letters"), [("fig01", "P R r z a D h E"), ("fig02", "p b B E N")])
def test_schemes_are_copies_with_every_letter_of_the_model(name, letters, tmp_path):
    svg, pdf, png = draw(name, tmp_path / "no results", tmp_path / "figures")
    assert [path.name for path in (svg, pdf, png)] == [f"{name}.{kind}" for kind in ("svg", "pdf", "png")]
    words = "".join(ElementTree.parse(svg).getroot().itertext())
    assert set(letters.split()) <= set(words)
    assert pdf.read_bytes().startswith(b"%PDF") and png.read_bytes().startswith(b"\x89PNG")
    assert name in DRAWINGS


def test_messages_of_plot(results, tmp_path, monkeypatch):
    with pytest.raises(StudyError, match='"fig3" is not known; did you mean "fig03"?'):
        draw("fig3", results, tmp_path)
    with pytest.raises(StudyError, match='"7" is not known; did you mean "fig07"?'):
        draw("7", results, tmp_path)
    with pytest.raises(StudyError, match='"1" is not known; did you mean "table1"?'):
        tabulate("1", results, tmp_path)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").touch()
    with pytest.raises(StudyError, match='"mine" is not known; did you mean "mine.toml"?'):
        draw("mine", results, tmp_path)
    with pytest.raises(StudyError, match="main_case.nc: does not exist, .* run main_case"):
        draw("fig03", tmp_path, tmp_path)


def test_pick_wants_exactly_one_case(results):
    found = opened(results / "spot_density.nc")
    with pytest.raises(StudyError, match="spot_density: 2 cases have Nbar = 62500: needs one"):
        pick(found, Nbar=62_500)
    with pytest.raises(StudyError, match="spot_density: 0 cases have Nbar = 62500.001, base = layered: needs one"):
        pick(found, Nbar=62_500.001, base="layered")
    assert float(pick(found, Nbar=62_500 * (1 - 5e-10), base="thin_layer")["B"]) == float(found["B"][1])


def test_files_carry_the_name_and_the_studies_and_fit_a_page(figures, results):
    from PIL import Image

    studies = (opened(results / f"{name}.nc") for name in ("load_sweep", "main_case"))
    title = "fig04, studies " + " ".join(found.attrs["study_digest"][:16] for found in studies)
    assert Image.open(figures("fig04").with_suffix(".png")).text["Title"] == title
    assert title.encode() in (figures("fig04").with_suffix(".pdf")).read_bytes()
    assert {recipe.size[0] for recipe in FIGURES.values()} == {3.35, 6.9}  # inches: one and two columns
    assert max(recipe.size[1] for recipe in FIGURES.values()) < 9.5


def test_captions_of_all_figures_that_have_results(results, tmp_path, monkeypatch):
    monkeypatch.setattr("study.figures.registry.opened", opened)
    (path,) = draw("captions", results, tmp_path)
    said = dict(re.findall(r"^[*]{2}(\w+)\.[*]{2} (.*)$", path.read_text(encoding="utf-8"), flags=re.MULTILINE))
    assert set(said) == {*FIGURES, *DRAWINGS} and all(len(text) > 40 for text in said.values())
    assert "Parameters: $P/(E_2^*\\,R^2)$ = $2.704\\times10^{-5}$, $h/R$ = 0.02" in said["fig03"]
    assert "The layer is exact" in said["fig03_layered"] and "1e-14 to 1e-3" in said["coatings"]
    found = opened(results / "coatings.nc")
    assert (float(found["P"].min()), float(found["P"].max())) == pytest.approx((1e-14, 1e-3))
    (path,) = draw("captions", tmp_path, tmp_path)
    said = re.findall(r"^[*]{2}(\w+)\.", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert said == ["fig01", "fig02", "fig09", "fig09_lattice", "scan_law", "substrate", "yielding"], "of what is there"


@pytest.mark.parametrize(
    ("columns", "row", "message"),
    [
        ("a; b | .3g", (0.5, 0.5), 'column "a" has no format, which does not fit 0.5: write one behind it, "a | .4g"'),
        ("a; b | d", ("x", 0.5), 'column "b" has the format "d", which does not fit 0.5'),
        ("a; b | .3g", ("x", None), 'column "b" has the format ".3g", which does not fit None'),
    ],
)
def test_a_cell_that_its_column_does_not_fit(columns, row, message):
    """It ended in the words of Python: "Unknown format code 's' for object of type 'float'"."""
    table = DataTable((), lambda: [row], "", tuple(map(column, columns.split("; "))))
    with pytest.raises(StudyError, match=re.escape(message)):
        as_text(table, [row])
