"""Moodle's bulk download: folders or files, files and texts, teams, and hidden names."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.students import Student
from tests.classroom.class_folders import assigned, lay_out, pack
from tests.classroom.lab6_class import read_class
from tests.examples import examples

FOLDER = "assignsubmission_file"


@pytest.mark.parametrize("ending", ["", "_"])
def test_a_download_is_detected(tmp_path: Path, ending: str) -> None:
    """Each participant's folder is a submission, unpacked or in a zip, from new and old versions."""
    names = [f"{name}_{FOLDER}{ending}" for name in ("Jane Doe_12", "O'Neil, Sam_13", "Jörg Müller_14", "עדה לוי_15")]
    files = [f"{name}/lab6.zip" for name in names]
    for target in (lay_out(tmp_path / "class", *files), pack(tmp_path / "class.zip", files)):
        intake = read_class(target)
        assert intake.layout == "moodle"
        assert sorted(submission.paths[0] for submission in intake.submissions()) == sorted(files)
        assert [submission.student.name for submission in intake.submissions()] == [
            "Jane Doe",
            "Jörg Müller",
            "O'Neil, Sam",
            "עדה לוי",
        ]
        assert next(intake.submissions()).student == Student("Jane Doe_12", "Jane Doe", moodle="12")


def test_one_participant_in_a_zip(tmp_path: Path) -> None:
    """A download of a single folder is not entered."""
    intake = read_class(pack(tmp_path / "class.zip", [f"Jane Doe_12_{FOLDER}/lab6.zip"]))
    assert assigned(intake) == {"Jane Doe_12": (f"Jane Doe_12_{FOLDER}/lab6.zip",)}


@pytest.mark.parametrize(
    ("files", "path"),
    [
        (("a.urdf",), "a.urdf"),
        (("lab6.TAR.GZ",), "lab6.TAR.GZ"),
        (("lab6.zip", ".DS_Store"), "lab6.zip"),
        (("notes.pdf",), ""),
        (("step.png",), ""),
        (("a.urdf", "step.png"), ""),
        (("src/a.urdf",), ""),
        (("a.urdf", "src/"), ""),
        ((), ""),
    ],
)
def test_a_single_file_is_the_submission(tmp_path: Path, files: tuple[str, ...], path: str) -> None:
    """A single archive or URDF is used without its folder, as in Canvas; anything else is a folder."""
    top = f"Jane Doe_12_{FOLDER}"
    expected = f"{top}/{path}" if path else top
    names = [f"{top}/", *(f"{top}/{name}" for name in files)]
    for target in (lay_out(tmp_path / "class", *names), pack(tmp_path / "class.zip", names)):
        (submission,) = read_class(target).submissions()
        assert (submission.paths, submission.names, submission.student.key) == ((expected,), (), "Jane Doe_12")


def test_a_single_symlink_is_not_the_submission(tmp_path: Path) -> None:
    """A symlink to another participant's file stays in its folder and is not followed."""
    lay_out(tmp_path, f"Jane Doe_12_{FOLDER}/a.urdf", f"Sam_13_{FOLDER}/")
    (tmp_path / f"Sam_13_{FOLDER}/b.urdf").symlink_to(tmp_path / f"Jane Doe_12_{FOLDER}/a.urdf")
    assert assigned(read_class(tmp_path)) == {
        "Jane Doe_12": (f"Jane Doe_12_{FOLDER}/a.urdf",),
        "Sam_13": (f"Sam_13_{FOLDER}",),
    }


def test_files_side_by_side(tmp_path: Path) -> None:
    """Without folders a participant has several files, under the names that they gave them."""
    lay_out(
        tmp_path, f"Jane Doe_12_{FOLDER}_lab_6.zip", f"Jane Doe_12_{FOLDER}_Task1_9_step.png", f"Sam_13_{FOLDER}_a.urdf"
    )
    jane, sam = read_class(tmp_path).submissions()
    assert jane.names == ("Task1_9_step.png", "lab_6.zip")
    assert jane.paths == tuple(f"Jane Doe_12_{FOLDER}_{name}" for name in jane.names)
    assert (sam.paths, sam.names) == ((f"Sam_13_{FOLDER}_a.urdf",), ("a.urdf",))


def test_a_text_beside_the_files(tmp_path: Path) -> None:
    """Files and a text of one participant are read as one folder, including the folders of the files."""
    top, text = f"Jane Doe_12_{FOLDER}", "Jane Doe_12_assignsubmission_onlinetext"
    files = (f"{top}/my_robot/urdf/my_robot.urdf", f"{top}/step.png", f"{text}/onlinetext.html")
    for target in (lay_out(tmp_path / "class", *files), pack(tmp_path / "class.zip", files)):
        (submission,) = read_class(target).submissions()
        assert submission.paths == files
        assert submission.names == ("my_robot/urdf/my_robot.urdf", "step.png", "onlinetext/onlinetext.html")
    (alone,) = read_class(lay_out(tmp_path / "other", f"{text}/onlinetext.html")).submissions()
    assert (alone.paths, alone.student.moodle) == ((text,), "12")


