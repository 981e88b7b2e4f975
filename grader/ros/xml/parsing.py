"""XML read by lxml, and a URDF as TinyXML2 reads it.

The parser may open nothing: no file, no network, no entity.
"""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from lxml import etree

from grader.base.grouping import StringsByName
from grader.base.merge_conflicts import describe_conflicts, find_conflicts, without_conflicts
from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.source import Edits, Location, Source
from grader.ros.xml.xml_problems import (
    MERGE_CONFLICT,
    MISMATCHED_TAG,
    NOT_UTF8,
    SEVERAL_ROOTS,
    UNTERMINATED,
)

if TYPE_CHECKING:
    from grader.ros.xml.tinyxml2 import Difference, Scan

Element = etree._Element  # noqa: SLF001  lxml has no public name for it
Elements = dict[str, Element]
XMLSyntaxError = etree.XMLSyntaxError

# Callers limit the number of bytes.
_PARSER = etree.XMLParser(
    resolve_entities=False,
    no_network=True,
    load_dtd=False,
    dtd_validation=False,
    huge_tree=False,
    remove_comments=True,
    remove_pis=True,
)

# lxml turns a line break or tab in a value into a space (XML 1.0, 3.3.3), TinyXML2 keeps it. The
# search skips all other bytes: of xyz="0 0<tab>1" it sees ="<tab>".
_UNIMPORTANT = bytes(sorted(set(range(256)) - set(b"=\"'\t\n\r")))
_BROKEN_VALUE = on_use(rb"""=[\t\n\r]*(?:"[='\t\n\r]*?[\t\n\r]|'[="\t\n\r]*?[\t\n\r])""")
_UTF_16 = on_use(rb"\xff\xfe(?!\0\0)|\xfe\xff|<\0[^\0]\0|\0<\0[^\0]")
_DEFAULT_NAMESPACE = rb"xmlns[ \t\r\n]*="
# No declaration, and no byte-order mark, which lxml takes for the encoding; or one that says what
# TinyXML2 assumes.
_PLAIN_START = on_use(
    rb"""
      (?!<\?|\xff\xfe|\xfe\xff|\xef\xbb\xbf)
    | <\?xml\s+version\s*=\s*["']1\.0["'](?:\s+encoding\s*=\s*["'](?i:utf-8)["'])?\s*\?>
    """,
    re.VERBOSE,
)


class Unresolved(Named):
    """What was not expanded of an element, with why it cannot be determined.

    It is empty where xacro refuses it.
    """

    attributes: StringsByName  # those that are left as they are written
    # why there may be more attributes and children; None if there are no more
    content: str | None = None


class XmlDocument(Named):
    """What is read of a URDF's text.

    This is its root element, and everything that TinyXML2, XML or xacro rejects in it.
    """

    root: (
        Element | None
    )  # None where TinyXML2 refuses the text, or finds no <robot> at its top level
    source: Source
    problems: list[Problem]
    first_tag: int = 0  # the offset of the first tag
    unresolved: Mapping[Element, Unresolved] = {}  # the elements that xacro leaves open
    is_expanded: bool = False  # whether xacro expanded the text
    # of a refused text, the robot as it is after the edits that repair the text
    recovered: Element | None = None
    is_meant: bool = True  # whether the text means these elements although it is refused
    # of a text that xacro expanded: the ways to write an attribute of the element with an index, of
    # its value and the new one
    rewrites: Callable[[int, str, tuple[str, str]], Sequence[Edits]] | None = None


def recover_xml(data: bytes) -> Element | None:
    """Return the root of what libxml2 can read of a text that is not XML.

    Returns None if that is nothing.
    """
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, remove_comments=True, remove_pis=True, recover=True
    )
    try:
        return etree.fromstring(data, parser)
    except (XMLSyntaxError, ValueError):
        return None


def parse_xml(data: bytes) -> Element:
    """Return the root element of an XML text; raises XMLSyntaxError."""
    return etree.fromstring(data, _PARSER)


def make_element(tag: str, attributes: dict[str, str], parent: Element | None = None) -> Element:
    """Return a new element, which becomes the last child of its parent."""
    if parent is None:
        return etree.Element(tag, attributes)
    return etree.SubElement(parent, tag, attributes)


def read_document(data: bytes, path: str) -> XmlDocument:
    """Read the bytes of a URDF; never raises.

    Text that lxml may not read as TinyXML2 does is translated first.
    """
    if _UTF_16.match(data):
        return _read_utf_16(data, path)
    text = data.decode("utf-8", "surrogateescape")
    body = data.removeprefix(b"\xef\xbb\xbf")  # TinyXML2 skips a byte-order mark
    if is_plain(body):
        source = Source(path, text)
        try:
            return XmlDocument(parse_xml(body), source, [], 0)
        except XMLSyntaxError:
            pass
    # late: most files are plain, and compiling its patterns takes long
    from grader.ros.xml.tinyxml2 import scan

    scanned = scan(without_conflicts(text, find_conflicts(text)))
    refused = _why_repaired(text, scanned)
    if refused:
        return _read_repaired(text, path, refused, scanned.first_tag)
    source = Source(path, text, scanned.offsets)
    root = parse_xml(scanned.xml) if scanned.xml else None
    return XmlDocument(root, source, _problems(scanned.differences, source), scanned.first_tag)


