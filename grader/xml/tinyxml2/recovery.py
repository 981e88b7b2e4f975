"""What can be read of a text that TinyXML2 refuses: every element but the broken ones as is, and the assumptions."""

import re
from typing import Literal

from grader.markup import indentation
from grader.names import near
from grader.text import enumerated
from grader.xml import catalogue
from grader.xml.tinyxml2.tags import MalformedTagError, NoteDifference, ReadTag, Scan, read_tag, short
from grader.xml.tinyxml2.values import decode, escape
from grader.xml.urdf_format import CHILDREN, REQUIRED, TAGS

# What is no tag, to its end or to the end of the text: a comment, a CDATA section, a declaration, a DOCTYPE.
_OTHER = re.compile(r"<!--.*?(?:-->|\Z)|<!\[CDATA\[(?P<text>.*?)(?:\]\]>|\Z)|<[?!].*?(?:>|\Z)", re.DOTALL)
# A broken tag to its > or to the next tag, and the attributes in it.
_BROKEN = re.compile(r"<\s*+(?P<close>/?)\s*+(?P<name>[A-Za-z_][\w:.-]*)(?P<rest>[^<>]*)>?")
_ATTRIBUTE = re.compile(
    r"""
    (?<![\w:.-])([A-Za-z_][\w:.-]*+)\s*+=\s*+(?:
        "([^"]*)"? | '([^']*)'?    # link="base", or link="base at the end of the tag
      | [“”„‘’‚]([^“”„‘’‚]*)[“”„‘’‚]
      | ([^\s"'“”„‘’‚=]+)           # link=base
    )
    """,
    re.VERBOSE,
)
_NAMELESS = re.compile(r"""\s*=\s*["']([^"']*)["']""")
_NEXT_NAME = re.compile(r"<\s*+([A-Za-z_][\w:.-]*)")
# Elements for other tools, and of xacro, which stand in the robot; those of xacro have no URDF in them.
_XACRO = ("xacro:property", "xacro:arg", "xacro:include")
_TOP = ("gazebo", "transmission", "ros2_control", *_XACRO)
_TAGS = {*CHILDREN, *(tag for tags in CHILDREN.values() for tag in tags), *_XACRO}
_MAX_DEPTH = 32  # where reading stops; urdfdom never looks deeper than robot/link/visual/geometry/box
_MAX_ASSUMED = 20


