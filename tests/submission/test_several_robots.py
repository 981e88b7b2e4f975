"""Several robots that fit, perhaps of several students: the most complete one is graded, and a note names the others."""

from collections.abc import Mapping

import pytest

from grader.lab.submission.labs import is_part
from tests.submission.trees import BOX, PICTURE, ROBOT, manifest, package, submission

pytestmark = pytest.mark.slow

LAB = {"lab", "6"}


@pytest.mark.parametrize(
    "name", ["Ash", "Ash Birch", "ash_birch", "Lab6_Ash", "ab12cde", "\u00d6zg\u00fcr"]
)
def test_names_of_students(name: str) -> None:
    """Names and logins are no parts of a submission."""
    assert not is_part(name, LAB)


@pytest.mark.parametrize(
    "name",
    [
        "src",
        "urdf",
        "launch",
        "rviz",
        "ros2_ws",
        "my_robot",
        "MyRobot",
        "Lab6",
        "lab_7",
        "Task1",
        "part-3",
        "prelab6",
        "Old stuff",
        "copy of lab6",
        "v2",
        "final_version",
        "2024-11-05",
        "Screenshots",
        "webots_worlds",
    ],
)
def test_names_of_parts_and_versions(name: str) -> None:
    """These are never students."""
    assert is_part(name, LAB)


PLACE = "my_robot/urdf/my_robot.urdf"


@pytest.mark.parametrize(
    ("files", "graded", "others"),
    [
        (
            {**package("Lab6/Ash/my_robot"), **package("Lab6/Birch/my_robot")},
            f"Lab6/Ash/{PLACE}",
            f"Lab6/Birch/{PLACE}",
        ),
        (
            {**package("Lab6/Ash/my_robot"), "Lab6/Birch/urdf.xacro file.py": ROBOT},
            f"Lab6/Ash/{PLACE}",
            "Lab6/Birch/urdf.xacro file.py",
        ),
        (
            {"Ash/my_robot.urdf": ROBOT, "Birch/my_robot.urdf": ROBOT, "README.md": b""},
            "Ash/my_robot.urdf",
            "Birch/my_robot.urdf",
        ),
        (
            {
                "Lab6/Ash/a.urdf": ROBOT,
                "Lab6/Birch/a.urdf": ROBOT,
                "Lab6/Cedar/a.urdf": ROBOT,
                "Lab7/Ash/a.urdf": ROBOT,
            },
            "Lab6/Ash/a.urdf",
            "Lab6/Birch/a.urdf and Lab6/Cedar/a.urdf",
        ),
        (
            {**package("a_ws/src/my_robot"), **package("b_ws/src/my_robot")},
            f"a_ws/src/{PLACE}",
            f"b_ws/src/{PLACE}",
        ),
    ],
)
def test_several_robots_fit(files: Mapping[str, bytes], graded: str, others: str) -> None:
    """In other packages or folders: who grades must see which one counts."""
    found = submission(files)
    count = 2 + others.count(" and ")
    note = f"{count} robots fit this lab: {graded} was graded, not {others}; to grade another one, name its file or folder"
    assert found.several == note
    assert found.several in found.notes


@pytest.mark.parametrize(
    "files",
    [
        {
            **package("Lab6/my_robot"),
            **package("Lab6/backup/my_robot"),
            **package("Lab6/Old_Versions/my_robot"),
        },
        {**package("Lab6/Ash/my_robot"), **package("Lab7/Birch/my_robot")},
        {**package("Lab6/Ash/my_robot"), "Lab6/Birch/step.png": PICTURE},
        {**package("Lab6/Ash/my_robot"), "Lab6/cubes/box.urdf": BOX},
        {"my_robot.urdf": ROBOT, "cubes/box.urdf": BOX, "balls/ball.urdf": BOX},
        {
            "a/my_robot/package.xml": manifest("my_robot"),
            "a/my_robot/urdf/ash/a.urdf": ROBOT,
            "a/my_robot/urdf/birch/b.urdf": ROBOT,
        },
    ],
)
def test_one_robot_fits(files: Mapping[str, bytes]) -> None:
    """Backups, other labs, other robots, and files in the package that is graded are listed, without a note."""
    assert submission(files).several == ""


def test_an_old_version_is_not_graded() -> None:
    """The package that is no backup is graded, however deep it is, and the backup is listed with the reason."""
    for backup in (
        "Lab6/backup/my_robot",
        "Lab6/Old_Versions/my_robot",
        "Lab6/wsBackup/src/my_robot",
    ):
        found = submission({**package(backup), **package("Lab6/ws/new/src/my_robot")})
        assert found.package is not None
        assert found.package.folder == "Lab6/ws/new/src/my_robot"
        reasons = {other.path: other.reason for other in found.other_candidates}
        assert reasons[f"{backup}/package.xml"] == "it is named like a backup"
