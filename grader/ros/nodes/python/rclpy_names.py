"""What nodes in Python are made of: classes, callbacks, and modules that do nothing for them."""

from collections.abc import Mapping

from grader.base.text import first_part
from grader.ros.known.python_names import MODULES, python_names
from grader.ros.known.releases import RELEASES

# Of rclpy of Jazzy: rclpy/__init__.py, rclpy/node.py and rclpy/lifecycle/ of ros2/rclpy.
NODE_CLASSES = frozenset(
    {
        "rclpy.Node",
        "rclpy.node.Node",
        "rclpy.lifecycle.LifecycleNode",
        "rclpy.lifecycle.Node",
        "rclpy.lifecycle.node.Node",
    }
)
# What is given a callback, with the position and the name of that argument: rclpy/node.py and
# rclpy/action/server.py, message_filters/__init__.py.
CALLBACKS: Mapping[str, tuple[int, str]] = {
    "create_timer": (1, "callback"),
    "create_subscription": (2, "callback"),
    "create_service": (2, "callback"),
    "ActionServer": (3, "execute_callback"),
    "registerCallback": (0, "cb"),
}
# What may be given a node, and declares and opens nothing but actions and the topics of tf2.
HARMLESS = frozenset(
    {
        *("spin", "spin_once", "spin_until_future_complete", "add_node", "remove_node"),
        *("super", "isinstance", "print", "hasattr", "getattr"),
        *("TransformListener", "TransformBroadcaster", "StaticTransformBroadcaster"),
        *("ActionServer", "ActionClient"),
    }
)
# Packages that neither initialise rclpy nor spin a node, besides those of messages and the standard
# library; tf2_ros.TransformListener does if it is asked to, with the argument spin_thread.
_PASSIVE = frozenset(
    {"rclpy", "numpy", "cv2", "cv_bridge", "tf2_ros", "tf_transformations", "transforms3d"}
    | {"ament_index_python", "yaml", "scipy", "std_srvs", "message_filters"}
)
_MESSAGES = ("_msgs", "_interfaces", "_srvs", "_actions")


def is_passive(module: str) -> bool:
    """Return whether a module surely neither initialises rclpy nor spins a node."""
    top = first_part(module)
    return top in _PASSIVE or top in python_names(MODULES, RELEASES) or top.endswith(_MESSAGES)
