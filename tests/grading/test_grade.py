"""A grade run: which criteria fail, are skipped because of others or need manual grading, and the points."""

from collections.abc import Callable, Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.appearance import shows_box, shows_cylinder
from grader.checks.check import describe
from grader.checks.colours import shows_colour
from grader.checks.heights import bottom_at_height
from grader.checks.motion import rolls_forward, turns_about_itself
from grader.checks.outcome import Outcome, failed, passed
from grader.checks.placement import centre_at, frame_at
from grader.checks.tree import held_by, urdf_loads
from grader.errors import InputError, MissingElement
from grader.grading.criterion import Criterion, Part
from grader.grading.grade import grade
from grader.grading.report import Report
from grader.grading.rubric import Rubric
from grader.robot.kinematics import Configuration
from grader.robot.model import Mesh
from grader.robot.reader import Reading
from grader.robot.shapes import UnknownShape
from grader.submission.opening import read_submission
from tests.checks.outcomes import Arguments
from tests.checks.robots import BASE, LIDAR, MOUNT, PATH, WHEEL, Scene, joint, mesh, rolling, scene
from tests.examples import examples

NOT_XML = Scene("this is no XML <")


def passes_(robot: Configuration) -> Outcome:
    """A check that always passes."""
    return passed("it is so")


def fails_(robot: Configuration) -> Outcome:
    """A check that always fails."""
    return failed("it is not so")


def pends(robot: Configuration) -> Outcome:
    """A check that needs manual grading."""
    raise UnknownShape(Mesh("part.stl"))


def breaks(robot: Configuration) -> Outcome:
    """A check with an error of the grader."""
    raise ZeroDivisionError("a secret detail")


def misses(robot: Configuration, *, what: str) -> Outcome:
    """A check that misses a thing of a name."""
    raise MissingElement("thing", what)


def of_file(urdf: Reading) -> Outcome:
    """A check of the file that always passes."""
    return passed("it is a file")


def ask(
    name: str,
    check: Callable[..., Outcome] = passes_,
    *,
    points: str = "1",
    requires: Sequence[str] = (),
    part: str = "a",
    **arguments: Any,
) -> Criterion:
    """Return a criterion."""
    return Criterion(name, name.title(), part, Decimal(points), describe(check), arguments, tuple(requires))


def run(*criteria: Criterion, on: Scene | None = None, parts: Sequence[str] = ()) -> Report:
    """Return the report on a robot under a rubric with these criteria, in parts a and b."""
    rubric = Rubric("r", "R", (Part("a", "A"), Part("b", "B")), criteria, "robot.urdf", "", b"", Path("r.toml"))
    robot = on if on is not None else scene(BASE)
    return grade(rubric, read_submission(robot.text.encode(), identity="me", path=PATH), parts)


def statuses(report: Report) -> list[str]:
    """Return the status of each criterion, in order."""
    return [result.outcome.status for result in report.results]


def causes(report: Report) -> list[str | None]:
    """Return the cause of each criterion's skip."""
    return [result.because for result in report.results]


def sums(report: Report) -> list[object]:
    """Return the points earned, the maximum, and the pending points."""
    return [report.score, report.max_score, report.pending]


# --- requires ---------------------------------------------------------------------------------------------------------


def test_a_skip_names_the_root_cause() -> None:
    """In a chain of requirements every skip names the criterion that failed, not another skip."""
    report = run(
        ask("one", fails_),
        ask("two", requires=["one"]),
        ask("three", requires=["two"]),
        ask("four", requires=["three"]),
    )
    assert statuses(report) == ["failed", "skipped", "skipped", "skipped"]
    assert causes(report) == [None, "one", "one", "one"]
    assert {result.outcome.message for result in report.results[1:]} == {"skipped because one failed"}


def test_the_first_unmet_requirement_is_named() -> None:
    """Of several failures the first of the list counts."""
    report = run(ask("one", fails_), ask("two", fails_), ask("three"), ask("four", requires=["three", "two", "one"]))
    assert causes(report)[3] == "two"


