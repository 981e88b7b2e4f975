"""The launch file: its name, the nodes that it starts, and whether the files that it names are installed there."""

import pytest

from grader.checks.launch import launch_finds_files, launch_found, launch_starts
from tests.checks.outcomes import finds, lacks
from tests.checks.submissions import FOLDER, LAUNCH, REFERENCE, RVIZ, SETUP, URDF, Submitted, start_of

NAME = "my_robot_rviz.launch.py"
STATES = "joint_state_publisher or joint_state_publisher_gui"
NODES = ["robot_state_publisher", STATES, "rviz2"]
STARTED = "the launch file starts joint_state_publisher_gui, robot_state_publisher, rviz2"
FOUND = "a build installs share/my_robot/my_robot.urdf and share/my_robot/my_robot.rviz, where the launch file looks"
URDF_PATH, RVIZ_PATH = "os.path.join(share, 'my_robot.urdf')", "os.path.join(share, 'my_robot.rviz')"
READ = """    with open(os.path.join(share, 'my_robot.urdf')) as file:
        robot_description = file.read()
"""
GUI = "        DeclareLaunchArgument('gui', default_value='true', description='Show sliders for the joints'),\n"
RVIZ_NODE = """        Node(
            package='rviz2',
            executable='rviz2',
            arguments=['-d', os.path.join(share, 'my_robot.rviz')],
        ),
"""
XML = "my_robot/launch/my_robot_rviz.launch.xml"
YAML = "my_robot/launch/my_robot_rviz.launch.yaml"
INNER = "my_robot/launch/robot.launch.py"


def launch(old: str, new: str, of: Submitted = REFERENCE) -> Submitted:
    """Return a submission with another text in its launch file."""
    return of.replacing(LAUNCH, old, new)


WITH_IMPORTS = launch(
    "from launch.substitutions import LaunchConfiguration\n",
    "from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution\n"
    "from launch_ros.parameter_descriptions import ParameterValue\n"
    "from launch_ros.substitutions import FindPackageShare\n"
    "import xacro\n",
)


def described(code: str) -> Submitted:
    """Return the reference with another way to load the robot's description."""
    return launch(READ, f"    robot_description = {code}\n", WITH_IMPORTS)


def declaring(argument: str, of: Submitted) -> Submitted:
    """Return a submission that declares another launch argument before the others."""
    return launch(GUI, f"        {argument},\n{GUI}", of)


def starts(submitted: Submitted) -> tuple[str, str, object]:
    """Return the outcome for the nodes that the lab asks for."""
    return finds(launch_starts, submitted, name=NAME, nodes=NODES)


def finds_files(submitted: Submitted) -> tuple[str, str, object]:
    """Return the outcome for the files that the launch file names."""
    return finds(launch_finds_files, submitted, name=NAME)


DISPLAY = REFERENCE.with_files(
    {
        LAUNCH: """\
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    display = PathJoinSubstitution([FindPackageShare('urdf_launch'), 'launch', 'display.launch.py'])
    return LaunchDescription([
        IncludeLaunchDescription(
            display,
            launch_arguments={
                'urdf_package': 'my_robot',
                'urdf_package_path': 'my_robot.urdf',
                'rviz_config': PathJoinSubstitution([FindPackageShare('my_robot'), 'my_robot.rviz']),
            }.items(),
        ),
    ])
"""
    }
)
INCLUDES = REFERENCE.with_files(
    {
        INNER: REFERENCE.files[LAUNCH],
        LAUNCH: """\
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource


def generate_launch_description():
    share = get_package_share_directory('my_robot')
    inner = os.path.join(share, 'launch', 'robot.launch.py')
    return LaunchDescription([IncludeLaunchDescription(PythonLaunchDescriptionSource(inner))])
""",
    }
)
IN_XML = REFERENCE.without(LAUNCH).with_files(
    {
        XML: """\
<launch>
  <arg name="gui" default="true"/>
  <node pkg="joint_state_publisher_gui" exec="joint_state_publisher_gui" if="$(var gui)"/>
  <node pkg="joint_state_publisher" exec="joint_state_publisher" unless="$(var gui)"/>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description" value="$(command 'xacro $(find-pkg-share my_robot)/my_robot.urdf')" type="str"/>
  </node>
  <node pkg="rviz2" exec="rviz2" args="-d $(find-pkg-share my_robot)/my_robot.rviz"/>
</launch>
"""
    }
)
AS_LAUNCH = IN_XML.renaming(XML, XML.removesuffix(".xml"))
IN_YAML = REFERENCE.without(LAUNCH).with_files(
    {
        YAML: """\
launch:
  - arg: {name: gui, default: 'true'}
  - node: {pkg: joint_state_publisher_gui, exec: joint_state_publisher_gui, if: $(var gui)}
  - node:
      pkg: robot_state_publisher
      exec: robot_state_publisher
      param:
        - name: robot_description
          value: $(command 'xacro $(find-pkg-share my_robot)/my_robot.urdf')
          type: str
  - node:
      pkg: rviz2
      exec: rviz2
      args: -d $(find-pkg-share my_robot)/my_robot.rviz
"""
    }
)


