"""Whether links and joints form one tree (`model.h`: initTree, initRoot; kdl_parser: addChildrenToTree)."""

from collections.abc import Iterable
from itertools import islice

from grader.robot import catalogue
from grader.robot.diagnostics import Notes
from grader.robot.model import Joint, Robot
from grader.robot.parent_joints import parent_joints
from grader.text import quoted
from grader.xml.parsing import Element

_REJECTED = "ROS 2 loads nothing of the file"
_MOST_PATHS = 10_000_000
_MOST_CYCLES = 10
_MOST_NAMED = 20

Edges = dict[str, list[Joint]]


def check_tree(robot: Robot, links: dict[str, Element], notes: Notes) -> None:
    """Note everything that keeps the links from being one tree. `links` gives the elements by name."""
    _check_names(robot, links, notes)
    held = parent_joints(robot)
    roots = [link.name for link in robot.links if link.name not in held]
    if len(roots) == 1 and len(held) == len(robot.joints) and _all_reached(roots[0], robot.joints, len(links)):
        return
    edges: Edges = {}
    for joint in robot.joints:
        if joint.parent and joint.child and robot.has_link(joint.parent) and robot.has_link(joint.child):
            edges.setdefault(joint.parent, []).append(joint)
    _check_two_parents(edges, held, notes)
    cycles = _cycles(edges, list(links))
    reachable = _reachable(roots, edges)
    for cycle in cycles[:_MOST_CYCLES]:
        _note_cycle(cycle, reachable, has_root=bool(roots), notes=notes)
    _check_roots(robot, roots, edges, links, notes)
    if not cycles:
        _check_paths(roots, edges, links, notes)


def _all_reached(root: str, joints: Iterable[Joint], count: int) -> bool:
    edges: Edges = {}
    for joint in joints:
        edges.setdefault(joint.parent, []).append(joint)
    return len(_reachable([root], edges)) == count


def _check_names(robot: Robot, links: dict[str, Element], notes: Notes) -> None:
    joints = [joint.name for joint in robot.joints]
    listed = f"; the links are: {', '.join(map(quoted, islice(links, 12)))}"
    for joint in robot.joints:
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name and not robot.has_link(name):
                guess = notes.did_you_mean(name, links) or listed
                message = (
                    f"the {role} link {quoted(name)} of joint {quoted(joint.name)} does not exist: {_REJECTED}{guess}"
                )
                notes.add(catalogue.UNKNOWN_LINK, message, _part(notes.element(joint), role), "link")
        if joint.mimic is not None and not robot.has_joint(joint.mimic.joint):
            guess = notes.did_you_mean(joint.mimic.joint, joints)
            message = f"joint {quoted(joint.name)} mimics {quoted(joint.mimic.joint)}, which does not exist{guess}"
            notes.add(catalogue.MIMIC_TARGET, message, _part(notes.element(joint), "mimic"), "joint")
    for loop in _mimic_loops(robot):
        message = f"joint {quoted(loop[0])} mimics itself: {' -> '.join(map(quoted, (*loop[:20], loop[0])))}"
        notes.add(catalogue.MIMIC_TARGET, message, _part(notes.element(robot.joint(loop[0])), "mimic"), "joint")


def _part(joint: Element, tag: str) -> Element:
    part = joint.find(tag)
    return joint if part is None else part


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


def _check_two_parents(edges: Edges, held: dict[str, Joint], notes: Notes) -> None:
    claims: dict[str, list[Joint]] = {}
    for joint in (each for group in edges.values() for each in group):
        claims.setdefault(joint.child, []).append(joint)
    for child, rivals in claims.items():
        if len({joint.name for joint in rivals}) > 1:
            names = " and ".join(quoted(joint.name) for joint in rivals[:_MOST_NAMED])
            message = f"link {quoted(child)} is the child of {names}; in ROS 2 {quoted(held[child].name)} holds it (last in name order)"
            notes.add(catalogue.TWO_PARENTS, message, notes.element(rivals[1]))


def _reachable(roots: Iterable[str], edges: Edges) -> set[str]:
    reached = set(roots)
    waiting = list(reached)
    while waiting:
        for joint in edges.get(waiting.pop(), ()):
            if joint.child not in reached:
                reached.add(joint.child)
                waiting.append(joint.child)
    return reached


