"""grader graph: its formats, what it shows of one node, its exit codes, and what it refuses."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from tests.command_line import ROOT, run
from tests.workspace.launch_graphs import FILES, TALKER, launch_file

_NODE = "Node(package='demo', executable='talker')"
_DIFFDRIVE = ROOT / "rubrics" / "diffdrive"
_STRANGE = '<b>"x"&|]\\#`\u202e'  # in a parameter, a topic and the name of a launch file
_STRANGE_FILE = "a<b>&'\"#;].launch.py"


def graph(*words: object) -> tuple[int, str, str]:
    """Return the exit code, and what the command prints on both streams."""
    done = run(("graph", *words), COLUMNS="200")
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def shown(*words: object) -> str:
    """Return what the command prints, which exits with 0."""
    code, output, errors = graph(*words)
    assert (code, errors) == (0, "")
    return output


def json_of(*words: object) -> Any:
    """Return the graph as JSON, which its schema allows."""
    schema = json.loads(run(("schema", "graph")).stdout)
    _, output, errors = graph(*words, "--format", "json")
    assert errors == ""
    data = json.loads(output)
    Draft202012Validator(schema).validate(data)
    return data


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Return a workspace with two packages, whose launch files can be added."""
    for path, text in FILES.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    (tmp_path / "demo/launch").mkdir()
    return tmp_path


def add_launch(workspace: Path, *actions: str, name: str = "demo.launch.py") -> None:
    """Add a launch file to a workspace."""
    text = launch_file(*actions)
    (workspace / "demo/launch" / name).write_text(text, encoding="utf-8")


@pytest.mark.parametrize("page", ["docs/graph.md", "README.md"])
def test_the_documentation_shows_what_is_printed(page: str) -> None:
    """Each block of Mermaid and text is what the command before it prints."""
    text = (ROOT / page).read_text("utf-8")
    pairs = re.findall(r"`?grader (graph [^\n`]+).*?```(?:mermaid|text)\n(.*?)```", text, re.DOTALL)
    assert pairs
    for command, block in pairs:
        assert run(command.split()).stdout.decode() == block, command


def test_every_format_has_the_nodes_and_topics() -> None:
    """They are the same bytes each time."""
    for kind in ("text", "json", "dot", "mermaid", "html"):
        output = shown(_DIFFDRIVE, "--format", kind)
        assert output == shown(_DIFFDRIVE, "--format", kind)
        for word in ("/drive_circle", "/diff_drive_controller", "/cmd_vel", "TwistStamped"):
            assert word in output, (kind, word)


def test_json_has_places_and_connections() -> None:
    """Each node and each end has file and line."""
    data = json_of(_DIFFDRIVE)
    names = {node["id"]: node["name"] for node in data["nodes"]}
    topics = {
        (names[each["from"]], each["name"], names[each["to"]]) for each in data["connections"]
    }
    assert ("/drive_circle", "/cmd_vel", "/diff_drive_controller") in topics
    assert all(each["connects"] and each["certain"] for each in data["connections"])
    [commands] = [
        end
        for node in data["nodes"]
        for end in node["ends"]
        if end["kind"] == "publisher" and end["name"] == "/cmd_vel"
    ]
    assert (commands["depth"], commands["connected"]) == (10, 1)
    assert commands["location"]["path"].endswith("drive_circle.py")
    assert {("odom", "base_footprint")} <= {(t["parent"], t["child"]) for t in data["transforms"]}


def test_one_node_and_its_neighbours() -> None:
    """The text has the node alone; a drawing has what it connects to."""
    text = shown(_DIFFDRIVE, "--node", "drive_circle")
    assert "/rviz" not in text
    drawn = shown(_DIFFDRIVE, "--node", "/drive_circle", "--format", "mermaid")
    assert len(re.findall(r"^  n\d\[", drawn, re.MULTILINE)) == 2
    assert len(json_of(_DIFFDRIVE, "--node", "drive_circle")["nodes"]) == 2
    code, output, errors = graph(_DIFFDRIVE, "--node", "nobody")
    assert (code, output) == (2, "")
    assert errors.startswith("grader: --node: there is no node 'nobody'; there are: /robot_state")


