"""TinyXML2's dialect of XML, brought into XML's form so that lxml can read it.

ROS 2 reads URDF with TinyXML2, which accepts much that XML forbids and refuses a little that XML allows
(`tinyxml2.cpp`: Identify, ParseDeep, ParseAttributes, GetStr). A URDF's meaning is in its tags and attributes alone, so the
translation keeps these, in order, and leaves out text, comments and declarations. Nothing else in the project knows of
the dialect.
"""

import re
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from grader.robot import catalogue
from grader.robot.catalogue import Kind

_SPACE = " \t\n\v\f\r"
_BLANK = re.compile(r"[ \t\n\v\f\r]*")
_NAME = re.compile(r"[A-Za-z_:\u0080-\U0010ffff][A-Za-z0-9_:.\-\u0080-\U0010ffff]*")
_PLAIN_NAME = re.compile(r"(?!(?i:xml))[A-Za-z_][A-Za-z0-9_.\-]*")
_DECLARATION = re.compile(r"""\s+version\s*=\s*["']1\.[0-9]+["'](\s+encoding\s*=\s*["'](?i:utf-8|us-ascii)["'])?[^<>]*""")
_REFERENCE = re.compile(r"&(?!(?:amp|lt|gt|quot|apos|#[0-9]+|#x[0-9a-fA-F]+);)")
_ILLEGAL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_ENTITIES = {b"quot;": b'"', b"amp;": b"&", b"apos;": b"'", b"lt;": b"<", b"gt;": b">"}
_CHARACTER = re.compile(rb"#(?:x(?:[^;]*x)?([0-9a-fA-F]*)|(?!x)(?:[^;]*#)?([0-9]*));")
_ESCAPES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;", "\v": "&#9;", "\f": "&#9;"}
)
_MAX_DEPTH = 500  # TINYXML2_MAX_ELEMENT_DEPTH; the document itself is the first level
_KEPT_DEPTH = 32  # urdfdom never looks deeper than robot/link/visual/geometry/box
_MOST_ERRORS = 20
_LONGEST_NAME = 60
_AMPERSAND = ord("&")
_FIRST_SURROGATE, _LAST_SURROGATE, _LAST_CODE_POINT, _FIVE_BYTES = 0xD800, 0xDFFF, 0x10FFFF, 0x200000

# lxml turns a line break or tab in a value into a space, TinyXML2 keeps it.
_BROKEN_VALUE = re.compile(rb"""=[ \t\r\n]*(?:"[^"\n\r\t]*[\n\r\t]|'[^'\n\r\t]*[\n\r\t])""")
_DEFAULT_NAMESPACE = re.compile(rb"xmlns[ \t\r\n]*=")
_PLAIN_START = re.compile(
    rb"""(?:\xef\xbb\xbf)?(?!<\?|\xff\xfe|\xfe\xff)|<\?xml\s+version\s*=\s*["']1\.0["'](?:\s+encoding\s*=\s*["'](?i:utf-8)["'])?\s*\?>"""
)


class Finding(NamedTuple):
    """A difference or an error at a character offset."""

    kind: Kind
    message: str
    offset: int


class Tag(NamedTuple):
    """One tag as TinyXML2 sees it; attribute values are decoded."""

    name: str
    form: Literal["open", "close", "empty"]
    attributes: dict[str, str]
    offset: int


@dataclass(slots=True)
class Scan:
    """A text read by TinyXML2's rules: the tags of its first top-level <robot>, or why there are none."""

    xml: bytes = b""
    offsets: list[int] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)


def is_plain(data: bytes) -> bool:
    """Whether a text that lxml accepts means the same to TinyXML2: then no translation is needed."""
    return (
        b"\0" not in data
        and data.find(b"<?", 1) < 0
        and data.count(b"<!") == data.count(b"<!--")
        and _PLAIN_START.match(data) is not None
        and _BROKEN_VALUE.search(data) is None
        and (b"xmlns" not in data or _DEFAULT_NAMESPACE.search(data) is None)
    )


