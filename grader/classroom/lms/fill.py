"""Fill a grade file of an LMS with the grades of a class, and say what importing it changes.

Only the cells of the grade, and Moodle's comments, are written; every other byte stays. An empty cell may be imported
as a change, and Moodle's worksheets have rounded grades. So rows of students without a grade are removed.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from decimal import ROUND_FLOOR, Decimal
from operator import itemgetter
from typing import NamedTuple

from grader.classroom.lms.comments import is_own_comment
from grader.classroom.lms.forms import IDS, TEST_STUDENT, WHO, Form
from grader.classroom.lms.owners import ClassGrade, match_rows
from grader.classroom.roster import Student
from grader.classroom.tables import Table, TableRow, read_table
from grader.errors import InputError
from grader.text import enumerated, first_lines, format_points, named, people_text, printable

Note = tuple[str, str, str]  # a kind, which begins the message, who is concerned, and why
_OPEN, _REFUSED = "without a grade", "the LMS would refuse the grade"
_UNKNOWN, _MISSING = "in the file, but not in the class", "in the class, but not in the file"
_AMBIGUOUS = "ambiguous"
_INCOMPLETE = (_REFUSED, _UNKNOWN, _MISSING, _AMBIGUOUS)
_NOT_GRADED = frozenset({"", "-", "needs grading"})  # the last in Blackboard
_COMMA = re.compile(r"[0-9],[0-9]{1,2}$")
_READ_ONLY = re.compile(r"\(.+\)")  # "(read only)" as the points possible in Canvas, in the user's language
_NUMBER = re.compile(r"-?[0-9][0-9.,]*")
_WORD = re.compile(r"[^\W\d_]+|\d+")
_MAX_CHANGES, _MAX_REASONS, _MAX_NAMED, _MAX_COLUMNS = 40, 50, 3, 20


class FillOptions(NamedTuple):
    """How a file is filled: `names` are the lab's, the best first (title, id), `shown` is the file's in messages."""

    out_of: Decimal
    names: Sequence[str]
    column: str = ""
    any_maximum: bool = False
    only: bool = False
    shown: str = "the file"


class Filled(NamedTuple):
    """A filled file and what importing it does; it is complete if each row has its student, and each grade its row.

    `rows` are the students as the file has them, by the key of the student of the class.
    """

    data: bytes = b""
    lines: Sequence[str] = ()
    is_complete: bool = True
    rows: Mapping[str, Student] = {}


class _GradeFile(NamedTuple):
    """A grade file: the columns by role (`grade` is that of the lab), and its maximum as it is written."""

    table: Table
    roles: dict[str, int]
    maximum: str
    students: list[tuple[TableRow, Student]]


def fill(data: bytes, grades: Sequence[ClassGrade], form: Form, options: FillOptions) -> Filled:
    """Return a grade file with the grades in the column of the lab; raises InputError if it is not such a file."""
    file = _read(data, form, options)
    header = file.table.titles[file.roles["grade"]]
    warnings = _check_maximum(file.maximum, f"{header!r} in {form.lms}", options)
    cells = [_cell(grade, form, file.maximum) for grade in grades]
    names = [named(one.student.key, one.student.name) for one in grades]
    of_row, doubtful = match_rows([one for _, one in file.students], [one.student for one in grades], form.lms)
    rows: dict[int, TableRow | None] = {row.number: row for row in file.table.rows}
    notes = list[Note]()
    for index, (row, one) in enumerate(file.students):
        who = f"row {row.number}, {one.name or next(filter(None, (getattr(one, name) for name in IDS)), '')}"
        at, could = of_row.get(index), people_text([names[at] for at in doubtful.get(index, ())], _MAX_NAMED)
        rows[row.number] = None
        if at is not None:
            rows[row.number], some = _filled_row(file, form, row, grades[at], cells[at])
            notes += ((kind, who, why) for kind, why in some)
        elif could:
            notes.append((_AMBIGUOUS, who, f"could be {could}"))
        elif not TEST_STUDENT.fullmatch(one.name):
            notes.append((_UNKNOWN, who, "no student of the class matches this id, address or name"))
    matched = {*of_row.values()}.union(*doubtful.values())
    missing = [name for at, name in enumerate(names) if cells[at] and at not in matched]
    notes += ((_MISSING, name, "has a grade or an excuse, but no row in the file") for name in missing)
    kept = [row for row in rows.values() if row is not None]
    if options.only and "maximum" not in file.roles:
        places = sorted({*file.roles.values()})
        kept = [row._replace(cells=tuple(row.cells[at] for at in places if at < len(row.cells))) for row in kept]
    graded = [rows[row.number] is not row for row, _ in file.students if rows[row.number] is not None]
    count = f"column {header!r}: {sum(graded)} filled in, {len(graded) - sum(graded)} already the same"
    notes.sort(key=lambda note: note[0] not in _INCOMPLETE)
    changes = [f"{who}: {why}" for kind, who, why in notes if not kind]
    lines = [count, *first_lines(changes, _MAX_CHANGES), *by_reason(filter(itemgetter(0), notes)), *warnings]
    own = {grades[at].student.key: file.students[index][1] for index, at in of_row.items()}
    data = file.table._replace(rows=tuple(kept)).encoded()
    return Filled(data, [*map(printable, lines)], all(note[0] not in _INCOMPLETE for note in notes), own)


def by_reason(notes: Iterable[Note]) -> list[str]:
    """Return a line for each reason: who has it, of several how many and the first of them."""
    names: dict[tuple[str, str], list[str]] = {}
    for kind, who, why in notes:
        names.setdefault((kind, why), []).append(who)
    groups = (
        (*key, f"{len(who)} ({people_text(who, _MAX_NAMED)})" if who[1:] else who[0]) for key, who in names.items()
    )
    return first_lines([f"{kind}: {who}: {why}" for kind, why, who in groups], _MAX_REASONS)


def _cell(grade: ClassGrade, form: Form, like: str) -> str:
    """Return the points, rounded down, for 99.996 of 100 is not the maximum; `like` may have a comma. Or an excuse."""
    if grade.total is None:
        return form.excuse if grade.is_excused else ""
    text = format(grade.total.quantize(Decimal("0.01"), ROUND_FLOOR), "f")
    return text.replace(".", ",") if _COMMA.search(like) else text


def _why_not(file: _GradeFile, form: Form, row: TableRow, new: str, why_open: str) -> tuple[str, str] | None:
    """Return why a row does not get a grade: the kind of the reason, and the reason."""
    titles = file.table.titles
    if not new:
        return _OPEN, why_open or "has no grade"
    if len(row.cells) != len(titles):
        return _OPEN, f"the row has {len(row.cells)} cells and the header {len(titles)}"
    for role, words in form.locked.items():
        cell = row.value(file.roles.get(role))
        if cell.casefold() in words and cell.casefold() != new.casefold():
            return _OPEN, f"{titles[file.roles[role]]!r} is {cell!r} in {form.lms}"
    if form.above and (read_points(new) or 0) > (read_points(file.maximum) or 0):
        return _REFUSED, f"{new} points are above the maximum of {file.maximum}: {form.above}"
    return None


def _filled_row(
    file: _GradeFile, form: Form, row: TableRow, grade: ClassGrade, new: str
) -> tuple[TableRow | None, list[tuple[str, str]]]:
    """Return a row with its grade and comment, None if it gets no grade; and notes on it, a change's without a kind."""
    if why := _why_not(file, form, row, new, grade.why_open):
        return None, [why]
    notes, old = list[tuple[str, str]](), row.value(file.roles["grade"])
    if old.casefold() != new.casefold() and (read_points(old) is None or read_points(old) != read_points(new)):
        notes += [("", f"was {old}, becomes {new}")] if old.casefold() not in _NOT_GRADED else []
        row = file.table.changed(row, file.roles["grade"], new)
    column = file.roles.get("comment")
    comment = row.value(column)
    if column is None or grade.comment in ("", comment):
        return row, notes
    if comment and not is_own_comment(comment):
        return row, [*notes, ("kept the comment", f"a person wrote or changed it in {form.lms}")]
    return file.table.changed(row, column, grade.comment), notes


