"""Problems of files: their kinds, each with a stable code, and one problem at its location."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

from grader.source import Location

Severity = Literal["error", "warning", "note"]
Effect = Literal["rejects", "drops", "loads", "other"]


@dataclass(frozen=True, slots=True)
class Kind:
    """One kind of problem: a code that never changes, its title, what ROS 2 does and how to fix the file.

    The effect of a URDF's problems decides the verdict: ROS 2 rejects the file, drops content of it, or loads all of it. The
    effect of a problem of another file is `other`.
    """

    code: str
    severity: Severity
    effect: Effect
    title: str
    explanation: str


@dataclass(frozen=True, slots=True)
class Problem:
    """One problem of one file, in a sentence; `subject` names the link that loses content with it, if one does."""

    kind: Kind
    message: str
    location: Location
    subject: str = ""

    @property
    def code(self) -> str:
        """The stable code of its kind, such as URDF012."""
        return self.kind.code

    @property
    def severity(self) -> Severity:
        """The severity of its kind: an error keeps ROS 2 from loading the file."""
        return self.kind.severity


def _maker(severity: Severity, effect: Effect) -> Callable[[str, str, str], Kind]:
    return lambda code, title, explanation: Kind(code, severity, effect, title, explanation)


# These make a kind of problem from its code, title and explanation.
rejects = _maker("error", "rejects")  # ROS 2 loads nothing of the file
drops = _maker("warning", "drops")  # ROS 2 loads the file without part of its content
warns = _maker("warning", "loads")  # ROS 2 loads everything, but probably not as intended
notes = _maker("note", "loads")


def kinds_in(namespace: Iterable[object]) -> tuple[Kind, ...]:
    """Return the kinds among the values of a module, sorted by code."""
    return tuple(sorted((value for value in namespace if isinstance(value, Kind)), key=lambda kind: kind.code))
