"""Headers that C++ files include: whether they exist, and whether a build installs them."""

import re
from collections.abc import Iterator, Mapping
from posixpath import basename, dirname, join, normpath

from grader.base.names import first_part, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.text import quoted
from grader.ros.interfaces.known_interfaces import known_interfaces
from grader.ros.known.released import is_released
from grader.ros.known.releases import other_name
from grader.ros.package.installed_files import are_installs_known
from grader.ros.package.package import CMAKE, Package
from grader.workspace.model.text_files import FILES_A_PART
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    charge_guess,
)
from grader.workspace.rules.rule_table import (
    NOT_COMPILED,
    Rule,
)
from grader.workspace.rules.used_packages import (
    CPP_FILES,
    HEADERS,
    OF_TESTS,
    IncludedHeader,
    included_headers,
)

# What makes headers while a package is built.
_GENERATORS = on_use(
    r"\b(?:configure_file|generate_export_header|generate_parameter_library|add_custom_command"
    r"|add_subdirectory|FetchContent\w*|ExternalProject\w*|protobuf_generate\w*|execute_process"
    r"|qt\d?_wrap\w*|add_custom_target|include)\s*\(",
    re.IGNORECASE,
)
_FOUND_PACKAGE = on_use(r"\bfind_package\s*\(\s*([^\s)]+)", re.IGNORECASE)
# What finds headers without a package.
_FINDS_OTHERS = on_use(
    r"\b(?:find_path|find_file|find_library|pkg_\w+|include_directories|target_include_directories"
    r"|add_compile_options|target_compile_options)\s*\(",
    re.IGNORECASE,
)
_OF_INTERFACE = on_use(
    r"(?P<package>\w++)/(?P<kind>msg|srv|action)/(?P<name>\w++)\.(?P<ending>hpp|h)"
)
_HUMP = on_use(r"(?<=[a-z0-9])(?=[A-Z])|(?<=.)(?=[A-Z][a-z])")  # as rosidl divides names
_OF_INTERFACES = on_use(r"/(?:msg|srv|action)/|/rosidl_|visibility_control")


def header_facts(workspace: Workspace) -> Facts:
    """Yield the headers of the workspace that compiled files include and that the compiler lacks.

    What a build may make, and what a submodule or an unread file may have, is not compared.
    """
    folder = workspace.folder
    if folder.absent_submodules or folder.tree.ignored or folder.tree.links:
        return
    headers = _headers_by_name(workspace)
    for package in workspace.packages:
        setup = package.installation
        if not setup or not setup.is_cmake or setup.doubt:
            continue
        for header in _included_by_targets(workspace, package):
            yield Compared("builds")
            yield from _missing(workspace, package, header, headers)
            yield from _generated(workspace, package, header)
            yield from _of_release(workspace, package, header)


class _Header(Named):
    """A header of the workspace, by its path in its package."""

    package: Package
    path: str


_Headers = Mapping[str, list[_Header]]


