"""Reports that no sample has: manual marks, fractions of points, errors of the grader."""

from dataclasses import replace
from decimal import Decimal
from pathlib import Path

from grader.checks.outcome import Outcome
from grader.grading.grade import grade
from grader.grading.report import ManualMark, Report
from grader.grading.rubric import load_rubric
from tests.samples import SAMPLES, opened

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
_ROWS = (("half", 0.5, "base_link", 0.5), ("quarter", 0.25, "base_link", 0.6), ("free", 0, "base", 0.6))
_MORE = (("skipped", 0, "base", 0.6), ("ours", 0.125, "base_link", 0.6))


def half_points(folder: Path) -> Report:
    """Return a report with fractions of points: one criterion failed, one passed, one missing, one skipped, one errored."""
    rows = "".join(
        _BOX.format(id=name, points=points, link=link, size=size) for name, points, link, size in (*_ROWS, *_MORE)
    )
    file = folder / "fractions.toml"
    file.write_text(f'id = "fractions"\ntitle = "Fractions"\n[[part]]\nid = "p"\ntitle = "P"\n{rows}', encoding="utf-8")
    rubric = load_rubric(str(file))
    report = grade(rubric, opened("submissions/several-mistakes/my_robot.urdf", rubric))
    *others, last = report.results
    own = last._replace(outcome=Outcome("errored", "the grader itself failed here (KeyError); please report it"))
    return replace(report, results=(*others, own))


def marked() -> Report:
    """Return a report with manual marks: all points for a failure, none for a pass, half for a pending criterion."""
    report = SAMPLES["launch-home-path"].grade()
    rulings: dict[str, ManualMark] = {}
    for status, share in (("failed", 1), ("passed", 0), ("pending", Decimal("0.5"))):
        chosen = next(result for result in report.results if result.outcome.status == status)
        rulings[chosen.criterion.id] = ManualMark(chosen.criterion.points * share, "Ada", "so it\nis")
    results = tuple(result._replace(manual_mark=rulings.get(result.criterion.id)) for result in report.results)
    return replace(report, results=results)