def test_an_empty_text_is_ignored(tmp_path: Path) -> None:
    """Beside an empty text a single file stays single, and a single picture stays a folder."""
    text = "assignsubmission_onlinetext"
    lay_out(tmp_path, f"Jane Doe_12_{FOLDER}/a.urdf", f"Jane Doe_12_{text}/")
    lay_out(tmp_path, f"Sam_13_{FOLDER}/step.png", f"Sam_13_{text}/", f"Zoe_14_{FOLDER}/", f"Zoe_14_{text}/a.html")
    assert assigned(read_class(tmp_path)) == {
        "Jane Doe_12": (f"Jane Doe_12_{FOLDER}/a.urdf",),
        "Sam_13": (f"Sam_13_{FOLDER}",),
        "Zoe_14": (f"Zoe_14_{text}",),
    }


def test_empty_folders_and_too_many_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """If file and text folders cannot be combined, the folder of files is the submission."""
    top, text = f"Jane Doe_12_{FOLDER}", "Jane Doe_12_assignsubmission_onlinetext"
    (empty,) = read_class(lay_out(tmp_path, f"{top}/", f"{text}/")).submissions()
    assert (empty.paths, empty.names) == ((top,), ())
    monkeypatch.setattr("grader.classroom.intake.layouts.moodle._MAX_FILES", 2)
    intake = read_class(lay_out(tmp_path, *(f"{top}/{name}" for name in "abc"), f"{text}/onlinetext.html"))
    assert assigned(intake) == {"Jane Doe_12": (top,)}
    assert intake.ignored == (f"{top} has more than 2 files: the files beside it were not read",)


@pytest.mark.parametrize("word", ["Participant", "Teilnehmerin", "参加者"])
def test_hidden_names(tmp_path: Path, word: str) -> None:
    """If every name is the same word, it is no student's name."""
    lay_out(tmp_path, f"{word}_12_{FOLDER}/", f"{word}_13_{FOLDER}/", "README.md")
    intake = read_class(tmp_path)
    assert [submission.student for submission in intake.submissions()] == [
        Student(f"{word}_{n}", moodle=n) for n in ("12", "13")
    ]
    assert intake.ignored == ("README.md is not named like a submission in Moodle",)


def test_teams(tmp_path: Path) -> None:
    """A team has its group's number, or none."""
    intake = read_class(lay_out(tmp_path, f"Team Red_7_{FOLDER}/", f"Default group_{FOLDER}/"))
    assert [submission.student for submission in intake.submissions()] == [
        Student("Default group", "Default group"),
        Student("Team Red_7", "Team Red", moodle="7"),
    ]


def test_the_roster_knows_numbers_and_names(tmp_path: Path) -> None:
    """A participant's number takes precedence, then the full name in either order, ignoring case and spaces."""
    lay_out(
        tmp_path,
        f"X_12_{FOLDER}/",
        f"jane  DOE_13_{FOLDER}/",
        f"Ann Ash_14_{FOLDER}/",
        f"max_15_{FOLDER}/",
        f"Sam ONeil_16_{FOLDER}/",
    )
    students = [
        Student("a", "Sam", moodle="12"),
        Student("b", "Doe, Jane"),
        Student("c", "Ann Ash", moodle="99"),
        Student("d", "Max Min", login="max"),
        Student("e", "O'Neil, Sam"),
    ]
    intake = read_class(tmp_path, Roster(RosterEntry(student) for student in students))
    assert list(assigned(intake)) == ["Ann Ash_14", "a", "b", "e", "max_15"]
    assert intake.notes == ("Ann Ash_14 has the name of c, but another number: left unassigned",)


NAMES = st.text(
    st.characters(categories=["L", "M", "Nd", "Zs", "Po", "Pc", "Sm"], exclude_characters="&<>\"`|':\\/"),
    min_size=1,
    max_size=15,
)


@examples(30)
@given(st.dictionaries(st.integers(0, 10**12), NAMES, min_size=2, max_size=6))
def test_any_download_is_grouped_again(people: dict[int, str]) -> None:
    """Whatever participants are called, each is identified by number and name."""
    names = {str(number): " ".join(name.split()).strip(".") or "x" for number, name in people.items()}
    with tempfile.TemporaryDirectory() as folder:
        target = pack(Path(folder, "class.zip"), [f"{name}_{number}_{FOLDER}/a.zip" for number, name in names.items()])
        found = {submission.student.moodle: submission.student.name for submission in read_class(target).submissions()}
    are_hidden = len(set(names.values())) == 1
    assert found == {number: "" if are_hidden else name for number, name in names.items()}