def test_a_passed_requirement_does_not_skip() -> None:
    """If all required criteria passed, or may still pass, a criterion is graded."""
    report = run(
        ask("one"), ask("two", pends), ask("three", fails_, requires=["one", "two"]), ask("four", requires=["two"])
    )
    assert statuses(report) == ["passed", "pending", "failed", "passed"]
    assert causes(report) == [None] * 4


def test_a_requirement_in_another_part_does_not_skip() -> None:
    """A part that is not graded does not affect others."""
    criteria = (ask("one", fails_), ask("two", part="b", requires=["one"]))
    assert statuses(run(*criteria)) == ["failed", "skipped"]
    assert statuses(run(*criteria, parts=["b"])) == ["passed"]


def test_a_skipped_check_is_not_run() -> None:
    """An error in a check that is skipped does not occur."""
    report = run(
        ask("one", fails_), ask("two", breaks, requires=["one"]), ask("three", misses, what="x", requires=["one"])
    )
    assert statuses(report) == ["failed", "skipped", "skipped"]


# --- Missing elements -------------------------------------------------------------------------------------------------


def test_the_first_criterion_that_misses_a_thing_fails() -> None:
    """Later criteria that miss the same thing are skipped because of it, and say so."""
    report = run(
        ask("one", misses, what="x"), ask("two"), ask("three", misses, what="x"), ask("four", misses, what="x")
    )
    assert statuses(report) == ["failed", "passed", "skipped", "skipped"]
    assert causes(report) == [None, None, "one", "one"]
    assert "there is no thing 'x'" in report.results[0].outcome.message
    assert report.results[2].outcome.message == "skipped because one failed"


def test_each_thing_that_is_missing_fails_once() -> None:
    """Two different missing things are two failures: one defect does not hide another."""
    report = run(*(ask(f"{name}{index}", misses, what=name) for index in (1, 2) for name in "xy"))
    assert statuses(report) == ["failed", "failed", "skipped", "skipped"]
    assert causes(report) == [None, None, "x1", "y1"]


_WHEEL: Arguments = {"link": "wheel", "base": "base"}
_PLACED: Arguments = {"link": "wheel", "relative_to": "base", "xyz": (-0.15, 0.225, 0.0), "tolerance": 0.002}
_LIDAR: Arguments = {"link": "lidar", "relative_to": "base", "xyz": (0.0, 0.0, 0.0), "tolerance": 0.002}
_SHAPE: Arguments = {"radius": 0.1, "length": 0.05, "tolerance": 0.002}
WHOLE = (
    ask("held", held_by, link="lidar", parent="base", joint_type="fixed"),
    ask("shape", shows_cylinder, link="lidar", **_SHAPE),
    ask("frame", frame_at, **_LIDAR),
    ask("back", frame_at, **{**_LIDAR, "link": "base", "relative_to": "lidar"}),
    ask("continuous", held_by, link="wheel", parent="base", joint_type="continuous"),
    ask("wheel", shows_cylinder, link="wheel", **_SHAPE),
    ask("placed", centre_at, **_PLACED),
    ask("forward", rolls_forward, **_WHEEL, tolerance=1.0),
    ask("spins", turns_about_itself, **_WHEEL, tolerance=0.002, angle=1.0),
)


@pytest.mark.parametrize(
    ("robot", "lost", "at"),
    [
        (rolling(), {"held": ["shape", "frame", "back"]}, ""),
        (rolling(kind="fixed"), {"held": ["shape", "frame", "back"], "continuous": ["forward", "spins"]}, ""),
        (rolling(axis="0 0 0"), {"held": ["shape", "frame", "back"], "placed": ["forward", "spins"]}, 'xyz="0 0 0"'),
        (scene(BASE, LIDAR, WHEEL), {"held": ["frame", "back"], "continuous": ["placed", "forward", "spins"]},
         "<link name"),
    ],
    ids=["link", "fixed-joint", "zero-axis", "joint"],
)  # fmt: skip
def test_what_is_missing_fails_once(robot: Scene, lost: dict[str, list[str]], at: str) -> None:
    """The first criterion that needs what is missing fails, at its place; others are skipped, the rest is graded."""
    report = run(*WHOLE, on=robot)
    found = {result.criterion.id: (result.outcome.status, result.because) for result in report.results}
    expected: dict[str, object] = {name: ("passed", None) for name in found}
    for name, skipped in lost.items():
        expected |= {name: ("failed", None)} | {other: ("skipped", name) for other in skipped}
    assert found == expected
    last = next(result for result in report.results if result.criterion.id == [*lost][-1])
    assert not at or last.outcome.location == robot.location_of(at if at != "<link name" else '<link name="wheel"')


