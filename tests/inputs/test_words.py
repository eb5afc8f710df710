"""Words that are made of numbers: what is allowed, how many, and which command makes what is missing."""

import pytest

import study
from solver.parameters import Parameter
from study.__main__ import main
from study.figures import registry
from study.inputs.vocabulary import allowed, check
from study.terminal import counted, on_one_line, shown


@pytest.mark.parametrize("least", [-1.0, 0.0, 2.5])
@pytest.mark.parametrize(("bracket", "word"), [("(", ">"), ("[", ">=")])
def test_the_end_is_allowed_where_the_words_say_so(bracket, word, least):
    own = Parameter(interval=f"{bracket}{least:g}, inf)")
    assert allowed(own) == f"must be {word} {least:g}"
    assert (check(own, least) == "") == (word == ">=") and check(own, least + 1) == ""


def test_one_and_several():
    assert [counted(number, "case") for number in (0, 1, 2, 1000)] == ["0 cases", "1 case", "2 cases", "1000 cases"]


@pytest.mark.parametrize("most", [10, 20, 60])
def test_a_long_text_is_cut_to_the_letters_that_there_are(most):
    """Whole up to that length; longer ones end in dots, and are no longer than that."""
    for length in (0, 1, most - 1, most):
        assert on_one_line("x" * length, most) == "x" * length
    for length in (most + 1, most + 3, 1000):
        assert on_one_line("x" * length, most) == "x" * (most - 3) + "..."
    assert shown("x" * 100) == f'"{"x" * 56}...' and len(shown(list(range(100)))) == 60


@pytest.mark.parametrize("kind", ["figure", "table"])
def test_the_command_that_is_told_is_one_that_there_is(kind, tmp_path, monkeypatch, capsys):
    """`run` takes studies; what is no study file has a command of its own."""
    monkeypatch.chdir(tmp_path)
    needed = {name: registry.entry(kind, name).studies for name in registry.names(kind)}
    told = set()
    for name, studies in needed.items():
        if not studies:
            continue
        with pytest.raises(study.StudyError) as caught:
            registry.open_studies(name, studies, tmp_path)
        told |= {message.partition("make it with: ")[2] for message in caught.value.messages}
    assert told
    for command in sorted(one.removeprefix("python -m roughcoat ").removeprefix("roughcoat ") for one in told):
        first, *names = command.split()
        with pytest.raises(SystemExit) as ended:
            main([first, "--help"])
        assert ended.value.code == 0, command
        capsys.readouterr()
        assert not names or first == "run" and main(["check", *names]) == 0, command
