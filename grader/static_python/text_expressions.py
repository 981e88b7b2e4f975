"""The value of an expression that is given as text, without a file around it."""

import ast
from collections.abc import Mapping

from grader.static_python.control_flow import EvaluationStopped, ExitFlow
from grader.static_python.evaluation import FunctionTable
from grader.static_python.expressions import ExpressionEvaluator
from grader.static_python.parse import SyntaxFault, parse
from grader.static_python.positions import START
from grader.static_python.values import Unknown, Value

_MAX_LENGTH = 1_000


def evaluate_text(text: str, functions: FunctionTable, names: Mapping[str, Value]) -> Value:
    """Return the value of an expression with these functions and names; Unknown if it has an error. Never raises."""
    if len(text) > _MAX_LENGTH:
        return Unknown("the expression is too long", START)
    code = parse(text.strip().encode("utf-8", "replace"), "")
    if isinstance(code, SyntaxFault):
        return Unknown(code.message, START)
    match code.tree.body:
        case [ast.Expr(value=expression)]:
            evaluator = ExpressionEvaluator(functions, names)
        case _:
            return Unknown("this is not one expression", START)
    try:
        value = evaluator.evaluate(expression, evaluator.module)
    except (EvaluationStopped, ExitFlow, RecursionError):
        return Unknown("the expression takes too long to evaluate", START)
    return Unknown(evaluator.errors[0].message, evaluator.errors[0].at) if evaluator.errors else value
