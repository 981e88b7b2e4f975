"""grader rubric test: the reference and its equivalents lose nothing, mutants something, samples what they say."""

import json
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.lab.authoring.mutants import Mutant
from grader.lab.authoring.rubric_test import MutantOutcome, Trial, run_rubric_test
from grader.lab.checks.outcome import Outcome, judged
from grader.lab.checks.registry import find_check
from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
from grader.report.writers.rubric_test_result import render_rubric_test
from grader.ros.urdf.kinematics import Configuration
from tests.authoring.robots import TOP, write_rubric
from tests.command_line import Done, run
from tests.samples import SAMPLES

LINKS = '<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
SMALL = f'<robot name="r">{LINKS}<origin xyz="1 2 3" rpy="0.1 0.2 0.3"/></joint></robot>'
EXACT = """\
[[criterion]]
id = "frame"
part = "model"
title = "The frame is there"
points = 1
check = "frame_at"
with = { link = "b", relative_to = "a", xyz = [1, 2, 3], rpy = [0.1, 0.2, 0.3], tolerance = 0.002, angle = 1 }
"""


def command(*arguments: object) -> Done:
    """Run the command."""
    return run(("rubric", "test", *arguments))


def data(*arguments: object) -> dict[str, Any]:
    """Return the result as JSON, valid under its schema."""
    found: dict[str, Any] = json.loads(command(*arguments, "--format", "json").stdout)
    jsonschema.validate(found, json.loads(run(("schema", "rubric-test")).stdout))
    return found


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_shipped_rubric_catches_every_mutant(name: str) -> None:
    """Or says in the rubric why not; no criterion is idle, no pattern unused, no correct robot loses points, no sample differs."""
    found = data(name, f"submissions/{name}")
    assert (found["score"], found["survivors"], found["idle"], found["unused_patterns"]) == (
        100,
        [],
        [],
        [],
    )
    assert found["equivalents"]["lost"] == found["reference"]["lost"] == []
    assert len(found["equivalents"]["tried"]) >= 6
    if name != "rover":  # which leaves sizes, masses and places to the student
        assert found["mutants"]["caught"] > 5 * len(found["ignored"])
    own = sum(sample.expected.rubric == name for sample in SAMPLES.values())
    assert own
    assert found["samples"] == {"tried": own, "skipped": 0, "different": []}


@pytest.mark.slow
def test_an_interrupted_test_has_the_score_so_far(tmp_path: Path) -> None:
    """What is left is counted, and nothing is said about criteria and files that were not tried."""
    rubric = load_rubric(write_rubric(tmp_path, TOP + EXACT, SMALL))
    trial = Trial(rubric)

    def graded(mutants: Sequence[Mutant]) -> Iterator[MutantOutcome]:
        yield from map(trial.outcome, mutants[:3])
        raise KeyboardInterrupt

    result = run_rubric_test(rubric, None, lambda *_: None, graded)
    text = render_rubric_test(result, 80)
    assert (result.tried, result.is_interrupted) == (3, True)
    assert f"Interrupted: {result.total - 3} mutants and the equivalents are left." in text
    assert "Mutation score so far:" in text
    assert not any(word in text for word in ("Idle", "No criterion", "Equivalents"))


def test_an_interrupt_before_the_first_mutant_ends_the_test(tmp_path: Path) -> None:
    """There is no score yet."""
    rubric = load_rubric(write_rubric(tmp_path, TOP + EXACT, SMALL))

    def graded(mutants: Sequence[Mutant]) -> Iterator[MutantOutcome]:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_rubric_test(rubric, None, lambda *_: None, graded)


@pytest.mark.slow
def test_survivors_are_listed_with_their_diff(tmp_path: Path) -> None:
    """The exit code is 0 because no correct robot loses points."""
    done = command(write_rubric(tmp_path))
    text = done.stdout.decode()
    assert done.returncode == 0
    assert "\nThese mutants of the reference get full marks:\n" in text
    assert re.search(r"\n  \.\.\. and \d+ more, which --format json lists", text)
    assert "      --- birch.urdf\n      +++ birch.urdf\n      @@ -" in text
    arm = data(tmp_path / "arm.toml")
    listed = {row["id"]: row for row in arm["survivors"]}
    row = listed["number x10: joint base_plate/origin xyz.z"]
    assert (
        '-    <origin xyz="0 0 0.11" rpy="0 0 3.14159"/>\n+    <origin xyz="0 0 1.1" rpy="0 0 3.14159"/>'
        in row["diff"]
    )
    assert (row["path"], row["line"]) == ("birch.urdf", 25)
    assert "number x10: joint tool_joint/origin xyz.z" not in listed  # tool-frame catches it
    assert "number negated: joint tool_joint/origin xyz.x" not in listed  # -0 is the same robot
    counts = arm["mutants"]
    assert (
        counts["tried"]
        == counts["caught"] + counts["same_robot"] + counts["ignored"] + counts["survived"]
    )
    assert arm["score"] == pytest.approx(
        100 * counts["caught"] / (counts["caught"] + counts["survived"]), abs=1e-6
    )


