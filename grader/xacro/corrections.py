"""Edits that may correct what xacro refuses: unknown names, calls that do not fit a macro, a missing include, XML."""

import posixpath
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from grader import markup
from grader.edits import Proposal, element_text, with_attribute, with_child, with_sibling
from grader.names import closest
from grader.source import Edit, Edits, Source
from grader.xacro.nodes import XacroNode
from grader.xacro.scopes import ScopePlace, UnknownName, XacroFails

_MAX_NAMES = 8
_MAX_VALUES = 40
_DEFINING = ("property", "arg", "macro")
_UNKNOWN = "a name that xacro does not know"
_NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'

Calls = Mapping[tuple[str, int], tuple[str, ScopePlace, Mapping[tuple[str, int], ScopePlace]]]


class Refusal(NamedTuple):
    """What xacro refuses, and where: in an attribute, or without one in the tag itself."""

    error: XacroFails
    place: ScopePlace
    attribute: str | None


class Corrector:
    """The documents of an expansion, and what was refused in them. `others` are xacro files that are not included."""

    def __init__(
        self, documents: Mapping[str, XacroNode], calls: Calls, others: Callable[[], Mapping[str, str]]
    ) -> None:
        self._documents, self._calls, self._others = documents, calls, others

    def corrections(
        self, refusals: Sequence[Refusal], names: Sequence[str], numbers: Sequence[str]
    ) -> Iterator[Proposal]:
        """Yield the edits that may correct refusals; `names` and `numbers` are those that a reference has."""
        for refusal in refusals[:_MAX_NAMES]:
            unknown, lacking = refusal.error.unknown, refusal.error.lacking
            if unknown is not None:
                for node in (it for tag in _DEFINING for it in self._nodes(tag) if _name_of(it) == unknown.name):
                    edits = tuple(_tags(node.place, node.tag, f"xacro:{node.tag}"))
                    yield Proposal(edits, f"<{node.tag}> without xacro:", f"write <xacro:{node.tag}>")
                for edits in self._respell(refusal.place, refusal.attribute, unknown):
                    yield Proposal(edits, _UNKNOWN, "correct the name")
                source, start = refusal.place.source.element(0)
                for xml, cause, action in self._additions(source.path, unknown, numbers):
                    yield Proposal((with_child(source, start, xml),), cause, action)
            what = " and ".join(lacking)
            for value in self._values(refusal.place, lacking, [*numbers, *names]) if lacking else ():
                edits = self._give(refusal.place, lacking, value)
                yield Proposal(edits, f"this call gives no value for {what}", f"give {what} a value")
        yield from self._calls_of_macros(names)

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

    def _additions(self, path: str, unknown: UnknownName, numbers: Sequence[str]) -> Iterator[tuple[str, str, str]]:
        """Yield what may define a name: the include of a file that does, or a property with one of the numbers."""
        name, is_included = unknown.name, False
        definition = re.compile(rf"<xacro:(?:macro|property|arg)\b[^>]*\bname\s*=\s*[\"']{re.escape(name)}[\"']")
        for other, text in self._others().items():
            if definition.search(text):
                is_included, include = True, f'<xacro:include filename="{self._path(path, other)}"/>'
                yield include, "a file that is not included", f"include {posixpath.basename(other)}"
        is_like = closest(name, unknown.known) is not None
        for value in () if is_included or is_like else numbers[:_MAX_VALUES]:
            found = f'<xacro:property name="{name}" value="{value}"/>'
            yield found, f"the property {name} is not defined", f"define the property {name}"

    def _path(self, path: str, other: str) -> str:
        """Return how a file is named in an include: as the files beside it are."""
        for node in self._nodes("xacro:include"):
            folder, slash, _ = node.attributes.get("filename", "").rpartition("/")
            if "$(find" in folder and posixpath.dirname(other).endswith(folder.partition(")")[2].strip("/")):
                return f"{folder}{slash}{posixpath.basename(other)}"
        return posixpath.relpath(other, posixpath.dirname(path) or ".")

    def _values(self, place: ScopePlace, lacking: Sequence[str], known: Sequence[str]) -> Iterator[Mapping[str, str]]:
        """Yield values for what a call lacks: those of other calls, and known ones."""
        for other in self._other_calls(place):
            if set(lacking) <= other.keys():
                yield {name: other[name] for name in lacking}
        if any(name.startswith("*") for name in lacking):
            yield dict.fromkeys(lacking, '<origin xyz="0 0 0"/>')
        elif len(lacking) == 1:
            yield from ({lacking[0]: value} for value in ("0", "1", "-1", *known[:_MAX_VALUES]))

    def _other_calls(self, place: ScopePlace) -> Iterator[dict[str, str]]:
        """Yield what the other calls of a macro give, blocks by the names of the parameters."""
        tag = next((node.tag for node in self._nodes() if node.place[:2] == place[:2]), "")
        macros = (it for it in self._nodes("xacro:macro") if f"xacro:{_name_of(it)}" == tag)
        parameters = next((it.attributes.get("params", "").split() for it in macros), [])
        for node in self._nodes(tag):
            if node.place[:2] != place[:2]:
                blocks = [element_text(*child.place.source.element(child.place.tag)) for child in node.elements]
                names = [name for name in parameters if name.startswith("*")]
                yield {**node.attributes, **dict(zip(names, blocks, strict=False))}

    def _give(self, place: ScopePlace, lacking: Sequence[str], values: Mapping[str, str]) -> Edits:
        source, start = place.source.element(place.tag)
        blocks = [values[name] for name in lacking if name.startswith("*")]
        if blocks:
            return (with_child(source, start, "\n".join(blocks)),)
        added = "".join(f' {name}="{values[name]}"' for name in lacking)
        ends = [markup.name_end(source.text, start), *(it.end for it in markup.attributes(source.text, start))]
        return (source.edit(ends[-1], ends[-1], added),)

    def _calls_of_macros(self, names: Sequence[str]) -> Iterator[Proposal]:
        """Call a macro that is never called; write the prefix of a call that lacks it."""
        called = {name for name, _, _ in self._calls.values()}
        *_, last = [None, *next(iter(self._documents.values())).elements]
        for node in islice(self._nodes("xacro:macro"), _MAX_NAMES):
            name = _name_of(node)
            cause = f"a call of the macro {name} without xacro:"
            for plain in self._nodes(name):
                edits = tuple(_tags(plain.place, name, f"xacro:{name}"))
                yield Proposal(edits, cause, "write xacro: before the name of the macro")
            needed = [it for it in node.attributes.get("params", "").split() if "=" not in it]
            is_simple = len(needed) <= 1 and not any(it.startswith("*") for it in needed)
            for value in (names if needed else [""]) if last and is_simple and name not in called else ():
                given = "".join(f' {it}="{value}"' for it in needed)
                edit = with_sibling(*last.place.source.element(last.place.tag), f"<xacro:{name}{given}/>")
                yield Proposal((edit,), f"the macro {name} is never called", f"call the macro {name}")

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
