"""Which joint holds each link, where several claim it or they form a loop."""

from grader.robot.model import Joint, Robot


def holding_joints(robot: Robot) -> dict[str, Joint]:
    """The joint that holds each link, by the link's name.

    Of two with one child the last in name order counts, as in ROS 2. Of a rejected file ROS 2 shows nothing, so there the
    fairer reading counts: no joint that would close a loop, rather one whose name speaks of its child than one whose name
    speaks of its parent alone (it may be the wrong way round), and then the first in the file.
    """
    whole = [
        joint
        for joint in robot.joints
        if joint.parent and joint.child and robot.has_link(joint.parent) and robot.has_link(joint.child)
    ]
    held: dict[str, Joint] = {}
    if robot.rejected:
        return _fairest(whole)
    for joint in whole:
        rival = held.get(joint.child)
        if rival is None or rival.name <= joint.name:
            held[joint.child] = joint
    return held


def _oddity(joint: Joint) -> tuple[bool, bool]:
    speaks_of_child = joint.child in joint.name
    return (joint.parent in joint.name and not speaks_of_child, not speaks_of_child)


def _fairest(joints: list[Joint]) -> dict[str, Joint]:
    held: dict[str, Joint] = {}
    top: dict[str, str] = {}  # some link further up, with the ways there shortened whenever one is walked

    def root(link: str) -> str:
        passed = []
        while link in top:
            passed.append(link)
            link = top[link]
        top.update(dict.fromkeys(passed, link))
        return link

    for joint in sorted(joints, key=_oddity):
        if joint.child not in held and root(joint.parent) != joint.child:
            held[joint.child] = joint
            top[joint.child] = joint.parent
    return held
