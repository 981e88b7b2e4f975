"""The values of C++ expressions: Python's own for literals and lists, and recorded calls."""

from collections.abc import Sequence
from typing import Any

from grader.ros.cpp.syntax import CppNode
from grader.ros.python.parse import START
from grader.ros.python.values import Unknown

# A str, int, float, bool, list, CppName, CppCall, CppSum or Unknown.
CppValue = Any


class CppName:
    """Something that has a name and no value that is known.

    Examples are `rclcpp::ReliabilityPolicy::Reliable`, `this`, a parameter of a function.
    """

    def __init__(self, name: str, node: CppNode) -> None:
        self.name, self.node = name, node


class CppCall:
    """A call that is recorded: a function or constructor by its name, or a method of `owner`.

    `types` are the arguments of its template, as they are written.
    """

    def __init__(
        self,
        name: str,
        args: Sequence[CppValue],
        node: CppNode,
        types: tuple[str, ...] = (),
        owner: CppValue = None,
    ) -> None:
        self.name, self.args, self.node = name, tuple(args), node
        self.types, self.owner = types, owner

    @property
    def short(self) -> str:
        """The name without namespaces and classes."""
        return self.name.rpartition("::")[2]

    def argument(self, position: int) -> CppValue:
        """Return an argument; None where it is missing."""
        return self.args[position] if position < len(self.args) else None


class CppSum:
    """Texts that are joined with +, of which not all are known."""

    def __init__(self, parts: Sequence[CppValue]) -> None:
        self.parts = tuple(parts)


def not_known(reason: str) -> Unknown:
    """Return a value that is not known, for a reason that is part of a sentence."""
    return Unknown(reason, START)