# --- Its name ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("submitted", [REFERENCE, IN_XML, IN_YAML, INCLUDES, REFERENCE.renaming(LAUNCH,
    f"{FOLDER}/{NAME}")],
                         ids=["py", "xml", "yaml", "two", "folder"])  # fmt: skip
def test_the_launch_file_is_found_in_any_language(submitted: Submitted) -> None:
    """The name counts, not the language of the launch file, nor its folder, which the check of setup.py grades."""
    path = next(name for name in (LAUNCH, XML, YAML, f"{FOLDER}/{NAME}") if name in submitted.files)
    message = f"the launch file is {path.removeprefix('my_robot/')}"
    assert finds(launch_found, submitted, name=NAME) == ("passed", message, None)


@pytest.mark.parametrize(
    "name",
    [
        "my_robot_rvix.launch.py",
        "display.launch.py",
        "my_robot_rviz.py",
        "my_robot_rviz.launch",
        "my_robot_rviz",
        "my_robot_rviz.launch.py.txt",
    ],
)
def test_another_name_fails_only_the_name(name: str) -> None:
    """A launch file of another name or ending fails the check of its name, and is examined all the same."""
    submitted = REFERENCE.renaming(LAUNCH, f"my_robot/launch/{name}")
    message = f"there is no launch file 'my_robot_rviz.launch.py'; the package has launch/{name}"
    assert finds(launch_found, submitted, name=NAME) == ("failed", message, None)
    assert starts(submitted) == ("passed", STARTED, None)


def test_the_launch_file_with_the_expected_name_is_graded() -> None:
    """Of several launch files the one with the expected name is examined; else the one with the most similar name."""
    broken = "import nothing\n"
    several = REFERENCE.with_files({"my_robot/launch/a.launch.py": broken})
    assert finds(launch_found, several, name=NAME)[0] == "passed"
    assert starts(several)[0] == "passed"
    misspelt = several.renaming(LAUNCH, "my_robot/launch/my_robot_rvix.launch.py")
    assert finds(launch_found, misspelt, name=NAME)[1].endswith("launch/my_robot_rvix.launch.py")


def test_a_missing_launch_file_is_one_fault() -> None:
    """Without a launch file every check reports the same missing thing."""
    gone, empty = REFERENCE.without("my_robot/launch"), REFERENCE.renaming(LAUNCH, "my_robot/launch/README.md")
    message = "the package has no launch file: no file ends in .launch.py, .launch.xml or .launch.yaml"
    for submitted, words in ((gone, f"{message}, and there is no folder launch"), (empty, message)):
        expected = ("launch file in the package", "", words, None)
        assert lacks(launch_found, submitted, name=NAME) == expected
        assert lacks(launch_starts, submitted, name=NAME, nodes=NODES) == expected
        assert lacks(launch_finds_files, submitted, name=NAME) == expected


# --- What it starts ---------------------------------------------------------------------------------------------------


OFF = launch("default_value='true'", "default_value='false'")
MORE = launch(RVIZ_NODE, RVIZ_NODE + "        Node(package='turtlesim', executable='turtlesim_node'),\n")


@pytest.mark.parametrize(
    ("submitted", "started"),
    [(each, STARTED) for each in (REFERENCE, WITH_IMPORTS, DISPLAY, INCLUDES, IN_XML, AS_LAUNCH, IN_YAML)]
    + [(OFF, STARTED.replace("publisher_gui", "publisher")), (MORE, f"{STARTED}, turtlesim/turtlesim_node")],
    ids=["py", "imports", "urdf_launch", "include", "xml", "launch", "yaml", "default", "more"],
)
def test_equivalent_launch_files_pass(submitted: Submitted, started: str) -> None:
    """Nodes are found in every language and in included files; defaults of arguments count; there may be more nodes."""
    assert starts(submitted) == ("passed", started, None)
    assert finds_files(submitted)[0] == "passed"


