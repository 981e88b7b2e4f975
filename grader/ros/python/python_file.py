"""A Python file with its syntax tree and strings, for edits that change nothing else."""

import ast
import re
from collections.abc import Container, Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

from grader.base.grouping import Span
from grader.base.patterns import on_use
from grader.base.source import Edit, Edits, Source
from grader.ros.known.python_names import python_names
from grader.ros.python.bindings import names_bound
from grader.ros.python.library import USUAL_NAMES
from grader.ros.python.parse import Code, SyntaxFault, parse, parse_expression
from grader.ros.python.walking import walk

_Placed = ast.expr | ast.stmt | ast.keyword

_STRING = on_use(
    r"""
      \#[^\n]*
    | (?P<string>[rRbBfFuU]{0,2}(?:
          "{3}(?:\\.|[^\\])*?"{3} | '{3}(?:\\.|[^\\])*?'{3}    # over several lines
        | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*'            # "launch", r'\d', f'{name}.urdf'
      ))
    | \w+
    """,
    re.DOTALL | re.VERBOSE,
)
_QUOTES = on_use("[rRbBfFuU]*(\"\"\"|'''|\"|')")
_MAX_DEPTH = 4  # of names that are replaced by their values
_MAX_CODE = 2000  # characters
_USE = on_use(r"\bglob\.glob\b")
_CAT = on_use(r"\bcat(?=\s)")


class _Literal(NamedTuple):
    """The text between the quotes of a string, and its offsets."""

    text: str
    start: int
    end: int


