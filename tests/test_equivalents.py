"""Full marks for every equivalent of the reference, and the same marks for a mistake in every form."""

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal

import pytest
from hypothesis import given, note
from hypothesis import strategies as st
from lxml import etree

from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import read_submission
from grader.ros.xml.parsing import Element
from tests.examples import examples
from tests.rewriting import BEHAVING, Step, parse, rewritings, rewritten

pytestmark = pytest.mark.slow

RUBRIC = load_rubric("lab6")
REFERENCE = parse((RUBRIC.path.parent / RUBRIC.reference / RUBRIC.urdf).read_bytes())

# Places in the reference, as the table of mistakes names them.
PLACES = {
    "LIDAR": "joint[@name='base_lidar_joint']",
    "LEFT": "joint[@name='base_left_wheel_joint']",
    "RIGHT": "joint[@name='base_right_wheel_joint']",
    "CASTER": "joint[@name='base_caster_wheel_joint']",
    "BASE": "joint[@name='base_joint']",
    "BOX": "link[@name='base_link']/visual",
    "DISC": "link[@name='lidar']/visual",
    "LEFT_DISC": "link[@name='left_wheel']/visual",
    "RIGHT_DISC": "link[@name='right_wheel']/visual",
    "BALL": "link[@name='caster_wheel']/visual",
    "GROUND": "footprint-at-wheel-bottoms stands-on-ground",
}


@dataclass(frozen=True, slots=True)
class Break:
    """A mistake: an attribute of the reference set to another value (None: removed), the lost criteria, and those carried."""

    name: str
    path: str
    attribute: str
    value: str | None
    lost: str
    carried: str = ""

    def applied(self) -> Element:
        """Return the reference with this mistake in it."""
        robot = etree.fromstring(etree.tostring(REFERENCE))
        elements = robot.findall(self.path) if self.path else [robot]
        assert elements, self.path
        for element in elements:
            if self.value is None:
                del element.attrib[self.attribute]
            else:
                element.set(self.attribute, self.value)
        return robot


