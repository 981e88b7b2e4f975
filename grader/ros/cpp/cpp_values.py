"""The values of C++ expressions: Python's own for literals and lists, and recorded calls."""

from collections.abc import Sequence
from math import isfinite
from typing import Any

from grader.base.grouping import Strings
from grader.ros.cpp.declarations import short_name
from grader.ros.cpp.syntax import CppNode
from grader.ros.python.parse import START
from grader.ros.python.values import Unknown

INTEGERS = ("int", "uint", "size_t", "long", "unsigned", "short")  # how the names of types begin

# A str, int, float, bool, list, CppName, CppCall, CppSum or Unknown.
CppValue = Any


class CppName:
    """Something that has a name and no value that is known.

    Examples are `rclcpp::ReliabilityPolicy::Reliable`, `this`, a parameter of a function.
    """

    def __init__(self, name: str, node: CppNode) -> None:
        self.name = name
        self.node = node


class CppCall:
    """A call that is recorded: a function or constructor by its name, or a method of `owner`.

    `types` are the arguments of its template, as they are written.
    """

    def __init__(
        self,
        name: str,
        args: Sequence[CppValue],
        node: CppNode,
        types: Strings = (),
        owner: CppValue = None,
    ) -> None:
        self.name = name
        self.args = tuple(args)
        self.node = node
        self.types = types
        self.owner = owner

    @property
    def short(self) -> str:
        """The name without namespaces and classes."""
        return short_name(self.name)

    def argument(self, position: int) -> CppValue:
        """Return an argument; None where it is missing."""
        return self.args[position] if position < len(self.args) else None


class CppSum:
    """Strings that are joined with +, of which not all are known."""

    def __init__(self, parts: Sequence[CppValue]) -> None:
        self.parts = tuple(parts)


def not_known(reason: str) -> Unknown:
    """Return a value that is not known, for a reason that is part of a sentence."""
    return Unknown(reason, START)


def as_scalar(value: CppValue, kind: str) -> CppValue:
    """Return a number as a type has it, such as 10.0 for `double range = 10`."""
    name = short_name(kind)
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        return value
    if name in ("double", "float"):
        return float(value)
    if name == "bool":
        return bool(value)
    return int(value) if name.startswith(INTEGERS) else value
