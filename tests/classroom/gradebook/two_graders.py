"""A plain model of gradebooks: every entry in order, and the grade of each student in a few lines of Python."""

from collections import Counter
from dataclasses import dataclass, field
from decimal import Decimal
from typing import NamedTuple

TOTAL = "total"


class Entry(NamedTuple):
    """An entry of the table of marks, without its id and result."""

    kind: str
    points: Decimal | None
    comment: str
    author: str
    by: str
    at: str


class Row(NamedTuple):
    """A criterion of a rubric: its points, whether they are extra credit, and how it is adjusted."""

    id: str
    points: Decimal
    bonus: bool = False
    adjusted: str = ""


class Grade(NamedTuple):
    """The grade of a student."""

    score: Decimal
    out_of: Decimal
    pending: Decimal
    total: Decimal
    is_excused: bool


Item = tuple[str, str]  # the key of a student, and a criterion or TOTAL


@dataclass
class Book:
    """A gradebook: its rubric, the signs of each student's submission (none without one), and all entries."""

    rubric: tuple[Row, ...]
    signs: dict[str, str]
    entries: dict[Item, list[Entry]] = field(default_factory=dict)

    def marks(self, item: Item) -> list[Entry]:
        """Return the entries of an item without second opinions."""
        return [entry for entry in self.entries.get(item, []) if entry.kind != "second"]

    def newest(self, item: Item) -> Entry | None:
        """Return the newest of them."""
        return next(reversed(self.marks(item)), None)

    def add(self, item: Item, entry: Entry) -> None:
        """Add an entry; a comment keeps the points or the excuse that counts, and their grader."""
        before = self.newest(item)
        if entry.kind == "comment" and before is not None and before.kind in ("points", "excused"):
            entry = entry._replace(kind=before.kind, points=before.points, by=before.by)
        self.entries.setdefault(item, []).append(entry)

    def restore(self, item: Item, before: Entry | None, author: str, at: str) -> None:
        """Add an entry that repeats an earlier one with its name, or withdraws the newest."""
        entry = before or Entry("withdrawn", None, "", author, author, at)
        self.entries[item].append(entry._replace(author=author, at=at))

    def grade(self, key: str) -> Grade:
        """Return the grade of a student."""
        score = out_of = pending = Decimal(0)
        for row, sign in zip(self.rubric, self.signs.get(key, ""), strict=False):
            entry = self.newest((key, row.id))
            maximum = Decimal(0) if row.bonus else row.points
            if row.adjusted:
                score += row.points if row.adjusted == "full" and sign != "-" else 0
                out_of += maximum if row.adjusted == "full" and sign != "-" else 0
            elif entry is not None and entry.points is not None:
                score, out_of = score + entry.points, out_of + maximum
            elif sign != "-":
                score, out_of = score + row.points * (sign == "p"), out_of + maximum
                pending += row.points * (sign == "?")
        final = self.newest((key, TOTAL))
        total = final.points if final is not None and final.points is not None else score
        return Grade(score, out_of, pending, total, final is not None and final.kind == "excused")

    def merge(self, other: "Book", keep: str, author: str, at: str) -> int:
        """Merge another gradebook into this one; return the number of conflicts that are left."""
        left = 0
        for item in sorted(other.entries):
            own, theirs = self.newest(item), other.newest(item)
            new = missing(other.entries[item], self.entries.get(item, []))
            lacking = missing(self.entries.get(item, []), other.entries[item])
            both = any(entry.kind != "second" for entry in new) and any(entry.kind != "second" for entry in lacking)
            chosen = own if keep == "first" else theirs
            if not (both and state(own) != state(theirs)):
                chosen = theirs if any(entry.kind != "second" for entry in new) and state(own) != state(theirs) else own
            elif not keep:
                left += 1
                continue
            if new:
                self.entries.setdefault(item, []).extend(new)
                if chosen is not None and state(self.newest(item)) != state(chosen):
                    self.restore(item, chosen, author, at)
        return left


def state(entry: Entry | None) -> tuple[str, Decimal | None, str] | None:
    """Return what an entry makes count."""
    return None if entry is None or entry.kind == "withdrawn" else entry[:3]


def missing(entries: list[Entry], others: list[Entry]) -> list[Entry]:
    """Return the entries that are not among others, each as often as it is more."""
    known = Counter(others)
    found = []
    for entry in entries:
        known[entry] -= 1
        if known[entry] < 0:
            found.append(entry)
    return found
