"""Model answers: those in a rubric, and those in a separate file, so that students can have the rubric."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from grader.checks.manual import answered
from grader.errors import RubricError
from grader.files.reading import read_capped
from grader.grading.rubric import Rubric, find_rubric, read_rubric
from grader.grading.toml_file import TomlPath, complain_of, read_toml
from grader.names import did_you_mean
from grader.text import printable_path


def load_with_answers(name: str) -> Rubric:
    """Load a rubric by its id or path with its model answers; raise RubricError or InputError.

    A rubric without its file of answers loads, too: see `missing_answers`.
    """
    path = find_rubric(name)
    rubric = read_rubric(read_capped(path, advice=""), path, answers=True)
    if not rubric.answers or missing_answers(rubric):
        return rubric
    file = _file(rubric)
    if not file.resolve().is_relative_to(path.parent.resolve()):
        raise RubricError((f"{printable_path(file)}: the answers file must be in the rubric's folder",))
    text, table = read_toml(read_capped(file, advice=""), file)
    complain_of(_complaints(rubric, table), text, file)
    return with_answers(rubric, table)


def missing_answers(rubric: Rubric) -> str:
    """Return a warning if the rubric's file of model answers does not exist; empty otherwise."""
    if not rubric.answers or _file(rubric).exists():
        return ""
    return (
        f"{rubric.id}: the answers file {printable_path(_file(rubric))} does not exist, so no model answers are shown"
    )


def with_answers(rubric: Rubric, answers: Mapping[str, str]) -> Rubric:
    """Return the rubric with these model answers, by the ids of their criteria, in addition to its own."""
    criteria = (replace(row, answer=answers.get(row.id, row.answer)) for row in rubric.criteria)
    return replace(rubric, criteria=tuple(criteria))


def _file(rubric: Rubric) -> Path:
    return rubric.path.parent / rubric.answers


def _complaints(rubric: Rubric, table: Mapping[str, Any]) -> list[tuple[TomlPath, str]]:
    questions = {row.id: row for row in rubric.criteria if row.check.function is answered}
    complaints: list[tuple[TomlPath, str]] = []
    for name, value in table.items():
        if name not in questions:
            guess = did_you_mean(name, questions) or f"; there are: {', '.join(questions) or 'none'}"
            complaints.append(((name,), f"the rubric {rubric.id} has no question {name!r}{guess}"))
        elif not isinstance(value, str):
            complaints.append(((name,), f"the answer to {name} must be a string"))
        elif questions[name].answer:
            complaints.append(((name,), f"the answer to {name} is already in the rubric: remove one of the two"))
    return complaints
