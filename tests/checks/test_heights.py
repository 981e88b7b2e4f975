"""Heights: bottoms of links and footprints, just inside and just outside their tolerances."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.heights import bottom_at_height, bottoms_at_height, under_the_base
from tests.checks.cases import BASE, CASTER, FOOT, FORWARD, WHEEL, mounted, standing
from tests.checks.outcomes import Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import Scene, box, cylinder, joint, link, mesh, scene, sphere, turned, visual
from tests.examples import examples

BOTTOM: Arguments = {"link": "base", "relative_to": "base", "height": 0.0, "tolerance": 0.002}
BOTTOMS: Arguments = {"links": ["wheel", "caster"], "relative_to": "foot", "height": 0.0, "tolerance": 0.002}
UNDER: Arguments = {"link": "foot", "base": "base", "wheels": ["wheel"], "tolerance": 0.002, "angle": 1.0}

# Offsets in metres from the expected value, and whether they are within a tolerance of 2 mm.
OFFSETS = [(0.0, True), (0.0019, True), (0.002, True), (-0.002, True), (0.0021, False), (-0.0021, False)]
positions = st.tuples(*[st.floats(-1.0, 1.0, width=16)] * 3)
angles = st.tuples(*[st.floats(-4.0, 4.0, width=16)] * 3)


@pytest.mark.parametrize(
    ("shape", "rpy", "bottom"),
    [
        (box(0.6, 0.4, 0.2), "", -0.1),
        (box(0.6, 0.4, 0.2), turned(roll=90), -0.2),
        (box(0.6, 0.4, 0.2), turned(pitch=90), -0.3),
        (box(0.6, 0.4, 0.2), turned(pitch=45), -0.4 / 2**0.5),
        (cylinder(0.1, 0.05), "", -0.025),
        (cylinder(0.1, 0.05), turned(roll=90), -0.1),
        (cylinder(0.1, 0.05), turned(pitch=45), -0.125 / 2**0.5),
        (sphere(0.05), "1 2 3", -0.05),
        (box(0.6, 0.4, -0.2), "", -0.1),
        (cylinder(-0.1, -0.05), turned(roll=90), -0.1),
    ],
)
def test_the_bottom_is_that_of_the_shape_as_it_lies(shape: str, rpy: str, bottom: float) -> None:
    """Boxes, cylinders and spheres reach as far down as their shape does, however they are turned."""
    found = scene(link("base", visual(shape, rpy=rpy)))
    passes(bottom_at_height, found, link="base", relative_to="base", height=bottom, tolerance=1e-9)


def test_the_lowest_of_several_visuals_counts() -> None:
    """A foot below the box is its bottom; the failure points to the origin of the body."""
    foot = visual(sphere(0.01), xyz="0 0 -0.04")
    found = scene(link("base", visual(box(0.6, 0.4, 0.2), xyz="0 0 0.1"), foot))
    message = fails(bottom_at_height, found, at='xyz="0 0 0.1"', **BOTTOM)
    assert message == "the bottom of 'base' in the frame 'base' is at z = -0.05 m; it should be 0 m (50 mm too low)"


def test_only_the_bottom_of_the_expected_shape_counts() -> None:
    """If the rubric names a shape that the link shows, other shapes may be lower; the largest of its kind counts."""
    body, ball = visual(box(0.6, 0.4, 0.2), xyz="0 0 0.1"), visual(sphere(1.0))
    foot = visual(box(0.01, 0.01, 0.01), xyz="0 0 -0.5")
    for order in ((body, ball, foot), (foot, ball, body)):
        found = scene(link("base", *order))
        passes(bottom_at_height, found, **BOTTOM, shape="box")
        for shape in ("any", "sphere"):
            assert "is at z = -1 m; it should be 0 m" in fails(
                bottom_at_height, found, at="<visual>\n<geometry>\n<sphere", **BOTTOM, shape=shape
            )


def test_a_bottom_is_measured_in_the_named_frame() -> None:
    """The height and the rotation of the other frame are taken into account."""
    found = mounted((0.0, 0.0, 1.0), turned(roll=90))
    passes(bottom_at_height, found, link="lidar", relative_to="base", height=0.9, tolerance=1e-9)
    passes(bottom_at_height, found, link="lidar", relative_to="lidar", height=-0.025, tolerance=1e-9)


@examples(10)
@given(rpy=angles, height=st.floats(-2.0, 2.0, width=16))
def test_a_sphere_stands_on_its_lowest_point_however_it_is_turned(rpy: tuple[float, ...], height: float) -> None:
    """A sphere's bottom is its radius below its centre, for every orientation."""
    found = scene(BASE, CASTER, joint("j", "fixed", "base", "caster", xyz=f"0.2 0 {height!r}", rpy=rpy))
    passes(bottom_at_height, found, link="caster", relative_to="base", height=height - 0.05, tolerance=1e-9)


