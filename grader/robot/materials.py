"""The colour that each visual gets (`model.cpp`: assignMaterial, `link.cpp`: parseMaterial)."""

from grader.robot import catalogue
from grader.robot.diagnostics import Problems, first_children, shown
from grader.robot.model import Material
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
        name = element.get("name")
        if name is None:
            problems.add(catalogue.UNNAMED_MATERIAL, "this material has no name; no link can use it", element)
        material, _ = self._read(element, name or "", "ROS 2 shows black")
        if name is not None and material is None:
            message = f"material {quoted(name)} has no valid colour; ROS 2 makes it black"
            if element.find("color[@rgba]") is None:
                problems.add(catalogue.COLOURLESS_MATERIAL, message, element)
            problems.check_printed(name, element, "name")
        if (name or "") in self.known:
            message = f"material {quoted(name or '')} is defined twice under <robot>; ROS 2 rejects the file"
            problems.add(catalogue.DUPLICATE_MATERIAL, message, element, "name")
            return
        self.known[name or ""] = material or Material(name or "", location=problems.location(element))

    def assign(self, element: Element, link: str) -> tuple[Material | None, str]:
        """Return the material that a visual gets, and its name: a defined one wins, otherwise the one in place is defined."""
        name = element.get("name") or ""
        if not len(element) and name in self.known and name:
            return self.known[name], name
        fallback = "the definition above applies" if name in self.known else f"material {quoted(name)} stays undefined"
        own, reported = self._read(element, name, f"ROS 2 logs an error: {fallback}")
        found = self.known.get(name) if name else own
        if found is None and own is None:
            if name and not reported:
                self._undefined(name, element, link)
        elif found is None and own is not None:
            found = self.known[name] = own
        elif own is not None and found is not None and (own.rgba, own.texture) != (found.rgba, found.texture):
            message = f"material {quoted(name)} is already defined differently; ROS 2 ignores this definition"
            self._problems.add(catalogue.REDEFINED_MATERIAL, message, element, "name")
        return found, name

    def _read(self, element: Element, name: str, consequence: str) -> tuple[Material | None, bool]:
        """Return the material that an element defines, if it does, and whether its colour is reported as a problem."""
        inside = first_children(element)
        texture, colour = inside.get("texture"), inside.get("color")
        filename = texture.get("filename") if texture is not None else None
        text = colour.get("rgba") if colour is not None else None
        channels, reported = None, False
        if text is not None and colour is not None:
            try:
                channels = rgba(text)
                if channels is None:
                    message = f"rgba={shown(text)} needs exactly four numbers; ROS 2 silently shows black"
                    self._problems.add(catalogue.COLOUR_COUNT, message, colour, "rgba")
                    channels = _BLACK
            except NumberError as error:
                reported = True
                message = f"cannot read rgba={shown(text)}: {error}; {consequence}"
                self._problems.add(catalogue.BAD_COLOUR, message, colour, "rgba")
                self._problems.check_printed(f"{name} {text}", colour, "rgba")
        if channels is None and filename is None:
            return None, reported
        location = self._problems.location(element if colour is None else colour)
        return Material(name, channels or _BLACK, filename or "", location), reported

    def _undefined(self, name: str, element: Element, link: str) -> None:
        problems = self._problems
        if self._defined is None:
            every = [other for other in problems.root.iter("material") if len(other) and other.get("name")]
            self._defined = {other.get("name") or "": other for other in reversed(every)}
        later = self._defined.get(name)
        if later is not None:
            line = problems.line(later)
            hint, advice = f" before its definition in line {line}", "; define it directly under <robot>"
        else:
            hint, advice = ", which is not defined", problems.did_you_mean(name, self._defined)
        message = f"link {quoted(link)} uses material {quoted(name)}{hint}; ROS 2 shows it without the colour{advice}"
        problems.add(catalogue.UNDEFINED_MATERIAL, message, element, "name")
