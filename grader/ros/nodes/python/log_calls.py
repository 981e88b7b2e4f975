"""Calls of the logger of rclpy with arguments that it does not take."""

import ast
from collections.abc import Sequence

from grader.base.patterns import on_use
from grader.ros.nodes.message_uses import CodePart, certain_nodes
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
)
from grader.ros.python.constants import last_name
from grader.ros.python.parse import Code

# rclpy/rclpy/impl/rcutils_logger.py, branches humble and jazzy.
_LEVELS = frozenset({"debug", "info", "warn", "warning", "error", "fatal"})
_OPTIONS = frozenset(
    {"throttle_duration_sec", "throttle_time_source_type", "skip_first", "once", "name"}
)
# What gives another meaning to get_logger.
_IS_NO_METHOD = on_use(
    r"\bget_logger\s*+(?::[^=\n]{0,100})?=(?!=)|\bdef get_logger\b"
    r"|\bimport\b[^\n]{0,200}\bget_logger\b"
)


def wrong_log_calls(code: Code, parts: Sequence[CodePart]) -> CodeFaults:
    """Yield calls of get_logger() with several texts, or with options of Python's own loggers.

    They raise a TypeError. Without its parentheses, get_logger has no such method.
    """
    if "rclpy" not in code.text:
        return
    is_other = _IS_NO_METHOD.search(code.text) is not None
    for part in parts:
        reasons = {call: _reason(call, is_other=is_other) for call in part.calls}
        wrong = {call: reason for call, reason in reasons.items() if reason}
        certain = set(certain_nodes(part.node)) if wrong else set[ast.AST]()
        for call, reason in wrong.items():
            if call in certain:
                yield CodeFault("call-arguments", reason, code.at(call))


def _reason(call: ast.Call, *, is_other: bool) -> str:
    """Return why a call of a logger fails; empty for any other call.

    `is_other` says whether get_logger may be something else than a method of a node.
    """
    if not isinstance(call.func, ast.Attribute) or call.func.attr not in _LEVELS:
        return ""
    level = call.func.attr
    logger = call.func.value
    if last_name(logger.func if isinstance(logger, ast.Call) else logger) != "get_logger":
        return ""
    if not isinstance(logger, ast.Call):
        if is_other or not isinstance(logger, ast.Attribute):
            return ""
        return f"get_logger is a method, which has no {level}: write get_logger().{level}()"
    if any(isinstance(argument, ast.Starred) for argument in call.args):
        return ""
    return _wrong_arguments(call, level)


def _wrong_arguments(call: ast.Call, level: str) -> str:
    """Return why a method of a logger does not take its arguments; empty where it does."""
    if len(call.args) > 1:
        return (
            f"{level}() of a logger of rclpy takes one text, and no values for it: Python raises a "
            "TypeError; write an f-string"
        )
    for keyword in call.keywords:
        if keyword.arg is not None and keyword.arg not in {*_OPTIONS, "message"}:
            return (
                f"{level}() of a logger of rclpy has no option {keyword.arg}: it raises a TypeError"
            )
    return ""