def test_all_wrong_bottoms_are_reported() -> None:
    """Every link that is off is named; if all are off alike, the failure points to their common cause."""
    message = fails(bottoms_at_height, standing(height=0.15), at='xyz="0 0 0.15"', **BOTTOMS)
    assert message == (
        "the bottoms of 'wheel' and 'caster' are at z = 0.05 0.05 m in 'foot'; they should be at 0 m"
        " ('wheel' 50 mm too high, 'caster' 50 mm too high)"
    )


def test_bottoms_that_are_off_differently_point_to_the_first() -> None:
    """If the distances differ, no single origin is the cause; the failure points to the first wrong link's."""
    found = standing(height=0.15, wheel=0.05)
    message = fails(bottoms_at_height, found, at='xyz="-0.15 0.225', **BOTTOMS)
    assert message.endswith(" ('wheel' 100 mm too high, 'caster' 50 mm too high)")
    only_the_caster = standing(height=0.15, wheel=-0.05)
    fails(bottoms_at_height, only_the_caster, at='xyz="0.2 0.0 -0.05"', **BOTTOMS)


def test_a_missing_link_does_not_hide_one_that_is_off() -> None:
    """What can be measured is graded first; only if that is correct, the missing link counts."""
    both: Arguments = {**BOTTOMS, "links": ["nowhere", "wheel"]}
    assert missing(bottoms_at_height, standing(), **both).name == "nowhere"
    message = fails(bottoms_at_height, standing(wheel=0.05), **both)
    assert (
        message == "the bottoms of 'wheel' are at z = 0.05 m in 'foot'; they should be at 0 m ('wheel' 50 mm too high)"
    )


def test_a_mesh_does_not_hide_a_bottom_that_is_off() -> None:
    """A link of unknown size leaves the outcome pending only if all others are correct."""
    open_ = standing().text.replace(sphere(0.05), mesh())
    assert graded(bottoms_at_height, Scene(open_), **BOTTOMS).status == "pending"
    closed = standing(wheel=0.05).text.replace(sphere(0.05), mesh())
    assert graded(bottoms_at_height, Scene(closed), **BOTTOMS).status == "failed"


# --- under_the_base ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("axis", "offset"), list(product("xy", OFFSETS)))
def test_a_footprint_has_a_tolerance_in_the_plane(axis: str, offset: tuple[float, bool]) -> None:
    """The base may be off the footprint by the tolerance in x and in y, inclusive."""
    off, fine = offset
    found = standing(xy=f"{off!r} 0" if axis == "x" else f"0 {off!r}")
    outcome = ask(under_the_base, found, **UNDER)
    assert (outcome.status == "passed") == fine
    if not fine:
        shown = f"{off:g} 0" if axis == "x" else f"0 {off:g}"
        assert f": 'base' is at x, y = {shown} m in it and should be at 0 0" in outcome.message


