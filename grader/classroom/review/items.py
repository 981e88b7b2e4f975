"""The items of a review: equal answers and a team's submission are one item, and similar answers are neighbours."""

import json
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import reduce
from operator import or_
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import FILES, ReviewScope, manual_grading_queue, queued_results
from grader.files.reading import sha256_of

# Answers to a question, each of which is compared with all others, and words of one.
_MAX_COMPARED, _MAX_WORDS = 300, 200
AMONG = "key IN (SELECT value FROM json_each(?))"


class QueuedItem(NamedTuple):
    """A criterion of the students that one mark serves, each with the id of the result that was read.

    `content` is what their results have in common, empty if there is nothing to read. An item of one student who is
    also part of an item of several has the position of that one, `whole`.
    """

    criterion: str
    students: tuple[tuple[str, int | None], ...]
    content: str = ""
    whole: int | None = None


def review_items(grades: Grades, scope: ReviewScope, numbers: Mapping[str, int]) -> tuple[QueuedItem, ...]:
    """Return the items of a review: first those with something to read, then those without, one for each criterion.

    Each item of several students is followed by one for each of them. The order says nothing about the names of
    students who have numbers.
    """
    queued = defaultdict[str, list[str]](list)
    for key, criterion in manual_grading_queue(grades, scope):
        queued[key].append(criterion)
    read: list[tuple[int, str, int | None, list[tuple[str, str]]]] = []
    for grade in list(grades.where(AMONG, json.dumps([*queued]))):
        key = grade.student.key
        found = [(one.result.criterion.id, one.content) for one in queued_results(grades, grade, queued[key], scope)]
        read.append((numbers.get(key, 0), key, grade.result, found))
    groups = defaultdict[str, dict[str, list[tuple[str, int | None]]]](dict)  # of each criterion, by content
    for _, key, result, found in sorted(read):
        for criterion, content in found:
            groups[criterion].setdefault(content, []).append((key, result))
    items: list[QueuedItem] = []
    for criterion, content in _in_order([row.id for row in grades.newest_rubric().criteria], groups):
        whole, students = len(items), groups[criterion][content]
        items.append(QueuedItem(criterion, tuple(students), content))
        items += [QueuedItem(criterion, (one,), content, whole) for one in students if len(students) > 1]
    return tuple(items)


def _in_order(criteria: Sequence[str], groups: Mapping[str, Mapping[str, object]]) -> Iterator[tuple[str, str]]:
    for criterion in filter(groups.__contains__, criteria):
        found = groups[criterion]
        texts = similar_order([content for content in found if content and not content.startswith(FILES)])
        yield from ((criterion, content) for content in texts)
        yield from ((criterion, content) for content in found if content.startswith(FILES))
    yield from ((criterion, "") for criterion in criteria if "" in groups.get(criterion, ()))


def similar_order(texts: Sequence[str]) -> list[str]:
    """Return texts in an order in which each is followed by the one, of those that are left, that shares most words.

    The first stays the first. Very many are in alphabetical order.
    """
    if len(texts) > _MAX_COMPARED:
        return sorted(texts, key=str.casefold)
    bits: dict[str, int] = {}  # of each word, in a set of words as a whole number
    left = [(text, reduce(or_, (1 << bits.setdefault(word, len(bits)) for word in _words(text)), 0)) for text in texts]
    order, last = list[str](), 0
    while left:
        shares = [(words & last).bit_count() / ((words | last).bit_count() or 1) for _, words in left]
        text, last = left.pop(shares.index(max(shares)))
        order.append(text)
    return order


def _words(text: str) -> list[str]:
    return text.casefold().split()[:_MAX_WORDS]


def student_numbers(book: Gradebook) -> dict[str, int]:
    """Return a number for each student with a submission, in an order that says nothing about names."""
    keys = [str(key) for (key,) in book.rows("SELECT key FROM grade WHERE result IS NOT NULL")]
    return {key: number for number, key in enumerate(sorted(keys, key=lambda key: sha256_of(key.encode())), 1)}
