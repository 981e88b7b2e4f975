"""The shapes, sizes and colours of a link, just inside and just outside their tolerances."""

from itertools import permutations, product
from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.appearance import shows_box, shows_cylinder, shows_nothing, shows_sphere
from grader.checks.colours import shows_colour, shows_grey
from grader.errors import NotDecided
from grader.robot.kinematics import Configuration
from grader.robot.transforms import Vector
from grader.submission.opening import read_submission
from tests.checks.cases import BASE, CASE, LIDAR
from tests.checks.outcomes import AnyCheck, Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import Numbers, Scene, box, cylinder, link, mesh, paint, scene, sphere, turned, visual
from tests.examples import examples

SIZE = (0.6, 0.4, 0.2)
BOX: Arguments = {"link": "base", "size": SIZE, "tolerance": 0.002}
CYLINDER: Arguments = {"link": "lidar", "radius": 0.1, "length": 0.05, "tolerance": 0.002}
SPHERE: Arguments = {"link": "caster", "radius": 0.05, "tolerance": 0.002}
GREEN: Arguments = {"link": "base", "colour": (0.0, 0.6, 0.0, 1.0), "tolerance": 0.01}
WHITE: Arguments = {"link": "lidar", "at_least": 0.75, "tolerance": 0.01}


COLOURS: tuple[tuple[AnyCheck, Arguments], ...] = ((shows_colour, GREEN), (shows_grey, {**WHITE, "link": "base"}))


def boxed(x: float, y: float, z: float, rpy: Numbers = "") -> Scene:
    """Return a base that shows one box."""
    return scene(link("base", visual(box(x, y, z), rpy=rpy)))


def painted(rgba: str, name: str = "base") -> Scene:
    """Return a link that shows a box in one colour."""
    return scene(link(name, visual(box(1.0, 1.0, 1.0), material=paint(rgba))))


# --- Boxes ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("size", "rpy"),
    [
        ((0.4, 0.6, 0.2), turned(yaw=90)),
        ((0.4, 0.6, 0.2), turned(yaw=-90)),
        ((0.6, 0.2, 0.4), turned(roll=90)),
        ((0.2, 0.4, 0.6), turned(pitch=90)),
        ((0.2, 0.4, 0.6), turned(pitch=-90)),
        ((0.6, 0.4, 0.2), turned(yaw=180)),
        ((0.6, 0.4, 0.2), turned(roll=180, yaw=180)),
        ((0.4, 0.2, 0.6), turned(roll=90, yaw=90)),
        ((0.2, 0.6, 0.4), turned(roll=90, pitch=90)),
        ((0.4, 0.6, 0.2), "0 0 1.57"),
    ],
)
def test_a_box_on_its_side_is_measured_along_the_links_axes(size: Vector, rpy: str) -> None:
    """Quarter turns of the visual change which edges lie along the link's axes; those edges count."""
    assert passes(shows_box, boxed(*size, rpy=rpy), **BOX) == "'base' shows a box 0.6 0.4 0.2 m"


def test_a_wrongly_turned_box_is_measured_as_it_lies() -> None:
    """Correct numbers in `size` are wrong if the visual is turned; the failure points to the turn."""
    message = fails(shows_box, boxed(*SIZE, rpy=turned(yaw=90)), at="rpy=", **BOX)
    assert message == "'base' shows a box 0.4 0.6 0.2 m; it should be 0.6 0.4 0.2 m (x, y, z)"


@pytest.mark.parametrize("angle", ["roll", "pitch", "yaw"])
def test_a_box_may_be_turned_by_one_degree(angle: str) -> None:
    """A tilt of less than a degree counts as a rounded angle; beyond it the edges are not along the axes."""
    for off in (0.99, -0.99, 90.99, 89.01):
        flat = ask(shows_box, boxed(0.5, 0.5, 0.5, rpy=turned(**{angle: off})), **{**BOX, "size": (0.5, 0.5, 0.5)})
        assert flat.status == "passed"
    for off in (1.01, -1.01, 45.0, 88.99):
        message = fails(shows_box, boxed(*SIZE, rpy=turned(**{angle: off})), at="rpy=", **BOX)
        assert message == "the box of 'base' is turned: its edges should be along the axes of 'base'"