def test_a_node_in_a_namespace_is_named_without_it(workspace: Path) -> None:
    """If only one has the name."""
    first, second = (f"Node(package='demo', executable='talker', namespace='{it}')" for it in "ab")
    add_launch(workspace, first)
    assert "/a/talker" in shown(workspace, "--node", "talker")
    add_launch(workspace, f"{first},\n        {second}")
    _, _, errors = graph(workspace, "--node", "talker")
    assert "there is no node 'talker'; there are: /a/talker and /b/talker" in errors


def test_what_connects_and_all_of_it(workspace: Path) -> None:
    """An end without another one is omitted, or stands in its node; --verbose says all."""
    talker = "Node(package='demo', executable='talker', parameters=[{'topic': 'x'}])"
    heard = "Node(package='demo', executable='talker', name='b', remappings=[('answer', 'x')])"
    turtle = "Node(package='turtlesim', executable='turtlesim_node', parameters=[{'a': 1}])"
    add_launch(workspace, talker, heard, turtle)
    text = shown(workspace)
    assert "subscribes /answer" in text
    assert "publishes, and nothing here asks for: /turtle1/" in text
    assert not re.search(r"/spawn|parameters:|topic = x", text)
    whole = shown(workspace, "--verbose")
    assert re.search(r"serves, and nothing here asks for: .*/spawn", whole)
    assert "parameters: topic = x" in whole
    connected = shown(workspace, "--connected")
    assert connected.startswith("demo/launch/demo.launch.py: 2 nodes, 1 connection")
    assert "turtlesim" not in connected.partition("Other")[0]
    assert "/answer" not in connected
    drawn = shown(workspace, "--format", "mermaid")
    assert '["/talker<br/>subscribes /answer"]' in drawn
    assert "/answer" not in shown(workspace, "--connected", "--format", "mermaid")
    assert [len(node["ends"]) for node in json_of(workspace, "--connected")["nodes"]] == [1, 1]


def test_a_node_has_few_lines_of_what_connects_to_nothing(workspace: Path) -> None:
    """The others are counted."""
    rows = [f"        self.create_publisher(String, 't{number}', 10)" for number in range(9)]
    end = "        self.create_subscription"
    code = TALKER.replace(end, "\n".join([*rows, end]))
    (workspace / "demo/demo/talker.py").write_text(code)
    add_launch(workspace, "Node(package='demo', executable='talker')")
    drawn = shown(workspace, "--format", "mermaid")
    assert drawn.count("<br/>publishes /t") == 5
    assert "<br/>and 5 more" in drawn


def test_the_head_counts_what_is_in_the_files_of_the_launch(workspace: Path) -> None:
    """What another launch file has is in the count of all."""
    add_launch(workspace, "Node(package='demo', executable='talker')")
    add_launch(workspace, "Node(package='demo', executable='tlker')", name="other.launch.py")
    shown_head = graph(workspace, "--launch", "demo.launch.py")[1].split("\n")[0]
    assert shown_head.endswith(" (1 note in the files of this launch)")
    other_head = graph(workspace, "--launch", "other.launch.py")[1].split("\n")[0]
    assert re.search(r" \(1 error, .*1 note in the files of this launch\)$", other_head)


def test_reports_are_saved(tmp_path: Path) -> None:
    """In any format, beside what is printed."""
    saves = [
        word for kind in ("mermaid", "html") for word in ("--save", f"{kind}={tmp_path}/{kind}")
    ]
    text = shown(_DIFFDRIVE, *saves)
    assert text.startswith("diffdrive_robot/launch/diffdrive.launch.py: 6 nodes")
    assert (tmp_path / "mermaid").read_text().startswith("flowchart LR\n")
    page = (tmp_path / "html").read_text()
    assert page.startswith("<!DOCTYPE html>")
    assert len(page.encode()) < 150_000
    assert re.search(r"(?:src|href)=\"(?!#)", page) is None


