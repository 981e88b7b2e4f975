"""Labs of other courses: correct robots keep full marks, and wrong robots lose what they should."""

import csv
import json
import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from shutil import copytree
from typing import Any, NamedTuple

import pytest

from grader.lab.authoring.rubric_test import Trial, run_rubric_test
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.submission.opening import open_submission
from tests.command_line import run
from tests.examples import spread

FOLDER = Path(__file__).parent
LABS = sorted(path.parent.name for path in FOLDER.glob("*/rubric.toml"))
every_lab = pytest.mark.parametrize("lab", LABS)


class Robot(NamedTuple):
    """A row of robots.toml: a robot as changes of the reference, or as a whole URDF."""

    lab: str
    kind: str
    name: str
    row: dict[str, Any]

    def write(self, folder: Path) -> Path:
        """Write the robot below a folder and return the path of the submission."""
        rubric = rubric_of(self.lab)
        reference = rubric.path.parent / rubric.reference
        path = folder / str(self.row.get("path", reference.name))
        if reference.is_dir():
            copytree(reference, path)
        else:
            path.write_text(reference.read_text())
        graded = path / rubric.urdf if reference.is_dir() else path
        if "urdf" in self.row:
            graded.write_text(self.row["urdf"])
        if "changes" in self.row:
            file = path / self.row["file"] if "file" in self.row else graded
            file.write_text(changed(file.read_text(), self.row["changes"]))
        for old, new in self.row.get("renamed", {}).items():
            (path / new).parent.mkdir(exist_ok=True)
            (path / old).rename(path / new)
        for name in self.row.get("removed", ()):
            (path / name).unlink()
        return path


def changed(text: str, changes: list[list[str]]) -> str:
    """Return a text after changes [after, old, new], each of which must find its text."""
    for after, old, new in changes:
        assert old != new
        if after == "*":
            assert old in text, old
            text = text.replace(old, new)
        else:
            assert after in text, after
            start = text.index(old, text.index(after))
            text = text[:start] + new + text[start + len(old) :]
    return text


@cache
def rubric_of(lab: str) -> Rubric:
    """Return the rubric of a lab."""
    return load_rubric(str(FOLDER / lab / "rubric.toml"))


def robots() -> Iterator[Robot]:
    """Yield the robots of all labs."""
    for lab in LABS:
        for kind, rows in tomllib.loads((FOLDER / lab / "robots.toml").read_text()).items():
            for name, row in rows.items():
                yield Robot(lab, kind, name, row)


ROBOTS = list(robots())


def graded(robot: Robot, folder: Path) -> Report:
    """Return the report of a robot."""
    rubric = rubric_of(robot.lab)
    path = str(robot.write(folder))
    return grade(rubric, open_submission(path, rubric.lab))


@cache
def reference_pending(lab: str) -> frozenset[str]:
    """Return the criteria that need manual grading on the reference: the inertia of a mesh."""
    rubric = rubric_of(lab)
    assert rubric.solution is not None
    results = grade(rubric, rubric.solution.submission).results
    assert {result.outcome.status for result in results} <= {"passed", "pending"}
    return frozenset(
        result.criterion.id for result in results if result.outcome.status == "pending"
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "robot", spread(ROBOTS, 80), ids=lambda robot: f"{robot.lab}-{robot.kind}-{robot.name}"
)
def test_a_robot_loses_what_it_should(robot: Robot, tmp_path: Path) -> None:
    """A correct robot loses nothing, a wrong one exactly the expected criteria, and nothing is errored."""
    report = graded(robot, tmp_path)
    outcomes = {result.criterion.id: result.outcome for result in report.results}
    statuses = {name: outcome.status for name, outcome in outcomes.items()}
    lost = {
        name: outcomes[name].message for name in outcomes if statuses[name] in ("failed", "skipped")
    }
    assert set(lost) == set(robot.row.get("lost", ())), lost
    pending, manual = (
        {name for name in outcomes if statuses[name] == "pending"},
        reference_pending(robot.lab),
    )
    assert pending == set(robot.row.get("pending", manual))
    assert "errored" not in statuses.values(), lost
    assert bool(lost or pending - manual) == (robot.kind == "wrong")


