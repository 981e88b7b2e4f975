"""Error carried forward: a criterion that fails only because of an earlier mistake keeps its points."""

import json
from decimal import Decimal
from pathlib import Path

import pytest

from grader.checks.check import describe
from grader.checks.outcome import Outcome, failed, pending
from grader.errors import MissingElement
from grader.grading.criterion import Carried, Criterion, Part
from grader.grading.grade import grade
from grader.grading.record import from_record, to_record
from grader.grading.report import Report
from grader.grading.rubric import Rubric
from grader.report.formats import Format
from grader.robot.kinematics import Configuration
from grader.submission.opening import read_submission
from tests.checks.outcomes import AnyCheck
from tests.checks.robots import BASE, scene
from tests.classroom.gradebooks import grader
from tests.grading.test_grade import ask, breaks, fails_, passes_, pends, statuses
from tests.grading.test_rubric import GOOD, announced, complaints, loaded
from tests.samples import LAB6, SAMPLES

REFERENCE = (LAB6.path.parent / LAB6.reference / LAB6.urdf).read_text(encoding="utf-8")
SMALL_WHEELS = "submissions/lab6/wheel-too-small/my_robot/urdf/my_robot.urdf"


def carried_from(name: str, causes: list[str], check: AnyCheck, other: AnyCheck = passes_) -> Criterion:
    """Return a criterion that is carried from others if another check passes."""
    return ask(name, check)._replace(carried=(Carried(tuple(causes), describe(other), {}),))


def report_on(*criteria: Criterion) -> Report:
    """Return the report on a robot under these criteria."""
    rubric = Rubric("r", "R", (Part("a", "A"), Part("b", "B")), criteria, "robot.urdf", "", b"", Path("r.toml"))
    return grade(rubric, read_submission(scene(BASE).text.encode(), identity="me", path="robot.urdf"))


def carried(report: Report) -> list[str]:
    """Return the cause of each carried criterion, empty for the others."""
    return [result.carried for result in report.results]


def misses_(robot: Configuration) -> Outcome:
    """A check of something that is missing."""
    raise MissingElement("thing", "x")


def fails_elsewhere(robot: Configuration) -> Outcome:
    """A check that fails at a place."""
    return failed("it fails", robot.link("base").location)


# --- When it is carried -----------------------------------------------------------------------------------------------


ONE = ask("one", fails_)
# The criteria, their statuses by their first letters, and what each is carried from.
CARRIED: dict[str, tuple[tuple[Criterion, ...], str, list[str]]] = {
    "the other fact fails": ((ONE, carried_from("two", ["one"], fails_, fails_)), "ff", ["", ""]),
    "the other fact misses a thing": (
        (ONE, carried_from("two", ["one"], fails_, misses_), ask("three", misses_)), "fff",
         ["", "", ""],  # and skips nobody
    ),
    "no early mistake": ((ask("one"), carried_from("two", ["one"], fails_)), "pf", ["", ""]),
    "early one is open": ((ask("one", pends), carried_from("two", ["one"], fails_)), "?f", ["", ""]),
    "passes": ((ONE, carried_from("two", ["one"], passes_)), "fp", ["", ""]),
    "chain": (
        (ONE, carried_from("two", ["one"], fails_), carried_from("three", ["two"], fails_)), "fff", ["", "one", "one"],
    ),
    "required": ((ONE, carried_from("two", ["one"], fails_), ask("three", requires=["two"])), "ffp", ["", "one", ""]),
}  # fmt: skip


@pytest.mark.parametrize("name", CARRIED)
def test_what_is_carried(name: str) -> None:
    """Only a failure after an early mistake, without which another fact would count; a chain names its first cause."""
    criteria, letters, causes = CARRIED[name]
    report = report_on(*criteria)
    expected = {"f": "failed", "p": "passed", "?": "pending"}
    assert (statuses(report), carried(report)) == ([expected[letter] for letter in letters], causes)
    kept = [bool(cause) or letter == "p" for cause, letter in zip(causes, letters, strict=True)]
    assert [result.points for result in report.results] == kept


