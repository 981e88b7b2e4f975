"""What every layout has to give: hand-ins in a row, and what was left out."""

import os
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import Protocol

from grader.classroom.students import ClassSubmission, Student
from grader.text import printable_path

MAX_LINES = 200
_HERE = "./"  # with which no name begins


class Submissions(Protocol):
    """Hand-ins, sorted by their students' keys, which are printable and differ. A student is told without a look into the files."""

    @property
    def assignments(self) -> frozenset[str]:
        """What an LMS calls the assignment."""

    @property
    def contested(self) -> tuple[Student, ...]:
        """Students of whom something was ignored because it may be another's."""

    def __len__(self) -> int:
        """How many there are."""

    def student(self, index: int) -> Student:
        """Who has handed in, as far as the names say."""

    def hand_in(self, index: int) -> ClassSubmission:
        """What was handed in."""

    def place(self, index: int) -> str:
        """Where it stands in the class: the path of the student's folder or file."""


@dataclass(frozen=True, slots=True)
class SubmissionList:
    """A shelf whose hand-ins are all at hand."""

    hand_ins: Sequence[ClassSubmission]
    assignments: frozenset[str] = frozenset()
    contested: tuple[Student, ...] = ()

    def __len__(self) -> int:
        return len(self.hand_ins)

    def student(self, index: int) -> Student:
        """Who has handed in."""
        return self.hand_ins[index].student

    def hand_in(self, index: int) -> ClassSubmission:
        """What was handed in."""
        return self.hand_ins[index]

    def place(self, index: int) -> str:
        """The path of the first of its files."""
        return self.hand_ins[index].paths[0]


def listed(hand_ins: Iterable[ClassSubmission]) -> SubmissionList:
    """A shelf of these submissions. A key that is not printable, or that several have, is replaced by the key of the place."""
    given = list(hand_ins)
    counts = Counter(each.student.key for each in given)
    keys = [
        each.student.key
        if counts[each.student.key] == 1 and each.student.key.isprintable()
        else place_key(each.paths[0])
        for each in given
    ]
    made = [
        each if key == each.student.key else replace(each, student=replace(each.student, key=key))
        for each, key in zip(given, keys, strict=True)
    ]
    return SubmissionList(sorted(made, key=lambda each: each.student.key))


def place_key(path: str) -> str:
    """The key of a submission whose own name cannot be its key: its path, which no other submission can have.

    It begins with `./`, as no name does, so no student can take such a key over by naming a folder after it.
    """
    if path.isprintable():
        return f"{_HERE}{path}"
    return f"{_HERE}{printable_path(path)}-{sha256(os.fsencode(path)).hexdigest()}"


def is_place_key(key: str) -> bool:
    """Whether a key is that of a place."""
    return key.startswith(_HERE)


class IgnoredFiles:
    """What is no submission, and why: the first lines in the order of the alphabet, and a count of the rest."""

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._count = 0

    def add(self, path: str, reason: str) -> None:
        """Leave something out; `reason` goes on where the name ends."""
        self._lines.append(f"{printable_path(path)} {reason}")
        self._count += 1
        if len(self._lines) > 10 * MAX_LINES:
            self._lines = sorted(self._lines)[:MAX_LINES]

    def add_all(self, refused: Iterable[tuple[str, str]]) -> None:
        """Leave out names, each with its reason."""
        for name, reason in refused:
            self.add(name, reason)

    def lines(self) -> tuple[str, ...]:
        """At most MAX_LINES lines, and one more that says how many there would be."""
        shown = sorted(self._lines)[:MAX_LINES]
        more = self._count - len(shown)
        return (*shown, f"and {more} more") if more else tuple(shown)
