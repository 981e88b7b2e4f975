"""Reading a class in any layout: refused input, ignored files, a zip, a roster, and a very large class."""

import os
import re
import sys
import tempfile
import tracemalloc
import zipfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.detection import LAYOUTS
from grader.classroom.intake.layouts.layout import MAX_LINES
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.students import Student
from grader.errors import InputError
from tests.classroom.class_folders import assigned, lay_out, pack
from tests.classroom.lab6_class import read_class
from tests.work import limited_work

LARGE = 10_000
ANN = Student("100", "Ann Ash", "ann@example.org", "aash")
BEA = Student("200", "Bea Birch", "bea@example.org", "bbirch")
CAL = Student("300", "Cal Cedar", "cal@example.org", "ccedar", canvas="33")


def roster(*students: Student) -> Roster:
    return Roster(RosterEntry(student) for student in students or (ANN, BEA, CAL))


def test_other_paths_are_refused(tmp_path: Path) -> None:
    """A missing path, a file that is no zip, a broken zip and an unknown layout are errors of one line."""
    (tmp_path / "class.txt").write_text("no zip")
    (tmp_path / "class.zip").write_bytes(b"PK\x03\x04 and no more")
    for name, message in (
        ("none", "does not exist"),
        ("class.txt", "neither a folder nor a zip"),
        ("class.zip", "as a zip"),
    ):
        with pytest.raises(InputError, match=message):
            read_class(tmp_path / name)
    with pytest.raises(InputError, match="there is no layout 'moodel'; the layouts are: auto, folders"):
        read_class(tmp_path, layout="moodel")
    with pytest.raises(InputError):
        read_class(Path("nul\0byte"))


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_layout_option_finds_submissions_or_fails(tmp_path: Path, layout: str) -> None:
    """A layout that does not fit raises an InputError, or finds what it can; nothing else happens."""
    lay_out(tmp_path, "ann/my_robot.urdf", "bea.zip", "notes.txt")
    try:
        assert read_class(tmp_path, layout=layout).layout == layout
    except InputError as error:
        assert "\n" not in str(error)


def test_no_symlink_is_a_submission(tmp_path: Path) -> None:
    """A symlink in the class folder is ignored and listed, wherever it leads."""
    lay_out(tmp_path / "class", "ann/my_robot.urdf")
    lay_out(tmp_path / "outside", "secret.urdf")
    os.symlink(tmp_path / "outside", tmp_path / "class" / "bea")
    os.symlink("ann", tmp_path / "class" / "cal")
    os.symlink("loop", tmp_path / "class" / "loop")
    intake = read_class(tmp_path / "class")
    assert assigned(intake) == {"ann": ("ann",)}
    assert intake.ignored == tuple(f"{name} is a symlink, and was not followed" for name in ("bea", "cal", "loop"))


def test_the_list_of_ignored_files_is_bounded(tmp_path: Path) -> None:
    """Of very many files that are no submissions the first are listed, the others counted."""
    lay_out(tmp_path, "ann/", *(f"note{index:05}.txt" for index in range(30 * MAX_LINES)))
    lines = read_class(tmp_path).ignored
    assert len(lines) == MAX_LINES + 1
    assert lines[0].startswith("note00000.txt ")
    assert lines[-2].startswith(f"note{MAX_LINES - 1:05}.txt ")
    assert lines[-1] == f"and {29 * MAX_LINES} more"


def test_a_zip_is_listed_in_place(tmp_path: Path) -> None:
    """A zip gives the same as its folder: names that lead out and litter are ignored."""
    names = ["ann/my_robot/urdf/my_robot.urdf", "bea.zip", "__MACOSX/bea.zip", "../cal.zip", "/dan.zip", "notes.txt"]
    intake = read_class(pack(tmp_path / "class.zip", names))
    assert assigned(intake) == {"ann": ("ann",), "bea": ("bea.zip",)}
    assert [line.split()[0] for line in intake.ignored] == ["../cal.zip", "/dan.zip", "notes.txt"]


