"""A class of 120 with awkward names, excuses and open grades, and its files as each LMS exports them."""

import csv
import io
from collections.abc import Mapping, Sequence
from decimal import Decimal

from grader.classroom.lms.fill import PublishedGrade
from grader.classroom.roster.roster import Student

NAMES = (
    "Zoë Ash",
    'Bo "Birch" O\'Neil',
    "Cedar, Jr.",
    "עץ ארז",
    "=1+1",
    "+Cedar",
    "@Ash",
    "Bjørk Løvtræ",
    "李 梣",
    "Ash;=2",
    "Birch & <Cedar>",
    "_Ash_77_",
)
STUDENTS = tuple(
    Student(
        f"s{n:03}",
        NAMES[n % len(NAMES)],
        f"s{n:03}@uni.example",
        f"s{n:03}",
        f"M{n:04}",
        str(1000 + n),
        str(5000 + n),
    )
    for n in range(120)
)


def graded(number: int) -> PublishedGrade:
    """Return the grade of a student: some are excused, some are open, the others have three decimals."""
    student = STUDENTS[number]
    if number % 17 == 3:
        return PublishedGrade(student, is_excused=True, why_open="excused")
    if number % 13 == 5:
        return PublishedGrade(student, why_open="nothing was submitted")
    total = Decimal(number * 37 % 1100) / 100 + Decimal("0.004") * (number % 3)
    return PublishedGrade(student, total, comment=f"<p>Well done, s{number:03}.</p>")


CLASS = tuple(map(graded, range(len(STUDENTS))))
CELLS = {
    one.student.key: "" if one.total is None else f"{int(one.total * 100) / 100:.2f}"
    for one in CLASS
}


def canvas_file(cells: Mapping[str, str], *, only: bool = False) -> bytes:
    """Return a gradebook of Canvas with these grades, by key; with other assignments and a computed column."""
    columns = (slice(0, 5), slice(6, 7)) if only else (slice(0, 9),)
    rows = [
        (
            "Student",
            "ID",
            "SIS User ID",
            "SIS Login ID",
            "Section",
            "Prelab (1)",
            "A small lab (2)",
            "Report (3)",
            "Final Score",
        ),
        ("    Points Possible", "", "", "", "", "10.00", "11.00", "20.00", "(read only)"),
    ]
    for one in _listed(cells):
        name = f'="{one.name}"' if one.name.startswith("=") else one.name
        rows.append(
            (name, one.canvas, one.sis, one.login, "S1", "9.00", cells[one.key], "EX", "87.5")
        )
    return _table([tuple(cell for part in columns for cell in row[part]) for row in rows]).encode()


def moodle_file(cells: Mapping[str, str], comments: Mapping[str, str]) -> bytes:
    """Return a grading worksheet of Moodle with these grades and comments, by key."""
    rows = [
        (
            "Identifier",
            "Full name",
            "Email address",
            "Status",
            "Grade",
            "Maximum grade",
            "Grade can be changed",
            "Last modified (submission)",
            "Last modified (grade)",
            "Feedback comments",
        ),
    ]
    for one in _listed(cells):
        about = (
            f"Participant {one.moodle}",
            one.name,
            one.email,
            "Submitted, for grading",
            cells[one.key],
            "11.00",
        )
        rows.append((*about, "Yes", "Friday, 1 May", "-", comments.get(one.key, "")))
    return _table(rows).encode("utf-8-sig")


def blackboard_file(cells: Mapping[str, str]) -> bytes:
    """Return a file of Blackboard: tabs and UTF-16, with another column and columns for comments."""
    rows = [
        (
            "Last Name",
            "First Name",
            "Username",
            "Student ID",
            "Last Access",
            "Prelab [Total Pts: 10 Score] |111",
            "A small lab [Total Pts: 11 Score] |222",
            "Total [Total Pts: up to 21 Score] |333",
            "Grading Notes",
        ),
    ]
    for one in _listed(cells):
        rows.append(
            (
                one.name,
                "",
                one.login,
                one.sis,
                "2026-09-10",
                "9.00",
                cells[one.key],
                "19.00",
                'mine\nonly, a "word"',
            )
        )
    return _table(rows, "\t").encode("utf-16")


def brightspace_file(cells: Mapping[str, str]) -> bytes:
    """Return an export of Brightspace, with another grade item."""
    rows = [
        (
            "OrgDefinedId",
            "Username",
            "Last Name",
            "First Name",
            "Email",
            "Prelab Points Grade <Numeric MaxPoints:10 Weight:5>",
            "A small lab Points Grade <Numeric MaxPoints:11>",
            "End-of-Line Indicator",
        ),
    ]
    for one in _listed(cells):
        rows.append(
            (f"#{one.sis}", f"#{one.login}", one.name, "", one.email, "9.00", cells[one.key], "#")
        )
    return _table(rows).encode("utf-8-sig")


def _listed(cells: Mapping[str, str]) -> list[Student]:
    return [one for one in reversed(STUDENTS) if one.key in cells]


def _table(rows: Sequence[tuple[str, ...]], delimiter: str = ",") -> str:
    text = io.StringIO(newline="")
    csv.writer(text, delimiter=delimiter, lineterminator="\r\n").writerows(rows)
    return text.getvalue()
