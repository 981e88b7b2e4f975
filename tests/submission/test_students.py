"""Repositories of several students are told from the parts and versions of one student's submission."""

from collections.abc import Mapping

import pytest

from grader.submission.students import is_part, person_in
from tests.submission.trees import BOX, PICTURE, ROBOT, manifest, package, submission

LAB = {"lab", "6"}


@pytest.mark.parametrize(
    ("name", "person"),
    [
        ("Ash", "ash"), ("Ash Birch", "ashbirch"), ("ash_birch", "ashbirch"), ("AshBirch", "ashbirch"), ("Lab6_Ash", "ash"),
        ("Ash-Lab 6", "ash"), ("Ash_final", "ash"), ("Ash_v2", "ash2"), ("Ash_2024-11-05", "ash"), ("Ash.zip", "ash"), ("ab12cde", "ab12cde"),
        ("s1234567", "s1234567"), ("1234567", "1234567"), ("student1", "student1"), ("Team 3", "team3"), ("\u00d6zg\u00fcr", "\u00f6zg\u00fcr"),
        ("ash@example.org", "ash"),
    ],
)  # fmt: skip
def test_names_of_students(name: str, person: str) -> None:
    """Names, logins and numbers, whatever words of the lab or of versions are around them."""
    assert person_in(name, LAB) == person
    assert not is_part(name, LAB)


@pytest.mark.parametrize(
    "name",
    [
        "src", "urdf", "launch", "rviz", "ros2_ws", "roscourse_sim_ws", "my_robot", "MyRobot", "myrobot", "my_robot_v2", "lab", "Lab6", "lab_7",
        "Task1", "Task 2", "part-3", "step15", "prelab", "prelab6", "Pre Lab", "backup", "my_robot_backup", "old", "Old stuff", "copy", "copy of lab6",
        "v2", "version 3", "final", "final_version", "solution", "Final Project", "New folder (2)", "resources", "Lab6 resources", "Screenshots",
        "other_robot_gazebo", "wheeled_base", "robot_description", "webots_worlds", "turtlebot3", "second try", "ubuntu", "template", "urdf_tutorial",
        "IRP_Course", "team", "students", "submissions", "diff_drive", "my_urdf", "robot_with_wheels", "evidence", "Lab 6 - pictures", "code",
    ],
)  # fmt: skip
def test_names_of_parts_and_versions(name: str) -> None:
    """These are never students."""
    assert person_in(name, LAB) == ""
    assert is_part(name, LAB)


@pytest.mark.parametrize("name", ["2024-11-05", "20241105", "05.11.2024", "1", "A", "42"])
def test_dates_and_short_names(name: str) -> None:
    """These are not students either."""
    assert person_in(name, LAB) == ""


@pytest.mark.parametrize(
    ("files", "students"),
    [
        ({**package("Lab6/Ash/my_robot"), **package("Lab6/Birch/my_robot")}, ("Lab6/Ash", "Lab6/Birch")),
        ({**package("Lab6/Ash/ws/src/my_robot"), "Lab6/Birch/urdf.xacro file.py": ROBOT}, ("Lab6/Ash", "Lab6/Birch")),
        ({**package("Lab6/Ash/my_robot"), **package("Lab6/Birch/my_robot", urdf=False)}, ("Lab6/Ash", "Lab6/Birch")),
        ({**package("Ash/Lab6/my_robot"), **package("Birch/Lab6/my_robot"), **package("Birch/Lab7/my_robot")}, ("Ash", "Birch")),
        ({"Lab6_Ash/my_robot.urdf": ROBOT, "Lab6_Birch/my_robot.urdf": ROBOT}, ("Lab6_Ash", "Lab6_Birch")),
        ({"Ash/my_robot.urdf": ROBOT, "Birch/my_robot.urdf": ROBOT, "README.md": b""}, ("Ash", "Birch")),
        ({"Oak/Lab6/Ash/a.urdf": ROBOT, "Oak/Lab6/Birch/a.urdf": ROBOT, "Oak/Lab6/Cedar/a.urdf": ROBOT},
         ("Oak/Lab6/Ash", "Oak/Lab6/Birch", "Oak/Lab6/Cedar")),
        ({**package("Lab6/Ash"), **package("Lab6/Birch")}, ("Lab6/Ash", "Lab6/Birch")),
        ({"Lab6/Ash/a.urdf": BOX, "Lab6/Birch/b.urdf": BOX}, ("Lab6/Ash", "Lab6/Birch")),
        ({"Lab6/student1/my_robot.urdf": ROBOT, "Lab6/student2/my_robot.urdf": ROBOT}, ("Lab6/student1", "Lab6/student2")),
        ({"Lab6/Ash/my_robot.urdf": ROBOT, "Lab6/Birch/my_robot.urdf": ROBOT, "Lab6/template/my_robot.urdf": ROBOT},
         ("Lab6/Ash", "Lab6/Birch")),
        ({"Lab6/Ash/a.urdf": ROBOT, "Lab6/Ash_old/a.urdf": ROBOT, "Lab6/Ash2/a.urdf": ROBOT, "Lab6/Birch/a.urdf": ROBOT},
         ("Lab6/Ash", "Lab6/Birch")),
    ],
)  # fmt: skip
def test_several_students(files: Mapping[str, bytes], students: tuple[str, ...]) -> None:
    """Folders with names of different students, each with a robot or a package."""
    assert submission(files).students == students