def _cycles(edges: Edges, links: list[str]) -> list[list[Joint]]:
    """One loop of joints after another; each is taken out before the next is looked for."""
    left = set(links)
    cycles: list[list[Joint]] = []
    while len(cycles) <= _MOST_CYCLES:
        left = _without_ends(left, edges)
        start = next((name for name in links if name in left), None)
        if start is None:
            break
        walked: list[Joint] = []
        met: dict[str, int] = {}
        name = start
        while name not in met:
            met[name] = len(walked)
            joint = next(each for each in edges[name] if each.child in left)
            walked.append(joint)
            name = joint.child
        cycle = walked[met[name] :]
        cycles.append(cycle)
        left -= {joint.parent for joint in cycle}
    return cycles


def _without_ends(names: set[str], edges: Edges) -> set[str]:
    """The links that are left when those with no joint in, or none out, are taken away again and again."""
    left = set(names)
    back: dict[str, list[str]] = {}
    into = dict.fromkeys(left, 0)
    out = dict.fromkeys(left, 0)
    for parent in left:
        for joint in edges.get(parent, ()):
            if joint.child in left:
                back.setdefault(joint.child, []).append(parent)
                into[joint.child] += 1
                out[parent] += 1
    waiting = [name for name in left if not into[name] or not out[name]]
    while waiting:
        name = waiting.pop()
        if name not in left:
            continue
        left.remove(name)
        for joint in edges.get(name, ()):
            if joint.child in left:
                into[joint.child] -= 1
                if not into[joint.child]:
                    waiting.append(joint.child)
        for parent in back.get(name, ()):
            if parent in left:
                out[parent] -= 1
                if not out[parent]:
                    waiting.append(parent)
    return left


def _note_cycle(cycle: list[Joint], reachable: set[str], *, has_root: bool, notes: Notes) -> None:
    shown = [*cycle[:20], *cycle[-1:]] if len(cycle) > 20 else cycle
    steps = " -> ".join(quoted(joint.parent) for joint in shown) + f" -> {quoted(cycle[0].parent)}"
    names = ", ".join(quoted(joint.name) for joint in shown)
    who = f"the joint {names} forms a loop" if len(cycle) == 1 else f"the joints {names} form a loop"
    element = notes.element(cycle[0])
    if cycle[0].parent in reachable:
        message = f"{who}: {steps}; ROS 2 follows it for ever and crashes"
        notes.add(catalogue.CYCLE, message, element)
    elif has_root:
        message = f"{who} apart from the robot: {steps}; ROS 2 leaves these links out"
        notes.add(catalogue.DETACHED_CYCLE, message, element)
    else:
        message = f"there is no root link: {who}: {steps}; {_REJECTED}"
        notes.add(catalogue.NO_ROOT, message, element)


def _check_roots(robot: Robot, roots: list[str], edges: Edges, links: dict[str, Element], notes: Notes) -> None:
    explained = {joint.child for joint in robot.joints if not robot.has_link(joint.parent)}
    explained |= {notes.closest(joint.child, links) or "" for joint in robot.joints if not robot.has_link(joint.child)}
    if len(roots) < 2 or len([name for name in roots if name not in explained]) < 2:
        return
    sizes = {name: len(_reachable([name], edges)) for name in roots} if len(roots) <= 50 else {}
    main = max(roots, key=lambda name: sizes.get(name, 0))
    others = [name for name in roots if name != main and name not in explained]
    named = ", ".join(map(quoted, others[:50])) + (f" and {len(others) - 50} more" if len(others) > 50 else "")
    verb = "is" if len(others) == 1 else "are"
    message = (
        f"{named} {verb} not joined to the robot: no joint has {'it' if len(others) == 1 else 'them'} as its child"
    )
    all_roots = f"roots are {', '.join(map(quoted, [main, *others][:50]))}"
    notes.add(catalogue.TWO_ROOTS, f"{message} ({all_roots}); {_REJECTED}", links[others[0]], "name")


def _check_paths(roots: list[str], edges: Edges, links: dict[str, Element], notes: Notes) -> None:
    into = dict.fromkeys(links, 0)
    for joint in (each for group in edges.values() for each in group):
        into[joint.child] += 1
    paths = dict.fromkeys(roots, 1)
    waiting = list(roots)
    total = 0
    while waiting:
        name = waiting.pop()
        total += paths[name]
        for joint in edges.get(name, ()):
            paths[joint.child] = paths.get(joint.child, 0) + paths[name]
            into[joint.child] -= 1
            if not into[joint.child]:
                waiting.append(joint.child)
    if total > _MOST_PATHS:
        message = "links with two parents multiply the paths through the tree: ROS 2 does not finish loading it"
        notes.add(catalogue.TOO_MANY_PATHS, message, links[roots[0]])