def _headers_by_name(workspace: Workspace) -> _Headers:
    """Return the headers of all packages by their names without folders."""
    headers: dict[str, list[_Header]] = {}
    for package in workspace.folder.found_packages:
        workspace.charge(1 + len(package.tree.files) // FILES_A_PART)
        for path in package.tree.files:
            if path.endswith(HEADERS):
                headers.setdefault(basename(path), []).append(_Header(package, path))
    return headers


def _included_by_targets(workspace: Workspace, package: Package) -> Iterator[IncludedHeader]:
    """Yield what the sources of targets include, and what the own headers that they include do."""
    assert package.installation
    sources = workspace.texts.read_sources(package, CPP_FILES)
    texts = {source.path.removeprefix(package.path("")): source for source in sources}
    by_name: dict[str, list[str]] = {}
    for path in texts:
        by_name.setdefault(basename(path), []).append(path)
    pending = {}
    for target in package.installation.targets:
        for path in target.sources:
            if path in texts and target.is_installed and not OF_TESTS.search(path):
                pending[path] = texts[path]
    seen = set()
    while pending:
        path, source = pending.popitem()
        seen.add(path)
        for header in included_headers(source):
            workspace.charge(1)
            yield header
            for other in by_name.get(basename(header.path), ()):
                if other not in seen and f"/{other}".endswith(f"/{header.path}"):
                    pending[other] = texts[other]


def _missing(
    workspace: Workspace, package: Package, header: IncludedHeader, headers: _Headers
) -> Mismatches:
    """Yield that the compiler does not find a header."""
    having = []
    for other in headers.get(basename(header.path), ()):
        if f"/{other.path}".endswith(f"/{normpath(header.path).lstrip('./')}"):
            having.append(other)
    if any(other.package is package for other in having):
        return
    first, _, rest = header.path.partition("/")
    owner = package.find(first)
    if not having and rest and owner:
        yield from _absent(workspace, package, owner, header, headers)
    elif not having and header.is_quoted and not rest:
        yield from _misspelt(workspace, package, header, headers)
    elif len(having) == 1 and owner is having[0].package:
        yield from _not_installed(package, having[0], header)


def _absent(
    workspace: Workspace,
    package: Package,
    owner: Package,
    header: IncludedHeader,
    headers: _Headers,
) -> Mismatches:
    """Yield that a package has no header at a path in its own folder."""
    setup = owner.installation
    is_made = _OF_INTERFACES.search(header.path) or workspace.code.interfaces[owner.name].types
    if not setup or not setup.is_cmake or setup.doubt or is_made:
        return
    if _GENERATORS.search(setup.source.text):
        return
    if "include" not in owner.tree.folders and not _has_only_ros(workspace, setup.source.text):
        return
    whose = "the package" if owner is package else f"the package {quoted(owner.name)}"
    message = f"{whose} has no header {quoted(header.path)}, so the file does not compile"
    yield _with_guess(workspace, message, header, headers, owner)


def _has_only_ros(workspace: Workspace, text: str) -> bool:
    """Return whether a CMakeLists.txt finds only packages of ROS 2, which have their own headers.

    A library that is none may have the name of the package.
    """
    if _FINDS_OTHERS.search(text):
        return False
    own_names = workspace.own_packages
    return all(name in own_names or is_released(name) for name in _FOUND_PACKAGE.findall(text))


def _misspelt(
    workspace: Workspace, package: Package, header: IncludedHeader, headers: _Headers
) -> Mismatches:
    """Yield that a package has a header with a similar name, and nothing has one of this name."""
    setup = package.installation
    if not setup or _GENERATORS.search(setup.source.text):
        return
    names = _names_in(headers, package)
    charge_guess(workspace, names)
    if near(header.path, names) is not None:
        message = f"the package has no header {quoted(header.path)}, so the file does not compile"
        yield _with_guess(workspace, message, header, headers, package)


_OWN_HEADER = Rule(
    "own-header",
    "builds",
    NOT_COMPILED,
    "The headers of a package that a compiled file includes exist.",
    why=(
        "The compiler stops with 'No such file or directory', and colcon does not build the "
        "package."
    ),
    wrong="""
#include "rover/limit.hpp"
RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)
""",
    right="""
#include "rover/limits.hpp"
RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)
""",
    frame="drive.cpp",
    beside={
        "rover.launch.py": "Node(package='rover', executable='drive_node'),",
        "package.xml": "",
        "parts/CMakeLists.txt": "",
        "../rover/include/rover/limits.hpp": "#pragma once",
    },
)


def _with_guess(
    workspace: Workspace, message: str, header: IncludedHeader, headers: _Headers, owner: Package
) -> Mismatch:
    names = _names_in(headers, owner)
    charge_guess(workspace, names)
    meant = near(basename(header.path), names)
    guess = f"; did you mean {quoted(meant)}?" if meant is not None else ""
    wrong = Mismatch(_OWN_HEADER, f"{message}{guess}", header.location, word=header.path)
    path = join(dirname(header.path), meant) if meant is not None else None
    return wrong.offering(header.path, path)


def _names_in(headers: _Headers, package: Package) -> list[str]:
    """Return the names of the headers that a package has."""
    names = []
    for name, having in headers.items():
        if any(header.package is package for header in having):
            names.append(name)
    return names


_USED_HEADER = Rule(
    "used-header",
    "builds",
    NOT_COMPILED,
    "A header of another package is one that it has, in the stated release.",
    why=(
        "The compiler stops with 'No such file or directory', and colcon does not build the "
        "package."
    ),
    wrong="""
#include "std_msgs/msg/uint16.hpp"
RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)
""",
    right="""
#include "std_msgs/msg/u_int16.hpp"
RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)
""",
    frame="drive.cpp",
    beside={
        "rover.launch.py": "Node(package='rover', executable='drive_node'),",
        "package.xml": "",
        "parts/CMakeLists.txt": "",
    },
)


def _generated(workspace: Workspace, package: Package, header: IncludedHeader) -> Mismatches:
    """Yield that rosidl generates no header of this name, but one that surely is meant."""
    match = _OF_INTERFACE.fullmatch(header.path)
    if not match or package.find(match["package"]):
        return
    known = known_interfaces(match["package"], tuple(workspace.releases)) or {}
    names = [name.rpartition(".")[2] for name in known if name.startswith(match["kind"])]
    headers = {_HUMP.sub("_", name).lower() for name in names}
    charge_guess(workspace, headers)
    meant = near(match["name"], headers) if match["name"] not in headers else None
    if meant is not None:
        path = f"{match['package']}/{match['kind']}/{meant}.{match['ending']}"
        message = f"rosidl generates no {quoted(header.path)}"
        yield Mismatch(_USED_HEADER, message, header.location).meaning(header.path, path)


def _of_release(workspace: Workspace, package: Package, header: IncludedHeader) -> Mismatches:
    """Yield that no stated release has a header of a package of ROS 2.

    What Rolling has depends on the day.
    """
    other = other_name("header", header.path, workspace.releases)
    is_own = package.find(first_part(header.path)) is not None
    if other and not is_own and "rolling" not in workspace.releases:
        message = f"the file does not compile: {other.message}"
        wrong = Mismatch(_USED_HEADER, message, header.location)
        yield wrong.correcting(header.path, other.name)


_HEADER_INSTALLED = Rule(
    "header-installed",
    "builds",
    NOT_COMPILED,
    "A build installs the headers that other packages include.",
    why=(
        "The package itself builds, and the build of the other package stops at the include "
        "with 'No such file or directory'."
    ),
    wrong="""
cmake_minimum_required(VERSION 3.8)
project(wheels)
find_package(ament_cmake REQUIRED)
ament_package()
""",
    right="""
cmake_minimum_required(VERSION 3.8)
project(wheels)
find_package(ament_cmake REQUIRED)
install(DIRECTORY include/ DESTINATION include)
ament_package()
""",
    frame="../wheels/CMakeLists.txt",
    beside={
        "../wheels/package.xml": """
<package format="3">
  <name>wheels</name>
  <version>1.0.0</version>
  <description>A part of a rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
        "../wheels/include/wheels/radius.hpp": "#pragma once",
        "rover.launch.py": "Node(package='rover', executable='drive_node'),",
        "package.xml": "<depend>wheels</depend>",
        "parts/CMakeLists.txt": "",
        "drive.cpp": """
#include "wheels/radius.hpp"
RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)
""",
    },
    at="rover/src/drive.cpp",
)


def _not_installed(package: Package, owned: _Header, header: IncludedHeader) -> Mismatches:
    """Yield that a build does not install the header of another package."""
    owner = owned.package
    setup = owned.package.installation
    user = package.installation
    if setup is None or user is None or not setup.is_cmake or not are_installs_known(owner):
        return
    if ".." in user.source.text or any(
        f"/{target}".endswith(f"/{header.path}") for target in owner.installed
    ):
        return
    message = (
        f"a build of {quoted(owner.name)} installs no header {quoted(header.path)}: no install() "
        f"in its {CMAKE} names {owned.path}, so the file does not compile"
    )
    at = setup.location(setup.called_at)
    yield Mismatch(_HEADER_INSTALLED, message, header.location, at, word=header.path)
