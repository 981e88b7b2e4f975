"""How the robot of a picture drives, as numbers for the script of a page: what the checks compute, of the student's robot only."""

import json
from itertools import pairwise
from math import asin, degrees, hypot
from types import SimpleNamespace
from typing import Any

import pytest

from grader.report.drawing.drive import drive_data
from grader.report.drawing.graded_picture import draw_report
from grader.report.drawing.picture import plain_picture
from grader.report.drawing.space import space_data, without_names
from grader.ros.urdf.driving import plan_drive
from tests.driving.test_edges import BALL, LEFT, RIGHT
from tests.driving.test_laws import base, configuration, part
from tests.samples import SAMPLES

pytestmark = pytest.mark.slow

BODY = base("0.4 0.2 0.05", "-0.05 0 0")


def drive_of(*elements: str, meshes: Any = None) -> Any:
    """Return how a robot drives whose wheels nothing names, as the page has it; None if it does not."""
    picture = plain_picture(configuration(*elements), "base", meshes)
    assert picture is not None
    return json.loads(json.dumps(drive_data(picture), allow_nan=False))


def sample_drive(name: str) -> Any:
    """Return how the robot of a sample drives."""
    picture = draw_report(SAMPLES[name].grade())
    assert picture is not None
    return drive_data(picture)


def test_a_correct_robot_drives_straight() -> None:
    """It stays where it is when it is set down, and drives by its radius for each radian."""
    drive = sample_drive("reference")
    assert drive["fall"][0][:3] == [0, 0, 1]
    assert drive["motion"] == pytest.approx([0.1, 0, 0], abs=1e-4)
    assert drive["joints"] == ["base_left_wheel_joint", "base_right_wheel_joint"]
    assert drive["text"].endswith("when its wheels turn forward, it drives straight ahead.")


def test_a_robot_leans_and_turns_on_the_spot() -> None:
    """A caster at the back lets the front down; an axis to the other side turns the robot."""
    *_, (x, y, _, height) = sample_drive("caster-at-the-back")["fall"]
    assert degrees(asin(hypot(x, y))) == pytest.approx(12.8, abs=0.1)
    assert height < 0.17
    _, _, turn = sample_drive("axis-negated")["motion"]
    assert abs(turn) > 0.4


def test_a_robot_that_tips_over_falls_to_the_side_of_its_mass() -> None:
    """It falls in steps of some 15 degrees until it lies, and its wheels do not drive it."""
    drive = drive_of(base("0.4 0.2 0.05", "-0.5 0 0.2"), LEFT, RIGHT)
    ups = [(x, z) for x, _, z, _ in drive["fall"]]
    assert ups[0] == (0, 1)
    assert ups[-1][0] > 0.9
    assert all(a[0] * b[0] + a[1] * b[1] > 0.94 for a, b in pairwise(ups))
    heights = [height for *_, height in drive["fall"]]
    assert heights == sorted(heights, reverse=True)


def test_wheels_that_nothing_names_are_those_that_roll() -> None:
    """Not a lidar that spins, nor a caster that swivels, nor a wheel that is not round about its joint."""
    lidar = part(
        "lidar", '<cylinder radius="0.05" length="0.05"/>', "0 0 0.1", axis='<axis xyz="0 0 1"/>'
    )
    assert drive_of(BODY, LEFT, RIGHT, BALL, lidar)["joints"] == ["left_joint", "right_joint"]
    assert drive_of(BODY, BALL, lidar) is None
    assert drive_of(BODY, BALL) is None
    cam = part(
        "cam", '<box size="0.2 0.2 0.05"/>', "0 0.3 0", "-1.5707963 0 0", '<axis xyz="0 0 1"/>'
    )
    assert drive_of(BODY, cam, BALL) is None


def test_a_wheel_that_hangs_does_not_drive() -> None:
    """The robot rests, and the text says why it stays."""
    high = LEFT.replace("0 0.2 0", "0 0.2 0.03")
    drive = drive_of(
        BODY, high, RIGHT, BALL, part("foot", '<sphere radius="0.05"/>', "0 0.2 -0.05")
    )
    assert (drive["joints"], drive["motion"]) == ([], [])
    assert drive["text"].endswith("and 'foot'; 'left' is 30 mm above the ground.")


def test_a_wheel_that_no_joint_turns_does_not_drive() -> None:
    """The robot is set down only."""
    robot = configuration(BODY, LEFT.replace("continuous", "fixed"), RIGHT, BALL)
    drive = plan_drive(robot, ["left", "right"])
    assert drive is not None
    assert drive.joints == ()
    assert drive.text.startswith("on level ground, it stands level on ")


def test_page_of_a_robot_without_wheels_has_no_drive() -> None:
    """Such as an arm."""
    picture = draw_report(SAMPLES["arm/axis-sign"].grade())
    assert picture is not None
    data = space_data(picture, {})
    assert data is not None
    assert "drive" not in data


def test_an_anonymous_robot_drives_without_names() -> None:
    """Its joints have numbers, and there is no text."""
    picture = draw_report(SAMPLES["reference"].grade())
    assert picture is not None
    data = space_data(picture, {})
    assert data is not None
    drive = without_names(data)["drive"]
    assert all(name.startswith("joint ") for name in drive["joints"])
    assert drive["text"] == ""


def test_a_robot_rests_on_the_boxes_of_its_meshes() -> None:
    """Where all meshes of a link are shown, which the text says; without one of them nothing is known."""
    mesh = '<mesh filename="package://a/foot.stl" scale="2 1 1"/>'
    foot = part("foot", mesh, "-0.2 0 0")
    triangles = SimpleNamespace(bounds=((-0.01, -0.02, -0.1), (0.01, 0.02, 0.0)))
    shown, missing = (SimpleNamespace(load=lambda _, got=got: got) for got in (triangles, "no"))
    drive = drive_of(BODY, LEFT, RIGHT, foot, meshes=shown)
    assert "stands level on 'left', 'right' and 'foot'" in drive["text"]
    assert drive["text"].endswith(", if its meshes are boxes.")
    assert drive["motion"] == pytest.approx([0.1, 0, 0], abs=1e-4)
    assert drive_of(BODY, LEFT, RIGHT, foot, meshes=missing) is None
    assert drive_of(BODY, LEFT, RIGHT, foot) is None
    solid = foot.replace(
        "</visual>", '</visual><collision><geometry><sphere radius="0.1"/></geometry></collision>'
    )
    drive = drive_of(BODY, LEFT, RIGHT, solid, meshes=shown)
    assert drive["text"].endswith("it drives straight ahead.")


@pytest.mark.parametrize("value", ["inf", "nan", "1e308", "1e200", "1e-320", "0", "-1", "ten"])
@pytest.mark.parametrize("number", range(8))
def test_every_number_of_a_student_is_data(number: int, value: str) -> None:
    """Numbers that are too large, or none, leave data that JSON can have."""
    values = ["0.05", "0.03", "0.1", "0.4", "0.1", "1", "1", "0.06"]
    values[number] = value
    radius, length, y, box, mass_at, axis, ground, ball = values
    wheel = f'<cylinder radius="{radius}" length="{length}"/>'
    drive_of(
        base(f"{box} 0.2 0.05", f"{mass_at} 0 {mass_at}"),
        part("left", wheel, f"0 {y} 0", "-1.5707963 0 0", f'<axis xyz="0 0 {axis}"/>'),
        part("right", wheel, "0 -0.1 0", f"-1.5707963 0 {ground}", '<axis xyz="0 0 1"/>'),
        part("ball", f'<sphere radius="{ball}"/>', "-0.2 0 0"),
    )
