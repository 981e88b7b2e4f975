"""Positions in a Python file, as its syntax tree gives them."""

import ast
from typing import NamedTuple


class Position(NamedTuple):
    """A place in a Python file; line and column count from 1."""

    line: int
    column: int


START = Position(1, 1)


def position_of(node: ast.expr | ast.stmt | ast.excepthandler) -> Position:
    """Return the position of a node."""
    return Position(node.lineno, node.col_offset + 1)