def _why_repaired(text: str, scanned: "Scan") -> list["Difference"]:
    """Return why a text is read after the edits that repair it.

    It is empty if it is read as it stands.
    """
    from grader.ros.xml.repair import unclosed_comments
    from grader.ros.xml.tinyxml2 import Difference

    conflicts = find_conflicts(text)
    if conflicts:
        message = f"{describe_conflicts(text, conflicts)}; ROS 2 rejects the file"
        return [Difference(MERGE_CONFLICT, message, conflicts[0].start), *scanned.differences]
    comments = unclosed_comments(text) if "->\n" in text or "->\r" in text else []
    if comments:
        start, end = comments[0]
        last = text.count("\n", 0, max(text.find("-->", end), end)) + 1
        message = (
            "this comment ends with -> and not with -->, so that ROS 2 ignores everything up "
            f"to line {last}"
        )
        return [Difference(UNTERMINATED, message, start)]
    if scanned.is_refused:
        return scanned.differences
    is_empty = scanned.xml.endswith(b"/>") and len(scanned.offsets) == 1
    if is_empty and any(difference.kind is SEVERAL_ROOTS for difference in scanned.differences):
        message = "the / in the tag of <robot> closes it before its links; ROS 2 finds no link"
        return [Difference(MISMATCHED_TAG, message, scanned.offsets[0])]
    return []


def _read_repaired(
    text: str, path: str, refused: "list[Difference]", first_tag: int
) -> XmlDocument:
    """Read a text after the edits that repair it, since TinyXML2 refuses it as it is.

    Places are those in the text.
    """
    from grader.ros.xml.repair import repair  # late: few files are broken

    repaired = repair(text)
    source = Source(path, text, repaired.offsets)
    recovered = parse_xml(repaired.xml) if repaired.xml else None
    problems = _problems(refused + repaired.assumed, source)
    return XmlDocument(None, source, problems, first_tag, recovered=recovered)


def _problems(differences: "Iterable[Difference]", source: Source) -> list[Problem]:
    return [
        Problem(
            difference.kind, difference.message, source.at(difference.offset), difference.subject
        )
        for difference in differences
    ]


def _read_utf_16(data: bytes, path: str) -> XmlDocument:
    """Read a text in UTF-16, which TinyXML2 refuses, as what it means.

    Without a byte-order mark it begins with a <.
    """
    encoding = "utf-16-le" if data[0] else "utf-16-be"
    if data[0] >= 0xFE:  # a byte-order mark
        encoding = "utf-16"
    document = read_document(
        data.decode(encoding, "replace").replace("\0", "\ufffd").encode(), path
    )
    message = "the file is UTF-16 text, which ROS 2 cannot read; save it as UTF-8"
    problems = [Problem(NOT_UTF8, message, document.source.at(0)), *document.problems]
    recovered = document.root if document.root is not None else document.recovered
    return document._replace(root=None, problems=problems, recovered=recovered)


def is_plain(data: bytes) -> bool:
    """Return whether a text that lxml accepts means the same to TinyXML2.

    Then no translation is needed.
    """
    return (
        b"\0" not in data
        and data.find(b"<?", 1) < 0
        and data.count(b"<!") == data.count(b"<!--")
        and _PLAIN_START.match(data) is not None
        and not _BROKEN_VALUE.search(data.translate(None, _UNIMPORTANT))
        and (b"xmlns" not in data or not re.search(_DEFAULT_NAMESPACE, data))
    )


def error_location(error: Exception, source: Source) -> Location:
    """Return where an XML parser stopped, within the text.

    The parser libxml2 counts columns beyond the end of a line.
    """
    line, column = getattr(error, "position", (1, 1))
    line = min(max(line or 1, 1), source.text.count("\n") + 1)
    return Location(source.path, line, min(max(column or 1, 1), len(source.line(line)) + 1))


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
            message, _, _ = str(getattr(error, "msg", error)).partition(
                ", line "
            )  # lxml adds the position
            raise XmlFault(" ".join(message.split()), error_location(error, source)) from None
        self._indices = {element: index for index, element in enumerate(self.root.iter("*"))}

    def location(self, element: Element, attribute: str | None = None) -> Location:
        """Return the location of an element, or of an attribute of it.

        It is the start of the file in an encoding in which tags are not found.
        """
        try:
            return self.source.tag(self._indices[element], attribute)
        except IndexError:
            return Location(self.source.path, 1, 1)


def parse_root(text: str) -> tuple[Element | None, Source]:
    """Return the root of a text, and the text that its places are in.

    Where it is no XML, it is read as ROS 2 reads it.
    """
    data = text.encode("utf-8", "surrogateescape")
    source = Source("", text)
    try:
        return XmlFile(data, source).root, source
    except XmlFault:
        document = read_document(data, "")
        return document.root, document.source
