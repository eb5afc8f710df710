"""Figures 3 to 10 and their companions: every line, label, band and limit against the datasets and against the CSV."""

import numpy as np
import pytest
import xarray as xr
from conftest import opened
from drawn import WORDS, bands, frame, legend, lines, texts

from solver import fit_power_law
from solver.laws.disc_cell import displacement
from study.figures.registry import entry

CASES = {"1": "rough, layered", "2": "rough, homogeneous", "1′": "smooth, layered", "2′": "smooth, homogeneous"}
EXACT = {"1": "rough, exact layer", "1′": "smooth, exact layer"}
P0 = 2.7040777  # load of the main case, in 1e-5 E2* R²
DEPTH = r"$D\ /\ (10^{-3} R)$"
# Figure -> quantity, what its axis is divided by, label of the axis, curves.
AGAINST_LOAD = {
    "fig04": ("Ar_An", 1, "$A_r/A_n$", ("1", "2")),
    "fig05": ("p_max", 1, r"$p_{\max}/E_2^*$", ("1", "2")),
    "fig06": ("D", 1e-3, DEPTH, ("1", "2")),
    "fig08": ("D", 1e-3, DEPTH, ("1", "2", "1′", "2′")),
}
# Figure -> study, its curves: name and place of the cases (the paper's, the one on the exact layer) in the study.
PROFILES = {
    "fig03": ("main_case", {"1": (0, 4), "2": (1, 1)}),
    "fig07": ("main_case", {"1": (0, 4), "2": (1, 1), "1′": (2, 5), "2′": (3, 3)}),
    "fig10": ("spot_density", {"1": (0, 3), "2": (1, 4), "3": (2, 5)}),
}
BOTH = pytest.mark.parametrize("exact", [False, True], ids=["paper", "companion"])
THIN = "thin layer (the paper)"


def same(found, expected) -> None:
    """The same numbers but for the rounding of a product or quotient."""
    np.testing.assert_allclose(found, expected, rtol=1e-14, atol=0)


def of_label(dataset: xr.Dataset, label: str) -> xr.Dataset:
    return dataset.isel(case=dataset.label.values.tolist().index(label))


def parts(drawing, name: str, exact: bool):
    figure, columns, _ = drawing(f"{name}_layered" if exact else name)
    (axes,) = figure.axes
    return axes, columns, lines(axes)


def check_legend(axes, drawn: list, words: list[str], exact: bool) -> dict:
    """All curves stand in the legend as they are drawn, and look different; a thin layer is a dotted line of the colour
    of its curve. Returns the entries that are no curves."""
    entries = legend(axes.get_legend())
    named = [line for line in drawn if line.label]
    assert [line.label for line in named] == words == list(entries)[: len(words)]
    assert all(entries[line.label] == line.look for line in named)
    assert len({line.look for line in named}) == len({line.look.dashes for line in named}) == len(named)
    for before, line in zip(drawn, drawn[1:], strict=False):
        if not line.label:
            assert (line.look.colour, line.look.dashes) == (before.look.colour, entries[THIN].dashes)
    rest = dict(list(entries.items())[len(words) :])
    assert (THIN in rest) == exact
    rest.pop(THIN, None)
    return rest


@BOTH
@pytest.mark.parametrize("name", AGAINST_LOAD)
def test_curves_against_the_load_are_the_datasets(drawing, results, name, exact):
    quantity, scale, label, curves = AGAINST_LOAD[name]
    axes, columns, (*drawn, mark) = parts(drawing, name, exact)
    sweep = opened(results / "load_sweep.nc")
    wanted, heads = [], []
    for curve in curves:
        layer = exact and curve in EXACT
        wanted.append(of_label(sweep, EXACT[curve] if layer else CASES[curve])[quantity])
        wanted += [of_label(sweep, CASES[curve])[quantity]] if layer else []
        heads += [f"{quantity} ({curve})"] + ([f"{quantity} ({curve}, thin layer)"] if layer else [])
    assert list(columns) == ["P/(E2* R^2)", *heads]
    same(columns["P/(E2* R^2)"], sweep.P)
    for line, values, head in zip(drawn, wanted, heads, strict=True):
        same(line.x, sweep.P * 1e5)
        same(line.y, values / scale)
        same(columns[head], values)
    assert frame(axes) == (r"$P\ /\ (10^{-5} E_2^* R^2)$", "linear", label, "linear", "")
    assert axes.get_xlim() == (0, pytest.approx(5))
    assert axes.get_ylim() == (0, pytest.approx(1.08 * max(line.y.max() for line in drawn if line.label)))
    check_legend(axes, drawn, [f"{curve}: {CASES[curve]}" for curve in curves], exact)
    same(mark.x, P0)
    assert texts(axes)["$P_0$ "] == (pytest.approx(P0), 0.98)
    assert mark.y[-1] == 1 and mark.look.dashes == ("solid",), "unlike every dotted line"


