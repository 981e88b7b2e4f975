"""The form of package.xml, setup.py and setup.cfg: what the tools accept and warn of, or ignore."""

import re

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.base.text import cut, enumerated, quoted
from grader.ros.installation.manifest import DeclaredDependency, Manifest
from grader.ros.package.package import Package
from grader.ros.package.setup_version import versions_in
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import FORM, NO_BUILD, Rule, Symptom

# By Package.validate() of catkin_pkg, which warns of others.
_NAME = on_use(r"[a-z][a-z0-9_-]*")
_INTERFACE = on_use(r"(?:msg|srv|action)/[A-Z]\w*+\.(?:msg|srv|action)")
_DASHED = on_use(r"^(script-dir|install-scripts)[ \t]*+[=:]", re.MULTILINE)
_MAX_SHOWN = 40  # characters of a text


_PYTHON_BUILD_TYPE = Rule(
    "python-build-type",
    "builds",
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


def package_form_facts(workspace: Workspace) -> Facts:
    """Yield what is of no use or deprecated in the files of packages of ROS 2.

    These are dependencies that are declared twice, texts between elements, names with capitals,
    another version in setup.py, keys with dashes in setup.cfg, and a setup.py that colcon does not
    read because package.xml has no build type.
    """
    for package in workspace.packages:
        manifest = package.manifest
        if not manifest or manifest.refusals or package.is_of_ros1:
            continue
        yield Compared("builds")
        yield from _repeated_dependencies(manifest)
        yield from _loose_texts(manifest)
        yield from _capital_names(manifest)
        setup = package.installation
        if setup and not setup.is_cmake:
            yield from _other_versions(manifest, setup.source)
            if not manifest.has_build_type:
                message = (
                    "package.xml has no build type, so colcon does not build the package with "
                    "setup.py: write <export><build_type>ament_python</build_type></export>"
                )
                wrong = warning(_PYTHON_BUILD_TYPE, message, manifest.name_location)
                yield wrong.offering("", "<export><build_type>ament_python</build_type></export>")
            yield from _interfaces_in_python(package)
            for source in workspace.texts.read_sources(package, ("setup.cfg",)):
                yield from _dashed_keys(source)


_INTERFACES_GENERATED = Rule(
    "interfaces-generated",
    "builds",
    NO_BUILD,
    "Messages, services and actions are in a package that CMake builds.",
    why=(
        "Only rosidl_generate_interfaces() of CMake generates them. An import of the message "
        "then stops with ModuleNotFoundError."
    ),
    wrong="""
<package format="3">
  <name>rover</name>
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
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    frame="own/package.xml",
    beside={
        "../rover/msg/Speed.msg": "float32 speed",
        "../rover/CMakeLists.txt": """
cmake_minimum_required(VERSION 3.8)
project(rover)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME} "msg/Speed.msg")
install(DIRECTORY launch urdf DESTINATION share/${PROJECT_NAME})
ament_package()
""",
    },
    at="rover/msg/Speed.msg",
)


def _interfaces_in_python(package: Package) -> Mismatches:
    """Yield the first interface in a package that setup.py builds, which generates none."""
    paths = [path for path in package.tree.files if _INTERFACE.fullmatch(path)]
    if paths:
        message = (
            "setup.py does not generate messages, services or actions: move them to a package with "
            "CMakeLists.txt and rosidl_generate_interfaces()"
        )
        yield warning(_INTERFACES_GENERATED, message, Location(package.path(min(paths)), 1, 1))


_DEPENDENCY_ONCE = Rule(
    "dependency-once",
    "builds",
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


def _repeated_dependencies(manifest: Manifest) -> Mismatches:
    """Yield the dependencies that a package.xml declares again, under no condition."""
    repeated = []
    first: dict[tuple[str, str], DeclaredDependency] = {}
    for declared in manifest.declared:
        key = (declared.name, declared.tag)
        if key in first and not (declared.is_conditional or first[key].is_conditional):
            repeated.append(declared)
        first.setdefault(key, declared)
    if repeated:
        names = enumerated(dict.fromkeys(quoted(declared.name) for declared in repeated))
        yield warning(_DEPENDENCY_ONCE, f"package.xml declares {names} twice", repeated[0].location)


_MANIFEST_TEXT = Rule(
    "manifest-text",
    "builds",
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


def _loose_texts(manifest: Manifest) -> Mismatches:
    """Yield the first text between elements of a package.xml."""
    for text, at in manifest.loose_texts[:1]:
        shown = quoted(cut(text, _MAX_SHOWN))
        message = f"package.xml has the text {shown} after this element, which nothing reads"
        yield warning(_MANIFEST_TEXT, message, at)


_PACKAGE_NAME = Rule(
    "package-name",
    "builds",
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


def _capital_names(manifest: Manifest) -> Mismatches:
    """Yield a name of which catkin_pkg warns."""
    if manifest.name is not None and not _NAME.fullmatch(manifest.name):
        message = (
            f"the name of the package {manifest.name!r} should begin with a small letter, and have "
            "small letters, digits and underscores only"
        )
        yield warning(_PACKAGE_NAME, message, manifest.name_location)


_PACKAGE_VERSION = Rule(
    "package-version",
    "builds",
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


def _other_versions(manifest: Manifest, setup: Source) -> Mismatches:
    """Yield that setup() in setup.py is given another version than package.xml has."""
    for version, at in versions_in(setup) if manifest.version else ():
        if version != manifest.version:
            message = f"setup.py has the version {version}, package.xml {manifest.version}"
            yield warning(_PACKAGE_VERSION, message, at, manifest.name_location)


_SETUP_KEY = Rule(
    "setup-key",
    "builds",
    FORM,
    "The keys of setup.cfg have underscores, and no dashes.",
    why=(
        "Newer setuptools warn at each build that they will not support keys with dashes. "
        "Without script_dir, ros2 run finds no program of the package."
    ),
    symptoms=(
        Symptom(
            "dash-separated",
            pattern=r"Usage of dash-separated '(?P<key>[\w-]{1,100}+)' will not be supported",
            source="pypa/setuptools 7d53128, setuptools/dist.py:635",
            sentence="setup.cfg has a key with a dash; nothing fails yet.",
            example=(
                "UserWarning: Usage of dash-separated 'script-dir' will not be supported in "
                "future versions."
            ),
            within=("key",),
        ),
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


def _dashed_keys(source: Source) -> Mismatches:
    """Yield the first key with a dash."""
    dashed = _DASHED.search(source.text)
    if dashed:
        meant = dashed[1].replace("-", "_")
        message = f"setuptools deprecates the key {dashed[1]}: write {meant}"
        wrong = warning(_SETUP_KEY, message, source.at(dashed.start(1)))
        yield wrong.offering(dashed[1], meant)
