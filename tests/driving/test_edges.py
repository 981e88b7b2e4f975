"""How robots stand and drive for which the usual words do not fit: none has a wheel that rolls, a mass, or a place to rest."""

import pytest

from grader.base.errors import NotDecided, RubricError
from grader.lab.checks import driving
from grader.ros.urdf import resting
from grader.ros.urdf.driving import describe_driving, plan_drive
from grader.ros.urdf.resting import find_rest, make_body
from grader.ros.urdf.standing_robot import StandingRobot
from tests.driving.test_laws import base, configuration, part

WHEEL = '<cylinder radius="0.1" length="0.05"/>'
ACROSS, ALONG, UP = '<axis xyz="0 0 1"/>', "-1.5707963 0 0", "0 0 0"
LEFT = part("left", WHEEL, "0 0.2 0", ALONG, ACROSS)
RIGHT = part("right", WHEEL, "0 -0.2 0", ALONG, ACROSS)
BALL = part("ball", '<sphere radius="0.05"/>', "-0.2 0 -0.05")


def rover(*others: str, mass_at: str = "-0.05 0 0") -> str:
    """Return how a robot with two wheels stands and drives, in one line."""
    robot = configuration(base("0.4 0.2 0.05", mass_at), LEFT, RIGHT, *others)
    return describe_driving(robot, ["left", "right"]).text


def test_a_line_on_how_a_robot_stands_and_drives() -> None:
    """It says what a person would see; nothing where that is not known."""
    assert rover(BALL).startswith(
        "on level ground, it stands level on 'left', 'right' and 'ball'; "
    )
    assert rover(mass_at="-0.05 0 0.5") == "on level ground, it tips over"
    low = part("ball", '<sphere radius="0.05"/>', "-0.2 0 -0.01")
    assert rover(low).startswith("on level ground, it leans by ")
    mesh = part("cover", '<mesh filename="package://a/b.stl"/>', "0 0 0.1")
    assert rover(BALL, mesh) == ""


def faults(*others: str, mass_at: str = "-0.05 0 0") -> tuple[list[str], list[str]]:
    """Return what is wrong with how a robot with two wheels stands, and with where it drives."""
    robot = configuration(base("0.4 0.2 0.05", mass_at), LEFT, RIGHT, *others)
    driving = describe_driving(robot, ["left", "right"])
    texts = [fault.text for fault in driving.rest_faults]
    return texts, [fault.text for fault in driving.course_faults]


def test_what_is_wrong_with_how_a_robot_stands() -> None:
    """It leans on a caster, hangs or tips over; one without a caster, which rests on its base, may balance."""
    assert faults(BALL) == ([], [])
    assert faults() == ([], [])
    high = part("ball", '<sphere radius="0.05"/>', "-0.2 0 -0.01")
    [leaning], _ = faults(high)
    assert leaning.startswith("it leans by ")
    assert leaning.endswith(" on 'left', 'right' and 'ball'")
    four = [
        part(f"ball{number}", '<sphere radius="0.05"/>', f"{x} {y} -0.1")
        for number, (x, y) in enumerate(((0.2, 0.1), (0.2, -0.1), (-0.2, 0.1), (-0.2, -0.1)))
    ]
    hanging, _ = faults(*four)
    assert hanging == ["'left' is 50 mm above the ground", "'right' is 50 mm above the ground"]
    assert faults(mass_at="-0.05 0 0.5")[0] == ["it tips over"]
    large = part("right", '<cylinder radius="0.12" length="0.05"/>', "0 -0.2 0.02", ALONG, ACROSS)
    robot = configuration(base("0.4 0.2 0.05", "-0.05 0 0"), LEFT, large, BALL)
    described = describe_driving(robot, ["left", "right"])
    assert described.rest_faults == ()
    assert described.course_faults[0].text.endswith("'left' is 16.7 % smaller")
    assert described.course_faults[0].at is not None


def test_no_line_on_wheels_that_may_be_omni_wheels() -> None:
    """Nobody says what rollers three wheels have whose axes cross: where they drive is not known."""
    places = (("a", "0.2 0 0", "0 1.5707963 0"), ("b", "0 0.2 0", ALONG), ("c", "0 -0.2 0", ALONG))
    wheels = [part(name, WHEEL, xyz, rpy, ACROSS) for name, xyz, rpy in places]
    robot = configuration(base("0.2 0.2 0.05", "0.01 0 0"), *wheels)
    assert describe_driving(robot, ["a", "b", "c"]).text == ""
    drive = plan_drive(robot, ["a", "b", "c"])
    assert drive is not None
    assert drive.text == "on level ground, it stands level on 'a', 'b' and 'c'"


