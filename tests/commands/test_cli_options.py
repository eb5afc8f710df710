"""What is said on the command line reaches what it is meant for: options, folders, exit codes, messages."""

import logging
import sys
from pathlib import Path

import pytest
import xarray as xr
from test_cli import GOOD, studies  # noqa: F401

from study import api, catalogue
from study.__main__ import main
from study.commands.computing import failure_lines
from study.figures import figure_results
from study.inputs.definition import StudyError
from study.work import plan
from study.work.plan import Report

pytestmark = pytest.mark.usefixtures("studies")


def tree() -> list[str]:
    """The files below the working folder, but for the studies."""
    return sorted(path.as_posix() for path in Path().rglob("*") if path.is_file() and path.parts[0] != "studies")


@pytest.fixture
def asked(monkeypatch) -> list:
    """What `Study.run` is asked for: (name of the study, folder of the results, options); nothing is computed."""
    found = []

    def run(self, **options):
        found.append((self.definition.name, self.results, options))
        return Report(Path("done.nc"), 3, 3, {}, {0: 3}, True)

    monkeypatch.setattr(api.Study, "run", run)
    return found


DEFAULTS = {"workers": None, "scheduler": None, "fail_fast": False, "yes": False}
FULL = "--results there --workers 3 --scheduler tcp://host:1 --fail-fast --yes"
CHOSEN = {"workers": 3, "scheduler": "tcp://host:1", "fail_fast": True, "yes": True}


@pytest.mark.parametrize(
    ("command", "folder", "expected"),
    [
        ("run good", "results", DEFAULTS | {"part": (1, 1), "force": False}),
        (f"run good {FULL} --part 2/3 --force", "there", CHOSEN | {"part": (2, 3), "force": True}),
        ("run good --part 3/3 --keep-going", "results", DEFAULTS | {"part": (3, 3), "force": False}),
        ("retry good --status diverged", "results", DEFAULTS | {"retry": (3,)}),
        (f"retry good {FULL} --status diverged --status iteration_limit", "there", CHOSEN | {"retry": (3, 1)}),
    ],
)
def test_options_of_the_commands_that_compute(asked, command, folder, expected):
    assert main(command.split()) == 0
    assert asked == [("good", Path(folder), expected | {"stream": sys.stderr})]


def test_yes_computes_what_is_large(monkeypatch, capsys):
    monkeypatch.setattr(plan, "LARGE", 10)
    for command in (["run", "good"], ["retry", "good", "--status", "diverged"]):
        assert main(command) == 2
        assert "; --yes computes them\n" in capsys.readouterr().err
    assert main(["run", "good", "--yes", "--workers", "1"]) == 0
    assert capsys.readouterr().out == "results/good.nc: 3 cases, 3 computed now\n"


def test_dry_run_is_told_the_workers_and_computes_nothing(asked, monkeypatch, capsys):
    seen, real = [], api.Study.dry_run
    monkeypatch.setattr(api.Study, "dry_run", lambda self, *given: seen.append(given) or real(self, *given))
    assert main(["run", "good", "--dry-run", "--workers", "7"]) == 0
    assert seen == [(7, False, False)] and asked == [] and tree() == []
    assert capsys.readouterr().out.startswith("good: 3 cases, 0 of them computed; ")


@pytest.mark.parametrize("whose", ["another program", "another definition"])
def test_dry_run_says_that_run_would_be_refused(studies, whose, capsys):  # noqa: F811
    """With the message and the exit code of `run`, behind the cost."""
    Path("results").mkdir()
    if whose == "another program":
        xr.Dataset({"a": 1.0}).to_netcdf("results/good.nc")
    else:
        main(["run", "good"])
        (studies / "good.toml").write_text(GOOD.replace("2e-6", "2.5e-6"), encoding="utf-8")
    capsys.readouterr()
    code, refusal = main(["run", "good"]), capsys.readouterr().err
    assert whose in refusal and code
    assert main(["run", "good", "--dry-run"]) == code
    cost, said = capsys.readouterr()
    assert cost.startswith("good: 3 cases, ") and said == f"good: `run` would be refused: {refusal}"
    forced = whose == "another definition"
    assert (main(["run", "good", "--dry-run", "--force"]) == 0) == forced
    assert (capsys.readouterr().err == "") == forced


@pytest.mark.parametrize(("options", "level"), [([], logging.WARNING), (["-v"], logging.DEBUG)])
def test_verbose_shows_the_log(options, level, monkeypatch):
    seen = []
    monkeypatch.setattr(logging, "basicConfig", lambda **given: seen.append(given["level"]))
    assert main([*options, "check", "good"]) == 0
    assert seen == [level]


@pytest.mark.parametrize("text", ["0/2", "3/2", "2", "1/2/3", "a/b", "-1/2", "1/", "1.0/2"])
def test_parts_that_are_none(text, capsys):
    with pytest.raises(SystemExit) as caught:
        main(["run", "good", f"--part={text}"])
    assert caught.value.code == 2
    assert f"--part: {text}: must be I/N, whole numbers with 1 <= I <= N\n" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["", "nonsense", "tcp:", "tcp://host", "http://host:8", "tcp://host:0", "host:65536"])
