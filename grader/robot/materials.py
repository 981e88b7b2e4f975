"""The materials of a robot: where each is defined, and which one a visual gets."""

from grader.robot import catalogue
from grader.robot.diagnostics import Problems, first_children, quote_value
from grader.robot.model import Material, UnresolvedPart
from grader.robot.numbers import NumberError, rgba
from grader.text import quoted
from grader.xml.parsing import Element

_BLACK = (0.0, 0.0, 0.0, 1.0)


class Materials:
    """The materials that are defined so far: first those under <robot>, then those in links, in file order."""

    def __init__(self, problems: Problems) -> None:
        self._problems = problems
        self._defined: dict[str, Element] | None = None  # all definitions of the file, once one is missing
        self.known: dict[str, Material] = {}

    def define(self, element: Element) -> None:
        """Read a material directly under <robot>; without a valid colour it is black."""
        problems = self._problems
        name = element.get("name") or ""
        material, _ = self._read(element, name, "ROS 2 shows black")
        if element.get("name") is None:
            problems.add(catalogue.UNNAMED_MATERIAL, "this material has no name; no link can use it", element)
        elif material is None:
            if element.find("color[@rgba]") is None:
                message = f"material {quoted(name)} has no valid colour; ROS 2 makes it black"
                problems.add(catalogue.COLOURLESS_MATERIAL, message, element)
            problems.check_printed(name, element, "name")
        if name in self.known:
            message = f"material {quoted(name)} is defined twice under <robot>; ROS 2 rejects the file"
            problems.add(catalogue.DUPLICATE_MATERIAL, message, element, "name")
        else:
            self.known[name] = material or Material(name, location=problems.location(element))

    def assign(self, element: Element, link: str) -> tuple[Material | None, str, bool]:
        """Return the material of a visual, its name, and whether its colour cannot be read.

        A defined one wins, otherwise the one in place is defined.
        """
        name = element.get("name") or ""
        if not len(element) and name in self.known and name:
            return self.known[name], name, False
        fallback = "the definition above applies" if name in self.known else f"material {quoted(name)} stays undefined"
        own, reported = self._read(element, name, f"ROS 2 logs an error: {fallback}")
        found = self.known.get(name) if name else own
        if own is None:
            if found is None and name and not reported:
                self._note_undefined(name, element, link)
                found = self._elsewhere(name)
        elif found is None:
            found = self.known[name] = own
        elif (own.rgba, own.texture) != (found.rgba, found.texture):
            message = f"material {quoted(name)} is already defined differently; ROS 2 ignores this definition"
            self._problems.add(catalogue.REDEFINED_MATERIAL, message, element, "name")
        return found, name, found is None and reported

    def _read(self, element: Element, name: str, consequence: str) -> tuple[Material | None, bool]:
        """Return the material that an element defines, if it does, and whether its colour is reported as a problem."""
        inside = first_children(element)
        colour = inside.get("color")
        filename = inside["texture"].get("filename") if "texture" in inside else None
        channels, reported = None, False
        if colour is not None and (text := colour.get("rgba")) is not None:
            try:
                channels = rgba(text)
                if channels is None:
                    message = f"rgba={quote_value(text)} needs exactly four numbers; ROS 2 silently shows black"
                    self._problems.add(catalogue.COLOUR_COUNT, message, colour, "rgba")
                    channels = _BLACK
            except NumberError as error:
                reported = True
                message = f"cannot read rgba={quote_value(text)}: {error}; {consequence}"
                self._problems.add(catalogue.BAD_COLOUR, message, colour, "rgba")
                self._problems.check_printed(f"{name} {text}", colour, "rgba")
        unresolved = self._problems.parts(element)
        if channels is None and filename is None and not unresolved:
            return None, reported
        location = self._problems.location(element if colour is None else colour)
        return Material(name, channels or _BLACK, filename or "", location, unresolved), reported

    def _elsewhere(self, name: str) -> Material | None:
        """Return a material that may be defined in a part of the robot that xacro leaves open."""
        root = self._problems.root
        found = self._problems.unresolved.get(root)
        if found is None or not found.content:
            return None
        return Material(name, unresolved={"": UnresolvedPart(found.content, self._problems.location(root))})

    def _note_undefined(self, name: str, element: Element, link: str) -> None:
        problems = self._problems
        if self._defined is None:
            every = [other for other in problems.root.iter("material") if len(other)]
            self._defined = {other.get("name") or "": other for other in reversed(every)}
            self._defined.pop("", None)
        if name in self._defined:
            line = problems.line(self._defined[name])
            hint = f" before its definition in line {line}; define it directly under <robot>"
        else:
            hint = f", which is not defined{problems.did_you_mean(name, self._defined)}"
        message = f"link {quoted(link)} uses material {quoted(name)}{hint}; ROS 2 shows it without the colour"
        problems.add(catalogue.UNDEFINED_MATERIAL, message, element, "name")
