"""The form of package.xml, setup.py and setup.cfg: what the tools accept and warn of, or ignore."""

import re
from collections.abc import Iterator

from grader.base.source import Source
from grader.base.text import cut, enumerated, quoted
from grader.ros.installation.manifest import DeclaredDependency, Manifest
from grader.ros.package.setup_version import versions_in
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Fact, Mismatch, warning
from grader.workspace.rules.rule_table import (
    FORM,
    NO_BUILD,
    Rule,
)

# By Package.validate() of catkin_pkg, which warns of others.
_NAME = re.compile(r"[a-z][a-z0-9_-]*")
_DASHED = re.compile(r"^(script-dir|install-scripts)[ \t]*+[=:]", re.MULTILINE)
_MAX_SHOWN = 40  # characters of a text


_PYTHON_BUILD_TYPE = Rule(
    "python-build-type",
    "builds",
    NO_BUILD,
    NO_BUILD,
    "package.xml of a package with setup.py has a build type.",
    why=(
        "colcon takes the package for a CMake package and stops because it has no "
        "CMakeLists.txt. ros2 run then finds no such package."
    ),
    wrong="""
<package format="3">
  <name>rover</name>
  <version>1.0.0</version>
  <description>A rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
</package>
""",
    right="""
<package format="3">
  <name>rover</name>
  <version>1.0.0</version>
  <description>A rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <export><build_type>ament_python</build_type></export>
</package>
""",
    frame="own/package.xml",
)


def package_form_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what is of no use or deprecated in the files of packages of ROS 2.

    These are dependencies that are declared twice, texts between elements, names with capitals,
    another version in setup.py, keys with dashes in setup.cfg, and a setup.py that colcon does not
    read because package.xml has no build type.
    """
    for package in workspace.packages:
        manifest = package.manifest
        if manifest is None or manifest.refusals or package.is_of_ros1:
            continue
        yield Compared("builds")
        yield from _repeated_dependencies(manifest)
        yield from _loose_texts(manifest)
        yield from _capital_names(manifest)
        setup = package.installation
        if setup is not None and not setup.is_cmake:
            yield from _other_versions(manifest, setup.source)
            if not manifest.has_build_type:
                message = (
                    "package.xml has no build type, so colcon does not build the package with "
                    "setup.py: write <export><build_type>ament_python</build_type></export>"
                )
                yield warning(_PYTHON_BUILD_TYPE, message, manifest.name_location)
            for source in workspace.texts.read_sources(package, ("setup.cfg",)):
                yield from _dashed_keys(source)


_DEPENDENCY_ONCE = Rule(
    "dependency-once",
    "builds",
    FORM,
    FORM,
    "package.xml declares a dependency once.",
    why=(
        "The second line has no effect. If only one of the two is removed, the dependency is still "
        "declared."
    ),
    wrong="""
<exec_depend>rclpy</exec_depend>
<exec_depend>std_msgs</exec_depend>
<exec_depend>rclpy</exec_depend>
""",
    right="""
<exec_depend>rclpy</exec_depend>
<exec_depend>std_msgs</exec_depend>
""",
    frame="python/package.xml",
)


def _repeated_dependencies(manifest: Manifest) -> Iterator[Mismatch]:
    """Yield the dependencies that a package.xml declares again, under no condition."""
    repeated: list[DeclaredDependency] = []
    first: dict[tuple[str, str], DeclaredDependency] = {}
    for declared in manifest.declared:
        key = (declared.name, declared.tag)
        if key in first and not (declared.is_conditional or first[key].is_conditional):
            repeated.append(declared)
        first.setdefault(key, declared)
    if repeated:
        names = enumerated([*dict.fromkeys(quoted(declared.name) for declared in repeated)])
        message = f"package.xml declares {names} twice"
        yield warning(_DEPENDENCY_ONCE, message, repeated[0].location)


_MANIFEST_TEXT = Rule(
    "manifest-text",
    "builds",
    FORM,
    FORM,
    "package.xml has no text beside its elements.",
    why=(
        "The tools ignore the text without a message. A dependency that is written there is "
        "neither installed nor built first."
    ),
    wrong="""