def translate(text: str) -> Scan:
    """Read a text by TinyXML2's rules and write its first <robot> as XML, with the offset of every tag kept."""
    return _Scanner(text).scan()


class _Malformed(Exception):
    def __init__(self, message: str, offset: int, resume: int) -> None:
        super().__init__(message)
        self.offset = offset
        self.resume = resume


class _Scanner:
    def __init__(self, text: str) -> None:
        self.text = text
        self.scanned = Scan()
        self.out: list[str] = []
        self.stack: list[tuple[Tag, str]] = []  # the open tags, each with the name under which it was written, if it was
        self.top_level: list[Tag] = []
        self.noted: set[str] = set()
        self.errors = 0
        self.only_declarations = True

    def scan(self) -> Scan:
        position = self._start()
        while position is not None and self.errors < _MOST_ERRORS:
            position = self._node(position)
        scanned = self.scanned
        if self.errors:
            scanned.findings = [each for each in scanned.findings if each.kind is not catalogue.NOT_WELL_FORMED]
        else:
            self._note_roots()
            scanned.xml = "".join(self.out).encode()
        return scanned

    def _start(self) -> int | None:
        text = self.text
        if text.startswith(("\udcff\udcfe", "\udcfe\udcff")) or "\0" in text[:4]:
            return self._refuse(catalogue.NOT_UTF8, "this is not UTF-8 text; ROS 2 cannot read it", 0)
        end = text.find("\0")
        if end >= 0:
            self._find(catalogue.IGNORED_REST, "ROS 2 reads only up to this NUL byte", end)
            text = self.text = text[:end]
        position = self._skip(0)
        if text.startswith("\ufeff", position):
            position += 1
        if position == len(text):
            return self._refuse(catalogue.EMPTY_DOCUMENT, "the file is empty; ROS 2 loads nothing", 0)
        illegal = _ILLEGAL.search(text)
        if illegal:
            what = "invalid UTF-8" if illegal[0] >= "\ud800" else "a control character"
            self._dialect(what, f"{what} ({illegal[0].encode('utf-8', 'surrogateescape').hex()})", illegal.start())
        return position

    def _node(self, start: int) -> int | None:
        """Read what stands at this offset; the offset behind it, or None at the end."""
        text = self.text
        position = self._skip(start)
        if position == len(text):
            return self._end(position)
        if text[position] != "<":
            return self._text(position)
        if text.startswith("<?", position):
            return self._declaration(position)
        if text.startswith("<!", position):
            return self._markup(position)
        self.only_declarations = False
        try:
            tag, end = self._tag(position)
        except _Malformed as error:
            self._refuse(catalogue.MALFORMED_TAG, f"{error}; ROS 2 loads nothing of the file", error.offset)
            return error.resume
        return self._place(tag, end)

    def _end(self, position: int) -> None:
        if self.stack and not self.errors:
            tag = self.stack[-1][0]
            message = f"<{_short(tag.name)}> is never closed: the file ends first; ROS 2 loads nothing"
            self._refuse(catalogue.MISMATCHED_TAG, message, tag.offset)

    def _text(self, position: int) -> int | None:
        end = self.text.find("<", position)
        if not self.stack:
            if end < 0:
                message = "there is text behind the end of the robot; ROS 2 loads nothing"
                return self._refuse(catalogue.STRAY_TEXT, message, position)
            self.only_declarations = False
            self._dialect("text outside", "text outside the robot", position)
        elif end < 0:
            return self._end(position)
        else:
            reference = _REFERENCE.search(self.text, position, end)
            if reference:
                self._dialect("reference", "a bare & (it is written &amp;)", reference.start())
        return end

    def _declaration(self, position: int) -> int | None:
        end = self.text.find("?>", position + 2)
        if end < 0:
            return self._refuse(catalogue.UNTERMINATED, "this <? is never closed with ?>; ROS 2 loads nothing", position)
        if self.stack or not self.only_declarations:
            message = "an XML declaration may stand only at the very top of the file; ROS 2 loads nothing"
            self._refuse(catalogue.MISPLACED_DECLARATION, message, position)
            return end + 2
        content = self.text[position + 2 : end]
        if position > 0 and not self.text.startswith("\ufeff<"):
            self._dialect("declaration", "something before the XML declaration", position)
        elif not content.startswith("xml") or not _DECLARATION.fullmatch(content, 3):
            self._dialect("declaration", "an XML declaration without a known version or encoding", position)
        return end + 2

    def _markup(self, position: int) -> int | None:
        text = self.text
        self.only_declarations = False
        for opening, closing, what in (("<!--", "-->", "comment"), ("<![CDATA[", "]]>", "CDATA section"), ("<!", ">", "<!")):
            if text.startswith(opening, position):
                break
        content = position + len(opening)
        end = text.find(closing, content)
        if end < 0:
            message = f"this {what} is never closed with {closing}; ROS 2 loads nothing"
            return self._refuse(catalogue.UNTERMINATED, message, position)
        if what == "comment" and ("--" in text[content:end] or text[end - 1 : end] == "-" and end > content):
            self._dialect("comment", "-- inside a comment", position)
        elif what == "CDATA section" and not self.stack:
            self._dialect("cdata", "a CDATA section outside the robot", position)
        elif what == "<!":
            message = "ROS 2 skips a DOCTYPE and leaves the entities that it defines as they stand"
            self._find(catalogue.DOCTYPE, message, position)
        return end + len(closing)

    def _tag(self, start: int) -> tuple[Tag, int]:
        text = self.text
        position = self._skip(start + 1)
        closing = text.startswith("/", position)
        if position > start + 1:
            self._dialect("space", "white space behind <", start)
        name = _NAME.match(text, position + closing)
        if name is None:
            raise _Malformed("a tag's name must follow < at once", start, self._behind(start))
        position = name.end()
        attributes: dict[str, str] = {}
        while True:
            at = self._skip(position)
            if text.startswith(">", at):
                form: Literal["open", "close", "empty"] = "close" if closing else "open"
                end = at + 1
                break
            if text.startswith("/>", at):
                form, end = "empty", at + 2
                break
            found = _NAME.match(text, at)
            if found is None:
                raise self._misfit(start, at, name[0], attributes)
            if at == position and attributes:
                self._dialect("attributes", "no space between two attributes", at)
            value, position = self._attribute(start, found, name[0])
            if found[0] in attributes:
                message = f"the attribute {_short(found[0])!r} is given twice in <{_short(name[0])}>"
                raise _Malformed(message, at, self._behind(position))
            attributes[found[0]] = value
        if closing and (attributes or form == "empty"):
            self._dialect("closing", "a closing tag with more than its name", start)
        prefix, colon, _ = name[0].partition(":")
        if colon and f"xmlns:{prefix}" not in text:
            self._dialect("prefix", f"the prefix of <{_short(name[0])}> is not declared with xmlns", start)
        return Tag(name[0], form, attributes, start), end

    def _attribute(self, start: int, found: re.Match[str], tag: str) -> tuple[str, int]:
        text = self.text
        at = self._skip(found.end())
        shown = _short(found[0])
        if not text.startswith("=", at):
            message = f"<{_short(tag)}> holds {shown!r} without ="
            raise _Malformed(message, found.start(), self._behind(found.end()))
        at = self._skip(at + 1)
        quote = text[at : at + 1]
        if quote not in ('"', "'"):
            message = f"the value of {shown!r} in <{_short(tag)}> is not in plain quotes"
            raise _Malformed(message, found.start(), self._behind(at))
        end = text.find(quote, at + 1)
        if end < 0:
            message = f"the quote of {shown!r} in <{_short(tag)}> is never closed"
            raise _Malformed(message, found.start(), self._behind(at))
        raw = text[at + 1 : end]
        if "<" in raw:
            self._dialect("less", "< inside a value (it is written &lt;)", found.start())
        if "&" in raw and _REFERENCE.search(raw):
            self._dialect("reference", "a bare & or an unknown entity (& is written &amp;)", found.start())
        return _decode(raw), end + 1

    def _misfit(self, start: int, at: int, name: str, attributes: dict[str, str]) -> _Malformed:
        """The error for what stands where an attribute should: said of the likely culprit."""
        text = self.text
        shown = _short(name)
        resume = self._behind(at)
        if at == len(text):
            return _Malformed(f"the file ends inside the tag <{shown}>", start, at)
        swallowed = next((each for each, value in attributes.items() if "\n" in value and "<" in value), None)
        if swallowed:
            line_end = text.find("\n", start)
            message = f"the quote of {_short(swallowed)!r} in <{shown}> is not closed before the next tag"
            return _Malformed(message, start, max(line_end, start + 1))
        match text[at]:
            case "=":
                message = f"<{shown}= has no attribute name: a value belongs to a name, as in <{shown} name="
            case ",":
                message = f"a comma stands between the attributes of <{shown}>; a space is enough"
            case "<":
                message = f"<{shown}> is not closed with > before the next tag"
                resume = at
            case _:
                word = text[at : at + 12].split(" ")[0]
                message = f"{word!r} in <{shown}> is not an attribute"
        return _Malformed(message, at if text[at] not in "=<" else start, resume)

    def _place(self, tag: Tag, end: int) -> int | None:
        """Put a tag into the tree; the offset behind it, or None where TinyXML2 stops."""
        if tag.form == "close":
            return self._close(tag, end)
        written = self._write(tag)
        if tag.form == "open":
            self.stack.append((tag, written))
            if len(self.stack) + 1 >= _MAX_DEPTH and not self.errors:
                message = "tags are nested too deep for ROS 2, which loads nothing"
                return self._refuse(catalogue.TOO_DEEP, message, tag.offset)
        return end

    def _close(self, tag: Tag, end: int) -> int | None:
        if not self.stack:
            return end if self.errors else self._stop(tag, end)
        opened, written = self.stack.pop()
        if written:
            self.out.append(f"</{written}>")
        if opened.name != tag.name and not self.errors:
            line = self.text.count("\n", 0, opened.offset) + 1
            still_open = f"<{_short(opened.name)}> of line {line} is still open"
            message = f"</{_short(tag.name)}> stands where {still_open}; ROS 2 loads nothing"
            self._refuse(catalogue.MISMATCHED_TAG, message, tag.offset)
        return end

    def _write(self, tag: Tag) -> str:
        """Write a tag of the first top-level <robot> as XML; its name there, or nothing for what is left out."""
        if self.stack:
            wanted = self.stack[-1][1] != "" and len(self.stack) < _KEPT_DEPTH
        else:
            wanted = tag.name == "robot" and not self.out
            self.top_level.append(tag)
        if not wanted:
            return ""
        self.scanned.offsets.append(tag.offset)
        name = tag.name if _is_plain_name(tag.name) else "_"
        values = "".join(f' {each}="{_escape(value)}"' for each, value in tag.attributes.items() if _is_plain_name(each))
        self.out.append(f"<{name}{values}{'>' if tag.form == 'open' else '/>'}")
        return name

    def _stop(self, tag: Tag, end: int) -> None:
        self._dialect("stray", f"the closing tag </{_short(tag.name)}>, which closes nothing", tag.offset)
        if self.text[end:].strip(_SPACE):
            self._find(catalogue.IGNORED_REST, "ROS 2 stops reading at this closing tag, which closes nothing", tag.offset)

    def _note_roots(self) -> None:
        robot = next((tag for tag in self.top_level if tag.name == "robot"), None)
        other = next((tag for tag in self.top_level if tag is not robot), None)
        if robot and other:
            message = f"ROS 2 takes the first <robot> at the top level and ignores <{_short(other.name)}> beside it"
            self._find(catalogue.SEVERAL_ROOTS, message, other.offset)

    def _skip(self, position: int) -> int:
        match = _BLANK.match(self.text, position)
        return match.end() if match else position

    def _behind(self, position: int) -> int:
        """Where to go on behind a broken tag: after its > or before the next <."""
        closed, opened = self.text.find(">", position), self.text.find("<", position + 1)
        if closed >= 0 and (opened < 0 or closed < opened):
            return closed + 1
        return opened if opened >= 0 else len(self.text)

    def _find(self, kind: Kind, message: str, offset: int) -> None:
        self.scanned.findings.append(Finding(kind, message, offset))

    def _refuse(self, kind: Kind, message: str, offset: int) -> None:
        self.errors += 1
        self._find(kind, message, offset)

    def _dialect(self, key: str, what: str, offset: int) -> None:
        if key not in self.noted:
            self.noted.add(key)
            message = f"ROS 2 loads this, but it is not well-formed XML: {what}"
            self._find(catalogue.NOT_WELL_FORMED, message, offset)


