"""Team repositories with a folder for each student, and nbgrader courses."""

from pathlib import Path

import pytest

from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from grader.submission.labs import LabFolders
from tests.classroom.class_folders import assigned, lay_out, pack
from tests.classroom.lab6_class import read_class

TEAM = (
    "red/Lab6/Ash/ws/src/my_robot/package.xml",
    "red/Lab6/Birch/my_robot.urdf",
    "red/Lab6/README.md",
    "red/Lab5/Ash/",
)


def test_students_in_teams(tmp_path: Path) -> None:
    """Each student's folder is a submission whose key starts with the team's name; other teams stay whole."""
    files = (*TEAM, "blue/lab_06/Ash/lab/a.urdf", "blue/lab_06/Cedar/lab/a.urdf", "gold/my_robot/package.xml")
    for path in (lay_out(tmp_path / "class", *files), pack(tmp_path / "class.zip", files)):
        intake = read_class(path)
        assert (intake.layout, assigned(intake)) == (
            "teams",
            {
                "blue/Ash": ("blue/lab_06/Ash",),
                "blue/Cedar": ("blue/lab_06/Cedar",),
                "gold": ("gold",),
                "red/Ash": ("red/Lab6/Ash",),
                "red/Birch": ("red/Lab6/Birch",),
            },
        )
        assert intake.ignored == ("red/Lab6/README.md is not a folder, an archive or a URDF",)


@pytest.mark.parametrize(
    "files",
    [
        ("red/Lab6/src/my_robot/urdf/a.urdf", "red/Lab6/Ash/a.urdf", "red/Lab6/Birch/a.urdf"),
        ("red/Lab6/my_robot/urdf/a.urdf", "red/Lab6/other_description/urdf/a.urdf"),
        ("red/Lab6/Task1/a.urdf", "red/Lab6/Task 2/a.urdf"),
        ("red/Lab6/prelab/box.urdf", "red/Lab6/lab/a.urdf"),
        ("red/Lab6/alpha/package.xml", "red/Lab6/beta/package.xml"),
        ("red/Lab6/Ash/a.urdf", "red/Lab6/Birch/step.png"),
        ("red/Lab6/roscourse_sim_ws/a.urdf", "red/Lab6/second_ws/a.urdf"),
        ("red/Lab6/Ash/a.urdf", "red/Lab6/Birch/a.urdf", "red/Lab6/package.xml"),
        ("red/Lab7/Ash/a.urdf", "red/Lab7/Birch/a.urdf"),
    ],
)
def test_a_single_submission_is_not_split(tmp_path: Path, files: tuple[str, ...]) -> None:
    """Parts of a package or of a report are never taken for students."""
    intake = read_class(lay_out(tmp_path, *files))
    assert (intake.layout, assigned(intake)) == ("folders", {"red": ("red",)})


def test_a_roster_confirms_students(tmp_path: Path) -> None:
    """Names on the roster are students even if their folders are empty; surnames count within a team."""
    students = [Student("1", "Ann Ash"), Student("2", "Birch, Bea"), Student("3", "Cal Cedar")]
    roster = Roster(RosterEntry(student, "Red") for student in students)
    intake = read_class(lay_out(tmp_path, "red/Lab6/ash/step.png", "red/Lab6/Birch.zip", "blue/Lab6/src/"), roster)
    assert assigned(intake) == {"1": ("red/Lab6/ash",), "2": ("red/Lab6/Birch.zip",), "blue": ("blue",)}
    assert intake.absent == (students[2],)


@pytest.mark.parametrize(
    ("group", "words"),
    [
        ("blue", "whose group is 'blue'"),
        ("", "who has no group on the roster (its column group names the team folders)"),
    ],
)
@pytest.mark.parametrize("name", ["ash", "ASH", "Ann Ash", "1"])
def test_a_team_can_only_name_its_own_members(tmp_path: Path, name: str, group: str, words: str) -> None:
    """A folder in a team matches only students whose group is that team; other students are not affected."""
    ann = Student("1", "Ann Ash", login="ash")
    roster = Roster([RosterEntry(ann, group), RosterEntry(Student("2", login="bea"), "red")])
    files = [f"red/Lab6/{name}/a.urdf", "red/Lab6/bea/a.urdf"]
    intake = read_class(lay_out(tmp_path / "class", *files), roster, layout="teams")
    assert assigned(intake) == {"2": ("red/Lab6/bea",), f"red/{name}": (f"red/Lab6/{name}",)}
    assert intake.notes == (f"red/{name} is named like 1, {words}: left unassigned",)
    assert (intake.absent, intake.contested) == ((ann,), ())
    if group:
        intake = read_class(lay_out(tmp_path / "class", "blue/Lab6/ash/a.urdf"), roster, layout="teams")
        assert assigned(intake)["1"] == ("blue/Lab6/ash",)


def test_a_team_cannot_submit_for_another_team(tmp_path: Path) -> None:
    """A folder named like another group counts for nobody in that group."""
    roster = Roster([RosterEntry(Student("1", login="ash"), "blue"), RosterEntry(Student("2", login="bea"), "red")])
    intake = read_class(lay_out(tmp_path, "red/Lab6/blue/a.urdf", "red/Lab6/bea/a.urdf"), roster, layout="teams")
    assert assigned(intake) == {"2": ("red/Lab6/bea",), "red/blue": ("red/Lab6/blue",)}


