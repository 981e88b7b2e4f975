"""Problems that say again what another problem of the same mistake says.

`grader inspect` lists each mistake once. An editor needs assumptions, which it shows beside their
causes: each carries the fix of what is assumed.
"""

from collections.abc import Iterable, Sequence

from grader.base.problems import Problem
from grader.ros.installation.package_problems import EMPTY_GLOB, MESH_PATH
from grader.ros.xml.xml_problems import MISMATCHED_TAG, RECOVERED
from grader.workspace.rules.files import FILE_INSTALLED

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
    assumed = [] if with_assumptions else _repeated_assumptions(robot_problems)
    absent = {_find_line(problem) for problem in others if problem.rule == FILE_INSTALLED.name}
    kept = []
    for problem in robot_problems:
        is_absent_mesh = problem.kind == MESH_PATH and _find_line(problem) in absent
        if problem not in assumed and not is_absent_mesh:
            kept.append(problem)
    return tuple(kept)


def without_said_patterns(problems: Sequence[Problem]) -> list[Problem]:
    """Return problems of packages without patterns of which it is said what they do not install."""
    said = {problem.related for problem in problems if problem.rule == FILE_INSTALLED.name}
    return [
        problem
        for problem in problems
        if problem.kind != EMPTY_GLOB or problem.location not in said
    ]


def _repeated_assumptions(problems: Sequence[Problem]) -> list[Problem]:
    """Return what is assumed of a line with another problem, or of a wrong closing tag."""
    said = {_find_line(problem) for problem in problems if problem.kind != RECOVERED}
    repeated = list[Problem]()
    others = list[Problem]()
    for problem in problems:
        if problem.kind == RECOVERED:
            (repeated if _find_line(problem) in said else others).append(problem)
    if any(problem.kind == MISMATCHED_TAG for problem in problems):
        repeated += others[:1]
    return repeated


def _find_line(problem: Problem) -> _Line:
    return problem.location.path, problem.location.line