def test_a_failure_after_an_early_mistake_keeps_its_points() -> None:
    """It stays failed, earns its points, and names the first cause in the list that failed."""
    report = report_on(
        ask("one", points="2"), ask("two", fails_, points="3"), ask("three", fails_),
        carried_from("four", ["one", "three", "two"], fails_),
    )  # fmt: skip
    assert statuses(report) == ["passed", "failed", "failed", "failed"]
    assert carried(report) == ["", "", "", "three"]
    assert [result.points for result in report.results] == [2, 0, 0, 1]
    assert [report.score, report.max_score] == [3, 7]


def test_a_skip_because_of_a_cause_is_a_failure() -> None:
    """What cannot be measured because of the mistake keeps its points; a skip because of another criterion does not."""
    report = report_on(
        ask("one", fails_), ask("two", misses_), carried_from("three", ["two"], misses_),
            carried_from("four", ["one"], misses_),
    )  # fmt: skip
    assert statuses(report) == ["failed", "failed", "failed", "skipped"]
    assert carried(report) == ["", "", "two", ""]
    assert report.results[2].outcome.message == "it cannot be measured, because two failed"
    assert report.results[2].because is None


def test_an_undecided_fact_needs_manual_grading() -> None:
    """Whether to give the points is not guessed."""

    def unsure(robot: Configuration) -> Outcome:
        """A check that cannot tell."""
        return pending("a mesh is not opened; needs manual grading", "a mesh")

    report = report_on(ask("one", fails_), carried_from("two", ["one"], fails_, unsure))
    assert statuses(report) == ["failed", "pending"]
    assert report.results[1].outcome.mistake == "a mesh"
    assert report.results[1].outcome.message.endswith(
        "; whether this is due to one alone cannot be decided: a mesh is not opened; needs manual grading"
    )


def test_a_faulty_fact_is_a_fault_of_the_grader() -> None:
    """An exception in the other check makes the criterion errored, never a silent zero."""
    report = report_on(ask("one", fails_), carried_from("two", ["one"], fails_, breaks))
    assert statuses(report) == ["failed", "errored"]
    assert report.results[1].traceback


def test_the_place_is_that_of_the_mistake() -> None:
    """A carried failure points to what has to be changed, not to what is as it should be."""
    first, second = report_on(ask("one", fails_elsewhere), carried_from("two", ["one"], fails_)).results
    assert first.outcome.location is not None
    assert second.outcome.location == first.outcome.location


# --- In a rubric ------------------------------------------------------------------------------------------------------

AFTER = """
[[criterion]]
id = "box"
part = "a"
title = "A box"
points = 1
check = "shows_box"
with = { link = "base", size = [1, 1, 1], tolerance = 0.1 }
[criterion.carried]
"""
FACT = 'check = "frame_at"\nwith = { link = "a", relative_to = "b", xyz = [0, 0, 1], tolerance = 0.1 }'


XZY = FACT.replace("xyz", "xzy")


def test_a_rubric_says_what_counts_instead(tmp_path: Path) -> None:
    """The causes and the other check with its arguments, converted like those of the criterion."""
    (found,) = loaded(tmp_path, f'{GOOD}{AFTER}from = ["loads"]\n{FACT}').criteria[1].carried
    assert (found.causes, found.check.name, found.arguments["xyz"]) == (("loads",), "frame_at", (0.0, 0.0, 1.0))


SEVERAL = AFTER.replace("[criterion.carried]", "[[criterion.carried]]")


def test_several_facts_may_count_instead(tmp_path: Path) -> None:
    """Each is a table with causes of its own; a mistake in the second has its line."""
    tables = f'{SEVERAL}from = ["loads"]\n{FACT}\n[[criterion.carried]]\nfrom = ["loads"]\ncheck = "urdf_loads"\n'
    found = loaded(tmp_path, GOOD + tables).criteria[1].carried
    assert [one.check.name for one in found] == ["frame_at", "urdf_loads"]
    wrong = f"{GOOD}{tables}with = {{ x = 1 }}  # !! the check urdf_loads takes no 'x'; it takes: nothing\n"
    assert complaints(tmp_path, wrong) == announced(wrong)
    first, second = carried_from("two", ["one"], fails_, fails_).carried + carried_from("two", ["one"], fails_).carried
    for order in ((first, second), (second, first)):
        assert carried(report_on(ONE, ask("two", fails_)._replace(carried=order))) == ["", "one"]


