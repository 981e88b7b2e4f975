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
from grader.base.patterns import on_use
from grader.base.text import enumerated, first_lines, format_points, people_text, printable
from grader.classroom.lms.feedback import is_own_comment
from grader.classroom.lms.forms import IDS, Form
from grader.classroom.roster.roster import Student, plain
from grader.classroom.roster.typed_names import number_in
from grader.classroom.tables import Table, TableRow, read_table

_OPEN = "without a grade"
_KEPT = "kept the comment"
_REFUSED = "the LMS would refuse the grade"
_UNKNOWN = "in the file, but not in the class"
_MISSING = "in the class, but not in the file"
_TEST_STUDENT = on_use(
    r"(?i)student, test|test student|.*_previewuser\d*"
)  # of Canvas and Blackboard
_NOT_GRADED = frozenset({"", "-", "needs grading"})  # the last in Blackboard
_POINTS_ROW = "Points Possible"  # in the first cell, of Canvas
_THOUSANDS = on_use(r"\s|[.,](?=[^.,\n]*+[.,])")  # in 1.000,00: the last comma or point is decimal
_COMMA = r"[0-9],[0-9]{1,2}$"
_WORDS = r"[^\W\d_]+|\d+"
_MAX_CHANGES = 40
_MAX_REASONS = 50
_MAX_COLUMNS = 20
_MAX_CONCERNED = 3  # people who are named for one reason
_Clues = list[set[str]]  # of a person, the most reliable first


class _Note(NamedTuple):
    """What a person should know about the grade of a student."""

    kind: str  # which begins the message; empty for a change of a grade
    who: str
    why: str


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
    """A grade file.

    It has the columns by role (`grade` is that of the lab), and its maximum as it is written.
    """

    table: Table
    form: Form
    roles: dict[str, int]
    people: dict[TableRow, Student]
    maximum: str

    def changed(self, row: TableRow, grade: PublishedGrade) -> tuple[TableRow | None, list[_Note]]:
        """Return a row with its grade and comment, or None; and notes on it."""
        new = _grade_text(grade, self)
        who = self.who(row)
        obstacle = next(self._obstacles(row, new, grade.why_open or "has no grade"), None)
        if obstacle is not None:
            kind, why = obstacle
            return None, [_Note(kind, who, why)]
        notes = []
        grade_column = self.roles["grade"]
        comment_column = self.roles.get("comment")
        old = row.value(grade_column)
        comment = row.value(comment_column)
        if not _is_same_grade(old, new):
            if old.casefold() not in _NOT_GRADED:
                notes.append(_Note("", who, f"was {old}, becomes {new}"))
            row = self.table.changed(row, grade_column, new)
        if comment_column is not None and grade.comment not in ("", comment):
            if not comment or is_own_comment(comment):
                return self.table.changed(row, comment_column, grade.comment), notes
            why = f"a person wrote or changed it in {self.form.lms}"
            notes.append(_Note(_KEPT, who, why))
        return row, notes

    def _obstacles(self, row: TableRow, new: str, why_open: str) -> Iterator[tuple[str, str]]:
        """Yield why a row cannot get a grade, each reason with its kind."""
        titles = self.table.titles
        lms = self.form.lms
        if not new:
            yield _OPEN, why_open
        if len(row.cells) != len(titles):
            yield _OPEN, f"the row has {len(row.cells)} cells and the header {len(titles)}"
        for role, words in self.form.locked.items():
            column = self.roles.get(role)
            cell = row.value(column)
            is_locked = cell.casefold() in words.split() and cell.casefold() != new.casefold()
            if column is not None and is_locked:
                yield _OPEN, f"{titles[column]!r} is {cell!r} in {lms}"
        points = number_in(new) or 0
        maximum = number_in(self.maximum) or 0
        if self.form.above and points > maximum:
            above = f"{new} points are above the maximum of {self.maximum}"
            yield _REFUSED, f"{above}: {self.form.above}"

    def who(self, row: TableRow) -> str:
        """Return the number of a row, and the name or an id of its student."""
        return f"row {row.number}, {next(filter(None, self.people[row]))}"

    def only_column(self, rows: Sequence[TableRow]) -> list[TableRow]:
        """Return rows without the columns of other assignments."""
        columns = {*self.roles.values()}
        for column, title in enumerate(self.table.titles):
            if title.lower() in self.form.kept:
                columns.add(column)
        shortened = []
        for row in rows:
            cells = [cell for column, cell in enumerate(row.cells) if column in columns]
            shortened.append(row._replace(cells=tuple(cells)))
        return shortened


