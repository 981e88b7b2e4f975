"""The facts of a reference: what may be true of it, as arguments of checks that are to be tried on it.

First those of the robot: its file, links, joints and tree. Then those of the elements for simulators and controllers,
which ROS 2 itself does not read, and last those of the package.
"""

import posixpath
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import combinations, permutations
from math import degrees, isfinite
from typing import Any, NamedTuple

from grader.checks.meshes import mesh_file
from grader.checks.outcome import point
from grader.checks.parameters import measures
from grader.checks.visuals import MAX_SHAPES
from grader.errors import MissingElement, NotDecided
from grader.package.launch.model import Launch
from grader.package.launch.places import is_of_one_machine
from grader.package.package import Package
from grader.package.trees import is_path
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Collision, Cylinder, Joint, Link, Mesh, Sphere, Visual
from grader.robot.reader import Reading
from grader.robot.shapes import is_empty
from grader.robot.transforms import rotation_from_rpy
from grader.submission.submission import Submission
from grader.text import enumerated
from grader.workspace.names import FAMILIES, Family
from grader.workspace.reading import read_agreement
from grader.workspace.workspace import Workspace
from grader.xml.elements import attributes_of, foreign_elements, name_of, readable, text_in, words_of_foreign
from grader.xml.parsing import Element

_THE_FILE, _THE_ROBOT, _THE_PACKAGE = "The file", "The robot", "The package"  # headings
_THE_NAMES = "The names"
_NAME_TITLES: Mapping[Family, str] = {
    "files": "every file that is named is where a build installs it",
    "frames": "every frame, link and joint that is named exists",
    "controllers": "spawners, controllers and interfaces fit together",
    "parameters": "every file of parameters has parameters of the nodes that get it",
    "arguments": "every launch and xacro argument that is passed is declared",
    "programs": "every program, entry point and node that is named exists",
    "topics": "topics have the same names, types and quality of service in all nodes",
    "dependencies": "package.xml declares the packages that the files use",
}
_WHEEL = re.compile("wheel|axle|tire|tyre")
_DISTANCE = re.compile("separation|wheel_?base|wheel_?track|track_?width")
_EXACT = 1e-6
_STOPPING: tuple[Family, ...] = ("files", "arguments", "programs")  # what keeps a launch file from starting
_WITH_AXIS = ("continuous", "revolute", "prismatic", "planar")
_COUNTED = ("revolute", "continuous", "prismatic")
_SLIDING_TOLERANCE = 0.002  # m: the tolerance of other limits is in degrees
_MASS_TOLERANCE = 0.001  # kg; of a small mass, a share of it
_MASS_SHARE = 0.01
_MAX_VALUES = 500  # in one element of <robot>: a check compares each with each
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_TRUTH = {"true": True, "false": False}
_TURNED: Mapping[str, str | bool] = {"true": False, "false": True, "True": "False", "False": "True"}
_NAMED_BY = ("reference", "name", "filename", "type")
_OWN_KINDS = (".urdf", ".xacro", ".rviz", ".py", ".xml", ".msg", ".srv", ".action")
_LOOSE_INERTIA = 5.0  # percent, for a solution with rounded numbers
_MAX_TIPS = 20
_Values = dict[str, Any]


class Solution(NamedTuple):
    """A solution: its submission; its URDF as it was read, and the robot that ROS 2 loads, with the joints at 0."""

    submission: Submission
    reading: Reading
    robot: Configuration

    @property
    def root(self) -> Element:
        """The <robot> that it was read from."""
        assert self.reading.root is not None  # ROS 2 loads it
        return self.reading.root


class Fact(NamedTuple):
    """A check with arguments that the reference may pass."""

    about: str  # the heading
    check: str
    arguments: Mapping[str, Any]
    words: str  # of the id
    package: str | None = None  # what it is about: the name of a package, empty for the main one; None for the robot
    causes: tuple[str, ...] = ()  # the words of facts for whose mistakes it costs nothing, if `instead` is true
    instead: "tuple[str, Mapping[str, Any]]" = ("", {})  # a check with its arguments
    otherwise: "Sequence[Fact]" = ()  # tried in its place if the reference does not pass it
    title: str = ""  # default: what the check says
    args: Mapping[str, str | bool] = {}  # launch arguments


class Omission(NamedTuple):
    """Something of the reference that no criterion is about, and why."""

    what: str
    why: str


