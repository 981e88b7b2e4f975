"""Edits that correct what xacro refuses: near names, the prefix xacro, arguments that other calls of a macro give."""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from grader import markup
from grader.edits import Proposal, with_attribute
from grader.names import closest
from grader.source import Edit, Edits, Source
from grader.xacro.nodes import XacroNode
from grader.xacro.scopes import ScopePlace, UnknownName, XacroFails

_MAX_NAMES = 8
_DEFINING = ("property", "arg", "macro")
_UNKNOWN = "a name that xacro does not know"
_NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'


class Refusal(NamedTuple):
    """What xacro refuses, and where: in an attribute, or without one in the tag itself."""

    error: XacroFails
    place: ScopePlace
    attribute: str | None


class Corrector:
    """The documents of an expansion, and what was refused in them."""

    def __init__(self, documents: Mapping[str, XacroNode]) -> None:
        self._documents = documents

    def corrections(self, refusals: Sequence[Refusal]) -> Iterator[Proposal]:
        """Yield the edits that may correct refusals."""
        for refusal in refusals[:_MAX_NAMES]:
            unknown, lacking = refusal.error.unknown, refusal.error.lacking
            if unknown is not None:
                for node in (it for tag in _DEFINING for it in self._nodes(tag) if _name_of(it) == unknown.name):
                    edits = tuple(_tags(node.place, node.tag, f"xacro:{node.tag}"))
                    yield Proposal(edits, f"<{node.tag}> without xacro:", f"write <xacro:{node.tag}>")
                for edits in self._respell(refusal.place, refusal.attribute, unknown):
                    yield Proposal(edits, _UNKNOWN, "correct the name")
            for values in self._values(refusal.place, lacking):
                what = " and ".join(lacking)
                edits = self._give(refusal.place, values)
                yield Proposal(edits, f"this call gives no value for {what}", f"give {what} a value")
        for node in islice(self._nodes("xacro:macro"), _MAX_NAMES):
            name = _name_of(node)
            for plain in self._nodes(name):
                edits = tuple(_tags(plain.place, name, f"xacro:{name}"))
                yield Proposal(
                    edits, f"a call of the macro {name} without xacro:", "write xacro: before the name of the macro"
                )

    def _respell(self, place: ScopePlace, attribute: str | None, unknown: UnknownName) -> Iterator[Edits]:
        """Yield the edits that correct an unknown name where it is used or a similar one defined; add a parameter."""
        near = closest(unknown.name, unknown.known)
        is_few = attribute is None and len(unknown.known) <= _MAX_NAMES
        ways: list[Edits] = []
        for name in [near] if near is not None else unknown.known if is_few else ():
            ways.append(_rename(place, attribute, unknown.name, name))
            at, where = unknown.known[name] or (place, None)
            if where is not None and name == near:
                ways.append(_rename(at, where, name, unknown.name))
            elif where == "params":
                source, start = at.source.element(at.tag)
                params = markup.attribute(source.text, start, "params")
                given = source.text[params.value_start : params.value_end] if params is not None else ""
                ways.append((with_attribute(source, start, "params", f"{given} {unknown.name}".strip()),))
        yield from filter(None, ways)

    def _values(self, place: ScopePlace, lacking: Sequence[str]) -> Iterator[Mapping[str, str]]:
        """Yield values for what a call lacks: those of other calls of the macro, also with another sign."""
        tag = next((node.tag for node in self._nodes() if node.place[:2] == place[:2]), "")
        for other in self._nodes(tag) if lacking else ():
            if other.place[:2] != place[:2] and set(lacking) <= other.attributes.keys():
                given = {name: other.attributes[name] for name in lacking}
                yield {name: text[1:] if text.startswith("-") else f"-{text}" for name, text in given.items()}
                yield given

    def _give(self, place: ScopePlace, values: Mapping[str, str]) -> Edits:
        source, start = place.source.element(place.tag)
        ends = [markup.name_end(source.text, start), *(it.end for it in markup.attributes(source.text, start))]
        return (source.edit(ends[-1], ends[-1], "".join(f' {name}="{text}"' for name, text in values.items())),)

    def _nodes(self, tag: str = "") -> Iterator[XacroNode]:
        for document in self._documents.values():
            yield from (node for node in islice(_walk(document), 2000) if tag in ("", node.tag))


def _walk(node: XacroNode) -> Iterator[XacroNode]:
    for child in node.elements:
        yield child
        yield from _walk(child)


def _name_of(macro: XacroNode) -> str:
    return macro.attributes.get("name", "").removeprefix("xacro:")


def _rename(place: ScopePlace, attribute: str | None, old: str, new: str) -> Edits:
    """Return the edit of an attribute's value; without an attribute, of an attribute's name, the tag, or any value."""
    source, start = place.source.element(place.tag)
    tags = tuple(_tags(place, f"xacro:{old}", f"xacro:{new}")) if attribute is None else ()
    for found in () if tags else markup.attributes(source.text, start):
        whole = source.text[found.start : found.end]
        changed = re.sub(rf"(?<![\w.]){re.escape(old)}(?!\w)", new, whole, count=0 if "$" in whole else 1)
        if attribute in (None, found.name) and changed != whole:
            return (source.edit(found.start, found.end, changed),)
    return tags


def _tags(place: ScopePlace, old: str, new: str) -> Iterator[Edit]:
    """Yield the edits of a call's start tag, and of its end tag if it has one."""
    source, start = place.source.element(place.tag)
    if source.text[start : markup.name_end(source.text, start)] == f"<{old}":
        yield source.edit(start, start + len(old) + 1, f"<{new}")
        end = markup.element_end(source.text, start)
        closing = re.search(rf"</{re.escape(old)}\s*>\Z", source.text[start:end])
        if closing is not None:
            yield source.edit(start + closing.start(), end, f"</{new}>")


def well_formed(source: Source) -> Iterator[Proposal]:
    """Yield the edit that declares the prefix xacro."""
    text = source.text
    if "xmlns:xacro" not in text and "xacro:" in text:
        _, start = source.element(0)
        end = markup.name_end(text, start)
        edit = source.edit(start, end, text[start:end] + _NAMESPACE)
        yield Proposal((edit,), "the prefix xacro, which is not declared", "declare the prefix xacro")
