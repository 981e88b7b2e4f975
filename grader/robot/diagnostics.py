"""What is noted of a URDF while it is read: problems with their places, and values read with a note where they fail."""

import re
from collections.abc import Iterable
from typing import TypeVar

from grader.names import closest, did_you_mean
from grader.problems import Effect, Kind, Problem
from grader.robot import catalogue
from grader.robot.model import Joint, Origin
from grader.robot.numbers import NumberError, number, vector
from grader.robot.transforms import Vector
from grader.source import Mark, Source
from grader.text import quoted
from grader.xml.parsing import Element

Default = TypeVar("Default")

_FORMAT_DIRECTIVE = re.compile(r"%[-+ #0-9.$*'hlLqjzt]*n")
_PRINTED = frozenset({"origin", "box", "cylinder", "sphere", "mass"})  # whose values urdfdom uses as printf's format
_FULL_TURN = 6.2832
_MOST_PROBLEMS = 1000
_MOST_GUESSES = 50


class Notes:
    """The problems of one file, and where its elements stand."""

    def __init__(self, source: Source, root: Element) -> None:
        self.source = source
        self.root = root
        self.problems: list[Problem] = []
        self.effects: set[Effect] = set()
        self.unlisted = 0
        self._guesses = _MOST_GUESSES
        self._elements = list(root.iter())
        self._indices = {element: index for index, element in enumerate(self._elements)}

    def mark(self, element: Element) -> Mark:
        """The place of an element, to be worked out when it is needed."""
        return Mark(self.source, self._indices[element])

    def element(self, joint: Joint) -> Element:
        """The element that a joint was read from."""
        return self._elements[joint.mark.tag] if joint.mark is not None else self.root

    def add(
        self, kind: Kind, message: str, element: Element, attribute: str | None = None, *, subject: str = ""
    ) -> None:
        """Note a problem at an element, or at one of its attributes if it has it; `subject` loses content by it."""
        self.effects.add(kind.effect)
        if len(self.problems) < _MOST_PROBLEMS:
            location = self.source.tag(self._indices[element], attribute)
            self.problems.append(Problem(kind, message, location, subject))
        else:
            self.unlisted += 1

    def closest(self, name: str, known: Iterable[str]) -> str | None:
        """The known name that is most like this one; only so often in one file, because it takes its time."""
        self._guesses -= 1
        return closest(name, known) if self._guesses >= 0 else None

    def did_you_mean(self, name: str, known: Iterable[str]) -> str:
        """`; did you mean 'x'?` to be put behind a message, or nothing where no known name is close."""
        self._guesses -= 1
        return did_you_mean(name, known) if self._guesses >= 0 else ""

    def printed(self, text: str, element: Element, attribute: str | None = None) -> None:
        """Note that ROS 2 puts this text into printf, if it holds a directive that can crash it."""
        if "%" in text and _FORMAT_DIRECTIVE.search(text):
            message = "ROS 2 prints this value through printf, where %n writes to memory: it can crash"
            self.add(catalogue.FORMAT_DIRECTIVE, message, element, attribute)


class Part:
    """One element that ROS 2 keeps or loses as a whole: every defect in it is noted under one kind of problem."""

    __slots__ = ("_consequence", "_kind", "_link", "_notes", "bad")

    def __init__(self, notes: Notes, kind: Kind, consequence: str, link: str | None = None) -> None:
        """`consequence` says what ROS 2 does then; `link` fills the place that it leaves for a name."""
        self._notes = notes
        self._kind = kind
        self._consequence = consequence
        self._link = link
        self.bad = False

    def fail(self, reason: str, element: Element, attribute: str | None = None) -> None:
        """Note a defect: the part is lost."""
        self.bad = True
        consequence = self._consequence if self._link is None else self._consequence.format(quoted(self._link))
        self._notes.add(self._kind, f"{reason}; {consequence}", element, attribute, subject=self._link or "")

    def mark(self, element: Element) -> Mark:
        """The place of an element."""
        return self._notes.mark(element)

    def number(self, element: Element, attribute: str, default: Default) -> float | Default:
        """An attribute's number; the default where it is left out or, with a note, where it cannot be read."""
        text = element.get(attribute)
        if text is None:
            return default
        try:
            return number(text)
        except NumberError as error:
            self._unreadable(element, attribute, text, error)
            return default

    def needed(self, element: Element, attribute: str) -> float:
        """An attribute's number that must be there; NaN, with a note, where it is not."""
        if element.get(attribute) is None:
            self.fail(f"<{element.tag}> has no {attribute}", element)
        return self.number(element, attribute, float("nan"))

    def vector(self, element: Element, attribute: str) -> Vector | None:
        """An attribute's three numbers; zeros where it is left out; None, with a note, where they cannot be read."""
        text = element.get(attribute)
        if text is None:
            return (0.0, 0.0, 0.0)
        try:
            return vector(text)
        except NumberError as error:
            self._unreadable(element, attribute, text, error)
            return None

    def origin(self, element: Element | None) -> Origin | None:
        """An <origin>: the identity where there is none; None, with a note, where it cannot be read."""
        if element is None:
            return Origin()
        xyz, rpy = self.vector(element, "xyz"), self.vector(element, "rpy")
        if xyz is None or rpy is None:
            return None
        if rpy != (0.0, 0.0, 0.0) and max(map(abs, rpy)) > _FULL_TURN:
            self._suspect_degrees(element, rpy)
        return Origin(xyz, rpy, self._notes.mark(element))

    def _unreadable(self, element: Element, attribute: str, text: str, error: NumberError) -> None:
        self.fail(f"{attribute}={shown(text)} of <{element.tag}> cannot be read: {error}", element, attribute)
        if element.tag in _PRINTED:
            self._notes.printed(text, element, attribute)

    def _suspect_degrees(self, element: Element, rpy: Vector) -> None:
        for angle in rpy:
            if abs(angle) > _FULL_TURN and angle % 15 == 0:
                message = f"rpy is in radians, and {angle:g} is more than a full turn: are degrees meant?"
                self._notes.add(catalogue.DEGREES, message, element, "rpy")
                return


def children(element: Element) -> dict[str, Element]:
    """The first child of each name: of several, urdfdom reads the first."""
    first: dict[str, Element] = {}
    for child in element:
        first.setdefault(child.tag, child)
    return first


def shown(text: str) -> str:
    """A value of the file between double quotes, cut where it is very long."""
    return f'"{text}"' if len(text) <= 60 else f'"{text[:57]}..."'
