"""Model answers: those in a rubric, and those in a separate file.

With a separate file students can have the rubric.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from grader.base.errors import RubricError
from grader.base.names import did_you_mean
from grader.base.text import printable_path
from grader.base.toml_file import raise_complaints, read_toml
from grader.files.reading import read_capped
from grader.lab.checks.manual import answered
from grader.lab.rubric.rubric import Rubric, find_rubric, read_rubric
from grader.lab.rubric.validation import Complaint


def load_with_answers(name: str, file: Path | None = None) -> Rubric:
    """Load a rubric by its id or path with its model answers; raise RubricError or InputError.

    Those outside of the rubric are in a file, or in the one that the rubric names, which may not
    exist: see `missing_answers`.
    """
    path = find_rubric(name)
    rubric = read_rubric(read_capped(path, advice=""), path, answers=True)
    if file:
        return _read_answers(rubric, file)
    if not rubric.answers or missing_answers(rubric):
        return rubric
    own_answers = _answers_file(rubric)
    if not own_answers.resolve().is_relative_to(path.parent.resolve()):
        message = f"the answers file {printable_path(own_answers)} must be in the rubric's folder"
        raise RubricError((f"{rubric.find_place(('answers',))}: {message}",))
    return _read_answers(rubric, own_answers)


def _read_answers(rubric: Rubric, file: Path) -> Rubric:
    """Return a rubric with the model answers in a file as well, which can be the rubric itself.

    Raises RubricError or InputError.
    """
    data = read_capped(file, advice="")
    if data == rubric.data:
        return rubric
    text, table = read_toml(data, file)
    raise_complaints(_find_complaints(rubric, table), text, file)
    return _with_answers(rubric, table)


def missing_answers(rubric: Rubric) -> str:
    """Return a warning if the rubric's file of model answers does not exist; empty otherwise."""
    file = _answers_file(rubric)
    if not rubric.answers or file.exists():
        return ""
    place = rubric.find_place(("answers",))
    return (
        f"{place}: the answers file {printable_path(file)} does not exist, so no model answers "
        "are shown"
    )


def _with_answers(rubric: Rubric, answers: Mapping[str, str]) -> Rubric:
    """Return the rubric with these model answers in addition to its own.

    They are given by the ids of their criteria.
    """
    criteria = (row._replace(answer=answers.get(row.id, row.answer)) for row in rubric.criteria)
    return replace(rubric, criteria=tuple(criteria))


def _answers_file(rubric: Rubric) -> Path:
    return rubric.path.parent / rubric.answers


def _find_complaints(rubric: Rubric, table: Mapping[str, Any]) -> list[Complaint]:
    questions = {row.id: row for row in rubric.criteria if row.check.function is answered}
    complaints: list[Complaint] = []
    for name, value in table.items():
        if name not in questions:
            guess = (
                did_you_mean(name, questions) or f"; there are: {', '.join(questions) or 'none'}"
            )
            complaints.append(((name,), f"the rubric {rubric.id} has no question {name!r}{guess}"))
        elif not isinstance(value, str):
            complaints.append(((name,), f"the answer to {name} must be a string"))
        elif questions[name].answer:
            complaints.append(
                ((name,), f"the answer to {name} is already in the rubric: remove one of the two")
            )
    return complaints