_Facts = Iterator[Fact | Omission]


def robot_facts(solution: Solution) -> _Facts:
    """Yield what may be true of the file, of each link with its parent joint, and of the robot."""
    robot = solution.robot
    yield Fact(_THE_FILE, "urdf_loads", {}, "urdf_loads")
    for link in robot.robot.links:
        yield from _visual_facts(link)
        joint = robot.parent_joints.get(link.name)
        if joint is not None:
            try:
                yield from _joint_facts(robot, joint)
            except (MissingElement, NotDecided) as error:  # an axis of length zero
                yield Omission(f"{link.name} joint_axis", str(error))
        yield from _body_facts(link)
    if robot.parent_joints:
        yield from _tree_facts(solution)


def _link_fact(link: str, check: str, **arguments: Any) -> Fact:
    return Fact(link, check, {"link": link, **arguments}, f"{link} {check}")


def _robot_fact(check: str, **arguments: Any) -> Fact:
    return Fact(_THE_ROBOT, check, arguments, check)


def _rounded(vector: Sequence[float], digits: int = 6) -> list[float]:
    """Return numbers without what rounding has added: 0.15 for 0.15000000000000002."""
    return [round(value, digits) + 0.0 for value in vector]


def _visual_facts(link: Link) -> _Facts:
    """Yield what a link shows; the place and colour of a shape only if no other shape of the link is of its kind."""
    if len(link.visuals) > MAX_SHAPES:
        yield Omission(f"{link.name} visuals", f"it has more than {MAX_SHAPES}")
        return
    shown = [visual for visual in link.visuals if not is_empty(visual.geometry)]
    kinds = Counter(type(visual.geometry) for visual in shown)
    for visual in shown:
        yield _size(link.name, visual)
        if kinds[type(visual.geometry)] == 1:
            is_mesh = isinstance(visual.geometry, Mesh)
            selected = {} if len(kinds) == 1 or is_mesh else {"shape": type(visual.geometry).__name__.lower()}
            if visual.material is not None:
                yield _link_fact(link.name, "shows_colour", **selected, colour=_rounded(visual.material.rgba, 4))
            if not is_mesh:
                xyz = _rounded(visual.origin.xyz)
                yield _link_fact(link.name, "centre_at", **selected, relative_to=link.name, xyz=xyz, **_axis(visual))
    for kind in (kind for kind, number in kinds.items() if number > 1):
        reason = "a check examines one shape of a kind"
        yield Omission(f"place and colour of each {kind.__name__.lower()} of {link.name}", reason)


def _size(link: str, visual: Visual) -> Fact:
    match visual.geometry:
        case Box(size=size):  # along the axes of the link, whichever of its own they are
            first, *others = [_link_fact(link, "shows_box", size=_rounded(edges)) for edges in permutations(size)]
            return first._replace(otherwise=others)
        case Cylinder(radius=radius, length=length):
            return _link_fact(link, "shows_cylinder", radius=round(radius, 6), length=round(length, 6))
        case Sphere(radius=radius):
            return _link_fact(link, "shows_sphere", radius=round(radius, 6))
        case mesh:
            file = "/".join(mesh_file(mesh.filename, is_expanded=True).steps)
            xyz, rpy = _rounded(visual.origin.xyz), _rounded(visual.origin.rpy)
            return _link_fact(link, "shows_mesh", file=file, scale=_rounded(mesh.scale), xyz=xyz, rpy=rpy)


def _axis(visual: Visual) -> dict[str, Any]:
    """Return how the axis of a cylinder lies: 0 1 0 for what rpy="1.57 0 0" makes of it."""
    if not isinstance(visual.geometry, Cylinder):
        return {}
    return {"axis": _rounded(rotation_from_rpy(visual.origin.rpy)[2::3], 2), "angle": 1.0}


