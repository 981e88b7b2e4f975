"""The graph has the nodes, parameters and components that run after a launch."""

from pathlib import Path

from grader.lab.submission.opening import open_submission
from grader.lab.submission.submission import Lab
from grader.workspace.graph.graph import Graph, make_graph
from tests.workspace.rule_examples import EXAMPLES, files_of_example


def graph_in(folder: Path, name: str, text: str) -> Graph:
    """Return the graph of the example of a rule with another text."""
    files = files_of_example({**EXAMPLES[name], "right": text}, "right").files
    for path, content in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(content, encoding="utf-8")
    return make_graph(open_submission(str(folder), Lab("urdf/rover.urdf", "rover")).workspace)


def nodes_of(graph: Graph) -> list[tuple[str | None, str, bool | None, bool]]:
    """Return name, kind, condition and end of each node."""
    return [(node.name, node.kind, node.when, node.does_end) for node in graph.nodes]


_STARTED = """
Node(package='controller_manager', executable='ros2_control_node', namespace='left', parameters=[controllers]),
Node(package='controller_manager', executable='spawner', arguments=['arm_controller']),
"""


def test_a_started_controller_is_a_node_in_the_process_of_its_manager(tmp_path: Path) -> None:
    """A spawner ends, and a controller that nothing spawns is no node."""
    graph = graph_in(tmp_path, "controller-started", _STARTED)
    assert nodes_of(graph) == [
        ("/robot_state_publisher", "program", True, False),
        ("/left/controller_manager", "program", True, False),
        ("/left/arm_controller", "controller", True, False),
        (None, "program", True, True),
    ]
    manager = graph.nodes[1].process
    assert graph.nodes[2].process is manager is not None
    owners = {end.owner for end in graph.ends if end.source == "controller"}
    assert owners == {"arm_controller"}


_CONDITIONAL = """
Node(package='turtlesim', executable='turtlesim_node', name='sim', namespace=os.environ.get('N')),
Node(package='turtlesim', executable='turtlesim_node', name='other', parameters=[{'background_r': 1}]),
ComposableNodeContainer(package='rclcpp_components', executable='component_container', name='parts',
                        namespace='', composable_node_descriptions=[
    ComposableNode(package='image_proc', plugin='image_proc::RectifyNode')]),
"""


def test_names_that_are_not_known_are_none(tmp_path: Path) -> None:
    """Containers and components are nodes, and a namespace that a run decides leaves the name open."""
    graph = graph_in(tmp_path, "node-name", _CONDITIONAL)
    assert nodes_of(graph) == [
        (None, "program", True, False),
        ("/other", "program", True, False),
        ("/parts", "program", True, False),
        (None, "component", True, False),
    ]
    [(node, value)] = graph.given("background_r")
    assert (node.node_name, value.value) == ("other", 1)
    assert [component.plugin for _, component in graph.components()] == ["image_proc::RectifyNode"]
