"""Input that is too large, too deep or not what it seems: one clear message and exit code 2 before any computing, or
it works."""

import os
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from test_cli import GOOD, studies  # noqa: F401

import study
from study.__main__ import main
from study.inputs import definition, reading
from study.inputs.reading import read

pytestmark = [
    pytest.mark.usefixtures("studies"),
    pytest.mark.skipif(sys.platform != "linux", reason="links, pipes, bytes as paths"),
]


def refused(text: str, folder: Path) -> list[str]:
    """The messages about a study file, without its name."""
    path = folder / "s.toml"
    path.write_text(text, encoding="utf-8")
    with warnings.catch_warnings(), pytest.raises(study.StudyError) as caught:
        warnings.simplefilter("error")
        read(path)
    assert all(message.startswith(f"{path}: ") and len(message) < 1000 for message in caught.value.messages)
    return [message.removeprefix(f"{path}: ") for message in caught.value.messages]


DEEP = ".".join(["a"] * 51)
NUMBER = "a number of more than 4300 digits"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"P = {'9' * 4301}", "is not valid TOML: a whole number has more than 4300 digits"),
        (f"[model]\nP = 0x{'f' * 4300}", f"P = {NUMBER}: must be a finite number, "),
        (f"[model]\nP = [0x{'f' * 4300}]", "[model] P has several values: these belong in [axes]"),
        (f"[[cases]]\nP = 0x{'f' * 4300}", f"P = {NUMBER}: must be a finite number, "),
        (f"[axes]\nP = {{start = 0x{'f' * 4300}, stop = 1, num = 2}}", f"P: start = {NUMBER}: must be a finite number"),
        (f"\n{DEEP} = 1", "is not valid TOML: a key has more than 50 parts (at line 2)"),
        (f"\n\n[{DEEP}]", "is not valid TOML: a key has more than 50 parts (at line 3)"),
        (" . ".join(['"a"', "'b'", "c"] * 17) + " = 1", "is not valid TOML: a key has more than 50 parts (at line 1)"),
        ("P = " + "[" * 5000, "is not valid TOML: brackets are nested too deep"),
        (
            "[axes]\nP = {start = -1e308, stop = 1e308, num = 3}",
            "P: from start = -1e+308 to stop = 1e+308: must be less than 1.8e308 apart",
        ),
        ('"\\u001b[31m" = 1', '"\\x1b[31m" is not a section'),
        (f"{'k' * 100_000} = 1", f'"{"k" * 56}... is not a section'),
        (f"a = 1\n{'a.' * 30}b = 2", "is not valid TOML: "),
    ],
)
def test_what_is_too_large_is_refused(text, message, tmp_path):
    assert any(found.startswith(message) for found in refused(text, tmp_path))


def test_what_is_just_small_enough_is_read(studies):  # noqa: F811
    """Dots in lists, in text and in a key of 50 parts are not taken for a longer key."""
    numbers = ", ".join(f"{i / 100:.2f}" for i in range(1, 101))
    text = GOOD.replace("[1e-6, 2e-6, 3e-6]", f"[{numbers}]").replace("a line", "a.b" + " . c" * 48)
    (studies / "good.toml").write_text(text, encoding="utf-8")
    assert read(studies / "good.toml").grid.size == 100
    assert len(refused(f"{'.'.join(['a'] * 50)} = 1", studies)) == 2, "no section, no load"


def test_a_file_that_is_too_large_is_not_read(studies, monkeypatch, capsys):  # noqa: F811
    size = (studies / "good.toml").stat().st_size
    monkeypatch.setattr(reading, "LARGEST_FILE", size)
    assert main(["check", "good"]) == 0
    monkeypatch.setattr(reading, "LARGEST_FILE", size - 1)
    assert main(["run", "good"]) == 2
    assert "good.toml: cannot be read: is larger than 0 MB; ranges" in capsys.readouterr().err
    (studies / "endless.toml").symlink_to("/dev/zero")
    os.mkfifo(studies / "pipe.toml")
    assert main(["check", "endless", "pipe"]) == 2
    said = capsys.readouterr().err.splitlines()
    assert said == [f"studies/{name}.toml: cannot be read: is not a regular file" for name in ("endless", "pipe")]


@pytest.mark.parametrize("cases", ["[[cases]]\nP = 1e-5\n" * 600_000, f"cases = [{'{P = 1e-5}, ' * 600_000}]"])
def test_very_many_tables_are_refused_before_they_are_read(cases, tmp_path, monkeypatch):
    """Reading 600,000 equal ones took half a minute."""
    monkeypatch.setattr("tomllib.loads", lambda _: pytest.fail("they are read"))
    (found,) = refused(f'model = {{ micro = "smooth" }}\n{cases}', tmp_path)
    assert "[[cases]] and those in braces: at most 100000; [axes] and [sample] describe" in found
    monkeypatch.undo()
    monkeypatch.setattr(reading, "MOST_TABLES", 3)
    text = '[model]\nbase = "half_space"\nmicro = "smooth"\n'
    three = [f"[[cases]]\nP = {i}e-6\n" for i in range(1, 4)]
    (tmp_path / "good.toml").write_text(text + "".join(three), encoding="utf-8")
    assert read(tmp_path / "good.toml").grid.size == 3
    assert "has 4 tables" in refused(text + "".join([*three, "[[cases]]\nP = 9e-6\n"]), tmp_path)[0]


