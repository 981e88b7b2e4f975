"""Where what packages have is defined and used, what a launch file starts, links and folding; a workspace of several packages."""

import shutil
from collections.abc import Callable, Iterator

import pytest
from lsprotocol import types as lsp

from grader.app.editor.folding import folding_ranges
from tests.command_line import ROOT
from tests.editor.client import Act, Editor, shared_editor

pytestmark = pytest.mark.slow
Run = Callable[[Act], None]
CART = ROOT / "tests/editor/cart"
LAUNCH = "src/cart_bringup/launch/cart.launch.py"
ROBOT = "src/cart_description/urdf/cart.urdf.xacro"
CONTROLLERS = "src/cart_description/config/controllers.yaml"
NODES = "src/cart_bringup/config/nodes.yaml"
BRIDGE = "src/cart_bringup/config/bridge.yaml"
FILTER = "src/cart_nodes/cart_nodes/filter.py"
DRIVER = "src/cart_nodes/cart_nodes/driver.py"
SETUP = "src/cart_nodes/setup.py"
WATCH = "src/cart_watch/src/watch.cpp"
MESSAGE = "src/cart_msgs/msg/Obstacle.msg"
MANIFEST = "src/cart_bringup/package.xml"


@pytest.fixture(scope="module")
def cart(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    root = shutil.copytree(CART, tmp_path_factory.mktemp("shared") / "ws")
    with shared_editor(root) as run:
        yield run


async def _defined(one: Editor, path: str, text: str, inside: int) -> list[str]:
    """Return where the name at a text is defined, as path:line."""
    at = one.position(path, text, inside=inside)
    asked = lsp.DefinitionParams(one.document(path), at)
    located = await one.client.text_document_definition_async(asked)
    assert isinstance(located, list | tuple)
    return [_place(one, each) for each in located if isinstance(each, lsp.Location)]


def _place(one: Editor, location: lsp.Location) -> str:
    path = location.uri.removeprefix(one.root.as_uri() + "/")
    return f"{path}:{location.range.start.line + 1}"


@pytest.mark.parametrize(
    ("path", "text", "inside", "expected"),
    [
        (LAUNCH, 'package="cart_nodes"', 10, ["src/cart_nodes/package.xml:3"]),
        (LAUNCH, 'FindPackageShare("cart_description")', 20, ["src/cart_description/package.xml:3"]),
        (MANIFEST, "<exec_depend>cart_nodes<", 15, ["src/cart_nodes/package.xml:3"]),
        ("src/cart_watch/package.xml", "<depend>cart_msgs<", 9, ["src/cart_msgs/package.xml:3"]),
        ("src/cart_watch/CMakeLists.txt", "find_package(cart_msgs", 15, ["src/cart_msgs/package.xml:3"]),
        (ROBOT, "$(find cart_description)", 9, ["src/cart_description/package.xml:3"]),
        (LAUNCH, 'executable="filter"', 13, [f"{FILTER}:26", f"{SETUP}:16"]),
        (LAUNCH, 'executable="watch"', 13, ["src/cart_watch/CMakeLists.txt:8", f"{WATCH}:38"]),
        (LAUNCH, '"nodes.yaml"', 3, [f"{NODES}:1"]),
        (LAUNCH, '"bridge.yaml"', 3, [f"{BRIDGE}:1"]),
        (ROBOT, "/config/controllers.yaml", 9, [f"{CONTROLLERS}:1"]),
        (SETUP, "cart_nodes.filter:main", 4, [f"{FILTER}:26"]),
        (FILTER, "import Obstacle", 8, [f"{MESSAGE}:1"]),
        (FILTER, "create_publisher(Obstacle", 18, [f"{MESSAGE}:1"]),
        (WATCH, "cart_msgs::msg::Obstacle", 17, [f"{MESSAGE}:1"]),
        (WATCH, "cart_msgs/msg/obstacle.hpp", 15, [f"{MESSAGE}:1"]),
        (LAUNCH, '"scan_raw"', 2, [f"{BRIDGE}:1"]),
        (LAUNCH, '"scan_in"', 2, [f"{FILTER}:13"]),
        (WATCH, '"obstacle", 10', 3, [f"{FILTER}:12"]),
        (LAUNCH, '"/wheel_controller/cmd_vel"', 4, [f"{CONTROLLERS}:6"]),
        (LAUNCH, '"/cmd_vel"', 3, [f"{DRIVER}:10"]),
        (NODES, "filter:", 2, [f"{LAUNCH}:45", f"{FILTER}:9"]),
        (NODES, "min_range:", 2, [f"{FILTER}:10"]),
        (WATCH, '"lidar_link"', 3, [f"{ROBOT}:29"]),
        (CONTROLLERS, "wheel_controller:", 2, [f"{CONTROLLERS}:6"]),
    ],
)  # fmt: skip
def test_finds_definitions(
    cart: Run, path: str, text: str, inside: int, expected: list[str]
) -> None:
    async def act(one: Editor) -> None:
        assert await _defined(one, path, text, inside) == expected

    cart(act)


@pytest.mark.parametrize(
    ("path", "text", "inside", "words"),
    [
        (LAUNCH, '"scan_raw"', 2, ("topic", "publisher: /ros", "subscription: /filter")),
        (FILTER, "import Obstacle", 8, ("message type", "distance: float64", "Header")),
        (LAUNCH, 'package="cart_nodes"', 10, ("package", "used 3 times")),
        (LAUNCH, 'executable="driver"', 13, ("program", "driver.py:20")),
        (LAUNCH, 'name="filter"', 8, ("node", "used 1 time")),
        (LAUNCH, '"nodes.yaml"', 3, ("file", "nodes.yaml:1")),
        (FILTER, "import LaserScan", 8, ("message type", "defined nowhere")),
    ],
)
def test_says_what_packages_have(
    cart: Run, path: str, text: str, inside: int, words: tuple[str, ...]
) -> None:
    async def act(one: Editor) -> None:
        at = one.position(path, text, inside=inside)
        hover = await one.client.text_document_hover_async(lsp.HoverParams(one.document(path), at))
        assert hover is not None
        assert isinstance(hover.contents, lsp.MarkupContent)
        shown = hover.contents.value.replace("\\", "")
        assert [word for word in words if word not in shown] == []

    cart(act)


def test_finds_uses_of_a_topic_and_a_package(cart: Run) -> None:
    async def act(one: Editor) -> None:
        for path, text, inside, expected in (
            (WATCH, '"obstacle", 10', 3, [f"{DRIVER}:11", f"{FILTER}:12", f"{WATCH}:16"]),
            (
                MANIFEST,
                "<exec_depend>cart_description<",
                15,
                [f"{LAUNCH}:13", f"{MANIFEST}:9", "src/cart_description/package.xml:3"],
            ),
        ):
            at = one.position(path, text, inside=inside)
            every = lsp.ReferenceParams(lsp.ReferenceContext(True), one.document(path), at)
            uses = await one.client.text_document_references_async(every)
            assert {_place(one, each) for each in uses or ()} >= {*expected}

    cart(act)


def test_links_files_of_packages(cart: Run) -> None:
    async def act(one: Editor) -> None:
        for path, expected in (
            (LAUNCH, {ROBOT, NODES, BRIDGE}),
            (ROBOT, {CONTROLLERS}),
            (WATCH, set()),
        ):
            asked = lsp.DocumentLinkParams(one.document(path))
            links = await one.client.text_document_document_link_async(asked)
            targets = {
                (each.target or "").removeprefix(one.root.as_uri() + "/") for each in links or ()
            }
            assert targets == expected

    cart(act)


def test_lists_the_nodes_of_a_launch_file(cart: Run) -> None:
    """The range of each is its whole action."""

    async def act(one: Editor) -> None:
        asked = lsp.DocumentSymbolParams(one.document(LAUNCH))
        symbols = await one.client.text_document_document_symbol_async(asked)
        assert symbols is not None
        rows = []
        for each in symbols:
            assert isinstance(each, lsp.DocumentSymbol)
            lines = each.range.start.line + 1, each.range.end.line + 1
            rows.append((each.name, each.detail, *lines))
        spawner = "spawner wheel_controller joint_state_broadcaster"
        assert rows == [
            ("use_sim_time", "launch argument", 18, 18),
            ("robot_state_publisher", "robot_state_publisher/robot_state_publisher", 19, 30),
            ("ros_gz_bridge", "ros_gz_bridge/parameter_bridge", 31, 35),
            (spawner, "controller_manager/spawner", 36, 41),
            ("filter", "cart_nodes/filter", 42, 48),
            ("driver", "cart_nodes/driver", 49, 49),
            ("watch", "cart_watch/watch", 50, 54),
        ]

    cart(act)


def test_folds(cart: Run) -> None:
    async def act(one: Editor) -> None:
        asked = lsp.FoldingRangeParams(one.document(ROBOT))
        ranges = await one.client.text_document_folding_range_async(asked)
        rows = {(each.start_line + 1, each.end_line + 1) for each in ranges or ()}
        assert {(2, 56), (3, 8), (10, 14), (45, 50)} <= rows

    cart(act)


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a.urdf", "<a>\n<b\n c='1'/>\n<!-- x\n y -->\n</a>", [(1, 2), (3, 4), (0, 4)]),
        ("a.urdf", "<a>\n<b>\n</a>\n</b>\n</c>", [(0, 1)]),
        ("a.yaml", "a:\n  b: 1\n\n# c\nd:\n  - e\n  - f:\n      g", [(0, 1), (6, 7), (4, 7)]),
        ("a.py", "def a():\n    b\nc", [(0, 1)]),
        ("a.cpp", "int a() {\n}", None),
    ],
)
def test_folds_elements_and_indents(
    path: str, text: str, expected: list[tuple[int, int]] | None
) -> None:
    """Also of a broken file; of C++ an editor knows it itself."""
    ranges = folding_ranges(path, text)
    rows = None if ranges is None else [(each.start_line, each.end_line) for each in ranges]
    assert rows == expected


def test_explains_a_pasted_output(cart: Run) -> None:
    """Lines begin with the whole path of what explains them."""

    async def act(one: Editor) -> None:
        text = one.text(CONTROLLERS)
        await one.open(CONTROLLERS)
        await one.type(
            CONTROLLERS,
            text.replace(
                "    wheel_controller:\n      type: diff_drive_controller/DiffDriveController\n", ""
            ),
        )
        log = "[gz-1] [ERROR] [1.2] [controller_manager]: The 'type' param was not defined for 'wheel_controller'.\n"
        for given, words in (
            (log, "explains line 1 of the log"),
            ("all is well\n", "no line of the log"),
        ):
            asked = lsp.ExecuteCommandParams("grader.explain", [given])
            lines = await one.client.workspace_execute_command_async(asked)
            assert lines is not None
            assert words in lines[0]
        lines = await one.client.workspace_execute_command_async(
            lsp.ExecuteCommandParams("grader.explain", [log])
        )
        assert lines is not None
        assert lines[0].startswith((one.root / "src").as_posix())

    cart(act)
