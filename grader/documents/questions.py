"""Headings that several questions share, such as "REQUIRED Question:": which of them belongs to which question."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from grader.documents.document import Passage
from grader.documents.headings import Pattern
from grader.documents.labels import WORDS

_ORDINAL = re.compile(r"\s*(\S.*?)\s+(\d{1,3})\s+of\s+(\d{1,3})\s*")


class Ordinal(NamedTuple):
    """A question by its place among all: "required question 1 of 2"."""

    pattern: Pattern
    number: int
    total: int


class AnswerMatch(NamedTuple):
    """The answers that belong to a question, by their index: exactly one, unless it is not certain. `how` says why."""

    indices: tuple[int, ...]
    is_certain: bool
    how: str


def read_ordinal(place: str) -> Ordinal | None:
    """Return the place among all questions that "required question 1 of 2" names; None for other texts."""
    found = _ORDINAL.fullmatch(place.lower())
    return Ordinal(tuple(WORDS.findall(found[1])), int(found[2]), int(found[3])) if found else None


def match_answer(wanted: Ordinal, task: int | None, answers: Sequence[Passage]) -> AnswerMatch | None:
    """Return which of the answers in one document belongs to a question of a task; None if there is none for it.

    In this order: the only one below the heading of the task; the one with its number; the one at its place, if there
    are as many as questions. Anything else is not certain.
    """
    if not answers:
        return None
    below = [index for index, answer in enumerate(answers) if answer.head.section == task]
    if task is not None and len(below) == 1 and all(answer.head.section is not None for answer in answers):
        return AnswerMatch(
            tuple(below), True, f"the only {_answer_text(answers, below)} below the heading of task {task}"
        )
    written = [index for index, answer in enumerate(answers) if not answer.is_empty]
    numbers = [answer.head.number for answer in answers if answer.head.number is not None]
    if len(numbers) == len(answers) and max(numbers) <= wanted.total:
        return _answer_by_number(wanted, task, answers, written)
    for indices in (list(range(len(answers))), written, _answers_after_list(answers, wanted.total)):
        in_order = all(answers[index].head.number in (None, place) for place, index in enumerate(indices, start=1))
        if len(indices) == wanted.total and in_order:
            index = indices[wanted.number - 1]
            how = f"in order: heading {wanted.number} of {wanted.total} like {_answer_text(answers, [index])}"
            return AnswerMatch((index,), True, how)
    indices = written or list(range(len(answers)))
    count = f"{len(indices)} heading{'' if len(indices) == 1 else 's'} like {_answer_text(answers, indices)}"
    return AnswerMatch(tuple(indices), False, f"{count} for {wanted.total} questions: it may answer another question")


def _answer_by_number(
    wanted: Ordinal, task: int | None, answers: Sequence[Passage], written: Sequence[int]
) -> AnswerMatch | None:
    """Return the answer below the question's number; of several, as with a list of the questions, that with text."""
    hits = [index for index, answer in enumerate(answers) if answer.head.number == wanted.number]
    if len(hits) > 1:
        hits = [index for index in hits if index in written] or hits
    if not hits:
        return None
    if len(hits) > 1:
        return AnswerMatch(tuple(hits), False, f"{len(hits)} headings like {_answer_text(answers, hits)}")
    section = answers[hits[0]].head.section
    is_other = len(wanted.pattern) == 1 and None not in (section, task) and section != task
    where = f", but below the heading of task {section}" if is_other else ""
    return AnswerMatch(tuple(hits), not is_other, f"by the number in {_answer_text(answers, hits)}{where}")


def _answers_after_list(answers: Sequence[Passage], total: int) -> list[int]:
    """Return the answers that follow a list of all questions; none without such a list."""
    is_list = len(answers) == 2 * total and all(map(_is_line, answers[:total]))
    return list(range(total, 2 * total)) if is_list and not any(map(_is_line, answers[total:])) else []


def _answer_text(answers: Sequence[Passage], indices: Sequence[int]) -> str:
    return f'"{answers[indices[0]].head.shown}"'


def _is_line(answer: Passage) -> bool:
    """Return whether an answer ends with the line of its heading."""
    return "\n" not in answer.text
