"""The values of an element's attributes, with a problem for each that cannot be read."""

from typing import TypeVar

from grader.problems import Kind
from grader.robot import catalogue
from grader.robot.diagnostics import Problems, shown
from grader.robot.model import Origin
from grader.robot.numbers import NumberError, number, vector
from grader.robot.transforms import Vector
from grader.text import quoted
from grader.xml.parsing import Element

Default = TypeVar("Default")

_PRINTED = frozenset({"origin", "box", "cylinder", "sphere", "mass"})  # whose values urdfdom uses as printf's format
_FULL_TURN = 6.2832  # radians
_REJECTED = "ROS 2 rejects the file"


class ElementReader:
    """A reader of one element that ROS 2 keeps or drops as a whole: every defect in it is a problem of one kind."""

    __slots__ = ("_consequence", "_kind", "_link", "_problems", "failed")

    def __init__(self, problems: Problems, kind: Kind, consequence: str = _REJECTED, link: str = "") -> None:
        """`consequence` says what ROS 2 does about a defect; the name of the `link` is put where it has {}."""
        self._problems = problems
        self._kind = kind
        self._consequence = consequence.format(quoted(link))
        self._link = link
        self.failed = False

    def fail(self, reason: str, element: Element, attribute: str | None = None) -> None:
        """Add a problem: the element is lost."""
        self.failed = True
        self._problems.add(self._kind, f"{reason}; {self._consequence}", element, attribute, self._link)

    def number(self, element: Element, attribute: str, default: Default) -> float | Default:
        """Return an attribute's number; the default if it is not given or, with a problem, if it cannot be read."""
        text = element.get(attribute)
        if text is None:
            return default
        try:
            return number(text)
        except NumberError as error:
            self._fail_value(element, attribute, text, error)
            return default

    def required(self, element: Element, attribute: str) -> float:
        """Return an attribute's number; NaN, with a problem, if it is not given or cannot be read."""
        if element.get(attribute) is None:
            self.fail(f"<{element.tag}> has no {attribute}", element)
        return self.number(element, attribute, float("nan"))

    def vector(self, element: Element, attribute: str, default: Vector = (0.0, 0.0, 0.0)) -> Vector | None:
        """Return an attribute's three numbers; the default if it is not given; None, with a problem, if it cannot be read."""
        text = element.get(attribute)
        if text is None:
            return default
        try:
            return vector(text)
        except NumberError as error:
            self._fail_value(element, attribute, text, error)
            return None

    def origin(self, element: Element | None) -> Origin | None:
        """Return an <origin>: the identity if there is none; None, with a problem, if it cannot be read."""
        if element is None:
            return Origin()
        xyz, rpy = self.vector(element, "xyz"), self.vector(element, "rpy")
        if xyz is None or rpy is None:
            return None
        if rpy != (0.0, 0.0, 0.0) and max(map(abs, rpy)) > _FULL_TURN:
            self._check_degrees(element, rpy)
        return Origin(xyz, rpy, self._problems.location(element))

    def _fail_value(self, element: Element, attribute: str, text: str, error: NumberError) -> None:
        self.fail(f"cannot read {attribute}={shown(text)} of <{element.tag}>: {error}", element, attribute)
        if element.tag in _PRINTED:
            self._problems.check_printed(text, element, attribute)

    def _check_degrees(self, element: Element, rpy: Vector) -> None:
        angle = next((angle for angle in rpy if abs(angle) > _FULL_TURN and angle % 15 == 0), None)
        if angle is not None:
            message = f"rpy is in radians, and {angle:g} is more than a full turn: is it in degrees?"
            self._problems.add(catalogue.DEGREES, message, element, "rpy")