class Recovery:
    """One pass over a text. A tag that does not fit closes those that are in its way, as the format of a URDF tells."""

    def __init__(self, text: str) -> None:
        self._text = text.partition("\0")[0]  # TinyXML2 reads no further
        self._xml: list[str] = []
        self._offsets: list[int] = []
        self._assumed: list[NoteDifference] = []
        self.changes: list[tuple[int, int, str]] = []  # with which the text is what is read: from offset to offset
        self.is_lossy = False  # whether a text in a tag has no place in what is read, or two changes are at one place
        self._end_of_tag = 0
        self._open: list[ReadTag] = []

    def run(self) -> Scan:
        """Return the first robot as `recovered`, and what was assumed; nothing if no link of it can be read."""
        position, text = 0, self._text
        while len(self._assumed) < _MAX_ASSUMED and len(self._open) <= _MAX_DEPTH:
            if (start := text.find("<", position)) < 0:
                break
            self._write(text[position:start])
            if other := _OTHER.match(text, start):
                self._write(other["text"] or "")
                position = other.end()
                if start and other[0].startswith("<?xml ") and text[:start].strip("\ufeff \t\r\n"):
                    self._change(start, position, "")
                continue
            tag, position = self._tag(start)
            self._end_of_tag = position
            if tag is not None and (tag.name == "robot" if not self._open else True):
                self._close(tag) if tag.form == "close" else self._start(tag)
            if self._xml and not self._open:
                rest = text[position:].strip()
                self._change(position, len(text.rstrip()), "") if rest and "<" not in rest else None
                break
        if self._open:
            self._assume(
                f"what is open is closed at the end: {enumerated([f'<{short(tag.name)}>' for tag in self._open], 3)}",
                len(text),
            )
        while self._open:
            self._close_before(len(text))
            self._end()
        if not any(xml.startswith("<link") for xml in self._xml):
            return Scan(b"", [], 0, [])
        return Scan(b"", self._offsets, 0, self._assumed, "".join(self._xml).encode())

    def _tag(self, start: int) -> tuple[ReadTag | None, int]:
        """Return the tag at an offset, and the offset after it; a broken one with the attributes that can be read."""
        try:
            tag, end = read_tag(self._text, start, lambda *_: None)
        except MalformedTagError as error:
            found = _BROKEN.match(self._text, start)
            if found is None:
                self._assume("a < without the name of a tag is ignored", start)
                self._change(start, start + 1, "")
                return None, max(error.resume, start + 1)
            attributes: dict[str, str] = {}
            rest = found["rest"].rstrip()
            for name, *values in _ATTRIBUTE.findall(rest.removesuffix("/")):
                attributes.setdefault(name, decode("".join(values)))
            form: Literal["open", "close", "empty"] = (
                "close" if found["close"] else "empty" if rest.endswith("/") else "open"
            )
            tag, end = ReadTag(found["name"], form, attributes, start), found.end()
            corrected = _corrected(tag, rest)
            self.is_lossy |= "=" in rest and "=" not in corrected and tag.form != "close"
            self._change(start, found.end(), corrected)
            if tag.form != "close":
                what = f"with {enumerated(list(map(short, attributes)))}" if attributes else "without attributes"
                self._assume(
                    f"<{short(tag.name)}> is read {what}", start, tag.name if "=" in rest and not attributes else ""
                )
        is_slash_missing = tag.form == "open" and not tag.attributes and self._open and self._open[-1].name == tag.name
        if is_slash_missing and not self._is_before_child(tag, end):
            self._assume(f"<{short(tag.name)}> is read as </{short(tag.name)}>", start)
            self._change(start, end, f"</{tag.name}>")
            return tag._replace(form="close"), end
        return tag, end

    def _is_before_child(self, tag: ReadTag, end: int) -> bool:
        found = _NEXT_NAME.search(self._text, end)
        return found is not None and found[1] in CHILDREN.get(tag.name, ())

    def _start(self, tag: ReadTag) -> None:
        parents = {"robot"} if tag.name in _TOP else {name for name, tags in CHILDREN.items() if tag.name in tags}
        around = [opened.name for opened in self._open]
        if around and around[-1] not in parents and parents.intersection(around) and _TAGS.issuperset(around):
            self._leave(max(index for index, name in enumerate(around) if name in parents) + 1, tag.offset)
        self._xml.append(tag.xml)
        self._offsets.append(tag.offset)
        if tag.form == "open":
            self._open.append(tag)

    def _close(self, tag: ReadTag) -> None:
        found = [index for index, opened in enumerate(self._open) if opened.name == tag.name]
        if not found and self._open and self._open[-1].name not in _TAGS and near(self._open[-1].name, [tag.name]):
            opened = self._open[-1]
            at = len(self._xml) - 1 - self._xml[::-1].index(opened.xml)
            self._open[-1] = opened._replace(name=tag.name)
            self._xml[at] = self._open[-1].xml
            self._assume(f"<{short(opened.name)}> is read as <{short(tag.name)}>", opened.offset)
            self._change(opened.offset, opened.offset + 1 + len(opened.name), f"<{tag.name}")
            self._end()
        elif not found:
            self._assume(f"</{short(tag.name)}> is ignored, because no <{short(tag.name)}> is open", tag.offset)
            self._change(tag.offset, self._end_of_tag, "")
        else:
            self._leave(found[-1] + 1, tag.offset)
            self._end()

    def _leave(self, depth: int, offset: int) -> None:
        """Close the tags that are open below a depth, before an offset."""
        while len(self._open) > depth:
            name = short(self._open[-1].name)
            line = self._text.count("\n", 0, self._open[-1].offset) + 1
            self._assume(f"<{name}> of line {line} is closed here", offset)
            self._close_before(offset)
            self._end()

    def _end(self) -> None:
        self._xml.append(f"</{self._open.pop().xml_name}>")

    def _write(self, text: str) -> None:
        if self._open:
            self._xml.append(escape(decode(text)).replace(">", "&gt;"))

    def _assume(self, message: str, offset: int, subject: str = "") -> None:
        self._assumed.append(NoteDifference(catalogue.RECOVERED, message, offset, subject))

    def _close_before(self, offset: int) -> None:
        """Note that the innermost open tag should be closed before an offset, in a line of its own if it has one."""
        at, opened = len(self._text[:offset].rstrip()), self._open[-1]
        _, end, new = self.changes[-1] if self.changes else (0, 0, " ")
        is_replaced = not new and not _OTHER.sub("", self._text[end:offset]).strip()  # a wrong end tag is there
        at = end if is_replaced else at
        indent = indentation(self._text, opened.offset)
        newline = "\r\n" if "\r\n" in self._text else "\n"
        before = f"{newline}{indent}" if "\n" in self._text[opened.offset : at] and not is_replaced else ""
        self._change(at, at, f"{before}</{opened.name}>")

    def _change(self, start: int, end: int, new: str) -> None:
        """Note a change; white space at its end stays."""
        end = start + len(self._text[start:end].rstrip())
        if self.changes and self.changes[-1][:2] == (start, end) and start < end:
            self.changes.pop()  # a tag that was respelt is replaced after all
        if self.changes and self.changes[-1][1] == start == end:
            start, end, new = *self.changes[-1][:2], self.changes.pop()[2] + new
        self.is_lossy |= any((first < end and start < last) or first == start for first, last, _ in self.changes)
        self.changes.append((start, end, new))


def broken_tag(text: str, start: int) -> str:
    """Return the broken tag at an offset; empty if it is not broken."""
    try:
        read_tag(text, start, lambda *_: None)
    except MalformedTagError:
        found = _BROKEN.match(text, start)
        return found[0].rstrip() if found is not None else ""
    return ""


def _corrected(tag: ReadTag, rest: str) -> str:
    """Return a broken tag as it is read; a value without a name gets that of the attribute that the tag needs."""
    attributes, value = dict(tag.attributes), _NAMELESS.match(rest)
    needed = REQUIRED.get(tag.name) or tuple(TAGS[tag.name].attributes if tag.name in TAGS else ())
    if value is not None and needed and needed[0] not in attributes:
        attributes = {needed[0]: value[1], **attributes}
    if tag.form == "close":
        return f"</{tag.name}>"
    text = "".join(f' {name}="{escape(value)}"' for name, value in attributes.items())
    return f"<{tag.name}{text}{'/' if tag.form == 'empty' else ''}>"