def test_a_single_enclosing_folder_is_entered(tmp_path: Path) -> None:
    """A single folder that holds the class is entered, and stays in the paths; a single submission is not."""
    assert assigned(read_class(pack(tmp_path / "a.zip", ["lab6/ann.zip", "lab6/bea/a.urdf"]))) == {
        "ann": ("lab6/ann.zip",),
        "bea": ("lab6/bea",),
    }
    alone = ["ann/src/my_robot/package.xml", "ann/answers.txt"]
    assert assigned(read_class(pack(tmp_path / "b.zip", alone))) == {"ann": ("ann",)}
    assert assigned(read_class(pack(tmp_path / "c.zip", ["ann/my_robot.urdf"]))) == {"ann": ("ann",)}
    assert assigned(read_class(pack(tmp_path / "d.zip", ["aash/x/a.urdf", "aash/y/"]), roster())) == {"100": ("aash",)}


def test_a_zip_of_too_many_members_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The number of members is bounded."""
    monkeypatch.setattr("grader.classroom.intake.listing.MAX_MEMBERS", 3)
    assert len(read_class(pack(tmp_path / "a.zip", ["a.zip", "b.zip", "c.zip"]))) == 3
    with pytest.raises(InputError, match="contains more than 3 files"):
        read_class(pack(tmp_path / "b.zip", ["a.zip", "b.zip", "c.zip", "d.zip"]))


def test_symlinks_in_a_zip_are_not_followed(tmp_path: Path) -> None:
    """A symlink in a zip is no submission."""
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        link = zipfile.ZipInfo("ann.zip")
        link.create_system, link.external_attr = 3, 0o120777 << 16
        archive.writestr(link, "/etc/passwd")
        archive.writestr("bea.zip", b"")
    intake = read_class(tmp_path / "class.zip")
    assert assigned(intake) == {"bea": ("bea.zip",)}
    assert intake.ignored == ("ann.zip is a symlink in an archive, and was not followed",)


def test_the_roster_names_the_students(tmp_path: Path) -> None:
    """Submissions get the roster's students and order; others are unmatched, and students without one are absent."""
    lay_out(tmp_path, "ccedar.zip", "Bea Birch/", "zoe.zip")
    intake = read_class(tmp_path, roster())
    assert assigned(intake) == {"200": ("Bea Birch",), "300": ("ccedar.zip",), "zoe": ("zoe.zip",)}
    assert intake.unmatched == ("zoe",)
    assert intake.absent == (ANN,)
    assert next(intake.submissions()).student == BEA
    assert list(intake.submissions()) == list(intake.submissions())


def test_of_two_submissions_of_a_student_the_certain_one_counts(tmp_path: Path) -> None:
    """One with the student's login is theirs; one that only has the name is unmatched, with a note."""
    intake = read_class(lay_out(tmp_path, "Ann Ash/", "aash.zip"), roster())
    assert assigned(intake) == {"100": ("aash.zip",), "Ann Ash": ("Ann Ash",)}
    assert intake.unmatched == ("Ann Ash",)
    assert intake.notes == ("Ann Ash may belong to 100 as well, but aash counts: left unassigned",)


@pytest.mark.parametrize(
    "names", [("aash.zip", "ann@example.org.zip"), ("Ann Ash/", "Ash, Ann/"), ("AASH/", "Ann Ash/")]
)
def test_equal_claims_are_contested(tmp_path: Path, names: tuple[str, str]) -> None:
    """Of two claims that are equally certain, or both uncertain, none is assigned; the student is contested, not absent."""
    intake = read_class(lay_out(tmp_path, *names), roster())
    assert "100" not in assigned(intake)
    assert (intake.contested, intake.absent) == ((ANN,), (BEA, CAL))
    assert "may each belong to 100: left unassigned; 100 keeps an earlier submission" in intake.notes[0]


def test_an_unmatched_submission_never_takes_a_key_of_the_roster(tmp_path: Path) -> None:
    """A submission that may belong to two students is unmatched and does not get the key of either."""
    lay_out(tmp_path, "sam.zip")
    intake = read_class(tmp_path, roster(Student("sam"), Student("7", login="sam")))
    assert assigned(intake) == {"./sam.zip": ("sam.zip",)}
    assert intake.notes == ("sam is ambiguous: it matches several students on the roster: left unassigned",)
    assert (len(intake.contested), intake.absent) == (2, ())


