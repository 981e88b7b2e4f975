"""The students of a class, and which of them a name or id means.

The roster is a CSV file of a person or an LMS, whose columns are known by their titles. `People`
finds the students to whom a submission may belong: by an LMS's id, any other id, or a full name, in
this order.
"""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from operator import itemgetter
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.grouping import StringsByName
from grader.base.names import folded
from grader.base.patterns import on_use
from grader.base.text import counted, first_lines, named, printable_path
from grader.classroom.tables import rows_with_lines

_TITLES = {
    "id": "id userid key identifier identifiant identificador identificativo identificatie",
    "sis": "sis sisid sisuserid studentid studentnumber studentno idnumber matriculationnumber "
    "matrikelnummer"
    " idnummer númerodeid",
    "login": "login loginid username user sisloginid netid account",
    "github": "github githubusername githublogin githubuser githubid githubaccount",
    "name": "name fullname student studentname sortablename vollständigername nomcomplet "
    "nombrecompleto nomecompleto"
    " volledigenaam",
    "first": "first firstname firstnames givenname givennames forename vorname nombre",
    "last": "last lastname surname familyname nachname apellidos",
    "email": "email emailaddress mail sisemail emailadresse direccióndecorreo correoelectrónico",
    "canvas": "canvas canvasid canvasuserid",
    "moodle": "moodle moodleid participantid participant",
    "group": "group groupname team teamname gruppe",
    "section": "section class tutorial",
    "due": "due duedate dueat deadline dueuntil extendeduntil extensionuntil",
    "extension": "extension extensiondays extradays",
    "submitted": "submitted submittedat submissiontime",
    "late": "late islate dayslate latedays",
    "tokens": "tokens latetokens tokensleft",
    "status": "status",
    "submission": "submission",
}
_FIELD_OF = {title: field for field, titles in _TITLES.items() for title in titles.split()}
_WHO = frozenset({"id", "sis", "login", "github", "email", "name", "last", "canvas", "moodle"})
_UNIQUE = {
    "key": "id",
    "canvas": "canvas id",
    "moodle": "moodle id",
    "sis": "sis id",
    "login": "login",
    "email": "email address",
}
_TEST_STUDENT = ("student, test", "test student")  # whom Canvas makes for "View as Student"
_MAX_MISTAKES = 20
# Characters that count as spaces; Moodle removes the others from the names of files (moodlelib.php,
# PARAM_FILE).
_ALIKE = str.maketrans("_-", "  ", "&<>\"`|':\\/")
_PARTICIPANT = on_use(r"(?i:(?:part[ie]ci|teilnehm|deelnem)\D*)([0-9]+)")  # Moodle's Identifier
_DAYS = on_use(r"([0-9]{1,4}(?:[.,][0-9]{1,4})?)\s*(?:days?)?")
_LATE = {"yes": True, "true": True, "late": True, "no": False, "false": False, "on time": False}
# The form of a cell that is no time, and what to write in it.
_FORMS = {
    "canvas": ("[0-9]+", "a number"),
    "moodle": ("[0-9]+", "a number (put other ids in a column `id`)"),
    "email": (r"[^@\s]+@[^@\s]+", "an address with an @"),
    "late": (rf"{'|'.join(_LATE)}|{_DAYS.pattern}", "yes, no, or a number of days from 0"),
    "group": (
        r"(?!(?:none|n/a|null|nil|no group)\Z).*\w.*",
        "nothing for a student without a group",
    ),
    "tokens": (r"[0-9]{1,4}", "a whole number from 0"),
    "submission": (r"(?!/|(?:.*/)?\.\.(?:/|\Z)).+", "a path below the class folder"),
    "due": ("(?!)", "2026-09-01 or 2026-09-01T23:59"),
    "extension": (_DAYS.pattern, "a number of days from 0, or a date"),
    "submitted": ("(?!)", "2026-09-01T10:00"),
}
# moodle, mod/assign/gradingtable.php, col_status: parts with ` - ` between them, one of them `1 day
# 2 hours late`, from the deadline that Moodle knows. Other parts with a number have a colon:
# overdue by, extension granted until.
_UNITS = {"year": 365.0, "day": 1.0, "hour": 1 / 24, "min": 1 / 1440, "sec": 1 / 86400}
_UNIT = rf"([0-9]{{1,6}}) ({'|'.join(_UNITS)})s?"
# What identifies the student: an id of the LMS, another id as it is spelt, in another spelling or a
# name; a group.
_LMS_ID, _EXACT, _WORD, GROUP, _UNCLEAR = range(5)
_MAX_WORDS = 8
_Indices = Sequence[int]  # of students


