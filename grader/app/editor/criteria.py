"""The criteria of a rubric that the files of an editor do not meet."""

from grader.app.hints_and_fix import add_hints
from grader.base.text import counted_points
from grader.files.tree import Tree
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric_files import load_named
from grader.lab.submission.opening import submission_of
from grader.report.findings import Finding, findings_in_report


def criteria_findings(name: str, tree: Tree, identity: str) -> list[Finding]:
    """Return the criteria that lose points, with the points.

    Args:
        name: The id of the rubric, or its file.
        tree: The files.
        identity: The name of the folder.

    Raises:
        GraderError: The rubric or the files cannot be read.
    """
    rubric = load_named(name, None)
    submission = submission_of(tree, identity, rubric.lab)
    report = grade(rubric, submission)
    report, _ = add_hints(report, submission, None, lambda _: None, is_fixed=False)
    lost = {}
    for result in report.results:
        lost[result.criterion.id] = result.criterion.points - result.points
    found = []
    for finding in findings_in_report(report):
        if finding.rule.id in lost:
            points = counted_points(lost[finding.rule.id])
            found.append(finding._replace(message=f"{finding.message} ({points})"))
    return found