RETURN = "    return LaunchDescription(["
OUTSIDE = launch(RETURN, f"    rviz = Node(package='rviz2', executable='rviz2')\n\n{RETURN}", launch(RVIZ_NODE, ""))
OTHER_OUTSIDE = launch(RETURN, f"    other = Node(package='a', executable='b')\n\n{RETURN}", launch(RVIZ_NODE, ""))
UNLESS = launch(
    "            arguments=['-d'", "            condition=UnlessCondition(gui),\n            arguments=['-d'"
)
EMPTY = "from launch import LaunchDescription\ndef generate_launch_description():\n  return LaunchDescription([])\n"
PUBLISHERS = "joint_state_publisher_gui, robot_state_publisher"
NO_NODE = f"{PUBLISHERS}. It creates the node rviz2, but the LaunchDescription does not contain it"
KEPT = f"{PUBLISHERS}. A condition keeps rviz2 from starting, unless an argument is given"
RVIZ_AT = "Node(\n            package='rviz2'"
STATE_AT = "Node(\n            package='robot_state_publisher'"


@pytest.mark.parametrize(
    ("submitted", "missing", "running", "at"),
    [
        (launch(RVIZ_NODE, ""), "rviz2", PUBLISHERS, None),
        (launch("package='rviz2'", "package='rviz'"), "rviz2", f"{PUBLISHERS}, rviz/rviz2",
         "Node(\n            package='rviz'"),
        (launch("executable='rviz2'", "executable='rviz'"), "rviz2", f"{PUBLISHERS}, rviz2/rviz", RVIZ_AT),
        (launch("executable='robot_state_publisher'", "executable='robot_state_publsher'"), "robot_state_publisher",
         "joint_state_publisher_gui, robot_state_publisher/robot_state_publsher, rviz2", STATE_AT),
        (DISPLAY.replacing(LAUNCH, "display.l", "description.l"), f"{STATES}, rviz2", "robot_state_publisher", None),
        (REFERENCE.with_files({LAUNCH: EMPTY}), f"robot_state_publisher, {STATES}, rviz2", "nothing", None),
        (OUTSIDE, "rviz2", NO_NODE, "Node(package='rviz2'"),
        (OTHER_OUTSIDE, "rviz2", PUBLISHERS, None),
        (UNLESS, "rviz2", KEPT, RVIZ_AT),
    ],
    ids=["left-out", "package", "executable", "misspelt", "description", "empty", "outside", "other-outside", "condition"],
)  # fmt: skip
def test_a_missing_node_is_named(submitted: Submitted, missing: str, running: str, at: str | None) -> None:
    """The message names the missing node, the started ones and why, and points to a similar node."""
    location = submitted.location_of(LAUNCH, at) if at is not None else None
    assert starts(submitted) == ("failed", f"the launch file does not start {missing}; it starts {running}", location)


def test_an_argument_without_default_needs_manual_grading() -> None:
    """Without a default, the node depends on the command line."""
    submitted = launch("default_value='true', ", "")
    assert starts(submitted) == (
        "pending",
        f"cannot determine statically whether {STATES} is started; needs manual grading",
        None,
    )
    worse = launch(RVIZ_NODE, "", submitted)
    assert starts(worse)[:2] == (
        "failed",
        f"the launch file does not start {STATES}, rviz2; it starts robot_state_publisher",
    )


def test_values_known_only_at_run_time_need_manual_grading() -> None:
    """Nodes that depend on the machine, or on launch files that are not in the submission, are pending."""
    submitted = launch("executable='rviz2'", "executable=os.environ['VIEWER']")
    status, message, location = starts(submitted)
    assert (status, location) == ("pending", None)
    assert message.startswith("cannot determine statically whether rviz2 is started: ")
    foreign = DISPLAY.replacing(LAUNCH, "'urdf_launch'", "'urdf_tutorial'")
    reason = "it includes share/urdf_tutorial/launch/display.launch.py, which the submission does not install"
    all_nodes = f"robot_state_publisher, {STATES}, rviz2"
    assert starts(foreign) == (
        "pending",
        f"cannot determine statically whether {all_nodes} is started: {reason}; needs manual grading",
        None,
    )
    assert finds_files(foreign) == (
        "pending",
        f"cannot determine statically which files it names: {reason}; needs manual grading",
        None,
    )


NO_OS = "the name 'os' is not defined or imported"
NO_ARGUMENT = "the launch argument {!r} is used, but DeclareLaunchArgument does not declare it before"
NO_FIND = "$(find ...) is a substitution of ROS 1; in ROS 2 write $(find-pkg-share ...)"
GUI_AT = "Node(\n            package='joint_state_publisher',"


