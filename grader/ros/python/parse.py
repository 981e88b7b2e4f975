"""Parses Python text with Python's own parser; whatever it refuses is data, not an exception."""

import ast
import re
import sys
import tokenize
import warnings
from codecs import lookup
from collections.abc import Iterable, Sequence
from functools import lru_cache
from io import BytesIO
from typing import NamedTuple

from grader.base.merge_conflicts import resolve_conflicts
from grader.base.records import Named
from grader.base.reuse import reuse
from grader.base.source import Location, Source
from grader.ros.known.python_names import python_version, shared_message
from grader.ros.known.releases import Releases
from grader.ros.python.bindings import bound_names
from grader.ros.python.walking import children, walk

_SLOW_ENCODINGS = (
    "idna",
    "punycode",
)  # encodings of domain names; their time grows with the square of the length
_JAZZY = 12  # the minor version of Python of ROS 2 Jazzy
# What a minor version of Python added, as it stands in a line: PEP 758 and 750, 696, 695, 701. A
# brace of an f-string that is open at its quote, at a backslash or at the end of the line is one of
# PEP 701. `feature_version` tells for older ones. Few files need the patterns: they are no objects.
_F_STRINGS = (
    12,
    r"""\b[rR]?[fF][rR]?(['"])(?:(?!\1).)*?(?<!\{)\{(?:(?!\1)[^\\{}])*(?:\1(?=.*\})|\\|$)""",
)
_ADDED = (
    (14, r"""^\s*except\*?\s+[\w.]+\s*,|(?<![\w'"])[rR]?[tT][rR]?['"]"""),
    (13, r"^\s*(?:type|(?:async\s+)?def|class)\s+\w+\s*\[[^\]]*="),
    (12, r"^\s*(?:type\s+\w+\s*[=\[]|(?:(?:async\s+)?def|class)\s+\w+\s*\[)"),
    _F_STRINGS,
)
# In it, versions of Python name other places and say other things.
_F_STRING = r"""\b[rR]?[fF][rR]?(['"])(?:.*?\1)?"""
_MAX_SEARCHED = 1_000  # characters of a line
_FUNCTIONS = ("def ", "class ", "lambda", "for ")  # what has code of its own; a comprehension has
_MAX_FUNCTIONS = 2_000  # of a file that is compiled


class Position(NamedTuple):
    """A place in a Python file; line and column count from 1."""

    line: int
    column: int


START = Position(1, 1)


AnyFunction = ast.FunctionDef | ast.AsyncFunctionDef
_Placed = ast.expr | ast.stmt | ast.excepthandler | ast.alias | ast.keyword


def make_position(node: _Placed) -> Position:
    """Return the position of a node."""
    return Position(node.lineno, node.col_offset + 1)


def end_position(node: _Placed) -> Position:
    """Return the position behind a node."""
    return Position(node.end_lineno or node.lineno, (node.end_col_offset or 0) + 1)


def name_position(node: ast.Attribute) -> Position:
    """Return the position of the name of an attribute."""
    line, column = end_position(node)
    return Position(line, column - len(node.attr))


def own_parameters(function: AnyFunction) -> list[str]:
    """Return the names of the parameters of a function, but for self."""
    return [parameter.arg for parameter in function.args.args if parameter.arg != "self"]


def caught_by(handler: ast.ExceptHandler) -> Sequence[ast.expr | None]:
    """Return the types of errors that a handler names; None stands for all."""
    return handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]


_TOO_DEEP = "too deeply nested for Python to read"


class Code(Named):
    """A parsed file with its text."""

    source: Source
    tree: ast.Module
    conflict: tuple[str, Position] | None = None  # of git, without which it was parsed
    releases: Releases = ()  # whose Python reads it; none: that of Jazzy

    @property
    def nodes(self) -> Sequence[ast.AST]:
        """All nodes of the module, level by level."""
        return every_node(self.tree)

    @property
    def text(self) -> str:
        """The text of the file."""
        return self.source.text

    def at(self, node: _Placed) -> Location:
        """Return the location of a node."""
        return location_in(self.source, make_position(node))


@lru_cache(maxsize=4)  # the readers of a module follow each other
def every_node(tree: ast.Module) -> Sequence[ast.AST]:
    """Return all nodes of a module, level by level."""
    return walk(tree)


class SyntaxFault(Named):
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


def parse(data: bytes, path: str, releases: Releases = ()) -> Code | SyntaxFault:
    """Parse the bytes of a Python file, as the newest Python of some releases does.

    It never raises: what Python refuses, also for its depth, is a SyntaxFault.
    """
    resolved = resolve_conflicts(data)
    try:
        parsed = _parse(resolved.data if resolved else data, path, releases)
        if not resolved:
            return parsed
        if isinstance(parsed, Code):
            return parsed._replace(conflict=(resolved.message, Position(resolved.line, 1)))
        return parsed._replace(message=resolved.message, location=Location(path, resolved.line, 1))
    except (RecursionError, MemoryError):  # these depend on the process, so they are not kept
        return SyntaxFault(Source.decoded(path, data), _TOO_DEEP, Location(path, 1, 1))


def _decode(data: bytes, path: str) -> Source | SyntaxFault:
    """Return the text of a file, as Python decodes it."""
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
        source = Source.decoded(path, data)
        return SyntaxFault(source, f"not readable as text: {error}", Location(path, 1, 1))
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    source = Source(path, text)
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        return SyntaxFault(source, "source code cannot contain null bytes", Location(path, line, 1))
    return source


