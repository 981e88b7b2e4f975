"""The TinyXML2 dialect of XML, translated into well-formed XML for lxml.

ROS 2 reads URDF with TinyXML2, which accepts much that XML forbids and rejects a little that XML
allows. A URDF's meaning is in its tags and attributes, so the translation keeps these, in order,
and the text in elements, which simulators read; it omits comments and declarations. The functions
are named after those of `tinyxml2.cpp` whose rules they follow: `StrPair::GetStr`,
`XMLElement::ParseAttributes`, `XMLDocument::Identify`, `XMLNode::ParseDeep`.
"""

import re
from collections.abc import Callable
from functools import cached_property
from typing import Literal, NamedTuple

from grader.base.patterns import on_use
from grader.base.problems import Kind
from grader.base.text import ILLEGAL, cut
from grader.ros.xml import xml_problems
from grader.ros.xml.urdf_format import TAGS

_Attributes = dict[str, str]

# --- Attribute values

_ENTITIES = {b"quot;": b'"', b"amp;": b"&", b"apos;": b"'", b"lt;": b"<", b"gt;": b">"}
_KNOWN_REFERENCE = on_use(rb"&(?:(quot;|amp;|apos;|lt;|gt;)|#)")
_DECIMAL = b"0123456789"
_HEXADECIMAL = b"0123456789abcdefABCDEF"
_LAST_CODE_POINT = 0x10FFFF
_FIVE_BYTES = 0x200000
_ESCAPES = str.maketrans(
    {
        "&": "&amp;",
        "<": "&lt;",
        '"': "&quot;",
        "\t": "&#9;",
        "\n": "&#10;",
        "\r": "&#13;",
        "\v": "&#9;",
        "\f": "&#9;",
    }
)

# A bare & or an entity that XML does not define.
_BARE_AMPERSAND = on_use(r"&(?!(?:amp|lt|gt|quot|apos|#[0-9]+|#x[0-9a-fA-F]+);)")


def decode(raw: str) -> str:
    """Return an attribute's value as TinyXML2's StrPair::GetStr does, up to the first NUL."""
    if "\r" in raw or "\n" in raw:
        raw = re.sub("\r\n|\n\r|\r", "\n", raw)
    if "&" not in raw:
        return raw
    source = raw.encode("utf-8", "surrogateescape")
    references = _References(source)
    decoded = bytearray()
    read = 0
    while match := _KNOWN_REFERENCE.search(source, read):
        _copy(source, read, match.start(), decoded)
        piece, width = (
            (_ENTITIES[match[1]], len(match[0])) if match[1] else references.at(match.start())
        )
        decoded += piece
        read = match.start() + width
    _copy(source, read, len(source), decoded)
    return bytes(decoded).split(b"\0")[0].decode("utf-8", "surrogateescape")


def _copy(source: bytes, start: int, end: int, decoded: bytearray) -> None:
    """Append the text between two references.

    TinyXML2 decodes in place and skips an & that begins no reference without writing it: the byte
    that was there stays.
    """
    write = len(decoded)
    decoded += source[start:end]
    if write == start:
        return
    at = source.find(b"&", start, end)
    while at >= 0:
        decoded[write + at - start] = source[write + at - start]
        at = source.find(b"&", at + 1, end)


class _References:
    """The characters that each &# of a value refers to, asked from left to right.

    They are those of `XMLUtil::GetCharacterRef`.

    A numeric reference extends to the next semicolon, and its digits are read backwards from there.
    """

    def __init__(self, source: bytes) -> None:
        self._source = source
        self._semicolon = -1
        # The offset of the digits before the semicolon, and their value.
        self._hexadecimal: tuple[int, int] | None = None
        self._decimal: tuple[int, int] | None = None

    def at(self, offset: int) -> tuple[bytes, int]:
        """Return the bytes that the &# at this offset refers to.

        Also return how many bytes it takes itself.
        """
        source = self._source
        if len(source) == offset + 2:
            return b"", 1
        if self._semicolon < offset:
            semicolon = source.find(b";", offset)
            self._semicolon = semicolon if semicolon >= 0 else len(source)
            self._hexadecimal = self._decimal = None
        if self._semicolon == len(source):
            return b"&", 1
        if source.startswith(b"x", offset + 2):
            self._hexadecimal = self._hexadecimal or self._number(_HEXADECIMAL, 16)
            first, code = self._hexadecimal
            complete = first > offset + 2 and source[first - 1 : first] == b"x"
        else:
            self._decimal = self._decimal or self._number(_DECIMAL, 10)
            first, code = self._decimal
            complete = first > offset + 1 and source[first - 1 : first] == b"#"
        if complete:
            return (_encode(code), self._semicolon + 1 - offset)
        return (b"&", 1)

    def _number(self, digits: bytes, radix: int) -> tuple[int, int]:
        # TinyXML2 10 multiplies in 32 bits and adds in 64, so very long numbers overflow.
        first = self._semicolon
        code = 0
        factor = 1
        while first > 0 and self._source[first - 1] in digits:
            first -= 1
            code += factor * int(chr(self._source[first]), radix) % 2**32
            factor = factor * radix % 2**32
        return first, code


