"""The pose of a transform of which code sets each number."""

from collections.abc import Callable, Collection
from typing import Any, TypeVar

from grader.base.transforms import Transform, rotation_from_quaternion

_PLACE = ("transform.translation.x", "transform.translation.y", "transform.translation.z")
_ROTATION = (
    "transform.rotation.x",
    "transform.rotation.y",
    "transform.rotation.z",
    "transform.rotation.w",
)
POSE_FIELDS = _PLACE + _ROTATION
_IDENTITY = {"transform.rotation.w": 1.0}  # what a new message has
_Node = TypeVar("_Node")


def pose_set(
    targets: Collection[str],
    value_set: Callable[[str], _Node | None],
    value_of: Callable[[_Node], Any],
) -> Transform | None:
    """Return T_parent_child that code sets number by number; None where one is not known.

    Args:
        targets: What of the transform is set somewhere, as transform.translation.x.
        value_set: Returns what a field is set to when the transform is sent, if that is known.
        value_of: Returns the value of an expression.
    """
    numbers = {field: _IDENTITY.get(field, 0.0) for field in POSE_FIELDS}
    for target in targets:
        node = value_set(target) if target in numbers else None
        value = value_of(node) if node is not None else None
        if not isinstance(value, int | float) or isinstance(value, bool):
            return None
        numbers[target] = float(value)
    x, y, z = (numbers[field] for field in _PLACE)
    qx, qy, qz, qw = (numbers[field] for field in _ROTATION)
    return Transform(rotation_from_quaternion((qx, qy, qz, qw)), (x, y, z))
