"""grader view: the pages of robots, which follow the files, what they can be asked for, and who can ask."""

import json
import re
import shutil
import signal
import struct
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from threading import Event, Thread
from urllib.request import urlopen

import pytest

from grader.app.commands import view_server
from grader.app.commands.view_server import RobotPages
from grader.app.commands.viewed_robots import ViewedFiles, ViewRequest, read_robots
from grader.base.processor_time import CAN_LIMIT
from grader.files.reading import URDF_LIMIT
from grader.report.drawing import mesh_data
from grader.report.local_server import HOST
from grader.report.open_browser import opened_in_browser
from tests.classroom.gradebooks import ENVIRONMENT
from tests.command_line import HANG_TIMEOUT, ROOT, run
from tests.mesh.mesh_files import CUBE, binary_stl, text_stl
from tests.samples import SAMPLES
from tests.urdf.builders import joint, links, robot
from tests.view_server import Page, put, viewing

BOX = '<link name="{}"><visual><geometry><box size="{} 1 1"/></geometry></visual></link>'
MANIFEST = (
    '<package format="3"><name>rover</name><version>0.0.1</version><description>d</description>'
    '<maintainer email="a@b.c">a</maintainer><license>MIT</license>'
    "<export><build_type>ament_cmake</build_type></export></package>"
)
BUILD = (
    "cmake_minimum_required(VERSION 3.8)\nproject(rover)\nfind_package(ament_cmake REQUIRED)\n"
    "install(DIRECTORY meshes urdf DESTINATION share/${PROJECT_NAME})\nament_package()\n"
)
XACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">
<xacro:arg name="size" default="1.5"/><xacro:arg name="tall" default="false"/>
<link name="base"><visual><geometry>
<xacro:if value="$(arg tall)"><box size="$(arg size) 1 9"/></xacro:if>
<xacro:unless value="$(arg tall)"><box size="$(arg size) 1 1"/></xacro:unless>
</geometry></visual></link></robot>
"""


def box(size: object, name: str = "base") -> str:
    """Return a robot with one box."""
    return robot(BOX.format(name, size))


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Return a URDF with one box, 2 m long."""
    path = tmp_path / "box.urdf"
    path.write_text(box(2))
    return path


def test_a_page_of_an_inspection(file: Path) -> None:
    """It has the robot and the problems, runs only what the policy names by its hash, and asks only this server."""
    file.write_text(robot(BOX.format("base", 2) + '<link name="lost"/>'))
    with viewing(file) as view:
        answer = view.get()
        page = view.page()
    policy = re.findall('Content-Security-Policy" content="(.*?)"', page.text)[0]
    assert (answer.status, answer.headers["content-type"]) == (200, "text/html; charset=utf-8")
    assert "unsafe" not in policy
    assert "connect-src &#39;self&#39;" in policy
    assert page.sizes == {"base": [2, 1, 1]}
    assert "box.urdf" in page.text and "lost" in page.text
    assert [page.part(name) for name in ("robots", "arguments", "broken")] == ["", "", ""]


def test_a_page_of_a_grading() -> None:
    """It is the report, with the numbers of mistakes, the three views and their reference."""
    with viewing(SAMPLES["several-mistakes"].path, "lab6") as view:
        page = view.page()
    assert {pin["link"] for pin in page.data["robot"]["pins"]} >= {"lidar", "base_link"}
    assert 'id="criterion-lidar-frame"' in page.text
    assert 'class="reference' in page.text


def test_the_page_follows_a_file(file: Path) -> None:
    """What waits for the next version gets it, and what waits for an older one gets it at once."""
    with viewing(file) as view:
        first = view.page()
        put(box(3), file)
        second = view.next(first)
        assert (second.sizes, second.number) == ({"base": [3, 1, 1]}, first.number + 1)
        assert view.next(first).number == second.number
        for size in range(4, 10):
            put(box(size), file)
            second = view.next(second)
            assert second.sizes == {"base": [size, 1, 1]}


