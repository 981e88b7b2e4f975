"""Headers that C++ files include: whether they exist, and whether a build installs them."""

import posixpath
import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from grader.base.names import near
from grader.base.source import Source
from grader.base.text import quoted
from grader.ros.known.released import is_released
from grader.ros.package.installed_files import are_installs_known
from grader.ros.package.package import CMAKE, Package
from grader.workspace.model.text_files import FILES_A_PART
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Fact, Mismatch, cost_of_guess
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
_GENERATORS = re.compile(
    r"\b(?:configure_file|generate_export_header|generate_parameter_library|add_custom_command"
    r"|add_subdirectory|FetchContent\w*|ExternalProject\w*|protobuf_generate\w*|execute_process"
    r"|qt\d?_wrap\w*|add_custom_target|include)\s*\(",
    re.IGNORECASE,
)
_FOUND_PACKAGE = re.compile(r"\bfind_package\s*\(\s*([^\s)]+)", re.IGNORECASE)
# What finds headers without a package.
_FINDS_OTHERS = re.compile(
    r"\b(?:find_path|find_file|find_library|pkg_\w+|include_directories|target_include_directories"
    r"|add_compile_options|target_compile_options)\s*\(",
    re.IGNORECASE,
)
_OF_INTERFACES = re.compile(r"/(?:msg|srv|action)/|/rosidl_|visibility_control")


def header_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the headers of the workspace that compiled files include and that the compiler lacks.

    What a build may make, and what a submodule or an unread file may have, is not compared.
    """
    folder = workspace.folder
    if folder.absent_submodules or folder.tree.ignored or folder.tree.links:
        return
    headers = _headers_by_name(workspace)
    for package in workspace.packages:
        setup = package.installation
        if setup is None or not setup.is_cmake or setup.doubt is not None:
            continue
        for header in _included_by_targets(workspace, package):
            yield Compared("builds")
            yield from _missing(workspace, package, header, headers)


class _Header(NamedTuple):
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
                headers.setdefault(posixpath.basename(path), []).append(_Header(package, path))
    return headers


def _included_by_targets(workspace: Workspace, package: Package) -> Iterator[IncludedHeader]:
    """Yield what the sources of targets include, and what the own headers that they include do."""
    assert package.installation is not None
    sources = workspace.texts.read_sources(package, CPP_FILES)
    texts = {source.path.removeprefix(package.path("")): source for source in sources}
    by_name: dict[str, list[str]] = {}
    for path in texts:
        by_name.setdefault(posixpath.basename(path), []).append(path)
    pending: dict[str, Source] = {}
    for target in package.installation.targets:
        for path in target.sources:
            if path in texts and target.is_installed and not OF_TESTS.search(path):
                pending[path] = texts[path]
    seen: set[str] = set()
    while pending:
        path, source = pending.popitem()
        seen.add(path)
        for header in included_headers(source):
            workspace.charge(1)
            yield header
            for other in by_name.get(posixpath.basename(header.path), ()):
                if other not in seen and f"/{other}".endswith(f"/{header.path}"):
                    pending[other] = texts[other]


def _missing(
    workspace: Workspace, package: Package, header: IncludedHeader, headers: _Headers
) -> Iterator[Mismatch]:
    """Yield that the compiler does not find a header."""
    having = []
    for other in headers.get(posixpath.basename(header.path), ()):
        if f"/{other.path}".endswith(f"/{posixpath.normpath(header.path).lstrip('./')}"):
            having.append(other)
    if any(other.package is package for other in having):
        return
    first, _, rest = header.path.partition("/")
    owner = package.find(first)
    if not having and rest and owner is not None:
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
) -> Iterator[Mismatch]:
    """Yield that a package has no header at a path in its own folder."""
    setup = owner.installation
    is_made = _OF_INTERFACES.search(header.path) or workspace.code.interfaces[owner.name].types
    if setup is None or not setup.is_cmake or setup.doubt is not None or is_made:
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
    own_names = {package.name for package in workspace.packages}
    return all(name in own_names or is_released(name) for name in _FOUND_PACKAGE.findall(text))


def _misspelt(
    workspace: Workspace, package: Package, header: IncludedHeader, headers: _Headers
) -> Iterator[Mismatch]:
    """Yield that a package has a header with a similar name, and nothing has one of this name."""
    setup = package.installation
    if setup is None or _GENERATORS.search(setup.source.text):
        return
    names = _names_in(headers, package)
    workspace.charge(cost_of_guess(len(names)))
    if near(header.path, names) is not None:
        message = f"the package has no header {quoted(header.path)}, so the file does not compile"
        yield _with_guess(workspace, message, header, headers, package)


_OWN_HEADER = Rule(
    "own-header",
    "builds",
    NOT_COMPILED,
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
    workspace.charge(cost_of_guess(len(names)))
    meant = near(posixpath.basename(header.path), names)
    guess = f"; did you mean {quoted(meant)}?" if meant is not None else ""
    return Mismatch(_OWN_HEADER, f"{message}{guess}", header.location, word=header.path)


def _names_in(headers: _Headers, package: Package) -> list[str]:
    """Return the names of the headers that a package has."""
    names = []
    for name, having in headers.items():
        if any(header.package is package for header in having):
            names.append(name)
    return names


_HEADER_INSTALLED = Rule(
    "header-installed",
    "builds",
    NOT_COMPILED,
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


def _not_installed(package: Package, owned: _Header, header: IncludedHeader) -> Iterator[Mismatch]:
    """Yield that a build does not install the header of another package."""
    owner, setup = owned.package, owned.package.installation
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