def _body_facts(link: Link) -> _Facts:
    """Yield the mass and inertia of a link, and its collision shapes, or that they are those that it shows."""
    if link.inertial is not None:
        least = abs(link.inertial.mass) * _MASS_SHARE
        tolerance = {"tolerance": least} if least < _MASS_TOLERANCE else {}
        yield _link_fact(link.name, "mass_is", mass=link.inertial.mass, **tolerance)
        title = f"the inertia of {link.name!r} is that of a uniform solid of its shapes"
        loose = _link_fact(link.name, "inertia_plausible", tolerance=_LOOSE_INERTIA)._replace(title=title)
        yield _link_fact(link.name, "inertia_plausible")._replace(title=title, otherwise=[loose])
    if len(link.collisions) > MAX_SHAPES:
        yield Omission(f"{link.name} collisions", f"it has more than {MAX_SHAPES}")
        return
    only = {"only": True} if len(link.collisions) == 1 else {}
    shapes = [_collision(link.name, collision, only) for collision in link.collisions]
    if not any(not is_empty(visual.geometry) for visual in link.visuals):
        yield from shapes
    elif shapes:
        yield _link_fact(link.name, "collision_matches_visual")._replace(otherwise=shapes if only else ())


def _collision(link: str, collision: Collision, only: Mapping[str, bool]) -> Fact:
    match collision.geometry:
        case Box(size=size):
            shape: dict[str, Any] = {"box": _rounded(size)}
        case Cylinder(radius=radius, length=length):
            shape = {"cylinder": _rounded((radius, length))}
        case Sphere(radius=radius):
            shape = {"sphere": round(radius, 6)}
        case _:
            return _link_fact(link, "collision_matches_visual")
    xyz, rpy = _rounded(collision.origin.xyz), _rounded(collision.origin.rpy, 4)
    return _link_fact(link, "collides_as", **shape, xyz=xyz, rpy=rpy, **only)


def _joint_facts(robot: Configuration, joint: Joint) -> Iterator[Fact]:
    """Yield what may be true of the parent joint of a link; raise MissingElement for an axis of length zero."""
    link, parent = joint.child, joint.parent
    title = f"a {joint.type} joint connects {link!r} to {parent!r}"  # its name is free
    yield _link_fact(link, "held_by", parent=parent, joint_type=joint.type)._replace(title=title)
    pose = robot.pose(link, relative_to=parent)
    xyz, rpy = _rounded(pose.translation), _rounded(pose.rpy, 4)
    title = f"the frame {link!r} is at {point((*xyz,))} m in {parent!r}"
    if any(rpy):
        title += f", with rpy {point((*_rounded([*map(degrees, rpy)], 1),))} degrees"
    turned = {"rpy": rpy} if any(rpy) else {}
    yield _link_fact(link, "frame_at", relative_to=parent, xyz=xyz, **turned)._replace(title=title)
    if joint.limit is not None and joint.type in ("revolute", "prismatic"):
        ends = (joint.limit.lower, joint.limit.upper)
        turns = joint.type == "revolute"
        lower, upper = _rounded([degrees(end) for end in ends], 1) if turns else _rounded(ends)
        given = {"effort": joint.limit.effort, "velocity": joint.limit.velocity}
        others = {name: value for name, value in given.items() if isfinite(value)}
        others |= {} if turns else {"tolerance": _SLIDING_TOLERANCE}
        unit = "degrees" if turns else "m"
        title = f"the range of the joint that moves {link!r} is {lower:g} to {upper:g} {unit}"
        yield _link_fact(link, "joint_limits", lower=lower, upper=upper, **others)._replace(title=title)
    if joint.dynamics is not None and joint.type != "fixed":
        friction, damping = joint.dynamics.friction, joint.dynamics.damping
        title = f"the joint that moves {link!r} has friction {friction:g} and damping {damping:g}"
        yield _link_fact(link, "joint_dynamics", friction=friction, damping=damping)._replace(title=title)
    mimic = joint.mimic
    if mimic is not None and joint.type != "fixed" and robot.robot.has_joint(mimic.joint):
        leader = robot.joint(mimic.joint).child
        yield _link_fact(link, "mimics", leader=leader, multiplier=mimic.multiplier, offset=mimic.offset)
    if joint.type in _WITH_AXIS:
        own = robot.axis(joint)
        direction = _rounded(pose.rotate(own), 2)
        title = f"the axis of the joint that moves {link!r} points along {point((*direction,))} in {parent!r}"
        axis = _link_fact(link, "joint_axis", relative_to=parent, direction=direction)._replace(title=title)
        in_own_frame = {"link": link, "relative_to": link, "direction": _rounded(own, 2)}
        yield axis._replace(causes=(f"{link} frame_at",), instead=("joint_axis", in_own_frame))


