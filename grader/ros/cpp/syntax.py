"""The syntax of a C++ file, as far as it can be read: nodes with their places."""

import re
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING

from grader.base.grouping import Span
from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.ros.python.budget import Budget, OutOfBudget

if TYPE_CHECKING:
    from tree_sitter import Parser, TreeCursor

MAX_BYTES = 512 * 1024  # of a file
_BYTES_A_PART = 2  # charged before a file is parsed
# tree-sitter reports its progress after each 100 steps. 4,000 public files take one report for 200
# bytes, the slowest one for 60; what takes more is not read.
_BYTES_A_REPORT = 60
_MIN_REPORTS = 200
_MAX_ATTRIBUTES = 500  # before one declaration, each step of the parser is as long as there are
# Macros between a keyword and a name, or without a semicolon, which the grammar has no place for.
_IGNORED = on_use(
    r"^[ \t]*#(?:[^\n]*\\\r?\n)*[^\n]*"
    r"|\b[A-Z][A-Z0-9_]*_(?:PUBLIC|EXPORT|IMPORT|LOCAL|API|VISIBILITY|PUBLIC_TYPE|HIDDEN)\b(?=\s+[A-Za-z_~:])"
    r"|\bRCLCPP_(?>\w*?PTR)(?>\w*?DEFINITIONS)\w*+\([^()\n]*\)"
    r"|\bQ_OBJECT\b"
    # The instantiation of a template declares nothing.
    r"|^[ \t]*template[ \t]+(?:class|struct)[ \t]+[^;{}]{0,300}+;",
    re.MULTILINE,
)
# `extern "C" {` for compilers of C++, whose brace another condition closes.
_OF_CPP = r"^[ \t]*#[ \t]*if(?:def)?\b[^\n]{0,80}\b__cplusplus\b[^\n]{0,80}\n\s*"
_LINKAGE = on_use(
    rf'{_OF_CPP}(?:extern\s+"C"\s*\{{|\}})[ \t]*(?://[^\n]*|/\*[^*\n]*\*/)?\s*#[ \t]*endif\b',
    re.MULTILINE,
)
# What holds statements, so that an error in one leaves the others as they are.
_HOLDERS = (
    *("compound_statement", "translation_unit", "declaration_list", "field_declaration_list"),
    *("preproc_if", "preproc_ifdef", "preproc_else", "preproc_elif"),
)
_TEXTS = ("comment", "string_literal", "raw_string_literal", "char_literal")
_PAIRS = {")": "(", "]": "[", "}": "{"}


class CppNode:
    """A node of the syntax: what the grammar calls it, its place, and the nodes in it.

    `field` is its role in its parent: `name`, `body`. Of punctuation only what has a role is kept.
    `index` is its place among the nodes of the file, `behind` the place after the last node in it.
    `called` is the name of what a call calls, once it is asked for. The root is its own parent.
    """

    __slots__ = (
        "behind",
        "called",
        "children",
        "end",
        "field",
        "file",
        "index",
        "kind",
        "parent",
        "start",
    )

    def __init__(
        self,
        file: "CppSyntax",
        kind: str,
        field: str | None,
        span: Span,
        parent: "CppNode | None",
    ) -> None:
        """`span` are the bytes that it begins and ends at."""
        self.file = file
        self.kind = kind
        self.field = field
        self.parent = parent or self
        self.start, self.end = span
        self.children: list[CppNode] = []
        self.index = self.behind = len(file.nodes)
        self.called: str | None = None

    def __bool__(self) -> bool:
        """Whether it is a node: NO_NODE is none."""
        return self.kind != ""

    def child(self, field: str) -> "CppNode":
        """Return the first child with a role; NO_NODE without one."""
        return next((child for child in self.children if child.field == field), NO_NODE)

    @property
    def first(self) -> "CppNode":
        """The first child; NO_NODE without one."""
        return self.children[0] if self.children else NO_NODE

    @property
    def code(self) -> "list[CppNode]":
        """The children without comments."""
        return [child for child in self.children if child.kind != "comment"]

    def of_kind(self, *kinds: str) -> "list[CppNode]":
        """Return the children of these kinds."""
        return [child for child in self.children if child.kind in kinds]

    @property
    def text(self) -> str:
        """The text of the node."""
        return self.file.data[self.start : self.end].decode("utf-8", "replace")

    @property
    def location(self) -> Location:
        """Where the node begins."""
        return self.file.location(self.start)

    def walk(self) -> "list[CppNode]":
        """Return the node and all nodes in it, in the order of the text."""
        return self.file.nodes[self.index : self.behind]

    def ancestors(self) -> "Iterator[CppNode]":
        """Yield the nodes around it, the innermost first."""
        node = self
        while node.parent is not node:
            node = node.parent
            yield node


CppNodes = list[CppNode]
CppNodesByName = dict[str, CppNodes]


