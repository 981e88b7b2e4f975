"""Moodle's bulk download: folders or files, files and texts, teams, and hidden names."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.reading import read_class
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.students import Student
from tests.classroom.class_folders import lay_out, pack, taken

FOLDER = "assignsubmission_file"


@pytest.mark.parametrize("ending", ["", "_"])
def test_a_download_is_recognised(tmp_path: Path, ending: str) -> None:
    """Each participant's folder is a submission, unpacked or in a zip, in new and old versions."""
    names = [f"{name}_{FOLDER}{ending}" for name in ("Jane Doe_12", "O'Neil, Sam_13", "Jörg Müller_14", "עדה לוי_15")]
    files = [f"{name}/lab6.zip" for name in names]
    for place in (lay_out(tmp_path / "class", *files), pack(tmp_path / "class.zip", files)):
        intake = read_class(place)
        assert intake.layout == "moodle"
        assert sorted(each.paths[0] for each in intake.submissions()) == sorted(files)
        assert [each.student.name for each in intake.submissions()] == [
            "Jane Doe",
            "Jörg Müller",
            "O'Neil, Sam",
            "עדה לוי",
        ]
        assert next(intake.submissions()).student == Student("Jane Doe_12", "Jane Doe", moodle="12")


def test_one_participant_in_a_zip(tmp_path: Path) -> None:
    """A download of one folder is not gone into."""
    intake = read_class(pack(tmp_path / "class.zip", [f"Jane Doe_12_{FOLDER}/lab6.zip"]))
    assert taken(intake) == {"Jane Doe_12": (f"Jane Doe_12_{FOLDER}/lab6.zip",)}


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
def test_a_lone_file_is_the_hand_in(tmp_path: Path, files: tuple[str, ...], path: str) -> None:
    """An archive or URDF with nothing beside it is given without its folder, as Canvas gives it; anything else is a folder."""
    top = f"Jane Doe_12_{FOLDER}"
    wanted = f"{top}/{path}" if path else top
    names = [f"{top}/", *(f"{top}/{name}" for name in files)]
    for place in (lay_out(tmp_path / "class", *names), pack(tmp_path / "class.zip", names)):
        (hand_in,) = read_class(place).submissions()
        assert (hand_in.paths, hand_in.names, hand_in.student.key) == ((wanted,), (), "Jane Doe_12")


def test_a_lone_link_is_not_the_hand_in(tmp_path: Path) -> None:
    """One to another participant's file is left where it is, and is not followed there."""
    lay_out(tmp_path, f"Jane Doe_12_{FOLDER}/a.urdf", f"Sam_13_{FOLDER}/")
    (tmp_path / f"Sam_13_{FOLDER}/b.urdf").symlink_to(tmp_path / f"Jane Doe_12_{FOLDER}/a.urdf")
    assert taken(read_class(tmp_path)) == {
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
    """Files and a text of one participant are put side by side, with the folders that the files were in."""
    top, text = f"Jane Doe_12_{FOLDER}", "Jane Doe_12_assignsubmission_onlinetext"
    files = (f"{top}/my_robot/urdf/my_robot.urdf", f"{top}/step.png", f"{text}/onlinetext.html")
    for place in (lay_out(tmp_path / "class", *files), pack(tmp_path / "class.zip", files)):
        (hand_in,) = read_class(place).submissions()
        assert hand_in.paths == files
        assert hand_in.names == ("my_robot/urdf/my_robot.urdf", "step.png", "onlinetext/onlinetext.html")
    (alone,) = read_class(lay_out(tmp_path / "other", f"{text}/onlinetext.html")).submissions()
    assert (alone.paths, alone.student.moodle) == ((text,), "12")


def test_an_empty_text_is_no_part(tmp_path: Path) -> None:
    """A lone file stays one beside it, and a lone picture stays a folder."""
    text = "assignsubmission_onlinetext"
    lay_out(tmp_path, f"Jane Doe_12_{FOLDER}/a.urdf", f"Jane Doe_12_{text}/")
    lay_out(tmp_path, f"Sam_13_{FOLDER}/step.png", f"Sam_13_{text}/", f"Zoe_14_{FOLDER}/", f"Zoe_14_{text}/a.html")
    assert taken(read_class(tmp_path)) == {
        "Jane Doe_12": (f"Jane Doe_12_{FOLDER}/a.urdf",),
        "Sam_13": (f"Sam_13_{FOLDER}",),
        "Zoe_14": (f"Zoe_14_{text}",),
    }


def test_empty_folders_and_too_many_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What cannot be put side by side leaves the folder of files as the submission."""
    top, text = f"Jane Doe_12_{FOLDER}", "Jane Doe_12_assignsubmission_onlinetext"
    (empty,) = read_class(lay_out(tmp_path, f"{top}/", f"{text}/")).submissions()
    assert (empty.paths, empty.names) == ((top,), ())
    monkeypatch.setattr("grader.classroom.intake.layouts.moodle._MAX_FILES", 2)
    intake = read_class(lay_out(tmp_path, *(f"{top}/{name}" for name in "abc"), f"{text}/onlinetext.html"))
    assert taken(intake) == {"Jane Doe_12": (top,)}
    assert intake.ignored == (f"{top} has more than 2 files: the files beside it were not read",)


@pytest.mark.parametrize("word", ["Participant", "Teilnehmerin", "参加者"])
def test_hidden_names(tmp_path: Path, word: str) -> None:
    """Where every name is the same word, nobody is called so."""
    lay_out(tmp_path, f"{word}_12_{FOLDER}/", f"{word}_13_{FOLDER}/", "README.md")
    intake = read_class(tmp_path)
    assert [each.student for each in intake.submissions()] == [Student(f"{word}_{n}", moodle=n) for n in ("12", "13")]
    assert intake.ignored == ("README.md is not named like a submission in Moodle",)


def test_teams(tmp_path: Path) -> None:
    """A team has its group's number, or none."""
    intake = read_class(lay_out(tmp_path, f"Team Red_7_{FOLDER}/", f"Default group_{FOLDER}/"))
    assert [each.student for each in intake.submissions()] == [
        Student("Default group", "Default group"),
        Student("Team Red_7", "Team Red", moodle="7"),
    ]


def test_the_roster_knows_numbers_and_names(tmp_path: Path) -> None:
    """A participant's number decides, and else the full name in either order, whatever its case and spaces."""
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
    intake = read_class(tmp_path, Roster(RosterEntry(each) for each in students))
    assert list(taken(intake)) == ["Ann Ash_14", "a", "b", "e", "max_15"]
    assert intake.notes == ("Ann Ash_14 has the name of c, but another number: left unassigned",)


NAMES = st.text(
    st.characters(categories=["L", "M", "Nd", "Zs", "Po", "Pc", "Sm"], exclude_characters="&<>\"`|':\\/"),
    min_size=1,
    max_size=15,
)


@given(st.dictionaries(st.integers(0, 10**12), NAMES, min_size=2, max_size=6))
def test_any_download_is_grouped_again(people: dict[int, str]) -> None:
    """Whatever people are called, every participant is told by their number and name."""
    names = {str(number): " ".join(name.split()).strip(".") or "x" for number, name in people.items()}
    with tempfile.TemporaryDirectory() as folder:
        place = pack(Path(folder, "class.zip"), [f"{name}_{number}_{FOLDER}/a.zip" for number, name in names.items()])
        found = {each.student.moodle: each.student.name for each in read_class(place).submissions()}
    are_hidden = len(set(names.values())) == 1
    assert found == {number: "" if are_hidden else name for number, name in names.items()}
