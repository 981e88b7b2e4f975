"""The plain layout: a folder, archive or URDF for each student, attempts, copies, and names with a prefix."""

from hashlib import sha256
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.layouts.folders import class_prefix
from grader.classroom.intake.names import ENDINGS, ending_of, without_copy
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.students import ClassSubmission, Student
from grader.files.names import ARCHIVES
from tests.classroom.class_folders import assigned, lay_out
from tests.classroom.lab6_class import read_class


def only(top: Path) -> ClassSubmission:
    (submission,) = read_class(top).submissions()
    return submission


def test_children_are_submissions(tmp_path: Path) -> None:
    """Folders, archives, URDFs and xacro files are named after their students; other files are listed as ignored."""
    lay_out(
        tmp_path,
        "ann/",
        "bea.urdf",
        "cal.TAR.GZ",
        "dee.v2/",
        "eli.urdf.xacro",
        "finn.zip",
        "README.md",
        "build/",
        ".git/",
    )
    intake = read_class(tmp_path)
    assert intake.layout == "folders"
    assert assigned(intake) == {
        "ann": ("ann",),
        "bea": ("bea.urdf",),
        "cal": ("cal.TAR.GZ",),
        "dee.v2": ("dee.v2",),
        "eli": ("eli.urdf.xacro",),
        "finn": ("finn.zip",),
    }
    assert intake.ignored == (
        "README.md is not a folder, an archive or a URDF",
        "build is a build folder",
    )


def test_every_supported_archive_is_a_submission() -> None:
    """Every ending of an archive that can be opened elsewhere is accepted here."""
    assert set(ARCHIVES) <= set(ENDINGS)
    assert [ending_of(f"lab.6{ending.upper()}") for ending in ENDINGS] == [ending.upper() for ending in ENDINGS]


def test_case_makes_two_students(tmp_path: Path) -> None:
    """Names that differ by case are two students."""
    lay_out(tmp_path, "ann/", "Ann.zip")
    assert assigned(read_class(tmp_path)) == {"Ann": ("Ann.zip",), "ann": ("ann",)}


def test_a_folder_precedes_its_archive(tmp_path: Path) -> None:
    """Of names that differ in their ending one counts, in the documented order, and the others are listed."""
    lay_out(tmp_path, "ann/", "ann.zip", "bea.urdf", "bea.tar.gz", "bea.zip")
    intake = read_class(tmp_path)
    assert assigned(intake) == {"ann": ("ann",), "bea": ("bea.zip",)}
    assert intake.ignored == (
        "ann.zip was ignored: ann has the same name, and counts",
        "bea.tar.gz was ignored: bea.zip has the same name, and counts",
        "bea.urdf was ignored: bea.zip has the same name, and counts",
    )


def test_a_browsers_copies_are_attempts(tmp_path: Path) -> None:
    """The copy with the highest number counts; the others are earlier attempts."""
    submission = only(lay_out(tmp_path, "ann.zip", "ann (1).zip", "ann (10).zip", "ann (2)/"))
    assert (submission.student.key, submission.paths, submission.attempt) == ("ann", ("ann (10).zip",), 4)
    assert submission.earlier == ("ann.zip", "ann (1).zip", "ann (2)")


def test_numbers_of_teams_are_no_attempts(tmp_path: Path) -> None:
    """Without the plain name, or a roster that has it, a number in brackets is part of the name."""
    lay_out(tmp_path, "Team (1).zip", "Team (2).zip")
    assert list(assigned(read_class(tmp_path))) == ["Team (1)", "Team (2)"]
    assert assigned(read_class(tmp_path, Roster([RosterEntry(Student("team"))]))) == {"team": ("Team (2).zip",)}


@pytest.mark.parametrize(
    ("stem", "ending", "plain"),
    [
        ("ann (2)", ".zip", ("ann", 2)),
        ("ann(2)", "", ("ann", 2)),
        ("ann.tar (1)", ".gz", ("ann", 1)),
        ("(1)", "", ("(1)", 0)),
    ],
)
def test_the_original_name_of_a_copy(stem: str, ending: str, plain: tuple[str, int]) -> None:
    """A browser puts a number after the name, with or without a space, before the last ending."""
    assert without_copy(stem, ending) == plain


