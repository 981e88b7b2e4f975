"""Canvas' bulk download: the owner of each file, lateness, and resubmissions."""

import re
import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.matching import canvas_name
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from tests.classroom.class_folders import assigned, lay_out, pack
from tests.classroom.lab6_class import read_class
from tests.examples import examples

FILES = (
    "doejane_LATE_123_9001_lab6.zip",
    "doejane_LATE_123_9002_Task1_Step8.png",
    "müllerjörg_124_9003_my_robot.urdf",
    "לויעדה_125_text.html",
    "o_neilsam_126_link.html",
)


NO_GROUP = (
    "not named like the student with this id on the roster; if this is a group assignment, add a column `group` to the"
    " roster, and the submission counts for each member"
)


def one(tmp_path: Path, *names: str) -> ClassSubmission:
    (submission,) = read_class(lay_out(tmp_path, *names), layout="canvas").submissions()
    return submission


def test_a_download_is_detected(tmp_path: Path) -> None:
    """Files belong to the user whose number they have; a folder and a zip of them give the same result."""
    expected = {
        "doejane_123": (FILES[1], FILES[0]),
        "müllerjörg_124": (FILES[2],),
        "o_neilsam_126": (FILES[4],),
        "לויעדה_125": (FILES[3],),
    }
    for path in (lay_out(tmp_path / "class", *FILES), pack(tmp_path / "submissions.zip", FILES)):
        intake = read_class(path)
        assert (intake.layout, assigned(intake)) == ("canvas", expected)
        jane = next(intake.submissions())
        assert (jane.is_late, jane.names) == (True, ("Task1_Step8.png", "lab6.zip"))
        assert jane.student == Student("doejane_123", canvas="123", readings=(("doejane", "123"),))


def test_anonymous_students(tmp_path: Path) -> None:
    """An anonymous student has five letters instead of a number, which are no user's."""
    lay_out(tmp_path, "anon_aB3xY_9001_lab6.zip", "LATE_anon_Qr5tu_9002_lab6.zip", "anon_aB3xY_text.html")
    late, on_time = read_class(tmp_path).submissions()
    assert (late.student, late.is_late) == (Student("anon_Qr5tu"), True)
    assert (on_time.student, on_time.is_late, len(on_time.paths)) == (Student("anon_aB3xY"), False, 2)


def test_resubmitted_files(tmp_path: Path) -> None:
    """Of files with one name and different resubmission numbers, the one saved last counts."""
    names = ("d_1_20_lab6.tar.gz", "d_1_7_lab6-1.tar.gz", "d_1_100_lab6-2.tar.gz", "d_1_101_a.png", "d_1_3_a.png")
    submission = one(tmp_path, *names)
    assert submission.paths == (names[3], names[2])
    assert submission.names == ("a.png", "lab6-2.tar.gz")
    assert submission.earlier == (names[4], names[1], names[0])
    assert submission.attempt == 3


def test_numbers_in_the_students_own_names(tmp_path: Path) -> None:
    """Numbered files without an unnumbered one are all part of the submission."""
    names = ("d_1_20_task-1.zip", "d_1_21_task-2.zip", "d_1_22_step-8.png")
    assert one(tmp_path, *names).paths == (names[2], names[0], names[1])


def test_files_with_other_names_are_ignored(tmp_path: Path) -> None:
    """A few other files do not prevent detection, and are listed; many of them do."""
    lay_out(tmp_path, *FILES, "solution.zip", "README.md", "grades.csv")
    intake = read_class(tmp_path)
    assert intake.layout == "canvas"
    assert [line.split()[0] for line in intake.ignored] == ["README.md", "grades.csv", "solution.zip"]
    lay_out(tmp_path, "ann/", "bea/", "cal.zip")
    assert read_class(tmp_path).layout == "folders"
    with pytest.raises(InputError, match=r"there is no submission in"):
        read_class(lay_out(tmp_path / "other", "ann/"), layout="canvas")


