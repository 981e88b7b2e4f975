"""Marks of many students in one CSV file.

They are rows of a file of marks, a review sheet, or the grades as they were exported.

A row of a sheet names an answer: it is a mark of the students with that answer, of those among them
whom the column `students` names. An export becomes marks where a person changed a cell: the column
`exported` has hashes of what the cells were, and `submission` the digest of what was graded.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from grader.base.errors import InputError
from grader.base.grouping import StringsByName
from grader.base.patterns import on_use
from grader.base.text import enumerated, quoted
from grader.classroom.marks.marks import (
    COLUMNS,
    WITHDRAWN,
    Cells,
    Key,
    Mark,
    Marks,
    collect,
    mark_in,
    marked_name,
    maxima,
    read_rows,
)
from grader.classroom.results.results import hash_values
from grader.classroom.roster.typed_names import (
    as_number,
    find_criterion,
    find_typed,
    known,
    number_in,
)
from grader.lab.rubric.criterion import DEADLINE, GRADE
from grader.lab.rubric.rubric import Rubric

_EXPORTED = on_use("(d[0-9a-f]{16})(d[0-9a-f]{16})")
_MAX_DIGITS = 9  # of a number that is compared


class MarkImport(NamedTuple):
    """What the rows of a file refer to."""

    students: Sequence[Any]
    rubric: Rubric
    marks: Marks
    digests: StringsByName  # of the submissions, by the key of the student
    answers: Mapping[
        tuple[str, str], Sequence[str]
    ] = {}  # students by criterion and the key of the answer
    points: Mapping[
        str, StringsByName
    ] = {}  # the cells of each student in an export, the total last

    def read(self, data: bytes, shown: str) -> tuple[list[Mark], int]:
        """Return the new marks in a CSV file, without times, and how many count already.

        Raises as `read_marks`.
        """
        _, titles, rows = read_rows(data, shown)
        has_marks = (
            "criterion" in titles
            and {"student", "answer"} & {*titles}
            and {"points", "comment"} & {*titles}
        )
        if not (has_marks or {"id", "exported"} <= {*titles}):
            raise InputError(
                f"the first line of {shown} must name the columns {enumerated(COLUMNS[2:6])}"
            )
        mistakes: list[str] = []
        new_marks = collect(rows, self.marks_in, mistakes, mistakes).newest
        new = [mark for key, mark in new_marks.items() if not self._is_same(key, mark)]
        return new, len(new_marks) - len(new)

    def _is_same(self, key: Key, mark: Mark) -> bool:
        before = (
            self.marks.counting.get(key)
            or self.marks.comments.get(key)
            or Mark("", "", *key, WITHDRAWN)
        )
        is_current = not mark.value or before.submission in ("", mark.submission)
        return is_current and (before.value, before.comment) == (
            mark.value or before.value,
            mark.comment,
        )

    def marks_in(self, row: Cells, place: str = "") -> Iterator[Mark]:
        """Yield the marks in a row, without a time; raises InputError."""
        for cells in self._changed(row) if "exported" in row else self._expanded(row):
            key = student, criterion = cells["student"], marked_name(cells["criterion"])
            if criterion not in (GRADE, DEADLINE):
                if student not in self.digests:
                    raise InputError(
                        f"{student} has submitted nothing that could be marked: `{GRADE}` "
                        "is a final mark"
                    )
                find_criterion(self.rubric, criterion)
            digest = row["submission"] or (
                "" if criterion == DEADLINE else self.digests.get(student, "")
            )
            yield mark_in(
                {**cells, "submission": digest, "time": ""},
                key,
                maxima(self.rubric)[criterion],
                place,
            )

    def _expanded(self, row: Cells) -> Iterator[Cells]:
        """Yield the cells of a row for each of its students."""
        for student in self._students(row) if row["points"] or row["comment"] else ():
            yield {**row, "student": student}

    def _students(self, row: Cells) -> Sequence[str]:
        cell = row["student"] or row.get("students", "")
        keys = {one.key: one for one in self.students}
        criterion = marked_name(row["criterion"])
        if "answer" in row and criterion != GRADE:
            where = (criterion, row["answer"])
            named = {*row.get("students", "").split("; ")}
            if some := [
                key for key in self.answers.get(where, ()) if key in named or named.isdisjoint(keys)
            ]:
                return some
            raise InputError(f"no student has this answer to {criterion} now: remove the row")
        of_lms = [one.key for one in self.students if cell in (one.sis, one.canvas, one.moodle)]
        is_certain = of_lms and cell.startswith("0")  # which a spreadsheet removes
        changed = as_number(cell, tuple(keys)) if not is_certain else of_lms
        if cell in keys or (changed and changed != of_lms):
            return [known("student", cell, keys)]
        return [find_typed(self.students, cell, "; `grades.csv` lists all students").key]

    def _changed(self, row: Cells) -> Iterator[Cells]:
        """Yield the cells of an export that a person changed, as a row for each.

        A comment stays.
        """
        exported = _EXPORTED.fullmatch(row["exported"])
        if not exported:
            raise InputError(
                f"{quoted(row['exported'])} in the column `exported` is not what was exported"
            )
        student = known("student", row["id"], {one.key: one for one in self.students})
        now = self.points[student]
        *criteria, total = now
        given = {name: row.get(name, text) for name, text in now.items()}
        for names, hashed in ((criteria, exported[1]), ([total], exported[2])):
            changed = [name for name in names if _plain(given[name]) != _plain(now[name])]
            if not changed or _hash_points(given, names) == hashed:
                continue
            if _hash_points(now, names) != hashed:
                raise InputError(
                    f"{student} has other points now than when they were exported: export "
                    "them again"
                )
            for name in changed:
                if not given[name]:
                    raise InputError(
                        f"{name} was {now[name]} and is empty: write `-` to withdraw a mark"
                    )
                mark = self.marks.counting.get((student, name))
                comment = mark.comment if mark else ""
                yield {
                    **row,
                    "student": student,
                    "criterion": name,
                    "points": given[name],
                    "comment": comment,
                }


def exported_text(points: StringsByName) -> str:
    """Return the hashes of the points in a row of an export.

    These are that of all criteria, and that of the grade.
    """
    *criteria, total = points
    return _hash_points(points, criteria) + _hash_points(points, [total])


def _hash_points(points: StringsByName, names: Sequence[str]) -> str:
    return hash_values(*(_plain(points[name]) for name in names))


def _plain(text: str) -> str:
    """Return a number as it is written in one way only, another text unchanged."""
    number = number_in(text)
    if number is None or abs(number.adjusted()) > _MAX_DIGITS:
        return text
    return str(number.normalize())
