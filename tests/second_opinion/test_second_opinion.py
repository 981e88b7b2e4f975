"""A checker that shares no code with the grader decides the geometric criteria of the shipped rubrics in the same way."""

import ast
from collections.abc import Iterable
from pathlib import Path

import pytest

from grader.lab.submission.edited import content
from grader.ros.package.robot_file import Read
from tests.examples import spread
from tests.samples import SAMPLES
from tests.second_opinion.compare import (
    Comparison,
    as_ros_reads_it,
    compared,
    compared_mutants,
    compared_seeds,
    summary,
)
from tests.second_opinion.opinion import Rubric

pytestmark = pytest.mark.slow

CHECKER = (
    "elements",
    "robot",
    "geometry",
    "posed",
    "tree_facts",
    "body_facts",
    "place_facts",
    "motion_facts",
    "facts",
    "opinion",
)
LIBRARIES = {
    "collections",
    "copy",
    "dataclasses",
    "itertools",
    "math",
    "numpy",
    "pathlib",
    "re",
    "tomllib",
    "typing",
    "xml",
}
PART = 120


def assert_alike(comparisons: Iterable[Comparison], least: int) -> None:
    """Assert that nothing differs, and that at least so many criteria are compared."""
    found = list(comparisons)
    lines, different = summary(found)
    assert different == 0, "\n".join(lines)
    assert sum(one.counts["same value"] + one.counts["same status"] for one in found) >= least, (
        lines[0]
    )


def test_the_checker_shares_no_code_with_the_grader() -> None:
    """It imports numpy, the standard library and itself."""
    for name in CHECKER:
        tree = ast.parse(Path(__file__).with_name(f"{name}.py").read_text(encoding="utf-8"))
        imported = {
            alias.name
            for node in ast.walk(tree)
            if isinstance(node, ast.Import)
            for alias in node.names
        }
        imported |= {
            str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)
        }
        own = {f"tests.second_opinion.{module}" for module in CHECKER} | {"tests.second_opinion"}
        assert {module.partition(".")[0] for module in imported - own} <= LIBRARIES, name


def test_most_criteria_have_a_second_opinion() -> None:
    """Of those that need a URDF only the elements for Gazebo have none: 32 of 32, 55 of 55, 18 of 34."""
    assert [len(Rubric(name).rows) for name in ("lab6", "arm", "sensors")] == [32, 55, 18]


@pytest.mark.parametrize("part", spread(range(12), 1))
def test_random_robots(part: int) -> None:
    """Status, carried points and measured values of random robots are the same."""
    assert_alike(compared_seeds(range(part * PART, (part + 1) * PART)), 3_000)


@pytest.mark.parametrize(
    "rubric",
    [pytest.param(name, marks=pytest.mark.exhaustive) for name in ("lab6", "arm", "sensors")],
)
def test_many_mutants(rubric: str) -> None:
    """Mutants of the reference that `grader rubric test` grades get the same results: every fourth of all."""
    assert_alike(compared_mutants(rubric, step=4), 500)


@pytest.mark.exhaustive
def test_all_samples() -> None:
    """All samples whose URDF is plain XML get the same results."""
    found = []
    for name, sample in SAMPLES.items():
        urdf = sample.open().urdf
        if isinstance(urdf, Read) and not urdf.is_expanded:
            text = content(sample.open(), urdf.path)
            assert text is not None
            report = sample.grade()
            results = as_ros_reads_it(report, report.submission)
            found.append(compared(name, sample.expected.rubric, text, results))
    assert_alike(found, 3_000)
    assert len(found) > 150