@pytest.mark.parametrize(
    "files",
    [
        {**package("Lab6/my_robot"), **package("Lab6/backup/my_robot"), **package("Lab6/2024-11-05/my_robot"), **package("Lab6/v2/my_robot")},
        {**package("Lab6/Ash/my_robot"), **package("Lab6/Ash_old/my_robot"), **package("Lab6/Ash/backup/my_robot"), **package("Lab6/Ash (1)/my_robot")},
        {**package("Lab6/Ash/my_robot"), **package("Lab7/Birch/my_robot")},
        {**package("Lab6/Ash/my_robot"), "Lab6/Birch/step.png": PICTURE},
        {**package("Lab6/Ash/my_robot"), "Lab6/cubes/box.urdf": BOX},
        {**package("Lab6/Ash/src/my_robot"), **package("Lab6/Ash/src/friendly", "friendly")},
        {**package("my_robot"), **package("alpha", "alpha"), **package("beta", "beta")},
        {**package("ros2_ws/src/my_robot"), **package("roscourse_sim_ws/src/my_robot")},
        {"Lab6/Task1/my_robot.urdf": ROBOT, **package("Lab6/Task2/my_robot")},
        {"lab6/ash/prelab/box.urdf": BOX, "lab6/ash/lab/my_robot.urdf": ROBOT},
        {"my_robot.urdf": ROBOT, "cubes/box.urdf": BOX, "balls/ball.urdf": BOX},
        {"a/my_robot.urdf": ROBOT, "b/my_robot.urdf": ROBOT},
        {"a/my_robot/package.xml": manifest("my_robot"), "a/my_robot/urdf/ash/a.urdf": ROBOT, "a/my_robot/urdf/birch/b.urdf": ROBOT},
    ],
)  # fmt: skip
def test_one_student(files: Mapping[str, bytes]) -> None:
    """Versions, parts, other packages, and robots that nobody asked for are of one student."""
    assert submission(files).students == ()


def test_folders_of_others_who_submitted_no_robot() -> None:
    """They are named in a note: their pictures and answers are read, because nothing proves whose they are."""
    files = {
        **package("Lab6/Ash/my_robot"),
        "Lab6/Birch/step.png": PICTURE,
        "Lab6/Cedar/a.md": b"",
        "Lab6/Pictures/b.png": PICTURE,
    }
    found = submission({**files, "Lab7/Elm/a.png": PICTURE, "Lab6/Ash2/a.png": PICTURE})
    note = "Lab6/Birch and Lab6/Cedar may be of other students, but were read as well: grade Lab6/Ash to leave them out"
    assert found.notes == (note,)
    assert submission(package("Lab6/Ash/my_robot")).notes == ()
    assert submission({**package("lab6-ash"), "lab5-ash/my_robot.urdf": ROBOT}).notes == ()  # another lab's
    assert submission({**package("Lab6/my_robot"), "Lab6/Birch/step.png": PICTURE}).notes == ()


def test_an_old_version_is_not_graded() -> None:
    """The package that is no backup is graded, however deep it is, and the backup is listed with the reason."""
    for backup in ("Lab6/backup/my_robot", "Lab6/Old_Versions/my_robot", "Lab6/wsBackup/src/my_robot"):
        found = submission({**package(backup), **package("Lab6/ws/new/src/my_robot")})
        assert found.package is not None
        assert found.package.folder == "Lab6/ws/new/src/my_robot"
        reasons = {other.path: other.reason for other in found.other_candidates}
        assert reasons[f"{backup}/package.xml"] == "it is named like a backup"