def test_what_is_refused(workspace: Path, tmp_path: Path) -> None:
    """A URDF, a workspace without launch files, and names that nothing has; one line says why."""
    urdf = ROOT / "submissions/lab6/reference"
    [robot] = urdf.rglob("*.urdf")
    for words, reason in (
        ((robot,), "is no folder: give the package or workspace of a launch"),
        ((workspace,), "has no launch file: there is nothing to show"),
        ((_DIFFDRIVE, "--launch", "no.py"), "--launch: there is no launch file 'no.py'; there are"),
        (
            (_DIFFDRIVE, "--arg", "drvie=true"),
            "declares no argument 'drvie'; did you mean 'drive'?",
        ),
        ((_DIFFDRIVE, "--arg", "gui"), "--arg takes NAME=VALUE"),
        ((tmp_path / "nothing",), "does not exist"),
    ):
        code, output, errors = graph(*words)
        assert (code, output, errors.count("\n")) == (2, "", 1)
        assert reason in errors


def test_a_launch_file_is_named_by_the_end_of_its_path(workspace: Path) -> None:
    """The others are listed; an end of several paths is refused."""
    add_launch(workspace, "Node(package='demo', executable='pair')", name="a.launch.py")
    add_launch(workspace, "Node(package='demo', executable='talker')", name="b.launch.py")
    text = shown(workspace, "--launch", "demo/launch/b.launch.py")
    assert text == shown(workspace, "--launch", "b.launch.py")
    assert "Other launch files, for --launch\n  demo/launch/a.launch.py" in text
    for number in range(14):
        add_launch(workspace, name=f"x{number}.launch.py")
    assert "... and 3 more (--format json lists all)" in shown(workspace)
    (workspace / "demo/launch/more").mkdir()
    (workspace / "demo/launch/more/b.launch.py").write_text(launch_file())
    assert "means several" in graph(workspace, "--launch", "b.launch.py")[2]


def test_launch_arguments_hold(workspace: Path) -> None:
    """What a condition prevents is listed apart."""
    assert "/rviz" not in shown(_DIFFDRIVE, "--arg", "gui=false").partition("Not started")[0]
    add_launch(workspace, "Node(package='demo', executable=LaunchConfiguration('program'))")
    assert "/talker" in shown(workspace, "--arg", "program=talker")


def test_findings_stand_at_what_they_concern(workspace: Path) -> None:
    """An error is at its end or node, in red, and the exit code is 1, unless a comment ignores it."""
    changed = TALKER.replace("import String", "import Int32, String").replace(
        "create_subscription(String", "create_subscription(Int32"
    )
    (workspace / "demo/demo/talker.py").write_text(changed)
    add_launch(
        workspace,
        "Node(package='demo', executable='talker', name='a')",
        "Node(package='demo', executable='talker', name='b', parameters=[{'topic': 'answer'}])",
    )
    status, text, _ = graph(workspace)
    assert status == 1
    assert "does not connect: std_msgs/msg/String is not std_msgs/msg/Int32" in text
    assert "2 nodes, 0 connections, 2 pairs not connected, 0 transforms" in text
    data = json_of(workspace)
    found = [
        finding for node in data["nodes"] for end in node["ends"] for finding in end["findings"]
    ]
    assert {finding["rule"] for finding in found} == {"topic-type"}
    faults = {each["fault"] for each in data["connections"]}
    assert faults == {"std_msgs/msg/String is not std_msgs/msg/Int32"}
    drawn = graph(workspace, "--format", "mermaid")[1]
    assert "--x|" in drawn
    assert re.search(r"t\d.*:::error$", drawn, re.MULTILINE)
    assert "arrowhead=tee" in graph(workspace, "--format", "dot")[1]
    page = graph(workspace, "--format", "html")[1]
    assert 'class="arrow broken"' in page
    assert "item topic error" in page
    ignored = changed.replace("print, 10)", "print, 10)  # grader:ignore topic-type")
    (workspace / "demo/demo/talker.py").write_text(ignored)
    assert graph(workspace)[0] == 0


def test_a_finding_of_an_include_is_at_its_first_node(workspace: Path) -> None:
    """Not at each of them."""
    add_launch(
        workspace,
        "IncludeLaunchDescription(PythonLaunchDescriptionSource(os.path.join("
        "get_package_share_directory('nav2_bringup'), 'launch', 'localization_launch.py')))",
    )
    nodes = json_of(workspace)["nodes"]
    assert [node["name"] for node in nodes][:2] == ["/map_server", "/amcl"]
    assert [len(node["findings"]) > 0 for node in nodes] == [True, False, False]