@examples(10)
@given(order=st.permutations((0, 1, 2)), turns=st.tuples(*[st.integers(-2, 2)] * 3))
def test_a_box_passes_in_every_orientation_that_lies_right(order: list[int], turns: tuple[int, int, int]) -> None:
    """Whatever quarter turns a visual has, a box passes exactly if one assignment of its edges fits."""
    size = (SIZE[order[0]], SIZE[order[1]], SIZE[order[2]])
    rpy = (turns[0] * pi / 2, turns[1] * pi / 2, turns[2] * pi / 2)
    outcome = ask(shows_box, boxed(*size, rpy=rpy), **BOX)
    assert outcome.measured in [pytest.approx(size) for size in permutations(SIZE)]
    assert (outcome.status == "passed") == (outcome.measured == pytest.approx(SIZE))


def test_of_several_boxes_the_nearest_counts() -> None:
    """If a link shows several boxes, one correct box is enough; otherwise the nearest one is reported."""
    wrong, right = visual(box(1.0, 1.0, 1.0)), visual(box(*SIZE))
    passes(shows_box, scene(link("base", wrong, right, visual(sphere(1.0)))), **BOX)
    near = visual(box(0.6, 0.4, 0.1))
    message = fails(shows_box, scene(link("base", wrong, near)), at='size="0.6 0.4 0.1"', **BOX)
    assert message == "'base' shows a box 0.6 0.4 0.1 m; it should be 0.6 0.4 0.2 m (x, y, z)"


def test_a_tilted_box_does_not_hide_an_aligned_one() -> None:
    """A box that is not along the axes ranks behind every box that is."""
    slanted = visual(box(*SIZE), rpy=turned(yaw=30))
    assert "shows a box 9 9 9 m" in fails(shows_box, scene(link("base", slanted, visual(box(9.0, 9.0, 9.0)))), **BOX)
    passes(shows_box, scene(link("base", slanted, visual(box(*SIZE)))), **BOX)


# --- Cylinders and spheres --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sign", [-1, 1])
def test_a_cylinder_has_a_tolerance_in_both_lengths(sign: int) -> None:
    """Radius and length may each be off by the tolerance, inclusive; the failure points to the wrong one."""
    for off in (0.0019, 0.002):
        passes(shows_cylinder, scene(link("lidar", visual(cylinder(0.1 + sign * off, 0.05 - sign * off)))), **CYLINDER)
    off = sign * 0.0021
    fails(shows_cylinder, scene(link("lidar", visual(cylinder(0.1 + off, 0.05)))), at="radius=", **CYLINDER)
    fails(shows_cylinder, scene(link("lidar", visual(cylinder(0.1, 0.05 + off)))), at="length=", **CYLINDER)
    fails(shows_cylinder, scene(link("lidar", visual(cylinder(0.1 + off, 0.05 + off)))), at="radius=", **CYLINDER)


def test_of_several_cylinders_the_nearest_counts() -> None:
    """If a link shows several cylinders, one correct cylinder is enough; otherwise the nearest one is reported."""
    others = (visual(cylinder(0.01, 0.01)), visual(cylinder(1.0, 1.0)), visual(box(9.0, 9.0, 9.0)))
    passes(shows_cylinder, scene(link("lidar", *others, visual(cylinder()))), **CYLINDER)
    fails(shows_cylinder, scene(link("lidar", *others, visual(cylinder(0.1, 0.06)))), at='length="0.06"', **CYLINDER)


def test_of_several_spheres_the_nearest_counts() -> None:
    """If a link shows several spheres, one correct sphere is enough; otherwise the nearest one is reported."""
    for other in (visual(sphere(1.0)), visual(sphere(0.001))):
        passes(shows_sphere, scene(link("caster", other, visual(sphere(0.05)))), **SPHERE)
        fails(shows_sphere, scene(link("caster", other, visual(sphere(0.06)))), at='radius="0.06"', **SPHERE)


SHAPES = {"box": box(0.6, 0.4, 0.2), "cylinder": cylinder(), "sphere": sphere(0.05), "mesh": mesh()}
EXPECTED = {"box": shows_box, "cylinder": shows_cylinder, "sphere": shows_sphere}


@pytest.mark.parametrize(("required", "shown"), [pair for pair in product(EXPECTED, SHAPES) if pair[0] != pair[1]])
def test_another_shape_is_named(required: str, shown: str) -> None:
    """If a link shows another shape than the expected one, the message names both."""
    case = CASE[f"shows_{required}"]
    name = case.arguments["link"]
    found = scene(link(name, visual(SHAPES[shown])))
    error = missing(case.check, found, **case.arguments)
    assert (error.kind, error.name) == (required, name)
    assert (
        fails(case.check, found, at=f"<{shown}", **case.arguments)
        == f"{name!r} shows a {shown}; it should show a {required}"
    )


