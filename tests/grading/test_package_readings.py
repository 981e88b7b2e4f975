"""A slip in a file of a package costs one criterion, and the message is at the place that is wrong."""

import pytest

from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.edited import with_files
from tests.grading.slips import DIFFDRIVE
from tests.samples import LAB6, reference

pytestmark = pytest.mark.slow


def _graded(rubric: Rubric, end: str, old: str, new: str) -> Report:
    """Return the report on a solution, one text of which is another one in one file."""
    solution = reference(rubric)
    path = next(path for path in solution.whole_tree.files if path.endswith(end))
    text = (solution.whole_tree.read(path, 1 << 20) or b"").decode()
    assert old in text
    return grade(rubric, with_files(solution, {path: text.replace(old, new, 1).encode()}))


def _lost(report: Report) -> list[str]:
    return [result.criterion.id for result in report.results if result.is_lost]


_EXPORT = "<export>\n    <build_type>ament_python</build_type>\n  </export>"
_SPAWNERS = """
        Node(package="controller_manager", executable="spawner", arguments=["joint_state_broadcaster"]),
        Node(
            package="controller_manager",
            executable="spawner",
            arguments=["diff_drive_controller", "--param-file", controllers],
        ),"""
# The second one waits for the end of the first one, which nothing starts.
_WAITING = """
        RegisterEventHandler(OnProcessExit(
            target_action=Node(package="controller_manager", executable="spawner", arguments=["joint_state_broadcaster"]),
            on_exit=[Node(
                package="controller_manager",
                executable="spawner",
                arguments=["diff_drive_controller", "--param-file", controllers],
            )],
        )),"""


@pytest.mark.parametrize(
    ("rubric", "end", "old", "new", "lost"),
    [
        (LAB6, "package.xml", _EXPORT, "<build_type>ament_python</build_type>", ["package-found"]),
        (LAB6, "launch.py", "package='rviz2'", "package='rvizz2'", ["launch-nodes"]),
        (LAB6, "launch.py", "executable='rviz2'", "executable='rvizz2'", ["launch-nodes"]),
        (LAB6, "launch.py", "executable='rviz2'", "executable='turtle'", ["launch-nodes"]),
        (LAB6, "launch.py", "package='rviz2'", "package=str('rviz2')", []),
        (DIFFDRIVE, "controllers.yaml", "wheel_radius: 0.05", 'wheel_radius: "0.05"', ["parameters-read"]),
        (DIFFDRIVE, "controllers.yaml", "odom_tf: true", "odom_tf: 'true'  # it is", ["parameters-read"]),
        (DIFFDRIVE, "controllers.yaml", "wheel_radius: 0.05", 'wheel_radius: "0.06"', ["parameters-read", "wheel-radius"]),
        (DIFFDRIVE, "controllers.yaml", "frame_id: odom", 'frame_id: "odom"', []),
    ],
)  # fmt: skip
def test_a_slip_in_a_package(rubric: Rubric, end: str, old: str, new: str, lost: list[str]) -> None:
    """One criterion pays for a word, and a wrong value costs its own points."""
    assert _lost(_graded(rubric, end, old, new)) == lost


@pytest.mark.parametrize(
    ("old", "new", "lost"),
    [
        (_SPAWNERS, _WAITING, ["launch-nodes"]),
        # Another mistake of the controllers costs its own points.
        (_SPAWNERS, _WAITING.replace("diff_drive_controller", "drive_controller"), ["launch-nodes", "controllers-fit"]),
    ],
)  # fmt: skip
def test_a_spawner_that_is_not_started(old: str, new: str, lost: list[str]) -> None:
    """A spawner that is made and not started costs the points of the launch file only."""
    imports = "from launch.actions import DeclareLaunchArgument\n"
    handlers = "from launch.actions import DeclareLaunchArgument, RegisterEventHandler\nfrom launch.event_handlers import OnProcessExit\n"
    path = next(
        path for path in reference(DIFFDRIVE).whole_tree.files if path.endswith("drive.launch.py")
    )
    text = (reference(DIFFDRIVE).whole_tree.read(path, 1 << 20) or b"").decode()
    changed = text.replace(imports, handlers).replace(old, new)
    report = grade(DIFFDRIVE, with_files(reference(DIFFDRIVE), {path: changed.encode()}))
    assert _lost(report) == lost


def test_a_name_of_a_file_that_is_a_number() -> None:
    """A file without parameters has its texts as they are written."""
    report = _graded(LAB6, "my_robot.rviz", "Fixed Frame: base_footprint", 'Fixed Frame: "1"')
    assert _lost(report) == ["rviz-fixed-frame"]


@pytest.mark.parametrize(
    ("executable", "line"),
    [("joint_state_publisher_gui", 27), ("robot_state_publisher", 32)],
)
def test_a_namespace(executable: str, line: int) -> None:
    """Where topics do not meet for a namespace, the place is the node that is in it."""
    old = f"executable='{executable}',"
    report = _graded(LAB6, "launch.py", old, f"{old} namespace='robot1',")
    lost = [result for result in report.results if result.is_lost]
    assert lost
    location = lost[0].outcome.location
    assert location is not None
    assert (location.path.endswith("launch.py"), location.line) == (True, line)


def test_a_comment_without_its_second_hyphen() -> None:
    """A <!- that TinyXML2 skips is named as a comment, not as a DOCTYPE."""
    report = _graded(LAB6, "my_robot.urdf", "<!-- Base,", "<!- Base,")
    messages = [problem.message for problem in report.problems if problem.code == "URDF010"]
    assert messages == ["a comment begins with <!--, not with <!-; ROS 2 skips it up to its >"]