def _encode(code: int) -> bytes:
    """Return a code point as UTF-8, as TinyXML2 does for surrogates and beyond the last.

    Returns nothing for one over four bytes.
    """
    if code <= _LAST_CODE_POINT:
        return chr(code).encode("utf-8", "surrogatepass")
    if code < _FIVE_BYTES:
        return bytes(
            (
                0xF0 | code >> 18,
                0x80 | code >> 12 & 0x3F,
                0x80 | code >> 6 & 0x3F,
                0x80 | code & 0x3F,
            )
        )
    return b""


def escape(value: str) -> str:
    """Return a value for double quotes in XML.

    Characters that XML forbids are spelt out, so that names differ.
    """
    return ILLEGAL.sub(_spell, value.translate(_ESCAPES))


def _spell(match: re.Match[str]) -> str:
    code = ord(match[0])
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    if code < 0x20:
        return chr(0x2400 + code)
    return f"\\u{code:04x}"


# --- Tags

_Note = Callable[
    [str, str, int], None
]  # the kind of a difference from XML, its description and its offset

_BLANK = on_use(r"[ \t\n\v\f\r]*")
# A letter, _, : or a character that is not ASCII, then also digits, . and -; as what is not in it,
# because a set of all other characters of Unicode takes 5 ms to compile.
_NAME = on_use(r"[^\0-9;-@\[-^`{-\x7f][^\0-,/;-@\[-^`{-\x7f]*")
_PLAIN_NAME = on_use(r"(?!(?i:xml))[A-Za-z_][A-Za-z0-9_.\-]*")
MAX_NAME_LENGTH = 60  # the longest name that urdfdom knows has 17 letters


class Tag(NamedTuple):
    """One tag; attribute values are decoded.

    Names that XML or lxml may refuse are `_`: urdfdom ignores them anyway.
    """

    name: str
    form: Literal["open", "close", "empty"]
    attributes: _Attributes
    offset: int

    @property
    def xml_name(self) -> str:
        """Its name in XML, which may have a prefix."""
        if all(map(_is_plain, self.name.split(":", 1))):
            return self.name
        return "_"

    @property
    def xml(self) -> str:
        """A start tag as XML, without attributes that mean nothing to urdfdom."""
        values = "".join(
            f' {key}="{escape(value)}"' for key, value in self.attributes.items() if _is_plain(key)
        )
        prefix, colon, _ = self.xml_name.partition(":")
        declared = f' xmlns:{prefix}="{prefix}"' if colon else ""
        return f"<{self.xml_name}{declared}{values}{'>' if self.form == 'open' else '/>'}"


class Difference(NamedTuple):
    """A difference from XML, an error, or what was assumed about one, at a character offset.

    `subject` is the tag of which a part cannot be read, or what is not well-formed in a few words.
    """

    kind: Kind
    message: str
    offset: int
    subject: str = ""


class Scan(NamedTuple):
    """The first top-level <robot> as XML, with the offset of each of its start tags.

    Both are empty if there is none.

    They are empty as well if TinyXML2 refuses the text: `is_refused`. The XML has no comments, and
    a prefix stands for its namespace.
    """

    xml: bytes
    offsets: list[int]
    first_tag: int
    differences: list[Difference]
    is_refused: bool = False


class MalformedTagError(Exception):
    """A tag that TinyXML2 rejects, with the offset of the error.

    It also has the offset at which reading can go on.
    """

    def __init__(self, message: str, offset: int, resume: int) -> None:
        super().__init__(message)
        self.offset = offset
        self.resume = resume


def _is_plain(name: str) -> bool:
    return len(name) < MAX_NAME_LENGTH and _PLAIN_NAME.fullmatch(name) is not None


