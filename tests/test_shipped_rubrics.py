"""The labs that come with the grader are data: the code knows none of them, and each is complete."""

import ast
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from shutil import copytree

import pytest

from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import Rubric
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC
from grader.lab.submission.opening import open_submission, read_submission
from tests.samples import ROOT, RUBRICS, SAMPLES
from tests.test_architecture import MODULES
from tests.workspace.rule_examples import FRAMES

every_rubric = pytest.mark.parametrize("rubric", RUBRICS.values(), ids=RUBRICS)
# Names of ROS 2 and of REP 105, which no lab made up.
STANDARD = {
    "/robot_description",
    "robot_state_publisher",
    "rviz2",
    "ament_python",
    "base_link",
    "base_footprint",
}


def names(rubric: Rubric) -> Iterator[str]:
    """Yield the names of a lab: those of the rubric, of its criteria, and of what the robot of the reference consists of."""
    assert rubric.solution is not None
    robot = rubric.solution.robot.robot
    yield from (rubric.id, rubric.package, rubric.urdf, *rubric.folders)
    yield from (criterion.id for criterion in rubric.criteria)
    yield from (link.name for link in robot.links)
    yield from (joint.name for joint in robot.joints)


def constants(tree: ast.AST) -> Iterator[str]:
    """Yield the strings of a module, without docstrings."""
    docstrings = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and id(node) not in docstrings
        ):
            yield node.value


def test_a_partial_fix_lowers_no_score(tmp_path: Path) -> None:
    """An entry for the wrong folder costs no more than no entry."""
    rubric = RUBRICS["lab6"]
    entry = "(os.path.join('share', package_name), glob('rviz/*')),"
    scores = []
    for number, other in enumerate((entry.replace("name)", "name, 'views')"), "")):
        folder = tmp_path / str(number)
        copytree(ROOT / "rubrics/lab6/my_robot", folder)
        setup = folder / "setup.py"
        text = setup.read_text(encoding="utf-8")
        assert entry in text
        setup.write_text(text.replace(entry, other), encoding="utf-8")
        report = grade(rubric, open_submission(str(folder), rubric.lab))
        scores.append(report.score)
        assert report.score < Decimal(90)
    assert scores[0] >= scores[1]


@pytest.mark.slow
def test_the_code_knows_no_lab() -> None:
    """No module has the name of a lab, of its criteria, links or joints as a value; the one exception is the default of --rubric.

    Names of one plain word, such as `lidar`, are words of the field, too.
    """
    made_up = {
        name for rubric in RUBRICS.values() for name in names(rubric) if name and not name.isalpha()
    } - STANDARD
    assert {"lab6", "joint_4", "camera_optical_frame", "arm.urdf", "left-wheel-forward"} <= made_up
    found = [
        (module, text)
        for module, path in MODULES.items()
        for text in constants(ast.parse(path.read_text(encoding="utf-8")))
        if text in made_up and text not in FRAMES  # of the examples of rules
    ]
    assert found == [("grader.lab.rubric.rubric_files", DEFAULT_RUBRIC)]


# An example with a mistake for each family of names, whose robot may be what those of the other labs are; a lab with few criteria.
_FEWER = {"diffdrive": (1, 13), "rover": (8, 10)}


@every_rubric
def test_a_lab_has_samples_and_a_page(rubric: Rubric) -> None:
    """It has correct robots and mistakes, and a page, which names parts and links, in the README's list."""
    own = [name for name, sample in SAMPLES.items() if sample.rubric is rubric]
    correct = [
        name for name in own if name.rpartition("/")[2].startswith(("equivalent-", "reference"))
    ]
    least_correct, least_wrong = _FEWER.get(rubric.id, (8, 25))
    assert len(correct) >= least_correct
    assert len(own) - len(correct) >= least_wrong
    page = (ROOT / f"rubrics/{rubric.id}/README.md").read_text(encoding="utf-8")
    assert rubric.solution is not None
    needed = [
        *(part.id for part in rubric.parts),
        *(link.name for link in rubric.solution.robot.robot.links),
    ]
    assert [name for name in needed if f"`{name}`" not in page] == []
    assert f"rubrics/{rubric.id}/README.md" in (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_a_mistake_costs_what_it_is_worth() -> None:
    """One mistake costs at most 15 % of all points, although it moves, turns or weighs what other criteria measure.

    Extra credit does not count.
    """
    reports = {
        name: SAMPLES[name].grade()
        for name in SAMPLES
        if "/" in name and "/equivalent-" not in name and "/recorded-" not in name
    }
    costs = {
        name: (report.max_score - report.score) / report.max_score
        for name, report in reports.items()
    }
    assert {name: cost for name, cost in costs.items() if not 0 < cost <= Decimal("0.15")} == {}


Edit = tuple[str, str, str]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("one", "other", "costs"),
    [
        (("joint_2", "0 0 0.1", "0 0 0.05"), ("joint_3", "0 1 0", "0 -1 0"), (4, 4, 8)),
        (("joint_2", "0 1 0", "0 -1 0"), ("tool_joint", "0.06", "0.6"), (4, 3, 7)),
        (("joint_1", '"0 0 1"', '"0 0 -1"'), ("joint_4", "0.25", "0.2"), (4, 3, 7)),
    ],
)
def test_two_mistakes_in_the_arm_cost_their_sum(
    one: Edit, other: Edit, costs: tuple[int, int, int]
) -> None:
    """A joint that turns the wrong way excuses no link that is misplaced, and costs nothing in poses that do not turn it."""
    assert (
        tuple(int(100 - _score_of_arm(edits)) for edits in ([one], [other], [one, other])) == costs
    )


def _score_of_arm(edits: list[Edit]) -> Decimal:
    """Return the score of the arm with edits, each of the first text in a joint."""
    text = (ROOT / "rubrics/arm/arm.urdf").read_text(encoding="utf-8")
    for joint, old, new in edits:
        before, name, after = text.partition(f'<joint name="{joint}"')
        assert old in after
        text = before + name + after.replace(old, new, 1)
    return grade(
        RUBRICS["arm"], read_submission(text.encode(), identity="student", path="arm.urdf")
    ).score
