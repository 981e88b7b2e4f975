"""`grader rubric review`: what stands out in the results of a class."""

from pathlib import Path

import pytest

from grader.classroom.results.results import Results
from tests.classroom.gradebooks import grader
from tests.samples import ROOT

pytestmark = pytest.mark.slow

URDF = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
LOW = ("0.15 0 0.225", "0.15 0 0.2")


def reviewed(top: Path, **robots: str) -> str:
    """Grade single URDFs as a class, and return what the review prints."""
    (top / "class").mkdir()
    for name, urdf in robots.items():
        (top / f"class/{name}.urdf").write_text(urdf, encoding="utf-8")
    done = grader("batch", top / "class", "--gradebook", top / "book", "--jobs", 1)
    assert done.returncode == 0, done.stderr
    done = grader("rubric", "review", top / "book")
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_criteria_that_all_pass_or_fail_are_listed(tmp_path: Path) -> None:
    """With the most common mistake; what only some fail is not listed."""
    lower, blue = URDF.replace(*LOW), URDF.replace("0 0.6 0 1", "0 0 0.6 1")
    text = reviewed(
        tmp_path, ann=lower, bob=blue.replace(*LOW), eve=lower.replace("<!--", "<!-- x")
    )
    failing, passing = text.split("All submissions pass.")
    assert failing.startswith("lab6: 3 submissions graded\n\nAll submissions fail.")
    assert "\n  lidar-frame: " in failing
    assert "(3 students)" in failing
    assert "urdf-loads" in passing
    assert "base-green" not in text


def test_equal_robots_with_other_results_are_listed(tmp_path: Path) -> None:
    """Such as after one of them was graded by another release."""
    lower = URDF.replace(*LOW)
    reviewed(tmp_path, ann=lower, bob=lower.replace("<!--", "<!-- mine"))
    results = tmp_path / "book/results.jsonl"
    stored = Results(results).of("bob")
    assert stored is not None
    points, _, *more = stored.results["base-green"]
    other = stored._replace(results={**stored.results, "base-green": (points, "failed", *more)})
    data = results.read_bytes()
    assert stored.line in data
    results.write_bytes(data.replace(stored.line, other.line))
    done = grader("rubric", "review", tmp_path / "book")
    assert "\n  ann and bob (the same robot): base-green\n" in done.stdout


def test_what_needs_manual_grading_is_counted(tmp_path: Path) -> None:
    """Of a submission that has no package, that of the others."""
    mesh = '<mesh filename="package://my_robot/meshes/ball.stl"/>'
    wheel = URDF.replace('<sphere radius="0.05"/>', mesh)
    assert wheel != URDF
    text = reviewed(tmp_path, ann=wheel, bob=wheel, eve=URDF)
    assert "Most often left to manual grading:\n  2 of 3: " in text


def test_a_small_class_has_nothing_that_stands_out(tmp_path: Path) -> None:
    """Two submissions say nothing about a criterion."""
    text = reviewed(tmp_path, ann=URDF, bob=URDF.replace(*LOW))
    assert "Nothing stands out" in text