def _skip_blank(text: str, position: int) -> int:
    """Return the first offset from here on that is not white space, as C's isspace defines it."""
    match = _BLANK.match(text, position)
    return match.end() if match else position


def read_tag(text: str, start: int, note: _Note) -> tuple[Tag, int]:
    """Return the tag whose < is at `start`, and the offset after it; raises MalformedTagError."""
    position = _skip_blank(text, start + 1)
    if position > start + 1:
        note("space", "white space after <", start)
    closing = text.startswith("/", position)
    match = _NAME.match(text, position + 1 if closing else position)
    if not match:
        raise MalformedTagError("there is no tag name after <", start, _resume_after(text, start))
    name = match[0]
    attributes, position = _read_attributes(text, start, match.end(), name, note)
    form: Literal["open", "close", "empty"] = "close" if closing else "open"
    if text.startswith("/", position):
        form = "empty"
        position = position + 1
    if closing and (attributes or form == "empty"):
        note("closing", "a closing tag with more than its name", start)
    return Tag(name, form, attributes, start), position + 1


def _resume_after(text: str, position: int) -> int:
    """Return the offset at which to go on after a malformed tag.

    This is after its > or before the next <.
    """
    closed = text.find(">", position)
    opened = text.find("<", position + 1)
    if closed >= 0 and (opened < 0 or closed < opened):
        return closed + 1
    return opened if opened >= 0 else len(text)


def short(text: str) -> str:
    """Return a name for a message, cut where it is very long.

    Bytes that are not UTF-8 are spelt out.
    """
    return cut(text, 40).encode("utf-8", "backslashreplace").decode()


def _read_attributes(
    text: str, start: int, position: int, tag: str, note: _Note
) -> tuple[_Attributes, int]:
    """Return the attributes of a tag, and the offset of the > or /> that ends it."""
    attributes: _Attributes = {}
    while True:
        at = _skip_blank(text, position)
        if text.startswith((">", "/>"), at):
            return attributes, at
        try:
            end = _read_attribute(text, start, at, tag, attributes, note)
        except MalformedTagError as error:
            raise _unclosed_quote(text, start, tag, attributes) or error from None
        if at == position and len(attributes) > 1:
            note("attributes", "no space between two attributes", at)
        position = end


def _unclosed_quote(
    text: str, start: int, tag: str, attributes: _Attributes
) -> MalformedTagError | None:
    """Return the likelier error for a value that contains the next tag.

    Then its quote is not closed.
    """
    unclosed = next(
        (name for name, value in attributes.items() if "\n" in value and "<" in value), None
    )
    if unclosed is None:
        return None
    message = (
        f"the quote of {short(unclosed)!r} in <{short(tag)}> is not closed before the next tag"
    )
    return MalformedTagError(message, start, max(text.find("\n", start), start + 1))


def _read_attribute(
    text: str, start: int, position: int, tag: str, attributes: _Attributes, note: _Note
) -> int:
    """Add the attribute at this offset to the others; return the offset after it."""
    name = _NAME.match(text, position)
    if not name:
        raise _misfit(text, start, position, tag)
    shown = f"{short(name[0])!r} in <{short(tag)}>"
    offset = name.start()
    at = _skip_blank(text, name.end())
    if not text.startswith("=", at):
        message = f"the attribute {short(name[0])!r} of <{short(tag)}> has no value"
        raise MalformedTagError(message, offset, _resume_after(text, name.end()))
    at = _skip_blank(text, at + 1)
    quote = text[at : at + 1]
    if quote not in ('"', "'"):
        raise MalformedTagError(
            f"the value of {shown} is not in straight quotes", offset, _resume_after(text, at)
        )
    end = text.find(quote, at + 1)
    if end < 0:
        raise MalformedTagError(
            f"the quote of {shown} is not closed", offset, _resume_after(text, at)
        )
    raw = text[at + 1 : end]
    if "<" in raw:
        note("less", "< inside a value (write &lt;)", offset)
    if "&" in raw and _BARE_AMPERSAND.search(raw):
        note("reference", "a bare & or an unknown entity (write &amp;)", offset)
    if name[0] in attributes:
        message = f"duplicate attribute {short(name[0])!r} in <{short(tag)}>"
        raise MalformedTagError(message, offset, _resume_after(text, end + 1))
    attributes[name[0]] = decode(raw)
    return end + 1