def _tree_facts(solution: Solution) -> Iterator[Fact]:
    """Yield the names of joints that other elements use, the root, the numbers of joints, and how the tips move."""
    robot = solution.robot
    joints, root = robot.parent_joints.values(), robot.main_tree[0]
    words = words_of_foreign(solution.root)
    used = {joint.name: joint.child for joint in joints if joint.name in words}
    if used:
        yield _robot_fact("joints_named", parent=root, joints=used)
    fixed = (joint.child for joint in joints if joint.parent == root and joint.type == "fixed")
    yield _robot_fact("root_of_tree", link=root, holds=next(fixed, root))
    moving = [joint for joint in joints if joint.type != "fixed"]
    kinds = Counter(joint.type for joint in moving)
    numbers = {"moving": sum(joint.mimic is None for joint in moving), **{kind: kinds[kind] for kind in _COUNTED}}
    yield _robot_fact("counts", **numbers)
    inner = {joint.parent for joint in joints}
    chains = {name: robot.chain(name) for name in robot.main_tree if name not in inner}
    tips = [name for name, chain in chains.items() if any(joint.type != "fixed" for joint in chain)]
    if tips:
        names = [repr(tip) for tip in tips[:_MAX_TIPS]]
        title = f"{enumerated(names)} {'moves' if len(names) == 1 else 'move'} as in the reference solution"
        known = [f"{joint.child} {check}" for joint in joints for check in ("frame_at", "joint_axis", "mimics")]
        motion = _robot_fact("kinematics_match_reference", links=tips[:_MAX_TIPS], match="order")
        yield motion._replace(title=title, causes=tuple(known), instead=("counts", numbers))


def element_facts(solution: Solution) -> _Facts:
    """Yield the values in each element for simulators and controllers."""
    for element in foreign_elements(solution.root):
        about = f"<{name_of(element)}>"
        if sum(1 + len(inner.attrib) for inner in element.iter()) > _MAX_VALUES:
            yield Omission(_label(element), f"it has more than {_MAX_VALUES} elements and attributes")
            continue
        conditions = "".join(f"[@{key}='{value}']" for key, value in attributes_of(element))
        for label, path, values in _element_values(element):
            at = f"{name_of(element)}{conditions}{f'/{path}' if path else ''}"
            if is_path(at):
                yield Fact(about, "entry_is", {"at": at, **({"values": values} if values else {})}, label)
            else:
                yield Omission(label, "a path cannot name it")


def _element_values(element: Element) -> Iterator[tuple[str, str, _Values]]:
    """Yield the plain values in an element, then those in each child that has elements or attributes.

    Each has a label, the path of the child, and values by their paths in it.
    """
    plain: _Values = {}
    deep: list[Element] = []
    for child in _children(element):
        if _children(child) or child.attrib:
            deep.append(child)
        else:
            _add(plain, name_of(child), _value(text_in(child)))
    if plain or not deep:
        yield _label(element), "", plain
    for child in deep:
        yield f"{_label(element)} {_label(child)}", name_of(child), _values_by_path(child)


def _values_by_path(element: Element, path: str = "") -> _Values:
    """Return all attributes and texts in an element by their paths; of repeated ones a list."""
    found: _Values = {}
    for key, text in element.attrib.items():
        _add(found, f"{path}@{key!s}", _value(str(text)))
    for child in _children(element):
        inner = f"{path}{name_of(child)}"
        if not _children(child) and (text_in(child) or not child.attrib):
            _add(found, inner, _value(text_in(child)))
        for key, value in _values_by_path(child, f"{inner}/").items():
            _add(found, key, value)
    return found


def _add(found: _Values, key: str, value: Any) -> None:
    """Add a value, unless it is a path that exists on one machine only; of several values with one path, a list."""
    if isinstance(value, str) and is_of_one_machine(value):
        return
    if key not in found:
        found[key] = value
    else:
        before = found[key] if isinstance(found[key], list) else [found[key]]
        found[key] = before + (value if isinstance(value, list) else [value])


def _value(text: str) -> str | bool | int | float:
    """Return the text of an element or attribute as a rubric writes it: a number, true or false, else a string."""
    word = readable(text.strip())
    if word in _TRUTH:
        return _TRUTH[word]
    if _NUMBER.fullmatch(word) and isfinite(number := float(word)):
        return int(word) if re.fullmatch(r"-?(?:0|[1-9]\d{0,14})", word) else number
    return " ".join(word.split())


def _children(element: Element) -> list[Element]:
    return [child for child in element if isinstance(child.tag, str)]