def test_without_a_change_the_answer_is_empty(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So that no request waits for longer than the server lets it."""
    monkeypatch.setattr("grader.app.commands.view_server._PATIENCE", 0.01)
    with viewing(file) as view:
        assert view.get("changes/1/box.urdf").json == {"page": ""}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<robot name='r'>\n<link name='base'>\n</lin></robot>", "URDF002 error box.urdf:3:1: "),
        (robot(links("base", "base")), "URDF"),
        ("", "URDF"),
    ],
    ids=["not-well-formed", "rejected", "empty"],
)
def test_a_broken_file_leaves_the_last_robot(file: Path, text: str, words: str) -> None:
    """The page has the problem with its line, and is the earlier one otherwise; the next file that ROS 2 loads replaces it."""
    with viewing(file) as view:
        first = view.page()
        put(text, file)
        broken = view.next(first)
        state = broken.data["view"]
        assert (state["isBroken"], state["isStale"], broken.sizes) == (True, True, first.sizes)
        assert words in broken.part("broken")
        put(box(5), file)
        fixed = view.next(broken)
        state = fixed.data["view"]
        assert (state["isBroken"], state["isStale"]) == (False, False)
        assert (fixed.sizes, fixed.part("broken")) == ({"base": [5, 1, 1]}, "")


def test_a_file_may_be_broken_at_first(file: Path) -> None:
    """Then its page has the problems, and what can be read of it."""
    file.write_text(robot(BOX.format("base", 2) + '<link name="base"/>'))
    with viewing(file) as view:
        first = view.page()
        state = first.data["view"]
        assert (state["isBroken"], state["isStale"], first.part("broken")) == (True, False, "")
        assert "error-card" in first.text
        put(box(3), file)
        assert view.next(first).sizes == {"base": [3, 1, 1]}


@pytest.mark.slow
def test_a_file_that_is_gone_may_come_back(file: Path) -> None:
    """As some editors save: the robot stays meanwhile, below what is wrong."""
    with viewing(file) as view:
        first = view.page()
        file.unlink()
        gone = view.next(first)
        assert "box.urdf does not exist" in gone.part("broken")
        assert (gone.sizes, gone.data["view"]["isStale"]) == (first.sizes, True)
        put(box(3), file)
        assert view.next(gone).sizes == {"base": [3, 1, 1]}


@pytest.mark.slow
def test_a_broken_rubric_is_named_with_its_line(tmp_path: Path) -> None:
    """While it is broken, the last report stays; then it counts."""
    for name in ("arm.toml", "arm.urdf"):
        shutil.copy(ROOT / "tests/corpus/given/posed" / name, tmp_path)
    rubric = tmp_path / "arm.toml"
    text = rubric.read_text()
    with viewing(tmp_path / "arm.urdf", str(rubric)) as view:
        first = view.page()
        put(text.replace('part = "model"', 'part = "modle"'), rubric)
        broken = view.next(first)
        assert "arm.toml:6: there is no part &#39;modle&#39;" in broken.part("broken")
        assert broken.part("broken").count("<article") == 2
        put(text, rubric)
        assert view.next(broken).part("broken") == ""


@pytest.mark.slow
def test_a_rejected_robot_is_not_graded(tmp_path: Path) -> None:
    """Of a grading as well, the last report that ROS 2 loads stays."""
    path = Path(shutil.copy(SAMPLES["lidar-buried"].path / "my_robot/urdf/my_robot.urdf", tmp_path))
    text = path.read_text()
    with viewing(path, "lab6") as view:
        first = view.page()
        put(text.replace("</link>", "</lin>", 1), path)
        broken = view.next(first)
        assert "does not match" in broken.part("broken")
        assert broken.data["robot"] == first.data["robot"]
        path.unlink()
        put("", path)
        empty = view.next(broken)
        assert "no robot to show" in empty.part("broken")


def robots_of(page: Page) -> list[tuple[str, str]]:
    """Return the list of robots: address and path of each."""
    return re.findall('<a href="(.*?)".*?>(.*?)</a>', page.part("robots"))


@pytest.mark.slow
def test_several_robots_are_a_list(tmp_path: Path) -> None:
    """Sorted by path, each with a page of its own; one that comes or goes moves no other one."""
    for name in ("b", "c d", "a/x"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / f"{name}.urdf").write_text(box(ord(name[0]), name[0]))
    with viewing(tmp_path) as view:
        page = view.page()
        listed = robots_of(page)
        assert [path for _, path in listed] == ["a/x.urdf", "b.urdf", "c d.urdf"]
        assert [address for address, _ in listed] == ["a%2Fx.urdf", "b.urdf", "c%20d.urdf"]
        sizes = [view.page(address).sizes for address, _ in listed]
        assert sizes == [{"a": [97, 1, 1]}, {"b": [98, 1, 1]}, {"c": [99, 1, 1]}]
        assert page.sizes == sizes[0]
        last = view.page("c%20d.urdf")
        put(box(1, "bb"), tmp_path / "bb.urdf")
        last = view.next(last)
        assert len(robots_of(last)) == 4
        assert last.sizes == sizes[2]
        (tmp_path / "c d.urdf").unlink()
        last = view.next(last)
        assert "No robot is read from this file any more" in last.part("broken")
        assert (len(robots_of(last)), last.sizes) == (4, sizes[2])
        assert view.page("b.urdf").part("broken") == ""


@pytest.mark.slow
@pytest.mark.slow
@pytest.mark.parametrize("rubric", ["", "diffdrive"])
def test_the_graph_is_beside_the_robot(tmp_path: Path, rubric: str) -> None:
    """It follows the files as well; each launch file has its own."""
    folder = tmp_path / "ws"
    shutil.copytree(ROOT / "rubrics/diffdrive/diffdrive_robot", folder / "diffdrive_robot")
    launch = folder / "diffdrive_robot/launch/diffdrive.launch.py"
    shutil.copy(launch, launch.with_name("other.launch.py"))
    with viewing(folder, rubric) as view:
        assert '<a href="graph!">Graph</a>' in view.page().part("robots")
        page = view.page("graph!")
        assert "/drive_circle" in page.text and 'aria-current="page">Graph of ' in page.text
        other = "graph!diffdrive_robot%2Flaunch%2Fother.launch.py"
        assert f'href="{other}"' in page.part("robots")
        assert view.get(other).status == 200
        assert view.get("graph!none").status == 404
        started = 'executable="drive_circle.py",'
        put(launch.read_text().replace(started, f'{started} name="circling",'), launch)
        following = view.next(page)
        while "/circling" not in following.text:
            following = view.next(following)


def test_a_robot_without_launch_files_has_no_graph(file: Path) -> None:
    """Neither has a lone file."""
    with viewing(file) as view:
        assert "Graph" not in view.page().part("robots")
        assert view.get("graph!").status == 404


def test_arguments_of_xacro_are_tried(tmp_path: Path) -> None:
    """The page has each with its default; values are expanded without writing a file, also after a change, until they are reset."""
    file = tmp_path / "r.urdf.xacro"
    file.write_text(XACRO)
    before = sorted(tmp_path.iterdir()), file.stat().st_mtime_ns
    with viewing(file, arg=["size=2"]) as view:
        page = view.page()
        fields = re.findall('name="(.*?)" value="(.*?)".*?title="(.*?)"', page.part("arguments"))
        assert fields == [("size", "2", "default: 1.5"), ("tall", "false", "default: false")]
        assert page.sizes == {"base": [2, 1, 1]}
        assert view.try_arguments(tall="true", size="4") == 200
        page = view.next(page)
        assert page.sizes == {"base": [4, 1, 9]}
        assert 'value="true"' in page.part("arguments")
        assert view.try_arguments(size="4") == 200  # nothing to do
        assert view.try_arguments(tall="perhaps") == 200
        broken = view.next(page)
        assert "XACRO" in broken.part("broken")
        assert broken.sizes == page.sizes
        assert (sorted(tmp_path.iterdir()), file.stat().st_mtime_ns) == before
        put(XACRO.replace("1 9", "1 7"), file)
        broken = view.next(broken)
        assert view.try_arguments(tall="true") == 200
        page = view.next(broken)
        assert page.sizes == {"base": [4, 1, 7]}
        assert view.server.post("arguments", {"do": "reset"}).status == 200
        assert view.next(page).sizes == {"base": [2, 1, 1]}


def test_the_page_follows_what_a_file_includes(tmp_path: Path) -> None:
    """Of a xacro file on its own, the files that it includes are watched as well."""
    start = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
    part = tmp_path / "part.xacro"
    part.write_text(f'{start}><xacro:property name="size" value="2"/></robot>')
    file = tmp_path / "r.urdf.xacro"
    body = '<xacro:include filename="part.xacro"/>' + BOX.format("base", "${size}")
    file.write_text(f'{start} name="r">{body}</robot>')
    with viewing(file) as view:
        page = view.page()
        assert page.sizes == {"base": [2, 1, 1]}
        assert "part.xacro was read besides r.urdf.xacro" in page.part("notes")
        put(f'{start}><xacro:property name="size" value="3"/></robot>', part)
        assert view.next(page).sizes == {"base": [3, 1, 1]}


def test_an_argument_of_another_form_is_refused(tmp_path: Path) -> None:
    """Unknown names, what is no text, long values, other actions; nothing is expanded."""
    file = tmp_path / "r.urdf.xacro"
    file.write_text(XACRO.replace('name="size"', 'name="a=b"', 1).replace("$(arg size)", "2"))
    with viewing(file) as view:
        assert "a=b" not in view.page().part("arguments")
        wrong: list[object] = [
            {"a=b": "1"},
            {"other": "1"},
            {"tall": 1},
            {"tall": "x" * 1001},
            "tall",
        ]
        sent: list[object] = [{"do": "try", "arguments": values} for values in wrong]
        for action in [*sent, {"do": "other"}, [], None]:
            assert view.server.post("arguments", action).status == 400
        body = b"[" * 60_000
        own = {"Content-Type": "application/json", "Origin": f"http://{HOST}:{view.server.port}"}
        found = view.server.ask("POST", f"/{view.server.token}/arguments", own, body)
        assert (found.status, view.page().number) == (400, 1)


def mesh(name: str, scale: str = "1 1 1") -> str:
    """Return a visual that is a mesh of the package."""
    file = f'<mesh filename="package://rover/meshes/{name}" scale="{scale}"/>'
    return f"<visual><geometry>{file}</geometry></visual>"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Return a package with a robot whose meshes are there, mirrored, missing, a pointer, and broken."""
    package = tmp_path / "rover"
    for folder in ("meshes", "urdf"):
        (package / folder).mkdir(parents=True)
    (package / "package.xml").write_text(MANIFEST)
    (package / "CMakeLists.txt").write_text(BUILD)
    (package / "meshes/cube.stl").write_bytes(binary_stl(CUBE))
    (package / "meshes/broken.stl").write_bytes(b"solid")
    pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"
    (package / "meshes/pointer.stl").write_bytes(pointer)
    shapes = {
        "cube": mesh("cube.stl"),
        "again": mesh("cube.stl", "2 2 2"),
        "mirrored": mesh("cube.stl", "1 -1 1"),
        "missing": mesh("none.stl"),
        "pointer": mesh("pointer.stl"),
        "broken": mesh("broken.stl"),
    }
    text = "".join(f'<link name="{name}">{shape}</link>' for name, shape in shapes.items())
    text += "".join(joint("cube", name, f"to {name}") for name in list(shapes)[1:])
    (package / "urdf/rover.urdf").write_text(robot(text))
    return package


def addresses_in(page: Page) -> dict[str, str]:
    """Return the addresses of the meshes of a page, by link."""
    links = page.data["robot"]["links"]
    return {it["name"]: it["shapes"][0]["mesh"] for it in links if it["shapes"]}


def corners_of(data: bytes) -> set[tuple[float, ...]]:
    """Return the triangles that a server sends, each as nine numbers from 0 to 1."""
    return {tuple(it / 65535 for it in row) for row in struct.iter_unpack("<9H", data)}


def test_meshes_are_triangles(package: Path) -> None:
    """Each is served once, in its box; of those that are not shown the page says why, and no other file is served."""
    with viewing(package) as view:
        page = view.page()
        addresses = addresses_in(page)
        assert addresses["cube"] == addresses["again"] != addresses["mirrored"]
        assert addresses.keys() == {"cube", "again", "mirrored"}
        sent = view.get(f"mesh/{addresses['cube']}")
        assert sent.headers["content-type"] == "application/octet-stream"
        expected = {
            tuple(value for x, y, z in triangle for value in (x, y / 2, z / 3)) for triangle in CUBE
        }
        assert corners_of(sent.body) == expected
        mirrored = corners_of(view.get(f"mesh/{addresses['mirrored']}").body)
        assert mirrored == {
            (a, 1 - b, c, d, 1 - e, f, g, 1 - h, i) for g, h, i, d, e, f, a, b, c in expected
        }
        for words in (
            "is looked for at share/rover/meshes/none.stl",
            "only the pointer of Git LFS",
            "broken.stl",
        ):
            assert words in page.text
        assert '<p class="legend">Shown as the boxes' not in page.text
        for address in ("mesh/cube.stl", "mesh/../meshes/cube.stl", "mesh/", "mesh"):
            assert view.get(address).status == 404


@pytest.mark.slow
def test_meshes_have_limits_that_are_said(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One with too many triangles is shown with fewer, one beyond all as its box."""
    monkeypatch.setattr(mesh_data, "_MAX_TRIANGLES", 8)
    monkeypatch.setattr(mesh_data, "_MAX_OF_ROBOT", 9)
    many = [
        tuple((x + number / 50, y, z) for x, y, z in triangle)
        for number in range(9)
        for triangle in CUBE
    ]
    (package / "meshes/cube.stl").write_bytes(text_stl(many))  # type: ignore[arg-type]
    with viewing(package) as view:
        page = view.page()
        found = re.findall("Shown with fewer triangles: .*?cube.stl&#39;, (.*?) of 108", page.text)
        assert found
        for address in addresses_in(page).values():
            assert 0 < len(corners_of(view.get(f"mesh/{address}").body)) <= 8
        put(robot(f'<link name="a">{mesh("cube.stl")}</link>'), package / "urdf/rover.urdf")
        assert "rover.urdf" in view.next(page).text


@pytest.mark.slow
def test_meshes_stay_while_the_robot_changes(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was read of a file is not read again until its content changes; what is kept is bounded."""
    import grader.ros.mesh.triangles as reader

    reads: list[str] = []
    read_triangles = reader.read_triangles

    def counted(data: bytes, path: str) -> object:
        reads.append(path)
        return read_triangles(data, path)

    monkeypatch.setattr(reader, "read_triangles", counted)
    urdf = package / "urdf/rover.urdf"
    with viewing(package) as view:
        page = view.page()
        for number in range(3):
            put(f"{urdf.read_text()}<!-- {number} -->", urdf)
            page = view.next(page)
        assert reads.count("meshes/cube.stl") == 1
        old = addresses_in(page)["cube"]
        monkeypatch.setattr(mesh_data, "_MAX_KEPT", 10)
        flat = [tuple((x, 0.0, z) for x, _, z in triangle) for triangle in CUBE]
        (package / "meshes/cube.stl").write_bytes(binary_stl(flat))  # type: ignore[arg-type]
        page = view.next(page)
        assert reads.count("meshes/cube.stl") == 2
        assert view.get(f"mesh/{addresses_in(page)['cube']}").status == 200
        assert view.get(f"mesh/{old}").status == 404


def test_only_the_page_itself_is_answered(file: Path) -> None:
    """Other host names, other secrets, other websites, other paths and methods are refused."""
    with viewing(file) as view:
        port, token = view.server.port, view.server.token
        assert view.get(Host=f"localhost:{port}").status == 200
        for host in ("evil.example", f"evil.example:{port}", HOST, f"{HOST}:{port + 1}", ""):
            assert view.get(Host=host).status == 421
        for path in ("/", f"/{token}", f"/{'x' * len(token)}/", "/box.urdf"):
            assert view.server.ask("GET", path).status == 404
        unknown = ("other.urdf", "..%2Fbox.urdf", "../box.urdf", "changes", "changes/1", "a/b/c/d")
        for address in unknown:
            assert view.get(address).status == 404
        assert view.get("changes/0/other.urdf").json == {"page": ""}
        reset = {"do": "reset"}
        assert view.server.post("arguments", reset, Origin="http://evil.example").status == 403
        assert view.server.post("arguments", reset, Content_Type="text/plain").status == 415
        assert view.server.post("box.urdf", reset).status == 404
        assert view.get("arguments").status == 404
        assert view.server.ask("PUT", f"/{token}/").status == 501


def test_pages_that_wait_are_told_of_the_end(file: Path) -> None:
    """They do not ask again."""
    answers: list[object] = []
    with viewing(file) as view:
        ask = Thread(target=lambda: answers.append(view.get("changes/1/box.urdf").json))
        ask.start()
        while not view.pages._waiting:
            pass
        view.pages.end()
        ask.join()
    assert answers == [{"isEnded": True}]


def test_what_is_asked_between_two_waits_is_not_lost() -> None:
    """A loop that waits again and again sees each request, also one that comes between two waits."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(100):
            pages, is_started = RobotPages(), Event()
            thread = Thread(target=_wait_until_asked, args=(pages, is_started), daemon=True)
            thread.start()
            is_started.wait()
            pages.end()
            thread.join(HANG_TIMEOUT)
            assert not thread.is_alive()
    finally:
        sys.setswitchinterval(interval)


def _wait_until_asked(pages: RobotPages, is_started: Event) -> None:
    while not pages.wait(0.0):
        is_started.set()
    is_started.set()


@pytest.mark.slow
@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_the_command(file: Path, ending: signal.Signals) -> None:
    """It prints the address, follows the file, leaves no file of its own, and ends with a signal; a port is free."""
    command = [sys.executable, "-m", "grader", "view", str(file), "--no-browser"]
    with subprocess.Popen(
        command,
        cwd=ROOT,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        url = process.stdout.readline().strip()
        port = re.findall(r"http://127\.0\.0\.1:(\d+)/[\w-]{32}/$", url)[0]
        with urlopen(url, timeout=HANG_TIMEOUT) as page:
            assert Page(page.read().decode()).sizes == {"base": [2, 1, 1]}
        refused = run(("view", file, "--no-browser", "--port", port))
        assert refused.returncode == 2
        assert refused.stderr.decode().startswith(f"grader: cannot listen on port {port} of ")
        put(box(3), file)
        with urlopen(f"{url}changes/1/box.urdf", timeout=HANG_TIMEOUT) as changed:
            assert Page(json.loads(changed.read())["page"]).sizes == {"base": [3, 1, 1]}
        process.send_signal(ending)
        out, err = process.communicate(timeout=HANG_TIMEOUT)
    assert (process.returncode, out) == (0, "1 change shown\n")
    assert err == (
        "grader: open this address in a browser on this machine; it follows the files; Ctrl-C ends it\n"
    )
    assert [path.name for path in file.parent.iterdir()] == ["box.urdf"]


def test_the_file_for_the_browser_is_gone_when_the_page_is_open(file: Path, tmp_path: Path) -> None:
    """It leads to the first page, and is of no use afterwards."""
    link = tmp_path / "open-view.html"
    link.touch()
    with viewing(file) as view:
        view.pages.link = link
        view.get("mesh/none")
        assert link.exists()
        assert view.get().status == view.get().status == 200
        assert not link.exists()


def test_without_a_place_for_that_file_the_address_is_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The current folder may be one in which the user cannot write."""
    monkeypatch.setattr("grader.report.open_browser._has_window", lambda: True)
    with opened_in_browser("http://127.0.0.1/", tmp_path / "none" / "open.html") as is_open:
        assert not is_open


@pytest.mark.slow
@pytest.mark.skipif(not CAN_LIMIT, reason="has no limits of processor time")
def test_a_robot_that_takes_too_long_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The page shows the reason above the last robot, until the file changes again."""
    file = tmp_path / "a.urdf"
    put("<robot name='a'><link name='b'/></robot>", file)

    def read_or_hang(
        request: ViewRequest, tried: Mapping[str, str], log: bytes | None
    ) -> ViewedFiles:
        hangs = file.read_bytes() == b"hangs"
        while hangs:
            pass
        return read_robots(request, tried, log)

    monkeypatch.setattr(view_server, "INSPECT_SECONDS", 3)
    monkeypatch.setattr(view_server, "read_robots", read_or_hang)
    pages = RobotPages()
    versions = view_server.follow_files(ViewRequest(str(file), "", (), URDF_LIMIT), pages)
    next(versions)
    for text, is_late in (("hangs", True), ("<robot name='c'><link name='b'/></robot>", False)):
        put(text, file)
        next(versions)
        page = pages(("",), None).body.decode()
        assert ("takes more than 3 s of processor time" in page) == is_late


def test_a_pasted_output_is_explained(tmp_path: Path) -> None:
    """What the files explain comes first, with its line; the text of the output is data, and stays until it is cleared."""
    root = shutil.copytree(ROOT / "submissions/diffdrive/spawner-misspelt", tmp_path / "ws")
    log = (
        "[x-1] <b>Error: boom</b>\n[ros2_control_node-2] [ERROR] [1.2] [controller_manager]: "
        "The 'type' param was not defined for 'diffdrive_controller'.\n"
    )
    with viewing(root) as view:
        first = view.page()
        assert first.part("answers") == ""
        assert view.explain(log) == 200
        second = view.next(first)
        answers = second.part("answers")
        cards = re.findall(r'<article class="card (\w+)-card">\n<p>(.*?)</p>', answers)
        assert cards[0][0] == "error"
        assert "explains line 2 of the log" in cards[0][1]
        assert "diffdrive_controller" in answers
        assert "<b>" not in answers
        robot_file = next(root.rglob("*.urdf.xacro"))
        robot_file.write_text(robot_file.read_text() + "\n")
        third = view.next(second)
        assert third.part("answers") == answers
        assert view.server.post("log", {"do": "clear"}).status == 200
        assert view.next(third).part("answers") == ""


def test_a_pasted_output_of_a_graded_robot() -> None:
    """Also the page of a rubric explains it; a text in which nothing fails is said to be one."""
    with viewing(SAMPLES["several-mistakes"].path, "lab6") as view:
        first = view.page()
        assert view.explain("all is well\n") == 200
        assert "no line of the log says that something fails" in view.next(first).part("answers")


@pytest.mark.parametrize("sent", [{"do": "explain"}, {"do": "explain", "log": 1}, {}, []])
def test_another_log_is_refused(file: Path, sent: object) -> None:
    """Only what the page sends counts."""
    with viewing(file) as view:
        assert view.server.post("log", sent).status == 400
        assert view.server.post("logs", {"do": "clear"}).status == 404
        assert view.page().part("answers") == ""