@pytest.mark.parametrize("command", ["run", "retry"])
def test_addresses_that_are_none(command, text, capsys):
    with pytest.raises(SystemExit) as caught:
        main([command, "good", "--scheduler", text])
    assert caught.value.code == 2
    assert f'--scheduler: "{text}": must be the address of a dask scheduler, such as tcp://' in capsys.readouterr().err
    assert tree() == []


@pytest.mark.parametrize("text", ["tcp://10.0.0.1:8786", "node-7.site_a:1", "tls://[::1]:65535", "wss://host:443"])
def test_addresses(asked, text):
    assert main(["run", "good", "--scheduler", text]) == 0
    assert asked[0][2]["scheduler"] == text


@pytest.mark.parametrize(
    ("options", "expected"), [("", ("results", False)), ("--results there --force", ("there", True))]
)
def test_work_and_precision_is_measured(options, expected, monkeypatch, capsys):
    seen = []
    monkeypatch.setattr(
        figure_results, "results", lambda name, folder, force, command: seen.append((folder, force, command))
    )
    monkeypatch.setattr(sys, "argv", ["/somewhere/study/__main__.py", "tradeoff"])
    assert main(["tradeoff", *options.split()]) == 0
    assert capsys.readouterr().out == f"{expected[0]}/tradeoff.nc\n"
    assert seen == [(*expected, "python -m study tradeoff")]


def test_list_is_of_a_folder_in_order(capsys):
    for name in ("b", "c", "a"):
        path = Path("mine") / f"{name}.toml"
        path.parent.mkdir(exist_ok=True)
        path.write_text(GOOD, encoding="utf-8")
    main(["run", "mine/b.toml", "--results", "there", "--workers", "1"])
    capsys.readouterr()
    assert main(["list", "mine", "--results", "there"]) == 0
    lines = [line.split()[:4] for line in capsys.readouterr().out.splitlines()]
    assert lines == [["a", "3", "cases", "new"], ["b", "3", "cases", "done"], ["c", "3", "cases", "new"]]


def test_check_says_what_is_in_a_file(studies, capsys):  # noqa: F811
    one = GOOD.replace("[axes]\nP = [1e-6, 2e-6, 3e-6]", "P = 1e-6")
    two = GOOD.replace("[axes]", '[axes]\nh = [1, 2]\nbonding = ["bonded", "frictionless"]')
    for name, text in (("one", one), ("two", two.replace('"half_space"', '"layered"\nn = 0.5'))):
        (studies / f"{name}.toml").write_text(text, encoding="utf-8")
    assert main(["check", "one", "two"]) == 0
    first, second = capsys.readouterr().out.splitlines()
    assert first.startswith("one: 1 case (one case), digest ")
    assert second.startswith("two: 12 cases (h 2 x bonding 2 x P 3), digest ")
    assert len(first.rpartition(" ")[2]) == 16 and first[-16:] != second[-16:]


def test_the_exit_code_is_the_worst(monkeypatch, capsys):
    """0 all right, 1 could not be done, 2 bad input, whatever their order."""

    def draw(name, *_):
        if name == "disk":
            raise OSError(28, "No space left on device")
        if name == "bad":
            raise StudyError(["bad"])
        if name == "locked":
            raise StudyError(["locked"], code=1)
        return [name]

    monkeypatch.setattr(catalogue, "draw", draw)
    for names, code in (("good", 0), ("good disk good", 1), ("locked good", 1), ("bad disk good", 2), ("disk bad", 2)):
        assert main(["plot", *names.split()]) == code
    capsys.readouterr()
    assert main(["plot", "bad", "disk", "good"]) == 2
    printed = capsys.readouterr()
    assert printed.err == "bad\ndisk: [Errno 28] No space left on device\n"
    assert printed.out == "good\n"


def test_what_a_lost_run_says(monkeypatch, capsys):
    def run(self, **_):
        raise ConnectionError("the scheduler is gone")

    monkeypatch.setattr(api.Study, "run", run)
    for command in (["run", "good"], ["retry", "good", "--status", "diverged"]):
        assert main(command) == 1
        said = "good: the scheduler is gone; finished blocks are kept, and the same command continues from there\n"
        assert capsys.readouterr() == ("", said)


def test_failed_blocks_are_told_in_their_order():
    report = Report(Path("x.nc"), 9, 5, {12: "late", 3: "early"}, {0: 5, 127: 4}, False)
    assert failure_lines(report, "s") == [
        "s: block 3 failed: early",
        "s: block 12 failed: late",
        "s: 2 blocks failed; the others are kept, and the same command tries again",
    ]


@pytest.mark.parametrize(
    "call", ["point P=1e-5 micro=smooth base=half_space", "run good", "table fig02", "status good"]
)
def test_a_core_that_there_is_not_is_said_before_anything(call, monkeypatch, capsys):
    monkeypatch.setenv("ROUGHCOAT_CORE", "fast")
    assert main(call.split()) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    assert said.err.startswith("ROUGHCOAT_CORE = fast: must be one of numpy")
    assert tree() == []


def test_what_computes_nothing_needs_no_core(monkeypatch):
    monkeypatch.setenv("ROUGHCOAT_CORE", "fast")
    assert main(["docs"]) == 0
    monkeypatch.setenv("ROUGHCOAT_CORE", "numpy")
    assert main(["point", "P=1e-5", "micro=smooth", "base=half_space"]) == 0
