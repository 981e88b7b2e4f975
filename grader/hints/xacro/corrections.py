"""Edits that correct what xacro refuses: near names, the prefix xacro, arguments that other calls of a macro give."""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from grader import markup
from grader.hints.edits import Proposal
from grader.names import closest
from grader.source import Edit, Edits, Source
from grader.xacro.expander import Refusal
from grader.xacro.nodes import XacroNode
from grader.xacro.scopes import ScopePlace, UnknownName

_MAX_NAMES, _MAX_NODES = 8, 2000
_PREFIXED = ("property", "arg", "macro", "include", "if", "unless")
_NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'


def corrections(document: Source, files: Mapping[str, XacroNode], refusals: Sequence[Refusal]) -> Iterator[Proposal]:
    """Yield the edits that may correct what xacro refuses in a document with the files that it includes."""
    text = document.text
    if "xmlns:xacro" not in text and "xacro:" in text:
        _, start = document.element(0)
        end = markup.name_end(text, start)
        edit = document.edit(start, end, text[start:end] + _NAMESPACE)
        yield Proposal((edit,), "the prefix xacro, which is not declared")
    nodes = [node for file in files.values() for node in islice(_walk(file), _MAX_NODES)]
    macros = {node.attributes.get("name", "") for node in nodes if node.tag == "xacro:macro"}
    for node in nodes:
        if node.tag in _PREFIXED or node.tag in macros:
            edits = tuple(_tags(node.place, node.tag, f"xacro:{node.tag}"))
            yield Proposal(edits, f"<{node.tag}> without xacro:")
    for error, place, attribute in refusals[:_MAX_NAMES]:
        for edits in _respell(place, attribute, error.unknown) if error.unknown is not None else ():
            yield Proposal(edits, "a name that xacro does not know")
        own = next((node for node in nodes if node.place[:2] == place[:2]), None)
        others = [node.attributes for node in nodes if own is not None and node is not own and node.tag == own.tag]
        for given in [it for it in others if set(error.lacking) <= it.keys()] if error.lacking else ():
            for values in ({name: given[name] for name in error.lacking}, _negated(given, error.lacking)):
                yield Proposal(_give(place, values), f"this call gives no value for {' and '.join(values)}")


def _walk(node: XacroNode) -> Iterator[XacroNode]:
    for child in node.elements:
        yield child
        yield from _walk(child)


def _respell(place: ScopePlace, attribute: str | None, unknown: UnknownName) -> Iterator[Edits]:
    """Yield the edits that correct an unknown name where it is used, or where a similar one is defined."""
    near = closest(unknown.name, unknown.known)
    if near is not None:
        at, where = unknown.known[near] or (place, None)
        ways = [_rename(place, attribute, unknown.name, near)]
        ways += [_rename(at, where, near, unknown.name)] if where is not None else []
        yield from filter(None, ways)


def _negated(given: Mapping[str, str], names: Sequence[str]) -> Mapping[str, str]:
    return {name: re.sub(r"^(-?)(?=\d)", lambda it: "" if it[1] else "-", given[name]) for name in names}


def _give(place: ScopePlace, values: Mapping[str, str]) -> Edits:
    source, start = place.source.element(place.tag)
    ends = [markup.name_end(source.text, start), *(it.end for it in markup.attributes(source.text, start))]
    return (source.edit(ends[-1], ends[-1], "".join(f' {name}="{text}"' for name, text in values.items())),)


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
