"""Problems of files: their kinds, each with a stable code, and one problem at its location."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from grader.source import Location

Severity = Literal["error", "warning", "note"]
Effect = Literal["rejects", "drops", "loads", "other"]


@dataclass(frozen=True, slots=True)
class Kind:
    """One kind of problem: a code that never changes, its title, what ROS 2 does and how to fix the file.

    The effect of a URDF's problems decides the verdict: ROS 2 rejects the file, drops content of it, or loads all of it. The
    effect of a problem of another file is `other`. `is_consequence`: another problem of the same file usually
    causes it. `detaches_links`: ROS 2 loads the file without links that are apart from the tree.
    """

    code: str
    severity: Severity
    effect: Effect
    title: str
    explanation: str
    is_consequence: bool = False
    detaches_links: bool = False


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


def rejects(code: str, title: str, explanation: str, *, is_consequence: bool = False) -> Kind:
    """Return a kind of problem with which ROS 2 loads nothing of the file."""
    return Kind(code, "error", "rejects", title, explanation, is_consequence=is_consequence)


def drops(code: str, title: str, explanation: str, *, detaches_links: bool = False) -> Kind:
    """Return a kind of problem with which ROS 2 loads the file without part of its content."""
    return Kind(code, "warning", "drops", title, explanation, detaches_links=detaches_links)


def warns(code: str, title: str, explanation: str) -> Kind:
    """Return a kind of problem that deserves a warning although ROS 2 loads everything."""
    return Kind(code, "warning", "loads", title, explanation)


def notes(code: str, title: str, explanation: str) -> Kind:
    """Return a kind of problem that is worth a note."""
    return Kind(code, "note", "loads", title, explanation)


def kinds_in(namespace: Iterable[object]) -> tuple[Kind, ...]:
    """Return the kinds among the values of a module, sorted by code."""
    return tuple(sorted((value for value in namespace if isinstance(value, Kind)), key=lambda kind: kind.code))
