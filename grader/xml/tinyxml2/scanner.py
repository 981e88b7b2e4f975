"""A text read by TinyXML2's rules (`tinyxml2.cpp`: Identify, ParseDeep): its first <robot> as XML, or why there is none."""

import re
from dataclasses import dataclass, field
from typing import NamedTuple

from grader.problems import Kind
from grader.xml import catalogue
from grader.xml.tinyxml2.tags import REFERENCE, MalformedTagError, Tag, read_tag, short, skip_blank
from grader.xml.tinyxml2.values import ILLEGAL, escape

_PLAIN_NAME = re.compile(r"(?!(?i:xml))[A-Za-z_][A-Za-z0-9_.\-]*")
_DECLARATION = re.compile(
    r"""xml\s+version\s*=\s*["']1\.[0-9]+["'](\s+encoding\s*=\s*["'](?i:utf-8|us-ascii)["'])?[^<>]*"""
)
_NAMESPACE = re.compile(r"xmlns:([^\s=]+)")
_MAX_DEPTH = 500  # TINYXML2_MAX_ELEMENT_DEPTH; the document itself is the first level
_KEPT_DEPTH = 32  # urdfdom never looks deeper than robot/link/visual/geometry/box
_MOST_ERRORS = 20
_LONGEST_NAME = 60
_SPACE = " \t\n\v\f\r"


class Difference(NamedTuple):
    """A difference or an error at a character offset."""

    kind: Kind
    message: str
    offset: int


@dataclass(slots=True)
class Scan:
    """The first top-level <robot> as XML, empty where there is none, with the offset of each of its start tags."""

    xml: bytes = b""
    offsets: list[int] = field(default_factory=list)
    first_tag: int = 0
    differences: list[Difference] = field(default_factory=list)


