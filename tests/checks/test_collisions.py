"""The collision shapes of a link against its visuals: as solids, in place, one to one."""

from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.collisions import collides_as, collision_matches_visual
from grader.errors import RubricError
from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape
from grader.robot.transforms import Transform, Vector, rotation_about, rotation_from_rpy
from tests.checks.outcomes import Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import (
    Numbers,
    Scene,
    box,
    collision,
    cylinder,
    joint,
    link,
    mesh,
    scene,
    sphere,
    turned,
    visual,
)
from tests.examples import examples

CLOSE: Arguments = {"link": "arm", "tolerance": 0.002}
BRICK, ROD, BALL = box(0.6, 0.4, 0.2), cylinder(0.1, 0.5), sphere(0.1)
_angle = st.floats(-3.0, 3.0)
_rpy = st.tuples(_angle, _angle, _angle)


def arm(*shapes: str) -> Scene:
    """Return a link with these visuals and collisions."""
    return scene(link("arm", *shapes))


# --- Equal solids -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shape", "other", "rpy"),
    [
        (BRICK, BRICK, turned(roll=180)),
        (BRICK, BRICK, turned(yaw=180)),
        (BRICK, box(0.4, 0.6, 0.2), turned(yaw=90)),
        (BRICK, box(0.2, 0.4, 0.6), turned(pitch=-90)),
        (BRICK, box(0.4, 0.2, 0.6), turned(roll=90, yaw=90)),
        (box(0.1, 0.1, 0.3), box(0.1, 0.1, 0.3), turned(yaw=90)),
        (ROD, ROD, turned(roll=180)),
        (ROD, ROD, turned(yaw=37)),
        (BALL, BALL, turned(roll=11, pitch=-70, yaw=37)),
        (mesh(), mesh(), turned(yaw=0.9)),
    ],
)
def test_symmetries_do_not_matter(shape: str, other: str, rpy: Numbers) -> None:
    """A solid that is turned onto itself, or a box on its side with its edges exchanged, is the same solid."""
    body = arm(visual(shape, xyz="1 2 3"), collision(other, xyz="1 2 3", rpy=rpy))
    assert passes(collision_matches_visual, body, **CLOSE) == "'arm' has 1 collision shape, as shown"


@pytest.mark.parametrize(
    ("shape", "other", "rpy", "told"),
    [
        (BRICK, BRICK, turned(yaw=90), "turned by 90 degrees"),
        (BRICK, BRICK, turned(roll=2), "turned by 2 degrees"),
        (BRICK, box(0.6, 0.4, 0.21), "", "of a size 10 mm off"),
        (box(0.1, 0.1, 0.3), box(0.1, 0.1, 0.3), turned(yaw=45), "turned by 45 degrees"),
        (ROD, ROD, turned(roll=90), "turned by 90 degrees"),
        (ROD, cylinder(0.11, 0.5), "", "of a size 10 mm off"),
        (ROD, cylinder(0.1, 0.4), "", "of a size 100 mm off"),
        (BALL, sphere(0.2), "", "of a size 100 mm off"),
        (mesh(), mesh(), turned(yaw=1.1), "turned by 1.1 degrees"),
        (
            BRICK,
            box(0.6, -0.4, 0.2),
            "",
            "of a size 800 mm off",
        ),  # simulators refuse it, although ROS 2 does not check it
    ],
)
def test_other_solids_fail(shape: str, other: str, rpy: Numbers, told: str) -> None:
    """The message says in what the nearest collision shape differs."""
    body = arm(visual(shape), collision(other, rpy=rpy))
    assert fails(collision_matches_visual, body, **CLOSE).endswith(f"({told})")


SHAPES = ((Box((0.6, 0.4, 0.2)), BRICK), (Cylinder(0.1, 0.5), ROD), (Sphere(0.1), BALL))
SYMMETRIES = {Box: ((1.0, 0.0, 0.0), pi), Cylinder: ((0.0, 0.0, 1.0), 0.7), Sphere: ((0.6, 0.0, 0.8), 2.1)}


@examples(10)
@given(st.sampled_from(SHAPES), _rpy)
def test_turned_solids(shape: tuple[Shape, str], rpy: Vector) -> None:
    """However both are turned, a symmetry changes nothing, and a shift along any axis of the link counts in full."""
    kind, text = shape
    pose = Transform(rotation_from_rpy(rpy), (0.1, 0.2, 0.3))
    same = (pose @ Transform(rotation_about(*SYMMETRIES[type(kind)]))).rpy
    shown = visual(text, xyz=pose.translation, rpy=rpy)
    for off, status in ((0.0, "passed"), (0.0019, "passed"), (0.0021, "failed"), (-0.0021, "failed")):
        body = arm(shown, collision(text, xyz=(0.1, 0.2 + off, 0.3), rpy=same))
        assert ask(collision_matches_visual, body, **CLOSE).status == status


# --- One to one -------------------------------------------------------------------------------------------------------


