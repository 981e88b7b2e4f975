"""Fill a grade file of an LMS with the grades of a class, and say what importing it changes.

Only the cells of the grade, and Moodle's comments, are written; every other byte stays. An empty
cell may be imported as a change, and Moodle's worksheets have rounded grades. So rows of students
without a grade are removed. In matching rows with students, ids decide over names, and nothing is
guessed.
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import ROUND_FLOOR, Decimal
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.text import enumerated, first_lines, format_points, named, people_text, printable
from grader.classroom.lms.feedback import is_own_comment
from grader.classroom.lms.forms import IDS, Form
from grader.classroom.roster.roster import Student, plain
from grader.classroom.roster.typed_names import number_in
from grader.classroom.tables import Table, TableRow, read_table

_Note = tuple[str, str, str]  # a kind, which begins the message, who is concerned, and why
_OPEN, _KEPT, _REFUSED = "without a grade", "kept the comment", "the LMS would refuse the grade"
_UNKNOWN, _MISSING = "in the file, but not in the class", "in the class, but not in the file"
_TEST_STUDENT = re.compile(
    r"(?i)student, test|test student|.*_previewuser\d*"
)  # of Canvas and Blackboard
_NOT_GRADED = frozenset({"", "-", "needs grading"})  # the last in Blackboard
_POINTS_ROW = "Points Possible"  # in the first cell, of Canvas
_THOUSANDS = re.compile(r"\s|[.,](?=.*[.,])")  # in 1.000,00: the last comma or point is decimal
_COMMA, _WORDS = r"[0-9],[0-9]{1,2}$", r"[^\W\d_]+|\d+"
_MAX_CHANGES, _MAX_REASONS, _MAX_NAMED, _MAX_COLUMNS = 40, 50, 3, 20


class PublishedGrade(NamedTuple):
    """A student's grade as an LMS gets it."""

    student: Student
    total: Decimal | None = None
    is_excused: bool = False
    why_open: str = ""  # why there is no total
    comment: str = ""  # HTML from `comment_html`


class FillOptions(NamedTuple):
    """How a file is filled."""

    out_of: Decimal  # the maximum of the rubric
    names: Sequence[str]  # the lab's, the best first: title, id
    column: str = ""  # the title of the grade's column
    any_maximum: bool = False  # whether the file may have another maximum
    only: bool = False  # whether the columns of other assignments are omitted
    shown: str = "the file"  # its name in messages


class Filled(NamedTuple):
    """A filled file."""

    data: bytes = b""
    lines: Sequence[str] = ()  # what importing it does
    is_complete: bool = True  # whether each row has its student, and each grade its row
    numbers: Mapping[
        str, str
    ] = {}  # the ids of students in Moodle as the file has them, by the key of the student


class _GradeFile(NamedTuple):
    """A grade file: the columns by role (`grade` is that of the lab), and its maximum as it is
    written.
    """

    table: Table
    form: Form
    roles: dict[str, int]
    people: dict[TableRow, Student]
    maximum: str

    def changed(self, row: TableRow, grade: PublishedGrade) -> tuple[TableRow | None, list[_Note]]:
        """Return a row with its grade and comment, or None; and notes on it, a change's without a
        kind.
        """
        new, who = _grade_text(grade, self), self.who(row)
        at, comment_at = self.roles["grade"], self.roles.get("comment")
        if why := next(self._why_not(row, new, grade.why_open or "has no grade"), None):
            return None, [(why[0], who, why[1])]
        notes, old, comment = list[_Note](), row.value(at), row.value(comment_at)
        if old.casefold() != new.casefold() and (
            number_in(old) is None or number_in(old) != number_in(new)
        ):
            if old.casefold() not in _NOT_GRADED:
                notes.append(("", who, f"was {old}, becomes {new}"))
            row = self.table.changed(row, at, new)
        if comment_at is not None and grade.comment not in ("", comment):
            if not comment or is_own_comment(comment):
                return self.table.changed(row, comment_at, grade.comment), notes
            notes.append((_KEPT, who, f"a person wrote or changed it in {self.form.lms}"))
        return row, notes

    def _why_not(self, row: TableRow, new: str, why_open: str) -> Iterator[tuple[str, str]]:
        """Yield why a row cannot get a grade, each reason with its kind."""
        titles = self.table.titles
        if not new:
            yield _OPEN, why_open
        if len(row.cells) != len(titles):
            yield _OPEN, f"the row has {len(row.cells)} cells and the header {len(titles)}"
        for role, words in self.form.locked.items():
            cell = row.value(self.roles.get(role))
            if cell.casefold() in words.split() and cell.casefold() != new.casefold():
                yield _OPEN, f"{titles[self.roles[role]]!r} is {cell!r} in {self.form.lms}"
        if self.form.above and (number_in(new) or 0) > (number_in(self.maximum) or 0):
            yield (
                _REFUSED,
                f"{new} points are above the maximum of {self.maximum}: {self.form.above}",
            )

    def who(self, row: TableRow) -> str:
        """Return the number of a row, and the name or an id of its student."""
        return f"row {row.number}, {next(filter(None, self.people[row]))}"


