"""For every check of a package, a submission that passes, one that fails, and the message for each."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from grader.checks.installs import build_installs, installs_files, setup_imports
from grader.checks.launch import launch_finds_files, launch_found, launch_starts
from grader.checks.manual import answered, evidence_shown
from grader.checks.package import package_found, package_type
from grader.checks.rviz import rviz_display_on, rviz_fixed_frame, rviz_found, rviz_shows_robot
from grader.checks.xacro_source import xacro_uses
from tests.checks.outcomes import AnyCheck
from tests.checks.submissions import ANSWERS, LAUNCH, MANIFEST, REFERENCE, RVIZ, SETUP, URDF, Submitted

_NAME = "my_robot_rviz.launch.py"
_RVIZ = {"name": "my_robot.rviz", "launch": _NAME}


@dataclass(frozen=True)
class PackageCase:
    """A check with arguments, a submission that fails it, both messages, and the location of the failure, if it has one."""

    check: AnyCheck
    arguments: Mapping[str, Any]
    pass_message: str
    failing: Submitted
    fail_message: str
    at: tuple[str, str] | None = None
    passing: Submitted = field(default=REFERENCE, repr=False)
    needs: str = "package"  # or "URDF"

    @property
    def name(self) -> str:
        """Return the name of the check."""
        return self.check.__name__


@dataclass(frozen=True)
class PendingCase:
    """A check that always needs manual grading: its message if something was found, and if nothing was."""

    check: AnyCheck
    arguments: Mapping[str, Any]
    found: str
    at: tuple[str, str] | None
    without: Submitted
    not_found: str

    @property
    def name(self) -> str:
        """Return the name of the check."""
        return self.check.__name__


_WHEEL = "my_robot/urdf/wheel.xacro"
_XACRO = f"{URDF}.xacro"
IN_XACRO = REFERENCE.without(URDF).with_files(
    {
        _XACRO: """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="my_robot">
<xacro:include filename="wheel.xacro"/>
<xacro:property name="radius" value="0.1"/>
<xacro:property name="width" value="0.05"/>
<link name="base_link"/>
<xacro:wheel side="left"/>
<xacro:wheel side="right"/>
</robot>
""",
        _WHEEL: """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="wheel" params="side">