def test_several_shapes_in_any_order() -> None:
    """The order of the shapes does not matter, and shapes without a size do not count."""
    shown = [visual(BRICK), visual(ROD, xyz="0 0 0.35"), visual(BALL, xyz="0 0 0.6"), visual(box(0.0, 0.0, 0.0))]
    solid = [collision(BALL, xyz="0 0 0.6"), collision(sphere(0.0)), collision(ROD, xyz="0 0 0.35"), collision(BRICK)]
    assert passes(collision_matches_visual, arm(*shown, *solid), **CLOSE) == "'arm' has 3 collision shapes, as shown"


def test_near_shapes_find_their_partners() -> None:
    """Where a shape fits two others, all get a partner if that is possible."""
    shown = [visual(BALL, xyz="0 0 0.0015"), visual(BALL, xyz="0 0 0")]
    solid = [collision(BALL, xyz="0 0 0.001"), collision(BALL, xyz="0 0 0.003")]
    assert ask(collision_matches_visual, arm(*shown, *solid), **CLOSE).status == "passed"
    assert ask(collision_matches_visual, arm(*reversed(shown), *reversed(solid)), **CLOSE).status == "passed"


def test_no_collision() -> None:
    """A link without collision shapes fails, at the link; one that shows nothing misses its visual."""
    for shapes in ((visual(BRICK),), (visual(BRICK), collision(sphere(0.0)))):
        assert fails(collision_matches_visual, arm(*shapes), at="<link ", **CLOSE) == (
            "link 'arm' has no collision shape with a size; it should have the shapes that it shows"
        )
    assert missing(collision_matches_visual, arm(visual(BRICK)), **CLOSE).kind == "collision"
    assert missing(collision_matches_visual, arm(collision(BRICK)), **CLOSE).kind == "visual"


IS_ROD = "a cylinder of radius 0.1 m and length 0.5 m"
TWO = visual(BALL) + visual(BALL, xyz="0 0 0") + collision(BALL)
WRONG = visual(BRICK) + visual(ROD) + collision(BALL) + collision(ROD, xyz="0 0 0.01")
# Visuals and collisions of a link, the end of the message, and what is at its place.
UNPAIRED = {
    "one for two": (TWO, "no collision shape of 'arm' is a sphere of radius 0.1 m at 0 0 0 m, as shown", None),
    "not shown": (
        visual(BRICK) + collision(BRICK) + collision(ROD, xyz="0 0 1"),
        f"'arm' has a collision shape that it does not show: {IS_ROD} at 0 0 1 m", None,
    ),
    "another kind": (
        visual(ROD) + collision(box(0.2, 0.2, 0.5)),
        f"no collision shape of 'arm' is {IS_ROD} at 0 0 0 m, as shown; the nearest is a box 0.2 0.2 0.5 m at 0 0 0 m",
            "<box",
    ),
    "nearest of several": (WRONG, f"the nearest is {IS_ROD} at 0 0 0.01 m (10 mm away)", 'xyz="0 0 0.01"'),
}  # fmt: skip


@pytest.mark.parametrize("name", UNPAIRED)
def test_shapes_without_a_partner(name: str) -> None:
    """Each visual needs a collision shape of its own, and each of these a visual; the most similar pair is named."""
    shapes, end, at = UNPAIRED[name]
    message = fails(collision_matches_visual, arm(shapes), at=at, **CLOSE)
    assert message.endswith(end)
    assert end.startswith("the nearest") or message == end


def test_a_collision_that_ros_cannot_read() -> None:
    """The message says why ROS 2 drops it."""
    bad = arm(visual(BRICK), collision('<box sise="1 1 1"/>'))
    assert "'sise'" in fails(collision_matches_visual, bad, at="<box sise", **CLOSE)


# --- Meshes -----------------------------------------------------------------------------------------------------------

HULL = mesh("package://my_robot/meshes/hull.stl")


@pytest.mark.parametrize(
    ("solid", "status"),
    [
        (collision(mesh()), "passed"),
        (collision(mesh(), xyz="0 0 0.0019"), "passed"),
        (collision(mesh(), xyz="0 0 0.0021"), "failed"),
        (collision(mesh(scale="2 2 2")), "failed"),
        (collision(HULL), "pending"),
        (collision(HULL) + collision(HULL, xyz="1 0 0"), "pending"),
        (collision(BRICK), "failed"),
        (collision(HULL) + collision(BRICK), "failed"),
    ],
)
def test_meshes(solid: str, status: str) -> None:
    """A mesh is the same file at the same scale and pose; another file may have the same shape, and no box has."""
    assert graded(collision_matches_visual, arm(visual(mesh()), solid), **CLOSE).status == status


def test_what_is_pending_is_told() -> None:
    """The message names the mesh that is not shown."""
    outcome = graded(collision_matches_visual, arm(visual(mesh()), collision(HULL)), **CLOSE)
    assert outcome.message == (
        "whether the collision mesh 'package://my_robot/meshes/hull.stl' of 'arm' has the shape that is shown"
        " cannot be determined: mesh files are not opened; needs manual grading"
    )


