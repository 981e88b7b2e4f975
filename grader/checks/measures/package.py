"""Facts about a ROS 2 package: its name and type, its launch and RViz files, and what a build installs."""

import posixpath
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from grader.checks.measures.fact import THE_PACKAGE, Fact, Facts, Measure, Solution
from grader.package.launch.model import Launch
from grader.package.package import Package
from grader.package.rviz import RvizFile
from grader.text import enumerated

_OWN_KINDS = (".urdf", ".xacro", ".rviz", ".py", ".xml")


def _of_package(rule: Callable[[Package], Iterable[Fact]]) -> Measure:
    """Return what a rule finds in the package, if there is one."""

    def measure(solution: Solution) -> Facts:
        if solution.submission.package is not None:
            yield from rule(solution.submission.package)

    return measure


def _fact(subject: str, aspect: str, title: str, check: str, **arguments: Any) -> Fact:
    return Fact(subject, aspect, title, check, arguments, about=THE_PACKAGE, of_package=True)


def _install_fact(kind: str, path: str) -> Fact:
    name = posixpath.basename(path)
    return _fact(f"installs {name}", "", f"A build installs {name}", "build_installs", kind=kind, name=name)


def _names(package: Package) -> Iterator[Fact]:
    yield _fact("package", "found", f"There is a package {package.name}", "package_found", name=package.name)


def _build_types(package: Package) -> Iterator[Fact]:
    if package.manifest is not None and package.manifest.build_type:
        kind = package.manifest.build_type
        yield _fact("package", "type", f"The build type is {kind}", "package_type", build_type=kind)


def _setup_names(package: Package) -> Iterator[Fact]:
    if not package.is_cmake:
        yield _fact("setup", "imports", "`setup.py` builds", "setup_imports")


def installed_files(solution: Solution) -> Facts:
    """Yield that a build installs the URDF, the launch files and the RViz files."""
    package, path = solution.submission.package, solution.submission.path
    if package is None or path is None:
        return
    if package.holds(path):
        yield _install_fact("urdf", path)
    yield from (_install_fact("launch", path) for path in package.launch_files)
    yield from (_install_fact("rviz", path) for path in package.rviz_files)


def _folder_facts(package: Package) -> Iterator[Fact]:
    """Yield a fact for each folder of other files that a build installs, such as meshes."""
    folders: dict[str, None] = {}
    for path in package.installed.values():
        folder = posixpath.dirname(path)
        if folder and folder != "resource" and path not in package.launch_files and not path.endswith(_OWN_KINDS):
            folders.setdefault(f"{folder}/*{posixpath.splitext(path)[1]}")
    for pattern in folders:
        yield _fact(f"installs {pattern}", "", f"A build installs {pattern}", "installs_files", files=[pattern])


def _launch_files(package: Package) -> Iterator[Fact]:
    for name in map(posixpath.basename, package.launch_files):
        yield _fact(name, "found", f"There is a launch file {name}", "launch_found", name=name)


def _node_facts(package: Package) -> Iterator[Fact]:
    for path in package.launch_files:
        name, nodes = posixpath.basename(path), _nodes_that_start(package.launch(path))
        if nodes:
            title = f"{name} starts {enumerated(nodes)}"
            yield _fact(name, "nodes", title, "launch_starts", name=name, nodes=nodes)


def _file_facts(package: Package) -> Iterator[Fact]:
    for path in package.launch_files:
        name = posixpath.basename(path)
        if package.launch(path).named("urdf", "rviz", "include"):
            title = f"{name} looks for its files where a build installs them"
            yield _fact(name, "files", title, "launch_finds_files", name=name)


def _nodes_that_start(launch: Launch) -> list[str]:
    """Return the nodes that start, with what a condition replaces: joint_state_publisher for its GUI, for example."""
    names = {when: list(dict.fromkeys(it.name for it in launch.nodes if it.when is when)) for when in (True, False)}
    alike = {name: [it for it in names[False] if name.startswith(it) or it.startswith(name)] for name in names[True]}
    return [" or ".join(dict.fromkeys((name, *others))) for name, others in alike.items()]


def _rviz(package: Package) -> Iterator[tuple[str, RvizFile, Mapping[str, Any]]]:
    """Yield the RViz files, each with the arguments that name it: also by the first launch file that opens it."""
    opened: dict[str, str] = {}
    for path in package.launch_files:
        opened.setdefault(package.rviz_opened(package.launch(path)) or "", posixpath.basename(path))
    for path in package.rviz_files:
        name = posixpath.basename(path)
        yield name, package.rviz(path), {"name": name, **({"launch": opened[path]} if path in opened else {})}


def _rviz_files(package: Package) -> Iterator[Fact]:
    for name, _, of in _rviz(package):
        yield _fact(name, "found", f"There is an RViz file {name}", "rviz_found", **of)


def _frame_facts(package: Package) -> Iterator[Fact]:
    for name, rviz, of in _rviz(package):
        if rviz.fixed_frame:
            title = f"The Fixed Frame of {name} is {rviz.fixed_frame}"
            yield _fact(name, "frame", title, "rviz_fixed_frame", **of, frame=rviz.fixed_frame)


def _robot_facts(package: Package) -> Iterator[Fact]:
    for name, rviz, of in _rviz(package):
        if any(display.enabled and display.kind == "RobotModel" for display in rviz.displays):
            topic = _topic(rviz)
            title = f"{name} shows the robot{f' of {topic}' if topic else ''}"
            yield _fact(name, "robot", title, "rviz_shows_robot", **of, **({"topic": topic} if topic else {}))


def _displays(package: Package) -> Iterator[Fact]:
    for name, rviz, of in _rviz(package):
        others = (it for it in rviz.displays if it.enabled and it.kind != "RobotModel")
        for owner, kind in dict.fromkeys((display.package, display.kind) for display in others):
            title = f"A {kind} display of {name} is on"
            yield _fact(name, f"display {kind}", title, "rviz_display_on", **of, kind=f"{owner}/{kind}")


def _topic(rviz: RvizFile) -> str:
    """Return the topic from which the first RobotModel display reads the robot; empty for the usual one, or none."""
    model = next(display for display in rviz.displays if display.kind == "RobotModel" and display.enabled)
    node = model.node.get("Description Topic", "Value") or model.node.get("Description Topic")
    topic = (node.text or "").strip() if node is not None else ""
    return "" if topic.strip("/") == "robot_description" else topic


names = _of_package(_names)
build_types = _of_package(_build_types)
setup_names = _of_package(_setup_names)
installed_folders = _of_package(_folder_facts)
launch_files = _of_package(_launch_files)
started_nodes = _of_package(_node_facts)
opened_files = _of_package(_file_facts)
rviz_files = _of_package(_rviz_files)
fixed_frames = _of_package(_frame_facts)
shown_robots = _of_package(_robot_facts)
displays = _of_package(_displays)
