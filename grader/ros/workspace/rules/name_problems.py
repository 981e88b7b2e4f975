"""What does not agree in a workspace, as problems.

docs/examples/ref.toml explains their kinds.
"""

from grader.base.problems import Problem
from grader.ros.workspace.rules.names import Agreement
from grader.ros.workspace.rules.rule_table import FILE_USED


def name_problems(agreement: Agreement) -> tuple[Problem, ...]:
    """Return what does not agree as problems, in the order of files and lines."""
    problems = []
    for wrong in agreement.mismatches:
        problems.append(
            wrong.rule.problem(wrong.message, wrong.location, is_certain=wrong.is_certain)
        )
    for at in agreement.unused:
        message = "no other file of the workspace names this file"
        problems.append(FILE_USED.problem(message, at))
    # Of a macro of xacro that several robots call, each place once.
    by_place: dict[tuple[object, ...], Problem] = {}
    for problem in problems:
        at = problem.location
        by_place.setdefault((problem.message, at.path, at.line, at.column), problem)
    return tuple(by_place.values())