def test_an_equivalent_that_loses_points_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A check that looks at the numbers of a file, not at the robot, is found out."""

    def is_written(robot: Configuration, *, link: str, **_: Any) -> Outcome:
        joint = robot.parent_joints.get(link)
        rpy = (
            joint.origin.rpy if joint is not None and joint.origin is not None else (0.0, 0.0, 0.0)
        )
        return judged(rpy == (0.1, 0.2, 0.3), f"the rpy is {rpy[0]:.2f}")

    frame_at = find_check("frame_at")
    assert frame_at is not None
    textual = frame_at._replace(function=is_written)
    monkeypatch.setattr(
        "grader.lab.rubric.validation.find_check",
        lambda name: textual if name == "frame_at" else find_check(name),
    )
    done = command(write_rubric(tmp_path, TOP + EXACT, SMALL))
    assert done.returncode == 1
    text = done.stdout.decode()
    assert (
        "These equivalents of the reference lose points:\n\n  fixed joints split\n    frame: the rpy is"
        in text
    )
    assert '-    <origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>' in text


def test_a_check_that_is_faulty_on_a_mutant_is_not_a_catch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is named with the mutant, and the exit code is 3."""

    def divides(robot: Configuration, *, link: str, **_: Any) -> Outcome:
        origin = robot.parent_joints[link].origin
        assert origin is not None
        return judged(1 / origin.xyz[0] > 0, "it is ahead")

    frame_at = find_check("frame_at")
    assert frame_at is not None
    plain = frame_at._replace(function=divides)
    monkeypatch.setattr(
        "grader.lab.rubric.validation.find_check",
        lambda name: plain if name == "frame_at" else find_check(name),
    )
    found = data(write_rubric(tmp_path, TOP + EXACT, SMALL))
    assert "number zero: joint j/origin xyz.x" in [row["name"] for row in found["faults"]]
    assert all(
        row["criteria"]["frame"].startswith("the grader itself failed") for row in found["faults"]
    )
    counts = found["mutants"]
    others = counts["caught"] + counts["same_robot"] + counts["ignored"] + counts["survived"]
    assert counts["tried"] == others + len(found["faults"])
    done = command(tmp_path / "arm.toml")
    assert done.returncode == 3
    assert "On these mutants a check is faulty:\n\n  " in done.stdout.decode()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("check", "changed"),
    [
        ('check = "urdf_loads"', {"robot.urdf"}),
        ('check = "package_found"\nwith = { name = "ash" }', {"robot.urdf", "package.xml"}),
        ('check = "setup_imports"', {"robot.urdf", "package.xml", "setup.py"}),
    ],
)
def test_a_package_is_changed_as_far_as_criteria_look(
    tmp_path: Path, check: str, changed: set[str]
) -> None:
    """A rubric of the robot is not tested with mistakes in setup.py, and one that wants the package's name only with that."""
    package = tmp_path / "ash"
    package.mkdir()
    (package / "robot.urdf").write_text(SMALL)
    texts = "<name>ash</name><version>0.1.0</version><description>An arm</description><license>MIT</license>"
    person = '<maintainer email="me@example.org">Me</maintainer>'
    (package / "package.xml").write_text(f'<package format="3">{texts}{person}</package>')
    (package / "setup.py").write_text("from setuptools import setup\nsetup(name='ash')\n")
    top = TOP.replace("birch.urdf", "ash").replace(
        'title = "An arm"', 'title = "An arm"\npackage = "ash"\nurdf = "robot.urdf"'
    )
    text = f'{top}[[criterion]]\nid = "other"\npart = "model"\ntitle = "Another"\npoints = 1\n{check}\n'
    found = data(
        write_rubric(tmp_path, text + '[[test.ignore]]\nmutants = ["*"]\nreason = "All."\n')
    )
    assert found["reference"]["lost"] == []
    assert {row["path"] for row in found["ignored"]} <= changed
    without = data(write_rubric(tmp_path, top))["mutants"]["total"]
    assert (found["mutants"]["total"] > without) == (len(changed) > 1)
