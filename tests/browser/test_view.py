"""The page of grader view in a browser: it follows the files, and keeps what the user has set."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.browser.conftest import OpenPage
from tests.cli.test_view import XACRO, box, mesh
from tests.command_line import ROOT
from tests.mesh.mesh_files import CUBE, binary_stl
from tests.samples import SAMPLES
from tests.urdf.builders import joint, robot
from tests.view_server import put, viewing

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]
WIDE = {"width": 1366, "height": 900}
NARROW = {"width": 390, "height": 844}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Return a robot with several mistakes, in a folder of its own."""
    return Path(
        shutil.copy(SAMPLES["several-mistakes"].path / "my_robot/urdf/my_robot.urdf", tmp_path)
    )


def version(page: Any) -> int:
    """Return the number of the version that a page shows."""
    number: int = page.evaluate(
        "() => JSON.parse(document.getElementById('data').textContent).view.number"
    )
    return number


def change(page: Any, text: str, file: Path) -> None:
    """Save a file, and wait until the page shows it."""
    before = version(page)
    put(text, file)
    page.wait_for_function(
        "(before) => JSON.parse(document.getElementById('data').textContent).view.number > before",
        arg=before,
    )


def greens(page: Any) -> float:
    """Return the part of the canvas that is green, as the base of the robot is."""
    part: float = page.evaluate(
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
    return part


def test_a_change_keeps_camera_joints_and_choices(open_page: Open, file: Path) -> None:
    """The page is not loaded again; the mistake that is fixed is gone, and its number; a slider stays in its limits."""
    text = file.read_text()
    with viewing(file, "lab6") as view:
        page = open_page(view.server.url, viewport=WIDE).page
        page.evaluate("() => { window.isSame = true; }")
        page.locator("#space-canvas").press("ArrowLeft")
        page.get_by_label("base_left_wheel_joint").fill("20")
        page.get_by_role("button", name="Frames").click()
        page.locator("#space-links").select_option("lidar")
        page.locator("details summary").first.click()
        page.get_by_label("base_left_wheel_joint").focus()
        before = page.evaluate("() => ({...RobotView.camera})")
        assert page.locator("#criterion-base-green").count() == 1
        fixed = text.replace('rgba="0 1 0 1"', 'rgba="0 0.6 0 1"')
        assert fixed != text
        change(page, fixed, file)
        assert page.locator("#criterion-base-green").count() == 0
        assert page.evaluate("() => window.isSame")
        assert page.evaluate("() => ({...RobotView.camera})") == before
        assert page.evaluate(
            "() => RobotView.positions.get('base_left_wheel_joint')"
        ) == pytest.approx(0.349065, abs=1e-5)
        assert page.get_by_text("20°").is_visible()
        assert page.get_by_role("button", name="Frames").get_attribute("aria-pressed") == "true"
        assert page.locator("#space-about").inner_text().startswith("lidar at")
        assert page.locator("details[open]").count() == 1
        assert page.evaluate(
            "() => document.activeElement.closest('label')?.textContent"
        ).startswith("base_left_wheel_joint")
        assert greens(page) > 0.05
        limited = fixed.replace('type="continuous"', 'type="revolute"').replace(
            '<axis xyz="0 0 1" />',
            '<axis xyz="0 0 1" /><limit lower="-0.1" upper="0.2" effort="1" velocity="1"/>',
        )
        change(page, limited, file)
        assert page.evaluate(
            "() => RobotView.positions.get('base_left_wheel_joint')"
        ) == pytest.approx(0.2)


@pytest.mark.parametrize("viewport", [WIDE, NARROW])
def test_a_broken_file_is_shown_in_grey(
    open_page: Open, file: Path, viewport: dict[str, int]
) -> None:
    """The problem with its line is above the robot, which is as it was; both fit the screen. It is fixed with the file."""
    text = file.read_text()
    with viewing(file) as view:
        page = open_page(view.server.url, viewport=viewport).page
        before = greens(page)
        grey = "() => getComputedStyle(document.getElementById('main')).filter"
        assert page.evaluate(grey) == "none"
        change(page, text.replace("</link>", "</lin>", 1), file)
        assert page.evaluate(grey) == "grayscale(1)"
        card = page.locator("#view-broken article")
        assert "URDF002 error my_robot.urdf:24:4" in card.inner_text()
        assert page.title() == "1 problem: my_robot"
        assert card.bounding_box()["y"] < page.locator("#space-canvas").bounding_box()["y"]
        assert greens(page) == pytest.approx(before)
        assert page.evaluate("() => document.documentElement.scrollWidth") == viewport["width"]
        change(page, text, file)
        assert page.evaluate(grey) == "none"
        assert page.locator("#view-broken article").count() == 0


def test_a_list_of_robots_leads_to_each(open_page: Open, tmp_path: Path) -> None:
    """Each page follows its own robot; the list follows as well."""
    for name in ("one", "two"):
        (tmp_path / f"{name}.urdf").write_text(box(1, name))
    with viewing(tmp_path) as view:
        page = open_page(view.server.url, viewport=NARROW).page
        page.get_by_role("link", name="two.urdf").click()
        page.wait_for_url("**/two.urdf")
        assert page.locator("h1").inner_text() == "r"
        change(page, box(5, "two"), tmp_path / "two.urdf")
        assert page.evaluate("() => [...RobotView.poses().keys()]") == ["two"]
        change(page, box(5, "three"), tmp_path / "three.urdf")
        links = page.locator("#view-robots a")
        assert links.all_inner_texts() == ["one.urdf", "three.urdf", "two.urdf"]
        assert page.locator("#view-robots [aria-current]").inner_text() == "two.urdf"
        assert page.evaluate("() => [...RobotView.poses().keys()]") == ["two"]


def test_the_graph_is_a_tab(open_page: Open, tmp_path: Path) -> None:
    """It is reached by keys on a phone, follows the files, and keeps what is chosen."""
    folder = tmp_path / "ws"
    shutil.copytree(ROOT / "rubrics/diffdrive/diffdrive_robot", folder / "diffdrive_robot")
    launch = folder / "diffdrive_robot/launch/diffdrive.launch.py"
    with viewing(folder) as view:
        page = open_page(view.server.url, viewport=NARROW).page
        page.get_by_role("link", name="Graph").focus()
        page.keyboard.press("Enter")
        page.wait_for_url("**/graph!")
        page.locator("#filter").fill("cmd_vel")
        page.locator("#tab-frames").click()
        started = 'executable="drive_circle.py",'
        put(launch.read_text().replace(started, f'{started} name="circling",'), launch)
        page.locator(".item", has_text="/circling").wait_for(state="attached")
        assert page.locator("#filter").input_value() == "cmd_vel"
        assert page.locator("#frames").is_visible()
        page.get_by_role("link", name="diffdrive.urdf.xacro").click()
        page.locator("#space-canvas").wait_for()


def test_arguments_are_tried(open_page: Open, tmp_path: Path) -> None:
    """With Enter or the button; what is typed stays while a file changes; the other button resets them."""
    file = tmp_path / "r.urdf.xacro"
    file.write_text(XACRO)

    def heights() -> Any:
        return page.evaluate(
            "() => JSON.parse(document.getElementById('data').textContent).robot.links[0].shapes[0].size"
        )

    def wait_for(size: list[float]) -> None:
        page.wait_for_function(
            "(size) => String(JSON.parse(document.getElementById('data').textContent).robot.links[0].shapes[0].size) === size",
            arg=",".join(f"{value:g}" for value in size),
        )

    with viewing(file) as view:
        page = open_page(view.server.url, viewport=NARROW).page
        assert heights() == [1.5, 1, 1]
        page.get_by_label("size").fill("3")
        page.get_by_label("size").press("Enter")
        wait_for([3, 1, 1])
        assert page.evaluate("() => document.activeElement.name") == "size"
        page.get_by_label("tall").fill("true")
        change(page, XACRO.replace("1 9", "1 8"), file)
        assert page.get_by_label("tall").input_value() == "true"
        page.get_by_role("button", name="Try").click()
        wait_for([3, 1, 8])
        page.get_by_role("button", name="As started").click()
        wait_for([1.5, 1, 1])
        assert page.get_by_label("tall").input_value() == "false"
        assert page.evaluate("() => document.documentElement.scrollWidth") == NARROW["width"]


def test_a_pasted_output_is_explained(open_page: Open, tmp_path: Path) -> None:
    """What the files explain is first, above the robot; the text is shown as text, and stays while a file changes."""
    root = shutil.copytree(ROOT / "submissions/diffdrive/spawner-misspelt", tmp_path / "ws")
    log = (
        "[x-1] Error: <img src=x onerror=alert(1)>\n[ros2_control_node-2] [ERROR] [1.2] [controller_manager]: "
        "The 'type' param was not defined for 'diffdrive_controller'.\n"
    )
    with viewing(root) as view:
        page = open_page(view.server.url, viewport=NARROW).page
        page.get_by_text("Explain an output of the terminal").click()
        page.locator("#view-log-text").fill(log)
        page.get_by_role("button", name="Explain").click()
        first = page.locator("#view-answers .card").first
        first.wait_for()
        assert "explains line 2 of the log" in first.inner_text()
        assert page.locator("#view-answers img").count() == 0
        robot_file = next(root.rglob("*.urdf.xacro"))
        change(page, robot_file.read_text() + "\n", robot_file)
        assert page.locator("#view-log-text").input_value() == log
        assert page.locator("#view-answers .card").count() >= 1
        assert page.evaluate("() => document.documentElement.scrollWidth") == NARROW["width"]
        page.get_by_role("button", name="Clear").click()
        page.wait_for_function("() => !document.querySelector('#view-answers .card')")


def test_meshes_are_drawn(open_page: Open, tmp_path: Path) -> None:
    """Triangles in place of the box: half a cube shows less of its colour; they stay when the robot changes."""
    package = tmp_path / "rover"
    (package / "meshes").mkdir(parents=True)
    (package / "meshes/half.stl").write_bytes(binary_stl(CUBE[:1]))
    (package / "meshes/whole.stl").write_bytes(binary_stl(CUBE))
    green = '<material name="g"><color rgba="0 0.8 0 1"/></material></visual>'

    def text(name: str) -> str:
        return robot(f'<link name="a">{mesh(name).replace("</visual>", green)}</link>')

    urdf = package / "rover.urdf"
    urdf.write_text(text("whole.stl"))
    with viewing(urdf) as view:
        page = open_page(view.server.url, viewport=WIDE).page
        drawn = "() => Object.keys(RobotView.solids).length === 4"
        page.wait_for_function(drawn)
        whole = greens(page)
        change(page, text("half.stl"), urdf)
        page.wait_for_function(drawn)
        assert greens(page) < 0.7 * whole
        change(page, text("whole.stl"), urdf)
        page.wait_for_function(drawn)
        assert greens(page) == pytest.approx(whole, rel=0.01)


@pytest.fixture
def arm() -> str:
    """Return a robot whose only joint turns."""
    limits = '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    return robot(
        box("{}")[len('<robot name="r">') : -len("</robot>")]
        + '<link name="arm"/>'
        + joint("base", "arm", kind="revolute", body=limits)
    )


