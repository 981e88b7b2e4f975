"""What holds of all checks: the cases, missing links, links without joints, loops of joints, meshes, empty visuals."""

import pytest

from tests.checks.asking import ask, graded, missing
from tests.checks.cases import CASES, Case
from tests.checks.robots import Scene, box, joint, mesh

# The arguments that name links, and the checks that ask how one link stands to another.
NAMING = ("link", "relative_to", "parent", "holds", "on", "of", "base")
LISTING = ("links", "wheels")
OPTIONAL = {("joints_named", "parent")}  # a joint that holds a link has its name, whatever the parent is called
RELATED = [case for case in CASES if case.name != "joints_named" and set(NAMING) & set(case.arguments) - {"link"}]
RELATED = [case for case in RELATED if case.arguments.get("relative_to") != case.arguments.get("link")]

every_case = pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
every_related_case = pytest.mark.parametrize("case", RELATED, ids=[case.name for case in RELATED])


@every_case
def test_the_passing_robot_passes(case: Case) -> None:
    """A check passes the robot that is as it should be, says what it found, and points to no place."""
    outcome = ask(case.check, case.passing, **case.arguments)
    assert (outcome.status, outcome.message, outcome.location) == ("passed", case.says, None)


@every_case
def test_the_failing_robot_fails(case: Case) -> None:
    """A check fails the robot that is not, says what it found and expected, and points to the place in the file."""
    outcome = ask(case.check, case.failing, **case.arguments)
    assert (outcome.status, outcome.message) == ("failed", case.complains)
    assert outcome.location == (None if case.at is None else case.failing.place(case.at))


@every_case
def test_a_grade_run_finds_the_same(case: Case) -> None:
    """A check answers the same when it is asked as a criterion."""
    for scene in (case.passing, case.failing):
        assert graded(case.check, scene, **case.arguments) == ask(case.check, scene, **case.arguments)


@every_case
def test_a_link_that_is_missing_is_named(case: Case) -> None:
    """Whichever link a check asks for, a missing one is named, and the links that there are too."""
    for argument in set(NAMING) & set(case.arguments):
        if (case.name, argument) in OPTIONAL:
            continue
        error = missing(case.check, case.passing, **{**case.arguments, argument: "nowhere"})
        assert (error.kind, error.name, error.known) == ("link", "nowhere", case.passing.links)
        assert "'nowhere'" in str(error)
    for argument in set(LISTING) & set(case.arguments):
        error = missing(case.check, case.passing, **{**case.arguments, argument: ["wheel", "nowhere"]})
        assert (error.kind, error.name) == ("link", "nowhere")


@every_related_case
def test_links_that_no_joint_joins_have_no_relation(case: Case) -> None:
    """Where no joints lead from one link to the other, a check says so instead of measuring."""
    error = missing(case.check, case.passing.without_joints(), **case.arguments)
    assert error.kind == "connection"
    assert "no chain of joints leads from " in str(error)


@every_related_case
def test_a_loop_of_joints_does_not_hang_a_check(case: Case) -> None:
    """A loop makes ROS 2 reject the file: the joint that closes it is left out, and the rest is looked at."""
    inner, outer = case.passing.links[-1], case.passing.links[0]
    looped = Scene(case.passing.text.replace("</robot>", joint("zz_back", "fixed", inner, outer) + "\n</robot>"))
    assert ask(case.check, looped, **case.arguments) == ask(case.check, case.passing, **case.arguments)


def test_what_is_said_of_meshes() -> None:
    """A mesh has a colour and a frame but an unknown size: needs manual grading: what is measured, no mesh is a cylinder."""
    found = {case.name: graded(case.check, case.passing.with_shape(mesh()), **case.arguments).status for case in CASES}
    pending = {"bottom_at_height", "bottoms_at_height", "stands_on", "clear_of", "under_the_base", "rolls_forward"}
    assert {name for name, status in found.items() if status == "pending"} - {"centre_at"} == pending
    failed = {"shows_box", "shows_cylinder", "shows_sphere", "turns_about_itself"}
    assert {name for name, status in found.items() if status == "failed"} == failed


def test_a_pending_outcome_names_the_mesh() -> None:
    """The person who has to look is told at which mesh and why."""
    for case in CASES:
        outcome = graded(case.check, case.passing.with_shape(mesh("package://my_robot/wheel.dae")), **case.arguments)
        if outcome.status == "pending":
            assert "'package://my_robot/wheel.dae'" in outcome.message
            assert "needs manual grading" in outcome.message


def test_a_shape_without_size_is_no_shape() -> None:
    """Checks that look at what is shown say that a zero-size visual shows nothing; the others do not mind it."""
    indifferent = {"urdf_loads", "shows_nothing", "held_by", "joints_named", "root_of_tree", "frame_at", "axis_along"}
    for case in CASES:
        empty = case.passing.with_shape(box(0.0, 0.0, 0.0))
        if case.name in indifferent:
            assert ask(case.check, empty, **case.arguments).status == "passed"
        else:
            error = missing(case.check, empty, **case.arguments)
            assert error.kind == "visual"
            assert f"{error.name!r} has no visual" in str(error)