# Name | place | attribute | value, "-" for none | lost | carried. In a-b,c there are a-b and a-c.
MISTAKES = """\
lidar-buried | LIDAR/origin | xyz | 0.15 0 0.2 | lidar-frame lidar-on-top
lidar-floating | LIDAR/origin | xyz | 0.15 0 0.25 | lidar-frame lidar-on-top
lidar-in-the-middle | LIDAR/origin | xyz | 0 0 0.225 | lidar-frame
lidar-aside | LIDAR/origin | xyz | 0.15 0.005 0.225 | lidar-frame
lidar-over-the-edge | LIDAR/origin | xyz | 0.3 0 0.225 | lidar-frame lidar-on-top
lidar-slanted | LIDAR/origin | rpy | 0 0.3 0 | lidar-frame lidar-on-top
lidar-upside-down | LIDAR/origin | rpy | 3.1416 0 0 | lidar-frame
lidar-backward | LIDAR/origin | rpy | 0 0 3.1416 | lidar-frame
lidar-turning | LIDAR | type | continuous | lidar-fixed
lidar-planar | LIDAR | type | planar | lidar-fixed
lidar-on-the-footprint | LIDAR/parent | link | base_footprint | lidar-fixed lidar-frame lidar-on-top
lidar-misspelt | LIDAR/child | link | lidr | urdf-loads
lidar-unknown | LIDAR/child | link | laser | urdf-loads lidar-fixed lidar-frame lidar-on-top joint-names
lidar-wide | DISC/geometry/cylinder | radius | 0.2 | lidar-shape | lidar-on-top
lidar-narrow | DISC/geometry/cylinder | radius | 0.05 | lidar-shape
lidar-long | DISC/geometry/cylinder | length | 0.1 | lidar-shape | lidar-on-top
lidar-too-dark | material[@name='white']/color | rgba | 0.5 0.5 0.5 1 | lidar-white
lidar-yellowish | material[@name='white']/color | rgba | 0.9 0.9 0.7 1 | lidar-white
lidar-invisible | material[@name='white']/color | rgba | 0.9 0.9 0.9 0 | lidar-white
gray-invisible | material[@name='gray']/color | rgba | 0.7 0.7 0.7 0.009 | left-wheel-gray right-wheel-gray
lidar-undefined-material | DISC/material | name | snow | lidar-white
lidar-joint-misnamed | LIDAR | name | lidar_joint | joint-names
green-full | material[@name='green']/color | rgba | 0 1 0 1 | base-green
green-transparent | material[@name='green']/color | rgba | 0 0.6 0 0.5 | base-green
green-a-little-off | material[@name='green']/color | rgba | 0 0.62 0 1 | base-green
green-in-255 | material[@name='green']/color | rgba | 0 153 0 255 | base-green
green-of-three | material[@name='green']/color | rgba | 0 0.6 0 | base-green
gray-too-dark | material[@name='gray']/color | rgba | 0.5 0.5 0.5 1 | left-wheel-gray right-wheel-gray
gray-bluish | material[@name='gray']/color | rgba | 0.7 0.7 0.72 1 | left-wheel-gray right-wheel-gray
wheel-green | LEFT_DISC/material | name | green | left-wheel-gray
left-negative | LEFT_DISC/geometry/cylinder | length | -0.05 | left-wheel-shape
caster-negative | BALL/geometry/sphere | radius | -0.05 | caster-shape
box-size-swapped | BOX/geometry/box | size | 0.4 0.6 0.2 | base-box | lidar-on-top left-wheel-clear right-wheel-clear
box-low | BOX/geometry/box | size | 0.6 0.4 0.1 | base-box | base-on-ground lidar-on-top
box-high | BOX/geometry/box | size | 0.6 0.4 0.21 | base-box | base-on-ground lidar-on-top
box-long | BOX/geometry/box | size | 0.61 0.4 0.2 | base-box
box-sunk | BOX/origin | xyz | 0 0 0 | base-on-ground | lidar-on-top
box-raised | BOX/origin | xyz | 0 0 0.11 | base-on-ground | lidar-on-top
box-over-a-wheel | BOX/origin | xyz | 0 0.01 0.1 | base-box | left-wheel-clear
box-ahead | BOX/origin | xyz | -0.15 0 0.1 | base-box | lidar-on-top
left-mirrored | LEFT/origin | rpy | 1.57 0 0 | left-wheel-placed,forward,axis,clear
right-mirrored | RIGHT/origin | rpy | 1.57 0 0 | right-wheel-placed,forward,axis,clear
left-in-degrees | LEFT/origin | rpy | -180 0 0 | left-wheel-placed,forward,axis,clear | GROUND
left-axis-negated | LEFT/axis | xyz | 0 0 -1 | left-wheel-forward
left-axis-y | LEFT/axis | xyz | 0 1 0 | left-wheel-forward,spins
right-axis-x | RIGHT/axis | xyz | 1 0 0 | right-wheel-forward,spins
left-axis-slanted | LEFT/axis | xyz | 0 0.2 1 | left-wheel-spins
left-axis-zero | LEFT/axis | xyz | 0 0 0 | left-wheel-placed,forward,axis,spins,clear | GROUND
left-fixed | LEFT | type | fixed | left-wheel-continuous,forward,spins
right-revolute | RIGHT | type | revolute | urdf-loads right-wheel-continuous
left-too-far-out | LEFT/origin | xyz | -0.15 0.25 0 | left-wheel-placed
left-at-the-front | LEFT/origin | xyz | 0.15 0.2 0 | left-wheel-placed
left-too-high | LEFT/origin | xyz | -0.15 0.2 0.01 | left-wheel-placed | GROUND
left-joint-misnamed | LEFT | name | left_wheel_joint | joint-names
left-half-inside | LEFT_DISC/origin | xyz | 0 0 0 | left-wheel-placed,clear
right-inside | RIGHT_DISC/origin | xyz | 0 0 0.025 | right-wheel-placed,clear
left-off-centre | LEFT_DISC/origin | xyz | 0.01 0 0.025 | left-wheel-placed,spins
left-off-centre-down | LEFT_DISC/origin | xyz | 0 0.01 0.025 | left-wheel-placed,spins | GROUND
left-lying | LEFT_DISC/origin | rpy | 1.57 0 0 | left-wheel-spins | left-wheel-clear GROUND
left-small | LEFT_DISC/geometry/cylinder | radius | 0.05 | left-wheel-shape | GROUND
right-broad | RIGHT_DISC/geometry/cylinder | length | 0.1 | right-wheel-shape | right-wheel-clear
caster-large | BALL/geometry/sphere | radius | 0.1 | caster-shape | stands-on-ground
caster-behind | CASTER/origin | xyz | -0.2 0 -0.05 | caster-placed
caster-low | CASTER/origin | xyz | 0.2 0 -0.06 | caster-placed | stands-on-ground
caster-turning | CASTER | type | continuous | caster-placed
footprint-low | BASE/origin | xyz | 0 0 0.2 | footprint-at-wheel-bottoms | stands-on-ground
footprint-high | BASE/origin | xyz | 0 0 0.05 | footprint-at-wheel-bottoms | stands-on-ground
footprint-ahead | BASE/origin | xyz | 0.1 0 0.1 | footprint-at-wheel-bottoms
footprint-turned | BASE/origin | rpy | 0 0 0.1 | footprint-at-wheel-bottoms
footprint-tilted | BASE/origin | rpy | 0 0.1 0 | footprint-at-wheel-bottoms | stands-on-ground
footprint-loose | BASE | type | continuous | footprint-root
robot-without-name |  | name | - | urdf-loads
robot-of-version-2 |  | version | 2.0 | urdf-loads
"""


