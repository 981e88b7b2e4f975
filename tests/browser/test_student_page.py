"""The student's page in a browser: controls move the robot, keys work, failures lead to their link, nothing runs or loads."""

from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from grader.grading.report import Report
from grader.report.formats import Format, render
from tests.browser.conftest import OpenPage
from tests.browser.test_kinematics import ODD
from tests.command_line import run
from tests.report.hostile import HOSTILE
from tests.report.reports import hinted, marked
from tests.report.rewording import recast
from tests.samples import SAMPLES

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]
PIXELS = "() => { viewer.draw(); return viewer.canvas.toDataURL(); }"
PIECES = (*HOSTILE["html"], *HOSTILE["links"], *HOSTILE["xml"])
ATTACK = "".join(("</script><script>document.title='run'</script>", *PIECES)) + "\"onerror='x' javascript:"


def write(folder: Path, *arguments: object) -> Path:
    """Write what a command prints to a file, and return that."""
    file = folder / "page.html"
    file.write_bytes(run((*arguments, "--format", "html")).stdout)
    return file


@pytest.fixture(scope="module")
def page(open_pages: Open, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Return the page of a robot with a wheel that turns the wrong way and a buried lidar; all tests use it as they find it."""
    file = write(tmp_path_factory.mktemp("page"), "grade", SAMPLES["several-mistakes"].path)
    opened = open_pages(file, viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    yield opened.page
    opened.check()


@pytest.fixture
def fresh(page: Any) -> Any:
    """Return the page with the robot as at the start."""
    page.evaluate("() => { viewer.reset(); viewer.choose(-1); scrollTo(0, 0); }")
    page.get_by_role("button", name="Submission", exact=True).click()
    return page


def pose(page: Any, link: str) -> list[float]:
    """Return the pose of a link as the page shows it."""
    page.evaluate("() => viewer.draw()")
    found: list[float] = page.evaluate("link => viewer.state.poses[pageData.robot.links.indexOf(link)]", link)
    return found


def test_slider_turns_the_wheel(fresh: Any) -> None:
    """The keys of a slider turn its wheel: its pose, the picture, and the number beside it."""
    slider = fresh.get_by_label("base_right_wheel_joint")
    before, picture = pose(fresh, "right_wheel"), fresh.evaluate(PIXELS)
    slider.focus()
    fresh.keyboard.press("ArrowRight")
    after = pose(fresh, "right_wheel")
    assert after[9:] == before[9:]
    assert max(abs(one - other) for one, other in zip(after, before, strict=True)) > 0.01
    assert fresh.evaluate(PIXELS) != picture
    assert slider.locator("..").locator("output").inner_text() != "0 \u00b0"


def test_keys_move_the_camera(fresh: Any) -> None:
    """Arrow keys rotate, plus and minus zoom, shift moves, digits look from the front, side and top, 0 resets."""
    canvas = fresh.locator("canvas")
    canvas.focus()
    seen = [fresh.evaluate(PIXELS)]
    for key in ("ArrowLeft", "ArrowUp", "+", "Shift+ArrowUp", "1", "2", "3"):
        fresh.keyboard.press(key)
        seen.append(fresh.evaluate(PIXELS))
    assert len(set(seen)) == len(seen)
    fresh.keyboard.press("0")
    assert fresh.evaluate(PIXELS) == seen[0]


def test_pointer_rotates_moves_and_zooms(fresh: Any) -> None:
    """Dragging rotates, with shift it moves, the wheel zooms; a click chooses the link under it."""
    box = fresh.locator("canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    camera = "() => [viewer.camera.azimuth, viewer.camera.zoom, viewer.camera.target.join()]"
    start = fresh.evaluate(camera)
    fresh.mouse.move(x, y)
    fresh.mouse.down()
    fresh.mouse.move(x + 60, y, steps=2)
    fresh.mouse.up()
    turned = fresh.evaluate(camera)
    assert turned[0] != start[0]
    assert turned[1:] == start[1:]
    fresh.keyboard.down("Shift")
    fresh.mouse.down()
    fresh.mouse.move(x, y, steps=2)
    fresh.mouse.up()
    fresh.keyboard.up("Shift")
    assert fresh.evaluate(camera)[2] != start[2]
    fresh.mouse.wheel(0, -200)
    fresh.wait_for_function(f"() => ({camera})()[1] > 1")
    fresh.evaluate("() => viewer.reset()")
    fresh.evaluate("() => viewer.draw()")
    fresh.mouse.click(x, y)
    assert fresh.locator("#links option:checked").inner_text() == "base_link"
    fresh.evaluate("() => viewer.draw()")
    assert fresh.locator("[data-part=pose]").inner_text() == "at 0 0 0 m in base_link"


def test_submission_reference_and_both(fresh: Any) -> None:
    """Each shows another picture, and its button is pressed."""
    pictures = []
    for name in ("Submission", "Reference", "Both"):
        fresh.get_by_role("button", name=name, exact=True).click()
        pictures.append(fresh.evaluate(PIXELS))
        assert fresh.locator("[data-mode][aria-pressed=true]").all_inner_texts() == [name]
    assert len(set(pictures)) == 3


def test_page_opens_with_the_submission(open_page: Open, tmp_path: Path) -> None:
    """Numbers are those of the submission: `Reference` has none, and a link that only the reference has is in `Both`."""
    page = open_page(write(tmp_path, "grade", SAMPLES["lidar-missing"].path), reduced_motion="reduce").page
    numbers = page.locator(".labels .callout:visible")
    pressed = page.locator("[data-mode][aria-pressed=true]")
    page.evaluate("() => viewer.draw()")
    assert (pressed.inner_text(), numbers.count()) == ("Submission", 0)
    page.locator("#criterion-lidar-shape .pin").first.click()
    page.evaluate("() => viewer.draw()")
    assert (pressed.inner_text(), numbers.count()) == ("Both", 1)
    page.get_by_role("button", name="Reference", exact=True).click()
    page.evaluate("() => viewer.draw()")
    assert (pressed.inner_text(), numbers.count()) == ("Reference", 0)


def test_labels_do_not_overlap(fresh: Any) -> None:
    """Numbers, letters of axes and the name of a link are beside each other, from each side."""
    fresh.get_by_role("button", name="Frames").click()
    fresh.get_by_label("Link", exact=True).select_option("lidar")
    for azimuth in (0, 1, 2, 3):
        fresh.evaluate("azimuth => { viewer.camera.azimuth = azimuth; viewer.draw(); }", azimuth)
        boxes = [label.bounding_box() for label in fresh.locator(".labels span:visible").all()]
        assert len(boxes) > 15
        for one, other in combinations(boxes, 2):
            across, down = (
                abs(one[at] + one[size] / 2 - other[at] - other[size] / 2)
                for at, size in (("x", "width"), ("y", "height"))
            )
            assert (
                across >= (one["width"] + other["width"]) / 2 - 3 or down >= (one["height"] + other["height"]) / 2 - 3
            )
    fresh.get_by_role("button", name="Frames").click()


def test_failure_leads_to_its_link(fresh: Any) -> None:
    """The number of a failure turns the robot to its link and marks it; the focus alone marks it."""
    card = fresh.locator("#criterion-right-wheel-forward")
    card.locator("pre.source").first.focus()
    assert fresh.locator("#links option:checked").inner_text() == "right_wheel"
    azimuth = fresh.evaluate("() => viewer.camera.azimuth = 1")  # the page may begin with the lidar
    fresh.locator("#criterion-lidar-frame .pin").first.click()
    assert fresh.locator("#links option:checked").inner_text() == "lidar"
    assert fresh.evaluate("() => viewer.camera.azimuth") != azimuth
    assert (
        fresh.locator(".labels .chosen:visible").inner_text()
        == fresh.locator("#criterion-lidar-frame .pin").first.inner_text()[-1]
    )
    card.hover()
    assert fresh.locator(".views .lit title").first.text_content() == "right_wheel"


def test_wheels_drive_and_stop(fresh: Any) -> None:
    """With less motion preferred, `Drive` turns all wheels by a step; here they turn the base, because one is reversed."""
    fresh.get_by_role("button", name="Drive").click()
    angles = fresh.evaluate("() => [...viewer.given.values()].map(value => Math.round(value * 180 / Math.PI))")
    assert angles == [15, 15]
    drift = fresh.evaluate("() => viewer.state.drift")
    assert abs(drift[0] - 1) > 1e-3  # it has turned
    assert abs(drift[9]) < 0.01  # and not gone ahead: a wheel rolls 26 mm
    assert fresh.evaluate("() => viewer.isDriving()") is False
    fresh.emulate_media(reduced_motion="no-preference")
    button = fresh.get_by_role("button", name="Drive")
    button.click()
    fresh.wait_for_function("() => [...viewer.given.values()][0] > 0.3")
    assert button.get_attribute("aria-pressed") == "true"
    button.click()
    assert (button.get_attribute("aria-pressed"), fresh.evaluate("() => viewer.isDriving()")) == ("false", False)
    fresh.emulate_media(reduced_motion="reduce")


def test_frames_and_names(fresh: Any) -> None:
    """`Frames` shows the axes of every frame; a link has its name under the pointer, and in the list its pose."""
    letters = fresh.locator(".labels .axis:visible")
    fresh.evaluate("() => viewer.draw()")
    assert letters.count() == 3  # of the root
    fresh.get_by_role("button", name="Frames").click()
    fresh.evaluate("() => viewer.draw()")
    assert letters.count() == 18
    fresh.get_by_role("button", name="Frames").click()
    fresh.get_by_label("Link", exact=True).select_option("lidar")
    fresh.evaluate("() => viewer.draw()")
    assert fresh.locator(".labels .name").inner_text() == "lidar"
    assert fresh.locator("[data-part=pose]").inner_text() == "at 0.15 0 0.2 m in base_link"
    fresh.get_by_role("button", name="Reference", exact=True).click()
    fresh.evaluate("() => viewer.draw()")
    assert fresh.locator("[data-part=pose]").inner_text() == "at 0.15 0 0.2 m in base_link (submission)"


def test_new_text_is_copied(open_page: Open, tmp_path: Path) -> None:
    """The button of a hint copies the new lines."""
    allowed = {"permissions": ["clipboard-read", "clipboard-write"]}
    page = open_page(write(tmp_path, "grade", SAMPLES["axis-negated"].path), **allowed).page
    page.get_by_role("button", name="Copy the new text").first.click()
    page.get_by_role("button", name="Copied").wait_for()
    assert page.evaluate("() => navigator.clipboard.readText()").strip() == '<axis xyz="0 0 1"/>'


def test_nothing_is_drawn_without_a_change(fresh: Any) -> None:
    """No loop runs while nothing changes."""
    counted = fresh.evaluate("""async () => {
      const real = requestAnimationFrame; let asked = 0;
      await new Promise((done) => real(() => real(done)));
      window.requestAnimationFrame = (step) => { asked += 1; return real(step); };
      await new Promise((done) => real(() => real(() => real(done))));
      const idle = asked;
      viewer.schedule(); viewer.schedule();
      window.requestAnimationFrame = real;
      return [idle, asked];
    }""")
    assert counted == [0, 1]


def test_dark_mode_and_print(fresh: Any) -> None:
    """Dark mode has another background, also in 3-D; print has a white one, everything unfolded, and no controls."""
    light = fresh.evaluate(PIXELS)
    fresh.emulate_media(color_scheme="dark")
    assert fresh.evaluate("() => getComputedStyle(document.body).backgroundColor") == "rgb(13, 17, 23)"
    fresh.wait_for_function(f"light => ({PIXELS})() !== light", arg=light)
    assert fresh.pdf()[:5] == b"%PDF-"
    fresh.emulate_media(media="print", color_scheme="dark")
    assert fresh.evaluate("() => getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert (
        fresh.evaluate("() => getComputedStyle(document.querySelector('.hint')).backgroundColor")
        == "rgb(218, 251, 225)"
    )
    assert not fresh.locator("canvas").is_visible()
    assert fresh.get_by_role("heading", name="The robot", exact=True).count() == 0
    tops = [
        fresh.locator(f"{part} h2").first.bounding_box()["y"] for part in ("header + main .picture", ".report", ".all")
    ]
    assert tops == sorted(tops)  # the three views are where the robot in 3-D is on the screen
    assert fresh.locator("details td").first.is_visible()
    tables = fresh.locator("details table").evaluate_all(
        "tables => tables.map((one) => one.clientWidth / one.parentElement.clientWidth)"
    )
    assert min(tables) > 0.9
    fresh.emulate_media(media="screen", color_scheme="light")
    fresh.wait_for_function(f"light => ({PIXELS})() === light", arg=light)


@pytest.mark.parametrize("width", [360, 800, 1400])
def test_no_width_scrolls_sideways(fresh: Any, width: int) -> None:
    """A telephone, a small and a large window: nothing is wider than the page."""
    fresh.set_viewport_size({"width": width, "height": 800})
    assert fresh.evaluate("() => document.documentElement.scrollWidth") <= width
    assert fresh.evaluate("() => viewer.canvas.clientWidth") > 300
    for lines in fresh.locator(".diff, .source").all():  # all of each line is visible, also what changes
        assert lines.evaluate("lines => lines.scrollWidth <= lines.clientWidth")
    fresh.set_viewport_size({"width": 1280, "height": 900})


def test_every_control_has_a_name(fresh: Any) -> None:
    """A screen reader says what each control is; the robot is described in words."""
    for control in fresh.locator("main :is(button, input, select, canvas):visible").all():
        assert control.evaluate("node => node.ariaLabel || node.labels?.[0]?.innerText || node.innerText")
    assert "right-wheel-forward" in fresh.locator("#robot-words").inner_text()


def test_page_works_without_scripts(open_page: Open, tmp_path: Path) -> None:
    """Without JavaScript there is no 3-D, and all else is there."""
    file = write(tmp_path, "grade", SAMPLES["lidar-buried"].path)
    page = open_page(file, java_script_enabled=False).page
    assert page.locator("#criterion-lidar-frame").is_visible()
    assert page.locator(".views svg").is_visible()
    assert not page.locator("canvas").is_visible()


def test_page_without_webgl_says_so(open_page: Open, tmp_path: Path) -> None:
    """Where WebGL is missing, a sentence takes the place of the canvas."""
    file = write(tmp_path, "inspect", SAMPLES["arm/axis-sign"].path)
    opened = open_page("about:blank")
    opened.page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    opened.page.goto(file.as_uri())
    opened.requests.clear()
    assert opened.page.get_by_text("does not show 3-D graphics").is_visible()
    assert not opened.page.locator("canvas").is_visible()


@pytest.mark.parametrize("made", [hinted, marked])
def test_hostile_report_stays_text(open_page: Open, tmp_path: Path, made: Callable[[], Report]) -> None:
    """The same in messages, notes, problems, paths, source lines, hints and comments of manual marks."""
    report = recast(made(), lambda: ATTACK)
    results = (
        result._replace(manual_mark=result.manual_mark and result.manual_mark._replace(by=ATTACK, comment=ATTACK))
        for result in report.results
    )
    file = tmp_path / "page.html"
    file.write_text(render(report._replace(results=tuple(results), notes=(ATTACK,)), Format.HTML), encoding="utf-8")
    opened = open_page(file)
    assert "<script>document.title" in opened.page.locator("main").inner_text()
    assert opened.page.title() != "run"
    assert len(opened.requests) == 1


# Nothing to show, one link, a mesh, sizes that no picture has, names that mean something to JavaScript and to CI systems.
ODD_ROBOTS = (
    ODD,
    "<robot name='a'/>",
    "<robot name='a'><link name='x'/></robot>",
    "<robot name='a'><link name='x'><visual><geometry><mesh filename='a.stl'/></geometry></visual></link></robot>",
    (
        "<robot name='a'><link name='x'><visual><geometry><box size='9000 1e-9 1e-9'/></geometry></visual>"
        "<visual><origin xyz='1e200 0 0'/><geometry><sphere radius='1e300'/></geometry></visual></link></robot>"
    ),
    (
        "<robot name='##[error]x'><link name='x'><visual><geometry><box size='1 1 1'/></geometry></visual></link>"
        "<link name='__proto__'/><link name='constructor'/>"
        "<joint name='toString' type='continuous'><parent link='x'/><child link='__proto__'/><axis xyz='0 0 1'/></joint>"
        "<joint name='__proto__' type='continuous'><parent link='x'/><child link='constructor'/><mimic joint='toString'/></joint></robot>"
    ),
)


def test_odd_robots_are_shown(open_page: Open, tmp_path: Path) -> None:
    """Each has a page without an error; those with links are drawn, and their joints move."""
    (tmp_path / "robot.urdf").write_text(ODD_ROBOTS[0])
    opened = open_page(write(tmp_path, "inspect", tmp_path / "robot.urdf"))
    for text in ODD_ROBOTS:
        (tmp_path / "robot.urdf").write_text(text)
        opened.page.goto(write(tmp_path, "inspect", tmp_path / "robot.urdf").as_uri())
        if "<link" in text:
            assert opened.page.evaluate("() => { viewer.draw(); return viewer.camera.target.every(Number.isFinite); }")
        for slider in opened.page.locator("input[type=range]:enabled").all():
            slider.evaluate("node => { node.value = node.max; node.dispatchEvent(new Event('input')); viewer.draw(); }")
            assert slider.locator("..").locator("output").inner_text()[0] in "0123456789-"


def test_two_fingers_zoom(open_page: Open, tmp_path: Path) -> None:
    """On a touch screen one finger rotates and two zoom."""
    file = write(tmp_path, "inspect", SAMPLES["lidar-buried"].path)
    page: Any = open_page(file, viewport={"width": 400, "height": 900}, has_touch=True, is_mobile=True).page
    page.locator("canvas").scroll_into_view_if_needed()
    box, session = page.locator("canvas").bounding_box(), page.context.new_cdp_session(page)
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def touch(*places: tuple[float, ...]) -> list[float]:
        """Move fingers through places on the x axis, and return azimuth and zoom."""
        for kind, place in zip(
            ("touchStart", *["touchMove"] * (len(places) - 1), "touchEnd"), (*places, ()), strict=True
        ):
            points = [{"x": x + off, "y": y, "id": number} for number, off in enumerate(place)]
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        found: list[float] = page.evaluate("() => [viewer.camera.azimuth, viewer.camera.zoom]")
        return found

    start = touch((0,))
    turned = touch((0,), (20,), (40,), (60,))
    assert turned[0] < start[0]
    assert turned[1] == start[1]
    assert touch((-30, 30), (-40, 40), (-60, 60))[1] > 1.5 * start[1]