def _misfit(text: str, start: int, at: int, name: str) -> MalformedTagError:
    """Return the error for something that is not an attribute, with its likely cause."""
    shown = short(name)
    if at == len(text):
        return MalformedTagError(f"the file ends inside the tag <{shown}>", start, at)
    match text[at]:
        case "=":
            main = next(iter(TAGS[name].attributes), "name") if name in TAGS else "name"
            message = f'<{shown}= has no attribute name; write <{shown} {main}="...">'
            return MalformedTagError(message, start, _resume_after(text, at))
        case "<":
            return MalformedTagError(
                f"<{shown}> is not closed with > before the next tag", start, at
            )
        case ",":
            message = (
                f"there is a comma between the attributes of <{shown}>; separate them with spaces"
            )
        case _:
            word = text[at : at + 12].split(" ", maxsplit=1)[0]
            message = f"{word!r} in <{shown}> is not an attribute"
    return MalformedTagError(message, at, _resume_after(text, at))


# --- Documents

# A declaration that XML parsers accept. TinyXML2 ignores what it says, and always reads UTF-8.
_DECLARATION = on_use(
    r"""xml\s+version\s*=\s*["']1\.[0-9]+["'](\s+encoding\s*=\s*["'](?i:utf-8|us-ascii)["'])?[^<>]*"""
)
_NAMESPACE = on_use(r"xmlns:([^\s=]+)")
_MAX_DEPTH = 500  # TINYXML2_MAX_ELEMENT_DEPTH; the document itself is the first level
_MAX_WRITTEN_DEPTH = 32  # urdfdom never looks deeper than robot/link/visual/geometry/box
_MAX_ERRORS = 20


def scan(text: str) -> Scan:
    """Return the first robot of a text as XML, or why TinyXML2 refuses the text."""
    return _Scanner(text).scan()