@BOTH
@pytest.mark.parametrize("name", AGAINST_LOAD)
def test_loads_are_shaded_where_a_curve_breaks_an_assumption(drawing, results, name, exact):
    """Each load counts as the nearest of the study; what is broken at all of them is written down."""
    axes, _, (*drawn, _) = parts(drawing, name, exact)
    curves = AGAINST_LOAD[name][3]
    sweep = opened(results / "load_sweep.nc")
    validity = {c: of_label(sweep, EXACT[c] if exact and c in EXACT else CASES[c]).validity.values for c in curves}
    P = sweep.P.values * 1e5
    trial = np.linspace(1e-4, 5, 997)
    nearest = np.abs(trial[:, None] - P).argmin(1)
    entries = check_legend(axes, drawn, [line.label for line in drawn if line.label], exact)
    everywhere, loads = {}, {}
    for mask, words in WORDS.items():
        broken = {c: flags & mask != 0 for c, flags in validity.items()}
        whose = [c for c, where in broken.items() if where.any()]
        somewhere = np.any(list(broken.values()), axis=0)
        words = f"{words} ({', '.join(whose)})"
        if somewhere[nearest].mean() > 0.75:  # too much to be shaded
            everywhere[mask] = whose
            last = int(somewhere.sum())
            assert somewhere[:last].all(), "from the smallest load on"
            unit = r" \times 10^{-5} E_2^* R^2$"
            loads[mask] = "" if somewhere.all() else f", $P < {(P[last - 1] + P[last]) / 2:.3g}{unit}"
        elif whose:
            colour = entries.pop(f"not valid: {words}")
            shaded = np.any([(a <= trial) & (trial < b) for a, b, c in bands(axes) if c == colour], axis=0)
            np.testing.assert_array_equal(shaded, somewhere[nearest])
    assert not entries, "nothing else in the legend"
    assert axes.get_title("left") == noted(everywhere, loads)
    assert bool(everywhere) != exact, "the paper's layer is not thin"


@BOTH
@pytest.mark.parametrize("name", PROFILES)
def test_pressures_are_the_profiles_of_the_datasets(drawing, results, name, exact):
    study, curves = PROFILES[name]
    axes, columns, drawn = parts(drawing, name, exact)
    found = opened(results / f"{study}.nc")
    a0 = float(found.a[0])
    assert a0 == pytest.approx(0.04, rel=1e-6), "the paper's"
    expected, words, broken = [], [], {}
    for curve, (paper, layered) in curves.items():
        case = found.isel(case=layered if exact else paper)
        expected.append((curve, case))
        expected += [(f"{curve}, thin layer", found.isel(case=paper))] if exact and layered != paper else []
        if study == "main_case":
            words.append(f"{curve}: {CASES[curve]}")
        else:
            density = {"1": 250000, "2": 62500, "3": 15625}[curve]
            words.append(rf"{curve}: $\bar N R^2 = {density}$")
        for mask in WORDS:
            broken.setdefault(mask, []).extend([curve] if int(case.validity) & mask else [])
    assert list(columns) == [head for key, _ in expected for head in (f"r/a0 ({key})", f"p/E2* ({key})")]
    for line, (key, case) in zip(drawn, expected, strict=True):
        same(line.x, case.x * case.a / a0)
        same(line.y, case.p * 100)
        same(columns[f"r/a0 ({key})"], line.x)
        same(columns[f"p/E2* ({key})"], case.p)
    assert frame(axes) == ("$r/a_0$", "linear", r"$p\ /\ (10^{-2} E_2^*)$", "linear", "")
    assert axes.get_xlim()[0] == 0 and axes.get_xlim()[1] >= max(line.x.max() for line in drawn)
    assert axes.get_ylim() == (0, pytest.approx(1.1 * max(line.y.max() for line in drawn)))
    assert not check_legend(axes, drawn, words, exact)
    assert axes.get_title("left") == noted({mask: curves for mask, curves in broken.items() if curves})


def noted(broken: dict[int, list[str]], loads=None) -> str:
    """The note above the axes: a line for each assumption that curves break nearly everywhere, and where that is."""
    return "\n".join(
        f"{', '.join(curves)}: {WORDS[mask]}{(loads or {}).get(mask, '')}" for mask, curves in broken.items()
    )


@pytest.mark.parametrize("name", [*PROFILES, *AGAINST_LOAD])
def test_every_figure_states_its_parameters(drawing, name):
    for suffix in ("", "_layered"):
        told = drawing(name + suffix)[0].get_suptitle().replace(",\n", ", ")
        roughness = "$R_a/R$ = 0.004" if name == "fig10" else "$\\bar N\\,R^2$ = 250000, $R_a/R$ = 0.004"
        assert told.removeprefix("$P/(E_2^*\\,R^2)$ = $2.704\\times10^{-5}$, ").startswith(
            f"$h/R$ = 0.02, $n$ = 0.5, frictionless interface, {roughness}"
        )
        assert told.startswith("$P") == (name in PROFILES)
        assert told.endswith("$B$ = 0.1 $R_a/E_1^{*\\beta}$, $\\beta$ = 0.5") == (name != "fig10")