def fill(data: bytes, grades: Sequence[PublishedGrade], form: Form, options: FillOptions) -> Filled:
    """Return a grade file with the grades in the column of the lab; raises InputError if it is not
    such a file.
    """
    file = _read_grade_file(data, form, options)
    people, titles = [*file.people.values()], file.table.titles
    header = titles[file.roles["grade"]]
    warnings = _check_maximum(file.maximum, f"{header!r} in {form.lms}", options)
    of_row = _match_rows(people, [one.student for one in grades], form.lms)
    rows: dict[TableRow, TableRow | None] = {row: row for row in file.table.rows}
    notes = list[_Note]()
    for index, (row, one) in enumerate(file.people.items()):
        rows[row] = None
        if index in of_row:
            rows[row], some = file.changed(row, grades[of_row[index]])
            notes += some
        elif not _TEST_STUDENT.fullmatch(one.name or one.login):
            notes.append((_UNKNOWN, file.who(row), "matches no student for certain"))
    rest = [grades[at] for at in sorted({*range(len(grades))}.difference(of_row.values()))]
    missing = (one for one in rest if _grade_text(one, file))
    notes += (
        (_MISSING, named(*one.student[:2]), "has a grade or an excuse, but matches no row")
        for one in missing
    )
    kept = [row for row in rows.values() if row is not None]
    graded = [rows[row] is not row for row in file.people if rows[row] is not None]
    if options.only and "maximum" not in file.roles:
        places = {
            *file.roles.values(),
            *(at for at, title in enumerate(titles) if title.lower() in form.kept),
        }
        kept = [
            row._replace(cells=tuple(cell for at, cell in enumerate(row.cells) if at in places))
            for row in kept
        ]
    lines = [
        f"column {header!r}: {sum(graded)} filled in, {len(graded) - sum(graded)} already the same"
    ]
    lines += first_lines([f"{who}: {why}" for kind, who, why in notes if not kind], _MAX_CHANGES)
    lines += [*by_reason(note for note in notes if note[0]), *warnings]
    is_complete = all(note[0] in ("", _OPEN, _KEPT) for note in notes)
    numbers = {grades[at].student.key: people[index].moodle for index, at in of_row.items()}
    return Filled(
        file.table._replace(rows=tuple(kept)).encoded(),
        [*map(printable, lines)],
        is_complete,
        numbers,
    )


def by_reason(notes: Iterable[_Note]) -> list[str]:
    """Return a line for each reason: who has it, of several how many and the first of them."""
    names = defaultdict[tuple[str, str], list[str]](list)
    for kind, who, why in notes:
        names[kind, why].append(who)
    groups = (
        (*key, f"{len(who)} ({people_text(who, _MAX_NAMED)})" if who[1:] else who[0])
        for key, who in names.items()
    )
    return first_lines(
        [printable(": ".join(filter(None, (kind, who, why)))) for kind, why, who in groups],
        _MAX_REASONS,
    )


def _grade_text(grade: PublishedGrade, file: _GradeFile) -> str:
    """Return the points, rounded down, for 99.996 of 100 is not the maximum, with the file's comma;
    or an excuse.
    """
    if grade.total is None:
        return file.form.excuse if grade.is_excused else ""
    text = format(grade.total.quantize(Decimal("0.01"), ROUND_FLOOR), "f")
    if re.search(_COMMA, file.maximum):
        return text.replace(".", ",")
    return text


def _check_maximum(text: str, what: str, options: FillOptions) -> list[str]:
    """Return a warning about an unknown maximum; raises InputError for another one: 9.33 of 100 is
    not 9.33 of 10.
    """
    maximum = number_in(text)
    if maximum is not None and maximum != options.out_of and not options.any_maximum:
        others = (
            f"{format_points(maximum)}, but that of the rubric is {format_points(options.out_of)}"
        )
        advice = (
            "change it in the LMS and export again, or pass --any-maximum to write the points "
            "unchanged"
        )
        raise InputError(f"the maximum of {what} is {others}: {advice}")
    if maximum is not None:
        return []
    return [f"the file does not state the maximum of {what}"]


