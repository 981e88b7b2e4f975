"""The class's page: statistics, common edits with small pictures of a robot, and a table of students with links."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

from lxml import etree
from markupsafe import Markup

from grader import __version__
from grader.classroom.gradebook.criterion_statistics import CriterionStatistics
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.hints import CommonFix
from grader.classroom.gradebook.statistics import ClassStatistics, members
from grader.classroom.gradebook.summary import ClassSummary
from grader.drawing.curves import SIDE, TOP
from grader.drawing.picture import Picture, picture_of
from grader.grading.report import Report
from grader.report import class_words as words
from grader.report.drawing import thumbnail_element
from grader.report.pages.class_rows import columns, group_data, row_groups, student_rows
from grader.report.pages.robot import RULES
from grader.report.pages.shell import Assets, render_page
from grader.robot.transforms import dot
from grader.text import counted, format_points

_SAME_WAY = 0.9  # cosine


def thumbnail(report: Report, criteria: Collection[str]) -> str:
    """Return a picture of a graded robot as SVG, with the differences that some criteria are about.

    It is empty if none of them is about a link, or if the robot can no longer be read.
    """
    picture = picture_of(report)
    shown = _about(picture, criteria) if picture is not None else None
    if shown is None or not any(callout.link for callout in shown.callouts):
        return ""
    element = thumbnail_element(shown, TOP if _drives_elsewhere(shown) else SIDE)
    return str(etree.tostring(element, encoding="unicode"))


def _about(picture: Picture, criteria: Collection[str]) -> Picture:
    """Return a picture with only those differences from the reference that some criteria are about.

    A frame is shown only if neither a shape nor an arrow shows the difference.
    """
    callouts = tuple(
        callout for callout in picture.callouts if any(result.criterion.id in criteria for result in callout.results)
    )
    links = {callout.link for callout in callouts}
    wheels = links.intersection(wheel.link for wheel in picture.scene.wheels)
    outlines = tuple(body for body in picture.outlines if body.link in links)
    seen = wheels.union(body.link for body in outlines)
    return replace(
        picture,
        scene=picture.scene if wheels else replace(picture.scene, wheels=()),
        outlines=outlines,
        frames=tuple(link for link in picture.frames if link in links - seen),
        callouts=callouts,
    )


def _drives_elsewhere(picture: Picture) -> bool:
    """Return whether a wheel drives in another direction than the reference's, which is visible from above."""
    wheels = picture.reference.wheels if picture.reference is not None else ()
    expected = {wheel.link: wheel.travel for wheel in wheels if wheel.travel is not None}
    return any(
        wheel.travel is None or dot(wheel.travel, expected[wheel.link]) < _SAME_WAY
        for wheel in picture.scene.wheels
        if wheel.link in expected
    )


MAX_DRAWINGS = words.MAX_LISTED
_MAX_ATTENTION = 100  # students for one reason
_ELEMENTS = {"-": "del", "+": "ins"}  # of a line of an edit, by its sign
_COUNTS = {
    **{f"status-{verdict}": text for verdict, text in words.VERDICTS.items()},
    "pending": "with points that need manual grading",
    "late": "late",
    "final": "with a final mark",
    "excused": "excused",
}  # in the head of the page, by group


def render_class_page(
    summary: ClassSummary, grades: Grades, links: Mapping[str, str], drawings: Mapping[str, str]
) -> str:
    """Return the class's page.

    Args:
        summary: The summary of the class, with its edits.
        grades: The grades of the students.
        links: The address of each student's page by key, relative to this page.
        drawings: A picture of a robot that needs an edit, as SVG, by the action of the edit.
    """
    all_grades = list(grades.all())
    counted_in = members(grades.book, summary.rubric, summary.statistics)
    rows = student_rows(all_grades, summary, counted_in, links)
    found = {name: group for name, group in row_groups(all_grades, summary, counted_in) if group.keys}
    values = {
        "version": __version__,
        "title": summary.rubric.title,
        "rubric": summary.rubric,
        "counts": [(name, f"{len(found[name].keys)} {text}") for name, text in _COUNTS.items() if name in found],
        "notes": [*filter(None, (words.final_line(summary.statistics), words.earlier_line(summary.statistics)))],
        "adjusted": words.adjusted_lines(summary.rubric),
        "lines": list(words.mark_lines(summary.statistics)) if summary.statistics.graded else [],
        "reasons": summary.statistics.reasons[1:],
        "bars": _bars(summary.statistics),
        "out_of": format_points(summary.statistics.out_of),
        "criteria": _criteria(summary.statistics),
        "criteria_note": words.CRITERIA_NOTE,
        "not_deducted_note": words.NOT_DEDUCTED_NOTE,
        "failures": summary.statistics.failures if summary.statistics.graded else (),
        "fixes": [_fix(fix, drawings) for fix in summary.fixes[: words.MAX_LISTED]],
        "fixes_note": words.FIXES_NOTE,
        "identical": [(work.students, words.what_is_same(work, summary.names)) for work in summary.identical],
        "identical_note": words.IDENTICAL_NOTE,
        "attention": summary.attention,
        "max_attention": _MAX_ATTENTION,
        "evidence": words.evidence_lines(summary),
        "people": {row.key: row for row in rows},
        "rows": rows,
        "columns": columns(rows, summary.statistics),
        "groups": found,
    }
    return render_page("class.html", values, group_data(rows, found), Assets("class.css", "class.js", RULES))


def _bars(statistics: ClassStatistics) -> list[dict[str, Any]]:
    most = max(statistics.bins)
    return [
        {
            "group": f"grade-{tenth}",
            "span": words.span(statistics, tenth),
            "count": count,
            "height": round(100 * count / most),
        }
        for tenth, count in enumerate(statistics.bins if most else ())
    ]


def _criteria(statistics: ClassStatistics) -> list[dict[str, Any]]:
    """Return the rows of the criteria, the hardest first."""
    asked = [row for row in statistics.criteria if row.of] if statistics.graded else []
    asked.sort(key=lambda row: (2.0 if row.share is None else row.share, -row.criterion.points))
    return [_criterion(row) for row in asked]


def _criterion(row: CriterionStatistics) -> dict[str, Any]:
    return {
        "row": row,
        "group": f"criterion-{row.criterion.position}",
        "points": format_points(row.criterion.points),
        "share": words.percent(row.share) if row.share is not None else "",
        "width": round(100 * (row.share or 0)),
        "discrimination": f"{row.discrimination:.2f}" if row.discrimination is not None else "",
        "is_low": words.is_low(row.discrimination),
    }


def _fix(fix: CommonFix, drawings: Mapping[str, str]) -> dict[str, Any]:
    return {
        "who": counted(fix.count, "student"),
        "action": fix.action,
        "lines": [(_ELEMENTS.get(sign, "span"), f"{sign} {line}") for sign, line in words.edit_lines(fix.example)],
        "gain": words.gain(fix),
        "drawing": Markup(drawings.get(fix.action, "")),  # noqa: S704  from a tree of elements
    }
