"""Expands xacro with plain numbers: properties and ${...}. Macros, conditions and includes run code and are not expanded."""

import ast
import math
import operator
import re
from collections.abc import Callable
from keyword import iskeyword

Number = int | float

# The pieces of a file that are read, in their order: comments, properties, arguments and expressions.
_PIECE = re.compile(
    r"""(?P<comment><!--.*?-->)|<xacro:property(?P<property>(?:\s+\w+\s*=\s*(?:"[^"<>]*"|'[^'<>]*'))+)\s*"""
    r"""(?:/>|>\s*</xacro:property\s*>)|(?P<argument><xacro:arg(?:\s+\w+\s*=\s*(?:"[^"<>]*"|'[^'<>]*'))+\s*/>)|"""
    r"""(?P<escape>\$\$)|\$\{(?P<expression>[^{}]*)\}""",
    re.DOTALL,
)
_ATTRIBUTE = re.compile(r"""(\w+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")
_INTEGER = re.compile(r"[+-]?[0-9]{1,15}")
_FLOAT = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_MAX_STEPS, _MAX_DEPTH, _MAX_LENGTH, _MAX_VALUE = 20_000, 20, 200, 1e15
_CONSTANTS: dict[str, Number] = {"pi": math.pi, "e": math.e, "tau": math.tau}
_FUNCTIONS: dict[str, Callable[..., Number]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "sqrt": math.sqrt, "radians": math.radians,
    "degrees": math.degrees, "atan2": math.atan2, "min": min, "max": max,
}  # fmt: skip
_OPERATORS: dict[type[ast.AST], Callable[..., Number]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip


class _UnsupportedError(Exception):
    """A use of xacro that needs more than numbers."""


def expand(text: str) -> str | None:
    """Return the text as xacro expands it, with every line in its place; None where this needs more than numbers."""
    if "<xacro:" in text and "xmlns:xacro" not in text:
        return None  # xacro rejects the undeclared prefix
    try:
        expanded = _PIECE.sub(_Properties().replace, text)
    except _UnsupportedError:
        return None
    return None if "xacro:" in expanded.replace("xmlns:xacro", "") or "${" in expanded or "$(" in expanded else expanded


class _Properties:
    """The properties defined so far; each is evaluated when it is first used."""

    def __init__(self) -> None:
        self._texts: dict[str, str] = {}
        self._values: dict[str, Number | str] = {}
        self._steps = 0

    def replace(self, piece: re.Match[str]) -> str:
        """Return what xacro writes for a piece of the file."""
        if piece["escape"] is not None:
            raise _UnsupportedError
        if piece["expression"] is not None:
            return str(self._value(piece["expression"], 0))
        if piece["property"] is not None:
            self._define(piece["property"])
        return re.sub(r"[^\n]", " ", piece[0])

    def _define(self, attributes: str) -> None:
        given = {name: one or other for name, one, other in _ATTRIBUTE.findall(attributes)}
        name = given.get("name", "")
        if given.keys() != {"name", "value"} or not name.isidentifier() or iskeyword(name) or name.startswith("__"):
            raise _UnsupportedError
        self._texts[name] = given["value"]
        self._values.pop(name, None)

    def _value(self, expression: str, depth: int) -> Number | str:
        """Return the value of an expression: a number, or the text of a property."""
        self._steps += 1
        if depth > _MAX_DEPTH or len(expression) > _MAX_LENGTH or self._steps > _MAX_STEPS:
            raise _UnsupportedError
        name = expression.strip()
        if name in self._texts:
            return self._property(name, depth)
        try:
            return self._number(ast.parse(name, mode="eval").body, depth)
        except (SyntaxError, ValueError, ArithmeticError, RecursionError, MemoryError, TypeError):
            raise _UnsupportedError from None

    def _property(self, name: str, depth: int) -> Number | str:
        if name not in self._values:
            self._values[name] = self._evaluated(self._texts[name], depth)
        return self._values[name]

    def _evaluated(self, text: str, depth: int) -> Number | str:
        whole = _EXPRESSION.fullmatch(text)
        if whole is not None:
            return self._value(whole[1], depth + 1)
        plain = _EXPRESSION.sub(lambda found: str(self._value(found[1], depth + 1)), text)
        if "$" in plain or plain.strip().lower() in ("true", "false") or plain != plain.strip():
            raise _UnsupportedError
        if _INTEGER.fullmatch(plain):
            return int(plain)
        return float(plain) if _FLOAT.fullmatch(plain) else plain

    def _number(self, node: ast.expr, depth: int) -> Number:
        value: Number | str = ""
        match node:
            case ast.Constant(value=int() | float() as constant) if not isinstance(constant, bool):
                value = constant
            case ast.Name(id=name) if name in self._texts:
                value = self._property(name, depth + 1)
            case ast.Name(id=name) if name in _CONSTANTS:
                value = _CONSTANTS[name]
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                value = _OPERATORS[type(op)](self._number(left, depth), self._number(right, depth))
            case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
                value = _OPERATORS[type(op)](self._number(operand, depth))
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
                value = _FUNCTIONS[name](*(self._number(argument, depth) for argument in args))
        if isinstance(value, str) or not abs(value) <= _MAX_VALUE:
            raise _UnsupportedError
        return value