def _decode(raw: str) -> str:
    """An attribute's value as TinyXML2's StrPair::GetStr gives it, up to the first NUL."""
    if "\r" in raw or "\n" in raw:
        raw = re.sub("\r\n|\n\r|\r", "\n", raw)
    if "&" not in raw:
        return raw
    source = raw.encode("utf-8", "surrogateescape")
    target = bytearray(source)  # TinyXML2 decodes in place: what it passes over without writing stays as it was
    read = write = 0
    while read < len(source):
        if source[read] != _AMPERSAND:
            target[write] = source[read]
            read, write = read + 1, write + 1
            continue
        piece, width = _reference(source, read)
        if piece is not None:
            target[write : write + len(piece)] = piece
        read, write = read + width, write + (1 if piece is None else len(piece))
    return bytes(target[:write]).split(b"\0")[0].decode("utf-8", "surrogateescape")


def _reference(source: bytes, at: int) -> tuple[bytes | None, int]:
    """What an & stands for (None: it is passed over), and how many bytes it takes (`XMLUtil::GetCharacterRef`)."""
    for name, value in _ENTITIES.items():
        if source.startswith(name, at + 1):
            return value, len(name) + 1
    if not source.startswith(b"#", at + 1):
        return None, 1
    if len(source) == at + 2:
        return b"", 1
    found = _CHARACTER.match(source, at + 1)
    if found is None:
        return b"&", 1
    code = _code_point(found[2] if found[1] is None else found[1], 10 if found[1] is None else 16)
    return _encoded(code), len(found[0]) + 1


