"""Facts about the robot as a whole: that it loads, its root, how many joints move, how its tips move, names of joints."""

from collections import Counter
from collections.abc import Iterator

from grader.authoring.elements import texts_in
from grader.authoring.fact import Fact
from grader.authoring.solution import Solution
from grader.text import counted, enumerated

_THE_FILE, _THE_ROBOT = "The file", "The robot"
_COUNTED = ("revolute", "continuous", "prismatic")
_MAX_TIPS = 20


def loading_facts(solution: Solution) -> Iterator[Fact]:
    """Yield that ROS 2 loads the file."""
    del solution
    title = "ROS 2 loads the URDF, and all links form one tree"
    yield Fact("urdf", "loads", title, "urdf_loads", about=_THE_FILE)


def tree_facts(solution: Solution) -> Iterator[Fact]:
    """Yield the root of the tree, with a link that is fixed to it, and the numbers of joints that move, if there are joints."""
    if not solution.joints:
        return
    root = solution.root
    fixed = (joint.child for joint in solution.joints.values() if joint.parent == root and joint.type == "fixed")
    holds = next(fixed, root)
    title = f"{root} is the root of the tree{f', and {holds} is fixed to it' if holds != root else ''}"
    yield Fact("root", "", title, "root_of_tree", {"link": root, "holds": holds}, about=_THE_ROBOT)
    kinds = Counter(joint.type for joint in solution.moving_joints)
    moving = sum(joint.mimic is None for joint in solution.moving_joints)
    numbers = {"moving": moving, **{kind: kinds[kind] for kind in _COUNTED}}
    types = [f"{kinds[kind]} {kind}" for kind in _COUNTED if kinds[kind]]
    title = f"{counted(moving, 'joint')} can be moved{f': {enumerated(types)}' if types else ''}"
    title += " (with those that mimic)" if moving != len(solution.moving_joints) else ""
    yield Fact("joint", "counts", title, "counts", numbers, about=_THE_ROBOT)


def motion_facts(solution: Solution) -> Iterator[Fact]:
    """Yield that the last links of the chains that move do so as those of the reference, and names that other elements use."""
    if solution.tips:
        tips = list(solution.tips[:_MAX_TIPS])
        title = f"{enumerated(tips, 4)} {'moves' if len(tips) == 1 else 'move'} as in the reference solution"
        yield Fact(
            "motion", "", title, "kinematics_match_reference", {"links": tips, "match": "order"}, about=_THE_ROBOT
        )
    words = texts_in(solution.reading.root) if solution.reading.root is not None else set()
    joints = {solution.joints[link.name].name: link.name for link in solution.links if link.name in solution.joints}
    used = {name: link for name, link in joints.items() if name in words}
    if used:
        title = f"The joints that controllers use are named {enumerated(list(used))}"
        arguments = {"parent": solution.root, "joints": used}
        yield Fact("joint", "names", title, "joints_named", arguments, about=_THE_ROBOT)