def test_the_location_of_a_missing_thing_is_kept() -> None:
    """A failure for a missing shape points to the existing shape."""
    robot = scene(BASE, LIDAR, MOUNT)
    report = run(ask("box", shows_box, link="lidar", size=(1.0, 1.0, 1.0), tolerance=0.1), on=robot)
    assert report.results[0].outcome.location == robot.location_of("<cylinder")


# --- Unreadable files -------------------------------------------------------------------------------------------------


def test_a_check_of_the_file_also_runs_on_an_unreadable_one() -> None:
    """Checks of the file do not need a robot."""
    report = run(ask("loads", urdf_loads), ask("file", of_file), ask("robot"), on=NOT_XML)
    assert statuses(report) == ["failed", "passed", "skipped"]
    assert causes(report) == [None, None, "loads"]


def test_without_a_check_of_the_file_the_first_criterion_fails() -> None:
    """If no criterion checks whether the file loads, the first one says that there is no robot."""
    report = run(ask("one"), ask("two", breaks), on=NOT_XML)
    assert statuses(report) == ["failed", "skipped"]
    assert causes(report) == [None, "one"]
    assert "no robot" in report.results[0].outcome.message
    report = run(ask("loads", urdf_loads), ask("one", part="b"), on=NOT_XML, parts=["b"])
    assert statuses(report) == ["failed"]


# --- Errors of the grader -----------------------------------------------------------------------------------------------


def test_an_exception_in_a_check_is_an_error_of_the_grader() -> None:
    """The criterion is errored, not failed; the traceback is kept, and the message is short."""
    result = run(ask("one", breaks)).results[0]
    assert result.outcome.status == "errored"
    assert "ZeroDivisionError" in result.outcome.message
    assert "a secret detail" not in result.outcome.message
    assert result.traceback.startswith("Traceback (most recent call last):")
    assert "in breaks" in result.traceback
    assert result.traceback.endswith("ZeroDivisionError: a secret detail\n")


def test_an_errored_criterion_affects_no_other() -> None:
    """Earlier and later criteria are graded as usual; one that requires it is not said to be skipped by a mistake."""
    report = run(
        ask("one"), ask("two", breaks), ask("three", requires=["two"]), ask("four", fails_), ask("five", pends)
    )
    assert [*statuses(report)[:2], *statuses(report)[3:]] == ["passed", "errored", "failed", "pending"]
    assert [bool(result.traceback) for result in report.results] == [False, True, False, False, False]
    after = report.results[2]
    assert after.outcome.status == "passed" or (after.because, "failed" in after.outcome.message) == ("two", False)


@pytest.mark.parametrize(
    "error",
    [KeyError("x"), LookupError("x"), ValueError("x"), RecursionError("x"), AssertionError("x"), MemoryError("x")],
)
def test_every_exception_of_a_check_is_caught(error: Exception) -> None:
    """Whatever a check raises unexpectedly, the run continues."""

    def raises(robot: Configuration) -> Outcome:
        raise error

    assert statuses(run(ask("one", raises), ask("two"))) == ["errored", "passed"]


def test_an_interrupt_is_not_caught() -> None:
    """An interrupt by the user is not an error of a check."""

    def interrupted(robot: Configuration) -> Outcome:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(ask("one", interrupted))


# --- Pending ----------------------------------------------------------------------------------------------------------


def test_what_depends_on_a_mesh_is_pending() -> None:
    """Each criterion that needs the size of a mesh is pending; the others are graded."""
    robot = scene(BASE, WHEEL, joint("j", "continuous", "base", "wheel")).with_shape(mesh())
    report = run(
        ask("base", bottom_at_height, link="base", relative_to="base", height=0.0, tolerance=0.002, points="2.5"),
        ask("green", shows_colour, link="base", colour=(0.0, 0.6, 0.0), tolerance=0.01),
        ask("wheel", bottom_at_height, link="wheel", relative_to="base", height=0.0, tolerance=0.002, points="0.1"),
        ask("held", held_by, link="wheel", parent="base", joint_type="continuous"),
        on=robot,
    )
    assert statuses(report) == ["pending", "passed", "pending", "passed"]
    assert sums(report) == [2, Decimal("4.6"), Decimal("2.6")]
    assert causes(report) == [None] * 4


