"""The work of this lab that a submission lacks: its URDF and its package. Evidence may replace it in manual grading."""

from collections.abc import Mapping

from grader.checks.outcome import Outcome, pending
from grader.errors import MissingElement
from grader.grading.rubric import Rubric
from grader.robot.model import Robot
from grader.submission.submission import Submission
from grader.submission.urdf import Absent, is_another_robot, known_links
from grader.text import enumerated

_MAX_PICTURES = 50
_MAX_LISTED = 6


def another_robot(rubric: Rubric, robot: Robot | None, link: str = "") -> MissingElement | None:
    """Return the error for a robot that is another one, and so has no `link`; None if it may be that of the lab."""
    if robot is None or not is_another_robot(robot, rubric.links):
        return None
    count = known_links(robot, rubric.links)
    links = f"only {count} of the {len(rubric.links)} links" if count else "none of the links"
    missing = f"there is no link {link!r}, and " if link else ""
    message = f"{missing}this looks like another robot: it has {links} that the rubric names"
    names = enumerated([repr(link.name) for link in robot.links], _MAX_LISTED) or "no link"
    detail = f" ({enumerated(sorted(rubric.links), _MAX_LISTED)}); it has {names}"
    location = robot.links[0].location if robot.links else None
    return MissingElement("robot of the lab", "", message=message, detail=detail, location=location)


def missing_work(rubric: Rubric, submission: Submission) -> Mapping[str, str]:
    """Return what a submission with evidence lacks, the `URDF` or the `package` of this lab, and why."""
    found = {}
    another = another_robot(rubric, submission.robot)
    if isinstance(submission.urdf, Absent):
        found["URDF"] = "no URDF was submitted"
    elif another is not None:
        found["URDF"] = another.mistake
    package = submission.package
    if package is None:
        found["package"] = submission.no_package[0]
    elif package.name != rubric.package and submission.other_lab and package.folder.startswith(submission.other_lab):
        found["package"] = f"no package was submitted for this lab; {package.name!r} is in the folder of another lab"
    return found if found and not submission.is_single and submission.evidence_files else {}


def by_evidence(submission: Submission, reason: str) -> Outcome:
    """Return the outcome of a criterion of what a submission lacks, for this reason, where evidence takes its place."""
    paths = tuple(file.path for file in submission.evidence_files[:_MAX_PICTURES])
    verb = "was" if len(paths) == 1 else "were"
    message = f"{reason}, but {enumerated(paths, _MAX_LISTED)} {verb} submitted; needs manual grading"
    return pending(message, f"{reason}, but evidence")._replace(measured=paths)
