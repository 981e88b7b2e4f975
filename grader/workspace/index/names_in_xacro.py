"""The names of xacro in files as they are written, and where they are used.

They are those of arguments, properties, and macros with their parameters.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

from grader.base import markup
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.ros.package.robot_file import Read
from grader.ros.python.budget import Budget
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.xacro.tags import HANDLERS
from grader.ros.xacro.xacro_nodes import XacroNode, read_nodes, walk
from grader.ros.xml.parsing import XMLSyntaxError
from grader.workspace.index.written_names import (
    Role,
    Span,
    WrittenNames,
    written_name,
)

_COMMENT = on_use(r"<!--.*?(?:-->|\Z)", re.DOTALL)
_PIECE = on_use(
    r"(?<!\$)\$\$++[{(]|\$\{(?P<expression>[^{}]*)\}|\$\(\s*arg\s+(?P<argument>[^\s()]+)\s*\)"
)
_IN_EXPRESSION = on_use(
    r"\barg\(\s*['\"](?P<argument>\w+)['\"]|'[^']*'|\"[^\"]*\"|[\w)\]]\s*\.\s*\w+"
    r"|(?P<name>[^\W\d]\w*)(?!\s*=[^=])"
)
_PARAMETER = on_use(r"[*]*([^\s:=*]+)(?::?=(?:\^\|?)?(?:\$\{[^{}]*\}|'[^']*'|\"[^\"]*\"|\S)*)?")
_PREFIX = "xacro:"


class _XacroName(NamedTuple):
    """A name in a file; `scope` is the macro that it belongs to, empty outside of macros.

    Of an argument in a macro call, only the name of the macro is known: `called`.
    """

    kind: str
    name: str
    role: Role
    span: Span
    scope: str = ""
    called: str | None = None


class _Macro(NamedTuple):
    """A macro in a file: its name, what is in it, and the names that are its own."""

    name: str
    scope: str
    start: int
    end: int
    local: frozenset[str]


class _Document(NamedTuple):
    """The names in a file. Of those in expressions is not known what they are: `loose`."""

    source: Source
    names: tuple[_XacroName, ...]
    loose: tuple[_XacroName, ...]
    macros: tuple[_Macro, ...]


def names_in_xacro(urdfs: Sequence[Read], others: Sequence[Source]) -> WrittenNames:
    """Yield the names of xacro in the files of each robot, and then in other files.

    The owner is the path of the robot; each of the other files is on its own.
    """
    known = {}
    for urdf in urdfs:
        roots = getattr(urdf.reading.source, "documents", {})
        for path, root in roots.items():
            if path not in known:
                known[path] = _read_document(root)
        yield from _names_of_owner([known[path] for path in roots], urdf.path)
    for source in others:
        if source.path in known or "xacro" not in source.text:
            continue
        data = source.text.encode("utf-8", "surrogateescape")
        with suppress(XMLSyntaxError, ValueError, EvaluationFails, Undetermined):
            known[source.path] = _read_document(read_nodes(data, source.path, Budget()))
            yield from _names_of_owner([known[source.path]], source.path)


def _names_of_owner(documents: Sequence[_Document], owner: str) -> WrittenNames:
    """Yield the names in files that are expanded together."""
    scopes = {macro.name: macro.scope for document in documents for macro in document.macros}
    properties = set()
    for document in documents:
        properties |= {
            defined.name for defined in document.names if defined.kind == "xacro property"
        }
    for document in documents:
        yield from _names_of_tags(document, owner, scopes)
        source = document.source
        for used in document.loose:
            scope = _scope_at(document.macros, used.span[0], used.name)
            if scope:
                yield written_name(source, used.span, "xacro parameter", used.name, "use", scope)
            elif used.name in properties:
                yield written_name(source, used.span, "xacro property", used.name, "use", owner)


def _names_of_tags(document: _Document, owner: str, scopes: Mapping[str, str]) -> WrittenNames:
    """Yield the names of a file whose kind is known; `scopes` are those of macros."""
    for used in document.names:
        scope = used.scope
        if used.called is not None:
            scope = scopes.get(used.called, "")
            if not scope:
                continue  # no file of this owner has the macro
        yield written_name(
            document.source, used.span, used.kind, used.name, used.role, scope or owner
        )


def _read_document(root: XacroNode) -> _Document:
    source, _ = root.place.written
    macros = tuple(_macros(root))
    names: list[_XacroName] = []
    for node in walk(root):
        names += _names_in_tag(node, macros)
    loose = []
    text = _COMMENT.sub(lambda comment: " " * len(comment[0]), source.text)
    for piece in _PIECE.finditer(text):
        if piece["argument"] is not None:
            names.append(
                _XacroName("xacro argument", piece["argument"], "use", piece.span("argument"))
            )
        elif piece["expression"] is not None:
            for match in _IN_EXPRESSION.finditer(text, *piece.span("expression")):
                if match["argument"] is not None:
                    span = match.span("argument")
                    names.append(_XacroName("xacro argument", match["argument"], "use", span))
                elif match["name"] is not None:
                    loose.append(_XacroName("", match["name"], "use", match.span("name")))
    return _Document(source, tuple(names), tuple(loose), macros)


def _macros(root: XacroNode) -> Iterator[_Macro]:
    """Yield the macros of a file, outer ones first."""
    for node in walk(root):
        if node.tag != "xacro:macro":
            continue
        source, start = node.place.written
        name = node.attributes.get("name", "").removeprefix(_PREFIX)
        parameters = {match[1] for match in _PARAMETER.finditer(node.attributes.get("params", ""))}
        for inner in walk(node):
            if inner.tag == "xacro:property" and "scope" not in inner.attributes:
                parameters.add(inner.attributes.get("name", ""))
        end = markup.element_end(source.text, start)
        yield _Macro(name, f"{source.path}#{name}", start, end, frozenset(parameters))


def _names_in_tag(node: XacroNode, macros: Sequence[_Macro]) -> Iterator[_XacroName]:
    """Yield the names that a tag of xacro defines, and those that it uses, but for expressions."""
    source, start = node.place.written
    text = source.text
    written = {attribute.name: attribute.value for attribute in markup.attributes(text, start)}
    if node.tag == "xacro:macro":
        yield from _names_of_macro(source, written)
    elif node.tag == "xacro:call" and "macro" in written:
        span = written["macro"]
        yield _XacroName("xacro macro", text[slice(*span)], "use", span)
    elif node.tag.startswith(_PREFIX) and node.tag not in HANDLERS:
        yield from _names_in_call(text, start, node.tag, written)
    elif "name" in written:
        name = text[slice(*written["name"])]
        scope = "" if "scope" in written else _scope_at(macros, start, name)
        yield from _name_of_tag(node.tag, name, written["name"], scope)


def _name_of_tag(tag: str, name: str, span: Span, scope: str) -> Iterator[_XacroName]:
    """Yield the name in the attribute of an argument, a property or an inserted block."""
    if tag == "xacro:arg":
        yield _XacroName("xacro argument", name, "definition", span)
    elif tag == "xacro:property":
        kind = "xacro parameter" if scope else "xacro property"
        yield _XacroName(kind, name, "definition", span, scope)
    elif tag == "xacro:insert_block" and scope:
        yield _XacroName("xacro parameter", name, "use", span, scope)


def _names_of_macro(source: Source, written: Mapping[str, Span]) -> Iterator[_XacroName]:
    """Yield the name of a macro that is defined, and those of its parameters."""
    start, end = written.get("name", (0, 0))
    name = source.text[start:end].removeprefix(_PREFIX)
    if name:
        yield _XacroName("xacro macro", name, "definition", (end - len(name), end))
    for match in _PARAMETER.finditer(source.text, *written.get("params", (0, 0))):
        scope = f"{source.path}#{name}"
        yield _XacroName("xacro parameter", match[1], "definition", match.span(1), scope)


def _names_in_call(
    text: str, start: int, tag: str, written: Mapping[str, Span]
) -> Iterator[_XacroName]:
    """Yield the name of a macro in the tags of its call, and the names of its arguments."""
    called = tag.removeprefix(_PREFIX).rpartition(".")[2]
    head = markup.name_end(text, start)
    yield _XacroName("xacro macro", called, "use", (head - len(called), head))
    end = markup.element_end(text, start)
    closing = text.rfind("</", start, end)
    if closing >= 0 and text[closing + 2 : end].strip(" \t\r\n>") == tag:
        last = text.rindex(called, 0, end) + len(called)
        yield _XacroName("xacro macro", called, "use", (last - len(called), last))
    for attribute, (value_start, _) in written.items():
        at = text.rindex(attribute, start, value_start)
        span = at, at + len(attribute)
        yield _XacroName("xacro parameter", attribute, "use", span, called=called)


def _scope_at(macros: Sequence[_Macro], offset: int, name: str) -> str:
    """Return the innermost macro around an offset that has a name as its own; empty without one."""
    scope = ""  # `macros` has outer ones first
    for macro in macros:
        if macro.start < offset < macro.end and name in macro.local:
            scope = macro.scope
    return scope
