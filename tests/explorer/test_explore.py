"""The command `explore`, and the page as a file."""

import re

import pytest

from study.__main__ import main
from study.explorer.page import MARK, page


def test_the_command_writes_the_page_and_replaces_an_older_one(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["explore"]) == 0 and main(["explore"]) == 0
    assert (tmp_path / "contact.html").read_text(encoding="utf-8") == page()
    assert "contact.html" in capsys.readouterr().out


def test_a_folder_that_is_not_there_is_made(tmp_path, capsys):
    assert main(["explore", "--out", str(tmp_path / "new" / "mine.html")]) == 0
    assert (tmp_path / "new" / "mine.html").stat().st_size
    assert main(["explore", "--out", str(tmp_path / "new" / "mine.html" / "page.html")]) == 1
    said = capsys.readouterr().err
    assert said.startswith("explore: ") and ".tmp" not in said.replace(str(tmp_path), "")


def test_another_file_is_not_replaced(tmp_path, capsys):
    (tmp_path / "mine.html").write_text("a night of writing")
    assert main(["explore", "--out", str(tmp_path / "mine.html")]) == 2
    assert main(["explore", "--out", str(tmp_path)]) == 2
    assert (tmp_path / "mine.html").read_text() == "a night of writing"
    assert "is not overwritten" in capsys.readouterr().err


def test_the_page_is_small_and_whole():
    text = page()
    assert MARK.decode() in text[:100]
    assert len(text.encode()) < 500_000
    assert not re.search(r"\b(src|href)=\"(?!data:,)|@import|url\((?!#)|/\* (style|scripts) \*/", text)
    assert text.count("</script>") == 1, "no text in the data ends the script"


@pytest.mark.parametrize("limit", ["STEEP", "YIELD", "RING"])
def test_limits_are_those_of_the_program(limit):
    from study.in_words import pressures
    from study.rules import assumptions, doubts

    places = [module for module in (assumptions, doubts, pressures) if hasattr(module, limit)]
    number = re.search(rf'"{limit}":([\d.e+-]+)', page())[1]
    assert float(number) == getattr(places[0], limit)