def mistakes() -> Iterator[Break]:
    """Yield the rows of the table."""
    for line in MISTAKES.splitlines():
        name, path, attribute, value, lost, carried = [
            *(cell.strip() for cell in line.split("|")),
            "",
        ][:6]
        first, slash, rest = path.partition("/")
        path = f"{PLACES.get(first, first)}{slash}{rest}"
        yield Break(
            name,
            path,
            attribute,
            None if value == "-" else value,
            spelt_out(lost),
            spelt_out(carried),
        )


def spelt_out(criteria: str) -> str:
    """Return the criteria of a cell."""
    found = []
    for word in criteria.split():
        first, *others = PLACES.get(word, word).split(",")
        side = first[: first.index("wheel-") + 6] if others else ""
        found += [first, *(side + other for other in others)]
    return " ".join(found)


BREAKS = list(mistakes())
each_break = pytest.mark.parametrize("mistake", BREAKS, ids=lambda mistake: mistake.name)


def graded(data: bytes) -> Report:
    """Return the report on a URDF."""
    return grade(RUBRIC, read_submission(data, identity="student", path="my_robot.urdf"))


def lost(report: Report) -> set[str]:
    """Return the criteria that cost points; none may be errored."""
    assert not report.fault, [result.traceback for result in report.results if result.traceback]
    return {
        result.criterion.id for result in report.results if result.points < result.criterion.points
    }


def carried(report: Report) -> set[str]:
    """Return the criteria that failed and have their points."""
    return {result.criterion.id for result in report.results if result.carried}


@examples(60)
@given(data=rewritings(REFERENCE))
def test_every_equivalent_of_the_reference_gets_full_marks(data: bytes) -> None:
    """Nothing is lost by any composition of equivalent rewritings."""
    note(data.decode())
    report = graded(data)
    assert {
        result.criterion.id: result.outcome.message
        for result in report.results
        if result.points == 0
    } == {}
    assert report.score == report.max_score == Decimal(70)
    assert report.submission.verdict == "clean"


@pytest.mark.parametrize("step", BEHAVING, ids=lambda step: step.__name__)
def test_each_rewriting_alone_gets_full_marks(step: Step) -> None:
    """No single rewriting loses points, in three tries."""

    @examples(8)
    @given(data=rewritten(REFERENCE, (step, step, step)))
    def check(data: bytes) -> None:
        """Assert full marks for this text."""
        note(data.decode())
        assert lost(graded(data)) == set()

    check()


@each_break
def test_a_mistake_loses_the_expected_criteria(mistake: Break) -> None:
    """One changed attribute of the reference loses exactly its criteria; those that fail because of these keep their points."""
    report = graded(etree.tostring(mistake.applied()))
    assert lost(report) == set(mistake.lost.split())
    assert carried(report) == set(mistake.carried.split())


@each_break
@examples(3)
@given(draw=st.data())
def test_a_mistake_is_recognised_in_every_form(mistake: Break, draw: st.DataObject) -> None:
    """The same criteria are lost, and the same carried, after any composition of equivalent rewritings."""
    report = graded(data := draw.draw(rewritings(mistake.applied())))
    note(data.decode())
    assert (lost(report), carried(report)) == (
        set(mistake.lost.split()),
        set(mistake.carried.split()),
    )