def fill(data: bytes, grades: Sequence[PublishedGrade], form: Form, options: FillOptions) -> Filled:
    """Return a grade file with the grades in the column of the lab.

    Raises InputError if it is not such a file.
    """
    file = _read_grade_file(data, form, options)
    header = file.table.titles[file.roles["grade"]]
    warnings = _check_maximum(file.maximum, f"{header!r} in {form.lms}", options)
    people = list(file.people.values())
    grade_of_row = _match_rows(people, [grade.student for grade in grades], form.lms)
    removed = set()
    changed = {}
    notes = []
    for index, (row, person) in enumerate(file.people.items()):
        new_row = None
        if index in grade_of_row:
            new_row, row_notes = file.changed(row, grades[grade_of_row[index]])
            notes += row_notes
        elif not _TEST_STUDENT.fullmatch(person.name or person.login):
            notes.append(_Note(_UNKNOWN, file.who(row), "matches no student for certain"))
        if not new_row:
            removed.add(row)
        elif new_row is not row:
            changed[row] = new_row
    notes += _notes_on_missing(grades, set(grade_of_row.values()), file)
    rows = [changed.get(row, row) for row in file.table.rows if row not in removed]
    if options.only and "maximum" not in file.roles:
        rows = file.only_column(rows)
    filled_table = file.table._replace(rows=tuple(rows))
    already = len(people) - len(removed) - len(changed)
    lines = [f"column {header!r}: {len(changed)} filled in, {already} already the same"]
    lines += _note_lines(notes) + warnings
    is_complete = all(note.kind in ("", _OPEN, _KEPT) for note in notes)
    numbers = {grades[at].student.key: people[row].moodle for row, at in grade_of_row.items()}
    return Filled(filled_table.encoded(), list(map(printable, lines)), is_complete, numbers)


def _notes_on_missing(
    grades: Sequence[PublishedGrade], matched: set[int], file: _GradeFile
) -> Iterator[_Note]:
    """Yield a note for each student with a grade or an excuse whom no row matches."""
    for index, grade in enumerate(grades):
        if index not in matched and _grade_text(grade, file):
            who = grade.student.label
            yield _Note(_MISSING, who, "has a grade or an excuse, but matches no row")


def _note_lines(notes: Sequence[_Note]) -> list[str]:
    """Return the lines of the changes, then those of the other notes by reason."""
    changes = [f"{note.who}: {note.why}" for note in notes if not note.kind]
    others = by_reason(note for note in notes if note.kind)
    return first_lines(changes, _MAX_CHANGES) + others


def by_reason(notes: Iterable[tuple[str, str, str]]) -> list[str]:
    """Return a line for each reason: who has it, of several how many and the first of them.

    Each note has the kind, who is concerned, and why.
    """
    concerned = defaultdict(list)
    for kind, who, why in notes:
        concerned[kind, why].append(who)
    lines = []
    for (kind, why), people in concerned.items():
        who = people[0]
        if len(people) > 1:
            who = f"{len(people)} ({people_text(people, _MAX_CONCERNED)})"
        lines.append(printable(": ".join(text for text in (kind, who, why) if text)))
    return first_lines(lines, _MAX_REASONS)


def _is_same_grade(old: str, new: str) -> bool:
    """Return whether two cells hold the same words or the same number: 9,5 is 9.50."""
    if old.casefold() == new.casefold():
        return True
    return number_in(old) is not None and number_in(old) == number_in(new)


def _grade_text(grade: PublishedGrade, file: _GradeFile) -> str:
    """Return the points with the file's comma, rounded down, or an excuse.

    99.996 of 100 is not the maximum.
    """
    if grade.total is None:
        return file.form.excuse if grade.is_excused else ""
    text = format(grade.total.quantize(Decimal("0.01"), ROUND_FLOOR), "f")
    if re.search(_COMMA, file.maximum):
        return text.replace(".", ",")
    return text


