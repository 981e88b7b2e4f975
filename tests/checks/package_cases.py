"""For every check of a package a submission that passes and one that fails; golden/outcomes-of-cases.txt has what it finds."""

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
    """A check with arguments, a submission that fails it, and one that passes."""

    check: AnyCheck
    arguments: Mapping[str, Any]
    failing: Submitted
    passing: Submitted = field(default=REFERENCE, repr=False)
    needs: str = "package"  # or "URDF"

    @property
    def name(self) -> str:
        """Return the name of the check."""
        return self.check.__name__


@dataclass(frozen=True)
class PendingCase:
    """A check that always needs manual grading, and a submission without what it looks for."""

    check: AnyCheck
    arguments: Mapping[str, Any]
    without: Submitted

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
        failing=IN_XACRO.replacing(_WHEEL, "${width / 2}", "0.025"),
        passing=IN_XACRO,
        needs="URDF",
    ),
    PackageCase(
        package_found,
        {"name": "my_robot"},
        failing=REFERENCE.replacing(MANIFEST, ">my_robot<", ">robot<"),
    ),
    PackageCase(
        package_type,
        {"build_type": "ament_python"},
        failing=REFERENCE.replacing(MANIFEST, "ament_python", "ament_cmake"),
    ),
    PackageCase(
        build_installs,
        {"kind": "urdf", "name": "my_robot.urdf"},
        failing=REFERENCE.replacing(SETUP, "glob('urdf/*')", "['urdf/robot.urdf']"),
    ),
    PackageCase(
        installs_files,
        {"files": ["launch/*.launch.py"]},
        failing=REFERENCE.replacing(SETUP, "os.path.join('share', package_name, 'launch')", "'lib/launch'"),
    ),
    PackageCase(
        setup_imports,
        {},
        failing=REFERENCE.replacing(SETUP, "from glob import glob\n", ""),
    ),
    PackageCase(
        launch_found,
        {"name": _NAME},
        failing=REFERENCE.renaming(LAUNCH, "my_robot/launch/my_robot_rvix.launch.py"),
    ),
    PackageCase(
        launch_starts,
        {"name": _NAME, "nodes": ["robot_state_publisher", "rviz2 or rviz"]},
        failing=REFERENCE.replacing(LAUNCH, "package='rviz2'", "package='rviz'"),
    ),
    PackageCase(
        launch_finds_files,
        {"name": _NAME},
        failing=REFERENCE.replacing(LAUNCH, "os.path.join(share, 'my_robot.urdf')", "'urdf/my_robot.urdf'"),
    ),
    PackageCase(
        rviz_found,
        _RVIZ,
        failing=REFERENCE.renaming(RVIZ, "my_robot/rviz/view.rviz"),
    ),
    PackageCase(
        rviz_fixed_frame,
        {**_RVIZ, "frame": "base_footprint"},
        failing=REFERENCE.replacing(RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: map"),
    ),
    PackageCase(
        rviz_shows_robot,
        {**_RVIZ, "topic": "/robot_description"},
        failing=REFERENCE.replacing(RVIZ, "rviz_default_plugins/RobotModel", "rviz/RobotModel"),
    ),
    PackageCase(
        rviz_display_on,
        {**_RVIZ, "kind": "TF"},
        failing=REFERENCE.replacing(RVIZ, "plugins/TF\n      Enabled: true", "plugins/TF\n      Enabled: false"),
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
        without=REFERENCE.without(ANSWERS),
    ),
    PendingCase(
        evidence_shown,
        {"names": ["task 1 step 8"]},
        without=Submitted({path: content for path, content in REFERENCE.files.items() if not path.endswith(".png")}),
    ),
)

PACKAGE_CASE = {case.name: case for case in PACKAGE_CASES}
PENDING_CASE = {case.name: case for case in PENDING_CASES}