@pytest.mark.parametrize(
    ("submitted", "message", "at"),
    [
        (launch("from launch_ros.actions import Node\n", ""), "the name 'Node' is not defined or imported", GUI_AT),
        (launch("import os\n", ""), NO_OS, URDF_PATH),
        (launch("from launch_ros.actions import Node\n", "", launch("import os\n", "")), f"{NO_OS} (and 1 more)",
         URDF_PATH),
        (launch(GUI, ""), NO_ARGUMENT.format("gui"), "LaunchConfiguration('gui')"),
        (described("Command(['xacro ', LaunchConfiguration('model')])"), NO_ARGUMENT.format("model"),
         "LaunchConfiguration('model')"),
        (described("Command(['xacro', os.path.join(share, 'my_robot.urdf')])"),
         "a space is missing between xacro and the path: write 'xacro '", "Command(['xacro'"),
        (DISPLAY.replacing(LAUNCH, "}.items(),", "},"), "launch_arguments is given a dict: add .items() to it",
         "IncludeLaunchDescription(\n"),
        (IN_XML.replacing(XML, "find-pkg-share", "find"), NO_FIND, None),
        (IN_XML.replacing(XML, 'pkg="rviz2" exec=', 'pkg="rviz2" type='),
         "<node> has no attribute 'type' in ROS 2; write 'exec'", None),
        (IN_XML.replacing(XML, '  <arg name="gui" default="true"/>\n', ""), NO_ARGUMENT.format("gui"), None),
    ],
    ids=["node", "os", "two", "argument", "in-command", "space", "items", "xml-find", "xml-type", "xml-argument"],
)  # fmt: skip
def test_errors_that_stop_the_launch_fail(submitted: Submitted, message: str, at: str | None) -> None:
    """An error that stops ros2 launch is reported once, at its location; the files count as found or pending."""
    if at is None:
        assert starts(submitted)[:2] == ("failed", message)
    else:
        assert starts(submitted) == ("failed", message, submitted.location_of(LAUNCH, at))
        assert finds_files(submitted)[0] in ("passed", "pending")


COMMA = "Python cannot read the file: invalid syntax. Perhaps you forgot a comma?"
BRACKET = "Python cannot read the file: closing parenthesis ')' does not match opening parenthesis '[' on line 20"
NO_FUNCTION = "the file does not define the function generate_launch_description, which ros2 launch calls"
NO_RETURN = "generate_launch_description does not return its LaunchDescription"


@pytest.mark.parametrize(
    ("submitted", "message", "at"),
    [
        (launch("            executable='rviz2',", "            executable='rviz2'"), COMMA, "'rviz2'\n"),
        (launch("    ])\n", "    )\n"), BRACKET, ")\n"),
        (launch("def generate_launch_description", "def generate_launch_descripton"), NO_FUNCTION, None),
        (REFERENCE.with_files({LAUNCH: ""}), NO_FUNCTION, None),
        (launch("    return LaunchDescription", "    LaunchDescription"), NO_RETURN, "def generate"),
    ],
    ids=["comma", "bracket", "entry", "empty", "return"],
)
def test_an_unreadable_launch_file_is_missed_once(submitted: Submitted, message: str, at: str | None) -> None:
    """A fault that hides everything is reported once, under one key, by both checks."""
    for check, arguments in ((launch_starts, {"nodes": NODES}), (launch_finds_files, {})):
        *key, location = lacks(check, submitted, name=NAME, **arguments)
        assert key == ["launch file", "launch/my_robot_rviz.launch.py", message]
        if at is None:
            assert location == start_of(LAUNCH)
        elif at != ")\n":
            assert location == submitted.location_of(LAUNCH, at)
    assert finds(launch_found, submitted, name=NAME)[0] == "passed"


ROBOT = IN_XML.replacing(XML, "<launch>", "<robot>").replacing(XML, "</launch>", "</robot>")
MISMATCH = "not readable as XML: Opening and ending tag mismatch"
NO_LIST = "the file is not a list of actions below launch:; ros2 launch starts nothing"


@pytest.mark.parametrize(
    ("submitted", "path", "message", "at"),
    [
        (IN_XML.replacing(XML, "</node>", ""), XML, MISMATCH, "</launch>"),
        (IN_YAML.replacing(YAML, "      exec: rviz2", "\texec: rviz2"), YAML, "not readable as YAML: ", "\texec"),
        (IN_YAML.replacing(YAML, "launch:\n", "lunch:\n"), YAML, NO_LIST, "lunch:"),
        (ROBOT, XML, "the root of the file is not <launch>; ros2 launch starts nothing", "<robot>"),
    ],
    ids=["xml", "yaml", "key", "root"],
)
def test_xml_and_yaml_that_cannot_be_read(submitted: Submitted, path: str, message: str, at: str) -> None:
    """An unreadable launch file in XML or YAML is reported in the same way."""
    kind, name, words, location = lacks(launch_starts, submitted, name=NAME, nodes=NODES)
    assert (kind, name) == ("launch file", path.removeprefix("my_robot/"))
    assert words.startswith(message)
    assert location is not None
    assert (location.path, location.line) == (path, submitted.location_of(path, at).line)