class Student(NamedTuple):
    """A student of a class, whose `key` is unique in it.

    What is not known of the others is empty or None.
    """

    key: str
    name: str = ""
    email: str = ""
    login: str = ""
    sis: str = ""  # the id at the university
    canvas: str = ""  # the user id in Canvas
    moodle: str = ""  # the participant id in Moodle
    aliases: Sequence[str] = ()  # further logins, such as that of GitHub
    group: str = ""
    section: str = ""
    due: str = ""  # ISO 8601, as `submitted`
    submitted: str = ""
    extension_days: float = 0.0
    is_late: bool | None = None
    days_late: float | None = None
    tokens: int = 0  # days late that cost the student or the team nothing
    measured_by: str = ""  # the LMS that measured the days, from the deadline that it knows
    submission: str = ""  # the path that a person has assigned, relative to its class folder
    is_on_roster: bool = True  # False beside a roster that lacks the student

    @property
    def label(self) -> str:
        """The name with the key, or the key alone."""
        return named(self.key, self.name)

    @property
    def shown_name(self) -> str:
        """The name, else the key."""
        return self.name or self.key


class Roster(NamedTuple):
    """The students of a class in the order of the file, and what was not understood in it."""

    students: Sequence[Student]
    notes: Sequence[str] = ()


def plain(word: str) -> str:
    """Return an id, name or group without differences of case, spaces, `_` and `-`.

    `Doe, Jane` is Jane Doe.
    """
    if not word.isascii():
        word = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", word).casefold())
    last, _, first = word.casefold().translate(_ALIKE).partition(",")
    return " ".join(f"{first} {last}".replace(",", " ").split())


def read_roster(data: bytes, shown: str) -> Roster:
    """Return the roster in a CSV file, called `shown` in messages.

    Raises InputError with a line for each mistake.

    A student's key is the id, else the university's id, login, address, name, or LMS id.
    """
    rows = rows_with_lines(data, shown)
    _, header = next(rows, (1, []))
    fields = _fields(header, shown)
    is_canvas = _is_from_canvas(header)
    students = {}  # by the line
    mistakes = []
    notes = []
    for line, cells in rows:
        if len(cells) < len(fields) or any(cells[len(fields) :]):
            why = f"has {counted(len(cells), 'cell')}, but the first line has {len(fields)}"
            mistakes.append((line, why))
            continue
        row = _row(fields, cells)
        if is_canvas and _is_no_student_in_canvas(row):
            continue
        if is_canvas and not row["canvas"] and row["id"].isdecimal():
            row["canvas"] = row["id"]
        mistakes += ((line, why) for why in _normalise(row))
        students[line] = _student(row)
        if _is_lateness_unclear(students[line], row):
            notes.append(
                f"line {line} of {shown}: {row['status']!r} does not say clearly how late the "
                "submission is, and counts as late: add a column `late` with `no` or a number of "
                "days"
            )
    mistakes += _duplicates(students)
    lines = [f"line {line} of {shown} {why}" for line, why in sorted(mistakes, key=itemgetter(0))]
    if not lines and not students:
        lines = [f"{shown} has no students"]
    if lines:
        raise InputError("\n".join(first_lines(lines, _MAX_MISTAKES)))
    return Roster(tuple(students.values()), tuple(first_lines(notes, _MAX_MISTAKES)))


def _is_lateness_unclear(student: Student, row: StringsByName) -> bool:
    """Return whether a student is late, and neither column of the row says by how many days."""
    has_days = bool(row["late"]) or _read_days(row["status"]) is not None
    return bool(student.is_late) and student.days_late is None and not has_days


