"""The mass of a link, and its inertia against that of a solid: equivalents, limits, and what each mistake is called."""

from collections.abc import Sequence
from math import nan, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.inertia import inertia_plausible, mass_is
from grader.robot.inertia import Tensor, shifted, solid_inertia, turned, uniform_solid
from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape
from grader.robot.transforms import IDENTITY, Transform, Vector, rotation_from_rpy
from tests.checks.outcomes import Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import (
    Numbers,
    Scene,
    box,
    collision,
    cylinder,
    inertial,
    link,
    mesh,
    scene,
    sphere,
    visual,
)
from tests.examples import examples

TEN: Arguments = {"link": "arm", "tolerance": 10.0}
MASS: Arguments = {"link": "arm", "mass": 0.5, "tolerance": 0.01}
ROD = Cylinder(0.05, 0.6)
PLATE = Box((0.6, 0.4, 0.2))
BALL = Sphere(0.1)
TEXTS = {ROD: cylinder(0.05, 0.6), PLATE: box(0.6, 0.4, 0.2), BALL: sphere(0.1)}
_angle = st.floats(-3.0, 3.0)
_rpy = st.tuples(_angle, _angle, _angle)


def arm(
    inertia: Sequence[float],
    *shapes: str,
    mass: float = 2.0,
    xyz: Numbers = "",
    rpy: Numbers = "",
) -> Scene:
    """Return a link with an inertial and these shapes."""
    return scene(link("arm", inertial(mass, inertia, xyz=xyz, rpy=rpy), *shapes))


def scaled(inertia: Tensor, factor: float) -> list[float]:
    """Return an inertia times a factor."""
    return [value * factor for value in inertia]


# --- Mass -------------------------------------------------------------------------------------------------------------


def test_grams_are_recognised() -> None:
    """A mass that is a thousand times too large looks like grams."""
    message = fails(mass_is, arm((1.0,) * 6, mass=500.0), at='value="500.0"', **MASS)
    assert message == "the mass of 'arm' is 500 kg; it should be 0.5 kg (499.5 kg too large): is it in grams?"
    message = fails(mass_is, arm((1.0,) * 6, mass=4000.0), link="arm", mass=4.0, tolerance=0.01)
    assert message.endswith("it should be 4 kg (3996 kg too large): is it in grams?")
    for mass, is_in_grams in ((496.0, True), (504.0, True), (494.0, False), (506.0, False)):
        message = fails(mass_is, arm((1.0,) * 6, mass=mass), **MASS)
        assert message.endswith("grams?") == is_in_grams


def test_a_missing_inertial() -> None:
    """A link without <inertial> has no mass and no inertia; the first criterion fails, at the link."""
    bare = scene(link("arm", visual(box(1.0, 1.0, 1.0))))
    for check, arguments in ((mass_is, MASS), (inertia_plausible, TEN)):
        error = missing(check, bare, **arguments)
        assert (error.kind, error.name) == ("inertial", "arm")
        assert fails(check, bare, at="<link ", **arguments) == "link 'arm' has no valid <inertial>"


def test_an_inertial_that_ros_cannot_read() -> None:
    """The message says why ROS 2 drops it, and never that of a bad visual."""
    bad = Scene(arm((1.0,) * 6).text.replace('mass value="2.0"', 'mass value="2 kg"'))
    assert "cannot read value=" in fails(mass_is, bad, at='value="2 kg"', **MASS)
    other = scene(link("arm", visual("<blob/>")))
    assert fails(mass_is, other, at="<link ", **MASS) == "link 'arm' has no valid <inertial>"


