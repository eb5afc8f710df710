"""`figures.py` beside studies of a user: found by its text, run when it is asked for and not before."""

import os
import sys
from itertools import count
from pathlib import Path

import pytest
from children import PATIENCE, run_forked

import study
from study.__main__ import main
from study.commands.arguments import proposed
from study.figures import figure_files, registry

GOOD = """
[model]
micro = "smooth"
base = "half_space"
[axes]
P = [1e-6, 2e-6, 3e-6]
"""
HEAD = "from pathlib import Path\n\nfrom study.figures.registry import figure, table\n\nPath('it-ran').touch()\n"
FIGURE = """

@figure("{name}", "{study}")
def {name}(axes, line):
    \"\"\"The radius against the load.\"\"\"
    axes.plot(line["P"], line["a"])
    return {{"P": line["P"].values, "a": {factor} * line["a"].values}}
"""
TABLE = """

@table("loads", "good", columns="P | .1e")
def loads(line):
    \"\"\"The loads.\"\"\"
    return [(P,) for P in line["P"].values.tolist()]
"""


def figure(name: str, factor="1", study="good") -> str:
    return FIGURE.format(name=name, factor=factor, study=study)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch) -> Path:
    """The working folder of a user with a study and a figure and a table beside it."""
    monkeypatch.chdir(tmp_path)
    put("studies/good.toml", GOOD)
    put("studies/figures.py", HEAD + figure("radius") + TABLE)
    return tmp_path


clock = count(1_700_000_000)