def _check_maximum(text: str, what: str, options: FillOptions) -> list[str]:
    """Return a warning about an unknown maximum; raises InputError for another one: 9.33 of 100 is not 9.33 of 10."""
    maximum = read_points(text)
    if maximum is not None and maximum != options.out_of and not options.any_maximum:
        others = f"{format_points(maximum)}, but that of the rubric is {format_points(options.out_of)}"
        advice = "change it in the LMS and export again, or pass --any-maximum to write the points unchanged"
        raise InputError(f"the maximum of {what} is {others}: {advice}")
    return [] if maximum is not None else [f"the file does not state the maximum of {what}"]


def read_points(text: str) -> Decimal | None:
    """Return the points in a cell, or None; the last comma or point is decimal (Canvas gradebook_importer.rb)."""
    text = re.sub(r"\s", "", text)
    if not _NUMBER.fullmatch(text):
        return None
    *whole, last = re.split("[.,]", text)
    return Decimal("".join(whole) + "." + (last or "0") if whole else last)


def _read(data: bytes, form: Form, options: FillOptions) -> _GradeFile:
    """Return a grade file; raises InputError if it is another file, or if the column of the lab is ambiguous."""
    table = read_table(data, options.shown)
    titles, roles = [*enumerate(table.titles)], form.roles(table.titles)
    if any(roles.keys().isdisjoint(needed.split()) for needed in form.needed):
        has = _list(table.titles) or "nothing"
        raise InputError(f"{options.shown} is not a grade file of {form.lms}: its first row has {has}")
    points = next((row for row in table.rows[1:] if form.points_row and form.points_row in row.value(0)), None)
    columns = {at: found for at, title in titles if (found := form.grade.fullmatch(title))}
    if "maximum" in roles:
        columns = {at: found for at, found in columns.items() if at + 1 == roles["maximum"]}
    if points is not None:
        columns = {at: found for at, found in columns.items() if not _READ_ONLY.fullmatch(points.value(at))}
    grade = roles["grade"] = _choose(columns, form, options)
    rows = [row for row in table.rows[1:] if row is not points and any(row.value(roles.get(role)) for role in WHO)]
    maximum = columns[grade].groupdict().get("maximum") or (points.value(grade) if points else "")
    maximum = maximum or next(filter(None, (row.value(roles.get("maximum")) for row in rows)), "")
    return _GradeFile(table, roles, maximum, [(row, form.student(row, roles)) for row in rows])