def _check_maximum(text: str, what: str, options: FillOptions) -> list[str]:
    """Return a warning about an unknown maximum.

    Raises InputError for another one: 9.33 of 100 is not 9.33 of 10.
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
    """Return a grade file.

    Raises InputError if it is another file, or if the column of the lab is ambiguous.
    """
    table = read_table(data, options.shown)
    roles = form.roles(table.titles)
    if not (roles.keys() >= {*form.needed} and roles.keys() & {*IDS}):
        has = _listed(table.titles) or "nothing"
        raise InputError(
            f"{options.shown} is not a grade file of {form.lms}: its first row has {has}"
        )
    columns = {}
    for at, title in enumerate(table.titles):
        header = form.grade.fullmatch(title)
        is_graded = "maximum" not in roles or at + 1 == roles["maximum"]
        if header and is_graded:
            columns[at] = header
    roles["grade"] = _choose(columns, form, options)
    points_row = None
    people = {}
    for row in table.rows[1:]:
        if not points_row and _POINTS_ROW in row.value(0):
            points_row = row
            continue
        student = _student_in(row, roles)
        if student != Student(""):
            people[row] = student
    maxima = [columns[roles["grade"]].groupdict().get("maximum")]
    if points_row:
        maxima.append(points_row.value(roles["grade"]))
    maxima += [row.value(roles.get("maximum")) for row in people]
    maximum = next(filter(None, maxima), "")
    return _GradeFile(table, form, roles, people, _THOUSANDS.sub("", maximum))


def _student_in(row: TableRow, roles: Mapping[str, int]) -> Student:
    """Return the student in a row."""
    login, sis, email, canvas, moodle, name = (
        row.value(roles.get(role)).removeprefix("#") for role in (*IDS, "name")
    )
    number = re.split(r"\D", moodle)[-1]  # of Participant 123
    return Student("", name, email, login, sis, canvas, number)


def _choose(columns: Mapping[int, re.Match[str]], form: Form, options: FillOptions) -> int:
    """Return the column that is named.

    Without a name, it is the one whose title is most like the title or the id of the lab.
    """
    wanted = options.column.strip()
    ranks = {}
    for at, header in columns.items():
        rank = _likeness(header, options)
        if rank is not None:
            ranks[at] = rank
    best = [at for at, rank in ranks.items() if rank == min(ranks.values())]
    if "maximum" in form.columns and not options.column:
        best = list(columns)
    if len(best) == 1:
        return best[0]
    listed = _listed([columns[at][0] for at in best or columns])
    if listed:
        advice = f"choose one with --column: {listed}"
    else:
        advice = f"create it in {form.lms}, and export again"
    problem = "has several columns" if best else "has no column"
    what = repr(wanted) if wanted else f"for {' or '.join(map(repr, options.names))}"
    raise InputError(f"{options.shown} {problem} {what}; {advice}")


def _likeness(header: re.Match[str], options: FillOptions) -> int | None:
    """Return how much a column is like the lab, 0 is best.

    It has the header, title or number that is wanted.

    Else its title is, or contains, each of the lab's names, in this order; last, it is part of one.
    """
    wanted = options.column.strip()
    if wanted:
        is_named = wanted in (header[0], header["title"], header.groupdict().get("number"))
        return 0 if is_named else None
    title = _spaced_words(header["title"])
    names = [_spaced_words(name) for name in options.names]
    for place, name in enumerate(names):
        if title.replace(" ", "") == name.replace(" ", ""):
            return 2 * place
        if name in title:
            return 2 * place + 1
    if any(title in name for name in names):
        return 2 * len(names)
    return None


def _spaced_words(text: str) -> str:
    """Return words between spaces: Lab 6: wheeled base contains lab6, Lab 61 does not."""
    return f" {' '.join(re.findall(_WORDS, text.casefold()))} "


def _listed(headers: Sequence[str]) -> str:
    return enumerated(map(repr, headers), _MAX_COLUMNS)


def _match_rows(rows: Sequence[Student], students: Sequence[Student], lms: str) -> dict[int, int]:
    """Return the student of each row that fits only one, whom no other row fits."""
    row_clues = [_clues(row, lms) for row in rows]
    student_clues = [_clues(student, lms) for student in students]
    students_of = _fitting(row_clues, student_clues)
    rows_of = _fitting(student_clues, row_clues)
    matches = {}
    for row, fitting in enumerate(students_of):
        if len(fitting) == 1 and rows_of[fitting[0]] == [row]:
            matches[row] = fitting[0]
    return matches


def _clues(student: Student, lms: str) -> _Clues:
    """Return what identifies a student, the most reliable first.

    These are the id in the LMS, other ids, and the name.

    Of a student who is not on the roster it is the id in the LMS alone, for who submits chooses the
    names.
    """
    lms_id = {"Canvas": student.canvas, "Moodle": student.moodle}.get(lms, "")
    ids = [student.key, student.login, student.sis, student.email]
    name = student.name
    if not student.is_on_roster:
        ids = []
        name = ""
    return [{*map(plain, kind)} - {""} for kind in ([lms_id], ids, [name])]


def _index_by_clue(
    people: Sequence[_Clues],
) -> defaultdict[tuple[int, str], set[int]]:
    """Return which people have a clue, by its kind and text."""
    having = defaultdict(set)
    for at, clues in enumerate(people):
        for kind, words in enumerate(clues):
            for word in words:
                having[kind, word].add(at)
    return having


def _fitting(some: Sequence[_Clues], others: Sequence[_Clues]) -> list[list[int]]:
    """Return the others that fit each of some.

    They have its most reliable clue that is known, and no other id in the LMS.
    """
    having = _index_by_clue(others)
    fitting = []
    for clues in some:
        candidates = set[int]()
        for kind, words in enumerate(clues):
            candidates.update(*(having[kind, word] for word in words))
            if candidates:
                break
        lms_id = clues[0]
        fitting.append(
            [
                at
                for at in sorted(candidates)
                if lms_id == others[at][0] or not (lms_id and others[at][0])
            ]
        )
    return fitting
