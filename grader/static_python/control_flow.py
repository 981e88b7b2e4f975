"""Control flow that leaves a block, as exceptions of the evaluation."""

from typing import NamedTuple

from grader.static_python.positions import Position
from grader.static_python.values import Value


class PythonError(NamedTuple):
    """An error that certainly stops Python at this position: an undefined name, an import that fails."""

    message: str
    at: Position


class ReturnFlow(Exception):
    """A return statement, with its value."""

    def __init__(self, value: Value) -> None:
        self.value = value


class LoopFlow(Exception):
    """A break or continue statement."""

    def __init__(self, *, is_break: bool) -> None:
        self.is_break = is_break


class RaisedFlow(Exception):
    """An error for which a handler is searched; `kind` decides which handler catches it."""

    def __init__(self, error: PythonError, kind: type[Exception]) -> None:
        self.error = error
        self.kind = kind


class ExitFlow(Exception):
    """The end of the program, by sys.exit or by an error that nothing catches."""


class EvaluationStopped(Exception):
    """The evaluation ends here: it takes too many steps, or nothing that follows can be determined."""