class Scanner:
    """One pass over a text. Where TinyXML2 would stop at an error, it goes on, to find other broken tags."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._scanned = Scan()
        self._out: list[str] = []
        self._stack: list[
            tuple[Tag, str]
        ] = []  # the open tags, each with the name under which it was written, if it was
        self._top_level: list[Tag] = []
        self._declared: set[str] | None = None  # the prefixes of the file, once one is met
        self._noted: set[str] = set()
        self._errors = 0
        self._only_declarations = True

    def scan(self) -> Scan:
        """Read the whole text."""
        position = self._start()
        while position is not None and self._errors < _MOST_ERRORS:
            position = self._node(position)
        scanned = self._scanned
        if self._errors:
            scanned.differences = [each for each in scanned.differences if each.kind is not catalogue.NOT_WELL_FORMED]
        else:
            self._note_roots()
            scanned.xml = "".join(self._out).encode()
        return scanned

    def _start(self) -> int | None:
        text = self._text
        if text.startswith(("\udcff\udcfe", "\udcfe\udcff")) or "\0" in text[:4]:
            self._refuse(catalogue.NOT_UTF8, "this is not UTF-8 text; ROS 2 cannot read it", 0)
            return None
        end = text.find("\0")
        if end >= 0:
            self._find(catalogue.IGNORED_REST, "ROS 2 reads only up to this NUL byte", end)
            text = self._text = text[:end]
        position = skip_blank(text, 0)
        if text.startswith("\ufeff", position):
            position += 1
        if position == len(text):
            self._refuse(catalogue.EMPTY_DOCUMENT, "the file is empty; ROS 2 loads nothing", 0)
            return None
        illegal = ILLEGAL.search(text)
        if illegal:
            what = "invalid UTF-8" if illegal[0] >= "\ud800" else "a control character"
            self._differ(what, f"{what} ({illegal[0].encode('utf-8', 'surrogateescape').hex()})", illegal.start())
        return position

    def _node(self, start: int) -> int | None:
        """Read what stands at this offset; the offset behind it, or None at the end."""
        text = self._text
        position = skip_blank(text, start)
        if position == len(text):
            self._end()
            return None
        if text[position] != "<":
            return self._text_node(position)
        if text.startswith("<?", position):
            return self._declaration(position)
        self._only_declarations = False
        if text.startswith("<!--", position):
            return self._comment(position)
        if text.startswith("<![CDATA[", position):
            return self._cdata(position)
        if text.startswith("<!", position):
            return self._unknown(position)
        try:
            tag, end = read_tag(text, position, self._differ)
        except MalformedTagError as error:
            self._refuse(catalogue.MALFORMED_TAG, f"{error}; ROS 2 loads nothing of the file", error.offset)
            return error.resume
        return self._close(tag, end) if tag.form == "close" else self._open(tag, end)

    def _end(self) -> None:
        if self._stack and not self._errors:
            tag = self._stack[-1][0]
            message = f"<{short(tag.name)}> is never closed: the file ends first; ROS 2 loads nothing"
            self._refuse(catalogue.MISMATCHED_TAG, message, tag.offset)

    def _text_node(self, position: int) -> int | None:
        end = self._text.find("<", position)
        if end < 0 and self._stack:
            self._end()
        elif end < 0:
            message = "there is text behind the end of the robot; ROS 2 loads nothing"
            if not self._top_level:
                message = f"this is not XML: it begins with {short(self._text.strip()[:20])!r}; ROS 2 loads nothing"
            self._refuse(catalogue.STRAY_TEXT, message, position)
        elif not self._stack:
            self._only_declarations = False
            self._differ("text", "text outside the robot", position)
        elif reference := REFERENCE.search(self._text, position, end):
            self._differ("reference", "a bare & (it is written &amp;)", reference.start())
        return end if end >= 0 else None

    def _declaration(self, position: int) -> int | None:
        end = self._text.find("?>", position + 2)
        if end < 0:
            self._refuse(catalogue.UNTERMINATED, "this <? is never closed with ?>; ROS 2 loads nothing", position)
            return None
        if self._stack or not self._only_declarations:
            message = "an XML declaration may stand only at the very top of the file; ROS 2 loads nothing"
            self._refuse(catalogue.MISPLACED_DECLARATION, message, position)
        elif position > 0 and not self._text.startswith("\ufeff<"):
            self._differ("declaration", "something before the XML declaration", position)
        elif not _DECLARATION.fullmatch(self._text, position + 2, end):
            self._differ("declaration", "an XML declaration without a known version or encoding", position)
        return end + 2

    def _comment(self, position: int) -> int | None:
        end = self._delimited(position, "<!--", "-->", "comment")
        if end is not None and "--" in self._text[position + 4 : end - 2]:
            self._differ("comment", "-- inside a comment", position)
        return end

    def _cdata(self, position: int) -> int | None:
        if not self._stack:
            self._differ("cdata", "a CDATA section outside the robot", position)
        return self._delimited(position, "<![CDATA[", "]]>", "CDATA section")

    def _unknown(self, position: int) -> int | None:
        end = self._delimited(position, "<!", ">", "<!")
        if end is not None and "doctype" not in self._noted:
            self._noted.add("doctype")
            message = "ROS 2 skips a DOCTYPE and leaves the entities that it defines as they stand"
            self._find(catalogue.DOCTYPE, message, position)
        return end

    def _delimited(self, position: int, opening: str, closing: str, what: str) -> int | None:
        end = self._text.find(closing, position + len(opening))
        if end < 0:
            message = f"this {what} is never closed with {closing}; ROS 2 loads nothing"
            self._refuse(catalogue.UNTERMINATED, message, position)
            return None
        return end + len(closing)

    def _open(self, tag: Tag, end: int) -> int | None:
        prefix, colon, _ = tag.name.partition(":")
        if colon and "prefix" not in self._noted and prefix not in self._prefixes():
            self._differ("prefix", f"the prefix of <{short(tag.name)}> is not declared with xmlns", tag.offset)
        written = self._write(tag)
        if tag.form == "open":
            self._stack.append((tag, written))
            if len(self._stack) + 1 >= _MAX_DEPTH and not self._errors:
                self._refuse(catalogue.TOO_DEEP, "tags are nested too deep for ROS 2, which loads nothing", tag.offset)
                return None
        return end

    def _close(self, tag: Tag, end: int) -> int | None:
        if not self._stack:
            if not self._errors:
                self._stop(tag, end)
                return None
            return end
        opened, written = self._stack.pop()
        if written:
            self._out.append(f"</{written}>")
        if opened.name != tag.name and not self._errors:
            line = self._text.count("\n", 0, opened.offset) + 1
            still_open = f"<{short(opened.name)}> of line {line} is still open"
            message = f"</{short(tag.name)}> stands where {still_open}; ROS 2 loads nothing"
            self._refuse(catalogue.MISMATCHED_TAG, message, tag.offset)
        return end

    def _prefixes(self) -> set[str]:
        if self._declared is None:
            self._declared = set(_NAMESPACE.findall(self._text))
        return self._declared

    def _write(self, tag: Tag) -> str:
        """Write a tag of the first top-level <robot> as XML; its name there, or nothing for what is left out."""
        if self._stack:
            wanted = self._stack[-1][1] != "" and len(self._stack) < _KEPT_DEPTH
        else:
            wanted = tag.name == "robot" and not self._out
            self._scanned.first_tag = self._scanned.first_tag if self._top_level else tag.offset
            self._top_level.append(tag)
        if not wanted:
            return ""
        self._scanned.offsets.append(tag.offset)
        name = tag.name if _is_plain_name(tag.name) else "_"
        values = "".join(f' {each}="{escape(value)}"' for each, value in tag.attributes.items() if _is_plain_name(each))
        self._out.append(f"<{name}{values}{'>' if tag.form == 'open' else '/>'}")
        return name

    def _stop(self, tag: Tag, end: int) -> None:
        self._differ("stray", f"the closing tag </{short(tag.name)}>, which closes nothing", tag.offset)
        if self._text[end:].strip(_SPACE):
            self._find(
                catalogue.IGNORED_REST, "ROS 2 stops reading at this closing tag, which closes nothing", tag.offset
            )

    def _note_roots(self) -> None:
        robot = next((tag for tag in self._top_level if tag.name == "robot"), None)
        other = next((tag for tag in self._top_level if tag is not robot), None)
        if robot and other:
            message = f"ROS 2 takes the first <robot> at the top level and ignores <{short(other.name)}> beside it"
            self._find(catalogue.SEVERAL_ROOTS, message, other.offset)

    def _find(self, kind: Kind, message: str, offset: int) -> None:
        self._scanned.differences.append(Difference(kind, message, offset))

    def _refuse(self, kind: Kind, message: str, offset: int) -> None:
        self._errors += 1
        self._find(kind, message, offset)

    def _differ(self, key: str, what: str, offset: int) -> None:
        if key not in self._noted:
            self._noted.add(key)
            self._find(
                catalogue.NOT_WELL_FORMED, f"ROS 2 reads past this, but it is not well-formed XML: {what}", offset
            )


def _is_plain_name(name: str) -> bool:
    # Names that XML or lxml may refuse never mean anything to urdfdom; the longest that does has 17 letters.
    return len(name) < _LONGEST_NAME and _PLAIN_NAME.fullmatch(name) is not None