def test_what_has_no_size_does_not_count() -> None:
    """Visuals without a size are ignored, whatever their place; plates and discs are visible."""
    nothing = visual(box(0.0, 0.0, 0.0), material=paint("1 0 0 1", "red"))
    real = visual(box(*SIZE), material=paint("0 0.6 0 1", "green"))
    for found in (scene(link("base", nothing, real)), scene(link("base", real, nothing))):
        passes(shows_box, found, **BOX)
        passes(shows_colour, found, **GREEN)
    disc, needle = (scene(link("lidar", visual(cylinder(*size)))) for size in ((0.1, 0.0), (0.0, 0.05)))
    assert "length 0 m; it should" in fails(shows_cylinder, disc, **CYLINDER)
    assert fails(shows_box, boxed(0.6, 0.4, 0.0), **BOX).startswith("'base' shows a box 0.6 0.4 0 m; it should be")
    flat_mesh, other_mesh = (scene(link("base", visual(mesh(scale=scale)))) for scale in ("0 0 0", "2 2 2"))
    for check, found, arguments, kind in (
        (shows_cylinder, needle, CYLINDER, "visual"),
        (shows_box, boxed(0.6, 0.0, 0.0), BOX, "visual"),
        (shows_colour, flat_mesh, GREEN, "visual"),
        (shows_box, other_mesh, BOX, "box"),
    ):
        assert missing(check, found, **arguments).kind == kind


def test_a_cylinder_may_lie_in_any_direction() -> None:
    """Only the shape counts, not its orientation."""
    passes(shows_cylinder, scene(link("lidar", visual(cylinder(), xyz="1 2 3", rpy="0.3 0.2 0.1"))), **CYLINDER)


# --- Colours ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("channel", range(4))
def test_a_colour_has_a_tolerance_in_each_channel(channel: int) -> None:
    """Each channel may be off by the tolerance, inclusive, and by no more."""
    for off, fine in ((0.009, True), (0.01, True), (0.011, False)):
        rgba = [0.0, 0.6, 0.0, 1.0]
        rgba[channel] += -off if rgba[channel] else off
        outcome = ask(shows_colour, painted(" ".join(map(str, rgba))), **GREEN)
        assert (outcome.status == "passed") == fine
        assert outcome.measured == pytest.approx(tuple(rgba))
        assert (outcome.expected, outcome.tolerance, outcome.unit) == ((0.0, 0.6, 0.0, 1.0), 0.01, None)


def test_three_channels_ignore_the_opacity() -> None:
    """Opacity is graded only if the rubric gives a fourth channel."""
    grey: Arguments = {"link": "base", "colour": (0.7, 0.7, 0.7), "tolerance": 0.01}
    assert passes(shows_colour, painted("0.7 0.7 0.7 0.1"), **grey) == "'base' is shown in rgb 0.7 0.7 0.7"
    message = fails(shows_colour, painted("0.7 0.7 0.6 0.1"), at="rgba=", **grey)
    assert message == "'base' is shown in rgb 0.7 0.7 0.6; it should be 0.7 0.7 0.7"
    assert (
        fails(shows_colour, painted("0 0.6 0 0.8"), **GREEN)
        == "'base' is shown in rgba 0 0.6 0 0.8; it should be 0 0.6 0 1"
    )


def test_a_wrong_colour_points_to_its_definition() -> None:
    """A material below <robot> is used by name; a failure points to its definition."""
    used = link("base", visual(box(*SIZE), material='<material name="green"/>'))
    passes(shows_colour, scene(paint("0 0.6 0 1", "green"), used), **GREEN)
    fails(shows_colour, scene(paint("0 1 0 1", "green"), used), at="rgba=", **GREEN)
    fails(shows_colour, scene(used, paint("0 1 0 1", "green")), at="rgba=", **GREEN)


def test_a_link_without_a_material_is_red() -> None:
    """RViz shows links without a material in its own red, so no colour passes."""
    found = scene(link("base", visual(box(*SIZE))))
    for check, arguments in COLOURS:
        message = fails(check, found, at="<visual>", **arguments)
        assert message == "'base' has no material, so RViz shows it in its default colour, red"


def test_an_undefined_material_is_no_colour() -> None:
    """A material that is used but not defined is quoted; ROS 2 reads a colour without exactly four numbers as black."""
    found = scene(link("base", visual(box(*SIZE), material='<material name="gren"/>')), paint("0 0.6 0 1", "green"))
    message = fails(shows_colour, found, at='name="gren"', **GREEN)
    assert message == "'base' has no colour: the material 'gren' is not defined here"
    assert "rgba 0 0 0 1" in fails(shows_colour, painted("0 0.6 0"), at="rgba=", **GREEN)