@pytest.mark.parametrize("angle", ["roll", "pitch", "yaw"])
def test_a_footprint_has_a_tolerance_in_its_angle(angle: str) -> None:
    """The base may be turned by the angle, inclusive, about any axis; the wheel then hardly moves."""
    loose: Arguments = {**UNDER, "tolerance": 0.1}
    for degrees, fine in (
        (0.99, True),
        (1.0, True),
        (1.0 + 1e-10, True),
        (-1.0, True),
        (1.01, False),
        (-1.01, False),
        (180.0, False),
    ):
        found = standing(rpy=turned(**{angle: degrees}))
        outcome = ask(under_the_base, found, **loose)
        assert (outcome.status == "passed") == fine, degrees
        if abs(degrees) == 180.0:
            assert "'base' is turned by 180 degrees in it and should not be turned" in outcome.message


def test_all_faults_of_a_footprint_are_reported() -> None:
    """Position, rotation and height are reported together."""
    found = standing(height=0.2, xy="0.3 0", rpy=turned(yaw=90))
    message = fails(under_the_base, found, at='xyz="0.3 0 0.2"', **UNDER)
    assert message == (
        "the frame 'foot' should be under 'base', level with the bottoms of the wheels: 'base' is at x, y = 0.3 0 m in it"
        " and should be at 0 0; 'base' is turned by 90 degrees in it and should not be turned; the lowest point of 'wheel' is 100 mm above it"
    )


def test_the_footprint_is_measured_with_the_existing_wheels() -> None:
    """A missing wheel does not hide that the footprint is too low, and is reported if the rest is correct."""
    both: Arguments = {**UNDER, "wheels": ["nowhere", "wheel"]}
    assert missing(under_the_base, standing(), **both).name == "nowhere"
    assert fails(under_the_base, standing(height=0.05), **both).endswith(
        "the lowest point of 'wheel' is 50 mm below it"
    )


def test_a_wheel_of_unknown_size_leaves_the_height_pending() -> None:
    """A mesh for a wheel is pending if the rest is correct, and does not hide that the base is turned."""
    assert graded(under_the_base, standing().with_shape(mesh()), **UNDER).status == "pending"
    assert graded(under_the_base, standing(rpy=turned(yaw=90)).with_shape(mesh()), **UNDER).status == "failed"


def test_a_footprint_need_not_be_the_root() -> None:
    """The check measures frames; the parents are graded by another criterion."""
    upside = scene(FOOT, BASE, WHEEL, joint("base_joint", "fixed", "base", "foot", xyz="0 0 -0.1"),
                   joint("wheel_joint", "continuous", "base", "wheel", xyz="-0.15 0.225 0", rpy=FORWARD))  # fmt: skip
    passes(under_the_base, upside, **UNDER)


def test_both_wheels_count() -> None:
    """Each wheel's lowest point is compared, and each wheel that is off is reported."""
    low = link("low", visual(cylinder(0.2)))
    found = Scene(
        standing().text.replace("</robot>", f"{low}\n{joint('k', 'continuous', 'base', 'low', rpy=FORWARD)}\n</robot>")
    )
    both: Arguments = {**UNDER, "wheels": ["wheel", "low"]}
    message = fails(under_the_base, found, at='<origin rpy="', **both)
    assert message.endswith(": the lowest point of 'low' is 100 mm below it")


def test_a_wheel_is_the_location_only_if_the_footprint_is_correct() -> None:
    """If another fault or all wheels indicate the base's own position, the failure points to its joint."""
    low = link("low", visual(cylinder()))
    both: Arguments = {**UNDER, "wheels": ["wheel", "low"]}

    def beside(frame: Scene, height: float) -> Scene:
        joined = joint("k", "continuous", "base", "low", xyz=(-0.15, -0.225, height), rpy=FORWARD)
        return Scene(frame.text.replace("</robot>", f"{low}\n{joined}\n</robot>"))

    fails(under_the_base, beside(standing(), 0.05), at='xyz="-0.15 -0.225', **both)
    fails(under_the_base, beside(standing(wheel=0.05), 0.0), at='xyz="-0.15 0.225', **both)
    fails(under_the_base, beside(standing(height=0.2), 0.0), at='xyz="0 0 0.2"', **both)
    fails(under_the_base, beside(standing(xy="0.3 0"), 0.05), at='xyz="0.3 0 0.1"', **both)