# --- What it names ----------------------------------------------------------------------------------------------------


OF_URDF = "a build installs share/my_robot/my_robot.urdf, where the launch file looks"
ANOTHER_NAME = REFERENCE.replacing("my_robot/package.xml", ">my_robot<", ">robot_lab<")


@pytest.mark.parametrize(
    ("submitted", "message"),
    [
        (REFERENCE, FOUND),
        (
            INCLUDES,
            FOUND.replace("installs ", "installs share/my_robot/launch/robot.launch.py, ").replace(" and", " and", 1),
        ),
        (launch(RVIZ_NODE, ""), OF_URDF),
        (ANOTHER_NAME, FOUND),
    ],
    ids=["two", "included", "no-rviz", "resource-index"],
)
def test_found_files_are_named(submitted: Submitted, message: str) -> None:
    """The installed files that the started nodes need, of the package with that entry in the resource index."""
    assert finds_files(submitted) == ("passed", message, None)


@pytest.mark.parametrize(
    "code",
    [
        "open(os.path.join(share, 'my_robot.urdf')).read()",
        "open(f'{share}/my_robot.urdf').read()",
        "open(share + '/my_robot.urdf', 'r', encoding='utf-8').read()",
        "Command(['xacro ', os.path.join(share, 'my_robot.urdf')])",
        "ParameterValue(Command(['xacro ', os.path.join(share, 'my_robot.urdf')]), value_type=str)",
        "Command(['xacro ', PathJoinSubstitution([FindPackageShare('my_robot'), 'my_robot.urdf'])])",
        "Command(['xacro ', FindPackageShare('my_robot'), '/my_robot.urdf'])",
        "Command(['cat ', os.path.join(share, 'my_robot.urdf')])",
        "xacro.process_file(os.path.join(share, 'my_robot.urdf')).toxml()",
        "xacro.process_file(os.path.join(share, 'my_robot.urdf')).toprettyxml(indent='  ')",
    ],
    ids=["open", "f", "plus", "command", "value", "substitution", "pieces", "cat", "process_file", "pretty"],
)
def test_equivalent_code_that_reads_the_urdf(code: str) -> None:
    """However the URDF is read, the path that is used counts."""
    assert finds_files(described(code)) == ("passed", FOUND, None)
    assert starts(described(code)) == ("passed", STARTED, None)
    wrong = described(code.replace("my_robot.urdf", "urdf/my_robot.urdf"))
    message = "the launch file looks for the URDF at share/my_robot/urdf/my_robot.urdf, but a build installs it as share/my_robot/my_robot.urdf"
    assert finds_files(wrong)[:2] == ("failed", message)


def test_the_default_of_an_argument_is_a_path() -> None:
    """A path may be the default of a launch argument; without a default manual grading is needed."""
    model = described("Command(['xacro ', LaunchConfiguration('model')])")
    right = declaring("DeclareLaunchArgument('model', default_value=os.path.join(share, 'my_robot.urdf'))", model)
    assert finds_files(right) == ("passed", FOUND, None)
    wrong = declaring("DeclareLaunchArgument('model', default_value='/home/me/my_robot.urdf')", model)
    assert finds_files(wrong)[0] == "failed"
    none = declaring("DeclareLaunchArgument('model')", model)
    message = "the launch argument 'model' has no default; needs manual grading"
    assert finds_files(none) == ("pending", message, None)


@pytest.mark.parametrize("spelling", ["['-d' + {}]", "['--display-config', {}]", "['-d', {}, '--fullscreen']"])
def test_options_that_open_the_rviz_file(spelling: str) -> None:
    """Every spelling of RViz's option is known."""
    assert finds_files(launch(f"['-d', {RVIZ_PATH}]", spelling.format(RVIZ_PATH))) == ("passed", FOUND, None)


NESTED = REFERENCE.replacing(
    SETUP,
    "(os.path.join('share', package_name), glob('urdf/*'))",
    "(os.path.join('share', package_name, 'urdf'), glob('urdf/*'))",
)