class PythonFile:
    """A Python file for edits.

    Offsets are in the text as the file has it, which may have other line breaks than Python sees.
    """

    def __init__(self, source: Source) -> None:
        self.source = source
        self.text = source.text
        self.newline = "\r\n" if "\r\n" in source.text else "\n"
        self._plain: dict[ast.expr, str] = {}

    @cached_property
    def parsed(self) -> Code | SyntaxFault:
        """The syntax tree, or why there is none."""
        return parse(self.text.encode("utf-8", "surrogateescape"), self.source.path)

    @property
    def fault(self) -> SyntaxFault | None:
        """Why Python cannot read the file; None if it can."""
        return self.parsed if isinstance(self.parsed, SyntaxFault) else None

    @cached_property
    def nodes(self) -> list[ast.AST]:
        """All nodes of the syntax tree; nothing where Python cannot read the file."""
        if isinstance(self.parsed, Code):
            return walk(self.parsed.tree)
        return []

    @cached_property
    def literals(self) -> list[_Literal]:
        """The texts in its strings."""
        literals = []
        for match in _STRING.finditer(self.text):
            quotes = _QUOTES.match(match["string"] or "")  # none in a comment or a word
            if quotes:
                start = match.start("string") + quotes.end()
                end = match.end("string") - len(quotes[1])
                literals.append(_Literal(self.text[start:end], start, end))
        return literals

    def offset(self, line: int, byte: int) -> int:
        """Return the offset of a place that Python gives: it counts the bytes of a line from 0."""
        start = self.source.offset(line, 1)
        text = self.text[start : start + byte].encode("utf-8", "surrogateescape")[:byte]
        return start + len(text.decode("utf-8", "surrogateescape"))

    def span(self, node: _Placed | ast.arg) -> Span:
        """Return the offsets of the start and the end of a node."""
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return self.offset(node.lineno, node.col_offset), self.offset(
            node.end_lineno, node.end_col_offset
        )

    def segment(self, node: _Placed) -> str:
        """Return the text of a node."""
        start, end = self.span(node)
        return self.text[start:end]

    def replaced(self, node: _Placed, new: str) -> Edit:
        """Return the edit that replaces a node."""
        return self.source.edit(*self.span(node), new)

    @cached_property
    def values(self) -> dict[str, ast.expr]:
        """The expressions that are bound to names."""
        by_name = {}
        for node in self.nodes:
            match node:
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    by_name[name] = value
                case ast.withitem(context_expr=value, optional_vars=ast.Name(id=name)):
                    by_name[name] = value
        return by_name

    @property
    def made(self) -> list[str]:
        """The names of what calls of classes make."""
        made = []
        for name, value in self.values.items():
            if isinstance(value, ast.Call) and _called(value)[:1].isupper():
                made.append(name)
        return made

    def meant(self, node: ast.expr) -> ast.expr:
        """Return the expression that a name is bound to; any other expression itself."""
        for _ in range(_MAX_DEPTH):
            if not isinstance(node, ast.Name) or node.id not in self.values:
                break
            node = self.values[node.id]
        return node

    def written(self, node: ast.expr, bound: Container[str] = (), depth: int = _MAX_DEPTH) -> str:
        """Return an expression in which the names that are not `bound` have their values."""
        start, _ = self.span(node)
        text = self.segment(node)
        names = [inner for inner in walk(node) if isinstance(inner, ast.Name)]
        if not depth:
            return text
        for name in sorted(names, key=lambda inner: self.span(inner)[0], reverse=True):
            if name.id not in bound and name.id in self.values and len(text) <= _MAX_CODE:
                at, end = (offset - start for offset in self.span(name))
                text = text[:at] + self.written(self.values[name.id], bound, depth - 1) + text[end:]
        return text

    def plain(self, node: ast.expr) -> str:
        """Return the code of an expression in one style, to compare it.

        Its parts have no names in it.
        """
        if node not in self._plain:
            code = self.written(node)
            tree = _expression(code)
            self._plain[node] = ast.unparse(tree) if tree else code
        return self._plain[node]

    def names_in(self, code: str) -> set[str]:
        """Return the names in an expression."""
        tree = _expression(code)
        if tree:
            return {node.id for node in walk(tree) if isinstance(node, ast.Name)}
        return set()

    @cached_property
    def bound(self) -> frozenset[str]:
        """The names that the file binds anywhere."""
        return frozenset(names_bound(self.nodes))

    @cached_property
    def used(self) -> frozenset[str]:
        """The names that the file reads anywhere."""
        return frozenset(
            node.id
            for node in self.nodes
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
        )

    @property
    def undefined(self) -> frozenset[str]:
        """The names that it reads, and that neither it nor Python defines."""
        return self.used - self.bound - python_names("builtins")

    @cached_property
    def imports(self) -> list[ast.Import | ast.ImportFrom]:
        """Its import statements."""
        return [node for node in self.nodes if isinstance(node, ast.Import | ast.ImportFrom)]

    def calls(self, name: str) -> list[ast.Call]:
        """Return the calls of a function or class of this name, in order."""
        matching = (
            node for node in self.nodes if isinstance(node, ast.Call) and _called(node) == name
        )
        return sorted(matching, key=lambda node: (node.lineno, node.col_offset))

    def with_imports(self, names: Iterable[str]) -> list[Edit]:
        """Return the edit that imports those of these names that have a usual meaning.

        Names that are bound are not imported.
        """
        missing = [name for name in dict.fromkeys(names) if name not in self.bound]
        lines = [self._import(name) for name in missing if name in USUAL_NAMES]
        if not lines:
            return []
        body = self.parsed.tree.body if isinstance(self.parsed, Code) else []
        first = next(iter(self.imports + body), None)
        start = self.span(first)[0] if first else len(self.text)
        lines.sort(key=lambda line: line.startswith("from"))
        return [self.source.edit(start, start, "".join(lines))]

    def _import(self, name: str) -> str:
        module, _, attribute = USUAL_NAMES[name].rpartition(".")
        if attribute == "?glob":
            module, attribute = ("", "glob") if _USE.search(self.text) else ("glob", "glob")
        if module:
            return f"from {module} import {attribute}{self.newline}"
        return f"import {attribute}{self.newline}"


def _expression(code: str) -> ast.expr | None:
    parsed = parse_expression(code.strip())
    return parsed if isinstance(parsed, ast.expr) else None


def _called(call: ast.Call) -> str:
    """Return the last part of the name of the function that is called."""
    if isinstance(call.func, ast.Attribute):
        return call.func.attr
    return getattr(call.func, "id", "")


def argument(call: ast.Call, name: str) -> ast.keyword | None:
    """Return a keyword argument of a call."""
    return next((keyword for keyword in call.keywords if keyword.arg == name), None)


def with_xacro(source: Source) -> Iterator[Edits]:
    """Yield the edits of a launch file that read the robot with xacro instead of open or cat."""
    for match in _CAT.finditer(source.text):
        yield (source.edit(match.start(), match.end(), "xacro"),)
    if not source.path.endswith(".py"):
        return
    file = PythonFile(source)
    for call in file.calls("read") + file.calls("read_text"):
        owner: ast.expr = call
        if isinstance(call.func, ast.Attribute):
            owner = file.meant(call.func.value)
        if isinstance(owner, ast.Name):
            owner = file.values.get(owner.id, owner)
        if isinstance(owner, ast.Call) and _called(owner) == "open" and owner.args:
            path = owner.args[0]
        elif _called(call) == "read_text":
            path = owner
        else:
            continue
        new = f"xacro.process_file({file.segment(path)}).toxml()"
        yield (*file.with_imports(["xacro"]), file.replaced(call, new))
