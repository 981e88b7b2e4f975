"""The texts that a program makes of variables, with a mark in place of what is not known."""

import ast
import re
from collections.abc import Iterator

from grader.ros.python.constants import dotted
from grader.ros.python.parse import Code

UNKNOWN = "\0"  # in a text, in place of what is not known
_FORMATTED = re.compile(r"%[sdi]|\{[^{}]*\}")
_JOINING = ("join", "joinpath", "Path", "PathJoinSubstitution")


def made_texts(code: Code) -> Iterator[str]:
    """Yield the texts that expressions of a file make, with UNKNOWN for what is not known."""
    nodes = [*ast.walk(code.tree)]
    texts: dict[str, str] = {}  # of the variables that are bound to one text only
    for node in nodes:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name, text = node.targets[0].id, _text(node.value, {})
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
        case ast.BinOp(left=left, op=ast.Mod()):
            made = _FORMATTED.sub(UNKNOWN, _text(left, texts))
        case ast.BinOp(left=left, op=ast.Add() | ast.Div() as op, right=right):
            between = "/" if isinstance(op, ast.Div) else ""
            made = f"{_text(left, texts)}{between}{_text(right, texts)}"
        case ast.Call(func=ast.Attribute(value=value, attr="format")):
            made = _FORMATTED.sub(UNKNOWN, _text(value, texts))
        case ast.Call(func=function, args=[ast.List(elts=parts)] | parts) if (
            dotted(function).rpartition(".")[2] in _JOINING
        ):
            made = "/".join(_text(part, texts) for part in parts)
    return made
