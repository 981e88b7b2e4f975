"""An XML file as TinyXML2 reads it, with the location of every tag."""

from typing import NamedTuple

from grader.problems import Problem
from grader.source import Source
from grader.xml import tinyxml2
from grader.xml.parsing import Element, XMLSyntaxError, parse_xml


class XmlDocument(NamedTuple):
    """The root element, and everything that TinyXML2 or XML rejects in the text; `first_tag` is an offset.

    The root is None where TinyXML2 refuses the text, or finds no <robot> at its top level.
    """

    root: Element | None
    source: Source
    problems: list[Problem]
    first_tag: int


def read_document(data: bytes, path: str) -> XmlDocument:
    """Read the bytes of a URDF; never raises. Text that lxml may not read as TinyXML2 does is translated first."""
    text = data.decode("utf-8", "surrogateescape")
    body = tinyxml2.without_mark(data)
    if tinyxml2.is_plain(body):
        source = Source(path, text)
        try:
            return XmlDocument(parse_xml(body), source, [], 0)
        except XMLSyntaxError:
            pass
    scan = tinyxml2.translate(text)
    source = Source(path, text, scan.offsets)
    problems = [Problem(found.kind, found.message, source.at(found.offset)) for found in scan.differences]
    return XmlDocument(parse_xml(scan.xml) if scan.xml else None, source, problems, scan.first_tag)
