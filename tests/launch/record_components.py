"""Record what the real launch_ros starts and loads: `python -m tests.launch.record_components LAUNCH LAUNCH_ROS`.

The arguments are checkouts of ros2/launch and ros2/launch_ros (recorded: 3.7.1 and f9ab937, branches rolling). What needs a
machine with ROS 2 (rclpy, messages, the index of packages, processes) is a stub. It needs lark and osrf-pycommon, writes
the outcomes of the cases of component_outcomes.json, and runs nothing.
"""

import importlib.abc
import importlib.machinery
import io
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

FILE = Path(__file__).with_name("component_outcomes.json")
_HEAD = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, OpaqueFunction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node, PushRosNamespace, SetRemap
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    {before}
    return LaunchDescription([
        DeclareLaunchArgument('ns', default_value='arg'),
        DeclareLaunchArgument('on', default_value='true'),
        {text},
    ])
"""
_STUBS = (
    "rclpy",
    "composition_interfaces",
    "lifecycle_msgs",
    "rcl_interfaces",
    "ament_index_python",
)


def text_of(case: Mapping[str, Any]) -> str:
    """Return the launch file of a case; in Python it has the actions, and a statement before them."""
    if case["language"] != "py":
        return str(case["text"])
    return _HEAD.format(text=case["text"], before=case.get("before", "pass"))


class _Stubs(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Import the packages that need ROS 2 as stubs."""

    def find_spec(self, name: str, *_: Any) -> importlib.machinery.ModuleSpec | None:
        if name.split(".", maxsplit=1)[0] not in _STUBS:
            return None
        return importlib.machinery.ModuleSpec(name, self, is_package=True)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        module: Any = MagicMock(name=spec.name)
        module.__spec__, module.__path__, module.__name__ = spec, [], spec.name
        return module  # type: ignore[no-any-return]

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing."""


class _Request:
    """A request to load a component."""

    def __init__(self) -> None:
        self.package_name = self.plugin_name = self.node_name = self.node_namespace = ""
        self.remap_rules: list[str] = []
        self.parameters: list[Any] = []
        self.extra_arguments: list[Any] = []


class _Loop:
    """An event loop that calls at once."""

    def run_in_executor(self, _: Any, function: Any, *arguments: Any) -> None:
        function(*arguments)


class _Recorder:
    """The real launch, whose effects are recorded."""

    def __init__(self, launch: Path, launch_ros: Path) -> None:
        folders = [
            *(launch / part for part in ("launch", "launch_xml", "launch_yaml")),
            launch_ros / "launch_ros",
        ]
        sys.path[:0] = map(str, folders)
        sys.meta_path.insert(0, _Stubs())
        self.rows: list[dict[str, Any]] = []
        self._replace(launch / "launch" / "share" / "launch")

    def _replace(self, share: Path) -> None:
        load: Any = importlib.import_module
        packages = load("ament_index_python.packages")
        packages.PackageNotFoundError = KeyError
        packages.get_package_share_directory = lambda _: str(share)
        load("composition_interfaces.srv").LoadNode = SimpleNamespace(Request=_Request)
        self._launch: Any = load("launch")
        actions: Any = load("launch_ros.actions")
        loading: Any = load("launch_ros.actions.load_composable_nodes")
        loading.get_ros_node = lambda _: MagicMock()
        loading.to_parameters_list = lambda *_: []
        execute = actions.Node.execute

        def start(action: Any, context: Any) -> Any:
            result = execute(action, context)
            self.rows.append({"node": action.node_name})
            return result

        def request(action: Any, requests: Any, _: Any) -> None:
            for each in requests:
                row = {
                    "component": each.plugin_name,
                    "name": each.node_name,
                    "namespace": each.node_namespace,
                    "remaps": [*each.remap_rules],
                    "container": vars(action)["_LoadComposableNodes__final_target_container_name"],
                }
                self.rows.append(row)

        load("launch.actions").ExecuteLocal.execute = lambda *_: None
        actions.Node.execute = start
        actions.LoadComposableNodes._load_in_sequence = request
        context: Any = self._launch.LaunchContext
        context.asyncio_loop = property(lambda _: _Loop())
        context.add_completion_future = lambda *_: None

    def outcome(self, language: str, text: str) -> list[dict[str, Any]]:
        """Return what a launch file starts and loads."""
        self.rows = []
        if language == "py":
            names: dict[str, Any] = {}
            exec(compile(text, "launch.py", "exec"), names)
            description = names["generate_launch_description"]()
        else:
            kind: Any = importlib.import_module(f"launch_{language}").Parser
            kind.load_launch_extensions = classmethod(lambda _: None)
            kind.load_parser_implementations = classmethod(lambda _: None)
            root, parser = kind.load(io.StringIO(text))
            description = parser.parse_description(root)
        context, pending = self._launch.LaunchContext(), [description]
        while pending:
            pending[:1] = pending[0].visit(context) or []
        return self.rows


def main() -> None:
    """Write the outcomes."""
    recorder = _Recorder(*map(Path, sys.argv[1:3]))
    cases = json.loads(FILE.read_text("utf-8"))
    lines = []
    for case in cases:
        case["outcome"] = recorder.outcome(case["language"], text_of(case))
        lines.append(json.dumps(case))
    FILE.write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8")


if __name__ == "__main__":
    main()
