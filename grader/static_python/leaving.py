"""Ways to leave a place in a followed file, as Python exceptions."""

from grader.static_python.values import Fault, TooHard, Value


class Return(Exception):
    """A function's value on its way out."""

    def __init__(self, value: Value) -> None:
        self.value = value


class Leave(Exception):
    """A break or continue on its way to its loop."""

    def __init__(self, *, for_good: bool) -> None:
        self.for_good = for_good


class Raised(Exception):
    """An error on its way to a handler that may catch it."""

    def __init__(self, fault: Fault, kind: type[Exception]) -> None:
        self.fault = fault
        self.kind = kind


class Left(Exception):
    """The file ends Python, or an error does that nothing catches."""


class Exhausted(TooHard):
    """The file does more than is followed."""