def test_a_case_variant_does_not_take_over_a_key(tmp_path: Path) -> None:
    """Beside the exact key another case is unmatched, and its key cannot be confused with the student's."""
    intake = read_class(lay_out(tmp_path, "sam.zip", "SAM/"), roster(Student("sam"), Student("Sam2")))
    assert assigned(intake) == {"./SAM": ("SAM",), "sam": ("sam.zip",)}
    assert intake.notes == ("SAM may belong to sam as well, but sam counts: left unassigned",)


def test_the_roster_determines_lateness(tmp_path: Path) -> None:
    """A time or lateness in the roster takes precedence over the LMS."""
    lay_out(tmp_path, "cedarcal_LATE_33_1_lab6.zip", "ashann_LATE_11_2_lab6.zip")
    entries = [RosterEntry(CAL, is_late=False, submitted="2026-09-01T10:00:00Z"), RosterEntry(ANN)]
    ann, cal = read_class(tmp_path, Roster(entries)).submissions()
    assert (ann.is_late, ann.submitted, ann.student.canvas) == (True, "", "11")
    assert (cal.is_late, cal.submitted, cal.student) == (False, "2026-09-01T10:00:00Z", CAL)


def test_names_that_are_not_utf_8_can_be_opened(tmp_path: Path) -> None:
    """A name of any bytes gets its own printable key, and its path leads to the file."""
    for name in (b"caf\xe9", b"caf\xe8", b"line\nbreak", b"line\\x0abreak"):
        os.mkdir(os.fsencode(tmp_path) + b"/" + name)
    found = assigned(read_class(tmp_path))
    assert len(found) == 4
    assert all(key.isprintable() for key in found)
    assert all((tmp_path / path).is_dir() for (path,) in found.values())


