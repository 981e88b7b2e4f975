"""The problems that are found in a URDF while it is read, each with its location."""

import re
from collections.abc import Iterable

from grader.names import closest, did_you_mean
from grader.problems import Effect, Kind, Problem
from grader.robot import catalogue
from grader.robot.model import Joint
from grader.source import LazyLocation, Source
from grader.text import quoted
from grader.xml.parsing import Element

_FORMAT_DIRECTIVE = re.compile(r"%[-+ #0-9.$*'hlLqjzt]*n")
_MAX_PROBLEMS = 1000
_MAX_GUESSES = 50  # in one file, because they take long


class Problems:
    """The problems of one file, and the locations of its elements."""

    def __init__(self, source: Source, root: Element) -> None:
        self.source = source
        self.root = root
        self.listed: list[Problem] = []
        self.effects: set[Effect] = set()
        self.unlisted = 0
        self._guesses = _MAX_GUESSES
        self._elements = list(root.iter())
        self._indices = {element: index for index, element in enumerate(self._elements)}

    def location(self, element: Element) -> LazyLocation:
        """Return the location of an element, to be computed when it is needed."""
        return LazyLocation(self.source, self._indices[element])

    def line(self, element: Element) -> int:
        """Return the line of an element, counted from 1."""
        return self.location(element).resolve().line

    def element(self, joint: Joint) -> Element:
        """Return the element that a joint was read from."""
        return self._elements[joint.location.tag] if joint.location is not None else self.root

    def add(self, kind: Kind, message: str, element: Element, attribute: str | None = None, subject: str = "") -> None:
        """Add a problem at an element, or at one of its attributes if it has it."""
        self.effects.add(kind.effect)
        if len(self.listed) < _MAX_PROBLEMS:
            location = self.source.tag(self._indices[element], attribute)
            self.listed.append(Problem(kind, message, location, subject))
        else:
            self.unlisted += 1

    def duplicate(self, kind: Kind, element: Element, first: Element) -> None:
        """Add that an element has the name of an earlier one of its kind."""
        name = quoted(element.get("name") or "")
        message = f"the {element.tag} {name} is already defined in line {self.line(first)}; ROS 2 rejects the file"
        self.add(kind, message, element, "name")

    def closest(self, name: str, known: Iterable[str]) -> str | None:
        """Return the known name that is most like this one, if one is close."""
        self._guesses -= 1
        return closest(name, known) if self._guesses >= 0 else None

    def did_you_mean(self, name: str, known: Iterable[str]) -> str:
        """Return `; did you mean 'x'?` for the end of a message, or nothing if no known name is close."""
        self._guesses -= 1
        return did_you_mean(name, known) if self._guesses >= 0 else ""

    def check_printed(self, text: str, element: Element, attribute: str | None = None) -> None:
        """Add a problem if ROS 2 passes this text to printf and it contains a directive that can crash it."""
        if "%" in text and _FORMAT_DIRECTIVE.search(text):
            message = "ROS 2 passes this value to printf as a format, where %n writes to memory: it can crash"
            self.add(catalogue.FORMAT_DIRECTIVE, message, element, attribute)


def first_children(element: Element) -> dict[str, Element]:
    """Return the first child of each name: urdfdom reads no other."""
    first: dict[str, Element] = {}
    for child in element:
        first.setdefault(child.tag, child)
    return first


def shown(text: str) -> str:
    """Return a value of the file between double quotes, cut where it is very long."""
    return f'"{text}"' if len(text) <= 60 else f'"{text[:57]}..."'