<exec_depend>rclpy</exec_depend>
needs a joystick
""",
    right="""
<exec_depend>rclpy</exec_depend>
<!-- needs a joystick -->
""",
    frame="python/package.xml",
)


def _loose_texts(manifest: Manifest) -> Iterator[Mismatch]:
    """Yield the first text between elements of a package.xml."""
    for text, at in manifest.loose_texts[:1]:
        shown = quoted(cut(text, _MAX_SHOWN))
        message = f"package.xml has the text {shown} after this element, which nothing reads"
        yield warning(_MANIFEST_TEXT, message, at)


_PACKAGE_NAME = Rule(
    "package-name",
    "builds",
    FORM,
    FORM,
    "The name of a package has small letters, digits and underscores.",
    why=(
        "catkin_pkg warns at each build that the name does not follow the naming conventions. "
        "Names are compared exactly, so another case is not found."
    ),
    wrong="""
<package format="3">
  <name>Rover</name>
  <version>1.0.0</version>
  <description>A rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <export><build_type>ament_python</build_type></export>
</package>
""",
    right="""
<package format="3">
  <name>rover</name>
  <version>1.0.0</version>
  <description>A rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <export><build_type>ament_python</build_type></export>
</package>
""",
    frame="own/package.xml",
)


def _capital_names(manifest: Manifest) -> Iterator[Mismatch]:
    """Yield a name of which catkin_pkg warns."""
    if manifest.name is not None and _NAME.fullmatch(manifest.name) is None:
        message = (
            f"the name of the package {manifest.name!r} should begin with a small letter, and have "
            "small letters, digits and underscores only"
        )
        yield warning(_PACKAGE_NAME, message, manifest.name_location)


_PACKAGE_VERSION = Rule(
    "package-version",
    "builds",
    FORM,
    FORM,
    "setup.py has the version that package.xml has.",
    why=(
        "ros2 pkg xml shows one version and the metadata of Python another one. A bug report "
        "may then name a version that was never released."
    ),
    wrong="""
from setuptools import setup

setup(
    name='rover',
    version='0.0.1',
    packages=['rover'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/rover']),
        ('share/rover', ['package.xml']),
        ('share/rover/launch', ['launch/rover.launch.py']),
        ('share/rover/urdf', ['urdf/rover.urdf']),
    ],
)
""",
    right="""
from setuptools import setup

setup(
    name='rover',
    version='1.0.0',
    packages=['rover'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/rover']),
        ('share/rover', ['package.xml']),
        ('share/rover/launch', ['launch/rover.launch.py']),
        ('share/rover/urdf', ['urdf/rover.urdf']),
    ],
)
""",
    frame="own/setup.py",
)


def _other_versions(manifest: Manifest, setup: Source) -> Iterator[Mismatch]:
    """Yield that setup() in setup.py is given another version than package.xml has."""
    for version in versions_in(setup) if manifest.version else ():
        if version.text != manifest.version:
            message = f"setup.py has the version {version.text}, package.xml {manifest.version}"
            yield warning(_PACKAGE_VERSION, message, version.location, manifest.name_location)


_SETUP_KEY = Rule(
    "setup-key",
    "builds",
    FORM,
    FORM,
    "The keys of setup.cfg have underscores, and no dashes.",
    why=(
        "Newer setuptools warn at each build that they will not support keys with dashes. "
        "Without script_dir, ros2 run finds no program of the package."
    ),
    wrong="""
[develop]
script-dir=$base/lib/rover
[install]
install-scripts=$base/lib/rover
""",
    right="""
[develop]
script_dir=$base/lib/rover
[install]
install_scripts=$base/lib/rover
""",
    frame="./setup.cfg",
)


def _dashed_keys(source: Source) -> Iterator[Mismatch]:
    """Yield the first key with a dash."""
    dashed = _DASHED.search(source.text)
    if dashed is not None:
        meant = dashed[1].replace("-", "_")
        message = f"setuptools deprecates the key {dashed[1]}: write {meant}"
        yield warning(_SETUP_KEY, message, source.at(dashed.start(1)))
