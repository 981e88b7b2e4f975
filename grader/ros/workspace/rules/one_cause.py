"""Problems that say again what another problem of the same mistake says.

`grader inspect` lists each mistake once. An editor needs assumptions, which it shows beside their
causes: each carries the fix of what is assumed.
"""

from collections.abc import Iterable, Sequence

from grader.base.problems import Problem
from grader.ros.installation.package_problems import MESH_PATH
from grader.ros.workspace.rules.rule_table import FILE_INSTALLED
from grader.ros.xml.xml_problems import MISMATCHED_TAG, RECOVERED

_Line = tuple[str, int]


def without_repetitions(
    robot_problems: Sequence[Problem],
    others: Iterable[Problem] = (),
    *,
    with_assumptions: bool = False,
) -> tuple[Problem, ...]:
    """Return the problems of a robot without those that repeat another one.

    These are what is assumed of a line with another problem, or of a tag whose closing tag is
    wrong, and a mesh of which it is said that a build does not install it.

    Args:
        robot_problems: The problems of the robot.
        others: Those of the packages.
        with_assumptions: Whether all assumptions are kept.
    """
    repeated = {_line_of(problem) for problem in others if problem.rule == FILE_INSTALLED.name}
    said = {_line_of(problem) for problem in robot_problems if problem.kind != RECOVERED}
    is_mismatched = any(problem.kind == MISMATCHED_TAG for problem in robot_problems)
    kept = []
    for problem in robot_problems:
        if problem.kind == MESH_PATH and _line_of(problem) in repeated:
            continue
        if problem.kind == RECOVERED and not with_assumptions:
            if _line_of(problem) in said:
                continue
            if is_mismatched:
                is_mismatched = False
                continue
        kept.append(problem)
    return tuple(kept)


def _line_of(problem: Problem) -> _Line:
    return problem.location.path, problem.location.line
