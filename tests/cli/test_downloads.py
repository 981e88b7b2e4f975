"""A class of 120 from the download of an LMS to its own file: awkward names, groups, lateness, extensions, resubmissions."""

import csv
import re
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

import pytest

from tests.classroom.gradebooks import grader, lab_text, urdf

SIZE = 120
GOOD, BAD = urdf(), urdf("1 1 2")  # 6 and 3 points
PENALTY = Decimal("1.1")  # for each day begun
FIRST_NAMES = ("Ann", "Jörg Ömer", "O'Neil-Zoë", "李", "Bea_7", "de la", "Ann")


@dataclass(frozen=True)
class Enrolled:
    """One student; everything about them follows from the number."""

    number: int

    @property
    def name(self) -> str:
        """The name, surname first."""
        return f"Ash{self.number}, {FIRST_NAMES[self.number % len(FIRST_NAMES)]}"

    @property
    def id(self) -> int:
        """The number in the LMS."""
        return 10_000 + self.number

    @property
    def group(self) -> str:
        """The group: ten groups of three, some of whose names end in a number as if it were a user's."""
        team = self.number // 3
        return "" if not 10 <= team < 20 else f"Team_{team}" if team % 2 else f"Team Ä-{team}"

    @property
    def submitter(self) -> int:
        """The number of the student whose submission counts; one member of a group has submitted alone as well."""
        is_shared = self.group and self.number != 31
        return self.number // 3 * 3 + 2 if is_shared else self.number

    @property
    def is_missing(self) -> bool:
        """Whether nobody submitted for the student."""
        return not self.group and self.number % 13 == 5

    @property
    def is_flagged(self) -> bool:
        """Whether the LMS says that it is late."""
        return self.submitter % 7 == 0

    @property
    def extension(self) -> str:
        """The extension on the roster, in days."""
        return "3" if self.number % 21 == 0 else ""

    @property
    def attempts(self) -> tuple[str, ...]:
        """The robots that were submitted: of two attempts the last one counts."""
        last = BAD if self.submitter % 4 == 0 else GOOD
        return (BAD if last == GOOD else GOOD, last) if self.submitter % 6 == 0 else (last,)

    def cell(self, days: int) -> str:
        """Return the grade in the LMS, for a late submission of so many days."""
        if self.is_missing:
            return ""
        late = days if self.is_flagged and not self.extension else 0
        return f"{(6 if self.attempts[-1] == GOOD else 3) - late * PENALTY:.2f}"


CLASS = tuple(map(Enrolled, range(SIZE)))
SUBMITTERS = [one for one in CLASS if not one.is_missing and one.submitter == one.number]


def canvas_files() -> dict[str, str]:
    """Return Canvas' download: of a group its name, as of content_zipper.rb, and the id of one member.

    Uploads have far larger numbers than users, as in Canvas: a name that ends in a number can be read in one way only.
    """
    files = {}
    for one in SUBMITTERS:
        shown = one.group if one.group and one.number != 31 else one.name
        plain = re.sub(r"\W", "", re.sub(r"_(\d+)_", r"\1", shown).lower())
        late = "_LATE" if one.is_flagged else ""
        for attempt, text in enumerate(one.attempts):
            again = f"-{attempt}" if attempt else ""
            files[f"submissions/{plain}{late}_{one.id}_{90_000_000 + 2 * one.number + attempt}_robot{again}.urdf"] = (
                text
            )
    return files


def moodle_files() -> dict[str, str]:
    """Return Moodle's download, which has the last attempt only."""
    return {
        f"Lab 6/{one.group or one.name}{'' if one.group else f'_{one.id}'}_assignsubmission_file/robot.urdf": one.attempts[
            -1
        ]
        for one in SUBMITTERS
        if one.number != 31
    }


