"""Contact: gaps and overlaps of two links, just inside and just outside their tolerances."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.contact import clear_of, stands_on
from grader.robot.shapes import UnknownShape
from tests.checks.cases import BASE, FORWARD, LIDAR, mounted, rolling
from tests.checks.outcomes import Arguments, ask, fails, graded, passes
from tests.checks.robots import box, cylinder, joint, link, mesh, scene, sphere, turned, visual
from tests.examples import examples

ON: Arguments = {"link": "lidar", "on": "base", "tolerance": 0.002}
CLEAR: Arguments = {"link": "wheel", "of": "base", "tolerance": 0.002}


# --- stands_on --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("x", "y", "beyond"),
    [
        (0.2, 0.1, None),
        (0.2019, 0.0, None),
        (0.202, 0.0, None),
        (0.2021, 0.0, "2.1"),
        (-0.2021, 0.0, "2.1"),
        (0.0, 0.102, None),
        (0.0, 0.1021, "2.1"),
        (0.0, -0.1021, "2.1"),
        (0.3, 0.0, "100"),
        (1.0, 1.0, "900"),
    ],
)
def test_a_standing_link_stays_within_the_outline(x: float, y: float, beyond: str | None) -> None:
    """A link that reaches beyond the outline by more than the tolerance does not stand on the top."""
    if beyond is None:
        passes(stands_on, mounted((x, y, 0.225)), **ON)
    else:
        message = fails(stands_on, mounted((x, y, 0.225)), at=f'xyz="{x!r} {y!r}', **ON)
        assert message == f"'lidar' reaches {beyond} mm beyond the edge of the top of 'base'"


def test_the_outline_turns_with_the_base() -> None:
    """The outline is that of the box as it lies, not that of the frame."""
    for yaw, fine in ((0, True), (90, False)):
        base = link("base", visual(box(0.6, 0.4, 0.2), xyz="0 0 0.1", rpy=turned(yaw=yaw)))
        found = scene(base, LIDAR, joint("j", "fixed", "base", "lidar", xyz="0.2 0 0.225"))
        assert (ask(stands_on, found, **ON).status == "passed") == fine
    slanted = link("base", visual(box(1.0, 0.3, 0.2), xyz="0 0 0.1", rpy=turned(yaw=45)))
    along = 0.3 / 2**0.5
    for y, fine in ((along, True), (-along, False)):
        found = scene(slanted, LIDAR, joint("j", "fixed", "base", "lidar", xyz=(along, y, 0.225)))
        assert (ask(stands_on, found, **ON).status == "passed") == fine


def test_links_can_stand_on_cylinders_and_spheres() -> None:
    """Any shape has a top and an outline."""
    drum = link("base", visual(cylinder(0.3, 0.2), xyz="0 0 0.1"))
    for x, fine in ((0.19, True), (0.21, False)):
        found = scene(drum, LIDAR, joint("j", "fixed", "base", "lidar", xyz=(x, 0.0, 0.225)))
        assert (ask(stands_on, found, **ON).status == "passed") == fine
    ball = link("base", visual(sphere(0.2)))
    passes(stands_on, scene(ball, LIDAR, joint("j", "fixed", "base", "lidar", xyz="0 0 0.225")), **ON)


def test_a_turned_lidar_is_measured_as_it_lies() -> None:
    """A lidar on its edge reaches farther down than one that lies flat."""
    message = fails(stands_on, mounted(rpy=turned(roll=90)), **ON)
    assert message.endswith("0.2 m (75 mm too low)")
    passes(stands_on, mounted((0.15, 0.0, 0.3), turned(roll=90)), **ON)


def test_all_visuals_of_the_standing_link_count() -> None:
    """A mast on the lidar is harmless; a plug below it is not."""
    mast = visual(cylinder(0.01, 0.01), xyz="0 0 0.5")
    passes(stands_on, mounted(lidar=link("lidar", visual(cylinder()), mast)), **ON)
    plug = visual(cylinder(0.01, 0.05), xyz="0 0 -0.01")
    assert "(10 mm too low)" in fails(stands_on, mounted(lidar=link("lidar", visual(cylinder()), plug)), **ON)


def test_a_lidar_without_an_origin_points_to_its_joint() -> None:
    """If no origin moves the lidar, the failure points to its joint; a gap alone has no location."""
    joined = joint("j", "fixed", "base", "lidar")
    pillar = link("base", visual(box(0.1, 0.1, 0.2), xyz="0 0 -0.125"))
    message = fails(stands_on, scene(pillar, LIDAR, joined), at="<joint", **ON)
    assert message == "'lidar' reaches 50 mm beyond the edge of the top of 'base'"
    assert graded(stands_on, scene(BASE, LIDAR, joined), **ON).location is None


def test_the_top_of_the_expected_shape_counts() -> None:
    """If the rubric names a shape, a larger shape of another kind on the base is no support."""
    body, dome = visual(box(0.6, 0.4, 0.2), xyz="0 0 0.1"), visual(sphere(1.0))
    for order in ((body, dome), (dome, body)):
        found = scene(link("base", *order), LIDAR, joint("j", "fixed", "base", "lidar", xyz="0.15 0 0.225"))
        passes(stands_on, found, **ON, shape="box")
        for shape in ("any", "sphere", "cylinder"):
            assert "the top of 'base', 1 m" in fails(stands_on, found, **ON, shape=shape)


# --- clear_of ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("y", "depth"),
    [(0.225, None), (0.25, None), (1.0, None), (0.2231, None), (0.223, None), (0.2229, "2.1"), (0.2, "25")],
)
def test_an_overlap_has_a_tolerance(y: float, depth: str | None) -> None:
    """Touching and an overlap up to the tolerance, inclusive, are accepted; a deeper overlap is reported."""
    found = rolling(xyz=(-0.15, y, 0.0))
    if depth is None:
        assert passes(clear_of, found, **CLEAR) == "'wheel' does not cut into 'base'"
        assert ask(clear_of, found, **CLEAR).measured == 0.0
    else:
        assert fails(clear_of, found, **CLEAR) == f"'wheel' cuts {depth} mm deep into 'base'"
        assert ask(clear_of, found, **CLEAR).measured == pytest.approx(float(depth) / 1000)


def test_the_depth_is_the_shortest_separation() -> None:
    """A wheel in the middle of the base is separated through the nearest side, here the bottom."""
    message = fails(clear_of, rolling(xyz="0 0 0"), **CLEAR)
    assert message == "'wheel' cuts 100 mm deep into 'base'"


def test_an_overlap_is_symmetric() -> None:
    """Both links overlap by the same depth."""
    found = rolling(xyz=(-0.15, 0.2, 0.0))
    assert fails(clear_of, found, **CLEAR) == "'wheel' cuts 25 mm deep into 'base'"
    assert fails(clear_of, found, link="base", of="wheel", tolerance=0.002) == "'base' cuts 25 mm deep into 'wheel'"


def test_the_visual_that_was_moved_inward_is_pointed_to() -> None:
    """If the visual has an origin, the failure points to its xyz; otherwise to the visual."""
    inward = link("wheel", visual(cylinder(), xyz="0 0 -0.025"))
    joined = joint("j", "continuous", "base", "wheel", xyz="-0.15 0.2 0", rpy=FORWARD)
    assert "50 mm deep" in fails(clear_of, scene(BASE, inward, joined), at='xyz="0 0 -0.025"', **CLEAR)


@examples(10)
@given(x=st.floats(-0.5, 0.5, width=16), z=st.floats(-0.5, 0.5, width=16), yaw=st.floats(-4.0, 4.0, width=16))
def test_the_depth_of_two_spheres(x: float, z: float, yaw: float) -> None:
    """For spheres the depth is known: the sum of the radii minus the distance of the centres."""
    one, other = link("base", visual(sphere(0.3))), link("wheel", visual(sphere(0.2)))
    found = scene(one, other, joint("j", "fixed", "base", "wheel", xyz=(x, 0.0, z), rpy=(0.0, 0.0, yaw)))
    depth = 0.5 - (x * x + z * z) ** 0.5
    outcome = ask(clear_of, found, **CLEAR)
    if depth < 0.0019:
        assert outcome.status == "passed"
    elif depth > 0.0021:
        assert outcome.status == "failed"
        assert outcome.measured == pytest.approx(depth, abs=2e-4)


def test_all_visuals_of_a_link_count() -> None:
    """An axle that reaches into the base overlaps it, even if the wheel does not."""
    axle = visual(cylinder(0.01, 0.3))
    joined = joint("j", "continuous", "base", "wheel", xyz="-0.15 0.225 0.1", rpy=FORWARD)
    fails(clear_of, scene(BASE, link("wheel", visual(cylinder()), axle), joined), **CLEAR)


@pytest.mark.parametrize("shapes", [(mesh(), box(1, 1, 1)), (box(1, 1, 1), mesh())], ids=["own", "other"])
def test_a_mesh_may_overlap(shapes: tuple[str, str]) -> None:
    """The size of a mesh is unknown, whichever link shows it; what overlaps beside it is wrong all the same."""
    own, other = map(visual, shapes)
    mounting = joint("j", "fixed", "base", "wheel", xyz="3 0 0")
    with pytest.raises(UnknownShape):
        ask(clear_of, scene(link("base", other), link("wheel", own), mounting), **CLEAR)
    ball = visual(sphere(3.0))
    fails(clear_of, scene(link("base", other, ball), link("wheel", own, ball), mounting), **CLEAR)


def test_too_many_shapes_need_manual_grading() -> None:
    """At most 2,000 pairs are compared; beyond that manual grading is needed, even if some overlap."""
    for own, theirs, depth in ((40, 50, 0.0), (40, 50, 0.1), (1, 2001, 0.1), (2001, 1, 0.0)):
        one, other = link("base", *[visual(sphere(0.5))] * theirs), link("wheel", *[visual(sphere(0.5))] * own)
        found = scene(one, other, joint("j", "fixed", "base", "wheel", xyz=(1.0 - depth, 0.0, 0.0)))
        outcome = graded(clear_of, found, **CLEAR)
        if own * theirs > 2000:
            assert outcome.status == "pending"
            assert outcome.message == "'wheel' and 'base' show too many shapes to compare; needs manual grading"
        else:
            assert outcome.status == ("failed" if depth else "passed")