<link name="${side}_wheel">
<visual><geometry><cylinder radius="${radius}" length="${width / 2}"/></geometry></visual>
</link>
<joint name="${side}_joint" type="fixed"><parent link="base_link"/><child link="${side}_wheel"/></joint>
</xacro:macro>
</robot>
""",
    }
)

PACKAGE_CASES = (
    PackageCase(
        xacro_uses,
        {"properties": ["radius", "width"], "macros": 1, "includes": ["wheel.xacro"]},
        pass_message="my_robot.urdf.xacro and wheel.xacro: xacro with the expected properties, macros and includes",
        failing=IN_XACRO.replacing(_WHEEL, "${width / 2}", "0.025"),
        fail_message="the property 'width' is defined, but never used",
        at=(_XACRO, 'name="width"'),
        passing=IN_XACRO,
        needs="URDF",
    ),
    PackageCase(
        package_found,
        {"name": "my_robot"},
        pass_message="the package is named 'my_robot'",
        failing=REFERENCE.replacing(MANIFEST, ">my_robot<", ">robot<"),
        fail_message="the package is named 'robot'; it should be named 'my_robot'",
        at=(MANIFEST, "<name>"),
    ),
    PackageCase(
        package_type,
        {"build_type": "ament_python"},
        pass_message="the build type is 'ament_python'",
        failing=REFERENCE.replacing(MANIFEST, "ament_python", "ament_cmake"),
        fail_message="the build type is 'ament_cmake'; it should be 'ament_python'",
        at=(MANIFEST, "<build_type>"),
    ),
    PackageCase(
        build_installs,
        {"kind": "urdf", "name": "my_robot.urdf"},
        pass_message="a build installs urdf/my_robot.urdf as share/my_robot/my_robot.urdf",
        failing=REFERENCE.replacing(SETUP, "glob('urdf/*')", "['urdf/robot.urdf']"),
        fail_message="the build stops here: data_files lists 'urdf/robot.urdf', but there is no such file; did you mean 'urdf/my_robot.urdf'?",
        at=(SETUP, "'urdf/robot.urdf'"),
    ),
    PackageCase(
        installs_files,
        {"files": ["launch/*.launch.py"]},
        pass_message="a build installs launch/my_robot_rviz.launch.py as share/my_robot/launch/my_robot_rviz.launch.py",
        failing=REFERENCE.replacing(SETUP, "os.path.join('share', package_name, 'launch')", "'lib/launch'"),
        fail_message="a build installs launch/my_robot_rviz.launch.py as lib/launch/my_robot_rviz.launch.py; "
        "ROS 2 looks for the package's files below share/my_robot/",
        at=(SETUP, "glob(os.path"),
    ),
    PackageCase(
        setup_imports,
        {},
        pass_message="every name that setup.py uses is defined",
        failing=REFERENCE.replacing(SETUP, "from glob import glob\n", ""),
        fail_message="the name 'glob' is not defined or imported",
        at=(SETUP, "glob('urdf/*')"),
    ),
    PackageCase(
        launch_found,
        {"name": _NAME},
        pass_message="the launch file is launch/my_robot_rviz.launch.py",
        failing=REFERENCE.renaming(LAUNCH, "my_robot/launch/my_robot_rvix.launch.py"),
        fail_message="there is no launch file 'my_robot_rviz.launch.py'; the package has launch/my_robot_rvix.launch.py",
    ),
    PackageCase(
        launch_starts,
        {"name": _NAME, "nodes": ["robot_state_publisher", "rviz2 or rviz"]},
        pass_message="the launch file starts joint_state_publisher_gui, robot_state_publisher, rviz2",
        failing=REFERENCE.replacing(LAUNCH, "package='rviz2'", "package='rviz'"),
        fail_message="the launch file does not start rviz2 or rviz; it starts joint_state_publisher_gui, robot_state_publisher, rviz/rviz2",
        at=(LAUNCH, "Node(\n            package='rviz'"),
    ),
    PackageCase(
        launch_finds_files,
        {"name": _NAME},
        pass_message="a build installs share/my_robot/my_robot.urdf and share/my_robot/my_robot.rviz, where the launch file looks for them",
        failing=REFERENCE.replacing(LAUNCH, "os.path.join(share, 'my_robot.urdf')", "'urdf/my_robot.urdf'"),
        fail_message="the launch file looks for the URDF at urdf/my_robot.urdf, relative to the folder that ros2 launch is started from",
        at=(LAUNCH, "open("),
    ),
    PackageCase(
        rviz_found,
        _RVIZ,
        pass_message="the RViz file is rviz/my_robot.rviz",
        failing=REFERENCE.renaming(RVIZ, "my_robot/rviz/view.rviz"),
        fail_message="there is no RViz file 'my_robot.rviz'; the package has rviz/view.rviz",
    ),
    PackageCase(
        rviz_fixed_frame,
        {**_RVIZ, "frame": "base_footprint"},
        pass_message="the Fixed Frame is 'base_footprint'",
        failing=REFERENCE.replacing(RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: map"),
        fail_message="the Fixed Frame is 'map'; it should be 'base_footprint'; the robot has no link 'map'",
        at=(RVIZ, "map\n"),
    ),
    PackageCase(
        rviz_shows_robot,
        {**_RVIZ, "topic": "/robot_description"},
        pass_message="the display 'RobotModel' shows the robot",
        failing=REFERENCE.replacing(RVIZ, "rviz_default_plugins/RobotModel", "rviz/RobotModel"),
        fail_message="rviz/RobotModel is a class of ROS 1; in ROS 2 it is rviz_default_plugins/RobotModel",
        at=(RVIZ, "rviz/RobotModel"),
    ),
    PackageCase(
        rviz_display_on,
        {**_RVIZ, "kind": "TF"},
        pass_message="a TF display is on",
        failing=REFERENCE.replacing(RVIZ, "plugins/TF\n      Enabled: true", "plugins/TF\n      Enabled: false"),
        fail_message="the TF display is off",
        at=(RVIZ, "rviz_default_plugins/TF"),
    ),
)

PENDING_CASES = (
    PendingCase(
        answered,
        {
            "question": "What happens?",
            "answer": "It vanishes.",
            "places": ["task 1 step 15"],
            "files": ("*.md", "*.txt"),
        },
        found="What happens? The answer in answers.md, from line 3, needs manual grading",
        at=(ANSWERS, "## Task 1"),
        without=REFERENCE.without(ANSWERS),
        not_found="What happens? No answer was found under 'task 1 step 15'; needs manual grading",
    ),
    PendingCase(
        evidence_shown,
        {"names": ["task 1 step 8"]},
        found="needs manual grading: Task1_Step8.png (640 x 480 pixels, 118 bytes)",
        at=None,
        without=Submitted({path: content for path, content in REFERENCE.files.items() if not path.endswith(".png")}),
        not_found="no picture or PDF is named 'task 1 step 8'; the submission has no pictures; needs manual grading",
    ),
)

PACKAGE_CASE = {case.name: case for case in PACKAGE_CASES}
PENDING_CASE = {case.name: case for case in PENDING_CASES}