@pytest.mark.exhaustive
def test_a_lab_for_lyrical_gives_the_same_marks(tmp_path: Path) -> None:
    """No robot of a lab, correct or wrong, uses what one of Jazzy and Lyrical lacks."""
    differing = []
    for number, robot in enumerate(ROBOTS):
        folder = tmp_path / str(number)
        folder.mkdir()
        path, rubric = str(robot.write(folder)), rubric_of(robot.lab)
        outcomes = []
        for distro in ("jazzy", "lyrical"):
            lab = replace(rubric, distro=distro)
            report = grade(lab, open_submission(path, lab.lab))
            outcomes.append([(row.criterion.id, row.outcome, row.points) for row in report.results])
        if outcomes[0] != outcomes[1]:
            differing.append((robot.lab, robot.name))
    assert differing == []


@every_lab
def test_a_lab_has_enough_robots(lab: str) -> None:
    """At least six correct robots and twenty-five wrong ones."""
    kinds = [robot.kind for robot in ROBOTS if robot.lab == lab]
    assert kinds.count("correct") >= 6
    assert kinds.count("wrong") >= 25
    assert set(kinds) == {"correct", "wrong"}


@every_lab
def test_every_criterion_is_lost_by_some_robot(lab: str) -> None:
    """No criterion of a rubric is idle."""
    lost = {name for robot in ROBOTS if robot.lab == lab for name in robot.row.get("lost", ())}
    assert {criterion.id for criterion in rubric_of(lab).criteria} <= lost


@every_lab
def test_a_rubric_passes_its_check(lab: str) -> None:
    """`grader rubric check` accepts the rubric, and the reference gets full marks, except for what a mesh leaves open."""
    done = run(["rubric", "check", FOLDER / lab / "rubric.toml"])
    named = re.findall(r"(\S+) fails on the reference:", done.stdout.decode())
    assert (named, done.stderr) == (["palm-inertia"] if lab == "gripper" else [], b"")
    assert done.returncode == bool(named)


@pytest.mark.exhaustive
@every_lab
def test_mutants_of_a_reference_lose_something(lab: str) -> None:
    """No mistake costs nothing, unless the rubric says why, and no equivalent costs something; `grader rubric test` tries all."""
    rubric = rubric_of(lab)
    trial = Trial(rubric)
    found = run_rubric_test(
        rubric, None, lambda *_: None, lambda every: map(trial.outcome, every[::20])
    )
    assert found.losses == []
    assert [survivor.mutant.id for survivor in found.survivors] == []
    assert found.caught >= 20


@pytest.mark.slow
def test_a_class_is_graded_with_its_reference(tmp_path: Path) -> None:
    """`grader batch` gives the marks of `grade`: its workers compare the motion with that of the reference, too."""
    chosen = [robot for robot in ROBOTS if robot.lab == "industrial"][::4]
    expected = {}
    for robot in chosen:
        folder = tmp_path / "class" / robot.name
        folder.mkdir(parents=True)
        path = robot.write(folder)
        done = run(["grade", path, "--rubric", rubric_of(robot.lab).path, "--format", "json"])
        report = json.loads(done.stdout)
        assert done.returncode == (robot.kind == "wrong")
        expected[robot.name] = report["score"]
        assert (report["score"] == report["max_score"]) == (robot.kind == "correct")
    words = [
        "--rubric",
        rubric_of("industrial").path,
        "--gradebook",
        tmp_path / "marks",
    ]
    done = run(["batch", tmp_path / "class", *words, "--jobs", "2"])
    assert done.returncode == 0, done.stderr.decode()
    with (tmp_path / "marks/grades.csv").open(newline="") as file:
        marks = {row["id"]: float(row["score"]) for row in csv.DictReader(file)}
    assert marks == expected
