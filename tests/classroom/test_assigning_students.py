"""Assigning submissions to students through the command line: nothing that a student writes changes it."""

import json
import shutil
from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest

from tests.classroom.class_runs import Done, grader, without_hints
from tests.samples import ROOT

GOOD, BAD = ROOT / "submissions/lab6/reference", ROOT / "submissions/lab6/lidar-buried/my_robot/urdf"
TEAMS = "id,login,name,group\n1,alice,Alice Ash,team2\n2,mallory,Mallory Moss,team1\n"


def submit(folder: Path, source: Path = GOOD) -> None:
    """Write a submission."""
    shutil.copytree(source, folder)


def batch(top: Path, *more: str | Path, roster: str = "", into: str = "g.db") -> Done:
    """Grade the class below a folder."""
    if roster:
        (top / "roster.csv").write_text(roster, encoding="utf-8")
        more = (*more, "--roster", top / "roster.csv")
    rubric = () if "--rubric" in more else ("--rubric", without_hints())
    return grader("batch", top / "class", "--gradebook", top / into, *rubric, *more)


def students(top: Path, into: str = "g.db") -> dict[str, dict[str, Any]]:
    """Return everyone's current grade, by key."""
    done = grader("export", "json", "--gradebook", top / into)
    assert done.returncode == 0, done.stderr
    return {student["id"]: student for student in json.loads(done.stdout)["students"]}


def mark(top: Path, who: str) -> None:
    """Give a student a manual mark."""
    assert grader("mark", who, "answer-floating-link", "3.5", "--gradebook", top / "g.db").returncode == 0


@pytest.mark.parametrize("name", ["alice", "ALICE", "Alice Ash"])
def test_a_team_cannot_submit_for_a_member_of_another(tmp_path: Path, name: str) -> None:
    """A folder in team1 counts for nobody in team2, before and after alice has submitted; her marks stay hers."""
    submit(tmp_path / "class/team1/Lab6/mallory", BAD)
    submit(tmp_path / f"class/team1/Lab6/{name}")
    done = batch(tmp_path, "--layout", "teams", roster=TEAMS)
    assert f"team1/{name} is named like 1, whose group is 'team2': left unassigned" in done.stderr
    assert students(tmp_path)["1"]["status"] == "missing"
    submit(tmp_path / "class/team2/Lab6/alice", BAD)
    batch(tmp_path, "--layout", "teams", roster=TEAMS)
    mark(tmp_path, "1")
    before = students(tmp_path)
    assert (before["1"]["score"], before["1"]["manual_marks"]) == (65.5, 1)
    shutil.rmtree(tmp_path / "class/team2")
    batch(tmp_path, "--layout", "teams", roster=TEAMS)
    after = students(tmp_path)
    assert (after["1"]["score"], after["1"]["manual_marks"]) == (65.5, 1)
    assert not after["1"]["is_final"]
    assert after[f"team1/{name}"] == before[f"team1/{name}"]


@pytest.mark.parametrize(
    ("name", "roster"),
    [(name, "") for name in ("ALICE", "alice~2", "\u0430lice")]
    + [(name, "id,name\nalice,Alice Ash\n") for name in ("Alice", "Alice Ash", "alice ash")],
)
def test_a_similar_name_takes_over_nothing(tmp_path: Path, name: str, roster: str) -> None:
    """Another spelling of alice's name has its own grade, and hers stays with all manual marks."""
    submit(tmp_path / "class/alice", BAD)
    batch(tmp_path, roster=roster)
    mark(tmp_path, "alice")
    before = students(tmp_path)["alice"]
    submit(tmp_path / "class" / name)
    done = batch(tmp_path, roster=roster)
    assert " now, with all" not in done.stderr
    after = students(tmp_path)
    assert after["alice"] == before
    assert len(after) == 2
    shutil.rmtree(tmp_path / "class/alice")
    batch(tmp_path)
    assert students(tmp_path)["alice"]["manual_marks"] == 1
    assert sum(student["manual_marks"] for student in students(tmp_path).values()) == 1


def test_marks_never_leave_the_roster(tmp_path: Path) -> None:
    """A roster entry keeps its marks even if its folder is contested: no folder name moves them, to `alice~2` for example."""
    submit(tmp_path / "class/alice", BAD)
    roster = "id,login\n7,alice\n"
    batch(tmp_path, roster=roster)
    mark(tmp_path, "7")
    before = students(tmp_path)["7"]
    changed = "id,login,github\n7,alice,\n8,bob,alice\n"  # now two may be meant
    done = batch(tmp_path, roster=changed)
    assert "alice is ambiguous: it matches several students on the roster: left unassigned" in done.stderr
    after = students(tmp_path)
    assert [after["7"][key] for key in ("score", "manual_marks", "status")] == [65.5, 1, "graded"]
    assert before["score"] == 65.5
    assert after["alice"]["manual_marks"] == 0


