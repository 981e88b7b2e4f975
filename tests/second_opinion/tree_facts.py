"""Facts about the tree of links: whether it loads, names and types of joints."""

from collections.abc import Mapping, Sequence

from tests.second_opinion.body_facts import is_shown
from tests.second_opinion.posed import Fact, Missing, Posed, below


def urdf_loads(posed: Posed) -> Fact:
    return posed.robot.loads, None


def held_by(posed: Posed, link: str, parent: str, joint_type: str, free: bool = False) -> Fact:
    way = below(posed, link, parent)
    types = [joint.type for joint in way or () if joint.type != "fixed"]
    if way and not types and joint_type != "fixed":
        raise Missing("moving joint", link)
    moving = [joint for joint in way or () if joint.type != "fixed"]
    is_free = not any(joint.is_mimic or (joint.limit and joint.limit[3] <= 0) for joint in moving)
    return way is not None and types == ([] if joint_type == "fixed" else [joint_type]) and (
        is_free or not free
    ), None


def joints_named(posed: Posed, parent: str, joints: Mapping[str, str]) -> Fact:
    for name, link in joints.items():
        if any((joint.name, joint.child) == (name, link) for joint in posed.robot.named):
            continue
        if link not in posed.robot.links:
            return False, None
        up, other = posed.way_up(link), posed.way_up(parent) if parent in posed.robot.links else []
        tops = [way[-1].parent if way else start for way, start in ((up, link), (other, parent))]
        between = (
            [joint for joint in (*up, *other) if (joint in up) != (joint in other)]
            if tops[0] == tops[1]
            else []
        )
        joints_of_link = (
            [*up[:1], *between]
            if up
            else [joint for joint in posed.robot.named if link in (joint.parent, joint.child)]
        )
        if name not in [joint.name for joint in joints_of_link]:
            return False, None
    return True, None


def root_of_tree(posed: Posed, link: str, holds: str, links: Sequence[str] = ()) -> Fact:
    posed.link(link), posed.link(holds)
    if link in posed.robot.parents and not links:
        return False, None
    for joint in posed.way_up(link):
        above = posed.link(joint.parent)
        has_shape = is_shown(above) or any(shape.has_size for shape in above.collisions)
        if joint.type != "fixed" or joint.parent in links or has_shape:
            return False, None
    way = below(posed, holds, link)
    return way is not None and all(joint.type == "fixed" for joint in way), None


def counts(posed: Posed, moving: int, continuous: int | None = None) -> Fact:
    tree = max(posed.robot.trees.values(), key=len)
    joints = [posed.robot.parents[link] for link in tree[1:]]
    number = sum(joint.type != "fixed" and not joint.is_mimic for joint in joints)
    turning = sum(joint.type == "continuous" for joint in joints)
    measured = (number,) if continuous is None else (number, turning)
    return number == moving and continuous in (None, turning), measured