@pytest.mark.parametrize(
    "text",
    [
        f"from = [\"load\"]  # !! is carried from 'load', which does not exist; did you mean 'loads'?\n{FACT}",
        f'from = ["box"]  # !! is carried from itself\n{FACT}',
        f"from = 3  # !! from must be a list of strings, not 3\n{FACT}",
        f"from = []  # !! from must be at least one id, not []\n{FACT}",
        "from = [\"loads\"]\ncheck = \"frame_on\"  # !! there is no check 'frame_on'; did you mean 'frame_at'?",
        f"from = [\"loads\"]\n{XZY}  # !! the check frame_at takes no 'xzy'; did you mean 'xyz'? !! the check frame_at needs xyz: 3 numbers",
        f"from = [\"loads\"]\nchek = 1  # !! a carried table has no key 'chek'; did you mean 'check'?\n{FACT}",
    ],
)
def test_a_mistake_in_it_is_reported(tmp_path: Path, text: str) -> None:
    """Ids, names and types are checked when the rubric is loaded, with line and suggestion."""
    assert complaints(tmp_path, f"{GOOD}{AFTER}{text}") == announced(f"{GOOD}{AFTER}{text}")


def test_it_is_carried_from_above_only(tmp_path: Path) -> None:
    """So there are no cycles."""
    text = (
        GOOD
        + f'carried = {{ from = ["later"], {FACT.replace(chr(10), ", ")} }}\n'
        + GOOD.partition("[[criterion]]")[2].join(("[[criterion]]", "")).replace("loads", "later", 1)
    )
    (complaint,) = complaints(tmp_path, text)
    assert complaint.endswith(
        "is carried from 'later', which is below: a criterion can only be carried from those above it"
    )


def test_all_bad_rows_are_reported_at_once(tmp_path: Path) -> None:
    """A mistake in the criterion does not hide one in its carried table."""
    text = f'{GOOD}{AFTER.replace("size", "sizes")}from = ["load"]\n{FACT.replace("frame_at", "frame_on")}'
    assert len(complaints(tmp_path, text)) == 4


# --- In Lab 6 ---------------------------------------------------------------------------------------------------------


def lab6(*edits: tuple[str, str]) -> Report:
    """Return the report on the reference with texts replaced."""
    text = REFERENCE
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return grade(LAB6, read_submission(text.encode(), identity="me", path="my_robot.urdf"))


LEFT_HIGH = ('xyz="-0.15 0.2 0"', 'xyz="-0.15 0.2 0.05"')
_FOOTPRINT = 'xyz="0 0 0.1" rpy="0 0 0"/>  <!-- the radius'
FOOTPRINT_LOW = (_FOOTPRINT, 'xyz="0 0 0.2" rpy="0 0 0"/>  <!-- the radius')
FOOTPRINT_TURNED = (_FOOTPRINT, 'xyz="0 0 0.1" rpy="0 0 0.1"/>  <!-- the radius')


def lost(report: Report) -> dict[str, Decimal]:
    """Return the points that each criterion lost."""
    points = {result.criterion.id: result.criterion.points - result.points for result in report.results}
    return {name: value for name, value in points.items() if value}


def test_one_early_mistake_costs_once() -> None:
    """A wheel that is too high loses its own two points, and neither the footprint nor the ground."""
    assert lost(lab6(LEFT_HIGH)) == {"left-wheel-placed": 2}


@pytest.mark.parametrize("footprint", [FOOTPRINT_LOW, FOOTPRINT_TURNED])
def test_a_wrong_footprint_is_lost_with_and_without_an_early_mistake(footprint: tuple[str, str]) -> None:
    """An early mistake excuses only what follows from it."""
    alone, both = lost(lab6(footprint)), lost(lab6(footprint, LEFT_HIGH))
    assert alone["footprint-at-wheel-bottoms"] == 6
    assert both == alone | {"left-wheel-placed": Decimal(2), "stands-on-ground": Decimal(1)}


