"""The check of how many links and joints a robot has."""

from collections import Counter
from collections.abc import Collection, Mapping
from typing import Any

from grader.checks.check import About
from grader.checks.outcome import Outcome, judged
from grader.checks.toml_types import Count
from grader.robot.kinematics import Configuration
from grader.text import counted, enumerated


def _breaks_under(arguments: Mapping[str, Any]) -> Collection[str]:
    """Splitting a fixed joint adds a link and a fixed joint."""
    is_counted = any(arguments.get(key) is not None for key in ("links", "joints", "fixed"))
    return ("fixed joints split",) if is_counted else ()


ABOUT = {"counts": About(("joint", "joint@type", "link"), breaks_under=_breaks_under)}


def counts(
    robot: Configuration,
    *,
    links: Count | None = None,
    joints: Count | None = None,
    moving: Count | None = None,
    revolute: Count | None = None,
    continuous: Count | None = None,
    prismatic: Count | None = None,
    fixed: Count | None = None,
) -> Outcome:
    """The tree has the given numbers of links and joints.

    Links and joints that no chain of joints connects to the root are not counted; of several trees, the largest one is
    counted.

    Args:
        links: The number of links.
        joints: The number of joints of all types.
        moving: The number of joints that are neither fixed nor mimic another joint.
        revolute: The number of revolute joints.
        continuous: The number of continuous joints.
        prismatic: The number of prismatic joints.
        fixed: The number of fixed joints.
    """
    wanted = {
        "link": links,
        "joint": joints,
        "moving joint": moving,
        "revolute joint": revolute,
        "continuous joint": continuous,
        "prismatic joint": prismatic,
        "fixed joint": fixed,
    }
    expected = {noun: number for noun, number in wanted.items() if number is not None}
    found = _count(robot, expected)
    numbers = tuple(found[noun] for noun in expected), tuple(expected.values())
    wrong = [noun for noun, number in expected.items() if found[noun] != number]
    shown = {noun: counted(found[noun], noun) for noun in expected}
    if not wrong:
        return judged(True, f"the tree has {enumerated(list(shown.values())) or 'links'}", *numbers)
    verbs = {noun: "is" if found[noun] == 1 else "are" for noun in wrong}
    faults = (f"there {verbs[noun]} {shown[noun]}; there should be {expected[noun]}" for noun in wrong)
    return judged(False, "; ".join(faults), *numbers)


def _count(robot: Configuration, nouns: Collection[str]) -> Counter[str]:
    """Return the numbers of links and joints by kind in the largest tree; raise NotDecided if xacro leaves one open."""
    tree = robot.main_tree
    found = Counter({"link": len(tree), "joint": max(0, len(tree) - 1)})
    for joint in (robot.parent_joints[link] for link in tree[1:]) if set(nouns) - {"link", "joint"} else ():
        is_moving = joint.type != "fixed" and joint.mimic is None
        found[f"{joint.type} joint"] += 1
        found["moving joint"] += is_moving
    return found
