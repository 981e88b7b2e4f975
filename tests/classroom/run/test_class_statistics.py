"""A class seen truly, through the command line: undecided points, causes, identical work, and the course's own folders."""

import json
import shutil
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tests.classroom.class_runs import grader
from tests.report.class_pages import ClassPageReader
from tests.samples import ROOT

URDF = (ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
HANDED_OUT = (ROOT / "submissions/lab6/base-half-sunk/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
REFERENCE = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
SMALL_WHEELS = (ROOT / "submissions/lab6/wheel-too-small/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
FORWARD = (ROOT / "submissions/lab6/axis-negated/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
XACRO = (
    '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:include filename="$(find other)/a.xacro"/></robot>'
)
FILES: dict[str, dict[str, str]] = {
    "ash": {"my_robot.urdf": URDF},
    "birch": {"my_robot.urdf": URDF.replace("base_lidar_joint", "lidar_joint").replace("<link", "<!-- mine --><link")},
    "cedar": {"robot.urdf": URDF},
    "elm": {"my_robot.urdf": REFERENCE},
    "fir": {"my_robot.urdf": REFERENCE},
    "hazel": {"my_robot.urdf": HANDED_OUT},
    "holly": {"my_robot.urdf": HANDED_OUT.replace("0.6 0.4 0.2", ".6 .4 .2")},
    "juniper": {"my_robot.urdf.xacro": XACRO},
    "larch": {"my_robot.urdf.xacro": XACRO + "\n"},
    "maple": {"a.txt": "x", "b.txt": "y"},
    "oak": {"a.txt": "x", "b.txt": "y", "c.txt": "z"},
    "pine": {"my_robot.urdf": SMALL_WHEELS},
    "rowan": {"my_robot.urdf": FORWARD},
    "spruce": {"my_robot.urdf": FORWARD.replace('axis xyz="0 0 -1"', 'axis xyz="0 0.0008 -1"')},
    "Lab6 resources": {"my_robot.urdf": URDF},
    "Handout": {"my_robot.urdf": HANDED_OUT},
    "lab_6_solutions": {"my_robot.urdf": REFERENCE},
}
COURSE = ("Handout", "Lab6 resources", "lab_6_solutions")


@pytest.fixture(scope="module")
def top(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a class, its roster and its gradebook; a file was handed out."""
    top = tmp_path_factory.mktemp("class")
    for name, files in FILES.items():
        (top / "class" / name).mkdir(parents=True)
        for file, text in files.items():
            (top / "class" / name / file).write_text(text, encoding="utf-8")
    rows = "".join(f"{name},{name.title()} Tree\n" for name in FILES if name not in COURSE)
    (top / "roster.csv").write_text(f"id,name\n{rows}", encoding="utf-8")
    (top / "start.urdf").write_text(HANDED_OUT, encoding="utf-8")
    done = grader(
        "batch", top / "class", "--gradebook", top / "g.db", "--roster", top / "roster.csv", "--ignore-file",
        top / "start.urdf", "--jobs", "2",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    (top / "out.txt").write_text(done.stdout, encoding="utf-8")
    (top / "err.txt").write_text(done.stderr, encoding="utf-8")
    return top


def data(top: Path) -> dict[str, Any]:
    """Return the class as JSON, valid under its schema."""
    found = json.loads(grader("stats", "--gradebook", top / "g.db", "--format", "json").stdout)
    jsonschema.validate(found, json.loads(grader("schema", "class").stdout))
    return dict(found)


def text(top: Path) -> str:
    """Return the summary that batch has printed, without line breaks; stats prints the same, and edits."""
    out = (top / "out.txt").read_text(encoding="utf-8")
    before, _, after = grader("stats", "--gradebook", top / "g.db").stdout.partition("Edits that would fix")
    assert before + after.partition("\n\n")[2] == out
    return " ".join(out.split())


# --- Points -----------------------------------------------------------------------------------------------------------


def test_undecided_submissions_are_no_zeros(top: Path) -> None:
    """The two that cannot be expanded are not in the mean, and stated beside it."""
    found, students = data(top)["statistics"], data(top)["students"]
    graded = [student for student in students if student["id"] not in ("juniper", "larch")]
    grades = [student["score"] * 100 / (student["max_score"] - student["pending"]) for student in graded]
    assert (found["graded"], found["undecided"]) == (len(students), 2) == (14, 2)
    assert found["mean"] == pytest.approx(sum(grades) / len(grades), abs=1e-3)
    assert sum(found["tenths"]) == 12
    assert "Not in these grades: 2 submissions, because most of the automatic points need manual grading" in text(top)


def test_three_kinds_of_points_are_separate(top: Path) -> None:
    """Earned, lost and undecided points add up to the maximum."""
    found, students = data(top)["statistics"]["points"], data(top)["students"]
    assert found["earned"] == sum(student["score"] for student in students)
    assert found["pending"] == sum(student["pending"] for student in students)
    assert sum(found.values()) == sum(student["max_score"] for student in students)
    shares = [f"{found[name] / 14:.1f}" for name in ("earned", "lost", "pending")]
    words = "Points on average: {} earned, {} lost, {} need manual grading; 14 submissions need manual grading"
    assert words.format(*shares) in text(top)


def test_the_main_reason_is_one_line(top: Path) -> None:
    """It counts the cause, although the messages name different files."""
    assert data(top)["statistics"]["reasons"] == [
        {"reason": "the package other is not part of the submission", "count": 2}
    ]
    assert "Checks without a result: 2 submissions: the package other is not part of the submission" in text(top)


def test_a_manual_mark_decides(top: Path) -> None:
    """A submission whose automatic points were all given by a person has no reason any more."""
    shutil.copy(top / "g.db", top / "marked.db")
    found = json.loads(grader("stats", "--gradebook", top / "g.db", "--format", "json").stdout)
    for row in found["statistics"]["criteria"]:
        if row["pending"] == 2:
            grader("mark", "larch", row["id"], "0", "--gradebook", top / "marked.db")
    done = grader("stats", "--gradebook", top / "marked.db", "--format", "json")
    after = json.loads(done.stdout)["statistics"]
    assert after["reasons"] == [{"reason": "the package other is not part of the submission", "count": 1}]
    assert after["undecided"] == 1


# --- Causes -----------------------------------------------------------------------------------------------------------


def test_failures_have_a_row_for_each_cause(top: Path) -> None:
    """Numbers of files, and differences below the tolerance, make no row of their own."""
    found = data(top)["statistics"]["failures"]
    assert [row["count"] for row in found if row["message"].startswith("no URDF was submitted")] == [2]
    assert [row["count"] for row in found if row["criterion"] == "left-wheel-forward"] == [2]
    assert [row["count"] for row in found if row["criterion"] == "lidar-frame"] == [3]


def test_a_carried_criterion_is_no_mistake(top: Path) -> None:
    """It is counted on its own, and the cause is the mistake."""
    found = data(top)["statistics"]
    criteria = {row["id"]: row for row in found["criteria"]}
    assert [criteria["footprint-at-wheel-bottoms"][name] for name in ("carried", "failed")] == [1, 0]
    assert not any(row["criterion"] == "footprint-at-wheel-bottoms" for row in found["failures"])
    (pine,) = (student for student in data(top)["students"] if student["id"] == "pine")
    assert (pine["score"], pine["carried"]) == (68, ["footprint-at-wheel-bottoms", "stands-on-ground"])
    table = grader("export", "csv", "--gradebook", top / "g.db").stdout.splitlines()
    (row,) = (line for line in table if line.startswith("pine,"))
    assert '"footprint-at-wheel-bottoms, stands-on-ground",' in row


def test_a_report_from_the_gradebook_names_the_cause(top: Path) -> None:
    """Reports of a class are as those of one submission."""
    done = grader(
        "batch",
        top / "class",
        "--gradebook",
        top / "g.db",
        "--roster",
        top / "roster.csv",
        "--reports",
        top / "reports",
    )
    assert done.returncode == 0
    report = (top / "reports/pine.txt").read_text(encoding="utf-8")
    assert "(caused by left-wheel-shape)." in " ".join(report.split())


# --- Identical work ---------------------------------------------------------------------------------------------------


def test_identical_work_is_listed(top: Path) -> None:
    """Who shares with whom, and which of them the same file; the reference and what was handed out are exempt."""
    assert data(top)["identical"] == [
        {"students": ["ash", "birch", "cedar"], "same_file": [["ash", "cedar"]], "equal": "the same robot"}
    ]
    words = text(top)
    assert (
        "Ash Tree (ash), Birch Tree (birch) and Cedar Tree (cedar): the same robot; the same file: Ash Tree (ash) and"
        " Cedar Tree (cedar)"
    ) in words
    assert "This is no verdict" in words
    assert "hazel and holly" not in words


def test_handed_out_files_are_remembered(top: Path) -> None:
    """A later run and `stats` need not name them again; without them they are identical work."""
    grader("batch", top / "class", "--gradebook", top / "other.db", "--roster", top / "roster.csv", "--jobs", "2")
    found = json.loads(grader("stats", "--gradebook", top / "other.db", "--format", "json").stdout)
    assert [group["students"] for group in found["identical"]] == [["ash", "birch", "cedar"], ["hazel", "holly"]]
    grader(
        "batch", top / "class", "--gradebook", top / "other.db", "--roster", top / "roster.csv", "--ignore-file",
        top / "start.urdf",
    )  # fmt: skip
    found = json.loads(grader("stats", "--gradebook", top / "other.db", "--format", "json").stdout)
    assert [group["students"] for group in found["identical"]] == [["ash", "birch", "cedar"]]


@pytest.mark.parametrize(
    ("name", "reason"), [("nowhere.urdf", "does not exist"), ("empty", "there is no URDF and no package in it")]
)
def test_a_wrong_ignore_file_is_refused(top: Path, name: str, reason: str) -> None:
    """Before anything is graded, in one line."""
    (top / "empty").mkdir(exist_ok=True)
    (top / "empty/notes.txt").write_text("x", encoding="utf-8")
    done = grader("batch", top / "class", "--gradebook", top / "no.db", "--ignore-file", top / name)
    assert (done.returncode, done.stdout) == (2, "")
    assert reason in done.stderr
    assert not (top / "no.db").exists()


def test_a_shared_submission_is_not_identical_work(tmp_path: Path) -> None:
    """The members of a group who have submitted together share nothing with others."""
    (tmp_path / "class/team1").mkdir(parents=True)
    (tmp_path / "class/team1/my_robot.urdf").write_text(URDF, encoding="utf-8")
    (tmp_path / "roster.csv").write_text("id,name,group\n1,Ash Tree,team1\n2,Birch Tree,team1\n", encoding="utf-8")
    done = grader(
        "batch",
        tmp_path / "class",
        "--gradebook",
        tmp_path / "g.db",
        "--roster",
        tmp_path / "roster.csv",
        "--format",
        "json",
    )
    found = json.loads(done.stdout)
    assert [student["score"] for student in found["students"]] == [62, 62]
    assert found["identical"] == []


# --- The course's own folders -----------------------------------------------------------------------------------------


def test_course_folders_are_not_students(top: Path) -> None:
    """With a roster they are ignored in one line, not graded."""
    assert not {student["id"] for student in data(top)["students"]} & set(COURSE)
    errors = (top / "err.txt").read_text(encoding="utf-8")
    assert (
        "ignored: Handout, Lab6 resources and lab_6_solutions are folders of the course, not of a student\n" in errors
    )
    assert "unmatched" not in errors


def test_without_a_roster_every_folder_is_graded(tmp_path: Path) -> None:
    """Nobody can tell then whose a folder is; a folder of a student on the roster is graded whatever its name."""
    for name in ("ash", "Template"):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "my_robot.urdf").write_text(URDF, encoding="utf-8")
    (tmp_path / "roster.csv").write_text("id,name\nash,Ash Tree\ntemplate,Tem Plate\n", encoding="utf-8")
    for more in ((), ("--roster", tmp_path / "roster.csv")):
        done = grader(
            "batch", tmp_path / "class", "--gradebook", tmp_path / f"g{len(more)}.db", "--format", "json", *more
        )
        assert len(json.loads(done.stdout)["students"]) == 2


# --- The class's page -------------------------------------------------------------------------------------------------


def test_the_page_says_what_the_terminal_says(top: Path) -> None:
    """The same words, the same numbers, and as many students behind each as it says."""
    done = grader("export", "html", "--gradebook", top / "g.db", "--output", top / "pages")
    assert (done.returncode, done.stdout) == (0, "")
    page, found = ClassPageReader(top / "pages/index.html"), data(top)
    statistics, printed = found["statistics"], text(top)
    (counts,) = page.texts("//p[@class='counts']")
    assert counts.startswith(
        f"{statistics['counts']['graded']} graded {statistics['pending']} with points that need manual grading"
    )
    paragraphs = page.texts("//section[@id='grades']/p")
    assert len(paragraphs) == 4
    assert all(paragraph in printed for paragraph in paragraphs)
    assert [int(count) for count in page.texts("//span[@class='bar-count']")] == statistics["tenths"]
    assert [len(page.members(f"grade-{tenth}")) for tenth in range(10)] == statistics["tenths"]
    rows = {row["criterion"].split()[0]: row for row in page.table("criteria")}
    assert rows.keys() == {row["id"] for row in statistics["criteria"]}
    for row in statistics["criteria"]:
        shown = rows[row["id"]]
        assert (shown["passed"], shown["carried"]) == (str(row["passed"]), str(row["carried"]))
        assert shown["of"] == "14"
        line = f"{row['id']} {row['max_points']:g} {row['passed']} {row['carried']} 14 {shown['share']} {shown['discrimination']}"
        assert line.removesuffix(" low").strip() in printed
        assert ("low" in shown["discrimination"]) == ((row["discrimination"] or 1) < 0.2)
    mistakes = page.texts("//section[@id='mistakes']//li")
    assert mistakes == [f"{row['count']} {row['criterion']}: {row['message']}" for row in statistics["failures"]]
    for number, row in enumerate(statistics["failures"]):
        assert len(page.members(f"mistake-{number}")) == row["count"]


def test_the_page_shows_edits_and_identical_work(top: Path) -> None:
    """Each edit with a picture of a robot that needs it, and each group with links to its pages."""
    grader("export", "html", "--gradebook", top / "g.db", "--output", top / "pages")
    page, found = ClassPageReader(top / "pages/index.html"), data(top)
    stated = grader("stats", "--gradebook", top / "g.db").stdout
    printed = " ".join(stated.split())
    assert len(found["fixes"]) > 2
    titles = page.texts("//article/h3")
    for number, (fix, gain) in enumerate(zip(found["fixes"], page.texts("//article/p"), strict=True)):
        assert titles[number] == fix["action"][:1].upper() + fix["action"][1:]
        assert gain.startswith(f"{fix['count']} student{'s' * (fix['count'] > 1)}: ")
        assert gain.partition(": ")[2] in printed
        assert len(page.members(f"edit-{number}")) == fix["count"]
    lines = page.texts("//article/pre/*")
    assert lines
    assert all(line in printed for line in lines)
    assert page.members("edit-0") == ["Ash Tree", "Birch Tree", "Cedar Tree"]
    (lidar,) = page.root.xpath("//article[1]//*[local-name()='svg']")
    assert [path.get("class") for path in lidar.iter("path")].count("reference") == 1
    same = "the same file: Ash Tree (ash) and Cedar Tree (cedar)"
    assert page.texts("//section[@id='identical']//li") == [
        f"3 students: Ash Tree ash, Birch Tree birch, Cedar Tree cedar (the same robot; {same})"
    ]
    assert page.root.xpath("//section[@id='identical']//a/@href") == ["ash.html", "birch.html", "cedar.html"]
    assert page.texts("//section[@id='identical']/p")[0] in printed
