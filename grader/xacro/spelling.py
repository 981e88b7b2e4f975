"""Edits that correct a name which xacro does not know: where it is used, or where a similar one is defined."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator

from grader import markup
from grader.names import closest
from grader.source import Correction, Edit
from grader.xacro.scopes import Place, UnknownName

_MAX_NAMES = 8
_CAUSE = "a name that xacro does not know"

Edits = tuple[Edit, ...]


def respelled(unknown: Iterable[tuple[UnknownName, Place, str | None]]) -> list[Correction]:
    """Return the edits that may correct unknown names, each used in an attribute at a place, or by the tag itself."""
    uses = list(unknown)
    counts = Counter(name.name for name, _, _ in uses)
    found: list[Edits] = []
    for (name, known), place, attribute in uses[:_MAX_NAMES]:
        near = closest(name, known)
        if near is None:
            continue
        ways = [_renamed(place, attribute, name, near)]
        defined = known[near]
        if defined is not None:
            ways.append(_renamed(*defined, near, name))
        found += reversed(ways) if counts[name] > 1 else ways  # it is rare to misspell a name twice in the same way
    return [Correction(edits, _CAUSE, "correct the name") for edits in dict.fromkeys(found) if edits]


def _renamed(place: Place, attribute: str | None, old: str, new: str) -> Edits:
    """Return the edit of an attribute's value; without an attribute, of the name of one, of the tag, or of any value."""
    source, start = place.source.element(place.tag)
    text = source.text
    for found in markup.attributes(text, start):
        if attribute is None and found.name == old:
            return (source.edit(found.start, found.end, new + text[found.start + len(old) : found.end]),)
    tags = tuple(_tags(place, old, new)) if attribute is None else ()
    for found in () if tags else markup.attributes(text, start):
        value = text[found.value_start : found.value_end]
        changed = re.sub(rf"(?<![\w.]){re.escape(old)}(?!\w)", new, value, count=0 if "$" in value else 1)
        if attribute in (None, found.name) and changed != value:
            head, tail = text[found.start : found.value_start], text[found.value_end : found.end]
            return (source.edit(found.start, found.end, f"{head}{changed}{tail}"),)
    return tags


def _tags(place: Place, old: str, new: str) -> Iterator[Edit]:
    """Yield the edits of a call's start tag, and of its end tag if it has one."""
    source, start = place.source.element(place.tag)
    tag = source.text[start : markup.name_end(source.text, start)]
    if tag != f"<xacro:{old}":
        return
    yield source.edit(start, start + len(tag), f"<xacro:{new}")
    end = markup.element_end(source.text, start)
    closing = re.search(rf"</xacro:{re.escape(old)}\s*>\Z", source.text[start:end])
    if closing is not None:
        yield source.edit(start + closing.start(), end, closing[0].replace(old, new))
