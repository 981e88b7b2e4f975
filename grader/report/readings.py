"""What is said of a file as ROS 2 reads it, in a report and in an inspection."""

from grader.base.problems import Problem
from grader.base.text import printable
from grader.report.locations import location_text

UNDECIDED = "xacro that cannot be determined statically"
VERDICTS = {
    "clean": "ROS 2 loads the file",
    "degraded": "ROS 2 loads the file, but drops content of it",
    "rejected": "ROS 2 rejects the file",
}


def problem_line(problem: Problem) -> str:
    """Return a problem with its code, severity and location."""
    return (
        f"{problem.label} {problem.severity} {location_text(problem.location)}: "
        f"{printable(problem.message)}"
    )
