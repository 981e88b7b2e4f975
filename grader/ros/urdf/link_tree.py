"""The tree of links: their parent joints, and what keeps them from being one tree.

Links that are named by their place are here too.

ROS 2 makes the tree in `model.h` (initTree, initRoot) and kdl_parser (addChildrenToTree). A rubric
can name a link by its place in the tree: "@root", "@tip", "@moved:2"; and a joint by the link that
it holds: "@joint:left_wheel".
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import group_values
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.text import counted, enumerated, quoted
from grader.ros.urdf import urdf_problems
from grader.ros.urdf.diagnostics import Problems
from grader.ros.urdf.model import Joint, Joints, Robot
from grader.ros.xml.parsing import Elements

_JointsByLink = dict[str, Joint]

_MAX_PATHS = 10_000_000  # that ROS 2 follows in a reasonable time
_MAX_CYCLES = 10
_MAX_NAMED = 20
_MAX_ROOTS = 50

JOINT_OF = "@joint:"
_SELECTOR = on_use(rf"@(?:root|tip|moved:([1-9]\d{{0,3}}))|{JOINT_OF}(.+)")
_MAX_CHOICES = 5  # links that a name may mean, in a message

_Edges = dict[str, list[Joint]]  # the joints by their parent link


def parent_joints(robot: Robot) -> _JointsByLink:
    """Return the parent joint of each link, by the link's name; a root has none.

    Of two joints with one child the last in name order counts, as in ROS 2. ROS 2 shows nothing of
    a rejected file, so there the most plausible reading counts: no joint that would close a loop,
    rather one whose name contains its child's than one whose name contains only its parent's (these
    two may be swapped), and then the first in the file.
    """
    complete = _complete_joints(robot)
    if robot.rejected:
        return _most_plausible(complete)
    parents: _JointsByLink = {}
    for joint in complete:
        if joint.name >= parents.get(joint.child, joint).name:
            parents[joint.child] = joint
    return parents


def _complete_joints(robot: Robot) -> list[Joint]:
    """Return the joints whose parent and child exist, in file order."""
    return [
        joint
        for joint in robot.joints
        if joint.parent
        and joint.child
        and robot.has_link(joint.parent)
        and robot.has_link(joint.child)
    ]


def _most_plausible(joints: list[Joint]) -> _JointsByLink:
    parents = {}
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


def _implausibility(joint: Joint) -> int:
    """Return how implausible the ends of a joint are by its name.

    This is 0, 1, or 2 if they look swapped.
    """
    if joint.child in joint.name:
        return 0
    return 2 if joint.parent in joint.name else 1


def check_tree(robot: Robot, links: Elements, problems: Problems) -> None:
    """Report everything that keeps the links from being one tree.

    `links` gives their elements by name.
    """
    parents = parent_joints(robot)
    roots = [link.name for link in robot.links if link.name not in parents]
    edges = group_values((joint.parent, joint) for joint in _complete_joints(robot))
    reachable = _reachable(roots, edges)
    if len(roots) == 1 and len(parents) == len(robot.joints) and len(reachable) == len(links):
        return
    _check_two_parents(edges, parents, problems)
    cycles = _cycles(edges, list(links))
    for cycle in cycles:
        _report_cycle(cycle, reachable, problems, has_root=bool(roots))
    _check_roots(robot, roots, edges, links, problems)
    if not cycles:
        _check_paths(roots, edges, links, problems)


def _check_two_parents(edges: _Edges, parents: _JointsByLink, problems: Problems) -> None:
    by_child = group_values((joint.child, joint) for joints in edges.values() for joint in joints)
    for child, rivals in by_child.items():
        if len({joint.name for joint in rivals}) > 1:
            names = " and ".join(quoted(joint.name) for joint in rivals[:_MAX_NAMED])
            taken = f"ROS 2 takes {quoted(parents[child].name)}, the last in name order"
            message = f"link {quoted(child)} is the child of the joints {names}; {taken}"
            problems.add(urdf_problems.TWO_PARENTS, message, problems.element(rivals[1]))


def _reachable(roots: Iterable[str], edges: _Edges) -> set[str]:
    reached = set(roots)
    waiting = list(reached)
    while waiting:
        for joint in edges.get(waiting.pop(), ()):
            if joint.child not in reached:
                reached.add(joint.child)
                waiting.append(joint.child)
    return reached


def _predecessors(edges: _Edges, links: Iterable[str]) -> dict[str, list[str]]:
    before: dict[str, list[str]] = {link: [] for link in links}
    for parent in before:
        for joint in edges.get(parent, ()):
            if joint.child in before:
                before[joint.child].append(parent)
    return before


def _cycles(edges: _Edges, links: list[str]) -> list[list[Joint]]:
    """Return up to `_MAX_CYCLES` loops of joints.

    The links of each are removed before the next is looked for.
    """
    cycles: list[list[Joint]] = []
    rank = {link: number for number, link in enumerate(links)}
    while len(cycles) < _MAX_CYCLES:
        try:
            TopologicalSorter(_predecessors(edges, links)).prepare()
        except CycleError as error:
            *names, _ = error.args[1]
        else:
            break
        # The loop begins with the link that is first in the file.
        first = names.index(min(names, key=rank.__getitem__))
        ring = [*names[first:], *names[:first], names[first]]
        cycle = []
        for parent, child in pairwise(ring):
            cycle.append(next(joint for joint in edges[parent] if joint.child == child))
        cycles.append(cycle)
        in_ring = set(ring)
        links = [link for link in links if link not in in_ring]
    return cycles


def _report_cycle(
    cycle: list[Joint], reachable: set[str], problems: Problems, *, has_root: bool
) -> None:
    shown = (cycle[:_MAX_NAMED] + cycle[-1:]) if len(cycle) > _MAX_NAMED else cycle
    first = cycle[0].parent
    steps = "".join(f"{quoted(joint.parent)} -> " for joint in shown) + quoted(first)
    names = ", ".join(quoted(joint.name) for joint in shown)
    loop = f"joint {names} forms a loop" if len(cycle) == 1 else f"joints {names} form a loop"
    if first in reachable:
        kind = urdf_problems.CYCLE
        message = f"{loop}: {steps}; ROS 2 follows it without end and crashes"
    elif has_root:
        kind = urdf_problems.DETACHED_CYCLE
        message = f"{loop} that is detached from the robot: {steps}; ROS 2 ignores these links"
    else:
        kind = urdf_problems.NO_ROOT
        message = f"there is no root link: {loop}: {steps}; ROS 2 rejects the file"
    problems.add(kind, message, problems.element(cycle[0]))


def _check_roots(
    robot: Robot, roots: list[str], edges: _Edges, links: Elements, problems: Problems
) -> None:
    """Report the links that no joint connects to the robot.

    Those that another problem explains are not reported.
    """
    explained = _explained_roots(robot, links, problems)
    is_child_open = any("child" in joint.unresolved for joint in robot.joints)
    if is_child_open or sum(name not in explained for name in roots) < 2:
        return
    # Of very many roots the first is as good: searching the tree below each takes long.
    candidates = roots if len(roots) <= _MAX_ROOTS else roots[:1]
    main = max(candidates, key=lambda name: len(_reachable([name], edges)))
    others = [name for name in roots if name != main and name not in explained]
    message = _describe_roots(main, others)
    problems.add(urdf_problems.TWO_ROOTS, message, links[others[0]], "name")


def _explained_roots(robot: Robot, links: Elements, problems: Problems) -> set[str]:
    """Return the links whose missing parent joint another problem explains."""
    explained = set()
    for joint in robot.joints:
        if not robot.has_link(joint.parent):
            explained.add(joint.child)
        if not robot.has_link(joint.child):
            explained.add(problems.closest(joint.child, links) or "")
    # Any joint may have a link of an open name as its child.
    explained |= {link.name for link in robot.links if "@name" in link.unresolved}
    return explained


def _describe_roots(main: str, others: list[str]) -> str:
    """Return the message on links that no joint connects to the main root."""
    named = enumerated(map(quoted, others), _MAX_ROOTS)
    verb, them = ("is", "it") if len(others) == 1 else ("are", "them")
    all_roots = ", ".join(map(quoted, [main, *others][:_MAX_ROOTS]))
    return (
        f"{named} {verb} not connected to the robot: no joint has {them} as its child "
        f"(the roots are {all_roots}); ROS 2 rejects the file"
    )


def _check_paths(roots: list[str], edges: _Edges, links: Elements, problems: Problems) -> None:
    paths = dict.fromkeys(links, 0) | dict.fromkeys(roots, 1)
    for name in TopologicalSorter(_predecessors(edges, links)).static_order():
        for joint in edges.get(name, ()):
            paths[joint.child] += paths[name]
    if sum(paths.values()) > _MAX_PATHS:
        message = (
            "links with two parents multiply the paths through the tree: ROS 2 does not finish "
            "loading it"
        )
        problems.add(urdf_problems.TOO_MANY_PATHS, message, links[roots[0]])


class _LinkPlace(Named):
    """The place of a link in its tree: the root, and how many moving joints are above it."""

    root: str
    depth: int
    is_moved: bool  # by its own joint


def is_selector(text: str) -> bool:
    """Return whether a text names a link by its place in the tree, or a joint by its link."""
    return _SELECTOR.fullmatch(text) is not None


def selected_name(robot: Robot, parents: Joints, name: str) -> str:
    """Return the name that a selector means, and any other text as it is.

    `parents` are the parent joints of links.

    Of several trees the one with the most links counts. "@root" is its root. The chain with the
    most moving joints, which are neither fixed nor mimic joints, leads to "@tip", its last link,
    and "@moved:2" is the child of its second moving joint. "@joint:left_wheel" is the parent joint
    of a link.

    Raises MissingElement where there is no such link, NotDecided where several could be meant.
    """
    match = _SELECTOR.fullmatch(name)
    if not match or robot.has_link(name):
        return name
    robot.check_complete()
    if match[2] is not None:
        link = robot.link(match[2]).name
        if link not in parents:
            raise MissingElement("joint", name, message=f"no joint holds {quoted(link)}")
        return parents[link].name
    places = _find_places(robot, parents)
    root = _main_root(places, name)
    places = {link: place for link, place in places.items() if place.root == root}
    if name == "@root":
        return root
    most = max(place.depth for place in places.values())
    if match[1] is None:
        selected = _find_tips(places, parents, most)
    else:
        selected = _links_moved_by(places, parents, int(match[1]), most, name)
    return _only_link(robot, selected, name)


def _find_tips(places: Mapping[str, _LinkPlace], parents: Joints, most: int) -> set[str]:
    """Return the last links of the chains of a tree with the most moving joints."""
    inner = {parents[link].parent for link, place in places.items() if link != place.root}
    return {link for link, place in places.items() if place.depth == most and link not in inner}


def _links_moved_by(
    places: dict[str, _LinkPlace], parents: Joints, number: int, most: int, name: str
) -> set[str]:
    """Return the links that the joint of this number moves.

    They are on the chains with the most moving joints.
    """
    if number > most:
        longest = f"the longest chain has {counted(most, 'moving joint')}"
        raise MissingElement("link", name, message=f"there is no {name}: {longest}")
    on_chain = {link for link, place in places.items() if place.depth == most}
    for link in reversed(places):  # a link comes after its parent
        if link in on_chain and link != places[link].root:
            on_chain.add(parents[link].parent)
    return {link for link in on_chain if places[link].is_moved and places[link].depth == number}


def _find_places(robot: Robot, parents: Joints) -> dict[str, _LinkPlace]:
    """Return the places of the links that are in a tree, each after that of its parent."""
    below = group_values((joint.parent, link) for link, joint in parents.items())
    places = {
        link.name: _LinkPlace(link.name, 0, is_moved=False)
        for link in robot.links
        if link.name not in parents
    }
    waiting = list(places)
    while waiting:
        above = waiting.pop()
        for link in below.get(above, ()):
            is_moving = parents[link].type != "fixed" and not parents[link].mimic
            places[link] = _LinkPlace(
                places[above].root, places[above].depth + is_moving, is_moving
            )
            waiting.append(link)
    return places


def _main_root(places: Mapping[str, _LinkPlace], name: str) -> str:
    sizes = Counter(place.root for place in places.values()).most_common()
    largest = [root for root, size in sizes if size == sizes[0][1]]
    if len(largest) == 1:
        return largest[0]
    if not largest:
        message = "no link is the root of the robot"
    else:
        message = "several links are roots of trees of the same size"
    detail = f": {enumerated(map(quoted, largest), _MAX_CHOICES)}" if largest else ""
    raise MissingElement("link", name, message=f"there is no {name}: {message}", detail=detail)


def _only_link(robot: Robot, links: set[str], name: str) -> str:
    if len(links) > 1:
        reason = f"several links can be {name}"
        in_file = [quoted(link.name) for link in robot.links if link.name in links]
        raise NotDecided(f"{reason}: {enumerated(in_file, _MAX_CHOICES)}", reason)
    return min(links)