_LATCHED = """\
import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.declare_parameter('topic', 'chatter')
        plain = QoSProfile(depth=1, durability=DurabilityPolicy.VOLATILE)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_publisher(String, self.get_parameter('topic').value, plain)
        self.create_subscription(String, 'answer', print, latched)


def main():
    rclpy.init()
    rclpy.spin(Talker())
"""


def test_the_text_says_what_is_not_certain(workspace: Path) -> None:
    """Qualities that do not fit, computed names, long values, and what may start more."""
    (workspace / "demo/demo/talker.py").write_text(_LATCHED)
    add_launch(
        workspace,
        "Node(package='demo', executable='talker', name='a', parameters=[{'topic': 'answer'}])",
        f"Node(package='turtlesim', executable='turtlesim_node', parameters=[{{'a': {'x' * 99!r}}}])",
        "Node(package='demo', executable='pair', condition=IfCondition(os.environ.get('X', '')))",
        "Node(package='demo', executable='talker', parameters=[{'topic': os.environ.get('X')}])",
        "Node(package=os.environ.get('P'), executable='x')",
        "Node(package='tf2_ros', executable='static_transform_publisher', namespace='n',"
        " remappings=[('/tf_static', 'tf_static')], arguments=['0', '0', '1', '0', '0', '0', 'map', 'odom'])",
    )
    _, text, _ = graph(workspace, "--verbose")
    for words in (
        "(does not connect: volatile is offered, transient local is asked for)",
        "depth 1, transient local]",
        "-> /second (perhaps)",
        "publishes * [std_msgs/msg/String, depth 1] -> nothing that is known (not certain: a part",
        f"a = {'x' * 40}...",
        "What may start more\n  the program of a node is not evaluated",
        "Transforms\n  map\n    odom  static, static_transform_publisher (not certain)",
    ):
        assert words in text, words
    drawn = graph(workspace, "--format", "mermaid")[1]
    assert drawn.count('(["*<br/>') == 1
    page = graph(workspace, "--format", "html")[1]
    assert "(does not connect)" in page
    assert "static, static_transform_publisher (not certain)" in page


def test_a_reason_of_several_ends_is_said_once(workspace: Path) -> None:
    """At the top; several reasons have numbers."""
    somewhere = "Node(package='demo', executable='talker', namespace=os.environ.get('X'))"
    add_launch(workspace, somewhere)
    _, text, _ = graph(workspace)
    assert text.split("\n")[1] == "not certain: a part of its name is computed"
    assert text.count("nothing that is known (not certain)") == 2
    unread = "os.path.join(get_package_share_directory('nav2_bringup'), 'params', 'a.yaml')"
    node = f"Node(package='nav2_amcl', executable='amcl', parameters=[{unread}])"
    add_launch(workspace, somewhere, node)
    _, text, _ = graph(workspace)
    first, second = text.split("\n")[1:3]
    assert first == "not certain, reason 1: a part of its name is computed"
    assert second.startswith("not certain, reason 2: the file /share/nav2_bringup/params/a.yaml is")
    assert text.count("(not certain, reason 1)") == text.count("(not certain, reason 2)") == 2