# --- Impossible inertias ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("mass", "inertia", "expected"),
    [
        (0.0, (1, 0, 0, 1, 0, 1), "the mass of 'arm' is 0 kg; it should be positive"),
        (-2.0, (1, 0, 0, 1, 0, 1), "the mass of 'arm' is -2 kg; it should be positive"),
        (2.0, (0, 0, 0, 0, 0, 0), "not positive definite: its principal moments are 0, 0 and 0 kg m^2"),
        (2.0, (1, 0, 0, -1, 0, 1), "not positive definite: its principal moments are -1, 1 and 1 kg m^2"),
        (2.0, (1, 1, 0, 1, 0, 1), "not positive definite: its principal moments are 0, 1 and 2 kg m^2"),
        (2.0, (1, 2, 0, 1, 0, 1), "not positive definite: its principal moments are -1, 1 and 3 kg m^2"),
        (2.0, (1, 0, 0, 1, 0, 3), "none should be larger than the sum of the other two"),
        (2.0, (1, 0, 0, 1, 0, 2.03), "none should be larger than the sum of the other two"),
        (2.0, (1e308, 0, 0, 1e308, 0, 1e308), "not positive definite"),
    ],
)
@pytest.mark.parametrize("shape", [box(1.0, 1.0, 1.0), mesh(), box(0.0, 0.0, 0.0)])
def test_what_no_body_has(mass: float, inertia: Sequence[float], expected: str, shape: str) -> None:
    """It fails whatever the shape is, also if that is a mesh or has no size."""
    message = fails(inertia_plausible, arm(inertia, visual(shape), mass=mass), **TEN)
    assert expected in message


@pytest.mark.parametrize("inertia", [(1, 0, 0, 1, 0, 2), (0.0133, 0, 0, 0.0133, 0, 0.0267), (1, 0, 0, 1, 0, 1e-6)])
def test_plates_and_rods_are_possible(inertia: Sequence[float]) -> None:
    """A flat plate is exactly at the limit, and rounded numbers beyond it; a mesh then needs manual grading."""
    assert graded(inertia_plausible, arm(inertia, visual(mesh())), **TEN).status == "pending"


# --- Equivalents ------------------------------------------------------------------------------------------------------


@examples(10)
@given(st.sampled_from([ROD, PLATE, BALL]), _rpy, _rpy)
def test_the_frames_do_not_matter(shape: Shape, of_shape: Vector, of_inertial: Vector) -> None:
    """However the shape and the frame of <inertial> are turned, an inertia within the tolerance passes and another fails."""
    solid = uniform_solid([(shape, Transform(rotation_from_rpy(of_shape), (0.1, 0.2, 0.3)))], 2.0)
    own = turned(solid.inertia, Transform(rotation_from_rpy(of_inertial)).inverse().rotation)
    shown = visual(TEXTS[shape], xyz="0.1 0.2 0.3", rpy=of_shape)
    for factor, status in ((1.0, "passed"), (1.08, "passed"), (1.12, "failed"), (0.88, "failed")):
        body = arm(scaled(own, factor), shown, xyz=solid.centre, rpy=of_inertial)
        assert ask(inertia_plausible, body, **TEN).status == status


def test_collisions_come_before_visuals() -> None:
    """The collision shapes count; the visuals only if no collision shape has a volume."""
    right = solid_inertia(PLATE, 2.0)
    for shapes in (
        (collision(TEXTS[PLATE]), visual(TEXTS[BALL])),
        (visual(mesh()), collision(TEXTS[PLATE])),
        (collision(box(0.0, 1.0, 1.0)), visual(TEXTS[PLATE])),
        (collision(TEXTS[PLATE]), collision(TEXTS[PLATE])),
    ):
        assert "its" in passes(inertia_plausible, arm(right, *shapes), **TEN)


def test_several_shapes_are_one_solid() -> None:
    """A box that is shown as two halves has the inertia and the centre of mass of the whole."""
    halves = [visual(box(0.3, 0.4, 0.2), xyz=(x, 0.0, 0.0)) for x in (0.15, 0.45)]
    right = solid_inertia(PLATE, 2.0)
    message = passes(inertia_plausible, arm(right, *halves, xyz="0.3 0 0"), **TEN)
    assert message == "the inertia of 'arm' is that of a uniform solid of its visuals (0 % off)"
    assert "the centre of mass" in fails(inertia_plausible, arm(right, *halves), **TEN)


def test_overlapping_shapes_need_manual_grading() -> None:
    """Where shapes overlap, the solid is not known: only the sum of the shapes passes, and nothing fails."""
    shapes = [visual(TEXTS[ROD]), visual(TEXTS[PLATE])]
    added = uniform_solid([(ROD, IDENTITY), (PLATE, IDENTITY)], 2.0).inertia
    assert ask(inertia_plausible, arm(added, *shapes), **TEN).status == "passed"
    outcome = graded(inertia_plausible, arm(scaled(added, 1.5), *shapes), **TEN)
    assert outcome.status == "pending"
    assert outcome.message.endswith(", but the visuals overlap; needs manual grading")


