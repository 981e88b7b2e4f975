"""Calls of the logger of rclpy with arguments that it does not take."""

import ast
from collections.abc import Iterator, Sequence

from grader.ros.nodes.message_uses import CodePart, certain_nodes
from grader.ros.nodes.node_facts import CodeFault
from grader.ros.python.parse import Code, location_in, position_of

# rclpy/rclpy/impl/rcutils_logger.py, branches humble and jazzy.
_LEVELS = frozenset({"debug", "info", "warn", "warning", "error", "fatal"})
_OPTIONS = frozenset(
    {"throttle_duration_sec", "throttle_time_source_type", "skip_first", "once", "name"}
)


def wrong_log_calls(code: Code, parts: Sequence[CodePart]) -> Iterator[CodeFault]:
    """Yield calls of get_logger() with several texts, or with options of Python's own loggers.

    They raise a TypeError.
    """
    if "rclpy" not in code.source.text:
        return
    for part in parts:
        reasons = {call: _reason(call) for call in part.calls}
        wrong = {call: reason for call, reason in reasons.items() if reason}
        certain = set(certain_nodes(part.node)) if wrong else set[ast.AST]()
        for call, reason in wrong.items():
            if call in certain:
                yield CodeFault("wrong call", reason, location_in(code.source, position_of(call)))


def _reason(call: ast.Call) -> str:
    """Return why rclpy refuses a call of a logger; empty for any other call."""
    match call.func:
        case ast.Attribute(attr=level, value=ast.Call(func=ast.Attribute(attr="get_logger"))):
            if level not in _LEVELS:
                return ""
        case _:
            return ""
    if any(isinstance(argument, ast.Starred) for argument in call.args):
        return ""
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