def test_launch_file_and_setup_py_must_agree() -> None:
    """The launch file and setup.py must use the same location, flat or nested."""
    required = launch(URDF_PATH, "os.path.join(share, 'urdf', 'my_robot.urdf')")
    flat, nested = "share/my_robot/my_robot.urdf", "share/my_robot/urdf/my_robot.urdf"
    agreeing = Submitted({**NESTED.files, LAUNCH: required.files[LAUNCH]})
    assert finds_files(agreeing) == ("passed", FOUND.replace(flat, nested), None)
    for submitted, requested, put in ((NESTED, flat, nested), (required, nested, flat)):
        message = f"the launch file looks for the URDF at {requested}, but a build installs it as {put}"
        assert finds_files(submitted) == ("failed", message, submitted.location_of(LAUNCH, "open("))


LOOKS, INSTALLS = "the launch file looks for the {} at {}", ", but a build installs it as {}"
ELSEWHERE = ", which exists on one machine only; use get_package_share_directory('my_robot'), which returns the installed folder"
RELATIVE = ", relative to the folder that ros2 launch is started from"
FLAT, DEEP = "share/my_robot/my_robot.urdf", "share/my_robot/urdf/my_robot.urdf"
DEEP_URDF = LOOKS.format("URDF", DEEP) + INSTALLS.format(FLAT)
DEEP_RVIZ = LOOKS.format("RViz file", "share/my_robot/rviz/my_robot.rviz") + INSTALLS.format(
    "share/my_robot/my_robot.rviz"
)
ROBT = (
    LOOKS.format("URDF", "share/my_robot/my_robt.urdf")
    + ", but the package has no file 'my_robt.urdf'; there is 'my_robot.urdf'"
)
CONFIG = (LOOKS.format("RViz file", "share/my_robot/config.rviz")
          + ", but the package has no file 'config.rviz'; there is 'my_robot.rviz'")  # fmt: skip
ONLY_INNER = INCLUDES.replacing(
    SETUP, "glob(os.path.join('launch', '*launch.[pxy][yma]*'))", "['launch/my_robot_rviz.launch.py']"
)
WHERE_RVIZ, WHERE_INCLUDE = "Node(\n            package='rviz2'", "IncludeLaunchDescription(\n"
# What the launch file names instead, what is wrong with it, and where that is written.
WRONG_PATHS = {
    "home": (launch(URDF_PATH, "'/home/student/my_robot.urdf'"),
             LOOKS.format("URDF", "/home/student/my_robot.urdf") + ELSEWHERE, "open("),
    "expanduser": (launch(URDF_PATH, "os.path.expanduser('~/ros2_ws/my_robot.urdf')"),
                   LOOKS.format("URDF", "~/ros2_ws/my_robot.urdf") + ELSEWHERE, "open("),
    "tilde": (launch(URDF_PATH, "'~/ros2_ws/my_robot.urdf'"),
              LOOKS.format("URDF", "~/ros2_ws/my_robot.urdf") + ", but nothing replaces ~ by the home folder", "open("),
    "relative": (launch(URDF_PATH, "'urdf/my_robot.urdf'"), LOOKS.format("URDF", "urdf/my_robot.urdf") + RELATIVE,
        "open("),
    "relative-rviz": (launch(RVIZ_PATH, "'rviz/my_robot.rviz'"),
                      LOOKS.format("RViz file", "rviz/my_robot.rviz") + RELATIVE, WHERE_RVIZ),
    "mac": (launch(RVIZ_PATH, "'/Users/me/my_robot.rviz'"),
            LOOKS.format("RViz file", "/Users/me/my_robot.rviz") + ELSEWHERE, WHERE_RVIZ),
    "package": (launch("get_package_share_directory('my_robot')", "get_package_share_directory('my_robt')"),
                "the launch file looks in a package 'my_robt', but the graded package is named 'my_robot'", "open("),
    "file": (launch("'my_robot.urdf'", "'my_robt.urdf'"), ROBT, "open("),
    "rviz-file": (launch("'my_robot.rviz'", "'config.rviz'"), CONFIG, WHERE_RVIZ),
    "no-d": (launch(f"            arguments=['-d', {RVIZ_PATH}],\n", ""),
        ("rviz2 is started without -d and a file, so it opens "
             "its own default instead of the lab's configuration"), WHERE_RVIZ),
    "bare-d": (launch(f"['-d', {RVIZ_PATH}]", "['-d']"), "rviz2 is given -d without the path of a file", WHERE_RVIZ),
    "no-description": (launch("            parameters=[{'robot_description': robot_description}],\n", ""),
                       "robot_state_publisher is started without robot_description: it has no robot to publish",
                           STATE_AT),
    "path-given": (described(URDF_PATH),
        ("robot_description is given the path of the URDF, not its contents: read the file "
                   "first"), STATE_AT),
    "urdf_launch-path": (DISPLAY.replacing(LAUNCH, "'my_robot.urdf'", "'urdf/my_robot.urdf'"), DEEP_URDF,
        WHERE_INCLUDE),
    "urdf_launch-package": (DISPLAY.replacing(LAUNCH, "                'urdf_package': 'my_robot',\n", ""),
                            "urdf_launch needs the arguments urdf_package and urdf_package_path", WHERE_INCLUDE),
    "urdf_launch-rviz": (DISPLAY.replacing(LAUNCH, "'rviz_config'", "'rvizconfig'"), ("urdf_launch is included without "
                         "rviz_config, so it opens its own configuration, not the lab's"), WHERE_INCLUDE),
    "xml": (IN_XML.replacing(XML, "/my_robot.urdf", "/urdf/my_robot.urdf"), DEEP_URDF, "<param"),
    "yaml": (IN_YAML.replacing(YAML, "/my_robot.rviz", "/rviz/my_robot.rviz"), DEEP_RVIZ, ""),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG_PATHS)
