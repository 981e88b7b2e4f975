"""Marks of many students in one CSV file: rows of a file of marks, a review sheet, or the grades as they were exported.

A sheet names answers, whose marks are those of all students with that answer. An export becomes marks where a person
changed a cell: the column `exported` has what the cells were, and `submission` the digest of what was graded.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

from grader.classroom.mark_files import COLUMNS, read_rows
from grader.classroom.marks import Key, Mark, Marks, Names, mark_in, maxima
from grader.classroom.typed_names import as_number, criterion_of, find_typed, number_in
from grader.errors import InputError
from grader.grading.criterion import DEADLINE, TOTAL
from grader.grading.rubric import Rubric
from grader.text import by_name, enumerated, first_lines, printable

SHEET_COLUMNS = ("criterion", "answer", "points", "comment", "text", "students")
_MAX_MISTAKES = 20
_Cells = Mapping[str, str]


class Imported(NamedTuple):
    """The marks to append, how many more say what counts already, and how many rows have marks."""

    marks: list[Mark]
    same: int
    rows: int


class MarkImport(NamedTuple):
    """What the rows of a file are compared with.

    `digests` are those of the submissions by the keys of students, `answers` the keys of the students with each
    answer, by criterion and the answer's key.
    """

    students: Sequence[Any]
    rubric: Rubric
    marks: Marks
    digests: Mapping[str, str]
    answers: Mapping[tuple[str, str], Sequence[str]] = {}

    def read(self, data: bytes, shown: str, by: str) -> Imported:
        """Return the marks in a CSV file; raises InputError with a line for each wrong row."""
        _, titles, rows = read_rows(data, shown)
        names, found, mistakes, used = {*titles}, dict[Key, Mark](), list[str](), 0
        is_of_marks = "criterion" in names and names & {"student", "answer"} and names & {"points", "comment"}
        if not is_of_marks and not names >= {"id", "exported"}:
            raise InputError(f"the first line of {shown} must name the columns {enumerated(COLUMNS[2:6])}")
        for line, values in rows:
            try:
                marks = list(self._marks({**dict.fromkeys(COLUMNS, ""), **values}, by, f"{shown}:{line}"))
                if twice := [mark for mark in marks if found.setdefault(_key(mark), mark) is not mark]:
                    ...
                used += bool(marks)
            except InputError as error:
                mistakes.append(f"{shown}:{line}: {error}")
        if mistakes:
            raise InputError("\n".join(map(printable, first_lines(mistakes, _MAX_MISTAKES))))
        new = [mark for mark in found.values() if mark.time]
        return Imported(new, len(found) - len(new), used)

    def _mark(self, cells: _Cells, most: Mapping[str, Decimal], place: str) -> Iterator[Mark]:
        """Yield the mark in a row; its time is empty if it says what counts already."""
        key = student, criterion = cells["student"], cells["criterion"]
        points = most[criterion] if criterion in (TOTAL, DEADLINE) else most[criterion_of(self.rubric, criterion).id]
        digest = cells["submission"] or self.digests.get(student, "")
        for mark in mark_in({**cells, "time": "", "submission": digest}, key, points, place):
            if criterion not in (TOTAL, DEADLINE) and student not in self.digests:
                raise InputError(f"{student} has submitted nothing that could be marked: `{TOTAL}` is a final mark")
            yield mark if self._is_same(mark, key) else mark._replace(time=self.marks.next_time(key))

    def _is_same(self, mark: Mark, key: Key) -> bool:
        counting = self.marks.counting.get(key)
        if mark.kind == "comment":
            return mark.comment == getattr(counting or self.marks.comments.get(key), "comment", "")
        if counting is None or mark.kind == "withdrawn":
            return counting is None and mark.kind == "withdrawn"
        return (counting.value, counting.comment) == (mark.value, mark.comment)

    def _expansion(self, titles: Sequence[str], shown: str) -> Callable[[dict[str, str]], Iterator[_Cells]]:
        """Return the function that yields the cells of a file of marks for each row of this file."""
        names = {*titles}
        values = names & {"points", "comment"}
        for needed, expand in (({"criterion", "answer"}, self._of_sheet), ({"student", "criterion"}, self._of_marks)):
            if needed <= names and values:
                return expand
        if {"id", "exported"} <= names:
            return self._of_export
        raise InputError(f"the first line of {shown} must name the columns {enumerated(COLUMNS[2:6])}")

    def _of_marks(self, row: dict[str, str]) -> Iterator[_Cells]:
        if row["points"] or row["comment"]:
            yield row | {"student": self._key(row["student"])}

    def _of_sheet(self, row: dict[str, str]) -> Iterator[_Cells]:
        students = self.answers.get((row["criterion"], row["answer"]), ())
        if not students and (row["points"] or row["comment"]):
            raise InputError(f"no student has this answer to {row['criterion']}: write the sheet again")
        yield from (row | {"student": student} for student in students)

    def _of_export(self, row: dict[str, str]) -> Iterator[_Cells]:
        student = Names("student", [one.key for one in self.students]).find(row["id"])
        before = dict(word.rpartition("=")[::2] for word in row["exported"].split())
        for criterion, old in before.items():
            new = row.get(criterion, old)
            now = self.marks.counting.get((student, criterion))
            if _are_equal(new, old):
                continue
            if not new:
                raise InputError(f"{criterion} was {old} and is empty: `-` withdraws a mark")
            if now is not None and not (_are_equal(now.value, old) or _are_equal(now.value, new)):
                raise InputError(f"{criterion} was {old} when it was exported, but is {now.value}{by_name(now.by)} now")
            comment = now.comment if now is not None else ""
            yield row | {"student": student, "criterion": criterion, "points": new, "comment": comment}

    def _key(self, cell: str) -> str:
        """Return the key of a student whom a person has typed."""
        keys = tuple(one.key for one in self.students)
        if cell in keys or as_number(cell, keys):
            return Names("student", keys).find(cell)
        return str(find_typed(self.students, cell, "; `grades.csv` lists all students").key)


def exported_cell(values: Mapping[str, str]) -> str:
    """Return the cell in the column `exported`: the values of criteria, as they are in their columns."""
    return " ".join(f"{criterion}={value}" for criterion, value in values.items())


def _are_equal(text: str, other: str) -> bool:
    return text == other or (number_in(text) is not None and number_in(text) == number_in(other))