@pytest.mark.parametrize("rollers", [None, [45.0, -45.0]])
def test_wheels_that_stand_up_do_not_roll(rollers: list[float] | None) -> None:
    """Two discs on the ground turn about vertical axes, with or without rollers."""
    discs = [
        part(name, WHEEL, f"0 {y} 0", UP, ACROSS) for name, y in (("left", 0.2), ("right", -0.2))
    ]
    robot = configuration(base("0.1 0.1 0.02", "0 0 0"), *discs)
    for check in (driving.drives_straight, driving.turns_in_place):
        outcome = check(robot, wheels=["left", "right"], rollers=rollers)
        assert outcome.message.startswith("'left' does not roll: its axis is 90 degrees off level")


def test_wheels_whose_rollers_turn_forward_drive_nothing() -> None:
    """Neither the robot moves nor does it turn: the rollers turn in place of the wheels."""
    robot = configuration(base("0.4 0.2 0.05", "-0.05 0 0"), LEFT, RIGHT, BALL)
    straight = driving.drives_straight(robot, wheels=["left", "right"], rollers=[0.0, 0.0])
    turning = driving.turns_in_place(robot, wheels=["left", "right"], rollers=[0.0, 0.0])
    assert (straight.message, turning.message) == ("it does not drive", "it does not turn")


def test_a_mass_below_the_ground_never_tips() -> None:
    """As of a robot on a rail, whose ballast hangs below it."""
    robot = configuration(base("0.4 0.4 0.05", "0 0 -1"), LEFT, RIGHT, BALL)
    outcome = driving.does_not_tip(robot, on=["left", "right", "ball"], acceleration=5.0)
    assert outcome.status == "passed"


def test_rollers_are_given_for_each_wheel() -> None:
    """Of other numbers the rubric is wrong, and not the robot."""
    robot = configuration(base("0.4 0.2 0.05", "0 0 0"), LEFT, RIGHT, BALL)
    with pytest.raises(RubricError):
        driving.drives_straight(robot, wheels=["left", "right"], rollers=[45.0])


def test_four_wheels_with_parallel_axes_are_no_omni_wheels() -> None:
    """They are decided without the angles of rollers."""
    wheels = [
        part(name, WHEEL, f"{x} {y} 0", ALONG, ACROSS)
        for name, x, y in (("a", 0.2, 0.2), ("b", 0.2, -0.2), ("c", -0.2, 0.2), ("d", -0.2, -0.2))
    ]
    robot = configuration(base("0.3 0.2 0.05", "0 0 0"), *wheels)
    assert driving.drives_straight(robot, wheels=["a", "b", "c", "d"]).status == "passed"


@pytest.mark.parametrize(
    ("shapes", "reason"),
    [
        (['<box size="1 1 0"/>'], "no mass"),
        (['<box size="1e200 1e200 1e200"/>', '<box size="1 1 1"/>'], "no mass"),
        (['<box size="0.1 0.1 0.1"/>'] * 301, "shapes"),
    ],
)
def test_what_cannot_be_told_of_a_robot(shapes: list[str], reason: str) -> None:
    """Its numbers, its masses or the number of its shapes leave open how it stands."""
    parts = [part(f"l{k}", shape, f"{k * 0.01} 0 0") for k, shape in enumerate(shapes)]
    robot = configuration('<link name="base"/>', *parts)
    with pytest.raises(NotDecided, match=reason):
        find_rest(make_body(robot, "base"))
    if len(shapes) > resting.MAX_SHAPES:
        with pytest.raises(NotDecided, match=reason):
            StandingRobot(robot, ["l0"])


def test_numbers_may_be_too_large() -> None:
    """A ball that is 1e150 m wide has no place at which it touches the ground, but for rounding."""
    huge = part("huge", '<sphere radius="1e150"/>', "0 0 0", "0.3 0.2 0")
    with pytest.raises(NotDecided, match="too large"):
        find_rest(make_body(configuration(base("0.1 0.1 0.1", "0 0 0"), huge), "base"))


def test_a_ball_rests_anywhere_and_a_thin_plate_lies_down() -> None:
    """A ball stays as it was set down; a plate without thickness that stands on its edge falls."""
    ball = configuration(
        '<link name="base"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>'
    )
    assert find_rest(make_body(ball, "base")).tilt == pytest.approx(0.0, abs=1e-6)
    heavy = part("ball", '<sphere radius="0.5"/>', "0 0 0")
    rolling = configuration(base("0.01 0.01 0.01", "0.4 0 0.1"), heavy)
    assert find_rest(make_body(rolling, "base")).has_fallen
    plate = configuration(base("1 0 1", "0 0 0"))
    assert find_rest(make_body(plate, "base")).has_fallen


def test_a_fall_ends_after_its_most_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it has come to until then is how the robot stands."""
    monkeypatch.setattr(resting, "_MAX_STEPS", 1)
    robot = configuration(base("0.4 0.2 0.05", "-0.15 0 0"), LEFT, RIGHT)
    assert find_rest(make_body(robot, "base")).tilt > 0.0
