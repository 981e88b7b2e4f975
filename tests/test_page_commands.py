"""The command lines on the pages can be run as they are written, in a folder with the files that the pages presume.

The tutorial and the walk-through of a class are followed by tests of their own, which compare the outputs too.
"""

import re
import shutil
from pathlib import Path

import pytest

from tests.command_line import ROOT, run_with_input
from tests.tutorial import PAGE as TUTORIAL
from tests.tutorial import run_commands

pytestmark = pytest.mark.exhaustive

PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
OTHER_FILES = {  # what only these pages presume, and what it is
    "grade-one-submission.md": {"arm.urdf": "rubrics/arm/arm.urdf"},
    "gradescope.md": {"my_lab.toml": "rubrics/arm/rubric.toml"},
    "rubric-test.md": {"my_lab.toml": "rubrics/arm/rubric.toml"},
}
ELSEWHERE = {  # beginnings of command lines that are run by another test, or not by any
    "grader batch submissions/class/files": "test_submissions.py",
    "grader batch submissions --roster canvas.csv": "classroom/test_walkthrough.py",
    'grader mark "Anik Tagrigri"': "classroom/test_walkthrough.py",
    "grader mark 100099": "classroom/test_walkthrough.py",
    "grader review --by": "a browser: browser/test_review.py",
    "grader explain distance_between": "a plug-in: cli/test_plugin_template.py",
    "grader rubric check arm_lab.toml": "a plug-in: cli/test_plugin_template.py",
}
CODES = {"grader grade ": 1}  # the robot has a mistake
FOLDERS = dict.fromkeys(("grader grade . ", "grader grade  "), "src/my_robot")  # a student's repository
STUDENTS = ("alice", "bob", "carol", "dave")
CANVAS = "Student,ID,SIS User ID,SIS Login ID,Section,Lab 6 (12345)\n    Points Possible,,,,,100\n"


@pytest.fixture(scope="module")
def presumed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a robot, a package, a rubric and a class of four students with a gradebook."""
    folder = tmp_path_factory.mktemp("presumed")
    shutil.copy(ROOT / "submissions/lab6/lidar-offset-in-visual/my_robot/urdf/my_robot.urdf", folder)
    shutil.copytree(ROOT / "rubrics/lab6/my_robot", folder / "src/my_robot")
    for path in folder.glob("src/my_robot/urdf/*.urdf"):
        shutil.copy(folder / "my_robot.urdf", path)
    shutil.copy(ROOT / "rubrics/arm/arm.urdf", folder / "solution.urdf")
    shutil.copy(ROOT / "rubrics/arm/arm.urdf", folder)
    shutil.copytree(ROOT / "submissions/arm/axis-sign", folder / "samples/arm-axis-sign")
    (folder / "submissions").mkdir()
    for number, student in ((1, "alice"), (2, "bob"), (4, "dave")):  # as Canvas names them
        shutil.make_archive(
            str(folder / f"submissions/example{student}_{number}_50{number}_lab6"), "zip", folder / "src"
        )
    roster = "id,name,canvas id,participant id,section,marker\n"
    rows = CANVAS
    for number, student in enumerate(STUDENTS, start=1):
        roster += f"{student},{student.title()} Example,{number},{100 + number},Lab A,Kim\n"
        rows += f'"Example, {student.title()}",{number},{student},{student},Lab A,\n'
    (folder / "roster.csv").write_text(roster, encoding="utf-8")
    (folder / "canvas.csv").write_text(rows, encoding="utf-8")
    marks = "student,criterion,points,comment\nalice,answer-floating-link,2,short\n"
    (folder / "marks.csv").write_text(marks, encoding="utf-8")
    (folder / "marks.txt").write_text("0\n", encoding="utf-8")
    shutil.make_archive(str(folder / "submissions"), "zip", folder / "submissions")
    for _ in range(2):  # `diff` compares two runs
        done = run_with_input(("batch", "submissions", "--roster", "roster.csv", "--force"), b"", folder=folder)
        assert done.returncode == 0, done.stderr
    return folder


def blocks(page: Path) -> list[list[str]]:
    """Return the lines of each `sh` block of a page that is not followed by another test, in which the grader is called."""
    found = re.findall(r"^ *```sh\n(.*?)^ *```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    lines = [[line.strip() for line in block.splitlines()] for block in found]
    return [block for block in lines if any(line.startswith("grader ") for line in block)]


WITH_COMMANDS = [page for page in PAGES if page != TUTORIAL and blocks(page)]


@pytest.mark.parametrize("page", WITH_COMMANDS, ids=lambda page: page.name)
def test_every_command_line_of_a_page_works(page: Path, presumed: Path, tmp_path: Path) -> None:
    """Each exit code is the expected one, and nothing is refused."""
    folder = tmp_path / "folder"
    shutil.copytree(presumed, folder)
    for name, source in OTHER_FILES.get(page.name, {}).items():
        shutil.copy(ROOT / source, folder / name)
    for block in blocks(page):
        for line in block:
            if line.startswith(tuple(ELSEWHERE)) or not line.startswith(("grader ", "printf ")):
                continue
            inside = next((inside for beginning, inside in FOLDERS.items() if line.startswith(beginning)), "")
            printed, code = run_commands(line, folder / inside)
            expected = next((code for beginning, code in CODES.items() if line.startswith(beginning)), 0)
            assert code == expected, (line, printed)


def test_every_exception_is_on_a_page() -> None:
    """The tables name command lines that exist."""
    lines = [line for page in WITH_COMMANDS for block in blocks(page) for line in block]
    for beginning in (*ELSEWHERE, *CODES, *FOLDERS):
        assert any(line.startswith(beginning) for line in lines), beginning
