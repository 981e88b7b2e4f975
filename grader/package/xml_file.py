"""An XML file of a package: its root and the location of every element."""

from grader.source import Location, Source
from grader.xml.parsing import Element, XMLSyntaxError, parse_xml


class XmlFault(Exception):
    """A text that is not XML, with the location of the error."""

    def __init__(self, message: str, location: Location) -> None:
        super().__init__(message)
        self.location = location


class XmlFile:
    """The elements of an XML text; raises XmlFault."""

    def __init__(self, data: bytes, source: Source) -> None:
        self.source = source
        try:
            self.root = parse_xml(data)
        except (XMLSyntaxError, ValueError) as error:
            line, column = getattr(error, "position", (1, 1))
            message, *_ = str(getattr(error, "msg", error)).split(
                ", line "
            )  # lxml adds the position to libxml2's message
            location = Location(source.path, max(line, 1), max(column, 1))
            raise XmlFault(" ".join(message.split()), location) from None
        self._indices = {element: index for index, element in enumerate(self.root.iter("*"))}

    def location(self, element: Element) -> Location:
        """Return the location of an element; the start of the file in an encoding in which its tags are not found."""
        try:
            return self.source.tag(self._indices[element])
        except IndexError:
            return Location(self.source.path, 1, 1)
