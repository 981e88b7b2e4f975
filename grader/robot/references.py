"""Names that joints refer to: parent and child links, and the joint that a mimic joint follows."""

from itertools import islice

from grader.robot import catalogue
from grader.robot.diagnostics import Problems
from grader.robot.model import Joint, Robot
from grader.text import quoted
from grader.xml.parsing import Element

_MAX_NAMED = 12  # links in a message
_MAX_STEPS = 20  # of a loop in a message


def check_references(robot: Robot, problems: Problems) -> None:
    """Report links and joints that do not exist, and mimic joints that follow themselves."""
    links = [link.name for link in robot.links]
    for joint in robot.joints:
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name and not robot.has_link(name):
                guess = problems.did_you_mean(name, links)
                guess = guess or f"; the links are: {', '.join(map(quoted, islice(links, _MAX_NAMED)))}"
                message = f"the {role} link {quoted(name)} of joint {quoted(joint.name)} does not exist; ROS 2 rejects the file{guess}"
                problems.add(catalogue.UNKNOWN_LINK, message, _child_element(joint, role, problems), "link")
        if joint.mimic is not None and not robot.has_joint(joint.mimic.joint):
            guess = problems.did_you_mean(joint.mimic.joint, [other.name for other in robot.joints])
            message = f"joint {quoted(joint.name)} mimics {quoted(joint.mimic.joint)}, which does not exist{guess}"
            problems.add(catalogue.MIMIC_TARGET, message, _child_element(joint, "mimic", problems), "joint")
    for loop in _mimic_loops(robot):
        message = f"joint {quoted(loop[0])} mimics itself: {' -> '.join(map(quoted, (*loop[:_MAX_STEPS], loop[0])))}"
        problems.add(catalogue.MIMIC_TARGET, message, _child_element(robot.joint(loop[0]), "mimic", problems), "joint")


def _child_element(joint: Joint, tag: str, problems: Problems) -> Element:
    element = problems.element(joint)
    child = element.find(tag)
    return element if child is None else child


def _mimic_loops(robot: Robot) -> list[list[str]]:
    targets = {joint.name: joint.mimic.joint for joint in robot.joints if joint.mimic is not None}
    seen: set[str] = set()
    loops = []
    for start in targets:
        path: dict[str, None] = {}
        name = start
        while name in targets and name not in seen and name not in path:
            path[name] = None
            name = targets[name]
        if name in path:
            walked = list(path)
            loops.append(walked[walked.index(name) :])
        seen.update(path)
    return loops
