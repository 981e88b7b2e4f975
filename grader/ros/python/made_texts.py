"""The texts that a program makes of variables, with a mark in place of what is not known."""

import ast
from collections.abc import Iterator

from grader.base.patterns import on_use
from grader.base.text import last_part
from grader.ros.python.constants import dotted
from grader.ros.python.parse import Code
from grader.ros.python.walking import walk

UNKNOWN = "\0"  # in a text, in place of what is not known
_FORMATTED = on_use(r"%[sdi]|\{[^{}]*\}")
_JOINING = ("join", "joinpath", "Path", "PathJoinSubstitution")


def made_texts(code: Code) -> Iterator[str]:
    """Yield the texts that expressions of a file make, with UNKNOWN for what is not known."""
    nodes = walk(code.tree)
    texts: dict[str, str] = {}  # of the variables that are bound to one text only
    for node in nodes:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
            text = _text(node.value, {})
            texts[name] = text if texts.get(name, text) == text else UNKNOWN
    for node in nodes:
        if isinstance(node, ast.BinOp | ast.JoinedStr | ast.Call | ast.List):
            yield _text(node, texts)


def _text(node: ast.AST, texts: dict[str, str]) -> str:
    """Return the text that an expression makes, as far as it is known."""
    made = UNKNOWN
    match node:
        case ast.Constant(value=str(text)):
            made = text.replace("*", UNKNOWN)
        case ast.Name(id=name):
            made = texts.get(name, UNKNOWN)
        case ast.JoinedStr(values=parts) | ast.List(elts=parts):
            made = "".join(_text(part, texts) for part in parts)
        case ast.FormattedValue(value=value):
            made = _text(value, texts)
        case ast.BinOp():
            made = _text_of_operation(node, texts)
        case ast.Call():
            made = _text_of_call(node, texts)
    return made


def _text_of_operation(node: ast.BinOp, texts: dict[str, str]) -> str:
    """Return the text that %, + or / makes of two."""
    left = _text(node.left, texts)
    match node.op:
        case ast.Mod():
            return _FORMATTED.sub(UNKNOWN, left)
        case ast.Add():
            return left + _text(node.right, texts)
        case ast.Div():
            return f"{left}/{_text(node.right, texts)}"
    return UNKNOWN


def _text_of_call(node: ast.Call, texts: dict[str, str]) -> str:
    """Return the text that format, or a function that joins the parts of a path, makes."""
    match node:
        case ast.Call(func=ast.Attribute(value=value, attr="format")):
            return _FORMATTED.sub(UNKNOWN, _text(value, texts))
        case ast.Call(args=[ast.List(elts=parts)] | parts):
            if last_part(dotted(node.func)) in _JOINING:
                return "/".join(_text(part, texts) for part in parts)
    return UNKNOWN