class CppSyntax:
    """A C++ file: its text, the root of its syntax, and its nodes in the order of the text.

    `unread` says why it is not read, as part of a sentence. `broken` are the statements, directives
    and members with a text that is no C++, around which nothing is lost; `error` is the place of
    the first other one.
    """

    def __init__(self, path: str, text: str) -> None:
        self.source = Source(path, text)
        self.data = text.encode("utf-8", "replace")
        self.nodes: CppNodes = []
        self.root = CppNode(self, "translation_unit", None, (0, len(self.data)), None)
        self.add(self.root)
        self.unread = ""
        self.error: Location | None = None
        self.broken: CppNodes = []

    def add(self, node: CppNode) -> None:
        """Add a node to its parent, and behind the nodes that the file has."""
        if node.parent is not node:
            node.parent.children.append(node)
        self.nodes.append(node)
        node.behind = len(self.nodes)

    def location(self, at: int) -> Location:
        """Return the location of a byte."""
        if len(self.data) == len(self.source.text):
            return self.source.at(at)
        return self.source.at(len(self.data[:at].decode("utf-8", "replace")))


# What stands for a node that is missing: it has no kind, text or children.
NO_NODE = CppNode(CppSyntax("", ""), "", None, (0, 0), None)


def parse_cpp(data: bytes, path: str, budget: Budget) -> CppSyntax:
    """Return the syntax of a file, which ends where it is broken too badly. It never raises."""
    syntax = CppSyntax(path, data.decode("utf-8", "replace"))
    if len(syntax.data) > MAX_BYTES:
        syntax.unread = "the file is too large"
        return syntax
    try:
        budget.charge(1 + len(syntax.data) // _BYTES_A_PART)
    except OutOfBudget:
        syntax.unread = "the submission is too large"
        return syntax
    if syntax.data.count(b"[[") > _MAX_ATTRIBUTES:
        syntax.unread = "the file has too many attributes"
        return syntax
    read = _without_macros(syntax.source.text).encode("utf-8", "replace")
    most = _MIN_REPORTS + len(read) // _BYTES_A_REPORT
    reports = 0

    def is_enough(_: int, has_error: bool) -> bool:  # noqa: ARG001
        nonlocal reports
        reports += 1
        return reports > most

    parser = _parser()
    try:
        tree = parser.parse(lambda at, _: read[at : at + MAX_BYTES], progress_callback=is_enough)
    except ValueError:  # where the callback ends it
        parser.reset()
        syntax.unread = "the file takes too long to read"
        return syntax
    if tree.root_node.is_error:
        syntax.error = syntax.location(0)
    for error in _copy(tree.walk(), syntax):
        _add_error(syntax, error)
    return syntax


def _add_error(syntax: CppSyntax, error: CppNode) -> None:
    """Add a text that is no C++: it leaves open the statement around it, or else the file."""
    statement = error
    if error.start == error.end:  # it is missing
        statement = error.parent
    for around in statement.ancestors():
        if around.kind in _HOLDERS and statement.field not in ("condition", "name"):
            break
        statement = around
    if statement in syntax.broken:
        return
    is_alone = all(around.kind != "ERROR" for around in statement.ancestors())
    if is_alone and _is_balanced(statement):
        syntax.broken.append(statement)
    elif not syntax.error:
        syntax.error = error.location


def _is_balanced(statement: CppNode) -> bool:
    """Return whether each bracket in a statement has the one that closes it."""
    data = bytearray(statement.file.data[statement.start : statement.end])
    for node in statement.walk():
        if node.kind in _TEXTS:
            length = node.end - node.start
            data[node.start - statement.start : node.end - statement.start] = b" " * length
    opened = []
    for letter in data.decode("latin-1"):
        if letter in "([{":
            opened.append(letter)
        elif letter in _PAIRS and (not opened or opened.pop() != _PAIRS[letter]):
            return False
    return not opened


@cache
def _parser() -> "Parser":
    # Late: few workspaces have C++.
    from tree_sitter import Language, Parser
    from tree_sitter_cpp import language

    return Parser(Language(language()))


def _without_macros(text: str) -> str:
    """Return a text with blanks in place of macros that declare nothing."""

    def replaced(match: re.Match[str]) -> str:
        word = match[0]
        return word if word.lstrip().startswith("#") else _blanked(match)

    if "__cplusplus" in text:
        text = _LINKAGE.sub(_blanked, text)
    return _IGNORED.sub(replaced, text)


def _blanked(match: re.Match[str]) -> str:
    """Return blanks in place of a text, in as many lines."""
    return "".join(letter if letter == "\n" else " " * len(letter.encode()) for letter in match[0])


def _copy(cursor: "TreeCursor", syntax: CppSyntax) -> CppNodes:
    """Copy the nodes of tree-sitter that have a name or a role; return those that are no C++."""
    errors: CppNodes = []
    parents = [syntax.root]
    root = cursor.node
    has_errors = root is not None and root.has_error
    if not cursor.goto_first_child():
        return errors
    while True:
        node = cursor.node
        field = cursor.field_name
        assert node is not None
        is_kept = node.is_named or field is not None
        if is_kept or has_errors:
            copy = CppNode(syntax, node.type, field, node.byte_range, parents[-1])
            if is_kept:
                syntax.add(copy)
            if node.is_error or (node.is_missing and node.type != ";"):
                errors.append(copy)
            if cursor.goto_first_child():
                parents.append(copy)
                continue
        while not cursor.goto_next_sibling():
            parents.pop().behind = len(syntax.nodes)
            if not parents or not cursor.goto_parent():
                return errors