# --- Parts ------------------------------------------------------------------------------------------------------------


def test_only_named_parts_are_graded() -> None:
    """Points of other parts are neither earned nor lost; by default all are graded, in the order of the file."""
    criteria = (ask("one", part="b"), ask("two", fails_, part="a"), ask("three", part="b", points="2"))
    for parts, graded, names, expected in (
        ([], ("a", "b"), ["one", "two", "three"], [3, 4, 0]),
        (["b"], ("b",), ["one", "three"], [3, 3, 0]),
        (["b", "a", "b"], ("a", "b"), ["one", "two", "three"], [3, 4, 0]),
    ):
        report = run(*criteria, parts=parts)
        assert report.parts == graded, parts
        assert [result.criterion.id for result in report.results] == names
        assert sums(report) == expected


def test_a_part_without_criteria_is_worth_nothing() -> None:
    """Its maximum is 0."""
    report = run(ask("one"), parts=["b"])
    assert report.results == ()
    assert sums(report) == [0, 0, 0]


def test_an_unknown_part_is_reported() -> None:
    """An unknown part is wrong usage, also beside a known one."""
    for parts in (["c"], ["a", "c"]):
        with pytest.raises(InputError, match="no part 'c'"):
            run(ask("one"), parts=parts)


# --- Points -----------------------------------------------------------------------------------------------------------


def test_points_are_all_or_nothing() -> None:
    """Only a pass earns points, and it earns all of them; a tenth and two tenths are three tenths."""
    report = run(
        ask("passed", points="1.5"),
        ask("failed", fails_, points="1.5"),
        ask("pending", pends, points="1.5"),
        ask("errored", breaks, points="1.5"),
        ask("skipped", requires=["failed"], points="1.5"),
    )
    assert [result.points for result in report.results] == [Decimal("1.5"), 0, 0, 0, 0]
    assert statuses(report) == ["passed", "failed", "pending", "errored", "skipped"]
    assert [report.counts("passed"), report.counts("failed", "errored"), report.counts()] == [1, 2, 0]
    assert sums(report) == [Decimal("1.5"), Decimal("7.5"), Decimal("1.5")]
    tenths = run(
        *(ask(f"{points}{check}", check, points=points) for check in (passes_, pends) for points in ("0.1", "0.2"))
    )
    assert (str(tenths.score), str(tenths.pending), str(tenths.max_score)) == ("0.3", "0.3", "0.6")


@examples(20)
@given(
    rows=st.lists(
        st.tuples(st.sampled_from([passes_, fails_, pends, breaks]), st.integers(0, 1000), st.sampled_from("ab")),
        max_size=12,
    )
)
def test_sums_equal_those_of_the_rows(rows: list[tuple[Callable[..., Outcome], int, str]]) -> None:
    """For any mix of outcomes the sums are exact, part by part and together."""
    criteria = [
        ask(f"c{index}", check, points=f"{points // 100}.{points % 100:02d}", part=part)
        for index, (check, points, part) in enumerate(rows)
    ]
    for parts in ((), ("a",), ("b",)):
        chosen = [(check, points) for check, points, part in rows if not parts or part in parts]
        report = run(*criteria, parts=parts)
        assert report.max_score * 100 == sum(points for _, points in chosen)
        assert report.score * 100 == sum(points for check, points in chosen if check is passes_)
        assert report.pending * 100 == sum(points for check, points in chosen if check is pends)


def test_the_same_submission_gets_the_same_report() -> None:
    """The report depends only on the submission and the rubric."""
    one, other = run(*WHOLE).results, run(*WHOLE).results
    for left, right in zip(one, other, strict=True):
        assert (left.criterion.id, left.outcome, left.because) == (right.criterion.id, right.outcome, right.because)
