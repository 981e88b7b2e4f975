"""Dependencies: whether package.xml of a package declares the packages that its files use."""

from collections.abc import Collection, Mapping, Sequence

from grader.base.names import near
from grader.ros.installation.installation import FoundPackage
from grader.ros.installation.manifest import Manifest
from grader.ros.known.cmake_words import cmake_words
from grader.ros.known.package_rows import package_row
from grader.ros.known.released import is_released, packages_brought_by, rosdep_keys
from grader.ros.package.package import Package
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    charge_guess,
    warning,
)
from grader.workspace.rules.rule_table import (
    BUILT_LATER,
    FORM,
    LENT,
    NO_DEPENDENCY,
    Rule,
)
from grader.workspace.rules.used_packages import PackageUse, used_packages

# Under which other names package.xml may declare the library of a package: keys of rosdep, and
# packages that bring it.
_OTHER_NAMES = ("lib{}-dev", "{}-dev", "lib{}", "{}_vendor", "python3-{}", "python-{}")

_BUILD_TOOL = "ament_cmake"
# What ament_lint_common brings: its package.xml of jazzy.
_LINTERS = frozenset(
    f"ament_cmake_{name}"
    for name in (
        *("copyright", "cppcheck", "cpplint", "flake8"),
        *("lint_cmake", "pep257", "uncrustify", "xmllint"),
    )
)
_FOR_RUN = frozenset({"exec_depend", "test_depend", "doc_depend"})
_FOR_BUILD = frozenset({"build_depend", "buildtool_depend"})
_WITH_NODES = ("rclcpp", "rclcpp_action", "rclcpp_components", "rclcpp_lifecycle", "tf2_ros")


def dependency_facts(workspace: Workspace) -> Facts:
    """Yield the packages that a package uses and does not declare."""
    for package in workspace.packages:
        if not package.manifest or package.manifest.refusals:
            continue
        used = {}
        uses = []
        for use in used_packages(workspace, package):
            uses.append(use)
            # What a launch file of another package starts, that package has to declare.
            if use.name not in used and package.holds(use.location.path):
                used[use.name] = use
                yield Compared("dependencies")
        disordered = {wrong.word: wrong for wrong in _built_before(workspace, package)}
        yield from disordered.values()
        others = {name: use for name, use in used.items() if name not in disordered}
        yield from _undeclared(workspace, package, package.manifest, others)
        yield from _of_other_kind(package, package.manifest, uses)


def _is_sought_here(required: FoundPackage) -> bool:
    """Return whether CMake stops without a package of the workspace, in any build."""
    is_sure = required.is_required and required.is_certain and not required.is_for_tests
    return is_sure and not is_released(required.name)


_BUILD_ORDER = Rule(
    "build-order",
    "dependencies",
    BUILT_LATER,
    "package.xml declares the packages of the workspace that CMake needs.",
    why=(
        "colcon may build the other package later, and find_package() then stops a clean build."
        " In a workspace that was built before, the mistake is hidden."
    ),
    wrong="<depend>rclcpp</depend>",
    right="<depend>wheels</depend>",
    frame="package.xml",
    beside={
        "CMakeLists.txt": "find_package(wheels REQUIRED)",
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
    },
    at="rover/CMakeLists.txt",
)


def _built_before(workspace: Workspace, package: Package) -> Mismatches:
    """Yield the packages of the workspace that CMake needs, and that colcon may build later.

    colcon orders packages by what package.xml declares. What a release has, too, CMake may find
    there.
    """
    setup = package.installation
    manifest = package.manifest
    if not setup or not manifest:
        return
    for required in setup.found_packages:
        needed = package.find(required.name)
        if not needed or needed is package or not _is_sought_here(required):
            continue
        if needed.name in _reached(workspace, package):
            continue
        message = (
            f"CMake needs the package {required.name!r} of the workspace, and package.xml of "
            f"{package.name!r} does not declare it: colcon may build it later, and then the build "
            f"stops; add <depend>{required.name}</depend>"
        )
        at = setup.location(required.at)
        start = manifest.name_location
        wrong = Mismatch(_BUILD_ORDER, message, at, start, word=required.name)
        yield wrong.offering("", f"<depend>{required.name}</depend>", start)


def _reached(workspace: Workspace, package: Package) -> set[str]:
    """Return the packages that package.xml declares, with what those of the workspace declare."""
    pending = [package]
    reached = set()
    while pending:
        manifest = pending.pop().manifest
        for name in manifest.dependencies if manifest else ():
            workspace.charge(1)
            if name not in reached:
                reached.add(name)
                inner = package.find(name)
                pending += [inner] if inner else []
    return reached


DEPENDENCY_DECLARED = Rule(
    "dependency-declared",
    "dependencies",
    NO_DEPENDENCY,
    "package.xml declares the packages that the files of the package use.",
    why=(
        "rosdep installs and colcon builds first only what is declared. On a new machine or in "
        "CI the build or launch file stops at the missing package."
    ),
    wrong="<exec_depend>rviz2</exec_depend>",
    right="<exec_depend>turtlesim</exec_depend>",
    frame="python/package.xml",
    beside={
        "rover.launch.py": "Node(package='turtlesim', executable='turtlesim_node'),",
    },
    at="launch/rover.launch.py",
    doubtful_kind=LENT,
)