@pytest.mark.parametrize("name", ["Team_A_1_2_x.zip", "a b_1_2_x.zip", "ann_1.zip", "ann_1_lab6.zip"])
def test_other_names_are_no_download(tmp_path: Path, name: str) -> None:
    """Capitals, spaces, or too few numbers are not Canvas' format."""
    assert read_class(lay_out(tmp_path, name)).layout == "folders"


def test_the_roster_knows_numbers_and_sortable_names(tmp_path: Path) -> None:
    """A user's number takes precedence; without one the sortable name counts, if only one student has it."""
    lay_out(
        tmp_path,
        "xx_1_9_a.zip",
        "vandenbergann_2_9_a.zip",
        "doejohnjr_3_9_a.zip",
        "leekim_4_9_a.zip",
        "ashal_5_9_a.zip",
    )
    students = [
        Student("a", "Jane Doe", canvas="1"),
        Student("b", "Ann van den Berg"),
        Student("c", "John Doe Jr."),
        Student("d", "Kim Lee"),
        Student("e", "Lee, Kim"),
        Student("f", "Al Ash", canvas="6"),
    ]
    intake = read_class(tmp_path, Roster(RosterEntry(student) for student in students))
    assert list(assigned(intake)) == ["a", "ashal_5", "b", "c", "leekim_4"]
    assert [submission.student.canvas for submission in intake.submissions()] == ["1", "5", "2", "3", "4"]
    assert intake.unmatched == ("ashal_5", "leekim_4")
    assert intake.notes == (
        "ashal_5 has the name of f, but another number: left unassigned",
        "leekim_4 is ambiguous: it matches several students on the roster: left unassigned",
        f"xx_1: {NO_GROUP}",
    )


WORDS = st.text(st.characters(categories=["L", "M", "Nd", "Pc", "Zs", "Po"]), min_size=1, max_size=12)
ORIGINAL = st.from_regex(r"[A-Za-z][A-Za-z0-9_ ]{0,9}\.(zip|png|urdf|tar\.gz)", fullmatch=True)


@examples(30)
@given(
    st.dictionaries(
        st.integers(1, 10**15),
        st.tuples(WORDS, st.booleans(), st.dictionaries(ORIGINAL, st.just(None), min_size=1, max_size=4)),
        min_size=1,
        max_size=6,
    )
)
def test_any_download_is_grouped_again(people: dict[int, tuple[str, bool, dict[str, None]]]) -> None:
    """Whatever students and files are called, Canvas' names for them give the same submissions."""
    attachment, names, expected = 1000, [], {}
    for user, (name, is_late, originals) in people.items():
        shown = re.sub(r"_\d+$", "", canvas_name(name))
        for original in originals:
            attachment += 1
            names.append(f"{shown}{'_LATE' if is_late else ''}_{user}_{attachment}_{original}")
        expected[str(user)] = (is_late, sorted(originals))
    with tempfile.TemporaryDirectory() as folder:
        intake = read_class(pack(Path(folder, "submissions.zip"), names), layout="canvas")
    assert {
        submission.student.canvas: (submission.is_late, sorted(submission.names)) for submission in intake.submissions()
    } == expected


ANONYMOUS = ("anon_aB3xY_9001_lab6.zip", "LATE_anon_Qr5tu_9002_lab6.zip")


def test_an_anonymous_download_matches_no_student(tmp_path: Path) -> None:
    """One message says why, and when the names come back; nobody on the roster has submitted nothing."""
    roster = Roster([RosterEntry(Student("1", "Anon Ab3xy")), RosterEntry(Student("2", "Ann Ash"))])
    for known in (roster, None):
        intake = read_class(lay_out(tmp_path, *ANONYMOUS), known)
        assert (intake.layout, list(assigned(intake))) == ("canvas", ["anon_Qr5tu", "anon_aB3xY"])
        assert [submission.is_late for submission in intake.submissions()] == [True, False]
        assert (intake.unmatched, intake.absent) == ((), ())
        assert [line.partition(":")[0] for line in intake.notes] == ["this is an anonymous download"]
    assert len(read_class(tmp_path, roster).contested) == 2