def test_messages_are_no_more_than_one_reads(tmp_path):
    keys = [f"key{i} = 1" for i in range(100)]
    for text in ("\n".join(keys), "[model]\n" + "\n".join(keys), "[numerics]\n" + "\n".join(keys)):
        found = refused(text, tmp_path)
        assert len(found) <= definition.MOST_MESSAGES + 1
    assert len(refused("[model]\n" + "\n".join(keys), tmp_path)) == 31
    assert refused("[model]\n" + "\n".join(keys), tmp_path)[-1] == "and 71 more mistakes"


@pytest.mark.parametrize("count", [31, 32, 65])
def test_dimensions_of_arrays_together(count):
    """31 and x are as many as a netCDF variable may have."""
    names = [f"d{i}" for i in range(count)]
    half = names[: count // 2]
    parts = [xr.DataArray(np.full([1] * len(part), value), dims=part)
             for part, value in ((half, 1e-6), (names[count // 2 :], 0.3))]  # fmt: skip
    given = {"P": parts[0], "nu1": parts[1], "micro": "smooth", "base": "half_space", "x": 2}
    if count <= 31:
        assert study.solve(**given).P.ndim == count // 2
    else:
        with pytest.raises(study.StudyError, match=f"solve: {count} dimensions: at most 31 are allowed"):
            study.solve(**given)


def test_a_title_moves_no_cursor(studies, capsys):  # noqa: F811
    text = GOOD.replace("a line", "\\u001b]0;mine\\u0007 \\n good 3 cases done \\u202e μ" + "x" * 1000)
    (studies / "good.toml").write_text(text, encoding="utf-8")
    assert main(["list"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert "\\x1b]0;mine\\x07 \\n good 3 cases done \\u202e μxxx" in line and len(line) < 300
    assert not any(sign in line for sign in "\x1b\x07\u202e")


def test_home(studies, monkeypatch, tmp_path, capsys):  # noqa: F811
    """As in --results=~/there, which the shell leaves alone."""
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert main(["run", "~/../studies/good.toml", "--results=~/there"]) == 2, "there is no home"
    (tmp_path / "home").mkdir()
    assert main(["run", "~/../studies/good.toml", "--results=~/there"]) == 0
    assert (tmp_path / "home" / "there" / "good.nc").exists() and not Path("~").exists()
    assert study.load("~/../studies/good.toml", "~/there").status()["state"] == "done"
    with pytest.raises(SystemExit) as caught:
        main(["run", "good", "--results=~nobody-here/there"])
    assert caught.value.code == 2
    said = capsys.readouterr().err
    assert '"~nobody-here/there": must be a folder; write ./~nobody-here/there if it has this name' in said


@pytest.mark.parametrize("number", ["9" * 5000, "1234567890", "0", "-1", "1.5"])
def test_numbers_of_workers(number, capsys):
    for options in (["--workers", number], ["--part", f"1/{number}"]):
        with pytest.raises(SystemExit) as caught:
            main(["run", "good", *options])
        assert caught.value.code == 2
        assert len(capsys.readouterr().err) < 2000


def test_bytes_that_are_no_text(studies, capsys):  # noqa: F811
    """In the path of a study they do no harm; netCDF can open no such path."""
    odd = Path(os.fsdecode(b"odd\xff"))
    odd.mkdir()
    (odd / "good.toml").write_text(GOOD, encoding="utf-8")
    assert main(["run", str(odd / "good.toml")]) == 0
    assert main(["run", "good", "--results", str(odd)]) == 2
    said = capsys.readouterr().err
    assert "odd\\udcff/good.nc: the path of results must be UTF-8: netCDF can open no other" in said
    assert sorted(path.name for path in odd.iterdir()) == ["good.toml"]
    assert main(["status", "good", "--results", str(odd)]) == 0


def test_the_command_in_the_results_is_text(monkeypatch, capsys):
    odd = Path(os.fsdecode(b"odd\xff"))
    odd.mkdir()
    (odd / "good.toml").write_text(GOOD, encoding="utf-8")
    arguments = ["run", str(odd / "good.toml")]
    monkeypatch.setattr(sys, "argv", ["study", *arguments])
    assert main(arguments) == 0
    assert study.open_results("results/good.nc").attrs["command"] == "study run 'odd\\udcff/good.toml'"


def test_what_a_link_leads_to_is_replaced(studies, capsys):  # noqa: F811
    """The link stays, also where the results are on another disk."""
    Path("disk").mkdir()
    Path("results").mkdir()
    Path("results/good.nc").symlink_to(Path("disk/kept.nc").absolute())
    for P, options in (("2e-6", []), ("2.5e-6", ["--force"])):
        (studies / "good.toml").write_text(GOOD.replace("2e-6", P), encoding="utf-8")
        assert main(["run", "good", *options]) == 0
        assert Path("results/good.nc").is_symlink() and not Path("disk/kept.nc").is_symlink()
        assert study.open_results("disk/kept.nc").P.values[1] == float(P)
    assert [path.name for path in Path("disk").iterdir()] == ["kept.nc"]
    assert {path.name for path in Path("results").iterdir()} == {"good.nc", ".good.blocks"}
    Path("results/good.nc").unlink()
    Path("results/good.nc").symlink_to("nowhere/good.nc")
    assert main(["run", "good"]) == 1
    assert "nowhere: cannot be written: No such file or directory" in capsys.readouterr().err