def test_groups_and_dashes(workspace: Path) -> None:
    """Nodes of a namespace are a group; what depends on a run is dashed."""
    add_launch(
        workspace,
        "Node(package='demo', executable='talker', namespace='left',"
        " condition=IfCondition(os.environ.get('X', '')))",
        "Node(package='demo', executable='talker', name='other', namespace='left',"
        " remappings=[('answer', 'chatter')])",
        "Node(package='turtlesim', executable='turtlesim_node', parameters=[{'a': [1.5, 2.0], 'b': float('inf')}])",
        "Node(package='demo', executable='pair', condition=IfCondition('false'))",
        _CONTAINER,
    )
    drawn = shown(workspace, "--format", "mermaid")
    assert 'subgraph s1["/left"]' in drawn
    assert "-.->" in drawn
    dot = shown(workspace, "--format", "dot")
    assert 'subgraph cluster_s1 { label="/left";' in dot
    assert re.search(r"n\d -> t\d \[style=dashed\];", dot)
    assert "shape=box, style=dashed" in dot
    page = shown(workspace, "--format", "html")
    assert "item node  dashed" in page
    text = shown(workspace)
    assert "may not run: whether it is started is known only at run time" in text
    assert "Not started under these arguments\n  demo/pair" in text
    assert "From another terminal\n  /turtle1/cmd_vel is read: turtlesim/turtle_teleop_key" in text
    values = {
        each["name"]: each["value"]
        for node in json_of(workspace)["nodes"]
        for each in node["parameters"]
    }
    assert (values["a"], values["b"]) == ([1.5, 2.0], "inf")


_CONTAINER = (
    "ComposableNodeContainer(name='head', namespace='', package='rclcpp_components',"
    " executable='component_container', composable_node_descriptions=["
    "ComposableNode(package='eyes', plugin='eyes::Eye')])"
)


@pytest.mark.parametrize("kind", ["text", "json", "dot", "mermaid", "html"])
def test_names_of_students_are_escaped(workspace: Path, kind: str) -> None:
    """In each format; no line of Mermaid or DOT has a quote that ends a label, and no tag is made."""
    add_launch(
        workspace,
        f"Node(package='demo', executable='talker', parameters=[{{'topic': {_STRANGE!r}}}])",
        f"Node(package={_STRANGE!r}, executable='x', name='y')",
        name=_STRANGE_FILE,
    )
    output = graph(workspace, "--format", kind)[1]
    assert "\u202e" not in output
    if kind in ("html", "mermaid"):
        assert "<b>" not in output
    if kind == "mermaid":
        for line in output.splitlines():
            assert line.count('"') in (0, 2), line
    if kind == "dot":
        for line in output.splitlines():
            assert len(re.findall(r'(?<!\\)(?:\\\\)*"', line)) % 2 == 0, line


def test_an_end_lists_its_first_partners(workspace: Path) -> None:
    """The others are counted."""
    (workspace / "demo/demo/talker.py").write_text(TALKER.replace("answer", "chatter"))
    nodes = "*[Node(package='demo', executable='talker', name=f'n{i}') for i in range(20)]"
    add_launch(workspace, nodes)
    assert "-> /n0, /n1," in shown(workspace)
    assert "/n11 and 8 more" in shown(workspace)


def test_a_large_graph_fits_a_page(workspace: Path) -> None:
    """Of many topics, the first ones are drawn."""
    rows = "\n".join(
        f"        self.create_publisher(String, 'topic_{number}', 10)\n"
        f"        self.create_subscription(String, 'topic_{number}', print, 10)"
        for number in range(400)
    )
    code = TALKER.replace(
        "        self.create_subscription", f"{rows}\n        self.create_subscription"
    )
    (workspace / "demo/demo/talker.py").write_text(code)
    add_launch(workspace, "Node(package='demo', executable='talker')")
    page = shown(workspace, "--format", "html")
    assert page.count('class="item ') == 130
    assert len(page.encode()) < 150_000


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ((), "0 transforms; "),
        (("import logging", "logging.info(1)"), "0 transforms; "),
        (("while share: pass",), "read in part (line 15 was not evaluated); "),
        (("from other_tools import find", "find()"), "read in part (line 15 was not evaluated); "),
        (("while share: pass",) * 2, "read in part (2 lines were not evaluated); "),
    ],
)
def test_the_head_says_which_lines_are_not_evaluated(
    workspace: Path, lines: tuple[str, ...], words: str
) -> None:
    """The other lines are read, whatever these do."""
    text = launch_file(_NODE).replace(
        "    return", "".join(f"    {line}\n" for line in lines) + "    return"
    )
    (workspace / "demo/launch/demo.launch.py").write_text(text, encoding="utf-8")
    [first, *_] = shown(workspace).splitlines()
    assert first.startswith("demo/launch/demo.launch.py: 1 node, ")
    assert words in first
