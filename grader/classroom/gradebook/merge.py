"""Merge the manual marks of one gradebook into another one, without losing an entry of either."""

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Literal, NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.histories import MergeItem, UnmatchedStudent, compare_marks, is_newest
from grader.classroom.gradebook.marks import account, insert_mark, writing
from grader.classroom.gradebook.schema import APPLICATION_ID
from grader.errors import InputError
from grader.text import printable_path

Choice = Literal["first", "second"]
# Key, criterion, and the ids of the newest marks: another mark is another conflict.
ConflictId = tuple[str, str, int, int]
# What a result refers to: the tables that belong to a rubric, each with its column, and the dictionary.
_OF_RUBRIC = (("rubric", "sha256"), ("criterion", "rubric"), ("model_answer", "rubric"))


class Merged(NamedTuple):
    """What a merge has written, and what it has not: conflicts without a choice, and unmatched students."""

    entries: int
    students: int
    conflicts: tuple[MergeItem, ...]
    unmatched: tuple[UnmatchedStudent, ...]


@contextmanager
def copy_of(path: Path) -> Iterator[Gradebook]:
    """Yield a temporary copy of a gradebook: the file itself is only read, also if it is in use."""
    shown = printable_path(path)
    if not path.is_file():
        raise InputError(f"there is no gradebook {shown}")
    with TemporaryDirectory() as folder:
        copy = Path(folder, "copy.db")
        try:
            address = f"{path.resolve().as_uri()}?mode=ro"
            with closing(sqlite3.connect(address, uri=True)) as source, closing(sqlite3.connect(copy)) as target:
                if source.execute("PRAGMA application_id").fetchone() != (APPLICATION_ID,):
                    raise InputError(f"{shown} is not a gradebook: name another file")
                target.execute("PRAGMA synchronous = OFF")  # it is only a copy
                source.backup(target)
        except sqlite3.DatabaseError as error:
            raise InputError(f"the gradebook {shown}: {error}") from None
        with Gradebook(copy, shown=shown) as book:
            book.check_undamaged()
            yield book


def conflict_of(item: MergeItem) -> ConflictId:
    """Return what identifies a conflict: it is another one as soon as somebody marks the item."""
    first, second = (entry.mark.id if entry is not None else 0 for entry in item.newest)
    return item.key, item.criterion, first, second


def merge(first: Gradebook, second: Gradebook, choices: Mapping[ConflictId, Choice]) -> Merged:
    """Append the entries that the first gradebook lacks, in one transaction; a conflict without a choice stays.

    If another mark than the chosen one would count after that, the chosen one is repeated as a new entry.
    """
    with writing(first):
        items, unmatched = compare_marks(first, second)
        results = _Results(first, second)
        written: dict[str, int] = {}
        conflicts = []
        for item in items:
            choice = choices.get(conflict_of(item)) if item.is_conflict else None
            if item.is_conflict and choice is None:
                conflicts.append(item)
                continue
            written[item.key] = written.get(item.key, 0) + _append(first, item, choice, results)
    return Merged(sum(written.values()), len(written), tuple(conflicts), unmatched)


def _append(book: Gradebook, item: MergeItem, choice: Choice | None, results: "_Results") -> int:
    """Write the new entries of an item, and the mark that counts if it is not the last; return how many."""
    own, theirs = item.newest
    counts = {"first": own, "second": theirs, None: item.counts}[choice]
    for entry in item.new:
        mark = entry.mark._replace(result=results.of(item.student, entry.mark.result))
        insert_mark(book, item.student, item.criterion, mark, entry.author)
    if counts is None or is_newest(counts, (*item.first, *item.new)):
        return len(item.new)
    result = counts.mark.result if counts is own else results.of(item.student, counts.mark.result)
    insert_mark(book, item.student, item.criterion, counts.mark._replace(result=result, at=""), account())
    return len(item.new) + 1


class _Results:
    """Finds the results of the second gradebook in the first one, and copies those that it lacks.

    A copied result belongs to no run, so it never becomes a student's current one.
    """

    def __init__(self, first: Gradebook, second: Gradebook) -> None:
        self._first, self._second = first, second
        self._found: dict[int, int] = {}

    def of(self, student: int, result: int | None) -> int | None:
        """Return the id in the first gradebook of a result in the second one."""
        if result is None:
            return None
        if result not in self._found:
            self._found[result] = self._find_or_copy(student, result)
        return self._found[result]

    def _find_or_copy(self, student: int, result: int) -> int:
        row = next(self._second.records("SELECT * FROM result WHERE id = ?", result))
        # A result without files has no digest: its record has to be the same.
        same = "student = ? AND rubric = ? AND digest = ? AND (digest <> '' OR record = ?)"
        key = student, row["rubric"], row["digest"], row["record"]
        found = self._first.first(f"SELECT max(id) FROM result WHERE {same}", *key)
        if found is not None and found[0] is not None:
            return int(found[0])
        for table, column in _OF_RUBRIC:
            self._copy(table, column, row["rubric"])
        self._copy("dictionary", "sha256", row["dictionary"])
        number = self._first.insert("result", row | {"id": None, "student": student})
        for outcome in self._second.records("SELECT * FROM outcome WHERE result = ?", result):
            self._first.insert("outcome", outcome | {"result": number})
        return number

    def _copy(self, table: str, column: str, value: Any) -> None:
        for row in self._second.records(f"SELECT * FROM {table} WHERE {column} = ?", value):
            self._first.insert(table, row, unless_known=True)
