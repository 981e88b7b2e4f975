"""The edits that repair a text which TinyXML2 refuses, and the robot that is read after them.

Every element but the broken ones is read as it stands. What the text stands for is assumed by the
format of a URDF: a tag that does not fit closes those that are in its way.
"""

import re
from bisect import bisect_right
from functools import lru_cache
from typing import Literal, NamedTuple

from grader.base.element_edits import empty_element
from grader.base.grouping import Span, StringsByName
from grader.base.markup import indentation
from grader.base.merge_conflicts import find_conflicts, without_conflicts
from grader.base.names import folded, near
from grader.base.patterns import on_use
from grader.base.source import Edits, Source
from grader.base.text import enumerated
from grader.ros.xml import xml_problems
from grader.ros.xml.broken_tags import read_attributes
from grader.ros.xml.tinyxml2 import (
    Difference,
    MalformedTagError,
    Tag,
    decode,
    escape,
    read_tag,
    scan,
    short,
)
from grader.ros.xml.urdf_format import CHILDREN, PARTS, REQUIRED, TAGS, numbers_in

# What is no tag: a comment, a CDATA section, a declaration, a DOCTYPE. A declaration may lack its
# end, ?>.
_OTHER = on_use(
    r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?[^<]*?\?>|(?P<declaration><\?[^<>]*>?)|<!(?!--|\[CDATA\[).*?>",
    re.DOTALL,
)
# A broken tag to its > or to the next tag, and the attributes in it.
_BROKEN = on_use(r"<\s*+(?P<close>/?)\s*+(?P<name>[A-Za-z_][\w:.-]*)(?P<rest>[^<>]*)>?")
_ATTRIBUTE = on_use(
    r"""
    (?<![\w:.-])([A-Za-z_][\w:.-]*+)\s*+=\s*+(?:
        "([^"]*)"? | '([^']*)'?    # link="base", or link="base at the end of the tag
      | [“”„‘’‚]([^“”„‘’‚]*)[“”„‘’‚]
      | ([^\s"'“”„‘’‚=]++(?:\s++[-+.]*+\d[^\s"'“”„‘’‚=]*+)*+)    # link=base, size=1 2 0.5
    )
    """,
    re.VERBOSE,
)
_WORD = on_use(r"[-+]?[\w.]*\w")
_EMPTY_CALL = on_use(
    r"<(xacro:(?!(?:property|if|unless|macro|call|element)\b)[\w.-]++)(?:\s[^<>]*+|/)(?<=/)>"
)
_MACRO = on_use(r"""<xacro:macro\s+name="([\w.-]+)"\s+params="([^"<]*)\"""")
_NAMELESS = on_use(r"""\s*=\s*["']([^"']*)["']""")
_NAME = on_use(r"<\s*+([A-Za-z_][\w:.-]*)")
# Elements for other tools, and of xacro, which stand in the robot; those of xacro have no URDF in
# them.
_XACRO = ("xacro:property", "xacro:arg", "xacro:include")
_TOP = ("gazebo", "transmission", "ros2_control", *_XACRO)
_AROUND = {"xacro:macro", "xacro:if", "xacro:unless"}  # elements of xacro with URDF in them
_TAGS = {*CHILDREN, *(tag for tags in CHILDREN.values() for tag in tags), *_XACRO}
_ARROW = on_use(r"(?<!-)->(?=[ \t]*(?:\r?\n|<))")
_VISIBLE = on_use(r"[^\r\n]")
# where reading stops; urdfdom never looks deeper than robot/link/visual/geometry/box
_MAX_DEPTH = 32
_MAX_ASSUMED = 20


class _TextEdit(NamedTuple):
    """A change of a text: what is between two offsets becomes `new`."""

    start: int
    end: int
    new: str

    @property
    def is_replacement(self) -> bool:
        """Whether it changes a text that is there; else it inserts one."""
        return self.end > self.start


class _Repair(NamedTuple):
    """The robot that is read of a text after the changes that repair it.

    There is no robot if no link can be read.
    """

    xml: bytes
    offsets: list[int]  # of its start tags, in the text as the student wrote it
    changes: list[_TextEdit]  # in order; none overlaps another one
    assumed: list[Difference]  # what the changes assume
    is_lossy: bool  # whether something that the student wrote has no place in the repaired text


@lru_cache(maxsize=1)  # who reads a robot again in another way asks for its text again
def repair(text: str) -> _Repair:
    """Return the changes that repair a text, and the robot that is read after them."""
    conflicts = find_conflicts(text)
    changes = []
    for conflict in conflicts:
        changes += [_TextEdit(start, end, "") for start, end in conflict.removed]
    kept = without_conflicts(text, conflicts)
    assumed = []
    for start, end in unclosed_comments(kept):
        changes.append(_TextEdit(end - 2, end, "-->"))
        message = "the comment ends here: -> is read as -->"
        assumed.append(Difference(xml_problems.RECOVERED, message, end - 2))
        kept = f"{kept[:start]}{_VISIBLE.sub(' ', kept[start:end])}{kept[end:]}"
    repaired = _Repairer(kept).run()
    assumed = (assumed + repaired.assumed) if repaired.xml else []

    def is_in_tag(change: _TextEdit) -> bool:
        """Return whether a change is in a tag that is replaced: a comment in a value."""
        return any(tag.start <= change.start < tag.end for tag in repaired.changes)

    kept_changes = [change for change in changes if not is_in_tag(change)]
    return repaired._replace(changes=sorted(repaired.changes + kept_changes), assumed=assumed)


def unclosed_comments(text: str) -> list[Span]:
    """Return the offsets of comments that end with -> by mistake.

    They run to the end of another one or of the text.
    """
    comments: list[Span] = []
    position = text.find("<!--")
    while position >= 0 and len(comments) < _MAX_ASSUMED:
        end = text.find("-->", position + 4)
        whole = end if end >= 0 else len(text)
        arrow = _ARROW.search(text, position + 4, whole)
        if arrow and (end < 0 or text.find("<!--", arrow.end(), whole) >= 0):
            comments.append((position, arrow.end()))
            whole = arrow.end()
        position = text.find("<!--", whole)
    return comments


class _Repairer:
    """One pass over a text, which notes what becomes of its tags.

    It also notes which end tags are missing where.
    """

    def __init__(self, text: str) -> None:
        self._text = text.partition("\0")[0]  # TinyXML2 reads no further
        # by the offset of a tag: where it ends, what it becomes
        self._replaced: dict[int, tuple[int, str]] = {}
        self._last = -1  # the offset of the tag that was replaced last
        self._inserted: dict[int, str] = {}  # end tags, by the offset before which they are missing
        self._assumed: list[Difference] = []
        self._is_lossy = False
        self._plain_macros: set[str] | None = None  # the tags that call macros without elements
        self._open: list[Tag] = []
        self._robot: int | None = None  # the offset of the first robot

    def run(self) -> _Repair:
        """Find the changes, and read the robot after them."""
        end = self._read()
        if self._open:
            opened = enumerated([f"<{short(tag.name)}>" for tag in self._open], 3)
            self._assume(f"what is open is closed at the end: {opened}", len(self._text))
            self._is_lossy |= end < len(self._text)
        while self._open:
            self._close_last(end)
        noted = self._noted()
        xml, offsets = self._robot_after(noted, end)
        if b"<link" not in xml:
            return _Repair(b"", [], _joined(noted), [], self._is_lossy)
        return _Repair(xml, offsets, _joined(noted), self._assumed, self._is_lossy)

    def _read(self) -> int:
        """Read the tags of the first robot; return the offset at which reading stops."""
        position = 0
        text = self._text
        while len(self._assumed) < _MAX_ASSUMED and len(self._open) <= _MAX_DEPTH:
            start = text.find("<", position)
            if start < 0:
                return len(text)
            if text.startswith(("<!", "<?"), start):
                other = _OTHER.match(text, start)
                if not other:
                    return start  # a comment or the like without an end
                position = other.end()
                self._repair_declaration(other)
                continue
            position = self._read_tag(start)
            if self._robot is not None and not self._open:
                rest = text[position:].strip()
                if rest and "<" not in rest:
                    self._replace(position, len(text), "")
                return position
        return position

    def _read_tag(self, start: int) -> int:
        """Read the tag at an offset; return the offset after it."""
        tag, end = self._tag(start)
        if not tag:
            return end
        if not self._open and tag.name != "robot":
            if tag.form == "close":  # TinyXML2 reads no further
                self._replace(start, end, "")
        elif tag.form == "close":
            self._close(tag, end)
        else:
            self._start(tag)
        return end

    def _repair_declaration(self, match: re.Match[str]) -> None:
        """Remove a declaration that is not at the top, and end one that has no end."""
        start, end = match.span()
        if start and match[0].startswith("<?xml ") and self._text[:start].strip("\ufeff \t\r\n"):
            self._replace(start, end, "")
        elif match["declaration"]:
            self._replace(start, end, match[0].rstrip("?> \t\r\n") + "?>")

    def _tag(self, start: int) -> tuple[Tag | None, int]:
        """Return the tag at an offset, and the offset after it.

        A broken tag has the attributes that can be read.
        """
        try:
            tag, end = read_tag(self._text, start, lambda *_: None)
        except MalformedTagError as error:
            match = _BROKEN.match(self._text, start)
            if not match:
                self._assume("a < without the name of a tag is ignored", start)
                self._replace(start, start + 1, "")
                return None, max(error.resume, start + 1)
            tag = self._broken(match)
            end = match.end()
        if tag.form == "empty" and self._has_end(tag, end):
            self._assume(f"<{short(tag.name)} .../> is read as <{short(tag.name)} ...>", start)
            self._replace(
                start, end, f"{self._text[start : self._text.rindex('/', start, end)].rstrip()}>"
            )
            return tag._replace(form="open"), end
        if self._lacks_slash(tag) and not self._is_before_child(tag, end):
            self._assume(f"<{short(tag.name)}> is read as </{short(tag.name)}>", start)
            self._replace(start, end, f"</{tag.name}>")
            return tag._replace(form="close"), end
        return tag, end

    def _lacks_slash(self, tag: Tag) -> bool:
        """Return whether a tag may be the end of the innermost element: <link> for </link>."""
        if tag.attributes or not self._open or self._open[-1].name != tag.name:
            return False
        return tag.form == "open" or (tag.form == "empty" and tag.name == "xacro:macro")

    def _broken(self, match: re.Match[str]) -> Tag:
        """Return a broken tag as it is read.

        A value without a name is that of the attribute that the tag needs.
        """
        name = match["name"]
        rest = match["rest"].rstrip()
        if match["close"]:
            self._replace(*match.span(), f"</{name}>")
            return Tag(name, "close", {}, match.start())
        attributes = read_attributes(name, rest)
        if attributes is None:
            attributes = _readable_attributes(name, rest)
            self._is_lossy |= _loses_words(rest, attributes)
        is_value_lost = "=" in rest and not attributes
        what = f"with {enumerated(map(short, attributes))}" if attributes else "without attributes"
        self._assume(
            f"<{short(name)}> is read {what}", match.start(), name if is_value_lost else ""
        )
        form: Literal["open", "empty"] = "empty" if rest.endswith("/") else "open"
        written = "".join(f' {key}="{escape(value)}"' for key, value in attributes.items())
        self._replace(*match.span(), f"<{name}{written}{'/' if form == 'empty' else ''}>")
        return Tag(name, form, attributes, match.start())

    def _has_end(self, tag: Tag, end: int) -> bool:
        """Return whether content and an own end tag follow a tag that ends with a slash."""
        if tag.name not in CHILDREN or not (tag.name == "robot" or self._is_before_child(tag, end)):
            return False
        other = re.compile(rf"<\s*+(/?)\s*+{tag.name}(?![\w:.-])").search(self._text, end)
        return other is not None and other[1] == "/"

    def _is_before_child(self, tag: Tag, end: int) -> bool:
        match = _NAME.search(self._text, end)
        return match is not None and match[1] in CHILDREN.get(tag.name, ())

    def _start(self, tag: Tag) -> None:
        if self._robot is None:
            self._robot = tag.offset
        if self._open and self._is_open_call(self._open[-1].name):
            self._leave(len(self._open) - 1, tag.offset)
        parents = _list_parents(tag.name)
        around = [opened.name for opened in self._open]
        if (
            around
            and around[-1] not in parents
            and parents.intersection(around)
            and (_TAGS | _AROUND).issuperset(around)
        ):
            last = max(index for index, name in enumerate(around) if name in parents)
            self._leave(last + 1, tag.offset)
        if tag.form == "open":
            self._open.append(tag)

    def _is_open_call(self, name: str) -> bool:
        """Return whether a tag calls a macro that takes no element, so that nothing is inside."""
        if not name.startswith("xacro:"):
            return False
        if self._plain_macros is None:
            macros = _MACRO.findall(self._text)
            self._plain_macros = {f"xacro:{macro}" for macro, params in macros if "*" not in params}
            # Of a macro of another file, one call has elements only if all have.
            self._plain_macros.update(_EMPTY_CALL.findall(self._text))
        return name in self._plain_macros

    def _close(self, tag: Tag, end: int) -> None:
        indices = [index for index, opened in enumerate(self._open) if opened.name == tag.name]
        if indices:
            self._leave(indices[-1] + 1, tag.offset)
            self._open.pop()
        elif self._is_end_of_xacro(tag.name):
            name = self._open.pop().name
            self._assume(f"</{short(tag.name)}> is read as </{short(name)}>", tag.offset)
            self._replace(tag.offset, end, f"</{name}>")
        elif (
            self._open
            and self._open[-1].name not in _TAGS
            and near(self._open[-1].name, [tag.name])
        ):
            opened = self._open.pop()
            self._assume(f"<{short(opened.name)}> is read as <{short(tag.name)}>", opened.offset)
            self._rename(opened, tag.name)
        else:
            self._assume(
                f"</{short(tag.name)}> is ignored, because no <{short(tag.name)}> is open",
                tag.offset,
            )
            self._replace(tag.offset, end, "")

    def _is_end_of_xacro(self, name: str) -> bool:
        """Return whether an end tag stands for that of the innermost element, which is xacro's.

        Examples are </macro>, </xacro> and the name of the macro for </xacro:macro>.
        """
        if not self._open:
            return False
        opened = self._open[-1]
        prefix, _, local = opened.name.partition(":")
        if prefix != "xacro":
            return False
        ways = (prefix, local, opened.attributes.get("name", ""))
        is_misspelt = name not in _TAGS and near(name.removeprefix("xacro:"), [local]) is not None
        is_same = folded(name) == folded(opened.name)
        return name.removeprefix("xacro:") in ways or is_same or is_misspelt

    def _leave(self, depth: int, offset: int) -> None:
        """Close the tags that are open below a depth, before an offset."""
        while len(self._open) > depth:
            name = short(self._open[-1].name)
            line = self._text.count("\n", 0, self._open[-1].offset) + 1
            self._assume(f"<{name}> of line {line} is closed here", offset)
            self._close_last(offset)

    def _assume(self, message: str, offset: int, subject: str = "") -> None:
        self._assumed.append(Difference(xml_problems.RECOVERED, message, offset, subject))

    def _close_last(self, offset: int) -> None:
        """Close the innermost open tag before an offset, in a line of its own if it has one."""
        opened = self._open.pop()
        head = self._text[opened.offset : offset].rstrip()
        is_alone = opened.offset not in self._replaced and head.find(">") == len(head) - 1
        if is_alone and (_is_never_filled(opened.name) or self._is_open_call(opened.name)):
            self._replace(opened.offset, opened.offset + len(head), f"{head[:-1].rstrip()}/>")
            return
        end, new = self._replaced.get(self._last, (0, " "))
        if not new and not _OTHER.sub("", self._text[end:offset]).strip():
            # A wrong end tag is there.
            self._replaced[self._last] = end, f"</{opened.name}>"
            return
        at = len(self._text[:offset].rstrip())
        before = ""
        if "\n" in self._text[opened.offset : at]:
            newline = "\r\n" if "\r\n" in self._text else "\n"
            before = f"{newline}{indentation(self._text, opened.offset)}"
        self._inserted[at] = f"{self._inserted.get(at, '')}{before}</{opened.name}>"

    def _replace(self, start: int, end: int, new: str) -> None:
        """Note what a tag becomes; white space at its end stays."""
        self._replaced[start] = start + len(self._text[start:end].rstrip()), new
        self._last = start

    def _rename(self, opened: Tag, name: str) -> None:
        start = opened.offset
        end, new = self._replaced.get(start, (0, ""))
        if new:
            self._replaced[start] = end, f"<{name}{new.removeprefix(f'<{opened.name}')}"
        else:
            self._replace(
                start, self._text.index(opened.name, start) + len(opened.name), f"<{name}"
            )

    def _noted(self) -> list[_TextEdit]:
        """Return all changes in order.

        Of two at one place, the end tags that are inserted come first.
        """
        replaced = [_TextEdit(start, end, new) for start, (end, new) in self._replaced.items()]
        inserted = [_TextEdit(at, at, new) for at, new in self._inserted.items()]
        return sorted(replaced + inserted)

    def _robot_after(self, changes: list[_TextEdit], end: int) -> tuple[bytes, list[int]]:
        """Return the robot that is read after changes of the text before an offset.

        Also return where its tags are now.
        """
        if self._robot is None:
            return b"", []
        pieces = []
        places = []  # of the pieces: the offset after the changes, and the one before
        position = self._robot
        length = 0
        for change in changes:
            if self._robot <= change.start and change.end <= end:
                for piece, start in (
                    (self._text[position : change.start], position),
                    (change.new, change.start),
                ):
                    places.append((length, start))
                    pieces.append(piece)
                    length += len(piece)
                position = change.end
        places.append((length, position))
        scanned = scan("".join([*pieces, self._text[position:end]]))
        offsets = []
        for offset in scanned.offsets:
            after, before = places[bisect_right(places, offset, key=lambda place: place[0]) - 1]
            offsets.append(before + offset - after)
        return scanned.xml, offsets


def _is_never_filled(tag: str) -> bool:
    """Return whether an element has attributes only.

    <box size="1 1 1"/> is closed where it begins.
    """
    return tag in TAGS and bool(TAGS[tag].attributes) and not TAGS[tag].children


def _readable_attributes(tag: str, text: str) -> dict[str, str]:
    """Return the attributes in the text of a broken tag, as they are meant."""
    attributes: dict[str, str] = {}
    given = [
        (key, decode("".join(values)))
        for key, *values in _ATTRIBUTE.findall(text.removesuffix("/"))
    ]
    keys = {key for key, _ in given}
    for key, value in given:
        if attributes.setdefault(key, value) != value:
            other = _other_attribute(tag, keys, value)
            if other:
                attributes[other] = value
    nameless = _NAMELESS.match(text)
    if nameless:
        main = _main_attribute(tag)
        if main not in attributes and _has_numbers(main, nameless[1]):
            return {main: decode(nameless[1]), **attributes}
    return attributes


def _loses_words(text: str, attributes: StringsByName) -> bool:
    """Return whether a word or a number in the text of a broken tag is in no attribute."""
    kept = {word for pair in attributes.items() for part in pair for word in _WORD.findall(part)}
    return not kept.issuperset(_WORD.findall(decode(text)))


def _list_parents(tag: str) -> set[str]:
    """Return the tags of the elements in which an element of this tag may be."""
    if tag in _TOP:
        return {"robot", *_AROUND}
    parents = {name for name, tags in CHILDREN.items() if tag in tags}
    if parents == {"robot"}:
        parents |= _AROUND
    return parents


def _main_attribute(tag: str) -> str:
    """Return the attribute that a value without a name is for.

    This is the first that the tag needs, else has.
    """
    known = [*REQUIRED.get(tag, ()), *(TAGS[tag].attributes if tag in TAGS else ())]
    return known[0] if known else ""


def _other_attribute(tag: str, given: set[str], value: str) -> str:
    """Return the one attribute that a value is meant for whose name is given twice.

    This attribute is not given.
    """
    known = TAGS[tag].attributes if tag in TAGS else {}
    absent = [name for name in known if name not in given and _has_numbers(name, value)]
    needed = [name for name in absent if name in REQUIRED.get(tag, ())]
    candidates = needed or absent
    if len(candidates) == 1:
        return candidates[0]
    return ""


def _has_numbers(attribute: str, value: str) -> bool:
    """Return whether a value has the numbers of an attribute; a text may be anything."""
    parts = PARTS.get(attribute, ())
    return bool(attribute) and (not parts or len(numbers_in(value)) == len(parts))


def _joined(changes: list[_TextEdit]) -> list[_TextEdit]:
    """Return the changes with inserted end tags as a part of the change that they touch."""
    joined: list[_TextEdit] = []
    for change in changes:
        last = joined[-1] if joined else None
        if (
            last
            and last.end == change.start
            and not (last.is_replacement and change.is_replacement)
        ):
            joined[-1] = _TextEdit(last.start, change.end, last.new + change.new)
        else:
            joined.append(change)
    return joined


def _broken_tag(text: str, start: int) -> str:
    """Return the broken tag at an offset; empty if it is not broken."""
    try:
        read_tag(text, start, lambda *_: None)
    except MalformedTagError:
        match = _BROKEN.match(text, start)
        if match:
            return match[0].rstrip()
        return ""
    return ""


def rewritten_tag(source: Source, start: int, tag: str, attributes: StringsByName) -> Edits | None:
    """Return the edit that writes the broken tag at an offset anew, with these attributes.

    There is none where the end of the tag is not known. Return None if it is not broken.
    """
    broken = _broken_tag(source.text, start)
    if not broken:
        return None
    if not broken.endswith(">"):
        return ()
    new = empty_element(tag, attributes)
    if not broken.endswith("/>"):
        new = f"{new[:-2]}>"
    return (source.edit(start, start + len(broken), new),)
