"""Facts about a ROS 2 package: its name and type, its launch and RViz files, and what a build installs."""

import posixpath
from collections.abc import Iterator
from typing import Any

from grader.authoring.fact import Fact
from grader.package.launch.model import Launch, StartedNode
from grader.package.package import Package
from grader.package.rviz import RvizFile
from grader.text import enumerated

_ABOUT = "The package"
_OWN_KINDS = (".urdf", ".xacro", ".rviz", ".py", ".xml")


def package_facts(package: Package, urdf: str) -> Iterator[Fact]:
    """Yield what is true of a package; `urdf` is the path of the URDF in it, empty if that is elsewhere."""
    manifest = package.manifest
    yield _fact("package", "found", f"There is a package {package.name}", "package_found", name=package.name)
    if manifest is not None and manifest.build_type:
        title = f"The build type is {manifest.build_type}"
        yield _fact("package", "type", title, "package_type", build_type=manifest.build_type)
    if not package.is_cmake:
        yield _fact("setup", "imports", "Every name that setup.py uses is defined", "setup_imports")
    if urdf:
        yield _installed("urdf", urdf)
    yield from _data_facts(package)
    opened: dict[str, str] = {}
    for path in package.launch_files:
        yield from _launch_facts(package, path, opened)
    for path in package.rviz_files:
        yield from _rviz_facts(package, path, opened.get(path, ""))


def _fact(subject: str, aspect: str, title: str, check: str, **arguments: Any) -> Fact:
    return Fact(subject, aspect, title, check, arguments, about=_ABOUT, of_package=True)


def _installed(kind: str, path: str) -> Fact:
    name = posixpath.basename(path)
    return _fact(f"installs {name}", "", f"A build installs {name}", "build_installs", kind=kind, name=name)


def _data_facts(package: Package) -> Iterator[Fact]:
    """Yield a fact for each folder of other files that a build installs, such as meshes."""
    folders: dict[str, None] = {}
    for path in package.installed.values():
        folder = posixpath.dirname(path)
        if folder and folder != "resource" and path not in package.launch_files and not path.endswith(_OWN_KINDS):
            folders.setdefault(f"{folder}/*{posixpath.splitext(path)[1]}")
    for pattern in folders:
        yield _fact(f"installs {pattern}", "", f"A build installs {pattern}", "installs_files", files=[pattern])


def _launch_facts(package: Package, path: str, opened: dict[str, str]) -> Iterator[Fact]:
    name, launch = posixpath.basename(path), package.launch(path)
    yield _fact(name, "found", f"There is a launch file {name}", "launch_found", name=name)
    yield _installed("launch", path)
    names = _started(launch)
    if names:
        yield _fact(name, "nodes", f"{name} starts {enumerated(names)}", "launch_starts", name=name, nodes=names)
    if launch.named("urdf", "rviz", "include"):
        title = f"{name} looks for its files where a build installs them"
        yield _fact(name, "files", title, "launch_finds_files", name=name)
    rviz = package.rviz_opened(launch)
    if rviz is not None:
        opened.setdefault(rviz, name)


def _started(launch: Launch) -> list[str]:
    """Return the nodes that start; one that a condition replaces is an alternative, as joint_state_publisher for its GUI."""
    names = {when: list(dict.fromkeys(_node(it) for it in launch.nodes if it.when is when)) for when in (True, False)}
    alike = {name: [it for it in names[False] if name.startswith(it) or it.startswith(name)] for name in names[True]}
    return [" or ".join(dict.fromkeys((name, *others))) for name, others in alike.items()]


def _node(node: StartedNode) -> str:
    return node.executable if node.package == node.executable else f"{node.package}/{node.executable}"


def _rviz_facts(package: Package, path: str, launch: str) -> Iterator[Fact]:
    name, rviz = posixpath.basename(path), package.rviz(path)
    of: dict[str, Any] = {"name": name, **({"launch": launch} if launch else {})}
    yield _fact(name, "found", f"There is an RViz file {name}", "rviz_found", **of)
    yield _installed("rviz", path)
    if rviz.fixed_frame:
        title = f"The Fixed Frame of {name} is {rviz.fixed_frame}"
        yield _fact(name, "frame", title, "rviz_fixed_frame", **of, frame=rviz.fixed_frame)
    shown = dict.fromkeys((display.package, display.kind) for display in rviz.displays if display.enabled)
    for owner, kind in shown:
        if kind == "RobotModel":
            topic = _topic(rviz)
            title = f"{name} shows the robot{f' of {topic}' if topic else ''}"
            yield _fact(name, "robot", title, "rviz_shows_robot", **of, **({"topic": topic} if topic else {}))
        else:
            title = f"A {kind} display of {name} is on"
            yield _fact(name, f"display {kind}", title, "rviz_display_on", **of, kind=f"{owner}/{kind}")


def _topic(rviz: RvizFile) -> str:
    """Return the topic from which the first RobotModel display reads the robot; empty for the usual one, or none."""
    model = next(display for display in rviz.displays if display.kind == "RobotModel" and display.enabled)
    node = model.node.get("Description Topic", "Value") or model.node.get("Description Topic")
    topic = (node.text or "").strip() if node is not None else ""
    return "" if topic.strip("/") == "robot_description" else topic
