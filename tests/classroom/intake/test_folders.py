"""The plain layout: one folder, archive or URDF each, attempts, copies, and names with a prefix."""

from hashlib import sha256
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.layouts.folders import class_prefix
from grader.classroom.intake.names import ENDINGS, ending_of, without_copy
from grader.classroom.intake.reading import read_class
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.students import ClassSubmission, Student
from grader.files.opening import ARCHIVES
from tests.classroom.class_folders import lay_out, taken


def only(top: Path) -> ClassSubmission:
    (hand_in,) = read_class(top).submissions()
    return hand_in


def test_children_are_submissions(tmp_path: Path) -> None:
    """Folders, archives, URDFs and xacro files are named after whose they are; what else there is is left out and named."""
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
    assert taken(intake) == {
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


def test_every_archive_that_can_be_opened_is_taken() -> None:
    """No ending that is opened elsewhere is missing here."""
    assert set(ARCHIVES) <= set(ENDINGS)
    assert [ending_of(f"lab.6{each.upper()}") for each in ENDINGS] == [each.upper() for each in ENDINGS]


def test_case_makes_two_students(tmp_path: Path) -> None:
    """Names that differ by case are two students."""
    lay_out(tmp_path, "ann/", "Ann.zip")
    assert taken(read_class(tmp_path)) == {"Ann": ("Ann.zip",), "ann": ("ann",)}


def test_a_folder_goes_before_its_archive(tmp_path: Path) -> None:
    """Of names that differ in their ending one counts, in the order that is documented, and each other is named."""
    lay_out(tmp_path, "ann/", "ann.zip", "bea.urdf", "bea.tar.gz", "bea.zip")
    intake = read_class(tmp_path)
    assert taken(intake) == {"ann": ("ann",), "bea": ("bea.zip",)}
    assert intake.ignored == (
        "ann.zip was ignored: ann has the same name, and counts",
        "bea.tar.gz was ignored: bea.zip has the same name, and counts",
        "bea.urdf was ignored: bea.zip has the same name, and counts",
    )


def test_a_browsers_copies_are_attempts(tmp_path: Path) -> None:
    """The copy with the highest number counts; the others are earlier attempts."""
    hand_in = only(lay_out(tmp_path, "ann.zip", "ann (1).zip", "ann (10).zip", "ann (2)/"))
    assert (hand_in.student.key, hand_in.paths, hand_in.attempt) == ("ann", ("ann (10).zip",), 4)
    assert hand_in.earlier == ("ann.zip", "ann (1).zip", "ann (2)")


def test_numbers_of_teams_are_no_copies(tmp_path: Path) -> None:
    """Without the plain name, or a roster that has it, a number in brackets is part of the name."""
    lay_out(tmp_path, "Team (1).zip", "Team (2).zip")
    assert list(taken(read_class(tmp_path))) == ["Team (1)", "Team (2)"]
    assert taken(read_class(tmp_path, Roster([RosterEntry(Student("team"))]))) == {"team": ("Team (2).zip",)}


@pytest.mark.parametrize(
    ("stem", "ending", "plain"),
    [
        ("ann (2)", ".zip", ("ann", 2)),
        ("ann(2)", "", ("ann", 2)),
        ("ann.tar (1)", ".gz", ("ann", 1)),
        ("(1)", "", ("(1)", 0)),
    ],
)
def test_what_a_copy_was_called(stem: str, ending: str, plain: tuple[str, int]) -> None:
    """A browser puts a number behind the name, with or without a space, in front of the last ending."""
    assert without_copy(stem, ending) == plain


def test_a_folder_of_attempts(tmp_path: Path) -> None:
    """A folder with nothing but attempts submits the last; one with anything else in it is a submission."""
    lay_out(tmp_path, "ann/attempt 1/a.urdf", "ann/Attempt-10.zip", "ann/attempt_2/", "ann/.hidden")
    lay_out(tmp_path, "bea/attempt 1/", "bea/notes.txt", "cal/try3/", "dee/submission 2.txt")
    ann, bea, cal, dee = read_class(tmp_path).submissions()
    assert (ann.paths, ann.attempt) == (("ann/Attempt-10.zip",), 10)
    assert ann.earlier == ("ann/attempt 1", "ann/attempt_2")
    assert (bea.paths, cal.paths, dee.paths) == (("bea",), ("cal/try3",), ("dee",))


@pytest.mark.parametrize(
    "names", [("lab6-ann/", "lab6-bo-b/"), ("LAB6-ann/", "lab6-bo-b/"), ("lab-12-ann/", "lab-12-bo-b/")]
)
def test_class_repositories(tmp_path: Path, names: tuple[str, ...]) -> None:
    """The lab in front of every name is taken away, and what is left is the login."""
    intake = read_class(lay_out(tmp_path, *names, "notes.txt"))
    assert [each.student for each in intake.submissions()] == [
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
def test_a_prefix_is_taken_away_where_it_is(tmp_path: Path, names: tuple[str, ...], keys: list[str]) -> None:
    """The rubric's wherever it is, that of another lab where most have it: one more folder does not change the others."""
    assert sorted(taken(read_class(lay_out(tmp_path, *names)))) == keys


def test_with_and_without_the_prefix_none_is_assigned(tmp_path: Path) -> None:
    """Nobody can tell which of the two is the student's."""
    intake = read_class(lay_out(tmp_path, "lab6-ann/", "ann/", "lab6-bea/"))
    assert sorted(taken(intake)) == ["./ann", "./lab6-ann", "bea"]
    assert [each.key for each in intake.contested] == ["ann"]


def test_a_roster_tells_the_prefix() -> None:
    """With a roster the prefix is the one that leaves the most students of it, and at least two: one folder changes nothing."""
    known = {"ann", "bea", "robots-2026-cal"}.__contains__
    assert class_prefix(["robots-2026-ann", "robots-2026-bea"], "lab6", known) == "robots-2026-"
    assert class_prefix(["robots-2026-ann", "robots-2026-bea", "zoe-ann"], "lab6", known) == "robots-2026-"
    assert class_prefix(["robots-2026-ann", "robots-2026-zoe"], "lab6", known) == ""
    assert class_prefix(["zoe-ann"], "lab6", known) == ""
    assert class_prefix(["robots-2026-cal"], "lab6", known) == ""
    assert class_prefix(["robots-2026-ann"], "lab6", None) == ""


AWKWARD = ["=cmd()", 'quo"te', "com,ma", "Müller, Jörg", "עדה", "@x", "a\nb", "<b>", "ann ~2", "%00"]


def test_awkward_names(tmp_path: Path) -> None:
    """Names of all kinds are keys as they are; what cannot be printed has its path and a digest for a key."""
    lay_out(tmp_path, *(f"{name}/" for name in AWKWARD))
    printable = {name for name in AWKWARD if name.isprintable()}
    (odd,) = set(taken(read_class(tmp_path))) - printable
    assert odd == f"./a\\x0ab-{sha256(b'a' + bytes([10]) + b'b').hexdigest()}"
    assert printable < set(taken(read_class(tmp_path)))


@given(st.text(), st.sampled_from(ENDINGS))
def test_an_ending_is_found_behind_any_name(stem: str, ending: str) -> None:
    """Behind a name that ends in nothing like it, an ending is found whole."""
    if ending_of(f"{stem}{ending}") != ending:
        assert stem.lower().endswith((".tar", ".urdf"))
