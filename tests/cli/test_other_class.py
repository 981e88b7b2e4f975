"""`batch` refuses a class or a roster that belongs to another gradebook, instead of giving students the grades of namesakes."""

import json
import shutil
from pathlib import Path

import pytest

from tests.command_line import ROOT, Done, run

GOOD, BAD = (
    ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf",
    ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf",
)
NAMES = ("Jane Doe", "Al Ash", "Bo Birch")
ROSTERS = {
    "none": "",
    "moodle": "Identifier,Full name,Email address,Status,Grade\n"
    + "".join(f"Participant {555 + n},{name},{n}@a.org,Submitted,\n" for n, name in enumerate(NAMES)),
    "names": "name\n" + "\n".join(NAMES),
    "canvas": 'Student,ID,SIS User ID,SIS Login ID,Section\n"Doe, Jane",11,s1,jdoe,A\n"Ash, Al",12,s2,aash,A\n',
    "both": "id,name,moodle id,canvas id\n"
    + "".join(f"k{n},{name},{555 + n},{11 + n}\n" for n, name in enumerate(NAMES)),
}


@pytest.fixture(autouse=True)
def _classes(tmp_path: Path) -> None:
    """Make a class from Moodle, another one from Canvas with namesakes, and rosters."""
    for number, name in enumerate(NAMES):
        folder = tmp_path / f"moodle/{name}_{555 + number}_assignsubmission_file"
        folder.mkdir(parents=True)
        shutil.copy(GOOD, folder)
    (tmp_path / "canvas").mkdir()
    for number, name in enumerate(("doejane", "ashal", "birchbo")):
        shutil.copy(BAD, tmp_path / f"canvas/{name}_{11 + number}_90{number}_my_robot.urdf")
    for name, text in ROSTERS.items():
        (tmp_path / f"{name}.csv").write_text(text, encoding="utf-8")


def batch(top: Path, folder: str, roster: str, *options: str) -> Done:
    """Grade a class into the gradebook, with one of the rosters."""
    more = () if roster == "none" else ("--roster", top / f"{roster}.csv")
    return run(("batch", top / folder, "--gradebook", top / "g.db", *more, *options))


def scores(top: Path) -> dict[str, int | None]:
    """Return the points of every student in the gradebook."""
    data = json.loads(run(("export", "json", "--gradebook", top / "g.db")).stdout)
    return {student["id"]: student["score"] for student in data["students"]}


@pytest.mark.parametrize("second", ["none", "moodle", "names", "canvas"])
@pytest.mark.parametrize("first", ["none", "moodle", "names"])
def test_the_class_of_another_lms_is_refused(tmp_path: Path, first: str, second: str) -> None:
    """Both have numbers and share none: the gradebook stays as it was."""
    assert batch(tmp_path, "moodle", first).returncode == 0
    before = scores(tmp_path)
    done = batch(tmp_path, "canvas", second)
    assert done.returncode == 2
    assert (b"the Moodle ids of its students are not those" in done.stderr) or (b"is this the roster" in done.stderr)
    assert scores(tmp_path) == before


@pytest.mark.parametrize("first", ["none", "moodle", "names"])
def test_an_added_class_of_another_lms_moves_no_grade(tmp_path: Path, first: str) -> None:
    """With --add, students with the same names are others: a name is no match for a student with another number."""
    batch(tmp_path, "moodle", first)
    before = scores(tmp_path)
    assert batch(tmp_path, "canvas", "none", "--add").returncode == 0
    assert scores(tmp_path) == before | {"doejane_11": 62, "ashal_12": 62, "birchbo_13": 62}


def test_a_roster_with_both_numbers_joins_the_classes(tmp_path: Path) -> None:
    """The same students in two LMS are known by the roster's numbers."""
    batch(tmp_path, "moodle", "both")
    assert batch(tmp_path, "canvas", "both").returncode == 0
    assert scores(tmp_path) == {"k0": 62, "k1": 62, "k2": 62}


def test_numbers_of_two_lms_never_match_in_an_export(tmp_path: Path) -> None:
    """A Canvas gradebook gets no grade from students whom only Moodle has a number for, whatever their names and numbers."""
    batch(tmp_path, "moodle", "moodle")
    canvas = (
        'Student,ID,SIS User ID,SIS Login ID,Section,Lab (1)\n    Points Possible,,,,,100\n"Doe, Jane",555,s1,jdoe,A,\n'
    )
    (tmp_path / "into.csv").write_text(canvas)
    done = run(
        ("export", "canvas", "--gradebook", tmp_path / "g.db", "--into", tmp_path / "into.csv", "--pending-as-zero")
    )
    assert b"Doe, Jane" in done.stderr, done
    assert b'"Doe, Jane",555,s1,jdoe,A,70' not in done.stdout


@pytest.mark.parametrize(("matching", "code"), [(0, 2), (1, 2), (2, 0)])
def test_a_roster_that_matches_few_submissions_is_refused(tmp_path: Path, matching: int, code: int) -> None:
    """A roster must match one in ten submissions; --add accepts any roster."""
    for number in range(20):
        (tmp_path / f"class/s{number}").mkdir(parents=True)
        shutil.copy(GOOD, tmp_path / f"class/s{number}")
    (tmp_path / "few.csv").write_text("id\n" + "".join(f"{'s' if n < matching else 'x'}{n}\n" for n in range(20)))
    done = batch(tmp_path, "class", "few")
    assert done.returncode == code, done.stderr
    words = f"the roster matches {matching} of 20 submissions: is this the roster of this class?"
    assert (words in done.stderr.decode()) == (code == 2)
    assert (tmp_path / "g.db").exists() == (code == 0)
    assert batch(tmp_path, "class", "few", "--add").returncode == 0


def test_a_smaller_roster_is_mentioned(tmp_path: Path) -> None:
    """The message counts the students of both, and names those who are missing."""
    batch(tmp_path, "moodle", "names")
    assert b"the roster has" not in batch(tmp_path, "moodle", "names").stderr
    (tmp_path / "one.csv").write_text("name\nJane Doe\n")
    said = " ".join(batch(tmp_path, "moodle", "one").stderr.decode().split())
    assert (
        "the roster has 1 student, but the gradebook's roster has 3. Missing on the new one: Al Ash and Bo Birch"
        in said
    )
