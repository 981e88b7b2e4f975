"""What every layout has to give: hand-ins in a row, and what was left out."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from grader.classroom.students import HandIn, Student
from grader.submission.files import printable_path

MOST_LINES = 200


class Shelf(Protocol):
    """Hand-ins, sorted by their students' keys, which are printable and differ. A student is told without a look into the files."""

    def __len__(self) -> int:
        """How many there are."""

    def student(self, index: int) -> Student:
        """Who has handed in, as far as the names say."""

    def hand_in(self, index: int) -> HandIn:
        """What was handed in."""


@dataclass(frozen=True, slots=True)
class Listed:
    """A shelf whose hand-ins are all at hand."""

    hand_ins: Sequence[HandIn]

    def __len__(self) -> int:
        return len(self.hand_ins)

    def student(self, index: int) -> Student:
        """Who has handed in."""
        return self.hand_ins[index].student

    def hand_in(self, index: int) -> HandIn:
        """What was handed in."""
        return self.hand_ins[index]


def listed(hand_ins: Iterable[HandIn]) -> Listed:
    """A shelf of these hand-ins; keys are made printable, and a second one that is the same gets a number."""
    taken: set[str] = set()
    made: list[HandIn] = []
    for each in sorted(hand_ins, key=lambda each: (each.student.key, each.paths)):
        key = unique(printable_path(each.student.key), taken)
        taken.add(key)
        made.append(each if key == each.student.key else replace(each, student=replace(each.student, key=key)))
    return Listed(sorted(made, key=lambda each: each.student.key))


def unique(key: str, taken: Collection[str]) -> str:
    """A key that nobody has yet: the one wanted, or it with the first free number."""
    number = 2
    wanted = key
    while key in taken:
        key = f"{wanted}~{number}"
        number += 1
    return key


class LeftOut:
    """What is no submission, and why: the first lines in the order of the alphabet, and a count of the rest."""

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._count = 0

    def add(self, path: str, reason: str) -> None:
        """Leave something out; `reason` goes on where the name ends."""
        self._lines.append(f"{printable_path(path)} {reason}")
        self._count += 1
        if len(self._lines) > 10 * MOST_LINES:
            self._lines = sorted(self._lines)[:MOST_LINES]

    def add_all(self, refused: Iterable[tuple[str, str]]) -> None:
        """Leave out names, each with its reason."""
        for name, reason in refused:
            self.add(name, reason)

    def lines(self) -> tuple[str, ...]:
        """At most MOST_LINES lines, and one more that says how many there would be."""
        shown = sorted(self._lines)[:MOST_LINES]
        more = self._count - len(shown)
        return (*shown, f"and {more} more") if more else tuple(shown)
