"""What a person decides: the items of a class, each a criterion of the students whose answer is the same."""

from collections import defaultdict
from collections.abc import Mapping, Sequence

from grader.classroom.grades import Class


def answers_of(book: Class) -> Mapping[tuple[str, str], Sequence[str]]:
    """Return the students with each answer, by criterion and the key of the answer."""
    found: defaultdict[tuple[str, str], list[str]] = defaultdict(list)
    for one in book.results.all():
        for criterion, key in one.answers.items():
            found[criterion, key].append(one.student)
    return found