def test_sections_with_their_own_rosters(tmp_path: Path) -> None:
    """Adding a second class keeps the first one's students on their roster; a removed student is no longer expected."""
    for name in ("ann", "bea"):
        submit(tmp_path / "class" / name, BAD)
    batch(tmp_path, roster="id\nann\nbea\nabe\n")
    submit(tmp_path / "second/cal", BAD)
    (tmp_path / "second.csv").write_text("id\ncal\n")
    added = (
        "batch",
        tmp_path / "second",
        "--gradebook",
        tmp_path / "g.db",
        "--roster",
        tmp_path / "second.csv",
        "--add",
    )
    assert grader(*added).returncode == 0
    listed = grader("export", "csv", "--gradebook", tmp_path / "g.db").stdout
    assert [line.split(",")[0] for line in listed.splitlines()[1:]] == ["abe", "ann", "bea", "cal"]
    assert "not on the roster" not in batch(tmp_path).stdout
    shutil.rmtree(tmp_path / "class/bea")
    done = batch(tmp_path, roster="id\nann\nabe\n")
    assert "no longer in the class folder (1): bea\n  not on the roster (1): bea\n" in done.stdout
    assert "cal" not in done.stdout.partition("Needs attention")[2]


def test_contested_submissions_change_nothing(tmp_path: Path) -> None:
    """If a second folder claims the same student by name only, neither counts, and earlier results stay."""
    submit(tmp_path / "class/Alice Ash", BAD)
    roster = "id,name\n7,Alice Ash\n"
    batch(tmp_path, roster=roster)
    before = students(tmp_path)["7"]
    submit(tmp_path / "class/Ash, Alice")
    done = batch(tmp_path, roster=roster)
    assert "Alice Ash, Ash, Alice may each belong to 7: left unassigned; 7 keeps an earlier submission" in done.stderr
    assert students(tmp_path)["7"] == before


@pytest.mark.parametrize(
    ("start", "link", "target"),
    [
        ("class", "lab6-mallory/attempt_1", "../lab6-bob"),
        ("class", "lab6-mallory", "lab6-bob"),
        ("class/submitted", "mallory/lab6", "../bob/lab6"),
        ("class/red", "Lab6/mallory", "bob"),
        ("class/red", "Lab6/mallory", "../../blue/Lab6/bob"),
    ],
)
def test_a_symlink_to_another_students_work_is_not_followed(tmp_path: Path, start: str, link: str, target: str) -> None:
    """In every layout, neither as the submission nor as an attempt."""
    for folder in (
        "class/lab6-bob",
        "class/submitted/bob/lab6",
        "class/red/Lab6/bob",
        "class/red/Lab6/ann",
        "class/blue/Lab6/bob",
    ):
        if folder.startswith(start):
            submit(tmp_path / folder)
    (tmp_path / start / link).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / start / link).symlink_to(target)
    batch(tmp_path)
    found = {key: student for key, student in students(tmp_path).items() if "mallory" in key}
    assert all(student["score"] in (0, None) and student["status"] != "graded" for student in found.values()), found


@pytest.mark.parametrize("target", ["../lab6-bob/src", "../lab6-bob/src/my_robot", "..", "../../class/lab6-bob", "/"])
def test_a_symlink_in_a_submission_stays_in_it(tmp_path: Path, target: str) -> None:
    """A symlink that leads out of a student's folder is ignored and listed; one that stays in it is followed."""
    submit(tmp_path / "class/lab6-bob")
    (tmp_path / "class/lab6-mallory").mkdir(parents=True)
    (tmp_path / "class/lab6-mallory/src").symlink_to(target)
    (tmp_path / "class/lab6-mallory/notes.txt").write_text("mine")
    submit(tmp_path / "class/lab6-ann/real")
    (tmp_path / "class/lab6-ann/linked").symlink_to("real")
    batch(tmp_path, "--reports", tmp_path / "reports")
    assert students(tmp_path)["mallory"]["score"] == 0
    assert students(tmp_path)["ann"]["score"] == students(tmp_path)["bob"]["score"] == 90
    assert "src is a symlink that leads out of the submission" in (tmp_path / "reports/mallory.txt").read_text()


