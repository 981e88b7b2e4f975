"""Libraries of Python and C++ that are no packages of ROS 2: whether package.xml declares them."""

from collections.abc import Collection, Iterator

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.known.rosdep_words import rosdep_words
from grader.ros.package.package import Package
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
)
from grader.workspace.rules.rule_table import (
    BROUGHT,
    NO_DEPENDENCY,
    Rule,
)
from grader.workspace.rules.used_packages import imported_modules, required_by_cmake

# What differs between the names of one library in keys, in pip and in apt.
_BEFORE = on_use(r"\A(?:python3?-)?(?:py(?=[a-z])|lib)?")
_ENDINGS = ("dev", "all", "pip", "python", "core")


class _LibraryUse(Named):
    """A library that a file uses, by its key; `name` is the module, or what CMake finds."""

    key: str
    name: str
    location: Location
    is_built: bool


def library_facts(workspace: Workspace) -> Facts:
    """Yield the libraries that a package uses, and that its package.xml does not declare.

    These are the modules that installed Python files import without a condition, and what
    CMakeLists.txt requires. A module of the workspace with the name of a library is meant instead.
    Where a package that is declared installs the library, too, it is a note, and nothing in C++.
    """
    own_modules = _modules_of_workspace(workspace)
    for package in workspace.packages:
        manifest = package.manifest
        if not manifest or manifest.refusals or package.is_of_ros1:
            continue
        declared = {*manifest.dependencies}
        names = {_library_name(name) for name in declared}
        seen = set()
        for use in _used_libraries(workspace, package, own_modules):
            if use.key in seen:
                continue
            seen.add(use.key)
            yield Compared("keys")
            if not _is_declared(use, declared, names):
                yield from _undeclared(package, use, declared)


def _used_libraries(
    workspace: Workspace, package: Package, own_modules: Collection[str]
) -> Iterator[_LibraryUse]:
    """Yield the libraries that the files of a package use."""
    words = rosdep_words()
    for imported in imported_modules(workspace, package):
        is_needed = imported.is_installed and not (imported.is_launched or imported.is_nested)
        if is_needed and imported.name in words.modules and imported.name not in own_modules:
            key = words.modules[imported.name]
            yield _LibraryUse(key, imported.name, imported.location, is_built=False)
    for required, at in required_by_cmake(package):
        if required.name in words.libraries and not required.is_for_tests:
            key = words.libraries[required.name]
            yield _LibraryUse(key, required.name, at, is_built=True)


def _is_declared(use: _LibraryUse, declared: set[str], names: Collection[str]) -> bool:
    """Return whether a library is declared: by a key of its own, or by those of its parts.

    `names` are what the names of what is declared have in common with other names.
    """
    keys = {use.key, use.name, *rosdep_words().alike.get(use.key, ())}
    if not declared.isdisjoint(keys) or not {_library_name(key) for key in keys}.isdisjoint(names):
        return True
    parts = tuple(f"{_library_name(key)}-" for key in keys)
    return use.is_built and any(
        name.startswith("lib") and _library_name(name).startswith(parts) for name in declared
    )


_LIBRARY_DECLARED = Rule(
    "library-declared",
    "keys",
    NO_DEPENDENCY,
    "package.xml declares the libraries of Python and C++ that the files of the package use.",
    why=(
        "rosdep does not install the library. On another machine the import raises "
        "ModuleNotFoundError, or the compiler does not find the header."
    ),
    wrong="<exec_depend>rclpy</exec_depend>",
    right="<exec_depend>python3-serial</exec_depend>",
    frame="python/package.xml",
    beside={
        "driver.py": """
import serial


def main():
    serial.Serial('/dev/ttyUSB0')
""",
    },
    at="rover/driver.py",
    doubtful_kind=BROUGHT,
)


def _undeclared(package: Package, use: _LibraryUse, declared: Collection[str]) -> Mismatches:
    """Yield that package.xml does not declare a library."""
    assert package.manifest
    is_brought = _is_brought(package, use.key, declared)
    if is_brought and use.is_built:
        return
    message = f"package.xml of {package.name!r} does not declare {use.key!r}, which is used here"
    start = package.manifest.name_location
    wrong = Mismatch(_LIBRARY_DECLARED, message, use.location, start, not is_brought)
    tag = "depend" if use.is_built else "exec_depend"
    yield wrong._replace(word=use.name, lacked=use.key, tag=tag)


def _is_brought(package: Package, key: str, declared: Collection[str]) -> bool:
    """Return whether a package that is declared, or one that it declares, installs a library."""
    installing = rosdep_words().brought.get(key, frozenset())
    if not installing.isdisjoint(declared):
        return True
    for name in declared:
        other = package.find(name)
        inner = other.manifest.dependencies if other and other.manifest else ()
        if key in inner or not installing.isdisjoint(inner):
            return True
    return False


def _modules_of_workspace(workspace: Workspace) -> set[str]:
    """Return the names of the modules and packages of Python in the workspace."""
    modules = set()
    for package in workspace.packages:
        modules.add(package.name)
        if package.installation:
            modules |= {name.partition(".")[0] for name in package.installation.packages}
    return modules


def _library_name(name: str) -> str:
    """Return what the names of a library have in common: numpy of python3-numpy."""
    parts = _BEFORE.sub("", name.lower().replace("_", "-")).split("-")
    while len(parts) > 1 and parts[-1] in _ENDINGS:
        parts.pop()
    return "-".join(parts)
