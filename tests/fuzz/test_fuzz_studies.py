"""A fixed sample of `make fuzz` over study files, and that it would find what it looks for."""

import warnings
from collections import Counter

import fuzz_studies
import pytest
from fuzz_studies import fault, faults

from study.inputs import definition, reading


def test_mutated_study_files(tmp_path, monkeypatch):
    for name, value in (("FEW", 12), ("ESTIMATED", 4), ("RUN", 4)):
        monkeypatch.setattr(fuzz_studies, name, value)
    done = Counter()
    assert faults(80, 7, tmp_path, done) == []
    assert sum(done[f"check {code}"] for code in (0, 2)) == 80
    assert done["check 0"] > 10 and done["run --dry-run 0"] and done["run 0"], f"enough of them are studies: {done}"


def _endless(*_, **__):
    while True:
        pass


def _noisy(*_, **__):
    raise definition.StudyError(["x" * 1000] * 100)


def _warning(*_, **__):
    warnings.warn("overflow", RuntimeWarning, stacklevel=1)


@pytest.mark.parametrize(
    ("broken", "seen"),
    [(_endless, "Hang"), (_noisy, "exit code 2, 100"), (_warning, "RuntimeWarning: overflow"), (len, "TypeError: ")],
)
def test_faults_are_found(tmp_path, monkeypatch, broken, seen):
    monkeypatch.setattr(fuzz_studies, "PATIENCE", 0.2)
    monkeypatch.setattr(reading, "definition_of", broken)
    file = tmp_path / "s.toml"
    file.write_text('[model]\nP = 1e-5\nmicro = "smooth"\nbase = "half_space"\n', encoding="utf-8")
    assert fault(["check", str(file)])[1].startswith(seen)


def test_a_failure_that_is_not_said_is_a_fault(tmp_path, monkeypatch):
    monkeypatch.setattr(fuzz_studies, "exit_and_messages", lambda _: (2, ""))
    assert fault(["check", "s.toml"]) == (2, "exit code 2, 0 characters: ")
    monkeypatch.setattr(fuzz_studies, "exit_and_messages", lambda _: (1, "a block failed"))
    assert fault(["run", "s.toml"])[1].startswith("exit code 1, ")