def test_a_name_that_ends_in_a_number(tmp_path: Path) -> None:
    """A name in Canvas may contain another user's number, unless the number of that upload is far below the others."""
    late = "blueash_7_LATE_102_200006_lab6-1.zip", "blueash_7_LATE_102_200004_lab6.zip"
    files = ("redash_7_101_200007_lab6.zip", *late, "ashann_103_200008_5_robot.urdf")
    students = [
        Student("a", "Ash, Red", canvas="101"), Student("b", "Ash, Blue", canvas="102"),
        Student("c", "Ash, Ann", canvas="103"), Student("d", canvas="7"),
    ]  # fmt: skip
    for count in (3, 4):
        intake = read_class(lay_out(tmp_path / "class", *files), Roster(map(RosterEntry, students[:count])))
        assert assigned(intake) == {"a": files[:1], "b": late[:1], "c": files[3:]}
    red, blue, ann = intake.submissions()
    assert (red.is_late, red.names, ann.names) == (False, ("lab6.zip",), ("5_robot.urdf",))
    assert (blue.is_late, blue.names, blue.attempt) == (True, ("lab6-1.zip",), 2)


@pytest.mark.parametrize("count", [1, 2])
def test_a_roster_settles_no_ambiguous_name(tmp_path: Path, count: int) -> None:
    """A roster with only one of the numbers decides nothing: it may lack the other student. No student counts as absent."""
    roster = Roster(map(RosterEntry, [Student("a", "Ash, Red", canvas="101"), Student("b", canvas="7")][:count]))
    intake = read_class(lay_out(tmp_path, "redash_7_101_5_lab6.zip"), roster, layout="canvas")
    assert assigned(intake) == {"redash_7_101": ("redash_7_101_5_lab6.zip",)}
    assert intake.notes == (
        "redash_7_101 may be of redash with the id 7 or of redash_7 with the id 101: left unassigned",
    )
    assert (len(intake.contested), intake.absent) == (count, ())


@pytest.mark.parametrize(
    ("names", "keys"),
    [
        (("bond_007_102_500_a.zip",), ["bond_007_102"]),  # no id begins with 0
        (("ashann_101_500_A.b_7_8_c.zip",), ["ashann_101"]),  # Canvas writes no point into a name
        (("ashann_101_500_a.zip", "mallory_101_102_501_a.zip"), ["ashann_101", "mallory_101_102"]),  # 101 is ashann
    ],
)
def test_impossible_readings(tmp_path: Path, names: tuple[str, ...], keys: list[str]) -> None:
    """A number that can be no user id in this place leaves one reading."""
    students = list(read_class(lay_out(tmp_path, *names), layout="canvas").submissions())
    assert [(one.student.key, len(one.student.readings)) for one in students] == [(key, 1) for key in keys]


def test_a_text_entry_can_be_ambiguous(tmp_path: Path) -> None:
    """The number before it is a user id, or that of an uploaded file with this name."""
    (found,) = read_class(lay_out(tmp_path, "ashann_101_102_text.html"), layout="canvas").submissions()
    assert (found.student.canvas, len(found.student.readings)) == ("", 2)


def test_a_student_who_is_called_like_an_anonymous_one(tmp_path: Path) -> None:
    """One such name does not make the download anonymous: the others are matched as ever."""
    lay_out(tmp_path, "anon_ab3xy_101_1_lab6.zip", "ashann_102_2_lab6.zip")
    intake = read_class(tmp_path, Roster([RosterEntry(Student("a", "Ash, Ann", canvas="102"))]))
    assert assigned(intake) == {"a": ("ashann_102_2_lab6.zip",), "anon_ab3xy": ("anon_ab3xy_101_1_lab6.zip",)}
    assert (intake.unmatched, intake.notes) == (("anon_ab3xy",), ())
