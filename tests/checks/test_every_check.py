"""Properties of all checks: the cases, missing links, links without joints, loops of joints, meshes, empty visuals."""

import re

import pytest

from grader.lab.checks.check import describe
from grader.lab.checks.collisions import collides_as
from tests.checks.cases import CASES, Case
from tests.checks.outcomes import ask, graded, missing
from tests.checks.robots import Scene, box, joint
from tests.checks.submissions import Submitted

XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
# The arguments that name links, and the checks of the relation of two links.
NAMING = ("link", "leader", "relative_to", "parent", "holds", "on", "of", "base")
LISTING = ("links", "wheels")
OPTIONAL = {
    ("joints_named", "parent")
}  # a parent joint has its name, whatever the parent link is called
UNRELATED = (
    "joints_named",
    "mimics",
)  # the relation of two joints does not depend on the chain between them
RELATED = [
    case
    for case in CASES
    if case.name not in UNRELATED and set(NAMING) & set(case.arguments) - {"link"}
]
RELATED = [
    case for case in RELATED if case.arguments.get("relative_to") != case.arguments.get("link")
]

every_case = pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
every_edge = pytest.mark.parametrize(
    ("case", "argument"),
    [
        pytest.param(case, argument, id=f"{case.name}-{argument}")
        for case in CASES
        for argument in case.edges
    ],
)
every_related_case = pytest.mark.parametrize("case", RELATED, ids=[case.name for case in RELATED])


@every_case
def test_a_link_that_is_missing_is_named(case: Case[Scene]) -> None:
    """If a link is missing, the message names it and the existing links."""
    for argument in set(NAMING) & set(case.arguments):
        if (case.name, argument) in OPTIONAL:
            continue
        is_list = isinstance(case.arguments[argument], list)
        nowhere = ["nowhere"] if is_list else "nowhere"
        error = missing(case.check, case.passing, **{**case.arguments, argument: nowhere})
        assert (error.kind, error.name, error.known) == ("link", "nowhere", case.passing.links)
        assert "'nowhere'" in str(error)
    for argument in set(LISTING) & set(case.arguments) if case.name != "counts" else ():
        error = missing(
            case.check, case.passing, **{**case.arguments, argument: ["wheel", "nowhere"]}
        )
        assert (error.kind, error.name) == ("link", "nowhere")


@every_related_case
def test_unconnected_links_are_reported(case: Case[Scene]) -> None:
    """If no joints connect two links, a check says so instead of measuring."""
    error = missing(case.check, case.passing.without_joints(), **case.arguments)
    assert error.kind == "connection"
    assert " is not connected to " in str(error)


@every_related_case
def test_a_loop_of_joints_stops_no_check(case: Case[Scene]) -> None:
    """ROS 2 rejects a file with a loop; the joint that closes it is ignored and the rest is examined."""
    inner, outer = case.passing.links[-1], case.passing.links[0]
    looped = Scene(
        case.passing.text.replace(
            "</robot>", joint("zz_back", "fixed", inner, outer) + "\n</robot>"
        )
    )
    assert ask(case.check, looped, **case.arguments) == ask(
        case.check, case.passing, **case.arguments
    )


@every_case
def test_a_mesh_has_a_frame_and_a_colour_but_no_size(case: Case[Scene]) -> None:
    """Measuring a mesh, which the message names, needs manual grading; a mesh is no box, cylinder or sphere."""
    outcome = graded(
        case.check,
        case.passing.with_shape('<mesh filename="package://my_robot/meshes/part.stl"/>'),
        **case.arguments,
    )
    assert outcome.status == case.mesh_status
    assert outcome.status != "pending" or "'package://my_robot/meshes/part.stl'" in outcome.message


@every_case
def test_a_shape_without_size_is_no_shape(case: Case[Scene]) -> None:
    """Checks of visible shapes say that a zero-size visual shows nothing; other checks ignore this."""
    empty = case.passing.with_shape(box(0.0, 0.0, 0.0))
    if case.needs_size:
        error = missing(case.check, empty, **case.arguments)
        assert error.kind == ("collision" if case.check is collides_as else "visual")
        assert f"{error.name!r} has no {error.kind}" in str(error)
    else:
        assert ask(case.check, empty, **case.arguments).status == "passed"


@every_case
def test_what_xacro_leaves_open_is_not_wrong(case: Case[Scene]) -> None:
    """A value that only a run tells needs manual grading if it matters; one that xacro refuses never breaks a check."""
    head, rest = case.passing.text.replace("<robot ", f"<robot {XMLNS} ").split(">", 1)
    values = re.finditer(r'(?<=[a-z]=")[^"]*(?=")', rest)
    parts = re.finditer(
        r"<(visual|collision|inertial)>.*?</\1>|<(origin|axis|limit|mimic|dynamics) [^>]*/>",
        rest,
        re.DOTALL,
    )
    perhaps = '<xacro:if value="{0}">\n{1}\n</xacro:if>'
    for found, text in [
        *((found, "{0}") for found in values),
        *((found, perhaps) for found in parts),
    ]:
        for value, statuses in (
            ("$(env X)", ("passed", "pending")),
            ("${nothing}", ("passed", "pending", "failed")),
        ):
            xacro = (
                f"{head}>{rest[: found.start()]}{text.format(value, found[0])}{rest[found.end() :]}"
            )
            outcome = graded(
                case.check, Submitted({"robot.urdf.xacro": xacro.encode()}), **case.arguments
            )
            assert outcome.status in statuses, (outcome, xacro)


@every_case
def test_every_tolerance_has_an_edge(case: Case[Scene]) -> None:
    """A sample has an edge for each argument of its check that is a tolerance, as its text says: how far something may be off."""
    texts = describe(case.check).documentation.arguments
    tolerances = {
        name
        for name, text in texts.items()
        if re.match("How (far|large|deep) .* (may|may each) ", text)
    }
    assert set(case.edges) == tolerances


@every_edge
@pytest.mark.parametrize("sign", [1, -1])
def test_the_edge_of_a_tolerance(case: Case[Scene], argument: str, sign: int) -> None:
    """A check passes at the end of its tolerance and fails just outside, unless the tolerance is one-sided."""
    edge, tolerance = case.edges[argument], case.arguments[argument]
    inside, outside = (
        ask(case.check, edge(sign * share * tolerance), **case.arguments) for share in (1.0, 1.05)
    )
    assert inside.status == "passed", inside
    assert outside.status == ("passed" if sign < 0 and argument in case.one_sided else "failed"), (
        outside
    )