@pytest.mark.parametrize("roster", ["", "id\nann\nbea\ncal\ndee\n"])
def test_another_class_is_refused(tmp_path: Path, roster: str) -> None:
    """A class with no student in common is refused with a line that describes the gradebook, unless --add."""
    for name in ("ann", "bea", "cal", "dee"):
        submit(tmp_path / "class" / name)
    batch(tmp_path, roster=roster)
    before = (tmp_path / "g.db").read_bytes()
    (tmp_path / "class").rename(tmp_path / "first")
    submit(tmp_path / "class/zoe")
    done = batch(tmp_path, roster=roster)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.splitlines()[-1].endswith(
        "the roster matches 0 of 1 submission: is this the roster of this class? Name another one, or use --add"
        if roster
        else "g.db is the gradebook of another class: no student of this class is in it (it contains ann, bea, cal, ...);"
        " name another file, or use --add"
    )
    assert (tmp_path / "g.db").read_bytes() == before
    assert batch(tmp_path, "--add").returncode == 0
    assert set(students(tmp_path)) == {"ann", "bea", "cal", "dee", "zoe"}
    assert batch(tmp_path).returncode == 0


def test_another_rubric_is_refused(tmp_path: Path) -> None:
    """Results of two labs are mixed only on request."""
    submit(tmp_path / "class/ann", BAD)
    batch(tmp_path)
    text = (ROOT / "rubrics/lab6/rubric.toml").read_text(encoding="utf-8").replace('id = "lab6"', 'id = "lab7"', 1)
    (tmp_path / "lab7.toml").write_text(text.replace('reference = "my_robot"', "", 1), encoding="utf-8")
    done = batch(tmp_path, "--rubric", tmp_path / "lab7.toml")
    assert (done.returncode, done.stdout) == (2, "")
    assert "it was graded by the rubric lab6, not lab7 (it contains ann)" in done.stderr
    assert batch(tmp_path, "--rubric", tmp_path / "lab7.toml", "--add").returncode == 0


@pytest.mark.parametrize(
    ("first", "second", "words"),
    [
        ("Lab 6 (98765)", "Lab 6 (11111)", "it was graded for Canvas 98765, not Canvas 11111"),
        ("Lab 6 (98765)", "Lab 5 (22),Lab 6 (98765)", ""),
    ],
)
def test_another_course_of_canvas_is_refused(tmp_path: Path, first: str, second: str, words: str) -> None:
    """A roster that Canvas exported for another course has none of the assignments of the first."""
    submit(tmp_path / "class/ann", BAD)
    header = "Student,ID,SIS User ID,SIS Login ID,Section"
    batch(tmp_path, roster=f'{header},{first}\n"Ash, Ann",5,s5,ann,A{"," * (first.count(",") + 1)}\n')
    done = batch(tmp_path, roster=f'{header},{second}\n"Ash, Ann",5,s5,ann,A{"," * (second.count(",") + 1)}\n')
    assert (done.returncode, words in done.stderr) == (2 if words else 0, True)


def test_another_assignment_of_moodle_is_refused(tmp_path: Path) -> None:
    """Moodle numbers participants per assignment: the same names with other numbers are another assignment."""
    for number in (12, 13):
        submit(tmp_path / f"class/Jane Doe {number}_{number}_assignsubmission_file/my_robot", BAD)
    batch(tmp_path)
    for number in (12, 13):
        folder = tmp_path / "class" / f"Jane Doe {number}_{number}_assignsubmission_file"
        folder.rename(tmp_path / "class" / f"Jane Doe {number}_{number + 70}_assignsubmission_file")
    done = batch(tmp_path)
    assert done.returncode == 2
    assert "the Moodle ids of its students are not those of this class" in done.stderr


@pytest.mark.parametrize("layout", ["moodle", "canvas"])
def test_a_display_name_takes_over_nothing_later(tmp_path: Path, layout: str) -> None:
    """The gradebook knows a student's number if the roster has only the name: another number is another student."""
    paths = {
        "moodle": ("Bob Birch_12_assignsubmission_file", "Bob Birch_99_assignsubmission_file"),
        "canvas": ("birchbob_12_1001_robot", "birchbob_99_1002_robot"),
    }[layout]
    submit(tmp_path / "class" / paths[0], BAD)
    submit(tmp_path / "class" / paths[0].replace("12", "13").replace("Bob", "Eve").replace("bob", "eve"), BAD)
    batch(tmp_path, "--layout", layout, roster="id,name\nbob,Bob Birch\neve,Eve Birch\n")
    mark(tmp_path, "bob")
    before = students(tmp_path)["bob"]
    (tmp_path / "class" / paths[0]).rename(tmp_path / "away")
    submit(tmp_path / "class" / paths[1])
    done = batch(tmp_path, "--layout", layout)
    assert "has the name of bob, but another number: left unassigned" in done.stderr
    after = students(tmp_path)["bob"]
    assert (after["score"], after["manual_marks"]) == (before["score"], 1)