@BOTH
@pytest.mark.parametrize("name", [*PROFILES, *AGAINST_LOAD])
def test_the_name_of_a_curve_stands_at_the_curve(drawing, name, exact):
    """On the uppermost or lowest of the lines that belong to the curve, at one place for all curves, in its colour."""
    axes, _, drawn = parts(drawing, name, exact)
    colours = {text.get_text(): text.get_color() for text in axes.texts}
    at = 0.12 if name in PROFILES else 0.85 * 5
    own = {}
    for line in drawn:
        if len(line.x) > 2 and line.label:
            own[curve := line.label.partition(":")[0]] = [line]
        elif len(line.x) > 2:
            own[curve].append(line)
    assert list(own) == list(PROFILES[name][1] if name in PROFILES else AGAINST_LOAD[name][3])
    for curve, its in own.items():
        x, y = texts(axes)[curve]
        assert x == pytest.approx(at)
        heights = [np.interp(at, line.x, line.y) for line in its]
        assert min(abs(y - max(heights)), abs(y - min(heights))) <= 1e-12 * y  # that point itself
        assert colours[curve].lower() == its[0].look.colour


def test_figure_9_shows_the_exact_law_and_its_fit(drawing):
    """The paper's pressures: 1e-4 to 0.025 E1* in steps of 1e-4."""
    figure, columns, _ = drawing("fig09")
    p = 1e-4 * np.arange(1, 251)
    np.testing.assert_allclose(columns["p/E1*"], p, rtol=1e-12)
    rows = [
        ("(a) $R_a/R = 0.004$", {rf"$\bar N R^2 = {N}$": (0.004, N) for N in (250000, 62500, 15625)}),
        (r"(b) $\bar N R^2 = 250000$", {f"$R_a/R = {Ra}$": (Ra, 250000) for Ra in (0.004, 0.002, 0.001)}),
    ]
    heads = {"p/E1*"}
    for axes, (title, cases) in zip(figure.axes, rows, strict=True):
        drawn = lines(axes)
        entries = legend(axes.get_legend())
        assert axes.get_legend().get_title().get_text() == title
        rounded = "with the paper's $B$, $\\beta$"
        assert list(entries) == ["exact, Eqs (6), (7)", r"fitted, $B p^{\beta}$", rounded]
        for fit, exact, paper, (name, (Ra, Nbar)) in zip(*(drawn[i::3] for i in range(3)), cases.items(), strict=True):
            B, beta, _ = fit_power_law(Nbar * Ra**2)
            printed = {4.0: (0.1, 0.50), 1.0: (0.3, 0.53), 0.25: (1.0, 0.57)}[round(Nbar * Ra**2, 9)]  # in Ra
            law = printed[0] * Ra * p ** printed[1]
            for line, kind, A in (
                (fit, "fit", B * Ra * p**beta), (exact, "exact", displacement(p, 1.0, Nbar, Ra)), (paper, "paper", law)
            ):  # fmt: skip
                np.testing.assert_allclose(line.x, p, rtol=1e-12)  # the steps, summed
                np.testing.assert_allclose(line.y, 1e4 * A, rtol=1e-12)
                same(columns[f"A/R Ra={Ra} N={Nbar} {kind}"], 1e-4 * line.y)
                heads.add(f"A/R Ra={Ra} N={Nbar} {kind}")
            assert exact.look == entries["exact, Eqs (6), (7)"] and exact.look.dashes != ("solid",)
            assert paper.look.dashes == entries[rounded].dashes and paper.look.colour == fit.look.colour
            assert fit.look.dashes == entries[r"fitted, $B p^{\beta}$"].dashes == ("solid",)
            assert texts(axes)[name] == (pytest.approx(0.95 * p[-1]), pytest.approx(np.interp(0.95 * p[-1], p, fit.y)))
        assert len({line.look.colour for line in drawn[::3]}) == 3
        assert frame(axes) == ("$p/E_1^*$", "linear", r"$A[p]\ /\ (10^{-4} R)$", "linear", "")
        assert axes.get_xlim() == (0, pytest.approx(0.025))
        assert axes.get_ylim()[0] == 0 and axes.get_ylim()[1] > 1.2 * drawn[-3].y.max(), "room for the legend"
    assert set(columns) == heads


def test_captions_say_why_the_load_is_not_the_printed_one():
    """Of all figures at P0, or over loads with P0 marked."""
    for name in ("fig03", "fig04", "fig05", "fig06", "fig07", "fig08", "fig10"):
        for caption in (entry("figure", name).caption, entry("figure", f"{name}_layered").caption):
            assert "P0 = 2.704e-5 E2* R²" in caption and "The paper prints 2.72e-5" in caption, name