def _code_point(digits: bytes, radix: int) -> int:
    # TinyXML2 10 multiplies in 32 bits and adds in 64, so that very long numbers come out as others.
    code, factor = 0, 1
    for digit in reversed(digits):
        code += factor * int(chr(digit), radix) % 2**32
        factor = factor * radix % 2**32
    return code


def _encoded(code: int) -> bytes:
    """UTF-8, past the last code point and over surrogates as well; nothing for what takes more than four bytes."""
    if code < _FIRST_SURROGATE or _LAST_SURROGATE < code <= _LAST_CODE_POINT:
        return chr(code).encode()
    if code < _LAST_CODE_POINT:
        return chr(code).encode("utf-8", "surrogatepass")
    if code < _FIVE_BYTES:
        return bytes((0xF0 | code >> 18, 0x80 | code >> 12 & 0x3F, 0x80 | code >> 6 & 0x3F, 0x80 | code & 0x3F))
    return b""


def _is_plain_name(name: str) -> bool:
    # Names that XML or lxml may refuse never mean anything to urdfdom; the longest that does has 17 letters.
    return len(name) < _LONGEST_NAME and _PLAIN_NAME.fullmatch(name) is not None


def _escape(value: str) -> str:
    """A value between double quotes in XML; what XML cannot hold is spelt out, so that names stay apart."""
    return _ILLEGAL.sub(_spell, value.translate(_ESCAPES))


def _spell(match: re.Match[str]) -> str:
    code = ord(match[0])
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    return chr(0x2400 + code) if code < 0x20 else f"\\u{code:04x}"


def _short(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."
