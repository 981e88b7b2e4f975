"""The check of the problems that the reader finds in a URDF.

Also of those in the xacro that it is written in.
"""

from collections.abc import Sequence
from typing import Annotated

from grader.base.errors import MissingElement
from grader.base.problems import Problem
from grader.base.text import MAX_NAMED, counted, enumerated
from grader.base.toml_types import Constraint
from grader.lab.checks.check import About, everything
from grader.lab.checks.outcome import Outcome, failed, passed, pending
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.reader import Reading
from grader.ros.urdf.urdf_problems import UNLISTED
from grader.ros.workspace.rules.problem_kinds import EVERY_KIND

# Another text for the same robot may have problems of its own.
ABOUT = {"without_problems": About(breaks_under=everything, is_of_writing=True)}

_CODES = [kind.code for kind in EVERY_KIND if kind.code.startswith(("URDF", "XACRO"))]
_KNOWN = Constraint(
    (
        "codes of problems of a URDF or of xacro, such as URDF012 (`grader explain CODE` "
        "describes one)"
    ),
    lambda codes: set(codes) <= set(_CODES),
    {"items": {"enum": _CODES}},
)
_Codes = Annotated[list[str], _KNOWN]


def without_problems(urdf: Reading, submission: Submission, *, problems: _Codes) -> Outcome:
    """The URDF has none of these problems.

    What cannot be determined statically needs manual grading.

    Args:
        problems: The codes of the problems, such as "URDF051" or "XACRO002".
    """
    assert isinstance(submission.urdf, Read)  # else there is none that is needed
    reported = [problem for problem in submission.urdf.problems if problem.code in problems]
    certain = [problem for problem in reported if problem.kind.effect != "undetermined"]
    if certain:
        return _fail_with_problems(certain)
    open_ones = [
        problem
        for problem in submission.urdf.problems
        if problem.kind.effect == "undetermined" or problem.kind is UNLISTED
    ]
    if open_ones:
        first = open_ones[0]
        return pending(f"{first.message}; needs manual grading", first.message, first.location)
    if urdf.robot is None:
        raise MissingElement(
            "robot", "", message="ROS 2 cannot read the file, so there is no robot"
        )
    return passed(f"the URDF has none of the problems {enumerated(problems, MAX_NAMED)}")


def _fail_with_problems(reported: Sequence[Problem]) -> Outcome:
    first, more = reported[0], len(reported) - 1
    others = f" (and {counted(more, 'more such problem')})" if more else ""
    outcome = failed(
        f"{first.code}: {first.message}{others}", first.location, problem=first.message
    )
    return outcome._replace(mistake=f"{first.code}: {first.kind.title}")