def test_a_folder_of_attempts(tmp_path: Path) -> None:
    """A folder with only attempts submits the last; one with anything else in it is a submission."""
    lay_out(tmp_path, "ann/attempt 1/a.urdf", "ann/Attempt-10.zip", "ann/attempt_2/", "ann/.hidden")
    lay_out(tmp_path, "bea/attempt 1/", "bea/notes.txt", "cal/try3/", "dee/submission 2.txt")
    ann, bea, cal, dee = read_class(tmp_path).submissions()
    assert (ann.paths, ann.attempt) == (("ann/Attempt-10.zip",), 10)
    assert ann.earlier == ("ann/attempt 1", "ann/attempt_2")
    assert (bea.paths, cal.paths, dee.paths) == (("bea",), ("cal/try3",), ("dee",))


@pytest.mark.parametrize(
    "names", [("lab6-ann/", "lab6-bo-b/"), ("LAB6-ann/", "lab6-bo-b/"), ("lab-12-ann/", "lab-12-bo-b/")]
)
def test_classroom_repositories(tmp_path: Path, names: tuple[str, ...]) -> None:
    """The assignment's prefix is removed from every name, which leaves the login."""
    intake = read_class(lay_out(tmp_path, *names, "notes.txt"))
    assert [submission.student for submission in intake.submissions()] == [
        Student("ann", login="ann"),
        Student("bo-b", login="bo-b"),
    ]


@pytest.mark.parametrize(
    ("names", "keys"),
    [
        (("lab6-ann/", "bea/"), ["ann", "bea"]),
        (("lab6-ann/", "lab7-bea/"), ["ann", "lab7-bea"]),
        (("lab6-/", "lab6-ann/"), ["ann", "lab6-"]),
        (("lab9-ann/", "lab9-bea/", "cal/"), ["ann", "bea", "cal"]),
        (("lab9-ann/", "cal/"), ["cal", "lab9-ann"]),
    ],
)
def test_a_prefix_is_removed(tmp_path: Path, names: tuple[str, ...], keys: list[str]) -> None:
    """The rubric's prefix is always removed, another only if most names have it: one more folder changes no other."""
    assert sorted(assigned(read_class(lay_out(tmp_path, *names)))) == keys


def test_names_with_and_without_the_prefix_are_ambiguous(tmp_path: Path) -> None:
    """It is unknown which of the two is the student's."""
    intake = read_class(lay_out(tmp_path, "lab6-ann/", "ann/", "lab6-bea/"))
    assert sorted(assigned(intake)) == ["./ann", "./lab6-ann", "bea"]
    assert [contest.key for contest in intake.contested] == ["ann"]


def test_a_roster_determines_the_prefix() -> None:
    """The prefix is the one that matches most students of the roster, at least two: one folder changes nothing."""
    known = {"ann", "bea", "robots-2026-cal"}.__contains__
    assert class_prefix(["robots-2026-ann", "robots-2026-bea"], "lab6", known) == "robots-2026-"
    assert class_prefix(["robots-2026-ann", "robots-2026-bea", "zoe-ann"], "lab6", known) == "robots-2026-"
    assert class_prefix(["robots-2026-ann", "robots-2026-zoe"], "lab6", known) == ""
    assert class_prefix(["zoe-ann"], "lab6", known) == ""
    assert class_prefix(["robots-2026-cal"], "lab6", known) == ""
    assert class_prefix(["robots-2026-ann"], "lab6", None) == ""


AWKWARD = ["=cmd()", 'quo"te', "com,ma", "Müller, Jörg", "עדה", "@x", "a\nb", "<b>", "ann ~2", "%00"]


def test_awkward_names(tmp_path: Path) -> None:
    """Names of all kinds are keys unchanged; for unprintable ones the key is the path and a digest."""
    lay_out(tmp_path, *(f"{name}/" for name in AWKWARD))
    printable = {name for name in AWKWARD if name.isprintable()}
    (odd,) = set(assigned(read_class(tmp_path))) - printable
    assert odd == f"./a\\x0ab-{sha256(b'a' + bytes([10]) + b'b').hexdigest()}"
    assert printable < set(assigned(read_class(tmp_path)))


@given(st.text(), st.sampled_from(ENDINGS))
def test_an_ending_is_found_after_any_name(stem: str, ending: str) -> None:
    """After a name without a similar ending, an ending is found whole."""
    if ending_of(f"{stem}{ending}") != ending:
        assert stem.lower().endswith((".tar", ".urdf"))
