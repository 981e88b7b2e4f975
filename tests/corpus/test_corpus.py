"""Every case of the corpus prints and writes what is expected of it."""

import re
import shlex
from pathlib import Path

import pytest

from tests.corpus.cases import Case, changed_lines, read_corpus
from tests.examples import light
from tests.samples import SAMPLES

STEP = 4  # a class takes ten times as long as a submission: of their rows the others are for CI


def is_costly(case: Case) -> bool:
    """Return whether only CI runs a case."""
    return case.path.parent.name == "class" and case.index % STEP > 0


def command_of(case: Case) -> tuple[str, ...]:
    """Return the command that a case runs first: `rubric new`, without options and arguments."""
    words = shlex.split(case.commands[0])
    command = [word for word in words if re.fullmatch("[a-z]+", word)]
    return tuple(command[: 2 if "rubric" in command[:1] else 1])


@pytest.mark.every(kind=lambda case: (case.path.parent.name, *command_of(case)))
@pytest.mark.parametrize("case", light(read_corpus(), is_costly), ids=lambda case: case.name)
def test_the_case_is_as_expected(case: Case, tmp_path: Path) -> None:
    """Standard output, standard error, exit codes and written files; `python -m tests.corpus` writes them again."""
    outcome = case.outcome(tmp_path)
    if outcome != case.expected:
        command = f"python -m tests.corpus {shlex.quote(case.name)}"
        lines = [
            *changed_lines(case.expected, outcome),
            f"To expect what is printed now: {command}",
        ]
        pytest.fail("\n".join(lines), pytrace=False)


def test_every_sample_has_a_row() -> None:
    """With its results, in the table of its rubric."""
    found = {
        case.about
        for case in read_corpus()
        if case.path.parent.name == "samples" and case.path.stem != "hints"
    }
    assert found == set(SAMPLES)
