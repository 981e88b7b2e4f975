"""xacro with plain numbers: properties and ${...} are worked out here. Macros, conditions and includes are not, as they run code."""

import ast
import math
import operator
import re
from collections.abc import Callable

Number = int | float

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_PROPERTY = re.compile(
    r"""<xacro:property\s+name\s*=\s*["'](?P<name>[A-Za-z_]\w*)["']\s+value\s*=\s*["'](?P<value>[^"'<>]*)["']\s*"""
    r"(?:/>|>\s*</xacro:property\s*>)"
)
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")
_MOST_PROPERTIES, _MOST_DEPTH, _LONGEST = 500, 20, 200
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
    blanked = _COMMENT.sub(lambda found: _blank(found[0]), text)
    properties = {found["name"]: found["value"] for found in _PROPERTY.finditer(blanked)}
    if len(properties) > _MOST_PROPERTIES:
        return None
    plain = _PROPERTY.sub(lambda found: _blank(found[0]), blanked)
    try:
        expanded = _EXPRESSION.sub(lambda found: str(_value(found[1], properties, 0)), plain)
    except _TooMuch:
        return None
    return None if "xacro:" in expanded.replace("xmlns:xacro", "") or "${" in expanded or "$(" in expanded else expanded


def _blank(text: str) -> str:
    """White space in place of a text, with its line breaks."""
    return re.sub(r"[^\n]", " ", text)


def _value(expression: str, properties: dict[str, str], depth: int) -> Number | str:
    """What an expression comes to: a number, or the text of a property."""
    if depth > _MOST_DEPTH or len(expression) > _LONGEST:
        raise _TooMuch
    name = expression.strip()
    if name in properties:
        return _property(name, properties, depth)
    try:
        tree = ast.parse(name, mode="eval").body
        return _number(tree, properties, depth)
    except (SyntaxError, ValueError, ArithmeticError, RecursionError, MemoryError, TypeError):
        raise _TooMuch from None


def _property(name: str, properties: dict[str, str], depth: int) -> Number | str:
    text = properties[name].strip()
    whole = _EXPRESSION.fullmatch(text)
    if whole is not None:
        return _value(whole[1], properties, depth + 1)
    if "$" in text:
        raise _TooMuch
    try:
        return int(text) if re.fullmatch(r"[+-]?\d+", text) else float(text)
    except ValueError:
        return text


def _number(node: ast.expr, properties: dict[str, str], depth: int) -> Number:
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return value
        case ast.Name(id=name) if name in properties:
            found = _property(name, properties, depth + 1)
            if not isinstance(found, str):
                return found
        case ast.Name(id=name) if name in _CONSTANTS:
            return _CONSTANTS[name]
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_number(left, properties, depth), _number(right, properties, depth))
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_number(operand, properties, depth))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*(_number(each, properties, depth) for each in args))
    raise _TooMuch
