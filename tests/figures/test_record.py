"""Figures and tables are whole or not there; what is up to date is said by what is in the files, not by the clock."""

import json
import os
import shutil
import signal
from itertools import product
from pathlib import Path

import pytest
import xarray as xr
from children import joined, started
from line_study import TEXT

import study
from study import catalogue
from study.__main__ import main
from study.figures import record, registry

FILES = {"figures": ("shown.csv", "shown.pdf", "shown.png"), "tables": ("listed.txt", "listed.csv", "listed.tex")}
COMMANDS = {"figures": ["plot", "--run", "shown"], "tables": ["table", "--run", "listed"]}
DRAWN = []


def shown(axes, line):
    """The radius against the load."""
    DRAWN.append("figures")
    axes.plot(line["P"], line["a"])
    axes.set_axis_off()  # text takes most of the time
    return {"P": line["P"].values, "a": line["a"].values}


def listed(line):
    """The radius at each load."""
    DRAWN.append("tables")
    return list(zip(line["P"].values.tolist(), line["a"].values.tolist(), strict=True))


def register() -> None:
    columns = tuple(map(registry.column, ("P | .6e", "a | .6e")))
    registry.FIGURES["shown"] = registry.Figure(("line",), shown, (3, 2), (1, 1), "")
    registry.TABLES["listed"] = registry.DataTable(("line",), listed, "", columns)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with the study of a figure and of a table, the current one."""
    monkeypatch.chdir(tmp_path)
    register()
    DRAWN.clear()
    Path("studies").mkdir()
    Path("studies/line.toml").write_text(TEXT, encoding="utf-8")
    yield
    del registry.FIGURES["shown"], registry.TABLES["listed"]


@pytest.fixture(params=FILES)
def kind(request) -> str:
    return request.param


def again(kind: str) -> bool:
    """Whether the command draws anew; its files are whole then, and not touched otherwise."""
    before, drawn = states(kind), len(DRAWN)
    assert main(COMMANDS[kind]) == 0
    assert len(DRAWN) > drawn or states(kind) == before
    assert set(os.listdir(kind)) == {*FILES[kind], record.RECORD}, "and nothing else is there"
    return len(DRAWN) > drawn


def states(kind: str) -> list:
    """Inode and time of change of each file."""
    paths = [Path(kind, name) for name in FILES[kind]]
    return [(path.stat().st_ino, path.stat().st_mtime_ns) for path in paths if path.exists()]


def contents(kind: str) -> dict[str, bytes]:
    return {name: Path(kind, name).read_bytes() for name in FILES[kind]}


def test_what_is_there_is_not_drawn_again_whatever_the_times(kind):
    assert again(kind) and not again(kind)
    whole = contents(kind)
    for clock in (1, 2_000_000_000):  # after a checkout of git, or a copy: results younger than figures, or older
        os.utime("results/line.nc", (clock, clock))
        assert not again(kind)
        for path in Path(kind).iterdir():
            os.utime(path, (clock + 7, clock + 7))
        assert not again(kind)
    shutil.copytree(kind, "copy")
    shutil.rmtree(kind)
    os.rename("copy", kind)
    assert not again(kind) and contents(kind) == whole


def test_results_computed_again_are_the_same_data(kind):
    """By another command, on another day."""
    assert again(kind)
    Path("results/line.nc").unlink()
    assert not again(kind)
    study.load("studies/line.toml").run(force=True)
    assert not again(kind)


def test_other_numbers_are_drawn_though_the_files_are_younger(kind):
    assert again(kind)
    before = contents(kind)
    for name in FILES[kind]:
        os.utime(Path(kind, name), (2_000_000_000, 2_000_000_000))
    Path("studies/line.toml").write_text(TEXT.replace("1e-4, num = 23", "1e-4, num = 45"), encoding="utf-8")
    assert again(kind) and not again(kind)
    assert all(contents(kind)[name] != before[name] for name in FILES[kind])


def test_small_results_are_read_once_until_the_file_is_another(monkeypatch):
    """Each figure has a copy. Large ones are read for each figure."""
    read = []

    def open_results(path):
        read.append(path)
        return xr.Dataset({"a": ("case", [float(word) for word in path.read_text().split()])})

    def opened():
        dataset = registry.opened(path)
        values = dataset["a"].values.tolist()
        dataset["a"] = 2 * dataset["a"]
        return values

    path = Path("line.nc")
    monkeypatch.setattr(registry, "open_results", open_results)
    path.write_text("1 2 3")
    assert opened() == opened() == [1, 2, 3] and len(read) == 1
    path.write_text("4 5")
    assert opened() == opened() == [4, 5] and len(read) == 2
    path.write_text("6")
    monkeypatch.setattr(registry, "SMALL", 0)
    assert opened() == opened() == [6] and len(read) == 4
    path.write_text("7 8 9 10")
    monkeypatch.setattr(registry, "SMALL", 1_000)
    assert opened() == opened() == [7, 8, 9, 10] and len(read) == 5


def cut_off(path: Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def emptied(path: Path) -> None:
    os.truncate(path, 0)


def edited(path: Path) -> None:
    """One byte, with the size and the times as they were."""
    times, content = (path.stat().st_atime_ns, path.stat().st_mtime_ns), bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    os.utime(path, ns=times)


def test_a_file_that_is_not_what_was_drawn_is_drawn_again(kind):
    assert again(kind)
    whole = contents(kind)
    for name, harm in product(FILES[kind], [Path.unlink, cut_off, emptied, edited]):
        harm(Path(kind, name))
        assert again(kind) and contents(kind) == whole, (name, harm)


def test_a_record_that_cannot_be_read_is_no_record(kind):
    assert again(kind)
    for text in ("", "nonsense", "[1]", '{"figure shown": 1, "table listed": []}', "[" * 100_000):
        Path(kind, record.RECORD).write_text(text, encoding="utf-8")
        assert again(kind) and not again(kind), text[:40]


def test_drawn_without_run_is_drawn_always(kind):
    command = [word for word in COMMANDS[kind] if word != "--run"]
    assert again(kind)
    for _ in range(2):
        before = len(DRAWN)
        assert main(command) == 0 and len(DRAWN) > before
    assert not again(kind), "the same bytes"


def test_the_code_and_the_data_of_the_program_count_and_compiled_code_does_not(kind, tmp_path, monkeypatch):
    package = tmp_path / "solver"
    monkeypatch.setattr(record, "PACKAGES", (package,))
    for name in ("law.py", "law.csv", "__pycache__/law.pyc"):
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text("1", encoding="utf-8")

    def changed(name: str) -> bool:
        """Whether another content of a file, with the times as they were, draws anew."""
        found = (package / name).stat()
        (package / name).write_text((package / name).read_text() + "2", encoding="utf-8")
        os.utime(package / name, ns=(found.st_atime_ns, found.st_mtime_ns))
        record.program.cache_clear()
        return again(kind)

    record.program.cache_clear()
    assert again(kind) and not changed("__pycache__/law.pyc") and changed("law.csv") and changed("law.py")
    monkeypatch.setattr(record, "package_version", lambda name: "next")
    record.program.cache_clear()
    assert again(kind)
    monkeypatch.undo()
    record.program.cache_clear()


def kill_at(kind: str, number: int, half: bool) -> None:
    """In a process of its own: kill it at the write of a file of the folder, before or in the middle of it."""
    real, count = Path.write_bytes, []

    def write_bytes(path, content):
        count.append(path)
        if len(count) == number:
            real(path, content[: len(content) // 2] if half else b"")
            os.kill(os.getpid(), signal.SIGKILL)
        real(path, content)

    register()
    Path.write_bytes = write_bytes
    main(COMMANDS[kind])


@pytest.mark.parametrize(
    ("kind", "number", "half"), [("figures", 1, True), ("figures", 2, False), ("figures", 4, True), ("tables", 3, True)]
)
def test_a_kill_leaves_whole_files_and_the_next_run_ends_well(kind, number, half):
    """At each of the three files and at the record; over other files, so that some are old and some are new."""
    assert again(kind)
    old = contents(kind)
    Path("studies/line.toml").write_text(TEXT.replace("1e-4, num = 23", "1e-4, num = 45"), encoding="utf-8")
    process = started(killed, Path.cwd(), kind, number, half)
    joined(process)
    assert process.exitcode == -signal.SIGKILL
    new = [name for name, content in contents(kind).items() if content != old[name]]
    assert new == list(FILES[kind])[: number - 1]
    for path in Path(kind).glob(".*.tmp"):  # what it has left goes when nobody can be writing it any more
        os.utime(path, (1, 1))
    assert again(kind) and not again(kind)
    assert all(contents(kind)[name] != old[name] for name in FILES[kind])


def killed(folder: Path, *arguments) -> None:
    os.chdir(folder)
    kill_at(*arguments)


def draw_until_killed(folder: Path) -> None:
    from matplotlib.backends.backend_pdf import PdfFile

    os.chdir(folder)
    register()
    PdfFile.finalize = lambda self: os.kill(os.getpid(), signal.SIGKILL)
    main(COMMANDS["figures"])


def test_a_kill_in_the_midst_of_a_page(folder):
    """Of the .pdf, whose beginning is written: it was there, empty or cut off, and younger than all."""
    process = started(draw_until_killed, Path.cwd())
    joined(process)
    assert process.exitcode == -signal.SIGKILL
    assert not Path("figures").exists() or not os.listdir("figures")
    assert again("figures")


def test_a_temporary_file_of_another_program_stays(kind):
    """It may draw the same at this moment."""
    Path(kind).mkdir()
    theirs = [Path(kind, f".{name}.01234567.tmp") for name in FILES[kind]]
    for path in theirs:
        path.touch()
    assert main(COMMANDS[kind]) == 0
    assert all(path.exists() for path in theirs)


def test_the_record_says_of_what_data_each_file_was_made(kind):
    assert again(kind)
    ((what, entry),) = json.loads(Path(kind, record.RECORD).read_text()).items()
    assert what == {"figures": "figure shown", "tables": "table listed"}[kind]
    assert list(entry["files"]) == sorted(FILES[kind]) and len(entry["of"]) == 64


def test_curves_of_a_study_are_whole_or_not_there(monkeypatch, capsys):
    from matplotlib.backends.backend_pdf import PdfFile

    def full(self):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(PdfFile, "finalize", full)
    assert main(["plot", "line", "--run", "--x", "P", "--y", "a"]) == 1
    assert "No space left on device" in capsys.readouterr().err and not Path("figures").exists()


def test_the_program_is_both_of_its_packages():
    root = Path(study.__file__).parent
    assert {*record.PACKAGES} == {root, root.parent / "solver"}


def test_a_bare_figure_has_no_parameters_above_it(monkeypatch):
    def titled(axes, line):
        axes.figure.suptitle("parameters")
        return shown(axes, line)

    above = []
    study.load("studies/line.toml").run(progress=False)
    registry.FIGURES["shown"] = registry.Figure(("line",), titled, (3, 2), (1, 1), "")
    monkeypatch.setattr(catalogue, "save", lambda path, figure, *rest: above.append(figure.get_suptitle()) or [])
    assert main(["plot", "shown"]) == main(["plot", "shown", "--bare"]) == 0
    assert above == ["parameters", ""]