def _label(element: Element) -> str:
    """Return the tag and the name of an element."""
    return f"{name_of(element)} {next((str(element.get(key)) for key in _NAMED_BY if element.get(key)), '')}"


def package_facts(submission: Submission) -> _Facts:
    """Yield what may be true of the packages that are graded, first of the main one."""
    path, main = submission.path, submission.package
    packages = sorted(submission.lab_packages.values(), key=lambda it: it is not main)
    found = read_agreement(submission) if packages else None
    named = found.files if found is not None and found.holds("files") else frozenset()
    families = [it for it in _STOPPING if found is not None and found.holds(it)]
    causes = tuple(f"{family} names_agree" for family in families)
    for package in packages:
        facts = _facts_of(package, path if path is not None and package.holds(path) else "", named, causes)
        if package is main:
            yield from facts
            continue
        about = f"{_THE_PACKAGE} {package.name}"
        for fact in facts:
            yield fact._replace(about=about, package=package.name, words=f"{package.name} {fact.words}")


def _facts_of(package: Package, path: str, named: Collection[str], causes: tuple[str, ...]) -> Iterator[Fact]:
    """Yield what may be true of a package, in which the URDF has this path.

    That the files are installed which are `named` somewhere is a fact about names; `causes` are these facts.
    """
    yield _package_fact("package_found", name=package.name)
    if package.manifest is not None and package.manifest.build_type:
        yield _package_fact("package_type", build_type=package.manifest.build_type)
    yield _package_fact("setup_imports")._replace(title="`colcon build` of the package succeeds")
    yield from _installs(package, path, named)
    for launch in (it for it in package.launch_files if not it.startswith("test/")):
        yield from _launch_facts(package, launch, causes)
    yield from _rviz_facts(package)


def measure_facts(solution: Solution) -> Iterator[Fact]:
    """Yield the parameters of nodes that are a radius in the robot, or a distance between two links."""
    workspace = Workspace(solution.submission)
    links = [link.name for link in solution.robot.robot.links]
    for node, given in workspace.parameter_owners.items():
        for name, found in {name: it for one in given for name, it in one.values.items()}.items():
            words = {*name.split("_")}
            alike = sorted(links, key=lambda it: (not _WHEEL.search(it), -len(words & {*it.split("_")})))
            sizes = _sizes_meant(name, alike)
            if sizes is None or not isinstance(found.value, float):
                continue
            measure, candidates = sizes
            fits = (it for it in candidates if _is_measured(solution.robot, measure, it, found.value))
            if (fitting := next(fits, None)) is not None:
                what = {"node": node, "parameter": name, "measure": measure, "links": [*fitting]}
                fact = _package_fact("parameter_is", f"{node} {name}", **what)
                of = enumerated([repr(link) for link in fitting])
                yield fact._replace(about=_THE_NAMES, title=f"{name} of {node} is the {measure} of {of} in the robot")


def _sizes_meant(name: str, links: Sequence[str]) -> tuple[str, Iterable[tuple[str, ...]]] | None:
    """Return what a parameter measures by its name, and of which links it may be; None for any other parameter."""
    if "radius" in name:
        return "radius", ((link,) for link in links)
    return ("distance", combinations(links, 2)) if _DISTANCE.search(name) else None


def _is_measured(robot: Configuration, measure: str, links: tuple[str, ...], value: float) -> bool:
    """Return whether a value is a measure of links."""
    try:
        found = measures(robot, [*links]).get(measure)
        return found is not None and abs(found() - value) <= _EXACT
    except (MissingElement, NotDecided):
        return False


def name_facts(submission: Submission) -> _Facts:
    """Yield that the names of each family that the packages use agree, or why they do not."""
    if submission.package is None:
        return
    found = read_agreement(submission)
    for family in (it for it in FAMILIES if it in found.families):
        yield _package_fact("names_agree", f"{family}", of=family)._replace(
            about=_THE_NAMES, title=_NAME_TITLES[family]
        )


def _package_fact(check: str, label: str = "", **arguments: Any) -> Fact:
    return Fact(_THE_PACKAGE, check, arguments, f"{label} {check}".strip(), package="")


