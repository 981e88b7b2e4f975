"""If there is a next step, the message says what to type."""

import re
import shutil
from pathlib import Path

import pytest

from grader.cli.app import COMMANDS
from tests.command_line import Done, run_with_input
from tests.samples import ROOT

SAMPLE = ROOT / "submissions/lab6/lidar-offset-in-visual/my_robot/urdf/my_robot.urdf"
PACKAGE = "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"
BATCH = "grader batch PATH --gradebook book.db"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Return a folder with a URDF, a class of one, a text and a package."""
    shutil.copy(SAMPLE, tmp_path / "my_robot.urdf")
    (tmp_path / "class" / "anna").mkdir(parents=True)
    shutil.copy(SAMPLE, tmp_path / "class" / "anna")
    shutil.copytree(ROOT / PACKAGE, tmp_path / "package")
    (tmp_path / "notes.txt").write_text("no gradebook, and long enough to be taken for something\n" * 20)
    (tmp_path / "empty").mkdir()
    return tmp_path


def typed(line: str, path: Path) -> Done:
    """Run a line as if it were typed there."""
    return run_with_input(line.split(), b"", folder=path)


def refused(line: str, path: Path) -> str:
    """Return the last line of a command that fails."""
    done = typed(line, path)
    assert (done.returncode, done.stdout) == (2, b"")
    message = done.stderr.decode().splitlines()[-1]
    assert message.startswith("grader: ")
    return message.removeprefix("grader: ")


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("my_robot.urdf", "there is no command 'my_robot.urdf'; to grade it, use `grader grade my_robot.urdf`"),
        ("grade my_robt.urdf", "my_robt.urdf does not exist; did you mean 'my_robot.urdf'?"),
        ("inspect clas/anna/my_robot.urdf", "did you mean 'class/anna/my_robot.urdf'?"),
        ("grade clas/ben", "clas/ben does not exist; did you mean 'class'?"),
        ("grade nowhere", "nowhere does not exist (relative to the current folder)"),
        (
            "grade my_robot.urdf --rubric lab",
            "did you mean 'lab6'? (`grader rubric list` lists the rubrics that come with the grader)",
        ),
        ("explain lidar-frame --rubric zzz", "write ./zzz for a file (`grader rubric list` lists"),
        ("grade my_robot.urdf --part task", "did you mean 'task3'? (see `grader rubric show lab6`)"),
        ("explain zzz", "`grader rubric show lab6` lists the criteria, `grader rubric checks` lists the checks"),
        ("grade my_robot.urdf --save json=out/a.json", "there is no folder out (create it with `mkdir -p out`)"),
        ("grade my_robot.urdf --score", "(`grader grade --help` shows the usage)"),
        ("rubric shov lab6", "(`grader rubric --help` shows the usage)"),
        ("batch clas --gradebook book.db", "clas does not exist; did you mean 'class'?"),
        ("batch my_robot.urdf --gradebook book.db", "(`grader grade` grades a single one)"),
        ("batch package --gradebook book.db", "(grade it with `grader grade package`)"),
        ("batch empty --gradebook book.db", "name the folder that holds the class's submissions"),
        ("batch class --layout canvas --gradebook book.db", "(without --layout canvas the layout is detected)"),
        ("batch class --layout nbgrader --gradebook book.db", "name the assignment to grade with --assignment"),
        ("batch class --gradebook book.db --csv out/a.csv", "there is no folder out (create it with `mkdir -p out`)"),
        ("batch class --gradebook out/book.db", "there is no folder out (create it with `mkdir -p out`)"),
        ("stats --gradebook notes.txt", "name another file"),
        ("stats --gradebook book.db", f"there is no gradebook book.db: create it with `{BATCH}`"),
        ("export canvas --gradebook book.db", "give it with --into"),
    ],
)
def test_the_next_command_is_named(line: str, why: str, path: Path) -> None:
    """It is on the line that says what is wrong, and every named command exists."""
    message = refused(line, path)
    assert why in message
    assert set(re.findall(r"\bgrader ([a-z]+)", message)) <= set(COMMANDS)


def test_the_next_command_with_a_gradebook(path: Path) -> None:
    """The messages name students, criteria and runs to choose from."""
    assert typed("batch class --gradebook book.db", path).returncode == 0
    for line, why in (
        ("mark zoe lidar-frame 1 --gradebook book.db", "; `grader export csv --gradebook book.db` lists all students"),
        ("mark anna lidar 1 --gradebook book.db", "has no criterion 'lidar' (`grader rubric show lab6` lists them)"),
        ("diff book.db", f"run `{BATCH}` again, or name a second gradebook"),
        ("export csv --gradebook book.db --output out/a.csv", "there is no folder out (create it with `mkdir -p out`)"),
    ):
        assert why in refused(line, path)
