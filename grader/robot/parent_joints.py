"""The parent joint of each link, also where several joints have the same child or form a loop."""

from grader.robot.model import Joint, Robot


def parent_joints(robot: Robot) -> dict[str, Joint]:
    """Return the parent joint of each link, by the link's name; a root has none.

    Of two joints with one child the last in name order counts, as in ROS 2. ROS 2 shows nothing of a rejected file, so there
    the most plausible reading counts: no joint that would close a loop, rather one whose name contains its child's than one
    whose name contains only its parent's (these two may be swapped), and then the first in the file.
    """
    complete = [
        joint
        for joint in robot.joints
        if joint.parent and joint.child and robot.has_link(joint.parent) and robot.has_link(joint.child)
    ]
    if robot.rejected:
        return _most_plausible(complete)
    parents: dict[str, Joint] = {}
    for joint in complete:
        rival = parents.get(joint.child)
        if rival is None or rival.name <= joint.name:
            parents[joint.child] = joint
    return parents


def _implausibility(joint: Joint) -> tuple[bool, bool]:
    names_child = joint.child in joint.name
    return (joint.parent in joint.name and not names_child, not names_child)


def _most_plausible(joints: list[Joint]) -> dict[str, Joint]:
    parents: dict[str, Joint] = {}
    above: dict[str, str] = {}  # some link further up; a path is shortened whenever it is followed

    def root(link: str) -> str:
        passed = []
        while link in above:
            passed.append(link)
            link = above[link]
        above.update(dict.fromkeys(passed, link))
        return link

    for joint in sorted(joints, key=_implausibility):
        if joint.child not in parents and root(joint.parent) != joint.child:
            parents[joint.child] = joint
            above[joint.child] = joint.parent
    return parents
