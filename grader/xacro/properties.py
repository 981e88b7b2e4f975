"""xacro with plain numbers: properties and ${...} are worked out here. Macros, conditions and includes are not, as they run code."""

import ast
import math
import operator
import re
from collections.abc import Callable
from keyword import iskeyword

Number = int | float

# What is looked at, in the order of the file: comments, properties, arguments, and what is to be worked out.
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
_MOST_STEPS, _MOST_DEPTH, _LONGEST, _LARGEST = 20_000, 20, 200, 1e15
_CONSTANTS: dict[str, Number] = {"pi": math.pi, "e": math.e, "tau": math.tau}
_FUNCTIONS: dict[str, Callable[..., Number]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "sqrt": math.sqrt, "radians": math.radians,
    "degrees": math.degrees, "atan2": math.atan2, "min": min, "max": max,
}  # fmt: skip
_OPERATORS: dict[type[ast.AST], Callable[..., Number]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip


class _TooMuch(Exception):
    """Something that is more than numbers."""


def expand(text: str) -> str | None:
    """The text as xacro would write it, line by line in its place; None where that takes more than working out numbers."""
    if "<xacro:" in text and "xmlns:xacro" not in text:
        return None  # to xacro this is no XML
    try:
        expanded = _PIECE.sub(_Properties().replace, text)
    except _TooMuch:
        return None
    return None if "xacro:" in expanded.replace("xmlns:xacro", "") or "${" in expanded or "$(" in expanded else expanded


class _Properties:
    """The properties that are defined so far; each is worked out when it is first used."""

    def __init__(self) -> None:
        self._texts: dict[str, str] = {}
        self._values: dict[str, Number | str] = {}
        self._steps = 0

    def replace(self, piece: re.Match[str]) -> str:
        """What xacro writes for a piece of the file."""
        if piece["escape"] is not None:
            raise _TooMuch
        if piece["expression"] is not None:
            return str(self._value(piece["expression"], 0))
        if piece["property"] is not None:
            self._define(piece["property"])
        return re.sub(r"[^\n]", " ", piece[0])

    def _define(self, attributes: str) -> None:
        given = {name: one or other for name, one, other in _ATTRIBUTE.findall(attributes)}
        name = given.get("name", "")
        if given.keys() != {"name", "value"} or not name.isidentifier() or iskeyword(name) or name.startswith("__"):
            raise _TooMuch
        self._texts[name] = given["value"]
        self._values.pop(name, None)

    def _value(self, expression: str, depth: int) -> Number | str:
        """What an expression comes to: a number, or the text of a property."""
        self._steps += 1
        if depth > _MOST_DEPTH or len(expression) > _LONGEST or self._steps > _MOST_STEPS:
            raise _TooMuch
        name = expression.strip()
        if name in self._texts:
            return self._property(name, depth)
        try:
            return self._number(ast.parse(name, mode="eval").body, depth)
        except (SyntaxError, ValueError, ArithmeticError, RecursionError, MemoryError, TypeError):
            raise _TooMuch from None

    def _property(self, name: str, depth: int) -> Number | str:
        if name not in self._values:
            self._values[name] = self._worked_out(self._texts[name], depth)
        return self._values[name]

    def _worked_out(self, text: str, depth: int) -> Number | str:
        whole = _EXPRESSION.fullmatch(text)
        if whole is not None:
            return self._value(whole[1], depth + 1)
        plain = _EXPRESSION.sub(lambda found: str(self._value(found[1], depth + 1)), text)
        if "$" in plain or plain.strip().lower() in ("true", "false") or plain != plain.strip():
            raise _TooMuch
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
                value = _FUNCTIONS[name](*(self._number(each, depth) for each in args))
        if isinstance(value, str) or not abs(value) <= _LARGEST:
            raise _TooMuch
        return value