def _installs(package: Package, urdf: str, named: Collection[str]) -> Iterator[Fact]:
    """Yield that a build installs the URDF, the launch and RViz files, and a file of each other folder."""
    own = {target: path for target, path in package.installed.items() if target.startswith(package.share)}
    elsewhere = {path for target, path in own.items() if any(f"{target}/".startswith(f"{it}/") for it in named)}
    installed = [path for path in own.values() if path not in elsewhere]
    launches = [path for path in package.launch_files if path in installed or not path.startswith("test/")]
    kinds = {"urdf": [urdf] if urdf else [], "launch": launches, "rviz": package.rviz_files}
    kinds = {kind: [path for path in paths if path not in elsewhere] for kind, paths in kinds.items()}
    for kind, paths in kinds.items():
        for name in map(posixpath.basename, paths):
            yield _package_fact("build_installs", name, kind=kind, name=name, despite_errors=True)
    patterns = {
        f"{folder}/*{posixpath.splitext(path)[1]}": None
        for path in installed
        if (folder := posixpath.dirname(path)) not in ("", "resource")
        and path not in package.launch_files
        and not path.endswith(_OWN_KINDS)
    }
    yield from (_package_fact("installs_files", pattern, files=[pattern], despite_errors=True) for pattern in patterns)


def _launch_facts(package: Package, path: str, causes: tuple[str, ...]) -> Iterator[Fact]:
    name, launch = posixpath.basename(path), package.launch(path)
    yield _package_fact("launch_found", name, name=name)
    instead = ("launch_found", {"name": name})
    if nodes := _nodes_that_start(launch):
        yield _package_fact("node_runs", name, launch=name, nodes=nodes)._replace(causes=causes, instead=instead)
    yield from (fact._replace(causes=causes, instead=instead) for fact in _turned_facts(package, path))
    if launch.named("urdf", "rviz", "include"):
        yield _package_fact("launch_finds_files", name, name=name)._replace(causes=causes, instead=instead)


def _turned_facts(package: Package, path: str) -> Iterator[Fact]:
    """Yield what a launch file starts in addition, and no more, if one of its boolean arguments is turned round."""
    launch, name = package.launch(path), posixpath.basename(path)
    before = _started(launch)
    for argument, value in dict(launch.values).items():
        turned = _TURNED.get(value)
        if turned is None:
            continue
        text = str(turned).lower() if isinstance(turned, bool) else turned
        after = _started(package.under({argument: text}).launch(path))
        nodes, absent = ([it for it in one if it not in other] for one, other in ((after, before), (before, after)))
        given = {key: names for key, names in (("nodes", nodes), ("not", absent)) if names}
        if given:
            starts = f"starts {enumerated(nodes)}" if nodes else f"does not start {enumerated(absent)}"
            fact = _package_fact("node_runs", f"{name} {argument}", launch=name, **given)
            title = f"with {argument}:={text}, the launch file {starts}"
            yield fact._replace(args={argument: turned}, title=title)


def _started(launch: Launch) -> list[str]:
    return list(dict.fromkeys(it.name for it in launch.nodes if it.when))


def _nodes_that_start(launch: Launch) -> list[str]:
    """Return the nodes that start, with what a condition replaces: joint_state_publisher for its GUI, for example."""
    names = {when: list(dict.fromkeys(it.name for it in launch.nodes if it.when is when)) for when in (True, False)}
    alike = {name: [it for it in names[False] if name.startswith(it) or it.startswith(name)] for name in names[True]}
    return [" or ".join(dict.fromkeys((name, *others))) for name, others in alike.items()]


def _rviz_facts(package: Package) -> Iterator[Fact]:
    """Yield what may be true of each RViz file, which is also found by the first launch file that opens it."""
    opened: dict[str, str] = {}
    for path in package.launch_files:
        opened.setdefault(package.rviz_opened(package.launch(path)) or "", posixpath.basename(path))
    for path in package.rviz_files:
        rviz, name = package.rviz(path), posixpath.basename(path)
        of = {"name": name, **({"launch": opened[path]} if path in opened else {})}
        yield _package_fact("rviz_found", name, **of)
        if rviz.fixed_frame:
            yield _package_fact("rviz_fixed_frame", name, **of, frame=rviz.fixed_frame)
        displays = dict.fromkeys((display.package, display.kind) for display in rviz.displays if display.enabled)
        for owner, kind in displays:
            if kind == "RobotModel":
                yield _package_fact("rviz_shows_robot", name, **of)
            else:
                yield _package_fact("rviz_display_on", f"{name} {kind}", **of, kind=f"{owner}/{kind}")