def _fields(header: Sequence[str], shown: str) -> list[str]:
    """Return the field of each column, empty for one of another title.

    Raises InputError if none of them identifies a student.
    """
    fields = [_FIELD_OF.get(folded(title), "") for title in header]
    if header and _WHO.isdisjoint(fields):
        titles = ", ".join(filter(None, header))[:200]
        raise InputError(
            f"{shown} has no column for an id, login, name or email in its first line, "
            f"only: {titles}"
        )
    return fields


def _is_from_canvas(header: Iterable[str]) -> bool:
    titles = [folded(title) for title in header]
    return {"student", "id"} <= {*titles} and any(title.startswith("sis") for title in titles)


def _row(fields: Sequence[str], cells: Sequence[str]) -> dict[str, str]:
    """Return the cells of a row by field.

    Of several columns for one field the first counts that is not empty.
    """
    row = dict.fromkeys(_TITLES, "")
    for field, cell in zip(fields, cells, strict=False):
        row[field] = row.get(field) or cell
    return row


def _is_no_student_in_canvas(row: StringsByName) -> bool:
    """Return whether a row of Canvas has its test student, or the points possible."""
    has_id = row["id"] or row["sis"] or row["login"]
    return row["name"].casefold() in _TEST_STUDENT or not has_id


def _normalise(row: dict[str, str]) -> Iterator[str]:
    """Move Moodle's numbers to their field, and write times as ISO 8601.

    Empty the cells that are wrong, and yield why.
    """
    for field in ("id", "moodle"):
        if match := _PARTICIPANT.fullmatch(row[field]):
            row[field], row["moodle"] = "", match[1]
    if not any(map(row.__getitem__, _WHO)):
        yield "has no id, login, name or email address: add one of them"
    if row["due"] and iso_time(row["extension"]):
        yield (
            f"has both {row['due']!r} for due and {row['extension']!r} for extension: write one "
            "date"
        )
    for field, (pattern, meant) in _FORMS.items():
        time = iso_time(row[field]) if field in ("due", "extension", "submitted") else ""
        if row[field] and not time and not re.fullmatch(pattern, row[field], re.IGNORECASE):
            yield f"has {row[field]!r} for {_UNIQUE.get(field, field)}: write {meant}"
            row[field] = ""
        row[field] = time or row[field]


def _student(row: dict[str, str]) -> Student:
    """Return the student in a row with values as they should be.

    The student has no key if the row identifies none.
    """
    name = row["name"] or f"{row['first']} {row['last']}".strip()
    login = row["login"] or row["github"]
    sis = row["sis"]
    if not sis and row["id"] != row["canvas"]:
        sis = row["id"]
    identifying = (row["id"], row["sis"], login, row["email"], name, row["canvas"], row["moodle"])
    due = row["due"]
    extension_days = _days(row["extension"])
    if extension_days is None:  # the column may have a date instead of days
        due = due or row["extension"]
        extension_days = 0.0
    is_late, days_late, measured_by = _lateness(row, extension_days)
    return Student(
        key=printable_path(next(filter(None, identifying), "")),
        name=name,
        email=row["email"],
        login=login,
        sis=sis,
        canvas=row["canvas"],
        moodle=row["moodle"],
        aliases=(row["github"],) if row["github"] else (),
        group=row["group"],
        section=row["section"],
        due=due,
        submitted=row["submitted"],
        extension_days=extension_days,
        is_late=is_late,
        days_late=days_late,
        tokens=int(row["tokens"] or 0),
        measured_by=measured_by,
        submission=row["submission"].strip("/"),
    )


def _lateness(row: StringsByName, extension_days: float) -> tuple[bool | None, float | None, str]:
    """Return whether a submission is late, by how many days, and the LMS that measured them."""
    status = _read_days(row["status"])
    if row["moodle"] and not (row["late"] or row["submitted"]) and status != 0:
        if status is None:
            return True, None, ""
        # Moodle does not know this extension.
        return status > extension_days, max(0.0, status - extension_days), "Moodle"
    days = _days(row["late"])
    if days is not None:
        return days > 0, days, ""
    return _LATE.get(row["late"].casefold()), None, ""


