"""Parses Python text with Python's own parser; whatever it refuses is data, not an exception."""

import ast
import re
import sys
import tokenize
import warnings
from codecs import lookup
from collections.abc import Sequence
from functools import lru_cache
from io import BytesIO
from typing import NamedTuple

from grader.base.merge_conflicts import resolve_conflicts
from grader.base.reuse import reuse
from grader.base.source import Location, Source
from grader.ros.python.bindings import bound_names
from grader.ros.python.walking import children, walk

_SLOW_ENCODINGS = (
    "idna",
    "punycode",
)  # encodings of domain names; their time grows with the square of the length
_JAZZY = (3, 12)  # the Python version of ROS 2 Jazzy
# What Python 3.12 added: type parameters and the statement type (PEP 695), and in a line, an
# f-string whose braces are still open at its quote or at the end of the line (PEP 701).
_TYPES = re.compile(
    r"^[ \t]*(?:type[ \t]+\w+[ \t]*[=\[]|(?:async[ \t]+)?(?:def|class)[ \t]+\w+[ \t]*\[)",
    re.MULTILINE,
)
_OPEN_BRACES = re.compile(
    r"""\b[rR]?[fF][rR]?(['"])(?:(?!\1).)*?(?<!\{)\{(?:(?!\1)[^{}])*(?:\1|$)"""
)
_MAX_SEARCHED = 1_000  # characters of a line
_FUNCTIONS = ("def ", "lambda", "for ")  # what has code of its own; a comprehension has
_MAX_FUNCTIONS = 2_000  # of a file that is compiled


class Position(NamedTuple):
    """A place in a Python file; line and column count from 1."""

    line: int
    column: int


START = Position(1, 1)


_Placed = ast.expr | ast.stmt | ast.excepthandler | ast.alias | ast.keyword


def position_of(node: _Placed) -> Position:
    """Return the position of a node."""
    return Position(node.lineno, node.col_offset + 1)


_TOO_DEEP = "too deeply nested for Python to read"


class Code(NamedTuple):
    """A parsed file with its text."""

    source: Source
    tree: ast.Module
    conflict: tuple[str, Position] | None = None  # of git, without which it was parsed

    def at(
        self, node: ast.expr | ast.stmt | ast.excepthandler | ast.alias | ast.keyword
    ) -> Location:
        """Return the location of a node."""
        return location_in(self.source, position_of(node))


@lru_cache(maxsize=4)  # the readers of a module follow each other
def every_node(tree: ast.Module) -> Sequence[ast.AST]:
    """Return all nodes of a module, level by level."""
    return walk(tree)


class SyntaxFault(NamedTuple):
    """A file that Python cannot parse, with Python's message.

    `sure` is False where a newer Python may parse it.
    """

    source: Source
    message: str
    location: Location
    is_certain: bool = True
    reason: str = ""  # Python's message as it is, without the word that is refused


def location_in(source: Source, position: Position) -> Location:
    """Return the location of a position that Python gives.

    Python counts columns in bytes, a location in characters.
    """
    line = source.line(position.line)
    column = len(
        line.encode("utf-8", "surrogateescape")[: position.column - 1].decode("utf-8", "ignore")
    )
    return Location(source.path, position.line, column + 1)


def parse(data: bytes, path: str) -> Code | SyntaxFault:
    """Parse the bytes of a Python file.

    Never raises: what Python refuses, also for its depth, is a SyntaxFault.
    """
    resolved = resolve_conflicts(data)
    try:
        parsed = _parse(resolved.data if resolved is not None else data, path)
        if resolved is None:
            return parsed
        if isinstance(parsed, Code):
            return parsed._replace(conflict=(resolved.message, Position(resolved.line, 1)))
        return parsed._replace(message=resolved.message, location=Location(path, resolved.line, 1))
    except (RecursionError, MemoryError):  # these depend on the process, so they are not kept
        return SyntaxFault(
            Source(path, data.decode("utf-8", "replace")), _TOO_DEEP, Location(path, 1, 1)
        )


