"""Every kind of problem that the files around a URDF can have, with its stable code. `docs/problems.md` is made from it."""

from grader.problems import Kind, Severity, kinds_in


def _kind(code: str, severity: Severity, title: str, explanation: str) -> Kind:
    return Kind(code, severity, "other", title, explanation)


BAD_MANIFEST = _kind(
    "PKG001",
    "error",
    "A package.xml that cannot be read",
    "colcon finds packages by their package.xml. One that is not well-formed XML, or whose root is not <package>, hides the "
    "package: nothing of it is built.",
)
INCOMPLETE_MANIFEST = _kind(
    "PKG002",
    "warning",
    "A package.xml without what every package needs",
    "REP 149 asks for a name, a version, a description, at least one maintainer with an email, and at least one licence. "
    "Without one of these the package is refused by the tools that check it.",
)
STILL_TO_DO = _kind(
    "PKG003",
    "note",
    "A licence, maintainer or description that is still to do",
    "ros2 pkg create writes TODO where it does not know better. It builds all the same; fill it in before others use it.",
)
OLD_FORMAT = _kind(
    "PKG004",
    "note",
    "An old format of package.xml",
    'ROS 2 packages are written in format 2 or 3: <package format="3">. Format 1 has no test_depend and no exec_depend.',
)
OTHER_NAME = _kind(
    "PKG005",
    "warning",
    "A package with two names",
    "The name in package.xml, the name that setup.py gives and the folder in share/ have to be the same, or launch files and "
    "ros2 run look in the wrong place.",
)
SETUP_SYNTAX = _kind(
    "PKG010",
    "error",
    "A setup.py that Python cannot read",
    "The build stops at the first thing that is not Python. The message is Python's own; the mistake is often just before "
    "the place that it names, such as a bracket that is not closed.",
)
SETUP_NAME = _kind(
    "PKG011",
    "error",
    "A name in setup.py that is not defined",
    "Python stops where a name is used that nothing defines: most often an import is missing, such as `import os` or `from glob "
    "import glob`. Nothing is installed then.",
)
SETUP_STOPS = _kind(
    "PKG012",
    "error",
    "An entry of data_files that cannot be installed",
    "setuptools installs files one by one. At a file that is not there, or at a folder, it stops with an error. A pattern such "
    "as glob('urdf/*') also finds folders: glob('urdf/*.urdf') finds only what is meant.",
)
EMPTY_GLOB = _kind(
    "PKG013",
    "warning",
    "A pattern in setup.py that finds nothing",
    "A glob without a match is no error: it installs nothing, in silence. Look at the spelling of the folder and of the files.",
)
NO_MARKER = _kind(
    "PKG014",
    "warning",
    "No entry for the resource index",
    "A file share/ament_index/resource_index/packages/<package> tells ROS 2 that the package exists. colcon adds one that is "
    "missing and warns that it will not do so for ever; other tools do not.",
)
NO_MANIFEST_ENTRY = _kind(
    "PKG015",
    "warning",
    "package.xml is not installed",
    "share/<package>/package.xml belongs to what is installed. colcon adds it where it is missing and warns that it will not do "
    "so for ever; other tools do not.",
)
SETUP_UNKNOWN = _kind(
    "PKG016",
    "note",
    "Something in setup.py that is told only by running it",
    "The grader reads setup.py and never runs it. Where a value depends on the machine, on a loop without a known end or on "
    "code that is not followed, a person decides.",
)
LAUNCH_SYNTAX = _kind(
    "LCH001",
    "error",
    "A launch file that cannot be read",
    "ros2 launch stops at the first thing that is not Python, XML or YAML. The message is the parser's own; the mistake is often "
    "just before the place that it names.",
)
LAUNCH_FAULT = _kind(
    "LCH002",
    "error",
    "Something that stops a launch file",
    "A name that is not defined, an argument that is not declared, a description that is not returned: ros2 launch stops there, "
    "and starts nothing.",
)
HARD_CODED = _kind(
    "LCH003",
    "warning",
    "A path that exists on one machine only",
    "A path such as /home/me/... is right on one machine. Ask ROS 2 where a package is installed: "
    "get_package_share_directory('my_robot') in Python, FindPackageShare as a substitution, $(find-pkg-share my_robot) in XML.",
)
LAUNCH_UNKNOWN = _kind(
    "LCH004",
    "note",
    "Something in a launch file that is told only by running it",
    "The grader reads launch files and never runs them. Where a node or path depends on the machine or on code that is not "
    "followed, a person decides.",
)
BAD_RVIZ = _kind(
    "RVZ001",
    "error",
    "An RViz file that cannot be read",
    "RViz saves its configuration as YAML. It ignores a file that is none, and shows its defaults.",
)
ROS1_CLASS = _kind(
    "RVZ002",
    "warning",
    "A display of ROS 1",
    "Classes such as rviz/RobotModel are those of ROS 1. RViz of ROS 2 knows rviz_default_plugins/RobotModel, and shows an error "
    "in place of the display. Set the display up in ROS 2's RViz and save the file again.",
)
NO_TF = _kind(
    "RVZ003",
    "note",
    "No TF display",
    "The TF display draws every frame with its axes. The robot is shown without it, too.",
)

PACKAGE_CATALOGUE = kinds_in(globals().values())