def test_textures_and_meshes() -> None:
    """A texture beside a colour changes nothing, alone it has none; a mesh has a colour, also beside other shapes."""
    texture = '<material name="t">\n{}<texture filename="grass.png"/>\n</material>'
    both, only = (texture.format(colour) for colour in ('<color rgba="0 0.6 0 1"/>\n', ""))
    passes(shows_colour, scene(link("base", visual(box(*SIZE), material=both))), **GREEN)
    for check, arguments in COLOURS:
        found = scene(link("base", visual(box(*SIZE), material=only)))
        assert graded(check, found, **arguments).status in ("failed", "pending")
    painted_mesh = visual(mesh(), material=paint("0 0.6 0 1", "green"))
    passes(shows_colour, scene(link("base", painted_mesh)), **GREEN)
    passes(shows_colour, scene(link("base", visual(box(9.0, 9.0, 9.0)), painted_mesh)), **GREEN)


@pytest.mark.parametrize(
    "material", ["<material name='green'/>", "<material name='red'><color rgba='$(env B)'/></material>"]
)
def test_a_colour_that_only_a_run_tells(material: str) -> None:
    """What xacro leaves open needs manual grading, in the visual or in the material that it names."""
    namespace = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    shown = f"<visual><geometry><box size='1 1 1'/></geometry>{material}</visual>"
    named = "<material name='green'><color rgba='$(env A)'/></material>"
    text = f"<robot name='r' {namespace}>{named}<link name='base'>{shown}</link></robot>"
    urdf = read_submission(text.encode(), identity="me", path="a.urdf.xacro").needed_urdf()
    assert urdf.robot is not None
    with pytest.raises(NotDecided, match="is known only at run time"):
        shows_colour(Configuration(urdf.robot, is_guarded=True), **GREEN)


def test_the_largest_visual_determines_the_colour() -> None:
    """Of several visuals the largest one counts, whatever their order."""
    small = visual(sphere(0.01), material=paint("1 0 0 1", "red"))
    large = visual(box(*SIZE), material=paint("0 0.6 0 1", "green"))
    for found in (scene(link("base", small, large)), scene(link("base", large, small))):
        passes(shows_colour, found, **GREEN)
    assert "1 0 0 1" in fails(
        shows_colour, scene(link("base", large, visual(sphere(9.0), material=paint("1 0 0 1")))), **GREEN
    )


def test_the_colour_of_the_expected_shape_counts() -> None:
    """If the rubric names a shape, the largest of that kind counts, whatever else is shown; a link without it fails."""
    body = visual(box(*SIZE), material=paint("0 0.6 0 1", "green"))
    ball = visual(sphere(9.0), material=paint("1 0 0 1", "red"))
    small = visual(box(0.1, 0.1, 0.1), material=paint("1 0 0 1", "red"))
    for found in (scene(link("base", body, ball)), scene(link("base", ball, body))):
        passes(shows_colour, found, **GREEN, shape="box")
        for shape in ("any", "sphere", "cylinder"):
            assert "rgba 1 0 0 1" in fails(shows_colour, found, at='rgba="1 0 0 1"', **GREEN, shape=shape)
    beside_a_mesh = visual(mesh(), material=paint("1 0 0 1", "red"))
    for order in ((beside_a_mesh, body), (small, body), (body, small)):
        passes(shows_colour, scene(link("base", *order)), **GREEN, shape="box")


LEVEL, TINTED = "; each should be at least 0.75", ", which is not grey; red, green and blue should be equal"


@pytest.mark.parametrize(
    ("rgba", "complaint"),
    [
        ("0.75 0.75 0.75 1", ""), ("1 1 1 1", ""), ("0.75 0.76 0.76 0.01", ""), ("0.8 0.809 0.8 1", ""),
         ("0.8 0.81 0.8 1", ""),
        ("0.749 0.749 0.749 1", LEVEL), ("0.749 0.755 0.755 1", LEVEL), ("0.7 0.7 0.7 1", LEVEL),
        ("0.8 0.811 0.8 1", TINTED), ("1 1 0.9 1", TINTED), ("1 0 0 1", TINTED),
    ],
)  # fmt: skip
def test_white_is_a_light_grey(rgba: str, complaint: str) -> None:
    """White has equal channels within the tolerance, none below the level; opacity is ignored."""
    found, channels = painted(rgba, "lidar"), rgba.split()[:3]
    if not complaint:
        passes(shows_grey, found, **WHITE)
        outcome = ask(shows_grey, found, **WHITE)
        assert (outcome.measured, outcome.expected) == (tuple(map(float, channels)), 0.75)
        return
    assert fails(shows_grey, found, at="rgba=", **WHITE) == f"'lidar' is shown in rgb {' '.join(channels)}{complaint}"


