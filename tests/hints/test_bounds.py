"""The search for hints ends: large and hostile robots cost a bounded number of steps, and no more work than those."""

import re
from itertools import count

import pytest

from grader.lab.grading.grade import grade
from grader.lab.hints.generators import Situation
from grader.lab.hints.hinting import hinted
from grader.lab.hints.search import _MAX_GRADINGS
from grader.lab.submission.opening import read_submission
from tests.examples import spread
from tests.hints.trials import BASES, graded, reference_draft, search_for
from tests.samples import LAB6, ROOT, RUBRICS
from tests.work import limited_work

pytestmark = pytest.mark.slow

REFERENCE = BASES["reference"].text
MANY = 150
_ARM = (ROOT / "rubrics" / "arm" / "arm.urdf").read_text()
LOST = REFERENCE.replace("0.15 0 0.225", "0.15 0 0.2")


def _chain(start: str, count: int) -> str:
    """Return links, each fixed to the one before."""
    return "".join(
        f'<link name="c{i}"/><joint name="j{i}" type="fixed"><parent link="{f"c{i - 1}" if i else start}"/>'
        f'<child link="c{i}"/><origin xyz="0.0001 0 0" rpy="0.001 0 0"/></joint>\n'
        for i in range(count)
    )


def _with(added: str, text: str = LOST) -> str:
    return text.replace("</robot>", f"{added}</robot>")


_LIDAR_PARENT = '<parent link="base_link"/>\n    <child link="lidar"/>'
_MATERIALS = "".join(
    f'<material name="m{i}"><color rgba="0 0 0 1"/></material>\n' for i in range(MANY)
)
_JOINTS = "".join(
    f'<joint name="q{i}"><parent link="b{i}"/><child link="lidr{i}"/></joint>' for i in range(MANY)
)

HOSTILE = {
    "links apart": _with(_chain("base_link", MANY)),
    "links between": _with(_chain("base_link", MANY)).replace(
        _LIDAR_PARENT, _LIDAR_PARENT.replace("base_link", f"c{MANY - 1}")
    ),
    "materials": _with(_MATERIALS).replace('<material name="white"/>', '<material name="whte"/>'),
    "joints of unknown links": _with(_JOINTS),
    "visuals": LOST.replace(
        "</visual>",
        "</visual>" + '<visual><geometry><sphere radius="10"/></geometry></visual>' * MANY,
    ),
    "numbers": LOST.replace('0.15 0 0.2"', f'0.15 0 0.2{" 0" * 100 * MANY}"'),
    "misspelt attributes": LOST.replace(
        "<visual>", "<visual>" + '<orign xz="1 2 3" ryp="0 0 0"/>' * MANY, 1
    ),
    "nested": _with("<link><visual>" * 200 + "</visual></link>" * 200),
    "long names": LOST.replace('"lidar"', f'"{"lidar" * 10 * MANY}"'),
    "commas": REFERENCE.replace('xyz="', 'xyz="0,') + "<!-- -->" * MANY,
}


@pytest.mark.parametrize("name", spread(HOSTILE, 1))
def test_a_large_robot_is_searched_with_bounded_work(name: str) -> None:
    """Hundreds of anything that a search looks at take a bounded number of lines of Python."""
    submission = read_submission(HOSTILE[name].encode(), identity="student", path="my_robot.urdf")
    results = graded(submission)
    assert any(result.is_lost for result in results.values())
    with limited_work(40_000_000):
        search_for(submission, results)


def _arm_with_other_joints() -> str:
    """Return the arm with each origin 1 cm higher than the one before, and all axes askew."""
    numbers = count(1)

    def higher(found: re.Match[str]) -> str:
        return f"{found[1]}{float(found[2]) + 0.01 * next(numbers)}"

    moved = re.sub(r'(<origin xyz="[^" ]* [^" ]* )([-.\d]+)', higher, _ARM)
    return re.sub(r'(?<=<axis xyz=")[^"]*', "0.3 0.5 0.7", moved)


@pytest.mark.exhaustive
def test_a_check_at_many_positions_is_searched_with_bounded_work() -> None:
    """An arm whose links all move in another way takes no more work than the gradings of its budget."""
    submission = read_submission(
        _arm_with_other_joints().encode(), identity="student", path="arm.urdf"
    )
    results = graded(submission, RUBRICS["arm"])
    with limited_work(2_000_000) as once:
        graded(submission, RUBRICS["arm"])
    with limited_work(_MAX_GRADINGS * once.calls):
        search_for(submission, results, RUBRICS["arm"])


def test_a_costly_submission_is_not_searched() -> None:
    """A robot whose reading takes long gets its report at once, even if words could say what it lacks."""
    text = _with("<!-- -->" * 40_000).replace("<visual>", f"<visual>{'<sphere/>' * 3000}", 1)
    submission = read_submission(text.encode(), identity="student", path="my_robot.urdf")
    report = grade(LAB6, submission)
    assert submission.is_costly
    with limited_work(100):
        assert hinted(report, submission, "edit").report == report


def test_the_joint_of_each_link_is_found_at_once() -> None:
    """Joints of links with names of one side are compared with those of the other side in linear work."""
    text = _with(_chain("base_link", 4 * MANY).replace('"c', '"l'))
    submission = read_submission(text.encode(), identity="student", path="my_robot.urdf")
    draft = reference_draft("lab6")
    assert draft is not None
    with limited_work(150_000):
        found = Situation(submission, LAB6.links, draft, lambda _: None).exchanges
    assert {piece.link for piece in found} == {"left_wheel", "right_wheel"}
