"""The syntax of a C++ file, as far as it can be read: nodes with their places."""

import re
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING

from grader.base.source import Location, Source
from grader.ros.python.budget import Budget, OutOfBudget

if TYPE_CHECKING:
    from tree_sitter import Parser, TreeCursor

MAX_BYTES = 512 * 1024  # of a file
_BYTES_A_PART = 2  # charged before a file is parsed
# tree-sitter reports its progress after each 100 steps. 4,000 public files take one report for 200
# bytes, the slowest one for 60; what takes more is not read.
_BYTES_A_REPORT, _MIN_REPORTS = 60, 200
_MAX_ATTRIBUTES = 500  # before one declaration, each step of the parser is as long as there are
# Macros between a keyword and a name, or without a semicolon, which the grammar has no place for.
_IGNORED = re.compile(
    r"^[ \t]*#(?:[^\n]*\\\r?\n)*[^\n]*"
    r"|\b[A-Z][A-Z0-9_]*_(?:PUBLIC|EXPORT|IMPORT|LOCAL|API|VISIBILITY|PUBLIC_TYPE|HIDDEN)\b(?=\s+[A-Za-z_~:])"
    r"|\bRCLCPP_(?>\w*?PTR)(?>\w*?DEFINITIONS)\w*+\([^()\n]*\)"
    r"|\bQ_OBJECT\b",
    re.MULTILINE,
)


class CppNode:
    """A node of the syntax: what the grammar calls it, its place, and the nodes in it.

    `field` is its role in its parent: `name`, `body`. Of punctuation only what has a role is kept.
    """

    __slots__ = ("children", "end", "field", "file", "kind", "parent", "start")

    def __init__(
        self,
        file: "CppSyntax",
        kind: str,
        field: str | None,
        span: tuple[int, int],
        parent: "CppNode | None",
    ) -> None:
        """`span` are the bytes that it begins and ends at."""
        self.file, self.kind, self.field, self.parent = file, kind, field, parent
        self.start, self.end = span
        self.children: list[CppNode] = []

    def child(self, field: str) -> "CppNode | None":
        """Return the first child with a role."""
        for child in self.children:
            if child.field == field:
                return child
        return None

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

    def walk(self) -> "Iterator[CppNode]":
        """Yield the node and all nodes in it, in the order of the text."""
        pending = [self]
        while pending:
            node = pending.pop()
            yield node
            pending += reversed(node.children)

    def ancestors(self) -> "Iterator[CppNode]":
        """Yield the nodes around it, the innermost first."""
        node = self.parent
        while node is not None:
            yield node
            node = node.parent


class CppSyntax:
    """A C++ file: its text, and the root of its syntax.

    `unread` says why it is not read, as part of a sentence; `error` is the place of the first text
    that is no C++.
    """

    def __init__(self, path: str, text: str) -> None:
        self.source = Source(path, text)
        self.data = text.encode("utf-8", "replace")
        self.root = CppNode(self, "translation_unit", None, (0, len(self.data)), None)
        self.unread = ""
        self.error: Location | None = None

    def location(self, at: int) -> Location:
        """Return the location of a byte."""
        if len(self.data) == len(self.source.text):
            return self.source.at(at)
        return self.source.at(len(self.data[:at].decode("utf-8", "replace")))


def parse_cpp(data: bytes, path: str, budget: Budget) -> CppSyntax:
    """Return the syntax of a file, which ends where it is broken too badly. Never raises."""
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
    _copy(tree.walk(), syntax)
    return syntax


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
        return word if word.lstrip().startswith("#") else " " * len(word)

    return _IGNORED.sub(replaced, text)


def _copy(cursor: "TreeCursor", syntax: CppSyntax) -> None:
    """Copy the nodes of tree-sitter that have a name or a role."""
    parents = [syntax.root]
    if not cursor.goto_first_child():
        return
    while True:
        node, field = cursor.node, cursor.field_name
        assert node is not None
        parent = parents[-1]
        copy = CppNode(syntax, node.type, field, node.byte_range, parent)
        if node.is_named or field is not None:
            parent.children.append(copy)
        is_broken = node.is_error or (node.is_missing and node.type != ";")
        if is_broken and syntax.error is None:
            syntax.error = copy.location
        if cursor.goto_first_child():
            parents.append(copy)
            continue
        while not cursor.goto_next_sibling():
            if not cursor.goto_parent():
                return
            parents.pop()
            if not parents:
                return