def test_a_misspelt_type_costs_once() -> None:
    """The wheel would drive forward and turn about itself; one with a wrong axis as well would not."""
    assert lost(lab6(('type="continuous"', 'type="continous"'))) == {"urdf-loads": 3}
    typo = ('type="continuous"', 'type="rotary"')
    expected = {"urdf-loads": 3, "left-wheel-continuous": 1, "right-wheel-continuous": 1}
    assert lost(lab6(typo)) == expected
    axes = ('axis xyz="0 0 1"', 'axis xyz="0 0 -1"')
    assert lost(lab6(typo, axes)) == expected | {"left-wheel-forward": 6, "right-wheel-forward": 6}


def test_a_wrong_type_costs_once() -> None:
    """A skip because of a criterion that is itself carried is carried from the same mistake."""
    report = lab6(('type="continuous"', 'type="planar"'))
    assert lost(report) == {"left-wheel-continuous": 1, "right-wheel-continuous": 1}
    found = {result.criterion.id: result.carried for result in report.results}
    assert found["left-wheel-forward"] == found["left-wheel-spins"] == "left-wheel-continuous"


def test_what_was_not_built_is_counted_where_it_is_missing() -> None:
    """A base without a box hides neither the wheels nor the lidar, but what is about the box itself is lost."""
    no_box = ('<box size="0.6 0.4 0.2"/>', '<box size="0.6, 0.4, 0.2"/>')
    assert set(lost(lab6(no_box))) == {"base-box", "base-on-ground", "base-green"}


def test_a_slanted_lidar_is_not_excused_by_the_base() -> None:
    """A lidar that would not stand on the correct base either is lost."""
    base = ('size="0.6 0.4 0.2"', 'size="0.6 0.4 0.1"')
    assert "lidar-on-top" not in lost(lab6(base))
    assert "lidar-on-top" in lost(lab6(base, ('"0.15 0 0.225" rpy="0 0 0"', '"0.15 0 0.225" rpy="0 0.2 0"')))


# --- In every format --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [kind for kind in Format if kind.needs != "identity" and kind is not Format.SVG])
def test_every_format_says_so(kind: Format) -> None:
    """Each names the cause, and the run has failures. A drawing shows only where points are lost."""
    done = grader("grade", SMALL_WHEELS, "--format", kind.value, COLUMNS="300")
    assert done.returncode == 1
    text = done.stdout.replace("\\", "")
    words = "Not deducted: caused by left-wheel-shape."
    words = "(caused by left-wheel-shape)" if kind is Format.TERMINAL else words
    assert words in text or kind is Format.JSON
    assert kind is not Format.JSON or '"carried": "left-wheel-shape"' in text


def test_the_json_and_the_threshold() -> None:
    """`status` stays failed, `points` equal `max_points`, `carried` is the cause; `--fail-under` looks at the points."""
    done = grader("grade", SMALL_WHEELS, "--fail-under", "68", "--format", "json")
    results = json.loads(done.stdout)["results"]
    row = next(result for result in results if result["id"] == "footprint-at-wheel-bottoms")
    assert (row["status"], row["points"], row["max_points"]) == ("failed", 6, 6)
    assert (row["carried"], row["because"], row["feedback"]) == ("left-wheel-shape", None, "")
    assert {row["id"] for row in results if row["carried"]} == {"footprint-at-wheel-bottoms", "stands-on-ground"}
    assert done.returncode == 0
    assert grader("grade", SMALL_WHEELS, "--fail-under", "68.5").returncode == 1


def test_explain_says_when_it_is_carried() -> None:
    """With the causes and the other check."""
    text = " ".join(grader("explain", "base-on-ground").stdout.split())
    assert "If it fails and base-box failed before it, the points are given if this check passes: centre_at." in text


def test_a_record_keeps_it() -> None:
    """A gradebook gives the same report."""
    report = SAMPLES["wheel-too-small"].alone.grade()
    again = from_record(to_record(report), report.rubric)
    assert [result.carried for result in again.results] == carried(report)
    assert again.score == report.score == 68