def _choose(columns: Mapping[int, re.Match[str]], form: Form, options: FillOptions) -> int:
    """Return the column that is named, else the one whose title is most like the title or the id of the lab."""
    wanted = options.column.strip()
    is_any = "maximum" in form.columns and not wanted
    ranks = {at: [True] if is_any else _likeness(found, wanted, options.names) for at, found in columns.items()}
    best = max(ranks.values(), default=[])
    found = [at for at, rank in ranks.items() if rank == best and any(rank)]
    if len(found) == 1:
        return found[0]
    listed = _list([columns[at][0] for at in found or columns])
    advice = f"choose one with --column: {listed}" if listed else f"create it in {form.lms}, and export again"
    what = repr(wanted) if wanted else f"for {' or '.join(map(repr, options.names))}"
    raise InputError(f"{options.shown} has {'several columns' if found else 'no column'} {what}; {advice}")


def _likeness(found: re.Match[str], wanted: str, names: Sequence[str]) -> list[bool]:
    """Return whether a column is the wanted one: by its header, or by its title or number.

    Of none, whether its title is, or contains, each of some names, in this order; last, whether it is part of one.
    """
    if wanted:
        return [wanted == found[0], wanted in (found["title"], found.groupdict().get("number"))]
    own, known = _words(found["title"]), [_words(name) for name in names]
    tests = (test for name in known for test in (own.replace(" ", "") == name.replace(" ", ""), name in own))
    return [*tests, any(own in name for name in known)]


def _words(text: str) -> str:
    """Return words between spaces: Lab 6: wheeled base contains lab6, Lab 61 does not."""
    return f" {' '.join(_WORD.findall(text.casefold()))} "


def _list(headers: Sequence[str]) -> str:
    return enumerated([repr(header) for header in headers], _MAX_COLUMNS)
