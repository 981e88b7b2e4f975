"""Reports that no sample has: manual marks, fractions of points, errors of the grader, hints, adjustments, extra credit."""

from decimal import Decimal
from pathlib import Path

from grader.base.source import Edit, Location
from grader.lab.checks.outcome import Outcome
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Hint, ManualComment, ManualMark, Report
from grader.lab.rubric.rubric import load_rubric, read_rubric
from tests.samples import LAB6, SAMPLES, opened

# The variables that the runner of Classroom 50 sets for an autograder.
CLASSROOM50 = {
    "CLASSROOM": "robotics",
    "ASSIGNMENT": "lab6",
    "ASSIGNMENT_TYPE": "individual",
    "USERNAME": "alice",
    "SUBMISSION_TAG": "submit/2026-11-20T18-30-05Z-ab12cd3",
    "COMMIT_URL": "https://github.com/robotics/lab6-alice/commit/ab12cd3",
    "RELEASE_URL": "https://github.com/robotics/lab6-alice/releases/tag/submit%2F2026-11-20T18-30-05Z-ab12cd3",
    "REVIEW_URL": "https://github.com/robotics/lab6-alice/compare/0a1b2c3...ab12cd3",
}

_BOX = """
[[criterion]]
id = "{id}"
part = "p"
title = "{id}"
points = {points}
check = "shows_box"
with = {{ link = "{link}", size = [{size}, 0.4, 0.2], tolerance = 0.002 }}
feedback = \"\"\"Two
lines.\"\"\"
"""
_ROWS = (
    ("half", 0.5, "base_link", 0.5),
    ("quarter", 0.25, "base_link", 0.6),
    ("free", 0, "base", 0.6),
)
_MORE = (("skipped", 0, "base", 0.6), ("ours", 0.125, "base_link", 0.6))


def half_points(folder: Path) -> Report:
    """Return a report with fractions of points: one criterion failed, one passed, one missing, one skipped, one errored."""
    rows = "".join(
        _BOX.format(id=name, points=points, link=link, size=size)
        for name, points, link, size in (*_ROWS, *_MORE)
    )
    file = folder / "fractions.toml"
    file.write_text(
        f'id = "fractions"\ntitle = "Fractions"\n[[part]]\nid = "p"\ntitle = "P"\n{rows}',
        encoding="utf-8",
    )
    rubric = load_rubric(str(file))
    report = grade(
        rubric, opened("submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf", rubric)
    )
    *others, last = report.results
    own = last._replace(
        outcome=Outcome("errored", "the grader itself failed here (KeyError); please report it")
    )
    return report._replace(results=(*others, own))


AXLE = ("right-wheel-forward", "right-wheel-axis")  # that one edit makes pass
LIFT = ("footprint-at-wheel-bottoms", "stands-on-ground")


def hinted(report: Report | None = None) -> Report:
    """Return the report on several mistakes, or a given one, with hints: one edit of one line, and two edits of two files."""
    report = SAMPLES["several-mistakes"].alone.grade() if report is None else report
    where = report.submission.path or ""
    rpy = Edit(where, 73, 34, 'rpy="1.57 0 0"', 'rpy="-1.57 0 0"')
    xyz = Edit(where, 99, 15, 'xyz="0 0 0.05"', 'xyz="0 0 0.1"')
    other = Edit("notes.txt", 1, 1, "", "a new file\n")
    points = {result.criterion.id: result.criterion.points for result in report.results}
    hints: dict[str, Hint] = {}
    for names, message, edits in (
        (AXLE, 'Change `rpy="1.57 0 0"` to `rpy="-1.57 0 0"` (line 73)', (rpy,)),
        (LIFT, "Raise the base by 50 mm", (xyz, other)),
    ):
        at, gains = (
            Location(where, edits[0].line, edits[0].column),
            {name: points[name] for name in names},
        )
        hints |= dict.fromkeys(names, Hint(message, at, gains, edits, shown_by=names[0]))
    results = tuple(
        result._replace(hint=hints.get(result.criterion.id)) for result in report.results
    )
    return report._replace(results=results)


def marked() -> Report:
    """Return a report with manual marks: all points for a failure, none for a pass, half for a pending criterion."""
    report = SAMPLES["launch-home-path"].grade()
    rulings: dict[str, ManualMark] = {}
    for status, share in (("failed", 1), ("passed", 0), ("pending", Decimal("0.5"))):
        chosen = next(result for result in report.results if result.outcome.status == status)
        rulings[chosen.criterion.id] = ManualMark(
            chosen.criterion.points * share, "Ada", "so it\nis"
        )
    results = tuple(
        result._replace(manual_mark=rulings.get(result.criterion.id)) for result in report.results
    )
    return report._replace(results=results)


_ADJUSTED = """
[[criterion]]
id = "flat-base"
part = "task1"
title = "The base is flat"
points = 5
check = "shows_box"
with = { link = "base_link", size = [0.6, 0.4, 0.1], tolerance = 0.002 }
feedback = "Try a flat base."
bonus = true

[[criterion]]
id = "base-is-there"
part = "task1"
title = "The base is a box"
points = 3
check = "shows_box"
with = { link = "base_link", size = [0.6, 0.4, 0.2], tolerance = 0.002 }
bonus = true

[adjust.lidar-frame]
action = "full"
reason = "the <handout> was *odd*"

[adjust.right-wheel-forward]
action = "drop"
reason = "turning was not taught"

[adjust.base-on-ground]
action = "full"
reason = "the ground was missing"

[adjust.answer-floating-link]
action = "full"
reason = "the question was ambiguous"

[adjust.rviz-fixed-frame]
action = "drop"
reason = "RViz was broken"
"""
COMMENTED = (
    "base-green",
    "base-box",
    "answer-launch-nodes",
    "launch-found",
    "flat-base",
    "lidar-frame",
)


def adjusted() -> Report:
    """Return a report with extra credit, earned and not, with all kinds of adjusted criteria, and with comments without points."""
    rubric = read_rubric(LAB6.data + _ADJUSTED.encode(), LAB6.path)
    report = grade(rubric, opened("submissions/lab6/several-mistakes/my_robot/urdf", rubric))
    comments = {name: ManualComment(f"seen <{name}>\nin *class*", "Ada") for name in COMMENTED}
    results = tuple(
        result._replace(comment=comments.get(result.criterion.id)) for result in report.results
    )
    return report._replace(results=results)
