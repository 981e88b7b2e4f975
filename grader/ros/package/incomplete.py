"""The problems of a robot, which may not be read completely.

What may be in the rest is not missing.
"""

import re
from collections.abc import Callable, Iterator, Sequence

from grader.base.patterns import on_use
from grader.base.problems import Problem, in_order
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree
from grader.ros.package.mesh_files import mesh_problems
from grader.ros.package.package import Packages
from grader.ros.package.robot_file import Read
from grader.ros.urdf import urdf_problems as kinds

_HARDWARE = on_use(rb"<hardware>.*?(?:</hardware>|\Z)", re.DOTALL)
_CONDITION = on_use(rb"<xacro:(if|unless)\b")
# That something is not there, or is there twice.
_OF_THE_WHOLE = frozenset(
    {
        kinds.NO_LINKS,
        kinds.UNDEFINED_MATERIAL,
        kinds.UNKNOWN_LINK,
        kinds.MIMIC_TARGET,
        kinds.TWO_ROOTS,
        kinds.NO_ROOT,
        kinds.TWO_PARENTS,
        kinds.CONTROLLED_JOINT,
    }
)


def problems_of_robot(
    robot: Read, packages: Packages, tree: Tree, is_started: Callable[[], bool]
) -> tuple[Problem, ...]:
    """Return the problems of a robot and of its meshes, in the order of their places.

    `is_started` says whether the robot is started, and always under the arguments of xacro under
    which it was read.
    """
    meshes = mesh_problems(robot, packages, tree)
    robot_problems = [
        problem
        for problem in _listed(robot.loaded.problems)
        if not _is_chosen(problem, robot, tree) or is_started()
    ]
    return in_order((*robot_problems, *meshes))


def _is_chosen(problem: Problem, robot: Read, tree: Tree) -> bool:
    """Return whether an argument of xacro chooses what is missing: the plugin of hardware."""
    if not robot.is_expanded or problem.kind is not kinds.HARDWARE_PLUGIN:
        return False
    text = tree.read(problem.location.path, URDF_LIMIT) or b""
    return any(_CONDITION.search(hardware) for hardware in _HARDWARE.findall(text))


def _listed(problems: Sequence[Problem]) -> Iterator[Problem]:
    """Yield the problems of a robot, but those that the unread part may undo.

    Those for which something cannot be determined are one problem.
    """
    unknown = [problem for problem in problems if problem.kind.effect == "undetermined"]
    is_cut = any(problem.kind.is_before_ros for problem in problems)
    for problem in problems:
        is_error = problem.kind.effect == "rejects"  # which the reader reports where it is certain
        if problem.kind in _OF_THE_WHOLE and (is_cut or (unknown and not is_error)):
            continue
        if problem not in unknown:
            yield problem
        elif problem is unknown[0]:
            more = f"; {len(unknown) - 1} more places" if len(unknown) > 1 else ""
            yield problem._replace(message=f"{problem.message}{more}", cause=problem.location.path)
