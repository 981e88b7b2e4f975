"""A recording in `grader view`: the robot is drawn where it was recorded, by slider, button and keyboard."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from grader.base.transforms import Transform
from grader.files.opening import open_tree
from grader.ros.api import Recording, find_recordings, read_recording
from tests.browser.conftest import OpenPage
from tests.browser.test_accessibility import assert_accessible, axe  # noqa: F401  a fixture
from tests.command_line import ROOT
from tests.recordings.cart import URDF, files_of
from tests.recordings.writing import write_files
from tests.view_server import View, viewing

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]
SAMPLES = ROOT / "submissions/rover"
TIMES = 20
# How many pixels are red, with or without what is recorded.
_REDS = """(isShown) => {
  const view = RobotView;
  if (!isShown) {
    view.failed.clear();
    Object.assign(view.recorded, { path: null, wrong: [] });
  }
  view.render();
  const canvas = document.getElementById("space-canvas");
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0);
  const { data: pixels } = context.getImageData(0, 0, copy.width, copy.height);
  let count = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    count += pixels[i] > 150 && pixels[i + 1] < 60 && pixels[i + 2] < 60;
  }
  return count;
}"""
_LOG = "[INFO] [1764000002.000000000] [driver]: half way\n[ERROR] [1763000000.0] [driver]: of another run\n"


def _recorded(folder: Path) -> Recording:
    tree = open_tree(folder)
    assert tree is not None
    (files,) = find_recordings(tree)
    return read_recording(files)


def _recorded_pose(recording: Recording, child: str, number: int) -> Transform:
    """Return the pose of a frame in the root of the recorded transforms, at one of the recorded times."""
    pose = Transform()
    while child in recording.frames.parents:
        ((child, transforms),) = recording.frames.parents[child].items()
        pose = transforms[number if len(transforms) > 1 else 0].pose @ pose
    return pose


def _drawn_pose(page: Any, link: str, number: int) -> list[float]:
    """Return the 12 numbers of the pose of a link in the drawing, with the slider at one of the times."""
    numbers: list[float] = page.evaluate(
        """([link, number]) => {
          const data = JSON.parse(document.getElementById("data").textContent).robot.playback;
          const input = document.getElementById("space-time");
          input.value = String(Playback.sums(data.times, data.unit)[number]);
          input.dispatchEvent(new Event("input"));
          return RobotView.pose(link);
        }""",
        [link, number],
    )
    return numbers


@pytest.mark.parametrize("sample", ["equivalent-recorded", "recorded-bend"])
def test_the_robot_is_drawn_where_it_was_recorded(open_page: Open, sample: str) -> None:
    """At 20 times, wheels and base are where the recorded transforms have them, within a micrometre."""
    recording = _recorded(SAMPLES / sample)
    with viewing(SAMPLES / sample) as view:
        page = open_page(view.server.url).page
        for number in range(0, 2 * TIMES, 2):
            for link in ("base_footprint", "left_wheel", "right_wheel", "lidar"):
                pose = _recorded_pose(recording, link, number)
                drawn = _drawn_pose(page, link, number)
                assert drawn[3::4] == pytest.approx(pose.translation, abs=1e-6)
                rotation = [drawn[4 * row + column] for row in range(3) for column in range(3)]
                assert rotation == pytest.approx(pose.rotation, abs=1e-6)


@pytest.fixture(params=[360, 1280])
def drive(request: pytest.FixtureRequest, open_page: Open) -> Iterator[tuple[View, Any]]:
    """Return the page of a recording in which the lidar is aside, and its server."""
    with viewing(SAMPLES / "recorded-with-lidar-aside") as view:
        view.pages.log = _LOG.encode()
        yield (
            view,
            open_page(view.server.url, viewport={"width": request.param, "height": 900}).page,
        )


def test_slider_button_and_keys(drive: tuple[View, Any]) -> None:
    """The slider moves the robot, also by keys, Play moves it until it is pressed again, Reset puts it back."""
    _, page = drive
    slider = page.get_by_label("Time in the recording drive")
    slider.focus()
    page.keyboard.press("End")
    assert page.locator("#space-play output").inner_text() == "4.0 s"
    assert page.evaluate("() => RobotView.pose('base_link')[3]") == pytest.approx(1.0)
    assert page.evaluate("() => RobotView.positions.get('left_wheel_joint')") == pytest.approx(20.0)
    page.keyboard.press("Tab")
    page.get_by_role("button", name="Play").focus()
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Pause").wait_for()
    page.keyboard.press("Enter")
    assert page.evaluate("() => RobotView.pose('base_link')[3]") < 1
    slider.fill("3")
    page.get_by_role("button", name="Reset").click()
    assert page.evaluate("() => RobotView.pose('base_link')[3]") == pytest.approx(0)
    width = page.viewport_size["width"]
    assert page.evaluate("() => document.documentElement.scrollWidth") == width


def test_what_is_wrong_is_told_and_red(open_page: Open, tmp_path: Path) -> None:
    """A link that was recorded elsewhere is named, and more of the drawing is red than without it."""
    grey = '</geometry><material name="grey"><color rgba="0.5 0.5 0.5 1"/></material></visual>'
    urdf = URDF.replace("</geometry></visual>", grey).replace('0.1 0 0.15"', '0.1 0 0.25"')
    write_files(tmp_path, {"cart.urdf": urdf.encode(), **files_of("drive", {})})
    with viewing(tmp_path) as view:
        page = open_page(view.server.url).page
        assert page.locator("#space-wrong li").all_inner_texts() == [
            "'laser' was recorded 100 mm from where the URDF has it in 'base_link'"
        ]
        assert page.evaluate(_REDS, True) > page.evaluate(_REDS, False)


def test_messages_of_a_log(drive: tuple[View, Any]) -> None:
    """A message that was printed meanwhile is at its time, which a click shows; one of another run is not there."""
    view, page = drive
    page.evaluate("() => { document.getElementById('view-log').open = true; }")
    page.locator("#view-log-text").fill(_LOG)
    page.get_by_role("button", name="Explain", exact=True).click()
    message = page.locator("#space-log button")
    message.wait_for()
    assert message.all_inner_texts() == ["2.0 s [INFO] [1764000002.000000000] [driver]: half way"]
    message.click()
    assert page.locator("#space-play output").inner_text() == "2.0 s"
    assert page.evaluate("() => RobotView.pose('base_link')[3]") == pytest.approx(0.5)
    assert view.pages.log is not None


def test_a_change_keeps_the_time(open_page: Open, tmp_path: Path) -> None:
    """Another version of the URDF is drawn at the time that was chosen."""
    write_files(tmp_path, {"cart.urdf": URDF.encode(), **files_of("drive", {})})
    with viewing(tmp_path) as view:
        page = open_page(view.server.url).page
        page.get_by_label("Time in the recording drive").fill("2")
        before = view.pages.number
        (tmp_path / "cart.urdf").write_text(URDF.replace('0.1 0 0.15"', '0.2 0 0.15"'))
        page.wait_for_function(
            "(before) => JSON.parse(document.getElementById('data').textContent).view.number > before",
            arg=before,
        )
        assert page.locator("#space-play output").inner_text() == "2.0 s"
        assert "'laser' was recorded 100 mm" in page.locator("#space-wrong").inner_text()


def test_the_page_is_accessible(drive: tuple[View, Any], axe: str) -> None:  # noqa: F811
    """Axe-core finds nothing serious, in both schemes and widths."""
    _, page = drive
    assert_accessible(page, axe)
