"""The kinds of problems of the files around a URDF.

docs/examples/ explains each one: pkg.toml, lch.toml, rvz.toml.
"""

from grader.base.problems import Kind, Severity, kinds_in


def _kind(code: str, severity: Severity, title: str) -> Kind:
    return Kind(code, title, severity, "other")


BAD_MANIFEST = _kind("PKG001", "error", "Unreadable package.xml")
REFUSED_MANIFEST = _kind("PKG002", "error", "package.xml that the tools of ROS 2 refuse")
STILL_TO_DO = _kind("PKG003", "note", "License, maintainer or description is still TODO")
OLD_FORMAT = _kind("PKG004", "note", "Old format of package.xml")
OTHER_NAME = _kind("PKG005", "warning", "Different package names in package.xml and setup.py")
QUOTED_EMAIL = _kind("PKG006", "warning", "Email in quotes in package.xml")
SETUP_SYNTAX = _kind("PKG010", "error", "Syntax error in setup.py or CMakeLists.txt")
SETUP_NAME = _kind("PKG011", "error", "Error that stops setup.py")
SETUP_STOPS = _kind(
    "PKG012", "error", "Something in setup.py or CMakeLists.txt that a build does not accept"
)
EMPTY_GLOB = _kind(
    "PKG013", "warning", "Pattern in setup.py or CMakeLists.txt that matches no file"
)
NO_MARKER = _kind("PKG014", "warning", "No entry for the resource index")
NO_MANIFEST_ENTRY = _kind("PKG015", "warning", "package.xml is not installed")
SETUP_UNKNOWN = _kind(
    "PKG016", "note", "Cannot be determined statically in setup.py or CMakeLists.txt"
)
IGNORED_ARGUMENT = _kind("PKG017", "warning", "Argument that setup() does not have")
OF_ROS1 = _kind("PKG018", "note", "Package or launch files of ROS 1")
NOT_COMPILED = _kind("PKG019", "warning", "C++ file that no target compiles")
NOT_INSTALLED = _kind("PKG020", "warning", "Target of CMakeLists.txt that is not installed")
NOT_LINKED = _kind("PKG021", "warning", "Package that a target includes and does not depend on")
NO_LAUNCH_FILES = _kind("PKG022", "warning", "Launch files that no build installs")
OLDER_ONLY = _kind("PKG023", "note", "Something in CMakeLists.txt that stops newer releases")
UNCLOSED = _kind("PKG024", "warning", "Generator expression of CMake that is not closed")
PACKAGE_TWICE = _kind("PKG025", "error", "Package that a workspace has twice")
LAUNCH_SYNTAX = _kind("LCH001", "error", "Unreadable launch file")
LAUNCH_FAULT = _kind("LCH002", "error", "Error that stops a launch file")
HARD_CODED = _kind("LCH003", "warning", "Path that exists on one machine only")
LAUNCH_UNKNOWN = _kind("LCH004", "note", "Cannot be determined statically in a launch file")
BAD_RVIZ = _kind("RVZ001", "error", "Unreadable RViz file")
ROS1_CLASS = _kind("RVZ002", "warning", "Display class of ROS 1")
NO_TF = _kind("RVZ003", "note", "No TF display")
MESH_PATH = _kind("RVZ004", "warning", "Mesh that RViz does not find")

PACKAGE_CATALOGUE = kinds_in(globals().values())