def test_sixty_changes_in_a_row(open_page: Open, tmp_path: Path, arm: str) -> None:
    """The last one is shown, broken ones between them as well; the page holds no more than after the first ones."""
    file = tmp_path / "arm.urdf"
    file.write_text(arm.format(1))
    with viewing(file) as view:
        page = open_page(view.server.url, viewport=WIDE).page
        page.get_by_role("slider", name="j").fill("30")
        counts = []
        session = page.context.new_cdp_session(page)
        for number in range(60):
            change(page, "<robot" if number % 10 == 5 else arm.format(2 + number / 10), file)
            if number in (19, 59):
                session.send("HeapProfiler.collectGarbage")
                counts.append({it["name"]: it["value"] for it in metrics(session)})
        assert page.evaluate("() => RobotView.positions.get('j')") == pytest.approx(
            0.523599, abs=1e-5
        )
        assert counts[1]["Nodes"] < 1.2 * counts[0]["Nodes"]
        assert counts[1]["JSEventListeners"] <= counts[0]["JSEventListeners"] + 5
        assert counts[1]["JSHeapUsedSize"] < 1.3 * counts[0]["JSHeapUsedSize"]


def metrics(session: Any) -> list[dict[str, Any]]:
    """Return what the browser counts of a page."""
    session.send("Performance.enable")
    found: list[dict[str, Any]] = session.send("Performance.getMetrics")["metrics"]
    return found


def test_the_end_is_said(open_page: Open, tmp_path: Path) -> None:
    """A page that is left open says that nothing follows any more, and asks no more."""
    file = tmp_path / "box.urdf"
    file.write_text(box(1))
    with viewing(file) as view:
        opened = open_page(view.server.url)
        assert not opened.page.locator("#view-ended").is_visible()
        while not view.pages._waiting:
            pass
    opened.page.locator("#view-ended").wait_for()
