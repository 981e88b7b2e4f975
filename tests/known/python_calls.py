"""Print the signatures of what nodes call, release by release: `python -m tests.known.python_calls RCLPY GEOMETRY2`.

The arguments are clones of github.com/ros2/rclpy and github.com/ros2/geometry2, with the branches of the releases, which are
parsed and not imported. The rows are `calls` of the tables `rclpy.toml` and `tf2_ros.toml`.
"""

import ast
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence

RELEASES = ("humble", "jazzy")
_NODE = """
create_publisher create_subscription create_client create_service create_timer create_rate declare_parameter get_parameter
get_parameter_or get_logger get_clock add_on_set_parameters_callback destroy_node
"""
# The file of each class, and its functions; those without a class are functions of the module.
_Files = Mapping[str, Mapping[str, Sequence[str]]]
_RCLPY: _Files = {
    "rclpy/rclpy/node.py": {"Node": ("__init__", *_NODE.split())},
    "rclpy/rclpy/publisher.py": {"Publisher": ("publish",)},
    "rclpy/rclpy/client.py": {"Client": ("call", "call_async", "wait_for_service")},
    "rclpy/rclpy/timer.py": {"Timer": ("cancel", "reset")},
    "rclpy/rclpy/action/client.py": {
        "ActionClient": ("__init__", "send_goal", "send_goal_async", "wait_for_server")
    },
    "rclpy/rclpy/action/server.py": {"ActionServer": ("__init__",)},
    "rclpy/rclpy/__init__.py": {
        "": ("init", "shutdown", "create_node", "spin", "spin_once", "spin_until_future_complete")
    },
}
_TF2: _Files = {
    "tf2_ros_py/tf2_ros/buffer.py": {"Buffer": ("__init__", "lookup_transform", "can_transform")},
    "tf2_ros_py/tf2_ros/transform_listener.py": {"TransformListener": ("__init__",)},
    "tf2_ros_py/tf2_ros/transform_broadcaster.py": {
        "TransformBroadcaster": ("__init__", "sendTransform")
    },
    "tf2_ros_py/tf2_ros/static_transform_broadcaster.py": {
        "StaticTransformBroadcaster": ("__init__", "sendTransform")
    },
}


def signature(function: ast.FunctionDef) -> str:
    """Return the parameters after self: `name` is required, `name=` is not; `*` and `**` as Python has them."""
    given = function.args
    positional = [*given.posonlyargs, *given.args]
    required = len(positional) - len(given.defaults)
    words = [arg.arg + "=" * (index >= required) for index, arg in enumerate(positional)]
    if words[:1] == ["self"]:
        del words[0]
    if given.vararg or given.kwonlyargs:
        words.append(f"*{given.vararg.arg if given.vararg else ''}")
    for arg, default in zip(given.kwonlyargs, given.kw_defaults, strict=True):
        words.append(arg.arg + "=" * (default is not None))
    if given.kwarg:
        words.append(f"**{given.kwarg.arg}")
    return " ".join(words)


def rows(checkout: str, files: _Files) -> Iterator[str]:
    """Yield a row of TOML for each function; a release has one where its signature is another than before."""
    for path, classes in files.items():
        trees = {}
        for release in RELEASES:
            command = ["git", "-C", checkout, "show", f"{release}:{path}"]
            trees[release] = ast.parse(
                subprocess.run(command, check=True, capture_output=True).stdout
            )
        for owner, names in classes.items():
            for name in names:
                by_release: dict[str, str] = {}
                for release, tree in trees.items():
                    body = tree.body
                    if owner:
                        body = next(
                            node.body
                            for node in body
                            if isinstance(node, ast.ClassDef) and node.name == owner
                        )
                    functions = [
                        node
                        for node in body
                        if isinstance(node, ast.FunctionDef) and node.name == name
                    ]
                    if functions and signature(functions[-1]) not in by_release.values():
                        by_release[release] = signature(functions[-1])
                key = f'"{owner}.{name}"' if owner else f'"rclpy.{name}"'
                values = ", ".join(f'{release} = "{text}"' for release, text in by_release.items())
                yield f"{key} = {{ {values} }}"


if __name__ == "__main__":
    print(*rows(sys.argv[1], _RCLPY), "", *rows(sys.argv[2], _TF2), sep="\n")