def _days(text: str) -> float | None:
    days = _DAYS.fullmatch(text)
    if days:
        return float(days[1].replace(",", "."))
    return None


def _read_days(status: str) -> float | None:
    """Return by how many days Moodle's Status says that a submission was late.

    It is None if that is not clear.
    """
    for part in map(str.strip, status.casefold().split(" - ")):
        if re.fullmatch(rf"{_UNIT}(?: {_UNIT})? late", part):
            return sum(int(number) * _UNITS[unit] for number, unit in re.findall(_UNIT, part))
        if re.search(r"\d|\blate\b", part) and ":" not in part:
            return None
    return 0.0


def _duplicates(students: Mapping[int, Student]) -> Iterator[tuple[int, str]]:
    """Yield a line and a message for each duplicate.

    It is a student with an id or address that another student has.
    """
    wrong = set()
    for field, title in _UNIQUE.items():
        first: dict[str, int] = {}
        for line, student in students.items():
            word = getattr(student, field)
            if not word:
                continue
            other = first.setdefault(word if field == "key" else word.casefold(), line)
            if other != line and line not in wrong:
                wrong.add(line)
                yield line, f"repeats the {title} {word} of line {other}"


def iso_time(text: str) -> str:
    """Return a date or time as ISO 8601, to the second if it has seconds; empty if it is neither.

    A time without a zone gets none.
    """
    zoned = (
        re.sub(r"(?<!\s)\s*+(?:UTC|UCT|GMT|Z)\Z", "+00:00", text.strip()) if ":" in text else text
    )
    try:
        time = datetime.fromisoformat(re.sub(r"(?<!\s)\s++(?=[+-][0-9:]+\Z)", "", zoned))
    except ValueError:
        return ""
    if ":" not in text:
        if len(text) == len("2026-09-01"):
            return time.date().isoformat()
        return ""
    precision = "seconds" if re.search(":[0-9]+:", text) else "minutes"
    return time.isoformat(timespec=precision).replace("+00:00", "Z")


class _Match(NamedTuple):
    """The indices of the students that a submission may belong to, and by what."""

    students: _Indices = ()
    by: int = _UNCLEAR

    @property
    def owners(self) -> _Indices:
        """The student whom it belongs to, or each member of its group.

        It is empty if that is not certain.
        """
        if self.by == GROUP or (len(self.students) == 1 and self.by < GROUP):
            return self.students
        return ()


