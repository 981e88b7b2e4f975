"""What `batch` says about the folders of a class: other labs, other assignments, templates, and columns of a roster."""

import json
import shutil
from pathlib import Path

import pytest

from tests.command_line import ROOT, run

ROBOT = ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf"


def submit(top: Path, *folders: str) -> None:
    """Write a robot into each of these folders of a class; a name that ends in `.md` becomes a file of answers instead."""
    for folder in folders:
        place = top / "class" / folder
        place.parent.mkdir(parents=True, exist_ok=True)
        if place.suffix == ".md":
            place.write_text("Task 1 step 15: It vanishes.\n")
        else:
            place.mkdir()
            shutil.copy(ROBOT, place)


def batch(top: Path, *options: str | Path) -> str:
    """Grade the class, and return the messages."""
    (top / "g.db").unlink(missing_ok=True)
    done = run(("batch", top / "class", "--gradebook", top / "g.db", *options))
    assert done.returncode == 0, done.stderr
    return " ".join(done.stderr.decode().split())


def scores(top: Path) -> dict[str, int | None]:
    """Return the points of every student in the gradebook."""
    data = json.loads(run(("export", "json", "--gradebook", top / "g.db")).stdout)
    return {student["id"]: student["score"] for student in data["students"]}


TEAMS = ("--layout", "teams")


@pytest.mark.parametrize("own", [(), ("red/Lab6/ann/a.md", "red/Lab6/bob/b.md"), ("red/Lab6/README.md",)])
def test_a_team_whose_robots_are_in_the_folder_of_another_lab(tmp_path: Path, own: tuple[str, ...]) -> None:
    """The robots in another lab's folder are graded, as by `grade`, and the message names the folder; a final project does not count."""
    submit(tmp_path, *own, "red/Lab5/ann", "red/Lab5/bob", "red/FinalProject/ann", "blue/Lab6/cal", "blue/Lab5/cal")
    said = batch(tmp_path, *TEAMS)
    assert "red/Lab5: another lab is graded, because there is no robot in the folder of this lab" in said
    assert scores(tmp_path) == {"red/ann": 70, "red/bob": 70, "blue/cal": 70}


def test_the_folder_of_this_lab_counts_if_it_has_a_robot(tmp_path: Path) -> None:
    """Another lab's folder is not searched then."""
    submit(tmp_path, "red/Lab6/ann", "red/Lab6/bob/b.md", "red/Lab5/ann", "red/Lab5/bob")
    assert "another lab" not in batch(tmp_path, *TEAMS)
    assert scores(tmp_path) == {"red/ann": 70, "red/bob": 0}


def test_a_repository_without_a_folder_of_any_lab(tmp_path: Path) -> None:
    """A repository without a lab's folder is reported and is no student with 0; one with a robot or a lab's folder is a submission."""
    submit(tmp_path, "red/Lab6/ann", "red/Lab6/bob", "green/docs/notes.md", "joint/robot", "late/Lab6/answers.md")
    said = batch(tmp_path, *TEAMS)
    assert "green has no folder 'Lab6', no folder of another lab and no robot" in said
    assert scores(tmp_path) == {"red/ann": 70, "red/bob": 70, "joint": 70, "late": 0}
    (tmp_path / "roster.csv").write_text("id,group\nann,green\n")
    assert "green has no folder" not in batch(tmp_path, *TEAMS, "--roster", tmp_path / "roster.csv", "--add")
    assert scores(tmp_path)["ann"] == 0


def test_nbgrader_says_which_assignment_it_took(tmp_path: Path) -> None:
    """`batch` names the assignment that it grades if there are several and none was given."""
    submit(tmp_path, "submitted/ann/lab6", "submitted/bob/lab6")
    assert "is graded; to grade" not in batch(tmp_path)
    submit(tmp_path, "submitted/ann/ps1", "submitted/ann/ps2")
    assert "the assignment lab6 is graded; to grade ps1 and ps2, add --assignment" in batch(tmp_path)
    assert "is graded; to grade" not in batch(tmp_path, "--assignment", "lab6")


def test_a_possible_template(tmp_path: Path) -> None:
    """Without a roster it is graded, and mentioned; with one it is ignored."""
    submit(tmp_path, "lab6-alice", "lab6-template")
    assert "lab6-template may be a template of the course: graded like a student's" in batch(tmp_path)
    assert scores(tmp_path) == {"alice": 70, "template": 70}
    (tmp_path / "roster.csv").write_text("login\nalice\n")
    assert "lab6-template is a folder of the course" in batch(tmp_path, "--roster", tmp_path / "roster.csv")
    assert scores(tmp_path) == {"alice": 70}


@pytest.mark.parametrize(
    ("header", "row", "key"),
    [
        ("ID-Nummer,Name", "u7,alice", "u7"),
        ("Nombre,Apellido(s),Dirección de correo", "Al,Ash,alice@x.org", "alice@x.org"),
    ],
)
def test_columns_of_a_roster(tmp_path: Path, header: str, row: str, key: str) -> None:
    """Moodle's names in other languages are known."""
    submit(tmp_path, "alice")
    (tmp_path / "roster.csv").write_text(f"{header}\n{row}\n", encoding="utf-8")
    batch(tmp_path, "--roster", tmp_path / "roster.csv")
    assert scores(tmp_path) == {key: 70}
