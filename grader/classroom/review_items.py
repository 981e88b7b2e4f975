"""What a person decides: the items of a class, each a criterion of the students whose answer is the same."""

from collections.abc import Iterator, Mapping, Sequence

from grader.classroom.grades import Class


def answers_of(book: Class) -> Mapping[tuple[str, str], Sequence[str]]:
    """Return the students with each answer, by criterion and the key of the answer."""
    return {}
