"""The robot in 3-D in a browser: it moves as the kinematics say, by every hand, and is silent."""

import random
from collections.abc import Callable, Iterator
from math import acos, hypot, pi
from pathlib import Path
from typing import Any

import pytest

from grader.base.transforms import Transform, dot, rotation_about, rotation_from_rpy, unit
from grader.report.drawing.drive import drive_data
from grader.report.drawing.graded_picture import draw_report
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Robot
from grader.ros.urdf.reader import read_urdf
from tests.browser.conftest import CHROMIUM, OpenPage
from tests.command_line import ROOT, run
from tests.samples import SAMPLES
from tests.urdf.builders import joint, links, robot

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]
WIDE = {"width": 1366, "height": 900}


def write(folder: Path, *arguments: object) -> Path:
    """Write what a command prints as a page to a file, and return that."""
    file = folder / "page.html"
    file.write_bytes(run((*arguments, "--format", "html")).stdout)
    return file


@pytest.fixture(scope="module")
def page(open_pages: Open, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Return the page of a robot with several mistakes; each test resets it."""
    folder = tmp_path_factory.mktemp("space")
    opened = open_pages(write(folder, "grade", SAMPLES["several-mistakes"].path), viewport=WIDE)
    yield opened.page
    opened.check()


@pytest.fixture(autouse=True)
def _reset(request: pytest.FixtureRequest) -> None:
    if "page" in request.fixturenames:
        request.getfixturevalue("page").get_by_role("button", name="Reset").click()


def picture(page: Any) -> bytes:
    """Return the canvas as a picture, after it is drawn."""
    page.evaluate("() => new Promise(requestAnimationFrame)")
    drawn: bytes = page.locator("#space-canvas").screenshot()
    return drawn


def rows(pose: Transform) -> list[float]:
    """Return a pose as scripts have it."""
    return [value for row in pose.matrix[:3] for value in row]


def random_robot(seed: int) -> str:
    """Return a tree of links with each type of joint, in any direction, with mimics of mimics and of nothing."""
    source = random.Random(seed)
    count = source.randint(2, 40)
    names = [f"link {k}" for k in range(count)]
    text = links(*names)

    def numbers(size: float) -> str:
        return " ".join(f"{source.uniform(-size, size):.4f}" for _ in range(3))

    for k in range(1, count):
        kind = source.choice(["revolute", "continuous", "prismatic", "fixed", "floating", "planar"])
        body = f'<origin xyz="{numbers(1)}" rpy="{numbers(3)}"/><axis xyz="{numbers(1)}"/>'
        body += '<limit lower="-2" upper="1.5" effort="1" velocity="1"/>'
        if source.random() < 0.3:
            leader = f"joint {source.randint(1, count + 1)}"
            body += (
                f'<mimic joint="{leader}" multiplier="{source.uniform(-2, 2):.3f}" offset="0.25"/>'
            )
        text += joint(names[source.randrange(k)], names[k], f"joint {k}", kind=kind, body=body)
    return robot(text)


def assert_same_poses(page: Any, read: Robot, frame: str, source: random.Random) -> None:
    """Assert that the script has the poses of the kinematics at random positions of the joints that have sliders."""
    joints = page.evaluate("() => [...RobotView.sliders.keys()]")
    for _ in range(5):
        positions = {name: source.uniform(-1.5, 1.5) for name in joints}
        page.evaluate(
            "(all) => Object.entries(all).forEach(([name, one]) => RobotView.positions.set(name, one))",
            positions,
        )
        page.evaluate("() => RobotView.render()")
        found = page.evaluate("() => Object.fromEntries(RobotView.poses())")
        configuration = Configuration(read, positions)
        assert found.keys() == {link.name for link in read.links}
        for name, pose in found.items():
            expected = configuration.pose(name, relative_to=frame)
            assert pose == pytest.approx(rows(expected), abs=1e-6), name


@pytest.mark.parametrize("name", ["caster-at-the-back", "diameter-for-radius", "axis-negated"])
def test_robot_drives_as_computed(open_page: Open, tmp_path: Path, name: str) -> None:
    """It comes to rest with the direction that is up upright, its mass at the height that was computed; then it moves
    as its velocity says, at first and for the whole way.
    """
    page = open_page(write(tmp_path, "grade", SAMPLES[name].path)).page
    picture = draw_report(SAMPLES[name].grade())
    assert picture is not None
    drive = drive_data(picture)
    assert drive is not None
    floor = -0.1

    def pose_after(seconds: float) -> Any:
        found = page.evaluate("(all) => Drive.after(...all)", [drive, floor, 1.0, seconds])
        a, b, c, x, d, e, f, y, g, h, i, z = found["pose"]
        return Transform((a, b, c, d, e, f, g, h, i), (x, y, z)), found["turned"], found["isOver"]

    first, turned, is_over = pose_after(0.0)
    assert (turned, is_over) == (0, False)
    assert rows(first) == pytest.approx(rows(Transform()), abs=1e-9)
    length, before = 0.0, (0.0, 0.0, 1.0)
    for *up, height in drive["fall"]:
        length += 0.3 + acos(min(1.0, dot(before, up)))
        before = up
        T_ground_robot, turned, _ = pose_after(length)
        x, y, z = T_ground_robot.apply(drive["mass"])
        assert (x, y, z) == pytest.approx((*drive["mass"][:2], floor + height), abs=1e-6)
        assert T_ground_robot.rotate(up) == pytest.approx((0, 0, 1), abs=1e-4)
    rest, _, _ = pose_after(length)
    x, y, rate = drive["motion"]
    moved, turned, _ = pose_after(length + 0.001)
    motion = moved @ rest.inverse()
    assert motion.rpy[2] == pytest.approx(rate * turned, abs=1e-6)
    ways = [
        b - a for a, b in zip(rest.apply(drive["mass"]), moved.apply(drive["mass"]), strict=True)
    ]
    assert ways == pytest.approx([x * turned, y * turned, 0], abs=1e-5)
    last, turned, is_over = pose_after(1e9)
    assert is_over
    if rate:  # on a circle
        assert abs(rate * turned) == pytest.approx(2 * pi)
        assert rows(last) == pytest.approx(rows(rest), abs=1e-6)
    else:
        assert turned * hypot(x, y) == pytest.approx(1.5)


def test_drive_button_moves_the_robot_until_it_is_pressed_again(page: Any) -> None:
    """It says what one sees, turns the wheels and hides the reference; the button, a slider and Reset put it back."""
    canvas, button = page.locator("#space-canvas"), page.get_by_role("button", name="Drive")
    page.locator("#space-frames").focus()
    before = picture(page)
    for stop in ("Drive", "Reset"):
        button.click()
        assert button.get_attribute("aria-pressed") == "true"
        assert "it turns on the spot to the right" in page.locator("#space-about").inner_text()
        page.evaluate("() => RobotView.driveTo(2)")
        assert canvas.screenshot() != before
        page.get_by_role("button", name=stop).click()
        assert button.get_attribute("aria-pressed") == "false"
        page.locator("#space-frames").focus()
        assert picture(page) == before
        assert page.locator("#space-about").inner_text() == ""
    button.click()
    page.evaluate("() => RobotView.driveTo(2)")
    page.get_by_label("base_left_wheel_joint").fill("0")
    assert button.get_attribute("aria-pressed") == "false"
    page.locator("#space-frames").focus()
    assert picture(page) == before


def test_drive_does_not_move_for_who_wants_no_motion(browser: Any, tmp_path: Path) -> None:
    """The robot is at once where it would come to."""
    page = browser.new_page(reduced_motion="reduce")
    page.goto(write(tmp_path, "grade", SAMPLES["axis-negated"].path).as_uri())
    page.get_by_role("button", name="Drive").click()
    turned = page.evaluate("() => RobotView.positions.get('base_left_wheel_joint')")
    assert turned > 6
    page.close()


@pytest.mark.parametrize("seed", range(12))
def test_poses_of_random_robots(open_page: Open, tmp_path: Path, seed: int) -> None:
    """At random positions of its joints, each link is where `Configuration.pose` has it."""
    text = random_robot(seed)
    (tmp_path / "robot.urdf").write_text(text)
    page = open_page(write(tmp_path, "inspect", tmp_path / "robot.urdf")).page
    read = read_urdf(text.encode()).robot
    assert read is not None
    assert_same_poses(page, read, read.links[0].name, random.Random(seed))


@pytest.mark.parametrize(
    ("path", "frame"),
    [
        ("rubrics/arm/arm.urdf", "world"),
        ("rubrics/lab6/my_robot/urdf/my_robot.urdf", "base_footprint"),
    ],
)
def test_poses_of_references(open_page: Open, tmp_path: Path, path: str, frame: str) -> None:
    """Likewise for the arm and the wheeled base."""
    page = open_page(write(tmp_path, "inspect", ROOT / path)).page
    read = read_urdf((ROOT / path).read_bytes()).robot
    assert read is not None
    assert_same_poses(page, read, frame, random.Random(path))


def test_rigid_motions_are_those_of_python(page: Any) -> None:
    """Products, inverses, rotations about axes and angles of random poses."""
    source = random.Random(3)

    def vector() -> tuple[float, float, float]:
        return (source.uniform(-3, 3), source.uniform(-3, 3), source.uniform(-3, 3))

    for _ in range(20):
        one, other = (Transform(rotation_from_rpy(vector()), vector()) for _ in range(2))
        axis, angle, point = unit(vector()), source.uniform(-7, 7), vector()
        assert axis is not None
        found = page.evaluate(
            """([a, b, axis, angle, point]) => [
                Transforms.product(a, b), Transforms.inverse(a), Transforms.about(axis, angle),
                Transforms.along(axis, angle), Transforms.apply(a, point), Transforms.rotate(a, point),
                Transforms.unrotate(a, point), Transforms.rpy(a)]""",
            [rows(one), rows(other), axis, angle, point],
        )
        along = Transform(translation=(axis[0] * angle, axis[1] * angle, axis[2] * angle))
        about = Transform(rotation_about(axis, angle))
        expected = [rows(one @ other), rows(one.inverse()), rows(about), rows(along)]
        expected += [[*one.apply(point)], [*one.rotate(point)], [*one.unrotate(point)], [*one.rpy]]
        for script, python in zip(found, expected, strict=True):
            assert script == pytest.approx(python, abs=1e-12)


def test_canvas_shows_the_robot(page: Any) -> None:
    """Many pixels are green, as the base is: the canvas is not blank."""
    greens = page.evaluate(
        """() => {
          RobotView.render();
          const canvas = document.getElementById("space-canvas");
          const copy = document.createElement("canvas");
          [copy.width, copy.height] = [canvas.width, canvas.height];
          const context = copy.getContext("2d");
          context.drawImage(canvas, 0, 0);
          const { data } = context.getImageData(0, 0, copy.width, copy.height);
          let count = 0;
          for (let i = 0; i < data.length; i += 4) count += data[i + 1] > 100 && data[i] < 50;
          return count / (data.length / 4);
        }"""
    )
    assert 0.05 < greens < 0.6


def test_every_control_changes_the_picture_and_reset_undoes_it(page: Any) -> None:
    """A drag, the wheel, keys, the slider of a wheel, the buttons; the slider is in degrees."""
    canvas = page.locator("#space-canvas")
    page.locator("#space-frames").focus()
    first = picture(page)
    box = canvas.bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def drag(**options: Any) -> None:
        page.mouse.move(*middle)
        page.mouse.down(**options)
        page.mouse.move(middle[0] + 60, middle[1] + 20)
        page.mouse.up(**options)

    def wheel() -> None:
        page.mouse.move(*middle)
        page.mouse.wheel(0, 200)

    def press(key: str) -> None:
        canvas.focus()
        page.keyboard.press(key)
        page.locator("#space-frames").focus()

    actions: list[Callable[[], Any]] = [
        drag,
        lambda: drag(button="middle"),
        wheel,
        *(lambda key=key: press(key) for key in ("ArrowLeft", "ArrowDown", "+", "-")),
        lambda: press("Shift+ArrowUp"),
        lambda: page.get_by_label("base_right_wheel_joint").fill("20"),
        lambda: page.locator("#space-links").select_option("lidar"),
    ]
    for number, action in enumerate(actions):
        action()
        assert picture(page) != first, number
        page.get_by_role("button", name="Reset").click()
        page.locator("#space-frames").focus()
        assert picture(page) == first, number
    for name in ("Reference", "Frames"):
        page.get_by_role("button", name=name, exact=True).click()
        assert picture(page) != first
        page.get_by_role("button", name=name, exact=True).click()


def test_slider_is_in_degrees_and_hides_the_reference(page: Any) -> None:
    """The wheel is turned by 20 degrees; the reference, which does not move, is hidden meanwhile."""
    page.get_by_label("base_right_wheel_joint").fill("20")
    assert page.evaluate(
        "() => RobotView.positions.get('base_right_wheel_joint')"
    ) == pytest.approx(0.349065, abs=1e-6)
    assert page.get_by_text("20°").is_visible()
    moved = picture(page)
    page.get_by_role("button", name="Reference").click()
    assert picture(page) == moved
    page.get_by_role("button", name="Reference").click()


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("lidar-buried", [[0.15, 0, 0.225]]),
        ("wheels-rolling-sideways", [[-0.15, 0.225, 0], [-0.15, -0.225, 0]]),
    ],
)
def test_reference_is_where_it_should_be(
    open_page: Open, tmp_path: Path, name: str, expected: list[list[float]]
) -> None:
    """The ghost is read from the three views: the middle of each part, once, is where the reference has it."""
    page = open_page(write(tmp_path, "grade", SAMPLES[name].path)).page
    bodies = page.evaluate(
        """() => {
          const links = JSON.parse(document.getElementById("data").textContent).robot.links;
          const points = links.flatMap((link) => link.shapes.flatMap((shape) =>
            Shapes.points(shape, Transforms.product(RobotView.poses().get(link.name), shape.pose))));
          const { views, scale } = Ghost.views(document.querySelector(".views svg"), points);
          return Ghost.bodies(views, scale).map((body) => body.middle);
        }"""
    )
    assert len(bodies) == len(expected)
    for middle, place in zip(bodies, expected, strict=True):
        assert middle == pytest.approx(place, abs=0.001)


def test_click_names_a_link_and_number_leads_to_its_mistake(page: Any) -> None:
    """Left of the middle is the base; a number leads to the card, and the number of the card back."""
    box = page.locator("#space-canvas").bounding_box()
    place = {"x": 0.36 * box["width"], "y": 0.48 * box["height"]}
    page.locator("#space-canvas").click(position=place)
    about = page.locator("#space-about").inner_text()
    assert about.startswith("base_link at 0 0 0 m, rpy 0 0 0° in base_link")
    page.locator(".space-pin", has_text="1").click()
    assert page.url.endswith("#criterion-lidar-frame")
    page.locator("#criterion-lidar-frame .pin").first.click()
    assert page.locator("#space-about").inner_text().startswith("lidar at 0.15 0 0.2 m")


def test_names_of_links_are_shown(page: Any) -> None:
    """The link under the pointer and the chosen one have their names, with Frames all that have room."""

    def names() -> set[str]:
        page.evaluate("() => RobotView.render()")
        return {
            element.text_content()
            for element in page.locator(".space-name").all()
            if element.get_attribute("visibility") == "visible"
        }

    page.locator("#space-reset").click()
    page.mouse.move(0, 0)
    assert names() == {"base_link"}
    page.locator("#space-links").select_option("lidar")
    assert names() == {"base_link", "lidar"}
    page.locator("#space-frames").click()
    assert {"lidar", "left_wheel", "base_link"} <= names()
    page.locator("#space-frames").click()
    page.locator("#space-reset").click()
    box = page.locator("#space-canvas").bounding_box()
    page.mouse.move(box["x"] + 0.36 * box["width"], box["y"] + 0.48 * box["height"])
    page.evaluate("() => RobotView.select('lidar')")
    assert names() == {"base_link", "lidar"}
    page.locator("#space-reset").click()


def test_two_fingers_zoom(browser: Any, tmp_path: Path) -> None:
    """One finger turns the robot, two zoom."""
    context = browser.new_context(has_touch=True, viewport={"width": 390, "height": 844})
    page = context.new_page()
    page.goto(write(tmp_path, "grade", SAMPLES["lidar-buried"].path).as_uri())
    touches = context.new_cdp_session(page)
    box = page.locator("#space-canvas").bounding_box()
    x, y = box["x"] + 100, box["y"] + 100

    def touch(kind: str, *points: tuple[float, float]) -> None:
        places = [{"x": a, "y": b, "id": k} for k, (a, b) in enumerate(points)]
        touches.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})

    before = page.evaluate("() => ({...RobotView.camera})")
    touch("touchStart", (x, y))
    touch("touchMove", (x + 30, y))
    touch("touchEnd")
    turned = page.evaluate("() => ({...RobotView.camera})")
    assert (turned["yaw"] < before["yaw"], turned["zoom"]) == (True, before["zoom"])
    touch("touchStart", (x, y), (x + 50, y))
    touch("touchMove", (x, y), (x + 100, y))
    touch("touchEnd")
    assert page.evaluate("() => RobotView.camera.zoom") < before["zoom"]
    assert page.evaluate("() => document.documentElement.scrollWidth") <= 390
    context.close()


def test_dark_and_print(page: Any) -> None:
    """In the dark the ground is dark; on paper there are the three views only."""
    light = picture(page)
    page.emulate_media(color_scheme="dark")
    assert picture(page) != light
    page.emulate_media(media="print", color_scheme="light")
    assert not page.locator("#space").is_visible()
    assert page.locator(".views svg").is_visible()
    page.emulate_media(media="screen", color_scheme="light")


def test_without_webgl_the_views_remain(browser: Any, tmp_path: Path) -> None:
    """A browser that has no WebGL shows the three views and no canvas, and says nothing."""
    file = write(tmp_path, "grade", SAMPLES["lidar-buried"].path)
    messages: list[str] = []
    other = browser.browser_type.launch(
        executable_path=CHROMIUM, args=["--no-sandbox", "--disable-3d-apis"]
    )
    page = other.new_page()
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.goto(file.as_uri())
    assert not page.locator("#space").is_visible()
    assert page.locator(".views svg").is_visible()
    other.close()
    assert messages == []