def test_a_file_at_the_wrong_path(name: str) -> None:
    """Each kind of wrong path has its own message where the path is written; the nodes still count as started."""
    submitted, message, at = WRONG_PATHS[name]
    status, words, location = finds_files(submitted)
    assert (status, words) == ("failed", message)
    assert not at or location == submitted.location_of(XML if name == "xml" else LAUNCH, at)
    assert starts(submitted)[0] == "passed"


def test_two_wrong_paths_are_both_reported() -> None:
    """One fault does not hide the other."""
    submitted = launch(RVIZ_PATH, "'my_robot.rviz'", launch(URDF_PATH, "'/home/me/my_robot.urdf'"))
    status, message, location = finds_files(submitted)
    assert (status, location) == ("failed", submitted.location_of(LAUNCH, "open("))
    assert "/home/me/my_robot.urdf" in message
    assert "; the launch file looks for the RViz file at my_robot.rviz, relative to the folder" in message


def test_a_launch_file_without_paths() -> None:
    """If no file is named, there is nothing to check."""
    text = "from launch import LaunchDescription\n\n\ndef generate_launch_description():\n    return LaunchDescription([])\n"
    expected = ("named file", "", "the launch file names neither a URDF nor an RViz file", None)
    assert lacks(launch_finds_files, REFERENCE.with_files({LAUNCH: text}), name=NAME) == expected


@pytest.mark.parametrize(
    ("submitted", "key", "name"),
    [
        (REFERENCE.replacing(SETUP, "(os.path.join('share', package_name), glob('urdf/*')),", ""), "installed urdf",
         FOLDER),
        (REFERENCE.replacing(SETUP, "(os.path.join('share', package_name), glob('rviz/*')),", ""), "installed rviz",
         FOLDER),
        (REFERENCE.without(SETUP), "setup.py", FOLDER),
        (REFERENCE.replacing(SETUP, "zip_safe=True,", "zip_safe=True"), "setup.py", FOLDER),
        (REFERENCE.with_files({SETUP: ""}), "call of setup", FOLDER),
        (REFERENCE.without(URDF), "URDF in the package", ""),
        (REFERENCE.without(RVIZ), "RViz file in the package", ""),
    ],
    ids=["urdf", "rviz", "no-setup", "syntax", "no-call", "no-urdf", "no-rviz"],
)  # fmt: skip
def test_a_file_that_is_not_installed(submitted: Submitted, key: str, name: str) -> None:
    """A file that is not installed, or not there, is the same missing thing as in the checks of that file."""
    assert lacks(launch_finds_files, submitted, name=NAME)[:2] == (key, name)


def test_unknown_installation_needs_manual_grading() -> None:
    """If setup.py needs manual grading, so do the paths of the launch file; so do files of other packages."""
    unknown = REFERENCE.replacing(SETUP, "glob('urdf/*')", "os.environ['FILES'].split()")
    message = "cannot determine statically whether a build installs share/my_robot/my_robot.urdf; needs manual grading"
    assert finds_files(unknown) == ("pending", message, None)
    large = REFERENCE.with_files({SETUP: str(REFERENCE.files[SETUP]) + "#" * 200_000})
    assert finds_files(large)[0] == "pending"
    cmake = REFERENCE.without(SETUP).with_files({"my_robot/CMakeLists.txt": "install()\n"})
    assert finds_files(cmake)[0] == "pending"
    other = launch("get_package_share_directory('my_robot')", "get_package_share_directory('urdf_tutorial')")
    message = "the URDF is in 'urdf_tutorial', which is not part of the submission; needs manual grading"
    assert finds_files(other) == ("pending", message, None)
    beside = launch(URDF_PATH, "os.path.join(share, '..', '..', 'lib', 'other.urdf')")
    message = "the URDF /lib/other.urdf is not part of the package; needs manual grading"
    assert finds_files(beside) == ("pending", message, None)


