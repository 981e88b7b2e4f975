"""Every problem of the files around a URDF, with its stable code. `docs/problems.md` is generated from it."""

from grader.problems import Kind, Severity, kinds_in


def _kind(code: str, severity: Severity, title: str, explanation: str) -> Kind:
    return Kind(code, title, explanation, severity, "other")


BAD_MANIFEST = _kind(
    "PKG001", "error", "Unreadable package.xml",
    "colcon finds packages by their package.xml. It ignores a package whose package.xml is not well-formed XML or has "
    "another root than <package>, and does not build it.",
)  # fmt: skip
INCOMPLETE_MANIFEST = _kind(
    "PKG002", "warning", "package.xml without a required element",
    "REP 149 requires a name, a version, a description, at least one maintainer with an email, and at least one "
    "license. Tools that validate packages reject a package without one of these.",
)  # fmt: skip
STILL_TO_DO = _kind(
    "PKG003", "note", "License, maintainer or description is still TODO",
    "ros2 pkg create writes TODO into these elements. The package builds; replace the text before others use it.",
)  # fmt: skip
OLD_FORMAT = _kind(
    "PKG004", "note", "Old format of package.xml",
    "ROS 2 packages use format 2 or 3. Format 1 has no test_depend and no exec_depend.",
)  # fmt: skip
OTHER_NAME = _kind(
    "PKG005", "warning", "Different package names in package.xml and setup.py",
    "The name in package.xml, the name in setup.py and the folder below share/ have to be the same. Otherwise launch "
    "files and ros2 run search in the wrong folder.",
)  # fmt: skip
SETUP_SYNTAX = _kind(
    "PKG010", "error", "Syntax error in setup.py",
    "The message is Python's own; the mistake is often just before the location that it names, such as a bracket that "
    "is not closed.",
)  # fmt: skip
SETUP_NAME = _kind(
    "PKG011", "error", "Undefined name in setup.py",
    "Python stops at a name that is not defined, and nothing is installed. Most often an import is missing.",
)  # fmt: skip
SETUP_STOPS = _kind(
    "PKG012", "error", "Entry of data_files that cannot be installed",
    "setuptools installs files one by one. It stops with an error at a file that does not exist and at a folder. A "
    "pattern such as glob('urdf/*') also matches folders; glob('urdf/*.urdf') matches the files only.",
)  # fmt: skip
EMPTY_GLOB = _kind(
    "PKG013", "warning", "Pattern in setup.py that matches no file",
    "A glob without a match is not an error: it silently installs nothing. Check the names of the folder and of the "
    "files.",
)  # fmt: skip
NO_MARKER = _kind(
    "PKG014", "warning", "No entry for the resource index",
    "The file share/ament_index/resource_index/packages/<package> registers the package in ROS 2. colcon adds a "
    "missing one and warns that this will change; other tools do not add it.",
)  # fmt: skip
NO_MANIFEST_ENTRY = _kind(
    "PKG015", "warning", "package.xml is not installed",
    "A package installs share/<package>/package.xml. colcon adds a missing one and warns that this will change; other "
    "tools do not add it.",
)  # fmt: skip
SETUP_UNKNOWN = _kind(
    "PKG016", "note", "Cannot be determined statically in setup.py",
    "The grader evaluates setup.py without running it. Where a value depends on the machine, on a loop with an unknown "
    "number of rounds or on unsupported code, the criterion needs manual grading.",
)  # fmt: skip
LAUNCH_SYNTAX = _kind(
    "LCH001", "error", "Unreadable launch file",
    "ros2 launch stops at the first error in Python, XML or YAML. The message is the parser's own; the mistake is "
    "often just before the location that it names.",
)  # fmt: skip
LAUNCH_FAULT = _kind(
    "LCH002", "error", "Error that stops a launch file",
    "ros2 launch stops and starts nothing at an undefined name, an undeclared argument, or a LaunchDescription that is "
    "not returned.",
)  # fmt: skip
HARD_CODED = _kind(
    "LCH003", "warning", "Path that exists on one machine only",
    "Let ROS 2 find the package: get_package_share_directory or FindPackageShare in Python, $(find-pkg-share my_robot) "
    "in XML and YAML.",
)  # fmt: skip
LAUNCH_UNKNOWN = _kind(
    "LCH004", "note", "Cannot be determined statically in a launch file",
    "The grader evaluates launch files without running them. Where a node or path depends on the machine or on "
    "unsupported code, the criterion needs manual grading.",
)  # fmt: skip
BAD_RVIZ = _kind(
    "RVZ001", "error", "Unreadable RViz file",
    "RViz saves its configuration as YAML. It ignores a file that is not YAML and shows its default configuration.",
)  # fmt: skip
ROS1_CLASS = _kind(
    "RVZ002", "warning", "Display class of ROS 1",
    "RViz shows an error instead of the display. Add the display in RViz of ROS 2 and save the file again.",
)  # fmt: skip
NO_TF = _kind(
    "RVZ003", "note", "No TF display",
    "The TF display draws the axes of every frame. RViz shows the robot without it, too.",
)  # fmt: skip

PACKAGE_CATALOGUE = kinds_in(globals().values())
