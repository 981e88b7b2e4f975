"""A class of 150 from three downloads: each cell of its tables, exports and figures as a second program computes it."""

import csv
import io
import json
import shutil
import sys
from collections.abc import Iterator
from datetime import datetime, timedelta
from decimal import Decimal
from pathlib import Path
from random import Random
from typing import Any

import pytest

from tests.classroom import second_program
from tests.classroom.class_runs import grader, report_in_process, without_hints
from tests.classroom.second_program import Policy, Row, cells_of, published
from tests.samples import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
import class_generator as made_up

pytestmark = pytest.mark.exhaustive

STUDENTS, SECTIONS = 150, "ABC"
DUE = datetime.fromisoformat("2026-11-20T23:59:59.999999+01:00")
POLICY = Policy(DUE, timedelta(minutes=15), Decimal(10), Decimal(50))
COLUMNS = (
    "id",
    "name",
    "email",
    "login",
    "section",
    "canvas id",
    "moodle id",
    "due",
    "submitted",
    "late",
)


class Class150:
    """The class on disk, its gradebook, and what the second program reads."""

    def __init__(self, top: Path) -> None:
        self.top, self.book, self.dice = top, top / "book", Random(59)
        shutil.copytree(without_hints().parent, top / "lab")
        self.rubric = top / "lab" / without_hints().name
        policy = "\n[late]\ngrace_minutes = 15\npercent_per_day = 10\nfloor_percent = 50\n"
        self.rubric.write_text(self.rubric.read_text(encoding="utf-8") + policy, encoding="utf-8")
        self.students, self.reports = list[Row](), dict[str, Any]()
        for number, one in enumerate(made_up.submissions(STUDENTS, 59, "urdf")):
            self._add(number, one)
        text = io.StringIO()
        writer = csv.DictWriter(text, COLUMNS)
        writer.writeheader()
        writer.writerows(self.students)
        (top / "roster.csv").write_text(text.getvalue(), encoding="utf-8")
        paths = [top / layout for layout in made_up.LAYOUTS]
        due = ("--due", "2026-11-20T23:59+01:00", "--roster", top / "roster.csv")
        done = grader("batch", *paths, "--gradebook", self.book, "--rubric", self.rubric, *due)
        assert done.returncode == 0, done.stderr
        self._mark()

    def _add(self, number: int, one: Any) -> None:
        """Write a submission into one of the three downloads, and grade it alone; every tenth student has none."""
        dice, who, layout = self.dice, one.person, made_up.LAYOUTS[number % 3]
        row = dict.fromkeys(COLUMNS, "") | {
            "id": f"S{number:03}",
            "name": who.name,
            "email": f"{who.login}@example.org",
        }
        row |= {
            "login": who.login,
            "section": SECTIONS[number % 3],
            "canvas id": str(100_000 + who.number),
        }
        row |= {
            "moodle id": str(5_000_000 + who.number),
            "late": dice.choice(["", "", "", "yes", "0", "2", "9"]),
        }
        if number % 4 == 0:
            late = timedelta(minutes=dice.choice([-600, -1, 0, 14, 16, 1500, 4000, 20_000]))
            row |= {
                "submitted": (DUE.replace(second=0, microsecond=0) + late).isoformat(),
                "late": "",
            }
        if number % 8 == 0:
            row["due"] = "2026-11-22T12:00:00+01:00"
        self.students.append(row)
        if number % 10 == 9:
            return
        (self.top / layout).mkdir(exist_ok=True)
        for item in made_up._PLACING[layout](one):
            made_up.write(str(self.top / layout), item)
        alone = self.top / "alone" / f"S{number:03}"
        alone.mkdir(parents=True)
        (alone / "my_robot.urdf").write_bytes(
            next(item.data for item in one.attempts[-1] if item.data)
        )
        code, data = report_in_process(
            alone, self.top / "report.json", "--rubric", str(self.rubric)
        )
        assert code in (0, 1), data
        self.reports[row["id"]] = json.loads(data)

    def _mark(self) -> None:
        """Give marks of all kinds, some of them twice or withdrawn, in files as commands and people write them."""
        dice, rows = self.dice, list[dict[str, str]]()
        for student, report in self.reports.items():
            worth = {one["id"]: Decimal(str(one["max_points"])) for one in report["results"]}
            open_ones = [one["id"] for one in report["results"] if one["status"] == "pending"]
            chosen = [name for name in open_ones if dice.random() < 0.9] + dice.sample(
                sorted(worth), dice.randrange(3)
            )
            for name in chosen:
                points = second_program.plain(
                    worth[name]
                    * dice.choice([Decimal(0), Decimal(1), Decimal("0.5"), Decimal("0.25")])
                )
                rows.append({"student": student, "criterion": name, "points": points})
        for row in self.students:
            if dice.random() < 0.1:
                points = dice.choice(["0", "61.5", "excused", "99.996"])
                rows.append({"student": row["id"], "criterion": "total", "points": points})
            if row["submitted"] and dice.random() < 0.3:
                when = "2026-11-23T08:00:00+01:00"
                rows.append({"student": row["id"], "criterion": "deadline", "points": when})
        again = [{**row, "points": "-"} for row in rows if dice.random() < 0.05]
        self.marks: list[Row] = [
            *{(row["student"], row["criterion"]): row for row in rows}.values()
        ]
        for part in (self.marks, again):
            text = "student,criterion,points\n" + "".join(
                f"{one['student']},{one['criterion']},{one['points']}\n"
                for one in {(one["student"], one["criterion"]): one for one in part}.values()
            )
            (self.top / "marks.csv").write_text(text)
            done = grader("mark", "--import", self.top / "marks.csv", "--gradebook", self.book)
            assert done.returncode == 0, done.stderr
        self.marks += again

    def expected(self) -> Iterator[dict[str, str]]:
        """Yield the cells of each student, as the second program has them."""
        for student in self.students:
            cells = cells_of(student, self.reports.get(student["id"]), self.marks, POLICY)
            yield {key: value for key, value in cells.items() if value}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Class150:
    """Return the class, graded and marked."""
    return Class150(tmp_path_factory.mktemp("class-of-150"))


