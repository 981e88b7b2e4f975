"""Conditions in a package.xml, such as $ROS_VERSION == 2 (REP 149).

They are read as catkin_pkg's `evaluate_condition` reads them.
"""

import ast
import re
from operator import eq, ge, gt, le, lt, ne

from grader.base.patterns import on_use

# What ROS 2 Jazzy sets; a variable that is not set is empty.
_VARIABLES = {"ROS_VERSION": "2", "ROS_DISTRO": "jazzy", "ROS_PYTHON_VERSION": "3"}
_TERM = r"""(\$[A-Za-z0-9_]+|[A-Za-z0-9_-]+|"[^"\n\r]*"|'[^'\n\r]*')"""
_COMPARISON = on_use(rf"{_TERM}\s*(==|!=|>=|>|<=|<)\s*{_TERM}")
_COMPARE = {
    "==": eq,
    "!=": ne,
    ">=": ge,
    ">": gt,
    "<=": le,
    "<": lt,
}
_BETWEEN = on_use(r"(?:and|or|[()\s])*")  # what stands between comparisons
_MAX_LENGTH = 1_000  # characters


def evaluate_condition(condition: str | None) -> bool | None:
    """Return whether a condition holds in ROS 2 Jazzy.

    The result is True without one, None for one that is not valid.
    """
    if condition is None:
        return True
    if len(condition) > _MAX_LENGTH or not _BETWEEN.fullmatch(_COMPARISON.sub("", condition)):
        return None
    # With each comparison replaced by what it is, the rest is Python: `and` binds closer than `or`
    # in both.
    decided = _COMPARISON.sub(_compare, condition)
    try:
        return _decide(ast.parse(" ".join(decided.split()), mode="eval").body)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _compare(comparison: re.Match[str]) -> str:
    """Return True or False as text, with spaces around it."""
    left, operator, right = comparison.groups()
    return f" {_COMPARE[operator](_evaluate_term(left), _evaluate_term(right))} "


def _evaluate_term(term: str) -> str:
    if term.startswith("$"):
        return _VARIABLES.get(term[1:], "")
    if term[0] in "\"'":
        return term[1:-1]
    return term


def _decide(node: ast.expr) -> bool:
    match node:
        case ast.Constant(value=bool() as value):
            return value
        case ast.BoolOp(op=operator, values=values):
            decided = [_decide(value) for value in values]
            if isinstance(operator, ast.And):
                return all(decided)
            return any(decided)
    raise ValueError("this is no condition")
