"""The headline of every report that a class's run writes is the grade that counts; below it is how that came about."""

import json
import re
from collections.abc import Mapping
from pathlib import Path

import jsonschema
import pytest

from grader.report.formats import Format
from tests.classroom.gradebooks import batch, grader, lab_text
from tests.command_line import run
from tests.report.readers import FINDINGS

FORMATS = [kind for kind in Format if kind is not Format.CLASSROOM50]
DECIDED = 6  # of 11 points, 5 of which need manual grading
WITH_HEADLINE = [kind for kind in FORMATS if kind not in {Format.JSON, *FINDINGS}]


def reports(top: Path, key: str, rubric: Path | None = None) -> Mapping[Format, str]:
    """Return the report on a student in every format that a class's run writes, with single spaces."""
    options = [option for kind in FORMATS for option in ("--report-format", kind)]
    done = batch(top, "--reports", top / "out", *options, rubric=rubric)
    assert done.returncode == 0, done.stderr
    return {
        kind: " ".join((top / "out" / f"{key}.{kind.ending}").read_text("utf-8").split())
        for kind in FORMATS
    }


def headline(kind: Format, text: str) -> str:
    """Return what a report of this format shows first, or as its score: 9 / 11."""
    patterns = {
        Format.TERMINAL: r" (\S+/\S+|Excused) A small lab",
        Format.MARKDOWN: r"\A# small: .*? \*\*(?:All automatic checks passed: |No mistakes found: )?(\S+ (?:/|of) \S+|Excused)",
        Format.JUNIT: r"<system-out>small: .*?\) (?:All automatic checks passed: |No mistakes found: )?(\S+ (?:/|of) \S+|Excused)",
        Format.GITHUB: r"\A::notice title=(.*?)(?: points)?%3A",
        Format.HTML: r'class="score"><strong>(.*?)(?: points)?</p>',
        Format.SVG: r"A small lab: (.*?)(?: points)?<",
        Format.GRADESCOPE: r'"output": "# small: .*?\*\*(?:All automatic checks passed: |No mistakes found: )?(\S+ (?:/|of) \S+|Excused)',
    }
    found = re.search(patterns[kind], text)
    assert found, (kind, text[:400])
    return re.sub(r" ?/ ?", " / ", found[1].replace("</strong>", ""))


def assert_headlines(
    found: Mapping[Format, str], expected: str, how: str, score: float, grade: object
) -> None:
    """Check the headline of every format, the line below it, and the keys of the formats for programs."""
    decided = f"{score} of {DECIDED}"  # where there is no grade, a sentence has the points of what is decided
    assert {headline(kind, found[kind]) for kind in WITH_HEADLINE} <= {
        expected,
        decided if grade is None else expected,
    }
    for kind in WITH_HEADLINE if how else ():
        assert how in found[kind], kind
    data = json.loads(found[Format.JSON])
    jsonschema.validate(data, json.loads(run(("schema", "report")).stdout))
    assert (data["score"], data.get("grade")) == (score, grade)
    counting = json.loads(found[Format.GRADESCOPE])["score"]
    assert counting == (float(expected.partition(" ")[0]) if "/" in expected else score)


def test_a_final_mark_is_the_headline(top: Path) -> None:
    """In all formats; a grade without a person and without a penalty is the score, without another key."""
    assert_headlines(reports(top, "anna"), "6 / 11", "", 6, None)
    assert grader("mark", "anna", "total", "3.5", "--gradebook", top / "book").returncode == 0
    expected = {"points": 3.5, "late": 0, "final": True}
    found = reports(top, "anna")
    assert_headlines(found, "3.5 / 11", "Final mark, instead of 6 automatic points.", 6, expected)
    assert "5 points need manual grading" not in found[Format.MARKDOWN]
    assert grader("mark", "dora", "total", "2", "--gradebook", top / "book").returncode == 0
    expected = {"points": 2, "late": 0, "final": True}
    assert_headlines(
        reports(top, "dora"), "2 / 11", "Final mark, instead of 0 automatic points.", 0, expected
    )


@pytest.mark.slow
def test_manual_marks_are_in_the_headline(top: Path) -> None:
    """Manual marks count in the headline, and the line below it separates them from the automatic points."""
    assert grader("mark", "anna", "essay", "3", "--gradebook", top / "book").returncode == 0
    expected = {"points": 9, "late": 0, "final": False}
    found = reports(top, "anna")
    assert_headlines(found, "9 / 11", "Points: 6 automatic + 3 manual.", 9, expected)
    assert "1 point needs manual grading" in found[Format.MARKDOWN]


@pytest.mark.slow
def test_the_late_penalty_is_in_the_headline(top: Path) -> None:
    """The headline includes the late penalty, unlike the score of the criteria."""
    (top / "late.toml").write_text(
        lab_text("due = 2020-01-01T00:00:00+00:00\npercent_per_day = 10", essay="4")
    )
    roster = (top / "roster.csv").read_text().splitlines()
    lines = [
        f"{line},{'late' if number == 0 else '2' if line.startswith('anna') else '0'}"
        for number, line in enumerate(roster)
    ]
    (top / "roster.csv").write_text("\n".join(lines) + "\n")
    found = reports(top, "anna", top / "late.toml")
    expected = {"points": 3.8, "late": -2.2, "final": False}
    assert_headlines(found, "3.8 / 11", "Points: 6 automatic - 2.2 late.", 6, expected)


@pytest.mark.slow
def test_an_excused_student_has_no_points_in_the_headline(top: Path) -> None:
    """The headline of an excused student has no points, whatever the criteria give."""
    assert grader("mark", "anna", "total", "excused", "--gradebook", top / "book").returncode == 0
    expected = {"points": None, "late": 0, "final": False}
    assert_headlines(
        reports(top, "anna"),
        "Excused",
        "Excused; the criteria give 6 automatic points.",
        6,
        expected,
    )


def test_points_that_need_manual_grading_are_a_dash(top: Path) -> None:
    """Never 0 of their maximum, in a criterion, in a group of nothing else, and in the comment for an LMS."""
    found = reports(top, "anna")
    for kind in (Format.TERMINAL, Format.MARKDOWN, Format.HTML, Format.JUNIT, Format.GRADESCOPE):
        assert not re.search(r"\b0/[14]\b|\b0 / [14]\b", found[kind]), kind
    assert (
        "–/4" in found[Format.MARKDOWN]
        and "–/5" in found[Format.HTML]
        and "–/1" in found[Format.JUNIT]
    )
    shown = run(
        ("grade", top / "class" / "anna", "--rubric", top / "small.toml", "--verbose")
    ).stdout.decode()
    assert "essay  –/4" in shown and "picture  –/1" in shown and "Report  –/5" in shown
    worksheet = "Identifier,Full name,Email address,Grade,Maximum Grade,Feedback comments\nParticipant 7,Anna Ek,anna@example.org,,11,\n"
    (top / "sheet.csv").write_text(worksheet)
    done = grader(
        "export",
        "moodle",
        "--gradebook",
        top / "book",
        "--into",
        top / "sheet.csv",
        "--output",
        top / "up.csv",
        "--pending-as-zero",
    )
    assert done.returncode == 0, done.stderr
    assert "<li>– of 4 (counted as 0 for now): About essay: " in (top / "up.csv").read_text("utf-8")