@pytest.mark.parametrize(
    ("shape", "off", "status"),
    [(ROD, 0.0118, "passed"), (ROD, 0.0125, "failed"), (Sphere(0.02), 0.0019, "passed"),
     (Sphere(0.02), 0.0021, "failed")],
)  # fmt: skip
def test_the_mass_centre_has_a_tolerance(shape: Shape, off: float, status: str) -> None:
    """2 % of the size of a rod 0.6 long, or 2 mm, if these are more, as for a ball of radius 2 cm."""
    body = arm(solid_inertia(shape, 2.0), visual(TEXTS.get(shape, sphere(0.02))), xyz=(0.0, 0.0, off))
    assert ask(inertia_plausible, body, **TEN).status == status


# --- Mistakes ---------------------------------------------------------------------------------------------------------

TILTED = rotation_from_rpy((0.0, 0.5, 0.0))
UP = (0.0, 0.0, 0.3)


def mirrored(inertia: Tensor) -> Tensor:
    """Return an inertia with products of inertia of the opposite sign."""
    xx, xy, xz, yy, yz, zz = inertia
    return (xx, -xy, -xz, yy, -yz, zz)


ON_END = {"xyz": UP}
ROUND, FLAT, LYING = solid_inertia(ROD, 2.0), solid_inertia(PLATE, 2.0), {"rpy": (0.0, 0.5, 0.0)}
MISTAKES = [
    (ROD, scaled(ROUND, 1.6), {}, "it is 60 % too large, as for a mass of 3.2 kg"),
    (ROD, scaled(ROUND, 0.5), {}, "it is 50 % too small, as for a mass of 1 kg"),
    (ROD, scaled(ROUND, 2.9), {}, "it is 190 % too large, as for a mass of 5.8 kg"),
    (ROD, scaled(ROUND, 3.5), {}, "it is 3.5 times too large, as for a mass of 7 kg"),
    (ROD, scaled(ROUND, 0.3), {}, "it is 3.33 times too small, as for a mass of 0.6 kg"),
    (ROD, scaled(ROUND, 12.0), {}, "it is 12 times too large, as for a mass of 24 kg"),
    (ROD, scaled(ROUND, 1e3), {}, "it is 1,000 times too large, as if it were computed with grams"),
    (ROD, scaled(ROUND, 1e-3), {}, "it is 1,000 times too small, as if the mass were given in grams"),
    (BALL, scaled(solid_inertia(BALL, 2.0), 1e9), {},
     "it is 1,000,000,000 times too large, as if it were given in g mm^2"),
    (BALL, solid_inertia(Sphere(0.2), 2.0), {}, "it would fit if its diameter were the radius"),
    (PLATE, solid_inertia(Box((0.4, 0.6, 0.2)), 2.0), {},
     "it would fit if the edges of the box along x and y were exchanged"),
    (PLATE, solid_inertia(Box((0.2, 0.4, 0.6)), 2.0), {},
     "it would fit if the edges of the box along x and z were exchanged"),
    (ROD, turned(ROUND, rotation_from_rpy((pi / 2, 0.0, 0.0))), {}, "it would fit if the axis of the cylinder were y"),
    (ROD, shifted(ROUND, 2.0, UP), ON_END,
     "it would fit if it were about the origin of the link, not about the centre of mass"),
    (ROD, shifted(ROUND, 2.0, UP), {}, "it would fit if it were about an end of the cylinder, not about its centre"),
    (PLATE, shifted(FLAT, 2.0, (0.3, 0.0, 0.0)), {},
     "it would fit if it were about an end of the box, not about its centre"),
    (PLATE, shifted(FLAT, 2.0, (0.0, 0.2, 0.0)), {},
     "it would fit if it were about an end of the box, not about its centre "),
    (PLATE, mirrored(turned(FLAT, rotation_from_rpy((0.3, 0.5, 0.7)))), {"rpy": (0.3, 0.5, 0.7)},
     "it would fit if ixy, ixz and iyz had the opposite sign "),
    (PLATE, mirrored(turned(FLAT, TILTED)), LYING, "it would fit if ixy, ixz and iyz had the opposite sign"),
    (PLATE, FLAT, LYING, "it would fit if the box were not turned"),
    (PLATE, (0.05, 0.0, 0.0, 0.0667, 0.0, 0.09), {}, "ixx is 0.05, not 0.0333, izz is 0.09, not 0.0867"),
]  # fmt: skip


