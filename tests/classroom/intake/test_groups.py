"""Group submissions: they count for each member, by the group's name in the roster."""

import random
from dataclasses import replace
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
        "200 has submitted bbirch, which counts instead of the group's team-blue",
        "300 has submitted ccedar, which counts instead of the group's team-red",
        SHARED.format(1),
    )


def test_two_submissions_of_a_group_are_ambiguous(tmp_path: Path) -> None:
    """It is unknown which is the group's, so its members are contested."""
    intake = read_class(lay_out(tmp_path, "team_red/", "Team Red/"), roster())
    assert assigned(intake) == {"Team Red": ("Team Red",), "team_red": ("team_red",)}
    assert intake.notes == ("Team Red, team_red are named like the same group: left unassigned",)
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
    assert "Section 1 is named like a group, but contains submissions of several students" in intake.notes


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


ASH, BIRCH, CEDAR, DOGWOOD = (
    Student(name.partition(",")[0], name, canvas=number)
    for name, number in (("Ash, Ann", "101"), ("Birch, Bea", "102"), ("Cedar, Cal", "103"), ("Dogwood, Dan", "104"))
)


def in_groups(*groups: str, numbers: bool = True) -> Roster:
    """Return a roster of four students with these groups."""
    students = (
        (ASH, BIRCH, CEDAR, DOGWOOD) if numbers else (replace(one, canvas="") for one in (ASH, BIRCH, CEDAR, DOGWOOD))
    )
    return Roster(RosterEntry(student, group=group) for student, group in zip(students, groups, strict=True))


@pytest.mark.parametrize("numbers", [True, False])
@pytest.mark.parametrize(
    ("group", "file"),
    [
        ("Team Ä-1", "teamä1_102_555_lab6.zip"),
        ("Team Ä-1", "teamä1_LATE_102_555_lab6.zip"),
        ("Team_7", "team_7_102_555_lab6.zip"),  # as if user 7 were called team
        ("Team_7_b", "team7b_102_text.html"),
    ],
)
def test_a_group_in_canvas(tmp_path: Path, group: str, file: str, numbers: bool) -> None:
    """The file has the group's name and a member's id: it counts for every member, with its lateness."""
    others = ("reds_103_556_lab6.zip", "reds_103_557_answers.pdf")
    intake = read_class(lay_out(tmp_path, file, *others), in_groups(group, group, "Reds", "Reds", numbers=numbers))
    assert assigned(intake) == {"Ash": (file,), "Birch": (file,), "Cedar": others[::-1], "Dogwood": others[::-1]}
    assert [submission.is_late for submission in intake.submissions()] == ["_LATE_" in file] * 2 + [False] * 2
    assert (intake.unmatched, intake.absent, intake.notes) == ((), (), (SHARED.format(2),))
    assert [submission.student.canvas for submission in intake.submissions()] == (
        ["101", "102", "103", "104"] if numbers else [""] * 4
    )


def test_without_a_group_on_the_roster_the_id_decides(tmp_path: Path) -> None:
    """The member whose id is in the name gets the submission, with a note that asks for the groups; others keep their own."""
    files = ("teama_102_555_lab6.zip", "cedarcal_103_556_lab6.zip", "other_104_557_lab6.zip")
    intake = read_class(lay_out(tmp_path, *files), in_groups("", "", "C", "D"))
    assert assigned(intake) == {"Birch": files[:1], "Cedar": files[1:2], "Dogwood": files[2:]}
    assert intake.absent == (ASH,)
    assert [note.partition(";")[0] for note in intake.notes] == [
        "teama_102: not named like the student with this id on the roster"
    ]


def test_a_member_who_also_submitted(tmp_path: Path) -> None:
    """Their own submission counts for them, the group's for the others."""
    files = ("ashann_101_554_lab6.zip", "teama_102_555_lab6.zip")
    intake = read_class(lay_out(tmp_path, *files), in_groups("Team A", "Team A", "Team A", ""))
    assert assigned(intake) == {"Ash": files[:1], "Birch": files[1:], "Cedar": files[1:]}
    assert intake.notes[0] == "Ash has submitted ashann_101, which counts instead of the group's teama_102"


@pytest.mark.parametrize(
    ("files", "groups", "given", "note"),
    [
        (
            ["reds_103_1_a.zip"],
            ("Reds", "Reds", "Blues", ""),
            ["Cedar"],
            (
                "reds_103 is named like the group 'Reds', but 103 is Cedar, whose group is 'Blues': counts for Cedar only;"
                " Ash and Birch keep an earlier submission"
            ),
        ),
        (
            ["reds_103_1_a.zip"],
            ("Reds", "Reds", "", ""),
            ["Cedar"],
            (
                "reds_103 is named like the group 'Reds', but 103 is Cedar, who has no group on the roster: counts for Cedar"
                " only; Ash and Birch keep an earlier submission"
            ),
        ),
        (
            ["reds_999_1_a.zip"],
            ("Reds", "Reds", "", ""),
            [],
            (
                "reds_999 is named like the group 'Reds', but 999 is not the id of a member: left unassigned; Ash and Birch keep"
                " an earlier submission"
            ),
        ),
        (
            ["ashann_101_1_a.zip"],
            ("Ash Ann", "Ash Ann", "", ""),
            ["Ash"],
            (
                "ashann_101 may be named after a student or the group 'Ash Ann': counts for Ash only; Birch keeps an earlier"
                " submission"
            ),
        ),
        (
            ["ashann_101_1_a.zip", "reds_101_2_a.zip"],
            ("Reds", "Reds", "", ""),
            ["Ash"],
            "reds_101 has files with different names: counts for Ash only; Birch keeps an earlier submission",
        ),
    ],
)
def test_contradictions_are_reported(
    tmp_path: Path, files: list[str], groups: tuple[str, ...], given: list[str], note: str
) -> None:
    """What the number and the name say differently counts for the student with the number only, or for nobody."""
    intake = read_class(lay_out(tmp_path, *files), in_groups(*groups), layout="canvas")
    assert [key for key in assigned(intake) if key not in intake.unmatched] == given
    assert intake.notes == (note,)
    assert {student.key for student in intake.contested} | set(given) >= {"Ash", "Birch"}
    assert "Birch" not in {student.key for student in intake.absent}


def test_a_student_who_is_called_like_a_group_takes_nothing_away(tmp_path: Path) -> None:
    """The group's own submission counts for its members; the student has only their own."""
    files = ("reds_104_1_lab6.zip", "reds_102_2_lab6.zip")
    intake = read_class(lay_out(tmp_path, *files), in_groups("Reds", "Reds", "", ""))
    assert assigned(intake) == {"Ash": files[1:], "Birch": files[1:], "Dogwood": files[:1]}
    assert (intake.absent, intake.contested) == ((CEDAR,), ())
    assert intake.notes[-1] == (
        "reds_104 is named like the group 'Reds', but 104 is Dogwood, who has no group on the roster: counts for Dogwood only"
    )


def test_a_gradebook_of_canvas_has_sections_only(tmp_path: Path) -> None:
    """A section is no group: the note still asks for the groups."""
    roster = Roster([RosterEntry(ASH, "ROB-1"), RosterEntry(BIRCH, "ROB-1")])
    intake = read_class(lay_out(tmp_path, "teama_101_1_lab6.zip"), roster)
    assert assigned(intake) == {"Ash": ("teama_101_1_lab6.zip",)}
    assert len(intake.notes) == 1
    assert "add a column `group`" in intake.notes[0]
