"""A text read by TinyXML2's rules (`tinyxml2.cpp`: Identify, ParseDeep): its first <robot> as XML, or why none."""

import re
from functools import cached_property

from grader.problems import Kind
from grader.xml import catalogue
from grader.xml.tinyxml2.recovery import Recovery
from grader.xml.tinyxml2.tags import MalformedTagError, NoteDifference, ReadTag, Scan, read_tag, short, skip_blank
from grader.xml.tinyxml2.values import ILLEGAL, REFERENCE, decode, escape

# A declaration that XML parsers accept. TinyXML2 ignores what it says, and always reads UTF-8.
_DECLARATION = re.compile(
    r"""xml\s+version\s*=\s*["']1\.[0-9]+["'](\s+encoding\s*=\s*["'](?i:utf-8|us-ascii)["'])?[^<>]*"""
)
_NAMESPACE = re.compile(r"xmlns:([^\s=]+)")
_MAX_DEPTH = 500  # TINYXML2_MAX_ELEMENT_DEPTH; the document itself is the first level
_MAX_WRITTEN_DEPTH = 32  # urdfdom never looks deeper than robot/link/visual/geometry/box
_MAX_ERRORS = 20


class Scanner:
    """One pass over a text. Where TinyXML2 would stop at an error, it goes on, to find other broken tags."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._xml: list[str] = []
        self._offsets: list[int] = []  # of the start tags that were written
        self._differences: list[NoteDifference] = []
        self._open_tags: list[tuple[ReadTag, bool]] = []  # each with whether it was written
        self._top_level: list[ReadTag] = []
        self._noted: set[str] = set()
        self._errors = 0
        self._only_declarations = True

    def scan(self) -> Scan:
        """Read the whole text."""
        position = self._start()
        while position is not None and self._errors < _MAX_ERRORS:
            position = self._node(position)
        first_tag = self._top_level[0].offset if self._top_level else 0
        if self._errors:
            errors = [found for found in self._differences if found.kind is not catalogue.NOT_WELL_FORMED]
            recovered = Recovery(self._text).run()
            return recovered._replace(first_tag=first_tag, differences=[*errors, *recovered.differences])
        robot = next((tag for tag in self._top_level if tag.name == "robot"), None)
        other = next((tag for tag in self._top_level if tag is not robot), None)
        if robot and other:
            message = f"ROS 2 reads the first <robot> at the top level and ignores <{short(other.name)}> beside it"
            self._add(catalogue.SEVERAL_ROOTS, message, other.offset)
        return Scan("".join(self._xml).encode(), self._offsets, first_tag, self._differences)

    def _start(self) -> int | None:
        text = self._text
        if text.startswith(("\udcff\udcfe", "\udcfe\udcff")) or "\0" in text[:4]:
            return self._refuse(catalogue.NOT_UTF8, "the file is not UTF-8 text; ROS 2 cannot read it", 0)
        end = text.find("\0")
        if end >= 0:
            self._add(catalogue.IGNORED_REST, "ROS 2 ignores everything after this NUL byte", end)
            text = self._text = text[:end]
        position = skip_blank(text, 0)
        position += text.startswith("\ufeff", position)
        if position == len(text):
            return self._refuse(catalogue.EMPTY_DOCUMENT, "the file is empty; ROS 2 rejects it", 0)
        illegal = ILLEGAL.search(text)
        if illegal:
            what = "invalid UTF-8" if illegal[0] >= "\ud800" else "a control character"
            self._differ(what, f"{what} ({illegal[0].encode('utf-8', 'surrogateescape').hex()})", illegal.start())
        return position

    def _node(self, start: int) -> int | None:
        """Read the node at this offset; return the offset after it, or None at the end."""
        text = self._text
        position = skip_blank(text, start)
        if position == len(text):
            return self._end()
        if text[position] != "<":
            return self._text_node(position)
        if text.startswith("<?", position):
            return self._declaration(position)
        self._only_declarations = False
        if text.startswith("<!", position):
            return self._markup(position)
        try:
            tag, end = read_tag(text, position, self._differ)
        except MalformedTagError as error:
            self._refuse(catalogue.MALFORMED_TAG, f"{error}; ROS 2 rejects the file", error.offset)
            return error.resume
        return self._close(tag, end) if tag.form == "close" else self._open(tag, end)

    def _markup(self, position: int) -> int | None:
        """Read a comment, a CDATA section or a DOCTYPE."""
        text = self._text
        if text.startswith("<!--", position):
            end = self._skip_to(position, "<!--", "-->", "comment")
            if end is not None and "--" in text[position + 4 : end - 2]:
                self._differ("comment", "-- inside a comment", position)
        elif text.startswith("<![CDATA[", position):
            if not self._open_tags:
                self._differ("cdata", "a CDATA section outside the robot", position)
            end = self._skip_to(position, "<![CDATA[", "]]>", "CDATA section")
            self._write(text[position + 9 : end - 3] if end is not None else "")
        else:
            end = self._skip_to(position, "<!", ">", "<!")
            if end is not None and "doctype" not in self._noted:
                entities = {"text", "reference"} if "[" in text[position:end] else set()  # XML may define them there
                self._noted |= {"doctype", *entities}
                message = "ROS 2 skips a DOCTYPE and does not expand the entities that it defines"
                self._add(catalogue.DOCTYPE, message, position)
        return end

    def _end(self) -> int | None:
        if not self._open_tags or self._errors:
            return None
        tag = self._open_tags[-1][0]
        message = f"<{short(tag.name)}> is not closed before the end of the file; ROS 2 rejects it"
        return self._refuse(catalogue.MISMATCHED_TAG, message, tag.offset)

    def _text_node(self, position: int) -> int | None:
        end = self._text.find("<", position)
        if end < 0 and self._open_tags:
            return self._end()
        if end < 0:
            message = "there is text after the robot; ROS 2 rejects the file"
            if not self._top_level:
                message = f"this is not XML: it begins with {short(self._text.strip()[:20])!r}; ROS 2 rejects the file"
            return self._refuse(catalogue.STRAY_TEXT, message, position)
        if not self._open_tags:
            self._only_declarations = False
            self._differ("text", "text outside the robot", position)
        elif reference := REFERENCE.search(self._text, position, end):
            self._differ("reference", "a bare & (write &amp;)", reference.start())
        self._write(decode(self._text[position:end]))
        return end

    def _write(self, text: str) -> None:
        """Write the text in an element."""
        if self._open_tags and self._open_tags[-1][1]:
            self._xml.append(escape(text).replace(">", "&gt;"))

    def _declaration(self, position: int) -> int | None:
        end = self._skip_to(position, "<?", "?>", "<?")
        if end is None:
            return None
        if self._open_tags or not self._only_declarations:
            message = "an XML declaration must be at the very top of the file; ROS 2 rejects the file"
            self._add(catalogue.MISPLACED_DECLARATION, message, position)  # the elements around it can be read
        elif position > 0 and not self._text.startswith("\ufeff<"):
            self._differ("declaration", "something before the XML declaration", position)
        elif not _DECLARATION.fullmatch(self._text, position + 2, end - 2):
            self._differ("declaration", "an XML declaration without a known version or encoding", position)
        return end

    def _skip_to(self, position: int, opening: str, closing: str, what: str) -> int | None:
        end = self._text.find(closing, position + len(opening))
        if end < 0:
            message = f"this {what} is not closed with {closing}; ROS 2 rejects the file"
            return self._refuse(catalogue.UNTERMINATED, message, position)
        return end + len(closing)

    def _open(self, tag: ReadTag, end: int) -> int | None:
        prefix, colon, _ = tag.name.partition(":")
        if colon and "prefix" not in self._noted and prefix not in self._prefixes:
            self._differ("prefix", f"the prefix of <{short(tag.name)}> is not declared with xmlns", tag.offset)
        depth = len(self._open_tags)
        if depth:
            is_written = depth < _MAX_WRITTEN_DEPTH and self._open_tags[-1][1]
        else:
            self._top_level.append(tag)
            is_written = tag.name == "robot" and not self._xml
        if is_written:
            self._xml.append(tag.xml)
            self._offsets.append(tag.offset)
        if tag.form == "open":
            self._open_tags.append((tag, is_written))
            if depth + 2 >= _MAX_DEPTH and not self._errors:
                return self._refuse(catalogue.TOO_DEEP, "tags are nested too deep; ROS 2 rejects the file", tag.offset)
        return end

    def _close(self, tag: ReadTag, end: int) -> int | None:
        if not self._open_tags:
            if self._errors:
                return end
            self._differ("stray", f"the closing tag </{short(tag.name)}>, which closes nothing", tag.offset)
            if skip_blank(self._text, end) < len(self._text):
                message = "ROS 2 stops reading at this closing tag, which closes nothing"
                self._add(catalogue.IGNORED_REST, message, tag.offset)
            return None
        opened, is_written = self._open_tags.pop()
        if is_written:
            self._xml.append(f"</{opened.xml_name}>")
        if opened.name != tag.name and not self._errors:
            line = self._text.count("\n", 0, opened.offset) + 1
            message = f"</{short(tag.name)}> does not match <{short(opened.name)}> in line {line}"
            self._refuse(catalogue.MISMATCHED_TAG, f"{message}; ROS 2 rejects the file", tag.offset)
        return end

    @cached_property
    def _prefixes(self) -> set[str]:
        return set(_NAMESPACE.findall(self._text))

    def _add(self, kind: Kind, message: str, offset: int) -> None:
        self._differences.append(NoteDifference(kind, message, offset))

    def _refuse(self, kind: Kind, message: str, offset: int) -> int | None:
        """Add an error; return None, for callers that cannot go on."""
        self._errors += 1
        self._add(kind, message, offset)
        return None

    def _differ(self, key: str, what: str, offset: int) -> None:
        if key not in self._noted:
            self._noted.add(key)
            self._add(catalogue.NOT_WELL_FORMED, f"ROS 2 accepts this, but it is not well-formed XML: {what}", offset)
