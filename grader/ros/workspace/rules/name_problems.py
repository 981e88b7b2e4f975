"""What does not agree in a workspace, as problems.

docs/examples/ref.toml explains their kinds.
"""

from grader.base.problems import Problem
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.name_fixes import NameFixes
from grader.ros.workspace.rules.reading import read_agreement
from grader.ros.workspace.rules.rule_table import FILE_USED


def name_problems(workspace: Workspace) -> tuple[Problem, ...]:
    """Return what does not agree as problems with their fixes, in the order of files and lines."""
    agreement, name_fixes = read_agreement(workspace), NameFixes(workspace)
    problems = []
    for wrong in agreement.mismatches:
        problem = wrong.rule.problem(wrong.message, wrong.location, is_certain=wrong.is_certain)
        problem = problem._replace(related=wrong.related, fixes=name_fixes.of(wrong))
        place = name_fixes.place_of_word(wrong)
        if place is not None:
            problem = problem._replace(location=place, around=wrong.location)
        problems.append(problem)
    for at in agreement.unused:
        message = "no other file of the workspace names this file"
        problems.append(FILE_USED.problem(message, at))
    # Of a macro of xacro that several robots call, each place once.
    by_place: dict[tuple[object, ...], Problem] = {}
    for problem in problems:
        at = problem.location
        by_place.setdefault((problem.message, at.path, at.line, at.column), problem)
    return tuple(by_place.values())
