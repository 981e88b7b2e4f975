"""An inspection as annotations of its files for GitHub."""

from grader.base.problems import Severity
from grader.base.source import Location
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

    What ROS 2 does is a notice. Robots that cannot be read follow, then its problems, errors first.
    """
    annotations = list[Annotation]()
    for robot in inspection.unread:
        place = annotation_place(Location(robot.path, 1, 1), inspection.source, inspection.base)
        level: Severity = "error" if inspection.has_no_readable_robot else "warning"
        annotations.append(Annotation("not read", level, printable(robot.reason), place))
    annotations += [
        Annotation(
            problem.label,
            problem.severity,
            annotation_text([printable(problem.message)], problem.location, inspection.base),
            annotation_place(problem.location, inspection.source, inspection.base),
        )
        for problem in inspection.problems
    ]
    first = command("notice", {}, printable(inspection.path), effect(inspection))
    return "".join([first, *limited_annotations(annotations, 1)])
