"""Hints in a class, through the command line: the edits that many students need, and those in each student's report."""

import json
import re
import shutil
import sqlite3
from collections.abc import Iterable
from contextlib import closing
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tests.classroom.class_runs import WITH_HOSTILE, Done, grader, rows
from tests.samples import ROOT

pytestmark = pytest.mark.exhaustive
LAB = ROOT / "rubrics/lab6"
REFERENCE = (LAB / "my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
_RIGHT = 'xyz="-0.15 -0.2 0" rpy="-1.57 0 0"'
MIRRORED = REFERENCE.replace(_RIGHT, _RIGHT.replace("-1.57", "1.57"))
BURIED = REFERENCE.replace('xyz="0.15 0 0.225"', 'xyz="0.15 0 0.2"')
BOTH = MIRRORED.replace('xyz="0.15 0 0.225"', 'xyz="0.15 0 0.2"')
BRIGHT = REFERENCE.replace('rgba="0 0.6 0 1"', 'rgba="0 1 0 1"')
OTHER_LINES = MIRRORED.replace("<link", "<!-- mine -->\n\n  <link").replace('rpy="1.57 0 0"', 'rpy="1.570 0 0"')
CLASS = {
    "ash.urdf": MIRRORED,
    "birch.urdf": OTHER_LINES,
    "cedar.urdf": MIRRORED,
    "elm/my_robot.urdf": MIRRORED,
    "fir.urdf": BURIED,
    "hazel.urdf": BURIED.replace('name="my_robot"', 'name="hazels"'),
    "holly/holly.urdf": BURIED,
    "juniper.urdf": BOTH,
    "larch.urdf": BRIGHT,
    "maple.urdf": REFERENCE,
    "oak.urdf": REFERENCE.replace("0.15 0 0.225", "0.150 0.0 0.225"),
    "pine/notes.txt": "I was ill.",
}
STUDENTS = {re.split(r"[/.]", path)[0]: path for path in CLASS}
NEGATE = "negate the roll of the joint origin of 'right_wheel'"
HEADING = "Edits that would fix the most\n"


def make(folder: Path, files: dict[str, str] = CLASS) -> Path:
    """Write a class and return its folder."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def batch(top: Path, *more: str | Path) -> Done:
    """Grade the class in a folder into its gradebook."""
    done = grader("batch", top / "class", "--gradebook", top / "g.db", *more)
    assert done.returncode == 0, done.stderr
    return done


def stats(top: Path, *more: str) -> Done:
    """Show the statistics of its gradebook."""
    done = grader("stats", "--gradebook", top / "g.db", *more)
    assert done.returncode == 0, done.stderr
    return done


def fixes(done: Done) -> list[dict[str, Any]]:
    """Return the fixes of a class as JSON, which is valid under its schema."""
    found = json.loads(done.stdout)
    jsonschema.validate(found, json.loads(grader("schema", "class").stdout))
    return list(found["fixes"])


def section(done: Done) -> str:
    """Return the edits in the statistics on a terminal."""
    return done.stdout.partition(HEADING)[2].partition("\n\n")[0]


def searched(top: Path) -> set[str]:
    """Return the students whose hints are stored."""
    return {key for (key,) in rows(top / "g.db", "SELECT key FROM grade JOIN hint USING (result)")}


def reports(folder: Path, names: Iterable[str] = STUDENTS) -> dict[str, dict[str, Any]]:
    """Return the reports of students as JSON."""
    return {name: json.loads((folder / f"{name}.json").read_text(encoding="utf-8")) for name in names}


def hints(report: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the hints of a report, each once."""
    found = [hint for result in report["results"] for hint in result["hints"]]
    return [hint for index, hint in enumerate(found) if hint not in found[:index]]


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a class of twelve, its gradebook, and its statistics; tests must not change it."""
    top = tmp_path_factory.mktemp("hints")
    make(top / "class")
    (top / "batch.txt").write_text(batch(top, "--jobs", "2").stdout, encoding="utf-8")
    assert searched(top) == set()
    for name, more in (("stats.txt", ()), ("stats.json", ("--format", "json"))):
        done = stats(top, *more)
        assert not done.stderr
        (top / name).write_text(done.stdout, encoding="utf-8")
    return top


@pytest.fixture
def top(graded: Path, tmp_path: Path) -> Path:
    """Return a copy of the gradebook beside the same class."""
    shutil.copy(graded / "g.db", tmp_path / "g.db")
    (tmp_path / "class").symlink_to(graded / "class")
    return tmp_path


def saved(top: Path, name: str) -> Done:
    """Return the saved output of a command."""
    return Done((), 0, (top / name).read_text(encoding="utf-8"), "")


# --- Statistics -------------------------------------------------------------------------------------------------------


def test_a_class_is_grouped_by_the_proven_edit(graded: Path) -> None:
    """Each change with the number of students, the most frequent first, with its diff, its criteria and points."""
    assert section(saved(graded, "stats.txt")) == (
        "  Each edit was tested: the listed criteria pass, and no other criterion fails.\n"
        "  5 students: negate the roll of the joint origin of 'right_wheel'\n"
        '        - rpy="1.57 0 0"\n'
        '        + rpy="-1.57 0 0"\n'
        "        right-wheel-placed, right-wheel-forward, right-wheel-axis and\n"
        "        right-wheel-clear pass, +10 points\n"
        "  4 students: set z of the joint origin of 'lidar' to 0.225\n"
        '        - xyz="0.15 0 0.2"\n'
        '        + xyz="0.15 0 0.225"\n'
        "        lidar-frame and lidar-on-top pass, +8 points\n"
        "  1 student: set the green of the material color of 'green' to 0.6\n"
        '        - rgba="0 1 0 1"\n'
        '        + rgba="0 0.6 0 1"\n'
        "        base-green passes, +6 points"
    )


def test_fixes_as_json(graded: Path) -> None:
    """The example has the text of one student, at the place of the URDF in the rubric."""
    first, second, third = fixes(saved(graded, "stats.json"))
    example = first.pop("example")
    passing = ["right-wheel-placed", "right-wheel-forward", "right-wheel-axis", "right-wheel-clear"]
    assert first == {"action": NEGATE, "count": 5, "criteria": passing, "points": 10}
    line = MIRRORED[: MIRRORED.index('rpy="1.57')].count("\n") + 1
    place = {"path": "urdf/my_robot.urdf", "line": line, "column": 32}
    assert example == [{**place, "old": 'rpy="1.57 0 0"', "new": 'rpy="-1.57 0 0"'}]
    assert [fix["count"] for fix in (second, third)] == [4, 1]


def test_no_student_is_named(graded: Path) -> None:
    """Neither their keys nor the names of their files are in the edits."""
    shown = section(saved(graded, "stats.txt")) + json.dumps(fixes(saved(graded, "stats.json")))
    assert not [name for name in (*STUDENTS, "hazels") if name in shown]


def test_each_distinct_robot_is_searched_once(graded: Path) -> None:
    """Equal robots with equal failures share one search, whatever their text, and equal files its result.

    A folder whose package fails is searched on its own.
    """
    assert searched(graded) == {"ash", "cedar", "elm", "fir", "holly", "juniper", "larch", "pine"}


def test_batch_shows_no_edits(graded: Path) -> None:
    """Without reports nothing is searched; otherwise its summary is that of stats."""
    before, _, after = (graded / "stats.txt").read_text(encoding="utf-8").partition(HEADING)
    assert before + after.partition("\n\n")[2] == (graded / "batch.txt").read_text(encoding="utf-8")


def test_the_gradebook_keeps_what_was_found(top: Path, graded: Path) -> None:
    """A second call searches nothing: it needs no class, and changes nothing."""
    (top / "class").unlink()
    before = rows(top / "g.db", "SELECT * FROM hint")
    done = stats(top)
    assert (done.stdout, done.stderr) == (saved(graded, "stats.txt").stdout, "")
    exported = grader("export", "json", "--gradebook", top / "g.db").stdout
    assert exported == saved(graded, "stats.json").stdout
    assert rows(top / "g.db", "SELECT * FROM hint") == before


def test_a_moved_class_is_reported(tmp_path: Path) -> None:
    """Nothing is guessed about files that changed since they were graded; everything else is shown."""
    make(tmp_path / "class", {"ash.urdf": MIRRORED, "birch.urdf": BURIED, "cedar.urdf": BRIGHT})
    batch(tmp_path)
    (tmp_path / "class/ash.urdf").write_text(BRIGHT, encoding="utf-8")
    (tmp_path / "class/birch.urdf").unlink()
    done = stats(tmp_path)
    assert [line for line in section(done).splitlines() if "student" in line] == [
        "  1 student: set the green of the material color of 'green' to 0.6"
    ]
    why = (
        "no hints for 2 submissions, which have changed or moved since the last run, or could not be read: "
        "run `grader batch` again"
    )
    assert done.stderr == f"grader: {why}\n"
    assert searched(tmp_path) == {"cedar"}


def test_a_manual_mark_settles_a_criterion(top: Path) -> None:
    """Who has all points of a change already does not need it."""
    for mark in (("fir", "lidar-frame", "6"), ("fir", "lidar-on-top", "2"), ("hazel", "lidar-frame", "6")):
        assert grader("mark", *mark, "--gradebook", top / "g.db").returncode == 0
    assert [fix["count"] for fix in fixes(stats(top, "--format", "json"))] == [5, 3, 1]


def test_text_of_students_is_escaped(tmp_path: Path) -> None:
    """Comments in an element that is replaced neither colour the terminal, nor reverse it, nor command a runner."""
    sneaky = "<!-- [red]\u202e\n::error::x -->"
    text = (ROOT / "submissions/lab6/caster-a-cylinder/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
    at = text.index("/>", text.index("<cylinder", text.index('<link name="caster_wheel"')))
    make(tmp_path / "class", {"ash.urdf": f"{text[:at]}>{sneaky}</cylinder>{text[at + 2 :]}"})
    batch(tmp_path)
    shown, as_json = section(stats(tmp_path)), stats(tmp_path, "--format", "json").stdout
    assert "<!-- [red]\\u202e" in shown
    assert not re.search(r"^\s*::", shown, re.MULTILINE)
    for output in (shown, as_json):
        assert "\u202e" not in output
    assert any("[red]\u202e" in edit["old"] for fix in json.loads(as_json)["fixes"] for edit in fix["example"])


# --- Reports ----------------------------------------------------------------------------------------------------------


def test_reports_have_hints_for_the_students_own_text(top: Path, graded: Path) -> None:
    """The edit is in the student's file, at the student's line; it is the hint that `grade` shows."""
    batch(top, "--reports", top / "reports", "--report-format", "json", "--jobs", "2")
    found = reports(top / "reports")
    without = {"maple", "oak", "pine"}
    assert {name for name, report in found.items() if not hints(report)} == without
    assert searched(top) == STUDENTS.keys() - {"maple", "oak"}
    for name in STUDENTS.keys() - without:
        lines = (graded / "class" / STUDENTS[name]).read_text(encoding="utf-8").splitlines()
        for hint in hints(found[name]):
            (edit,) = hint["edits"]
            assert edit["path"] == found[name]["submission"]["path"]
            assert lines[edit["line"] - 1][edit["column"] - 1 :].startswith(edit["old"])
    assert hints(found["ash"])[0]["edits"][0]["line"] < hints(found["birch"])[0]["edits"][0]["line"]
    for name in ("elm", "holly"):
        alone = grader("grade", graded / "class" / name, "--format", "json").stdout
        assert json.loads(alone)["results"] == found[name]["results"]


def test_the_number_of_jobs_does_not_matter(tmp_path: Path) -> None:
    """The same class gives the same reports and the same statistics."""
    make(tmp_path / "class")
    outputs: list[str] = []
    files: list[dict[str, bytes]] = []
    for jobs in ("1", "3"):
        done = grader(
            "batch", tmp_path / "class", "--gradebook", tmp_path / f"g{jobs}.db", "--jobs", jobs, "--format", "json",
            "--reports", tmp_path / jobs, "--report-format", "json", "--report-format", "markdown",
        )  # fmt: skip
        outputs.append(done.stdout)
        files.append({path.name: path.read_bytes() for path in (tmp_path / jobs).iterdir()})
    assert outputs[0] == outputs[1]
    assert files[0] == files[1]
    assert fixes(Done((), 0, outputs[0], ""))[0]["count"] == 5


@pytest.mark.parametrize("level", ["none", "place", "cause"])
def test_the_rubric_says_how_much_reports_tell(tmp_path: Path, level: str) -> None:
    """Below the level edit reports have no edit; statistics are for the grader and always have it."""
    shutil.copytree(LAB / "my_robot", tmp_path / "lab/my_robot")
    text = (LAB / "rubric.toml").read_text(encoding="utf-8").replace('hints = "edit"', f'hints = "{level}"')
    rubric = tmp_path / "lab/lab6.toml"
    rubric.write_text(text, encoding="utf-8")
    make(tmp_path / "class", {"ash.urdf": MIRRORED})
    batch(tmp_path, "--rubric", rubric, "--reports", tmp_path / "reports", "--report-format", "json")
    assert searched(tmp_path) == (set() if level == "none" else {"ash"})
    for hint in hints(reports(tmp_path / "reports", ["ash"])["ash"]):
        assert hint["edits"] == []
        assert "-1.57" not in hint["message"]
        assert ("the sign of the roll" in hint["message"]) == (level == "cause")
    (fix,) = fixes(stats(tmp_path, "--format", "json"))
    assert (fix["action"], fix["example"][0]["new"]) == (NEGATE, 'rpy="-1.57 0 0"')
    if level == "none":  # what statistics have stored is not for students
        batch(tmp_path, "--rubric", rubric, "--reports", tmp_path / "reports", "--report-format", "json")
    assert bool(hints(reports(tmp_path / "reports", ["ash"])["ash"])) == (level != "none")


def test_a_manual_mark_replaces_a_hint(top: Path) -> None:
    """A person has decided the criterion: no hint promises its points."""
    assert grader("mark", "fir", "lidar-frame", "5", "--gradebook", top / "g.db").returncode == 0
    batch(top, "--reports", top / "reports", "--report-format", "json")
    results = {result["id"]: result for result in reports(top / "reports", ["fir"])["fir"]["results"]}
    assert results["lidar-frame"]["hints"] == []
    assert results["lidar-on-top"]["hints"]


# --- What is stored ---------------------------------------------------------------------------------------------------


def test_hints_are_stored_until_something_changes(tmp_path: Path) -> None:
    """Kept by an unchanged run; searched again for a changed file, for another rubric, and with --force."""
    shutil.copytree(LAB / "my_robot", tmp_path / "lab/my_robot")
    rubric = tmp_path / "lab/lab6.toml"
    rubric.write_text((LAB / "rubric.toml").read_text(encoding="utf-8"), encoding="utf-8")
    make(tmp_path / "class", {"ash.urdf": MIRRORED, "birch.urdf": BURIED})

    def hinted(*more: str) -> dict[str, bool]:
        out = tmp_path / "reports"
        batch(tmp_path, "--rubric", rubric, "--reports", out, "--report-format", "json", *more)
        return {name: bool(hints(report)) for name, report in reports(out, ["ash", "birch"]).items()}

    assert hinted() == {"ash": True, "birch": True}
    forget(tmp_path)
    assert hinted() == {"ash": False, "birch": False}
    (tmp_path / "class/birch.urdf").write_text(BRIGHT, encoding="utf-8")
    assert hinted() == {"ash": False, "birch": True}
    assert hinted("--force") == {"ash": True, "birch": True}
    forget(tmp_path)
    rubric.write_text(rubric.read_text(encoding="utf-8") + "\n# a comment\n", encoding="utf-8")
    assert hinted() == {"ash": True, "birch": True}
    assert rows(tmp_path / "g.db", "SELECT count(*) FROM hint") == [(2,)]  # those of the former results are dropped


def forget(top: Path) -> None:
    """Store for all results that nothing was found."""
    with closing(sqlite3.connect(top / "g.db")) as book, book:
        book.execute("UPDATE hint SET hints = ?", ('{"hints":[],"complete":true}',))


def test_a_lost_search_costs_only_its_own_hints(tmp_path: Path) -> None:
    """A crash and a timeout while edits are tried: every report is written, and the others have hints."""
    names = {"ash": "dies_when_tried", "birch": "fine", "cedar": "hangs_when_tried"}
    body = '<link name="base"><visual><geometry><box size="1 1 2"/></geometry></visual></link>'
    make(tmp_path / "class", {f"{key}.urdf": f'<robot name="{name}">{body}</robot>' for key, name in names.items()})
    text = (ROOT / "tests/classroom/hostile/hostile.toml").read_text(encoding="utf-8")
    box = 'check = "shows_box"\nwith = { link = "base", size = [1, 1, 1], tolerance = 0.001 }'
    rubric = tmp_path / "lab.toml"
    (tmp_path / "correct.urdf").write_text(f'<robot name="r">{body.replace("1 1 2", "1 1 1")}</robot>')
    rubric.write_text(
        f'reference = "correct.urdf"\n{text}\n[[criterion]]\nid = "box"\npart = "all"\ntitle = "Box"\npoints = 1\n{box}\n'
    )
    done = grader(
        "batch", tmp_path / "class", "--gradebook", tmp_path / "g.db", "--rubric", rubric, "--timeout", "3",
        "--reports", tmp_path / "reports", "--report-format", "json", "--jobs", "2", **WITH_HOSTILE,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = reports(tmp_path / "reports", names)
    assert {name: report["score"] for name, report in found.items()} == dict.fromkeys(names, 3)
    assert {name: bool(hints(report)) for name, report in found.items()} == {
        "ash": False,
        "birch": True,
        "cedar": False,
    }
