"""Group submissions: they count for each member, by the group's name in the roster."""

import random
from pathlib import Path

import pytest

from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.intake.roster_file import read_roster
from grader.classroom.students import Student
from grader.errors import InputError
from tests.classroom.class_folders import assigned, lay_out, pack
from tests.classroom.lab6_class import read_class

ANN = Student("100", "Ann Ash", login="aash")
BEA = Student("200", "Bea Birch", login="bbirch")
CAL = Student("300", "Cal Cedar", login="ccedar")
DAN = Student("400", "Dan Dale", login="ddale")
SHARED = "group submissions that count for each member: {}"


def roster(red: str = "Team Red", blue: str = "Team Blue") -> Roster:
    """Return a roster of two groups whose members are interleaved."""
    return Roster([RosterEntry(CAL, red), RosterEntry(BEA, blue), RosterEntry(ANN, red), RosterEntry(DAN)])


@pytest.mark.parametrize("name", ["Team Red", "team_red", "TEAM-RED", "Team  Red", "lab6-team-red"])
def test_each_member_gets_the_groups_submission(tmp_path: Path, name: str) -> None:
    """Case and separators are ignored; the paths are the same, names and numbers are the member's own."""
    files = [f"{name}/my_robot.urdf", f"{name[:-1]}x.zip"]
    for path in (lay_out(tmp_path / "class", *files), pack(tmp_path / "class.zip", files)):
        intake = read_class(path, roster())
        assert len(intake) == 3
        assert [(submission.student, submission.paths) for submission in intake.submissions()][:2] == [
            (ANN, (name,)),
            (CAL, (name,)),
        ]
        assert (intake.unmatched, intake.absent) == (tuple(list(assigned(intake))[2:]), (BEA, DAN))
        assert intake.notes == (SHARED.format(1),)


@pytest.mark.parametrize("name", ["Team", "Red", "TeamRed", "Team Red 2", "Team Reds"])
def test_only_the_whole_name_counts(tmp_path: Path, name: str) -> None:
    """A group with another name is unmatched, as without groups."""
    intake = read_class(lay_out(tmp_path, f"{name}/my_robot.urdf", "x.zip"), roster())
    assert sorted(assigned(intake)) == sorted(intake.unmatched) == sorted([name, "x"])
    assert len(intake.absent) == 4
    assert not intake.notes


def test_a_members_own_submission_takes_precedence(tmp_path: Path) -> None:
    """The group's counts for the others, with a note; if all have their own, it is unmatched."""
    lay_out(tmp_path, "ccedar.zip", "team-red/", "bbirch.urdf", "team-blue.zip")
    intake = read_class(tmp_path, roster())
    assert assigned(intake) == {
        "100": ("team-red",),
        "200": ("bbirch.urdf",),
        "300": ("ccedar.zip",),
        "team-blue": ("team-blue.zip",),
    }
    assert intake.unmatched == ("team-blue",)
    assert intake.absent == (DAN,)
    assert intake.notes == (
        "200 has submitted bbirch, which counts for them, not team-blue of their group",
        "300 has submitted ccedar, which counts for them, not team-red of their group",
        SHARED.format(1),
    )


def test_two_submissions_of_a_group_are_ambiguous(tmp_path: Path) -> None:
    """It is unknown which is the group's, so its members are contested."""
    intake = read_class(lay_out(tmp_path, "team_red/", "Team Red/"), roster())
    assert assigned(intake) == {"Team Red": ("Team Red",), "team_red": ("team_red",)}
    assert intake.notes == ("Team Red, team_red are each named like one group: left unassigned",)
    assert (intake.contested, intake.absent) == ((CAL, ANN), (BEA, DAN))


def test_a_student_takes_precedence_over_a_group(tmp_path: Path) -> None:
    """A submission that matches a student and a group, or several students, is not the group's."""
    intake = read_class(lay_out(tmp_path, "aash/"), roster(red="aash"))
    assert assigned(intake) == {"100": ("aash",)}
    twins = Roster([RosterEntry(Student("1", "Sam"), "sam"), RosterEntry(Student("2", "Sam"), "sam")])
    intake = read_class(tmp_path, twins)
    assert intake.unmatched == ("aash",)
    intake = read_class(lay_out(tmp_path / "twins", "sam/"), twins)
    assert (intake.unmatched, len(intake.absent), len(intake.contested)) == (("sam",), 0, 2)


def test_a_section_is_no_group(tmp_path: Path) -> None:
    """A folder named like a section that holds submissions of its students is unmatched, with a note."""
    files = ["Section 1/aash/my_robot.urdf", "Section 1/ccedar.zip", "Section 2/bbirch.zip", "Section 2/readme.txt"]
    path = lay_out(tmp_path, *files)
    intake = read_class(path, roster("Section 1", "Section 2"))
    assert assigned(intake) == {"200": ("Section 2",), "Section 1": ("Section 1",)}
    assert "Section 1 is named like a group, but holds submissions of several students" in intake.notes


def test_a_group_in_moodle_and_in_a_roster_file(tmp_path: Path) -> None:
    """Moodle gives a group's number beside its name; a column of groups takes precedence over one of sections."""
    (tmp_path / "roster.csv").write_text("id,section,Team\naash,A,Team Red\nbbirch,A,\nccedar,B,team red\n")
    known = read_roster(tmp_path / "roster.csv")
    assert [entry.team for entry in known.entries] == ["Team Red", "A", "team red"]
    top = lay_out(tmp_path / "class", "Team Red_7_assignsubmission_file/lab6.zip")
    submissions = list(read_class(top, known).submissions())
    assert [submission.student.key for submission in submissions] == ["aash", "ccedar"]
    assert {submission.paths for submission in submissions} == {("Team Red_7_assignsubmission_file/lab6.zip",)}
    assert {(submission.student.moodle, submission.student.name) for submission in submissions} == {("", "")}


def test_submissions_are_ordered_by_key(tmp_path: Path) -> None:
    """The order does not depend on the roster and is the same every time."""
    names = [f"team {number:02}" for number in range(20)]
    entries = [RosterEntry(Student(f"s{number:03}"), names[number % 20]) for number in range(100)]
    lay_out(tmp_path, *(f"{name}/" for name in names), "zoe/")
    expected = {**{f"s{number:03}": (names[number % 20],) for number in range(100)}, "zoe": ("zoe",)}
    for seed in range(3):
        random.Random(seed).shuffle(entries)
        intake = read_class(tmp_path, Roster(entries))
        assert list(assigned(intake).items()) == list(expected.items())
        assert list(intake.submissions()) == list(intake.submissions())
        assert (len(intake), intake.unmatched, intake.absent) == (101, ("zoe",), ())


@pytest.mark.parametrize("layout", ["auto", "folders", "canvas", "moodle", "teams"])
def test_the_assignment_option_is_for_nbgrader(tmp_path: Path, layout: str) -> None:
    """With another layout it would have no effect, which is an error."""
    lay_out(tmp_path, "ann/my_robot.urdf", "bea.zip")
    with pytest.raises(InputError, match="--assignment is only for the layout nbgrader"):
        read_class(tmp_path, layout=layout, assignment="ps1")