class _Scanner:
    """One pass over a text.

    Where TinyXML2 would stop at an error, it goes on, to find other broken tags.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        self._xml: list[str] = []
        self._offsets: list[int] = []  # of the start tags that were written
        self._differences: list[Difference] = []
        self._open_tags: list[tuple[Tag, bool]] = []  # each with whether it was written
        self._top_level: list[Tag] = []
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
            errors = [
                difference
                for difference in self._differences
                if difference.kind is not xml_problems.NOT_WELL_FORMED
            ]
            return Scan(b"", [], first_tag, errors, is_refused=True)
        self._note_other_roots()
        return Scan("".join(self._xml).encode(), self._offsets, first_tag, self._differences)

    def _note_other_roots(self) -> None:
        """Note the first tag at the top level besides the <robot> that ROS 2 reads."""
        robot = next((tag for tag in self._top_level if tag.name == "robot"), None)
        other = next((tag for tag in self._top_level if tag is not robot), None)
        if robot and other:
            message = (
                "ROS 2 reads the first <robot> at the top level and ignores "
                f"<{short(other.name)}> beside it"
            )
            self._add(xml_problems.SEVERAL_ROOTS, message, other.offset)

    def _start(self) -> int | None:
        text = self._text
        if text.startswith(("\udcff\udcfe", "\udcfe\udcff")) or "\0" in text[:4]:
            return self._refuse(
                xml_problems.NOT_UTF8, "the file is not UTF-8 text; ROS 2 cannot read it", 0
            )
        end = text.find("\0")
        if end >= 0:
            self._add(
                xml_problems.IGNORED_REST, "ROS 2 ignores everything after this NUL byte", end
            )
            text = self._text = text[:end]
        position = _skip_blank(text, 0)
        if text.startswith("\ufeff", position):
            position += 1
        if position == len(text):
            return self._refuse(
                xml_problems.EMPTY_DOCUMENT, "the file is empty; ROS 2 rejects it", 0
            )
        illegal = ILLEGAL.search(text)
        if illegal:
            what = "invalid UTF-8" if illegal[0] >= "\ud800" else "a control character"
            self._differ(
                what,
                f"{what} ({illegal[0].encode('utf-8', 'surrogateescape').hex()})",
                illegal.start(),
            )
        return position

    def _node(self, start: int) -> int | None:
        """Read the node at this offset; return the offset after it, or None at the end."""
        text = self._text
        position = _skip_blank(text, start)
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
            self._refuse(
                xml_problems.MALFORMED_TAG, f"{error}; ROS 2 rejects the file", error.offset
            )
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
                entities = (
                    {"text", "reference"} if "[" in text[position:end] else set()
                )  # XML may define them there
                self._noted |= {"doctype", *entities}
                message = "ROS 2 skips a DOCTYPE and does not expand the entities that it defines"
                if text.startswith("<!-", position):
                    message = "a comment begins with <!--, not with <!-; ROS 2 skips it up to its >"
                self._add(xml_problems.DOCTYPE, message, position)
        return end

    def _end(self) -> int | None:
        if not self._open_tags or self._errors:
            return None
        tag = self._open_tags[-1][0]
        message = f"<{short(tag.name)}> is not closed before the end of the file; ROS 2 rejects it"
        return self._refuse(xml_problems.MISMATCHED_TAG, message, tag.offset)

    def _text_node(self, position: int) -> int | None:
        end = self._text.find("<", position)
        if end < 0 and self._open_tags:
            return self._end()
        if end < 0:
            message = "there is text after the robot; ROS 2 rejects the file"
            if not self._top_level:
                message = (
                    f"this is not XML: it begins with {short(self._text.strip()[:20])!r}; ROS 2 "
                    "rejects the file"
                )
            return self._refuse(xml_problems.STRAY_TEXT, message, position)
        if not self._open_tags:
            self._only_declarations = False
            self._differ("text", "text outside the robot", position)
        elif reference := _BARE_AMPERSAND.search(self._text, position, end):
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
            message = (
                "an XML declaration must be at the very top of the file; ROS 2 rejects the file"
            )
            self._add(
                xml_problems.MISPLACED_DECLARATION, message, position
            )  # the elements around it can be read
        elif position > 0 and not self._text.startswith("\ufeff<"):
            self._differ("declaration", "something before the XML declaration", position)
        elif not _DECLARATION.fullmatch(self._text, position + 2, end - 2):
            self._differ(
                "declaration", "an XML declaration without a known version or encoding", position
            )
        return end

    def _skip_to(self, position: int, opening: str, closing: str, what: str) -> int | None:
        end = self._text.find(closing, position + len(opening))
        if end < 0:
            message = f"this {what} is not closed with {closing}; ROS 2 rejects the file"
            return self._refuse(xml_problems.UNTERMINATED, message, position)
        return end + len(closing)

    def _open(self, tag: Tag, end: int) -> int | None:
        prefix, colon, _ = tag.name.partition(":")
        if colon and "prefix" not in self._noted and prefix not in self._prefixes:
            self._differ(
                "prefix",
                f"the prefix of <{short(tag.name)}> is not declared with xmlns",
                tag.offset,
            )
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
                return self._refuse(
                    xml_problems.TOO_DEEP,
                    "tags are nested too deep; ROS 2 rejects the file",
                    tag.offset,
                )
        return end

    def _close(self, tag: Tag, end: int) -> int | None:
        if not self._open_tags:
            if self._errors:
                return end
            self._differ(
                "stray", f"the closing tag </{short(tag.name)}>, which closes nothing", tag.offset
            )
            if _skip_blank(self._text, end) < len(self._text):
                message = "ROS 2 stops reading at this closing tag, which closes nothing"
                self._add(xml_problems.IGNORED_REST, message, tag.offset)
            return None
        opened, is_written = self._open_tags.pop()
        if is_written:
            self._xml.append(f"</{opened.xml_name}>")
        if opened.name != tag.name and not self._errors:
            line = self._text.count("\n", 0, opened.offset) + 1
            message = f"</{short(tag.name)}> does not match <{short(opened.name)}> in line {line}"
            self._refuse(
                xml_problems.MISMATCHED_TAG, f"{message}; ROS 2 rejects the file", tag.offset
            )
        return end

    @cached_property
    def _prefixes(self) -> set[str]:
        return set(_NAMESPACE.findall(self._text))

    def _add(self, kind: Kind, message: str, offset: int, subject: str = "") -> None:
        self._differences.append(Difference(kind, message, offset, subject))

    def _refuse(self, kind: Kind, message: str, offset: int) -> int | None:
        """Add an error; return None, for callers that cannot go on."""
        self._errors += 1
        self._add(kind, message, offset)
        return None

    def _differ(self, key: str, what: str, offset: int) -> None:
        if key not in self._noted:
            self._noted.add(key)
            message = f"ROS 2 accepts this, but it is not well-formed XML: {what}"
            self._add(xml_problems.NOT_WELL_FORMED, message, offset, what)