@reuse
def _parse(data: bytes, path: str) -> Code | SyntaxFault:
    try:
        encoding, _ = tokenize.detect_encoding(BytesIO(data).readline)
        if lookup(encoding).name in _SLOW_ENCODINGS:
            location = Location(path, 1, 1)
            return SyntaxFault(
                Source(path, ""),
                f"the encoding {encoding} is not supported",
                location,
                is_certain=False,
            )
        text = data.decode(encoding)
    except (SyntaxError, ValueError, LookupError) as error:
        source = Source(path, data.decode("utf-8", "replace"))
        return SyntaxFault(source, f"not readable as text: {error}", Location(path, 1, 1))
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    source = Source(path, text)
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        return SyntaxFault(source, "source code cannot contain null bytes", Location(path, line, 1))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore"
            )  # such as an invalid escape sequence, which Python accepts
            try:
                tree = ast.parse(text, feature_version=_JAZZY)
            except SystemError:
                # CPython 3.11 miscounts its depth if its garbage collector runs meanwhile: try
                # again
                tree = ast.parse(text, feature_version=_JAZZY)
            # Never run: the compiler finds errors that the grammar allows. It compares the code of
            # equal functions with each other, so that many take long.
            if sum(map(text.count, _FUNCTIONS)) <= _MAX_FUNCTIONS:
                compile(tree, path, "exec", dont_inherit=True)
            return Code(source, tree)
    except SyntaxError as error:
        location = Location(path, max(error.lineno or 1, 1), max(error.offset or 1, 1))
        return SyntaxFault(
            source,
            _message_of(error),
            location,
            is_certain=not _is_of_newer_python(error, text),
            reason=error.msg,
        )
    except (ValueError, OverflowError):
        return SyntaxFault(source, _TOO_DEEP, Location(path, 1, 1))


def _message_of(error: SyntaxError) -> str:
    """Return Python's message, with the word or character where it says no more than a place."""
    line, start = error.text or "", max((error.offset or 1) - 1, 0)
    token = re.compile(r"\w{1,30}|\S").match(line, start)
    if error.msg != "invalid syntax" or token is None:
        return error.msg
    return f"{error.msg} at {token[0]!r}"


def _is_of_newer_python(error: SyntaxError, text: str) -> bool:
    """Return whether the Python of ROS 2 Jazzy may accept what this older Python refuses."""
    if sys.version_info >= _JAZZY:
        return False
    in_f_string = error.msg.startswith("f-string") or _OPEN_BRACES.search(
        (error.text or "")[:_MAX_SEARCHED].rstrip()
    )
    return bool(in_f_string or _TYPES.search(text))


def parse_expression(text: str) -> ast.expr | str | None:
    """Return an expression, or Python's message on why it is none.

    Returns None if it is nested too deeply.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(text, mode="eval").body
    except SyntaxError as error:
        return f"SyntaxError: {_message_of(error)}"
    except (
        RecursionError,
        MemoryError,
        SystemError,
    ):  # how deep differs between versions; CPython 3.11 may miscount
        return None
    except (ValueError, OverflowError) as error:
        return f"{type(error).__name__}: {error}"


def own_nodes(node: ast.AST) -> list[ast.AST]:
    """Return the nodes of a function, class or statement itself.

    Those of the functions and classes in it are not among them.
    """
    nodes: list[ast.AST] = []
    pending = children(node) if isinstance(node, ast.FunctionDef | ast.ClassDef) else [node]
    while pending:
        part = pending.pop()
        nodes.append(part)
        if not isinstance(part, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda):
            pending += children(part)
    return nodes


def bound_in(node: ast.FunctionDef | ast.Module) -> frozenset[str]:
    """Return the names that a function or module binds itself."""
    nodes = own_nodes(node)
    declared: set[str] = set()  # names of a scope around this one
    inner: set[ast.AST] = set()  # targets in comprehensions, which have scopes of their own
    for part in nodes:
        if isinstance(part, ast.Global | ast.Nonlocal):
            declared.update(part.names)
        elif isinstance(part, ast.comprehension):
            inner.update(walk(part.target))
    names: set[str] = set()
    for part in nodes:
        if part not in inner and not isinstance(part, ast.arg):
            names.update(bound_names(part))
    return frozenset(names - declared)


def lines_of_docstrings(code: Code) -> set[int]:
    """Return the lines of texts that stand for themselves, such as docstrings."""
    lines: set[int] = set()
    for node in every_node(code.tree):
        match node:
            case ast.Expr(value=ast.Constant(value=str())):
                lines.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return lines