# --- Absurd numbers ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [1e-300, 1e160, 1e300])
@pytest.mark.parametrize("far", ["0 0 0", "1e300 1e300 1e300", "-1e308 1e308 1e308"])
def test_absurd_numbers(size: float, far: str) -> None:
    """Overflow never passes a shape in another place, and never breaks the check."""
    for text in (box(size, size, size), sphere(size), cylinder(size, size)):
        here = visual(text)
        status = graded(collision_matches_visual, arm(here, collision(text, xyz=far)), **CLOSE).status
        assert status == ("passed" if far == "0 0 0" else "failed")


def test_very_many_shapes() -> None:
    """A link with more shapes than are compared needs manual grading."""
    shapes = [shape for _ in range(51) for shape in (visual(BALL), collision(BALL))]
    assert graded(collision_matches_visual, arm(*shapes), **CLOSE).status == "pending"


# --- A given shape ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "shape", "status"),
    [
        ({"box": (0.6, 0.4, 0.2)}, collision(box(0.2, 0.4, 0.6), xyz="1 2 3"), "passed"),  # no place is asked for
        ({"box": (0.6, 0.4, 0.2), "rpy": (0, 0, 0)}, collision(box(0.2, 0.4, 0.6)), "failed"),
        ({"box": (0.6, 0.4, 0.2), "rpy": (0, 0, 0)}, collision(box(0.2, 0.4, 0.6), rpy=turned(pitch=90)), "passed"),
        ({"cylinder": (0.1, 0.5), "rpy": (0, pi / 2, 0)}, collision(ROD, rpy=turned(pitch=-90)), "passed"),
        ({"cylinder": (0.1, 0.5), "rpy": (0, pi / 2, 0)}, collision(ROD), "failed"),
        ({"cylinder": (0.1, 0.5)}, collision(ROD, rpy=turned(pitch=-90)), "passed"),
        ({"cylinder": (0.1, 0.5)}, collision(BALL), "failed"),
        ({"cylinder": (0.1, 0.5)}, collision(mesh()), "failed"),
        ({"sphere": 0.1, "xyz": (0, 0, 1)}, collision(BALL, xyz="0 0 1", rpy=turned(yaw=37)), "passed"),
        ({"sphere": 0.1, "xyz": (0, 0, 1)}, collision(BALL), "failed"),
        ({"sphere": 0.1}, collision(ROD) + collision(BALL), "passed"),
        ({"sphere": 0.1, "only": True}, collision(ROD) + collision(BALL), "failed"),
        ({"sphere": 0.1, "only": True}, collision(sphere(0)) + collision(BALL), "passed"),
    ],
)
def test_a_collision_is_a_given_shape(arguments: Arguments, shape: str, status: str) -> None:
    """A link has a collision shape of the given size, in the given place if there is one; symmetric equivalents count."""
    assert graded(collides_as, arm(visual(BRICK), shape), **CLOSE, **arguments).status == status


def test_the_place_can_be_given_in_another_frame() -> None:
    """The collision is placed by the joints between."""
    held = scene(link("base"), link("arm", collision(BALL)), joint("j", "fixed", "base", "arm", xyz="0 0 2"))
    given: Arguments = {**CLOSE, "sphere": 0.1, "relative_to": "base"}
    assert passes(collides_as, held, xyz=(0.0, 0.0, 2.0), **given) == (
        "'arm' collides as a sphere of radius 0.1 m at 0 0 2 m in 'base'"
    )
    assert fails(collides_as, held, xyz=(0.0, 0.0, 0.0), **given).endswith("(2000 mm away)")
    assert missing(collides_as, scene(link("arm", visual(BALL))), **CLOSE, sphere=0.1).kind == "collision"


@pytest.mark.parametrize("shapes", [{}, {"sphere": 0.1, "box": (1.0, 1.0, 1.0)}])
def test_exactly_one_shape_is_given(shapes: Arguments) -> None:
    """Otherwise the rubric is refused."""
    complaint = "^the criterion only: collides_as takes exactly one of box, cylinder and sphere$"
    with pytest.raises(RubricError, match=complaint):
        graded(collides_as, arm(collision(BALL)), **CLOSE, **shapes)


def test_the_nearest_of_several_collision_shapes_is_named() -> None:
    """It is the one that is least off in place, size and orientation together; any is nearer than a mesh."""
    near = collision(cylinder(0.1, 0.52), xyz="0 0 0.01", rpy=turned(roll=1))
    others = [
        collision(mesh()), collision(cylinder(0.1, 0.2), xyz="0 0 0.01"), collision(ROD, xyz="0 0 0.4"),
        collision(ROD, rpy=turned(roll=90)),
    ]  # fmt: skip
    for other in others:
        for shapes in ((other, near), (near, other)):
            body = arm(*shapes)
            message = fails(
                collides_as,
                body,
                link="arm",
                tolerance=0.001,
                cylinder=(0.1, 0.5),
                xyz=(0.0, 0.0, 0.0),
                rpy=(0.0, 0.0, 0.0),
            )
            assert "; the nearest is a cylinder of radius 0.1 m and length 0.52 m" in message
