"""The findings in a launch file, collected while its actions are visited."""

from collections.abc import Callable
from dataclasses import dataclass, field

from grader.package.launch.context import Context
from grader.package.launch.model import LaunchFault, Purpose, Reference, StartedNode
from grader.source import Location
from grader.static_python.positions import Position
from grader.static_python.values import Call, Unknown, Value


@dataclass(slots=True)
class Findings:
    """The findings so far in one launch file. `sets_parameters` is set where an action gives parameters to all nodes."""

    locate: Callable[[Position], Location]
    nodes: list[StartedNode] = field(default_factory=list)
    references: list[Reference] = field(default_factory=list)
    faults: list[LaunchFault] = field(default_factory=list)
    unknown: list[LaunchFault] = field(default_factory=list)
    sets_parameters: bool = False

    def add_fault(self, message: str, at: Position) -> None:
        """Add an error that stops the launch."""
        self.faults.append(LaunchFault(message, self.locate(at)))

    def add_unknown(self, reason: str, at: Position) -> None:
        """Add something that cannot be determined; the same again only where others are between."""
        fault = LaunchFault(reason, self.locate(at))
        if fault not in self.unknown[-3:]:
            self.unknown.append(fault)

    def add_errors(self, context: Context, start: int, *, is_certain: bool) -> None:
        """Take the errors of an action from the context; they count if the action is certainly executed."""
        for message, at in context.errors[start:] if is_certain else ():
            self.add_fault(message, at)
        del context.errors[start:]

    def refer(self, purpose: Purpose, path: str | Unknown, call: Call, value: Value = None, by: str = "") -> None:
        """Add the file that an action names, or why it is unknown which."""
        location = self.locate(_position(value, call))
        if isinstance(path, Unknown):
            self.references.append(Reference(purpose, None, location, path.reason, sure=False))
        else:
            self.references.append(Reference(purpose, path, location, by=by))

    def refer_wrongly(self, purpose: Purpose, message: str, call: Call, value: Value = None) -> None:
        """Add that an action should name a file, and what is wrong with it."""
        self.references.append(Reference(purpose, None, self.locate(_position(value, call)), message))


def _position(value: Value, call: Call) -> Position:
    """Return the position of the call that gives a value; of open(path).read() that of open."""
    if isinstance(value, list | tuple):
        value = next((part for part in value if isinstance(part, Call)), None)
    while isinstance(value, Call) and value.owner is not None:
        value = value.owner
    return value.at if isinstance(value, Call) else call.at