def _undeclared(
    workspace: Workspace, package: Package, manifest: Manifest, used: Mapping[str, PackageUse]
) -> Mismatches:
    """Yield the packages that are used and that package.xml does not declare.

    Those that packages of the workspace bring, which are declared, rosdep installs.
    """
    declared = _declared(package)
    brought = _brought_by(package, declared)
    found_with = _found_with(declared)
    start = manifest.name_location
    for name, use in used.items():
        if name in declared or _is_declared_otherwise(name, declared):
            continue
        at = use.location
        charge_guess(workspace, declared)
        meant = near(name, declared)
        if meant is not None and _is_there(package, name) and _is_there(package, meant):
            meant = None  # another package
        guess = _guess(package, manifest, name, meant)
        bringer = brought.get(name) or (found_with.get(name) if use.is_built else None)
        is_linter = name in _LINTERS and "ament_lint_common" in declared
        if use.is_for_tests and (is_linter or bringer is not None):
            continue
        message = f"package.xml of {package.name!r} does not declare {name!r}, which "
        if bringer is None:
            message += f"is used here{guess}"
        else:
            message += (
                f"only {bringer!r} brings: the package builds and runs as long as that needs it"
            )
        lacked = name if not guess else ""
        wrong = Mismatch(DEPENDENCY_DECLARED, message, at, start, bringer is None)
        wrong = wrong.correcting(name, meant, start if meant not in used else None)
        yield wrong._replace(word=name, lacked=lacked, tag=use.tag)


_DEPENDENCY_KIND = Rule(
    "dependency-kind",
    "builds",
    FORM,
    "package.xml declares what a build needs for it, and what a run needs for that.",
    why=(
        "rosdep and the build farm can install build and run dependencies apart. A clean build "
        "or an installed package may then lack this one."
    ),
    wrong="""
<exec_depend>rclcpp</exec_depend>
<depend>rclcpp_components</depend>
""",
    right="""
<depend>rclcpp</depend>
<depend>rclcpp_components</depend>
""",
    frame="package.xml",
    beside={
        "CMakeLists.txt": "",
    },
)


def _of_other_kind(package: Package, manifest: Manifest, uses: Sequence[PackageUse]) -> Mismatches:
    """Yield the packages that a build needs and package.xml declares only for a run, or inversely.

    A C++ program needs the library of a package with nodes when it runs, too.
    """
    tags: dict[str, set[str]] = {}
    for declared in manifest.declared:
        tags.setdefault(declared.name, set()).add(declared.tag)
    places = {declared.name: declared.location for declared in manifest.declared}
    said = set()
    for use in uses:
        name = use.name
        given = tags.get(use.name, set())
        is_here = package.holds(use.location.path)
        if not given or use.is_for_tests or name in said or not is_here:
            continue
        if use.is_built and given <= _FOR_RUN:
            kind = "when it runs"
            other = "build"
        elif (not use.is_built or name in _WITH_NODES) and given <= _FOR_BUILD:
            kind = "to be built"
            other = "run"
        else:
            continue
        message = (
            f"package.xml of {package.name!r} declares {name!r} only for what it needs {kind}, but "
            f"its {other} needs it: write <depend>{name}</depend>"
        )
        said.add(name)
        wrong = warning(_DEPENDENCY_KIND, message, places[name], use.location)
        old, new = (f"<{tag}>{name}</{tag}>" for tag in (max(given), "depend"))
        yield wrong.offering(old, new)


def _guess(package: Package, manifest: Manifest, name: str, meant: str | None) -> str:
    """Return what package.xml has in place of a package that it does not declare."""
    misplaced = manifest.misplaced.get(name)
    if misplaced:
        return f": <export> has it (line {misplaced.line}), where it has no effect"
    if meant is None:
        return ""
    if _is_there(package, name):  # then package.xml has the slip
        return f"; it declares {meant!r}: did you mean {name!r}?"
    return f"; did you mean {meant!r}?"


def _brought_by(package: Package, declared: Collection[str]) -> dict[str, str]:
    """Return what packages of the workspace bring that are declared, with the first that does."""
    brought: dict[str, str] = {}
    for name in sorted(declared):
        dependency = package.find(name)
        if dependency and dependency.manifest:
            for inner in dependency.manifest.dependencies:
                brought.setdefault(inner, name)
    return brought


def _found_with(declared: Collection[str]) -> dict[str, str]:
    """Return what CMake finds with well-known packages that are declared, each with the first."""
    exports = cmake_words().exports
    found_with: dict[str, str] = {}
    for name in sorted(exports.keys() & declared):
        for inner in exports[name].split():
            found_with.setdefault(inner, name)
    return found_with


def _is_declared_otherwise(name: str, declared: Collection[str]) -> bool:
    """Return whether package.xml declares the library of a package by another name."""
    dashed = name.replace("_", "-")
    others = {form.format(each) for form in _OTHER_NAMES for each in (name, dashed)}
    if dashed in rosdep_keys():
        others.add(dashed)
    return not others.isdisjoint(declared)


def _is_there(package: Package, name: str) -> bool:
    """Return whether the workspace or a release has a package."""
    return package.find(name) is not None or is_released(name)


def _declared(package: Package) -> set[str]:
    """Return the dependencies of a package, those that its metapackages bring, and the package."""
    assert package.manifest
    declared = {*package.manifest.dependencies, *package.names}
    for name in [*declared]:
        declared.update(package_row(name).members, packages_brought_by(name))
    # <build_type> names it, and nobody declares the packages that it consists of.
    declared.update((_BUILD_TOOL, *cmake_words().exports[_BUILD_TOOL].split()))
    return declared
