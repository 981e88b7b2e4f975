"""The context in which the values of a launch file are resolved: its folder and the launch arguments so far."""

from dataclasses import dataclass, field

from grader.static_python.positions import Position
from grader.static_python.values import Unknown, Value

_MAX_STEPS = 50_000


@dataclass(frozen=True, slots=True)
class Contents:
    """The contents of a file, read by open, cat or xacro."""

    path: str
    by: str


Resolved = str | Contents | Unknown


@dataclass(slots=True)
class Context:
    """The folder of the installed launch file, the launch arguments so far, and the errors of the current action.

    `when` is whether the file is launched at all; `steps_left` counts down, also for included files.
    """

    folder: str
    arguments: dict[str, Value] = field(default_factory=dict)
    errors: list[tuple[str, Position]] = field(default_factory=list)
    when: bool | None = True
    steps_left: list[int] = field(default_factory=lambda: [_MAX_STEPS])

    def add_error(self, message: str, at: Position) -> None:
        """Add an error that stops the launch if it certainly executes the current action."""
        self.errors.append((message, at))
