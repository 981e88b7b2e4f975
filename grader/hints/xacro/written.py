"""Texts of a xacro file where they are written: the value of an attribute or a part of it, with its place for edits."""

import re
from collections.abc import Iterable
from typing import NamedTuple

from grader import markup
from grader.source import Edit, Edits, Source
from grader.xacro.scopes import Definition, Key, ScopePlace, XacroScope

_MAX_LENGTH = 2_000  # of a text that is edited in parts


class Written(NamedTuple):
    """A text at an offset of a file, the scope in which it is evaluated, the attribute that it is in, and its name."""

    source: Source
    start: int
    text: str
    scope: XacroScope
    attribute: tuple[int, int]  # its offsets, with name and quotes
    key: Key | None = None  # of what is defined with it

    @property
    def end(self) -> int:
        """The offset after it."""
        return self.start + len(self.text)

    def part(self, start: int, end: int) -> "Written":
        """Return a part of it."""
        return self._replace(start=self.start + start, text=self.text[start:end])


class Use(NamedTuple):
    """A use of a text: the scope in which it is evaluated, what it is and should be, the call of the macro it is in."""

    scope: XacroScope
    old: str
    new: str
    call: ScopePlace | None = None


class TextChange(NamedTuple):
    """A text that becomes another one."""

    written: Written
    new: str


def edits_of(changes: Iterable[TextChange]) -> Edits | None:
    """Return the edits that make changes, one for each attribute; None where two of them overlap."""
    attributes: dict[tuple[str, int], list[TextChange]] = {}
    for change in dict.fromkeys(changes):
        attributes.setdefault((change.written.source.path, change.written.attribute[0]), []).append(change)
    edits: list[Edit] = []
    for inside in attributes.values():
        source, (start, end) = inside[0].written.source, inside[0].written.attribute
        new, position = "", start
        for written, text in sorted(inside, key=lambda change: change.written.start):
            if written.start < position:
                return None
            new += source.text[position : written.start] + text
            position = written.end
        edits.append(source.edit(start, end, new + source.text[position:end]))
    return tuple(edits)


def find_text(place: ScopePlace, attribute: str, scope: XacroScope) -> Written | None:
    """Return the value of an attribute, or without a name the text of an element without children.

    None where it is missing, too long, or has entities, so that it is not what is read.
    """
    source, at = place.source.element(place.tag)
    if attribute:
        found = markup.attribute(source.text, at, attribute)
        start, end, span = (found.value_start, found.value_end, (found.start, found.end)) if found else (0, 0, None)
    else:
        start = markup.head_end(source.text, at)[0]
        end = source.text.rfind("</", start, markup.element_end(source.text, at))
        text = source.text[start:end]
        start, end = start + len(text) - len(text.lstrip()), start + len(text.rstrip())
        span = (start, end) if text.strip() else None
    text = source.text[start:end]
    is_read = span is not None and not re.search("[&<]", text) and len(text) <= _MAX_LENGTH
    return Written(source, start, text, scope, span) if span is not None and is_read else None


def definition_text(definition: Definition) -> Written | None:
    """Return the text that a name is defined with: of a parameter's default the part of `params`."""
    whole = find_text(definition.place, definition.attribute, definition.scope)
    if whole is not None and definition.attribute == "params" and whole.text != definition.text:
        found = re.search(rf"(?:^|\s){re.escape(definition.name)}\s*:?=\s*(?:\^\|?)?", whole.text)
        if found is None or not whole.text.startswith(definition.text, found.end()):
            return None
        whole = whole.part(found.end(), found.end() + len(definition.text))
    return whole._replace(key=definition.key) if whole is not None else None
