"""A class seen truly, through the command line: undecided points, causes, identical work, and the course's own folders."""

import json
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
