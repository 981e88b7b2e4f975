"""An inspection as annotations of its files for GitHub."""

from grader.base.text import printable
from grader.report.inspection import Inspection, effect
from grader.report.writers.workflow_commands import (
    Annotation,
    annotation_place,
    annotation_text,
    command,
    limited_annotations,
)


def inspection_github(inspection: Inspection) -> str:
    """Return the annotations of an inspection.

    What ROS 2 does is a notice, then come its problems, errors first.
    """
    problems = [
        Annotation(
            problem.label,
            problem.severity,
            annotation_text([printable(problem.message)], problem.location, inspection.base),
            annotation_place(problem.location, inspection.source, inspection.base),
        )
        for problem in inspection.problems
    ]
    first = command("notice", {}, printable(inspection.path), effect(inspection))
    return "".join([first, *limited_annotations(problems, 1)])