@reuse
def _parse(data: bytes, path: str, releases: Releases) -> Code | SyntaxFault:
    source = _decode(data, path)
    if isinstance(source, SyntaxFault):
        return source
    text = source.text
    minor = python_version(releases)
    # Python 3.14 does not tell with parentheses, which Python 3.9 added, by feature_version.
    features = (3, max(minor, 9))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore"
            )  # such as an invalid escape sequence, which Python accepts
            try:
                tree = ast.parse(text, feature_version=features)
            except SystemError:
                # CPython 3.11 miscounts its depth if its garbage collector runs meanwhile: try
                # again
                tree = ast.parse(text, feature_version=features)
            # Never run: the compiler finds errors that the grammar allows. It compares the code of
            # equal functions with each other, so that many take long.
            if sum(map(text.count, _FUNCTIONS)) <= _MAX_FUNCTIONS:
                compile(tree, path, "exec", dont_inherit=True)
            code = Code(source, tree, releases=releases)
            if minor >= _F_STRINGS[0]:
                return code
            lines = [node.lineno for node in walk(tree) if isinstance(node, ast.JoinedStr)]
            return _newer_syntax(source, lines, minor, [_F_STRINGS]) or code
    except SyntaxError as error:
        line = max(error.lineno or 1, 1)
        reason, message, column = _described(error, source.line(line))
        # Python 3.14 refuses an except for its version at the end of the statement.
        above = range(line, 0 if "only supported in Python" in error.msg else line - 2, -1)
        return _newer_syntax(source, above, minor) or SyntaxFault(
            source, message, Location(path, line, column), reason=reason
        )
    except (ValueError, OverflowError):
        return SyntaxFault(source, _TOO_DEEP, Location(path, 1, 1))


def _newer_syntax(
    source: Source,
    lines: Iterable[int],
    minor: int,
    added: Iterable[tuple[int, str]] = _ADDED,
) -> SyntaxFault | None:
    """Return that one of some lines needs a newer version of Python than reads the file.

    That is the version of the release, which certainly refuses the file, or the one that runs the
    grader.
    """
    running = sys.version_info.minor
    for line in filter(None, lines):
        text = source.line(line)[:_MAX_SEARCHED].rstrip()
        for needed, pattern in added:
            if needed > min(minor, running) and re.search(pattern, text):
                other = f"Python 3.{running} runs the grader"
                if needed > minor:
                    other = f"the release has Python 3.{minor}"
                message = f"line {line} needs Python 3.{needed}, and {other}"
                return SyntaxFault(source, message, Location(source.path, line, 1), needed > minor)
    return None


def _described(error: SyntaxError, line: str) -> tuple[str, str, int]:
    """Return what is wrong in a line, as each version of Python says it.

    This is the reason, the message, which has the word or character where the reason says no more
    than a place, and the column. The versions name other places in f-strings.
    """
    column = max(error.offset or 1, 1)
    line = line[:_MAX_SEARCHED]
    spans = [match.span() for match in re.finditer(_F_STRING, line)]
    is_inside = any(start + 1 < column <= end for start, end in spans)
    is_of_f_string = error.msg.startswith("f-string") or (error.text or line).rstrip("\n") != line
    if spans and (is_inside or is_of_f_string):
        return "invalid f-string", "invalid f-string", spans[0][0] + 1
    if error.msg.startswith("expected argument value"):
        rest = line[(error.end_offset or 1) - 1 :].lstrip()
        column = len(line) - len(rest) + 1
    reason = message = shared_message(error.msg)
    token = re.match(r"\w{1,30}|\S", line[column - 1 :])
    if reason == "invalid syntax" and token:
        message = f"{reason} at {token[0]!r}"
    return reason, message, column


def parse_expression(text: str) -> ast.expr | SyntaxFault:
    """Return an expression as the Python of ROS 2 Jazzy reads it, or why it does not."""
    source = Source("", text)
    at = Location("", 1, 1)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(text, mode="eval", feature_version=(3, _JAZZY)).body
    except SyntaxError as error:
        _, message, _ = _described(error, text)
        # No line follows in which an f-string may go on.
        newer = _newer_syntax(Source("", text + "}"), (1,), _JAZZY)
        return newer or SyntaxFault(source, f"SyntaxError: {message}", at)
    except (
        RecursionError,
        MemoryError,
        SystemError,
    ):  # how deep differs between versions; CPython 3.11 may miscount
        return SyntaxFault(source, "the expression is nested too deeply", at, is_certain=False)
    except (ValueError, OverflowError) as error:
        return SyntaxFault(source, f"{type(error).__name__}: {error}", at)


def own_nodes(node: ast.AST) -> list[ast.AST]:
    """Return the nodes of a function, class or statement itself.

    Those of the functions and classes in it are not among them.
    """
    nodes = []
    pending = children(node) if isinstance(node, ast.FunctionDef | ast.ClassDef) else [node]
    while pending:
        part = pending.pop()
        nodes.append(part)
        if not isinstance(part, AnyFunction | ast.ClassDef | ast.Lambda):
            pending += children(part)
    return nodes


def bound_in(node: ast.FunctionDef | ast.Module) -> frozenset[str]:
    """Return the names that a function or module binds itself."""
    nodes = own_nodes(node)
    declared = set()  # names of a scope around this one
    inner = set()  # targets in comprehensions, which have scopes of their own
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
    for node in code.nodes:
        match node:
            case ast.Expr(value=ast.Constant(value=str())):
                lines.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return lines
