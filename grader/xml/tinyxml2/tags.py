"""One tag as TinyXML2 reads it (`XMLElement::ParseDeep`, `ParseAttributes`), or why it rejects it."""

import re
from collections.abc import Callable
from typing import Literal, NamedTuple

from grader.problems import Kind
from grader.text import cut
from grader.xml.tinyxml2.values import REFERENCE, decode, escape
from grader.xml.urdf_format import TAGS

Note = Callable[[str, str, int], None]  # the kind of a difference from XML, its description and its offset

_BLANK = re.compile(r"[ \t\n\v\f\r]*")
_NAME = re.compile(r"[A-Za-z_:\u0080-\U0010ffff][A-Za-z0-9_:.\-\u0080-\U0010ffff]*")
_PLAIN_NAME = re.compile(r"(?!(?i:xml))[A-Za-z_][A-Za-z0-9_.\-]*")
MAX_NAME_LENGTH = 60  # the longest name that urdfdom knows has 17 letters


class ReadTag(NamedTuple):
    """One tag; attribute values are decoded. Names that XML or lxml may refuse are `_`: urdfdom ignores them anyway."""

    name: str
    form: Literal["open", "close", "empty"]
    attributes: dict[str, str]
    offset: int

    @property
    def xml_name(self) -> str:
        """Its name in XML, which may have a prefix."""
        return self.name if all(map(_is_plain, self.name.split(":", 1))) else "_"

    @property
    def xml(self) -> str:
        """A start tag as XML, without attributes that mean nothing to urdfdom."""
        values = "".join(f' {key}="{escape(value)}"' for key, value in self.attributes.items() if _is_plain(key))
        prefix, colon, _ = self.xml_name.partition(":")
        declared = f' xmlns:{prefix}="{prefix}"' if colon else ""
        return f"<{self.xml_name}{declared}{values}{'>' if self.form == 'open' else '/>'}"


class NoteDifference(NamedTuple):
    """A difference from XML, an error, or what was assumed about one, at a character offset.

    `subject` is the tag of which a part cannot be read.
    """

    kind: Kind
    message: str
    offset: int
    subject: str = ""


class Scan(NamedTuple):
    """The first top-level <robot> as XML, with the offset of each of its start tags; both empty if there is none.

    If TinyXML2 refuses the text, `recovered` is what can be read of it, and the offsets are those of its tags. The XML
    has no comments, and a prefix stands for its namespace. urdfdom reads tags and attributes only; simulators read the
    text in elements, too.
    """

    xml: bytes
    offsets: list[int]
    first_tag: int
    differences: list[NoteDifference]
    recovered: bytes = b""


class MalformedTagError(Exception):
    """A tag that TinyXML2 rejects, with the offset of the error, and the one at which reading can go on."""

    def __init__(self, message: str, offset: int, resume: int) -> None:
        super().__init__(message)
        self.offset = offset
        self.resume = resume


def _is_plain(name: str) -> bool:
    return len(name) < MAX_NAME_LENGTH and _PLAIN_NAME.fullmatch(name) is not None


def skip_blank(text: str, position: int) -> int:
    """Return the first offset from here on that is not white space, as C's isspace defines it."""
    match = _BLANK.match(text, position)
    return match.end() if match else position


def read_tag(text: str, start: int, note: Note) -> tuple[ReadTag, int]:
    """Return the tag whose < is at `start`, and the offset after it; raises MalformedTagError."""
    position = skip_blank(text, start + 1)
    closing = text.startswith("/", position)
    if position > start + 1:
        note("space", "white space after <", start)
    found = _NAME.match(text, position + closing)
    if found is None:
        raise MalformedTagError("there is no tag name after <", start, resume_after(text, start))
    name = found[0]
    attributes, position = _read_attributes(text, start, found.end(), name, note)
    form: Literal["open", "close", "empty"] = "close" if closing else "open"
    if text.startswith("/", position):
        form, position = "empty", position + 1
    if closing and (attributes or form == "empty"):
        note("closing", "a closing tag with more than its name", start)
    return ReadTag(name, form, attributes, start), position + 1


def resume_after(text: str, position: int) -> int:
    """Return the offset at which to go on after a malformed tag: after its > or before the next <."""
    closed, opened = text.find(">", position), text.find("<", position + 1)
    if closed >= 0 and (opened < 0 or closed < opened):
        return closed + 1
    return opened if opened >= 0 else len(text)


def short(text: str) -> str:
    """Return a name for a message, cut where it is very long; bytes that are not UTF-8 are spelt out."""
    return cut(text, 40).encode("utf-8", "backslashreplace").decode()


def _read_attributes(text: str, start: int, position: int, tag: str, note: Note) -> tuple[dict[str, str], int]:
    """Return the attributes of a tag, and the offset of the > or /> that ends it."""
    attributes: dict[str, str] = {}
    while True:
        at = skip_blank(text, position)
        if text.startswith((">", "/>"), at):
            return attributes, at
        try:
            end = _read_attribute(text, start, at, tag, attributes, note)
        except MalformedTagError as error:
            raise _unclosed_quote(text, start, tag, attributes) or error from None
        if at == position and len(attributes) > 1:
            note("attributes", "no space between two attributes", at)
        position = end


def _unclosed_quote(text: str, start: int, tag: str, attributes: dict[str, str]) -> MalformedTagError | None:
    """Return the likelier error, if a value contains the next tag because its quote is not closed."""
    unclosed = next((name for name, value in attributes.items() if "\n" in value and "<" in value), None)
    if unclosed is None:
        return None
    message = f"the quote of {short(unclosed)!r} in <{short(tag)}> is not closed before the next tag"
    return MalformedTagError(message, start, max(text.find("\n", start), start + 1))


def _read_attribute(text: str, start: int, position: int, tag: str, attributes: dict[str, str], note: Note) -> int:
    """Add the attribute at this offset to the others; return the offset after it."""
    name = _NAME.match(text, position)
    if name is None:
        raise _misfit(text, start, position, tag)
    shown, offset = f"{short(name[0])!r} in <{short(tag)}>", name.start()
    at = skip_blank(text, name.end())
    if not text.startswith("=", at):
        message = f"the attribute {short(name[0])!r} of <{short(tag)}> has no value"
        raise MalformedTagError(message, offset, resume_after(text, name.end()))
    at = skip_blank(text, at + 1)
    quote = text[at : at + 1]
    if quote not in ('"', "'"):
        raise MalformedTagError(f"the value of {shown} is not in straight quotes", offset, resume_after(text, at))
    end = text.find(quote, at + 1)
    if end < 0:
        raise MalformedTagError(f"the quote of {shown} is not closed", offset, resume_after(text, at))
    raw = text[at + 1 : end]
    if "<" in raw:
        note("less", "< inside a value (write &lt;)", offset)
    if "&" in raw and REFERENCE.search(raw):
        note("reference", "a bare & or an unknown entity (write &amp;)", offset)
    if name[0] in attributes:
        message = f"duplicate attribute {short(name[0])!r} in <{short(tag)}>"
        raise MalformedTagError(message, offset, resume_after(text, end + 1))
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
            return MalformedTagError(message, start, resume_after(text, at))
        case "<":
            return MalformedTagError(f"<{shown}> is not closed with > before the next tag", start, at)
        case ",":
            message = f"there is a comma between the attributes of <{shown}>; separate them with spaces"
        case _:
            word = text[at : at + 12].split(" ", maxsplit=1)[0]
            message = f"{word!r} in <{shown}> is not an attribute"
    return MalformedTagError(message, at, resume_after(text, at))