class People:
    """The students on a roster, by ids, names and groups."""

    def __init__(self, students: Sequence[Student]) -> None:
        self.students = students
        self._known: Sequence[dict[str, tuple[int, ...]]] = ({}, {}, {}, {})
        self._groups = defaultdict(list)
        lms_ids, exact, words, names = self._known
        for index, student in enumerate(students):
            own_index = (index,)  # kept once for all words that only this student has
            ids = [student.key, student.login, student.sis, student.email, *student.aliases]
            user = student.email.partition("@")[0]
            spellings = (plain(student.name), plain(user), _surname(student.name))
            _add(own_index, _lms_ids(student), lms_ids)
            _add(own_index, ids, exact)
            _add(own_index, map(plain, ids), words)
            _add(own_index, (*spellings, *_in_canvas(student.name)), names)
            for word in {plain(student.group), letters(student.group)} - {""}:
                self._groups[word].append(index)

    def members(self, group: str) -> _Indices:
        """Return the students of a group."""
        return self._groups.get(plain(group), ())

    def knows(self, name: str, team: str = "") -> bool:
        """Return whether a name is that of one student, or else of a group.

        In a team it may also be the surname.
        """
        return bool(self.match(Student(name, login=name, group=team)).owners)

    def match(self, claim: Student) -> _Match:
        """Return whose a submission is by what its name claims.

        With a `group`, it is only that of a member of that team.

        What has the name of a group is the group's, unless an id in it is that of another student:
        Canvas writes the id of a member, Moodle a number of the group's own. Of `aliases` it is not
        clear which is the user's id.
        """
        if claim.aliases:
            return self._one_of_users(claim)
        name = letters(claim.name) if claim.canvas else plain(claim.name or claim.login)
        matched = self._person(claim, name)
        group = [] if claim.group else self._groups.get(name, [])
        is_own_name = matched.by == _LMS_ID and matched.students[0] in self._known[-1].get(name, ())
        if is_own_name or not {*group}.difference(matched.students):
            return matched
        if matched.by == _LMS_ID and claim.canvas:
            if matched.students[0] in group:
                return _Match(tuple(group), GROUP)
            return matched
        if matched.students or (
            claim.canvas and any(self.students[index].canvas for index in group)
        ):
            return _Match(tuple(sorted({*matched.students, *group})))
        return _Match(tuple(group), GROUP)

    def _one_of_users(self, claim: Student) -> _Match:
        """Return the student whose id is among the aliases of a claim, after the student's name.

        Without one, it is not clear which of the aliases is the user's id.
        """
        users = self._having([f"canvas {user}" for user in claim.aliases], self._known[_LMS_ID])
        named = []
        for index in users:
            name = claim.name.partition(f"_{self.students[index].canvas}")[0]
            if index in self._known[-1].get(letters(name), ()):
                named.append(index)
        if len(named) == 1:
            return _Match(tuple(named), _LMS_ID)
        return _Match(users)

    def _person(self, claim: Student, name: str) -> _Match:
        """Return the students with the best words of a claim.

        Those whom the LMS knows by another id are not among them.
        """
        login = plain(claim.login)
        names = [name, login, _surname(login) if claim.group else ""]
        ranked = (_lms_ids(claim), [unicodedata.normalize("NFC", claim.login)], [login], names)
        team = self.members(claim.group)
        for by, (words, table) in enumerate(zip(ranked, self._known, strict=True)):
            having = self._having(words, table)
            if claim.group:
                having = tuple(index for index in having if index in team)
            if having:
                students = [at for at in having if not _has_other_lms_id(self.students[at], claim)]
                return _Match(tuple(students), min(by, _WORD))
        return _Match()

    def _having(self, words: Iterable[str], table: Mapping[str, tuple[int, ...]]) -> _Indices:
        return tuple(sorted({index for word in words for index in table.get(word, ())}))


def _add(own_index: tuple[int], words: Iterable[str], table: dict[str, tuple[int, ...]]) -> None:
    """Add the index of a student to a table of those who have a word."""
    for word in filter(None, words):
        composed = unicodedata.normalize("NFC", word)
        if composed not in table:
            table[composed] = own_index
        elif table[composed][-1:] != own_index:
            table[composed] += own_index


def _has_other_lms_id(student: Student, claim: Student) -> bool:
    """Return whether the LMS knows a student by another id than that in a claim."""
    ids = ((student.canvas, claim.canvas), (student.moodle, claim.moodle))
    return any(own_id and given and own_id != given for own_id, given in ids)


def _lms_ids(student: Student) -> list[str]:
    ids = []
    if student.canvas:
        ids.append(f"canvas {student.canvas}")
    if student.moodle:
        ids.append(f"moodle {student.moodle}")
    return ids


def _surname(name: str) -> str:
    last, comma, _ = name.partition(",")
    word = plain(last if comma else last.rpartition(" ")[2])
    return f"surname\n{word}" if word else ""


def letters(name: str) -> str:
    """Return a name as Canvas writes it into names of files (canvas-lms, content_zipper.rb)."""
    composed = re.sub(r"_(\d+)_", r"\1", unicodedata.normalize("NFC", name))
    letters = re.sub(r"\W", "", composed).casefold()
    return f"canvas\n{letters}" if letters else ""


def _in_canvas(name: str) -> Iterable[str]:
    """Return what Canvas may call a student in names of files.

    It is sorted by any word of the name, or as the user set.
    """
    words = name.split()[:_MAX_WORDS]
    if "," in name:
        orders = [name]
    else:
        orders = [" ".join(words[index:] + words[:index]) for index in range(len(words))]
    return map(letters, orders)