_NUMBERS = "|0|0 0 0|-1|-1 -1 -1|1e308 1e308 1e308|1.7e308 -1.7e308 0|1e308|1e-308|1e-308 0 0|0 0 0 0|1 1 1 1|nan|1,2,3"
_WORDS = "x|base_link|left_wheel|lidar|planar|floating|prismatic|revolute|fixed|gray|base_left_wheel_joint"
_ODD = st.sampled_from(f"{_NUMBERS}|{_WORDS}".split("|"))
_ADDED = st.sampled_from(
    (
        "<limit lower='-1' upper='1' effort='1' velocity='1'/>",
        "<mimic joint='base_left_wheel_joint'/>",
        "<mimic joint='base_right_wheel_joint' multiplier='1e308' offset='1e308'/>",
        "<visual><geometry><mesh filename='package://a/b.stl'/></geometry></visual>",
        "<visual><origin xyz='1e308 1e308 0'/><geometry><box size='1e308 1e308 1e308'/></geometry></visual>",
        "<visual><geometry><sphere radius='1e-320'/></geometry></visual>",
        "<origin xyz='1e308 0 0' rpy='1e308 0 1'/>",
        "<axis xyz='1e-320 0 1e-320'/>",
    )
)


@examples(80)
@given(draw=st.data())
def test_no_value_is_an_error_of_the_grader(draw: st.DataObject) -> None:
    """Whatever a few attributes of the reference are set to, no criterion is errored."""
    robot = etree.fromstring(etree.tostring(REFERENCE))
    elements = [element for element in robot.iter() if element.attrib]
    for _ in range(draw.draw(st.integers(0, 4))):
        element = draw.draw(st.sampled_from(elements))
        element.set(draw.draw(st.sampled_from(sorted(map(str, element.attrib)))), draw.draw(_ODD))
    for _ in range(draw.draw(st.integers(0, 2))):
        owner = draw.draw(st.sampled_from(list(robot)))
        owner.insert(draw.draw(st.integers(0, len(owner))), etree.fromstring(draw.draw(_ADDED)))
    data = etree.tostring(robot)
    note(data.decode())
    report = graded(data)
    lost(report)
    assert report.submission.verdict in ("clean", "degraded", "rejected")


def mimicking(*rules: tuple[str, str]) -> bytes:
    """Return the reference with mimics in its joints: path of the joint, attributes of the mimic."""
    robot = etree.fromstring(etree.tostring(REFERENCE))
    for path, attributes in rules:
        for joint in robot.findall(path):
            joint.append(etree.fromstring(f"<mimic {attributes}/>"))
    return etree.tostring(robot)


@pytest.mark.parametrize("offset", ["0", "0.5", "-3"])
def test_a_wheel_that_follows_the_other_rolls_like_it(offset: str) -> None:
    """A small positive rotation starts from the joint's position, which a mimic's offset may have moved."""
    report = graded(
        mimicking((PLACES["RIGHT"], f"joint='base_left_wheel_joint' offset='{offset}'"))
    )
    assert lost(report) == {"right-wheel-continuous"}  # which should move by itself


def test_mimics_that_overflow_are_no_error_of_the_grader() -> None:
    """A position that overflows leaves the pose undefined, which is the file's fault."""
    left = (PLACES["LEFT"], "joint='base_right_wheel_joint' multiplier='1e308'")
    right = (PLACES["RIGHT"], "joint='base_caster_wheel_joint' offset='1e308'")
    assert "left-wheel-placed" in lost(graded(mimicking(left, right)))


@pytest.mark.parametrize("kind", ["planar", "floating"])
def test_a_planar_or_floating_wheel_does_not_roll(kind: str) -> None:
    """A planar or floating joint is no wheel's joint, and has no small positive angle to turn by; a planar one has an axis."""
    report = graded(etree.tostring(Break(kind, PLACES["LEFT"], "type", kind, "").applied()))
    wheel = {f"left-wheel-{name}" for name in ("continuous", "forward", "spins")}
    assert (
        {"left-wheel-continuous", "left-wheel-forward"} <= lost(report) | carried(report) <= wheel
    )
    assert ("left-wheel-forward" in lost(report)) == (kind == "floating")
    assert "left-wheel-continuous" in lost(report)


def test_every_criterion_is_lost_by_some_mistake() -> None:
    """The mistakes cover the rubric, except the footprint's visibility, which is no attribute."""
    covered = {
        criterion for mistake in BREAKS for criterion in f"{mistake.lost} {mistake.carried}".split()
    }
    urdf = {criterion.id for criterion in RUBRIC.criteria if criterion.part == "task1"}
    assert urdf - covered == {"footprint-virtual"}