def test_a_display_name_removes_nobody(tmp_path: Path) -> None:
    """A file that can be read as another user's is a submission of its own, and earlier grades stay."""
    (tmp_path / "class").mkdir()
    shutil.copy(BAD / "my_robot.urdf", tmp_path / "class/doejane_12_1001_6_robot.urdf")
    shutil.copy(BAD / "my_robot.urdf", tmp_path / "class/roerick_13_1002_robot.urdf")
    batch(tmp_path, "--layout", "canvas")
    before = students(tmp_path)
    shutil.copy(BAD / "my_robot.urdf", tmp_path / "class/mallory_12_14_1003_robot.urdf")
    batch(tmp_path, "--layout", "canvas")
    after = students(tmp_path)
    assert after.pop("mallory_12_14")["score"] == 62
    assert after == before


@pytest.mark.parametrize("roster", ["", "id,login\nalice,alice\n", "id,login,group\nalice,alice,team2\n"])
def test_marks_stay_in_their_team(tmp_path: Path, roster: str) -> None:
    """A folder of the same name in another team gets nothing of a removed team, with or without a roster."""
    for folder in ("team1/Lab6/mallory", "team1/Lab6/dave", "team2/Lab6/alice", "team2/Lab6/bob"):
        submit(tmp_path / "class" / folder, BAD)
    batch(tmp_path)
    mark(tmp_path, "team2/alice")
    (tmp_path / "class/team2").rename(tmp_path / "away")
    submit(tmp_path / "class/team1/Lab6/alice")
    done = batch(tmp_path, "--layout", "teams", "--add", roster=roster)
    assert "now, with all" not in done.stderr
    found = students(tmp_path)
    assert found["team2/alice"]["manual_marks"] == 1
    assert found["team1/alice"]["manual_marks"] == 0


def test_two_exact_claims_are_contested(tmp_path: Path) -> None:
    """A login that equals another student's id does not take precedence over that student's own login."""
    submit(tmp_path / "class/lab6-alice-gh", BAD)
    roster = "id,name,github\ns123456,Alice Ash,alice-gh\n"
    batch(tmp_path, roster=roster)
    before = students(tmp_path)["s123456"]
    submit(tmp_path / "class/lab6-s123456")
    assert "left unassigned" in batch(tmp_path, roster=roster).stderr
    assert students(tmp_path)["s123456"] == before


def test_a_case_variant_takes_over_no_key_later(tmp_path: Path) -> None:
    """After alice's folder is removed, ALICE is still unmatched: her grade and marks stay as they were."""
    submit(tmp_path / "class/alice", BAD)
    submit(tmp_path / "class/ALICE")
    roster = "id\nalice\n"
    batch(tmp_path, roster=roster)
    mark(tmp_path, "alice")
    before = students(tmp_path)["alice"]
    shutil.rmtree(tmp_path / "class/alice")
    done = batch(tmp_path, roster=roster)
    assert "ALICE may belong to alice, who had another submission: left unassigned" in done.stderr
    assert students(tmp_path)["alice"] == before


def test_a_folder_without_the_prefix_takes_over_nothing(tmp_path: Path) -> None:
    """In a class of `lab6-...`, a folder `alice` is not the one that was graded as alice's."""
    for name in ("lab6-alice", "lab6-carl"):
        submit(tmp_path / "class" / name, BAD)
    batch(tmp_path)
    mark(tmp_path, "alice")
    submit(tmp_path / "class/alice")
    batch(tmp_path)
    found = students(tmp_path)
    assert {key: (student["score"], student["manual_marks"]) for key, student in found.items()} == {
        "./alice": (90, 0),
        "./lab6-alice": (65.5, 1),
        "carl": (62, 0),
    }


def test_another_assignment_of_nbgrader_is_refused(tmp_path: Path) -> None:
    """nbgrader names the assignment."""
    for name in ("lab6", "lab7"):
        submit(tmp_path / f"class/submitted/ann/{name}", BAD)
    assert batch(tmp_path, "--assignment", "lab6").returncode == 0
    done = batch(tmp_path, "--assignment", "lab7")
    assert done.returncode == 2
    assert "it was graded for nbgrader lab6, not nbgrader lab7 (it contains ann)" in done.stderr