def canvas_gradebook(cells: dict[int, str], more: str = "") -> str:
    """Return Canvas' gradebook with these grades, with columns that an instructor has added to use it as the roster."""
    lines = [f"Student,ID,SIS User ID,SIS Login ID,Section,A small lab (5){',group,extension' if more else ''}"]
    lines += [f"    Points Possible,,,,,6.00{',,' if more else ''}"]
    for one in CLASS:
        if one.id in cells:
            added = f',"{one.group}",{one.extension}' if more else ""
            lines.append(f'"{one.name}",{one.id},s{one.number},login{one.number},A,{cells[one.id]}{added}')
    return "\n".join(lines) + "\n"


def moodle_worksheet(more: bool = False) -> str:
    """Return Moodle's worksheet; lateness is in its Status."""
    lines = [f"Identifier,Full name,Email address,Status,Group,Grade,Maximum grade{',extension' if more else ''}"]
    for one in CLASS:
        status = "No submission" if one.is_missing else "Submitted for grading"
        status += " - 1 day 5 hours late" if one.is_flagged and not one.is_missing else ""
        about = f'Participant {one.id},"{one.name}",n{one.number}@example.org,{status},"{one.group}"'
        lines.append(f"{about},,6.00{f',{one.extension}' if more else ''}")
    return "\n".join(lines) + "\n"


def graded(top: Path, lms: str, files: dict[str, str], roster: str, given: str) -> dict[str, list[str]]:
    """Return the rows of the LMS's file by id, after grading the download and exporting the grades."""
    for name, text in files.items():
        (top / "class" / name).parent.mkdir(parents=True, exist_ok=True)
        (top / "class" / name).write_text(text)
    (top / "roster.csv").write_text(roster)
    (top / "lms.csv").write_text(given)
    (top / "small.toml").write_text(lab_text("percent_per_day = 10\n"))
    book = ("--gradebook", top / "book.db")
    done = grader(
        "batch", top / "class", *book, "--rubric", top / "small.toml", "--part", "robot", "--roster", top / "roster.csv"
    )
    assert done.returncode == 0, done.stderr
    assert f"layout {lms}" in done.stderr
    assert not [line for line in done.stderr.splitlines() if "unmatched" in line or "left unassigned" in line]
    done = grader("export", lms, *book, "--into", top / "lms.csv")
    assert done.returncode == 0, done.stderr
    column = 1 if lms == "canvas" else 0
    return {row[column]: row for row in csv.reader(done.stdout.splitlines())}


def test_from_a_canvas_download_to_the_gradebook(tmp_path: Path) -> None:
    """Every cell is that of a plain model, and every other cell is as it was."""
    nothing = dict.fromkeys((one.id for one in CLASS), "")
    rows = graded(tmp_path, "canvas", canvas_files(), canvas_gradebook(nothing, "more"), canvas_gradebook(nothing))
    expected = {one.id: one.cell(1) for one in CLASS if not one.is_missing}
    assert {int(row[1]): row[5] for row in rows.values() if row[1].isdecimal()} == expected
    given = {row[1]: row for row in csv.reader(canvas_gradebook(nothing).splitlines())}
    assert all(row[:5] == given[number][:5] for number, row in rows.items())


def test_from_a_moodle_download_to_the_worksheet(tmp_path: Path) -> None:
    """The same in Moodle, where the worksheet says how late: 1 day 5 hours are two days begun."""
    rows = graded(tmp_path, "moodle", moodle_files(), moodle_worksheet(more=True), moodle_worksheet())
    for one in CLASS:
        if not one.is_missing:
            counts = one if one.number != 31 else Enrolled(32)  # who has submitted for the group only
            assert rows[f"Participant {one.id}"][5] == counts.cell(2), one
    assert len(rows) == 1 + sum(not one.is_missing for one in CLASS)


@pytest.mark.parametrize("wanted", ["is_missing", "is_flagged", "extension", "group"])
def test_the_class_has_everything(wanted: str) -> None:
    """The class has enough of what the other tests are about."""
    assert sum(bool(getattr(one, wanted)) for one in CLASS) >= 5
    assert sum(bool(one.is_flagged and one.extension) for one in CLASS) >= 2
    assert sum(len(one.attempts) == 2 for one in SUBMITTERS) >= 10