def put(name: str, text: str) -> Path:
    path = Path(name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    seconds = next(clock)
    os.utime(path, (seconds, seconds))  # Python asks for the second in which a file was changed
    return path


def ran() -> bool:
    """Whether the code beside the study has run since this was asked last."""
    there = Path("it-ran").exists()
    Path("it-ran").unlink(missing_ok=True)
    return there


def shown(name: str) -> list[str]:
    """The lines of the numbers of a figure."""
    return Path(f"figures/{name}.csv").read_text(encoding="utf-8").splitlines()


def test_it_runs_when_its_figure_or_table_is_asked_for_and_not_before(capsys):
    quiet = ("list", "check good", "run --dry-run good", "run good", "status good", "verify good", "clean good")
    for command in (*quiet, "point P=1e-5 base=half_space micro=smooth", "plot fig01", "table table1",
                    "plot good --x P --y a"):  # fmt: skip
        assert main(command.split()) == 0 and not ran(), command
    for command in ("plot radios", "table nothing", "plot good", "run nothing", "plot radius --x P"):
        assert main(command.split()) == 2 and not ran(), command
    assert '"radios" is not known; did you mean "radius"?' in capsys.readouterr().err
    study.load("studies/good.toml").open()
    assert proposed("plot", "rad") == ["radius"] and proposed("table", "lo") == ["loads"]
    assert registry.names("figure")[0] == "radius" and not ran()
    assert main(["plot", "radius"]) == 0 and ran()
    assert main(["table", "loads"]) == 0
    assert Path("tables/loads.txt").read_text(encoding="utf-8").startswith("The loads.\n")


@pytest.mark.parametrize("place", [".", "studies", "studies/chapter"])
def test_it_is_found_beside_the_study_and_so_is_the_study(place, capsys):
    name = f"in_{place[-1] if place != '.' else 'here'}"
    put(f"{place}/other.toml", GOOD.replace("3e-6", "4e-6"))
    put(f"{place}/figures.py", HEAD + figure(name, study="other"))
    assert main(["plot", "--run", name]) == 0
    assert shown(name)[-1].startswith("4e-06,") and Path("results/other.nc").exists()
    assert main(["plot", "--run", name]) == 0 and "is up to date" in capsys.readouterr().out


def test_a_folder_anywhere_may_be_named():
    put("elsewhere/other.toml", GOOD.replace("3e-6", "5e-6"))
    put("elsewhere/figures.py", HEAD + figure("far", study="other"))
    assert main(["plot", "--run", "far"]) == 2
    assert main(["plot", "--run", "elsewhere/far"]) == 0
    assert shown("far")[-1].startswith("5e-06,") and sorted(os.listdir("figures"))[1:] == [
        f"far.{e}" for e in ("csv", "pdf", "png")
    ]


def test_that_of_the_user_goes_before_one_of_the_book_and_two_of_his_are_refused(capsys):
    put("studies/figures.py", HEAD + figure("fig03"))
    assert main(["plot", "--run", "fig03"]) == 0 and shown("fig03")[0] == "P,a"
    put("studies/chapter/figures.py", HEAD + figure("fig03", factor="2"))
    capsys.readouterr()
    assert main(["plot", "fig03"]) == 2
    said = "fig03: is in studies/figures.py and studies/chapter/figures.py: say which, such as studies/fig03\n"
    assert capsys.readouterr().err == said
    assert main(["plot", "studies/chapter/fig03"]) == 0
    assert float(shown("fig03")[1].split(",")[1]) == 2 * study.load("studies/good.toml").open()["a"].values[0]


def test_files_beside_it_are_imported_and_count(monkeypatch):
    """A figure may stand in one of them, and each has names and data of its own, whatever another chapter has."""
    put("studies/one/good.toml", GOOD)
    for chapter, factor in (("one", 3), ("two", 7)):
        put(f"studies/{chapter}/figures.py", f"from . import helpers, more\nfrom ..{chapter}.helpers import FACTOR\n")
        put(f"studies/{chapter}/helpers.py", "from pathlib import Path\n\n"
            "FACTOR = int(Path(__file__).with_name('factor.csv').read_text())\n")  # fmt: skip
        put(f"studies/{chapter}/factor.csv", f"{factor}\n")
        put(f"studies/{chapter}/more.py", HEAD.replace("\n\nPath", "\nfrom .helpers import FACTOR\n\nPath")
            + figure(f"of_{chapter}", "FACTOR"))  # fmt: skip
    assert main(["plot", "--run", "of_one", "of_two"]) == 0
    one, two = (float(shown(f"of_{chapter}")[1].split(",")[1]) for chapter in ("one", "two"))
    assert one / two == pytest.approx(3 / 7, rel=1e-12)  # the same number times whole numbers


def names_of(text: str) -> set[tuple[str, str]]:
    return {*figure_files.names_in(put("studies/figures.py", text))}


@pytest.mark.parametrize(
    "text",
    [
        'from study.figures.registry import figure\n@figure("mine")\ndef draw(axes): ...',
        'from study.figures.registry import figure as f\n@f("mine", size=(1, 1))\ndef draw(axes): ...',
        'from study.figures import registry\n@registry.figure("mine")\ndef draw(axes): ...',
        'import study.figures.registry as r\nr.figure("mine")(print)',
        'if True:\n    from study.figures.registry import figure\n    figure("mine")(print)',
    ],
)
def test_names_are_read_however_the_decorator_is_called(text):
    assert names_of(text) == {("figure", "mine")}


@pytest.mark.parametrize(
    "text",
    [
        "",
        '# figure("mine")',
        '"""figure("mine")"""',
        'from matplotlib.figure import Figure as figure\nfigure("mine")',
        'from study.figures.registry import figure\nname = "mine"\nfigure(name)(print)',
        "from study.figures.registry import figure\nfigure(1)(print)\nfigure()(print)",
    ],
)
def test_what_is_no_name_is_none(text):
    assert names_of(text) == set()


WRONG = {
    "no Python": ("def (", "studies/figures.py: is not valid Python: line 1: ", 2),
    "raises": (HEAD + "raise ValueError('of mine')\n" + figure("radius"),
               "studies/figures.py: cannot be run: ValueError: of mine; -v before the command shows where", 1),
    "lacks a module": (HEAD + "import no_such_module\n" + figure("radius"),
                       "studies/figures.py: cannot be run: ModuleNotFoundError: No module named 'no_such_module'", 1),
    "ends": (HEAD + "import sys\nsys.exit(3)\n" + figure("radius"),
             "radius: something that it needs calls sys.exit(3)", 1),
    "is not reached": (HEAD + "if False:\n" + figure("radius").strip().replace("\n", "\n    ").replace("@", "    @", 1),
                       "studies/figures.py: does not register the figure radius, although it names it", 1),
}  # fmt: skip


@pytest.mark.parametrize(("text", "said", "code"), WRONG.values(), ids=WRONG)
def test_a_file_that_cannot_be_used_is_told_and_the_others_are_drawn(text, said, code, capsys):
    put("studies/figures.py", text)
    assert main(["plot", "radius", "fig01"]) == code
    printed = capsys.readouterr()
    assert printed.out.startswith("figures/fig01.svg\n") and any(
        line.startswith(said) for line in printed.err.splitlines()
    )
    assert "fig01" in proposed("plot", "fig0") and main(["list"]) == 0 and main(["run", "good"]) == 0


def test_all_tells_of_a_file_that_is_no_python(monkeypatch, capsys):
    put("studies/figures.py", "def (")
    monkeypatch.setattr("study.figures.figure_files.book_files", list)
    assert main(["plot", "all"]) == 2
    assert "studies/figures.py: is not valid Python: line 1: " in capsys.readouterr().err


def test_it_is_drawn_again_when_its_code_or_data_change():
    """Each time in a process of its own, as by a shell."""

    def drawn_again() -> bool:
        before = Path("figures/radius.csv").stat().st_ino if Path("figures/radius.csv").exists() else 0
        script = "from study.__main__ import main; main(['plot', '--run', 'radius'])"
        run_forked([f"import os; os.chdir({os.getcwd()!r}); {script}"], input=b"", timeout=PATIENCE)
        return Path("figures/radius.csv").stat().st_ino != before

    put("studies/figures.py", "from . import helpers\n" + HEAD + figure("radius", "helpers.FACTOR"))
    put("studies/helpers.py", "FACTOR = 2\n")
    put("studies/data.csv", "1\n")
    assert drawn_again() and not drawn_again()
    put("studies/helpers.py", "FACTOR = 4\n")
    assert drawn_again() and not drawn_again()
    put("studies/data.csv", "2\n")
    assert drawn_again() and not drawn_again()
    put("notes.txt", "of no figure")
    assert not drawn_again()


def test_the_book_is_one_of_them():
    """It has the form of a user's studies, and its code is not loaded by asking for names."""
    files = [file.parent.name for file in figure_files.book_files()]
    assert files == ["evidence", "literature", "paper", "systems"]
    loaded = {name for name in sys.modules if name.startswith("study.studies.")}
    assert {"fig03", "coatings", "validity", "literature"} <= set(registry.names("figure"))
    assert {name for name in sys.modules if name.startswith("study.studies.")} == loaded