@pytest.mark.parametrize("roster", ["", "id,login\n1,ann\n"])
def test_a_fresh_download_is_not_refused(tmp_path: Path, roster: str) -> None:
    """The same class in another folder, or with a roster that comes later, is accepted for the same gradebook."""
    submit(tmp_path / "class/lab6-ann", BAD)
    batch(tmp_path)
    (tmp_path / "class").rename(tmp_path / "old")
    submit(tmp_path / "class/lab6-ann")
    assert batch(tmp_path, roster=roster).returncode == 0
    assert [student["score"] for student in students(tmp_path).values()] == [90]


def test_hostile_display_names_of_moodle_are_refused(tmp_path: Path) -> None:
    """A full name that imitates a participant's number is ambiguous and ignored."""
    submit(tmp_path / "class/Bob_7_assignsubmission_file/my_robot", BAD)
    submit(tmp_path / "class/Mallory_7_assignsubmission_file__9_assignsubmission_file/my_robot")
    done = batch(tmp_path)
    assert "Mallory_7_assignsubmission_file__9_assignsubmission_file" in done.stderr
    assert {key: student["score"] for key, student in students(tmp_path).items()} == {"Bob_7": 62}


def test_hostile_display_names_of_canvas_are_refused(tmp_path: Path) -> None:
    """A name that ends in another user's number is not that user's, whose own files show another name."""
    (tmp_path / "class").mkdir()
    shutil.copy(BAD / "my_robot.urdf", tmp_path / "class/smithbob_77_100_my_robot.urdf")
    shutil.copy(ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf", tmp_path / "class/mallory_77_99_101_my_robot.urdf")
    batch(tmp_path, "--layout", "canvas")
    assert {key: student["score"] for key, student in students(tmp_path).items()} == {
        "smithbob_77": 62,
        "mallory_77_99": 70,
    }


@pytest.mark.parametrize("alice", ["", "ashalice_71_50071_my_robot.urdf"])
@pytest.mark.parametrize("mallory", ["alice_71_80_50080_my_robot.urdf", "ashalice_71_80_50080_my_robot.urdf"])
def test_a_roster_does_not_settle_a_name_with_two_numbers(tmp_path: Path, alice: str, mallory: str) -> None:
    """Whether the student with the known number has submitted or not, the file is left unassigned and named."""
    (tmp_path / "class").mkdir()
    for name in (alice, "birchbob_72_50072_my_robot.urdf"):
        if name:
            shutil.copy(BAD / "my_robot.urdf", tmp_path / "class" / name)
    shutil.copy(ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf", tmp_path / "class" / mallory)
    done = batch(tmp_path, "--layout", "canvas", roster="id,name,Canvas ID\na,Alice Ash,71\nb,Bob Birch,72\n")
    assert done.returncode == 0, done.stderr
    key = mallory.partition("_50080")[0]
    assert key in done.stderr
    scores = {name: student["score"] for name, student in students(tmp_path).items()}
    assert scores == {"a": 62 if alice else None, "b": 62, key: 70}


def digested(key: str) -> str:
    """Return a report's name with the whole digest of a key."""
    return f"{key.replace(' ', '_')}-{sha256(key.encode()).hexdigest()}"


def test_a_report_belongs_to_one_student(tmp_path: Path) -> None:
    """Names that collide in a file system have separate reports, and an index names their students."""
    names = ["Bob Smith", "Bob_Smith", "bob_smith", "CON", "a" * 200, "a" * 201, "Zoe\u0308", "Zo\u00eb"]
    names += ["Bob_Smith-7e3d89", digested("Bob Smith"), digested("BOB_SMITH")]
    for name in names:
        submit(tmp_path / "class" / name, BAD)
    batch(tmp_path, "--reports", tmp_path / "reports")
    written = [path.name for path in (tmp_path / "reports").iterdir() if path.suffix == ".txt"]
    assert len({name.casefold() for name in written}) == len(names)
    index = dict(line.split(",") for line in (tmp_path / "reports/index.csv").read_text().splitlines()[1:])
    assert sorted(index.values()) == sorted(names)
    assert sorted(f"{name}.txt" for name in index) == sorted(written)


def test_a_report_of_another_student_is_not_overwritten(tmp_path: Path) -> None:
    """A folder with reports of another class is refused if a name belongs to another student there."""
    submit(tmp_path / "class/ann", BAD)
    (tmp_path / "reports").mkdir()
    (tmp_path / "reports/index.csv").write_text("report,id\r\nann,Ann Ash\r\n")
    done = batch(tmp_path, "--reports", tmp_path / "reports")
    assert done.returncode == 2
    assert "has a report of Ann Ash named ann: choose another folder" in done.stderr
