"""What CMakeLists.txt does not do with the C++ files of a package: compile them, install them."""

import posixpath
import re
from collections.abc import Collection, Iterator

from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.ros.installation import package_problems as kinds
from grader.ros.installation.cmake.cmake_values import reachable_packages
from grader.ros.installation.installation import CmakeTarget, Installation
from grader.ros.known.cmake_words import cmake_words
from grader.ros.package.package import Package

_SOURCES = (".cpp", ".cc", ".cxx")
_INTERFACES = (".msg", ".srv", ".action")
_MAX_BYTES = 256 * 1024
_MAX_FILES = 50
_COMMENT = on_use(r"//[^\n]*|/\*.*?(?:\*/|\Z)", re.DOTALL)
_PROGRAM = on_use(r"\bint\s+main\s*\(|^[^\S\n]*+RCLCPP_COMPONENTS_REGISTER_NODE\b", re.MULTILINE)
_COMMENT_OF_CMAKE = on_use(r"#\[=*+\[.*?(?:\]=*+\]|\Z)|#[^\n]*", re.DOTALL)
_INCLUDE = on_use(r"^[ \t]*#[ \t]*include[ \t]*[\"<](\w+)/", re.MULTILINE)
# Other ways to find headers: of all packages, or by their folders.
_OTHER_WAYS = on_use(
    r"ament_auto|_INCLUDE_DIR|(?<!target_)link_libraries\(|target_link_libraries\(\s*\$"
)
_LINKED = on_use(r"target_link_libraries\(\s*+([^\s()]++)")
_OF_TESTS = on_use(r"(^|/)tests?/|(^|/|_)test_|_test\.")


def cmake_problems(package: Package, setup: Installation) -> Iterator[Problem]:
    """Yield programs, targets and packages that CMakeLists.txt forgets.

    These are programs that no target compiles, targets that no install() names, and packages that a
    target needs. A target whose sources are not known may compile any file, and says nothing of the
    others.
    """
    for unclosed in setup.unclosed:
        message = f"{unclosed.message}, so CMake takes it for text"
        yield Problem(kinds.UNCLOSED, message, setup.location(unclosed.at))
    if setup.doubt or setup.stops:
        return
    for target in setup.targets:
        if target.is_certain:
            yield from _target_problems(package, setup, target)
    if not setup.unknown and all(target.is_certain for target in setup.targets):
        yield from _not_compiled(package, setup)


def _target_problems(
    package: Package, setup: Installation, target: CmakeTarget
) -> Iterator[Problem]:
    """Yield that a target is not installed, and the packages that it needs."""
    is_of_tests = any(_OF_TESTS.search(path) for path in target.sources)
    is_left_out = not target.is_installed and not setup.unknown
    if is_left_out and target.sources and not is_of_tests:
        yield from _not_installed(package, setup, target)
    if not target.links and not is_of_tests:
        yield from _not_linked(package, setup, target)


def _not_installed(package: Package, setup: Installation, target: CmakeTarget) -> Iterator[Problem]:
    at = setup.location(target.at)
    is_ros = any("rclcpp" in _read_text(package, path) for path in target.sources[:_MAX_FILES])
    message = f"no install() names the target {target.name!r}, so "
    if target.kind == "executable" and is_ros:
        yield Problem(kinds.NOT_INSTALLED, f"{message}ros2 run does not find it", at)
    elif target.components:
        yield Problem(kinds.NOT_INSTALLED, f"{message}nothing can load its components", at)
    elif target.is_shared:
        for other in setup.targets:
            if other.is_installed and target.name in other.links:
                message += (
                    f"{other.name!r}, which links it, does not find the library when it starts"
                )
                yield Problem(kinds.NOT_INSTALLED, message, at)
                return


def _not_linked(package: Package, setup: Installation, target: CmakeTarget) -> Iterator[Problem]:
    """Yield packages whose headers a target includes and that it does not depend on.

    Neither ament_target_dependencies() names them nor what it names exports them.
    """
    exports = cmake_words().exports
    text = setup.source.text  # what it links may be a package, as ${sensor_msgs_TARGETS}
    if _OTHER_WAYS.search(text) or target.name in _LINKED.findall(text):
        return
    if not target.packages:
        return
    included: dict[str, str] = {}
    for path in target.sources[:_MAX_FILES]:
        for name in _INCLUDE.findall(_read_text(package, path)):
            included.setdefault(name, path)
    others = set()
    if {*target.packages} <= exports.keys():
        reached = reachable_packages(target.packages)
        others |= (exports.keys() & included.keys()) - reached - {package.name}
    if not any(package.find(name) for name in target.packages):
        # No package of ROS 2 exports one of the workspace.
        others |= {name for name in included if _is_of_interfaces(package, name, exports)}
    for name, path in included.items():
        if name in others:
            message = (
                f"{path} includes headers of {name}, but the target {target.name!r} does not "
                f"depend on it: see ament_target_dependencies()"
            )
            yield Problem(kinds.NOT_LINKED, message, setup.location(target.at))


def _is_of_interfaces(package: Package, name: str, known: Collection[str]) -> bool:
    """Return whether a package beside another one generates headers of messages."""
    beside = package.find(name) if name not in known and name != package.name else None
    return beside is not None and any(path.endswith(_INTERFACES) for path in beside.tree.files)


def _not_compiled(package: Package, setup: Installation) -> Iterator[Problem]:
    compiled = {path for target in setup.targets for path in target.sources}
    paths = [path for path in package.tree.files if path.endswith(_SOURCES)]
    unread = ("test/", *package.inner)
    commented = " ".join(_COMMENT_OF_CMAKE.findall(setup.source.text))
    others = [path for path in paths if path not in compiled and not path.startswith(unread)]
    others = [path for path in others if not _is_named(path, commented)]
    for path in others[:_MAX_FILES]:
        text = _read_text(package, path)
        if "rclcpp" in text and _PROGRAM.search(text) and not _OF_TESTS.search(path):
            message = f"no target of CMakeLists.txt compiles {path}"
            yield Problem(kinds.NOT_COMPILED, message, setup.location(setup.targets[-1].at))


def _is_named(path: str, text: str) -> bool:
    """Return whether a text names a file."""
    return re.search(rf"\b{re.escape(posixpath.basename(path))}\b", text) is not None


def _read_text(package: Package, path: str) -> str:
    """Return the text of a file without comments; empty for one that is not read."""
    data = package.tree.read(path, _MAX_BYTES)
    if data is None or not package.budget.take_of_whole(len(data) // 16):
        return ""
    return _COMMENT.sub("", data.decode("utf-8", "replace"))