@pytest.mark.parametrize(("shape", "inertia", "pose", "cause"), MISTAKES, ids=[row[3] for row in MISTAKES])
def test_what_a_mistake_is_called(shape: Shape, inertia: Sequence[float], pose: dict[str, Vector], cause: str) -> None:
    """The message says how far the inertia is off, and what it would be the inertia of, as far as that is certain."""
    shown = visual(TEXTS[shape], xyz=pose.get("xyz", ""), rpy=pose.get("rpy", ""))
    message = fails(
        inertia_plausible, arm(inertia, shown, xyz=pose.get("xyz", "")), at="<inertia ", link="arm", tolerance=1.0
    )
    assert " % off that of a uniform solid of its visual: " in message
    assert message.endswith(f": {cause.strip()}")


def test_the_mass_centre_is_told() -> None:
    """The usual mistake: the inertia is right, but <inertial> has no origin."""
    body = arm(solid_inertia(ROD, 2.0), visual(TEXTS[ROD], xyz=UP))
    assert fails(inertia_plausible, body, at="<inertial>", **TEN) == (
        "the centre of mass of 'arm' is at 0 0 0 m; it should be at 0 0 0.3 m in 'arm' (300 mm off)"
    )
    both = arm(scaled(solid_inertia(ROD, 2.0), 2.0), visual(TEXTS[ROD], xyz=UP), xyz="0 0 0.1")
    message = fails(inertia_plausible, both, at="<inertia ", **TEN)
    assert "100 % too large, as for a mass of 4 kg; the centre of mass of 'arm' is at 0 0 0.1 m" in message


# --- Shapes and numbers that cannot be compared -----------------------------------------------------------------------


@pytest.mark.parametrize("shape", ["", visual(box(1.0, 1.0, 0.0)), collision(cylinder(0.1, 0.0))])
def test_no_volume(shape: str) -> None:
    """Without a shape that has a volume there is no solid: the first criterion of the link's shapes fails."""
    body = arm((1, 0, 0, 1, 0, 1), shape)
    assert missing(inertia_plausible, body, **TEN).kind == "visual"
    assert fails(inertia_plausible, body, **TEN) == "link 'arm' has no visual or collision shape with a volume"


@pytest.mark.parametrize("size", [1e-150, 1e-60, 1e60, 1e120, 1e300])
@pytest.mark.parametrize("moment", [1e-300, 1.0, 1e300])
@pytest.mark.parametrize("mass", [1e-300, 1.0, 1e300])
def test_absurd_numbers_fail(size: float, moment: float, mass: float) -> None:
    """Overflow and underflow never pass and never break the check."""
    body = arm((moment, 0, 0, moment, 0, moment), visual(box(size, size, size)), mass=mass)
    outcome = graded(inertia_plausible, body, **TEN)
    assert outcome.status == "failed", outcome
    assert "nan" not in outcome.message


def test_a_link_with_very_many_shapes() -> None:
    """They are not compared with each other."""
    shapes = [visual(sphere(0.001), xyz=(index * 0.1, 0.0, 0.0)) for index in range(51)]
    outcome = graded(inertia_plausible, arm((1, 0, 0, 1, 0, 1), *shapes), **TEN)
    assert (outcome.status, outcome.message) == ("pending", "'arm' has more than 50 shapes; needs manual grading")


def test_nan_fails() -> None:
    """NaN is within no tolerance."""
    assert ask(mass_is, arm((1.0,) * 6, mass=1.0), link="arm", mass=nan, tolerance=1.0).status == "failed"


def test_a_negative_size_counts_as_positive() -> None:
    """RViz shows it so."""
    body = arm(solid_inertia(PLATE, 2.0), visual(box(-0.6, 0.4, -0.2), rpy="3.14159265 0 0"))
    assert ask(inertia_plausible, body, **TEN).status == "passed"