def _rows(text: str) -> list[dict[str, str]]:
    kept = ("not_final_because", "submission", "exported")
    rows = csv.DictReader(io.StringIO(text))
    return [{key: value for key, value in row.items() if value and key not in kept} for row in rows]


def test_each_cell_of_the_tables(made: Class150) -> None:
    """`grades.csv` and `export csv` have the cells that the second program computes, and no others."""
    expected = sorted(made.expected(), key=lambda row: row["id"])
    assert len(expected) == STUDENTS
    assert _rows((made.book / "grades.csv").read_text(encoding="utf-8")) == expected
    assert _rows(grader("export", "csv", "--gradebook", made.book).stdout) == expected


def test_each_cell_of_an_lms(made: Class150) -> None:
    """Canvas gets the grades that are final, rounded down, and excuses; no row of another student."""
    rows = [("Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Lab 6 (98765)")]
    rows.append(("    Points Possible", "", "", "", "", "100"))
    rows += [(row["name"], row["canvas id"], "", row["login"], "S", "") for row in made.students]
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    (made.top / "canvas.csv").write_text(text.getvalue(), encoding="utf-8")
    done = grader("export", "canvas", "--gradebook", made.book, "--into", made.top / "canvas.csv")
    assert done.returncode == 0, done.stderr
    found = {
        row["ID"]: row["Lab 6 (98765)"]
        for row in csv.DictReader(io.StringIO(done.stdout))
        if row["ID"]
    }
    ids = {row["id"]: row["canvas id"] for row in made.students}
    wanted = {
        ids[one["id"]]: "EX" if one["status"] == "excused" else published(one)
        for one in made.expected()
    }
    assert found == {key: text for key, text in wanted.items() if text}
    assert {"EX", "99.99"} <= {*found.values()}


def test_each_figure(made: Class150) -> None:
    """Mean and median of all and of each section, the tenths, and the students by status."""
    data = json.loads(grader("stats", "--gradebook", made.book, "--format", "json").stdout)[
        "statistics"
    ]
    rows = [*made.expected()]
    counted = [row for row in rows if row["status"] == "graded" or "grade" in row]
    for name in (None, *SECTIONS):
        totals = [Decimal(row["grade"]) for row in counted if name in (None, row["section"])]
        found = data["grades"] if name is None else data["sections"][name]
        mean, middle = second_program.summary(totals)
        assert (found["students"], found["mean"], found["median"]) == (
            len(totals),
            pytest.approx(mean),
            pytest.approx(middle),
        )
    tenths = [min(9, int(Decimal(row["grade"]) // 10)) for row in counted]
    assert data["tenths"] == [tenths.count(tenth) for tenth in range(10)]
    statuses = [row["status"] for row in rows]
    assert data["counts"] == {name: statuses.count(name) for name in sorted({*statuses})}


def test_an_import_of_the_export_changes_nothing(made: Class150) -> None:
    """The table that was exported has no new marks; where a cell was changed it has one."""
    table = made.top / "exported.csv"
    table.write_bytes(grader("export", "csv", "--gradebook", made.book, "--excel").stdout.encode())
    before = (made.book / "grades.csv").read_bytes()
    done = grader("mark", "--import", table, "--gradebook", made.book)
    assert done.stdout.endswith(": 0 recorded, 0 the same as before\n"), done.stderr
    assert (made.book / "grades.csv").read_bytes() == before
