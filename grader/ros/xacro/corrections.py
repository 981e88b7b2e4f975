"""The edits that correct what xacro refuses.

There is one edit where it surely is meant, and others that hints try.
"""

import re
from collections.abc import Iterator

from grader.base import markup
from grader.base.element_edits import element_text, tag_edits, without_element
from grader.base.patterns import on_use
from grader.base.problems import Fix
from grader.base.records import Named
from grader.base.source import Edits, Location
from grader.base.text import quoted
from grader.ros.python.values import EvaluationFails
from grader.ros.xacro.scopes import ScopePlace, UnknownName, XacroFails
from grader.ros.xacro.texts import TEXT_IN_QUOTES
from grader.ros.xacro.xacro_files import Files, XmlFails
from grader.ros.xacro.xacro_nodes import XacroNode

_EXPRESSION = on_use(r"\$\{([^{}]*)\}")  # no brace inside: else many that open take quadratic time
_NUMBER = on_use(r"-?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?")
_PRODUCT = on_use(r"-?\s*+[\w.]++(?:\s*+[*/]\s*+[\w.]++)*+")


class _XacroCorrection(Named):
    """The fix of what xacro refuses, and where something is read as another thing."""

    fix: Fix
    location: Location
    problem: str = ""  # what is wrong, where it says more than xacro's message


class Refusal(Named):
    """What xacro refuses, and where: in an attribute, or without one in the tag itself."""

    error: EvaluationFails
    place: ScopePlace
    attribute: str | None
    correction: _XacroCorrection | None = None  # that is surely meant

    @property
    def unknown(self) -> UnknownName | None:
        """The name that is not known, if that is why."""
        return self.error.unknown if isinstance(self.error, XacroFails) else None


def find_correction(refusal: Refusal, files: Files) -> _XacroCorrection | None:
    """Return the correction of a file that is no XML, or of a name that is defined below."""
    error = refusal.error
    location = refusal.place.at(refusal.attribute)
    if isinstance(error, XmlFails) and error.repair:
        return _XacroCorrection(Fix(error.repair, error.assumed), location)
    unknown = refusal.unknown
    moved = _move_to_top(unknown, files) if unknown else None
    if not unknown or moved is None:
        return None
    is_above = moved[1][1:3] <= location[1:3]
    if is_above and moved[1].path == location.path:  # in another file it may always be below
        return None
    named = f"the {unknown.kind} {quoted(unknown.name)}"
    line = moved[1].line
    sentence = f"{named} of line {line} is read above its use"
    problem = f"{named} is defined in line {line}, below its use: move it up"
    return _XacroCorrection(Fix(moved[0], sentence), moved[1], problem)


def _move_to_top(unknown: UnknownName, files: Files) -> tuple[Edits, Location] | None:
    """Return the edits that move what defines a name to the top, and where it is.

    Returns None if nothing below defines it.
    """
    tag = {"property": "xacro:property", "macro": "xacro:macro"}.get(unknown.kind)
    root = next(iter(files.documents.values()))
    definitions = []  # each with the child of the root that it is, or that includes it
    for child in root.elements:
        nodes = [child] if child.tag == tag else _list_included(child, tag, files)
        for node in nodes:
            if node.attributes.get("name", "").removeprefix("xacro:") == unknown.name:
                definitions.append((child, node))
    if len(definitions) != 1:
        return None
    [(child, node)] = definitions
    if child is root.elements[0]:
        return None
    source, start = child.place.source.element(child.place.tag)
    _, first = source.element(root.elements[0].place.tag)
    block = f"{element_text(source, start)}\n{markup.indentation(source.text, first)}"
    edits = (source.edit(first, first, block), without_element(source, start))
    return edits, node.place.at()


def _list_included(child: XacroNode, tag: str | None, files: Files) -> list[XacroNode]:
    """Return the definitions in the files that an element includes."""
    paths = files.followed.get((child.place.source.path, child.place.tag), [])
    documents = [files.documents[path] for path in paths if path in files.documents]
    return [node for root in documents for node in root.elements if node.tag == tag]


def respellings(
    refusal: Refusal, unknown: UnknownName, similar: str | None
) -> Iterator[tuple[Edits, str]]:
    """Yield the edits that correct an unknown name where it is used, and what is assumed.

    Others correct a similar name where it is defined.
    """
    if similar is None:
        return
    definition = unknown.known.get(similar) or (refusal.place, None)
    names = [(refusal.place, refusal.attribute, unknown.name, similar)]
    if definition[1] is not None:
        names.append((*definition, similar, unknown.name))
    for place, attribute, old, new in names:
        edits = _rename(place, attribute, old, new)
        if edits:
            yield edits, f"the {unknown.kind} {quoted(old)} is read as {quoted(new)}"


def negated(text: str) -> str:
    """Return a number or an expression of xacro with the other sign; any other text as it is."""
    inner = text[2:-1].strip() if _EXPRESSION.fullmatch(text) else ""
    value = inner or text
    if not (inner or _NUMBER.fullmatch(text)) or TEXT_IN_QUOTES.search(value):
        return text
    if inner and not _PRODUCT.fullmatch(inner):
        return f"${{-({inner})}}"
    value = value[1:].lstrip() if value.startswith("-") else f"-{value}"
    return f"${{{value}}}" if inner else value


def _rename(place: ScopePlace, attribute: str | None, old: str, new: str) -> Edits:
    """Return the edit of an attribute's value.

    Without an attribute, it is of an attribute's name, the tag, or any value.
    """
    source, start = place.source.element(place.tag)
    if attribute is None:
        tags = tag_edits(*place.written, f"xacro:{old}", f"xacro:{new}")
        if tags:
            return tags
    for markup_attribute in markup.attributes(source.text, start):
        whole = source.text[markup_attribute.start : markup_attribute.end]
        changed = re.sub(
            rf"(?<![\w.]){re.escape(old)}(?!\w)", new, whole, count=0 if "$" in whole else 1
        )
        if attribute in (None, markup_attribute.name) and changed != whole:
            return (source.edit(markup_attribute.start, markup_attribute.end, changed),)
    return ()