def test_a_second_package_of_the_submission_counts() -> None:
    """The URDF may be in a description package of the same submission."""
    description = {
        path.replace(FOLDER, "my_description", 1): str(content).replace("my_robot'", "my_description'")
        for path, content in REFERENCE.without(LAUNCH, RVIZ).files.items()
        if path.startswith(FOLDER)
    }
    description["my_description/package.xml"] = str(REFERENCE.files["my_robot/package.xml"]).replace(
        ">my_robot<", ">my_description<"
    )
    description["my_description/resource/my_description"] = ""
    submitted = REFERENCE.without(URDF).with_files(description)
    submitted = launch(
        URDF_PATH, "os.path.join(get_package_share_directory('my_description'), 'my_robot.urdf')", submitted
    )
    assert finds_files(submitted) == (
        "passed",
        FOUND.replace("my_robot/my_robot.urdf", "my_description/my_robot.urdf"),
        None,
    )


# --- What it includes -------------------------------------------------------------------------------------------------


INNER_PATH = "share/my_robot/launch/robot.launch.py"


@pytest.mark.parametrize(
    ("submitted", "at", "words"),
    [
        (INCLUDES.replacing(LAUNCH, "share, 'launch', ", "share, "), "share/my_robot/robot.launch.py",
         INSTALLS.format(INNER_PATH)),
        (INCLUDES.without(INNER), INNER_PATH, ", but the package has no file 'robot.launch.py'"),
        (ONLY_INNER, INNER_PATH, ", but a build does not install robot.launch.py"),
    ],
    ids=["elsewhere", "no-such-file", "not-installed"],
)  # fmt: skip
def test_a_missing_included_file(submitted: Submitted, at: str, words: str) -> None:
    """An included launch file must exist at its path and be installed; its nodes are unknown and pending."""
    location = submitted.location_of(LAUNCH, "IncludeLaunchDescription(P")
    message = LOOKS.format("launch file", at) + words
    if submitted is ONLY_INNER:
        assert lacks(launch_finds_files, submitted, name=NAME) == ("installed include", FOLDER, message, location)
    else:
        assert finds_files(submitted) == ("failed", message, location)
        assert starts(submitted)[0] == "pending"


def test_a_fault_in_an_included_file() -> None:
    """A fault in an included file is reported at its location there."""
    fault = INCLUDES.replacing(INNER, "from launch_ros.actions import Node\n", "")
    message = "the name 'Node' is not defined or imported"
    assert starts(fault) == (
        "failed",
        message,
        fault.location_of(INNER, "Node(\n            package='joint_state_publisher',"),
    )
    broken = INCLUDES.replacing(INNER, "    ])\n", "")
    location = broken.location_of(INNER, "[\n        DeclareLaunchArgument")
    expected = (
        "launch file",
        "launch/my_robot_rviz.launch.py",
        "Python cannot read the file: '[' was never closed",
        location,
    )
    assert lacks(launch_starts, broken, name=NAME, nodes=NODES) == expected
    assert lacks(launch_finds_files, broken, name=NAME) == expected


def test_opaque_functions_are_evaluated() -> None:
    """OpaqueFunction calls its function with a context; the actions that it returns are started, too."""
    submitted = launch(
        RVIZ_NODE,
        "        OpaqueFunction(function=lambda context: [\n"
        f"            Node(package='rviz2', executable='rviz2', arguments=['-d', {RVIZ_PATH}])]),\n",
        launch("from launch.actions import D", "from launch.actions import OpaqueFunction, D"),
    )
    assert starts(submitted) == ("passed", STARTED, None)
    assert finds_files(submitted) == ("passed", FOUND, None)


def test_without_a_build_the_files_of_the_package_count() -> None:
    """With `built = false` only files that the package lacks, or that the launch file looks for elsewhere, fail."""
    no_setup = REFERENCE.without(SETUP)
    assert lacks(launch_finds_files, no_setup, name=NAME)[0] == "setup.py"
    status, message, _ = finds(launch_finds_files, no_setup, name=NAME, built=False)
    assert (status, message) == ("passed", "the launch file looks for files of the package")
    assert lacks(launch_finds_files, REFERENCE.without(RVIZ), name=NAME, built=False)[0] == "RViz file in the package"


def test_a_urdf_that_is_too_large_to_read_is_there() -> None:
    """Another criterion reports that it is too large."""
    assert finds_files(REFERENCE.with_files({URDF: " " * 2_000_000}))[:2] == ("passed", FOUND)