@examples(20)
@given(channels=st.tuples(*[st.integers(0, 100)] * 3), level=st.integers(0, 100))
def test_grey_is_decided_by_the_channels_alone(channels: tuple[int, int, int], level: int) -> None:
    """For every colour in hundredths the result is that of exact arithmetic, the tolerance inclusive."""
    rgba = " ".join(f"{channel / 100:.2f}" for channel in channels) + " 1"
    outcome = ask(shows_grey, painted(rgba, "lidar"), link="lidar", at_least=level / 100, tolerance=0.01)
    assert (outcome.status == "passed") == (max(channels) - min(channels) <= 1 and min(channels) >= level)


# --- Nothing ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "visuals",
    [
        (),
        (visual(box(0.0, 0.0, 0.0)),),
        (visual(sphere(0.0)), visual(cylinder(0.0, 1.0))),
        (visual(box(1.0, 1.0, 1.0), material=paint("1 1 1 0")),),
        (visual(mesh(scale="0 0 0")),),
    ],
    ids=["no-visual", "zero-box", "zero-sphere-and-line", "fully-transparent", "mesh-scaled-to-nothing"],
)
def test_a_link_shows_nothing(visuals: tuple[str, ...]) -> None:
    """A link without visuals, with visuals without a size, or with transparent ones only shows nothing."""
    assert passes(shows_nothing, scene(link("foot", *visuals)), link="foot") == "'foot' shows nothing"


@pytest.mark.parametrize(
    ("shape", "material", "name"),
    [
        (box(0.01, 0.01, 0.01), "", "a box"),
        (cylinder(0.1, 0.0), "", "a cylinder"),
        (sphere(0.01), paint("1 1 1 0.01"), "a sphere"),
        (sphere(0.01), '<material name="undefined"/>', "a sphere"),
        (mesh(), "", "a mesh"),
    ],
    ids=["box", "disc", "nearly-transparent", "undefined-material", "mesh"],
)
def test_a_link_shows_something(shape: str, material: str, name: str) -> None:
    """A visible shape is named, and the failure points to it."""
    message = fails(shows_nothing, scene(link("foot", visual(shape, material=material))), at="<visual>", link="foot")
    assert message == f"'foot' shows {name}; it should have no visual"


def test_the_visible_one_of_several_visuals_is_named() -> None:
    """An invisible visual before a visible one does not hide it."""
    ghost = visual(box(1.0, 1.0, 1.0), material=paint("1 1 1 0"))
    found = scene(link("foot", visual(box(0.0, 0.0, 0.0)), ghost, visual(sphere(0.5))))
    assert "shows a sphere" in fails(shows_nothing, found, at="<visual>\n<geometry>\n<sphere", link="foot")


def test_a_collision_is_not_shown() -> None:
    """Only visuals are visible."""
    bumper = '<collision>\n<geometry>\n<sphere radius="1"/>\n</geometry>\n</collision>'
    passes(shows_nothing, scene(link("foot", bumper)), link="foot")
    assert missing(shows_sphere, scene(link("caster", bumper)), **SPHERE).kind == "visual"


def test_other_links_do_not_matter() -> None:
    """A check examines its own link only."""
    passes(shows_box, scene(LIDAR, BASE), **BOX)
    passes(shows_nothing, scene(link("foot"), BASE), link="foot")


def test_an_invisible_colour_is_wrong_unless_it_is_wanted() -> None:
    """Below an alpha of 0.01 nothing shows; a rubric may ask for that by the fourth channel."""
    assert "invisible" in fails(shows_colour, painted("0 0.6 0 0.009"), **{**GREEN, "colour": (0.0, 0.6, 0.0)})
    passes(shows_colour, painted("0 0.6 0 0.01"), **{**GREEN, "colour": (0.0, 0.6, 0.0)})
    passes(shows_colour, painted("0 0.6 0 0"), **{**GREEN, "colour": (0.0, 0.6, 0.0, 0.0)})


@pytest.mark.parametrize("size", [(-0.6, 0.4, 0.2), (0.6, 0.4, -0.001)])
def test_a_negative_size_is_wrong(size: Vector) -> None:
    """Even if it is within the tolerance of a thin plate."""
    passes(shows_box, boxed(0.6, 0.4, abs(size[2])), **{**BOX, "size": (0.6, 0.4, abs(size[2]))})
    fails(shows_box, boxed(*size), **{**BOX, "size": (0.6, 0.4, abs(size[2]))})
