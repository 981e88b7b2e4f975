"""Harnesses of the files of a ROS 2 package, each beside files that it can name."""

from collections.abc import Callable, Mapping
from functools import partial

from grader.base.source import Location
from grader.files.tree import Tree, make_tree
from grader.ros.config.rviz import read_rviz
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.ros.installation.cmake.cmake_lists import read_cmake
from grader.ros.installation.manifest import read_manifest
from grader.ros.installation.setup_py import read_setup
from grader.ros.launch.launch_file import read_launch
from grader.ros.nodes.cpp.cpp_nodes import read_cpp_nodes
from grader.ros.package.finding import read_packages
from grader.ros.python.parse import Position, parse
from tests.checks.submissions import file_of
from tests.fuzz.harness import check_location, check_message, decoded
from tests.installation.my_robot import FILES
from tests.launch.launch_samples import Installed

_TREE = make_tree(
    "my_robot", [file_of(path, text.format(path).encode()) for path, text in FILES.items()], ()
)
_LAUNCHES = {
    "share/my_robot/launch/other.launch.py": b"from launch import LaunchDescription\n"
    b"def generate_launch_description():\n    return LaunchDescription([])\n",
    "share/my_robot/launch/other.launch.xml": b'<launch><include file="$(dirname)/other.launch.yaml"/></launch>',
    "share/my_robot/launch/other.launch.yaml": b"launch:\n- arg: {name: a, default: b}\n",
}


def with_file(path: str, data: bytes) -> Tree:
    """Return the files of the package with another one."""
    kept = [file for file in _TREE.files.values() if file.path != path]
    return make_tree("my_robot", [*kept, file_of(path, data)], ())


def setup(data: bytes) -> None:
    """What a setup.py installs are files of the package, at paths below the prefix; what is wrong has a place."""
    text = _python_text(data)
    found = read_setup(data, "setup.py", with_file("setup.py", data))
    for copy in found.copies:
        assert copy.source in {*_TREE.files, "setup.py"}
        assert ".." not in copy.target.split("/"), copy
    if found.fault is not None:
        _check(found.fault.message, found.fault.location, text)
    places: list[tuple[str, Position]] = [(fault.message, fault.at) for fault in found.stops]
    places += [(fault.message, fault.at) for fault in found.faults]
    places += [(it.reason, it.at) for it in found.unknown]
    places += [(empty.pattern, empty.at) for empty in found.empty if empty.pattern]
    for message, at in places:
        _check(message, found.location(at), text)


def launch(data: bytes, ending: str) -> None:
    """A launch file of any language, and those that it includes, are evaluated; what is found has a place."""
    path = f"launch/my.launch.{ending}"
    installed = f"share/my_robot/{path}"
    found = read_launch(data, path, installed, Installed({**_LAUNCHES, installed: data}))
    text = _TEXTS[ending](data)
    faults = [*found.faults, *found.unknown, *([found.syntax] if found.syntax is not None else [])]
    for fault in faults:
        _check(fault.message, fault.location, text)
    for reference in found.references:
        assert reference.path is not None or reference.reason
        check_location(reference.location, {path: text})
    for node in (*found.nodes, *found.forgotten):
        check_location(node.location, {path: text})
    assert all(frame is None or frame[:1] != "/" for frame in found.list_frames("base_link"))


def cmake(data: bytes) -> None:
    """A CMakeLists.txt installs only files that the package has; what is found has a place."""
    tree, text = with_file("CMakeLists.txt", data), data.decode("utf-8", "replace")
    found = read_cmake(text, "CMakeLists.txt", tree, "my_robot")
    assert {copy.source for copy in found.copies} <= {*tree.files}
    for at in (*(stop.at for stop in found.stops), *(unknown.at for unknown in found.unknown)):
        check_location(found.location(at), {"CMakeLists.txt": text})


_CPP_CMAKE = (
    b"project(my_robot)\nfind_package(ament_cmake REQUIRED)\nfind_package(rclcpp_components REQUIRED)\n"
    b"add_executable(a src/a.cpp)\nadd_library(b src/a.cpp)\n"
    b'rclcpp_components_register_node(b PLUGIN "A" EXECUTABLE c)\nament_package()\n'
)
_CPP_MANIFEST = b"<package format='3'><name>my_robot</name><export><build_type>ament_cmake</build_type></export></package>"


def cpp(data: bytes) -> None:
    """What the nodes in a C++ file declare and open has a place and a plain name; what is wrong has a message."""
    files = {"package.xml": _CPP_MANIFEST, "CMakeLists.txt": _CPP_CMAKE, "src/a.cpp": data}
    tree = make_tree("my_robot", [file_of(path, text) for path, text in files.items()], ())
    [package] = read_packages(tree, "urdf/a.urdf")
    found = read_cpp_nodes(package)
    texts = {path: decoded(text) for path, text in files.items()}
    for node in found.nodes:
        check_location(node.location, texts)
        places = [it.location for it in node.endpoints]
        places += [it.location for it in node.parameters]
        places += [it.location for it in node.doubts]
        places += [it.location for it in node.frames]
        for place in places:
            check_location(place, texts)
        for endpoint in node.endpoints:
            assert endpoint.name is None or not endpoint.parts
            assert endpoint.type is None or endpoint.type.count(".") == 2
    for fault in found.faults:
        check_message(fault.message)
        check_location(fault.location, texts)
    for program in found.programs:
        check_location(program.location, texts)


def manifest(data: bytes) -> None:
    """A package.xml has a name and a build type, or problems with their places."""
    found = read_manifest(data, "package.xml")
    for problem in found.problems:
        _check(problem.message, problem.location, decoded(data))
    texts = {"package.xml": decoded(data)}
    check_location(found.name_location, texts)
    check_location(found.type_location, texts)
    assert found.name is None or found.name.strip(" \n\r\t") == found.name != ""  # as catkin_pkg


def rviz(data: bytes) -> None:
    """An RViz file has displays and a frame, each with its place."""
    found = read_rviz(data, "my.rviz")
    texts = {"my.rviz": yaml_text(data)}
    for problem in found.problems:
        _check(problem.message, problem.location, texts["my.rviz"])
    check_location(found.frame_location, texts)
    for display in found.displays:
        check_location(display.location, texts)
        assert isinstance(display.enabled, bool)


def yaml(data: bytes) -> None:
    """YAML is read into values with places, or has a fault with one."""
    texts = {"a.yaml": yaml_text(data)}
    try:
        root = read_yaml(data, "a.yaml")
    except YamlFault as fault:
        _check(str(fault), fault.location, texts["a.yaml"])
        return
    pending, seen = [root], set[int]()
    while pending:
        node = pending.pop()
        if id(node) not in seen:
            seen.add(id(node))
            check_location(node.location, texts)
            inside = node.value.values() if isinstance(node.value, dict) else node.items
            pending += [it for it in inside if isinstance(it, YamlNode)]


def yaml_text(data: bytes) -> str:
    """Return the text of a YAML file."""
    is_wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    return data.decode("utf-16" if is_wide else "utf-8", "replace")


def _python_text(data: bytes) -> str:
    return parse(data, "setup.py").source.text


_TEXTS = {"py": _python_text, "xml": decoded, "yaml": yaml_text}


def _check(message: str, location: Location, text: str) -> None:
    check_message(message)
    check_location(location, {location.path: text})


LAUNCHES: Mapping[str, Callable[[bytes], None]] = {
    ending: partial(launch, ending=ending) for ending in ("py", "xml", "yaml")
}
