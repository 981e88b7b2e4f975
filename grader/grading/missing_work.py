"""The work of this lab that a submission lacks: its URDF and its package. Evidence may replace it in manual grading."""

import re
from collections.abc import Mapping
from itertools import islice

from grader.checks.outcome import Outcome, pending
from grader.errors import MissingElement
from grader.grading.rubric import Rubric
from grader.names import closest
from grader.robot.model import Robot
from grader.submission.submission import Submission
from grader.submission.urdf import Absent, Read, Urdf
from grader.text import enumerated

_MAX_LINKS = 50  # whose names are compared
_MAX_PICTURES = 50
_MAX_LISTED = 6
_WORD = re.compile(r"[^\W\d_]+")
_NO_WORDS = frozenset({"link", "joint", "frame"})  # which names of any robot have


def robot_of(urdf: Urdf) -> Robot | None:
    """Return the robot of a URDF as far as it could be read."""
    return urdf.reading.robot if isinstance(urdf, Read) else None


def is_another_robot(rubric: Rubric, robot: Robot | None) -> bool:
    """Return whether a completely known robot has none of the rubric's links, and none with a similar name."""
    if robot is None or robot.incomplete or not robot.links or not rubric.links:
        return False
    if any(link.name in rubric.links for link in robot.links):
        return False
    words = frozenset().union(*map(_words, rubric.links))
    return not any(
        closest(link.name, rubric.links) or words & _words(link.name) for link in islice(robot.links, _MAX_LINKS)
    )


def another_robot(rubric: Rubric, robot: Robot) -> MissingElement:
    """Return the error for a robot that is another one."""
    message = "this looks like another robot: it has none of the links that the rubric names"
    names = enumerated([repr(link.name) for link in robot.links], _MAX_LISTED)
    detail = f" ({enumerated(sorted(rubric.links), _MAX_LISTED)}); it has {names}"
    return MissingElement("robot of the lab", "", message=message, detail=detail, location=robot.links[0].location)


def missing_work(rubric: Rubric, submission: Submission) -> Mapping[str, str]:
    """Return what a submission with evidence lacks, the `URDF` or the `package` of this lab, and why."""
    if submission.is_single or not submission.evidence_files:
        return {}
    found = {}
    robot = robot_of(submission.urdf)
    if isinstance(submission.urdf, Absent):
        found["URDF"] = "no URDF was submitted"
    elif robot is not None and is_another_robot(rubric, robot):
        found["URDF"] = another_robot(rubric, robot).mistake
    package = submission.package
    if package is None:
        found["package"] = submission.no_package[0]
    elif submission.other_lab and package.name != rubric.package:
        found["package"] = f"no package was submitted for this lab; {package.name!r} is in the folder of another lab"
    return found


def by_evidence(submission: Submission, reason: str) -> Outcome:
    """Return the outcome of a criterion of what a submission lacks, for this reason, where evidence takes its place."""
    paths = tuple(file.path for file in submission.evidence_files[:_MAX_PICTURES])
    message = f"{reason}, but {enumerated(paths, _MAX_LISTED)}; needs manual grading"
    return pending(message, f"{reason}, but evidence")._replace(measured=paths)


def _words(name: str) -> frozenset[str]:
    return frozenset(_WORD.findall(name.lower())) - _NO_WORDS