def _read_grade_file(data: bytes, form: Form, options: FillOptions) -> _GradeFile:
    """Return a grade file; raises InputError if it is another file, or if the column of the lab is
    ambiguous.
    """
    table = read_table(data, options.shown)
    titles, roles = table.titles, form.roles(table.titles)
    if not (roles.keys() >= {*form.needed} and roles.keys() & {*IDS}):
        has = _listed(titles) or "nothing"
        raise InputError(
            f"{options.shown} is not a grade file of {form.lms}: its first row has {has}"
        )
    points = next(
        (row for row in table.rows[1:] if _POINTS_ROW in row.value(0)), TableRow(0, 0, (), "")
    )
    columns = {
        at: found for at, title in enumerate(titles) if (found := form.grade.fullmatch(title))
    }
    if "maximum" in roles:
        columns = {at: found for at, found in columns.items() if at + 1 == roles["maximum"]}
    grade = roles["grade"] = _choose(columns, form, options)
    people = {
        row: one
        for row in table.rows[1:]
        if row is not points and any((one := _student_in(row, roles))[:7])
    }
    places = (columns[grade].groupdict().get("maximum"), points.value(grade))
    maxima = (*places, *(row.value(roles.get("maximum")) for row in people))
    return _GradeFile(
        table, form, roles, people, _THOUSANDS.sub("", next(filter(None, maxima), ""))
    )


def _student_in(row: TableRow, roles: Mapping[str, int]) -> Student:
    """Return the student in a row."""
    login, sis, email, canvas, moodle, name = (
        row.value(roles.get(role)).removeprefix("#") for role in (*IDS, "name")
    )
    return Student(
        "", name, email, login, sis, canvas, re.split(r"\D", moodle)[-1]
    )  # of Participant 123


def _choose(columns: Mapping[int, re.Match[str]], form: Form, options: FillOptions) -> int:
    """Return the column that is named, else the one whose title is most like the title or the id of
    the lab.
    """
    names = [options.column.strip()] if options.column.strip() else options.names
    ranks = {
        at: rank for at, one in columns.items() if (rank := _likeness(one, options)) is not None
    }
    found = [at for at, rank in ranks.items() if rank == min(ranks.values())]
    if "maximum" in form.columns and not options.column:
        found = [*columns]
    if len(found) == 1:
        return found[0]
    listed = _listed([columns[at][0] for at in found or columns])
    if listed:
        advice = f"choose one with --column: {listed}"
    else:
        advice = f"create it in {form.lms}, and export again"
    what = f"{'' if options.column.strip() else 'for '}{' or '.join(map(repr, names))}"
    raise InputError(
        f"{options.shown} has {'several columns' if found else 'no column'} {what}; {advice}"
    )


def _likeness(found: re.Match[str], options: FillOptions) -> int | None:
    """Return how much a column is like the lab, 0 is best: it has the header, title or number that
    is wanted.

    Else its title is, or contains, each of the lab's names, in this order; last, it is part of one.
    """
    if wanted := options.column.strip():
        tests = [wanted in (found[0], found["title"], found.groupdict().get("number"))]
    else:
        own, known = _spaced_words(found["title"]), [_spaced_words(name) for name in options.names]
        tests = [
            is_so
            for name in known
            for is_so in (own.replace(" ", "") == name.replace(" ", ""), name in own)
        ]
        tests.append(any(own in name for name in known))
    return tests.index(True) if True in tests else None


def _spaced_words(text: str) -> str:
    """Return words between spaces: Lab 6: wheeled base contains lab6, Lab 61 does not."""
    return f" {' '.join(re.findall(_WORDS, text.casefold()))} "


def _listed(headers: Sequence[str]) -> str:
    return enumerated([repr(header) for header in headers], _MAX_COLUMNS)


def _match_rows(rows: Sequence[Student], students: Sequence[Student], lms: str) -> dict[int, int]:
    """Return the student of each row that fits only one, whom no other row fits."""
    theirs, ours = (
        [_clues(row, lms) for row in rows],
        [_clues(student, lms) for student in students],
    )
    students_of, rows_of = _fitting(theirs, ours), _fitting(ours, theirs)
    return {
        row: some[0]
        for row, some in enumerate(students_of)
        if [rows_of[at] for at in some] == [[row]]
    }


def _clues(student: Student, lms: str) -> list[set[str]]:
    """Return what identifies a student, the most reliable first: the id in the LMS, other ids, the
    name.

    Of a student who is not on the roster it is the id in the LMS alone, for who submits chooses the
    names.
    """
    lms_id = {"Canvas": student.canvas, "Moodle": student.moodle}.get(lms, "")
    ids, name = [student.key, student.login, student.sis, student.email], student.name
    if not student.is_on_roster:
        ids, name = [], ""
    return [{*map(plain, kind)} - {""} for kind in ([lms_id], ids, [name])]


def _fitting(some: Sequence[list[set[str]]], others: Sequence[list[set[str]]]) -> list[list[int]]:
    """Return for each of some the others with its most reliable clue that is known, and no other id
    in the LMS.
    """
    having = defaultdict[tuple[int, str], set[int]](set)
    for at, clues in enumerate(others):
        for kind, words in enumerate(clues):
            for word in words:
                having[kind, word].add(at)
    found = []
    for clues in some:
        kinds = (
            set[int]().union(*(having[kind, word] for word in words))
            for kind, words in enumerate(clues)
        )
        fitting = sorted(next(filter(None, kinds), ()))
        found.append(
            [at for at in fitting if clues[0] == others[at][0] or not (clues[0] and others[at][0])]
        )
    return found