def test_the_teams_layout_as_an_option(tmp_path: Path) -> None:
    """With the option, the folders in a lab folder are students unless they are parts of a package."""
    lay_out(tmp_path, "red/Lab6/Ash/step.png", "blue/Lab6/src/a.urdf")
    assert read_class(tmp_path).layout == "folders"
    assert assigned(read_class(tmp_path, layout="teams")) == {"red/Ash": ("red/Lab6/Ash",), "blue": ("blue",)}


def test_names_of_lab_folders() -> None:
    """Case, spaces, hyphens, underscores and leading zeros are ignored."""
    is_lab = LabFolders(["lab6"]).is_lab
    assert all(map(is_lab, ("lab6", "Lab6", "LAB_6", "lab-06", "Lab 006")))
    assert not any(map(is_lab, ("lab66", "lab", "prelab6", "lab6b", "")))
    assert LabFolders(["wheeled base"]).is_lab("Wheeled_Base")
    assert not LabFolders([]).is_lab("")


COURSE = (
    "submitted/ann/lab6/a.urdf",
    "submitted/ann/ps1/",
    "submitted/bea/Lab 6/",
    "submitted/bea/ps1/",
    "source/lab6/",
)


def test_an_nbgrader_course(tmp_path: Path) -> None:
    """The course's folder, or `submitted` itself, gives each student's folder of the assignment, and its time."""
    lay_out(tmp_path / "c", *COURSE, "submitted/notes.txt")
    (tmp_path / "c/submitted/ann/lab6/timestamp.txt").write_text("2015-02-02 15:58:23.948203 UTC\n")
    intake = read_class(tmp_path / "c")
    assert intake.layout == "nbgrader"
    ann = Student("ann", login="ann")
    assert list(intake.submissions()) == [
        ClassSubmission(ann, ("submitted/ann/lab6",), submitted="2015-02-02T15:58:23Z")
    ]
    assert intake.ignored == (
        "submitted/bea has no submission for the assignment lab6",
        "submitted/notes.txt is not a student's folder",
    )
    assert assigned(read_class(tmp_path / "c" / "submitted")) == {"ann": ("ann/lab6",)}
    assert assigned(read_class(tmp_path / "c", assignment="ps1")) == {
        "ann": ("submitted/ann/ps1",),
        "bea": ("submitted/bea/ps1",),
    }


def test_a_course_in_a_zip(tmp_path: Path) -> None:
    """A zip of a course is read in place, including its times."""
    import zipfile

    with zipfile.ZipFile(tmp_path / "course.zip", "w") as archive:
        archive.writestr("robo/submitted/ann/lab-6/a.urdf", b"")
        archive.writestr("robo/submitted/ann/lab-6/timestamp.txt", b"2026-01-30 15:30:10 UCT")
    (ann,) = read_class(tmp_path / "course.zip").submissions()
    assert (ann.paths, ann.submitted) == (("robo/submitted/ann/lab-6",), "2026-01-30T15:30:10Z")


@pytest.mark.parametrize(
    ("stamp", "time"),
    [
        (b"2026-01-30 15:30:10.123 +0200", "2026-01-30T13:30:10Z"),
        (b"2026-01-30 15:30:10", "2026-01-30T15:30:10Z"),
        (b"0001-01-01 00:00:00 +0500", ""),
        (b"2026-01-30 15:30:10 CET", ""),
        (b"\xff\xfe nonsense", ""),
        (b"", ""),
    ],
)
def test_times_of_nbgrader(tmp_path: Path, stamp: bytes, time: str) -> None:
    """A time without a zone is in UTC; one that cannot be read is ignored."""
    lay_out(tmp_path, "submitted/ann/lab6/")
    (tmp_path / "submitted/ann/lab6/timestamp.txt").write_bytes(stamp)
    (ann,) = read_class(tmp_path).submissions()
    assert ann.submitted == time


def test_the_assignment_is_an_option(tmp_path: Path) -> None:
    """A single assignment is used whatever its name; of several one must be named, and an unknown name is an error."""
    lay_out(tmp_path / "c", "submitted/ann/ps1/")
    assert assigned(read_class(tmp_path / "c")) == {"ann": ("submitted/ann/ps1",)}
    lay_out(tmp_path / "c", "submitted/ann/ps2/")
    with pytest.raises(InputError, match="name the assignment to grade with --assignment; there are: ps1, ps2"):
        read_class(tmp_path / "c")
    with pytest.raises(InputError, match="there is no submission for the assignment ps3; there are: ps1, ps2"):
        read_class(tmp_path / "c", assignment="ps3")
    lay_out(tmp_path / "c", "submitted/ann/LAB 6/", "submitted/ann/Lab_6/")
    with pytest.raises(InputError, match="name the assignment"):
        read_class(tmp_path / "c")


def test_a_students_own_repository_is_not_split(tmp_path: Path) -> None:
    """A folder of a student on the roster stays whole, whatever is in it, unless the layout is named."""
    files = ("hazel/Lab6/Ash/a.urdf", "hazel/Lab6/Birch/a.urdf", "oak/Lab6/Elm/a.urdf", "oak/Lab6/Fir/a.urdf")
    top = lay_out(tmp_path, *files)
    roster = Roster([RosterEntry(Student(name)) for name in ("hazel", "oak")])
    intake = read_class(top, roster)
    assert (intake.layout, assigned(intake)) == ("folders", {"hazel": ("hazel",), "oak": ("oak",)})
    groups = {"hazel": "", "Elm": "oak", "Fir": "oak"}
    some = Roster([RosterEntry(Student(name), group) for name, group in groups.items()])
    expected = {"hazel": ("hazel",), "Elm": ("oak/Lab6/Elm",), "Fir": ("oak/Lab6/Fir",)}
    assert assigned(read_class(top, some)) == expected