@given(st.lists(st.text(st.characters(codec="utf-8"), min_size=1, max_size=20), max_size=20))
def test_any_names_are_accepted(names: list[str]) -> None:
    """Whatever the members of a zip are called, keys are printable and unique, and every path is in the zip."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder, "class.zip")
        with zipfile.ZipFile(target, "w") as archive:
            members = {zipfile.ZipInfo(name).filename or "x" for name in ("ann.zip", "bea.zip", *names)}  # cut at a NUL
            for name in sorted(members - {"package.xml"}):
                archive.writestr(zipfile.ZipInfo(name), b"")
        submissions = list(read_class(target).submissions())
    keys = [submission.student.key for submission in submissions]
    assert keys == sorted(set(keys))
    assert all(key.isprintable() for key in keys)


def test_a_very_large_class_takes_linear_work(tmp_path: Path) -> None:
    """Each submission takes few lines of Python and little more memory than its name."""
    folder = large_class(tmp_path / "class", LARGE)
    with limited_work(500 * LARGE):
        intake = read_class(folder)
        assert sum(1 for _ in intake.submissions()) == LARGE
    folder = large_class(tmp_path / "smaller", LARGE // 10)
    tracemalloc.start()
    try:
        intake = read_class(folder)
        assert sum(1 for _ in intake.submissions()) == LARGE // 10
        assert tracemalloc.get_traced_memory()[1] < 3 * LARGE // 10 * sys.getsizeof("student000000.urdf")
    finally:
        tracemalloc.stop()


def large_class(folder: Path, count: int) -> Path:
    """Make a class of as many URDFs, which are links to a few, because files are slow to make."""
    folder.mkdir()
    for index in range(count):
        name = f"{folder}/student{index:06}.urdf"
        if index % 50_000:  # file systems limit the number of links to one file
            os.link(f"{folder}/student{index // 50_000 * 50_000:06}.urdf", name)
        else:
            Path(name).touch()
    return folder


CANVAS = ("ashann_101_1_lab6.zip", "birchbea_LATE_102_2_lab6.zip")
MOODLE = ("Ann Ash_11_assignsubmission_file/lab6.zip", "Bea Birch_12_assignsubmission_file/lab6.zip")
NBGRADER = ("submitted/ash/lab6/a.urdf", "submitted/birch/lab6/a.urdf", "release/lab6/a.ipynb")


@pytest.mark.parametrize("wrapper", ["submissions", "rob101-lab-6_submissions", "course/submissions"])
@pytest.mark.parametrize(
    ("layout", "files"), [("canvas", CANVAS), ("canvas", CANVAS[:1]), ("moodle", MOODLE), ("nbgrader", NBGRADER)]
)
@pytest.mark.parametrize("option", ["auto", ""])
def test_a_download_in_a_wrapper_folder(
    tmp_path: Path, wrapper: str, layout: str, files: tuple[str, ...], option: str
) -> None:
    """The download within other folders that hold nothing else is found, also in a zip, and if its layout is named."""
    names = [f"{wrapper}/{file}" for file in files] + ["roster.csv"]
    for path in (lay_out(tmp_path / "class", *names), pack(tmp_path / "class.zip", names)):
        intake = read_class(path, layout=option or layout)
        plain = read_class(lay_out(tmp_path / layout, *files))
        assert intake.layout == plain.layout == layout
        assert assigned(intake) == {
            key: tuple(f"{wrapper}/{place}" for place in paths) for key, paths in assigned(plain).items()
        }
        assert intake.ignored[-1] == "roster.csv is beside the folder of the download"


@pytest.mark.parametrize(
    "files",
    [
        ("ash/src/my_robot/package.xml",),
        ("ash/ashann_101_1_lab6.zip",),  # a student's own folder
        ("ash/submitted/old/work/a.urdf",),
        ("ash/lab6.zip", "ash/lab5.zip"),
        ("ash/ashann_101_1_lab6.zip", "ash/birchbea_102_2_answers.pdf", "birch.zip"),
    ],
)
def test_a_students_folder_is_no_wrapper(tmp_path: Path, files: tuple[str, ...]) -> None:
    """A course folder with the folder of one student, or with several entries, is the class."""
    assert "ash" in assigned(read_class(lay_out(tmp_path, *files)))


def test_a_download_beside_the_courses_own_folder_is_no_submission(tmp_path: Path) -> None:
    """It is refused with the command that grades it, unpacked or not, unless it has the name of a student."""
    lay_out(tmp_path, *(f"submissions/{name}" for name in CANVAS), "solution/robot.urdf")
    command = f"`grader batch {tmp_path}/"
    with pytest.raises(InputError, match=re.escape(f"(2 students): grade it with {command}")):
        read_class(tmp_path)
    assert set(assigned(read_class(tmp_path, Roster([RosterEntry(Student("submissions"))])))) == {"submissions"}
    assert len(read_class(tmp_path, layout="folders")) == 2
    sections = tmp_path / "sections"
    sections.mkdir()
    pack(sections / "a.zip", CANVAS)
    pack(sections / "b.zip", MOODLE)
    with pytest.raises(InputError, match=r"/sections/a\.zip is a download of a whole class"):
        read_class(sections)


def test_one_submission_with_files_named_as_in_canvas_stops_no_class(tmp_path: Path) -> None:
    """It is graded among the others, with a note that names it, whether the others are on a roster or not."""
    lay_out(tmp_path, *(f"birch/{name}" for name in CANVAS), "ash/robot.urdf")
    note = (
        "birch is graded as the submission of one student; if it is a download of a whole class (2 students), grade it with"
        f" `grader batch {tmp_path}/birch`"
    )
    for students in (None, Roster([RosterEntry(Student("ash"))])):
        intake = read_class(tmp_path, students)
        assert set(assigned(intake)) == {"ash", "birch"}
        assert intake.notes == (note,)


def test_a_folder_of_a_student_on_the_roster_is_no_wrapper(tmp_path: Path) -> None:
    """Not even if it is named like a download and looks like one."""
    roster = Roster([RosterEntry(Student("submissions"))])
    intake = read_class(lay_out(tmp_path, *(f"submissions/{name}" for name in CANVAS)), roster)
    assert assigned(intake) == {"submissions": ("submissions",)}
