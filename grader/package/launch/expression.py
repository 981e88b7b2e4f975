"""The value of launch's PythonExpression: Python that contains plain values only."""

import builtins
import sys

from grader.package.launch.model import Context, LaunchFails, NotEvaluated
from grader.static_python.budget import Budget, OutOfBudget
from grader.static_python.builtins import BUILTINS, MATH
from grader.static_python.expressions import evaluate
from grader.static_python.knowledge import str_of
from grader.static_python.parse import Position
from grader.static_python.values import ExpressionFails, Namespace, Undetermined, Value

_WORK = 10_000  # of an expression


def expression_text(text: str, modules: Value, at: Position, context: Context) -> str:
    """Return the value of an expression, which may use these modules, as a text. Raises LaunchSignal."""
    names = [modules] if isinstance(modules, str) else modules if isinstance(modules, list | tuple) else [None]
    if not all(isinstance(name, str) and name in sys.stdlib_module_names for name in names):
        raise NotEvaluated("the modules of this expression are not evaluated", at)
    budget = Budget(_WORK)
    try:
        return str_of(evaluate(text, _find if list(names) == ["math"] else _unknown, budget))
    except ExpressionFails as error:
        raise LaunchFails(f"the expression {text[:60]!r} fails: {error}", at) from None
    except (Undetermined, OutOfBudget) as error:
        raise NotEvaluated(f"this expression is not evaluated: {error}", at) from None
    finally:
        context.around.steps_left -= budget.used


def _find(name: str) -> Value:
    if name in BUILTINS or name in MATH:
        return MATH.get(name, BUILTINS.get(name))
    if name == "math":
        return Namespace("math", MATH.__getitem__)
    if hasattr(builtins, name) or name.startswith("__"):
        return _unknown(name)
    raise ExpressionFails(f"the name {name!r} is not defined")


def _unknown(name: str) -> Value:
    raise Undetermined(f"the name {name!r} is not evaluated")
